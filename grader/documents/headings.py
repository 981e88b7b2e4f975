"""The headings of a document: the lines that name a task or step, and where the passages below them end."""

import re
from typing import NamedTuple

from grader.documents.labels import Label, read_label

_MAX_LINE = 1000  # characters of a line in which a label is searched
_MAX_WORDS = 6  # the first words of a line, which contain the label of a heading
_MARKUP = re.compile(r"^[\s#>*\-_+|`]+")
_DIGIT = re.compile(r"\d")
# Numbers that name a step: 1.15, and 15) or 15. with two digits, because one digit numbers the items of a list.
_DOTTED = re.compile(r"^\(?([1-9])\.(\d{1,2})\b[.):]?\s*")
_NUMBERED = re.compile(r"^\(?([1-9]\d)[.):]\s+")


class Heading(NamedTuple):
    """A line that names a task or step: its index, what it names, and the index of the line that ends its passage.

    `task` is that of the label, or of the headings above.
    """

    start: int
    label: Label
    task: int | None
    end: int


def find_headings(lines: list[str], name: str) -> tuple[Heading, ...]:
    """Return the headings among the lines of a document; `name` is that of the file, which may name a task."""
    found: list[tuple[int, Label, int | None, list[str]]] = []
    task = read_label(name).task
    for index, line in enumerate(lines):
        if not _DIGIT.search(line, 0, _MAX_LINE):
            continue
        words = _words(line[:_MAX_LINE])
        label = read_label(" ".join(words[:_MAX_WORDS]))
        if label.steps or label.task is not None:
            task = label.task if label.task is not None else task
            found.append((index, label, task, words))
    headings: list[Heading] = []
    end = end_of_marked = len(lines)
    for index, label, task, words in reversed(found):
        is_marked = lines[index].startswith("#")
        headings.append(Heading(index, label, task, end_of_marked if is_marked else end))
        # A sentence that mentions a step ends no passage. Below a heading that is marked as one, only such a heading does,
        # or a line that names task and step at once.
        begins = read_label(" ".join(words[:2]))
        if len(words) <= _MAX_WORDS or begins.steps or begins.task is not None:
            end = index
        if is_marked or (begins.task is not None and read_label(" ".join(words[:4])).steps):
            end_of_marked = index
    return tuple(reversed(headings))


def _words(line: str) -> list[str]:
    plain = _MARKUP.sub("", line)
    plain = _DOTTED.sub(r"task \1 step \2 ", plain)
    plain = _NUMBERED.sub(r"step \1 ", plain)
    return [word for word in plain.split() if any(map(str.isalnum, word))]
