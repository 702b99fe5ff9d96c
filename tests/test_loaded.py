"""What a report is to Python: its columns are arrays, and a scalar is a number."""

from pathlib import Path

import numpy as np
import pytest

import loopsheet
from loopsheet import LoopsheetError, load

pytestmark = pytest.mark.usefixtures("unrefereed")


def test_what_is_wrong_with_a_folder_stands_below_two_frames(tmp_path: Path) -> None:
    (tmp_path / "report.toml").write_text('workbook = "soft_impact"\n', encoding="utf-8")
    with pytest.raises(LoopsheetError) as told:
        load(tmp_path)
    assert len(told.traceback) == 2


def test_columns_behave_as_arrays_do() -> None:
    report = loopsheet.load("paper")
    mean, each = report["alpha_mean"], report["alpha"]
    assert mean
    assert isinstance(each * 2, np.ndarray)
    assert (2 * each).tolist() == (each.value * 2).tolist()
    assert (mean > 1) & (mean < 2)
    assert (each > mean).tolist() == (each.value > float(mean)).tolist()
    assert len(each) == len(each.index)
    with pytest.raises(TypeError):
        len(mean)
    with pytest.raises(ValueError, match="ambiguous"):
        bool(each)
