"""The default rubric, a rubric by its name, and the files that it is read from."""

from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from grader.base.errors import GraderError

if TYPE_CHECKING:
    from grader.lab.rubric.rubric import Rubric

DEFAULT_RUBRIC = "lab6"  # of the command line


def list_files(name: str, answers: Path | None = None) -> list[Path]:
    """Return the files and folders that a rubric is read from.

    These are its own file, its model answers and its reference.

    It is only its own file if there is a mistake in it. Of a reference in the rubric's own folder
    it is only the URDF.
    """
    from grader.lab.rubric.rubric import find_rubric, load_rubric  # late: the default needs none

    files = [answers] if answers else []
    with suppress(GraderError):
        file = find_rubric(name)
        files.append(file)
        rubric = load_rubric(name)
        if rubric.answers:
            files.append(file.parent / rubric.answers)
        if rubric.reference:
            place = file.parent / rubric.reference
            files.append(
                place / rubric.urdf if place.resolve() in file.resolve().parents else place
            )
    return files


def load_named(name: str, answers: Path | None = None) -> "Rubric":
    """Return a rubric, with model answers if their file is named.

    Raises RubricError or InputError.
    """
    if not answers:
        from grader.lab.rubric.rubric import load_rubric

        return load_rubric(name)
    from grader.lab.rubric.model_answers import load_with_answers

    return load_with_answers(name, answers)
