"""Python files that hints and mutants edit."""

import ast
import warnings

import pytest

from grader.base.source import Source
from grader.ros.python.python_file import PythonFile


@pytest.mark.parametrize(
    ("code", "plain"),
    [("f('\\d',x)", "f('\\\\d', x)"), ("1if x else 2", "1 if x else 2")],
)
def test_code_is_compared_without_a_warning(code: str, plain: str) -> None:
    """From Python 3.12 on, an invalid escape sequence would be a line on the user's terminal."""
    file = PythonFile(Source("a.py", f"y = {code}\n"))
    [statement] = [node for node in file.nodes if isinstance(node, ast.Assign)]
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        assert file.plain(statement.value) == plain
    assert said == []
