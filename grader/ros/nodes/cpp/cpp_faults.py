"""What keeps a node in C++ from doing anything: in the files that are compiled into one target.

Each rule is about what certainly fails once it runs.
"""

import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from itertools import chain

from grader.ros.cpp.declarations import CppFunction, declared_in, plain
from grader.ros.cpp.objects import class_written
from grader.ros.cpp.syntax import CppNode
from grader.ros.cpp.unit import (
    CppUnit,
    called_name,
    is_conditional,
    list_arguments,
)
from grader.ros.nodes.node_facts import CodeFault

_MAX_FAULTS = 20  # of one target and rule
# What works as long as something keeps it, and how it is called.
_KEPT = {
    "create_wall_timer": "timer",
    "create_timer": "timer",
    "create_subscription": "subscription",
    "create_service": "service",
    "create_server": "action server",
}
# rclcpp keeps only weak pointers to these: rclcpp/src/rclcpp/node_interfaces/node_parameters.cpp.
_HANDLES = dict.fromkeys(
    (
        "add_pre_set_parameters_callback",
        "add_on_set_parameters_callback",
        "add_post_set_parameters_callback",
    ),
    "handle of a callback",
)
# What sets the state of a goal, if nothing cancels it, and what destroys it otherwise:
# rclcpp_action/include/rclcpp_action/server_goal_handle.hpp.
_ENDING_STATES, _ACTIONS = ("succeed", "abort"), "rclcpp_action::"
# The answers to a goal: rclcpp_action/include/rclcpp_action/types.hpp.
_ACCEPTS, _REJECTS = ("ACCEPT_AND_EXECUTE", "ACCEPT_AND_DEFER"), "REJECT"
_CANCEL_ANSWER = "CancelResponse"  # which rejects as well, but no goals
# Publishers of these nodes send nothing before: rclcpp_lifecycle/lifecycle_publisher.hpp.
_LIFECYCLE, _ACTIVATES = "rclcpp_lifecycle::LifecycleNode", "on_activate"
_LISTENER, _BUFFER = "TransformListener", "Buffer"
_LOOKING_UP = ("lookupTransform", "canTransform")
# What may spin a node, or wait for its messages.
_SPINNING = re.compile(r"spin|executor|wait|take|sleep|thread|async", re.IGNORECASE)
_LOOPS = ("while_statement", "for_statement", "do_statement", "for_range_loop")
# With one of these, a callback may wait for another one.
_CONCURRENT = ("create_callback_group", "MultiThreadedExecutor", "thread", "async", "detach")
_WAITING = ("wait", "get")
_SLEEPING = ("sleep_for", "sleep_until", "sleep", "usleep")
_GIVEN_CALLBACKS = (*_KEPT, "create_client")
_OTHER_CALLBACKS = ("TransformListener", "message_filters", "async_send_request")
_SENDING = ("sendTransform", "push_back", "emplace_back")
_ROTATION = re.compile(r"(\w+(?:(?:\.|->)\w+)*)(?:\.|->)rotation\.([xyzw])")
_ZERO = re.compile(r"-?(?:0++(?:\.0*+)?|\.0++)f?")


def cpp_faults(
    unit: CppUnit, nodes: Collection[str], *, is_program: bool, is_read: bool
) -> Iterator[CodeFault]:
    """Yield what is wrong in the files of a target.

    Args:
        unit: The files.
        nodes: The full names of the classes of nodes.
        is_program: Whether they are all that a program is made of.
        is_read: Whether all of them are read as a whole.
    """
    search = _CppSearch(unit, nodes)
    rules = [search.destroyed(), search.without_rotation(), search.waiting()]
    if is_read:
        rules += [search.without_listener(), search.without_goal_state()]
        rules += [search.without_activation(), search.rejected_goals()]
    if is_read and is_program:
        rules.append(search.without_spin())
    for rule in rules:
        for number, fault in enumerate(rule):
            if number < _MAX_FAULTS:
                yield fault


class _CppSearch:
    """Searches faults in the files of a target."""

    def __init__(self, unit: CppUnit, nodes: Collection[str]) -> None:
        self._unit, self._nodes = unit, nodes
        self._methods = [
            function for function in unit.functions if unit.find_owner(function) in nodes
        ]

    def _calls(self, function: CppFunction, *names: str) -> Iterator[CppNode]:
        for call in self._unit.calls_in(function):
            short = called_name(call).rpartition("::")[2]
            if call.kind == "call_expression" and short in names:
                yield call

    def _own_calls(self, function: CppFunction, *names: str) -> Iterator[CppNode]:
        """Yield the calls of functions, or of methods of the object itself or of a rate."""
        for call in self._calls(function, *names):
            called = call.child("function")
            written = called.text.removeprefix("this->") if called is not None else ""
            is_own = "." not in written and "->" not in written
            if is_own or "rate" in written.lower():
                yield call

    def _uses(self, name: str, function: CppFunction) -> list[CppNode]:
        """Return where a name is written in a function."""
        node = function.node
        uses = [use for use in self._unit.uses.get(name, ()) if use.file is node.file]
        return [use for use in uses if node.start <= use.start < node.end]

    def without_activation(self) -> Iterator[CodeFault]:
        """Yield where a node with a lifecycle becomes active, and its publishers do not."""
        if any(next(self._calls(each, _ACTIVATES), None) for each in self._unit.functions):
            return
        for function in self._methods:
            owner = function.owner
            if function.name != _ACTIVATES or function.is_conditional:
                continue
            scopes = self._unit.list_scopes(function)
            bases = chain.from_iterable(
                written.bases for written in self._unit.classes.get(owner, ())
            )
            if not any(_LIFECYCLE in self._unit.meanings(base, scopes) for base in bases):
                continue
            for method in self._methods:
                calls = self._own_calls(method, "create_publisher")
                made = next((call for call in calls if "::" not in called_name(call)), None)
                if made is not None and self._unit.find_owner(method) == owner:
                    message = (
                        f"the publishers of {owner.rpartition('::')[2]} stay inactive, and send "
                        f"nothing: call LifecycleNode::{_ACTIVATES}(state)"
                    )
                    at = function.node.location
                    yield CodeFault("publisher-activated", message, at, made.location)
                    break

    def without_goal_state(self) -> Iterator[CodeFault]:
        """Yield action servers in files in which no goal succeeds or is aborted."""
        if not self._unit.uses.keys().isdisjoint(_ENDING_STATES):
            return
        for function in self._methods:
            for call in self._calls(function, "create_server"):
                if called_name(call).startswith(_ACTIONS):
                    message = (
                        "nothing sets the state of a goal, so rclcpp_action cancels it; "
                        "call succeed()"
                    )
                    yield CodeFault("goal-state", message, call.location, is_certain=False)

    def rejected_goals(self) -> Iterator[CodeFault]:
        """Yield action servers in files in which goals are rejected, and none is accepted."""
        uses = self._unit.uses
        rejections = []
        for node in uses.get(_REJECTS, ()):
            # Who cancels a goal is answered by the same word.
            if node.parent is None or _CANCEL_ANSWER not in node.parent.text:
                rejections.append(node)
        if not rejections or not uses.keys().isdisjoint(_ACCEPTS):
            return
        for function in self._methods:
            for call in self._calls(function, "create_server"):
                if called_name(call).startswith(_ACTIONS):
                    message = (
                        "the server rejects each goal: GoalResponse::ACCEPT_AND_EXECUTE accepts"
                    )
                    yield CodeFault("goal-state", message, call.location, is_certain=False)

    def destroyed(self) -> Iterator[CodeFault]:
        """Yield what a method makes and nothing keeps: it is destroyed when the method ends."""
        for function in self._methods:
            if function.is_conditional or _may_wait(function, self._unit):
                continue
            kept = {**_KEPT, **_HANDLES}
            for call in self._calls(function, *kept):
                kind = kept[called_name(call).rpartition("::")[2]]
                if self._is_lost(call, function):
                    message = (
                        f"nothing keeps this {kind}: it is destroyed when {function.name}() ends"
                    )
                    yield CodeFault("entity-kept", message, call.location)
            if function.name == function.owner.rpartition("::")[2]:
                yield from self._lost_listeners(function)

    def _lost_listeners(self, constructor: CppFunction) -> Iterator[CodeFault]:
        for node in self._unit.calls_in(constructor):
            written = plain(class_written(node))
            is_listener = written.rpartition("::")[2] == _LISTENER
            if is_listener and self._is_lost(node, constructor):
                message = "nothing keeps this TransformListener: the buffer stays empty"
                yield CodeFault("entity-kept", message, node.location)

    def _is_lost(self, made: CppNode, function: CppFunction) -> bool:
        """Return whether an object is not kept.

        It is a statement of its own, or of a local variable that nothing else names.
        """
        declaration = made
        if made.kind != "declaration":
            parent = made.parent
            if parent is None or is_conditional(made, function.node):
                return False
            if parent.kind == "expression_statement":
                return True
            if parent.kind != "init_declarator" or parent.parent is None:
                return False
            declaration = parent.parent
        if "static" in declaration.text.split("(")[0].split():
            return False
        names = [name for name, _ in declared_in(declaration)]
        return len(names) == 1 and len(self._uses(names[0].text, function)) == 1

    def without_rotation(self) -> Iterator[CodeFault]:
        """Yield transforms that are sent with a rotation whose four numbers are zeros."""
        for function in self._unit.functions:
            if function.body is None or not any(self._calls(function, "sendTransform")):
                continue
            for path, parts in _assigned_rotations(function).items():
                zero = _last_zero(parts)
                if zero is not None and self._is_only_sent(path, function):
                    message = "the rotation 0 0 0 0 turns nothing: tf2 ignores the transform"
                    yield CodeFault("rotation-set", message, zero.location)

    def _is_only_sent(self, path: str, function: CppFunction) -> bool:
        """Return whether nothing but the statements that are read can set a transform."""
        root = re.split(r"\.|->", path)[0]
        for use in self._uses(root, function):
            parent = use.parent
            if parent is None:
                return False
            if parent.kind == "argument_list" and parent.parent is not None:
                if called_name(parent.parent).rpartition("::")[2] not in _SENDING:
                    return False
            elif parent.kind == "field_expression":
                whole = _outermost_member(parent)
                if not _is_number_set(whole):
                    return False
            elif use.field != "declarator":
                return False
        return True

    def without_listener(self) -> Iterator[CodeFault]:
        """Yield where a buffer is asked for transforms that nothing puts into it."""
        if self._is_made(_LISTENER) or "setTransform" in self._unit.uses:
            return
        for function in self._methods:
            for call in self._calls(function, *_LOOKING_UP):
                if self._is_own_buffer(call):
                    message = "the buffer stays empty: nothing makes a TransformListener"
                    yield CodeFault("buffer-listener", message, call.location)
                    return

    def _is_made(self, name: str) -> bool:
        """Return whether an object of a class may be made.

        The class is named otherwise than as the type of a pointer that is a member.
        """
        for file in self._unit.files:
            for node in file.syntax.nodes:
                if node.kind != "type_identifier" or node.text != name:
                    continue
                kinds = [around.kind for around in node.ancestors()]
                is_member = "field_declaration" in kinds and "template_argument_list" in kinds
                if not is_member or "compound_statement" in kinds or "call_expression" in kinds:
                    return True
        return False

    def _is_own_buffer(self, call: CppNode) -> bool:
        """Return whether a call is a method of a member that is a buffer.

        Only such methods are called of the member.
        """
        called = call.child("function")
        owner = called.child("argument") if called is not None else None
        if owner is None or owner.kind != "identifier":
            return False
        variables = [
            variable
            for variables_of_name in self._unit.variables.values()
            for variable in variables_of_name
        ]
        declared = [variable for variable in variables if variable.declarator.text == owner.text]
        if len(declared) != 1 or not re.search(rf"\b{_BUFFER}\b", declared[0].type):
            return False
        return all(_is_plain_use(use) for use in self._unit.uses[owner.text])

    def without_spin(self) -> Iterator[CodeFault]:
        """Yield the end of a main() whose nodes nothing spins."""
        mains = [
            function
            for function in self._unit.functions
            if function.name == "main" and not function.owner
        ]
        if len(mains) != 1 or any(_SPINNING.search(word) for word in self._words()):
            return
        callbacks = any(
            any(self._calls(function, *_KEPT)) for function in (*self._methods, mains[0])
        )
        if callbacks and mains[0].body is not None:
            message = "nothing spins the node: its callbacks are never called"
            yield CodeFault("node-spins", message, mains[0].node.location)

    def waiting(self) -> Iterator[CodeFault]:
        """Yield callbacks that wait for a response, which the same thread would have to receive."""
        if any(name in self._unit.uses for name in _CONCURRENT):
            return
        if self._words().isdisjoint(_CONCURRENT):
            for function in self._methods:
                yield from self._waiting_in(function)
                yield from self._sleeping_in(function)

    def _sleeping_in(self, function: CppFunction) -> Iterator[CodeFault]:
        """Yield where a callback sleeps, in a program with another callback."""
        if not self._has_several_callbacks:
            return
        for call in self._own_calls(function, *_SLEEPING):
            if self._is_in_callback(call, function):
                name = called_name(call)
                callback = f"the callback {function.name}()"
                message = f"while {name}() in {callback} waits, no other callback runs"
                yield CodeFault("callback-sleep", message, call.location, is_certain=False)
                break

    @cached_property
    def _has_several_callbacks(self) -> bool:
        """Whether more than one callback may run in the program."""
        count = 0
        for function in self._unit.functions:
            count += len([*self._calls(function, *_KEPT)])
        return count > 1 or not self._words().isdisjoint(_OTHER_CALLBACKS)

    def _waiting_in(self, function: CppFunction) -> Iterator[CodeFault]:
        """Yield where a method waits in a callback.

        What it spins raises an error, or is another node, which receives the response.
        """
        spins = [*self._calls(function, "spin_until_future_complete")]
        for call in spins:
            if self._is_in_callback(call, function) and _is_given_itself(call):
                message = "a callback must not spin its own node: rclcpp throws an error"
                yield CodeFault("callback-wait", message, call.location)
        if spins:
            return
        for call in self._calls(function, *_WAITING):
            if self._is_in_callback(call, function) and self._is_of_request(call, function):
                message = (
                    "this callback waits for a response that only the next callback can receive"
                )
                yield CodeFault("callback-wait", message, call.location)

    def _words(self) -> set[str]:
        """Return the words in the files of the unit."""
        return {word for file in self._unit.files for word in file.words}

    def _is_in_callback(self, node: CppNode, function: CppFunction) -> bool:
        """Return whether a place is in a function that becomes a callback.

        It is given to a timer, a subscription or a service.
        """
        for around in node.ancestors():
            if around is function.node:
                break
            if around.kind == "lambda_expression":
                return _is_callback_argument(around)
        for use in self._unit.uses.get(function.name, ()):
            bound = _find_binding(use)
            if bound is not None:
                return _is_callback_argument(bound)
        return False

    def _is_of_request(self, call: CppNode, function: CppFunction) -> bool:
        """Return whether a call is a method of the future that async_send_request() returned."""
        called = call.child("function")
        owner = called.child("argument") if called is not None else None
        if owner is None or list_arguments(call):
            return False
        if owner.kind == "call_expression":
            return called_name(owner) == "async_send_request"
        if owner.kind != "identifier":
            return False
        made = _call_declared(self._uses(owner.text, function))
        if made is None or called_name(made) != "async_send_request":
            return False
        return len(list_arguments(made)) == 1


def _may_wait(function: CppFunction, unit: CppUnit) -> bool:
    """Return whether a function may run for so long that what it makes does its work."""
    if any(node.kind in _LOOPS for node in function.node.walk()):
        return True
    calls = [call for call in unit.calls_in(function) if call.kind == "call_expression"]
    return any(_SPINNING.search(called_name(call).rpartition("::")[2]) for call in calls)


def _outermost_member(node: CppNode) -> CppNode:
    while node.parent is not None and node.parent.kind == "field_expression":
        node = node.parent
    return node


def _is_number_set(member: CppNode) -> bool:
    """Return whether a member of a transform is set that is no rotation, or is a number of one.

    No rotation means none as a whole.
    """
    parent = member.parent
    if parent is None or parent.kind != "assignment_expression" or member.field != "left":
        return parent is not None and parent.kind not in ("call_expression", "argument_list")
    last = re.split(r"\.|->", member.text)[-1]
    return last not in ("rotation", "transform")


def _is_plain_use(use: CppNode) -> bool:
    """Return whether a buffer is declared, made or asked for a transform where it is named."""
    parent = use.parent
    if parent is None:
        return False
    if parent.kind == "field_expression":
        field = parent.child("field")
        is_member = field is not None and field is not use and use.field == "argument"
        return is_member and field is not None and field.text in (*_LOOKING_UP, "reset")
    kinds = ("field_declaration", "assignment_expression", "field_initializer")
    is_set = parent.kind in kinds
    return is_set and use.field != "right"


def _is_given_itself(call: CppNode) -> bool:
    """Return whether a function is given the node that the callback belongs to."""
    given = list_arguments(call)
    text = given[0].text if given else ""
    return "shared_from_this()" in text or "get_node_base_interface()" in text.removeprefix(
        "this->"
    )


def _is_callback_argument(node: CppNode) -> bool:
    """Return whether an expression is given to what makes a timer, subscription or service."""
    given = node.parent
    call = given.parent if given is not None and given.kind == "argument_list" else None
    if call is None or call.kind != "call_expression":
        return False
    return called_name(call).rpartition("::")[2] in _GIVEN_CALLBACKS


def _assigned_rotations(function: CppFunction) -> dict[str, dict[str, list[CppNode]]]:
    """Return what a function assigns to the numbers of rotations, by paths and numbers."""
    rotations: dict[str, dict[str, list[CppNode]]] = {}
    for node in function.node.walk():
        if node.kind != "assignment_expression":
            continue
        left, right = node.child("left"), node.child("right")
        match = _ROTATION.fullmatch(left.text) if left is not None else None
        if match is not None and right is not None:
            parts = rotations.setdefault(match[1], {})
            parts.setdefault(match[2], []).append(right)
    return rotations


def _last_zero(parts: Mapping[str, Sequence[CppNode]]) -> CppNode | None:
    """Return the last number of a rotation of four zeros, each of which is assigned once."""
    written = [value for values in parts.values() for value in values]
    numbers = [value for value in written if value.kind == "number_literal"]
    zeros = [number for number in numbers if _ZERO.fullmatch(number.text)]
    is_zero = len(parts) == len(zeros) == len(written) == 4
    return zeros[-1] if is_zero else None


def _call_declared(uses: Iterable[CppNode]) -> CppNode | None:
    """Return the first call that the declaration of a variable has as its value."""
    for use in uses:
        made = use.parent
        if use.field == "declarator" and made is not None and made.kind == "init_declarator":
            value = made.child("value")
            if value is not None and value.kind == "call_expression":
                return value
    return None


def _find_binding(use: CppNode) -> CppNode | None:
    """Return the call of std::bind() that is given a pointer to a method where it is named."""
    pointed = _first_around(use, "pointer_expression")
    if pointed is None or not pointed.text.startswith("&"):
        return None
    bound = _first_around(pointed, "call_expression")
    return bound if bound is not None and called_name(bound) == "std::bind" else None


def _first_around(node: CppNode, kind: str) -> CppNode | None:
    """Return the nearest node of a kind around another one."""
    return next((ancestor for ancestor in node.ancestors() if ancestor.kind == kind), None)
