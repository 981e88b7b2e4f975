"""Renaming that is proven: it is tried on a copy, which is inspected, before it is offered."""

from collections import Counter
from collections.abc import Collection

from lsprotocol.types import Range, WorkspaceEdit
from pygls.exceptions import JsonRpcInvalidParams

from grader.app.editor.fixes import apply_edits
from grader.app.editor.look import Look
from grader.app.editor.places import TextPlace
from grader.base.patterns import on_use
from grader.base.source import Edit, Location
from grader.base.text import counted, enumerated
from grader.report.findings import Finding
from grader.workspace.api import WrittenName

_REST = on_use(r"[\w~.-]*(?:/[\w~.-]+)+")
_MAX_NAMED = 3  # places
_VALID = on_use(r"[\w~/.-]+")
_WITH_NAMESPACES = ("topic", "service", "action")  # of whose names the last part is renamed
_ELSEWHERE = "folders, builds and other packages have its name as well"
_NOT_RENAMED = {
    "package": _ELSEWHERE,
    "program": "setup.py or CMakeLists.txt makes it, and others may start it by its name",
    "file": "rename the file itself",
    "message type": _ELSEWHERE,
    "plugin": "its library has the name as well",
    "function": "use the editor's own rename for Python",
}


class CannotRenameError(JsonRpcInvalidParams):
    """Why a name is not renamed: the editor shows the reason."""


def prepared(look: Look, place: TextPlace) -> Range:
    """Return the range of the name at a place, if it can be renamed. Raises CannotRenameError."""
    name = _find_name(look, place)
    if name.is_made:
        raise CannotRenameError(_made(name.location, name.name))
    return place.ranges(look).range(name.location)


def _check_places(look: Look, name: WrittenName, same: Collection[WrittenName], new: str) -> None:
    """Raise CannotRenameError where places of a name are not known, or another has the new one."""
    if name.kind == "parameter" and all(other.role == "use" for other in same):
        raise CannotRenameError(f"no code declares the parameter {name.name!r} that is read here")
    for other in look.names.named_like(same, new):
        where = other.location.file_and_line
        raise CannotRenameError(f"there is a {other.kind} {new!r} already, at {where}")
    for computed in look.names.computed_like(same):
        where = computed.location.file_and_line
        raise CannotRenameError(f"{where} may have this {name.kind}: {computed.reason}")


def renamed(look: Look, place: TextPlace, new: str) -> WorkspaceEdit:
    """Return the edits that give the name at a place another text, everywhere.

    Raises CannotRenameError where something would be wrong then that is not wrong now, or where a
    use of the name may be left.
    """
    name = _find_name(look, place)
    if name.kind in _WITH_NAMESPACES:
        new = new.removeprefix("/")
    if not _VALID.fullmatch(new):
        raise CannotRenameError(f"{new!r} is no name: use letters, digits and underscores")
    same = look.names.same(name)
    _check_places(look, name, same, new)
    edits = {}
    for other in same:
        at = other.location
        if other.is_made:
            raise CannotRenameError(_made(at, name.name))
        edits[at.path, at.line, at.column] = Edit(at.path, at.line, at.column, name.name, new)
    tree = apply_edits(look, edits.values())
    if not tree:
        raise CannotRenameError("its places overlap")
    after = look.again(tree)
    _check_uses(look, after, same, new)
    _check_problems(look, after)
    return place.ranges(look).workspace_edit(edits[key] for key in sorted(edits))


def _find_name(look: Look, place: TextPlace) -> WrittenName:
    """Return the name at a place. Raises CannotRenameError for what is more than a word."""
    name = look.names.at(*place.triple)
    where = f"{place.path}:{place.line}"
    if not name:
        line = place.text_line
        rest = _REST.match(line, place.column - 1)
        last = rest.end() if rest else place.column
        behind = look.names.at(place.path, place.line, last)
        if behind and behind.kind in _WITH_NAMESPACES:
            reason = f"only the last part of the {behind.kind} {behind.owner!r} is renamed"
            raise CannotRenameError(f"{where}: {reason}: {behind.name!r}")
        raise CannotRenameError(f"{where}: it is not known what is named here")
    reason = _NOT_RENAMED.get(name.kind, "")
    if reason:
        others = [one.location.file_and_line for one in look.names.same(name)]
        named = enumerated(dict.fromkeys(others), _MAX_NAMED)
        raise CannotRenameError(
            f"a {name.kind} is not renamed here: {reason}; it is named at {named}"
        )
    return name


def _check_uses(look: Look, after: Look, same: Collection[WrittenName], new: str) -> None:
    """Raise CannotRenameError if a use keeps the old name, or something else gets the new one."""
    old = next(iter(same)).name
    left = after.names.named_like(same, old)
    if left:
        where = left[0].location.file_and_line
        message = f"{counted(len(left), 'place')} would keep the old name, the first at {where}"
        raise CannotRenameError(message)
    if len(after.names.named_like(same, new)) != len(same):
        raise CannotRenameError("not all places that use this name are known")
    kind = next(iter(same)).kind
    expected = look.names.graph_under(kind, same, new)
    launched = after.names.graph_under(kind, (), "")
    for row in (launched - expected) or (expected - launched):
        where = row[0].rpartition(" ")[2]
        message = f"not all places that use this name are known: {where} would have {row[-1]!r}"
        raise CannotRenameError(message)
    words = after.names.words_left(same)
    if words:
        where = words[0].file_and_line
        raise CannotRenameError(f"{where} would keep {old!r}: it is not known what is named there")


def _made(where: Location, name: str) -> str:
    return f"{where.file_and_line} builds the name {name!r} from parts: change it there"


def _check_problems(look: Look, after: Look) -> None:
    """Raise CannotRenameError if there is a problem that there was not; lines stay the same."""
    before = Counter(map(_identity, look.findings))
    for finding in after.findings:
        identity = _identity(finding)
        before[identity] -= 1
        if before[identity] < 0:
            where = finding.location.file_and_line
            raise CannotRenameError(f"this would cause a problem at {where}: {finding.message}")


def _identity(finding: Finding) -> tuple[str, str, int]:
    return finding.rule.id, finding.location.path, finding.location.line
