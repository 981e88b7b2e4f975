"""The ways to give expanded elements other values: edits of the xacro texts that they come from.

A value is changed where it is defined, if a name alone gives it: in a property, in the argument of a macro call, in the
default of an argument. Else it is replaced where it is used, or given in a macro call that lacks it. Nothing inside an
expression is changed, and nothing that a YAML file gives.
"""

import re
from collections.abc import Callable, Iterator, Sequence

from grader import markup
from grader.hints.edits import merged, with_attribute
from grader.hints.xacro.written import TextChange, Use, Written, definition_text, edits_of, find_text
from grader.source import Edits, Source
from grader.xacro.scopes import Definition, ScopePlace, XacroScope
from grader.xacro.texts import Texts

_TOKEN = re.compile(r"(?:\$\{[^}]*\}|\$\([^)]*\)|[^\s$]|\$)+")
_EXPRESSION = re.compile(r"\$\{([^}]*)\}")
_NAME = re.compile(r"(?<![\w.'\"])[^\W\d]\w*(?![\w(])")
_NUMBER = re.compile(r"\s*[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?\s*")
# The one expression of a text that is a name, perhaps with a minus.
_ALONE = re.compile(
    r"""(?P<before>[^$]*)
    (?: \$\{\s*(?P<sign>-?)\s*(?P<name>[^\W\d]\w*)\s*\}
      | \$\(\s*arg\s+(?P<argument>[^\s()]+)\s*\) )
    (?P<after>[^$]*)""",
    re.VERBOSE,
)
_LOADED = re.compile(r"\$\{\s*(?:xacro\.)?load_yaml\(")
_MAX_DEPTH = 4  # definitions that lead to one another
_MAX_DEFINITIONS = 12


class Rewriter:
    """Makes the edits of one expanded document."""

    def __init__(self, texts: Texts) -> None:
        self._texts = texts

    def ways(self, place: ScopePlace, attribute: str, uses: Sequence[Use]) -> list[Edits]:
        """Return the ways to change an attribute (or, without a name, the text) for its uses, the best first."""
        text = find_text(place, attribute, uses[0].scope)
        changed = [use for use in uses if use.old != use.new]
        if text is None or not changed:
            return []
        found: list[TextChange] = []
        has_definition = False
        for use in changed if "$" in text.text else ():
            for part, old, new in _parts(text, use):
                changes = self._definitions(part, use.scope, old, new)
                if not changes and self._is_loaded(part):
                    return []
                has_definition |= bool(changes)
                found += changes or [TextChange(part, new)]
        by_place = {change.written[:3]: change for change in found}
        is_one = all(by_place[change.written[:3]].new == change.new for change in found)
        edits = edits_of(by_place.values()) if has_definition and is_one else None
        return [*filter(None, [edits]), *self._literal(text, changed), *self._in_calls(text, changed)]

    def _in_calls(self, text: Written, changed: Sequence[Use]) -> list[Edits]:
        """Return the edits that give a parameter, of which a text is the default, in the calls of its macro."""
        name = text.text[2:-1].strip() if text.text.startswith("${") else ""
        definition = self._of_name(name, changed[0].scope)
        if definition is None or definition.attribute != "params":
            return []
        calls = {use.call: use.new for use in changed if use.call is not None}
        each = ((*call.source.element(call.tag), new) for call, new in calls.items())
        return [tuple(with_attribute(source, start, name, new) for source, start, new in each)]

    def _literal(self, text: Written, changed: Sequence[Use]) -> list[Edits]:
        """Return the edit that writes a value where it is used; none where uses differ, or a YAML file gives it."""
        around = {_around(text, use) for use in changed}
        if len(around) == 1 and "" not in around:
            edits = edits_of([TextChange(text, around.pop())])
            return [edits] if edits else []
        if len({use.new for use in changed}) != 1 or self._is_loaded(text):
            return []
        parts = _parts(text, changed[0])
        if len(parts) == 2 and parts[0][1:] == parts[1][:0:-1]:  # two expressions are exchanged
            edits = edits_of([TextChange(parts[0][0], parts[1][0].text), TextChange(parts[1][0], parts[0][0].text)])
        else:
            written, _, new = parts[0] if len(parts) == 1 else (text, "", changed[0].new)
            edits = edits_of([TextChange(written, new if "$" in written.text else merged(written.text, new))])
        return [edits] if edits else []

    def _definitions(
        self, text: Written, scope: XacroScope, old: str, new: str, depth: int = _MAX_DEPTH
    ) -> list[TextChange]:
        """Return the changes of what defines the one name in a text, with which the text has another value."""
        found = _ALONE.fullmatch(text.text)
        before, after = (found["before"], found["after"]) if found else ("", "")
        is_inside = new.startswith(before) and new.endswith(after) and len(new) > len(before) + len(after)
        if found is None or not depth or not is_inside:
            return []
        inner, was = (it[len(before) : len(it) - len(after)] for it in (new, old))
        if found["sign"]:
            inner, was = (it[1:] if it.startswith("-") else f"-{it}" for it in (inner, was))
        name = found["argument"]
        definition = self._texts.defaults.get(name) if name else self._of_name(found["name"], scope)
        own = definition_text(definition) if definition is not None else None
        if definition is None or own is None:
            return []
        if self.definitions(own):
            parts = _parts(own, Use(definition.scope, was, inner))
            changes = [self._definitions(part, definition.scope, a, b, depth - 1) for part, a, b in parts]
            return [change for several in changes for change in several] if all(changes) else []
        is_quoted = own.text[:1] == "'" == own.text[-1:]
        return [TextChange(own, f"'{inner}'" if is_quoted else merged(own.text, inner))]

    def _is_loaded(self, text: Written) -> bool:
        """Return whether a YAML file gives a text."""
        return any(_LOADED.match(it.text) for it in self.definitions(text))

    def _of_name(self, name: str, scope: XacroScope) -> Definition | None:
        holder = scope.holder(name)
        return holder.properties[name].definition if holder is not None else None

    def definitions(self, text: Written) -> list[Written]:
        """Return the texts with which the names in a text are defined, also by way of others."""
        found: dict[object, Written] = {}
        waiting = [text]
        while waiting and len(found) < _MAX_DEFINITIONS:
            one = waiting.pop(0)
            for definition in self._named(one):
                own = definition_text(definition)
                if own is not None and definition.key not in found:
                    found[definition.key] = own._replace(scope=definition.scope)
                    waiting.append(found[definition.key])
        return list(found.values())

    def _named(self, text: Written) -> Iterator[Definition]:
        for expression in _EXPRESSION.findall(text.text):
            yield from filter(None, (self._of_name(name, text.scope) for name in _NAME.findall(expression)))
        for argument in re.findall(r"\$\(\s*arg\s+([^\s()]+)\s*\)", text.text):
            if argument in self._texts.defaults:
                yield self._texts.defaults[argument]

    def numbers(self, place: ScopePlace, attribute: str, scope: XacroScope) -> list[Written]:
        """Return the texts that define numbers from which an attribute is computed."""
        text = find_text(place, attribute, scope)
        return [it for it in self.definitions(text) if _NUMBER.fullmatch(it.text)] if text is not None else []


def _parts(text: Written, use: Use) -> list[tuple[Written, str, str]]:
    """Return the parts of a text that should be others, each with what it is and should be: words, or the whole."""
    tokens = [text.part(*found.span()) for found in _TOKEN.finditer(text.text)]
    old, new = use.old.split(), use.new.split()
    if len(tokens) != len(old) or len(old) != len(new) or len(tokens) < 2:
        return [(text, use.old, use.new)]
    return [part for part in zip(tokens, old, new, strict=True) if not is_equal(*part[1:])]


def _around(text: Written, use: Use) -> str:
    """Return a text with another one around its only expression, whose value stays: ${side}_joint; empty if it goes."""
    found = _ALONE.fullmatch(text.text)
    if found is None or not (found["before"] or found["after"]):
        return ""
    value = use.old[len(found["before"]) : len(use.old) - len(found["after"])]
    expression = text.text[len(found["before"]) : len(text.text) - len(found["after"])]
    return use.new.replace(value, expression) if value.isidentifier() and use.new.count(value) == 1 else ""


def is_equal(one: str, other: str) -> bool:
    """Return whether two texts are equal, or are the same number."""
    try:
        return one == other or abs(float(one) - float(other)) < 1e-9
    except ValueError:
        return False


def conditions(source: Source, known: Sequence[str], near: Callable[[str, Sequence[str]], str | None]) -> list[Edits]:
    """Return the edits that correct a text in quotes in the condition of an <xacro:if> or <xacro:unless>: 'rigth'."""
    found: list[Edits] = []
    for tag in re.finditer(r"<xacro:(?:if|unless)\b", source.text):
        value = markup.attribute(source.text, tag.start(), "value")
        text = source.text[value.value_start : value.value_end] if value is not None else ""
        for word in re.findall(r"'(\w+)'|\"(\w+)\"", text):
            meant = near(word[0] or word[1], known) if (word[0] or word[1]) not in known else None
            if value is not None and meant is not None:
                new = re.sub(rf"\b{word[0] or word[1]}\b", meant, text)
                found.append((with_attribute(source, tag.start(), "value", new),))
    return found
