"""Reading C++ is bounded: by the size of a file, by the work of the grammar, and by the budget."""

import pytest

from grader.ros.cpp.syntax import MAX_BYTES, parse_cpp
from grader.ros.python.budget import Budget

pytestmark = pytest.mark.slow

TOO_LONG = ["a<" * 20_000, "a<b," * 10_000, "f(" * 20_000]


@pytest.mark.parametrize("text", TOO_LONG)
def test_work_of_the_grammar(text: str) -> None:
    """What the grammar reads in too many ways is not read."""
    syntax = parse_cpp(text.encode(), "a.cpp", Budget(10**9))
    assert syntax.unread == "the file takes too long to read"
    assert not syntax.root.children


@pytest.mark.parametrize("text", ["(" * 20_000, "{" * 20_000, '"' * 20_000, "#if a\n" * 5_000])
def test_deep_nesting(text: str) -> None:
    """What is nested deeply is read, or not, without an error of the grader."""
    syntax = parse_cpp(text.encode(), "a.cpp", Budget(10**9))
    assert syntax.unread or syntax.error is not None


def test_size() -> None:
    """A file that is too large is not read, nor one after the budget is spent."""
    assert (
        parse_cpp(b" " * (MAX_BYTES + 1), "a.cpp", Budget(10**9)).unread == "the file is too large"
    )
    spent = Budget(10)
    assert parse_cpp(b"int a;" * 10, "a.cpp", spent).unread == "the submission is too large"
