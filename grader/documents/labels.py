"""The task and step that a name or heading names, in any spelling: Task1_Step8, task 1 step 8, T1S8, lab6_task1_q8."""

import re
from dataclasses import dataclass
from itertools import takewhile
from typing import NamedTuple

_WORDS = re.compile(r"[^\W\d_]+|\d+")
_NUMBER = re.compile(r"\d{1,4}")
_TASKS = frozenset({"task", "tasks", "t", "tsk", "tast", "aufgabe", "teil"})
_STEPS = {"step", "steps", "s", "st", "stp", "question", "questions", "q", "que", "no", "nr", "schritt", "frage"}
_KEYWORDS = _TASKS | _STEPS
_MAX_LENGTH = 300
_MAX_LINE = 1000  # characters of a line in which a label is searched
_MAX_WORDS = 6  # the first words of a line, which contain the label of a heading
_MARKUP = re.compile(r"^[\s#>*\-_+|`]+")
_DIGIT = re.compile(r"\d")
# Numbers that name a step: 1.15, and 15) or 15. with two digits, because one digit numbers the items of a list.
_DOTTED = re.compile(r"^\(?([1-9])\.(\d{1,2})\b[.):]?\s*")
_NUMBERED = re.compile(r"^\(?([1-9]\d)[.):]\s+")


@dataclass(frozen=True, slots=True)
class Label:
    """The task and steps that a text names, and all of its words; None and empty where it names none."""

    task: int | None
    steps: frozenset[int]
    words: tuple[str, ...]


def read_label(text: str) -> Label:
    """Return the label of a name or line. If it names several tasks, as a path may, the last one counts."""
    words = tuple(_WORDS.findall(text[-_MAX_LENGTH:].lower()))
    task: int | None = None
    steps: set[int] = set()
    for index, word in enumerate(words):
        if word not in _KEYWORDS:
            continue
        numbers = [int(number) for number in takewhile(_NUMBER.fullmatch, words[index + 1 :])]
        if word in _TASKS and numbers:
            task, steps = numbers[0], set(numbers[1:])
        else:
            steps |= set(numbers)
    return Label(task, frozenset(steps), words)


def matches(wanted: Label, found: Label, task: int | None = None) -> bool:
    """Return whether a label matches the wanted one; `task` is the task of the headings around it."""
    if wanted.steps or wanted.task is not None:
        own = found.task if found.task is not None else task
        if wanted.task is not None and wanted.task != own:
            return False
        return wanted.steps <= found.steps if wanted.steps else own == wanted.task
    return bool(wanted.words) and _in_order(wanted.words, found.words)


def _in_order(wanted: tuple[str, ...], found: tuple[str, ...]) -> bool:
    """Return whether the wanted words occur next to each other, each at least as a prefix: cam in camera."""
    span = len(wanted)
    return any(
        all(word.startswith(part) for part, word in zip(wanted, found[start : start + span], strict=True))
        for start in range(len(found) - span + 1)
    )


class Heading(NamedTuple):
    """A line that names a task or step: its index, what it names, and the index of the line that ends its passage."""

    start: int
    label: Label
    task: int | None  # that of the label, or of the headings above
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
