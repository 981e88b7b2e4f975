"""Any Python file is evaluated without an exception and in little time; what would stop Python is a fault."""

import ast
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.files.tree import File, make_tree
from grader.ros.installation.installation import Installation
from grader.ros.installation.setup_py import read_setup
from grader.ros.python.parse import Code, parse
from tests.examples import examples, spread
from tests.installation.my_robot import FILES
from tests.work import limited_work


def read_nothing(limit: int, *, first: bool = False) -> bytes:
    """Return the bytes of any file of the package."""
    return b""


_TREE = make_tree("my_robot", [File(path, 0, read_nothing) for path in FILES], [])


def evaluated(text: str | bytes) -> Installation:
    """Return the evaluation of a setup.py, which must take little work."""
    with limited_work(60_000_000):
        return read_setup(text.encode() if isinstance(text, str) else text, "setup.py", _TREE)


def is_fully_known(setup: Installation) -> bool:
    """Return whether a file has no faults and no unknown values."""
    return not (setup.fault or setup.faults or setup.stops or setup.unknown)


# --- Any program ------------------------------------------------------------------------------------------------------

_NAMES = st.sampled_from(
    [
        "a",
        "b",
        "f",
        "os",
        "glob",
        "setup",
        "data_files",
        "Path",
        "self",
        "len",
        "sorted",
        "__file__",
    ]
)
_LITERALS = st.sampled_from(
    [
        "0",
        "1",
        "-1",
        "1e400",
        "10**9",
        "0x" + "f" * 5000,
        "None",
        "True",
        "''",
        "'urdf/*'",
        "'a/b'",
        "'%s'",
        "'{}'",
        "b'x'",
        "...",
        "1j",
        "[]",
        "()",
        "{}",
        "{1}",
        "'..'",
        "'/'",
        "'\\0'",
        "f'{a}'",
        "f'{a!r:>{b}}'",
        "'nan'",
        "'**'",
    ]
)
_METHODS = st.sampled_from(
    [
        "append",
        "extend",
        "insert",
        "pop",
        "remove",
        "sort",
        "reverse",
        "clear",
        "index",
        "copy",
        "items",
        "keys",
        "values",
        "get",
        "update",
        "setdefault",
        "join",
        "split",
        "format",
        "replace",
        "strip",
        "upper",
        "find",
        "splitlines",
        "glob",
        "rglob",
        "iterdir",
        "parent",
        "parents",
        "name",
        "parts",
        "with_suffix",
        "relative_to",
        "resolve",
        "joinpath",
        "read_text",
        "open",
        "path",
        "exists",
        "isfile",
        "walk",
        "listdir",
        "getcwd",
        "chdir",
        "environ",
        "dirname",
        "relpath",
        "splitext",
        "nothing",
    ]
)
_OPERATORS = st.sampled_from(
    ["+", "-", "*", "/", "%", "|", "&", "==", "!=", "<", "<=", "in", "not in", "is", "and", "or"]
)


def _inner(expressions: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
    """Draw expressions made of smaller ones."""
    pair = st.tuples(expressions, expressions)
    named = st.tuples(_NAMES, expressions, expressions)
    return st.one_of(
        st.tuples(expressions, _OPERATORS, expressions).map(
            lambda it: f"({it[0]} {it[1]} {it[2]})"
        ),
        st.tuples(expressions, _METHODS).map(lambda it: f"{it[0]}.{it[1]}"),
        st.tuples(expressions, _METHODS, st.lists(expressions, max_size=2)).map(
            lambda it: f"{it[0]}.{it[1]}({', '.join(it[2])})"
        ),
        st.tuples(_NAMES, st.lists(expressions, max_size=3)).map(
            lambda it: f"{it[0]}({', '.join(it[1])})"
        ),
        st.tuples(expressions, _NAMES, expressions).map(
            lambda it: f"{it[0]}(*{it[2]}, {it[1]}={it[2]})"
        ),
        pair.map(lambda it: f"{it[0]}(**{it[1]})"),
        pair.map(lambda it: f"{it[0]}[{it[1]}]"),
        pair.map(lambda it: f"{it[0]}[{it[1]}:]"),
        pair.map(lambda it: f"[{it[0]}, *{it[1]}]"),
        pair.map(lambda it: f"({it[0]}, {it[1]})"),
        pair.map(lambda it: f"{{{it[0]}: {it[1]}, **{it[1]}}}"),
        pair.map(lambda it: f"{{{it[0]}, {it[1]}}}"),
        named.map(lambda it: f"[{it[1]} for {it[0]} in {it[2]} if {it[1]}]"),
        named.map(lambda it: f"{{{it[1]}: {it[0]} for {it[0]}, b in {it[2]}}}"),
        named.map(lambda it: f"(lambda {it[0]}, *b: {it[1]})({it[2]})"),
        named.map(lambda it: f"({it[0]} := {it[1]})"),
        pair.map(lambda it: f"({it[0]} if {it[1]} else {it[0]})"),
        pair.map(lambda it: f"setup(name={it[0]}, packages=[], data_files={it[1]})"),
        pair.map(lambda it: f"glob({it[0]}, root_dir={it[1]}, recursive=True)"),
        expressions.map(lambda it: f"Path({it})"),
        expressions.map(lambda it: f"not {it}"),
        expressions.map(lambda it: f"-{it}"),
    )


_EXPRESSIONS = st.recursive(_NAMES | _LITERALS, _inner, max_leaves=6)


def _indented(lines: list[str]) -> str:
    return "\n".join("    " + line for text in lines for line in text.split("\n")) or "    pass"


def _compound(statements: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
    """Draw statements made of smaller ones."""
    body = st.lists(statements, min_size=1, max_size=3).map(_indented)
    return st.one_of(
        st.tuples(_EXPRESSIONS, body, body).map(lambda it: f"if {it[0]}:\n{it[1]}\nelse:\n{it[2]}"),
        st.tuples(_NAMES, _EXPRESSIONS, body).map(
            lambda it: f"for {it[0]} in {it[1]}:\n{it[2]}\n    continue"
        ),
        st.tuples(_EXPRESSIONS, body).map(lambda it: f"while {it[0]}:\n{it[1]}\n    break"),
        st.tuples(_NAMES, _NAMES, _EXPRESSIONS, body).map(
            lambda it: f"def {it[0]}({it[1]}={it[2]}, *b, **k):\n{it[3]}"
        ),
        st.tuples(body, _NAMES, body).map(
            lambda it: f"try:\n{it[0]}\nexcept {it[1]} as a:\n{it[2]}\nfinally:\n    pass"
        ),
        st.tuples(_EXPRESSIONS, _NAMES, body).map(lambda it: f"with {it[0]} as {it[1]}:\n{it[2]}"),
        st.tuples(_EXPRESSIONS, _NAMES, body).map(
            lambda it: f"match {it[0]}:\n  case [{it[1]}, *_]:\n{it[2]}"
        ),
        st.tuples(_NAMES, body).map(lambda it: f"class {it[0]}:\n{it[1]}"),
    )


_SIMPLE = st.one_of(
    _EXPRESSIONS,
    st.tuples(_NAMES, _EXPRESSIONS).map(lambda it: f"{it[0]} = {it[1]}"),
    st.tuples(_NAMES, _EXPRESSIONS).map(lambda it: f"{it[0]} += {it[1]}"),
    st.tuples(_NAMES, _EXPRESSIONS, _EXPRESSIONS).map(lambda it: f"{it[0]}[{it[1]}] = {it[2]}"),
    st.tuples(_NAMES, _EXPRESSIONS).map(lambda it: f"{it[0]}, *b = {it[1]}"),
    st.tuples(_NAMES, _EXPRESSIONS).map(lambda it: f"del {it[0]}[{it[1]}]"),
    _NAMES.map(lambda it: f"del {it}"),
    _NAMES.map(lambda it: f"import {it}"),
    _NAMES.map(lambda it: f"from os import {it}"),
    _EXPRESSIONS.map(lambda it: f"assert {it}"),
    _EXPRESSIONS.map(lambda it: f"raise {it}"),
)
_PROGRAMS = st.lists(st.recursive(_SIMPLE, _compound, max_leaves=5), min_size=1, max_size=8).map(
    "\n".join
)
_START = "import os\nfrom glob import glob\nfrom pathlib import Path\nfrom setuptools import setup\na = ['urdf']\nb = {'a': a}\n"


@pytest.mark.slow
@examples(30)
@given(program=_PROGRAMS)
def test_any_program_is_evaluated(program: str) -> None:
    """No program raises an exception in the evaluation."""
    evaluated(_START + program)


# --- Too much ---------------------------------------------------------------------------------------------------------

_LOOP = "for i in range(20000):\n    "
_LIST = f"x = list(range(19999))\n{_LOOP}"
_TEXT = f"x = '{'a,' * 45000}'\n{_LOOP}"
_DICT = f"x = {{str(i): i for i in range(9999)}}\ndef f(**k): pass\n{_LOOP}"
_PATH = "from pathlib import Path\nimport os\nx = Path('ab')\n"
_SETUP = "from setuptools import setup\n"

# Files that Python itself refuses, or would never finish.
REFUSED: dict[str, str | bytes] = {
    "brackets": "[" * 120_000,
    "brackets that close": "x = " + "[" * 60_000 + "]" * 60_000,
    "a long sum": "x = " + "1+" * 60_000 + "1",
    "a long chain of attributes": "x = a" + ".b" * 60_000,
    "a long chain of calls": "x = f" + "()" * 60_000,
    "many nots": "x = " + "not " * 30_000 + "1",
    "many elifs": "if a: pass\n" + "elif a: pass\n" * 9_000,
    "invalid UTF-8": b"x = '\xff'\n",
    "a NUL byte": b"x = 1\0\n",
    "an unknown encoding": b"# coding: klingon\nx = 1\n",
    "an encoding that is none": b"# coding: undefined\nx = 1\n",
    "an encoding that takes its time": b"# coding: punycode\nx="
    + b"a" * 60_000
    + b"-"
    + b"b" * 60_000,
    "another": b"# coding: idna\nx=" + b"a." * 60_000,
    "an encoding of bytes": b"# coding: zip\nx = 1\n",
    "wide characters": "x = 1\n".encode("utf-16"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_a_syntax_error_is_the_only_fault(name: str) -> None:
    """A file that Python cannot read has no other fault."""
    setup = evaluated(REFUSED[name])
    assert setup.fault is not None
    assert not setup.copies


# Files that would take Python too long, or too much memory; each ends in `setup`, which is not reached or unknown.
EXPENSIVE = {
    "an endless loop that grows": "x = [1]\nwhile True: x += x\nsetup(data_files=x)",
    "a list that doubles": f"x = [1]\n{_LOOP}x += x\nsetup(data_files=x)",
    "a long text": "x = 'a' * 10**9\nsetup(data_files=[(x, [])])",
    "a text that doubles": "x = 'a'\n" + "x += x\n" * 99 + "setup(data_files=[(x, [])])",
    "a text that doubles by %": "x = 'ab'\n"
    + "x = '%s%s' % (x, x)\n" * 99
    + "setup(data_files=[(x, [])])",
    "a text that doubles by format": "x = 'ab'\n"
    + "x = '{}{}'.format(x, x)\n" * 99
    + "setup(data_files=[(x, [])])",
    "a text that doubles by f-string": "x = 'ab'\n"
    + "x = f'{x}{x}'\n" * 99
    + "setup(data_files=[(x, [])])",
    "a text that doubles by replace": "x = 'a'\n"
    + "x = x.replace('a', 'aa')\n" * 99
    + "setup(data_files=[(x, [])])",
    "a path that doubles": _PATH + "x = x / x\n" * 99 + "setup(data_files=[(x, [])])",
    "a path that doubles by joinpath": _PATH
    + "x = x.joinpath(x)\n" * 99
    + "setup(data_files=[(x, [])])",
    "a path that doubles by join": _PATH
    + "x = os.path.join(x, x)\n" * 99
    + "setup(data_files=[(x, [])])",
    "a number that doubles": "x = 1\n"
    + "x = x + x\n" * 20_000
    + "setup(data_files=[(str(x), [])])",
    "a number of many digits": f"x = 0x{'f' * 99_999}\nsetup(data_files=[(f'{{x}}', ['%s' % x, '{{}}'.format(x)])])",
    "a function that calls itself": "def f(n): return f(n)\nsetup(data_files=f(1))",
    "functions that call each other": "def f(n): return g(n) + g(n)\ndef g(n): return f(n) + f(n)\nsetup(data_files=f(1))",
    "a lambda that calls itself": "f = lambda n: [f(n) for i in range(20)]\nsetup(data_files=f(1))",
    "a huge range": "setup(data_files=list(range(10**30)))",
    "a huge literal range": "setup(data_files=list(range(99999999999999999999999)))",
    "loops in loops": "".join(" " * i + f"for i{i} in range(20000):\n" for i in range(3))
    + "   pass\nsetup(data_files=[])",
    "a comprehension in itself": "setup(data_files=[i for i in range(20000) for j in range(20000) for k in range(20000)])",
    "lists of lists": "x = [range(20000) for i in range(20000)]\nsetup(data_files=x)",
    "whiles in whiles": "".join(" " * i + "while a():\n" for i in range(20))
    + " " * 20
    + "x = 1\nsetup(data_files=[x])",
    "a list in itself": "x = []\n" + "x.append(x)\n" * 30 + "setup(name=''.join(x), data_files=x)",
    "a list of itself twice": "a = [0]\n"
    + "a = [a, a]\n" * 3000
    + "b = a == [a]\nsetup(data_files=a if a in a else a)",
    "a function with a long body": "def f():\n return 1\n"
    + " x = 1\n" * 12_000
    + f"{_LOOP}[f() for j in range(9)]\nsetup(data_files=[])",
    "many files": "f = [('a', ['package.xml'] ) for i in range(9000)]\n"
    + "setup(packages=[], data_files=f)\n" * 99,
    "many calls": f"f = [('a', ['package.xml'] ) for i in range(9000)]\n{_LOOP}setup(packages=[], data_files=f)",
}


@pytest.mark.slow
@pytest.mark.parametrize("name", spread(EXPENSIVE, 6))
def test_expensive_programs_are_stopped(name: str) -> None:
    """A program that would take long, or much memory, is not evaluated further, which is reported."""
    setup = evaluated(_SETUP + EXPENSIVE[name])
    assert setup.fault is None
    assert setup.unknown or setup.faults or setup.stops


# Each of these repeats an expensive step on a large value.
SLOW = {
    **{
        f"a list: {code}": _LIST + code
        for code in (
            "y = x + x[:3000]",
            "y = [*x]",
            "sorted(x)",
            "x[:]",
            "list(x)",
            "x.copy()",
            "-1 in x",
            "len(x)",
            "x.index(5)",
            "x[0]",
            "a, b = x",
            "x.remove('a')",
            "x.sort()",
            "x[3] = 4",
            "del x[3]",
            "x.insert(0, 1)",
            "x.pop(0)",
            "f'{x}'",
            "x == x",
            "range(20000)",
            "set(x)",
            "reversed(x)",
            "map(str, x)",
            "dict(a=x)",
            "print(*x)",
            "(lambda *a: 0)(*x)",
            "''.join(x)",
            "x.reverse()",
            "zip(x, x)",
            "enumerate(x)",
            "sum([x, x], [])",
            "[x, x] == [x, x]",
            "x.count('a')",
            "x += x",
        )
    },
    **{
        f"a text: {code}": _TEXT + code
        for code in (
            "x + x",
            "x.split(',')",
            "x.count('a,a,b')",
            "x.find('a,a,b')",
            "'b' in x",
            "x == x",
            "x.upper()",
            "x.replace('a', 'b')",
            "x.replace('', 'b')",
            "f'{x}{x}'",
            "'%s' % x",
            "'{}{}'.format(x, x)",
            "x.format(x)",
            "list(x)",
            "x[1:]",
            "x[::-1]",
            "[*x]",
            "x % 1",
            "x.splitlines()",
            "x.partition('b')",
            "x.strip('a')",
            "(x, x) == (x, x)",
            "for c in x: break",
        )
    },
    **{
        f"a dict: {code}": _DICT + code
        for code in (
            "x.items()",
            "{**x}",
            "f(**x)",
            "dict(**x)",
            "x.update(x)",
            "x | x",
            "x == x",
            "list(x)",
            "x.copy()",
            "x.values()",
        )
    },
    "many undefined names": "".join(f"x{i}\n" for i in range(15_000)),
    "many statements": "x = 1\n" * 20_000,
    "many searches": "from glob import glob\n" + _LOOP + "glob(f'**/*{i}*', recursive=True)",
}


@pytest.mark.parametrize("name", spread(SLOW, 2))
def test_repeated_expensive_steps_are_bounded(name: str) -> None:
    """A large value is evaluated only so often."""
    evaluated(SLOW[name])


# --- Faults -----------------------------------------------------------------------------------------------------------

_IMPORTS = "import os\nfrom glob import glob\nfrom setuptools import setup\n"


def end(data_files: str) -> str:
    """Return a call of setup."""
    return f"setup(name='my_robot', packages=['my_robot'], data_files={data_files})\n"


FAULTS = [
    (
        "from setuptools import setup\n" + end("[(os.path.join('a'), [])]"),
        2,
        60,
        "the name 'os' is not defined",
    ),
    (
        "import os\nfrom setuptools import setup\n" + end("[('a', glob('*'))]"),
        3,
        65,
        "the name 'glob' is not defined",
    ),
    (
        "import glob\nfrom setuptools import setup\n" + end("[('a', glob('*'))]"),
        3,
        65,
        "glob is a module here",
    ),
    (_IMPORTS + end("[('a', glob.glob('*'))]"), 4, 65, "glob is a function here"),
    (_IMPORTS + end("[('a', globb('*'))]"), 4, 65, "the name 'globb' is not defined"),
    (_IMPORTS + "é = 'ä'; x = nmae\n" + end("[]"), 4, 14, "the name 'nmae' is not defined"),
    (
        _IMPORTS + "x = name + 'a'\nname = 'my_robot'\n" + end("[]"),
        4,
        5,
        "the name 'name' is not defined",
    ),
    (
        "from setuptools import find_package, setup\n" + end("[]"),
        1,
        1,
        "setuptools has no 'find_package'",
    ),
    (
        "import setuptools\nsetuptools.find_package()\nsetuptools." + end("[]"),
        2,
        1,
        "setuptools has no 'find_package'",
    ),
    ("from os import Path\n" + _IMPORTS + end("[]"), 1, 1, "os has no 'Path'"),
    ("import oss\n" + _IMPORTS + end("[]"), 1, 1, None),
    (_IMPORTS + end("[(os.join('a', 'b'), [])]"), 4, 60, "os has no 'join'"),
    (
        _IMPORTS + "def f():\n    return nmae\nf()\n" + end("[]"),
        5,
        12,
        "the name 'nmae' is not defined",
    ),
    (_IMPORTS + "f = lambda: nmae\nf()\n" + end("[]"), 4, 13, "the name 'nmae' is not defined"),
    (_IMPORTS + "[x for x in [1]]\nx\n" + end("[]"), 5, 1, "the name 'x' is not defined"),
    (_IMPORTS + "def f(x):\n    y = x\nf(1)\ny\n" + end("[]"), 7, 1, "the name 'y' is not defined"),
    (_IMPORTS + "open('nothing.md')\n" + end("[]"), 4, 1, "there is no file 'nothing.md'"),
    (_IMPORTS + "os.listdir('nothing')\n" + end("[]"), 4, 1, "there is no folder 'nothing'"),
    (
        _IMPORTS + "raise RuntimeError('no')\n" + end("[]"),
        4,
        1,
        "the file raises RuntimeError here",
    ),
    (_IMPORTS + end("[('a', ['README.md'])('b', [])]"), 4, 59, "a tuple cannot be called"),
    (_IMPORTS + end("['a' + ['b']]"), 4, 59, "TypeError: can only concatenate str"),
]


@pytest.mark.parametrize(("text", "line", "column", "message"), FAULTS, ids=range(len(FAULTS)))
def test_faults_have_messages_and_locations(
    text: str, line: int, column: int, message: str | None
) -> None:
    """A fault has its message, and its location as an editor counts it; what only looks like a mistake has none."""
    setup = evaluated(text)
    if message is None:
        assert not setup.faults
        return
    (fault,) = setup.faults
    assert fault.message.startswith(message)
    location = setup.location(fault.at)
    assert (location.path, location.line, location.column) == ("setup.py", line, column)


@pytest.mark.parametrize(
    "code",
    [
        "x = [y for y in 'ab' if y]",
        "x = [(a, b) for a in 'ab' for b in a]",
        "x = {a: b for a, b in {'a': 1}.items()}",
        "[last := y for y in 'ab']\nlast",
        "f = lambda a, *b, c=1, **d: (a, b, c, d)\nf(1, 2, e=3)",
        "def f(a, /, b=os, *c, d, **e):\n    return a, b, c, d, e\nf(1, d=2)",
        "def f():\n    return later\nlater = 1\nf()",
        "def f():\n    return nothing",
        "def f():\n    global x\n    x = 1\nf()\nx",
        "def f():\n    x = 1\n    def g():\n        nonlocal x\n        x += 1\n    g()\n    return x\nf()",
        "for a, (b, c) in [(1, (2, 3))]:\n    pass\na, b, c",
        "with open('README.md') as f:\n    f.read()\nf",
        "try:\n    nothing\nexcept NameError as error:\n    x = str(error)",
        "try:\n    nothing\nexcept Exception:\n    pass",
        "if False:\n    nothing",
        "x = 1 if True else nothing",
        "x = True or nothing",
        "from os.path import *\njoin('a', 'b')",
        "from nowhere_known import *\nwhatever",
        "exec('x = 1')\nx",
        "import os.path as p\np.join('a')",
        "str((__name__, __file__, __doc__)); len, ValueError",
    ],
)
def test_correct_names_are_no_fault(code: str) -> None:
    """Names of comprehensions, functions and lambdas, and unused ones, are no fault."""
    setup = evaluated(_IMPORTS + code + "\n" + end("[('share/my_robot', ['package.xml'])]"))
    assert not setup.fault
    assert not setup.faults
    assert not setup.stops


@pytest.mark.parametrize("ending", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize(
    "start", ["", "\ufeff", "# -*- coding: utf-8 -*-\n", "#!/usr/bin/env python3\n# coding: utf8\n"]
)
def test_encodings_of_a_file(start: str, ending: str) -> None:
    """Line endings, a byte-order mark and a declared encoding are read as Python reads them."""
    text = start + _IMPORTS + end("[('share/my_robot/ä', ['package.xml'])]")
    setup = evaluated(text.replace("\n", ending).encode())
    assert is_fully_known(setup)
    assert setup.installed() == {"share/my_robot/ä/package.xml": "package.xml"}


def test_a_declared_encoding_is_used() -> None:
    """Bytes that are no UTF-8 are read if the file declares their encoding."""
    text = "# coding: latin-1\n" + _IMPORTS + end("[('share/ä', ['package.xml'])]")
    assert evaluated(text.encode("latin-1")).installed() == {"share/ä/package.xml": "package.xml"}


def test_a_wrong_depth_count_of_cpython_is_harmless(monkeypatch: pytest.MonkeyPatch) -> None:
    """If CPython's own recursion count is off, which is no fault of the file, the file is parsed again."""
    calls: list[str] = []
    parse_once: Any = ast.parse

    def miscounting(text: str, **rest: Any) -> Any:
        calls.append(text)
        if len(calls) == 1:
            raise SystemError("AST constructor recursion depth mismatch (before=50, after=47)")
        return parse_once(text, **rest)

    monkeypatch.setattr(ast, "parse", miscounting)
    assert isinstance(parse(b"x = 1\n", "setup.py"), Code)
    assert len(calls) == 2
