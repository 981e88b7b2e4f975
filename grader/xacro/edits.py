"""The ways to give expanded elements other values: edits of the xacro texts that they come from.

A text in a macro is used by each call, in its own scope, and one change of it must give each use what it should be. The
texts are the attribute itself, and those that define the names in it. Their changes are tried, not derived: small
variants of an expression, and other numbers, which are solved for.
"""

import re
from collections.abc import Iterator, Sequence
from contextlib import suppress
from itertools import islice, product
from math import isclose, isfinite, nan
from typing import NamedTuple

from grader import markup
from grader.edits import merged, with_attribute
from grader.source import Edit, Edits
from grader.static_python.closed_values import Budget, ExpressionFails, OutOfBudget, Undetermined
from grader.xacro.scopes import Definition, Key, ScopePlace, XacroScope, literal
from grader.xacro.texts import PIECE, Texts
from grader.xacro.variants import (
    ARGUMENT,
    EXPRESSION,
    NAME,
    NUMBER,
    OTHER_NUMBER,
    TOKEN,
    numbers,
    variants,
    with_number,
)
from grader.xacro.written import TextChange, Written, defined, edits_of, written

_WORK = 300_000  # parts that all evaluations for one document may look at
_MAX_WAYS = 8
_MAX_SITES = 10  # texts that one value is computed from
_MAX_NAMES = 24  # that are tried in place of another one
_MAX_CHOICES = 3  # for each number, where several change
_MAX_USES = 12
_MAX_DIGITS = 6
_NICE_DIGITS = 3  # more are no number that a student would write into an expression
_TOLERANCE = 1e-3  # relative: -1.57 is -pi/2
_LITERAL = 20  # the rank of a text in place of an expression

Way = tuple[TextChange, ...]


class Use(NamedTuple):
    """A use of a text: the scope in which it is evaluated, what it is and should be, and the macro calls around it."""

    scope: XacroScope
    old: str
    new: str
    calls: tuple[tuple[str, ScopePlace], ...] = ()


class Rewriter:
    """Makes the edits of one expanded document."""

    def __init__(self, texts: Texts) -> None:
        self._texts = texts
        self._budget = Budget(_WORK)
        self._known: dict[int, tuple[XacroScope, tuple[list[str], list[str]]]] = {}

    def ways(self, place: ScopePlace, attribute: str, uses: Sequence[Use]) -> list[Edits]:
        """Return the ways to change an attribute (or, without a name, the text) for its uses, the most plausible first.

        Those with which all uses get what they should be come first, then those for the changed ones.
        """
        text = written(place, attribute, uses[0].scope)
        changed = [use for use in uses if not _same(use.old, use.new)]
        found: list[Edits] = []
        for several in dict.fromkeys((tuple(uses), tuple(changed))) if changed else ():
            if text is not None:
                ways = sorted(islice(self._ways(text, several[:_MAX_USES]), 60), key=lambda way: way[0])
                found += [edits for _, way in ways if (edits := edits_of(way)) is not None]
                found += self._at_calls(text, several) if not found else []
        if attribute and len({use.new for use in changed}) == 1:
            source, start = place.source.element(place.tag)
            current = markup.attribute(source.text, start, attribute)
            raw = source.text[current.value_start : current.value_end] if current is not None else ""
            found.insert(_MAX_WAYS - 1, (with_attribute(source, start, attribute, merged(raw, changed[0].new)),))
        return list(dict.fromkeys(found))[:_MAX_WAYS]

    def _ways(self, text: Written, uses: Sequence[Use]) -> Iterator[tuple[int, Way]]:
        """Yield the changes with which a text is what its uses need, each with its rank."""
        values = [self._value(text.text, use.scope) for use in uses]
        if any(value is not None and not _same(value, use.old) for value, use in zip(values, uses, strict=True)):
            return  # a name has another value by now
        yield from self._changes(text, uses)
        if None not in values:
            yield from self._of_parts(text, uses)

    def _of_parts(self, text: Written, uses: Sequence[Use]) -> Iterator[tuple[int, Way]]:
        """Yield changes of the wrong parts of a text: of the numbers of a list, or of what is around one part."""
        tokens = [text.part(*found.span()) for found in TOKEN.finditer(text.text)]
        words = [(use.old.split(), use.new.split()) for use in uses]
        if len(tokens) > 1 and all(len(tokens) == len(old) == len(new) for old, new in words):
            each = [
                [use._replace(old=old[index], new=new[index]) for use, (old, new) in zip(uses, words, strict=True)]
                for index in range(len(tokens))
            ]
            yield from self._of_tokens(tokens, each)
        pieces = [text.part(*found.span()) for found in PIECE.finditer(text.text)]
        values = [[self._value(piece.text, use.scope) or "" for piece in pieces] for use in uses]
        for index, piece in enumerate(pieces if len(pieces) > 1 else ()):
            middles = [_middle(use, found, index) for use, found in zip(uses, values, strict=True)]
            if None not in middles:
                yield from ((rank + 1, way) for rank, way in self._changes(piece, [*filter(None, middles)]))

    def _of_tokens(self, tokens: Sequence[Written], uses: Sequence[Sequence[Use]]) -> Iterator[tuple[int, Way]]:
        """Yield changes of all tokens that are wrong, together."""
        wrong: list[list[tuple[int, Way]]] = []
        for token, own in zip(tokens, uses, strict=True):
            if not all(_same(use.old, use.new) for use in own):
                ways = sorted(islice(self._changes(token, own), 40), key=lambda way: way[0])
                wrong.append(ways[: _MAX_CHOICES if wrong else _MAX_WAYS])
        for parts in islice(product(*wrong), 4 * _MAX_WAYS):
            yield sum(rank for rank, _ in parts), tuple(change for _, way in parts for change in way)

    def _changes(self, root: Written, uses: Sequence[Use]) -> Iterator[tuple[int, Way]]:
        """Yield the changes of one text with which another one, that is computed from it, is what its uses need."""
        changed = [use.scope for use in uses if not _same(use.old, use.new)] or [uses[0].scope]
        sites = {site.key: (rank, site) for scope in changed for rank, site in self._sites(root, scope)}
        for first, site in sites.values():
            for rank, other in self._candidates(site, root, uses):
                yield rank + first, (TextChange(site, other),)

    def _candidates(self, site: Written, root: Written, uses: Sequence[Use]) -> Iterator[tuple[int, str]]:
        """Yield the texts of a site with which the root fits its uses: variants, the plain value, solved numbers."""
        text = site.text

        def fits(other: str) -> bool:
            return all(_near(self._with(site, root, other, use), use.new) for use in uses)

        kinds: set[int] = set()
        for kind, other in variants(text, *self._names(site.scope)):
            if kind not in kinds and fits(other):
                kinds.add(kind)
                yield kind, other
        if len({use.new for use in uses}) == 1 and fits(plain := _plain(site, uses[0].new)):
            yield _LITERAL if "$" in text else NUMBER, plain
        for slot in numbers(text):
            is_plain = not any(it.start() < slot.start() < it.end() for it in EXPRESSION.finditer(text))
            solutions = ((digits, other) for digits, other in self._solutions(site, root, slot, uses) if fits(other))
            for digits, other in islice(solutions, 1):
                if is_plain or digits <= _NICE_DIGITS:
                    yield NUMBER if is_plain or digits == 1 else OTHER_NUMBER, other

    def _solutions(
        self, site: Written, root: Written, slot: re.Match[str], uses: Sequence[Use]
    ) -> Iterator[tuple[int, str]]:
        """Yield the text with the number, or its inverse, that the first use needs, with more and more digits."""
        first = next((use for use in uses if not _same(use.old, use.new)), uses[0])
        pairs = enumerate(zip(first.old.split(), first.new.split(), strict=False))
        index = next((index for index, pair in pairs if not _same(*pair)), 0)

        def at(text: str | None) -> float:
            words = (text or "").split()
            return _number(words[index]) if index < len(words) else nan

        def of(value: float) -> float:
            return at(self._with(site, root, with_number(site.text, slot, repr(value)), first))

        for power in (1, -1):  # what is linear in a number, or in a divisor
            with suppress(ZeroDivisionError, OverflowError):
                near = float(slot[0])
                far = near * 1.015625 + 1e-3
                low, high = of(near) ** power, of(far) ** power
                found = near + (at(first.new) ** power - low) * (far - near) / (high - low)
                for digits in range(1, _MAX_DIGITS + 1) if isfinite(found) else ():
                    short = float(f"{found:.{digits}g}") + 0.0
                    yield digits, with_number(site.text, slot, f"{short:.9g}")

    def _at_calls(self, text: Written, uses: Sequence[Use]) -> list[Edits]:
        """Return the edits that give calls of a macro a value of their own, where they have the default."""
        defaults = [it for it in self._definitions(text, uses[0].scope) if it.attribute == "params"]
        edits: list[Edit] = []
        for use in uses:
            if not _same(use.old, use.new) and use.calls:
                for definition in defaults:
                    for value in (use.new, f"'{use.new}'"):
                        if _near(self._value(text.text, use.scope, {definition.key: value}), use.new):
                            source, start = use.calls[-1][1].source.element(use.calls[-1][1].tag)
                            edits.append(with_attribute(source, start, definition.name, value))
                            break
        return [tuple(dict.fromkeys(edits))] if edits else []

    def _sites(self, root: Written, scope: XacroScope) -> list[tuple[int, Written]]:
        """Return the texts that a text is computed from, itself the first, each with its rank."""
        sites = {root.key: (0, root._replace(scope=scope))}
        pending = [root._replace(scope=scope)]
        while pending and len(sites) < _MAX_SITES:
            for definition in self._definitions(pending[0], pending.pop(0).scope):
                text = defined(definition)
                if text is not None and definition.key not in sites:
                    is_given = definition.attribute not in ("params", "value", "default")
                    sites[definition.key] = (0 if is_given else 2, text)
                    pending.append(text)
        return list(sites.values())

    def _definitions(self, text: Written, scope: XacroScope) -> Iterator[Definition]:
        """Yield where the names in the expressions of a text are defined."""
        for expression in EXPRESSION.findall(text.text):
            for name in NAME.findall(expression):
                holder = scope.holder(name)
                definition = holder.properties[name].definition if holder is not None else None
                if definition is not None:
                    yield definition
        defaults = self._texts.defaults
        yield from (defaults[name] for name in ARGUMENT.findall(text.text) if name in defaults)

    def _with(self, site: Written, root: Written, text: str, use: Use) -> str | None:
        return self._value(text, use.scope) if site.key is None else self._value(root.text, use.scope, {site.key: text})

    def _value(self, text: str, scope: XacroScope, supposed: dict[Key, str] | None = None) -> str | None:
        """Return what a text is in the expanded file; None if it has no value, or the budget is spent."""
        try:
            return self._texts.supposing(supposed or {}, self._budget).text(text, scope)
        except (ExpressionFails, Undetermined, OutOfBudget, RecursionError):
            return None

    def _names(self, scope: XacroScope) -> tuple[list[str], list[str]]:
        """Return the names that have values in a scope, and those of the innermost macro."""
        if id(scope) not in self._known:
            names = dict.fromkeys(scope.names()[:_MAX_NAMES])
            found = [name for name in names if self._value(f"${{{name}}}", scope) is not None]
            own = scope.properties if scope.parent is not None else {}
            self._known[id(scope)] = scope, (found, [name for name in found if name in own])
        return self._known[id(scope)][1]


def _plain(site: Written, new: str) -> str:
    """Return a value as it is written at a site: a number in its place, in quotes where the site is an expression's."""
    is_number = isfinite(_number(site.text)) and site.text == site.text.strip()
    if site.key is not None and site.text != literal(site.text) and not is_number:
        return f"'{new}'"
    return merged(site.text, new) if is_number else new


def _middle(use: Use, values: Sequence[str], index: int) -> Use | None:
    """Return what one part of a text is and should be, if the others stay."""
    before, after = "".join(values[:index]), "".join(values[index + 1 :])
    middle = use.new[len(before) : len(use.new) - len(after)]
    is_alone = "".join(values) == use.old and f"{before}{middle}{after}" == use.new
    return use._replace(old=values[index], new=middle) if is_alone else None


def _number(text: str) -> float:
    try:
        return float(text) if "_" not in text else nan
    except ValueError:
        return nan


def _near(text: str | None, wanted: str, tolerance: float = _TOLERANCE) -> bool:
    """Return whether a text, or each number in it, is as good as the wanted one."""
    one, other = [[_number(word) for word in (it or "").split()] for it in (text, wanted)]
    is_alike = text is not None and 0 < len(one) == len(other)
    pairs = zip(one, other, strict=False)
    return text == wanted or (is_alike and all(isclose(a, b, rel_tol=tolerance, abs_tol=1e-6) for a, b in pairs))


def _same(one: str, other: str) -> bool:
    return _near(one, other, 1e-9)
