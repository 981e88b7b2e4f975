"""What the code of a node declares and opens, in whatever language it is written.

The readers of the languages make these facts; names and parameters are compared by them.
"""

from collections.abc import Iterator
from typing import Literal, NamedTuple

from grader.base.problems import NO_FIXES, Fixes
from grader.base.source import Location
from grader.base.transforms import Transform
from grader.ros.python.parse import SyntaxFault
from grader.ros.python.values import Value

EndpointKind = Literal[
    "publisher", "subscription", "service", "client", "action server", "action client"
]


class NamePart(NamedTuple):
    """A part of a name that depends on the node as it is started.

    `text` is the text itself, or the parameter whose value is the part: an "item" is each entry of
    its list, in one name always the same one.
    """

    kind: Literal["text", "node name", "namespace", "parameter", "item", "unknown"]
    text: str = ""


class Qos(NamedTuple):
    """A quality of service; None for what is not known."""

    depth: int | None = None
    reliability: str | None = None
    durability: str | None = None


class ImageEncoding(NamedTuple):
    """An encoding of images, as bgr8, and where code makes or asks for it."""

    name: str
    location: Location


class Endpoint(NamedTuple):
    """A publisher, subscription, service or client, also of an action.

    `type` is a full name: std_msgs.msg.Float32.
    """

    kind: EndpointKind
    type: str | None
    name: str | None  # of the topic or service, as it is written; None where it is made of `parts`
    location: Location
    qos: Qos = Qos()
    parts: tuple[NamePart, ...] = ()  # of a name that is no plain text; none if it is not known
    # Of the images that it sends, or to which its callback converts them; none if one is unknown.
    encodings: tuple[ImageEncoding, ...] = ()
    is_conditional: bool = False  # whether a condition in the code decides if it is opened
    is_caught: bool = False  # whether the code may catch the error that it is refused with
    is_unused: bool = False  # a publisher with which the code certainly publishes nothing

    @property
    def is_computed(self) -> bool:
        """Whether its name is computed in a way that is not known for any node."""
        return self.name is None and (not self.parts or ("unknown", "") in self.parts)


class NodeParameter(NamedTuple):
    """A parameter that a node declares, with its default, or that it reads."""

    name: str | None
    default: Value  # Unknown where it is computed, None where there is none
    location: Location
    is_declared: bool = True
    is_plain: bool = True  # without a descriptor, which may allow values of other types
    is_needed: bool = True  # False where it is read, and need not be declared
    is_unset: bool = False  # declared with a type and no value, so that it has to be given one
    is_guard: bool = False  # asked for whether it is declared, which need not be so


FrameUse = Literal["publishes", "is above", "looks up", "names"]


class NodeFrame(NamedTuple):
    """A frame that a node publishes, looks up or names in messages, or one above it.

    Without a name and `parts` it is not known.

    `lookup` is the place of the call that looks up the transform between it and another frame.
    """

    use: FrameUse
    name: str | None
    location: Location
    parts: tuple[NamePart, ...] = ()
    lookup: Location | None = None


class NodeTransform(NamedTuple):
    """A transform that a node gives to a broadcaster; frames that are not known have no name."""

    parent: NodeFrame
    child: NodeFrame
    location: Location
    is_static: bool = False
    is_conditional: bool = False  # whether a parameter decides if it is sent
    pose: Transform | None = None  # T_parent_child, where the code sets it to numbers


class Timer(NamedTuple):
    """A timer, with its period in seconds."""

    period: float | None
    location: Location


class Doubt(NamedTuple):
    """What may declare or open more, and where; `of` says what has to be known to settle it."""

    reason: str
    location: Location
    of: Literal["", "base class", "more arguments"] = ""


class TypeImport(NamedTuple):
    """A message, service or action that code certainly imports: chat_msgs.srv.Ask."""

    name: str
    location: Location


class RclpyObject(NamedTuple):
    """An object of rclpy that code uses where its value is meant."""

    name: str  # Parameter
    lacks: str  # what gives the value: .value
    end: Location  # where this has to be written


class FieldUse(NamedTuple):
    """A field that code uses of a value whose type is certain.

    `type` has the name of the section, as in Python: chat_msgs.srv.Ask.Request; GoalHandle is what
    has the goal as its `request`. `path` are the names of fields down to the one that is used; `[]`
    is an item of a list. `literal` is what the field is set to: one value, or none if it is not
    known. Items of a list may not be known. `instead` is an object that is used in place of the
    value that it has; a number of a computation then has the type of that object.
    """

    type: str
    path: tuple[str, ...]
    location: Location
    literal: tuple[Value, ...] = ()
    instead: RclpyObject | None = None


class SynchronisedType(NamedTuple):
    """A type of messages whose times a synchroniser compares, and the class of that.

    `together` are the types of all its messages, for a class of C++ that takes any.
    """

    type: str
    by: str
    location: Location
    together: tuple[str, ...] = ()


class CodeFault(NamedTuple):
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


class NodeFacts(NamedTuple):
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


class NodeProgram(NamedTuple):
    """A program, and the nodes that its function creates, as far as they are known."""

    name: str
    nodes: tuple[NodeFacts, ...]
    location: Location
    path: str  # of its file in the package
    function: str  # that setup.py names; empty for a file that is a program
    syntax: SyntaxFault | None = None  # why Python cannot read the file
    may_have_more: bool = False  # nodes in its process, of classes of another package


class PackageNodes(NamedTuple):
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
