"""The elements of a xacro file before and after expansion.

Each has the place in the source that it came from.
"""

import re
from collections.abc import Iterator

from grader.base.patterns import on_use
from grader.base.problems import Problem
from grader.base.reuse import reuse
from grader.base.source import Source
from grader.base.text import blanked
from grader.ros.python.budget import Budget
from grader.ros.python.values import EvaluationFails, Undetermined
from grader.ros.xacro.scopes import ScopePlace
from grader.ros.xml.parsing import Element, parse_xml

_Attributes = dict[str, str]

_Children = list["XacroNode | str"]
_OF_TAG, _OF_ATTRIBUTE = 4, 2  # what reading one is charged
_COMPARED = 256  # names of attributes that lxml compares for one part: each with all of its element

# xacro reads the file as UTF-8, so that its parser ignores the encoding that the file declares.
_DECLARATION = on_use(
    r"""
    ^\ufeff?<\?xml\s+version\s*=\s*(["'])1\.[0-9]+\1
    (?:\s+\w+\s*=\s*(?:"[^"<>]*"|'[^'<>]*'))*        # encoding="latin-1", standalone='yes'
    \s*\?>
    """,
    re.VERBOSE,
)
_MISPLACED = on_use(r"<\?xml\s[^<>]*\?>")
_UNDECLARED = on_use(r"(</?\s*)xacro:")
# for the colon of an undeclared prefix: a letter that looks like one, so that columns stay
_STAND_IN = "\u02d0"
_UNDECLARED_TAG = f"xacro{_STAND_IN}"
_CDATA = on_use(r"<!--.*?(?:-->|\Z)|<!\[CDATA\[(.*?)(?:\]\]>|\Z)", re.DOTALL)


class XacroNode:
    """An element of a xacro file.

    `unresolved` holds why attributes are left as written: they are refused, or cannot be
    determined.
    """

    __slots__ = ("attributes", "children", "open", "place", "tag", "unresolved")

    def __init__(self, tag: str, place: ScopePlace, attributes: _Attributes | None = None) -> None:
        self.tag = tag
        self.place = place
        self.attributes: _Attributes = attributes if attributes is not None else {}
        self.children: _Children = []
        # attribute -> why it cannot be determined; empty where xacro refuses it
        self.unresolved: _Attributes = {}
        # why it may have more children or attributes; empty where xacro refuses them
        self.open: str | None = None

    @property
    def elements(self) -> "list[XacroNode]":
        """The children that are elements."""
        return [child for child in self.children if isinstance(child, XacroNode)]

    @property
    def text(self) -> str:
        """Its own text, without that of its children."""
        return "".join(child for child in self.children if isinstance(child, str)).strip()


def walk(node: XacroNode) -> Iterator[XacroNode]:
    """Yield an element and all in it, in the order of the text."""
    waiting = [node]
    while waiting:
        current = waiting.pop()
        yield current
        if current.children:
            waiting += reversed(current.elements)


def read_nodes(data: bytes, path: str, budget: Budget, *, is_repaired: bool = False) -> XacroNode:
    """Return the root of an XML file.

    Raises XMLSyntaxError, and Undetermined for a file with entities of its own.

    With `is_repaired`, two faults that xacro refuses do not matter: a misplaced declaration, and no
    xmlns:xacro.
    """
    _decode(data, budget)
    root, parts = _read(data, path, is_repaired)
    budget.charge(parts)
    return root


@reuse
def _read(data: bytes, path: str, is_repaired: bool) -> tuple[XacroNode, int]:
    """Return the root of an XML file, and what its attributes are charged."""
    source = Source(path, data.decode())
    text = source.text
    xml = _DECLARATION.sub(blanked, text, count=1)
    if is_repaired:
        xml = _MISPLACED.sub(blanked, xml)
        xml = xml if "xmlns:xacro" in xml else _UNDECLARED.sub(r"\1xacro" + _STAND_IN, xml)
    root = parse_xml(xml.encode("utf-8", "surrogateescape"))
    definitions = root.getroottree().docinfo.internalDTD
    if definitions is not None and next(definitions.iterentities(), None) is not None:  # type: ignore[attr-defined]
        raise Undetermined("entities of a DOCTYPE are not supported")
    if "<![CDATA[" in text and any("$" in section for section in _CDATA.findall(text)):
        raise Undetermined("a CDATA section with $ is not supported")
    budget = Budget()
    return _nodes(root, source, budget), budget.used


def recovered_nodes(
    data: bytes, path: str, budget: Budget
) -> tuple[XacroNode | None, list[Problem]]:
    """Return what can be read of a file with broken tags, and what was assumed.

    Returns None if no link can be read.
    """
    from grader.ros.xml.repair import repair  # late: few files are broken

    text = _decode(data, budget)
    repaired = repair(text)
    source = Source(path, text, repaired.offsets)
    assumed = [
        Problem(
            assumption.kind,
            assumption.message,
            source.at(assumption.offset),
            assumption.subject,
        )
        for assumption in repaired.assumed
    ]
    return _nodes(parse_xml(repaired.xml), source, budget) if repaired.xml else None, assumed


def _nodes(root: Element, source: Source, budget: Budget) -> XacroNode:
    nodes = {}
    for index, element in enumerate(root.iter()):
        attributes = _attributes(element)
        budget.charge(len(attributes) ** 2 // _COMPARED)
        node = nodes[element] = XacroNode(_tag(element), ScopePlace(source, index), attributes)
        _add_text(node.children, element.text)
        parent = element.getparent()
        if parent is not None:
            children = nodes[parent].children
            children.append(node)
            _add_text(children, element.tail)
    return nodes[root]


def _decode(data: bytes, budget: Budget) -> str:
    """Return the text of a file as UTF-8, which xacro assumes whatever the declaration says.

    It charges its tags.
    """
    prefixes = data.count(b"xmlns") * data.count(b":") // 8
    budget.charge(
        _OF_TAG * data.count(b"<") + _OF_ATTRIBUTE * data.count(b"=") + prefixes, len(data)
    )
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError:
        raise EvaluationFails("the file is not UTF-8 text") from None


def _add_text(children: _Children, text: str | None) -> None:
    if text and not text.isspace():
        children.append(text)


def _tag(element: Element) -> str:
    tag = str(element.tag)
    if tag[0] != "{":
        if tag.startswith(_UNDECLARED_TAG):
            return tag.replace(_STAND_IN, ":", 1)
        return tag
    local = tag.rpartition("}")[2]
    if element.prefix:
        return f"{element.prefix}:{local}"
    return local


def _attributes(element: Element) -> _Attributes:
    attributes: _Attributes = dict(element.items())  # type: ignore[arg-type]  # lxml gives str here
    if "{" not in "".join(attributes):
        return attributes
    prefixes = {uri: prefix for prefix, uri in element.nsmap.items() if prefix} | {_XML: "xml"}
    named = (
        name[1:].partition("}") if name.startswith("{") else ("", "", name) for name in attributes
    )
    names = (f"{prefixes[uri]}:{local}" if uri else local for uri, _, local in named)
    return dict(zip(names, attributes.values(), strict=True))


_XML = "http://www.w3.org/XML/1998/namespace"
