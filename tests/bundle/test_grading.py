"""An autograder on Gradescope grades submissions: results.json always exists and is what Gradescope accepts."""

import json
import os
import shutil
from pathlib import Path

import pytest

from tests.bundle.gradescope import Autograder
from tests.classroom.gradebooks import PNG, grader
from tests.samples import ROOT

# Modules that Python, the autograder or the grader imports.
MODULES = (
    "json",
    "typing",
    "sitecustomize",
    "usercustomize",
    "encodings",
    "os",
    "re",
    "subprocess",
    "lxml",
    "typer",
    "yaml",
)


@pytest.mark.slow
def test_a_submission_with_mistakes(autograder: Autograder) -> None:
    """Students see the same report as on any other machine."""
    autograder.submit("several-mistakes")
    report = grader("grade", ROOT / "submissions/lab6/several-mistakes", "--format", "gradescope")
    assert report.returncode == 1
    results = autograder.run()
    assert results == json.loads(report.stdout)
    assert {test.get("status") for test in results["tests"]} == {"passed", "failed", None}


@pytest.mark.exhaustive
def test_the_same_submission_gives_the_same_bytes(autograder: Autograder) -> None:
    """Results contain no time, and nothing of an earlier run remains."""
    autograder.submit("several-mistakes")
    autograder.run()
    before = (autograder.root / "results" / "results.json").read_bytes()
    (autograder.root / "results" / "results.json").write_text("of yesterday")
    autograder.run(TZ="Asia/Tokyo", LANG="de_DE.ISO-8859-1", COLUMNS="40")
    assert (autograder.root / "results" / "results.json").read_bytes() == before


@pytest.mark.exhaustive
def test_an_empty_submission(autograder: Autograder) -> None:
    """Nothing is graded, and the student sees the reason."""
    results = autograder.run()
    assert (results["score"], results["tests"], results["output_format"]) == (0, [], "text")
    assert "submission is empty" in results["output"]
    assert "grader: " not in results["output"]
    autograder.submission.rmdir()
    shutil.rmtree(autograder.root / "results")
    assert "submission does not exist" in autograder.run()["output"]


@pytest.mark.exhaustive
def test_a_changed_rubric_is_refused(tmp_path: Path, autograder: Autograder, source: Path) -> None:
    """No points are given if the rubric differs from the one that the bundle was made for."""
    settings = json.loads((source / "autograder.json").read_text())
    (autograder.root / "source").unlink()
    (autograder.root / "source").mkdir()
    (autograder.root / "source" / "autograder.py").write_bytes(
        (source / "autograder.py").read_bytes()
    )
    (autograder.root / "source" / "autograder.json").write_text(
        json.dumps({**settings, "sha256": "0" * 64})
    )
    autograder.submit("reference")
    results = autograder.run()
    assert (results["score"], results["tests"]) == (0, [])
    assert "rubric" in results["output"]


def named(folder: Path) -> None:
    """Write files whose names contain escapes, markup, newlines, bidirectional marks and undecodable bytes."""
    text = (ROOT / "submissions/lab6/several-mistakes/my_robot/urdf/my_robot.urdf").read_bytes()
    for name in (
        b"a\nb.urdf",
        b"\x1b[31m\x1b]0;t\x07.urdf",
        b"'\"$(id)`id`.urdf",
        "\u202egnp.urdf".encode(),
        b"\xff\xfe.urdf",
    ):
        path = Path(os.fsdecode(os.path.join(os.fsencode(folder), name)))
        path.write_bytes(text)
        path.with_suffix(".png").write_bytes(PNG)
    (folder / "<img src=x onerror=alert(1)>.md").write_text(
        "# Step 15\n\n<script>alert(1)</script>\x00\x1b[2J\n```\n"
    )
    (folder / "step 2.md").write_bytes(b"# Task 2 step 2\n\n\xff\xfe\xed\xa0\x80\n")


def linked(folder: Path) -> None:
    """Write symlinks to the machine's files, to the autograder's files and to themselves."""
    (folder / "my_robot.urdf").symlink_to("/etc/passwd")
    (folder / "etc").symlink_to("/etc")
    (folder / "source").symlink_to("../source")
    (folder / "loop").symlink_to("loop")
    (folder / "up").symlink_to("..")
    os.mkfifo(folder / "pipe.urdf")


_IN_CI = [pytest.param(hostile, marks=pytest.mark.exhaustive) for hostile in (named, linked)]


@pytest.mark.parametrize("hostile", _IN_CI, ids=lambda make: make.__name__)
def test_a_hostile_submission(autograder: Autograder, hostile: object) -> None:
    """A hostile submission still has results, and they contain nothing of the machine's own files."""
    assert callable(hostile)
    hostile(autograder.submission)
    results = autograder.run()
    assert results["score"] <= 90
    assert "root:" not in json.dumps(results)
    assert sorted(path.name for path in autograder.root.iterdir()) == [
        "results",
        "run_autograder",
        "source",
        "submission",
        "submission_metadata.json",
        "venv",
    ]


@pytest.mark.exhaustive
def test_nothing_of_a_submission_is_imported(autograder: Autograder) -> None:
    """Modules of a submission named like the grader's are not imported, even if PYTHONPATH names their folder."""
    autograder.submit("reference")
    mark = autograder.root.parent / "ran"
    program = f"open({str(mark)!r}, 'w').close()\n"
    for target in (autograder.submission, autograder.root):
        for name in MODULES:
            (target / f"{name}.py").write_text(program)
        (target / "grader").mkdir()
        for name in ("__init__", "__main__", "errors"):
            (target / "grader" / f"{name}.py").write_text(program)
    folder = str(autograder.submission)
    results = autograder.run(
        PYTHONPATH=folder, PYTHONHOME=folder, PYTHONUSERBASE=folder, PYTHONSTARTUP=f"{folder}/os.py"
    )
    assert results["score"] == 90
    assert not mark.exists()
