"""A class gets the same marks as each submission alone, with any number of workers."""

import json
import shutil
import zipfile
from pathlib import Path

import pytest

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.reports.class_reports import make_report
from grader.report.formats import Format, render
from tests.classroom.class_runs import (
    class_with_roster,
    contents,
    counted,
    grader,
    mixed_class,
    newest,
    report_in_process,
    urdf_class,
    verdicts,
    without_hints,
)
from tests.command_line import GRADER
from tests.samples import LAB6_SAMPLES, ROOT

JSON = ("--report-format", "json")
REFERENCE = ROOT / "submissions/lab6/reference/roscourse_sim_ws/src/my_robot/urdf/my_robot.urdf"


def batch(path: Path, out: Path, *arguments: str, cwd: str = "") -> dict[str, bytes]:
    """Grade a class into a new gradebook and return the JSON reports by key."""
    book, reports = out.with_suffix(".book"), out.with_suffix(".reports")
    done = grader(
        "batch",
        path,
        "--gradebook",
        book,
        "--jobs",
        "2",
        "--reports",
        reports,
        *JSON,
        *arguments,
        cwd=cwd,
    )
    assert done.returncode == 0, done.stderr
    return reports_of(book, reports)


def reports_of(book: Path, reports: Path) -> dict[str, bytes]:
    """Return the reports in a folder by the key of their students."""
    from grader.classroom.reports.class_reports import file_names

    names = file_names(sorted(verdicts(book)))
    found = contents(reports)
    assert set(found) == {f"{name}.json" for name in names.values()}
    return {key: found[f"{name}.json"] for key, name in names.items()}


# --- The same marks ---------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def samples(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Make a class whose submissions are the samples."""
    folder = tmp_path_factory.mktemp("samples") / "class"
    for name, sample in list(LAB6_SAMPLES.items())[::7]:
        graded = ROOT / sample.path
        shutil.copytree(graded if graded.is_dir() else graded.parent, folder / name)
    return folder


@pytest.fixture(scope="module")
def mixed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Make a class of all kinds of submissions."""
    return mixed_class(tmp_path_factory.mktemp("mixed") / "class", 40)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["samples", "mixed"])
def test_a_class_is_graded_like_each_submission_alone(
    name: str, request: pytest.FixtureRequest, tmp_path: Path
) -> None:
    """In this process and in two workers the reports equal those of `grader grade` on the same parts; refusals have the same reason."""
    folder: Path = request.getfixturevalue(name)
    options = "--layout", "folders", "--rubric", str(without_hints())
    one = batch(folder, tmp_path / "one", *options)
    if name == "mixed":
        assert one == batch(folder, tmp_path / "several", *options, cwd=str(ROOT))
    assert len(one) >= 20
    refused = 0
    for key, line in newest(tmp_path / "one.book").items():
        (path,) = line["paths"]
        code, alone = report_in_process(folder / path, tmp_path / "alone.json", *options[2:])
        if code != 2:  # a readable folder may contain only unreadable files
            assert line["verdict"] in ("graded", "unreadable")
            assert without_other_parts(one[key], alone) == json.loads(alone), path
            statuses = {result["status"] for result in json.loads(alone)["results"]}
            is_red = not statuses.isdisjoint(("failed", "skipped")) or is_undecided(alone)
            assert code == int(is_red), path
        else:
            assert line["verdict"] == "unreadable"
            assert line["reason"] in str(alone).replace(f"{folder}/", "")
            refused += 1
    assert refused == 0 if name == "samples" else refused > 1


def without_other_parts(report: bytes, alone: bytes | str) -> object:
    """Return a report as data, of a single URDF only for the parts that `grader grade` grades it on; all others byte for byte."""
    data, other = json.loads(report), json.loads(alone)
    if data["parts"] == other["parts"]:
        assert report == (alone if isinstance(alone, bytes) else alone.encode())
        return data
    assert (data["parts"], other["parts"]) == (["task1", "task2", "task3", "questions"], ["task1"])
    kept = [result for result in data["results"] if result["part"] == "task1"]
    assert {result["status"] for result in data["results"][len(kept) :]} <= {
        "failed",
        "skipped",
        "pending",
    }
    changed = ("notes", "parts", "max_score", "pending", "evidence")
    return {**data, "results": kept, **{key: other[key] for key in changed}}


def is_undecided(report: bytes | str) -> bool:
    """Return whether something needs manual grading that a program normally decides."""
    waiting = {
        result["id"] for result in json.loads(report)["results"] if result["status"] == "pending"
    }
    return bool(waiting - {"answer-floating-link", "answer-launch-nodes", "evidence-webcam"})


def _pack(folder: Path, target: Path) -> Path:
    with zipfile.ZipFile(target, "w") as archive:
        for path in sorted(folder.rglob("*")):
            archive.write(path, path.relative_to(folder))
    return target


@pytest.mark.slow
@pytest.mark.parametrize("layout", ["canvas", "moodle", "folders"])
def test_a_zip_is_graded_as_its_folder(layout: str, tmp_path: Path) -> None:
    """A zip as an LMS provides it is graded without unpacking: the reports are the same, and a second run grades nothing.

    Nor does a run over the folder, apart from submissions whose bytes cannot be read.
    """
    folder = mixed_class(tmp_path / "class", 25, layout, for_zip=True)
    packed = _pack(folder, tmp_path / "class.zip")
    rubric = "--rubric", str(without_hints())
    unpacked = batch(folder, tmp_path / "folder", *rubric)
    assert unpacked == batch(packed, tmp_path / "zip", *rubric)
    done = grader("batch", packed, "--gradebook", tmp_path / "zip.book", *rubric)
    assert counted(done).startswith("0 graded, ")
    closed = sum("digest" not in line for line in newest(tmp_path / "zip.book").values())
    done = grader("batch", folder, "--gradebook", tmp_path / "zip.book", *rubric)
    assert counted(done).startswith(f"{closed} graded, ")
    assert closed < 10


@pytest.mark.slow
def test_several_files_are_graded_like_a_folder(tmp_path: Path) -> None:
    """Several files of one student in a Canvas download equal the folder that the student had."""
    folder = mixed_class(tmp_path / "class", 40, "canvas")
    rubric = "--rubric", str(without_hints())
    reports = batch(folder, tmp_path / "out", *rubric)
    several = 0
    for key, line in newest(tmp_path / "out.book").items():
        paths = line["paths"]
        if (
            len(paths) > 1 and line["verdict"] == "graded" and not line.get("is_late")
        ):  # a late penalty is a note in the report
            together = tmp_path / "together" / key
            together.mkdir(parents=True)
            for path, name in zip(paths, line["names"], strict=True):
                shutil.copy(folder / path, together / name)
            _, alone = report_in_process(together, tmp_path / "alone.json", *rubric)
            assert alone == reports[key]
            several += 1
    assert several > 1


# --- Reports ----------------------------------------------------------------------------------------------------------


@pytest.mark.slow
def test_reports_quote_unchanged_files_only(tmp_path: Path) -> None:
    """A text report quotes lines as `grader grade` does, below the student's name; once the file has changed, none.

    It also lists what else to hand in, which `grade` only counts while there is something to correct.
    """
    folder, book, words = tmp_path / "class", tmp_path / "lab6", tmp_path / "words"
    for name in ("ann", "bea"):
        shutil.copytree(ROOT / "submissions/lab6/several-mistakes/my_robot/urdf", folder / name)
    grader("batch", folder, "--gradebook", book, "--reports", words)
    alone = grader("grade", folder / "ann").stdout
    mistakes, counted, _ = alone.partition("Not found yet")
    assert counted
    assert (words / "ann.txt").read_text().partition("Not found")[0] == mistakes.replace(
        "my_robot.urdf\n", "my_robot.urdf (ann)\n", 1
    )
    quoted = next(line for line in alone.splitlines() if "<" in line and "xyz" in line)
    (folder / "ann/my_robot.urdf").write_text('<robot name="other"/>\n' * 100)
    before = (book / "results.jsonl").read_bytes()
    texts = {
        key: render(make_report(Gradebook(book), Gradebook(book).grade(key)), Format.TERMINAL)
        for key in ("ann", "bea")
    }
    assert quoted not in texts["ann"]
    assert "The submission has moved or changed" in " ".join(texts["ann"].split())
    assert quoted in texts["bea"]
    assert (book / "results.jsonl").read_bytes() == before


# --- Safety -----------------------------------------------------------------------------------------------------------

MODULES = (
    "numpy",
    "lxml",
    "yaml",
    "signal",
    "resource",
    "multiprocessing",
    "zlib",
    "json",
    "token",
    "selectors",
    "pebble",
    "rich",
    "distributed",
    "pypdf",
)


@pytest.mark.slow
def test_nothing_of_a_class_is_imported(tmp_path: Path) -> None:
    """Nothing is imported even if the grader starts in the class folder, nor by its worker processes."""
    folder = urdf_class(tmp_path / "class", 5)
    mark = tmp_path / "ran"
    for name in MODULES:
        (folder / f"{name}.py").write_text(f"open({str(mark)!r}, 'w').close()\nraise SystemExit\n")
    done = grader(
        "batch", ".", "--gradebook", "../lab6", "--reports", "../reports", cwd=str(folder)
    )
    assert (done.returncode, counted(done)) == (0, "5 graded, 0 unchanged")
    assert not mark.exists()
    assert GRADER[-2:] == ("-m", "grader")


@pytest.mark.slow
def test_awkward_names_are_found_in_the_roster(tmp_path: Path) -> None:
    """A folder with a bidirectional mark, a line break or a tab in its name belongs to the student of that name."""
    unmatched, absent = class_with_roster(tmp_path / "class", tmp_path / "roster.csv", 120)
    done = grader(
        "batch",
        tmp_path / "class",
        "--gradebook",
        tmp_path / "lab6",
        "--roster",
        tmp_path / "roster.csv",
    )
    assert done.returncode == 0
    students = {grade.student.key: grade for grade in Gradebook(tmp_path / "lab6")}
    assert [key for key, grade in students.items() if not grade.student.is_on_roster] == unmatched
    assert sum(grade.stored is None for grade in students.values()) == absent
