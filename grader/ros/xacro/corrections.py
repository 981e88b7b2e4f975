"""The edits that correct what xacro refuses.

There is one edit where it surely is meant, and others that hints try.
"""

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import islice
from typing import NamedTuple

from grader.base import markup
from grader.base.element_edits import tag_edits, with_attribute
from grader.base.names import closest
from grader.base.problems import Fix
from grader.base.source import Edit, Edits, Location
from grader.base.text import cut, quoted
from grader.ros.python.budget import Budget
from grader.ros.python.values import EvaluationFails
from grader.ros.xacro.macros import MacroError
from grader.ros.xacro.scopes import ScopePlace, UnknownName, XacroFails
from grader.ros.xacro.texts import TEXT_IN_QUOTES
from grader.ros.xacro.xacro_files import Files, XmlFails
from grader.ros.xacro.xacro_nodes import XacroNode, walk

_MAX_NODES = 2000
_OF_WALK = 500  # what looking at all elements of a file is charged
_MAX_SHOWN = 60  # characters of an edit in a sentence
_MAX_VALUE = 10_000  # characters of an attribute that is corrected
_EXPRESSION = re.compile(
    r"\$\{([^{}]*)\}"
)  # no brace inside: else many that open take quadratic time
_NAME = re.compile(r"[^\W\d]\w*")
_NUMBER = re.compile(r"-?(?:\d++\.?\d*+|\.\d++)(?:[eE][-+]?\d++)?")
_PRODUCT = re.compile(r"-?\s*+[\w.]++(?:\s*+[*/]\s*+[\w.]++)*+")
_MAX_MIRRORED = 6  # ways to negate a number of what another call gives
_WORD = re.compile(r"(?:\$\{[^{}]*\}|[^\s$])+")
_DECIMAL_COMMA = re.compile(r"\s*[-+]?\d+,\d+\s*")
# A separator between parameters, which xacro takes for a part of the name or of the default before
# it.
_SEPARATOR = re.compile(
    r"\$\{[^{}]*\}|'[^']*'|(?P<separator>(?:(?<!\s)\s++)?[,;](?=\s|\Z|[*^\W\d]))"
)
# What is written for ${side}: {side}, $ {side}, $(side), $side.
_UNMARKED = re.compile(
    r"\$\{[^{}]*\}|(?:\$\s*+)?\{\s*+(?P<brace>[^\W\d]\w*)\s*\}|\$\(\s*(?P<paren>[^\W\d]\w*)\s*\)|\$(?P<bare>[^\W\d]\w*)"
)


class XacroCorrection(NamedTuple):
    """The fix of what xacro refuses, and where something is read as another thing."""

    fix: Fix
    location: Location
    # of a name that may bring others with it: that of a macro, of an attribute, of a file
    is_of_element: bool = False
    problem: str = ""  # what is wrong, where it says more than xacro's message


# What xacro refuses, and where: in an attribute, or without one in the tag itself.
Refusal = tuple[EvaluationFails, ScopePlace, str | None]


class Corrections:
    """Finds the correction that is surely meant of what xacro refuses in a document.

    The files that the document includes are part of it.
    """

    def __init__(self, files: Files, budget: Budget) -> None:
        self._files, self._budget = files, budget

    def of(self, refusal: Refusal) -> XacroCorrection | None:
        """Return the correction of what is refused; None if several can be meant."""
        error, place, attribute = refusal
        location = place.at(attribute)
        unknown = error.unknown if isinstance(error, XacroFails) else None
        if isinstance(error, XmlFails) and error.repair:
            return XacroCorrection(Fix(error.repair, error.assumed), location, is_of_element=True)
        parameters = self._parameters(refusal)
        if parameters:
            return _correction(parameters, location, is_of_element=True)
        if unknown is not None:
            correction = self._correct_unknown(place, attribute, unknown)
            if correction is not None:
                return correction
        ways: tuple[Callable[[Refusal], Edits], ...] = (
            _power,
            self._decimal_commas,
            self._unmarked,
        )
        edits = next(filter(None, (way(refusal) for way in ways)), ())
        return _correction(edits, location) if edits else None

    def moved(self, unknown: UnknownName) -> tuple[Edits, Location] | None:
        """Return the edits that move what defines a name to the top, and where it is.

        Returns None if nothing below defines it.
        """
        tag = {"property": "xacro:property", "macro": "xacro:macro"}.get(unknown.kind)
        root = next(iter(self._files.documents.values()))
        definitions = []  # each with the child of the root that it is, or that includes it
        for child in root.elements:
            nodes = [child] if child.tag == tag else self._included(child, tag)
            definitions += [(child, node) for node in nodes if _defined_name(node) == unknown.name]
        if len(definitions) != 1:
            return None
        [(child, node)] = definitions
        if child is root.elements[0]:
            return None
        source, start = child.place.source.element(child.place.tag)
        _, first = source.element(root.elements[0].place.tag)
        end = markup.element_end(source.text, start)
        block = source.text[start:end]
        indent = markup.indentation(source.text, first)
        newline = "\r\n" if "\r\n" in source.text else "\n"
        inserted = source.edit(first, first, f"{block}{newline}{indent}")
        line = start - len(markup.indentation(source.text, start))
        begins_line = line > 0 and source.text[line - 1] == "\n"
        if begins_line and source.text[end : end + 1] in ("\n", "\r"):
            removed = source.edit(line, end + len(newline), "")
        else:
            removed = source.edit(start, end, "")
        return (inserted, removed), node.place.at()

    def _included(self, child: XacroNode, tag: str | None) -> list[XacroNode]:
        """Return the definitions in the files that an element includes."""
        paths = self._files.followed.get((child.place.source.path, child.place.tag), [])
        documents = [self._files.documents[path] for path in paths if path in self._files.documents]
        return [node for root in documents for node in root.elements if node.tag == tag]

    def _correct_unknown(
        self, place: ScopePlace, attribute: str | None, unknown: UnknownName
    ) -> XacroCorrection | None:
        location, of_element = place.at(attribute), unknown.kind != "property"
        moved = self.moved(unknown)
        if moved is not None and _is_below(moved[1], location):
            sentence = (
                f"the {unknown.kind} {quoted(unknown.name)} of line {moved[1].line} is read "
                "above its use"
            )
            problem = (
                f"the {unknown.kind} {unknown.name} is defined in line {moved[1].line}, below "
                "its use: move it up"
            )
            fix = Fix(moved[0], sentence)
            return XacroCorrection(fix, moved[1], is_of_element=True, problem=problem)
        prefixed = self._prefixed(unknown)
        if len(prefixed) == 1:
            return _correction(prefixed[0], location, is_of_element=True)
        edits = self._quoted(place, attribute, unknown)
        if edits:
            problem = f"there is no property {unknown.name}; a text needs quotes: '{unknown.name}'"
            return _correction(edits, location)._replace(problem=problem)
        if unknown.meant:
            return self._respelt(place, attribute, unknown, is_of_element=of_element)
        return None

    def _prefixed(self, unknown: UnknownName) -> list[Edits]:
        """Return the edits that write xacro: before what defines a name, else before includes."""
        definitions = []
        included: Edits = ()
        for node in self.nodes():
            edits = tag_edits(*node.place.written, node.tag, f"xacro:{node.tag}")
            if node.tag == unknown.kind and node.attributes.get("name") == unknown.name:
                definitions.append(edits)
            elif node.tag == "include" and "filename" in node.attributes:
                included += edits
        if included and not definitions:
            return [included]
        return definitions

    def _respelt(
        self, place: ScopePlace, attribute: str | None, unknown: UnknownName, *, is_of_element: bool
    ) -> XacroCorrection | None:
        """Return the correction of a name where it is used.

        If nothing uses it as defined, it is corrected where it is defined.
        """
        meant = unknown.meant or ""
        definition = unknown.known.get(meant)
        if definition is not None and definition[1] is not None and self._uses(unknown.name) > 1:
            edits = _rename(*definition, meant, unknown.name) if not self._uses(meant) else ()
            if edits:
                sentence = f"the {unknown.kind} {quoted(meant)} is read as {quoted(unknown.name)}"
                at = definition[0].at(definition[1])
                return XacroCorrection(Fix(edits, sentence), at, is_of_element=True)
        edits = _rename(place, attribute, unknown.name, meant)
        sentence = f"the {unknown.kind} {quoted(unknown.name)} is read as {quoted(meant)}"
        if edits:
            return XacroCorrection(Fix(edits, sentence), place.at(attribute), is_of_element)
        return None

    def _uses(self, name: str) -> int:
        """Return how many attributes use a name in an expression, or give an argument of it."""
        used = re.compile(rf"(?<![\w.]){re.escape(name)}(?!\w)")
        texts = (text for node in self.nodes() for text in node.attributes.values() if "${" in text)
        given = sum(
            name in node.attributes for node in self.nodes() if node.tag.startswith("xacro:")
        )
        return given + sum(any(map(used.search, _EXPRESSION.findall(text))) for text in texts)

    def nodes(self) -> Iterator[XacroNode]:
        """Yield the elements of all files, as they are written."""
        for root in self._files.documents.values():
            self._budget.charge(_OF_WALK)
            yield from islice(walk(root), _MAX_NODES)

    def _quoted(self, place: ScopePlace, attribute: str | None, unknown: UnknownName) -> Edits:
        """Return the edit that puts a text in quotes with which something is compared.

        An example is ${side == left}.
        """
        name = re.escape(unknown.name)
        compared = re.compile(rf"([=!]=\s*){name}(?![\w.(\[])|(?<![\w.]){name}(?=\s*[=!]=)")
        is_value = any(unknown.name in node.attributes.values() for node in self.nodes())
        if unknown.kind != "property" or not (is_value or unknown.meant is None):
            return ()
        for attribute_name, text, quote in _values(place, attribute):
            other = '"' if quote == "'" else "'"
            if "${" in text and compared.search(text):
                return _with_value(
                    place, attribute_name, compared.sub(rf"\g<1>{other}{unknown.name}{other}", text)
                )
        return ()

    def _parameters(self, refusal: Refusal) -> Edits:
        """Return the edit that separates the parameters of a called macro by spaces."""
        error, place, _ = refusal
        if not isinstance(error, MacroError):
            return ()
        source, start = place.source.element(place.tag)
        tag = source.text[start + 1 : markup.name_end(source.text, start)]
        called = tag.rpartition(":")[2].rpartition(".")[2]
        for node in self.nodes():
            if node.tag == "xacro:macro" and _defined_name(node) == called:
                params = node.attributes.get("params", "")
                separated = _SEPARATOR.sub(
                    lambda match: match[0] if match["separator"] is None else " ", params
                )
                new = " ".join(separated.split())
                if new != " ".join(params.split()):
                    return _with_value(node.place, "params", new)
        return ()

    def _decimal_commas(self, refusal: Refusal) -> Edits:
        """Return the edits that write decimal points in the numbers that an expression uses."""
        _, place, attribute = refusal
        expressions = [
            expression
            for _, text, _ in _values(place, attribute)
            for expression in _EXPRESSION.findall(text)
        ]
        names = {name for text in expressions for name in _NAME.findall(text)}
        edits: list[Edit] = []
        for node in self.nodes():
            named_by = {
                "value": node.attributes.get("name", ""),
                "default": node.attributes.get("name", ""),
            }
            for key, text in node.attributes.items() if node.tag.startswith("xacro:") else ():
                name = (
                    named_by.get(key, key) if node.tag in ("xacro:property", "xacro:arg") else key
                )
                if name in names and _DECIMAL_COMMA.fullmatch(text):
                    edits += _with_value(node.place, key, text.replace(",", "."))
        return tuple(edits)

    def _unmarked(self, refusal: Refusal) -> Edits:
        """Return the edits that write ${side} for $(side), which xacro takes for a command."""
        _, place, attribute = refusal
        if not any("$(" in text for _, text, _ in _values(place, attribute)):
            return ()
        return tuple(edit for edit in self.unmarked() if edit[:2] == place.at()[:2])

    def unmarked(self) -> Edits:
        """Return the edits that write ${side} where another form stands for a known name.

        Such a form is {side}, $ {side}, $(side) or $side.
        """
        properties = {
            element.attributes.get("name", "")
            for element in self.nodes()
            if element.tag == "xacro:property"
        }
        edits: list[Edit] = []
        for root in self._files.documents.values():
            waiting = [(root, frozenset(properties))]
            while waiting and len(edits) < _MAX_NODES:
                node, known = waiting.pop()
                if node.tag == "xacro:macro":
                    words = node.attributes.get("params", "").split()
                    known |= {re.split(r":?=", word)[0] for word in words}
                edits += _mark_names(node, known)
                waiting += [(child, known) for child in node.elements]
        return tuple(edits)


def _is_below(definition: Location, use: Location) -> bool:
    """Return whether a definition may come after a use; that in another file always may."""
    return definition.path != use.path or definition[1:3] > use[1:3]


def _defined_name(node: XacroNode) -> str:
    """Return the name that a property or macro defines, without a prefix, which macros may have."""
    return node.attributes.get("name", "").removeprefix("xacro:")


def _mark_names(node: XacroNode, known: Iterable[str]) -> list[Edit]:
    """Return the edits of attributes in which known names are meant to be evaluated."""
    edits: list[Edit] = []
    for name, text in node.attributes.items():
        new = _marked(text, known) if "{" in text or "$" in text else text
        if new != text and name != "params":
            edits += _with_value(node.place, name, new)
    return edits


def _marked(text: str, known: Iterable[str]) -> str:
    """Return a text in which each known name that is meant to be evaluated is in ${}."""

    def marked(match: re.Match[str]) -> str:
        name = match["brace"] or match["paren"]
        if name is not None:
            if name in known:
                return f"${{{name}}}"
            return match[0]
        bare = match["bare"] or ""
        ends = [len(bare), *(at.start() for at in reversed([*re.finditer("_", bare)]))]
        end = next((end for end in ends if bare[:end] in known), 0)
        if end:
            return f"${{{bare[:end]}}}{bare[end:]}"
        return match[0]

    return _UNMARKED.sub(marked, text)


def _power(refusal: Refusal) -> Edits:
    """Return the edit that writes ** for ^ in an expression that xacro refuses."""
    _, place, attribute = refusal
    for name, text, _ in _values(place, attribute):
        new = _EXPRESSION.sub(
            lambda match: (
                match[0] if TEXT_IN_QUOTES.search(match[0]) else match[0].replace("^", "**")
            ),
            text,
        )
        if new != text:
            return _with_value(place, name, new)
    return ()


def _values(place: ScopePlace, attribute: str | None) -> Iterator[tuple[str, str, str]]:
    """Yield the name, the text and the quote of an attribute.

    Without a name, those of all attributes of the tag are yielded.
    """
    source, start = place.source.element(place.tag)
    for markup_attribute in markup.attributes(source.text, start):
        if (
            attribute in (None, markup_attribute.name)
            and markup_attribute.value_end - markup_attribute.value_start <= _MAX_VALUE
        ):
            yield (
                markup_attribute.name,
                source.text[markup_attribute.value_start : markup_attribute.value_end],
                source.text[markup_attribute.value_end],
            )


def _with_value(place: ScopePlace, name: str, new: str) -> Edits:
    """Return the edit that gives an attribute another value.

    Returns none where it is not written in the tag.
    """
    source, start = place.source.element(place.tag)
    if markup.attribute(source.text, start, name) is None:
        return ()
    return (with_attribute(source, start, name, new),)


def _correction(
    edits: Edits, location: Location, *, is_of_element: bool = False
) -> XacroCorrection:
    """Return a correction that is where the first edit is."""
    at = Location(edits[0].path, edits[0].line, edits[0].column)
    fix = Fix(edits, describe_edits(edits))
    return XacroCorrection(fix, location if location[:3] == at[:3] else at, is_of_element)


def describe_edits(edits: Edits) -> str:
    """Return what is read as what after some edits."""
    shown = [
        f"{cut(edit.old, _MAX_SHOWN)} is read as {cut(edit.new, _MAX_SHOWN)}" for edit in edits[:3]
    ]
    return ", ".join(shown)


def respellings(place: ScopePlace, attribute: str | None, unknown: UnknownName) -> Iterator[Edits]:
    """Yield the edits that correct an unknown name where it is used.

    Others correct a similar name where it is defined.
    """
    similar = closest(unknown.name, unknown.known)
    if similar is not None:
        at, where = unknown.known[similar] or (place, None)
        ways = [_rename(place, attribute, unknown.name, similar)]
        if where is not None:
            ways.append(_rename(at, where, similar, unknown.name))
        yield from (edits for edits in ways if edits)


def values_of_other_calls(
    place: ScopePlace, nodes: Sequence[XacroNode], lacking: tuple[str, ...]
) -> Iterator[tuple[Edits, Mapping[str, str]]]:
    """Yield the edits that give a call the values that it lacks.

    The values are from other calls of the macro, also negated.
    """
    own_call = next((node for node in nodes if node.place[:2] == place[:2]), None)
    if own_call is None:
        return
    for other in nodes:
        given = other.attributes
        is_of_macro = other is not own_call and other.tag == own_call.tag
        if is_of_macro and set(lacking) <= given.keys():
            copied = {name: given[name] for name in lacking}
            mirrored = ({**copied, name: new} for name in lacking for new in _mirrored(given[name]))
            for values in (copied, *islice(mirrored, _MAX_MIRRORED)):
                yield _give(place, values), values


def _mirrored(text: str) -> Iterator[str]:
    """Yield a text with each of its numbers and expressions negated.

    One on the other side differs in one of them.
    """
    for match in _WORD.finditer(text):
        new = negated(match[0])
        if new != match[0] and match[0].strip("0."):
            yield f"{text[: match.start()]}{new}{text[match.end() :]}"


def negated(text: str) -> str:
    """Return a number or an expression of xacro with the other sign; any other text as it is."""
    inner = text[2:-1].strip() if _EXPRESSION.fullmatch(text) else ""
    value = inner or text
    if not (inner or _NUMBER.fullmatch(text)) or TEXT_IN_QUOTES.search(value):
        return text
    if inner and not _PRODUCT.fullmatch(inner):
        return f"${{-({inner})}}"
    value = value[1:].lstrip() if value.startswith("-") else f"-{value}"
    return f"${{{value}}}" if inner else value


def _give(place: ScopePlace, values: Mapping[str, str]) -> Edits:
    source, start = place.source.element(place.tag)
    ends = [
        markup.name_end(source.text, start),
        *(other.end for other in markup.attributes(source.text, start)),
    ]
    return (
        source.edit(
            ends[-1], ends[-1], "".join(f' {name}="{text}"' for name, text in values.items())
        ),
    )


def _rename(place: ScopePlace, attribute: str | None, old: str, new: str) -> Edits:
    """Return the edit of an attribute's value.

    Without an attribute, it is of an attribute's name, the tag, or any value.
    """
    source, start = place.source.element(place.tag)
    if attribute is None:
        tags = tag_edits(*place.written, f"xacro:{old}", f"xacro:{new}")
        if tags:
            return tags
    for markup_attribute in markup.attributes(source.text, start):
        whole = source.text[markup_attribute.start : markup_attribute.end]
        changed = re.sub(
            rf"(?<![\w.]){re.escape(old)}(?!\w)", new, whole, count=0 if "$" in whole else 1
        )
        if attribute in (None, markup_attribute.name) and changed != whole:
            return (source.edit(markup_attribute.start, markup_attribute.end, changed),)
    return ()
