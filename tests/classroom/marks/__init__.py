"""Marks in files: a class, its folder of marks, and what counts."""

from pathlib import Path

from grader.classroom.marks.marks import Mark, Marks, read_marks
from tests.classroom.gradebooks import lab

LAB = lab()  # loads (3), box (2.5), tall (0.5), essay (4), picture (1)
STUDENTS = ("anna", "ben", "0012", "-x")
NO_LINE_BREAK = "=NO LINE BREAK\n"


def folder_of(top: Path, files: dict[str, str]) -> Path:
    """Write files of marks as the tables of cases have them."""
    folder = top / "marks"
    folder.mkdir()
    for name, text in files.items():
        data = text.replace(NO_LINE_BREAK, "").encode().replace(rb"\xe9", b"\xe9")
        (folder / name).write_bytes(data)
    return folder


def read(folder: Path) -> Marks:
    """Return the marks of the class."""
    return read_marks(folder, STUDENTS, LAB)


def said(mark: Mark) -> str:
    """Return what a mark says in a few words."""
    return " ".join(filter(None, (mark.value, mark.by, mark.comment)))
