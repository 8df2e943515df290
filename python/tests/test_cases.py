"""Problems that other programs are asked about, each with values of its own.

In: the scripts of the folder `cases`. Each names the discussions that it comes from and where its values come from, and
asserts that the motion has them.
"""

import runpy
from pathlib import Path

import pytest

CASES = sorted((Path(__file__).parent / "cases").glob("*.py"))


def test_no_case_is_lost():
    assert len(CASES) == 13


@pytest.mark.filterwarnings("ignore:overflow encountered in multiply:RuntimeWarning")  # in SciPy
@pytest.mark.parametrize("case", CASES, ids=lambda case: case.stem)
def test_case(case, tmp_path, monkeypatch):
    # A case writes its tables beside itself.
    monkeypatch.chdir(tmp_path)
    runpy.run_path(str(case))
