"""The ways to give an attribute of an expanded element another value: edits of the xacro that it comes from."""

import re
from itertools import islice, product
from typing import NamedTuple

from grader import markup
from grader.edits import merged, with_attribute
from grader.names import closest
from grader.source import Edit
from grader.xacro.scopes import Place, Scope, literal
from grader.xacro.solving import ComputedNumber, Evaluator, Ranked, as_number, definitions
from grader.xacro.texts import PIECE, Texts
from grader.xacro.variants import EXPRESSION, NAME, variants
from grader.xacro.written import Change, Written, defined, edits_of, written

_TOKEN = re.compile(r"(?:\$\{[^}]*\}|\$\([^)]*\)|[^\s$]|\$)+")
_SINGLE = re.compile(r"\s*\$(?:\{\s*(?:[^\W\d]\w*)\s*\}|\(arg\s+[^\s()]+\s*\))\s*")
_MAX_WAYS = 6
_MAX_DEPTH = 6  # names that stand for each other
_MAX_CHOICES = 3  # for each number, where several change

Way = tuple[Change, ...]
_LAST = (9, 0)  # the rank of a number in place of an expression


class Token(NamedTuple):
    """A part of a text without spaces, and the words that it is in the expanded file."""

    written: Written
    words: list[str]


class Rewriter:
    """Makes the edits of one expanded document."""

    def __init__(self, texts: Texts) -> None:
        self._evaluator = Evaluator(texts)
        self._numbers: dict[tuple[str, int, int, int, int], ComputedNumber] = {}

    def ways(self, place: Place, attribute: str, old: str, new: str) -> list[tuple[Edit, ...]]:
        """Return the ways to change an attribute at a place that the reader sees as `old`, the most plausible first."""
        text = written(place, attribute, place.scope or Scope())
        ways = islice(self._ways(text, old, new, 0), _MAX_WAYS) if text is not None else ()
        found = [edits for edits in map(edits_of, ways) if edits is not None]
        if found and text is not None and self._evaluator.text(text.text, text.scope) is None:
            return found  # a name is misspelt
        source, start = place.source.element(place.tag)
        current = markup.attribute(source.text, start, attribute)
        raw = source.text[current.value_start : current.value_end] if current is not None else ""
        found.append((with_attribute(source, start, attribute, merged(raw, new)),))
        return list(dict.fromkeys(found))

    def _ways(self, text: Written, old: str, new: str, depth: int) -> "list[Way]":
        """Return the ways to make a text another one after expansion."""
        if depth > _MAX_DEPTH:
            return []
        value = self._evaluator.text(text.text, text.scope)
        if value is None:
            return [*self._respelled(text), *self._repaired(text, new)]
        if not _same(value, old):
            return []  # a name has another value by now
        are_numbers = all(as_number(word) is not None for word in (*old.split(), *new.split()))
        if are_numbers and len(old.split()) == len(new.split()):
            return self._of_numbers(text, old.split(), new.split(), depth)
        return self._of_text(text, old, new, depth)

    def _respelled(self, text: Written) -> list[Way]:
        """Return the ways to correct a name that is not defined."""
        ways: list[Way] = []
        for expression in EXPRESSION.finditer(text.text):
            for name in NAME.finditer(expression[1]):
                near = closest(name[0], text.scope.names()) if text.scope.holder(name[0]) is None else None
                if near is not None:
                    start = expression.start(1) + name.start()
                    ways.append((Change(text.part(start, start + len(name[0])), near),))
        return ways

    def _repaired(self, text: Written, new: str) -> list[Way]:
        """Return the changes of an expression that fails which give the wanted value, as ${side} for ${-side}."""
        names, signs = self._evaluator.names(text.scope)
        values = ((other, self._evaluator.text(other, text.scope)) for _, other in variants(text.text, names, signs))
        return [(Change(text, other),) for other, value in values if value is not None and _same(value, new)]

    def _of_numbers(self, text: Written, old: list[str], new: list[str], depth: int) -> list[Way]:
        choices: list[list[Way]] = []
        for token, wanted in self._tokens(text, old, new):
            if not _same(" ".join(token.words), " ".join(wanted)):
                choices.append(self._of_token(token, wanted, depth)[: _MAX_WAYS if not choices else _MAX_CHOICES])
        if len(choices) > 1:
            choices = [ways[:_MAX_CHOICES] for ways in choices]
        ways = [sum(parts, ()) for parts in islice(product(*choices), 4 * _MAX_WAYS)] if choices else []
        return [way for way in ways if edits_of(way) is not None]

    def _tokens(self, text: Written, old: list[str], new: list[str]) -> list[tuple[Token, list[str]]]:
        """Return the parts of a text, each with the words that it should be; none where they cannot be told apart."""
        found: list[tuple[Token, list[str]]] = []
        position = 0
        for match in _TOKEN.finditer(text.text):
            part = text.part(*match.span())
            words = (self._evaluator.text(part.text, part.scope) or "").split()
            end = position + len(words)
            found.append((Token(part, words), new[position:end]))
            position = end
        return found if [word for token, _ in found for word in token.words] == old else []

    def _of_token(self, token: Token, wanted: list[str], depth: int) -> list[Way]:
        part, words = token
        plain: Way = (Change(part, " ".join(wanted)),)
        if len(words) != 1:
            inner = self._of_name(part, " ".join(words), " ".join(wanted), depth)
            return [*(inner or self._in_list(token, wanted)), plain]
        kept = Change(part, merged(part.text, wanted[0]))
        if "$" not in part.text:
            signed = [ranked for ranked in self._number(part).changes(float(wanted[0])) if "$" in ranked.change.new]
            return [(kept,), *((ranked.change,) for ranked in signed[:1])]
        changes = [*self._number(part).changes(float(wanted[0]))[: _MAX_WAYS - 1], Ranked(_LAST, kept)]
        return [(ranked.change,) for ranked in changes]

    def _in_list(self, token: Token, wanted: list[str]) -> list[Way]:
        """Return the ways to change one of the numbers that an expression gives, as ${colours['green']}."""
        off = [index for index, pair in enumerate(zip(token.words, wanted, strict=True)) if not _same(*pair)]
        changes = self._number(token.written, off[0]).changes(float(wanted[off[0]])) if len(off) == 1 else []
        return [(ranked.change,) for ranked in changes]

    def _number(self, part: Written, index: int = 0) -> ComputedNumber:
        key = part.source.path, part.start, part.end, id(part.scope), index
        if key not in self._numbers:
            self._numbers[key] = ComputedNumber(self._evaluator, part, index)
        return self._numbers[key]

    def _of_name(self, text: Written, old: str, new: str, depth: int) -> list[Way]:
        """Return the ways to change what a name stands for."""
        if not _SINGLE.fullmatch(text.text):
            return []
        ways: list[Way] = []
        for definition in definitions(text, self._evaluator):
            inner = defined(definition)
            if inner is not None and inner.text != literal(inner.text) == old:
                inner = inner.part(1, len(inner.text) - 1)  # in quotes
            ways += self._ways(inner, old, new, depth + 1) if inner is not None else []
        return ways

    def _of_text(self, text: Written, old: str, new: str, depth: int) -> list[Way]:
        """Return the ways to change one part of a text: one that is written out, or what a name stands for."""
        pieces = [text.part(*found.span()) for found in PIECE.finditer(text.text)]
        values = [self._evaluator.text(piece.text, piece.scope) or "" for piece in pieces]
        if "".join(values) != old:
            return []
        literals: list[Way] = []
        named: list[Way] = []
        for index, piece in enumerate(pieces):
            before, after = "".join(values[:index]), "".join(values[index + 1 :])
            if len(new) < len(before) + len(after) or not (new.startswith(before) and new.endswith(after)):
                continue
            middle = new[len(before) : len(new) - len(after)]
            if "$" not in piece.text:
                literals.append((Change(piece, middle),))
            else:
                named += self._of_name(piece, values[index], middle, depth)
        return [*literals, *named]


def _same(one: str, other: str) -> bool:
    """Return whether two texts, or two lists of numbers, are the same."""
    if one == other:
        return True
    pairs = [(as_number(a), as_number(b)) for a, b in zip(one.split(), other.split(), strict=False)]
    return len(one.split()) == len(other.split()) and all(
        a is not None and b is not None and abs(a - b) < 1e-9 for a, b in pairs
    )
