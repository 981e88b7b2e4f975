"""What xacro 2.1.1 from PyPI makes of a document: the text that ROS 2 reads, or its refusal.

The library evaluates Python expressions, so it is given our own documents only.
"""

import io
import sys
import warnings
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, nullcontext, redirect_stderr, redirect_stdout
from math import isfinite
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple
from unittest import mock

import pytest
from lxml import etree

from tests.xacro.documents.document import PACKAGES, Document


class Accepted(NamedTuple):
    """The text that xacro writes, and whether it writes something to stderr, at which a launch file stops."""

    text: str
    has_warned: bool = False


class Refused(NamedTuple):
    """Why xacro writes nothing, or nothing that an XML parser reads."""

    message: str


def expand(document: Document) -> Accepted | Refused:
    """Return what xacro makes of a document, in a folder that holds it and its files only.

    The path of that folder is removed from the text: `$(find my_robot)/a.stl` becomes `/a.stl`.
    """
    with TemporaryDirectory() as name:
        folder = Path(name).resolve()
        for path, content in {document.path: document.text, **document.files}.items():
            file = folder / path
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(content if isinstance(content, bytes) else content.encode())
        try:
            text, has_warned = _process(folder, document)
            etree.fromstring(text.encode())
        except Exception as error:  # noqa: BLE001 - `ros2 run xacro` ends with an error whatever it is
            return Refused(f"{type(error).__name__}: {error}".replace(str(folder), ""))
        return Accepted(text.replace(str(folder), ""), has_warned)


def _process(folder: Path, document: Document) -> tuple[str, bool]:
    """Return what `ros2 run xacro` writes on its standard output, without the white space that it adds.

    The second value is whether it writes something to stderr.
    """
    xacro: Any = pytest.importorskip("xacro")
    pytest.importorskip("xacro.substitution_args")  # xacro imports it when it is first needed
    errors = io.StringIO()
    with (
        _fresh(xacro),
        _packages(xacro, folder),
        redirect_stderr(errors),
        redirect_stdout(io.StringIO()),
    ):
        result = xacro.process_file(
            str(folder / document.path), mappings=dict(document.arguments), verbosity=0
        )
        text: str = result.toxml()
    return text, bool(errors.getvalue())


def _compensated_sum(values: Any, start: Any = 0, add: Any = sum) -> Any:
    """Return what sum() returns from Python 3.12 on, which Jazzy has.

    What is lost where a float is added to one is added at the end; integers are added as they are.
    """
    items = list(values)
    total = start
    if not all(isinstance(item, int | float) for item in (total, *items)):
        return add(items, start)
    lost = 0.0
    for item in items:
        before, total = total, total + item
        if isinstance(before, float) and isinstance(item, float):
            is_larger = abs(before) >= abs(item)
            lost += before - total + item if is_larger else item - total + before
    return total + lost if lost and isfinite(lost) else total


@contextmanager
def _fresh(xacro: Any) -> Iterator[None]:
    """Give xacro the state and the environment of a new process: expressions can change its namespace."""
    compensated = mock.patch("builtins.sum", _compensated_sum)
    with compensated if sys.version_info < (3, 12) else nullcontext():
        symbols = xacro.create_global_symbols()
    state = {
        "_global_symbols": symbols,
        "all_includes": [],
        "substitution_args_context": {},
    }
    functions = dict(xacro.substitution_args._eval_dict)
    with (
        mock.patch.multiple(xacro, **state),
        mock.patch.dict(xacro.substitution_args._eval_dict, functions, clear=True),
        mock.patch.dict("os.environ", {"HOME": "/home/ash"}, clear=True),
        warnings.catch_warnings(),
    ):
        warnings.simplefilter("ignore")  # `${1 is 1}` is a SyntaxWarning
        yield


@contextmanager
def _packages(xacro: Any, folder: Path, packages: Mapping[str, str] = PACKAGES) -> Iterator[None]:
    """Let xacro find the packages of the submission, which ament would find after a build."""

    def find(name: str) -> str:
        if name not in packages:
            raise LookupError(f"package '{name}' not found")
        return str(folder / packages[name])

    functions = xacro.substitution_args
    with (
        mock.patch.object(functions, "_eval_find", find),
        mock.patch.dict(functions._eval_dict, {"find": find}),
    ):
        yield
