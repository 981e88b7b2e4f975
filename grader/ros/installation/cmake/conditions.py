"""The conditions of if() in a CMakeLists.txt, as cmake-commands(7) gives their order."""

import operator
from collections.abc import Callable, Sequence

from grader.base.patterns import on_use
from grader.ros.installation.cmake.cmake_values import Text, Values, split_list
from grader.ros.python.parse import Position
from grader.ros.python.values import Unknown

_Truth = bool | None  # None where it is not known

_TRUE = frozenset({"1", "ON", "YES", "TRUE", "Y"})
_FALSE = frozenset({"0", "OFF", "NO", "FALSE", "N", "IGNORE", "NOTFOUND", ""})
_MAX_DEPTH = 30  # parentheses and NOT in each other
_NUMBER = on_use(r"-?\d+(?:\.\d+)?")
_COMPARE: dict[str, Callable[[float, float], bool]] = {
    "EQUAL": operator.eq,
    "LESS": operator.lt,
    "GREATER": operator.gt,
    "LESS_EQUAL": operator.le,
    "GREATER_EQUAL": operator.ge,
}
_FILE_TESTS = ("EXISTS", "IS_DIRECTORY")
_UNARY = (
    "DEFINED",
    "TARGET",
    "COMMAND",
    "POLICY",
    "TEST",
    "IS_ABSOLUTE",
    "IS_SYMLINK",
    *_FILE_TESTS,
)


class Condition:
    """A condition: texts, and whether each is written without quotes.

    A text without quotes may name a variable.
    """

    def __init__(
        self,
        tokens: Sequence[tuple[Text, bool]],
        values: Values,
        exists: Callable[[str], _Truth],
        at: Position,
    ) -> None:
        """`exists` says whether there is a file or folder at a path."""
        self._tokens = tokens
        self._values = values
        self._exists = exists
        self._at = at
        self._index = 0

    def holds(self) -> _Truth:
        """Return whether it holds; None if that is not known."""
        is_true = self._either(0)
        if self._index == len(self._tokens):
            return is_true
        return None

    def _peek(self) -> Text | None:
        if self._index < len(self._tokens):
            return self._tokens[self._index][0]
        return None

    def _either(self, depth: int) -> _Truth:
        is_true = self._both(depth)
        while self._peek() == "OR":
            self._index += 1
            other = self._both(depth)
            if is_true or other:
                is_true = True
            elif None in (is_true, other):
                is_true = None
            else:
                is_true = False
        return is_true

    def _both(self, depth: int) -> _Truth:
        is_true = self._negated(depth)
        while self._peek() == "AND":
            self._index += 1
            other = self._negated(depth)
            if False in (is_true, other):
                is_true = False
            elif None in (is_true, other):
                is_true = None
            else:
                is_true = True
        return is_true

    def _negated(self, depth: int) -> _Truth:
        if depth > _MAX_DEPTH:
            return None
        if self._peek() == "NOT":
            self._index += 1
            is_true = self._negated(depth + 1)
            return None if is_true is None else not is_true
        if self._peek() == "(":
            self._index += 1
            is_true = self._either(depth + 1)
            if self._peek() == ")":
                self._index += 1
            return is_true
        return self._leaf()

    def _leaf(self) -> _Truth:
        first = self._next()
        if first is None:
            return None
        text, is_plain = first
        if is_plain and text in _UNARY and self._peek() not in (None, "AND", "OR", ")"):
            operand = self._next()
            if operand is not None:
                return self._test(str(text), operand[0])
            return None
        word = self._peek()
        if isinstance(word, str) and (
            word in _COMPARE or word.startswith(("STR", "VERSION_", "MATCHES", "IN_LIST"))
        ):
            self._index += 1
            second = self._next()
            if second is not None:
                return self._compare(self._operand(*first), word, second)
            return None
        return self._truth(text, is_plain)

    def _next(self) -> tuple[Text, bool] | None:
        self._index += 1
        if self._index <= len(self._tokens):
            return self._tokens[self._index - 1]
        return None

    def _operand(self, text: Text, is_plain: bool) -> Text:
        """Return a text, or the value of the variable that it names."""
        if isinstance(text, str) and is_plain and text in self._values.variables:
            return self._values.variables[text]
        return text

    def _truth(self, text: Text, is_plain: bool) -> _Truth:
        if isinstance(text, Unknown):
            return None
        constant = _constant(text)
        if constant is not None or not is_plain:
            return bool(constant)
        value = self._values.lookup(text, self._at)
        if isinstance(value, Unknown):
            return None
        return not _is_false(value)

    def _test(self, word: str, operand: Text) -> _Truth:
        if isinstance(operand, Unknown):
            return None
        if word in _FILE_TESTS:
            return self._exists(operand)
        if word == "DEFINED" and "{" not in operand:
            value = self._values.lookup(operand, self._at)
            if value == "" and operand not in self._values.variables:
                return False
            return (
                True if value and isinstance(value, str) else None
            )  # one that is set to nothing may be defined
        return None

    def _compare(self, left: Text, word: str, second: tuple[Text, bool]) -> _Truth:
        right = second[0] if word in ("MATCHES", "IN_LIST") else self._operand(*second)
        if isinstance(left, Unknown) or isinstance(right, Unknown):
            return None
        if word == "STREQUAL":
            return left == right
        if word == "IN_LIST":
            items = self._values.lookup(right, self._at)
            return None if isinstance(items, Unknown) else left in split_list(items)
        if word == "MATCHES":
            return right in left if right.isidentifier() else None
        if word in _COMPARE and _NUMBER.fullmatch(left) and _NUMBER.fullmatch(right):
            return _COMPARE[word](float(left), float(right))
        return None


def _constant(text: str) -> _Truth:
    """Return the truth of a constant; None for another text."""
    word = text.upper()
    if word in _TRUE or (_NUMBER.fullmatch(text) and float(text) != 0):
        return True
    return False if _is_false(text) else None


def _is_false(text: str) -> bool:
    return text.upper() in _FALSE or text.upper().endswith("-NOTFOUND")
