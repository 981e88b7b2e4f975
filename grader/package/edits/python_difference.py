"""The difference between two Python files: what they give to setup or LaunchDescription, part by part."""

import ast
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from grader.difference import Node, paired
from grader.edits import Proposal
from grader.package.edits.python_file import PythonFile, called
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
_MAX_TEXT = 12 * 1024  # characters of a file that is compared

Code = tuple[str, set[str]]  # and the names in it


class PythonDifference(NamedTuple):
    """A file of a student and the one of the reference; `what` is what the file is called."""

    own: PythonFile
    like: PythonFile
    what: str

    def proposals(self) -> Iterator[Proposal]:
        """Yield the edits that undo one difference each."""
        for name in _ROOTS if len(self.own.text) <= _MAX_TEXT else ():
            for pair in zip(self.own.calls(name), self.like.calls(name), strict=False):
                yield from self._compared(*pair, name)

    def _change(self, verb: Verb, name: str, edits: Sequence[Edit], *codes: Code) -> Proposal:
        imports = self.own.with_imports(sorted(set().union(*(names for _, names in codes))))
        name = f"the value of `{name}`" if verb == "set" else f"`{name}`"
        return change([*imports, *edits], verb, name, self.what)

    def _compared(self, own: ast.expr, like: ast.expr, name: str) -> Iterator[Proposal]:
        """Yield the edits that make an expression the one of the reference: of one of its parts, else of the whole."""
        own, like = self.own.meant(own), self.like.meant(like)
        mine, its = _parts(own), _parts(like)
        is_root = name in _ROOTS and isinstance(own, ast.Call)
        if self.own.plain(own) == self.like.plain(like):
            return
        if isinstance(like, ast.List) and (isinstance(own, ast.List) or is_root):
            yield from self._items(own, like, name)
        elif is_root and set(mine) < {"0"} == set(its):  # actions are added later
            yield from self._compared(own, its["0"], name)
        elif _tag(own) != _tag(like) or set(filter(str.isdigit, mine)) != set(filter(str.isdigit, its)) or not its:
            code = self.like.written(like, self.own.bound)
            yield self._change("set", name, [self.own.replaced(own, code[0])], code)
        else:
            for part in [part for part in its if part in mine]:
                yield from self._compared(mine[part], its[part], name if part.isdigit() else part)
            arguments: list[ast.expr | ast.keyword] = [*own.args, *own.keywords] if isinstance(own, ast.Call) else []
            for part in [part for part in its if part not in mine and arguments]:
                code = self.like.written(its[part], self.own.bound)
                yield self._change("add", part, [_appended(self.own, arguments, [f"{part}={code[0]}"])], code)
            for argument in own.keywords if isinstance(own, ast.Call) else ():
                if argument.arg and argument.arg not in its:
                    yield self._change("remove", argument.arg, [_without(self.own, argument)])

    def _items(self, own: ast.expr, like: ast.List, name: str) -> Iterator[Proposal]:
        """Yield the edits of the items of a list, and those that add missing ones: all together, then each."""
        actions = [call.args[0] for call in self.own.calls("add_action") if call.args] if name in _ROOTS else []
        listed = own.elts if isinstance(own, ast.List) else []
        pairs = paired(
            [_node(self.own, item) for item in (*listed, *actions)[:_MAX_ITEMS]],
            [_node(self.like, item) for item in like.elts[:_MAX_ITEMS]],
        )
        missing = [self._item(node) for node in pairs.missing]
        for one, other in pairs.both:
            yield from self._compared(one.of, other.of, name)
            if one.keys[1] != other.keys[1] and not slip(one.keys[1], [other.keys[1]]):
                missing.append(self._item(other))
        for several in (missing, *([item] for item in missing)) if missing else ():
            codes = [code for code, _ in several]
            if listed:
                edits = [_appended(self.own, listed, codes)]
            elif actions:
                call = self.own.calls("add_action")[-1]
                codes = [f"{self.own.segment(call.func)}({code})" for code in codes]
                edits = [_appended(self.own, [call], codes, comma="")]
            else:
                start, end = self.own.span(own)
                start, end = (start, end) if isinstance(own, ast.List) else (end - 1, end - 1)  # in an empty call
                edits = [self.own.source.edit(start, end, f"[{', '.join(codes)}]")]
            yield self._change("add", name, edits, *several)

    def _item(self, like: Node) -> Code:
        """Return the code of an item of the reference; the name that the file has for it, where it does not use it."""
        for name, value in self.own.values.items():
            if (
                isinstance(value, ast.Call)
                and called(value) == like.tag
                and _node(self.own, value).keys[1] == like.keys[1]
            ):
                return name, set()
        return self.like.written(self.like.meant(like.of), self.own.bound)


def _tag(node: ast.expr) -> str:
    return called(node) if isinstance(node, ast.Call) else type(node).__name__


def _parts(node: ast.expr) -> Mapping[str, ast.expr]:
    """Return the parts of an expression by their names or numbers."""
    match node:
        case ast.Call(args=items):
            named = {it.arg: it.value for it in node.keywords if it.arg}
        case ast.Tuple(elts=items):
            named = {}
        case ast.Dict(keys=keys, values=values):
            items, named = [], {ast.unparse(key): value for key, value in zip(keys, values, strict=True) if key}
        case _:
            return {}
    return {str(number): item for number, item in enumerate(items)} | named


def _node(file: PythonFile, item: ast.expr) -> Node:
    """Return an item of a list as it is paired: as a whole, then by what identifies it, then by its likeness."""
    meant = file.meant(item)
    values = {name: file.plain(value) for name, value in _parts(meant).items()}
    key = next((values[name] for name in _IDENTIFYING if name in values), "")
    return Node(_tag(meant), (file.plain(meant), key), values, (), item)


def _appended(
    file: PythonFile, nodes: Sequence[ast.expr | ast.keyword], codes: Sequence[str], comma: str = ","
) -> Edit:
    """Return the edit that adds code after the last of some nodes, in lines of their own if that has one."""
    start, end = file.span(nodes[-1])
    line = file.text[file.text.rfind("\n", 0, start) + 1 : start]
    space = " " if line.strip() else f"{file.newline}{line}"
    text = ""
    for code in codes:
        first, *others = code.split("\n")
        least = min((len(other) - len(other.lstrip()) for other in others if other.strip()), default=0)
        lines = (space.lstrip("\r\n") + other[least:] if other.strip() else other for other in others)
        text += f"{comma}{space}{file.newline.join([first, *lines])}"
    return file.source.edit(end, end, text)


def _without(file: PythonFile, argument: ast.keyword) -> Edit:
    """Return the edit that removes an argument, with its comma and its line."""
    start, end = file.span(argument)
    end += file.text[end : end + 1] == ","
    line = file.text.rfind("\n", 0, start) + 1
    return file.source.edit(max(line - 1, 0) if not file.text[line:start].strip() else start, end, "")
