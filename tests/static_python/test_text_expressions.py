"""An expression is evaluated without a file around it, with tables of functions and names; nothing is run."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.static_python.evaluation import Evaluation
from grader.static_python.expressions import evaluate_text
from grader.static_python.parse import START
from grader.static_python.values import Call, QualifiedName, Unknown, Value


def double(_: Evaluation, call: Call) -> Value:
    """Return twice a value: a function of the table."""
    return call.args[0] + call.args[0]


FUNCTIONS = {"double": double}
VALUES = {
    "1 + 2": 3,
    "-size + 0.5": -3.5,
    "size == 4 and 'a' in 'abc'": True,
    "1 < size": True,
    "'big' if size > 3 else 'small'": "big",
    "'a,b'.upper().split(',')": ["A", "B"],
    "f'wheel_{size}'": "wheel_4",
    "'%s_%s' % (size, 'x')": "4_x",
    "[item + 1 for item in (1, 2, 3) if item != 2]": [2, 4],
    "{name: len for name in ['a'] for len in [1, 2]}": {"a": 2},
    "{'a': [1, 2]}['a'][-1]": 2,
    "(lambda first, second=2: first + second)(size)": 6,
    "[n := 3, n + n]": [3, 6],
    "[1, 2, 3][1:]": [2, 3],
    "double('ab')": "abab",
    "\n  1\n": 1,
}
UNKNOWN = [
    "1 +",
    "x",
    "undefined(1)",
    "open('a').read()",
    "1) + (2",
    "1\n2",
    "x = 1",
    "import os",
    "quit()",
    "1" * 2000,
    "[]" + "()" * 400,
]


@pytest.mark.parametrize("text", VALUES)
def test_the_value_equals_pythons(text: str) -> None:
    """Arithmetic, comparisons, conditions, strings, lists, dicts, comprehensions and functions have Python's values."""
    names: dict[str, Value] = {"size": 4, "double": QualifiedName("double")}
    assert evaluate_text(text, FUNCTIONS, names) == VALUES[text]


@pytest.mark.parametrize("text", UNKNOWN)
def test_any_other_text_is_unknown(text: str) -> None:
    """A text that is no expression, uses unknown names or takes too long has no value, and raises nothing."""
    value = evaluate_text(text, {}, {})
    assert isinstance(value, Unknown | Call)


def test_a_text_with_an_unknown_value_is_unknown() -> None:
    """An unknown value is never written into a text."""
    unknown = Unknown("it depends on the machine", START)
    assert evaluate_text("'%s' % x", {}, {"x": unknown}) == unknown


@given(text=st.text(max_size=60))
def test_no_text_raises(text: str) -> None:
    """Any text has a value or is unknown."""
    evaluate_text(text, FUNCTIONS, {})
