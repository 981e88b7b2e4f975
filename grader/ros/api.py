"""The public API of `ros`: what the rest of the grader uses of it.

The checks, hints and rubric tools, which take robots and packages apart, use more. All other
names may move at any time.

**Read.** `open_workspace` reads what is at a path, `read_workspace` a file tree, and `read_urdf`
one URDF. Nothing is run or imported, and no text raises: a URDF that ROS 2 rejects is a `Reading`
with the verdict `rejected`, and a file that cannot be opened is `Unreadable`. Only a path without
anything that can be read raises InputError. Files are read as the programs of ROS 2 read them, by
default those of Jazzy: a URDF as urdfdom on TinyXML2, xacro as xacro, a package as colcon, ament
and launch.

**Ask.** A `Robot` has values, and a `Configuration` has poses. Lengths and sizes are metres, angles
are radians about fixed axes x, y, z (REP 103), masses are kilograms. A vector is three floats, and
a pose is a `Transform`: `T_a_b` maps points of frame b to frame a. What a file lacks raises
MissingElement, which names what exists; what cannot be determined statically raises NotDecided; a
shape whose size is not known raises UnknownShape.

**Show.** Every element and `Problem` has its place: path, line and column from 1. The `fixes` of a
problem are computed when they are iterated over.

A name is imported with its module when it is first asked for: most commands need few of them.

>>> from grader.ros.api import Configuration, read_urdf
>>> robot = read_urdf('<robot name="r"><link name="base"/></robot>').robot
>>> Configuration(robot).pose("base").translation
(0.0, 0.0, 0.0)
"""
# ruff: noqa: PLC0414  mypy takes a name that is imported `as` itself for one of this module

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from grader.ros.known.known_tables import releases_explanation as releases_explanation
    from grader.ros.known.parameter_texts import parameter_explanation as parameter_explanation
    from grader.ros.known.releases import Release as Release
    from grader.ros.known.releases import StatedReleases as StatedReleases
    from grader.ros.log.explaining import LogAnswer as LogAnswer
    from grader.ros.log.explaining import explain_log as explain_log
    from grader.ros.log.log_messages import MAX_LOG as MAX_LOG
    from grader.ros.nodes.node_facts import EndpointKind as EndpointKind
    from grader.ros.nodes.node_facts import Qos as Qos
    from grader.ros.package.mesh_loading import MeshLoader as MeshLoader
    from grader.ros.package.package import MANIFEST as MANIFEST
    from grader.ros.package.package import SETUP as SETUP
    from grader.ros.package.package import Package as Package
    from grader.ros.package.robot_file import Absent as Absent
    from grader.ros.package.robot_file import Read as Read
    from grader.ros.package.robot_file import Unreadable as Unreadable
    from grader.ros.package.robots import is_robot as is_robot
    from grader.ros.urdf.driving import Drive as Drive
    from grader.ros.urdf.driving import describe_driving as describe_driving
    from grader.ros.urdf.driving import plan_drive as plan_drive
    from grader.ros.urdf.kinematics import Configuration as Configuration
    from grader.ros.urdf.model import Box as Box
    from grader.ros.urdf.model import Capsule as Capsule
    from grader.ros.urdf.model import Cylinder as Cylinder
    from grader.ros.urdf.model import Joint as Joint
    from grader.ros.urdf.model import Link as Link
    from grader.ros.urdf.model import Mesh as Mesh
    from grader.ros.urdf.model import Origin as Origin
    from grader.ros.urdf.model import Robot as Robot
    from grader.ros.urdf.model import Sphere as Sphere
    from grader.ros.urdf.model import Visual as Visual
    from grader.ros.urdf.normal_form import robot_hash as robot_hash
    from grader.ros.urdf.normal_form import written_form as written_form
    from grader.ros.urdf.reader import Reading as Reading
    from grader.ros.urdf.reader import read_urdf as read_urdf
    from grader.ros.urdf.shapes import Shape as Shape
    from grader.ros.urdf.shapes import UnknownShape as UnknownShape
    from grader.ros.urdf.wheel_travel import travel_of as travel_of
    from grader.ros.urdf.wheel_travel import turning_joint as turning_joint
    from grader.ros.workspace.all_robots import read_workspace as read_workspace
    from grader.ros.workspace.extent import Extent as Extent
    from grader.ros.workspace.graph.graph_form import graph_form as graph_form
    from grader.ros.workspace.graph.launch_graph import CONNECTION_KINDS as CONNECTION_KINDS
    from grader.ros.workspace.graph.launch_graph import GRAPH_NODE_KINDS as GRAPH_NODE_KINDS
    from grader.ros.workspace.graph.launch_graph import Connection as Connection
    from grader.ros.workspace.graph.launch_graph import EndedProcess as EndedProcess
    from grader.ros.workspace.graph.launch_graph import GivenValue as GivenValue
    from grader.ros.workspace.graph.launch_graph import GraphEnd as GraphEnd
    from grader.ros.workspace.graph.launch_graph import GraphNode as GraphNode
    from grader.ros.workspace.graph.launch_graph import GraphTransform as GraphTransform
    from grader.ros.workspace.graph.launch_graph import LaunchGraph as LaunchGraph
    from grader.ros.workspace.graph.launch_graph import Unread as Unread
    from grader.ros.workspace.graph.launch_graph import connections_in as connections_in
    from grader.ros.workspace.graph.launch_graph import unconnected_ends as unconnected_ends
    from grader.ros.workspace.graph.lookups import looked_up_transforms as looked_up_transforms
    from grader.ros.workspace.graph.manual_ends import manual_ends as manual_ends
    from grader.ros.workspace.graph.node_ends import opened_by_bridge as opened_by_bridge
    from grader.ros.workspace.graph.started_controllers import spawned_by as spawned_by
    from grader.ros.workspace.graph.started_graph import unread_includes as unread_includes
    from grader.ros.workspace.graph.started_worlds import has_programs as has_programs
    from grader.ros.workspace.graph.started_worlds import started_worlds as started_worlds
    from grader.ros.workspace.graph.used_files import used_file as used_file
    from grader.ros.workspace.index.written_names import WrittenName as WrittenName
    from grader.ros.workspace.joined_graph import JoinedGraph as JoinedGraph
    from grader.ros.workspace.joined_graph import PlacedEnd as PlacedEnd
    from grader.ros.workspace.joined_graph import join_launches as join_launches
    from grader.ros.workspace.launch_graphs import launch_files as launch_files
    from grader.ros.workspace.launch_graphs import launch_graph as launch_graph
    from grader.ros.workspace.name_places import NamePlaces as NamePlaces
    from grader.ros.workspace.opened import OpenedWorkspace as OpenedWorkspace
    from grader.ros.workspace.opening import STANDARD_INPUT as STANDARD_INPUT
    from grader.ros.workspace.opening import open_workspace as open_workspace
    from grader.ros.workspace.parameter_callbacks import parameter_callbacks as parameter_callbacks
    from grader.ros.workspace.rules.problem_kinds import EVERY_KIND as EVERY_KIND
    from grader.ros.workspace.rules.rule_table import RULES as RULES
    from grader.ros.workspace.rules.rule_table import Rule as Rule
    from grader.ros.xml.xml_problems import RECOVERED as RECOVERED
else:
    _NAMES = {
        "known.known_tables": "releases_explanation",
        "known.parameter_texts": "parameter_explanation",
        "known.releases": "Release StatedReleases",
        "log.explaining": "LogAnswer explain_log",
        "log.log_messages": "MAX_LOG",
        "nodes.node_facts": "EndpointKind Qos",
        "package.mesh_loading": "MeshLoader",
        "package.package": "MANIFEST SETUP Package",
        "package.robot_file": "Absent Read Unreadable",
        "package.robots": "is_robot",
        "urdf.driving": "Drive describe_driving plan_drive",
        "urdf.kinematics": "Configuration",
        "urdf.model": "Box Capsule Cylinder Joint Link Mesh Origin Robot Sphere Visual",
        "urdf.normal_form": "robot_hash written_form",
        "urdf.reader": "Reading read_urdf",
        "urdf.shapes": "Shape UnknownShape",
        "urdf.wheel_travel": "travel_of turning_joint",
        "workspace.all_robots": "read_workspace",
        "workspace.extent": "Extent",
        "workspace.graph.graph_form": "graph_form",
        "workspace.graph.launch_graph": "CONNECTION_KINDS Connection EndedProcess "
        "GRAPH_NODE_KINDS GivenValue GraphEnd GraphNode GraphTransform LaunchGraph Unread "
        "connections_in unconnected_ends",
        "workspace.graph.manual_ends": "manual_ends",
        "workspace.index.written_names": "WrittenName",
        "workspace.joined_graph": "JoinedGraph PlacedEnd join_launches",
        "workspace.launch_graphs": "launch_files launch_graph",
        "workspace.graph.lookups": "looked_up_transforms",
        "workspace.graph.node_ends": "opened_by_bridge",
        "workspace.graph.started_controllers": "spawned_by",
        "workspace.graph.started_graph": "unread_includes",
        "workspace.graph.started_worlds": "has_programs started_worlds",
        "workspace.graph.used_files": "used_file",
        "workspace.name_places": "NamePlaces",
        "workspace.opened": "OpenedWorkspace",
        "workspace.opening": "STANDARD_INPUT open_workspace",
        "workspace.parameter_callbacks": "parameter_callbacks",
        "workspace.rules.problem_kinds": "EVERY_KIND",
        "workspace.rules.rule_table": "RULES Rule",
        "xml.xml_problems": "RECOVERED",
    }
    _MODULES = {name: module for module, names in _NAMES.items() for name in names.split()}

    def __getattr__(name: str) -> object:
        """Return a name of the API, and keep it."""
        if name not in _MODULES:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        value = getattr(import_module(f"grader.ros.{_MODULES[name]}"), name)
        globals()[name] = value
        return value
