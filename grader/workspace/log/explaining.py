"""What explains the messages of a log: findings of rules, and places of the workspace.

A message is explained by what the files prove of it, and of others nothing is said: names that are
alike are no proof.
"""

from collections.abc import Iterable, Iterator, Sequence
from functools import cache
from typing import Literal, NamedTuple

from grader.base.errors import NotDecided
from grader.base.patterns import on_use
from grader.base.problems import Problem
from grader.base.source import Location
from grader.base.text import cut
from grader.ros.known.output_rows import OutputRow, known_outputs
from grader.workspace.log.known_messages import KnownMessage, PlacedAnswer
from grader.workspace.log.log_findings import LogFindings
from grader.workspace.log.log_messages import LogMessage, read_messages
from grader.workspace.log.log_names import LogNames
from grader.workspace.log.log_paths import LogPaths
from grader.workspace.log.log_places import say_publishers, search_place
from grader.workspace.opening.opened import OpenedWorkspace
from grader.workspace.rules.rule_table import RULES

_MAX_ANSWERS = 40
_MAX_OF_A_MESSAGE = 2
_MAX_UNKNOWN = 5  # messages of which no place is said
_MAX_TEXT = 200  # characters of a message that are shown
_FAILURE = on_use(r"(?i)(?:error|fatal|exception|failed|failure)\b|\bnot found\b")
_WARNING = on_use(r"(?i)warning\b")
_UNKNOWN = "no explanation is known"
# What a place has to do with a message: the cause, the line that it names, or a name in it.
_Relation = Literal["explains", "is named in", "see also"]


class LogAnswer(NamedTuple):
    """What is said of a message of a log.

    Without a location the files do not explain it.
    """

    line: int  # of the log, from 1
    text: str  # of the message
    output: str  # the name of its row; empty without one
    message: str  # what explains it, or that nothing does
    location: Location | None = None
    code: str = ""  # of the finding that explains it; empty without one
    relation: _Relation = "explains"  # of the location to the message


class _Asked(NamedTuple):
    """A message that is known or says that something fails, with the rows that know it."""

    message: LogMessage
    known: Sequence[KnownMessage]

    @property
    def roots(self) -> list[KnownMessage]:
        """The rows of what is no consequence of another message."""
        return [each for each in self.known if not each.row.follows]

    @property
    def output(self) -> str:
        """The name of the first row that knows it; empty without one."""
        return next((each.row.name for each in self.known), "")

    @property
    def follows(self) -> bool:
        """Whether another message before it says the cause."""
        return bool(self.known) and not self.roots

    @property
    def speaker(self) -> str:
        """The program, or the build, whose later failures follow from the first."""
        return self.message.process or self.message.logger or self.message.package

    def answer(self, output: str, placed: PlacedAnswer, relation: _Relation) -> LogAnswer:
        """Return what is said of it with a place."""
        text = cut(self.message.text, _MAX_TEXT)
        where = placed.location
        return LogAnswer(self.message.line, text, output, placed.text, where, placed.code, relation)


def explain_log(
    opened: OpenedWorkspace, problems: Sequence[Problem], log: bytes
) -> tuple[LogAnswer, ...]:
    """Return what the files of a workspace say of a log: what they explain first.

    Args:
        opened: The workspace.
        problems: Its findings, of packages and of robots.
        log: The bytes of the log.
    """
    messages = read_messages(log)
    reading = _LogReading(opened, problems, messages)
    asked = list(_list_asked(messages))
    answers, rest = reading.explain_roots(asked)
    if not answers:  # else what follows, and warnings, need no cause of their own
        for each in asked:
            answers += reading.explain(each, each.known) if each.follows else reading.place(each)
    has_places = bool(answers)
    told = rest if rest or answers else asked
    told = [each for each in told if each.known or _is_failure(each.message)]
    for each in told[:_MAX_UNKNOWN]:
        answers += reading.tell(each, with_names=not has_places)
    return tuple(_list_distinct(answers)[:_MAX_ANSWERS])


def _list_distinct(answers: Iterable[LogAnswer]) -> list[LogAnswer]:
    """Return answers without those that say the same again; each unknown message is one."""
    distinct: dict[tuple[object, str], LogAnswer] = {}
    for answer in answers:
        is_known = answer.location is not None or answer.output
        said = answer.location if is_known else answer.line
        distinct.setdefault((said, answer.message), answer)
    return list(distinct.values())


def _list_asked(messages: Iterable[LogMessage]) -> Iterator[_Asked]:
    """Yield the messages that are known, or that something fails or warns, each once."""
    seen = set()
    for message in messages:
        if (message.process, message.text) in seen:
            continue
        seen.add((message.process, message.text))
        known = list(_list_known(message))
        if known or _is_failure(message) or _WARNING.search(message.severity + message.text):
            yield _Asked(message, known)


@cache
def known_rows() -> tuple[OutputRow, ...]:
    """Return what the terminal prints where rules are broken, then the other known messages."""
    rows: dict[str, OutputRow] = {}
    for rule in RULES.values():
        for symptom in rule.symptoms:
            row = rows.get(symptom.name) or OutputRow(**symptom._asdict(), is_place_last=True)
            rows[symptom.name] = row._replace(rules=(*row.rules, rule.name))
    return (*rows.values(), *known_outputs())


def _list_known(message: LogMessage) -> Iterator[KnownMessage]:
    """Yield the rows that know a message."""
    for row in known_rows():
        match = row.compiled.search(message.text)
        if match:
            groups = {name: value or "" for name, value in match.groupdict().items()}
            groups["logger"] = message.logger
            yield KnownMessage(message, row, groups)


def _is_failure(message: LogMessage) -> bool:
    """Return whether a message says that something fails."""
    if message.severity:
        return message.severity in ("ERROR", "FATAL", "CRITICAL")
    return message.is_traceback or _FAILURE.search(message.text) is not None


class _LogReading:
    """What the files of a workspace say of messages."""

    def __init__(
        self, opened: OpenedWorkspace, problems: Sequence[Problem], messages: Sequence[LogMessage]
    ) -> None:
        self._opened = opened
        self._findings = LogFindings(opened, problems, messages)
        self._paths = LogPaths(opened)
        self._names = LogNames(opened)

    def explain_roots(self, asked: Iterable[_Asked]) -> tuple[list[LogAnswer], list[_Asked]]:
        """Return what explains the messages that follow from no other one, and those unexplained.

        What a program says after its first explained failure follows from that.
        """
        answers = []
        rest = []
        settled = set()  # the speakers whose first failure has an answer
        for each in asked:
            is_failure = _is_failure(each.message)
            answered = list(self.explain(each, each.roots))
            if not answered and is_failure and each.speaker not in settled:
                answered = list(self.place(each))
            if answered and is_failure:
                settled.add(each.speaker)
            elif not answered and not each.follows and each.speaker not in settled:
                rest.append(each)
            answers += answered
        return answers, rest

    def explain(self, asked: _Asked, known: Iterable[KnownMessage]) -> Iterator[LogAnswer]:
        """Yield what explains a message: places that its rows name, and findings."""
        answers = list[LogAnswer]()
        for each in known:
            is_explained = any(answer.code for answer in answers)
            for place in self._list_places(each, is_explained=is_explained):
                answers.append(asked.answer(each.row.name, place, "explains"))
        yield from answers[:_MAX_OF_A_MESSAGE]

    def _list_places(self, known: KnownMessage, *, is_explained: bool) -> Sequence[PlacedAnswer]:
        """Return what a row says of a message, which another one may have explained by findings."""
        row = known.row
        if row.processes and not self._is_started(row.processes):
            return ()
        problems = self._findings.explaining(known)
        placed = []
        if not (row.is_place_last and (problems or is_explained)):
            placed = self._search(known)
        placed = placed or list(map(PlacedAnswer.of_problem, problems))
        kept = self._findings.keep_meant(placed)
        # Without names in it, a message is of the packages that the log is of.
        return kept if kept or not row.within else placed

    def place(self, asked: _Asked) -> Iterator[LogAnswer]:
        """Yield the first line of the workspace that a message names, with the findings there."""
        places = list(self._paths.named_in(asked.message))
        if not places:
            return
        place, rest = places[-1 if asked.message.is_traceback else 0]
        problems = [each for each in self._findings.at(place) if each.severity != "note"]
        for problem in problems[:_MAX_OF_A_MESSAGE]:
            yield asked.answer(asked.output, PlacedAnswer.of_problem(problem), "explains")
        if not problems:
            text = cut(rest, _MAX_TEXT) or "the message names this line"
            yield asked.answer(asked.output, PlacedAnswer(place, text), "is named in")

    def tell(self, asked: _Asked, *, with_names: bool) -> Iterator[LogAnswer]:
        """Yield what is known in general of a message, and the names in it."""
        message = _UNKNOWN
        line = asked.message.line
        output = asked.output
        text = cut(asked.message.text, _MAX_TEXT)
        for each in asked.known[:1]:
            message = each.row.sentence
            if each.row.place == "frame":
                message += say_publishers(self._opened, each.groups["frame"])
        named = list[PlacedAnswer]()
        if with_names and not asked.known:
            named += self._names.named_in(asked.message, self._findings)
        if not named:
            yield LogAnswer(line, text, output, message)
        for place in named[:_MAX_OF_A_MESSAGE]:
            yield asked.answer(output, place, "see also")

    def _search(self, known: KnownMessage) -> list[PlacedAnswer]:
        """Return what the place of a row says."""
        try:
            return list(search_place(self._opened, known))
        except NotDecided:
            return []

    def _is_started(self, programs: Sequence[str]) -> bool:
        """Return whether a launch file of the workspace starts one of some programs."""
        nodes = self._opened.workspace.launches.nodes
        return any(node.executable in programs for node in nodes)
