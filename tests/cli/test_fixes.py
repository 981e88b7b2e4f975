"""The fixes of problems: what they are, and that reports never ask for them."""

import pickle
import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest

from grader.base.problems import NO_FIXES, Fix, Fixes, Problem
from grader.base.source import Edit
from grader.files.tree import make_tree, overlaid
from grader.report.formats import Format, InspectFormat
from grader.ros.api import read_workspace
from tests.command_line import run, run_process
from tests.samples import ROOT

_SAMPLE = ROOT / "submissions/diffdrive/joint-misspelt"
_GRADE = ("grade", _SAMPLE, "--rubric", "diffdrive", "--hints")
# A process that asks for a fix ends with this code.
_ASKED = 77
_STOPPING = f"""\
import os
import sys
from grader.base import problems
problems.Fixes.__iter__ = lambda self: os._exit({_ASKED})
"""


def _problems() -> list[Problem]:
    files = {
        path.relative_to(_SAMPLE).as_posix(): path.read_bytes()
        for path in _SAMPLE.rglob("*")
        if path.is_file()
    }
    tree = overlaid(make_tree("ws", (), ()), files)
    return read_workspace(tree, "ws", 1_000_000, {}).package_problems()


def _no_fix(_: Fixes) -> Iterator[Fix]:
    raise AssertionError("nothing that is printed asks for a fix")


def test_a_misspelt_name_has_a_fix_where_it_is_used() -> None:
    [problem] = [it for it in _problems() if it.severity == "error"]
    [fix] = problem.fixes
    at = problem.location
    right = "left_wheel_joint"
    assert fix.edits == (Edit(at.path, at.line, at.column, "wheel_left_joint", right),)
    assert fix.assumption == f"'wheel_left_joint' is read as '{right}'"
    assert problem.related is not None


def test_fixes_take_no_part_in_what_a_problem_is() -> None:
    """It is equal to itself without them, and its copy in another process has none."""
    [problem] = [it for it in _problems() if it.severity == "error"]
    plain = problem._replace(fixes=NO_FIXES)
    assert (problem, hash(problem)) == (plain, hash(plain))
    copy = pickle.loads(pickle.dumps(problem))
    assert copy == problem
    assert ([*problem.fixes] != [], [*copy.fixes]) == (True, [])


def test_fixes_are_computed_once_and_when_they_are_asked_for() -> None:
    asked = []

    def compute() -> list[Fix]:
        asked.append(1)
        return [Fix((), "nothing")]

    fixes = Fixes(compute)
    assert asked == []
    assert [*fixes] == [*fixes] == [Fix((), "nothing")]
    assert asked == [1]


@pytest.mark.slow
@pytest.mark.parametrize("form", Format)
@pytest.mark.parametrize("level", ["none", "place", "cause"])
def test_no_report_asks_for_a_fix(
    form: Format, level: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """No format of a report has one below the level `edit`, where hints prove edits first."""
    expected = run((*_GRADE, level, "--format", form)).stdout
    monkeypatch.setattr(Fixes, "__iter__", _no_fix)
    assert run((*_GRADE, level, "--format", form)).stdout == expected


@pytest.mark.slow
@pytest.mark.parametrize("form", InspectFormat)
def test_no_inspection_asks_for_a_fix(form: InspectFormat, monkeypatch: pytest.MonkeyPatch) -> None:
    expected = run(("inspect", _SAMPLE, "--format", form)).stdout
    monkeypatch.setattr(Fixes, "__iter__", _no_fix)
    assert run(("inspect", _SAMPLE, "--format", form)).stdout == expected


@pytest.mark.exhaustive
def test_no_class_asks_for_a_fix(tmp_path: Path) -> None:
    """Neither the command nor the processes that grade."""
    (tmp_path / "code").mkdir()
    (tmp_path / "code/sitecustomize.py").write_text(_STOPPING)
    shutil.copytree(_SAMPLE, tmp_path / "class/ada")
    words = ["batch", tmp_path / "class", "--gradebook", tmp_path / "book", "--jobs", "1"]
    words += ["--rubric", "diffdrive", "--report-format", "html", "--reports", tmp_path / "reports"]
    done = run_process([str(word) for word in words], b"", {"PYTHONPATH": str(tmp_path / "code")})
    assert done.returncode == 0, done.stderr.decode()
    assert "wheel_left_joint" in next((tmp_path / "reports").rglob("*.html")).read_text()
