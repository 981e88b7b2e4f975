"""Make class folders and zips for tests."""

import zipfile
from collections.abc import Iterable
from pathlib import Path

from grader.classroom.intake.intake import Intake


def lay_out(top: Path, *paths: str) -> Path:
    """Make a folder with these empty files; a path that ends in a slash is a folder."""
    top.mkdir(parents=True, exist_ok=True)
    for path in paths:
        folder = top / path
        if path.endswith("/"):
            folder.mkdir(parents=True, exist_ok=True)
        else:
            folder.parent.mkdir(parents=True, exist_ok=True)
            folder.touch()
    return top


def pack(folder: Path, names: Iterable[str]) -> Path:
    """Make a zip with these empty members."""
    with zipfile.ZipFile(folder, "w") as archive:
        for name in names:
            archive.writestr(name, b"")
    return folder


def assigned(intake: Intake) -> dict[str, tuple[str, ...]]:
    """Return the paths of each submission by its student's key, in order."""
    return {submission.student.key: submission.paths for submission in intake.submissions()}
