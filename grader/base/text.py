"""Text for people: printable names and paths, lists, counts, points."""

import os
import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from decimal import Decimal
from functools import lru_cache
from pathlib import Path
from typing import Any

from grader.base.grouping import Span
from grader.base.patterns import on_use

# Characters that XML 1.0 does not allow, not even as a reference; bytes that are not UTF-8 are
# surrogates here.
ILLEGAL = on_use("[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]")
# The runner of GitHub Actions treats a line as a command if it begins with `::`, after white space
# as well, or contains `##[`; the agent of Azure Pipelines, if it contains `##vso[`.
_LINE_COMMAND = on_use(r"^([^\S\n]*+):(?=:)", re.MULTILINE)
_TAG_COMMAND = on_use(r"##(vso)?\[", re.IGNORECASE)
_MAX_NAME = 60  # characters of a name that are shown
_MAX_FILE_NAME = 100  # characters of a path that are shown, its last ones
MAX_NAMED = 5  # names that a message lists, where nothing asks for more or fewer
MAX_PEOPLE = 12  # whom a line lists


def first_part(name: str) -> str:
    """Return what is before the first dot of a name."""
    return name.partition(".")[0]


def last_part(name: str) -> str:
    """Return what is behind the last dot of a name."""
    return name.rpartition(".")[2]


def blanked(match: re.Match[str]) -> str:
    """Return as many spaces as a match has characters."""
    return " " * len(match[0])


def indent_of(line: str) -> str:
    """Return the space at the beginning of a line."""
    return line[: len(line) - len(line.lstrip())]


def printable(text: str) -> str:
    """Return a text with escapes for all but visible characters and plain spaces.

    A tab becomes a space.

    These are control characters, bidirectional marks, other spaces, and bytes that are not UTF-8.
    """
    if text.isprintable():
        return text
    return "".join(
        character if character.isprintable() else _escape(character) for character in text
    )


def without_commands(text: str) -> str:
    """Return a text with a space wherever the runner of a CI system would see a command.

    A command is a line that the runner treats as one.
    """
    return without_tag_commands(_LINE_COMMAND.sub(r"\1: ", text))


def without_tag_commands(text: str, bracket: str = " [") -> str:
    """Return a text with another bracket in the commands that may be anywhere in a line.

    Such a command begins with ##vso[.
    """
    return _TAG_COMMAND.sub(lambda match: match[0][:-1] + bracket, text)


def _escape(character: str) -> str:
    if character == "\t":
        return " "
    code = ord(character)
    if 0xDC80 <= code <= 0xDCFF:  # a byte that is not UTF-8, as Python decodes it
        return f"\\x{code - 0xDC00:02x}"
    if code < 0x100:
        return f"\\x{code:02x}"
    return f"\\u{code:04x}"


def printable_path(path: Path | str) -> str:
    """Return a path for a message.

    Bytes that are not UTF-8 are replaced, control characters escaped.
    """
    text = os.fsencode(path).decode("utf-8", "replace")
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() else f"\\x{ord(c):02x}" for c in text)


def shell_quoted(path: Path | str) -> str:
    """Return a path as a word of a command that a message suggests.

    It has quotes where a shell needs them.
    """
    from shlex import quote  # late: most messages suggest no command

    return quote(printable_path(path))


def quoted_end(path: str) -> str:
    """Return a path between quotes; only the end of one that is very long."""
    return repr(path if len(path) <= _MAX_FILE_NAME else f"...{path[3 - _MAX_FILE_NAME :]}")


def quoted(name: str) -> str:
    """Return a name between quotes, cut if it is very long."""
    return repr(cut(name, _MAX_NAME))


def cut(text: str, most: int) -> str:
    """Return a text of at most so many characters.

    If it was longer, the last three of them are points.
    """
    if len(text) <= most:
        return text
    return f"{text[: most - 3]}..."


def named(key: str, name: str) -> str:
    """Return a student's name with the key, or the key alone: "Jane Doe (12280)"."""
    if name not in ("", key):
        return f"{name} ({key})"
    return key


def capitalised(text: str) -> str:
    """Return a text with a capital, unless it begins with a quote, a file or an attribute.

    An attribute is such as xyz="0 0".
    """
    if text.split(" ", 1)[0].isalpha():
        return text[:1].upper() + text[1:]
    return text


def sentence_end(text: str) -> str:
    """Return a text with the point that ends a sentence, unless a question ends it."""
    return text if text.endswith(("?", ".")) else f"{text}."


def in_backticks(texts: Iterable[str]) -> str:
    """Return texts of a file for a sentence: `a` and `b`; empty without one that can be read."""
    shown = [" ".join(text.split()) for text in texts]
    quotes = [f"`{cut(text, _MAX_NAME)}`" for text in dict.fromkeys(shown) if text]
    return enumerated(quotes, MAX_NAMED)


def enumerated(
    items: Iterable[str], most: int | None = None, word: str = "and", separator: str = ", "
) -> str:
    """Return "a, b and c"; of more than `most` items the first ones: "a, b and 3 more"."""
    names = list(items)
    if most is not None and len(names) > most:
        names[most:] = [f"{len(names) - most} more"]
    *first, last = names or [""]
    if first:
        return f"{separator.join(first)} {word} {last}"
    return last


def sentence(message: str) -> str:
    """Return a message as a printable sentence, with a capital and a full stop."""
    text = capitalised(printable(message))
    if text.endswith((".", "?")):
        return text
    return f"{text}."


def in_quotes(names: Iterable[str]) -> str:
    """Return "'a', 'b' and 'c'"."""
    return enumerated([repr(name) for name in names])


def people_text(names: Collection[str], most: int = MAX_PEOPLE) -> str:
    """Return the names of people like `enumerated`: "Doe, Jane; Roe, Al and 3 more"."""
    return enumerated(names, most, separator="; " if any(", " in name for name in names) else ", ")


def first_lines(lines: Sequence[str], most: int) -> list[str]:
    """Return the lines; of more than `most` the first ones, and a line "... and 3 more"."""
    if len(lines) <= most:
        return list(lines)
    return [*lines[:most], f"... and {len(lines) - most} more"]


def counted(number: int, noun: str, plural: str = "") -> str:
    """Return a number with its noun: "1 file", "2 files", "2 entries"."""
    if number == 1:
        return f"{number} {noun}"
    return f"{number} {plural or noun + 's'}"


@lru_cache(maxsize=1024)
def format_points(points: Decimal) -> str:
    """Return exact points, without trailing zeros: 58.5, 70."""
    return format(points.normalize(), "f") if points else "0"


def counted_points(points: Decimal) -> str:
    """Return points with their noun: 1 point, 58.5 points."""
    return f"{format_points(points)} point{'' if points == 1 else 's'}"


def by_name(name: str) -> str:
    """Return who did something, for the end of a sentence: " by Kim"; empty without a name."""
    return f" by {name}" if name else ""


def signed_points(points: Decimal) -> str:
    """Return a change of points with its sign: +6, -0.5."""
    return f"{'+' if points >= 0 else '-'}{format_points(abs(points))}"


def size_text(size: int) -> str:
    """Return a number of bytes for people: 32 MiB, or 1500 bytes where no larger unit fits."""
    for unit, factor in (("GiB", 1 << 30), ("MiB", 1 << 20), ("KiB", 1 << 10)):
        if size >= factor and size % factor == 0:
            return f"{size // factor} {unit}"
    return f"{size} bytes"


def was_not_committed(path: str) -> str:
    """Return the end of a message on a missing file that a build has copied to a path."""
    return f"; a build contains {path}: was the source not committed?"


def texts_in(value: Any) -> Iterator[str]:
    """Yield a text, or the texts in a list or in the values of a table."""
    match value:
        case str():
            yield value
        case list() | tuple():
            for item in value:
                yield from texts_in(item)
        case Mapping():
            yield from texts_in(list(value.values()))


def comment_spans(text: str) -> Iterator[Span]:
    """Yield the offsets at which each comment begins, and at which its `-->` does."""
    start = text.find("<!--")
    while start >= 0 and (end := text.find("-->", start + 4)) >= 0:
        yield start, end
        start = text.find("<!--", end)
