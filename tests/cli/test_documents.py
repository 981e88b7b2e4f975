"""Answers and evidence in documents, as the command line shows them, and submissions that have evidence only."""

import json
import tomllib
from contextlib import redirect_stderr, redirect_stdout
from io import StringIO
from pathlib import Path
from typing import Any

import jsonschema
import pytest

from grader.cli.app import run as in_process
from grader.grading.record import graded_submission_from, to_record
from tests.checks.submissions import png
from tests.classroom.gradebooks import grader, urdf
from tests.command_line import run
from tests.documents.files import PICTURE, docx, pdf
from tests.samples import LAB6, ROOT, SAMPLES

REPORT = pdf(
    ["Lab 6", "Task 1: Step 8", PICTURE],
    ["Task 1: Step 18", PICTURE, "REQUIRED Question: what happens and why?", "It vanishes."],
    ["REQUIRED Question:", "rviz2 shows the robot."],
)
NO_URDF = "pictures or documents, but no URDF of this lab"
EVIDENCE_LAB = """
id = "small"
title = "A small lab"
urdf = "robot.urdf"

[[part]]
id = "robot"
title = "Robot"

[[part]]
id = "report"
title = "Report"
needs = "files"

[[criterion]]
id = "loads"
part = "robot"
title = "It loads"
points = 3
check = "urdf_loads"

[[criterion]]
id = "box"
part = "robot"
title = "It shows a box"
points = 2
check = "shows_box"
with = { link = "base", size = [1, 1, 1], tolerance = 0.001 }

[[criterion]]
id = "essay"
part = "report"
title = "Why"
points = 1
check = "answered"
with = { question = "Why?", places = ["task 1 step 1"] }
"""


def submitted(folder: Path, files: dict[str, bytes]) -> Path:
    """Write a submission of some files."""
    for path, data in files.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_bytes(data)
    return folder


def grade(path: Path, *more: object) -> str:
    """Return everything that `grade` can print, with single spaces."""
    done = run(("grade", path, "--verbose", *more))
    assert not done.stderr or done.stderr.startswith(b"grader: exit code 1: could not be decided")
    return " ".join(done.stdout.decode().split())


def rubric(folder: Path, key: str) -> Path:
    """Write the small lab, with `without_urdf` if a value is given."""
    path = folder / f"small{key}.toml"
    path.write_text(f'without_urdf = "{key}"\n{EVIDENCE_LAB}' if key else EVIDENCE_LAB)
    return path


def as_json(path: Path, *more: object) -> dict[str, Any]:
    """Return the report on a submission as JSON, valid under its schema."""
    report = json.loads(run(("grade", path, "--format", "json", *more)).stdout)
    jsonschema.validate(report, json.loads(run(("schema", "report")).stdout))
    return dict(report)


def test_a_report_names_pages_and_matches(tmp_path: Path) -> None:
    """Evidence and answers in a PDF are named with their page, and how they were matched, in every kind of format."""
    path = submitted(tmp_path / "Ash", {"report.pdf": REPORT})
    for kind in ("terminal", "markdown", "junit"):
        text = grade(path, "--format", kind).replace("&quot;", '"').replace("\\", "")
        assert "Step 8: the box on the ground: Task 1: Step 8, page 1 of report.pdf" in text
        assert "Step 18: the lidar on the box: Task 1: Step 18, page 2 of report.pdf" in text
        assert "Step 36: the robot with its wheels: missing" in text
        how = '(in order: heading {} of 2 like "REQUIRED Question")'
        assert f"The answer on page 2 of report.pdf {how.format(1)}, needs manual grading" in text
        assert f"The answer on page 3 of report.pdf {how.format(2)}, needs manual grading" in text
    (step_8, *_) = as_json(path)["evidence"]
    file = {"path": "report.pdf", "size": len(REPORT), "width": None, "height": None}
    assert step_8["files"] == [{**file, "heading": "Task 1: Step 8", "page": 1}]
    assert step_8["possible"] == []


def test_a_report_names_misspelt_pictures(tmp_path: Path) -> None:
    """A misspelt name counts if it is unambiguous, and is listed as perhaps meant if not."""
    path = submitted(tmp_path / "Ash", {"Part3_step3.png": png(), "step18.png": png()})
    text = grade(path)
    assert "Step 3: the camera image in RViz: Part3_step3.png (640 x 480 pixels, 118 bytes)" in text
    assert "Step 18: the lidar on the box: perhaps step18.png (640 x 480 pixels, 118 bytes)" in text
    assert "Needs manual grading: Part3_step3.png" in text
    report = as_json(path)
    listed = {
        row["id"]: ([it["path"] for it in row["files"]], [it["path"] for it in row["possible"]])
        for row in report["evidence"]
    }
    assert listed["task3-step3"] == (["Part3_step3.png"], [])
    assert listed["task1-step18"] == ([], ["step18.png"])
    assert report["other_pictures"] == []


def test_a_pdf_of_google_docs_is_read_as_it_looks(tmp_path: Path) -> None:
    """Each word has a place of its own: headings are found, and `review` shows an answer whole, with its reason at the end."""
    answer = [f"It vanishes from the view, says line {number}." for number in range(90)]
    lines = ["Task 1: Step 15", "REQUIRED Question: what happens and why?", *answer, "The reason: it has two roots."]
    pages = [lines[start : start + 40] for start in range(0, len(lines), 40)]
    data = pdf(*pages, ["Task 2", "REQUIRED Question:", "rviz2 shows the robot."], by_word=True)
    submitted(tmp_path / "class" / "Ash", {"report.pdf": data, "robot.urdf": urdf().encode()})
    text = grade(tmp_path / "class" / "Ash")
    assert "The answer on page 1 of report.pdf" in text
    assert "The answer on page 4 of report.pdf" in text
    book = tmp_path / "book.db"
    grader("batch", tmp_path / "class", "--gradebook", book, "--rubric", "lab6")
    shown = grader("review", "--gradebook", book, "--criterion", "answer-floating-link", stdin="q\n").stdout
    assert [line.strip() for line in shown.splitlines() if line.strip() in lines] == lines[1:]


def test_evidence_does_not_contradict_itself(tmp_path: Path) -> None:
    """What a criterion takes as its picture is not missing, no picture is offered twice, and a wrong step is near the right one."""
    scan = pdf([PICTURE], [PICTURE])
    files = {"Task3_desk.png": png(), "report.pdf": scan, "prelab.pdf": scan, "Task2_Step3.png": png()}
    path = submitted(tmp_path / "Ash", files)
    report = as_json(path)
    listed = {row["id"]: [file["path"] for file in (*row["files"], *row["possible"])] for row in report["evidence"]}
    assert listed == {
        "task1-step8": ["report.pdf"],
        "task1-step18": ["report.pdf"],
        "task1-step36": ["report.pdf"],
        "task2-step6": ["report.pdf", "Task2_Step3.png"],
        "task3-step3": ["Task3_desk.png"],
    }
    (webcam,) = (row for row in report["results"] if row["id"] == "evidence-webcam")
    assert webcam["measured"] == ["Task3_desk.png"]
    text = grade(path)
    assert "Step 3: the camera image in RViz: Task3_desk.png" in text
    assert "Step 6: the robot, started by the launch file: perhaps report.pdf" in text


def test_the_list_of_evidence_agrees_with_the_criterion(tmp_path: Path) -> None:
    """A document that the criterion lists as perhaps its picture is listed for the same piece; files of a prelab are not."""
    scan = pdf([PICTURE], [PICTURE])
    report = as_json(submitted(tmp_path / "Ash", {"report.pdf": scan, "Prelab/pictures.pdf": scan}))
    assert [row["id"] for row in report["evidence"]][-1] == "task3-step3"
    listed = {row["id"]: [file["path"] for file in row["possible"]] for row in report["evidence"] if row["possible"]}
    assert listed == {row["id"]: ["report.pdf"] for row in report["evidence"]}
    (webcam,) = (row for row in report["results"] if row["id"] == "evidence-webcam")
    assert webcam["measured"] == ["report.pdf"]


def test_without_the_extra_one_line_says_what_was_not_searched(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """If the packages for Word and PDF are not installed, a note names the document; its evidence is not called missing."""
    monkeypatch.setattr("grader.documents.converter.MISSING", 1)  # as a damaged document ends
    text = grade(submitted(tmp_path / "Ash", {"report.pdf": b"no document"}))
    reason = "report.pdf is read only with the grader's extra `documents`: open it yourself"
    assert text.count(f"Note: not searched for evidence: {reason}") == 1
    assert "Step 8: the box on the ground: perhaps report.pdf (11 bytes)" in text
    assert "missing" not in text


class _Terminal(StringIO):
    """Standard error of a terminal."""

    def isatty(self) -> bool:
        return True


@pytest.mark.exhaustive
@pytest.mark.parametrize(("stream", "seconds", "lines"), [(_Terminal, 0.0, 1), (_Terminal, 1e9, 0), (StringIO, 0.0, 0)])
def test_a_document_that_takes_long_is_named(
    stream: type[StringIO], seconds: float, lines: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """On a terminal, after a time; the line is removed before the report is printed. The document is read all the same."""
    monkeypatch.setattr("grader.documents.collection.NOTICE_SECONDS", seconds)
    monkeypatch.setenv("COLUMNS", "80")
    path = submitted(tmp_path / "Ash", {"an\x1b swers.docx": docx("Task 1 step 15", "Two roots.")})
    with redirect_stderr(stream()) as err, redirect_stdout(StringIO()) as out:
        in_process(["grade", str(path), "--verbose"])
    assert "Two roots." in out.getvalue()
    text = "grader: reading an\\x1b swers.docx"
    assert err.getvalue() == f"\r\r{text}\r{' ' * len(text)}\r" * lines


def test_a_record_keeps_evidence(tmp_path: Path) -> None:
    """A class report names the same evidence as `grade`."""
    files = {"report.docx": docx("Task 1: Step 8", PICTURE), "step18.png": png()}
    submitted(tmp_path / "class" / "Ash", files)
    done = grader("batch", tmp_path / "class", "--gradebook", tmp_path / "lab.db", "--jobs", 1,
                  "--reports", tmp_path / "reports", "--report-format", "json")  # fmt: skip
    assert done.returncode == 0, done.stderr
    report = json.loads((tmp_path / "reports" / "Ash.json").read_text())
    assert report["evidence"] == as_json(tmp_path / "class" / "Ash")["evidence"]
    assert graded_submission_from(to_record(SAMPLES["pictures-only"].grade())).lacks == ("URDF", "package")


@pytest.mark.parametrize(("key", "pending"), [("", 1), ("failed", 1), ("manual", 6)])
def test_evidence_without_a_urdf(key: str, pending: int, tmp_path: Path) -> None:
    """The criteria of the URDF are failed, unless the rubric asks for manual grading."""
    path = submitted(tmp_path / "Ash", {"desk.png": png(), "notes.txt": b"none"})
    report = as_json(path, "--rubric", rubric(tmp_path, key))
    assert (report["score"], report["pending"], report["max_score"]) == (0, pending, 6)
    loads = report["results"][0]
    if key == "manual":
        assert (loads["status"], loads["measured"]) == ("pending", ["desk.png"])
        assert loads["message"] == "no URDF was submitted, but desk.png was submitted; needs manual grading"
    else:
        assert loads["status"] == "failed"


@pytest.mark.parametrize(
    "files", [{"notes.txt": b"none"}, {"notes.txt": b"none", "old.txt": b""}, {"robot.urdf": urdf("1 1 2").encode()}]
)
def test_manual_grading_needs_evidence_and_no_urdf(files: dict[str, bytes], tmp_path: Path) -> None:
    """Without evidence, or with a URDF, the checks decide whatever the rubric says."""
    if "robot.urdf" in files:
        files = {**files, "desk.png": png()}
    path = submitted(tmp_path / "Ash", files)
    reports = [as_json(path, "--rubric", rubric(tmp_path, key)) for key in ("", "manual")]
    first, second = ([(row["status"], row["message"]) for row in report["results"]] for report in reports)
    assert first == second
    assert [report["pending"] for report in reports] == [1, 1]


@pytest.mark.parametrize("name", ["desk.png", "report.pdf", "film.mp4", "report.docx"])
def test_every_kind_of_evidence_counts(name: str, tmp_path: Path) -> None:
    """A picture, a PDF, a film and a Word file are evidence."""
    path = submitted(tmp_path / "Ash", {name: b"data"})
    assert as_json(path, "--rubric", rubric(tmp_path, "manual"))["pending"] == 6


def test_pictures_alone_need_manual_grading_in_every_part(tmp_path: Path) -> None:
    """Without a package the criteria of the package need manual grading too; with one they are decided."""
    text = (ROOT / "rubrics/lab6/rubric.toml").read_text(encoding="utf-8")
    (tmp_path / "lab6.toml").write_text(text.replace('without_package = "manual"', ""), encoding="utf-8")
    for name in ("answers.toml", "my_robot"):
        (tmp_path / name).symlink_to(ROOT / "rubrics/lab6" / name)
    path = submitted(tmp_path / "Ash", {"Task2_Step6.png": png(), "notes.txt": b"none"})
    report = as_json(path, "--rubric", tmp_path / "lab6.toml")
    assert (report["score"], report["pending"]) == (0, 100)
    submitted(path, {"my_robot/package.xml": b"<package/>"})
    statuses = {row["id"]: row["status"] for row in as_json(path, "--rubric", tmp_path / "lab6.toml")["results"]}
    assert (statuses["urdf-loads"], statuses["setup-installs-urdf"]) == ("pending", "failed")


def test_a_batch_counts_evidence_without_a_urdf(tmp_path: Path) -> None:
    """The end of the summary says how many submissions have evidence, but no URDF, and which key to set."""
    folder = tmp_path / "class"
    submitted(folder / "Ash", {"robot.urdf": urdf().encode(), "desk.png": png()})
    submitted(folder / "Birch", {"desk.png": png()})
    submitted(folder / "Cedar", {"pictures/desk.png": png(), "film.mp4": b"film"})
    submitted(folder / "Elm", {"notes.txt": b"none"})
    submitted(folder / "Fir", {"robot.urdf": b"<robot", "desk.png": png()})
    book = tmp_path / "lab.db"

    def batch(key: str, *more: object) -> str:
        done = grader("batch", folder, "--gradebook", book, "--rubric", rubric(tmp_path, key), "--jobs", 1, *more)
        assert done.returncode == 0, done.stderr
        return done.stdout

    for text in (batch(""), batch(""), grader("stats", "--gradebook", book).stdout):  # graded, unchanged
        assert " ".join(text.split()).endswith(
            f"2 submissions have {NO_URDF}: the criteria of the URDF fail. "
            'Set `without_urdf = "manual"` in the rubric to grade them manually, or "failed" to keep this'
        )
    data = json.loads(batch("", "--format", "json"))
    jsonschema.validate(data, json.loads(run(("schema", "class")).stdout))
    assert data["evidence_without_urdf"] == 2
    for key in ("failed", "manual"):
        assert NO_URDF not in batch(key)
        assert json.loads(batch(key, "--format", "json"))["evidence_without_urdf"] == 2


def test_the_key_is_checked(tmp_path: Path) -> None:
    """The rubric's key has two values; the schema for editors and the loader agree."""
    schema = json.loads(run(("schema", "rubric")).stdout)
    for key, is_valid in (("failed", True), ("manual", True), ("maybe", False), (True, False)):
        data = {**tomllib.loads(EVIDENCE_LAB), "without_urdf": key}
        assert jsonschema.Draft202012Validator(schema).is_valid(data) is is_valid
    done = grader("rubric", "check", rubric(tmp_path, "maybe"))
    assert done.returncode == 2
    assert "smallmaybe.toml:1: without_urdf must be one of failed, manual, not 'maybe'" in done.stderr


def test_one_submission_with_evidence_only(tmp_path: Path) -> None:
    """One submission is in the singular, and review names its files under manual grading."""
    submitted(tmp_path / "class" / "Ash", {"report.pdf": pdf(["Task 1: Step 1", "The roots."])})
    command = ("batch", tmp_path / "class", "--gradebook", tmp_path / "lab.db", "--jobs", 1, "--rubric")
    assert f"1 submission has {NO_URDF}: the" in " ".join(grader(*command, rubric(tmp_path, "")).stdout.split())
    assert grader(*command, rubric(tmp_path, "manual")).returncode == 0
    shown = grader("review", "--gradebook", tmp_path / "lab.db", stdin="s\ns\ns\n", COLUMNS="300").stdout
    path = tmp_path / "class" / "Ash" / "report.pdf"
    assert shown.count(f"Look at:\n  {path}\n") == 2
    assert (
        f"Why? The answer on page 1 of report.pdf, needs manual grading\nFound:\n  Task 1: Step 1\n  The roots.\nin {path}\n"
        in shown
    )


def test_lab6_leaves_pictures_to_manual_grading() -> None:
    """The shipped rubric: the course took pictures."""
    assert (LAB6.without_urdf, LAB6.without_package) == ("manual", "manual")
    text = grade(ROOT / "submissions/lab6/pictures-only")
    assert "no URDF was submitted; 47 need manual grading" in text
