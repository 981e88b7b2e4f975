"""Corrections that an editor offers at a problem."""

from collections.abc import Iterator

from lsprotocol import types as lsp

from grader.app.editor.look import Look
from grader.app.editor.places import TextPlace
from grader.base.source import Edit, Edits, Location
from grader.base.text import quoted
from grader.lab.hints.generators import word_edits
from grader.lab.hints.name_edits import correction_edits
from grader.lab.hints.robot_draft import Draft
from grader.ros.api import Read


def actions(look: Look, place: TextPlace, wanted: lsp.Range) -> list[lsp.CodeAction]:
    """Return the corrections of what is wrong in a range of a file."""
    ranges = place.ranges(look)
    found = []
    for title, at, edits in _offered(look, place.path):
        # Where it is wrong, and where it is written.
        places = [at, *(Location(it.path, it.line, it.column) for it in edits)]
        own = [ranges.range(it) for it in places if it.path == place.path]
        if edits and any(_overlap(it, wanted) for it in own):
            edit = ranges.workspace_edit(edits)
            found.append(lsp.CodeAction(title, lsp.CodeActionKind.QuickFix, edit=edit))
    return found


def _offered(look: Look, path: str) -> Iterator[tuple[str, Location, Edits]]:
    """Yield all corrections at places of a file, with their titles and places."""
    yield from _of_names(look, path)
    yield from _of_robots(look, path)
    yield from _of_rejected(look)
    for fix in look.graded.fixes:
        if fix.at.path == path:
            yield fix.title, fix.at, fix.edits


def _of_names(look: Look, path: str) -> Iterator[tuple[str, Location, Edits]]:
    """Yield the corrections of names that do not agree, with their titles and places."""
    for mismatch in look.names.mismatches.values():
        if mismatch.location.path == path:
            for each in mismatch.corrections:
                title = f"Change {quoted(each.old)} to {quoted(each.new)}"
                where = each.location
                if where.path != path:
                    title += f" in {where.file_and_line}"
                yield title, mismatch.location, correction_edits(look.opened.source, each)


def _of_robots(look: Look, path: str) -> Iterator[tuple[str, Location, Edits]]:
    """Yield the words of robots that surely are others, corrected."""
    for robot in look.opened.robots:
        for slip in robot.slips if isinstance(robot, Read) else ():
            if slip.location.path == path and slip.edits:
                yield _change(slip.edits[0]), slip.location, slip.edits


def _of_rejected(look: Look) -> Iterator[tuple[str, Location, Edits]]:
    """Yield the words for which ROS 2 rejects a robot, corrected."""
    for robot in look.opened.robots:
        words = robot.reading.undone if isinstance(robot, Read) else ()
        draft = Draft.of(robot.reading) if isinstance(robot, Read) and words else None
        if draft is None:
            continue
        for word in words:
            edits = word_edits(draft, word)
            if edits:
                first = edits[0]
                yield _change(first), Location(first.path, first.line, first.column), edits


def _change(edit: Edit) -> str:
    return f"Change {quoted(edit.old)} to {quoted(edit.new)}"


def _overlap(one: lsp.Range, other: lsp.Range) -> bool:
    """Return whether two ranges share a line."""
    return one.start.line <= other.end.line and other.start.line <= one.end.line
