"""The headings of a document, and where the passage below each ends.

A heading is a line that names a task, a step or a question.

A label is the task and step that a heading or the name of a file names, in any spelling:
Task1_Step8, task 1 step 8, T1S8, lab6_task1_q8.
"""

import re
from bisect import bisect_right
from collections.abc import Collection, Iterable
from functools import lru_cache
from itertools import islice, takewhile

from grader.base.grouping import Strings
from grader.base.patterns import on_use
from grader.base.records import Named
from grader.base.text import cut

WORDS = on_use(r"[^\W\d_]+|\d+")
_QUESTION_WORDS = frozenset({"question", "q", "que", "frage"})
_NUMBER = on_use(r"\d{1,4}")
_TASKS = frozenset({"task", "tasks", "t", "tsk", "tast", "aufgabe", "teil"})
_STEPS = {
    "step",
    "steps",
    "s",
    "st",
    "stp",
    "questions",
    "no",
    "nr",
    "schritt",
    "answer",
    "antwort",
} | _QUESTION_WORDS
KEYWORDS = _TASKS | _STEPS
_MAX_LENGTH = 300
Pattern = Strings  # the words of a heading, such as ("required", "question")
_QUESTIONS = (
    ("required", "question"),
    ("optional", "question"),
    ("question",),
)
_MAX_LINE = 1000  # characters of a line in which a label is searched
_MAX_SHOWN = 40  # characters of a heading
_MAX_WORDS = 6  # the first words of a line, which contain the label of a heading
_MAX_SPLIT = 12  # words and signs at the beginning of a line that are looked at
_MARKUP = on_use(r"^[\s#>*\-_+|`]+")
_MARKED = on_use(r"(#{1,6})(?!#)")
_FENCE = on_use(r"\s*(?:```|~~~)")
_SPACED = on_use(r"#+\s")
# Numbers that name a step: 1.15, and 15) or 15. with two digits, because one digit also numbers the
# items of a list.
_DOTTED = on_use(r"^\(?([1-9])\.(\d{1,2})\b[.):]?\s*")
_NUMBERED = on_use(r"^\(?([1-9]\d)[.):][*_]*(?:\s+|$)")
_ITEM = on_use(r"^\(?([1-9])[.):][*_]*(?:\s+|$)")
_LEADING = frozenset({"to", "the", "my", "for", "lab"})  # before the words of a question
_ANSWERS = frozenset({"answer", "answers"})
_TAG = on_use(r"</?[a-zA-Z][^<>]{0,80}>")  # of HTML in Markdown
# "Task 1", "t_1"; "Step 15", "Steps 3, 4 & 5", "Step 1-2".
_TASK = rf"(?:{'|'.join(sorted(_TASKS))})(?:[\W_]*\d{{1,4}}(?!\d))+"
_STEP = (
    rf"(?:{'|'.join(sorted(_STEPS))})[\W_]*\d{{1,4}}(?!\d)"
    r"(?:(?:\s*+(?:[,&+/]\s*+)?|[-_])\d{1,4}(?!\d))*"
)
# What a line needs to begin a passage: a sign or number at its start, or a keyword with a number.
_BEGINNING = (
    r"[\s>*\-_+|`]*(?:#|\(?\d)|"
    rf".{{0,200}}?(?<![^\W\d_])(?:{'|'.join(sorted(_TASKS | _STEPS))})[\W_]*\d"
)
_FILLERS = r"[\W_]*(?:(?:of|the|in|to|for|and|required|optional|question|answer)\b[\W_]*)*"
# "Step 15: see task 2" names no task, and "Step 26: 0.6" no step 6.
_LABEL = on_use(rf"(?<![^\W\d_])(?:{_TASK}|{_STEP})(?:{_FILLERS}(?:{_TASK}|{_STEP}))*")


class Label(Named):
    """The task and steps that a text names, and all of its words.

    They are None and empty where it names none.
    """

    task: int | None
    steps: frozenset[int]
    words: Strings

    @property
    def is_complete(self) -> bool:
        """Return whether it names both a task and a step."""
        return self.task is not None and bool(self.steps)


@lru_cache(maxsize=1024)  # a rubric's names are read for each submission
def read_label(text: str) -> Label:
    """Return the label of a name or line.

    If it names several tasks, as a path may, the last one counts.
    """
    text = text[-_MAX_LENGTH:].lower()
    task = None
    steps = set()
    for part in text.split("/"):
        own_task, own_steps = _numbers(WORDS.findall(part))
        if own_task is not None:
            task = own_task
            steps = own_steps
        else:
            steps |= own_steps
    return Label(task, frozenset(steps), tuple(WORDS.findall(text)))


def matches(wanted: Label, given: Label, task: int | None = None) -> bool:
    """Return whether a label matches the wanted one.

    `task` is the task of the headings around it.
    """
    if wanted.steps or wanted.task is not None:
        own_task = given.task if given.task is not None else task
        if wanted.task is not None and wanted.task != own_task:
            return False
        if wanted.steps:
            return wanted.steps <= given.steps
        return own_task == wanted.task
    return bool(wanted.words) and _in_order(wanted.words, given.words)


def stem(path: str) -> str:
    """Return a path without its suffix."""
    folder, slash, name = path.rpartition("/")
    return folder + slash + (name.rpartition(".")[0] or name)


def _numbers(words: list[str]) -> tuple[int | None, set[int]]:
    """Return the task and the steps that these words name."""
    task = None
    steps = set()
    for index, word in enumerate(words):
        numbers = [int(number) for number in takewhile(_NUMBER.fullmatch, words[index + 1 :])]
        if not numbers:
            continue
        if word in _TASKS:
            task, steps = numbers[0], (steps if task is None else set()) | set(numbers[1:])
        elif word in _STEPS:
            steps |= set(numbers)
    return task, steps


def _in_order(wanted: Strings, words_of_heading: Strings) -> bool:
    """Return whether the wanted words occur next to each other.

    Each may be a prefix of a word: cam in camera.
    """
    for start in range(len(words_of_heading) - len(wanted) + 1):
        words = words_of_heading[start : start + len(wanted)]
        if all(map(str.startswith, words, wanted)):
            return True
    return False


class Heading(Named):
    """A line that begins a passage, and the index of the line that ends it."""

    start: int
    end: int
    text: str
    label: Label
    level: int = 0  # the number of # before it
    task: int | None = None  # of the label, or of the headings above
    section: int | None = None  # the task of the heading without a step above
    pattern: Pattern = ()  # the words of a question
    number: int | None = None  # of the question
    is_bold: bool = False
    is_item: bool = False  # one of a numbered list right below the heading of a task
    is_mention: bool = False  # a sentence that begins a passage, but ends none

    @property
    def shown(self) -> str:
        """Its beginning; of a question the words before its colon."""
        return cut(
            " ".join((self.text.partition(":")[0] if self.pattern else self.text).split()),
            _MAX_SHOWN,
        )


def find_headings(
    lines: list[str], name: str, patterns: Collection[Pattern] = ()
) -> tuple[Heading, ...]:
    """Return the headings among the lines of a document.

    `name` is that of the file, which may name a task. `patterns` are the words of further headings,
    besides those of questions.
    """
    headings: list[Heading] = []
    known = (*patterns, *_QUESTIONS)
    words = "|".join(
        sorted({re.escape(word) for pattern in known for word in pattern} | _QUESTION_WORDS)
    )
    candidate = re.compile(rf"{_BEGINNING}|.{{0,200}}?\b(?:{words})(?![^\W\d_])", re.IGNORECASE)
    task = section = read_label(name).task
    is_fenced = False
    for index, line in enumerate(lines):
        is_fenced ^= _FENCE.match(line) is not None
        if not candidate.match(line, 0, _MAX_LINE):
            continue
        above = headings[-1] if headings else None
        heading = _read_heading(line[:_MAX_LINE], index, known, above, is_marked=not is_fenced)
        if not heading:
            continue
        own_task = heading.label.task
        if own_task is not None and not heading.is_mention:
            if not heading.label.steps:
                section = own_task
            elif own_task != section:
                section = None
            task = own_task
        headings.append(
            heading._replace(task=own_task if own_task is not None else task, section=section)
        )
    return _with_ends(headings, lines)


def _with_ends(headings: Collection[Heading], lines: list[str]) -> tuple[Heading, ...]:
    """Return headings with the ends of the passages below them."""
    ending = [heading for heading in headings if not heading.is_mention]
    starts = [heading.start for heading in ending]
    return tuple(
        heading._replace(
            end=_end_of_passage(
                heading, islice(ending, bisect_right(starts, heading.start), None), lines
            )
        )
        for heading in headings
    )


def is_about(wanted: Label, head: Heading) -> bool:
    """Return whether a heading has a label.

    Plain words begin it, or are in one that is marked as a heading.
    """
    if not wanted.steps and wanted.task is None:
        is_pattern = bool(head.pattern) and head.pattern == wanted.words
        return is_pattern or (head.level > 0 and matches(wanted, read_label(head.text)))
    return matches(wanted, head.label, head.task)


def has_words(line: str) -> bool:
    """Return whether a line contains text, not only markup or a picture."""
    return any(map(str.isalnum, line))


def _read_heading(
    line: str, index: int, patterns: Collection[Pattern], above: Heading | None, *, is_marked: bool
) -> Heading | None:
    """Return what a line begins, if it begins anything; its end and its tasks are not known yet."""
    marked = _MARKED.match(line) if is_marked else None
    plain = _MARKUP.sub("", _TAG.sub(" ", line) if "<" in line else line)
    text = plain.rstrip(" *_|`#\t")
    words = _first_words(plain)
    label = _label_in(words)
    pattern, number = read_question(plain, patterns)
    level = len(marked[1]) if marked else 0
    heading = Heading(
        index, index, text, label, level, pattern=pattern, number=number, is_bold=_is_bold(line)
    )
    if label.steps or label.task is not None:
        is_heading = marked or pattern or _begins_with_label(words)
        return heading._replace(is_mention=not is_heading)
    if pattern or (marked and _SPACED.match(line) and has_words(line)):
        return heading
    item = _ITEM.match(plain)
    if item and above and not marked and (above.is_item or _is_task(above)):
        return heading._replace(label=read_label(f"step {item[1]}"), is_item=True)
    return None


def _is_bold(line: str) -> bool:
    """Return whether the whole line is bold, but for a colon or point at its end."""
    return line.lstrip().startswith(("**", "__")) and line.rstrip(" :.").endswith(("**", "__"))


def _begins_with_label(words: list[str]) -> bool:
    """Return whether a line with a label is short, or its first two words have one."""
    if len(words) <= _MAX_WORDS:
        return True
    begins = _label_in(words[:2])
    return bool(begins.steps) or begins.task is not None


def _is_task(heading: Heading) -> bool:
    """Return whether a heading names a task as a whole."""
    return heading.label.task is not None and not (
        heading.label.steps or heading.is_mention or heading.pattern
    )


def _first_words(plain: str) -> list[str]:
    plain = _DOTTED.sub(r"task \1 step \2 ", plain)
    plain = _NUMBERED.sub(r"step \1 ", plain)
    return [word for word in plain.split(None, _MAX_SPLIT) if has_words(word)]


def _label_in(words: list[str]) -> Label:
    """Return the first label in the first words of a line."""
    match = _LABEL.search(" ".join(words[:_MAX_WORDS]).lower())
    return read_label(match[0] if match else "")


def read_question(text: str, patterns: Collection[Pattern]) -> tuple[Pattern, int | None]:
    """Return the pattern that a line or name begins with, and a number.

    The pattern's words are in any order, the number after or between them.
    """
    words = [word for word in text.split(None, _MAX_SPLIT) if has_words(word)]
    tokens = _question_words(" ".join(words[: _MAX_WORDS + 2]))
    for pattern in patterns:
        count = len(pattern)
        number = next(
            (int(token) for token in tokens[1 : count + 1] if token.isdecimal() and len(token) < 5),
            None,
        )
        first = [token for token in tokens[: count + (number is not None)] if not token.isdecimal()]
        is_short = (
            count > 1 or number is not None or len(tokens) == 1 or ":" in " ".join(text.split()[:2])
        )
        if is_short and sorted(first) == sorted(pattern):
            return pattern, number
    return (), None


def _question_words(text: str) -> list[str]:
    """Return the words of a heading from the question on.

    "2. Task 1 - Answer to Q3" begins with "question".
    """
    tokens = WORDS.findall(text.lower())
    while tokens:
        has_number = len(tokens) > 1 and tokens[1].isdecimal()
        if tokens[0] in _ANSWERS and has_number:
            tokens[0] = "question"
        elif has_number and tokens[0] in (_TASKS | _STEPS) - _QUESTION_WORDS:
            del tokens[:2]
        elif tokens[0] in _LEADING or tokens[0] in _ANSWERS or tokens[0].isdecimal():
            del tokens[0]
        else:
            break
    return ["question" if token in _QUESTION_WORDS else token for token in tokens]


def _end_of_passage(heading: Heading, later: Iterable[Heading], lines: list[str]) -> int:
    return next(
        (other.start for other in later if _ends_passage(heading, other, lines)), len(lines)
    )


def _ends_passage(heading: Heading, other: Heading, lines: list[str]) -> bool:
    """Return whether a later heading ends the passage.

    Below a heading that is marked as one, only such a heading does, or a line that is bold or names
    task and step at once. A heading without a step, such as "Answer" or "REQUIRED Question:" below
    "Step 15", does not end a passage without text.
    """
    if other.is_item:
        return heading.is_item
    if heading.pattern and other.pattern and not (heading.level and not other.level):
        return True
    if (other.label.steps and not other.pattern) or other.label.task is not None:
        return not heading.level or other.level > 0 or other.is_bold or other.label.is_complete
    if heading.level and (not other.level or (other.level > heading.level and not other.pattern)):
        return False
    between = lines[heading.start + 1 : other.start]
    is_title = heading.level or ":" not in heading.text or heading.text.endswith(":")
    return any(map(has_words, between)) or not is_title
