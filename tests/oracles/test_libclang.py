"""clang reads the same literals and calls of C++ as our reader: its tokens, without a header and without a compiler."""

from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import pytest

from grader.ros.cpp.literals import TEXTS, number_of_literal
from grader.ros.cpp.syntax import CppNode, parse_cpp
from grader.ros.cpp.unit import called_name
from grader.ros.python.budget import Budget
from tests.oracles.cpp_files import written_files
from tests.samples import ROOT

clang = pytest.importorskip("clang.cindex")
pytestmark = pytest.mark.exhaustive

_OWN = sorted(
    path
    for folder in ("tests", "submissions", "rubrics")
    for path in (ROOT / folder).rglob("*.cpp")
)
_COUNT = 300


def _tokens(text: str) -> Iterator[tuple[str, str]]:
    """Yield the kinds and texts of clang's tokens."""
    unit = clang.TranslationUnit.from_source(
        "a.cpp", args=["-std=c++17", "-fsyntax-only"], unsaved_files=[("a.cpp", text)]
    )
    for token in unit.get_tokens(extent=unit.cursor.extent):
        yield token.kind.name, token.spelling


def _of_clang(text: str) -> tuple[Counter[str], Counter[str]]:
    """Return the literals of texts and numbers, and the names before a parenthesis."""
    literals: Counter[str] = Counter()
    called: Counter[str] = Counter()
    tokens = list(_tokens(text))
    for (kind, spelling), (_, after) in zip(tokens, [*tokens[1:], ("", "")], strict=True):
        if kind == "LITERAL":
            literals[spelling] += 1
        if kind == "IDENTIFIER" and after == "(":
            called[spelling] += 1
    return literals, called


def _of_reader(text: str) -> tuple[Counter[str], Counter[str]]:
    """Return the same of our reader, whose literals may be parts of one with an ending of its own."""
    literals: Counter[str] = Counter()
    called: Counter[str] = Counter()
    syntax = parse_cpp(text.encode(), "a.cpp", Budget(10**9))
    assert not syntax.unread
    for node in syntax.root.walk():
        if node.kind in (*TEXTS, "number_literal", "char_literal", "user_defined_literal"):
            if not _is_part(node):
                literals[node.text] += 1
        elif node.kind == "call_expression":
            called[called_name(node).rpartition("::")[2]] += 1
    return literals, called


def _is_part(node: CppNode) -> bool:
    return node.parent is not None and node.parent.kind == "user_defined_literal"


def _without_preprocessor(text: str) -> str:
    """Return a text without lines that begin with #: what follows is no syntax, a macro a text."""
    lines = text.split("\n")
    return "\n".join("" if line.lstrip().startswith("#") else line for line in lines)


def _compare(text: str) -> None:
    text = _without_preprocessor(text)
    literals, called = _of_clang(text)
    own_literals, own_called = _of_reader(text)
    for literal in [literal for literal in own_literals if literal.startswith("-")]:
        # The grammar takes a sign for a part of the number.
        own_literals[literal[1:]] += own_literals.pop(literal)
    assert own_literals == literals
    # Declarations have names before parentheses, too, and templates have arguments between.
    assert not {
        name: count for name, count in own_called.items() if name in called and count > called[name]
    }


@pytest.mark.parametrize("path", _OWN, ids=lambda path: path.name)
def test_own_files(path: Path) -> None:
    """The files of our labs and samples have the same literals and calls."""
    _compare(path.read_text())


def test_written_files() -> None:
    """So do files that are made of the statements of nodes."""
    for text in written_files(_COUNT):
        _compare(text)


@pytest.mark.parametrize(
    "text", ["0", "10", "0x1F", "0b101", "017", "1'000", "10u", "10ULL", "1.5", ".5", "1e3", "1.5f"]
)
def test_numbers(text: str) -> None:
    """A number has the value that clang computes for it."""
    unit = clang.TranslationUnit.from_source(
        "a.cpp", args=["-std=c++17"], unsaved_files=[("a.cpp", f"constexpr auto a = {text};")]
    )
    [variable] = [it for it in unit.cursor.get_children() if it.spelling == "a"]
    [literal] = [it for it in variable.get_children() if it.kind.is_expression()]
    kind = literal.kind.name
    number = number_of_literal(text)
    assert isinstance(number, float if kind == "FLOATING_LITERAL" else int)
