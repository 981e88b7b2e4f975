"""A closed expression has Python's value, fails as Python fails, or is undetermined; nothing outside the allow-list is reached."""

import math
from contextlib import suppress

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.ros.python.budget import Budget, OutOfBudget
from grader.ros.python.builtins import BUILTINS, MATH
from grader.ros.python.expressions import evaluate
from grader.ros.python.values import EvaluationFails, Undetermined, Value

NAMES: dict[str, Value] = {
    **BUILTINS,
    **MATH,
    "size": 4,
    "text": "wheel",
    "table": {"a": [1, 2]},
    "flag": True,
}
PLAIN = {name: NAMES[name] for name in ("size", "text", "table", "flag", "pi")}


def find(name: str) -> Value:
    """Return the value of a name."""
    if name not in NAMES:
        raise EvaluationFails(f"name {name!r} is not defined")
    return NAMES[name]


def value(text: str, steps: int = 10_000) -> Value:
    """Return the value of an expression."""
    return evaluate(text, find, Budget(steps))


@pytest.mark.parametrize(
    "text",
    [
        "1 + 2 * 3 ** 2 // 4 % 5 - -1",
        "0.1 + 0.2",
        "size == 4 and 'a' in 'abc'",
        "1 < size <= 4 != 5",
        "'big' if size > 3 else missing",
        "not text or size",
        "'a,b'.upper().split(',')",
        "'%s_%.3f %%' % (size, pi)",
        "[item + 1 for item in (1, 2, 3) if item != 2]",
        "[n * name for name, n in [('a', 1), ('b', 2)]]",
        "dict([('a', 1), ('b', 2)]), dict(dict(a=1), b=2), sorted([3, 1, 2], reverse=True)",
        "table['a'][-1] + len(table)",
        "text[::-1][1:3]",
        "sum([x * y for x in range(3) for y in (1, 2)])",
        "max(1, 2) + min([3, 4]) + abs(-2) + round(2.675, 2)",
        "list(map(str, [0, 1, 2]))",
        "list(map(max, [0, 5], [1, 2]))",
        "int('12') + float('.5') + bool(text)",
        "' '.join(str(x) for x in [1, 2] if x)",
        "'-'.join(sorted('cba')).replace('b', 'x').rsplit('-', 1)",
        "table.get('b', 'none'), list(table.items()), len(table.keys()), size | 1, '{}{a}'.format(1, a=2)",
        "list(zip([1], 'a')), list(enumerate('ab', 1)), any([0, 1]), all([]), tuple(reversed([1, 2]))",
        "sorted(['b', 'A']), [*map(max, [0, 5], [1, 2])][0] if False else 1",
        " size ",
    ],
)
def test_the_value_is_pythons(text: str) -> None:
    """Operators, strings, containers, comprehensions and functions have Python's values, of the same type."""
    expected = eval(text.strip(), {**PLAIN})
    found = value(text)
    assert (found, type(found)) == (expected, type(expected))


@pytest.mark.parametrize(
    "text",
    [
        "1 +",
        "missing",
        "1 / 0",
        "'a' + 1",
        "[][0]",
        "dict()['a']",
        "size.missing",
        "float('x')",
        "5(3)",
        "len(5)",
        "1\n2",
        "x = 1",
        "sqrt(-1)",
        "max()",
        "dict(a=1, a=2)",
        "''.join([1])",
        "sorted([1, 'a'])",
        "-text",
        "",
    ],
)
def test_what_python_refuses_fails(text: str) -> None:
    """An expression for which Python raises an error fails with its message."""
    with pytest.raises(EvaluationFails, match=r"\w"):
        value(text)


@pytest.mark.parametrize(
    "text",
    [
        "().__class__",
        "__import__('os')",
        "text.__class__",
        "'{0.__class__}'.format(1)",
        "f'{text.__len__}'",
        "(lambda: 0).__globals__",
        "[x.__class__ for x in (1,)]",
        "open('a')",
        "type(1)",
        "vars()",
        "table.update(a=1)",
        "table.pop('a')",
        "str(len)",
        "hash('a')",
        "'%*d' % (10**9, 1)",
        "'{:9999999}'.format(1)",
        "9**9**9",
        "1 << 10**9",
        "'a' * 10**9",
        "[0] * 10**9",
        "10**9 * 'a'",
        "range(10**9)",
        "factorial(10**6)",
        "round(1, -10**9)",
        "'a'.ljust(10**9)",
        "[[[0] * 99] * 99] * 99",
        "size is 4",
        "(a := 1)",
        "[]" + "()" * 400,
        "-" * 3000 + "1",
        "f'{text}'",
        "{size}",
        "{'a': 1}",
        "[*text]",
        "max(*[1, 2])",
        "dict(**table)",
        "lambda: 1",
        "~size",
        "size << 1",
        "await 1",
        "1j",
        "b'a'",
        "...",
        "divmod(7, 2)",
        "sorted(['b', 'A'], key=len)",
        "isinstance(1, int)",
        "text.zfill(9)",
        "(-8) ** 0.5",
        "dict([(0.5, 1)])",
        "dict([(2**40, 1)])",
    ],
)
def test_what_is_dangerous_or_unknown_has_no_value(text: str) -> None:
    """Attributes with underscores, formats that reach them, huge values and everything else outside the list are refused."""
    with pytest.raises((EvaluationFails, Undetermined, OutOfBudget)):
        value(text)


def test_what_python_cannot_parse_has_no_value() -> None:
    """An expression that is nested too deeply for this version of Python is not certainly an error."""
    with pytest.raises(Undetermined, match="nested too deeply"):
        evaluate("-" * 3900 + "1", lambda name: name, Budget(10_000))


def test_steps_are_bounded() -> None:
    """A loop that takes too long ends with its own exception."""
    with pytest.raises(OutOfBudget):
        value("[[0 for i in range(1000)] for j in range(1000)]")


NUMBERS = st.one_of(st.integers(-50, 50), st.floats(-1e3, 1e3, allow_nan=False)).map(
    lambda number: f"({number!r})"
)
ARITHMETIC = st.recursive(
    NUMBERS,
    lambda inner: st.one_of(
        st.tuples(
            inner, st.sampled_from(["+", "-", "*", "/", "//", "%", "<", "==", "and", "or"]), inner
        ).map(lambda parts: f"({' '.join(parts)})"),
        st.tuples(st.sampled_from(["sin", "abs", "-", "not ", "radians"]), inner).map(
            lambda parts: f"({parts[0]}({parts[1]}))"
        ),
    ),
    max_leaves=12,
)


@given(text=ARITHMETIC)
def test_any_arithmetic_is_pythons(text: str) -> None:
    """Arithmetic of any numbers has exactly Python's value, or fails with Python's error."""
    try:
        expected = eval(text, {**vars(math), "abs": abs})
    except (ArithmeticError, ValueError) as error:
        with pytest.raises(EvaluationFails, match=type(error).__name__):
            value(text)
        return
    assert repr(value(text)) == repr(expected)


@given(
    text=st.text(alphabet="()[]{}'\"%.,:+-*/=<>!&|~ \\\n0123456789abcdefpisz_xlnmort", max_size=60)
)
def test_no_text_raises_anything_else(text: str) -> None:
    """Any text has a value, fails or is undetermined."""
    with suppress(EvaluationFails, Undetermined, OutOfBudget):
        value(text)
