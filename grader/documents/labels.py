"""The task and step that a name or heading names, in any spelling: Task1_Step8, task 1 step 8, T1S8, lab6_task1_q8."""

import re
from dataclasses import dataclass

_WORDS = re.compile(r"[^\W\d_]+|\d+")
_TASKS = frozenset({"task", "tasks", "t", "tsk", "tast", "aufgabe", "teil"})
_STEPS = frozenset(
    {"step", "steps", "s", "st", "stp", "question", "questions", "q", "que", "no", "nr", "schritt", "frage"}
)
_KEYWORDS = _TASKS | _STEPS
_MAX_LENGTH = 300


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
        if word not in _KEYWORDS or not (numbers := _numbers(words, index + 1)):
            continue
        if word in _TASKS:
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


def _numbers(words: tuple[str, ...], start: int) -> list[int]:
    """Return the numbers directly after a word."""
    numbers: list[int] = []
    for word in words[start:]:
        if not word.isdecimal() or len(word) > 4:
            break
        numbers.append(int(word))
    return numbers


def _in_order(wanted: tuple[str, ...], found: tuple[str, ...]) -> bool:
    """Return whether the wanted words occur next to each other, each at least as a prefix: cam in camera."""
    span = len(wanted)
    return any(
        all(word.startswith(part) for part, word in zip(wanted, found[start : start + span], strict=True))
        for start in range(len(found) - span + 1)
    )
