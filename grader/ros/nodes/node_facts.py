"""What the code of a node declares and opens, in whatever language it is written.

The readers of the languages make these facts; names and parameters are compared by them.
"""

from collections.abc import Collection, Iterator, Mapping
from typing import Literal, NamedTuple, TypeVar

from grader.base.grouping import Strings
from grader.base.names import near
from grader.base.problems import NO_FIXES, Fixes
from grader.base.records import Named
from grader.base.source import Location
from grader.base.transforms import Transform
from grader.ros.python.parse import SyntaxFault
from grader.ros.python.values import Value

EndpointKind = Literal[
    "publisher", "subscription", "service", "client", "action server", "action client"
]


# rclcpp_lifecycle/lifecycle_node_interface.hpp and rclpy/lifecycle/managed_entity.py.
_STATE_CALLBACKS = frozenset(
    {"on_configure", "on_activate", "on_deactivate", "on_cleanup", "on_shutdown", "on_error"}
)


class NamePart(Named):
    """A part of a name that depends on the node as it is started.

    `text` is the text itself, or the parameter whose value is the part: an "item" is each entry of
    its list, in one name always the same one.
    """

    kind: Literal["text", "node name", "namespace", "parameter", "item", "unknown"]
    text: str = ""


NameParts = tuple[NamePart, ...]
NameOrParts = tuple[str | None, NameParts]  # None for one that is no plain text


class Qos(Named):
    """A quality of service; None for what is not known."""

    depth: int | None = None
    reliability: str | None = None
    durability: str | None = None


class ImageEncoding(Named):
    """An encoding of images, as bgr8, and where code makes or asks for it."""

    name: str
    location: Location


ImageEncodings = tuple[ImageEncoding, ...]
EncodingsByLocation = Mapping[Location, ImageEncodings]  # of the ends for images


class Endpoint(NamedTuple):
    """A publisher, subscription, service or client, also of an action.

    `type` is a full name: std_msgs.msg.Float32.
    """

    kind: EndpointKind
    type: str | None
    name: str | None  # of the topic or service, as it is written; None where it is made of `parts`
    location: Location
    qos: Qos = Qos()
    parts: NameParts = ()  # of a name that is no plain text; none if it is not known
    # Of the images that it sends, or to which its callback converts them; none if one is unknown.
    encodings: ImageEncodings = ()
    is_conditional: bool = False  # whether a condition in the code decides if it is opened
    is_caught: bool = False  # whether the code may catch the error that it is refused with
    is_unused: bool = False  # a publisher with which the code certainly publishes nothing

    @property
    def is_computed(self) -> bool:
        """Whether its name is computed in a way that is not known for any node."""
        return self.name is None and (not self.parts or ("unknown", "") in self.parts)


class NodeParameter(Named):
    """A parameter that a node declares, with its default, or that it reads."""

    name: str | None
    default: Value  # Unknown where it is computed, None where there is none
    location: Location
    is_declared: bool = True
    is_plain: bool = True  # without a descriptor, which may allow values of other types
    is_needed: bool = True  # False where it is read, and need not be declared
    is_unset: bool = False  # declared with a type and no value, so that it has to be given one
    is_guard: bool = False  # asked for whether it is declared, which need not be so
    is_untyped: bool = False  # declared in C++ with neither a type nor a value
    read_as: str = ""  # by which method of a parameter in C++: as_int


def updater_facts(location: Location) -> tuple[Endpoint, NodeParameter, NodeParameter]:
    """Return what a diagnostic_updater::Updater opens and declares for the node that it is given.

    Source: diagnostic_updater.hpp and _diagnostic_updater.py of ros/diagnostics.
    """
    published = "diagnostic_msgs.msg.DiagnosticArray"
    return (
        Endpoint("publisher", published, "/diagnostics", location, Qos(1)),
        NodeParameter("diagnostic_updater.period", 1.0, location),
        NodeParameter("diagnostic_updater.use_fqn", False, location),
    )


FrameUse = Literal["publishes", "is above", "looks up", "names"]


class NodeFrame(Named):
    """A frame that a node publishes, looks up or names in messages, or one above it.

    Without a name and `parts` it is not known.

    `lookup` is the place of the call that looks up the transform between it and another frame.
    """

    use: FrameUse
    name: str | None
    location: Location
    parts: NameParts = ()
    lookup: Location | None = None


class NodeTransform(Named):
    """A transform that a node gives to a broadcaster; frames that are not known have no name."""

    parent: NodeFrame
    child: NodeFrame
    location: Location
    is_static: bool = False
    is_conditional: bool = False  # whether a parameter decides if it is sent
    pose: Transform | None = None  # T_parent_child, where the code sets it to numbers


class Timer(Named):
    """A timer, with its period in seconds."""

    period: float | None
    location: Location


class Doubt(Named):
    """What may declare or open more, and where; `of` says what has to be known to settle it."""

    reason: str
    location: Location
    of: Literal["", "base class", "more arguments"] = ""


class TypeImport(Named):
    """A message, service or action that code certainly imports: chat_msgs.srv.Ask."""

    name: str
    location: Location


class RclpyObject(Named):
    """An object of rclpy that code uses where its value is meant."""

    name: str  # Parameter
    lacks: str  # what gives the value: .value
    end: Location  # where this has to be written


class FieldUse(Named):
    """A field that code uses of a value whose type is certain.

    `type` has the name of the section, as in Python: chat_msgs.srv.Ask.Request; GoalHandle is what
    has the goal as its `request`. `path` are the names of fields down to the one that is used; `[]`
    is an item of a list. `literal` is what the field is set to: one value, or none if it is not
    known. Items of a list may not be known. `instead` is an object that is used in place of the
    value that it has; a number of a computation then has the type of that object.
    """

    type: str
    path: Strings
    location: Location
    literal: tuple[Value, ...] = ()
    instead: RclpyObject | None = None


class SynchronisedType(Named):
    """A type of messages whose times a synchroniser compares, and the class of that.

    `together` are the types of all its messages, for a class of C++ that takes any.
    """

    type: str
    by: str
    location: Location
    together: Strings = ()


class CodeFault(Named):
    """Why a node stops, or does nothing; it fails no criterion unless it is certain.

    `code_faults` and the readers of C++ find it. `inspect` says it as a finding of its rule, and a
    grade assumes its first fix where a program certainly runs the code (`running_code`).
    """

    rule: str  # the name of a rule, most of `workspace/rules/code.py`
    message: str
    location: Location
    related: Location | None = None
    is_certain: bool = True
    fixes: Fixes = NO_FIXES


CodeFaults = Iterator[CodeFault]


class NodeFacts(Named):
    """A node: a class of nodes, or one that is made by a function; then `class_name` is empty.

    With `doubts`, it may declare or open more than is listed.
    """

    class_name: str  # in full: sensor_hub.alarm.Alarm
    name: str | None
    location: Location
    endpoints: tuple[Endpoint, ...]
    parameters: tuple[NodeParameter, ...]
    timers: tuple[Timer, ...]
    doubts: tuple[Doubt, ...]
    frames: tuple[NodeFrame, ...] = ()
    transforms: tuple[NodeTransform, ...] = ()  # of a broadcaster
    named_at: Location | None = None  # where it gets its name; None where that is not known


NodeFact = Endpoint | NodeParameter | NodeFrame | NodeTransform | Timer | Doubt
_Kind = TypeVar("_Kind")


def make_node(
    facts: Collection[object],
    encodings: EncodingsByLocation,
    class_name: str,
    name: str | None,
    location: Location,
) -> NodeFacts:
    """Return a node with its facts; `encodings` are those of images, by the places of endpoints."""

    def of_kind(kind: type[_Kind]) -> tuple[_Kind, ...]:
        return tuple(fact for fact in facts if isinstance(fact, kind))

    endpoints = []
    for endpoint in of_kind(Endpoint):
        known = encodings.get(endpoint.location, ())
        endpoints.append(endpoint._replace(encodings=known))
    return NodeFacts(
        class_name,
        name,
        location,
        tuple(endpoints),
        of_kind(NodeParameter),
        of_kind(Timer),
        of_kind(Doubt),
        of_kind(NodeFrame),
        of_kind(NodeTransform),
    )


class NodeProgram(Named):
    """A program, and the nodes that its function creates, as far as they are known."""

    name: str
    nodes: tuple[NodeFacts, ...]
    location: Location
    path: str  # of its file in the package
    function: str  # that setup.py names; empty for a file that is a program
    syntax: SyntaxFault | None = None  # why Python cannot read the file
    may_have_more: bool = False  # nodes in its process, of classes of another package


class PackageNodes(Named):
    """The nodes of a package, and its programs.

    With `doubts`, a node may declare or open more, or be missing.
    """

    nodes: tuple[NodeFacts, ...]
    programs: tuple[NodeProgram, ...]
    doubts: tuple[Doubt, ...]
    has_loose_declarations: bool = False  # of parameters, of a node that is not known
    imports: tuple[TypeImport, ...] = ()
    field_uses: tuple[FieldUse, ...] = ()
    faults: tuple[CodeFault, ...] = ()
    synchronised: tuple[SynchronisedType, ...] = ()
    has_more_faults: bool = False  # perhaps, in modules that are not searched
    # What a program publishes for which no node is known.
    loose_frames: tuple[NodeFrame, ...] = ()
    texts: tuple[tuple[str, Location], ...] = ()  # in C++, those that name files of packages
    cpp_files: frozenset[str] = frozenset()  # the paths in the package of those that are read


def misnamed_callback(name: str, defined: Collection[str], at: Location) -> CodeFault | None:
    """Return that a method is named nearly as a callback of a lifecycle that its class lacks.

    `defined` are the methods of the class, which nothing else calls.
    """
    meant = near(name, _STATE_CALLBACKS)
    if meant is None or meant in defined or name in _STATE_CALLBACKS:
        return None
    message = f"{name}() is no callback of a lifecycle node, so nothing calls it; use {meant}()"
    return CodeFault("callback-name", message, at)
