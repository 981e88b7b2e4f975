"""Written answers: the passage of a document about a question. A person grades it.

Several questions may share a heading, such as "REQUIRED Question:": which of them belongs to which
is matched.
"""

from collections.abc import Iterator, Sequence
from itertools import pairwise, starmap

from grader.base.grouping import Strings
from grader.base.patterns import on_use
from grader.base.records import Named
from grader.base.source import Location
from grader.base.text import counted
from grader.lab.documents.collection import DocumentCollection, Passage, TextDocument
from grader.lab.documents.converter import PICTURE
from grader.lab.documents.headings import (
    KEYWORDS,
    WORDS,
    Heading,
    Label,
    Pattern,
    has_words,
    is_about,
    matches,
    read_label,
    read_question,
    stem,
)

_ORDINAL = on_use(r"\s*+(\S++(?:\s++\S++)*?)\s++(\d{1,3})\s++of\s++(\d{1,3})\s*")
_MAX_TEXT = 32_000  # characters, which no written answer has
_MAX_QUESTION = 4000  # characters of a question
_MAX_HEADING_WORDS = 6  # a passage of so few words is a heading without a text
_MAX_MATCHES = 50  # headings of one document that are compared
_MAX_OTHERS = 3  # passages besides the best one
_COPIED = frozenset(
    {"required", "optional", "question", "answer", "task", "step", "todo", "your", "here", "write"}
)  # words of a question or of a template, besides its own
_Passages = Sequence[Passage]


class _FoundAnswer(Named):
    """The result of a search for an answer.

    It has the passage, the documents that were read, and why others were not.
    """

    passage: Passage | None
    others: tuple[Passage, ...]  # further passages for the same place
    read: Strings
    unread: Strings


def find_answer(
    documents: DocumentCollection, files: Sequence[str], places: Sequence[str], question: str = ""
) -> _FoundAnswer:
    """Search for the passage about one of `places` in documents.

    A place is such as `task 1 step 15`. The documents have names like `files`.

    A passage with a text wins over a heading without one, a certain one over another, and then an
    earlier place over a later one.
    """
    read, unread = documents.named(files)
    wanted = [_read_ordinal(place) or read_label(place) for place in places]
    candidates = [
        passages
        for passages in _AnswerSearch(documents, read, wanted, question).passages()
        if passages
    ]
    first = None
    others = []
    if candidates:
        first, *others = min(
            candidates, key=lambda passages: (passages[0].is_empty, not passages[0].is_certain)
        )
    paths = tuple(document.file.path for document in read)
    return _FoundAnswer(first, tuple(others[:_MAX_OTHERS]), paths, tuple(map(str, unread)))


class _Ordinal(Named):
    """A question by its place among all: "required question 1 of 2"."""

    pattern: Pattern
    number: int
    total: int


class _AnswerMatch(Named):
    """The answers that belong to a question, by their index: exactly one, unless it is not certain.

    `how` says why.
    """

    indices: tuple[int, ...]
    is_certain: bool
    how: str


def _read_ordinal(place: str) -> _Ordinal | None:
    """Return the place among all questions that "required question 1 of 2" names.

    It is None for other texts.
    """
    match = _ORDINAL.fullmatch(place.lower())
    if match:
        return _Ordinal(tuple(WORDS.findall(match[1])), int(match[2]), int(match[3]))
    return None


def _match_answer(wanted: _Ordinal, task: int | None, answers: _Passages) -> _AnswerMatch | None:
    """Return which of the answers in one document belongs to a question of a task.

    It is None if there is none for it.

    The order is this: the only one below the heading of the task; the one with its number; the one
    at its place, if there are as many as questions. Anything else is not certain.
    """
    if not answers:
        return None
    only_answer = _only_answer_of_task(task, answers)
    if only_answer:
        return only_answer
    written = [index for index, answer in enumerate(answers) if not answer.is_empty]
    numbers = [answer.head.number for answer in answers if answer.head.number is not None]
    if len(numbers) == len(answers) and max(numbers) <= wanted.total:
        return _answer_by_number(wanted, task, answers, written)
    every = list(range(len(answers)))
    for indices in (every, written, _answers_after_list(answers, wanted.total)):
        if len(indices) == wanted.total and _are_in_order(answers, indices):
            index = indices[wanted.number - 1]
            title = _answer_text(answers, [index])
            how = f"in order: heading {wanted.number} of {wanted.total} like {title}"
            return _AnswerMatch((index,), True, how)
    indices = written or every
    headings = f"{counted(len(indices), 'heading')} like {_answer_text(answers, indices)}"
    how = f"{headings} for {wanted.total} questions: it may answer another question"
    return _AnswerMatch(tuple(indices), False, how)


def _only_answer_of_task(task: int | None, answers: _Passages) -> _AnswerMatch | None:
    """Return the only answer below the heading of a task, if all answers are below one."""
    if task is None or any(answer.head.section is None for answer in answers):
        return None
    below = [index for index, answer in enumerate(answers) if answer.head.section == task]
    if len(below) != 1:
        return None
    how = f"the only {_answer_text(answers, below)} below the heading of task {task}"
    return _AnswerMatch(tuple(below), True, how)


def _are_in_order(answers: _Passages, indices: Sequence[int]) -> bool:
    """Return whether each answer that has a number has that of its place."""
    return all(
        answers[index].head.number in (None, place) for place, index in enumerate(indices, start=1)
    )


def _answer_by_number(
    wanted: _Ordinal, task: int | None, answers: _Passages, written: Sequence[int]
) -> _AnswerMatch | None:
    """Return the answer below the question's number.

    Of several, as with a list of the questions, it is that with text.
    """
    hits = [index for index, answer in enumerate(answers) if answer.head.number == wanted.number]
    if len(hits) > 1:
        hits = [index for index in hits if index in written] or hits
    if not hits:
        return None
    title = _answer_text(answers, hits)
    if len(hits) > 1:
        return _AnswerMatch(tuple(hits), False, f"{len(hits)} headings like {title}")
    section = answers[hits[0]].head.section
    if len(wanted.pattern) == 1 and None not in (section, task) and section != task:
        how = f"by the number in {title}, but below the heading of task {section}"
        return _AnswerMatch(tuple(hits), False, how)
    return _AnswerMatch(tuple(hits), True, f"by the number in {title}")


def _answers_after_list(answers: _Passages, total: int) -> list[int]:
    """Return the answers that follow a list of all questions; none without such a list."""
    is_list = len(answers) == 2 * total and all(map(_is_line, answers[:total]))
    if is_list and not any(map(_is_line, answers[total:])):
        return list(range(total, 2 * total))
    return []


def _answer_text(answers: _Passages, indices: Sequence[int]) -> str:
    return f'"{answers[indices[0]].head.shown}"'


def _is_line(answer: Passage) -> bool:
    """Return whether an answer ends with the line of its heading."""
    return "\n" not in answer.text


class _AnswerSearch:
    """The search for one answer in some documents."""

    def __init__(
        self,
        documents: DocumentCollection,
        read: list[TextDocument],
        wanted: list[Label | _Ordinal],
        question: str,
    ) -> None:
        self._documents = documents
        self._read = read
        self._wanted = wanted
        self._copied = _COPIED | set(WORDS.findall(question.lower()))
        self._task = None  # the first that is named
        self._patterns = set()
        for place in wanted:
            if isinstance(place, _Ordinal):
                self._patterns.add(place.pattern)
            elif place.task is not None:
                if self._task is None:
                    self._task = place.task
            elif place.words and not place.steps:
                self._patterns.add(place.words)

    def passages(self) -> Iterator[list[Passage]]:
        """Yield the passages for each place.

        The best one comes first, then others that certainly answer the question as well.
        """
        for wanted in self._wanted:
            if isinstance(wanted, _Ordinal):
                passages = self._in_order(wanted)
            else:
                passages = self._passages_below(wanted)
            kept = passages[:1]
            for passage in passages[1:]:
                if passage.is_certain and not passage.is_empty and passage.text != kept[0].text:
                    kept.append(passage)
            yield kept

    def _headings(self, document: TextDocument) -> tuple[Heading, ...]:
        return self._documents.headings(document, self._patterns)

    def _passages_below(self, wanted: Label) -> list[Passage]:
        """Return the passages whose heading, or whose file, is labelled so.

        One that is an item of a list or a mention is among them only if it comes first.
        """
        ranked = []
        for document in self._read:
            for head in self._headings_about(wanted, document):
                passage = self._find_passage(document, head)
                if not passage:
                    continue
                words = passage.text.split(maxsplit=_MAX_HEADING_WORDS)
                is_short = len(words) <= _MAX_HEADING_WORDS
                rank = (passage.is_empty, is_short, head.is_item, head.is_mention)
                ranked.append((rank, self._explained_passage(passage, document, head, wanted)))
        ranked.sort(key=lambda ranked_passage: ranked_passage[0])
        passages = [passage for _, passage in ranked]
        return passages[:1] + [
            passage
            for passage in passages[1:]
            if not (passage.head.is_item or passage.head.is_mention)
        ]

    def _headings_about(self, wanted: Label, document: TextDocument) -> list[Heading]:
        """Return the headings that are labelled so, or one for the whole file if it is named so."""
        if matches(wanted, read_label(stem(document.file.name))):
            return [Heading(0, len(document.lines), "", wanted)]
        heads = [head for head in self._headings(document) if is_about(wanted, head)]
        return heads[:_MAX_MATCHES]

    def _explained_passage(
        self, passage: Passage, document: TextDocument, head: Heading, wanted: Label
    ) -> Passage:
        """Return a passage with what makes its heading less than certain."""
        if head.is_item:
            items = [
                item
                for item in self._headings(document)
                if item.is_item and item.section == head.section
            ]
            if (
                len(items) > 1 and min(min(item.label.steps) for item in items) == 1
            ):  # perhaps the points of one answer
                whole = (
                    self._find_passage(document, items[0]._replace(end=items[-1].end)) or passage
                )
                how = (
                    f"a numbered list below the heading of task {head.task}, whose items may be "
                    "steps or not"
                )
                return whole._replace(how=how, is_certain=False)
            return passage._replace(
                how=f"item {min(wanted.steps)} below the heading of task {head.task}"
            )
        is_other = None not in (self._task, head.task) and head.task != self._task
        how = f"below a heading of task {head.task}: it may answer another question"
        if is_other:
            return passage._replace(how=how, is_certain=False)
        return passage

    def _in_order(self, wanted: _Ordinal) -> list[Passage]:
        """Return the passages below headings that questions share.

        These may also be those in files of that name, if this is clear.
        """
        groups = []
        for document in self._read:
            groups.append([(document, head) for head in self._headings(document)])
        groups.append(
            [(document, _heading_of_file(document, wanted.pattern)) for document in self._read]
        )
        joined = []
        for group in groups:
            heads = []
            for document, head in group:
                # "question" means also those that say which: "REQUIRED Question".
                is_question = wanted.pattern == ("question",) and "question" in head.pattern
                if is_question or head.pattern == wanted.pattern:
                    heads.append((document, head))
            passages = list(starmap(self._find_passage, heads[:_MAX_MATCHES]))
            answers = [passage for passage in passages if passage]
            match = _match_answer(wanted, self._task, answers)
            if match:
                joined.append(_joined_passage(match, [answers[index] for index in match.indices]))
        return sorted(joined, key=lambda passage: (passage.is_empty, not passage.is_certain))

    def _find_passage(self, document: TextDocument, head: Heading) -> Passage | None:
        lines = document.lines
        start = head.start
        end = head.end
        while start < end and not has_words(lines[start]):
            start += 1
        kept = ["[picture]" if line == PICTURE else line.rstrip() for line in lines[start:end]]
        while kept and not kept[-1]:
            kept.pop()
        text = "\n".join(kept)
        if not text.strip():
            return None
        text = text[:_MAX_TEXT] + (" [...]" if len(text) > _MAX_TEXT else "")
        at = Location(document.file.path, start + 1, 1)
        return Passage(
            text,
            at,
            _describe_place(document, head, at),
            head,
            is_empty=self._is_question_only(text),
        )

    def _is_question_only(self, text: str) -> bool:
        """Return whether a passage holds only the question's words.

        One that ends in "?", or a whole passage in ":", may be worded differently.
        """
        if "[picture]" in text or len(text) > _MAX_QUESTION:
            return False
        text = text.lower()
        asked, mark, rest = text.rpartition("?")
        if text.rstrip().endswith(":"):
            asked = text
            mark = ":"
            rest = ""
        others = [word not in self._copied for word in _own_words(asked)]
        is_asked = mark != "" and 2 * sum(others) <= len(others)
        return self._copied.issuperset(_own_words(rest if is_asked else text))


def _own_words(text: str) -> list[str]:
    """Return the words of a text without those of labels."""
    words = WORDS.findall(text)
    pairs = pairwise([*words, ""])
    return [
        word
        for word, after in pairs
        if not word.isdecimal() and not (word in KEYWORDS and after.isdecimal())
    ]


def _heading_of_file(document: TextDocument, pattern: Pattern) -> Heading:
    """Return a heading for a whole document: its name may be that of a question."""
    name = stem(document.file.name)
    task = read_label(stem(document.file.path)).task
    matching, number = read_question(name.replace("_", " "), (pattern,))
    return Heading(
        0,
        len(document.lines),
        name,
        read_label(name),
        section=task,
        pattern=matching,
        number=number,
    )


def _joined_passage(match: _AnswerMatch, passages: list[Passage]) -> Passage:
    text = "\n\n".join(passage.text for passage in passages)[:_MAX_TEXT]
    return passages[0]._replace(
        text=text,
        how=match.how,
        is_certain=match.is_certain,
        is_empty=all(passage.is_empty for passage in passages),
    )


def _describe_place(document: TextDocument, head: Heading, at: Location) -> str:
    """Return where a passage is.

    This is its page, or its heading, or its line where editors count lines.
    """
    page = document.page(head.start)
    if page is not None:
        return f"on page {page} of {at.path}"
    if document.file.suffix == ".docx":
        if head.text:
            return f'in {at.path}, below "{head.shown}"'
        return f"in {at.path}"
    return f"in {at.path}, from line {at.line}"
