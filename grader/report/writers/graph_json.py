"""A graph as JSON, schema grader/graph/v1."""

from collections.abc import Iterator, Sequence
from math import isfinite
from typing import Any, NamedTuple

from grader.base.problems import Problem
from grader.report.json_data import (
    PLACE,
    TEXT,
    JsonObject,
    Many,
    array,
    each,
    nullable,
    schema_key,
    to_json,
)
from grader.report.shown_graph import ShownGraph
from grader.workspace.api import CONNECTION_KINDS, GRAPH_NODE_KINDS, GraphEnd, GraphNode

_YES_OR_NO = {"type": "boolean"}
_NUMBER = {"type": "integer", "minimum": 0}
_END_KINDS = [
    "publisher",
    "subscription",
    "service",
    "client",
    "action server",
    "action client",
]


class _ShownNode(NamedTuple):
    """A node with its number and what is found at it."""

    id: int
    node: GraphNode
    ends: tuple["_ShownEnd", ...]
    findings: Sequence[Problem]


class _ShownEnd(NamedTuple):
    """An end of a node, how many others it connects to, and what is found at it."""

    end: GraphEnd
    partners: int
    findings: Sequence[Problem]


def _null_if_empty(name: str) -> Any:
    """Return the key of a text that is null where it is empty."""

    def get(value: Any) -> str | None:
        for part in name.split("."):
            value = getattr(value, part)
        return value or None

    return (nullable(TEXT), get)


def _nodes(shown: ShownGraph) -> Iterator[_ShownNode]:
    for number, node in shown.nodes:
        ends = [
            _ShownEnd(end, len(shown.partners(number, end)), shown.findings_at(node, end))
            for end in node.ends
        ]
        yield _ShownNode(number, node, tuple(ends), shown.list_findings(number))


def _json_value(value: Any) -> Any:
    """Return the value of a parameter; a number that JSON does not have is a text."""
    if isinstance(value, float) and not isfinite(value):
        return str(value)
    if isinstance(value, list | tuple):
        return list(map(_json_value, value))
    return value


_PLACE = JsonObject(dict(PLACE))
_FINDING = JsonObject(
    {
        "code": TEXT,
        "rule": (nullable(TEXT), lambda problem: problem.rule or None),
        "severity": {"enum": ["error", "warning", "note"]},
        "message": TEXT,
        "location": _PLACE,
    }
)
_END = JsonObject(
    {
        "kind": ({"enum": _END_KINDS}, "end.kind"),
        "name": (TEXT, "end.name"),
        "type": _null_if_empty("end.type"),
        "depth": (nullable(_NUMBER), "end.qos.depth"),
        "reliability": (nullable(TEXT), "end.qos.reliability"),
        "durability": (nullable(TEXT), "end.qos.durability"),
        "connected": (_NUMBER, "partners"),
        "certain": (_YES_OR_NO, lambda shown: not shown.end.doubt),
        "doubt": _null_if_empty("end.doubt"),
        "note": _null_if_empty("end.note"),
        "location": (_PLACE, "end.location"),
        "findings": Many(_FINDING),
    }
)
_PARAMETER = JsonObject(
    {
        "name": TEXT,
        "value": ({}, lambda given: _json_value(given.value)),
        "location": _PLACE,
    }
)
_NODE = JsonObject(
    {
        "id": _NUMBER,
        "name": _null_if_empty("node.name"),
        "program": (TEXT, "node.program"),
        "kind": ({"enum": list(GRAPH_NODE_KINDS)}, "node.kind"),
        "inside": _null_if_empty("node.inside"),
        "certain": (_YES_OR_NO, lambda shown: not shown.node.doubt),
        "doubt": _null_if_empty("node.doubt"),
        "opens_more": _null_if_empty("node.opens_more"),
        "location": (_PLACE, "node.location"),
        "parameters": (Many(_PARAMETER), "node.parameters"),
        "ends": Many(_END),
        "findings": Many(_FINDING),
    }
)
_CONNECTION = JsonObject(
    {
        "kind": {"enum": list(CONNECTION_KINDS)},
        "name": TEXT,
        "from": (_NUMBER, "from_node"),
        "to": (_NUMBER, "to_node"),
        "connects": (_YES_OR_NO, lambda each: not each.fault),
        "fault": _null_if_empty("fault"),
        "certain": (_YES_OR_NO, lambda each: not each.doubt),
        "doubt": _null_if_empty("doubt"),
    }
)
_PROCESS = JsonObject(
    {"program": TEXT, "doubt": _null_if_empty("doubt"), "location": _PLACE},
)
_TRANSFORM = JsonObject(
    {
        **each(TEXT, "parent child by"),
        "static": (_YES_OR_NO, "is_static"),
        "certain": (_YES_OR_NO, "is_certain"),
        "location": _PLACE,
    }
)
_MANUAL = JsonObject(
    {
        "kind": ({"enum": _END_KINDS}, lambda pair: pair[0].kind),
        "name": (TEXT, lambda pair: pair[0].name),
        "programs": (array(TEXT), lambda pair: pair[1]),
    }
)
_ARGUMENT = JsonObject(
    {"name": (TEXT, lambda pair: pair[0]), "value": (TEXT, lambda pair: pair[1])}
)
_HEARD = JsonObject(
    {
        "name": (TEXT, "topic.name"),
        "types": (array(TEXT), lambda heard: list(heard.topic.types)),
        "messages": (_NUMBER, "topic.count"),
        "rate": (nullable({"type": "number"}), "topic.rate"),
        "reliability": (nullable(TEXT), lambda heard: heard.topic.qos[0]),
        "durability": (nullable(TEXT), lambda heard: heard.topic.qos[1]),
        **each(array(TEXT), "publishers differences"),
    }
)
GRAPH = JsonObject(
    {
        **schema_key("grader/graph/v1"),
        "launch": (TEXT, "graph.path"),
        "launches": (array(TEXT), lambda shown: list(shown.launches)),
        "arguments": (Many(_ARGUMENT), "graph.arguments"),
        "nodes": (Many(_NODE), _nodes),
        "connections": Many(_CONNECTION),
        "manual": Many(_MANUAL),
        "processes": (Many(_PROCESS), "graph.processes"),
        "not_started": (Many(_PROCESS), "graph.not_started"),
        "transforms": (Many(_TRANSFORM), "graph.transforms"),
        "unread": (
            Many(JsonObject({"reason": TEXT, "location": _PLACE})),
            "graph.unread",
        ),
        "recorded": (Many(_HEARD), "heard"),
    },
    ("recorded",),
)


def graph_json(shown: ShownGraph) -> str:
    """Return a graph as JSON."""
    return to_json(GRAPH.data(shown))
