"""Corrections that an editor offers at a problem, and how to ignore it."""

from collections import Counter
from collections.abc import Iterable, Iterator
from typing import NamedTuple

from lsprotocol.types import CodeAction, CodeActionKind, Range

from grader.app.editor.look import Look
from grader.app.editor.places import TextPlace
from grader.base.element_edits import edit_files
from grader.base.ignore_comments import ignoring_edit
from grader.base.slips import Slip
from grader.base.source import Edit, Edits, Location
from grader.base.text import cut, quoted
from grader.files.reading import URDF_LIMIT
from grader.files.tree import Tree, overlaid
from grader.report.findings import Finding
from grader.ros.api import Read, package_slips

_MAX_SHOWN = 60  # characters of a text in a title
_MAX_TRIED = 8  # corrections


class _Offered(NamedTuple):
    """A correction, with what it is called and where it is offered."""

    title: str
    at: Location
    edits: Edits
    is_certain: bool = False


def actions(look: Look, place: TextPlace, wanted: Range) -> list[CodeAction]:
    """Return what can be done about what is wrong in a range of a file.

    These are the corrections, each tried on a copy, those of all problems of the same rule in the
    file, and comments that ignore the problems.
    """
    ranges = place.ranges(look)

    def is_wanted(where: Location) -> bool:
        return where.path == place.path and _overlap(ranges.range(where), wanted)

    here = [one for one in look.findings if is_wanted(one.location)]
    corrections = []
    for each in _corrections(look, place.path):
        # Where it is wrong, and where it is written.
        if is_wanted(each.at) or any(is_wanted(edit.location) for edit in each.edits):
            corrections.append(each)
    offered = [each for each in corrections[:_MAX_TRIED] if _is_sound(look, each.edits)]
    offered += _of_whole_file(look, place.path, here)
    offered += _ignoring(look, here)
    made = []
    for title, _, edits, is_certain in offered:
        action = CodeAction(title, CodeActionKind.QuickFix, is_preferred=is_certain)
        action.edit = ranges.workspace_edit(edits)
        made.append(action)
    return made


def _corrections(look: Look, path: str) -> Iterator[_Offered]:
    """Yield all corrections at places of a file, with their titles and places."""
    known: dict[Edits, _Offered] = {}
    for finding in look.findings:
        if finding.location.path == path:
            for fix in finding.fixes:
                if fix.edits:
                    title = _title(fix.edits[0], path)
                    one = _Offered(title, finding.location, fix.edits, fix.is_certain)
                    known.setdefault(fix.edits, one)
    for slip in _slips_in(look, path):
        one = _Offered(_title(slip.edits[0], path), slip.location, slip.edits, is_certain=True)
        known.setdefault(slip.edits, one)
    yield from known.values()
    for proven in look.graded.fixes:
        if proven.at.path == path:
            yield _Offered(proven.title, proven.at, proven.edits)


def _slips_in(look: Look, path: str) -> Iterator[Slip]:
    """Yield the slips of robots and packages in a file.

    Of some, such as a tag without the prefix of xacro, ROS 2 reports no problem.
    """
    slips = [
        slip for robot in look.opened.robots if isinstance(robot, Read) for slip in robot.slips
    ]
    for package in look.opened.packages:
        if package.holds(path):
            slips += package_slips(package)
    yield from (slip for slip in slips if slip.location.path == path and slip.edits)


def _is_sound(look: Look, edits: Edits) -> bool:
    """Return whether edits cause no problem: in no file, there are more of any rule than before."""
    tree = apply_edits(look, edits)
    if not tree:
        return False
    before, after = (_count(each.findings) for each in (look, look.again(tree)))
    return all(count <= before[rule] for rule, count in after.items())


def _count(findings: Iterable[Finding]) -> Counter[tuple[str, str, str]]:
    return Counter((each.rule.id, each.rule.name, each.location.path) for each in findings)


def apply_edits(look: Look, edits: Iterable[Edit]) -> Tree | None:
    """Return the files of a look after edits; None where these overlap."""
    files = edit_files(lambda path: look.tree.read(path, URDF_LIMIT), edits)
    return overlaid(look.tree, files) if files is not None else None


def _of_whole_file(look: Look, path: str, here: Iterable[Finding]) -> Iterator[_Offered]:
    """Yield the corrections of all problems of a rule in a file, where it has several."""
    for rule, first in {one.rule: one for one in here}.items():
        edits = {}
        count = 0
        for one in look.findings:
            fix = next(iter(one.fixes), None)
            if one.rule == rule and one.location.path == path and fix:
                count += 1
                edits.update(dict.fromkeys(fix.edits))
        if count > 1 and _is_sound(look, tuple(edits)):
            yield _Offered(f"Fix all of {rule.label} in this file", first.location, tuple(edits))


def _ignoring(look: Look, here: Iterable[Finding]) -> Iterator[_Offered]:
    """Yield the comments that ignore problems where they are, by the names of their rules."""
    for name, one in {each.rule.name or each.rule.id: each for each in here}.items():
        source = look.opened.source(one.location.path)
        edit = ignoring_edit(source, one.location, name) if source else None
        if edit:
            yield _Offered(f"Ignore {name} here", one.location, (edit,))


def _title(edit: Edit, path: str) -> str:
    """Return what an edit changes, with the place of one in another file than the problem."""
    old, new = (quoted(cut(text.strip(), _MAX_SHOWN)) for text in (edit.old, edit.new))
    title = f"Change {old} to {new}" if edit.old else f"Add {new}"
    if not edit.new.strip():
        title = f"Remove {old}"
    if edit.path != path:
        return f"{title} in {edit.path}:{edit.line}"
    return title


def _overlap(one: Range, other: Range) -> bool:
    """Return whether two ranges share a line."""
    return one.start.line <= other.end.line and other.start.line <= one.end.line
