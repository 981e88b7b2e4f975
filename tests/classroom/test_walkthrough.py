"""The walk-through of docs/grade-a-class.md: from a Canvas download of 121 students to published grades and feedback."""

import csv
import io
import re
import shlex
import subprocess
import sys
import tarfile
from decimal import Decimal
from pathlib import Path
from zipfile import ZipFile

import pytest

from grader.classroom.gradebook.gradebook import Gradebook
from tests.command_line import HANG_TIMEOUT, ROOT
from tests.tutorial import Step, follow

pytestmark = pytest.mark.exhaustive

PAGE = (ROOT / "docs" / "grade-a-class.md").read_text(encoding="utf-8")
SECTION = PAGE.partition("## From download to published grades\n")[2].partition("\n## ")[0]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with the class that the page generates."""
    folder = tmp_path_factory.mktemp("walk-through")
    generate = re.search(r"`python CHECKOUT/(benchmarks/class_generator.py [^`]+)`", SECTION)
    assert generate is not None
    script, *options = shlex.split(generate[1])
    subprocess.run(
        [sys.executable, ROOT / script, *options], check=True, cwd=folder, timeout=HANG_TIMEOUT
    )
    return folder


@pytest.fixture(scope="module")
def followed(folder: Path) -> tuple[str, list[Step]]:
    """Return the section with current outputs, and what was run."""
    return follow(SECTION, folder)


def test_every_command_works_as_shown(followed: tuple[str, list[Step]]) -> None:
    """No command fails, and the outputs on the page are current."""
    section, steps = followed
    assert section == SECTION
    assert [step.code for step in steps] == [0] * 4
    assert not [step.printed for step in steps if "there is no student" in step.printed]


def test_canvas_gets_what_the_gradebook_holds(
    folder: Path, followed: tuple[str, list[Step]]
) -> None:
    """All marks are in the gradebook; each row of the upload has its student's total, or EX, and nothing else differs."""
    del followed
    grades = {grade.student.canvas: grade for grade in Gradebook(folder / "lab6-grades")}
    files = ((folder / name).read_text(encoding="utf-8") for name in ("canvas.csv", "upload.csv"))
    before, after = (list(csv.reader(text.splitlines())) for text in files)
    assert after[:2] == before[:2]
    rows = {row[1]: row for row in before[2:]}
    for row in after[2:]:
        grade = grades[row[1]]
        assert row[:-1] == rows[row[1]][:-1]
        assert row[-1] == ("EX" if grade.is_excused else f"{grade.total:.2f}")
    uploaded = {row[1] for row in after[2:]}
    assert "EX" in {row[-1] for row in after}
    for key, grade in grades.items():
        is_final = grade.has_final or (
            grade.stored is not None and grade.stored.verdict == "graded"
        )
        assert (key in uploaded) == (is_final and key in rows), key
    assert len(uploaded) == 108
    assert grades["100064"].total == Decimal(0)


def test_each_archive_gets_a_report(folder: Path, followed: tuple[str, list[Step]]) -> None:
    """The zip for Canvas has a file for each archive that a student submitted, under a name that fits; a URDF has none."""
    del followed
    with ZipFile(folder / "feedback.zip") as feedback:
        names = feedback.namelist()
        for name in names:
            data = io.BytesIO(feedback.read(name))
            with ZipFile(data) if name.endswith(".zip") else tarfile.open(fileobj=data) as archive:
                found = archive.namelist() if isinstance(archive, ZipFile) else archive.getnames()
            assert found == ["report.html"], name
    numbers = [re.search(r"_(\d+)_\d+_", name) for name in names]
    assert len({number[1] for number in numbers if number}) == len(names) > 60
