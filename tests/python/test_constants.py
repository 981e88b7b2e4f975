"""Constants: what is said to be the value of a name is the value that Python gives it."""

import ast

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.ros.python.budget import Budget
from grader.ros.python.constants import Constants, constant_in
from grader.ros.python.parse import own_nodes
from grader.ros.python.values import SCALARS, Scope
from tests.examples import examples

pytestmark = pytest.mark.slow

_NAMES = ("a", "b", "c")
_LINES = st.one_of(
    st.tuples(
        st.sampled_from(_NAMES),
        st.sampled_from(
            ["'x'", "1", "a", "b + 'y'", "f'{c}'", "[1]", "str(5)", "a or b", "(1, 'x')"]
        ),
    ).map(lambda it: f"{it[0]} = {it[1]}"),
    st.sampled_from(
        [
            "a += 'z'",
            "del b",
            "for c in ('p', 'q'): pass",
            "if unknown(): a = 'if'",
            "def f(b): a = 'inner'",
            "def g():\n    global a\n    a = 'global'",
            "g()",
            "from math import pi as b",
            "import math as c",
            "exec('a = 5')",
            "with open_() as a: pass",
            "a, b = 'u', 'v'",
            "try:\n    c = 1 // 0\nexcept ZeroDivisionError as b:\n    c = 'caught'",
            "class T:\n    a = 'class'",
            "[b for b in 'xy']",
            "(c := 'walrus')",
            "a: str = 'annotated'",
            "a: str",
            "lambda a: a",
        ]
    ),
)


class _Manager:
    def __enter__(self) -> str:
        return "entered"

    def __exit__(self, *_: object) -> None:
        return None


@given(st.lists(_LINES, max_size=7))
@examples(400)
def test_a_constant_has_the_value_that_python_gives_it(lines: list[str]) -> None:
    """Whatever else a module does: a name that is changed, deleted or bound elsewhere is no constant."""
    text = "\n".join(lines)
    tree = ast.parse(text)
    constants = Constants([*ast.walk(tree)], "module", {}, Budget(), is_package=False)
    scope = constants.bound(own_nodes(tree), Scope({}))
    for answer in (True, False):
        run: dict[str, object] = {"unknown": lambda answer=answer: answer, "open_": _Manager}
        try:
            exec(text, run)
        except Exception:  # noqa: BLE001  a module that stops has no values
            continue
        for name in _NAMES:
            value = constant_in(scope, name)
            if isinstance(value, (*SCALARS, tuple)) and name in run:
                assert run[name] == value, (name, text)
