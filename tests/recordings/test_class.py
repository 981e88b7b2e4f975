"""A class with recordings: equal ones are listed, and one that cannot be read affects its own student only."""

import csv
import io
import json
from pathlib import Path

from tests.command_line import ROOT, run
from tests.recordings.writing import MAGIC, write_files, write_metadata

_SAMPLES = ROOT / "submissions/rover"
_ROBOT = (ROOT / "rubrics/rover/rover.urdf").read_bytes()


def _grade(folder: Path) -> tuple[dict[str, dict[str, str]], str]:
    """Return the rows of the grades by student, and the statistics in words."""
    book = folder / "book"
    done = run(["batch", folder / "class", "--rubric", "rover", "--gradebook", book])
    assert done.returncode == 0, done.stderr
    rows = csv.DictReader(io.StringIO((book / "grades.csv").read_text(encoding="utf-8-sig")))
    stats = run(["stats", "--gradebook", book]).stdout.decode()
    return {row["id"]: row for row in rows}, " ".join(stats.split())


def test_equal_recordings(tmp_path: Path) -> None:
    """The same messages in files with other names are equal work, also of a robot that the course handed out."""
    drive = (_SAMPLES / "equivalent-recorded/drive/drive_0.mcap").read_bytes()
    bend = (_SAMPLES / "recorded-bend/drive/drive_0.mcap").read_bytes()
    for student, files in {
        "ann": {"drive/drive_0.mcap": drive, "drive/metadata.yaml": write_metadata("drive_0.mcap")},
        "ben": {"mine.mcap": drive, "short.mcap": MAGIC + b"\0" * 40},
        "cem": {"drive.mcap": bend},
        "dia": {},
    }.items():
        write_files(tmp_path / "class" / student, {"rover.urdf": _ROBOT, **files})
    rows, stats = _grade(tmp_path)
    assert [row["grade"] for row in rows.values()] == ["60", "60", "57", "50"]
    assert "ann and ben: the same recording" in stats
    assert "cem" not in stats.partition("Equal work")[2]


def test_recordings_that_cannot_be_read(tmp_path: Path) -> None:
    """Empty, damaged and huge ones are one row each with a clear reason, and the robot is graded."""
    for student, data in {
        "ann": b"",
        "ben": MAGIC + b"x" * 400,
        "cem": b"SQLite format 3\0" + b"junk" * 100,
        "dia": MAGIC,
    }.items():
        write_files(
            tmp_path / "class" / student,
            {"rover.urdf": _ROBOT, "drive/drive_0.mcap": data},
        )
    with (tmp_path / "class/dia/drive/drive_0.mcap").open("r+b") as file:
        file.truncate(1200 << 20)  # a file with a hole
    rows, _ = _grade(tmp_path)
    assert [row["grade"] for row in rows.values()] == ["50"] * 4
    lines = (tmp_path / "book/results.jsonl").read_bytes().splitlines()
    results = {row.get("student"): row.get("results") for row in map(json.loads, lines)}
    told = {student: results[student]["recorded"][1:3] for student in rows}
    assert told["ann"] == ["failed", "drive/drive_0.mcap is empty"]
    assert told["ben"][1].startswith("no message of drive/drive_0.mcap can be read: ")
    assert told["cem"][1].startswith("no message of drive/drive_0.mcap can be read: the database")
    assert told["dia"] == ["pending", "a limit"]
    report = run(["grade", tmp_path / "class/dia", "--rubric", "rover"]).stdout.decode()
    shown = " ".join(report.split())
    assert "'drive/drive_0.mcap' cannot be read: drive/drive_0.mcap is larger than 1 GiB." in shown
    assert "(1258 MB) is larger than 1 GiB, the limit for a recording, and was ignored" in shown
    assert "No mistakes found: 50 of 50 points; 10 more need manual grading." in report


def test_a_mistake_in_extra_credit_costs_no_points() -> None:
    """The result counts it apart from mistakes that cost points of the maximum."""
    graded = run(["grade", _SAMPLES / "recorded-bend", "--rubric", "rover"])
    assert "\n57 of 50 points: 1 mistake in extra credit.\n" in graded.stdout.decode()
