"""The public API of `workspace`: what packages, launch files, nodes and robots are together.

**Open.** `open_workspace` opens what is at a path, `read_workspace` a file tree. Nothing is run or
imported. Only a path without anything that can be read raises InputError.

**Ask.** An `OpenedWorkspace` has robots, packages, launch files and problems. `launch_graph` says
what runs after a launch: a `LaunchGraph` of nodes, topics, services, actions and transforms, each
with its place and certainty. A `Problem` has its code, the name of its `Rule`, its message, its
place (path, line and column from 1), and fixes, which are computed when they are iterated over.

A name is imported with its module when it is first asked for. All other names may move at any time.
"""
# ruff: noqa: PLC0414  mypy takes a name that is imported `as` itself for one of this module

from typing import TYPE_CHECKING

from grader.base.late_names import late_names

if TYPE_CHECKING:
    from grader.workspace.graph.code_behaviour import frames_published as frames_published
    from grader.workspace.graph.code_behaviour import lack_of_goals as lack_of_goals
    from grader.workspace.graph.code_behaviour import names_text as names_text
    from grader.workspace.graph.code_ends import End as End
    from grader.workspace.graph.graph_form import graph_form as graph_form
    from grader.workspace.graph.included_nodes import unread_includes as unread_includes
    from grader.workspace.graph.joined_graph import JoinedGraph as JoinedGraph
    from grader.workspace.graph.joined_graph import PlacedEnd as PlacedEnd
    from grader.workspace.graph.joined_graph import join_launches as join_launches
    from grader.workspace.graph.launch_graph import CONNECTION_KINDS as CONNECTION_KINDS
    from grader.workspace.graph.launch_graph import GRAPH_NODE_KINDS as GRAPH_NODE_KINDS
    from grader.workspace.graph.launch_graph import PART_UNKNOWN as PART_UNKNOWN
    from grader.workspace.graph.launch_graph import Connection as Connection
    from grader.workspace.graph.launch_graph import EndedProcess as EndedProcess
    from grader.workspace.graph.launch_graph import GivenValue as GivenValue
    from grader.workspace.graph.launch_graph import GraphEnd as GraphEnd
    from grader.workspace.graph.launch_graph import GraphNode as GraphNode
    from grader.workspace.graph.launch_graph import GraphTransform as GraphTransform
    from grader.workspace.graph.launch_graph import LaunchGraph as LaunchGraph
    from grader.workspace.graph.launch_graph import Unread as Unread
    from grader.workspace.graph.launch_graph import connected_part as connected_part
    from grader.workspace.graph.launch_graph import connections_in as connections_in
    from grader.workspace.graph.launch_graph import fault_with_others as fault_with_others
    from grader.workspace.graph.launch_graph import unconnected_ends as unconnected_ends
    from grader.workspace.graph.launch_graphs import launch_files as launch_files
    from grader.workspace.graph.launch_graphs import launch_graph as launch_graph
    from grader.workspace.graph.lifecycle import LIFECYCLE_MANAGERS as LIFECYCLE_MANAGERS
    from grader.workspace.graph.lifecycle import are_nodes_activated as are_nodes_activated
    from grader.workspace.graph.lifecycle import find_stuck_nodes as find_stuck_nodes
    from grader.workspace.graph.lifecycle import has_lifecycle as has_lifecycle
    from grader.workspace.graph.lifecycle import managed_nodes as managed_nodes
    from grader.workspace.graph.lookups import looked_up_transforms as looked_up_transforms
    from grader.workspace.graph.manual_ends import manual_ends as manual_ends
    from grader.workspace.graph.node_ends import opened_by_bridge as opened_by_bridge
    from grader.workspace.graph.started_controllers import spawned_by as spawned_by
    from grader.workspace.graph.started_worlds import has_programs as has_programs
    from grader.workspace.graph.started_worlds import started_worlds as started_worlds
    from grader.workspace.graph.used_files import used_file as used_file
    from grader.workspace.index.name_places import NamePlaces as NamePlaces
    from grader.workspace.index.offered_at import offered_at as offered_at
    from grader.workspace.index.typed_places import KEY as KEY
    from grader.workspace.index.typed_places import TypedPlace as TypedPlace
    from grader.workspace.index.typed_places import read_typed_place as read_typed_place
    from grader.workspace.index.written_names import WrittenName as WrittenName
    from grader.workspace.log.explaining import LogAnswer as LogAnswer
    from grader.workspace.log.explaining import explain_log as explain_log
    from grader.workspace.log.explaining import known_rows as known_rows
    from grader.workspace.log.log_messages import MAX_LOG as MAX_LOG
    from grader.workspace.model.parameter_callbacks import (
        parameter_callbacks as parameter_callbacks,
    )
    from grader.workspace.model.parameter_uses import find_parameter_use as find_parameter_use
    from grader.workspace.opening.all_robots import read_workspace as read_workspace
    from grader.workspace.opening.described_recordings import (
        DescribedRecording as DescribedRecording,
    )
    from grader.workspace.opening.described_recordings import (
        describe_recordings as describe_recordings,
    )
    from grader.workspace.opening.extent import Extent as Extent
    from grader.workspace.opening.opened import OpenedWorkspace as OpenedWorkspace
    from grader.workspace.opening.opening import STANDARD_INPUT as STANDARD_INPUT
    from grader.workspace.opening.opening import open_workspace as open_workspace
    from grader.workspace.opening.recorded_graph import HeardTopic as HeardTopic
    from grader.workspace.opening.recorded_graph import compare_recording as compare_recording
    from grader.workspace.rules.problem_kinds import EVERY_KIND as EVERY_KIND
    from grader.workspace.rules.rule_table import RULES as RULES
    from grader.workspace.rules.rule_table import Rule as Rule
    from grader.workspace.rules.rule_table import public_findings as public_findings
else:
    _NAMES = {
        "graph.code_behaviour": "frames_published lack_of_goals names_text",
        "graph.code_ends": "End",
        "graph.graph_form": "graph_form",
        "graph.included_nodes": "unread_includes",
        "graph.joined_graph": "JoinedGraph PlacedEnd join_launches",
        "graph.launch_graph": "CONNECTION_KINDS GRAPH_NODE_KINDS Connection EndedProcess "
        "GivenValue GraphEnd GraphNode GraphTransform LaunchGraph "
        "PART_UNKNOWN Unread connected_part connections_in fault_with_others unconnected_ends",
        "graph.launch_graphs": "launch_files launch_graph",
        "graph.lifecycle": "LIFECYCLE_MANAGERS are_nodes_activated find_stuck_nodes "
        "has_lifecycle managed_nodes",
        "graph.lookups": "looked_up_transforms",
        "graph.manual_ends": "manual_ends",
        "graph.node_ends": "opened_by_bridge",
        "graph.started_controllers": "spawned_by",
        "graph.started_worlds": "has_programs started_worlds",
        "graph.used_files": "used_file",
        "index.name_places": "NamePlaces",
        "index.offered_at": "offered_at",
        "index.typed_places": "KEY TypedPlace read_typed_place",
        "index.written_names": "WrittenName",
        "log.explaining": "LogAnswer explain_log known_rows",
        "log.log_messages": "MAX_LOG",
        "model.parameter_callbacks": "parameter_callbacks",
        "model.parameter_uses": "find_parameter_use",
        "opening.all_robots": "read_workspace",
        "opening.recorded_graph": "HeardTopic compare_recording",
        "opening.described_recordings": "DescribedRecording describe_recordings",
        "opening.extent": "Extent",
        "opening.opened": "OpenedWorkspace",
        "opening.opening": "STANDARD_INPUT open_workspace",
        "rules.problem_kinds": "EVERY_KIND",
        "rules.rule_table": "RULES Rule public_findings",
    }
    __getattr__ = late_names(__name__, _NAMES)
