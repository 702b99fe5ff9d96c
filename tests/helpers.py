"""What tests of several files share."""

from loopsheet.derivations.contact import damping as model
from loopsheet.report.impacts.damping import _MARGIN, _STRONG, _value, _zero


def number_for(e: float) -> float:
    """The damping number with which the family returns a restitution, for any n: (L106), solved for it."""
    if e < 1 / _STRONG:
        return 1 / e
    (residual,) = model.returned.residuals
    # Weak damping: c is about 1 - e^2; (L106) also holds for c = 0, which returns any e.
    return _zero(lambda c: _value(residual, c=c, e_o=e), 0.2 * (1 - e**2), (1 - _MARGIN) / e)
