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
    assert "the probability is that of the sum of squares with what these errors" in text
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
    assert found.uncertain().misfits["chi2_eiv"].dof == 4


def test_beside_a_shared_error_that_hides_all_others_nothing_is_told(tmp_path: Path) -> None:
    """It was a sum on one degree of freedom, much too small: honest tests were told that they overstate."""
    for u, skipped in ((1e2, False), (1e5, True)):
        shared = f'[uncertainty.shared.datum]\nof = "x_p"\nstated = "u = {u:g} um"\n'
        write(tmp_path, SOUND, stated() + shared)
        found = checks(tmp_path)["squares chi2_eiv"]
        assert (found.skipped, found.passed) == (skipped, True)
        assert skipped or found.message.endswith("which is what chance makes")


def test_uncertainties_that_are_themselves_known_from_few_readings_count(tmp_path: Path) -> None:
    own = stated(0.3).replace('x_p = "u = 0.06 um"', 'x_p = "u = 0.06 um, dof = 3"')
    assert own != stated(0.3)
    sure, unsure = (
        checks(write(tmp_path, SOUND, each + TIED["correlated"]))["squares chi2_eiv"].message
        for each in (stated(0.3), own)
    )
    assert "the probability of so much" in sure
    assert "on 4 degrees of freedom by a u with" in unsure
    assert unsure.endswith("which is what chance makes")
