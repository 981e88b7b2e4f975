"""What keeps a node in C++ from doing anything: in the files that are compiled into one target.

Each rule is about what certainly fails once it runs.
"""

import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from functools import cached_property
from itertools import chain

from grader.base.patterns import on_use
from grader.ros.cpp.declarations import CppFunction, declared_in, plain, short_name
from grader.ros.cpp.objects import class_written
from grader.ros.cpp.syntax import NO_NODE, CppNode, CppNodes, CppNodesByName
from grader.ros.cpp.unit import (
    CppUnit,
    called_name,
    called_object,
    is_conditional,
    is_given_to,
    list_arguments,
)
from grader.ros.nodes.node_facts import (
    CodeFault,
    CodeFaults,
    misnamed_callback,
)

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
_ENDING_STATES = ("succeed", "abort")
_ACTIONS = "rclcpp_action::"
# The answers to a goal: rclcpp_action/include/rclcpp_action/types.hpp.
_ACCEPTS = ("ACCEPT_AND_EXECUTE", "ACCEPT_AND_DEFER")
_REJECTS = "REJECT"
_READS_CANCEL = "is_canceling"
_CANCEL_ANSWER = "CancelResponse"  # which rejects as well, but no goals
# Publishers of these nodes send nothing before: rclcpp_lifecycle/lifecycle_publisher.hpp.
_LIFECYCLE = "rclcpp_lifecycle::LifecycleNode"
_ACTIVATES = "on_activate"
_STATE = on_use(r"\bState\b")
_LISTENER = "TransformListener"
_BUFFER = "Buffer"
_LOOKING_UP = ("lookupTransform", "canTransform")
# What may spin a node, or wait for its messages.
_SPINNING = on_use(r"spin|executor|wait|take|sleep|thread|async", re.IGNORECASE)
_LOOPS = ("while_statement", "for_statement", "do_statement", "for_range_loop")
# With one of these, a callback may wait for another one.
_CONCURRENT = ("create_callback_group", "MultiThreadedExecutor", "thread", "async", "detach")
_WAITING = ("wait", "get")
_MAX_CALLS = 4  # from a callback to where it waits
_SLEEPING = ("sleep_for", "sleep_until", "sleep", "usleep")
_OF_ACTIONS = ("create_server",)
_GIVEN_CALLBACKS = (*_KEPT, "create_client")
_OTHER_CALLBACKS = ("TransformListener", "message_filters", "async_send_request", "create_server")
_SENDING = ("sendTransform", "push_back", "emplace_back")
_ROTATION = on_use(r"(\w+(?:(?:\.|->)\w+)*)(?:\.|->)rotation\.([xyzw])")
_ZERO = on_use(r"-?(?:0++(?:\.0*+)?|\.0++)f?")


def cpp_faults(
    unit: CppUnit, nodes: Collection[str], *, is_program: bool, is_read: bool
) -> CodeFaults:
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
        rules.append(search.misnamed_callbacks())
    if is_read and is_program:
        rules.append(search.without_spin())
    for rule in rules:
        for number, fault in enumerate(rule):
            if number < _MAX_FAULTS:
                yield fault


class _CppSearch:
    """Searches faults in the files of a target."""

    def __init__(self, unit: CppUnit, nodes: Collection[str]) -> None:
        self._unit = unit
        self._nodes = nodes
        self._methods = [function for function in unit.functions if function.class_name in nodes]

    def _calls(self, function: CppFunction, *names: str) -> Iterator[CppNode]:
        for call in self._unit.calls_in(function):
            short = short_name(called_name(call))
            if call.kind == "call_expression" and short in names:
                yield call

    def _own_calls(self, function: CppFunction, *names: str) -> Iterator[CppNode]:
        """Yield the calls of functions, or of methods of the object itself or of a rate."""
        for call in self._calls(function, *names):
            written = call.child("function").text.removeprefix("this->")
            is_own = "." not in written and "->" not in written
            if is_own or "rate" in written.lower():
                yield call

    def without_activation(self) -> CodeFaults:
        """Yield where a node with a lifecycle becomes active, and its publishers do not."""
        if any(next(self._calls(each, _ACTIVATES), None) for each in self._unit.functions):
            return
        for function in self._methods:
            owner = function.owner
            if function.name != _ACTIVATES or not self._has_lifecycle(function):
                continue
            for method in self._methods:
                calls = self._own_calls(method, "create_publisher")
                made = next((call for call in calls if "::" not in called_name(call)), None)
                if made is not None and method.class_name == owner:
                    message = (
                        f"the publishers of {short_name(owner)} stay inactive, and send "
                        f"nothing: call LifecycleNode::{_ACTIVATES}(state)"
                    )
                    at = function.node.location
                    yield CodeFault("publisher-activated", message, at, made.location)
                    break

    def _has_lifecycle(self, method: CppFunction) -> bool:
        """Return whether a method certainly is one of a node with a lifecycle."""
        scopes = method.inner_scopes
        classes = self._unit.classes.get(method.class_name, ())
        bases = chain.from_iterable(written.bases for written in classes)
        is_base = any(_LIFECYCLE in self._unit.meanings(base, scopes) for base in bases)
        return is_base and not method.is_conditional

    def _is_called(self, name: str) -> bool:
        """Return whether a function names another one."""
        uses = self._unit.uses.get(name, ())
        return any(_first_around(use, "compound_statement") for use in uses)

    def misnamed_callbacks(self) -> CodeFaults:
        """Yield methods that take a state, and override no callback of a node's lifecycle."""
        for method in self._methods:
            given = " ".join(parameter.text for parameter in method.parameters)
            if not _STATE.search(given) or not self._has_lifecycle(method):
                continue
            if self._is_called(method.name):
                continue
            same = [each for each in self._methods if each.class_name == method.class_name]
            defined = {each.name for each in same}
            fault = misnamed_callback(method.name, defined, method.node.location)
            yield from [] if not fault else [fault]

    def without_goal_state(self) -> CodeFaults:
        """Yield action servers in files in which no goal succeeds, or no cancel request is read."""
        used = self._unit.uses.keys()
        messages = []
        if used.isdisjoint(_ENDING_STATES):
            messages.append(
                "nothing sets the state of a goal, so rclcpp_action cancels it; call succeed()"
            )
        elif "succeed" not in used:
            messages.append(
                "succeed() is never called, so rclcpp_action cancels each finished goal"
            )
        answers = self._unit.uses.get("ACCEPT", ())
        accepts = any(_CANCEL_ANSWER in answer.parent.text for answer in answers)
        if accepts and _READS_CANCEL not in used:
            messages.append("cancel requests are accepted but ignored: check is_canceling()")
        for function in self._methods:
            for call in self._calls(function, "create_server") if messages else ():
                if called_name(call).startswith(_ACTIONS):
                    for message in messages:
                        yield CodeFault("goal-state", message, call.location, is_certain=False)

    def rejected_goals(self) -> CodeFaults:
        """Yield action servers in files in which goals are rejected, and none is accepted."""
        uses = self._unit.uses
        rejections = []
        for node in uses.get(_REJECTS, ()):
            # Who cancels a goal is answered by the same word.
            if _CANCEL_ANSWER not in node.parent.text:
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

    def destroyed(self) -> CodeFaults:
        """Yield what a method makes and nothing keeps: it is destroyed when the method ends."""
        for function in self._methods:
            if function.is_conditional or _may_wait(function, self._unit):
                continue
            kept = {**_KEPT, **_HANDLES}
            for call in self._calls(function, *kept):
                kind = kept[short_name(called_name(call))]
                if self._is_lost(call, function):
                    message = (
                        f"nothing keeps this {kind}: it is destroyed when {function.name}() ends"
                    )
                    yield CodeFault("entity-kept", message, call.location)
            if function.name == short_name(function.owner):
                yield from self._lost_listeners(function)

    def _lost_listeners(self, constructor: CppFunction) -> CodeFaults:
        for node in self._unit.calls_in(constructor):
            written = plain(class_written(node))
            is_listener = short_name(written) == _LISTENER
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
            if is_conditional(made, function.node):
                return False
            if parent.kind == "expression_statement":
                return True
            if parent.kind != "init_declarator":
                return False
            declaration = parent.parent
        if "static" in declaration.text.split("(")[0].split():
            return False
        names = [name for name, _ in declared_in(declaration)]
        return len(names) == 1 and len(self._unit.uses_in(function, names[0].text)) == 1

    def without_rotation(self) -> CodeFaults:
        """Yield transforms that are sent with a rotation whose four numbers are zeros."""
        for function in self._unit.functions:
            if not any(self._calls(function, "sendTransform")):
                continue
            for path, parts in _assigned_rotations(function).items():
                zero = _last_zero(parts)
                if zero and self._is_only_sent(path, function):
                    message = "the rotation 0 0 0 0 turns nothing: tf2 ignores the transform"
                    yield CodeFault("rotation-set", message, zero.location)

    def _is_only_sent(self, path: str, function: CppFunction) -> bool:
        """Return whether nothing but the statements that are read can set a transform."""
        root = re.split(r"\.|->", path)[0]
        for use in self._unit.uses_in(function, root):
            parent = use.parent
            if parent.kind == "argument_list":
                if short_name(called_name(parent.parent)) not in _SENDING:
                    return False
            elif parent.kind == "field_expression":
                while parent.parent.kind == "field_expression":
                    parent = parent.parent
                if not _is_number_set(parent):
                    return False
            elif use.field != "declarator":
                return False
        return True

    def without_listener(self) -> CodeFaults:
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
        owner = called_object(call)
        if owner.kind != "identifier":
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

    def without_spin(self) -> CodeFaults:
        """Yield the end of a main() whose nodes nothing spins."""
        mains = self._unit.mains
        if len(mains) != 1 or any(_SPINNING.search(word) for word in self._words()):
            return
        callbacks = any(
            any(self._calls(function, *_KEPT)) for function in (*self._methods, mains[0])
        )
        if callbacks and mains[0].body:
            message = "nothing spins the node: its callbacks are never called"
            yield CodeFault("node-spins", message, mains[0].node.location)

    def waiting(self) -> CodeFaults:
        """Yield callbacks that wait for a response, which the same thread would have to receive."""
        if any(name in self._unit.uses for name in _CONCURRENT):
            return
        if self._words().isdisjoint(_CONCURRENT):
            for function in self._methods:
                yield from self._waiting_in(function)
                yield from self._sleeping_in(function)

    def _sleeping_in(self, function: CppFunction) -> CodeFaults:
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
            count += len(list(self._calls(function, *_KEPT)))
        return count > 1 or not self._words().isdisjoint(_OTHER_CALLBACKS)

    def _waiting_in(self, function: CppFunction) -> CodeFaults:
        """Yield where a method waits in a callback.

        What it spins raises an error, or is another node, which receives the response.
        """
        spins = list(self._calls(function, "spin_until_future_complete"))
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

    def _is_in_callback(self, node: CppNode, function: CppFunction, depth: int = 0) -> bool:
        """Return whether a place is in a function that becomes a callback.

        It is given to a timer, a subscription, a service or an action server; the callbacks of the
        last may also call it.
        """
        takers = _OF_ACTIONS if depth else _GIVEN_CALLBACKS
        for around in node.ancestors():
            if around is function.node:
                break
            if around.kind == "lambda_expression":
                return is_given_to(around, takers)
        for use in self._unit.uses.get(function.name, ()):
            bound = _find_binding(use)
            if bound:
                return is_given_to(bound, takers)
            if depth < _MAX_CALLS and self._is_called_back(use, function, depth + 1):
                return True
        return False

    def _is_called_back(self, use: CppNode, function: CppFunction, depth: int) -> bool:
        """Return whether another function that names this one is called back."""
        caller = self._unit.function_around(use)
        is_other = caller is not None and caller is not function
        return is_other and caller is not None and self._is_in_callback(use, caller, depth)

    def _is_of_request(self, call: CppNode, function: CppFunction) -> bool:
        """Return whether a call is a method of the future that async_send_request() returned."""
        owner = called_object(call)
        if list_arguments(call):
            return False
        if owner.kind == "call_expression":
            return called_name(owner) == "async_send_request"
        if owner.kind != "identifier":
            return False
        made = _call_declared(self._unit.uses_in(function, owner.text))
        return called_name(made) == "async_send_request" and len(list_arguments(made)) == 1


def _may_wait(function: CppFunction, unit: CppUnit) -> bool:
    """Return whether a function may run for so long that what it makes does its work."""
    if any(node.kind in _LOOPS for node in function.node.walk()):
        return True
    calls = [call for call in unit.calls_in(function) if call.kind == "call_expression"]
    return any(_SPINNING.search(short_name(called_name(call))) for call in calls)


def _is_number_set(member: CppNode) -> bool:
    """Return whether a member of a transform is set that is no rotation, or is a number of one.

    No rotation means none as a whole.
    """
    parent = member.parent
    if parent.kind != "assignment_expression" or member.field != "left":
        return parent.kind not in ("call_expression", "argument_list")
    last = re.split(r"\.|->", member.text)[-1]
    return last not in ("rotation", "transform")


def _is_plain_use(use: CppNode) -> bool:
    """Return whether a buffer is declared, made or asked for a transform where it is named."""
    parent = use.parent
    if parent.kind == "field_expression":
        method = parent.child("field").text
        return use.field == "argument" and method in (*_LOOKING_UP, "reset")
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


def _assigned_rotations(function: CppFunction) -> dict[str, CppNodesByName]:
    """Return what a function assigns to the numbers of rotations, by paths and numbers."""
    rotations: dict[str, CppNodesByName] = {}
    for node in function.node.walk():
        if node.kind != "assignment_expression":
            continue
        left = node.child("left")
        right = node.child("right")
        match = _ROTATION.fullmatch(left.text)
        if match and right:
            parts = rotations.setdefault(match[1], {})
            parts.setdefault(match[2], []).append(right)
    return rotations


def _last_zero(parts: Mapping[str, CppNodes]) -> CppNode:
    """Return the last number of a rotation of four zeros, each of which is assigned once."""
    written = [value for values in parts.values() for value in values]
    numbers = [value for value in written if value.kind == "number_literal"]
    zeros = [number for number in numbers if _ZERO.fullmatch(number.text)]
    is_zero = len(parts) == len(zeros) == len(written) == 4
    return zeros[-1] if is_zero else NO_NODE


def _call_declared(uses: Iterable[CppNode]) -> CppNode:
    """Return the first call that the declaration of a variable has as its value."""
    for use in uses:
        if use.field == "declarator" and use.parent.kind == "init_declarator":
            value = use.parent.child("value")
            if value.kind == "call_expression":
                return value
    return NO_NODE


def _find_binding(use: CppNode) -> CppNode:
    """Return the call of std::bind() that is given a pointer to a method where it is named."""
    pointed = _first_around(use, "pointer_expression")
    if not pointed.text.startswith("&"):
        return NO_NODE
    bound = _first_around(pointed, "call_expression")
    return bound if called_name(bound) == "std::bind" else NO_NODE


def _first_around(node: CppNode, kind: str) -> CppNode:
    """Return the nearest node of a kind around another one."""
    return next((ancestor for ancestor in node.ancestors() if ancestor.kind == kind), NO_NODE)
