"""What explains the messages of a log: findings of rules, and places of the workspace.

A message is explained by what the files prove of it, and of others nothing is said: names that are
alike are no proof.
"""

import re
from collections.abc import Iterator, Sequence
from contextlib import suppress
from functools import cache
from typing import NamedTuple

from grader.base.errors import NotDecided
from grader.base.problems import Problem
from grader.base.source import Location, SourceOf
from grader.base.text import cut
from grader.ros.known.output_rows import OutputRow, known_outputs
from grader.ros.package.robot_file import Read
from grader.workspace.log.log_messages import LogMessage, read_messages
from grader.workspace.log.log_places import KnownMessage, paths_of_publishers, placed_answers
from grader.workspace.opening.opened import OpenedWorkspace
from grader.workspace.rules.name_fixes import NameFixes
from grader.workspace.rules.rule_table import RULES

_MAX_ANSWERS = 40
_MAX_OF_A_MESSAGE = 2
_MAX_UNKNOWN = 5  # messages of which nothing is said
_MAX_TEXT = 200  # characters of a message that are shown
_FAILURE = re.compile(r"(?i)(?:error|fatal|exception|failed|failure)\b")


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


def explain_log(
    opened: OpenedWorkspace, problems: Sequence[Problem], log: bytes
) -> tuple[LogAnswer, ...]:
    """Return what the files of a workspace say of a log: what they explain first.

    Args:
        opened: The workspace.
        problems: Its findings, of packages and of robots.
        log: The bytes of the log.
    """
    known, unknown = list[KnownMessage](), list[LogMessage]()
    ends = NameFixes(opened.workspace)
    seen = set[tuple[str, str]]()
    for message in read_messages(log):
        if (message.process, message.text) in seen:
            continue
        seen.add((message.process, message.text))
        row_and_groups = _known(message)
        if row_and_groups is not None:
            known.append(row_and_groups)
        elif _is_failure(message):
            unknown.append(message)
    answers = list[LogAnswer]()
    roots = [each for each in known if not each.row.follows]
    asked = roots
    for each in roots:
        answers += _answers_to(opened, problems, each, ends)
    if not answers:  # else what follows needs no cause of its own
        asked = known
        for each in known:
            if each.row.follows:
                answers += _answers_to(opened, problems, each, ends)
    answered = {answer.line for answer in answers}
    unknown += [each.message for each in asked if each.message.line not in answered]
    for message in sorted(unknown, key=lambda message: message.line)[:_MAX_UNKNOWN]:
        answers.append(
            LogAnswer(message.line, cut(message.text, _MAX_TEXT), "", "no explanation is known")
        )
    return tuple(answers[:_MAX_ANSWERS])


@cache
def known_rows() -> tuple[OutputRow, ...]:
    """Return what the terminal prints where rules are broken, then the other known messages."""
    rows = []
    for rule in RULES.values():
        for symptom in rule.symptoms:
            pattern, program, source, sentence, _, within = symptom
            rows.append(
                OutputRow(rule.name, pattern, program, source, sentence, (rule.name,), within)
            )
    return (*rows, *known_outputs())


def _known(message: LogMessage) -> KnownMessage | None:
    """Return the first row that knows a message."""
    for row in known_rows():
        match = row.compiled.search(message.text)
        if match is not None:
            groups = {name: value or "" for name, value in match.groupdict().items()}
            return KnownMessage(message, row, groups)
    return None


def _is_failure(message: LogMessage) -> bool:
    """Return whether a message says that something fails."""
    if message.severity:
        return message.severity in ("ERROR", "FATAL", "CRITICAL")
    return message.is_traceback or _FAILURE.search(message.text) is not None


def _answers_to(
    opened: OpenedWorkspace, problems: Sequence[Problem], known: KnownMessage, ends: NameFixes
) -> Iterator[LogAnswer]:
    """Yield what explains a message: places that its row names, else findings."""
    line, text = known.message.line, cut(known.message.text, _MAX_TEXT)
    row = known.row
    try:
        if row.processes and not _is_started(opened, row.processes):
            return
        placed = placed_answers(opened, known)
    except NotDecided:
        placed = ()
    problems = _findings_for(opened, problems, known, ends)
    if placed and not (row.is_place_last and problems):
        for place in placed[:_MAX_OF_A_MESSAGE]:
            yield LogAnswer(line, text, row.name, place.text, place.location)
        return
    for problem in problems[:_MAX_OF_A_MESSAGE]:
        yield LogAnswer(line, text, row.name, problem.message, problem.location, problem.code)


def _is_started(opened: OpenedWorkspace, programs: Sequence[str]) -> bool:
    """Return whether a launch file of the workspace starts one of some programs."""
    return any(node.executable in programs for _, node in opened.workspace.launches.nodes)


def _findings_for(
    opened: OpenedWorkspace, problems: Sequence[Problem], known: KnownMessage, ends: NameFixes
) -> list[Problem]:
    """Return the findings of the first rule of a row that has some with the names of a message.

    What keeps a node from publishing a frame is in its parameters.
    """
    names = [known.groups[group] for group in known.row.within]
    paths = frozenset[str]()
    if known.row.place == "frame":
        with suppress(NotDecided):
            paths = paths_of_publishers(opened, known.groups["frame"])
    if known.row.is_of_robot:
        problems = [*_rejections_of_started(opened, problems)]
    for rule in known.row.rules:
        of_rule = [problem for problem in problems if problem.is_meant_by(rule)]
        fitting = []
        for problem in of_rule:
            if problem.location.path in paths or _has_names(problem, names, opened.source, ends):
                fitting.append(problem)
        if fitting:
            return fitting
    return []


def _rejections_of_started(
    opened: OpenedWorkspace, problems: Sequence[Problem]
) -> Iterator[Problem]:
    """Yield for what robot_state_publisher reads no robot of those that launch files start."""
    started: set[str | None] = set()
    for _, _, launch in opened.workspace.launches.files:
        for named in launch.named("urdf"):
            started.add(opened.workspace.installed.find_source(named.path or ""))
    paths = set[str]()
    for robot in opened.robots:
        if isinstance(robot, Read) and robot.path in started:
            paths.update((robot.path, *getattr(robot.reading.source, "documents", ())))
    for problem in problems:
        is_rejection = problem.kind.effect == "rejects" and problem.location.path in paths
        if is_rejection or problem.rule:
            yield problem


def _has_names(
    problem: Problem,
    names: Sequence[str],
    source_of: SourceOf,
    ends: NameFixes,
) -> bool:
    """Return whether a finding, or the lines that it names, have each of some names as a word."""
    texts = [problem.subject, *problem.names]
    for place in (problem.location, problem.around, problem.related):
        source = source_of(place.path) if place is not None else None
        if place is None or source is None:
            continue
        start = source.start_offset(place)
        end = ends.end_of_element(source, place, start)
        texts += [place.path, source.line(place.line), source.text[start:end]]
    words = "\n".join(texts)
    return all(re.search(rf"(?<![\w-]){re.escape(name)}(?![\w-])", words) for name in names)
