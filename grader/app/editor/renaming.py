"""Renaming that is proven: it is tried on a copy, which is inspected, before it is offered."""

import re
from collections import Counter
from collections.abc import Mapping

from lsprotocol import types as lsp
from pygls.exceptions import JsonRpcInvalidParams

from grader.app.editor.look import Look
from grader.app.editor.places import TextPlace
from grader.base.element_edits import edited
from grader.base.source import Edit, Location
from grader.base.text import counted
from grader.files.tree import Tree, overlaid
from grader.report.findings import Finding

_VALID = re.compile(r"[\w~/.-]+")


class CannotRenameError(JsonRpcInvalidParams):
    """Why a name is not renamed: the editor shows the reason."""


def prepared(look: Look, place: TextPlace) -> lsp.Range | None:
    """Return the range of the name at a place, if it can be renamed. Raises CannotRenameError."""
    name = look.names.at(*place.triple)
    if name is None:
        return None
    if name.is_made:
        raise CannotRenameError(_made(name.location, name.name))
    return place.ranges(look).range(name.location)


def renamed(look: Look, place: TextPlace, new: str) -> lsp.WorkspaceEdit | None:
    """Return the edits that give the name at a place another text, everywhere.

    Raises CannotRenameError where something would be wrong then that is not wrong now.
    """
    name = look.names.at(*place.triple)
    if name is None:
        return None
    if not _VALID.fullmatch(new):
        raise CannotRenameError(f"{new!r} is no name: use letters, digits and underscores")
    same = look.names.same(name)
    for other in look.names.named_like(same, new):
        where = other.location.file_and_line
        raise CannotRenameError(f"there is a {other.kind} {new!r} already, at {where}")
    edits: dict[tuple[str, int, int], Edit] = {}
    for other in same:
        at = other.location
        if other.is_made:
            raise CannotRenameError(_made(at, name.name))
        edits[at.path, at.line, at.column] = Edit(at.path, at.line, at.column, name.name, new)
    after = look.again(_with(look, edits))
    _check_problems(look, after)
    left = after.names.named_like(same, name.name)
    if left:
        where = left[0].location.file_and_line
        message = f"{counted(len(left), 'place')} would keep the old name, the first at {where}"
        raise CannotRenameError(message)
    if len(after.names.named_like(same, new)) != len(same):
        raise CannotRenameError("not all places that use this name are known")
    return place.ranges(look).workspace_edit(edits[key] for key in sorted(edits))


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
