"""What a report is to Python: its columns are arrays, and a scalar is a number."""

import copy
import pickle
from pathlib import Path

import grouped
import numpy as np
import pytest

import loopsheet
from loopsheet import LoopsheetError, load
from loopsheet.report.inputs.folders import PAPER

pytestmark = pytest.mark.usefixtures("unrefereed")


def test_what_is_wrong_with_a_folder_stands_below_two_frames(tmp_path: Path) -> None:
    (tmp_path / "report.toml").write_text('workbook = "soft_impact"\n', encoding="utf-8")
    with pytest.raises(LoopsheetError) as told:
        load(tmp_path)
    assert len(told.traceback) == 2


def test_a_report_is_shown_by_its_results_if_it_has_any() -> None:
    assert repr(load("paper")).startswith("<report 'Soft steel, ball drop': 1.3013, ")
    assert repr(load(PAPER.parent / "kepler")) == "<report 'Kepler's equation'>"


def test_columns_behave_as_arrays_do() -> None:
    report = loopsheet.load("paper")
    mean, each = report["alpha_mean"], report["alpha"]
    assert mean
    assert isinstance(each * 2, np.ndarray)
    assert (2 * each).tolist() == (each.value * 2).tolist()
    assert (mean > 1) & (mean < 2)
    assert (each > mean).tolist() == (each.value > float(mean)).tolist()
    assert (int(mean), round(mean, 2)) == (int(float(mean)), round(float(mean), 2))
    assert len(each) == len(each.index)
    with pytest.raises(TypeError):
        len(mean)
    with pytest.raises(ValueError, match="ambiguous"):
        bool(each)


def test_what_was_computed_stays_as_it_is() -> None:
    mean, each = (loopsheet.load("paper")[name] for name in ("alpha_mean", "alpha"))
    with pytest.raises(TypeError, match="alpha stays as it was computed: alpha = alpha"):
        each += 1
    with pytest.raises(TypeError, match="stays as it was computed"):
        np.add(each, 1, out=each)
    assert np.asarray(each, copy=False) is each.value
    with pytest.raises(ValueError, match="copy"):
        np.asarray(each, dtype=np.float32, copy=False)
    assert str(mean) == f"{mean}" == "1.3026"


def test_another_process_has_the_same_report() -> None:
    paper = loopsheet.load("paper")
    for again in (pickle.loads(pickle.dumps(paper)), copy.deepcopy(paper)):
        assert again["alpha"].value.tolist() == paper["alpha"].value.tolist()
        assert again.title == paper.title
    assert "alpha_mean" in paper._ipython_key_completions_()


def test_a_name_that_is_misspelt_is_told_with_the_nearest() -> None:
    with pytest.raises(AttributeError) as told:
        loopsheet.laod  # type: ignore[attr-defined]  # noqa: B018
    assert (told.value.name, told.value.obj) == ("laod", loopsheet)  # by which Python proposes `load`


def test_a_row_has_its_number() -> None:
    report = loopsheet.load("paper")
    pair = report["alpha[1-2]"]
    assert (pair.index, pair.value.shape, pair.rows[0][0]) == (("1-2",), (), "alpha[1-2]")
    assert (float(pair), float(pair.u)) == (report["alpha"].value[0], report["alpha"].u[0])
    with pytest.raises(KeyError, match="alpha has no row '2-1': 1-2, 1-3, "):
        report["alpha"]["2-1"]
    with pytest.raises(KeyError, match="alpha_mean has no row '1': it is a single number"):
        report["alpha_mean[1]"]
    with pytest.raises(KeyError, match="no quantity 'alfa"):
        report["alfa[1-2]"]


def test_a_group_has_its_word(tmp_path: Path) -> None:
    report = loopsheet.load(grouped.write(tmp_path))
    word = report["level"].names[1]
    assert not word.isdigit()
    assert [at for at, _, _ in report["level"].rows] == [f"level[{each}]" for each in report["level"].names]
    assert float(report[f"level[{word}]"]) == float(report["level"]["2"]) == report["level"].value[1]
    assert report["level"].of(2).index == ("2",)
    own = report["y"][word]  # of all rows of the group
    assert own.value.tolist() == [
        y for y, each in zip(report["y"], report["y"].words, strict=True) if each == word
    ]
    with pytest.raises(KeyError, match=f"1, 2, 3, .*{word}"):
        report["level"]["of nobody"]
