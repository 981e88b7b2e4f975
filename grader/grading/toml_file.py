"""Read a TOML file, and complain of the mistakes in it: all in one error, each with its line."""

import tomllib
from collections.abc import Sequence
from decimal import Decimal
from pathlib import Path
from typing import Any

from grader.errors import RubricError
from grader.grading.toml_lines import Path as TomlPath
from grader.grading.toml_lines import key_lines, line_of
from grader.text import printable_path

_MAX_COMPLAINTS = 1000  # lines about one file


def read_toml(data: bytes, path: Path) -> tuple[str, dict[str, Any]]:
    """Return the text and the table of a TOML file; raise RubricError."""
    shown = printable_path(path)
    try:
        text = data.decode().removeprefix("\ufeff")
        return text, tomllib.loads(text, parse_float=Decimal)
    except UnicodeDecodeError as error:
        raise RubricError((f"{shown}{_encoding(data, error.start)}",)) from None
    except tomllib.TOMLDecodeError:
        from grader.grading.toml_errors import toml_mistakes  # late: most files have none

        found = toml_mistakes(text)
        raise RubricError(tuple(f"{shown}:{line}:{column}: {what}" for line, column, what, _ in found)) from None
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


def _encoding(data: bytes, at: int) -> str:
    """Return why bytes are not UTF-8 text, after a line if that is known."""
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        return ": this is UTF-16 text; save it as UTF-8"
    line = data.count(b"\n", 0, at) + 1
    return f":{line}: this is not UTF-8 text; save it as UTF-8"
