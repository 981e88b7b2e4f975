"""Which task and step a name or heading speaks of, however it is spelt: Task1_Step8, task 1 step 8, T1S8, lab6_task1_q8."""

import re
from dataclasses import dataclass

_WORDS = re.compile(r"[^\W\d_]+|\d+")
_TASKS = frozenset({"task", "tasks", "t", "tsk", "tast", "aufgabe", "teil"})
_STEPS = frozenset(
    {"step", "steps", "s", "st", "stp", "question", "questions", "q", "que", "no", "nr", "schritt", "frage"}
)
_NAMING = _TASKS | _STEPS
_LONGEST = 300


@dataclass(frozen=True, slots=True)
class Label:
    """A task and the steps of it that are named, and every word; None and nothing where there are none."""

    task: int | None
    steps: frozenset[int]
    words: tuple[str, ...]


def read_label(text: str) -> Label:
    """The label in a name or line. Where several tasks are named, as in a path, the last one counts."""
    words = tuple(_WORDS.findall(text[-_LONGEST:].lower()))
    task: int | None = None
    steps: set[int] = set()
    for index, word in enumerate(words):
        if word not in _NAMING or not (numbers := _numbers(words, index + 1)):
            continue
        if word in _TASKS:
            task, steps = numbers[0], set(numbers[1:])
        else:
            steps |= set(numbers)
    return Label(task, frozenset(steps), words)


def is_meant(wanted: Label, found: Label, task: int | None = None) -> bool:
    """Whether a label speaks of what is wanted; `task` is the one that is known from around it."""
    if wanted.steps or wanted.task is not None:
        own = found.task if found.task is not None else task
        if wanted.task is not None and wanted.task != own:
            return False
        return wanted.steps <= found.steps if wanted.steps else own == wanted.task
    return bool(wanted.words) and _in_order(wanted.words, found.words)


def _numbers(words: tuple[str, ...], start: int) -> list[int]:
    """The numbers that follow a word at once."""
    numbers: list[int] = []
    for word in words[start:]:
        if not word.isdecimal() or len(word) > 4:
            break
        numbers.append(int(word))
    return numbers


def _in_order(wanted: tuple[str, ...], found: tuple[str, ...]) -> bool:
    """Whether words stand next to each other in others, each at least as a beginning: cam in camera."""
    span = len(wanted)
    return any(
        all(word.startswith(part) for part, word in zip(wanted, found[start : start + span], strict=True))
        for start in range(len(found) - span + 1)
    )
