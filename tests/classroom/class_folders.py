"""Make class folders and zips for tests."""

import zipfile
from collections.abc import Iterable
from pathlib import Path

from grader.classroom.intake.intake import Intake


def lay_out(top: Path, *paths: str) -> Path:
    """Make a folder with these empty files; a path that ends in a slash is a folder."""
    top.mkdir(parents=True, exist_ok=True)
    for path in paths:
        place = top / path
        if path.endswith("/"):
            place.mkdir(parents=True, exist_ok=True)
        else:
            place.parent.mkdir(parents=True, exist_ok=True)
            place.touch()
    return top


def pack(place: Path, names: Iterable[str]) -> Path:
    """Make a zip with these empty members."""
    with zipfile.ZipFile(place, "w") as archive:
        for name in names:
            archive.writestr(name, b"")
    return place


def assigned(intake: Intake) -> dict[str, tuple[str, ...]]:
    """Return the paths of each submission by its student's key, in order."""
    return {submission.student.key: submission.paths for submission in intake.submissions()}
