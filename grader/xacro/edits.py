"""The ways to give expanded elements other values: edits of the xacro texts that they come from.

A text in a macro is used by each call, in its own scope, and one change of it must give each use what it should be. The
texts are the attribute itself, and those that define the names in it. Their changes are tried, not derived: small
variants of an expression, and other numbers, which are solved for.
"""

from collections.abc import Iterator, Sequence
from itertools import islice, product

from grader import markup
from grader.edits import merged, with_attribute
from grader.source import Edit, Edits
from grader.xacro.candidates import ARGUMENT, EXPRESSION, NAME, TOKEN, Candidates, is_equal_value, near
from grader.xacro.scopes import Definition, ScopePlace, XacroScope
from grader.xacro.texts import PIECE, Texts
from grader.xacro.written import TextChange, Use, Written, definition_text, edits_of, find_text

_MAX_WAYS = 8
_MAX_SITES = 10  # texts that one value is computed from
_MAX_CHOICES = 3  # for each number, where several change
_MAX_USES = 12

Way = tuple[TextChange, ...]


class Rewriter:
    """Makes the edits of one expanded document."""

    def __init__(self, texts: Texts) -> None:
        self._texts = texts
        self._candidates = Candidates(texts)

    def ways(self, place: ScopePlace, attribute: str, uses: Sequence[Use]) -> list[Edits]:
        """Return the ways to change an attribute (or, without a name, the text) for its uses, the most plausible first.

        Those with which all uses get what they should be come first, then those for the changed ones.
        """
        text = find_text(place, attribute, uses[0].scope)
        changed = [use for use in uses if not is_equal_value(use.old, use.new)]
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
        values = [self._candidates.value(text.text, use.scope) for use in uses]
        if any(
            value is not None and not is_equal_value(value, use.old) for value, use in zip(values, uses, strict=True)
        ):
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
        values = [[self._candidates.value(piece.text, use.scope) or "" for piece in pieces] for use in uses]
        for index, piece in enumerate(pieces if len(pieces) > 1 else ()):
            middles = [_middle(use, found, index) for use, found in zip(uses, values, strict=True)]
            if None not in middles:
                yield from ((rank + 1, way) for rank, way in self._changes(piece, [*filter(None, middles)]))

    def _of_tokens(self, tokens: Sequence[Written], uses: Sequence[Sequence[Use]]) -> Iterator[tuple[int, Way]]:
        """Yield changes of all tokens that are wrong, together."""
        wrong: list[list[tuple[int, Way]]] = []
        for token, own in zip(tokens, uses, strict=True):
            if not all(is_equal_value(use.old, use.new) for use in own):
                ways = sorted(islice(self._changes(token, own), 40), key=lambda way: way[0])
                wrong.append(ways[: _MAX_CHOICES if wrong else _MAX_WAYS])
        for parts in islice(product(*wrong), 4 * _MAX_WAYS):
            yield sum(rank for rank, _ in parts), tuple(change for _, way in parts for change in way)

    def _changes(self, root: Written, uses: Sequence[Use]) -> Iterator[tuple[int, Way]]:
        """Yield the changes of one text with which another one, that is computed from it, is what its uses need."""
        changed = [use.scope for use in uses if not is_equal_value(use.old, use.new)] or [uses[0].scope]
        sites = {site.key: (rank, site) for scope in changed for rank, site in self._sites(root, scope)}
        for first, site in sites.values():
            for rank, other in self._candidates.of(site, root, uses):
                yield rank + first, (TextChange(site, other),)

    def _at_calls(self, text: Written, uses: Sequence[Use]) -> list[Edits]:
        """Return the edits that give calls of a macro a value of their own, where they have the default."""
        defaults = [it for it in self._definitions(text, uses[0].scope) if it.attribute == "params"]
        edits: list[Edit] = []
        for use in uses:
            if not is_equal_value(use.old, use.new) and use.calls:
                for definition in defaults:
                    for value in (use.new, f"'{use.new}'"):
                        if near(self._candidates.value(text.text, use.scope, {definition.key: value}), use.new):
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
                text = definition_text(definition)
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


def _middle(use: Use, values: Sequence[str], index: int) -> Use | None:
    """Return what one part of a text is and should be, if the others stay."""
    before, after = "".join(values[:index]), "".join(values[index + 1 :])
    middle = use.new[len(before) : len(use.new) - len(after)]
    is_alone = "".join(values) == use.old and f"{before}{middle}{after}" == use.new
    return use._replace(old=values[index], new=middle) if is_alone else None
