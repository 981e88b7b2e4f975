"""Of the files that the grader reads it replaces only those that it has written, and it waits for no pipe."""

import os
import shutil
from collections.abc import Iterator
from pathlib import Path
from threading import Thread
from zipfile import ZipFile

import pytest

from grader.report.formats import Format, GraphFormat, InspectFormat
from tests.classroom.gradebooks import grader, lab_text
from tests.command_line import ROOT, Done, run, run_with_input
from tests.examples import spread
from tests.report.reports import CLASSROOM50

WORKSPACE = ROOT / "submissions/diffdrive/spawner-misspelt"
PACKAGE = "diffdrive_robot"
OTHERS = (
    "package.xml",
    "CMakeLists.txt",
    "README.md",
    "answers.txt",
    "resource/diffdrive_robot",
    "src/a.cpp",
    "include/a.hpp",
    "config/robot.srdf",
    "config/nav.yaml",
    "worlds/course.sdf",
    "worlds/course.world",
    "meshes/wheel.stl",
    "meshes/wheel.svg",
    "setup.cfg",
    "docs/index.html",
    "results.xml",
    "data.json",
    "findings.sarif",
)
TEXTS = {
    "resource/diffdrive_robot": "",
    "CMakeLists.txt": "",
    "README.md": "# Lab 6: a robot for ROS 2\n",
    "answers.txt": "Question 1: 5 points are enough\nROS 2 loads it",
    "docs/index.html": "<!DOCTYPE html>\n<html></html>\n",
    "results.xml": '<?xml version="1.0"?>\n<testsuites/>\n',
    "data.json": '{"schema": 1}',
    "findings.sarif": '{"version": "2.1.0", "runs": []}',
    "meshes/wheel.svg": '<svg xmlns="http://www.w3.org/2000/svg"/>',
}
COMMANDS = {
    "inspect --save": ("inspect", ".", "--save", "json={}"),
    "inspect --save terminal": ("inspect", ".", "--save", "terminal={}"),
    "inspect --write-baseline": ("inspect", ".", "--write-baseline", "{}"),
    "graph --save": ("graph", ".", "--save", "dot={}"),
    "grade --save": ("grade", PACKAGE, "--save", "html={}"),
    "inspect a robot": ("inspect", f"{PACKAGE}/urdf/diffdrive.urdf.xacro", "--save", "svg={}"),
}


@pytest.fixture
def place(tmp_path: Path) -> Path:
    """Return a workspace with files of many kinds."""
    folder = tmp_path / "ws"
    shutil.copytree(WORKSPACE, folder)
    for name in OTHERS:
        file = folder / PACKAGE / name
        file.parent.mkdir(exist_ok=True)
        if not file.exists() or name in TEXTS:
            file.write_text(TEXTS.get(name, "x\n"))
    return folder


def call(folder: Path, command: str, file: object) -> Done:
    """Run a command in a folder that is to write a file."""
    words = [word.format(file) for word in COMMANDS[command]]
    return run_with_input(words, b"", folder=folder)


@pytest.mark.parametrize("name", OTHERS)
@pytest.mark.parametrize("command", spread(COMMANDS, 1))
def test_a_file_of_the_submission_stays(command: str, name: str, place: Path) -> None:
    """It is refused with exit code 2, and nothing is printed."""
    file = place / PACKAGE / name
    before = file.read_bytes()
    done = call(place, command, f"{PACKAGE}/{name}")
    assert (done.returncode, done.stdout) == (2, b""), done.stderr
    assert b"it exists, and the grader did not write it; name another file for --" in done.stderr
    assert file.read_bytes() == before


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize("way", ["another path", "a link", "a hard link", "the whole path"])
def test_no_other_way_leads_to_it(command: str, way: str, place: Path) -> None:
    """Neither does a link from outside of the workspace."""
    file = place / PACKAGE / "README.md"
    link = place.parent / "report"
    match way:
        case "another path":
            written: object = f"../ws/{PACKAGE}/src/../README.md"
        case "a link":
            link.symlink_to(file)
            written = link
        case "a hard link":
            link.hardlink_to(file)
            written = link
        case _:
            written = file
    done = call(place, command, written)
    assert (done.returncode, done.stdout) == (2, b""), done.stderr
    assert file.read_text() == TEXTS["README.md"]


def _formats() -> Iterator[tuple[str, str, int]]:
    for command, formats, code in (
        ("inspect", InspectFormat, 1),
        ("graph", GraphFormat, 1),
        ("grade", Format, 1),
    ):
        for kind in formats:
            yield command, kind, code


@pytest.mark.parametrize(("command", "kind", "code"), spread(_formats(), 8))
def test_a_report_is_written_anew(command: str, kind: str, code: int, place: Path) -> None:
    """In each format, inside of what is read; the second report equals the first."""
    words = [command, place, "--save", f"{kind}={place / PACKAGE / 'report.out'}"]
    hints = ("--hints", "none") if command == "grade" else ()
    reports = []
    for _ in range(2):
        done = run([*words, *hints], **CLASSROOM50)
        assert done.returncode == code, done.stderr
        reports.append((place / PACKAGE / "report.out").read_bytes())
    assert reports[0] == reports[1] != b""


@pytest.mark.parametrize("kind", InspectFormat)
def test_a_report_without_findings_is_written_anew(kind: str, tmp_path: Path) -> None:
    """Also one that is empty, and one that is the whole of a single robot."""
    (tmp_path / "package.xml").write_text("<package/>")
    (tmp_path / "a.urdf").write_text('<robot name="a"><link name="base"/></robot>')
    for _ in range(2):
        done = run(("inspect", tmp_path / "a.urdf", "--save", f"{kind}={tmp_path / 'r.txt'}"))
        assert done.returncode == 0, done.stderr


def test_a_baseline_is_written_anew(place: Path) -> None:
    """Inside of what is read."""
    for _ in range(2):
        assert call(place, "inspect --write-baseline", "known.json").returncode == 0


def test_a_file_beside_what_is_read_is_replaced(tmp_path: Path, place: Path) -> None:
    """Whatever it is."""
    file = tmp_path / "report.json"
    file.write_text("other")
    done = call(place, "inspect --save", file)
    assert done.returncode == 1, done.stderr
    assert b"grader/inspect" in file.read_bytes()


@pytest.mark.parametrize("command", COMMANDS)
def test_a_pipe_that_nothing_reads_is_refused(command: str, place: Path) -> None:
    """The command ends with exit code 2 in place of waiting for a reader."""
    os.mkfifo(place / "pipe")
    done = call(place, command, "pipe")
    assert done.returncode == 2
    assert b"cannot write pipe: no program reads this pipe" in done.stderr


def test_a_pipe_that_is_read_gets_the_report(place: Path) -> None:
    """All of it, however long."""
    os.mkfifo(place / "pipe")
    read: list[bytes] = []
    thread = Thread(target=lambda: read.append((place / "pipe").read_bytes()))
    handle = os.open(place / "pipe", os.O_RDWR)  # a reader, before the thread has come to it
    thread.start()
    done = run_with_input(
        ("inspect", ".", "--format", "html", "--save", "html=pipe"), b"", folder=place
    )
    os.close(handle)
    thread.join()
    assert done.returncode == 1, done.stderr
    assert read == [done.stdout]


@pytest.mark.parametrize("target", ["csv", "xlsx", "json", "canvas", "zip"])
def test_an_export_replaces_no_submission(target: str, top: Path) -> None:
    """An earlier export is replaced, also beside the submissions."""
    submissions = top / "class"
    words: list[object] = ["export", "csv", "--gradebook", top / "book"]
    option = "--output"
    if target in ("json", "canvas"):
        words[1] = target
    if target in ("canvas", "zip"):
        words[1] = "canvas"
        lms = top / "lms.csv"
        lms.write_text("Student,ID,Section,A small lab (77)\n    Points Possible,,,11\nBen,1,S1,\n")
        words += ["--into", lms]
    if target == "zip":  # of reports for students whom Canvas has not named: it is empty
        option = "--feedback"
    names = [path for path in submissions.rglob("*") if path.is_file()]
    assert names
    for name in names:
        before = name.read_bytes()
        done = grader(*words, option, name)
        assert done.returncode == 2, done.stderr
        assert name.read_bytes() == before
    for _ in range(2):
        done = grader(*words, option, submissions / f"grades.{target}")
        assert done.returncode == 0, done.stderr


def test_feedback_replaces_feedback(tmp_path: Path) -> None:
    """Not another zip."""
    folder = tmp_path / "class" / "Ada Byron_123_assignsubmission_file_"
    folder.mkdir(parents=True)
    (folder / "robot.urdf").write_text('<robot name="a"><link name="base"/></robot>')
    (tmp_path / "small.toml").write_text(lab_text())
    options = ("--rubric", tmp_path / "small.toml", "--gradebook", tmp_path / "book", "--jobs", "1")
    assert grader("batch", tmp_path / "class", *options).returncode == 0
    words = ("export", "moodle", "--gradebook", tmp_path / "book", "--feedback")
    for _ in range(2):
        done = grader(*words, tmp_path / "class" / "feedback.zip")
        assert done.returncode == 0, done.stderr
    with ZipFile(tmp_path / "class" / "feedback.zip") as archive:
        assert [name.rpartition("/")[2] for name in archive.namelist()] == ["report.html"]
    other = tmp_path / "class" / "other.zip"
    with ZipFile(other, "w") as archive:
        archive.writestr("robot.urdf", "<robot/>")
    before = other.read_bytes()
    assert grader(*words, other).returncode == 2
    assert other.read_bytes() == before
