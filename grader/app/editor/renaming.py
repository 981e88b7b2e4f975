"""Renaming that is proven: it is tried on a copy, which is inspected, before it is offered."""

import re
from collections import Counter
from collections.abc import Collection, Mapping

from lsprotocol import types as lsp
from pygls.exceptions import JsonRpcInvalidParams

from grader.app.editor.look import Look
from grader.app.editor.places import TextPlace
from grader.base.element_edits import edited
from grader.base.source import Edit, Location
from grader.base.text import counted
from grader.files.tree import Tree, overlaid
from grader.report.findings import Finding
from grader.workspace.api import WrittenName

_VALID = re.compile(r"[\w~/.-]+")
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


def prepared(look: Look, place: TextPlace) -> lsp.Range | None:
    """Return the range of the name at a place, if it can be renamed. Raises CannotRenameError."""
    name = look.names.at(*place.triple)
    if name is None:
        return None
    _check_kind(name)
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


def renamed(look: Look, place: TextPlace, new: str) -> lsp.WorkspaceEdit | None:
    """Return the edits that give the name at a place another text, everywhere.

    Raises CannotRenameError where something would be wrong then that is not wrong now, or where a
    use of the name may be left.
    """
    name = look.names.at(*place.triple)
    if name is None:
        return None
    _check_kind(name)
    if name.kind in _WITH_NAMESPACES:
        new = new.removeprefix("/")
    if not _VALID.fullmatch(new):
        raise CannotRenameError(f"{new!r} is no name: use letters, digits and underscores")
    same = look.names.same(name)
    _check_places(look, name, same, new)
    edits: dict[tuple[str, int, int], Edit] = {}
    for other in same:
        at = other.location
        if other.is_made:
            raise CannotRenameError(_made(at, name.name))
        edits[at.path, at.line, at.column] = Edit(at.path, at.line, at.column, name.name, new)
    after = look.again(_with(look, edits))
    _check_uses(look, after, same, new)
    _check_problems(look, after)
    return place.ranges(look).workspace_edit(edits[key] for key in sorted(edits))


def _check_kind(name: WrittenName) -> None:
    """Raise CannotRenameError for what is more than a word in files."""
    reason = _NOT_RENAMED.get(name.kind)
    if reason is not None:
        raise CannotRenameError(f"a {name.kind} is not renamed here: {reason}")


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


def _with(look: Look, edits: Mapping[tuple[str, int, int], Edit]) -> Tree:
    """Return the files of a look after edits. Raises CannotRenameError where these overlap."""
    files: dict[str, bytes | None] = {}
    for path in {path for path, _, _ in edits}:
        source = look.opened.source(path)
        assert source is not None  # a name was found in it
        text = edited(source.text, path, (edit for edit in edits.values() if edit.path == path))
        if text is None:
            raise CannotRenameError(f"the places in {path} overlap")
        files[path] = text.encode("utf-8", "surrogatepass")
    return overlaid(look.tree, files)


def _check_problems(look: Look, after: Look) -> None:
    """Raise CannotRenameError if there is a problem that there was not; lines stay the same."""
    before = Counter(_identity(finding) for finding in look.findings)
    for finding in after.findings:
        identity = _identity(finding)
        before[identity] -= 1
        if before[identity] < 0:
            where = finding.location.file_and_line
            raise CannotRenameError(f"this would cause a problem at {where}: {finding.message}")


def _identity(finding: Finding) -> tuple[str, str, int]:
    return finding.rule.id, finding.location.path, finding.location.line
