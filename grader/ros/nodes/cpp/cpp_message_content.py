"""What C++ code asks of the content of messages.

This is a time in their header that a synchroniser compares, and the encoding of images that
cv_bridge makes and converts.
"""

from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from typing import NamedTuple

from grader.base.grouping import group_values
from grader.base.patterns import on_use
from grader.ros.cpp.cpp_evaluation import CppEvaluation, is_member_of_this
from grader.ros.cpp.cpp_values import CppName
from grader.ros.cpp.declarations import CppFunction, declared_in, name_in, plain, short_name
from grader.ros.cpp.objects import class_written, find_variable
from grader.ros.cpp.syntax import (
    NO_NODE,
    CppNode,
    CppNodes,
)
from grader.ros.cpp.unit import (
    CppUnit,
    called_name,
    called_object,
    is_conditional,
    is_given_to,
    list_arguments,
)
from grader.ros.known.package_tables import colour_encodings
from grader.ros.nodes.cpp.rclcpp_calls import message_type
from grader.ros.nodes.node_facts import (
    EncodingsByLocation,
    ImageEncoding,
    ImageEncodings,
    SynchronisedType,
)
from grader.ros.python.budget import Budget

_Found = CppNodes | None  # None where that is not known

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
_CONSTANT = on_use(r"sensor_msgs::image_encodings::(?:TYPE_)?(\w+)")
_DEPTH = on_use(r"\d++[USF]C\d")
_ANY_ENCODINGS = ("", "passthrough")
_ENCODING = "encoding"
_CONVERTING = ("toCvCopy", "toCvShare", "cvtColor")
_IMAGE = "CvImage"
_TO_MESSAGE = "toImageMsg"
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

    values: CppNodes
    encodings: CppNodes  # the assignments


class CppContentReader:
    """Reads what the functions of a target ask of messages."""

    def __init__(self, unit: CppUnit, evaluation: CppEvaluation, budget: Budget) -> None:
        self._unit = unit
        self._evaluation = evaluation
        self._budget = budget

    def synchronised_types(self) -> Iterator[SynchronisedType]:
        """Yield the types of the messages whose times are compared, each synchroniser once."""
        words = {word for file in self._unit.files for word in file.words}
        if _TRAITS in words or _STARTS not in words:
            return
        said = set()
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
    ) -> tuple[str, list[str | None], CppNodes] | None:
        """Return the policy of message_filters that a template is, with the types of messages.

        The last are where these types are written. The result is None for another template, and
        for one under a condition.
        """
        scopes = self._scopes_at(node)
        names = {*self._unit.meanings(_full_name(node), scopes)} & _SYNCHRONISERS
        if len(names) != 1 or is_conditional(node, root):
            return None
        written = node.child("arguments").of_kind("type_descriptor")
        types = [message_type(descriptor.text, self._unit, scopes) for descriptor in written]
        return names.pop(), types, written

    def _scopes_at(self, node: CppNode) -> Sequence[str]:
        """Return the namespaces and classes around a place."""
        function = self._unit.function_around(node)
        if function:
            return function.inner_scopes
        kinds = ("namespace_definition", "class_specifier", "struct_specifier")
        scopes: list[str] = []
        for around in node.ancestors():
            name = around.child("name")
            if around.kind in kinds and name:
                scopes = plain(name.text).split("::") + scopes
        return scopes

    def encodings(self) -> EncodingsByLocation:
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

    def _sent_by(self, made: CppNode) -> ImageEncodings:
        """Return the encodings of the images that a publisher sends."""
        variable = _find_variable(made)
        calls = self._published(variable, made) if variable else None
        sent = []
        for call in calls or ():
            given = list_arguments(call)
            encoding = self._find_encoding(given[0], _MAX_DEPTH) if given else None
            if not encoding:
                return ()
            sent.append(encoding)
        return tuple(sent)

    def _published(self, variable: CppNode, made: CppNode) -> _Found:
        """Return the calls of publish() of a publisher; None where it may publish elsewhere."""
        calls = []
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
        name = short_name(called_name(node)) if node.kind == "call_expression" else ""
        if name == _TO_MESSAGE and not list_arguments(node):
            return self._find_encoding(called_object(node), depth - 1)
        if name in _CONVERTING:
            return self._converted_to(node)
        is_literal = node.kind == "compound_literal_expression"
        kind = node.child("type").text if is_literal else class_written(node) or name
        if short_name(plain(kind)) == _IMAGE:
            return self._encoding_in(list_arguments(node), 1)
        return None

    def _converted_to(self, call: CppNode) -> ImageEncoding | None:
        """Return the encoding to which cv_bridge converts an image."""
        given = list_arguments(call)
        is_tracked = called_name(call).endswith("toCvShare") and len(given) == 3
        return self._encoding_in(given, 2 if is_tracked else 1)

    def _encoding_in(self, given: CppNodes, position: int) -> ImageEncoding | None:
        """Return the encoding that an argument is; None where it is missing or not known."""
        if position >= len(given):
            return None
        node = given[position]
        value = self._evaluation.evaluate_node(node)
        text = None
        if isinstance(value, str):
            text = value
        elif isinstance(value, CppName):
            text = self._constant(value.name, node)
        return ImageEncoding(text, node.location) if text not in (None, *_ANY_ENCODINGS) else None

    def _constant(self, name: str, node: CppNode) -> str | None:
        """Return the encoding that a constant of sensor_msgs is; None for another name."""
        for meaning in self._unit.meanings(name, self._scopes_at(node)):
            match = _CONSTANT.fullmatch(meaning)
            if match and _DEPTH.fullmatch(match[1]):
                return match[1]
            if match and match[1].lower() in colour_encodings():
                return match[1].lower()
        return None

    def _encoding_of_variable(self, node: CppNode, depth: int) -> ImageEncoding | None:
        """Return the encoding of the image that a variable has where it is published."""
        name = node.child("field") if node.kind == "field_expression" else node
        if _whole(name) is not node:
            return None
        writes = self._find_writes(name)
        if not writes:
            return None
        if writes.encodings:
            return self._encoding_assigned(writes, node)
        if len(writes.values) != 1:
            return None
        [value] = writes.values
        if value.kind in _LISTS:
            return self._encoding_in(value.code, 1)
        return self._find_encoding(value, depth - 1)

    def _encoding_assigned(self, writes: _Writes, node: CppNode) -> ImageEncoding | None:
        """Return the encoding that is assigned to a variable after everything else."""
        [assignment, *more] = writes.encodings
        value = assignment.child("right")
        if more or not value:
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
        values: CppNodes = []
        encodings: CppNodes = []
        for use in uses:
            node = _wrapped(use)
            if node.parent.kind == "field_expression" and node.field == "argument":
                written = _encoding_set(node.parent)
                place = encodings
            else:
                written = _value_set(use, node, node.parent)
                place = values
            if written is None:
                return None
            place += written
        return _Writes(values, encodings)

    def _reaches(self, assignment: CppNode, use: CppNode) -> bool:
        """Return whether an assignment certainly precedes a place."""
        block = assignment.parent.parent
        # Not in an `if` without braces, nor below a `case`.
        if block.kind != "compound_statement":
            return False
        if is_conditional(assignment, assignment.file.root):
            return False
        if use.file is assignment.file and block.start <= use.start < block.end:
            return assignment.start < use.start
        function = self._unit.function_around(assignment)
        if not function or function is self._unit.function_around(use):
            return False
        return block is function.body and function.name == short_name(function.owner)

    # --- What is asked
    # ----------------------------------------------------------------------

    def _asked_by(self, call: CppNode, function: CppFunction) -> ImageEncodings:
        """Return the encodings to which the callback of a subscription converts its image."""
        for callback in list_arguments(call)[2:3]:
            body, message = self._function_given(callback, function)
            inner = _only_call(body, message)
            if inner:
                body, message = self._method(called_name(inner), function)
            if body and message:
                return self._asked_in(body, message)
        return ()

    def _function_given(self, callback: CppNode, function: CppFunction) -> tuple[CppNode, CppNode]:
        """Return the body of a callback and the name of what it is given, as far as known."""
        if callback.kind == "identifier":
            callback = self._declared_callback(callback)
        if callback.kind == "lambda_expression":
            parameters = callback.child("declarator").child("parameters")
            return callback.child("body"), _parameter_name(parameters.children)
        if callback.kind == "call_expression" and called_name(callback) in ("std::bind", "bind"):
            pointed = next(iter(list_arguments(callback)), NO_NODE)
            if pointed.kind == "pointer_expression":
                return self._method(plain(pointed.child("argument").text), function)
        return NO_NODE, NO_NODE

    def _declared_callback(self, name: CppNode) -> CppNode:
        """Return the value of the only declaration of a variable; else its name."""
        declared = [use for use in self._evaluation.find_uses(name) or () if use is not name]
        values = [_value_declared(use) for use in declared if use.field == "declarator"]
        if len(declared) == 1 and len(values) == 1 and values[0]:
            return values[0]
        return name

    def _method(self, name: str, function: CppFunction) -> tuple[CppNode, CppNode]:
        """Return the body and the first parameter of a method of the class of a function."""
        class_name, _, short = name.rpartition("::")
        owner = function.class_name
        if class_name and short_name(class_name) != short_name(owner):
            return NO_NODE, NO_NODE
        methods = self._methods.get((owner, short), ()) if owner else ()
        if len(methods) != 1 or methods[0].is_conditional or methods[0].is_template:
            return NO_NODE, NO_NODE
        return methods[0].body, _parameter_name(methods[0].parameters)

    @cached_property
    def _methods(self) -> Mapping[tuple[str, str], Sequence[CppFunction]]:
        """The functions by their classes and names."""
        return group_values(((each.class_name, each.name), each) for each in self._unit.functions)

    def _asked_in(self, body: CppNode, message: CppNode) -> ImageEncodings:
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
            if not encoding or is_conditional(node, body):
                return ()
            asked.append(encoding)
        return tuple(asked)


def _find_variable(made: CppNode) -> CppNode:
    """Return the name of the variable that a publisher is made for; NO_NODE without one."""
    initializer = made.parent.parent
    return initializer.first if initializer.kind == "field_initializer" else find_variable(made)


def _full_name(node: CppNode) -> str:
    """Return the name of a type that is a template, with its namespaces."""
    whole = node
    while whole.field == "name" and whole.parent.kind == "qualified_identifier":
        whole = whole.parent
    return plain(whole.text)


def _whole(use: CppNode) -> CppNode:
    """Return the expression that a name is part of: `this->name`, or the name."""
    return use.parent if is_member_of_this(use) else use


def _is_same(node: CppNode) -> bool:
    """Return whether an expression is what it contains: in parentheses, or where it points to."""
    if node.kind == "pointer_expression":
        return node.text.startswith("*")
    return node.kind == "parenthesized_expression"


def _wrapped(use: CppNode) -> CppNode:
    """Return the largest expression that is what a name means, with `*` and parentheses."""
    node = _whole(use)
    while _is_same(node.parent):
        node = node.parent
    return node


def _unwrapped(node: CppNode) -> CppNode:
    """Return an expression without `*`, parentheses and std::move()."""
    while True:
        given = list_arguments(node) if node.kind == "call_expression" else []
        if _is_same(node):
            node = node.child("argument") or node.first
        elif len(given) == 1 and called_name(node) in ("std::move", "move"):
            node = given[0]
        else:
            return node


def _encoding_set(member: CppNode) -> _Found:
    """Return the assignment of an encoding where a member of an image is named.

    There is none for another member. The result has None where the encoding may be set in another
    way.
    """
    parent = member.parent
    field = member.child("field")
    if parent.kind == "call_expression":
        return [] if field.text == _TO_MESSAGE else None
    if field.text != _ENCODING:
        return []
    is_set = parent.kind == "assignment_expression" and member.field == "left"
    return [parent] if is_set else None


def _value_declared(name: CppNode) -> CppNode:
    """Return the value that a variable is declared with; NO_NODE without one."""
    for around in name.ancestors():
        if around.kind.endswith("declarator"):
            continue
        for declared, value in declared_in(around):
            if declared is name:
                return value
    return NO_NODE


def _parameter_name(parameters: CppNodes) -> CppNode:
    """Return the name of the first parameter."""
    return name_in(parameters[0].child("declarator")) if parameters else NO_NODE


def _only_call(body: CppNode, message: CppNode) -> CppNode:
    """Return the call of a method that is all that a function does with what it is given."""
    statements = body.code
    if not message or len(statements) != 1:
        return NO_NODE
    call = statements[0].first
    given = list_arguments(call) if call.kind == "call_expression" else []
    if not given or _unwrapped(given[0]).text != message.text:
        return NO_NODE
    # A method of the same object, or a function without a scope.
    is_own = called_object(call).kind in ("", "this") and "::" not in called_name(call)
    return call if is_own else NO_NODE


def _compared_types(
    synchroniser: str, types: Sequence[str | None], written: CppNodes
) -> Iterator[SynchronisedType]:
    """Yield the known types of the messages that a synchroniser compares, with the others."""
    known = tuple(type_name for type_name in types if type_name is not None)
    for type_name, at in zip(types, written, strict=True):
        if type_name is not None:
            yield SynchronisedType(type_name, synchroniser, at.location, known)


def _publishing_calls(node: CppNode, made: CppNode) -> _Found:
    """Return the call of publish() that a use of a publisher is.

    There is none where it is another harmless use. The result is None where the publisher may
    publish elsewhere.
    """
    parent = node.parent
    if parent.kind == "field_expression" and node.field == "argument":
        return _calls_of_method(parent.parent, parent.child("field").text)
    if node.field in ("declarator", "left") or parent.kind == "field_initializer":
        is_here = parent.start <= made.start < parent.end
        is_harmless = is_here or parent.kind in ("declaration", "field_declaration")
    else:
        is_harmless = parent.kind in _READING
    return [] if is_harmless else None


def _calls_of_method(call: CppNode, method: str) -> _Found:
    """Return the call of a publisher's method if it is publish(); None where it may publish."""
    if call.kind != "call_expression":
        return None
    if method == "publish":
        return [call]
    return [] if method in _HARMLESS_METHODS else None


def _value_set(use: CppNode, node: CppNode, parent: CppNode) -> _Found:
    """Return the value that a use of an image sets it to, if it sets it.

    The result is None where the use may set it to something that is not known.
    """
    value = NO_NODE
    if node.field == "declarator":
        value = _value_declared(use)
    elif parent.kind == "assignment_expression" and node.field == "left":
        value = parent.child("right")
    elif not is_given_to(node, _TAKERS) and parent.kind not in _READING:
        return None
    return [value] if value else []


def _is_conversion(node: CppNode, message: CppNode) -> bool:
    """Return whether a node is a call of cv_bridge that converts a message."""
    if node.kind != "call_expression":
        return False
    given = list_arguments(node)
    if short_name(called_name(node)) not in _CONVERTING[:2] or not given:
        return False
    return _unwrapped(given[0]).text == message.text
