"""The task and step that a name or heading names, in any spelling: Task1_Step8, task 1 step 8, T1S8, lab6_task1_q8."""

import re
from dataclasses import dataclass
from functools import lru_cache
from itertools import takewhile

WORDS = re.compile(r"[^\W\d_]+|\d+")
QUESTION_WORDS = frozenset({"question", "q", "que", "frage"})
_NUMBER = re.compile(r"\d{1,4}")
TASKS = frozenset({"task", "tasks", "t", "tsk", "tast", "aufgabe", "teil"})
STEPS = {"step", "steps", "s", "st", "stp", "questions", "no", "nr", "schritt", "answer", "antwort"} | QUESTION_WORDS
KEYWORDS = TASKS | STEPS
_MAX_LENGTH = 300


@dataclass(frozen=True, slots=True)
class Label:
    """The task and steps that a text names, and all of its words; None and empty where it names none."""

    task: int | None
    steps: frozenset[int]
    words: tuple[str, ...]

    @property
    def is_complete(self) -> bool:
        """Return whether it names both a task and a step."""
        return self.task is not None and bool(self.steps)


@lru_cache(maxsize=1024)  # a rubric's names are read for each submission
def read_label(text: str) -> Label:
    """Return the label of a name or line. If it names several tasks, as a path may, the last one counts."""
    text = text[-_MAX_LENGTH:].lower()
    task: int | None = None
    steps: set[int] = set()
    for part in text.split("/"):
        own_task, own_steps = _numbers(WORDS.findall(part))
        if own_task is not None:
            task, steps = own_task, own_steps
        else:
            steps |= own_steps
    return Label(task, frozenset(steps), tuple(WORDS.findall(text)))


def matches(wanted: Label, found: Label, task: int | None = None) -> bool:
    """Return whether a label matches the wanted one; `task` is the task of the headings around it."""
    if wanted.steps or wanted.task is not None:
        own = found.task if found.task is not None else task
        if wanted.task is not None and wanted.task != own:
            return False
        return wanted.steps <= found.steps if wanted.steps else own == wanted.task
    return bool(wanted.words) and _in_order(wanted.words, found.words)


def stem(path: str) -> str:
    """Return a path without its suffix."""
    folder, slash, name = path.rpartition("/")
    return folder + slash + (name.rpartition(".")[0] or name)


def _numbers(words: list[str]) -> tuple[int | None, set[int]]:
    """Return the task and the steps that these words name."""
    task: int | None = None
    steps: set[int] = set()
    for index, word in enumerate(words):
        numbers = [int(number) for number in takewhile(_NUMBER.fullmatch, words[index + 1 :])]
        if not numbers:
            continue
        if word in TASKS:
            task, steps = numbers[0], (steps if task is None else set()) | set(numbers[1:])
        elif word in STEPS:
            steps |= set(numbers)
    return task, steps


def _in_order(wanted: tuple[str, ...], found: tuple[str, ...]) -> bool:
    """Return whether the wanted words occur next to each other, each at least as a prefix: cam in camera."""
    span = len(wanted)
    return any(
        all(word.startswith(part) for part, word in zip(wanted, found[start : start + span], strict=True))
        for start in range(len(found) - span + 1)
    )
