"""Renaming that is proven: it is tried on a copy, which is inspected, before it is offered."""

import re
from collections import Counter
from collections.abc import Mapping, Sequence

from lsprotocol import types as lsp
from pygls.exceptions import JsonRpcInvalidParams

from grader.app.editor.look import Look, look_at
from grader.app.editor.names_at import NamePlace, places_of
from grader.app.editor.places import TextPlace
from grader.base.element_edits import edited
from grader.base.reuse import Memory
from grader.base.source import Edit
from grader.base.text import counted
from grader.files.tree import overlaid
from grader.report.findings import Finding
from grader.ros.workspace.names import Definition, Use

_VALID = re.compile(r"[\w~/.-]+")
_MOST = 20_000


class CannotRename(JsonRpcInvalidParams):
    """Why a name is not renamed: the editor shows the reason."""


def prepared(look: Look, place: TextPlace) -> lsp.Range | None:
    """Return the range of the name at a place, if it can be renamed. Raises CannotRename."""
    found = place.name(look)
    if found is None:
        return None
    if found.written is None:
        raise CannotRename(_made(found))
    return place.ranges(look).range(found.written)


def renamed(look: Look, place: TextPlace, new: str) -> lsp.WorkspaceEdit | None:
    """Return the edits that give a name at a place another text, everywhere. Raises CannotRename
    where the renamed files would not be as right as they are.
    """
    found = place.name(look)
    if found is None:
        return None
    if not _VALID.fullmatch(new):
        raise CannotRename(f"{new!r} is no name: use letters, digits and underscores")
    same = look.names.same(found.fact)
    _check_free(look, found.fact, new)
    edits = _edits(look, same, new)
    files = {path: _edited(look, path, of_file) for path, of_file in edits.items()}
    _check_result(look, place, found.fact, new, files)
    return place.ranges(look).workspace_edit(it for of_file in edits.values() for it in of_file)


def _check_free(look: Look, fact: Definition | Use, new: str) -> None:
    """Raise CannotRename if another thing of the same kind has the name."""
    for other in look.names.same(fact._replace(name=new)):
        if isinstance(other, Definition):
            where = other.location.file_and_line
            raise CannotRename(f"there is a {other.kind} {new!r} already, at {where}")


def _edits(look: Look, facts: Sequence[Definition | Use], new: str) -> dict[str, list[Edit]]:
    """Return the edit of each place that writes a name, by files. Raises CannotRename for one that
    is made of parts.
    """
    edits: dict[str, dict[tuple[int, int], Edit]] = {}
    for place in places_of(look, facts):
        at = place.written
        if at is None:
            raise CannotRename(_made(place))
        edit = Edit(at.path, at.line, at.column, place.fact.name, new)
        edits.setdefault(at.path, {})[at.line, at.column] = edit
    return {path: [of_file[key] for key in sorted(of_file)] for path, of_file in edits.items()}


def _made(place: NamePlace) -> str:
    where = place.whole.file_and_line
    return f"{where} makes the name {place.fact.name!r} of parts: change it there"


def _edited(look: Look, path: str, edits: Sequence[Edit]) -> str:
    source = look.opened.source(path)
    assert source is not None  # a name was found in it
    text = edited(source.text, path, edits)
    if text is None:
        raise CannotRename(f"the places in {path} overlap")
    return text


def _check_result(
    look: Look,
    place: TextPlace,
    fact: Definition | Use,
    new: str,
    files: Mapping[str, str],
) -> None:
    """Raise CannotRename if the renamed files have a problem that they did not have, or if some
    place still has the old name.
    """
    data = {path: text.encode("utf-8", "surrogatepass") for path, text in files.items()}
    tree = overlaid(look.tree, data)
    after = look_at(tree, place.root, look.settings, Memory(_MOST))
    before = Counter(_identity(finding, fact.name, new) for finding in look.findings)
    for finding in after.findings:
        identity = _identity(finding, fact.name, new)
        if not before[identity]:
            where = finding.location.file_and_line
            raise CannotRename(f"it would be wrong in {where}: {finding.message}")
        before[identity] -= 1
    left = after.names.same(fact)
    if left:
        where = left[0].location.file_and_line
        raise CannotRename(f"{where} and {counted(len(left), 'place')} would keep the old name")
    if len(after.names.same(fact._replace(name=new))) != len(look.names.same(fact)):
        raise CannotRename("not every place that means this name is known")


def _identity(finding: Finding, old: str, new: str) -> tuple[str, str, str]:
    """Return what identifies a finding before and after a renaming."""
    return finding.rule.id, finding.location.path, finding.message.replace(old, new)
