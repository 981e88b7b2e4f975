"""The edits of the texts that the elements of an expanded xacro file come from.

A value is changed where it is defined, if a name alone gives it: in a property, in the argument of
a macro call, in the default of an argument. A number from which it is computed gets the value with
which the result is the wanted one; an expression that defines it is negated or replaced. Else it is
replaced where it is used, or given in a macro call that lacks it. Nothing that a YAML file gives is
changed. A name that xacro does not know is corrected by similar ones.
"""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from itertools import islice
from math import isclose
from typing import NamedTuple

from grader.base import markup
from grader.base.element_edits import format_number, merged, with_attribute
from grader.base.grouping import Span, group_values
from grader.base.markup import WORD_OF_VALUE
from grader.base.names import closest, near
from grader.base.patterns import on_use
from grader.base.source import Edit, Edits, Location, Source
from grader.ros.python.values import EvaluationSignal
from grader.ros.xacro.corrections import (
    Refusal,
    negated,
    respellings,
)
from grader.ros.xacro.expansion import ExpandedSource
from grader.ros.xacro.scopes import Key, ScopePlace, XacroDefinition, XacroScope
from grader.ros.xacro.texts import Texts
from grader.ros.xacro.xacro_nodes import XacroNode, walk

_Ways = list[Edits]  # to change a text

_MAX_LENGTH = 2_000  # of a text that is edited in parts
_MAX_NAMES = 20  # that xacro refuses
_EXPRESSION = on_use(r"\$\{([^}]*)\}")
_NAME = on_use(r"(?<![\w.'\"])[^\W\d]\w*(?![\w(])")
_NUMBER = on_use(r"\s*+[-+]?(?:\d++\.?\d*+|\.\d++)(?:[eE][-+]?\d++)?\s*")
# The one expression of a text that is a name, perhaps with a minus.
_ALONE = on_use(
    r"""(?P<before>[^$]*)
    (?: \$\{\s*(?P<sign>-?)\s*(?P<name>[^\W\d]\w*)\s*\}
      | \$\(\s*arg\s+(?P<argument>[^\s()]+)\s*\) )
    (?P<after>[^$]*)""",
    re.VERBOSE,
)
_LOADED = on_use(r"\$\{\s*(?:xacro\.)?load_yaml\(")
_NO_CALL = ("value", "default", "params")  # where a name is defined that no call of a macro gives
_MAX_ORIGINS = 3  # of a text
_MAX_DEPTH = 4  # definitions that lead to one another
_MAX_DEFINITIONS = 12


class _Written(NamedTuple):
    """A text at an offset of a file, and the scope in which it is evaluated.

    It also has the attribute that it is in, and its name.
    """

    source: Source
    start: int
    text: str
    scope: XacroScope
    attribute: Span  # its offsets, with name and quotes
    key: Key | None = None  # of what is defined with it

    @property
    def end(self) -> int:
        """The offset after it."""
        return self.start + len(self.text)

    def part(self, start: int, end: int) -> "_Written":
        """Return a part of it."""
        return self._replace(start=self.start + start, text=self.text[start:end])


class _Use(NamedTuple):
    """A use of a text: what it is and should be, and where it is evaluated.

    This is the scope, and the call of the macro it is in.
    """

    scope: XacroScope
    old: str
    new: str
    call: ScopePlace | None = None


class _TextChange(NamedTuple):
    """A text that becomes another one."""

    written: _Written
    new: str


def _make_edits(changes: Iterable[_TextChange]) -> Edits | None:
    """Return the edits that make changes, one for each attribute.

    Returns None where two of them overlap.
    """
    attributes = group_values(
        ((change.written.source.path, change.written.attribute[0]), change)
        for change in dict.fromkeys(changes)
    )
    edits = []
    for inside in attributes.values():
        source, (start, end) = inside[0].written.source, inside[0].written.attribute
        new = ""
        position = start
        for written, text in sorted(inside, key=lambda change: change.written.start):
            if written.start < position:
                return None
            new += source.text[position : written.start] + text
            position = written.end
        edits.append(source.edit(start, end, new + source.text[position:end]))
    return tuple(edits)


def _edits_alone(changes: Iterable[_TextChange]) -> _Ways:
    """Return the edits that make changes, if there are any."""
    edits = _make_edits(changes)
    return [edits] if edits else []


def _find_text(place: ScopePlace, attribute: str, scope: XacroScope) -> _Written | None:
    """Return the value of an attribute, or without a name the text of an element without children.

    None where it is missing, too long, or has entities, so that it is not what is read.
    """
    source, at = place.source.element(place.tag)
    if attribute:
        markup_attribute = markup.attribute(source.text, at, attribute)
        if not markup_attribute:
            return None
        start = markup_attribute.value_start
        end = markup_attribute.value_end
        span = (markup_attribute.start, markup_attribute.end)
    else:
        start = markup.head_end(source.text, at)[0]
        end = source.text.rfind("</", start, markup.element_end(source.text, at))
        content = source.text[start:end]
        if not content.strip():
            return None
        end = start + len(content.rstrip())
        start += len(content) - len(content.lstrip())
        span = (start, end)
    text = source.text[start:end]
    if len(text) > _MAX_LENGTH or re.search("[&<]", text):
        return None
    return _Written(source, start, text, scope, span)


def _definition_text(definition: XacroDefinition) -> _Written | None:
    """Return the text that a name is defined with.

    For a parameter's default it is a part of `params`.
    """
    whole = _find_text(definition.place, definition.attribute, definition.scope)
    if whole and definition.attribute == "params" and whole.text != definition.text:
        match = re.search(rf"(?:^|\s){re.escape(definition.name)}\s*:?=\s*(?:\^\|?)?", whole.text)
        if not match or not whole.text.startswith(definition.text, match.end()):
            return None
        whole = whole.part(match.end(), match.end() + len(definition.text))
    if whole:
        return whole._replace(key=definition.key)
    return None


class _Rewriter:
    """Makes the edits of one expanded document."""

    def __init__(self, texts: Texts) -> None:
        self._texts = texts

    def ways(self, place: ScopePlace, attribute: str, uses: Sequence[_Use]) -> _Ways:
        """Return the ways to change an attribute for its uses, the best first.

        Without a name, they change the text.
        """
        text = _find_text(place, attribute, uses[0].scope)
        changed = [use for use in uses if use.old != use.new]
        if not text or not changed:
            return []
        parts = []
        if "$" in text.text:
            parts = [(use, *part) for use in changed for part in _parts(text, use)]
        of_definitions = self._changes_of_definitions(parts)
        if of_definitions is None:
            return []
        ways = self._literal(text, changed) + self._in_calls(text, changed)
        computed = self._computed(parts)
        # Where it is used, it would change for other calls of a macro, too.
        ways = (computed + ways) if len(changed) < len(uses) else (ways + computed)
        return list(dict.fromkeys(of_definitions + ways))

    def _changes_of_definitions(
        self, parts: Sequence[tuple[_Use, _Written, str, str]]
    ) -> _Ways | None:
        """Return the edits of the definitions of parts of a text; None where they are loaded.

        Returns none where no part is defined, or uses want different values of one definition.
        """
        changes: dict[tuple[Source, int, str], _TextChange] = {}
        has_definition = False
        is_one = True
        for use, part, old, new in parts:
            definitions = self._definitions(part, use.scope, old, new)
            if not definitions and self._is_loaded(part):
                return None
            has_definition |= bool(definitions)
            for change in definitions or [_TextChange(part, new)]:
                written = change.written
                where = written.source, written.start, written.text
                is_one &= changes.setdefault(where, change).new == change.new
        if has_definition and is_one:
            return _edits_alone(changes.values())
        return []

    def _computed(self, parts: Iterable[tuple[_Use, _Written, str, str]]) -> _Ways:
        """Return the edits of what parts of a text are computed from.

        They are of one definition for each part.
        """
        origins = []
        for use, part, old, new in parts:
            origins.append(islice(self._origins(part, use.scope, old, new), _MAX_ORIGINS))
        ways = []
        for changes in zip(*origins, strict=False):
            ways += _edits_alone(changes)
        return ways

    def _origins(
        self, text: _Written, scope: XacroScope, old: str, new: str, depth: int = _MAX_DEPTH
    ) -> Iterator[_TextChange]:
        """Yield the changes of one definition with which a text has another value.

        Numbers come first, then expressions.
        """
        defined = self._defined(text, scope, old, new)
        if defined is None:
            if depth:
                yield from self._solved_origins(text, scope, old, new, depth)
            return
        written, inside, was, value = defined
        if _LOADED.match(written.text):
            return
        parts = _parts(written, _Use(inside, was, value))
        if not self.definitions(written):
            yield self._rewritten(written, value)
        elif len(parts) == 1 and depth:
            part, before, after = parts[0]
            yield from self._origins(part, inside, before, after, depth - 1)
            if _NUMBER.fullmatch(after) and _is_equal(before, format_number(-float(after))):
                yield _TextChange(part, negated(part.text))
            yield _TextChange(part, after)

    def _solved_origins(
        self, text: _Written, scope: XacroScope, old: str, new: str, depth: int
    ) -> Iterator[_TextChange]:
        """Yield the changes of one number in an expression with which it has another value."""
        names = [name for name in _NAME.findall(text.text) if self._find_definition(name, scope)]
        for name in list(dict.fromkeys(names))[:_MAX_ORIGINS]:
            for was, value in self._solved(text, name, scope, old, new):
                alone = text._replace(text=f"${{{name}}}")
                is_side = was in ("1.0", "-1.0")
                keeps_sign = is_side or was.startswith("-") == value.startswith("-")
                for change in self._origins(alone, scope, was, value, depth - 1):
                    if _may_change(change.written, keeps_sign=keeps_sign):
                        yield change

    def _solved(
        self, text: _Written, name: str, scope: XacroScope, old: str, new: str
    ) -> Iterator[tuple[str, str]]:
        """Yield the number that a name stands for, and the one with which a value is another.

        The value is that of a linear expression.
        """
        inside = XacroScope(scope)

        def value_with(number: float) -> float:
            inside.bind(name, number)
            return float(self._texts.written(self._texts.evaluate(text.text, inside)))

        try:
            at = float(self._texts.written(self._texts.find(name, scope)))
            first = value_with(at)
            solution = at + (float(new) - first) / (value_with(at + 1) - first)
            is_solved = _is_equal(old, repr(first)) and isclose(
                value_with(solution), float(new), abs_tol=1e-9
            )
        except (EvaluationSignal, ArithmeticError, ValueError, TypeError):
            return
        if is_solved:
            yield repr(at), format_number(solution)

    def _in_calls(self, text: _Written, changed: Sequence[_Use]) -> _Ways:
        """Return the edits that give a parameter in the calls of its macro.

        A text is the default of this parameter.
        """
        name = text.text[2:-1].strip() if text.text.startswith("${") else ""
        definition = self._find_definition(name, changed[0].scope)
        if not definition or definition.attribute != "params":
            return []
        calls = {use.call: use.new for use in changed if use.call}
        each = ((*call.source.element(call.tag), new) for call, new in calls.items())
        return [tuple(with_attribute(source, start, name, new) for source, start, new in each)]

    def _literal(self, text: _Written, changed: Sequence[_Use]) -> _Ways:
        """Return the edit that writes a value where it is used.

        Returns none where uses differ, or a YAML file gives it.
        """
        around = {_around(text, use) for use in changed}
        if len(around) == 1 and "" not in around:
            return _edits_alone([_TextChange(text, around.pop())])
        new = changed[0].new
        if any(use.new != new for use in changed) or self._is_loaded(text):
            return []
        parts = _parts(text, changed[0])
        if len(parts) == 2:
            (first, first_old, first_new), (second, second_old, second_new) = parts
            if (first_old, first_new) == (second_new, second_old):  # they are exchanged
                return _edits_alone(
                    [_TextChange(first, second.text), _TextChange(second, first.text)]
                )
        written = text
        if len(parts) == 1:
            written, _, new = parts[0]
        if "$" not in written.text:
            new = merged(written.text, new)
        return _edits_alone([_TextChange(written, new)])

    def _definitions(
        self, text: _Written, scope: XacroScope, old: str, new: str, depth: int = _MAX_DEPTH
    ) -> list[_TextChange]:
        """Return the changes of the definition of the one name in a text.

        With them the text has another value.
        """
        defined = self._defined(text, scope, old, new) if depth else None
        if defined is None:
            return []
        written, inside, was, inner = defined
        if self.definitions(written):
            parts = _parts(written, _Use(inside, was, inner))
            changes = [self._definitions(part, inside, a, b, depth - 1) for part, a, b in parts]
            if all(changes):
                return [change for several in changes for change in several]
            return []
        return [self._rewritten(written, inner)]

    def _defined(
        self, text: _Written, scope: XacroScope, old: str, new: str
    ) -> tuple[_Written, XacroScope, str, str] | None:
        """Return the definition of the one name that gives a text, and its scope.

        Also return what it is and should be.
        """
        match = _ALONE.fullmatch(text.text)
        before, after = (match["before"], match["after"]) if match else ("", "")
        is_inside = (
            new.startswith(before) and new.endswith(after) and len(new) > len(before) + len(after)
        )
        if not match or not is_inside:
            return None
        inner = new[len(before) : len(new) - len(after)]
        was = old[len(before) : len(old) - len(after)]
        if match["sign"]:
            inner = _negate(inner)
            was = _negate(was)
        name = match["argument"]
        definition = (
            self._texts.defaults.get(name) if name else self._find_definition(match["name"], scope)
        )
        written = _definition_text(definition) if definition else None
        if definition and written:
            return (written, definition.scope, was, inner)
        return None

    def _rewritten(self, written: _Written, value: str) -> _TextChange:
        """Return the change of a definition to a value, which stays in quotes."""
        is_quoted = written.text[:1] == "'" == written.text[-1:]
        return _TextChange(written, f"'{value}'" if is_quoted else merged(written.text, value))

    def _is_loaded(self, text: _Written) -> bool:
        """Return whether a YAML file gives a text."""
        return any(_LOADED.match(definition.text) for definition in self.definitions(text))

    def _find_definition(self, name: str, scope: XacroScope) -> XacroDefinition | None:
        holder = scope.holder(name)
        if holder:
            return holder.properties[name].definition
        return None

    def definitions(self, text: _Written) -> list[_Written]:
        """Return the texts with which the names in a text are defined, also by way of others."""
        by_key: dict[object, _Written] = {}
        waiting = [text]
        while waiting and len(by_key) < _MAX_DEFINITIONS:
            one = waiting.pop(0)
            for definition in self._named(one):
                written = _definition_text(definition)
                if written and definition.key not in by_key:
                    by_key[definition.key] = written._replace(scope=definition.scope)
                    waiting.append(by_key[definition.key])
        return list(by_key.values())

    def _named(self, text: _Written) -> Iterator[XacroDefinition]:
        for expression in _EXPRESSION.findall(text.text):
            for name in _NAME.findall(expression):
                definition = self._find_definition(name, text.scope)
                if definition:
                    yield definition
        for argument in re.findall(r"\$\(\s*arg\s+([^\s()]+)\s*\)", text.text):
            if argument in self._texts.defaults:
                yield self._texts.defaults[argument]

    def numbers(self, place: ScopePlace, attribute: str, scope: XacroScope) -> list[_Written]:
        """Return the texts that define numbers from which an attribute is computed."""
        text = _find_text(place, attribute, scope)
        if text:
            return [
                definition
                for definition in self.definitions(text)
                if _NUMBER.fullmatch(definition.text)
            ]
        return []


def _may_change(text: _Written, *, keeps_sign: bool) -> bool:
    """Return whether a definition is an argument in a call, or a number that keeps its sign.

    A length is such a number.
    """
    is_argument = text.key is not None and text.key[2] not in _NO_CALL
    return is_argument or (keeps_sign and bool(_NUMBER.fullmatch(text.text)))


def _parts(text: _Written, use: _Use) -> list[tuple[_Written, str, str]]:
    """Return the parts of a text that should be others, each with what it is and should be.

    The parts are words, or the whole text.
    """
    tokens = [text.part(*match.span()) for match in WORD_OF_VALUE.finditer(text.text)]
    old = use.old.split()
    new = use.new.split()
    if len(tokens) != len(old) or len(old) != len(new) or len(tokens) < 2:
        return [(text, use.old, use.new)]
    return [part for part in zip(tokens, old, new, strict=True) if not _is_equal(*part[1:])]


def _around(text: _Written, use: _Use) -> str:
    """Return a text with another one around its only expression, whose value stays.

    An example is ${side}_joint. It is empty if the text around it goes.
    """
    match = _ALONE.fullmatch(text.text)
    if not match or not (match["before"] or match["after"]):
        return ""
    value = use.old[len(match["before"]) : len(use.old) - len(match["after"])]
    expression = text.text[len(match["before"]) : len(text.text) - len(match["after"])]
    if value.isidentifier() and use.new.count(value) == 1:
        return use.new.replace(value, expression)
    return ""


def _negate(number: str) -> str:
    return number[1:] if number.startswith("-") else f"-{number}"


def _is_equal(one: str, other: str) -> bool:
    """Return whether two texts are equal, or are the same number."""
    try:
        return one == other or abs(float(one) - float(other)) < 1e-9
    except ValueError:
        return False


def _conditions(document: XacroNode, known: Sequence[str]) -> Iterator[Edits]:
    """Yield the edits that correct a text in quotes in a condition: 'rigth'."""
    for node in walk(document):
        if node.tag not in ("xacro:if", "xacro:unless"):
            continue
        text = node.attributes.get("value", "")
        for word in re.findall(r"['\"](\w+)['\"]", text):
            meant = near(word, known) if word not in known else None
            if meant is not None:
                new = re.sub(rf"\b{word}\b", meant, text)
                yield (with_attribute(*node.place.written, "value", new),)


class _XacroMistake(NamedTuple):
    """Edits that may undo a mistake, and what it is."""

    edits: Edits
    mistake: str


class NumberDefinition(NamedTuple):
    """A number of xacro from which an attribute is computed."""

    written: _Written

    @property
    def text(self) -> str:
        """The number as it is written."""
        return self.written.text.strip()

    def edits_with(self, new: str) -> Edits:
        """Return the edits that define another number."""
        return _make_edits([_TextChange(self.written, new)]) or ()


class ExpandedEdits:
    """Makes the edits of an expanded xacro file.

    Elements are named by their indices in the expanded document.
    """

    def __init__(self, source: ExpandedSource) -> None:
        self._source = source

    def rewrites(self, attribute: str, wanted: Mapping[int, tuple[str, str]]) -> _Ways:
        """Return the ways to give an attribute of elements of one place other values.

        Without a name, they are ways for the text.
        """
        place = self._source.nodes[next(iter(wanted))].place
        scope = place.scope or XacroScope()
        uses = []
        for tag in self.siblings(next(iter(wanted))):
            node = self._source.nodes[tag]
            if attribute:
                text = node.attributes.get(attribute, "")
            else:
                text = "".join(map(str, node.children)).strip()
            call = node.place.calls[-1][1] if node.place.calls else None
            uses.append(_Use(node.place.scope or scope, *wanted.get(tag, (text, text)), call))
        return self._rewriter.ways(place, attribute, uses)

    def numbers(self, tag: int, attribute: str) -> "list[NumberDefinition]":
        """Return the definitions of the numbers from which an attribute is computed."""
        place = self._source.nodes[tag].place
        definitions = self._rewriter.numbers(place, attribute, place.scope or XacroScope())
        return [NumberDefinition(written) for written in definitions]

    def siblings(self, tag: int) -> list[int]:
        """Return the indices of the expanded elements that come from the same source place."""
        place = self._source.nodes[tag].place
        return self._by_place[place.source.path, place.tag]

    @cached_property
    def _by_place(self) -> dict[tuple[str, int], list[int]]:
        return group_values(
            ((node.place.source.path, node.place.tag), index)
            for index, node in enumerate(self._source.nodes)
        )

    def corrections(self, names: Sequence[str]) -> list[_XacroMistake]:
        """Return edits that may correct names that are not known, and conditions.

        `names` are those that the reference and the format have.
        """
        mistakes = list(_respelt(self._source.refused))
        given = sorted({word for name in names for word in name.split("_")})
        for document in self._source.documents.values():
            edited = _conditions(document, given)
            mistakes += [_XacroMistake(edits, "a text in a condition") for edits in edited]
        unique: dict[Edits, _XacroMistake] = {}
        for mistake in mistakes:
            unique.setdefault(mistake.edits, mistake)
        return list(unique.values())

    def calls(self, edit: Edit) -> dict[str, list[Location]]:
        """Return the calls of the macros that an edit is in, by their names."""
        calls_by_name: dict[str, dict[Location, None]] = {}
        if not edit.old:
            return {}
        for node in self._source.nodes:
            place = node.place.at(
                next(
                    (
                        parameter
                        for parameter in node.attributes
                        if parameter and edit.old.startswith(f"{parameter}=")
                    ),
                    None,
                )
            )
            if node.place.calls and place[:3] == edit[:3]:
                name, call = node.place.calls[-1]
                calls_by_name.setdefault(name, {})[call.at()] = None
        return {name: list(calls) for name, calls in calls_by_name.items()}

    @cached_property
    def _rewriter(self) -> _Rewriter:
        return _Rewriter(self._source.texts)


def _respelt(refusals: Sequence[Refusal]) -> Iterator[_XacroMistake]:
    """Yield the edits that correct names that are not known to similar ones."""
    for refusal in refusals[:_MAX_NAMES]:
        unknown = refusal.unknown
        if unknown:
            similar = closest(unknown.name, unknown.known)
            for edits, _ in respellings(refusal, unknown, similar):
                yield _XacroMistake(edits, "a name that xacro does not know")
