"""The frames that functions of a C++ node publish, look up or stamp messages with."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from itertools import chain

from grader.base.grouping import only_one
from grader.base.patterns import on_use
from grader.base.transforms import Transform
from grader.ros.cpp.cpp_evaluation import CppEvaluation
from grader.ros.cpp.declarations import CppFunction, find_declaration, short_name
from grader.ros.cpp.syntax import NO_NODE, CppNode, CppNodes, CppNodesByName
from grader.ros.cpp.unit import CppUnit, called_name, list_arguments
from grader.ros.nodes.cpp.rclcpp_calls import read_name
from grader.ros.nodes.node_facts import FrameUse, NodeFrame, NodeTransform
from grader.ros.nodes.transform_poses import pose_set

_Settings = Mapping[str, Sequence[CppNode]]  # what is set to each field

_LOOKING_UP = ("lookupTransform", "canTransform", "waitForTransform")
_FULL_FORM = 5  # arguments of lookupTransform() with two times and a fixed frame
_TRANSFORM = "TransformStamped"
_SENDS = "sendTransform"
_FIELDS: Mapping[FrameUse, str] = {
    "is above": "header.frame_id",
    "publishes": "child_frame_id",
}
_STATIC = "StaticTransformBroadcaster"
_SET = ("frame_id", "child_frame_id")
_OF_POSE = on_use(r"(?:\.|->)transform\b")
_NUMBER_OF_POSE = on_use(r"(?:\.|->)[xyzw]\Z")
_MOVED = ("x", "y", "z", "w", "translation", "rotation", "transform")  # fields of a transform


class _Variables:
    """The variables of a function: the type of each, and what its fields are set to."""

    def __init__(self, function: CppFunction, unit: CppUnit) -> None:
        self.function = function
        self._unit = unit
        self._types: dict[str, str] = {}
        self._local: dict[str, bool] = {}
        self._numbers: dict[str, _Settings | None] = {}

    def find_type(self, name: CppNode) -> str:
        """Return the type of a local variable or a member, as it is written.

        It is empty if it is not known.
        """
        if name.text not in self._types:
            self._types[name.text] = self._read_type(name)
        return self._types[name.text]

    def is_local(self, name: CppNode) -> bool:
        """Return whether the function declares a variable."""
        self.find_type(name)
        return self._local[name.text]

    def _read_type(self, name: CppNode) -> str:
        self._local[name.text] = False
        for use in self.find_uses(name.text):
            declaration = find_declaration(use)
            if declaration:
                self._local[name.text] = True
                return declaration.child("type").text
        scopes = self.function.inner_scopes
        members = self._unit.variables_named(name.text, scopes)
        return members[0].type if len(members) == 1 else ""

    def find_uses(self, name: str) -> Iterator[CppNode]:
        """Yield where a name is written in the function."""
        start = self.function.node.start
        end = self.function.node.end
        for use in self._unit.uses.get(name, ()):
            if use.file is self.function.node.file and start <= use.start < end:
                yield use

    @cached_property
    def fields(self) -> _Settings:
        """What fields are set to in the function, by their whole text."""
        return _values_by_field(chain.from_iterable(map(self.find_uses, _SET)))

    def numbers(self, name: str) -> _Settings | None:
        """Return what is set of the transform in a local variable, by its field.

        The result is None where more may be set.
        """
        if name not in self._numbers:
            is_open = any(map(_is_given_away, self.find_uses(name)))
            self._numbers[name] = None if is_open else self._moved.get(name, {})
        return self._numbers[name]

    @cached_property
    def _moved(self) -> Mapping[str, _Settings]:
        """What fields of poses are set to in the function, by the variable and the field."""
        values = _values_by_field(chain.from_iterable(map(self.find_uses, _MOVED)))
        moved: dict[str, CppNodesByName] = {}
        for field, nodes in values.items():
            name, _, rest = field.partition(".")
            moved.setdefault(name, {})[rest] = nodes
        return moved

    @cached_property
    def fields_of_file(self) -> _Settings:
        """What fields are set to in the file, by their whole text."""
        uses = chain.from_iterable(self._unit.uses.get(name, ()) for name in _SET)
        return _values_by_field(use for use in uses if use.file is self.function.node.file)


def _values_by_field(uses: Iterable[CppNode]) -> CppNodesByName:
    """Return what is assigned to members, by the whole text of each."""
    values: CppNodesByName = {}
    for use in uses:
        value = _value_assigned(use.parent)
        if value:
            values.setdefault(use.parent.text, []).append(value)
    return values


def _value_assigned(member: CppNode) -> CppNode:
    """Return what a member is set to; NO_NODE where it is not set."""
    setting = member.parent
    is_set = setting.kind == "assignment_expression" and member.field == "left"
    return setting.child("right") if is_set else NO_NODE


def frames_in(
    function: CppFunction, unit: CppUnit, evaluation: CppEvaluation
) -> Iterator[NodeFrame]:
    """Yield the frames that a function names. One that is published and not known has no name."""
    variables = _Variables(function, unit)
    yield from _frames_in_calls(variables, unit, evaluation)
    for name in _SET:
        for use in variables.find_uses(name):
            yield from _set_frame(use, variables, evaluation)


def transforms_in(
    function: CppFunction, unit: CppUnit, evaluation: CppEvaluation
) -> Iterator[NodeTransform]:
    """Yield the transforms that a function sends by a broadcaster; frames may be unknown."""
    variables = _Variables(function, unit)
    for call in unit.calls_in(function):
        if call.kind != "call_expression" or short_name(called_name(call)) != _SENDS:
            continue
        given = list_arguments(call)
        is_name = len(given) == 1 and given[0].kind == "identifier"
        frames = []
        for kind, field in _FIELDS.items():
            value = _value_set(given[0], field, variables) if is_name else NO_NODE
            if value:
                frames.append(_frame(kind, value, evaluation))
            else:
                frames.append(NodeFrame(kind, None, call.location))
        broadcaster = next((each for each in call.walk() if each.kind == "identifier"), NO_NODE)
        kind_of_sender = variables.find_type(broadcaster)
        yield NodeTransform(
            frames[0],
            frames[1],
            call.location,
            is_static=_STATIC in kind_of_sender,
            is_conditional=_is_decided_by_parameter(call, function, evaluation),
            pose=_pose_sent(given[0], variables, evaluation) if is_name else None,
        )


def _pose_sent(name: CppNode, variables: _Variables, evaluation: CppEvaluation) -> Transform | None:
    """Return T_parent_child of a transform that is sent; None where it is not known."""
    values = variables.numbers(name.text) if variables.is_local(name) else None
    if values is None:
        return None

    def value_set(field: str) -> CppNode | None:
        return only_one(values[field])

    return pose_set(values.keys(), value_set, evaluation.evaluate_node)


def _is_given_away(use: CppNode) -> bool:
    """Return whether something may change a transform, or its pose, without an assignment."""
    part = use
    parent = use.parent
    while parent.kind == "field_expression" and part.field == "argument":
        part = parent
        parent = parent.parent
    if parent.kind == "declaration":
        return False
    if part is not use:
        is_set = part.field == "left" and parent.kind == "assignment_expression"
        is_of_pose = _OF_POSE.search(part.text) is not None
        return is_of_pose and not is_set and not _NUMBER_OF_POSE.search(part.text)
    if parent.kind == "init_declarator":
        return use.field == "value"
    if parent.kind == "argument_list":
        return short_name(called_name(parent.parent)) != _SENDS
    return True


def _value_set(name: CppNode, field: str, variables: _Variables) -> CppNode:
    """Return what a field of a transform is set to, once in the function.

    That of a member may be set once in another function of the file.
    """
    values = variables.fields.get(f"{name.text}.{field}", ())
    if not values and not variables.is_local(name):
        values = variables.fields_of_file.get(f"{name.text}.{field}", ())
    return values[0] if len(values) == 1 else NO_NODE


def _is_decided_by_parameter(
    call: CppNode, function: CppFunction, evaluation: CppEvaluation
) -> bool:
    """Return whether a condition on a parameter decides whether a call is made."""
    for around in call.ancestors():
        if around.start < function.node.start:
            return False
        condition = around.child("condition") if around.kind == "if_statement" else NO_NODE
        for tested in condition.walk():
            if tested.kind == "identifier":
                _, parts = read_name(evaluation.evaluate_node(tested))
                if any(part.kind == "parameter" for part in parts):
                    return True
    return False


def _frames_in_calls(
    variables: _Variables, unit: CppUnit, evaluation: CppEvaluation
) -> Iterator[NodeFrame]:
    """Yield the frames between which a function looks up transforms, and unknown published ones."""
    for call in unit.calls_in(variables.function):
        short = short_name(called_name(call)) if call.kind == "call_expression" else ""
        given = list_arguments(call) if short else []
        if short in _LOOKING_UP and len(given) > 1:
            second = given[2] if len(given) >= _FULL_FORM else given[1]
            for node in (given[0], second):
                yield _frame("looks up", node, evaluation)._replace(lookup=call.location)
        elif short == _SENDS and not _is_known_transform(given, variables):
            yield NodeFrame("publishes", None, call.location)


def _set_frame(
    use: CppNode, variables: _Variables, evaluation: CppEvaluation
) -> Iterator[NodeFrame]:
    """Yield the frame that a member frame_id or child_frame_id is set to."""
    value = _value_assigned(use.parent)
    if value:
        yield _frame(_kind_of_use(use, variables), value, evaluation)


def _kind_of_use(use: CppNode, variables: _Variables) -> FrameUse:
    """Return what a frame is to the message in which it is set."""
    root = next((inner for inner in use.parent.walk() if inner.kind == "identifier"), NO_NODE)
    if not variables.find_type(root).endswith(_TRANSFORM):
        return "names"
    return "publishes" if use.text == "child_frame_id" else "is above"


def _frame(kind: FrameUse, node: CppNode, evaluation: CppEvaluation) -> NodeFrame:
    name, parts = read_name(evaluation.evaluate_node(node))
    return NodeFrame(kind, name, node.location, parts)


def _is_known_transform(given: CppNodes, variables: _Variables) -> bool:
    """Return whether what is sent is one transform whose child frame the function itself sets."""
    if len(given) != 1 or given[0].kind != "identifier":
        return False
    if not variables.find_type(given[0]).endswith(_TRANSFORM):
        return False
    return f"{given[0].text}.child_frame_id" in variables.fields
