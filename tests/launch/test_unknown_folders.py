"""What Python does with the text of a folder that is not known: the same for every folder, or not known."""

import ast
from pathlib import PurePosixPath
from typing import Any

import pytest

from grader.ros.installation.places import PREFIX
from grader.ros.python import values as py
from grader.ros.python.interpreter import Interpreter
from grader.ros.python.library import standard_functions
from grader.ros.python.parse import Code, Position, parse

# Real folders in the place of the one that is not known: short, long, with other letters.
FOLDERS = ("/opt", "/zz/ws/install/a_robot", "/home/ash/lab 6/install", "/a/b/c/d/e/f/g")
METHODS = [name for name in dir(str) if not name.startswith("_")]
ARGUMENTS = [
    "",
    "'/'",
    "'s'",
    "'/opt'",
    "'share'",
    "-1",
    "0",
    "3",
    "30",
    "60, '.'",
    "'/', '_'",
    "'share', 'x'",
    "['a', 'b']",
    "T",
    "'/', 1",
    "{97: 'b'}",
]
EXPRESSIONS = [
    *(f"T.{name}({arguments})" for name in METHODS for arguments in ARGUMENTS),
    *(
        f"{name}({value})"
        for name in (
            "len",
            "list",
            "tuple",
            "set",
            "sorted",
            "max",
            "min",
            "any",
            "all",
            "bool",
            "str",
            "repr",
            "hash",
            "sum",
            "ord",
            "dict",
            "iter",
            "next",
            "reversed",
            "enumerate",
            "zip",
            "float",
            "int",
            "abs",
            "bytes",
            "ascii",
        )
        for value in ("T", "[T]", "[T, '/usr']", "T, '/usr'", "T[0]", "(T, 1)", "{T}", "{T: 1}")
    ),
    *(
        f"list({name})"
        for name in (
            "reversed(T)",
            "enumerate(T)",
            "zip(T, T)",
            "map(len, T)",
            "map(len, [T])",
            "map(str, T)",
            "filter(None, T)",
            "T.split('/')",
            "iter(T)",
        )
    ),
    *(
        f"len({name})"
        for name in (
            "T + 'x'",
            "[T]",
            "T.split('/')",
            "f'{T}'",
            "{T: 1}",
            "[*T]",
            "(*T,)",
            "list(T)",
            "T.encode()",
        )
    ),
    *(
        f"T {sign} {other}"
        for sign in ("==", "!=", "<", "<=", ">", ">=", "in", "not in", "+", "*", "%", "is")
        for other in ("'/usr'", "T", "'x'", "3", "['/usr']", "[T]", "'/opt/share/p'")
    ),
    *(
        f"{other} {sign} T"
        for sign in ("in", "not in", "==", "<", "+", "%", "*")
        for other in ("'/usr'", "'share'", "'<'", "'%s'", "'%.3s'", "'%40s'", "3", "['a']")
    ),
    *(f"T[{key}]" for key in ("0", "-1", "1:", ":3", "-3:", "::2", "::-1", ":-1", "5:40")),
    *(
        f"'{text}'.format(T)"
        for text in ("{}", "{:>40}", "{:.5}", "{!r}", "{0[0]}", "{:40}", "{:s}")
    ),
    *("f'{T}'", "f'{T:>40}'", "f'{T:.5}'", "f'{T!r}'", "f'{len(T)}'", "f'{T:s}'"),
    *(
        "','.join(T)",
        "','.join([T])",
        "T.join(['a', 'b'])",
        "''.join(reversed(T))",
        "''.join(sorted(T))",
    ),
    *(
        "[c for c in T]",
        "{c for c in T}",
        "{c: 1 for c in T}",
        "[c for c in T if c == '/']",
        "sum(1 for c in T)",
        "[*T]",
        "(*T, 1)",
    ),
    *(
        "max(c for c in T)",
        "T if T else 'x'",
        "not T",
        "T and 'x'",
        "T or 'x'",
        "T < '/p' or 'x'",
        "'x' if len(T) < 32 else 'y'",
    ),
    *(
        f"os.path.{name}({arguments})"
        for name in (
            "basename",
            "dirname",
            "normpath",
            "split",
            "splitext",
            "isabs",
            "join",
            "abspath",
            "realpath",
            "relpath",
            "commonpath",
            "commonprefix",
            "exists",
            "isdir",
            "expanduser",
            "normcase",
        )
        for arguments in (
            "T",
            "T, '..'",
            "T, '../..', 'x'",
            "[T, '/opt']",
            "'x', T",
            "T + '/a.b'",
            "os.path.dirname(os.path.dirname(T))",
            "os.path.join(T, '../../..')",
            "os.path.join(T, '../../../../x')",
        )
    ),
    *(
        "os.sep.join([T, 'x'])",
        "T.split(os.sep)",
        "os.path.split(T)[1]",
        "os.path.splitext(T + '.urdf')[1]",
    ),
]


def value_of(expression: str, text: str, stand_ins: tuple[str, ...]) -> Any:
    """Return the value of an expression about a text; an Unknown where it is not known."""
    code = parse(f"import os\nR = {expression}\n".encode(), "x.py")
    assert isinstance(code, Code)
    interpreter = Interpreter(
        standard_functions("/<current folder>"), {"T": text}, stand_ins=stand_ins
    )
    names = interpreter.run(code).names
    return names.get("R", py.Unknown("", Position(1, 1)))


def plain(value: Any) -> Any:
    """Return a value that can be compared, with the items of iterators."""
    if isinstance(value, py.Items):
        return [plain(item) for item in value.iterator]
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    return value


def in_place(value: Any, folder: str) -> Any:
    """Return a value with a folder in the place of the one that is not known."""
    if isinstance(value, str):
        return value.replace(PREFIX, folder)
    if isinstance(value, PurePosixPath):
        return PurePosixPath(str(value).replace(PREFIX, folder))
    if isinstance(value, list | set):
        return type(value)(in_place(item, folder) for item in value)
    if isinstance(value, dict):
        return {in_place(key, folder): in_place(item, folder) for key, item in value.items()}
    return value


def is_known(value: Any) -> bool:
    """Return whether nothing in a value is not known."""
    if isinstance(value, list | set):
        return all(map(is_known, value))
    return isinstance(value, str | int | float | dict | PurePosixPath | type(None) | range)


@pytest.mark.parametrize("expression", EXPRESSIONS)
def test_an_answer_holds_for_every_folder(expression: str) -> None:
    """What is known about a text with a stand-in is what Python says of any folder in its place."""
    ast.parse(expression)
    value = plain(value_of(expression, f"{PREFIX}/share/p", (PREFIX,)))
    if not is_known(value):
        return
    for folder in FOLDERS:
        real = plain(value_of(expression, f"{folder}/share/p", ()))
        if is_known(real):
            assert in_place(value, folder) == real
