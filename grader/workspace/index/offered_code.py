"""What may be written at a place of code: topics, parameters, types and their fields."""

import re
from collections.abc import Iterator, Mapping
from functools import partial
from itertools import chain

from grader.base.names import last_part
from grader.base.patterns import on_use
from grader.base.source import Location
from grader.ros.interfaces.interface_types import Interface
from grader.ros.interfaces.known_interfaces import known_interfaces
from grader.ros.known.end_rows import opened_ends
from grader.ros.known.package_files import packages_with_files
from grader.ros.known.package_rows import program_row
from grader.ros.known.package_tables import display_types, interface_table
from grader.ros.nodes.node_facts import EndpointKind, FieldUse, NodeFacts
from grader.ros.nodes.used_fields import resolve_field
from grader.workspace.graph.graph import make_graph
from grader.workspace.graph.launch_graph import OPPOSITES, PART_UNKNOWN
from grader.workspace.index.offered_names import (
    declared_by,
    started_node,
    topics_of_controllers,
)
from grader.workspace.index.offers import (
    BEST,
    GOOD,
    POSSIBLE,
    UNLIKELY,
    Offer,
    Offers,
    offers,
    package_at,
)
from grader.workspace.index.typed_places import FIELD, TypedPlace
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.interfaces import find_interface

# What a call opens, and which of its arguments has the type, unless it is a template's.
_OPENED: Mapping[str, tuple[EndpointKind, str]] = {
    "create_publisher": ("publisher", "0"),
    "create_subscription": ("subscription", "0"),
    "create_service": ("service", "0"),
    "create_client": ("client", "0"),
    "ActionServer": ("action server", "1"),
    "ActionClient": ("action client", "1"),
    "create_server": ("action server", "0"),
    "Subscriber": ("subscription", "1"),
}
_WORDS = on_use(r"\w+")
_DECLARED = on_use(r"\bdeclare_parameter\w*+(?:<[^()]{0,200}>)?\(\s*[\"'](?P<name>[\w.]+)")


# --- Topics, services and actions


def find_opened_names(workspace: Workspace, place: TypedPlace) -> Offers:
    """Yield the names of topics, services or actions that a call opens, first those of its type."""
    kind, argument = _OPENED[place.holder.name]
    wanted = _find_last_word(place.given("<", argument))
    for offer in _named_ends(workspace, kind, wanted):
        name = offer.name if place.typed.startswith("/") else offer.name.lstrip("/")
        yield offer._replace(name=name)
    for end in chain.from_iterable(facts.endpoints for facts in workspace.code.nodes):
        if end.kind in (kind, OPPOSITES[kind]):
            rank = _rank_type(wanted, end.type or "", GOOD)
            yield Offer(end.name or "", end.type or "", end.kind, rank)
    package = package_at(workspace, place.path)
    for _, node in workspace.launches.launched:
        if package and package.name == node.package:
            yield from offers((rule[0] for rule in node.remaps or ()), "in a remapping", GOOD)


def _find_last_word(text: str) -> str:
    words = _WORDS.findall(text)
    return words[-1] if words else ""


def _named_ends(workspace: Workspace, kind: EndpointKind, wanted: str) -> Offers:
    """Yield the full names to which an end of a kind may connect, first those of its type."""
    for graph in make_graph(workspace).launched:
        for node in graph.nodes:
            for end in node.ends:
                if end.kind in (kind, OPPOSITES[kind]) and PART_UNKNOWN not in end.name:
                    rank = _rank_type(wanted, end.type, POSSIBLE - int(end.kind != kind))
                    yield Offer(end.name, end.type, f"{end.kind}: {node.label}", rank)


def _rank_type(wanted: str, written: str, otherwise: int) -> int:
    """Return the rank of an end with a type where one is wanted; either may be unknown."""
    if not wanted or not written:
        return otherwise
    return otherwise - 1 if _find_last_word(written) == wanted else UNLIKELY


def find_topics(workspace: Workspace, place: TypedPlace) -> Offers:
    """Yield the topics that something publishes, by their full names."""
    message = display_types().get(last_part(place.given("Class")), "")
    if place.holder.name == "Description Topic":
        message = "std_msgs.msg.String"
        yield Offer("/robot_description", message)
    wanted = _find_last_word(message or place.given("ros_type_name"))
    yield from _named_ends(workspace, "subscription", wanted)


def find_remapped(workspace: Workspace, place: TypedPlace) -> Offers:
    """Yield the names that a program opens, as a remapping of it replaces them."""
    started = started_node(place)
    for facts in workspace.code.find_nodes(started):
        for endpoint in facts.endpoints:
            yield Offer(endpoint.name or "", endpoint.type or "", endpoint.kind)
    row = opened_ends(*started.program)
    for kind, name, message in row.fixed if row else ():
        yield Offer(name, message, kind, POSSIBLE if kind == "service" else BEST)
    known = program_row(*started.program)
    for name, message in {**known.subscriptions, **known.publishers}.items():
        yield Offer(name, message)
    if started.package == "controller_manager":
        yield Offer("~/robot_description", "std_msgs.msg.String")
        yield from topics_of_controllers(workspace)


# --- Parameters


def _nodes_in(workspace: Workspace, path: str) -> list[NodeFacts]:
    """Return the nodes in a file."""
    package = package_at(workspace, path)
    code = workspace.code.by_package.get(package.name) if package else None
    nodes = code.nodes if code else ()
    return [facts for facts in nodes if facts.location.path == path]


def find_declared_parameters(workspace: Workspace, place: TypedPlace) -> Offers:
    """Yield the parameters that the nodes of a file declare."""
    yield from declared_by(_nodes_in(workspace, place.path))
    yield from offers(_DECLARED.findall(place.text), "parameter", GOOD)


# --- Types


_IMPORTED = on_use(
    r"^[ \t]*+from\s+(?P<package>\w+)\.(?P<part>msg|srv|action)\s+import\s+"
    r"(?P<names>\([\w\s,]+|[\w ,]+)",
    re.MULTILINE,
)


def _imported_types(text: str) -> Iterator[tuple[str, str]]:
    """Yield the types that a file of Python imports: the name there, and the full one."""
    for match in _IMPORTED.finditer(text):
        for word in match["names"].strip("(").split(","):
            name, _, other = word.strip().partition(" as ")
            yield other or name, f"{match['package']}.{match['part']}.{name}"


def find_imported_types(_: Workspace, place: TypedPlace) -> Offers:
    """Yield the types that a file imports, of the kind that a call takes."""
    kind, _argument = _OPENED[place.holder.name]
    part = {"service": ".srv.", "client": ".srv."}.get(kind, ".action." if " " in kind else ".msg.")
    for name, full in _imported_types(place.text):
        if part in full:
            yield Offer(name, full)


def _name_header(name: str) -> str:
    """Return what rosidl calls the header of a type: u_int16.hpp of UInt16."""
    name = re.sub(r"(.)([A-Z][a-z]+)", r"\1_\2", name)
    return re.sub(r"([a-z0-9])([A-Z])", r"\1_\2", name).lower() + ".hpp"


def find_types(workspace: Workspace, place: TypedPlace) -> Offers:
    """Yield the types of a package that an import, a header or a name of C++ is of.

    Those that the file names come first.
    """
    if place.holder.slot == FIELD:
        return
    words = _WORDS.findall(f"{place.holder.slot} {place.before}")
    is_header = place.language == "cpp" and place.holder.name == "import"
    if len(words) > 1 and words[-1] in ("msg", "srv", "action"):
        used = {*_WORDS.findall(place.text)}
        for name, interface in _types_in(workspace, words[-2], words[-1]):
            shown = _name_header(name) if is_header else name
            rank = int(name not in used)
            fields = _fields_text(interface)
            yield Offer(f"{place.before}{shown}", "/".join(words[-2:]), fields, rank)
        return
    mark = "/" if is_header else "."
    if place.language == "cpp" and not is_header:
        mark = "::"
    names = [mark.join(each) for each in _interface_packages(workspace)]
    yield from offers([f"{name}/" for name in names] if is_header else names, "types", GOOD)
    package = package_at(workspace, place.path) if is_header else None
    for path in package.tree.files if package else ():
        if path.endswith((".hpp", ".h")):
            yield Offer(path.removeprefix("include/"), "header")


def _types_in(workspace: Workspace, package: str, part: str) -> Iterator[tuple[str, Interface]]:
    """Yield the messages, services or actions of a package."""
    types = dict(known_interfaces(package, workspace.releases) or {})
    known = workspace.code.interfaces.get(package)
    for name, own_type in known.types.items() if known else ():
        types[name] = own_type.interface
    for name, interface in types.items():
        if name.startswith(f"{part}."):
            yield name.removeprefix(f"{part}."), interface


def _fields_text(interface: Interface) -> str:
    fields = [field for section in interface.sections for field in section.fields.values()]
    return "\n".join(f"{field.type.full_name} {field.name}" for field in fields)


def _interface_packages(workspace: Workspace) -> Iterator[tuple[str, str]]:
    """Yield the packages with types, each with msg, srv or action."""
    for name in sorted(packages_with_files()):
        yield from ((name, part) for part in interface_table(name) or ())
    for name, known in workspace.code.interfaces.items():
        yield from ((name, kind.partition(".")[0]) for kind in known.types)


# --- Fields


_PYTHON_VARIABLE = on_use(
    r"(?<![\w.])(?P<name>[\w.]++)\s*+(?::\s*+[\w.\"']++\s*+)?=\s*+(?P<type>[A-Z][\w.]*+)\("
    r"|(?<![\w.])(?P<argument>\w++)\s*+:\s*+(?P<of>[A-Z][\w.]*+)"
    r"|create_(?:subscription|service)\(\s*(?P<called>[\w.]+)\s*,[^()]{0,200}?self\.(?P<callback>\w+)"
)
_CPP_VARIABLE = on_use(
    r"\b(?P<type>\w++::(?:msg|srv|action)::\w++(?:::\w++){0,3}+)\s*+>?\s*+(?:const\b\s*+)?[&*]*+\s*+"
    r"(?P<name>\w+)\s*[;,)({=]"
    r"|\bauto\s+(?P<made>\w+)\s*=[^;]{0,200}?\b(?P<of>\w++::(?:msg|srv|action)::\w+)"
)
_POINTER = on_use(r"\.(?:Const|Shared|Unique)\w*")
_ITEM = on_use(r"\[[^\[\]]*\]")


def find_fields(workspace: Workspace, place: TypedPlace) -> Offers:
    """Yield the fields of a value whose type is a message, service or action."""
    owner = _ITEM.sub(".[]", place.levels[0].name.replace("->", ".")).strip("()*&")
    types = _types_of_variables(place)
    parts = owner.split(".")
    count = 1 + int(parts[0] == "self")
    kind = types.get(".".join(parts[:count]), "")
    if kind.count(".") > 1:
        use = FieldUse(kind, (*parts[count:], ""), Location(place.path, 1, 1))
        used = resolve_field(use, partial(find_interface, workspace))
        for field in used.section.fields.values() if used else ():
            yield Offer(field.name, field.type.full_name + "[]" * field.type.is_list)


def _types_of_variables(place: TypedPlace) -> dict[str, str]:
    """Return the full types of the variables before a place, by their names; later ones count."""
    before = place.text[: place.offset]
    if place.language == "python":
        return _types_in_python(place, before)
    types: dict[str, str] = {}
    for match in _CPP_VARIABLE.finditer(before):
        full = (match["type"] or match["of"]).replace("::", ".")
        types[match["name"] or match["made"]] = _POINTER.sub("", full)
    return types


def _types_in_python(place: TypedPlace, before: str) -> dict[str, str]:
    imported = dict(_imported_types(place.text))
    types = dict[str, str]()
    for match in _PYTHON_VARIABLE.finditer(place.text):
        short, _, section = (match["type"] or match["of"] or match["called"]).partition(".")
        full = f"{imported.get(short, '')}.{section}".strip(".")
        if match["callback"] is not None:
            types |= _types_of_callback(before, match["callback"], full)
        elif match.end() <= place.offset and "." in full:
            types[match["name"] or match["argument"]] = full
    return types


def _types_of_callback(before: str, name: str, full: str) -> dict[str, str]:
    """Return the types of the arguments of a callback, if a text ends in its definition."""
    defined = re.match(rf"{name}\(self, (\w+)(?:, (\w+))?", before.rpartition("def ")[2])
    if not defined:
        return {}
    if ".srv." in full:
        return {defined[1]: f"{full}.Request", defined[2]: f"{full}.Response"}
    return {defined[1]: full}
