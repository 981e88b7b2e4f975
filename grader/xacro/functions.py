"""The names that every xacro expression knows: Python's functions, math, and the namespaces python, math and xacro."""

import re
from collections.abc import Callable, Mapping

from grader.static_python.builtins import BUILTINS, MATH
from grader.static_python.knowledge import str_of
from grader.static_python.values import ExpressionFails, Namespace, PlainFunction, Undetermined, Value

_OLD_BUILTINS = ("list", "dict", "map", "len", "str", "float", "int", "bool", "min", "max", "round", "sorted", "range")
_NOT_IN_XACRO = ("iter", "next")
_UNSUPPORTED = ("load_yaml", "dotify", "abs_filename")
_PLAIN_SEPARATORS = re.compile(r"[^\]\[\\^-]+")


def namespace(name: str, names: Mapping[str, Value]) -> Namespace:
    """Return a namespace with these names."""

    def find(wanted: str) -> Value:
        if wanted not in names:
            raise ExpressionFails(f"name {name}.{wanted} is not defined")
        return names[wanted]

    return Namespace(name, find)


def _tokenize(text: str, sep: str = ",; ", skip_empty: bool = True) -> list[str]:
    if not _PLAIN_SEPARATORS.fullmatch(sep):
        raise Undetermined("tokenize with these separators is not supported")
    parts = re.split(f"[{sep}]", text)
    return [part for part in parts if part] if skip_empty else parts


def _fatal(*parts: Value) -> Value:
    raise ExpressionFails(" ".join(map(str_of, parts)))


def _refuse(reason: str) -> Callable[..., Value]:
    def refuse(*_: Value, **__: Value) -> Value:
        raise Undetermined(reason)

    return refuse


_XACRO: dict[str, Value] = {
    **{name: PlainFunction(name, lambda *_, **__: "") for name in ("message", "warning", "error", "print_location")},
    "fatal": PlainFunction("fatal", _fatal),
    "tokenize": PlainFunction("tokenize", _tokenize),
    **{name: PlainFunction(name, _refuse(f"{name} is not supported")) for name in _UNSUPPORTED},
}
GLOBALS: Mapping[str, Value] = {
    **MATH,
    **{name: BUILTINS[name] for name in _OLD_BUILTINS},
    "python": namespace("python", {name: it for name, it in BUILTINS.items() if name not in _NOT_IN_XACRO}),
    "math": namespace("math", MATH),
    **{name: _XACRO[name] for name in _UNSUPPORTED},
}


def known_names(argument: Callable[[str], str]) -> dict[str, Value]:
    """Return the names that every expression of a document knows; `argument` returns the value of an argument."""
    return {**GLOBALS, "xacro": namespace("xacro", {**_XACRO, "arg": PlainFunction("arg", argument)})}
