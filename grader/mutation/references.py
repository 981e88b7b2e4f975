"""The names that a rubric and the files of a package refer to: renaming these changes more than a name."""

import re
from collections.abc import Iterator, Mapping
from typing import Any

from grader.errors import InputError
from grader.files.reading import URDF_LIMIT
from grader.grading.criterion import Criterion
from grader.grading.rubric import Rubric
from grader.submission.submission import Submission

_WORD = re.compile(r"[\w@:.-]+")
_TEXTS = (".py", ".xml", ".yaml", ".yml", ".rviz", ".launch", ".cfg", ".json", ".txt", ".world", ".sdf")


def names_in(rubric: Rubric) -> set[str]:
    """Return every text in the arguments of a rubric's checks, also the keys of tables."""
    return {name for criterion in rubric.criteria for name in names_of(criterion)}


def names_of(criterion: Criterion) -> set[str]:
    """Return every text in the arguments of a criterion, and the joints that it poses."""
    carried = criterion.carried.arguments if criterion.carried is not None else {}
    return set(texts([criterion.arguments, carried, getattr(criterion, "at", {})]))


def words_in_files(submission: Submission) -> set[str]:
    """Return the words in the text files around a URDF: launch files, configurations of controllers and of RViz."""
    found: set[str] = set()
    for path, file in submission.everything.files.items():
        if path.lower().endswith(_TEXTS):
            try:
                found |= set(_WORD.findall(file.read(URDF_LIMIT).decode("utf-8", "replace")))
            except InputError:
                continue
    return found


def texts(value: Any) -> Iterator[str]:
    """Yield the texts in the arguments of a check, also the keys of tables."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, Mapping):
        yield from texts([*value, *value.values()])
    elif isinstance(value, list | tuple):
        for item in value:
            yield from texts(item)
