"""Documents whose reading depends on what is installed, on time, and on the record of a class."""

import json
from pathlib import Path

import pytest

from tests.classroom.gradebooks import grader
from tests.command_line import run
from tests.documents.files import PICTURE, docx

pytestmark = pytest.mark.slow


def test_without_the_extra_one_line_says_what_was_not_searched(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """If the packages for Word and PDF are not installed, a note names the document; its evidence is not called missing."""
    monkeypatch.setattr("grader.lab.documents.converter.MISSING", 1)  # as a damaged document ends
    (tmp_path / "report.pdf").write_bytes(b"no document")
    text = " ".join(run(("grade", tmp_path, "--verbose")).stdout.decode().split())
    reason = "report.pdf is read only with the grader's extra `documents`: open it yourself"
    assert text.count(f"Note: not searched for evidence: {reason}") == 1
    assert "Step 8: the box on the ground: perhaps report.pdf (11 bytes)" in text
    assert "missing" not in text


def test_a_record_keeps_evidence(tmp_path: Path) -> None:
    """A class report names the same evidence as `grade`."""
    (tmp_path / "class/Ash").mkdir(parents=True)
    (tmp_path / "class/Ash/report.docx").write_bytes(docx("Task 1: Step 8", PICTURE))
    reports = (
        "--gradebook",
        tmp_path / "lab",
        "--reports",
        tmp_path / "reports",
        "--report-format",
        "json",
    )
    assert grader("batch", tmp_path / "class", *reports).returncode == 0
    report, same = (
        json.loads(text)
        for text in (
            (tmp_path / "reports/Ash.json").read_text(encoding="utf-8"),
            run(("grade", tmp_path / "class/Ash", "--format", "json")).stdout,
        )
    )
    assert report["evidence"] == same["evidence"] != []
