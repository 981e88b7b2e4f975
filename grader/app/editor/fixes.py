"""Corrections that an editor offers at a problem."""

from collections.abc import Iterator

from lsprotocol import types as lsp

from grader.app.editor.look import Look
from grader.app.editor.places import TextPlace
from grader.base.slips import Slip
from grader.base.source import Edit, Edits, Location
from grader.base.text import cut, quoted
from grader.ros.api import Read

_MAX_SHOWN = 60  # characters of a text in a title


def actions(look: Look, place: TextPlace, wanted: lsp.Range) -> list[lsp.CodeAction]:
    """Return the corrections of what is wrong in a range of a file."""
    ranges = place.ranges(look)
    offered = []
    for title, at, edits in _offered(look, place.path):
        # Where it is wrong, and where it is written.
        places = [at, *(edit.location for edit in edits)]
        inside = [ranges.range(where) for where in places if where.path == place.path]
        if any(_overlap(each, wanted) for each in inside):
            change = ranges.workspace_edit(edits)
            offered.append(lsp.CodeAction(title, lsp.CodeActionKind.QuickFix, edit=change))
    return offered


def _offered(look: Look, path: str) -> Iterator[tuple[str, Location, Edits]]:
    """Yield all corrections at places of a file, with their titles and places."""
    at_places: dict[Edits, Location] = {}
    for finding in look.findings:
        if finding.location.path == path:
            for fix in finding.fixes:
                at_places.setdefault(fix.edits, finding.location)
    for slip in _slips_in(look, path):
        at_places.setdefault(slip.fix.edits, slip.location)
    for edits, at in at_places.items():
        if edits:
            yield _title(edits[0], path), at, edits
    for proven in look.graded.fixes:
        if proven.at.path == path:
            yield proven.title, proven.at, proven.edits


def _slips_in(look: Look, path: str) -> Iterator[Slip]:
    """Yield the slips of robots in a file.

    Of some, such as a tag without the prefix of xacro, ROS 2 reports no problem.
    """
    for robot in look.opened.robots:
        for slip in robot.slips if isinstance(robot, Read) else ():
            if slip.location.path == path:
                yield slip


def _title(edit: Edit, path: str) -> str:
    """Return what an edit changes, with the place of one in another file than the problem."""
    old, new = (quoted(cut(text.strip(), _MAX_SHOWN)) for text in (edit.old, edit.new))
    title = f"Change {old} to {new}" if edit.old else f"Add {new}"
    if edit.path != path:
        return f"{title} in {edit.path}:{edit.line}"
    return title


def _overlap(one: lsp.Range, other: lsp.Range) -> bool:
    """Return whether two ranges share a line."""
    return one.start.line <= other.end.line and other.start.line <= one.end.line
