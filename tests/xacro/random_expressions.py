"""Random expressions of xacro over names that are defined: numbers, texts, lists and conditions; a few are defective."""

from collections.abc import Callable
from dataclasses import dataclass, field
from random import Random

_LITERALS = (
    "0",
    "1",
    "2",
    "3",
    "7",
    "10",
    "0.5",
    ".25",
    "1.50",
    "0.1",
    "0.05",
    "1e-3",
    "2.5e2",
    "100",
    "1_0",
    "0x1F",
    "1.",
)
_CONSTANTS = ("pi", "math.pi", "e", "tau")
_FUNCTIONS = (
    "sin",
    "cos",
    "tan",
    "atan",
    "exp",
    "radians",
    "degrees",
    "fabs",
    "floor",
    "ceil",
    "int",
    "float",
    "round",
    "math.sin",
    "math.cos",
    "math.radians",
    "python.abs",
    "python.round",
    "trunc",
    "bool",
    "math.floor",
)
_WORDS = ("left", "right", "wheel", "base link", "a,b;c", "0 0 1", "", "1", "Über", "x_y", "true")
_METHODS = (
    "upper()",
    "lower()",
    "strip()",
    "replace('e', 'E')",
    "title()",
    "split('e')[0]",
    "replace('_', ' ')",
    "capitalize()",
)
_COMPARISONS = ("<", "<=", ">", ">=", "==", "!=")
_DEFECTS = (
    "missing_name",
    "1 +",
    "(2",
    "3)",
    "1 / 0",
    "'a' - 1",
    "[1][5]",
    "nothing(1)",
    "1 2",
    "'open",
    "sqrt(-1)",
    "PI",
    "int('x')",
    "true",
)


@dataclass
class Names:
    """The properties that are defined in a scope, by the kind of their values."""

    numbers: list[str] = field(default_factory=list)
    texts: list[str] = field(default_factory=list)
    lists: list[str] = field(default_factory=list)
    flags: list[str] = field(default_factory=list)

    def inner(self) -> "Names":
        """Return the names of a scope inside this one."""
        return Names(list(self.numbers), list(self.texts), list(self.lists), list(self.flags))


class Expressions:
    """Writes expressions; `defect` is the probability that one of them is replaced by a defective one."""

    def __init__(self, random: Random, defect: float) -> None:
        self.random, self._defect = random, defect

    def number(self, names: Names, depth: int = 3) -> str:
        """Return an expression that is a number."""
        pick = self.random.choice
        if self.random.random() < self._defect:
            return pick(_DEFECTS)
        if depth == 0 or self.random.random() < 0.25:
            return pick([*names.numbers * 2, pick(_LITERALS), pick(_CONSTANTS)])

        def inner() -> str:
            return self.number(names, depth - 1)

        forms: tuple[Callable[[], str], ...] = (
            lambda: f"{inner()} {pick('+-*')} {inner()}",
            lambda: f"{inner()}{pick('+-*')}{inner()}",
            lambda: f"({inner()} {pick('+-*')} {inner()})",
            lambda: f"({inner()}) / {pick(_LITERALS[1:])}",
            lambda: f"({inner()}) {pick(('//', '%'))} {pick(_LITERALS[1:])}",
            lambda: f"{pick('-+')}{inner()}",
            lambda: f"({inner()}) ** {pick(('2', '3', '0', '1'))}",
            lambda: f"(1 + ({inner()}) ** 2) ** {pick(('0.5', '-1', '-0.5'))}",
            lambda: f"{pick(_FUNCTIONS)}({inner()})",
            lambda: f"{pick(('min', 'max', 'atan2', 'hypot', 'python.max'))}({inner()}, {inner()})",
            lambda: f"({inner()} if {self.flag(names, depth - 1)} else {inner()})",
            lambda: f"len({pick((self.text, self.values))(names, depth - 1)})",
            lambda: f"({self.values(names, depth - 1)} + [1])[{pick(('0', '-1', '0'))}]",
            lambda: (
                f"{pick(('max', 'min', 'python.sum'))}([{pick(_LITERALS)}] + {self.values(names, depth - 1)})"
            ),
            lambda: f"{pick(('sqrt', 'math.sqrt'))}(fabs({inner()}))",
            lambda: f"{pick(('log', 'log10'))}(1 + fabs({inner()}))",
            lambda: f"{pick(('asin', 'acos'))}(sin({inner()}))",
            lambda: f"round({inner()}, {pick('123')})",
            lambda: f"float(str({inner()}))",
        )
        return pick(forms)()

    def text(self, names: Names, depth: int = 2) -> str:
        """Return an expression that is a text."""
        pick = self.random.choice
        if depth == 0 or self.random.random() < 0.3:
            return pick([*names.texts, repr(pick(_WORDS))])

        def inner() -> str:
            return self.text(names, depth - 1)

        forms: tuple[Callable[[], str], ...] = (
            lambda: f"{inner()} + {inner()}",
            lambda: f"str({self.number(names, depth - 1)})",
            lambda: f"({inner()}).{pick(_METHODS)}",
            lambda: f"({inner()})[{pick(('0:2', '1:', ':-1', '::-1', '::2'))}]",
            lambda: f"({inner()}) * {pick('0123')}",
            lambda: f"' '.join([str(v) for v in {self.values(names, depth - 1)}])",
            lambda: f"({inner()} if {self.flag(names, depth - 1)} else {inner()})",
            lambda: f"'{pick(('%s', '%.3f', '%d', '%5.1f'))}' % ({self.number(names, depth - 1)})",
        )
        return pick(forms)()

    def values(self, names: Names, depth: int = 2) -> str:
        """Return an expression that is a list of numbers, seldom empty."""
        pick = self.random.choice
        if depth == 0 or self.random.random() < 0.3:
            return pick([*names.lists, "[1, 2.5, 3]", "[0.1]", "list(range(3))"])

        def inner() -> str:
            return self.values(names, depth - 1)

        forms: tuple[Callable[[], str], ...] = (
            lambda: f"[{self.number(names, depth - 1)}, {self.number(names, depth - 1)}]",
            lambda: f"({inner()} + {inner()})",
            lambda: f"[v * {pick(_LITERALS)} for v in {inner()}]",
            lambda: f"[v for v in {inner()} if v {pick(_COMPARISONS)} {pick(_LITERALS)}]",
            lambda: f"sorted({inner()})",
            lambda: f"({inner()})[{pick((':2', '-2:', '::-1'))}]",
            lambda: f"[float(v) for v in '1 2 {pick(('0.5', '1e2', '7'))}'.split()]",
            lambda: f"[i + j for i in range(2) for j in {inner()}]",
        )
        return pick(forms)()

    def flag(self, names: Names, depth: int = 2) -> str:
        """Return an expression that is true or false."""
        pick = self.random.choice
        if depth <= 0 or self.random.random() < 0.2:
            return pick([*names.flags, "True", "False", "1", "0"])

        def inner() -> str:
            return self.flag(names, depth - 1)

        def number() -> str:
            return self.number(names, depth - 1)

        forms: tuple[Callable[[], str], ...] = (
            lambda: f"{number()} {pick(_COMPARISONS)} {number()}",
            lambda: f"{number()} < {number()} <= {number()}",
            lambda: f"({inner()} {pick(('and', 'or'))} {inner()})",
            lambda: f"(not {inner()})",
            lambda: (
                f"{self.text(names, depth - 1)} {pick(('==', '!=', 'in', 'not in'))} {self.text(names, depth - 1)}"
            ),
            lambda: f"{pick(_LITERALS)} in {self.values(names, depth - 1)}",
            lambda: f"bool({number()})",
        )
        return pick(forms)()
