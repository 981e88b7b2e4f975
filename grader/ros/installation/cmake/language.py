"""The commands of a CMakeLists.txt, with their blocks; the grammar is that of cmake-language(7)."""

import re
from collections.abc import Iterable, Iterator
from itertools import chain
from typing import Literal

from grader.base.patterns import on_use
from grader.base.records import Named
from grader.base.source import Source
from grader.ros.python.parse import Position

_MAX_DEPTH = 30  # blocks in each other
_SKIP = on_use(r"(?:\s++|#\[(=*)\[.*?\]\1\]|#(?!\[=*\[)[^\n]*+)++", re.DOTALL)
_NAME = on_use(r"([A-Za-z_]\w*+)[ \t]*+\(")
_ARGUMENT = on_use(
    r'(?P<paren>[()])|(?P<bracket>\[(=*)\[\n?(.*?)\]\3\])|"(?P<quoted>(?:[^"\\]|\\.)*+)"'
    r'|(?P<unquoted>(?:\$\([A-Za-z0-9_]*+\)|[^\s()#"\\]|\\.)'
    r'(?:\$\([A-Za-z0-9_]*+\)|[^\s()#"\\]|\\.|"(?:[^"\\]|\\.)*+")*+)',
    re.DOTALL,
)
_ENDS = {
    "if": "endif",
    "foreach": "endforeach",
    "while": "endwhile",
    "function": "endfunction",
    "macro": "endmacro",
    "block": "endblock",
}
BLOCK_WORDS = frozenset({*_ENDS, *_ENDS.values(), "elseif", "else"})


class CMakeFault(Exception):
    """What CMake cannot parse, and where.

    `sure` is False for what only this reader does not parse.
    """

    def __init__(self, message: str, at: Position, *, is_certain: bool = True) -> None:
        super().__init__(message)
        self.at = at
        self.is_certain = is_certain


class Argument(Named):
    """An argument as it is written, without its quotes or brackets."""

    text: str
    kind: Literal["paren", "bracket", "quoted", "unquoted"]
    at: Position


class Command(Named):
    """A command, with the commands in it if it begins a block.

    Of `if`, `elseif` and `else` are in `others`.
    """

    name: str  # in lower case
    arguments: tuple[Argument, ...]
    at: Position
    body: tuple["Command", ...] = ()
    others: tuple["Command", ...] = ()


def parse_cmake(source: Source) -> tuple[Command, ...]:
    """Return the commands of a file. Raises CMakeFault."""
    commands = list(_commands(source))
    parsed, rest = _block(commands, 0, "", 0)
    if rest < len(commands):
        raise CMakeFault(f"{commands[rest].name}() has no beginning", commands[rest].at)
    return parsed


def _block(
    commands: list[Command], index: int, end: str, depth: int
) -> tuple[tuple[Command, ...], int]:
    """Return the commands up to the end of a block, and the index of that end."""
    block = []
    while index < len(commands):
        command = commands[index]
        if command.name == end or (end == "endif" and command.name in ("elseif", "else")):
            break
        if command.name in _ENDS.values() or command.name in ("elseif", "else"):
            break
        if command.name in _ENDS:
            command, index = _opened(commands, index, depth)
        block.append(command)
        index += 1
    return tuple(block), index


def _opened(commands: list[Command], start: int, depth: int) -> tuple[Command, int]:
    """Return the command that begins a block, with what is in it, and the index of its end.

    Raises CMakeFault.
    """
    first = commands[start]
    end = _ENDS[commands[start].name]
    if depth > _MAX_DEPTH:
        raise CMakeFault("the blocks are too deeply nested to read", first.at, is_certain=False)
    body, index = _block(commands, start + 1, end, depth + 1)
    others = []
    while index < len(commands):
        command = commands[index]
        if end != "endif" or command.name not in ("elseif", "else"):
            break
        part, index = _block(commands, index + 1, end, depth + 1)
        others.append(command._replace(body=part))
    if index >= len(commands) or commands[index].name != end:
        raise CMakeFault(f"{first.name}() has no {end}()", first.at)
    return first._replace(body=body, others=tuple(others)), index


def _commands(source: Source) -> Iterator[Command]:
    """Yield the commands of a file, without blocks. Raises CMakeFault."""
    text = source.text
    places = _Columns(source)
    offset = len("\ufeff") if text.startswith("\ufeff") else 0  # CMake takes a byte order mark
    while (offset := _skip(text, offset)) < len(text):
        name = _NAME.match(text, offset)
        if not name:
            word = re.match(r"\S{1,30}", text[offset:])
            raise CMakeFault(
                f"CMake expects a command such as install(...), not {word and word[0]!r}",
                places.at(offset),
            )
        at = places.at(offset)
        arguments, end = _arguments(text, name.end(), places)
        yield Command(name[1].lower(), arguments, at)
        offset = end


def _arguments(text: str, offset: int, places: "_Columns") -> tuple[tuple[Argument, ...], int]:
    """Return the arguments of a command and where it ends. Raises CMakeFault."""
    start = offset
    depth = 0
    arguments: list[Argument] = []
    while True:
        offset = _skip(text, offset)
        match = _ARGUMENT.match(text, offset)
        if not match:
            if text[offset : offset + 1] == '"':
                reason = "a quote is not closed"
            else:
                reason = "a parenthesis is not closed"
            raise CMakeFault(reason, places.at(start))
        offset = match.end()
        kind: Literal["paren", "bracket", "quoted", "unquoted"] = match.lastgroup  # type: ignore[assignment]
        if match["paren"]:
            depth += 1 if match["paren"] == "(" else -1
            if depth < 0:
                return tuple(arguments), offset
        content = match[4] if kind == "bracket" else match[kind]
        arguments.append(Argument(content, kind, places.at(match.start())))


def _skip(text: str, offset: int) -> int:
    """Return where the next token begins, after space and comments."""
    match = _SKIP.match(text, offset)
    return match.end() if match else offset


class _Columns:
    """The positions of offsets in a text, whose columns count bytes, as Python counts them.

    Offsets grow, and a line may have many arguments: a column is counted from the one before.
    """

    def __init__(self, source: Source) -> None:
        self._source = source
        self._line = 0
        self._offset = 0
        self._column = 1

    def at(self, offset: int) -> Position:
        """Return the position of an offset."""
        at = self._source.at(offset)
        start = offset - at.column + 1
        if self._line != at.line or offset < self._offset:
            self._line = at.line
            self._offset = start
            self._column = 1
        between = self._source.text[self._offset : offset]
        self._column += len(between.encode("utf-8", "surrogateescape"))
        self._offset = offset
        return Position(at.line, self._column)


def all_commands(commands: Iterable[Command]) -> Iterator[Command]:
    """Yield commands with those in their blocks."""
    for command in commands:
        yield command
        yield from all_commands(chain(command.body, *(other.body for other in command.others)))
