"""The names that every xacro expression knows: Python's functions, math, and the namespaces python, math and xacro."""

import re
from collections.abc import Callable, Mapping

from grader.static_python.closed_functions import BUILTINS, MATH, make_dict
from grader.static_python.closed_values import (
    ClosedFunction,
    DottedDict,
    ExpressionFails,
    Namespace,
    Undetermined,
    Value,
    run,
    text_of,
)

_OLD_BUILTINS = ("list", "dict", "map", "len", "str", "float", "int", "bool", "min", "max", "round", "sorted", "range")
_PLAIN_SEPARATORS = re.compile(r"[^\]\[\\^-]+")


def namespace(name: str, names: Mapping[str, Value]) -> Namespace:
    """Return a namespace with these names."""

    def find(wanted: str) -> Value:
        if wanted not in names:
            raise ExpressionFails(f"name {name}.{wanted} is not defined")
        return names[wanted]

    return Namespace(name, find)


def _dotify(value: Value) -> Value:
    return _dotted(run(make_dict, value))


def _dotted(value: Value) -> Value:
    if isinstance(value, dict):
        return DottedDict({key: _dotted(item) for key, item in value.items()})
    return [_dotted(item) for item in value] if isinstance(value, list) else value


def document_functions(load_yaml: Callable[[Value], Value], argument: Callable[[str], str]) -> dict[str, Value]:
    """Return the functions that need the document: those of the namespace xacro, and the old ones outside of it."""
    load = ClosedFunction("load_yaml", load_yaml)
    own = {**_XACRO, "load_yaml": load, "arg": ClosedFunction("arg", argument)}
    return {"xacro": namespace("xacro", own), "load_yaml": load}


def _tokenize(text: str, sep: str = ",; ", skip_empty: bool = True) -> list[str]:
    if not _PLAIN_SEPARATORS.fullmatch(sep):
        raise Undetermined("tokenize with these separators is not supported")
    parts = re.split(f"[{sep}]", text)
    return [part for part in parts if part] if skip_empty else parts


def _fatal(*parts: Value) -> Value:
    raise ExpressionFails(" ".join(map(text_of, parts)))


def _no_path(*_: Value) -> Value:
    raise Undetermined("an absolute path is known only at run time")


_XACRO: dict[str, Value] = {
    **{name: ClosedFunction(name, lambda *_, **__: "") for name in ("message", "warning", "error", "print_location")},
    "fatal": ClosedFunction("fatal", _fatal),
    "tokenize": ClosedFunction("tokenize", _tokenize),
    "dotify": ClosedFunction("dotify", _dotify),
    "abs_filename": ClosedFunction("abs_filename", _no_path),
}
GLOBALS: Mapping[str, Value] = {
    **MATH,
    **{name: BUILTINS[name] for name in _OLD_BUILTINS},
    "python": namespace("python", BUILTINS),
    "math": namespace("math", MATH),
    "dotify": _XACRO["dotify"],
    "abs_filename": _XACRO["abs_filename"],
}
