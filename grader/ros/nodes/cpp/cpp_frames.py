"""The frames that functions of a C++ node publish, look up or stamp messages with."""

from collections.abc import Iterator

from grader.ros.cpp.cpp_evaluation import CppEvaluation
from grader.ros.cpp.declarations import CppFunction, declared_in
from grader.ros.cpp.syntax import CppNode
from grader.ros.cpp.unit import CppUnit, arguments_of, called_name
from grader.ros.nodes.cpp.rclcpp_calls import name_of
from grader.ros.nodes.node_facts import FrameUse, NodeFrame

_LOOKING_UP = ("lookupTransform", "canTransform", "waitForTransform")
_FULL_FORM = 5  # arguments of lookupTransform() with two times and a fixed frame
_TRANSFORM = "TransformStamped"


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
        elif short == "sendTransform" and not _is_known_transform(given, function, unit):
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
