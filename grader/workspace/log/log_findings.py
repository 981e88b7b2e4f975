"""The findings of rules that a message of a log means: their names, files and lines agree."""

import re
from collections.abc import Iterator, Sequence
from contextlib import suppress

from grader.base.errors import NotDecided
from grader.base.problems import Problem
from grader.base.source import Location
from grader.ros.package.package import Package
from grader.ros.package.robot_file import Read
from grader.workspace.log.known_messages import KnownMessage, PlacedAnswer
from grader.workspace.log.log_messages import LogMessage
from grader.workspace.log.log_places import paths_of_publishers
from grader.workspace.opening.opened import OpenedWorkspace
from grader.workspace.rules.name_fixes import NameFixes

_SEVERITIES = ("error", "warning", "note")
_OF_FILES = ("file", "folder")  # groups that the path of a finding may have
_LINE = "line"  # the group that is the line of a finding


class LogFindings:
    """The findings of a workspace, for the messages of a log."""

    def __init__(
        self, opened: OpenedWorkspace, problems: Sequence[Problem], messages: Sequence[LogMessage]
    ) -> None:
        self._opened = opened
        self._problems = sorted(problems, key=lambda problem: _SEVERITIES.index(problem.severity))
        self._ends = NameFixes(opened.workspace)
        self._meant = list(_list_meant(opened, messages))

    def explaining(self, known: KnownMessage) -> list[Problem]:
        """Return the findings of the rules of a row that have the names of a message.

        What keeps a node from publishing a frame is in its parameters.
        """
        paths = frozenset[str]()
        if known.row.place == "frame":
            with suppress(NotDecided):
                paths = paths_of_publishers(self._opened, known.groups["frame"])
        problems = self._problems
        if known.row.is_of_robot:
            problems = list(self._rejections_of_started())
        fitting = []
        for problem in problems:
            if not any(problem.is_meant_by(rule) for rule in known.row.rules):
                continue
            if problem.location.path in paths or self._has_names(problem, known):
                fitting.append(problem)
        return fitting

    def keep_meant(self, answers: Sequence[PlacedAnswer]) -> Sequence[PlacedAnswer]:
        """Return the answers in the packages that the log is of.

        If it is not known of which it is, of several only what certainly fails counts.
        """
        if self._meant:
            paths = tuple(package.path("") for package in self._meant)
            return [each for each in answers if each.location.path.startswith(paths)]
        launching = {package.name for package, _ in self._opened.workspace.launches.roots}
        if len(launching) > 1:
            return [each for each in answers if each.is_certain]
        return answers

    def at(self, place: Location) -> Iterator[Problem]:
        """Yield the findings at a line, and those in a call or element that begins there."""
        for problem in self._problems:
            for at in (problem.location, problem.around):
                if at and at[:2] == place[:2]:
                    yield problem
                    break

    def naming(self, word: str) -> Iterator[Problem]:
        """Yield the findings about a name."""
        for problem in self._problems:
            if word in (problem.subject, *problem.names):
                yield problem

    def _rejections_of_started(self) -> Iterator[Problem]:
        """Yield for what robot_state_publisher reads no robot of those that launch files start."""
        workspace = self._opened.workspace
        started = set()
        for launch in workspace.launches.every:
            for named in launch.named("urdf"):
                started.add(workspace.installed.find_source(named.path or ""))
        paths = set[str]()
        for robot in self._opened.robots:
            if isinstance(robot, Read) and robot.path in started:
                paths.update((robot.path, *getattr(robot.reading.source, "documents", ())))
        for problem in self._problems:
            is_rejection = problem.kind.effect == "rejects" and problem.location.path in paths
            if is_rejection or problem.rule:
                yield problem

    def _has_names(self, problem: Problem, known: KnownMessage) -> bool:
        """Return whether a finding, or the lines that it names, have the names of a message."""
        groups = {group: known.groups[group] for group in known.row.within}
        if groups.pop(_LINE, str(problem.location.line)) != str(problem.location.line):
            return False
        words = "\n".join(self._texts(problem))
        path = problem.location.path
        for group, name in groups.items():
            # The path of a finding of a rule has the package, which need not be what it is about.
            text = f"{words}\n{path}" if group in _OF_FILES or not problem.rule else words
            if not re.search(rf"(?<![\w-]){re.escape(name)}(?![\w-])", text):
                return False
        return True

    def _texts(self, problem: Problem) -> Iterator[str]:
        """Yield what a finding is about, and the text of its places."""
        yield from (problem.subject, *problem.names)
        for place in (problem.location, problem.around, problem.related):
            source = self._opened.source(place.path) if place else None
            if not place or not source:
                continue
            start = source.start_offset(place)
            end = self._ends.end_of_element(source, place, start)
            yield from (source.line(place.line), source.text[start:end])


def _list_meant(opened: OpenedWorkspace, messages: Sequence[LogMessage]) -> Iterator[Package]:
    """Yield the packages that a log names or whose programs it has, and those that they name."""
    text = "\n".join(f"/{message.package} {message.text}" for message in messages)
    started = _count_started(opened, {message.process for message in messages} - {""})
    most = max([1, *started.values()])
    meant = []
    for package in opened.packages:
        if started.get(package.name) == most or _names(text, package):
            meant.append(package)
    yield from meant
    for package in meant:
        for source in opened.workspace.texts.launch_sources(package):
            yield from (other for other in opened.packages if _names(source.text, other))


def _count_started(opened: OpenedWorkspace, processes: set[str]) -> dict[str | None, int]:
    """Return how many of some programs a launch file of each package starts at most."""
    started: dict[str | None, int] = {}
    for package, launch in opened.workspace.launches.roots:
        count = len(processes & {node.executable for node in launch.nodes})
        started[package.name] = max(count, started.get(package.name, 0))
    return started


def _names(text: str, package: Package) -> bool:
    """Return whether a text has the name of a package in a path or in quotes."""
    return re.search(rf"[/'\"]{re.escape(package.name or '?')}(?![\w-])", text) is not None
