"""What an autograder on Gradescope makes of submissions: results.json is always there, and is what Gradescope takes."""

import io
import json
import os
import shutil
import tarfile
from pathlib import Path

import pytest

from tests.bundle.platform import Autograder
from tests.classroom.gradebooks import PNG, grader
from tests.samples import ROOT

LAUGHS = '<!DOCTYPE r [<!ENTITY a "ha">' + "".join(
    f'<!ENTITY {b} "{f"&{a};" * 10}">' for a, b in zip("abcdefghi", "bcdefghij", strict=True)
)
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


def test_a_submission_that_passes(autograder: Autograder) -> None:
    """The reference gets all points that a program can give, and each criterion is a test."""
    autograder.hand_in("reference")
    results = autograder.run()
    assert results["score"] == sum(each.get("score", 0) for each in results["tests"]) == 90
    assert all(each["status"] == "passed" for each in results["tests"] if "score" in each)


def test_a_submission_with_mistakes(autograder: Autograder) -> None:
    """What students see is what the report says on any other machine."""
    autograder.hand_in("several-mistakes")
    report = grader("grade", ROOT / "submissions" / "several-mistakes", "--format", "gradescope")
    assert report.returncode == 1
    results = autograder.run()
    assert results == json.loads(report.stdout)
    assert {each.get("status") for each in results["tests"]} == {"passed", "failed", None}


def test_the_same_submission_gives_the_same_bytes(autograder: Autograder) -> None:
    """There is no clock in the results, and nothing of an earlier run stays."""
    autograder.hand_in("several-mistakes")
    autograder.run()
    before = (autograder.root / "results" / "results.json").read_bytes()
    (autograder.root / "results" / "results.json").write_text("of yesterday")
    autograder.run(TZ="Asia/Tokyo", LANG="de_DE.ISO-8859-1", COLUMNS="40")
    assert (autograder.root / "results" / "results.json").read_bytes() == before


def test_an_archive_that_is_not_unpacked(autograder: Autograder) -> None:
    """Gradescope unpacks a zip and no tar; it is read where it is."""
    with tarfile.open(autograder.submission / "lab6.tar.gz", "w:gz") as archive:
        archive.add(ROOT / "submissions" / "reference", "lab6")
    assert autograder.run()["score"] == 90


def test_an_empty_submission(autograder: Autograder) -> None:
    """Nothing is graded, and the student reads why."""
    results = autograder.run()
    assert (results["score"], results["tests"], results["output_format"]) == (0, [], "text")
    assert "submission is empty" in results["output"]
    assert "grader: " not in results["output"]
    autograder.submission.rmdir()
    shutil.rmtree(autograder.root / "results")
    assert "submission does not exist" in autograder.run()["output"]


def test_another_rubric_than_the_bundle_was_made_for(tmp_path: Path, autograder: Autograder, source: Path) -> None:
    """Nobody gets points by a rubric that somebody has changed since."""
    settings = json.loads((source / "autograder.json").read_text())
    (autograder.root / "source").unlink()
    (autograder.root / "source").mkdir()
    (autograder.root / "source" / "autograder.py").write_bytes((source / "autograder.py").read_bytes())
    (autograder.root / "source" / "autograder.json").write_text(json.dumps({**settings, "sha256": "0" * 64}))
    autograder.hand_in("reference")
    results = autograder.run()
    assert (results["score"], results["tests"]) == (0, [])
    assert "rubric" in results["output"]


def deep(folder: Path) -> None:
    """XML with entities that multiply, and with a hundred thousand tags in each other."""
    (folder / "laughs.urdf").write_text(f"{LAUGHS}]><robot name='r'>&j;</robot>")
    (folder / "deep.urdf").write_text("<robot name='r'>" + "<link>" * 100_000)


def huge(folder: Path) -> None:
    """Files of gigabytes, of which nothing is on the disk."""
    for name in ("my_robot.urdf", "package.xml", "answers.md", "lab6.zip"):
        with (folder / name).open("wb") as file:
            file.truncate(4 << 30)


def named(folder: Path) -> None:
    """Files whose names are escapes, markup, newlines, marks that turn text around and bytes that are no text."""
    text = (ROOT / "submissions/several-mistakes/my_robot.urdf").read_bytes()
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
    (folder / "<img src=x onerror=alert(1)>.md").write_text("# Step 15\n\n<script>alert(1)</script>\x00\x1b[2J\n```\n")
    (folder / "step 2.md").write_bytes(b"# Task 2 step 2\n\n\xff\xfe\xed\xa0\x80\n")


def linked(folder: Path) -> None:
    """Links to the machine's files, to the autograder's own and to themselves."""
    (folder / "my_robot.urdf").symlink_to("/etc/passwd")
    (folder / "etc").symlink_to("/etc")
    (folder / "source").symlink_to("../source")
    (folder / "loop").symlink_to("loop")
    (folder / "up").symlink_to("..")
    os.mkfifo(folder / "pipe.urdf")


def damaged(folder: Path) -> None:
    """Archives, documents and pictures that are none."""
    for name in ("a.zip", "b.tar.gz", "c.docx", "d.pdf", "e.png"):
        (folder / name).write_bytes(b"PK\x03\x04" + bytes(100))
    bomb = io.BytesIO()
    with tarfile.open(fileobj=bomb, mode="w:gz") as archive:
        entry = tarfile.TarInfo("../../evil.urdf")
        entry.size = 64 << 20
        archive.addfile(entry, io.BytesIO(bytes(64 << 20)))
    (folder / "bomb.tar.gz").write_bytes(bomb.getvalue())


@pytest.mark.parametrize("hostile", [deep, huge, named, linked, damaged], ids=lambda make: make.__name__)
def test_a_hostile_submission(autograder: Autograder, hostile: object) -> None:
    """Whatever is handed in, there are results, and nothing of the machine's own files is in them."""
    assert callable(hostile)
    hostile(autograder.submission)
    results = autograder.run()
    assert results["score"] <= 90
    assert "root:" not in json.dumps(results)
    assert sorted(path.name for path in autograder.root.iterdir()) == [
        "results", "run_autograder", "source", "submission", "submission_metadata.json", "venv",
    ]  # fmt: skip


def test_nothing_of_a_submission_is_imported(autograder: Autograder) -> None:
    """Modules that are called like the grader's do not run, not even where the environment names their folder."""
    autograder.hand_in("reference")
    mark = autograder.root.parent / "ran"
    program = f"open({str(mark)!r}, 'w').close()\n"
    for place in (autograder.submission, autograder.root):
        for name in MODULES:
            (place / f"{name}.py").write_text(program)
        (place / "grader").mkdir()
        for name in ("__init__", "__main__", "errors"):
            (place / "grader" / f"{name}.py").write_text(program)
    folder = str(autograder.submission)
    results = autograder.run(
        PYTHONPATH=folder, PYTHONHOME=folder, PYTHONUSERBASE=folder, PYTHONSTARTUP=f"{folder}/os.py"
    )
    assert results["score"] == 90
    assert not mark.exists()
