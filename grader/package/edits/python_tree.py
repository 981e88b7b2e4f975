"""A Python file as a tree: its functions, the calls of setup and LaunchDescription, their arguments and list items."""

import ast
from collections.abc import Mapping, Sequence

from grader.difference import Node
from grader.markup import indentation, indented
from grader.package.edits.python_file import PythonFile, called
from grader.package.edits.trees import TreePlace
from grader.source import Edit

_ROOTS = ("setup", "LaunchDescription")
# Arguments: of a node, else the files of an entry of data_files, else the first; and of a node.
_IDENTIFYING = ("executable", "1", "0"), ("package",)
_OWNER = "00"  # what a method is called of
_MAX_ITEMS, _MAX_DEPTH = 100, 8
_MAX_TEXT = 12 * 1024  # characters of a file that is compared


def python_tree(file: PythonFile, into: PythonFile) -> Node | None:
    """Return a file as a tree, whose parts are written into another one; None of one without these calls."""
    calls = [call for name in _ROOTS for call in file.calls(name)] if len(file.text) <= _MAX_TEXT else []
    functions = [_function(file, node) for node in file.nodes if isinstance(node, ast.FunctionDef)]
    children = [*functions, *(_expression(file, into, call, called(call), called(call)) for call in calls)]
    return Node("", ("", "", ""), {}, children) if calls else None


def _function(file: PythonFile, code: ast.FunctionDef) -> Node:
    """Return a function: its values are what it is called, and whether it returns something."""
    last, is_returning = code.body[-1], any(isinstance(it, ast.Return) for it in ast.walk(code))
    values = {"name": code.name} | ({"return": ""} if is_returning else {})

    def returning(name: str, _: str) -> Edit | None:
        start, end = file.span(last)
        if any(_tag(it) in _ROOTS for it in ast.walk(last)):
            return file.source.edit(start, start, "return ")
        found = [variable for variable, value in file.values.items() if _tag(value) in _ROOTS]
        new = f"{file.newline}{' ' * last.col_offset}{name} {''.join(found[:1])}"
        return file.source.edit(end, end, new) if found else None

    def of() -> TreePlace:
        start = file.text.index(code.name, file.span(code)[0])
        return TreePlace(
            "the function", "", values, {"name": (start, start + len(code.name))}, {}, returning, lambda _: None
        )

    return Node("def", (code.name, "", ""), values, (), of)


def _expression(
    file: PythonFile, into: PythonFile, code: ast.expr, label: str, tag: str = "", depth: int = _MAX_DEPTH
) -> Node:
    """Return an expression: its parts are values, those that have parts and the items of lists are nodes, too."""
    code = file.meant(code)
    parts, items, keys = _parts(file, code), _items(file, code)[:_MAX_ITEMS], _keys(file, code)
    inner = [(name, it) for name, it in parts.items() if _parts(file, file.meant(it)) or _items(file, file.meant(it))]
    inner += [("", item) for item in items]
    values = {name: file.plain(part) for name, part in parts.items()}
    values = values or ({} if items or _tag(code) in _ROOTS else {"": keys[0]})

    def with_value(name: str, new: str) -> Edit | None:
        if not isinstance(code, ast.Call) or not name.isidentifier():
            return None
        return _add(file, [*code.args, *code.keywords], code, f"{name}={new}")

    def with_child(new: str) -> Edit | None:
        own, actions = code, file.calls("add_action")
        if isinstance(own, ast.Call) and called(own) == _ROOTS[1]:
            if not own.args and actions:
                return _add(file, actions[-1:], own, f"{file.segment(actions[-1].func)}({new})", "")
            own = file.meant(own.args[0]) if own.args else own
        return _add(file, own.elts, own, new) if isinstance(own, ast.List) else None

    def of() -> TreePlace:
        whole = {**parts, **({"": code} if "" in values else {})}
        spans = {name: file.span(file.meant(part)) for name, part in whole.items()}
        codes = {name: file.written(file.meant(part), into.bound) for name, part in whole.items()}
        keywords = [it for it in getattr(code, "keywords", []) if it.arg]
        names = {it.arg: (start := file.span(it)[0], start + len(it.arg)) for it in keywords}
        calls = [name for name, value in into.values.items() if _tag(value) == _tag(code) != ""]
        own = [name for name in calls if _keys(into, into.values[name])[1] == keys[1]]  # that is not used
        text = own[0] if own else file.written(code, into.bound)
        return TreePlace(label, text, codes, spans, names, with_value, with_child)

    children = [
        _expression(file, into, it, name if name and not name.isdigit() else _tag(it) or label, name, depth - 1)
        for name, it in inner
        if depth
    ]
    return Node(tag or _tag(code) or type(code).__name__, keys, values, children, of)


def _items(file: PythonFile, code: ast.expr) -> list[ast.expr]:
    """Return the items of a list, or the actions of a LaunchDescription."""
    if isinstance(code, ast.Call) and called(code) == _ROOTS[1]:
        listed = _items(file, file.meant(code.args[0])) if code.args else []
        return [*listed, *(call.args[0] for call in file.calls("add_action") if call.args)]
    return code.elts if isinstance(code, ast.List) else []


def _parts(file: PythonFile, node: ast.expr) -> Mapping[str, ast.expr]:
    """Return the parts of an expression by their names or numbers."""
    items: Sequence[ast.expr] = ()
    named: dict[str, ast.expr] = {}
    match node:
        case ast.Call(args=args) if called(node) != _ROOTS[1]:
            items, named = args, {it.arg: it.value for it in node.keywords if it.arg}
            owner = node.func.value if isinstance(node.func, ast.Attribute) else None
            owner = file.values.get(owner.id) if isinstance(owner, ast.Name) else owner
            named |= {_OWNER: owner} if isinstance(owner, ast.Call) else {}
        case ast.Tuple(elts=elts):
            items = elts
        case ast.Dict(keys=keys, values=values):
            named = {ast.unparse(key): value for key, value in zip(keys, values, strict=True) if key}
    return {str(number): item for number, item in enumerate(items)} | named


def _keys(file: PythonFile, code: ast.expr) -> tuple[str, str, str]:
    """Return what an item of a list is recognised by: as a whole, then by what identifies it, then by its package."""
    parts = _parts(file, code)
    key, package = (next((file.plain(parts[name]) for name in names if name in parts), "") for names in _IDENTIFYING)
    return file.plain(code), key, package


def _tag(node: ast.AST) -> str:
    return called(node) if isinstance(node, ast.Call) else ""


def _add(file: PythonFile, nodes: Sequence[ast.expr | ast.keyword], own: ast.expr, code: str, comma: str = ",") -> Edit:
    """Return the edit that adds code after the last of some nodes, in lines of their own if that has one."""
    start, end = file.span(nodes[-1] if nodes else own)
    if not nodes:
        return file.source.edit(end - 1, end - 1, f"{code}, ")
    line = indentation(file.text, start)
    space = f"{file.newline}{line}" if line else " "
    return file.source.edit(end, end, f"{comma}{space}{indented(code, line, file.newline)}")
