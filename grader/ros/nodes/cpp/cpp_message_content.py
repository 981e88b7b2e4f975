"""What C++ code asks of the content of messages.

A time in their header that a synchroniser compares, and the encoding of images that cv_bridge
makes and converts.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from typing import NamedTuple

from grader.base.source import Location
from grader.ros.cpp.cpp_evaluation import CppEvaluation, is_member_of_this
from grader.ros.cpp.cpp_values import CppName
from grader.ros.cpp.declarations import CppFunction, declared_in, name_in, plain
from grader.ros.cpp.objects import class_written, find_variable
from grader.ros.cpp.syntax import CppNode
from grader.ros.cpp.unit import CppUnit, called_name, is_conditional, list_arguments
from grader.ros.known.package_tables import colour_encodings
from grader.ros.nodes.cpp.rclcpp_calls import message_type
from grader.ros.nodes.node_facts import ImageEncoding, SynchronisedType
from grader.ros.python.budget import Budget

_SYNCHRONISERS = frozenset(
    {
        "message_filters::TimeSynchronizer",
        "message_filters::sync_policies::ExactTime",
        "message_filters::sync_policies::ApproximateTime",
        "message_filters::sync_policies::ApproximateEpsilonTime",
    }
)
_TRAITS = "message_traits"  # by which code gives a message a time of its own
_STARTS = "registerCallback"  # without which a synchroniser does nothing
_CONSTANT = re.compile(r"sensor_msgs::image_encodings::(?:TYPE_)?(\w+)")
_DEPTH = re.compile(r"\d++[USF]C\d")
_ANY_ENCODINGS = ("", "passthrough")
_ENCODING = "encoding"
_CONVERTING = ("toCvCopy", "toCvShare", "cvtColor")
_IMAGE, _TO_MESSAGE = "CvImage", "toImageMsg"
_CALLS = ("call_expression", "compound_literal_expression", "new_expression")
_LISTS = ("argument_list", "initializer_list", "parameter_list")
# Methods of a publisher that publish nothing.
_HARMLESS_METHODS = frozenset(
    {"get_subscription_count", "get_topic_name", "on_activate", "on_deactivate", "is_activated"}
)
_READING = ("condition_clause", "binary_expression", "unary_expression", "lambda_capture_specifier")
_TAKERS = ("publish", "move", *_CONVERTING)  # that do not change an image
_LEAVING = ("return_statement", "throw_statement")
_MAX_DEPTH = 6  # of images that are made of others


class _Writes(NamedTuple):
    """What sets a variable with an image: to another value, and its encoding."""

    values: Sequence[CppNode]
    encodings: Sequence[CppNode]  # the assignments


class CppContentReader:
    """Reads what the functions of a target ask of messages."""

    def __init__(self, unit: CppUnit, evaluation: CppEvaluation, budget: Budget) -> None:
        self._unit, self._evaluation, self._budget = unit, evaluation, budget

    def synchronised_types(self) -> Iterator[SynchronisedType]:
        """Yield the types of the messages whose times are compared, each synchroniser once."""
        words = {word for file in self._unit.files for word in file.words}
        if _TRAITS in words or _STARTS not in words:
            return
        said: set[tuple[str | None, ...]] = set()
        for file in self._unit.files:
            for node in file.of_kind("template_type"):
                compared = self._compared_by(node, file.syntax.root)
                if compared is None:
                    continue
                synchroniser, types, written = compared
                if (synchroniser, *types) not in said:
                    said.add((synchroniser, *types))
                    yield from _compared_types(synchroniser, types, written)

    def _compared_by(
        self, node: CppNode, root: CppNode
    ) -> tuple[str, list[str | None], list[CppNode]] | None:
        """Return the policy of message_filters that a template is, with the types of messages.

        The last are where these types are written. The result is None for another template, and
        for one under a condition.
        """
        scopes = self._scopes_at(node)
        names = {*self._unit.meanings(_full_name(node), scopes)} & _SYNCHRONISERS
        given = node.child("arguments")
        if len(names) != 1 or given is None or is_conditional(node, root):
            return None
        written = [child for child in given.children if child.kind == "type_descriptor"]
        types = [message_type(descriptor.text, self._unit, scopes) for descriptor in written]
        return names.pop(), types, written

    def _scopes_at(self, node: CppNode) -> Sequence[str]:
        """Return the namespaces and classes around a place."""
        function = self._unit.function_around(node)
        if function is not None:
            return self._unit.list_scopes(function)
        kinds = ("namespace_definition", "class_specifier", "struct_specifier")
        scopes: list[str] = []
        for around in node.ancestors():
            name = around.child("name")
            if around.kind in kinds and name is not None:
                scopes = [*plain(name.text).split("::"), *scopes]
        return scopes

    def encodings(self) -> Mapping[Location, tuple[ImageEncoding, ...]]:
        """Return the encodings that publishers send, and to which callbacks convert images.

        The keys are the places where publishers and subscriptions are made. There are none where
        one is not known.
        """
        if not any(name in self._unit.uses for name in (_ENCODING, *_CONVERTING, _TO_MESSAGE)):
            return {}
        encodings_by_place = {}
        for function in self._unit.functions:
            for call in self._unit.calls_in(function):
                name = called_name(call) if call.kind == "call_expression" else ""
                if name == "create_publisher":
                    encodings_by_place[call.location] = self._sent_by(call)
                elif name == "create_subscription":
                    encodings_by_place[call.location] = self._asked_by(call, function)
        return encodings_by_place

    # --- What is sent
    # ----------------------------------------------------------------------

    def _sent_by(self, made: CppNode) -> tuple[ImageEncoding, ...]:
        """Return the encodings of the images that a publisher sends."""
        variable = _find_variable(made)
        calls = self._published(variable, made) if variable is not None else None
        sent = []
        for call in calls or ():
            given = list_arguments(call)
            encoding = self._find_encoding(given[0], _MAX_DEPTH) if given else None
            if encoding is None:
                return ()
            sent.append(encoding)
        return tuple(sent)

    def _published(self, variable: CppNode, made: CppNode) -> Sequence[CppNode] | None:
        """Return the calls of publish() of a publisher; None where it may publish elsewhere."""
        calls: list[CppNode] = []
        for use in self._evaluation.find_uses(variable) or ():
            of_use = _publishing_calls(_whole(use), made)
            if of_use is None:
                return None
            calls += of_use
        return calls

    def _find_encoding(self, node: CppNode, depth: int) -> ImageEncoding | None:
        """Return the encoding of an image, a message or one of cv_bridge.

        The result is None where it is not known.
        """
        node = _unwrapped(node)
        if depth == 0:
            return None
        if node.kind in ("identifier", "field_expression"):
            return self._encoding_of_variable(node, depth)
        return self._encoding_made(node, depth) if node.kind in _CALLS else None

    def _encoding_made(self, node: CppNode, depth: int) -> ImageEncoding | None:
        """Return the encoding of the image that a call makes; None where it is not known."""
        name = called_name(node).rpartition("::")[2] if node.kind == "call_expression" else ""
        if name == _TO_MESSAGE and not list_arguments(node):
            function = node.child("function")
            owner = function.child("argument") if function is not None else None
            return self._find_encoding(owner, depth - 1) if owner is not None else None
        if name in _CONVERTING:
            return self._converted_to(node)
        written = node.child("type") if node.kind == "compound_literal_expression" else None
        kind = written.text if written is not None else class_written(node) or name
        if plain(kind).rpartition("::")[2] == _IMAGE:
            return self._encoding_in(list_arguments(node), 1)
        return None

    def _converted_to(self, call: CppNode) -> ImageEncoding | None:
        """Return the encoding to which cv_bridge converts an image."""
        given = list_arguments(call)
        is_tracked = called_name(call).endswith("toCvShare") and len(given) == 3
        return self._encoding_in(given, 2 if is_tracked else 1)

    def _encoding_in(self, given: Sequence[CppNode], position: int) -> ImageEncoding | None:
        """Return the encoding that an argument is; None where it is missing or not known."""
        if position >= len(given):
            return None
        node = given[position]
        value, text = self._evaluation.evaluate_node(node), None
        if isinstance(value, str):
            text = value
        elif isinstance(value, CppName):
            text = self._constant(value.name, node)
        return ImageEncoding(text, node.location) if text not in (None, *_ANY_ENCODINGS) else None

    def _constant(self, name: str, node: CppNode) -> str | None:
        """Return the encoding that a constant of sensor_msgs is; None for another name."""
        for meaning in self._unit.meanings(name, self._scopes_at(node)):
            match = _CONSTANT.fullmatch(meaning)
            if match is not None and _DEPTH.fullmatch(match[1]):
                return match[1]
            if match is not None and match[1].lower() in colour_encodings():
                return match[1].lower()
        return None

    def _encoding_of_variable(self, node: CppNode, depth: int) -> ImageEncoding | None:
        """Return the encoding of the image that a variable has where it is published."""
        name = node.child("field") if node.kind == "field_expression" else node
        if name is None or _whole(name) is not node:
            return None
        writes = self._find_writes(name)
        if writes is None:
            return None
        if writes.encodings:
            return self._encoding_assigned(writes, node)
        if len(writes.values) != 1:
            return None
        [value] = writes.values
        if value.kind in _LISTS:
            return self._encoding_in(
                [child for child in value.children if child.kind != "comment"], 1
            )
        return self._find_encoding(value, depth - 1)

    def _encoding_assigned(self, writes: _Writes, node: CppNode) -> ImageEncoding | None:
        """Return the encoding that is assigned to a variable after everything else."""
        [assignment, *more] = writes.encodings
        value = assignment.child("right")
        if more or value is None:
            return None
        is_last = all(
            write.file is assignment.file and write.start < assignment.start
            for write in writes.values
        )
        if is_last and self._reaches(assignment, node):
            return self._encoding_in([value], 0)
        return None

    def _find_writes(self, name: CppNode) -> _Writes | None:
        """Return what sets an image; None where something that is not known may set it."""
        uses = self._evaluation.find_uses(name)
        if uses is None:
            return None
        values: list[CppNode] = []
        encodings: list[CppNode] = []
        for use in uses:
            node = _wrapped(use)
            if node.parent is None:
                return None
            if node.parent.kind == "field_expression" and node.field == "argument":
                written, place = _encoding_set(node.parent), encodings
            else:
                written, place = _value_set(use, node, node.parent), values
            if written is None:
                return None
            place += written
        return _Writes(values, encodings)

    def _reaches(self, assignment: CppNode, use: CppNode) -> bool:
        """Return whether an assignment certainly precedes a place."""
        statement = assignment.parent
        block = statement.parent if statement is not None else None
        # Not in an `if` without braces, nor below a `case`.
        if block is None or block.kind != "compound_statement":
            return False
        if is_conditional(assignment, assignment.file.root):
            return False
        if use.file is assignment.file and block.start <= use.start < block.end:
            return assignment.start < use.start
        function = self._unit.function_around(assignment)
        if function is None or function is self._unit.function_around(use):
            return False
        return block is function.body and function.name == function.owner.rpartition("::")[2]

    # --- What is asked
    # ----------------------------------------------------------------------

    def _asked_by(self, call: CppNode, function: CppFunction) -> tuple[ImageEncoding, ...]:
        """Return the encodings to which the callback of a subscription converts its image."""
        for callback in list_arguments(call)[2:3]:
            body, message = self._function_given(callback, function)
            inner = _only_call(body, message) if body is not None else None
            if inner is not None:
                body, message = self._method(called_name(inner), function)
            if body is not None and message is not None:
                return self._asked_in(body, message)
        return ()

    def _function_given(
        self, callback: CppNode, function: CppFunction
    ) -> tuple[CppNode | None, CppNode | None]:
        """Return the body of a callback and the name of what it is given, as far as known."""
        if callback.kind == "identifier":
            callback = self._declared_callback(callback)
        if callback.kind == "lambda_expression":
            declarator = callback.child("declarator")
            parameters = declarator.child("parameters") if declarator is not None else None
            given = parameters.children if parameters is not None else []
            return callback.child("body"), _parameter_name(given)
        if callback.kind == "call_expression" and called_name(callback) in ("std::bind", "bind"):
            pointed = list_arguments(callback)[0] if list_arguments(callback) else callback
            method = pointed.child("argument") if pointed.kind == "pointer_expression" else None
            if method is not None:
                return self._method(plain(method.text), function)
        return None, None

    def _declared_callback(self, name: CppNode) -> CppNode:
        """Return the value of the only declaration of a variable; else its name."""
        declared = [use for use in self._evaluation.find_uses(name) or () if use is not name]
        values = [_value_declared(use) for use in declared if use.field == "declarator"]
        if len(declared) == 1 and len(values) == 1 and values[0] is not None:
            return values[0]
        return name

    def _method(self, name: str, function: CppFunction) -> tuple[CppNode | None, CppNode | None]:
        """Return the body and the first parameter of a method of the class of a function."""
        class_name, _, short = name.rpartition("::")
        owner = self._unit.find_owner(function)
        if class_name and class_name.rpartition("::")[2] != owner.rpartition("::")[2]:
            return None, None
        methods = self._methods.get((owner, short), ()) if owner else ()
        if len(methods) != 1 or methods[0].is_conditional or methods[0].is_template:
            return None, None
        return methods[0].body, _parameter_name(methods[0].parameters)

    @cached_property
    def _methods(self) -> Mapping[tuple[str, str], Sequence[CppFunction]]:
        """The functions by their classes and names."""
        methods: dict[tuple[str, str], list[CppFunction]] = {}
        for function in self._unit.functions:
            owner = self._unit.find_owner(function)
            methods.setdefault((owner, function.name), []).append(function)
        return methods

    def _asked_in(self, body: CppNode, message: CppNode) -> tuple[ImageEncoding, ...]:
        """Return the encodings to which a function converts a message.

        There are none where one is not known, or it reads what the encoding is.
        """
        asked = []
        self._budget.charge(1, body.end - body.start)
        for node in body.walk():
            if node.kind in ("identifier", "field_identifier"):
                is_set = node.field == "left" and node.text == message.text
                if is_set or node.text == _ENCODING:
                    return ()
            if node.kind in _LEAVING:
                break  # what follows may never be executed
            if not _is_conversion(node, message):
                continue
            encoding = self._converted_to(node)
            if encoding is None or is_conditional(node, body):
                return ()
            asked.append(encoding)
        return tuple(asked)


def _find_variable(made: CppNode) -> CppNode | None:
    """Return the name of the variable that a publisher is made for; None without one."""
    given = made.parent
    initializer = given.parent if given is not None else None
    if initializer is not None and initializer.kind == "field_initializer":
        return initializer.children[0]
    return find_variable(made)


def _full_name(node: CppNode) -> str:
    """Return the name of a type that is a template, with its namespaces."""
    whole = node
    while whole.field == "name" and whole.parent is not None:
        if whole.parent.kind != "qualified_identifier":
            break
        whole = whole.parent
    return plain(whole.text)


def _whole(use: CppNode) -> CppNode:
    """Return the expression that a name is part of: `this->name`, or the name."""
    return use.parent if is_member_of_this(use) and use.parent is not None else use


def _is_same(node: CppNode) -> bool:
    """Return whether an expression is what it contains: in parentheses, or where it points to."""
    if node.kind == "pointer_expression":
        return node.text.startswith("*")
    return node.kind == "parenthesized_expression"


def _wrapped(use: CppNode) -> CppNode:
    """Return the largest expression that is what a name means, with `*` and parentheses."""
    node = _whole(use)
    while node.parent is not None and _is_same(node.parent):
        node = node.parent
    return node


def _unwrapped(node: CppNode) -> CppNode:
    """Return an expression without `*`, parentheses and std::move()."""
    while True:
        given = list_arguments(node) if node.kind == "call_expression" else []
        if _is_same(node) and node.children:
            node = node.child("argument") or node.children[0]
        elif len(given) == 1 and called_name(node) in ("std::move", "move"):
            node = given[0]
        else:
            return node


def _encoding_set(member: CppNode) -> list[CppNode] | None:
    """Return the assignment of an encoding where a member of an image is named.

    There is none for another member. The result has None where the encoding may be set in another
    way.
    """
    parent, field = member.parent, member.child("field")
    if parent is None or field is None:
        return None
    if parent.kind == "call_expression":
        return [] if field.text == _TO_MESSAGE else None
    if field.text != _ENCODING:
        return []
    is_set = parent.kind == "assignment_expression" and member.field == "left"
    return [parent] if is_set else None


def _value_declared(name: CppNode) -> CppNode | None:
    """Return the value that a variable is declared with; None without one."""
    for around in name.ancestors():
        if around.kind.endswith("declarator"):
            continue
        for declared, value in declared_in(around):
            if declared is name:
                return value
    return None


def _is_given_to(node: CppNode, takers: Sequence[str]) -> bool:
    """Return whether an expression is an argument of a function with one of these names."""
    given = node.parent
    call = given.parent if given is not None and given.kind == "argument_list" else None
    if call is None or call.kind != "call_expression":
        return False
    return called_name(call).rpartition("::")[2] in takers


def _parameter_name(parameters: Sequence[CppNode]) -> CppNode | None:
    """Return the name of the first parameter."""
    declarator = parameters[0].child("declarator") if parameters else None
    return name_in(declarator) if declarator is not None else None


def _only_call(body: CppNode, message: CppNode | None) -> CppNode | None:
    """Return the call of a method that is all that a function does with what it is given."""
    statements = [child for child in body.children if child.kind != "comment"]
    if message is None or len(statements) != 1 or not statements[0].children:
        return None
    call = statements[0].children[0]
    given = list_arguments(call) if call.kind == "call_expression" else []
    if not given or _unwrapped(given[0]).text != message.text:
        return None
    return call if _is_own_method(call) else None


def _is_own_method(call: CppNode) -> bool:
    """Return whether a call is a method of the same object, or a function without a scope."""
    function = call.child("function")
    owner = function.child("argument") if function is not None else None
    is_own = owner is None or owner.kind == "this"
    return is_own and "::" not in called_name(call)


def _compared_types(
    synchroniser: str, types: Sequence[str | None], written: Sequence[CppNode]
) -> Iterator[SynchronisedType]:
    """Yield the known types of the messages that a synchroniser compares, with the others."""
    known = tuple(type_name for type_name in types if type_name is not None)
    for type_name, at in zip(types, written, strict=True):
        if type_name is not None:
            yield SynchronisedType(type_name, synchroniser, at.location, known)


def _publishing_calls(node: CppNode, made: CppNode) -> list[CppNode] | None:
    """Return the call of publish() that a use of a publisher is.

    There is none where it is another harmless use. The result is None where the publisher may
    publish elsewhere.
    """
    parent = node.parent
    if parent is None:
        return None
    call, field = parent.parent, parent.child("field")
    is_method = parent.kind == "field_expression" and node.field == "argument"
    if is_method and field is not None and call is not None:
        return _calls_of_method(call, field.text)
    if node.field in ("declarator", "left") or parent.kind == "field_initializer":
        is_here = parent.start <= made.start < parent.end
        is_harmless = is_here or parent.kind in ("declaration", "field_declaration")
    else:
        is_harmless = parent.kind in _READING
    return [] if is_harmless else None


def _calls_of_method(call: CppNode, method: str) -> list[CppNode] | None:
    """Return the call of a publisher's method if it is publish(); None where it may publish."""
    if call.kind != "call_expression":
        return None
    if method == "publish":
        return [call]
    return [] if method in _HARMLESS_METHODS else None


def _value_set(use: CppNode, node: CppNode, parent: CppNode) -> list[CppNode] | None:
    """Return the value that a use of an image sets it to, if it sets it.

    The result is None where the use may set it to something that is not known.
    """
    value = None
    if node.field == "declarator":
        value = _value_declared(use)
    elif parent.kind == "assignment_expression" and node.field == "left":
        value = parent.child("right")
    elif not _is_given_to(node, _TAKERS) and parent.kind not in _READING:
        return None
    return [value] if value is not None else []


def _is_conversion(node: CppNode, message: CppNode) -> bool:
    """Return whether a node is a call of cv_bridge that converts a message."""
    if node.kind != "call_expression":
        return False
    given = list_arguments(node)
    if called_name(node).rpartition("::")[2] not in _CONVERTING[:2] or not given:
        return False
    return _unwrapped(given[0]).text == message.text
