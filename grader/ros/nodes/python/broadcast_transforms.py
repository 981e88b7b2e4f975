"""The transforms that Python code gives to a broadcaster of tf2: which frame is in which one."""

import ast
from collections.abc import Callable, Collection, Iterator
from functools import partial

from grader.base.records import Named
from grader.base.source import Location
from grader.base.text import last_part
from grader.base.transforms import Transform
from grader.ros.nodes.message_uses import Evaluate, given_argument
from grader.ros.nodes.node_facts import NameOrParts, NodeFrame, NodeTransform
from grader.ros.nodes.python.endpoint_names import Bindings
from grader.ros.nodes.transform_poses import POSE_FIELDS, pose_set
from grader.ros.python.constants import dotted
from grader.ros.python.walking import children, walk

_Expression = ast.expr | None

SENDS = "sendTransform"
_KEEPING = (SENDS, "append")  # what is given a transform, and does not change it
_PARENT = "header.frame_id"
_CHILD = "child_frame_id"
_STATIC = "StaticTransformBroadcaster"
_PARAMETERS = ("get_parameter", "declare_parameter")


class SendingMethod(Named):
    """A method that sends transforms, and how what it names is read."""

    node: ast.AST
    of_class: ast.AST  # the class of the node, where attributes of self are set
    bindings: Bindings
    names: Callable[[ast.expr], Iterator[NameOrParts]]  # that an expression may be
    place: Callable[[ast.expr], Location]
    value_of: Evaluate


def sent_transforms(method: SendingMethod, call: ast.Call) -> Iterator[NodeTransform]:
    """Yield the transforms that a call of sendTransform() sends; frames may be unknown."""
    given = given_argument(call, 0, "transform")
    assert isinstance(call.func, ast.Attribute)
    broadcaster = method.bindings.values.get(dotted(call.func.value))
    is_static = isinstance(broadcaster, ast.Call) and dotted(broadcaster.func).endswith(_STATIC)
    for item, added in _items_sent(method, call, given):
        at = method.place(call)
        pose = _pose_sent(method, call, item)
        is_conditional = _is_decided_by_parameter(method, added)
        parents, children = _frames_set(method, call, item)
        for parent, parent_parts in parents:
            for child, child_parts in children:
                yield NodeTransform(
                    NodeFrame("is above", parent, at, parent_parts),
                    NodeFrame("publishes", child, at, child_parts),
                    at,
                    is_static=is_static,
                    is_conditional=is_conditional,
                    pose=pose,
                )


def _frames_set(
    method: SendingMethod, call: ast.Call, item: _Expression
) -> tuple[list[NameOrParts], list[NameOrParts]]:
    """Return the names of the parent and of the child that a transform may have."""
    parents = _names_set(method, call, item, _PARENT)
    children = _names_set(method, call, item, _CHILD)
    if len(parents) > 1 and len(children) > 1:  # a loop sets both
        return [(None, ())], [(None, ())]
    return parents, children


def _items_sent(
    method: SendingMethod, call: ast.Call, given: _Expression
) -> Iterator[tuple[_Expression, ast.Call]]:
    """Yield each transform that a call sends, with the call that adds it to a list."""
    name = given.id if isinstance(given, ast.Name) else ""
    made = method.bindings.values.get(name)
    listed = made if isinstance(made, ast.List) else given
    if not isinstance(listed, ast.List | ast.Tuple):
        yield given, call
        return
    for item in listed.elts:
        yield item, call
    for node in walk(method.node) if listed is made else ():
        match node:
            case ast.Call(func=ast.Attribute(value=ast.Name(id=owner), attr=called)):
                is_added = called == "append" and len(node.args) == 1
                if owner == name:
                    yield (node.args[0], node) if is_added else (None, call)


def _pose_sent(method: SendingMethod, call: ast.Call, item: _Expression) -> Transform | None:
    """Return T_parent_child of a transform that is sent; None where it is not known."""
    made = _resolve(method, item)
    if not isinstance(made, ast.Call):
        return None
    given = {f for f in _fields_given(method, made) if f.startswith("transform")}
    if made is item or given:
        return pose_set(given, partial(_value_made, method, made), method.value_of)
    name = dotted(item) if item else ""
    around = method.of_class if name.startswith("self.") else method.node
    targets: set[str] = set()
    for node in walk(around):
        if _may_set(node, name, "transform") or _hands_on(node, name):
            return None
        set_here = []
        if isinstance(node, ast.Assign):
            set_here = node.targets
        elif isinstance(node, ast.AugAssign):
            set_here = [node.target]
        targets.update(map(dotted, set_here))
    start = f"{name}.transform"
    moved = {each.removeprefix(f"{name}.") for each in targets if each.startswith(start)}
    return pose_set(moved, partial(_value_set, method, call, name), method.value_of)


def _names_set(
    method: SendingMethod, call: ast.Call, item: _Expression, field: str
) -> list[NameOrParts]:
    """Return the names to which a field of a transform is set before it is sent."""
    value = None
    if isinstance(item, ast.Call):
        value = _value_made(method, item, field)
    elif item:
        value = _value_set(method, call, dotted(item), field)
    return list(method.names(value)) if value else [(None, ())]


def _value_set(method: SendingMethod, call: ast.Call, name: str, field: str) -> _Expression:
    """Return what a field of a transform is set to; None if that is not known.

    Of several values the last one before the call counts, if no branch or loop decides it.
    """
    if not name:
        return None
    around = method.of_class if name.startswith("self.") else method.node
    statements = []
    for node in walk(around):
        if isinstance(node, ast.Assign) and f"{name}.{field}" in map(dotted, node.targets):
            statements.append(node)
        elif _may_set(node, name, field):
            return None
    if not statements:
        return _value_made(method, method.bindings.values.get(name), field)
    if len(statements) == 1:
        return statements[0].value
    body = getattr(method.node, "body", [])
    before = [each for each in statements if each.lineno < call.lineno]
    if before and all(each in body for each in statements):
        return max(before, key=lambda each: each.lineno).value
    return None


def _may_set(node: ast.AST, name: str, field: str) -> bool:
    """Return whether code adds to a field of a transform, or gives the transform another name."""
    match node:
        case ast.AugAssign(target=target):
            return dotted(target) == f"{name}.{field}"
        case ast.Assign(value=value):
            return dotted(value) == name
        case ast.Call(func=ast.Name(id="setattr"), args=[first, *_]):
            return dotted(first) == name
        case ast.Call(func=ast.Attribute(value=ast.Name(id="self"), attr=called), args=given):
            return called != SENDS and name in map(dotted, given)
    return False


def _hands_on(node: ast.AST, name: str) -> bool:
    """Return whether a part of code may set the pose of a transform by another name, or unseen."""
    start = f"{name}.transform"
    for part in children(node):
        written = dotted(part)
        if isinstance(node, ast.Attribute) or not (written == name or written.startswith(start)):
            continue
        is_set = not isinstance(getattr(part, "ctx", None), ast.Load)
        if written == name:
            is_shown = isinstance(node, ast.List | ast.Tuple | ast.FormattedValue)
            is_sent = is_shown or _calls_method(node, _KEEPING)
            is_known = is_set or is_sent
        elif is_set:
            is_known = isinstance(node, ast.Assign | ast.AugAssign)
        else:
            is_known = written.removeprefix(f"{name}.") in POSE_FIELDS
        if not is_known:
            return True
    return False


def _calls_method(node: ast.AST, names: Collection[str]) -> bool:
    """Return whether a call is one of a method with one of these names."""
    return isinstance(node, ast.Call) and last_part(dotted(node.func)) in names


def _value_made(method: SendingMethod, made: _Expression, field: str) -> _Expression:
    """Return what the call that makes a transform gives a field of it."""
    value = made
    for name in field.split("."):
        maker = _resolve(method, value)
        if not isinstance(maker, ast.Call):
            return None
        given = {keyword.arg: keyword.value for keyword in maker.keywords}
        value = given.get(name)
    return value


def _resolve(method: SendingMethod, node: _Expression) -> _Expression:
    """Return the call that a name is bound to; another expression as it is."""
    made = method.bindings.values.get(dotted(node))
    return made if isinstance(made, ast.Call) else node


def _fields_given(method: SendingMethod, made: ast.Call) -> Iterator[str]:
    """Yield the fields that a call gives to the message that it makes, each in full."""
    if made.args:
        yield "transform"  # of which nothing is known
    for keyword in made.keywords:
        name = keyword.arg or "transform"
        value = _resolve(method, keyword.value)
        if isinstance(value, ast.Call) and value is not keyword.value:
            value = None  # it may be changed after it is made
        if isinstance(value, ast.Call) and value.keywords:
            for inner in _fields_given(method, value):
                yield f"{name}.{inner}"
        else:
            yield name


def _is_decided_by_parameter(method: SendingMethod, call: ast.Call) -> bool:
    """Return whether a condition on a parameter decides whether a call is made."""
    for node in walk(method.node):
        if isinstance(node, ast.If) and call in walk(node):
            tested = [node.test]
            for inner in walk(node.test):
                bound = method.bindings.values.get(dotted(inner))
                if bound:
                    tested.append(bound)
            if any(map(_names_parameter, tested)):
                return True
    return False


def _names_parameter(value: ast.expr) -> bool:
    """Return whether an expression is made from a parameter of the node."""
    inner = (node.attr for node in walk(value) if isinstance(node, ast.Attribute))
    return not set(_PARAMETERS).isdisjoint(inner)
