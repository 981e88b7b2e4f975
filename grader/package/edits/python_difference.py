"""The difference between two Python files: what they give to setup or LaunchDescription, part by part."""

import ast
from collections.abc import Iterator, Mapping, Sequence
from itertools import chain
from typing import NamedTuple

from grader.difference import Node, paired
from grader.edits import Proposal
from grader.package.edits.python_file import PythonFile, called, keyword
from grader.package.edits.task import Verb, change
from grader.package.edits.wording import slip
from grader.source import Edit

_ROOTS = ("setup", "LaunchDescription")
_IDENTIFYING = (
    "executable",
    "1",
    "0",
)  # arguments: of a node, else the files of an entry of data_files, else the first
_MAX_ITEMS = 100


class PythonDifference(NamedTuple):
    """A file of a student and the one of the reference; `what` is what the file is called."""

    own: PythonFile
    like: PythonFile
    what: str

    def proposals(self) -> Iterator[Proposal]:
        """Yield the edits that undo one difference each."""
        for name in _ROOTS:
            for pair in zip(self.own.calls(name), self.like.calls(name), strict=False):
                yield from self._compared(*pair, name)

    def _made(self, verb: Verb, name: str, edits: Sequence[Edit], needed: set[str] = frozenset()) -> Proposal:  # type: ignore[assignment]
        name = f"the value of `{name}`" if verb == "set" else f"`{name}`"
        return change([*self.own.with_imports(sorted(needed)), *edits], verb, name, self.what)

    def _compared(self, own: ast.expr, like: ast.expr, name: str) -> Iterator[Proposal]:
        """Yield the edits that make an expression the one of the reference: of one of its parts, else of the whole."""
        own, like = self.own.meant(own), self.like.meant(like)
        if self.own.plain(own) == self.like.plain(like):
            return
        if isinstance(own, ast.List) and isinstance(like, ast.List):
            yield from self._items(own, own.elts, like.elts, name)
            return
        mine, its = _parts(own), _parts(like)
        if _tag(own) != _tag(like) or [*filter(str.isdigit, mine)] != [*filter(str.isdigit, its)] or not (mine and its):
            if not (isinstance(own, ast.Call) and called(own) in _ROOTS):
                code, needed = self.like.written(like, self.own.bound)
                yield self._made("set", name, [self.own.replaced(own, code)], needed)
            elif isinstance(own, ast.Call):
                given = self.like.meant(like.args[0]) if isinstance(like, ast.Call) and like.args else None
                yield from self._items(own, [], given.elts if isinstance(given, ast.List) else [], name)
            return
        for part, value in its.items():
            inner = name if part.isdigit() else part
            if part in mine:
                yield from self._compared(mine[part], value, inner)
            elif isinstance(own, ast.Call):
                code, needed = self.like.written(value, self.own.bound)
                yield self._made("add", inner, [_with_keyword(self.own, own, f"{part}={code}")], needed)
        for part in [part for part in mine if part not in its and isinstance(own, ast.Call)]:
            argument = keyword(own, part) if isinstance(own, ast.Call) else None
            if argument is not None:
                yield self._made("remove", part, [_without(self.own, argument)])

    def _items(self, own: ast.expr, mine: Sequence[ast.expr], its: Sequence[ast.expr], name: str) -> Iterator[Proposal]:
        """Yield the edits of the items of a list, and those that add missing ones: all together, then each."""
        if called_root(own) or name == "LaunchDescription":
            mine = [*mine, *(call.args[0] for call in self.own.calls("add_action") if call.args)]
        pairs = paired(
            [_node(self.own, item) for item in mine[:_MAX_ITEMS]], [_node(self.like, item) for item in its[:_MAX_ITEMS]]
        )
        yield from chain.from_iterable(self._compared(one.of, other.of, name) for one, other in pairs.both)
        far = [
            other
            for one, other in pairs.both
            if one.keys[1] != other.keys[1] and not slip(one.keys[1], [other.keys[1]])
        ]
        missing = [self._item(node) for node in (*far, *pairs.missing)]
        for several in (missing, *([item] for item in missing[1:] or ())) if missing else ():
            edits = _added(self.own, own, [code for code, _ in several])
            if edits:
                yield self._made("add", name, edits, set().union(*(needed for _, needed in several)))
        if len(missing) > 1 and (edits := _added(self.own, own, [missing[0][0]])):
            yield self._made("add", name, edits, missing[0][1])

    def _item(self, like: Node) -> tuple[str, set[str]]:
        """Return the code of an item of the reference and the names that it needs; a name that the file has for it and forgot."""
        for name, value in self.own.values.items():
            if (
                _tag(value) == like.tag
                and isinstance(value, ast.Call)
                and _node(self.own, value).keys[1] == like.keys[1]
            ):
                return name, set()
        return self.like.written(self.like.meant(like.of), self.own.bound)


def called_root(node: ast.expr) -> bool:
    """Return whether an expression is a call of LaunchDescription, whose actions may be added later."""
    return isinstance(node, ast.Call) and called(node) == _ROOTS[1]


def _tag(node: ast.expr) -> str:
    return called(node) if isinstance(node, ast.Call) else type(node).__name__


def _parts(node: ast.expr) -> Mapping[str, ast.expr]:
    """Return the parts of an expression by their names or numbers."""
    match node:
        case ast.Call():
            return _numbered(node.args) | {it.arg: it.value for it in node.keywords if it.arg}
        case ast.Tuple():
            return _numbered(node.elts)
        case ast.Dict():
            return {ast.unparse(key): value for key, value in zip(node.keys, node.values, strict=True) if key}
        case _:
            return {}


def _numbered(items: Sequence[ast.expr]) -> dict[str, ast.expr]:
    return {str(number): item for number, item in enumerate(items)}


def _node(file: PythonFile, item: ast.expr) -> Node:
    """Return an item of a list as it is paired: as a whole, then by what identifies it, then by its likeness."""
    meant = file.meant(item)
    values = {name: file.plain(value) for name, value in _parts(meant).items()}
    key = next((values[name] for name in _IDENTIFYING if name in values), "")
    return Node(_tag(meant), (file.plain(meant), key), values, (), item)


def _added(file: PythonFile, own: ast.expr, codes: Sequence[str]) -> list[Edit]:
    """Return the edit that adds items at the end of a list, or actions where the file adds actions."""
    if isinstance(own, ast.List) and own.elts:
        start, end = file.span(own.elts[-1])
        line = file.text[file.text.rfind("\n", 0, start) + 1 : start]
        space = " " if line.strip() else f"{file.newline}{line}"
        return [
            file.source.edit(end, end, "".join(f",{space}{_at_indent(code, space, file.newline)}" for code in codes))
        ]
    if isinstance(own, ast.List):
        return [file.replaced(own, f"[{', '.join(codes)}]")]
    for call in file.calls("add_action")[-1:]:
        start, end = file.span(call)
        space = file.newline + file.text[file.text.rfind("\n", 0, start) + 1 : start]
        lines = (f"{space}{file.segment(call.func)}({_at_indent(code, space, file.newline)})" for code in codes)
        return [file.source.edit(end, end, "".join(lines))]
    if isinstance(own, ast.Call) and not own.args:
        end = file.span(own)[1] - 1
        return [file.source.edit(end, end, f"[{', '.join(codes)}]")]
    return []


def _at_indent(code: str, space: str, newline: str) -> str:
    """Return the lines of an expression, whose first one stands after this space."""
    first, *others = code.split("\n")
    least = min((len(line) - len(line.lstrip()) for line in others if line.strip()), default=0)
    return newline.join([first, *(space.lstrip("\r\n") + line[least:] if line.strip() else line for line in others)])


def _with_keyword(file: PythonFile, call: ast.Call, code: str) -> Edit:
    """Return the edit that adds an argument to a call."""
    last = [*call.args, *call.keywords][-1:]
    start, end = file.span(last[0]) if last else (0, file.span(call)[1] - 1)
    line = file.text[file.text.rfind("\n", 0, start) + 1 : start]
    space = " " if line.strip() else f"{file.newline}{line}"
    return file.source.edit(end, end, f",{space}{code}" if last else code)


def _without(file: PythonFile, argument: ast.keyword) -> Edit:
    """Return the edit that removes an argument, with its comma and its line."""
    start, end = file.span(argument)
    end += file.text[end : end + 1] == ","
    line = file.text.rfind("\n", 0, start) + 1
    return file.source.edit(max(line - 1, 0) if not file.text[line:start].strip() else start, end, "")
