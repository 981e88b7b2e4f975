"""What holds for every C++ file: reading it raises nothing, and what is a literal keeps its text."""

import json

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from grader.ros.cpp.declarations import CppFile
from grader.ros.cpp.syntax import parse_cpp
from grader.ros.python.budget import Budget
from tests.cpp.test_values import evaluated
from tests.examples import examples

pytestmark = pytest.mark.slow

_WORDS = st.sampled_from(
    [
        *(
            "class",
            "A",
            "a",
            "::",
            ":",
            "public",
            "rclcpp::Node",
            "{",
            "}",
            "(",
            ")",
            "<",
            ">",
            ";",
        ),
        *('"a"', "'a'", 'R"(', ')"', "=", "+", ",", "#if A\n", "#endif\n", "#define A a\n", "\n"),
        *("const", "auto", "this", "->", ".", "*", "&", "[", "]", "namespace", "using", "typedef"),
        *("template", "std::string", "1", "2.0", "ms", "//", "/*", "*/", "return", "if", "for"),
    ]
)


@examples(150)
@given(st.lists(_WORDS, max_size=60).map(" ".join))
@example("class A : public A { A() : A(a) { a = a; } A a = a; };")
@example("const auto a = b; const auto b = a; void f() { use(a, b); }")
def test_every_text_is_read(text: str) -> None:
    """Every node is in its parent, in the order of the text, and every place is in the file."""
    syntax = parse_cpp(text.encode(), "a.cpp", Budget())
    for node in syntax.root.walk():
        ends = [(child.start, child.end) for child in node.children]
        assert ends == sorted(ends)
        assert all(node.start <= start <= end <= node.end for start, end in ends)
    file = CppFile(syntax)
    count = text.count("\n") + 1
    places = [each.node.location for each in file.classes]
    places += [each.node.location for each in file.functions]
    assert all(1 <= place.line <= count for place in places)
    evaluated(f"{text}\nvoid g() {{ use(a); }}", "void h() { use(1); }")


_PLAIN = st.text(st.characters(min_codepoint=32, max_codepoint=126), max_size=20)


@examples(100)
@given(_PLAIN)
def test_a_text_keeps_its_characters(text: str) -> None:
    """A literal with escapes, and a raw one, stand for the text."""
    assert evaluated(f"void f() {{ use({json.dumps(text)}); }}") == [text]
    if ')x"' not in text:
        assert evaluated(f'void f() {{ use(R"x({text})x"); }}') == [text]


@examples(100)
@given(st.one_of(st.integers(0, 2**63), st.floats(0, 1e300, allow_nan=False)))
def test_a_number_keeps_its_value(number: float) -> None:
    """A number is read as Python writes it."""
    assert evaluated(f"void f() {{ use({number!r}); }}") == [number]
