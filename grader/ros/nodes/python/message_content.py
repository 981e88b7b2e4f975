"""What Python code asks of the content of messages.

This is a time in their header that a synchroniser compares, and the encoding of images that
cv_bridge converts.
"""

import ast
from collections.abc import Callable, Iterator, Mapping, Sequence

from grader.base.grouping import StringsByName
from grader.base.records import Named
from grader.base.source import Location, Source
from grader.base.text import last_part
from grader.ros.nodes.message_uses import CodePart, FunctionKey, given_argument
from grader.ros.nodes.node_facts import (
    CodeFault,
    CodeFaults,
    EncodingsByLocation,
    ImageEncoding,
    ImageEncodings,
    SynchronisedType,
)
from grader.ros.nodes.python.called_functions import name_fully
from grader.ros.nodes.python.endpoint_names import Bindings
from grader.ros.python.constants import dotted, last_name
from grader.ros.python.parse import Code, location_in, make_position, own_parameters
from grader.ros.python.values import QualifiedName, Scope, Value
from grader.ros.python.walking import walk

SUBSCRIBER = "message_filters.Subscriber"
_SYNCHRONISERS = (
    "message_filters.TimeSynchronizer",
    "message_filters.ApproximateTimeSynchronizer",
)
_HEADERLESS_AT = 3
_HEADERLESS = "allow_headerless"
_MAX_DEPTH = 12  # of names that are bound to expressions with names
_ANY_ENCODING = "passthrough"
_PUBLISHES = "create_publisher"


class _BoundFunction(Named):
    """A function, and what the names in it and the attributes of its class are bound to."""

    part: CodePart
    values: Mapping[str, ast.expr]

    def resolve(self, node: ast.expr | None) -> ast.expr | None:
        """Return the expression that a name is bound to, or the expression itself."""
        for _ in range(_MAX_DEPTH):
            if not isinstance(node, ast.Name | ast.Attribute) or dotted(node) not in self.values:
                break
            node = self.values[dotted(node)]
        return node


class ContentReader:
    """Reads what the functions of a module ask of messages."""

    def __init__(
        self,
        parts: Sequence[CodePart],
        source: Source,
        value_of: Callable[[ast.expr | None, Scope], Value],
        bindings_of: Callable[[CodePart], Bindings],
    ) -> None:
        """`bindings_of` returns the bindings in a function, with those of its class."""
        self._functions = [_BoundFunction(part, bindings_of(part).values) for part in parts]
        self._source = source
        self._value_of = value_of

    def synchronised_types(self) -> Iterator[SynchronisedType]:
        """Yield the types of the messages that synchronisers get, unless these need no header."""
        for function in self._functions:
            for call in function.part.calls:
                kind = self._called(function, call)
                if kind not in _SYNCHRONISERS or _takes_any(call):
                    continue
                filters = function.resolve(given_argument(call, 0, "fs"))
                for each in filters.elts if isinstance(filters, ast.List | ast.Tuple) else ():
                    made = function.resolve(each)
                    if not isinstance(made, ast.Call) or self._called(function, made) != SUBSCRIBER:
                        continue
                    written = given_argument(made, 1, "msg_type")
                    type_name = self._value_of(written, function.part.scope)
                    if isinstance(type_name, QualifiedName):
                        by = last_part(kind)
                        yield SynchronisedType(type_name.name, by, self._at(made))

    def encodings(self) -> EncodingsByLocation:
        """Return the encodings that publishers send, and to which callbacks convert images.

        The keys are the places where publishers and subscriptions are made. There are none where
        one is not known.
        """
        asked = self._encodings_asked()
        encodings_by_place: dict[Location, list[ImageEncoding | None]] = {}
        for function in self._functions:
            names_encoding = _names_encoding(function.part)
            for call in function.part.calls:
                match call.func:
                    case ast.Attribute(attr="publish", value=owner):
                        made = function.resolve(owner)
                        if isinstance(made, ast.Call) and last_name(made.func) == _PUBLISHES:
                            sent = None if names_encoding else self._sent(function, call)
                            encodings_by_place.setdefault(self._at(made), []).append(sent)
                    case ast.Attribute(attr="create_subscription"):
                        name = dotted(given_argument(call, 2, "callback") or call)
                        of = function.part.of if name.startswith("self.") else None
                        encodings_by_place.setdefault(self._at(call), []).extend(
                            asked.get((of, name), ())
                        )
        return _all_known(encodings_by_place)

    def _sent(self, function: _BoundFunction, call: ast.Call) -> ImageEncoding | None:
        """Return the encoding of the image that is published."""
        image = function.resolve(given_argument(call, 0, "msg"))
        if isinstance(image, ast.Call) and last_name(image.func) == "cv2_to_imgmsg":
            return self._encoding(function, image, "encoding")
        return None

    def _encodings_asked(self) -> Mapping[FunctionKey, list[ImageEncoding]]:
        """Return the encodings to which functions convert what they are given.

        The keys are their class and name.
        """
        asked: dict[FunctionKey, list[ImageEncoding]] = {}
        for function in self._functions:
            part = function.part
            message = _first_argument(function.part)
            if not message or _names_encoding(part):
                continue
            key = (part.of, f"self.{part.name}" if part.of else part.name)
            for call in part.calls:
                given = given_argument(call, 0, "img_msg")
                if last_name(call.func) == "imgmsg_to_cv2" and dotted(given or call) == message:
                    encoding = self._encoding(function, call, "desired_encoding")
                    if encoding:
                        asked.setdefault(key, []).append(encoding)
        return asked

    def _encoding(
        self, function: _BoundFunction, call: ast.Call, name: str
    ) -> ImageEncoding | None:
        text = self._value_of(given_argument(call, 1, name), function.part.scope)
        if not isinstance(text, str) or text == _ANY_ENCODING:
            return None
        return ImageEncoding(text, self._at(call))

    def _called(self, function: _BoundFunction, call: ast.Call) -> str:
        value = self._value_of(call.func, function.part.scope) if dotted(call.func) else None
        return value.name if isinstance(value, QualifiedName) else ""

    def _at(self, node: ast.expr) -> Location:
        return location_in(self._source, make_position(node))


def _takes_any(call: ast.Call) -> bool:
    """Return whether a synchroniser may take messages without a header."""
    given = given_argument(call, _HEADERLESS_AT, _HEADERLESS)
    is_off = isinstance(given, ast.Constant) and given.value is False
    is_unpacked = any(keyword.arg is None for keyword in call.keywords)
    return is_unpacked or not (not given or is_off)


def _names_encoding(part: CodePart) -> bool:
    """Return whether a function reads or sets the encoding of an image itself."""
    nodes = walk(part.node)
    return any(isinstance(node, ast.Attribute) and node.attr == "encoding" for node in nodes)


def _first_argument(part: CodePart) -> str:
    """Return the name of what a function is given, if nothing else is bound to it."""
    if isinstance(part.node, ast.Module):
        return ""
    names = own_parameters(part.node)
    for node in walk(part.node):
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store) and node.id in names:
            return ""
    return names[0] if names else ""


def _all_known(
    encodings_by_place: Mapping[Location, Sequence[ImageEncoding | None]],
) -> dict[Location, ImageEncodings]:
    """Return the encodings of the places at which all of them are known."""
    known = {}
    for at, encodings in encodings_by_place.items():
        if None not in encodings:
            known[at] = tuple(encoding for encoding in encodings if encoding)
    return known


def silent_synchronisers(
    code: Code, parts: Sequence[CodePart], imports: StringsByName
) -> CodeFaults:
    """Yield the synchronisers of a module, in a package that registers no callback of any.

    `imports` has the full names of what the module imports.
    """
    for part in parts:
        for call in part.calls:
            if name_fully(call.func, imports) in _SYNCHRONISERS:
                message = "no callback is registered with this synchroniser, so it does nothing"
                yield CodeFault("filter-callback", message, code.at(call))
