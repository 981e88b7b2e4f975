"""Reads .msg, .srv and .action files as rosidl_adapter does.

The source is rosidl_adapter/parser.py of ros2/rosidl, branch jazzy.
"""

import posixpath
import re
from collections.abc import Iterator, Sequence
from typing import cast, get_args

from grader.base.names import near
from grader.base.patterns import on_use
from grader.base.records import Named
from grader.base.source import Location, Source
from grader.base.text import enumerated
from grader.ros.interfaces.interface_types import (
    BOOLEANS,
    FLOATS,
    INTEGERS,
    PRIMITIVES,
    SECTIONS,
    TEXTS,
    FieldType,
    Interface,
    InterfaceFault,
    InterfaceField,
    InterfaceKind,
    InterfaceSection,
)

INTERFACE_ENDINGS = tuple(f".{kind}" for kind in get_args(InterfaceKind))
_MAX_LINES = 2_000  # of a file; no message is as long
_MAX_FAULTS = 20
_SEPARATOR = "---"
_LIKE_SEPARATOR = re.compile(r"\s*+[-_]{2,}+\s*")
_BOUND = "<="
_PACKAGE = on_use(r"(?!.*__)(?!.*_\Z)[a-z][a-z0-9_]*\Z")
_FIELD = _PACKAGE
_MESSAGE = on_use(r"[A-Z][A-Za-z0-9]*\Z")
# rosidl has the pattern [A-Z]([A-Z0-9_]?[A-Z0-9]+)*, which takes long on some names.
_CONSTANT = on_use(r"(?!.*__)[A-Z][A-Z0-9_]*+(?<!_)\Z")
_OWN_SUFFIXES = ("_Request", "_Response", "_Goal", "_Result", "_Feedback")
_WORDS = {"true": True, "1": True, "false": False, "0": False}
# Names that other languages and ROS 1 have for the primitive types.
_MEANT = {
    "int": "int32",
    "integer": "int32",
    "uint": "uint32",
    "float": "float32",
    "double": "float64",
    "real": "float64",
    "boolean": "bool",
    "str": "string",
    "String": "string",
    "Bool": "bool",
    "Float32": "float32",
    "Float64": "float64",
    "Int32": "int32",
}


class _Wrong(Exception):
    """What is wrong with a line; `written` is the word, and `meant` what may be meant by it."""

    def __init__(self, message: str, written: str = "", meant: str | None = None) -> None:
        super().__init__(message)
        self.written = written
        self.meant = meant


class _Line(Named):
    """A line of a file, without its comment, and its number."""

    text: str
    number: int


def read_interface(data: bytes, path: str, package: str) -> Interface:
    """Read the file of a message, service or action of a package.

    It never raises: what rosidl does not accept is among the faults.
    """
    kind = cast("InterfaceKind", posixpath.splitext(path)[1].removeprefix("."))
    try:
        text = data.decode()
    except UnicodeDecodeError as error:
        message = f"the file is not UTF-8 text (byte {error.start})"
        return Interface(kind, (), (InterfaceFault(message, Location(path, 1, 1)),))
    source = Source(path, text.replace("\r\n", "\n").replace("\r", "\n"))
    return _Reading(source, package, kind).interface()


class _Reading:
    """The reading of one file."""

    def __init__(self, source: Source, package: str, kind: InterfaceKind) -> None:
        self._source = source
        self._package = package
        self._kind = kind
        self._faults: list[InterfaceFault] = []

    def interface(self) -> Interface:
        """Return what the file defines, and what is wrong with it."""
        texts = self._source.text.splitlines()
        if len(texts) > _MAX_LINES:
            self._fault(f"the file has more than {_MAX_LINES} lines, which is not read", 1)
            return Interface(self._kind, (), tuple(self._faults))
        self._check_name()
        lines = [_Line(text, number) for number, text in enumerate(texts, 1)]
        sections = [self._section(part) for part in self._parts(lines)]
        return Interface(self._kind, tuple(sections), tuple(self._faults))

    def _fault(self, message: str, line: int, written: str = "", meant: str | None = None) -> None:
        if len(self._faults) < _MAX_FAULTS:
            column = self._source.line(line).find(written) + 1 if written else 1
            at = Location(self._source.path, line, max(column, 1))
            self._faults.append(InterfaceFault(message, at, written, meant))

    def _check_name(self) -> None:
        name = posixpath.splitext(posixpath.basename(self._source.path))[0]
        # rosidl reads each section as a message with this name.
        of_section = f"{name}_{SECTIONS[self._kind][0]}".removesuffix("_")
        if not _is_message_name(of_section):
            message = (
                f"the name of the file, {name!r}, begins with no capital letter, or has other "
                "characters than letters and digits"
            )
            self._fault(message, 1)

    def _parts(self, lines: Sequence[_Line]) -> Iterator[Sequence[_Line]]:
        """Yield the lines of each section, as far as the file has the right number of them."""
        names = SECTIONS[self._kind]
        if len(names) == 1:
            yield lines
            return
        ends = [index for index, line in enumerate(lines) if line.text == _SEPARATOR]
        if len(ends) + 1 != len(names):
            self._fault_of_parts(lines, ends)
            return
        start = 0
        for end in (*ends, len(lines)):
            yield lines[start:end]
            start = end + 1

    def _fault_of_parts(self, lines: Sequence[_Line], ends: Sequence[int]) -> None:
        names = [name.lower() for name in SECTIONS[self._kind]]
        wanted = "one line" if len(names) == 2 else f"{len(names) - 1} lines"
        message = (
            f"a .{self._kind} has {wanted} {_SEPARATOR} between {enumerated(names)}; "
            f"this file has {len(ends)}"
        )
        at = lines[ends[-1]].number if ends else 1
        for line in lines:
            if line.text != _SEPARATOR and _LIKE_SEPARATOR.fullmatch(line.text):
                message = f"{message} ({line.text!r} is none)"
                at = line.number
                break
        self._fault(message, at)

    def _section(self, lines: Sequence[_Line]) -> InterfaceSection:
        fields: dict[str, InterfaceField] = {}
        constants: set[str] = set()
        for line in _without_comments(lines):
            type_text, _, rest = line.text.replace("\t", " ").partition(" ")
            rest = rest.lstrip()
            name, is_constant, value = rest.partition("=")
            if not rest:
                message = f"{line.text.strip()!r} is no field: it needs a type and a name"
                self._fault(message, line.number)
                continue
            try:
                if is_constant:
                    self._add_constant(constants, type_text, name.rstrip(), value.lstrip())
                else:
                    self._add_field(fields, type_text, rest, line.number)
            except _Wrong as wrong:
                self._fault(str(wrong), line.number, wrong.written, wrong.meant)
        return InterfaceSection(fields, frozenset(constants))

    def _add_constant(self, known: set[str], kind: str, name: str, value: str) -> None:
        if kind not in PRIMITIVES:
            meant = _MEANT.get(kind) or near(kind, PRIMITIVES)
            raise _Wrong(f"the type of a constant is primitive, not {kind!r}", kind, meant)
        if not _CONSTANT.match(name):
            meant = name.upper() if _CONSTANT.match(name.upper()) else None
            raise _Wrong(
                f"the name of a constant is written as MAX_SPEED, not {name!r}", name, meant
            )
        _check_value(FieldType("", kind), value)
        if name in known:
            raise _Wrong(f"there are two constants {name}", name)
        known.add(name)

    def _add_field(
        self, known: dict[str, InterfaceField], type_text: str, rest: str, line: int
    ) -> None:
        name, _, default = rest.partition(" ")
        kind = read_type(type_text, self._package)
        if not _FIELD.match(name):
            lower = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).lower()
            meant = lower if _FIELD.match(lower) else None
            raise _Wrong(f"the name of a field is written as max_speed, not {name!r}", name, meant)
        if default.lstrip():
            _check_default(kind, default.lstrip())
        if name in known:
            raise _Wrong(f"there are two fields {name}", name)
        known[name] = InterfaceField(name, kind, Location(self._source.path, line, 1))


def _without_comments(lines: Sequence[_Line]) -> Iterator[_Line]:
    """Yield the lines with a definition, without comments and the spaces at their ends."""
    is_start = True  # of the comments on the file, which begin in the first column
    for line in lines:
        is_start = is_start and line.text.startswith("#")
        text = line.text.partition("#")[0].rstrip()
        if text and not is_start:
            yield _Line(text, line.number)


def _is_message_name(name: str) -> bool:
    name = name.removeprefix("Sample_")
    for suffix in _OWN_SUFFIXES:
        name = name.removesuffix(suffix)
    return _MESSAGE.match(name) is not None


def read_type(text: str, package: str) -> FieldType:
    """Return the type that a word names. Raises _Wrong."""
    if not text:
        raise _Wrong("a line begins with a space: it should begin with the type of a field")
    if not text.endswith("]"):
        return _read_element(text, package)
    name, bracket, size_text = text[:-1].rpartition("[")
    if not bracket:
        raise _Wrong(f"{text!r} ends with ], and has no [", text)
    element = _read_element(name, package)
    is_bounded = size_text.startswith(_BOUND)
    if not size_text:
        return element._replace(is_list=True)
    size = _positive(size_text.removeprefix(_BOUND))
    if size is None:
        raise _Wrong(f"the size of {text!r} is no whole number above 0", text)
    return element._replace(is_list=True, size=size, is_bounded=is_bounded)


def _read_element(text: str, package: str) -> FieldType:
    """Return the type of a field that is no list, or of an item of one. Raises _Wrong."""
    if text in PRIMITIVES:
        return FieldType("", text)
    word, is_bounded, bound_text = text.partition(_BOUND)
    if is_bounded and word in TEXTS:
        bound = _positive(bound_text)
        if bound is None:
            raise _Wrong(f"the bound of {text!r} is no whole number above 0", text)
        return FieldType("", word, text_bound=bound)
    owner, is_foreign, name = text.partition("/")
    if is_foreign:
        _check_foreign(text)
    else:
        owner = package
        name = text
    if not _is_message_name(name):
        raise _no_type(text, is_foreign=bool(is_foreign))
    return FieldType(owner, name)


def _check_foreign(text: str) -> None:
    """Raise _Wrong for a text that is no package with a message of it."""
    owner, _, name = text.partition("/")
    if "/" in name:
        plain = text.replace("/msg/", "/")
        if plain == text:
            raise _Wrong(f"there is no type {text!r}", text)
        raise _Wrong(f"there is no type {text!r}; write {plain!r}", text, plain)
    if not _PACKAGE.match(owner):
        raise _Wrong(f"{owner!r} is no name of a package", owner)


def _no_type(text: str, *, is_foreign: bool) -> _Wrong:
    """Return that there is no type of a name, with the primitive type that may be meant."""
    meant = None
    if not is_foreign:
        meant = _MEANT.get(text) or near(text, PRIMITIVES)
    word = text.rstrip("0123456789")
    sizes = [
        primitive for primitive in sorted(PRIMITIVES) if primitive.rstrip("0123456789") == word
    ]
    hint = ""
    if meant is not None:
        hint = f"; did you mean {meant!r}?"
    elif len(sizes) > 1:
        hint = f"; there are {enumerated(sizes)}"
    return _Wrong(f"there is no type {text!r}{hint}", text, meant)


def _positive(text: str) -> int | None:
    number = _integer(text, 10)
    return number if number is not None and number > 0 else None


def _integer(text: str, base: int) -> int | None:
    try:
        return int(text, base)
    except ValueError:
        return None


def _check_default(kind: FieldType, text: str) -> None:
    """Raise _Wrong for a text that is no default of a type."""
    if kind.package:
        raise _Wrong(f"a field of the type {kind.name} has no default", text)
    if not kind.is_list:
        _check_value(kind, text)
        return
    if not (text.startswith("[") and text.endswith("]")):
        raise _Wrong(f"the default of a list is written as [1, 2], not {text!r}", text)
    items = _text_items(text[1:-1]) if kind.name in TEXTS else text[1:-1].split(",")
    if text == "[]":
        items = []
    _check_size(kind, len(items), text)
    for item in items:
        _check_value(kind, item.strip())


def _check_size(kind: FieldType, count: int, text: str) -> None:
    """Raise _Wrong for a default with another number of items than a list may have."""
    if kind.size is None:
        return
    if not kind.is_bounded and count != kind.size:
        raise _Wrong(f"the default has {count} items; the list has {kind.size}", text)
    if count > kind.size:
        raise _Wrong(f"the default has {count} items; the list has at most {kind.size}", text)


def _text_items(text: str) -> list[str]:
    """Return the items of a list of texts, where a comma may be between quotes. Raises _Wrong."""
    items = []
    while text:
        text = text.lstrip(" ")
        if not text or text[0] == ",":
            raise _Wrong("an item of the default is missing", text)
        if text[0] in "\"'":
            end = _closing_quote(text)
            items.append(text[1:end].replace(f"\\{text[0]}", text[0]))
            text = text[end + 1 :]
        else:
            item, comma, rest = text.partition(",")
            items.append(item)
            text = f"{comma}{rest}"
        text = text.lstrip(" ").removeprefix(",")
    return items


def _closing_quote(text: str) -> int:
    """Return where the quote that a text begins with is closed. Raises _Wrong."""
    for at in range(1, len(text)):
        if text[at] == text[0] and text[at - 1] != "\\":
            return at
    raise _Wrong(f"the text {text!r} is not closed", text)


def _check_value(kind: FieldType, text: str) -> None:
    """Raise _Wrong for a text that is no value of a primitive type."""
    if kind.name in BOOLEANS:
        if text.lower() not in _WORDS:
            raise _Wrong(f"a bool is true or false, not {text!r}", text)
    elif kind.name in FLOATS:
        try:
            float(text)
        except ValueError:
            raise _Wrong(f"{text!r} is no number", text) from None
    elif kind.name in TEXTS:
        _check_text(kind, text)
    elif kind.name in INTEGERS or kind.name == "byte":
        _check_integer(kind, text)
    else:
        raise _Wrong(f"a value of the type {kind.name} cannot be written", text)


def _check_integer(kind: FieldType, text: str) -> None:
    """Raise _Wrong for a text that is no integer of a type."""
    number = _integer(text, 10)
    if number is None:
        number = _integer(text, 0)
    smallest, largest = _compute_range(kind.name)
    if number is None or not smallest <= number <= largest:
        raise _Wrong(
            f"{text!r} is no {kind.name}, a whole number from {smallest} to {largest}", text
        )


def _compute_range(name: str) -> tuple[int, int]:
    """Return the smallest and the largest value of a type of whole numbers."""
    if name in ("byte", "char"):
        return 0, 255
    bits = int(name.lstrip("uint"))
    if name.startswith("u"):
        return 0, 2**bits - 1
    return -(2 ** (bits - 1)), 2 ** (bits - 1) - 1


def _check_text(kind: FieldType, text: str) -> None:
    """Raise _Wrong for a text with quotes inside of its quotes, or one that is too long."""
    for quote in "\"'":
        if text.startswith(quote) and text.endswith(quote):
            text = text[1:-1]
            if re.search(rf"(?<!\\){quote}", text):
                raise _Wrong(f"a quote in the text {text!r} needs a \\ before it", text)
            text = text.replace(f"\\{quote}", quote)
            break
    if kind.text_bound is not None and len(text) > kind.text_bound:
        raise _Wrong(f"the default has more than {kind.text_bound} characters", text)
