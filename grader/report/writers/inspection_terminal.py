"""An inspection on a terminal: each error is in its first rows.

Text of files is never interpreted as markup or control codes.
"""

from collections import Counter
from collections.abc import Iterator, Sequence
from math import inf
from os.path import commonprefix
from typing import TYPE_CHECKING

from rich.console import Console
from rich.text import Text

from grader.base.text import counted, printable
from grader.report.causes import Cause, CauseKind, group_causes, group_problems, places_text
from grader.report.inspection import (
    EFFECTS,
    NO_FAILURE,
    Inspection,
    choose_look,
    effect,
    lists,
    log_line,
    problem_counts,
    robot_line,
)
from grader.report.locations import calls_text
from grader.report.writers.terminal_page import (
    INDENT,
    SEVERITY_LOOKS,
    Page,
    block,
    count_rows,
    excerpt_block,
    shortened,
)

if TYPE_CHECKING:
    from grader.ros.api import RecordedTopic

_SCREEN = 40  # rows, in which each error is
_MAX_CAUSES = 35  # errors that have a row of their own
_MAX_EXCERPTS = 10
_MIN_MESSAGE = 24  # columns of a message that is cut, for which its place is cut
_POINTS = "..."
_LEAST_ROBOTS = 5  # rows, with the title and the one above it
_STYLES = dict(zip(EFFECTS, ("green", "yellow", "bold red", "bold red"), strict=True))
_EVERYTHING = "--verbose spells out all of it, --format concise lists each problem"


def inspection_terminal(inspection: Inspection, console: Console, *, verbose: bool = False) -> None:
    """Print the inspection, with `verbose` everything in it."""
    page = Page(console, [])
    page.inset(_head(inspection), indent=0)
    for answer in _log_lines(inspection):
        page.inset(answer)
    if inspection.log is not None and not verbose:
        _print_others(page, inspection)
        return
    remarks = [block(console, Text(remark, "dim"), 0) for remark in _remarks_on(inspection)]
    problems = _ProblemRows(inspection, console, verbose=verbose)
    # The title of problems, its empty row, that above the remarks, and the last row of problems.
    taken = page.height + sum(map(count_rows, remarks)) + problems.height + 4
    robots = list(_robot_rows(inspection, console))
    taken += sum(map(count_rows, robots[:_LEAST_ROBOTS]))
    room = _RowsLeft(inf if verbose else _SCREEN - taken)
    problems.spell_out(room)
    robots = _first_robots(robots, room)
    if inspection.problems:
        page.title("Problems")
        page.rows.extend(problems)
    if inspection.problems and remarks:
        page.leave_row()
    page.rows.extend(remarks)
    page.rows.extend(robots)
    page.rows.extend(_recording_rows(inspection, console))
    page.rows.extend(_whole_robots(inspection, console, room, verbose=verbose))
    page.print()


def _print_others(page: Page, inspection: Inspection) -> None:
    """Print below what explains a log how many other problems there are, so that none is taken."""
    said = {(answer.location, answer.message) for answer in inspection.log or ()}
    others = [each for each in inspection.problems if (each.location, each.message) not in said]
    if others:
        page.title("Problems")
        page.inset(f"{counted(len(others), 'other problem')}: without --log (or with --verbose)")
        page.leave_row()
    for remark in _remarks_on(inspection):
        page.inset(Text(remark, "dim"), indent=0)
    page.print()


def _head(inspection: Inspection) -> Text:
    """Return what ROS 2 does with a robot on its own, else how many problems there are."""
    style = _STYLES[choose_look(inspection)]
    robot = inspection.robot
    if not inspection.extent and robot:
        path = printable(robot.path)
        name = f", {printable(robot.name)}"
        return Text.assemble((path, "bold"), ": ", (effect(inspection), style), name)
    if not inspection.is_passed:
        style = _STYLES["rejected"]
    path = printable(inspection.path)
    return Text.assemble((path, "bold"), ": ", (problem_counts(inspection), style))


def _log_lines(inspection: Inspection) -> Iterator[str]:
    """Yield what is said of a log, a line for each message."""
    if inspection.log is None:
        return
    if not inspection.log:
        yield NO_FAILURE
    yield from map(log_line, inspection.log)


def _remarks_on(inspection: Inspection) -> Iterator[str]:
    """Yield what is known of releases and of driving, and how many problems are not shown."""
    shown = inspection.robot
    if inspection.extent:
        yield inspection.extent.words
    if shown and shown.driving:
        yield printable(shown.driving)
    if inspection.ignored:
        yield f"{inspection.ignored} ignored"
    if inspection.known:
        yield f"{inspection.known} known from the baseline"


def _robot_rows(inspection: Inspection, console: Console) -> Iterator[Text]:
    """Yield a row for each robot of a workspace, below a title; the only one has several rows."""
    if not inspection.extent or not inspection.robots:
        return
    is_only = len(inspection.robots) == 1
    yield Text()
    yield Text("Robot" if is_only else "Robots", "bold")
    for robot, path in zip(inspection.robots, _robot_paths(inspection, console), strict=True):
        line = robot_line(robot)
        text = Text.assemble(" " * INDENT, path, ": ", (line, _STYLES[robot.verdict]))
        yield block(console, text, 2 * INDENT, Text()) if is_only else shortened(console, text)


def _robot_paths(inspection: Inspection, console: Console) -> list[str]:
    """Return the paths of robots, of several in the room that a row has, and all different."""
    paths = [printable(robot.path) for robot in inspection.robots]
    if len(paths) == 1:
        return paths
    ends = []
    for robot, path in zip(inspection.robots, paths, strict=True):
        room = console.width - INDENT - len(robot_line(robot)) - len(": ")
        ends.append(_keep_end(path, max(room, _MIN_MESSAGE)))
    return ends if len({*ends}) == len({*paths}) else _with_difference(paths)


def _first_robots(rows: list[Text], room: "_RowsLeft") -> list[Text]:
    """Return the rows of robots; where there is no room for all, the first ones and their number.

    The first few rows are in no other room.
    """
    rest = rows[_LEAST_ROBOTS:]
    if not rest or len(rest) <= room.rows:
        room.rows -= len(rest)
        return rows
    most = _LEAST_ROBOTS + max(0, int(room.rows)) - 1
    room.rows = 0
    return [*rows[:most], Text(f"{' ' * INDENT}... and {len(rows) - most} more (--verbose)")]


def _whole_robots(
    inspection: Inspection, console: Console, room: "_RowsLeft", *, verbose: bool
) -> list[Text]:
    """Return the tree and the poses of the only robot, if asked for or where there is room.

    With `verbose` they are those of all robots.
    """
    is_only = len(inspection.robots) == 1
    if not (is_only or verbose):
        return []
    rows = []
    for robot in inspection.robots:
        path = "" if is_only else f" of {printable(robot.path)}"
        for title, lines in lists(robot):
            rows += [Text(), block(console, Text(f"{title}{path}", "bold"), 0)]
            for name, words in lines:
                rows.append(block(console, Text.assemble(name, (words, "dim")), INDENT))
    is_asked = verbose or not inspection.extent or inspection.is_posed
    if is_asked or sum(map(count_rows, rows)) <= room.rows:
        return rows
    return []


def _recording_rows(inspection: Inspection, console: Console) -> Iterator[Text]:
    """Yield what each recording shows: facts, faults and topics, below a title."""
    for recording in inspection.recordings:
        yield Text()
        yield block(console, Text(f"Recording {printable(recording.path)}", "bold"), 0)
        for text in recording.facts:
            yield block(console, Text(printable(text)), INDENT)
        for text in recording.faults:
            yield block(console, Text(printable(text), "yellow"), INDENT)
        for topic in recording.topics:
            row = Text.assemble(printable(topic.name), (f"  {describe_topic(topic)}", "dim"))
            yield block(console, row, INDENT)


def describe_topic(topic: "RecordedTopic") -> str:
    """Return what was recorded on a topic: types, messages and rates."""
    parts = [" and ".join(topic.types), counted(topic.count, "message")]
    if topic.rate is not None:
        parts.append(f"{topic.rate:.1f} Hz")
    if topic.recorder_rate is not None:
        parts[-1] += f" ({topic.recorder_rate:.1f} Hz by the recorder's clock)"
    return printable(", ".join(filter(None, parts)))


class _RowsLeft:
    """The rows of the screen that are left."""

    def __init__(self, rows: float) -> None:
        self.rows = rows

    def takes(self, old: Text, new: Text) -> bool:
        """Return whether there are rows for a text in place of another; then it takes them."""
        more = count_rows(new) - count_rows(old)
        if more > max(0, self.rows):
            return False
        self.rows -= more
        return True


class _ProblemRows:
    """The rows of problems: one for each error, and one for each kind of the others.

    `spell_out` replaces them by longer texts, as far as there is room.
    """

    def __init__(self, inspection: Inspection, console: Console, *, verbose: bool) -> None:
        self._inspection = inspection
        self._console = console
        shown = inspection.robot if not inspection.extent else None
        self._urdf = shown.reading.source.path if shown else ""
        causes = group_problems(inspection.problems, with_other_messages=not verbose)
        errors = [cause for cause in causes if cause.problem.severity == "error"]
        self._kinds = group_causes(causes[len(errors) :])
        most = _MAX_CAUSES
        self._most_excerpts = _MAX_EXCERPTS
        if verbose:
            most = self._most_excerpts = len(errors)
        self._errors = errors[:most]
        self._rest = errors[most:]
        self._error_texts = [self._in_a_row(cause) for cause in self._errors]
        self._kind_texts = [self._kind_in_a_row(kind) for kind in self._kinds]
        self._is_cut = bool(self._rest)

    @property
    def height(self) -> int:
        """How many rows there are at least, without the last one."""
        return len(self._error_texts) + len(self._kind_texts) + bool(self._rest)

    def __iter__(self) -> Iterator[Text]:
        """Iterate over the texts."""
        yield from self._error_texts
        if self._rest:
            count = sum(len(cause.problems) for cause in self._rest)
            words = counted(count, "more error")
            yield Text(f"{' ' * INDENT}... and {words} (--verbose)", SEVERITY_LOOKS["error"])
        yield from self._kind_texts
        if self._is_cut:
            yield shortened(self._console, Text(f"{' ' * INDENT}{_EVERYTHING}", "dim"))

    def spell_out(self, room: _RowsLeft) -> None:
        """Replace rows by whole messages of errors, their places and lines, then the others."""
        wholes = [self._whole(cause) for cause in self._errors]
        for index, whole in enumerate(wholes):
            self._replaces(index, self._begun(self._errors[index], whole), room)
        complete = list[int]()
        placed = list[int]()
        for index, whole in enumerate(wholes):
            if self._replaces(index, whole, room):
                complete.append(index)
        for index in complete:
            if self._replaces(index, self._with_places(self._errors[index]), room):
                placed.append(index)
        for index in placed[: self._most_excerpts]:
            text = self._with_excerpt(self._errors[index], self._error_texts[index])
            self._replaces(index, text, room)
        self._is_cut = len(placed) < len(self._errors) or bool(self._rest)
        self._spell_out_kinds(room)

    def _replaces(self, index: int, text: Text, room: _RowsLeft) -> bool:
        """Replace the text of an error if there are rows for the new one; return whether."""
        if not room.takes(self._error_texts[index], text):
            return False
        self._error_texts[index] = text
        return True

    def _spell_out_kinds(self, room: _RowsLeft) -> None:
        for index, kind in enumerate(self._kinds):
            if len(kind.causes) > room.rows + 1:
                self._is_cut = True
                continue
            text = Text("\n").join(map(self._with_places, kind.causes))
            if room.takes(self._kind_texts[index], text):
                self._kind_texts[index] = text
            else:
                self._is_cut = True

    def _in_a_row(self, cause: Cause) -> Text:
        """Return an error in one row; a long path without its start."""
        head = _write_label(cause)
        message = printable(cause.problem.message)
        head.append(f"{cause.problem.rule} ".lstrip())
        more = f" and {len(cause.others)} more" if cause.others else ""
        room = self._console.width - len(head) - len(more) - _MIN_MESSAGE
        where = _keep_end(self._write_line(cause), room)
        text = Text.assemble(head, (f"{where}{more}: ", "dim"), message)
        return shortened(self._console, text)

    def _kind_in_a_row(self, kind: CauseKind) -> Text:
        """Return how many warnings or notes of a kind there are, and of which rules."""
        counts: Counter[str] = Counter()
        for cause in kind.causes:
            counts[cause.problem.rule] += len(cause.problems)
        rules = ", ".join(f"{name} {count}" for name, count in counts.items() if name)
        text = f"{kind.total}: {rules}"
        if len(counts) == 1:
            text = f"{kind.problem.rule} {kind.total}: {kind.problem.kind.title}".lstrip()
        return shortened(self._console, Text.assemble(_write_label(kind), text))

    def _whole(self, cause: Cause) -> Text:
        """Return a problem with its whole message."""
        return self._inset(cause, self._place(cause))

    def _begun(self, cause: Cause, whole: Text) -> Text:
        """Return the first two rows of a problem, without that of its code if it is alone there."""
        lines = list(whole.split("\n"))
        most = 3 if len(lines[0]) < len(_write_label(cause)) else 2
        if len(lines) <= most:
            return whole
        last = lines[most - 1][: self._console.width - len(_POINTS)].append(_POINTS)
        return Text("\n").join([*lines[: most - 1], last])

    def _with_places(self, cause: Cause) -> Text:
        """Return a problem with all of its places."""
        if not cause.others:
            return self._whole(cause)
        text = self._inset(cause, self._place(cause._replace(problems=cause.problems[:1])))
        files = list(places_text(cause.others, self._urdf))
        places = "; ".join(files)
        longest = max(len(file.split(" ")[0]) for file in files)
        words = "also at" if cause.is_repeated else "likewise at"
        indent = " " * len(_write_label(cause))
        if longest >= self._console.width - len(indent):
            indent = " " * (2 * INDENT)
        below = block(self._console, Text(f"{words} {places}", "dim"), len(indent), Text(indent))
        return text + Text("\n") + below

    def _with_excerpt(self, cause: Cause, text: Text) -> Text:
        """Return the text of an error with the line of its source, if that can be read."""
        at = cause.problem.location
        source = self._inspection.source(at.path)
        if not source:
            return text
        indent = min(len(_write_label(cause)), self._console.width // 5)
        return text + Text("\n") + excerpt_block(self._console, source, at, indent)

    def _inset(self, cause: Cause, where: str) -> Text:
        """Return a message behind its code and place, or below the code if the place is long."""
        console = self._console
        head = _write_label(cause)
        rule = f"{cause.problem.rule} ".lstrip()
        text = Text.assemble(rule, (where, "dim"), printable(cause.problem.message))
        if len(where.split(" ", maxsplit=1)[0]) < console.width - len(head):
            return block(console, text, len(head), head)
        below = " " * (2 * INDENT)
        head.rstrip()
        return head + Text("\n") + block(console, text, len(below), Text(below))

    def _place(self, cause: Cause) -> str:
        """Return the first place of a cause, and how many others there are."""
        place = _keep_end(self._write_line(cause), self._console.width - 2 * INDENT - 1)
        others = len(cause.others)
        more = f" and {counted(others, 'more place')}" if others else ""
        return f"{place}{calls_text(cause.problem.location)}{more}: "

    def _write_line(self, cause: Cause) -> str:
        at = cause.problem.location
        file = "line " if at.path == self._urdf else f"{printable(at.path)}:"
        return f"{file}{at.line}"


def _keep_end(text: str, most: int) -> str:
    """Return a text of at most so many columns: of a longer one the end."""
    if len(text) <= most:
        return text
    return _POINTS + text[len(text) - most + len(_POINTS) :]


def _with_difference(paths: Sequence[str]) -> list[str]:
    """Return the names of files, each with the first folders in which their paths differ."""
    start = commonprefix(paths).rfind("/") + 1  # noqa: RUF071  the last slash ends a folder
    shown = []
    for path in paths:
        folders, _, name = path[start:].rpartition("/")
        if len(folders) > _MIN_MESSAGE:
            folders = f"{folders[: _MIN_MESSAGE - len(_POINTS)]}{_POINTS}"
        shown.append(f"{folders}/{name}".lstrip("/"))
    return shown


def _write_label(shown: Cause | CauseKind) -> Text:
    """Return the code and the severity."""
    problem = shown.problem
    name = f"{problem.code} {problem.severity} "
    return Text.assemble(" " * INDENT, (name, SEVERITY_LOOKS[problem.severity]))
