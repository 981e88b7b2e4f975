"""The difference between two Python files: what they give to setup or LaunchDescription, part by part."""

import ast
from collections.abc import Iterator, Mapping, Sequence
from itertools import product
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
_OWNER = "00"  # what a method is called of
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
            yield from self._functions() if self.own.calls(name) else ()
            for pair in zip(self.own.calls(name), self.like.calls(name), strict=False):
                yield from self._compared(*pair, name)

    def _functions(self) -> Iterator[Proposal]:
        """Yield the edits that give a function the name that it should have, and what it should return."""
        mine, its = (
            {it.name: it for it in file.nodes if isinstance(it, ast.FunctionDef)} for file in (self.own, self.like)
        )
        other = [name for name in mine if name not in its]
        for name, wanted in zip(other, [name for name in its if name not in mine], strict=False):
            start = self.own.text.index(name, self.own.span(mine[name])[0])
            yield change([self.own.source.edit(start, start + len(name), wanted)], "rename", f"`{name}`", self.what)
        for name in its:
            body = mine[name].body if name in mine else []
            if not body or any(isinstance(it, ast.Return) for it in ast.walk(mine[name])):
                continue
            start, end = self.own.span(body[-1])
            indent = " " * body[-1].col_offset
            yield change([self.own.source.edit(start, start, "return ")], "add", "`return`", self.what)
            for variable in sorted(name for name, value in self.own.values.items() if _tag(value) in _ROOTS):
                new = f"{self.own.newline}{indent}return {variable}"
                yield change([self.own.source.edit(end, end, new)], "add", "`return`", self.what)

    def _change(self, verb: Verb, name: str, edits: Sequence[Edit], *codes: Code) -> Proposal:
        imports = self.own.with_imports(sorted(set().union(*(names for _, names in codes))))
        name = f"the value of `{name}`" if verb == "set" else f"`{name}`"
        return change([*imports, *edits], verb, name, self.what)

    def _compared(self, own: ast.expr, like: ast.expr, name: str) -> Iterator[Proposal]:
        """Yield the edits that make an expression the one of the reference: of one of its parts, else of the whole."""
        own, like = self.own.meant(own), self.like.meant(like)
        mine, its = _parts(self.own, own), _parts(self.like, like)
        is_root = name in _ROOTS and isinstance(own, ast.Call)
        if self.own.plain(own) == self.like.plain(like):
            return
        if isinstance(like, ast.List) and (isinstance(own, ast.List) or is_root):
            yield from self._items(own, like, name)
            return
        if is_root and set(mine) < {"0"} == set(its):  # actions are added later
            yield from self._compared(own, its["0"], name)
            return
        for part in [part for part in its if part in mine and _tag(own) == _tag(like)]:
            yield from self._compared(mine[part], its[part], name if part.isdigit() else part)
        if _tag(own) != _tag(like) or set(filter(str.isdigit, mine)) != set(filter(str.isdigit, its)) or not its:
            code = self.like.written(like, self.own.bound)
            whole = self._change("set", name, [self.own.replaced(own, code[0])], code)
            yield whole._replace(rank=int(_tag(own) == _tag(like) and bool(its)))
        else:
            arguments: list[ast.expr | ast.keyword] = [*own.args, *own.keywords] if isinstance(own, ast.Call) else []
            missing = [part for part in its if part not in mine and arguments]
            for parts in (missing, *([part] for part in missing)) if missing else ():
                codes = [self.like.written(its[part], self.own.bound) for part in parts]
                texts = [f"{part}={code}" for part, (code, _) in zip(parts, codes, strict=True)]
                yield self._change("add", parts[-1], [_appended(self.own, arguments, texts)], *codes)
            for part, argument in product(missing, own.keywords if isinstance(own, ast.Call) else ()):
                if self.own.plain(argument.value) == self.like.plain(its[part]) and argument.arg:
                    start = self.own.span(argument)[0]
                    yield self._change(
                        "rename", argument.arg, [self.own.source.edit(start, start + len(argument.arg), part)]
                    )

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


def _parts(file: PythonFile, node: ast.expr) -> Mapping[str, ast.expr]:
    """Return the parts of an expression by their names or numbers."""
    match node:
        case ast.Call(args=items):
            named = {it.arg: it.value for it in node.keywords if it.arg}
            owner = node.func.value if isinstance(node.func, ast.Attribute) else None
            owner = file.values.get(owner.id) if isinstance(owner, ast.Name) else owner
            named |= {_OWNER: owner} if isinstance(owner, ast.Call) else {}
        case ast.BinOp(left=left, right=right):
            items, named = [left, right], {}
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
    values = {name: file.plain(value) for name, value in _parts(file, meant).items()}
    key = next((values[name] for name in _IDENTIFYING if name in values), "")
    return Node(_tag(meant), (file.plain(meant), key, values.get("package", "")), values, (), item)


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
