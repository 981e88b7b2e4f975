"""A number of the expanded file and the texts that it is computed from: which change of one of them gives another number."""

import re
from collections.abc import Callable, Iterator
from functools import cached_property
from typing import NamedTuple

from grader.static_python.closed_values import Budget, ExpressionFails, OutOfBudget, Undetermined
from grader.xacro.scopes import Definition, Key, Scope
from grader.xacro.texts import Texts
from grader.xacro.variants import EXPRESSION, NAME, NUMBER, Slot, numbers, variants, with_number
from grader.xacro.written import Change, Written, defined

_ARGUMENT = re.compile(r"\$\(arg\s+([^\s()]+)\s*\)")
_WORK = 150_000  # parts that all evaluations for one document may look at
_MAX_SITES = 10  # texts that one number is computed from
_MAX_NAMES = 24  # that are tried in place of another one
_MAX_DIGITS = 6
_NICE_DIGITS = 3  # more are no number that a student would write into an expression
_ROUNDS = 4  # of the secant method
_TOLERANCE = 1e-3  # relative: -1.57 is -pi/2


class Ranked(NamedTuple):
    """A change; the smaller the rank, the more plausible."""

    rank: tuple[int, int]
    change: Change


class Evaluator:
    """What texts would be if others were written where names are defined; all within one budget."""

    def __init__(self, texts: Texts) -> None:
        self._texts = texts
        self._budget = Budget(_WORK)
        self._known: dict[int, tuple[Scope, tuple[list[str], list[str]]]] = {}

    def text(self, text: str, scope: Scope, supposed: dict[Key, str] | None = None) -> str | None:
        """Return what a text is in the expanded file; None if it has no value, or the budget is spent."""
        try:
            return self._texts.supposing(supposed or {}, self._budget).text(text, scope)
        except (ExpressionFails, Undetermined, OutOfBudget, RecursionError):
            return None

    def arguments(self, text: str) -> list[Definition]:
        """Return the defaults of the arguments in a text."""
        return [self._texts.defaults[name] for name in _ARGUMENT.findall(text) if name in self._texts.defaults]

    def names(self, scope: Scope) -> tuple[list[str], list[str]]:
        """Return the names that have numbers in a scope, and those of the innermost macro that are 1 or -1."""
        if id(scope) not in self._known:
            found = dict.fromkeys(scope.names()[:_MAX_NAMES])
            values = {name: as_number(self.text(f"${{{name}}}", scope)) for name in found}
            own = scope.properties if scope.parent is not None else {}
            signs = [name for name, value in values.items() if name in own and value in (1.0, -1.0)]
            self._known[id(scope)] = scope, ([name for name, value in values.items() if value is not None], signs)
        return self._known[id(scope)][1]


def as_number(text: str | None) -> float | None:
    """Return a text as a number; None if it is none."""
    try:
        return float(text) if text is not None and "_" not in text else None
    except ValueError:
        return None


def is_near(value: float | None, wanted: float) -> bool:
    """Return whether a number is as good as the wanted one."""
    return value is not None and abs(value - wanted) <= _TOLERANCE * abs(wanted) + 1e-6


class Site(NamedTuple):
    """A text that a number is computed from; `key` is None for the text of the attribute itself."""

    written: Written
    key: Key | None
    rank: int


class ComputedNumber:
    """A number in an attribute, such as ${-length/4}; one of several, where an expression gives a list of them."""

    def __init__(self, evaluator: Evaluator, written: Written, index: int) -> None:
        self.written = written
        self._index = index
        self._evaluator = evaluator
        self._memo: dict[tuple[Key | None, str], float | None] = {}

    def changes(self, wanted: float) -> list[Ranked]:
        """Return the changes of one text that give the wanted number, the most plausible first."""
        found: dict[Change, Ranked] = {}
        for site in self._sites:
            for ranked in (*self._varied(site, wanted), *self._solved(site, wanted)):
                found.setdefault(ranked.change, ranked)
        return sorted(found.values(), key=lambda ranked: ranked.rank)

    @cached_property
    def _sites(self) -> list[Site]:
        sites: dict[Key | None, Site] = {None: Site(self.written, None, 0)}
        pending = [self.written]
        while pending and len(sites) < _MAX_SITES:
            for definition in definitions(pending.pop(0), self._evaluator):
                text = defined(definition)
                if text is not None and definition.key not in sites:
                    is_given = definition.attribute not in ("params", "value", "default")
                    sites[definition.key] = Site(text, definition.key, 0 if is_given else 1)
                    pending.append(text)
        return list(sites.values())

    def _with(self, site: Site, text: str) -> float | None:
        """Return the number that another text at a site gives."""
        if (site.key, text) not in self._memo:
            root, supposed = (text, None) if site.key is None else (self.written.text, {site.key: text})
            words = (self._evaluator.text(root, self.written.scope, supposed) or "").split()[self._index :]
            self._memo[site.key, text] = as_number(words[0]) if words else None
        return self._memo[site.key, text]

    def _varied(self, site: Site, wanted: float) -> Iterator[Ranked]:
        kinds: set[int] = set()
        for kind, text in variants(site.written.text, *self._evaluator.names(site.written.scope)):
            if kind not in kinds and is_near(self._with(site, text), wanted):
                kinds.add(kind)
                yield Ranked((kind + 2 * site.rank, 0), Change(site.written, text))

    def _solved(self, site: Site, wanted: float) -> Iterator[Ranked]:
        for slot in numbers(site.written.text):
            solution = self._solution(site, slot, wanted)
            is_plain = slot.end - slot.start == len(site.written.text.strip())
            if solution is not None and (is_plain or solution[1] <= _NICE_DIGITS):
                text, digits = solution
                yield Ranked((NUMBER + 2 * site.rank + (not is_plain), digits), Change(site.written, text))

    def _solution(self, site: Site, slot: Slot, wanted: float) -> tuple[str, int] | None:
        """Return the text with the number in a slot that gives the wanted one, and how many digits it has."""

        def of(number: float) -> float | None:
            return self._with(site, with_number(site.written.text, slot, repr(number)))

        root = secant(of, slot.value, wanted)
        if root is None and wanted:  # a divisor: 1/f is linear
            root = secant(lambda number: 1.0 / (of(number) or 0.0), slot.value, 1.0 / wanted)
        for digits in range(1, _MAX_DIGITS + 1) if root is not None else ():
            text = with_number(site.written.text, slot, decimal(root or 0.0, digits))
            if is_near(self._with(site, text), wanted):
                return text, digits
        return None


def secant(of: Callable[[float], float | None], start: float, wanted: float) -> float | None:
    """Return where a function has the wanted value; None if a few steps of the secant method do not find it."""
    before, x = start, start + 1e-3 + abs(start) / 64
    try:
        value, now = of(before), of(x)
        for _ in range(_ROUNDS):
            if value is None or now is None or now == value:
                return None
            before, x = x, x + (wanted - now) * (x - before) / (now - value)
            value, now = now, of(x)
            if now is not None and abs(wanted - now) <= 1e-9 * (1 + abs(wanted)):
                return x
    except (ZeroDivisionError, OverflowError):
        pass
    return None


def decimal(value: float, digits: int) -> str:
    """Return a number with so many significant digits, without an exponent where it can be."""
    text = f"{value:.{digits}g}"
    if "e" in text and 1e-9 < abs(value) < 1e9:
        text = f"{float(text):.9f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def definitions(text: Written, evaluator: Evaluator) -> Iterator[Definition]:
    """Yield where the names in the expressions of a text are defined."""
    for expression in EXPRESSION.findall(text.text):
        for name in NAME.findall(expression):
            holder = text.scope.holder(name)
            definition = holder.properties[name].definition if holder is not None else None
            if definition is not None:
                yield definition
    yield from evaluator.arguments(text.text)
