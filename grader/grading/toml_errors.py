"""What is wrong with a text that is not TOML, where, and what to do: tomllib says little more than "Invalid value"."""

import re
import tomllib
from collections.abc import Sequence
from decimal import Decimal
from typing import NamedTuple

from grader.grading.keys import RUBRIC
from grader.grading.toml_causes import CAUSES, OPEN_STRING
from grader.grading.toml_lines import Path, statement_paths, statements
from grader.text import printable

_MAX_MISTAKES = 20
_MAX_TEXT = 200_000  # characters of a text that is read again after a mistake
_MAX_WIDTH = 200  # characters of a line that are looked at on each side of a mistake
_PLACE = re.compile(r" \(at (?:line (\d+), column (\d+)|end of document)\)$")
_KEY = re.compile(r"""^\s*((?:[\w.-]|"[^"]*"|'[^']*')+)\s*=""")
_BEGINS = re.compile(rf"{_KEY.pattern}|\s*(?:\[|#|$)")
_TWICE = ("Cannot overwrite", "Cannot declare", "Cannot mutate", "Cannot redefine")
_ROWS = [name for name, kind in RUBRIC.keys.items() if kind.schema.get("items", {}).get("type") == "object"]


class Mistake(NamedTuple):
    """A mistake, its line and column, and the line on which the key or table around it begins. All count from 1."""

    line: int
    column: int
    message: str
    start: int


def toml_mistakes(text: str) -> list[Mistake]:
    """Return the mistakes in a text that tomllib refuses; none where tomllib gives no place.

    After a mistake in a key whose value ends on the same line, the text is read again without that line.
    """
    mistakes: list[Mistake] = []
    lines = text.replace("\r\n", "\n").split("\n")
    while len(mistakes) < (_MAX_MISTAKES if len(text) <= _MAX_TEXT else 1):
        try:
            tomllib.loads("\n".join(lines), parse_float=Decimal)
        except tomllib.TOMLDecodeError as error:
            mistake = _mistake(str(error), lines)
            mistakes.append(mistake)
            if mistake.start != mistake.line or _continues(*lines[mistake.line - 1 : mistake.line + 1]):
                break
            lines[mistake.line - 1] = ""
        except (ValueError, RecursionError, ArithmeticError):
            break
        else:
            break
    return mistakes


def _continues(line: str, following: str = "") -> bool:
    """Return whether a line is anything but a key with a value that ends on this line."""
    is_open = line.count("[") != line.count("]") or line.count("{") != line.count("}")
    is_cut = is_open or '"""' in line or "'''" in line or _BEGINS.match(following) is None
    return is_cut or _KEY.match(line) is None


def _mistake(error: str, lines: Sequence[str]) -> Mistake:
    """Return the mistake that a message of tomllib is about."""
    place = _PLACE.search(error)
    kind = error[: place.start()] if place else error
    line, column = (int(number) for number in place.groups()) if place and place[1] else _end(kind, lines)
    before, after = lines[line - 1][: column - 1], lines[line - 1][column - 1 :][:_MAX_WIDTH]
    start = next((begun for begun, _ in reversed(statements("\n".join((*lines[: line - 1], before))))), line)
    twice = _twice("\n".join(lines[:line])) if kind.startswith(_TWICE) else None
    if twice is not None:
        return twice
    key = _KEY.match(lines[start - 1])
    known = {"key": key[1] if key else "the key", "start": str(start), "rest": after.strip()}
    known["code"] = f"U+{ord(after[0]):04X}" if after else ""
    message = f"{kind[0].lower()}{kind[1:]}: {lines[line - 1].strip()[:_MAX_WIDTH]}"
    for cause in CAUSES:
        words = cause.match(kind, before[-_MAX_WIDTH:], after)
        if words is not None:
            message = cause.message.format(**known | words)
            break
    return Mistake(line, column, printable(message), start)


def _end(kind: str, lines: Sequence[str]) -> tuple[int, int]:
    """Return the place of a mistake at the end of the text: of a string without an end, where it begins."""
    text = "\n".join(lines)
    at = len(text)
    if re.match(OPEN_STRING, kind):
        quote = "'" if "'" in kind else '"'
        at = text.rfind(quote * 3 if text.count(quote * 3) % 2 else quote)
    before = text[:at]
    return before.count("\n") + 1, len(before) - before.rfind("\n")


def _twice(text: str) -> Mistake | None:
    """Return the mistake that the last key or table of a text is there before; None where both are in one value."""
    *earlier, (line, path) = statement_paths(text)
    same = [number for number, other in earlier if other == path]
    around = [number for number, other in earlier if _is_below(other, path) or _is_below(path, other)]
    if not same and not around:
        return None
    first, lines = (same or around)[0], text.split("\n")
    header = lines[line - 1].strip()
    name = ".".join(step for step in path if isinstance(step, str))
    if name in _ROWS and header.startswith("["):
        wrong, other = (first, line) if header.startswith("[[") else (line, first)
        message = f"write [[{name}]] in double brackets: there are several (another is on line {other})"
        return Mistake(wrong, 1, message, wrong)
    if header.startswith("["):
        return Mistake(line, 1, f"the table [{name}] is already on line {first}: join the two", line)
    return Mistake(
        line, 1, f"the key {name.rpartition('.')[2]} is already on line {first}: remove one of the two", line
    )


def _is_below(path: Path, other: Path) -> bool:
    return len(path) > len(other) and path[: len(other)] == other
