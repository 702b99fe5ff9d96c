"""How likely a sum of squares is whose errors are shared or correlated."""

import math
import re
from pathlib import Path

import pytest
from slipped_campaigns import write
from test_oddities import SOUND, checks, computed, stated, told

from loopsheet.report.views import html

pytestmark = pytest.mark.usefixtures("keeping")

TIED = {
    "correlated": '[uncertainty.correlation]\n"v, e" = "0.95"\n',
    "shared": '[uncertainty.shared."height datum"]\nof = "x_p"\nstated = "u = 0.3 um"\n',
}


@pytest.mark.parametrize("more", TIED.values(), ids=list(TIED))
def test_of_errors_that_are_tied_chance_is_asked_with_what_they_have_in_common(
    tmp_path: Path, more: str
) -> None:
    """A shared error, however small, was no reason to say nothing of tests on no common curve."""
    assert told(write(tmp_path, SOUND, stated() + more)) == []
    assert checks(tmp_path)["squares chi2_eiv"].message.endswith("which is what chance makes")
    text = " ".join(html.render(computed(tmp_path), {}).split())
    assert "Some errors are shared or correlated" in text
    assert "the probability counts it" in text
    assert "describes these tests within" in text
    (warning,) = told(write(tmp_path, SOUND, stated(0.2) + more))
    said = r"warning: chi2_eiv = [\d.]+, [\d.]+ with what errors have in common, on 4 degrees of freedom; "
    assert re.match(said, warning)
    assert "without test" not in warning  # its weights are those of the fit


def test_an_error_of_each_test_alone_counts_as_its_own(tmp_path: Path) -> None:
    """Groups of one test share nothing: the sum is that of a fit that weighs by all of it, along tangents."""
    groups = str([[n] for n in range(1, 7)])
    shared = f'[uncertainty.shared.gauge]\nof = "x_p"\nstated = "u = 0.15 um"\ngroups = {groups}\n'
    found = computed(write(tmp_path, SOUND, stated(0.5) + shared))
    own = stated(0.5).replace("u = 0.1 um", f"u = {math.hypot(0.1, 0.15)!r} um")
    assert own != stated(0.5)
    of_fit = computed(write(tmp_path, SOUND, own)).values.scalar("chi2_eiv")
    assert found.uncertain().misfits["chi2_eiv"].chi2 == pytest.approx(of_fit, rel=2e-3)
    assert abs(found.values.scalar("chi2_eiv") / of_fit - 1) > 0.2
    without = found.uncertain().misfits["chi2_eiv"]
    assert (without.dof, without.is_stated) == (4, True)
