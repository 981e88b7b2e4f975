"""The properties and macros that xacro files define, and the names that they use.

They are as they are written.
"""

from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import chain

from grader.base.grouping import texts_among
from grader.base.patterns import on_use
from grader.base.source import Location
from grader.base.text import last_part
from grader.ros.python.budget import Budget
from grader.ros.python.values import EvaluationFails, Undetermined
from grader.ros.xacro.macros import read_parameters
from grader.ros.xacro.scopes import ScopePlace
from grader.ros.xacro.tags import HANDLERS
from grader.ros.xacro.texts import PIECE, TEXT_IN_QUOTES
from grader.ros.xacro.xacro_nodes import XacroNode, walk

_NAME = on_use(r"(?<![\w.])[^\W\d]\w*+(?:\.[^\W\d]\w*+)*+(?!\s*=[^=])")

_Definitions = dict[str, list[ScopePlace]]


@dataclass(frozen=True, slots=True)
class Inventory:
    """The definitions in files, each with its places, and what is used.

    `dynamic` are tags with evaluated names.
    """

    properties: _Definitions = field(default_factory=dict)
    macros: _Definitions = field(default_factory=dict)
    used: set[str] = field(default_factory=set)
    called: set[str] = field(default_factory=set)
    includes: list[ScopePlace] = field(default_factory=list)
    dynamic: list[ScopePlace] = field(default_factory=list)

    @staticmethod
    def first_places(definitions: _Definitions, paths: Sequence[str]) -> dict[str, Location]:
        """Return where names are first defined in some files."""
        first = {}
        for name, places in definitions.items():
            for place in places:
                if place.source.path in paths:
                    first[name] = place.at("name")
                    break
        return first

    def define(self, definitions: _Definitions, name: str, place: ScopePlace) -> None:
        """Note a definition, or that its name is evaluated."""
        if "$" in name:
            self.dynamic.append(place)
        elif name:
            definitions.setdefault(name, []).append(place)


def take_inventory(documents: Iterable[XacroNode], budget: Budget) -> Inventory:
    """Return what files define and use; a macro's parameter is no use of a property of its name.

    Raises OutOfBudget.
    """
    inventory = Inventory()
    roots = list(documents)
    namespaces = set()
    for node in chain.from_iterable(map(walk, roots)):
        if node.tag == "xacro:include":
            namespaces.add(node.attributes.get("ns"))
    waiting = [(root, frozenset[str]()) for root in reversed(roots)]
    while waiting:
        node, hidden = waiting.pop()
        tag_name = _note_tag(node, inventory)
        inventory.used.update(_names_used(node, namespaces) - hidden - {tag_name})
        if node.tag == "xacro:macro":
            hidden |= _parameters(node, inventory, budget)
        waiting += [(child, hidden) for child in reversed(node.elements)]
    return inventory


def _names_used(node: XacroNode, namespaces: Collection[str | None]) -> set[str]:
    """Return the names in the attributes and texts of an element, without namespaces."""
    names = set()
    texts = texts_among(node.children)
    for text in (*node.attributes.values(), *texts):
        for name in _names_in(text):
            first, _, other = name.partition(".")
            names.add(other if first in namespaces else first)
    return names


def _note_tag(node: XacroNode, inventory: Inventory) -> str:
    """Note what a tag of xacro defines or calls.

    Returns the name of a property, whose own text is no use of it.
    """
    name = node.attributes.get("name", "")
    match node.tag:
        case "xacro:property":
            if node.attributes.get("remove") in (None, "false"):
                inventory.define(inventory.properties, name, node.place)
            return name
        case "xacro:macro":
            inventory.define(inventory.macros, name.removeprefix("xacro:"), node.place)
        case "xacro:include":
            inventory.includes.append(node.place)
        case "xacro:insert_block":
            inventory.used.add(name)
        case "xacro:call":
            called = node.attributes.get("macro", "")
            inventory.called.add(last_part(called))
            if "$" in called:
                inventory.dynamic.append(node.place)
        case tag if tag.startswith("xacro:") and tag not in HANDLERS:
            inventory.called.add(last_part(tag.removeprefix("xacro:")))
    return ""


def _parameters(node: XacroNode, inventory: Inventory, budget: Budget) -> frozenset[str]:
    """Return the names of a macro's parameters; forwarding one uses the caller's property.

    Raises OutOfBudget.
    """
    try:
        parameters = read_parameters(node.attributes.get("params", ""), budget)
    except (EvaluationFails, Undetermined):
        return frozenset()
    inventory.used.update(parameter.name for parameter in parameters if parameter.is_forwarded)
    return frozenset(parameter.name.lstrip("*") for parameter in parameters)


def _names_in(text: str) -> Iterator[str]:
    """Yield the names in the expressions of a text, with dots."""
    position = text.find("$")
    while position >= 0 and (piece := PIECE.match(text, position)):
        position = piece.end()
        if piece["substitution"] is not None:
            yield from _names_in(piece["substitution"])
        for match in _NAME.finditer(TEXT_IN_QUOTES.sub("''", piece["expression"] or "")):
            yield match[0]
