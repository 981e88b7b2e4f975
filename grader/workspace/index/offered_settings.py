"""What may be written at a place of a parameter file, a bridge's file or a file of RViz."""

import json

from grader.base.names import first_part, last_part
from grader.ros.known.package_rows import controller_types, plugin_classes, usual_names
from grader.ros.known.package_tables import bridge_table, display_types, rviz_classes
from grader.ros.known.parameter_rows import ParameterRow, row_for
from grader.ros.known.releases import names_in, releases_with
from grader.workspace.graph.gazebo_topics import gazebo_topics
from grader.workspace.graph.rviz_ends import TOOL_TYPES
from grader.workspace.graph.started_controllers import defined_controllers
from grader.workspace.index.offered_code import find_topics
from grader.workspace.index.offered_names import (
    declared_by,
    defined,
    find_frames,
    known_parameters,
)
from grader.workspace.index.offers import (
    BEST,
    GOOD,
    POSSIBLE,
    UNLIKELY,
    Offer,
    Offers,
    offer_released,
    offers,
    package_at,
)
from grader.workspace.index.typed_places import TypedPlace
from grader.workspace.model.workspace import Workspace

_PARAMETERS = "ros__parameters"
_MANAGER = "controller_manager"
_CLASS_KEYS = ("type", "plugin", "primary_controller", "kinematics_solver")


def _section_at(place: TypedPlace) -> tuple[str, str]:
    """Return the node whose parameters are around a place, and the prefix of these there.

    Outside of parameters both are empty.
    """
    names = [level.name for level in place.levels]
    if _PARAMETERS not in names[:-1]:
        return "", ""
    at = names.index(_PARAMETERS)
    prefix = "".join(f"{name}." for name in reversed(names[:at]))
    return last_part(names[at + 1]), prefix


def _nodes_at(workspace: Workspace, place: TypedPlace) -> list[tuple[str, str]]:
    """Return what is known to read the parameters at a place, each with the prefix of these there.

    It is a plug-in whose class is beside them, a controller by its type, or a node by its usual
    name.
    """
    section, prefix = _section_at(place)
    types = [each.type.text for each in defined_controllers(workspace) if each.name == section]
    node = types[0] if types else usual_names().get(section)
    plugin = place.holder.given.get("plugin", "").replace("/", "::")
    return [(plugin, ""), (node or "", prefix)]


def find_keys(workspace: Workspace, place: TypedPlace) -> Offers:
    """Yield the keys of a table of parameters, without those that it has."""
    return (one for one in _keys_at(workspace, place) if one.name not in place.holder.given)


def _keys_at(workspace: Workspace, place: TypedPlace) -> Offers:
    section, prefix = _section_at(place)
    if not section:
        yield from _keys_outside(workspace, place)
        return
    for offer in declared_by([node for node in workspace.code.nodes if node.name == section]):
        if offer.name.startswith(prefix):
            yield offer._replace(name=offer.name.removeprefix(prefix).partition(".")[0])
    for node, below in _nodes_at(workspace, place):
        yield from known_parameters(workspace, node, below)
    if section == _MANAGER:
        yield from offers(("type",) if prefix else workspace.installed.controllers, "")
    yield from offers(("plugin", "use_sim_time"), "", POSSIBLE)


def _keys_outside(workspace: Workspace, place: TypedPlace) -> Offers:
    """Yield the keys of a file outside of parameters: those of a bridge, or names of nodes."""
    if place.holder.name:
        yield Offer(_PARAMETERS, "parameters of a node")
        return
    rank = BEST if "_topic_name" in place.text else UNLIKELY
    yield from offers((*bridge_table().keys, "direction"), "key of a bridge", rank)
    yield from defined(workspace, place, "node")
    yield from defined(workspace, place, "controller")
    yield from offers(usual_names(), "node", POSSIBLE)


def find_values(workspace: Workspace, place: TypedPlace) -> Offers:
    """Yield the values of a parameter: what its row accepts, or what its name says that it is."""
    key = place.holder.slot
    rows = [row_for(node, f"{prefix}{key}") for node, prefix in _nodes_at(workspace, place)]
    is_class = key in _CLASS_KEYS
    for row in filter(None, rows):
        is_class = is_class or row.is_class
        yield from _values_of_row(row)
    if is_class:
        yield from _find_classes(workspace, place)
    elif key.endswith("plugins"):
        tables = [name for name, value in place.holder.given.items() if not value]
        yield from offers(tables, "table beside it")
    elif "joint" in key or key.endswith(("wheel_names", "wheels_names")):
        yield from defined(workspace, place, "joint")
    elif "frame" in key or key.endswith("_link"):
        yield from find_frames(workspace, place)
    elif "topic" in key:
        yield from find_topics(workspace, place)


def _values_of_row(row: ParameterRow) -> Offers:
    values = [*row.one_of, *row.entries]
    if row.type == "bool":
        values += [not row.default, bool(row.default)]
    values += row.default if isinstance(row.default, list) else [row.default]
    known = [json.dumps(value).strip('"') for value in values if value is not None]
    yield from offers(known, "accepted value")


def _find_classes(workspace: Workspace, place: TypedPlace) -> Offers:
    """Yield classes: of controllers in the controller manager, else of plug-ins."""
    is_of_manager = _section_at(place)[0] == _MANAGER
    package = package_at(workspace, place.path)
    for name in controller_types():
        is_declared = package is not None and package.depends_on(first_part(name))
        rank = GOOD - int(is_declared) if is_of_manager else UNLIKELY
        yield Offer(name, "controller", rank=rank)
    yield from defined(workspace, place, "plugin")
    for name in (*plugin_classes(), *names_in("plugin")):
        rank = UNLIKELY if is_of_manager or name.startswith("lib") else GOOD
        if "*" not in name:
            releases = releases_with("plugin", name)
            yield offer_released(workspace, name, "class of plug-ins", releases, rank)


def find_hardware(workspace: Workspace, place: TypedPlace) -> Offers:
    """Yield the classes of hardware of ros2_control."""
    for name in names_in("plugin"):
        if name.endswith("System"):
            releases = releases_with("plugin", name)
            yield offer_released(workspace, name, "class of hardware", releases, BEST)
    yield from defined(workspace, place, "plugin")


def find_bridged(workspace: Workspace, place: TypedPlace) -> Offers:
    """Yield the directions, types and topics of a row of a bridge."""
    key = place.holder.slot
    table = bridge_table()
    if key == "direction":
        yield from offers(table.directions, key)
    elif key == "ros_type_name":
        yield from offers((name.replace(".", "/") for name in table.types), "type of ROS")
    elif key == "gz_type_name":
        ros = place.given("ros_type_name").replace("/", ".")
        for name, types in table.types.items():
            rank = BEST if name == ros else POSSIBLE
            yield from offers((f"gz.msgs.{each}" for each in types), "type of Gazebo", rank)
    elif key == "gz_topic_name":
        for topic in gazebo_topics(workspace):
            yield Offer(f"/{topic.name}", f"gz.msgs.{topic.type}")
    else:
        yield from find_topics(workspace, place)


def find_rviz_settings(workspace: Workspace, place: TypedPlace) -> Offers:
    """Yield the value of a setting of RViz: a frame, a class or a topic."""
    key = place.holder.slot
    if key.endswith("Frame"):
        yield from find_frames(workspace, place)
    elif key == "Class":
        yield from _find_rviz_classes(place)
    elif key.endswith("Topic") or place.holder.name.endswith("Topic"):
        yield from find_topics(workspace, place)


def _find_rviz_classes(place: TypedPlace) -> Offers:
    """Yield the classes of displays, tools or views, first those that have the topics beside."""
    messages = {**display_types(), **TOOL_TYPES}
    written = {"Topic", "Description Topic"} & place.holder.given.keys()
    around = {level.name for level in place.levels}
    for kind, names in rviz_classes().items():
        for name in names if kind in around else ():
            shown = f"rviz_default_plugins/{name}"
            needed = {"Topic"} if name in messages else set[str]()
            if name == "RobotModel":
                needed = {"Description Topic"}
            rank = int(needed != written) + int(f"{shown}\n" in place.text)
            yield Offer(shown, kind, messages.get(name, ""), rank)
