"""The frames that functions of a C++ node publish, look up or stamp messages with."""

from collections.abc import Iterator, Mapping

from grader.ros.cpp.cpp_evaluation import CppEvaluation
from grader.ros.cpp.declarations import CppFunction, declared_in
from grader.ros.cpp.syntax import CppNode
from grader.ros.cpp.unit import CppUnit, arguments_of, called_name
from grader.ros.nodes.cpp.rclcpp_calls import name_of
from grader.ros.nodes.node_facts import FrameUse, NodeFrame, NodeTransform

_LOOKING_UP = ("lookupTransform", "canTransform", "waitForTransform")
_FULL_FORM = 5  # arguments of lookupTransform() with two times and a fixed frame
_TRANSFORM = "TransformStamped"
_SENDS = "sendTransform"
_FIELDS: Mapping[FrameUse, str] = {
    "is above": "header.frame_id",
    "publishes": "child_frame_id",
}
_STATIC = "StaticTransformBroadcaster"


def frames_in(
    function: CppFunction, unit: CppUnit, evaluation: CppEvaluation
) -> Iterator[NodeFrame]:
    """Yield the frames that a function names. One that is published and not known has no name."""
    yield from _frames_in_calls(function, unit, evaluation)
    for name in ("frame_id", "child_frame_id"):
        for use in unit.uses.get(name, ()):
            is_inside = function.node.start <= use.start < function.node.end
            if use.file is function.node.file and is_inside:
                yield from _set_frame(use, function, unit, evaluation)


def transforms_in(
    function: CppFunction, unit: CppUnit, evaluation: CppEvaluation
) -> Iterator[NodeTransform]:
    """Yield the transforms that a function sends by a broadcaster; frames may be unknown."""
    for call in unit.calls_in(function):
        if call.kind != "call_expression" or called_name(call).rpartition("::")[2] != _SENDS:
            continue
        given = arguments_of(call)
        name = given[0].text if len(given) == 1 and given[0].kind == "identifier" else ""
        frames: list[NodeFrame] = []
        for kind, field in _FIELDS.items():
            value = _value_set(f"{name}.{field}", function, unit) if name else None
            if value is not None:
                frames.append(_frame(kind, value, evaluation))
            else:
                frames.append(NodeFrame(kind, None, call.location))
        broadcaster = next((each for each in call.walk() if each.kind == "identifier"), None)
        kind_of_sender = _type_of(broadcaster, function, unit) if broadcaster is not None else ""
        yield NodeTransform(
            frames[0],
            frames[1],
            call.location,
            is_static=_STATIC in kind_of_sender,
            is_conditional=_is_decided_by_parameter(call, function, evaluation),
        )


def _value_set(field: str, function: CppFunction, unit: CppUnit) -> CppNode | None:
    """Return what a field of a transform is set to, once in the function, or once elsewhere."""
    inside: list[CppNode] = []
    elsewhere: list[CppNode] = []
    for use in unit.uses.get(field.rpartition(".")[2], ()):
        member = use.parent
        setting = member.parent if member is not None and member.text == field else None
        if member is None or setting is None or member.field != "left":
            continue
        value = setting.child("right") if setting.kind == "assignment_expression" else None
        if value is None or use.file is not function.node.file:
            continue
        is_inside = function.node.start <= use.start < function.node.end
        (inside if is_inside else elsewhere).append(value)
    values = inside or elsewhere
    return values[0] if len(values) == 1 else None


def _is_decided_by_parameter(
    call: CppNode, function: CppFunction, evaluation: CppEvaluation
) -> bool:
    """Return whether a condition on a parameter decides whether a call is made."""
    for around in call.ancestors():
        if around.start < function.node.start:
            return False
        condition = around.child("condition") if around.kind == "if_statement" else None
        for tested in condition.walk() if condition is not None else ():
            if tested.kind == "identifier":
                _, parts = name_of(evaluation.value_of(tested))
                if any(part.kind == "parameter" for part in parts):
                    return True
    return False


def _frames_in_calls(
    function: CppFunction, unit: CppUnit, evaluation: CppEvaluation
) -> Iterator[NodeFrame]:
    """Yield the frames between which a function looks up transforms, and unknown published ones."""
    for call in unit.calls_in(function):
        short = called_name(call).rpartition("::")[2] if call.kind == "call_expression" else ""
        given = arguments_of(call) if short else []
        if short in _LOOKING_UP and len(given) > 1:
            second = given[2] if len(given) >= _FULL_FORM else given[1]
            for node in (given[0], second):
                yield _frame("looks up", node, evaluation)._replace(lookup=call.location)
        elif short == _SENDS and not _is_known_transform(given, function, unit):
            yield NodeFrame("publishes", None, call.location)


def _set_frame(
    use: CppNode, function: CppFunction, unit: CppUnit, evaluation: CppEvaluation
) -> Iterator[NodeFrame]:
    """Yield the frame that a member frame_id or child_frame_id is set to."""
    member = use.parent
    setting = member.parent if member is not None else None
    if member is None or setting is None or setting.kind != "assignment_expression":
        return
    value = setting.child("right")
    if member.field == "left" and value is not None:
        yield _frame(_kind_of_use(use, member, function, unit), value, evaluation)


def _kind_of_use(use: CppNode, member: CppNode, function: CppFunction, unit: CppUnit) -> FrameUse:
    """Return what a frame is to the message in which it is set."""
    root = next((inner for inner in member.walk() if inner.kind == "identifier"), None)
    if root is None or not _type_of(root, function, unit).endswith(_TRANSFORM):
        return "names"
    return "publishes" if use.text == "child_frame_id" else "is above"


def _frame(kind: FrameUse, node: CppNode, evaluation: CppEvaluation) -> NodeFrame:
    name, parts = name_of(evaluation.value_of(node))
    return NodeFrame(kind, name, node.location, parts)


def _type_of(name: CppNode, function: CppFunction, unit: CppUnit) -> str:
    """Return the type of a local variable or a member, as it is written; empty if not known."""
    start, end = function.node.start, function.node.end
    for use in unit.uses.get(name.text, ()):
        if use.file is not name.file or not start <= use.start < end:
            continue
        for around in use.ancestors():
            is_declared = any(declared is use for declared, _ in declared_in(around))
            kind = around.child("type")
            if is_declared and kind is not None:
                return kind.text
    members = unit.variables_named(name.text, unit.scopes_of(function))
    return members[0].type if len(members) == 1 else ""


def _is_known_transform(given: list[CppNode], function: CppFunction, unit: CppUnit) -> bool:
    """Return whether what is sent is one transform whose child frame the function itself sets."""
    if len(given) != 1 or given[0].kind != "identifier":
        return False
    name = given[0].text
    if not _type_of(given[0], function, unit).endswith(_TRANSFORM):
        return False
    start, end = function.node.start, function.node.end
    for use in unit.uses.get("child_frame_id", ()):
        member = use.parent
        is_inside = use.file is function.node.file and start <= use.start < end
        is_set = member is not None and member.field == "left"
        if is_inside and is_set and member is not None and member.text == f"{name}.child_frame_id":
            return True
    return False
