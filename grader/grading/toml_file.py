"""Read a TOML file, and complain of the mistakes in it: all in one error, each with its line."""

import re
import tomllib
from collections.abc import Sequence
from decimal import Decimal
from pathlib import Path
from typing import Any

from grader.errors import RubricError
from grader.grading.toml_lines import Path as TomlPath
from grader.grading.toml_lines import key_lines, line_of
from grader.text import printable, printable_path

_MAX_COMPLAINTS = 1000  # lines about one file
_MAX_WIDTH = 200  # characters of a line that are looked at on each side of a mistake
_PLACE = r" \(at (?:line (\d+), column (\d+)|end of document)\)$"
_SMART = "[“”„‟‘’‚‛«»‹›]"
# The mistakes that people make: what tomllib says, what is before and what is after the place (a line each), and what to do.
_MISTAKES = (
    # name = “lab”, or a string that begins with " and ends with ”
    (rf".*\n.*\n({_SMART})|Illegal.*\n.*({_SMART})\s*\n$", "{} is not a TOML quote: write straight quotes, \" or '"),
    (
        r"(?:Illegal|Found invalid) character '\\n'",
        'the string has no closing quote on its line: add it, or put a long string between """ and """',
    ),
    (r"Invalid value\n.*\n((?i:true|false))\b", "write true and false in lower case, not {}"),
    # name = lab, and name = lab"
    (r"Invalid value\n.*\n([^\W\d][^,\]}#\"']*?)\s*[\"']?\s*(?:[,\]}#]|$)", 'a string needs quotes: write "{}"'),
    (
        r"Unclosed array\n.*\n(\"[^\"]*\"|'[^']*'|[^\s,\]]+)",
        "a comma is missing before {}, or a list above has no closing bracket",
    ),
    (
        r"(?:Unclosed inline table|Invalid initial).*\n.*\{.*\n\s*(?:#.*)?$",
        "a table in braces must be on one line: join the lines, or write it as a [table] after the other keys",
    ),
)


def read_toml(data: bytes, path: Path) -> tuple[str, dict[str, Any]]:
    """Return the text and the table of a TOML file; raise RubricError."""
    shown = printable_path(path)
    try:
        text = data.decode().removeprefix("\ufeff")
        return text, tomllib.loads(text, parse_float=Decimal)
    except UnicodeDecodeError as error:
        raise RubricError((f"{shown}{_encoding(data, error.start)}",)) from None
    except tomllib.TOMLDecodeError as error:
        raise RubricError((f"{shown}:{_mistake(str(error), text)}",)) from None
    except RecursionError:
        raise RubricError((f"{shown}: lists or tables are nested too deeply",)) from None
    except (ValueError, ArithmeticError):
        raise RubricError((f"{shown}: a number has too many digits",)) from None


def complain_of(complaints: Sequence[tuple[TomlPath, str]], text: str, path: Path) -> None:
    """Raise RubricError with a line for each complaint, in the order of the file, if there are any."""
    if complaints:
        lines = key_lines(text)
        found = sorted((line_of(lines, where), order, what) for order, (where, what) in enumerate(complaints))
        shown, more = printable_path(path), len(found) - _MAX_COMPLAINTS
        listed = tuple(f"{shown}:{line}: {what}" for line, _, what in found[:_MAX_COMPLAINTS])
        raise RubricError((*listed, f"{shown}: {more} more mistakes are not listed") if more > 0 else listed)


def _mistake(error: str, text: str) -> str:
    """Return the place of the mistake that a message of tomllib is about, and what to do, else what tomllib says."""
    lines = text.replace("\r\n", "\n").split("\n")
    said, line, column, _ = re.split(_PLACE, error)
    row, at = (int(line), int(column) - 1) if line else (len(lines), len(lines[-1]))
    before, after = lines[row - 1][:at][-_MAX_WIDTH:], lines[row - 1][at:][:_MAX_WIDTH]
    what = f"{said[0].lower()}{said[1:]}: {(before + after).strip() or 'an empty line'}"
    for pattern, advice in _MISTAKES:
        if match := re.match(pattern, f"{said}\n{before}\n{after}"):
            what = advice.format(match[match.lastindex or 0])
            break
    return f"{row}:{at + 1}: {printable(what)}"


def _encoding(data: bytes, at: int) -> str:
    """Return why bytes are not UTF-8 text, after a line if that is known."""
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        return ": this is UTF-16 text; save it as UTF-8"
    line = data.count(b"\n", 0, at) + 1
    return f":{line}: this is not UTF-8 text; save it as UTF-8"
