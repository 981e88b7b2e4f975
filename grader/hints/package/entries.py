"""Entries of the lists in setup.py and launch files that the reference has: files to install, nodes to start."""

import ast
from collections.abc import Iterator, Sequence

from grader.hints.edits import Proposal
from grader.hints.package.python_file import PythonFile, keyword
from grader.hints.package.task import change
from grader.markup import indentation, indented
from grader.source import Edit

_DESCRIPTION = "LaunchDescription"
_MAX_ITEMS = 30


def missing_entries(own: PythonFile, like: PythonFile, what: str) -> Iterator[Proposal]:
    """Yield edits that add an entry of the reference's lists, or all that are missing."""
    known = {own.plain(it) for it in _items(own)}
    installed = {own.plain(it.elts[-1]) for it in _items(own) if isinstance(it, ast.Tuple) and it.elts}
    others = (it for it in _items(like) if like.plain(it) not in known)
    missing = [it for it in others if not (isinstance(it, ast.Tuple) and like.plain(it.elts[-1]) in installed)]
    several: list[str] = []
    spare = {
        _executable(own, value) or "-": name for name, value in own.values.items() if own.plain(value) not in known
    }
    for item in missing:
        code = spare.get(_executable(like, item) or "", "") or like.written(item, own.bound)
        several.append(code)
        yield from _adding(own, [code], what)
    if len(several) > 1:
        yield from _adding(own, several, what)


def as_lists(own: PythonFile, what: str) -> Iterator[Proposal]:
    """Yield edits that put the one file of an entry of data_files into a list."""
    for item in _items(own):
        files = item.elts[-1] if isinstance(item, ast.Tuple) and item.elts else None
        if isinstance(files, ast.Constant) and isinstance(files.value, str):
            yield change([own.replaced(files, f"[{own.segment(files)}]")], "a list of files", what)


def _adding(own: PythonFile, codes: Sequence[str], what: str) -> Iterator[Proposal]:
    edit = _add(own, codes)
    if edit is not None:
        needs = own.with_imports(sorted({name for code in codes for name in own.names_in(code)}))
        yield change([*needs, edit], f"a missing part of {what}")


def _executable(file: PythonFile, code: ast.expr) -> str | None:
    """Return what a node starts."""
    given = keyword(code, "executable") if isinstance(code, ast.Call) else None
    return file.plain(given.value) if given is not None else None


def _list(file: PythonFile) -> ast.expr | None:
    """Return the list of files to install, or of actions to start."""
    for call in file.calls("setup"):
        entries = keyword(call, "data_files")
        return file.meant(entries.value) if entries is not None else None
    return next((file.meant(call.args[0]) for call in file.calls(_DESCRIPTION) if call.args), None)


def _items(file: PythonFile) -> list[ast.expr]:
    """Return the entries of the list, and those that are added to it."""
    found = _list(file)
    own = found.elts if isinstance(found, ast.List) else []
    return [*map(file.meant, own), *(file.meant(it.args[0]) for it in file.calls("add_action") if it.args)][:_MAX_ITEMS]


def _add(file: PythonFile, codes: Sequence[str]) -> Edit | None:
    """Return the edit that adds code after the last entry, in lines of their own if that has one."""
    found, actions = _list(file), file.calls("add_action")
    if isinstance(found, ast.List) and not (actions and not found.elts):
        nodes: Sequence[ast.expr] = found.elts
        start, end = file.span(nodes[-1] if nodes else found)
        if not nodes:
            return file.source.edit(end - 1, end - 1, ", ".join(codes))
        before = ","
    elif actions:
        start, end = file.span(actions[-1])
        owner = file.segment(actions[-1].func)
        codes, before = [f"{owner}({code})" for code in codes], ""
    else:
        return None
    line = indentation(file.text, start)
    space = f"{file.newline}{line}" if line else " "
    return file.source.edit(end, end, "".join(f"{before}{space}{indented(it, line, file.newline)}" for it in codes))
