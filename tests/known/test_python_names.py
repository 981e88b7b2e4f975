"""The table of Python's modules and names, compared with the Python that runs the tests."""

import re
import sys
from collections.abc import Mapping
from functools import cache

import pytest
import tomli

from grader.ros.known.python_names import (
    PYTHON_NAMES_FILE,
    python_names,
    python_version,
    shared_message,
)
from grader.ros.known.releases import RELEASES
from tests.known.make_python_names import list_names

_RUNNING = sys.version_info.minor
_TABLE = tomli.loads(PYTHON_NAMES_FILE.read_text("utf-8"))
_BY_MINOR = {python_version((release,)): release for release in RELEASES}
_OF_MACHINE = {"errno", "os", "platform", "stat", "sys", "time"}  # the libc decides what is there
_OF_BUILD = re.compile(
    r"_|ctypes|dbm|curses|.*win|ms|nt$|setuptools|pip|pkg_resources|lib2to3|tkinter|distutils"
)


def _compared() -> list[str]:
    """Return all keys; of a version between two of the table, those that imports in CPython's modules do not change."""
    keys = sorted(_TABLE["always"].keys() - {"setuptools"})
    if _RUNNING in _BY_MINOR:
        return keys
    return [
        key
        for key in keys
        if key.startswith(("class ", "builtins", "math", "itertools", "operator"))
    ]


@cache
def _running() -> Mapping[str, frozenset[str]]:
    asked = {key: python_names(key, RELEASES) for key in _TABLE["always"]}
    return list_names([sys.executable], asked)[1]


def _around() -> tuple[str, str]:
    """Return the releases whose Python is the nearest that is not newer, and not older, than the running one."""
    older = max(minor for minor in _BY_MINOR if minor <= _RUNNING)
    newer = min((minor for minor in _BY_MINOR if minor >= _RUNNING), default=older)
    return _BY_MINOR[older], _BY_MINOR[newer]


@pytest.mark.parametrize("key", _compared())
def test_names(key: str) -> None:
    """What both neighbouring versions have, the running one has, and it has nothing that neither has."""
    older, newer = (python_names(key, (release,)) for release in _around())
    running = _running().get(key, frozenset())
    if key in _OF_MACHINE:
        assert len(running ^ (older | newer)) < 0.1 * len(running)
        return
    lacks, has = older & newer - running, running - older - newer
    assert not [name for name in lacks if not _OF_BUILD.match(name)]
    assert not [name for name in has if not _OF_BUILD.match(name)]


def test_each_release_has_a_python() -> None:
    """Each release runs with a version that the table has, and no release with an older one than the release before it."""
    minors = [python_version((release,)) for release in RELEASES]
    assert minors == sorted(minors)
    assert {f"3.{minor}" for minor in minors} == {*_TABLE} - {
        "python",
        "messages",
        "always",
    }


@pytest.mark.parametrize(
    ("code", "message"),
    [
        ("1 / 0", "division by zero"),
        ("1.5 // 0", "division by zero"),
        ("7 % 0", "division by zero"),
        ("0.0 ** -1", "division by zero"),
        ("__import__('math').sqrt(-1)", "math domain error"),
        ("__import__('math').log(0)", "math domain error"),
        ("__import__('math').acos(2)", "math domain error"),
        ("max([])", "max() arg is an empty sequence"),
        ("1 in 2", "argument of type 'int' is not iterable"),
        ("'a'.find(1)", "must be str, not int"),
        ("[].index(1)", "list.index(x): x not in list"),
        ("f(a=)", "invalid syntax"),
        ("[*]", "invalid syntax"),
    ],
)
def test_messages(code: str, message: str) -> None:
    """Each version's message is given as the one that all have."""
    with pytest.raises((ArithmeticError, ValueError, TypeError, SyntaxError)) as caught:
        eval(code, {})
    text = caught.value.msg if isinstance(caught.value, SyntaxError) else str(caught.value)
    assert shared_message(text) == message
