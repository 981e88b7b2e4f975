"""Text for people: names and paths made printable, lists and counts in words."""

import os
import re
from collections.abc import Collection, Sequence
from pathlib import Path

# The runner of GitHub Actions takes a line for a command that begins with `::`, whatever space is before it, or that holds
# `##[` anywhere.
_LINE_COMMAND = re.compile(r"^(\s*):(?=:)", re.MULTILINE)


_MAX_NAME = 60  # characters of a name that are shown


def printable(text: str) -> str:
    """The text with everything spelt out that is no visible character or plain space.

    That is controls and escapes, bidirectional marks, odd spaces, and bytes that are no UTF-8. A tab becomes a space.
    """
    if text.isprintable():
        return text
    return "".join(character if character.isprintable() else _spelt(character) for character in text)


def without_commands(text: str) -> str:
    """The text with a space put in wherever a CI system's runner would take a line of its log for a command."""
    return _LINE_COMMAND.sub(r"\1: ", text).replace("##[", "## [")


def _spelt(character: str) -> str:
    if character == "\t":
        return " "
    code = ord(character)
    if 0xDC80 <= code <= 0xDCFF:  # a byte that could not be decoded
        return f"\\x{code - 0xDC00:02x}"
    return f"\\x{code:02x}" if code < 0x100 else f"\\u{code:04x}"


def printable_path(path: Path | str) -> str:
    """Return a path for a message: bytes that are not UTF-8 are replaced, control characters spelt out."""
    text = os.fsencode(path).decode("utf-8", "replace")
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() else f"\\x{ord(c):02x}" for c in text)


def quoted(name: str) -> str:
    """Return a name between quotes, cut where it is very long."""
    return repr(name) if len(name) <= _MAX_NAME else repr(name[: _MAX_NAME - 3] + "...")


def enumerated(items: Collection[str], most: int | None = None, word: str = "and") -> str:
    """Return "a, b and c"; of more than `most` items the first ones: "a, b and 3 more"."""
    names = list(items)
    if most is not None and len(names) > most:
        names[most:] = [f"{len(names) - most} more"]
    *first, last = names or [""]
    return f"{', '.join(first)} {word} {last}" if first else last


def first_lines(lines: Sequence[str], most: int) -> list[str]:
    """Return the lines; of more than `most` the first ones, and a line "... and 3 more"."""
    return [*lines[:most], *([f"... and {len(lines) - most} more"] if len(lines) > most else [])]


def counted(number: int, noun: str, plural: str = "") -> str:
    """Return a number with its noun: "1 file", "2 files", "2 entries"."""
    return f"{number} {noun}" if number == 1 else f"{number} {plural or noun + 's'}"
