"""The texts that may replace one from which a value is computed, so that the value is what its uses need.

They are tried, not derived: small changes of an expression, as in mistakes (a sign, an operator, a name, a half), the
plain value, and other numbers, which are solved for.
"""

import re
from collections.abc import Iterator, Sequence
from contextlib import suppress
from itertools import combinations, islice
from math import isclose, isfinite, nan

from grader.edits import merged
from grader.names import closest
from grader.static_python.budget import Budget, OutOfBudget
from grader.static_python.values import ExpressionFails, Undetermined
from grader.xacro.scopes import Key, XacroScope, literal
from grader.xacro.texts import Texts
from grader.xacro.written import Use, Written

_WORK = 300_000  # parts that all evaluations for one document may look at
_MAX_NAMES = 24  # that are tried in place of another one
_MAX_DIGITS = 6
_NICE_DIGITS = 3  # more are no number that a student would write into an expression
_TOLERANCE = 1e-3  # relative: -1.57 is -pi/2
_LITERAL = 20  # the rank of a text in place of an expression
EXPRESSION = re.compile(r"\$\{([^}]*)\}")
NAME = re.compile(r"(?<![\w.])[^\W\d]\w*(?![\w.(])")
_PLAIN = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*")
# -0.1 with its sign after a space or quote, or at the start; 2 without it in ${a-2}, where it may be an operator.
_NUMBER = re.compile(r"""(?:(?<![^\s'"])[-+]?|(?<![\w.]))(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?(?![\w.])""")
TOKEN = re.compile(r"(?:\$\{[^}]*\}|\$\([^)]*\)|[^\s$]|\$)+")
ARGUMENT = re.compile(r"\$\(arg\s+([^\s()]+)\s*\)")
_LOOSE = re.compile(r"(?<!\$)\{(\w+)\}|\$\((\w+)\)|\$(?=\w)(\w+)")
_WORD = re.compile(r"(?<![\w${.(])[^\W\d]\w*(?![\w(])")
_MAX_VARIANTS = 80  # of one text
_MAX_PARTS = 4  # that are exchanged
# Kinds of changes, the most plausible first.
SPELLING, SIGN, NUMBER, OPERATOR, HALF, FACTOR, OTHER_NUMBER, OTHER_NAME = range(8)
_OPERATOR = r"(?<=[\w.)\s])(?<!\*){}(?![*/])"
_WITHOUT = r"\b{}\s*\*\s*"
# What is replaced by what in an expression; {} is each parameter of the macro around it.
_CHANGES = (
    (SIGN, r"\A\s*-\s*", ""),
    (SIGN, r"\A\s*\+?", "-"),
    (SIGN, r"\A(.*)\Z", r"-(\1)"),
    *((OPERATOR, _OPERATOR.format(re.escape(old)), new) for old, new in ("+-", "-+", "*/", "/*")),
    (OPERATOR, r"(?<!\w)\(([^()]*)\)", r"\1"),
    *((OPERATOR, r"(?<=[\w)])\s+(?=[\w(])", f" {sign} ") for sign in "+-*/"),
    (FACTOR, _WITHOUT, ""),
    (FACTOR, r"\A(.*)\Z", r"{}*(\1)"),
    (FACTOR, _WITHOUT.format("radians"), ""),
    (FACTOR, r"\A(.*)\Z", r"radians(\1)"),
    (HALF, r"\A(?!.*/\s*[\d.]+\Z).*\Z", r"\g<0>/2"),
    (HALF, r"\A(?!.*/\s*[\d.]+\Z)(.*)\Z", r"(\1)/2"),
    (HALF, r"\s*/\s*2(?![\w.])", ""),
    (HALF, r"\A(.*)\Z", r"2*(\1)"),
)


class Candidates:
    """Finds the texts that may replace one, in the scopes of one expanded document."""

    def __init__(self, texts: Texts) -> None:
        self._texts = texts
        self._budget = Budget(_WORK)
        self._known: dict[int, tuple[XacroScope, tuple[list[str], list[str]]]] = {}

    def of(self, site: Written, root: Written, uses: Sequence[Use]) -> Iterator[tuple[int, str]]:
        """Yield the texts of a site with which the root fits its uses: variants, the plain value, solved numbers."""
        text = site.text

        def fits(other: str) -> bool:
            return all(near(self._with(site, root, other, use), use.new) for use in uses)

        kinds: set[int] = set()
        for kind, other in _variants(text, *self._names(site.scope)):
            if kind not in kinds and fits(other):
                kinds.add(kind)
                yield kind, other
        if len({use.new for use in uses}) == 1 and fits(plain := _plain(site, uses[0].new)):
            yield _LITERAL if "$" in text else NUMBER, plain
        for slot in _NUMBER.finditer(text):
            is_plain = not any(it.start() < slot.start() < it.end() for it in EXPRESSION.finditer(text))
            solutions = ((digits, other) for digits, other in self._solutions(site, root, slot, uses) if fits(other))
            for digits, other in islice(solutions, 1):
                if is_plain or digits <= _NICE_DIGITS:
                    yield NUMBER if is_plain or digits == 1 else OTHER_NUMBER, other

    def _solutions(
        self, site: Written, root: Written, slot: re.Match[str], uses: Sequence[Use]
    ) -> Iterator[tuple[int, str]]:
        """Yield the text with the number, or its inverse, that the first use needs, with more and more digits."""
        first = next((use for use in uses if not is_equal_value(use.old, use.new)), uses[0])
        pairs = enumerate(zip(first.old.split(), first.new.split(), strict=False))
        index = next((index for index, pair in pairs if not is_equal_value(*pair)), 0)

        def at(text: str | None) -> float:
            words = (text or "").split()
            return _number(words[index]) if index < len(words) else nan

        def of(value: float) -> float:
            return at(self._with(site, root, _with_number(site.text, slot, repr(value)), first))

        for power in (1, -1):  # what is linear in a number, or in a divisor
            with suppress(ZeroDivisionError, OverflowError):
                near = float(slot[0])
                far = near * 1.015625 + 1e-3
                low, high = of(near) ** power, of(far) ** power
                found = near + (at(first.new) ** power - low) * (far - near) / (high - low)
                for digits in range(1, _MAX_DIGITS + 1) if isfinite(found) else ():
                    short = float(f"{found:.{digits}g}") + 0.0
                    yield digits, _with_number(site.text, slot, f"{short:.9g}")

    def _with(self, site: Written, root: Written, text: str, use: Use) -> str | None:
        return self.value(text, use.scope) if site.key is None else self.value(root.text, use.scope, {site.key: text})

    def value(self, text: str, scope: XacroScope, supposed: dict[Key, str] | None = None) -> str | None:
        """Return what a text is in the expanded file; None if it has no value, or the budget is spent."""
        try:
            return self._texts.supposing(supposed or {}, self._budget).text(text, scope)
        except (ExpressionFails, Undetermined, OutOfBudget, RecursionError):
            return None

    def _names(self, scope: XacroScope) -> tuple[list[str], list[str]]:
        """Return the names that have values in a scope, and those of the innermost macro."""
        if id(scope) not in self._known:
            names = dict.fromkeys(scope.names()[:_MAX_NAMES])
            found = [name for name in names if self.value(f"${{{name}}}", scope) is not None]
            own = scope.properties if scope.parent is not None else {}
            self._known[id(scope)] = scope, (found, [name for name in found if name in own])
        return self._known[id(scope)][1]


def _plain(site: Written, new: str) -> str:
    """Return a value as it is written at a site: a number in its place, in quotes where the site is an expression's."""
    is_number = isfinite(_number(site.text)) and site.text == site.text.strip()
    if site.key is not None and site.text != literal(site.text) and not is_number:
        return f"'{new}'"
    return merged(site.text, new) if is_number else new


def _number(text: str) -> float:
    try:
        return float(text) if "_" not in text else nan
    except ValueError:
        return nan


def near(text: str | None, wanted: str, tolerance: float = _TOLERANCE) -> bool:
    """Return whether a text, or each number in it, is as good as the wanted one."""
    one, other = [[_number(word) for word in (it or "").split()] for it in (text, wanted)]
    is_alike = text is not None and 0 < len(one) == len(other)
    pairs = zip(one, other, strict=False)
    return text == wanted or (is_alike and all(isclose(a, b, rel_tol=tolerance, abs_tol=1e-6) for a, b in pairs))


def is_equal_value(one: str, other: str) -> bool:
    """Return whether two texts are equal, or their numbers nearly are."""
    return near(one, other, 1e-9)


def _with_number(text: str, slot: re.Match[str], number: str) -> str:
    """Return a text with another number, in parentheses where its sign would follow another one."""
    before = text[: slot.start()].rstrip()[-1:]
    shown = f"({number})" if number.startswith("-") and before in ("-", "+", "*") else number
    return f"{text[: slot.start()]}{shown}{text[slot.end() :]}"


def _variants(text: str, names: Sequence[str], own: Sequence[str]) -> Iterator[tuple[int, str]]:
    """Yield texts with one change of an expression, each with its rank: the smaller, the more plausible.

    `names` are known at this place; `own` are the parameters of the macro around it.
    """
    yield from ((SPELLING, other) for other in _respelt(text, own))
    parts = [*TOKEN.finditer(text)] if "$" in text else []
    for one, other in combinations(parts[:_MAX_PARTS], 2):  # x and z exchanged
        yield SIGN, text[: one.start()] + other[0] + text[one.end() : other.start()] + one[0] + text[other.end() :]
    for found in EXPRESSION.finditer(text):
        start, end = found.span(1)
        for rank, inner in islice(_of_expression(found[1].strip(), names, own), _MAX_VARIANTS):
            yield rank, f"{text[:start]}{inner}{text[end:]}"
    if _PLAIN.fullmatch(text):
        number = text.strip()
        for sign in own:
            for magnitude in (number.lstrip("+-"), number):
                yield FACTOR, f"${{{sign}*{magnitude}}}"


def _respelt(text: str, own: Sequence[str]) -> Iterator[str]:
    """Yield texts in which what may be meant as an expression is one."""
    if _LOOSE.search(text):  # {side}, $(side) and $side
        yield _LOOSE.sub(lambda found: f"${{{found[1] or found[2] or found[3]}}}", text)
    for found in re.finditer(r"(?<=[\w)])(?=\s|\Z)", text) if text.count("${") > text.count("}") else ():
        yield f"{text[: found.end()]}}}{text[found.end() :]}"
    for found in _WORD.finditer(text) if "${" not in text else ():  # the name of a parameter, not its value
        if found[0] in own:
            yield f"{text[: found.start()]}${{{found[0]}}}{text[found.end() :]}"


def _of_expression(text: str, names: Sequence[str], own: Sequence[str]) -> Iterator[tuple[int, str]]:
    for rank, pattern, new in _CHANGES:
        for factor in own if "{}" in pattern + new else [""]:
            for found in re.finditer(pattern.replace("{}", factor), text):
                other = text[: found.start()] + found.expand(new.replace("{}", factor)) + text[found.end() :]
                yield rank, re.sub(r"(?<!\w)\(([\w.]+)\)", r"\1", other)
    for found in NAME.finditer(text):
        for name in sorted(names, key=lambda name: name != closest(found[0], names)):
            if name != found[0]:
                yield OTHER_NAME, f"{text[: found.start()]}{name}{text[found.end() :]}"
