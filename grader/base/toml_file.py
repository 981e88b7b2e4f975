"""Read a TOML file and its tables; all mistakes in it are one error, each with its line.

tomli does not report the lines of keys, so a mistake in a value is collected with the path of its
key, and the lines are found in the text. Values are converted by the type of their key.
"""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from decimal import Decimal
from itertools import starmap
from pathlib import Path
from typing import Any

import tomli

from grader.base.errors import RubricError
from grader.base.grouping import Strings, group_values
from grader.base.names import did_you_mean
from grader.base.patterns import on_use
from grader.base.records import Named
from grader.base.text import cut, enumerated, printable, printable_path
from grader.base.toml_types import TomlType, WrongValue, simple_type

TomlPath = tuple[str | int, ...]
_Lines = dict[TomlPath, int]  # of keys by their paths
TomlRow = dict[str, Any]
_NOTHING: Mapping[str, Any] = {}


# keys in a path: no rubric nests deeper, and the paths of a deeper key grow with its square
_MAX_DEPTH = 20

_TOKEN = r"""(?sx)
      "{3}(?:\\.|[^\\])*?"{3}(?!")      # several lines; the last three of five quotes close it
    | '{3}.*?'{3}(?!')                # the same, without escapes
    | "(?:\\.|[^"\\\n])*"             # "30\" wide"
    | '[^'\n]*'                       # 'C:\labs'
    | \#[^\n]*                        # a comment, which may hold quotes and brackets
    | [\[\]{}\n=.]
    | [^\s"'\#\[\]{}=.]+              # a bare key, a number, or a boolean: points, 12, true
    | [ \t\r]+
    """
# tomli stores each beginning of a dotted key: memory that grows with the square of its parts.
_LONG_KEY = on_use(
    r"""(?m)(?:^|[\[{,])[ \t]*+"""
    r"""((?:(?:[\w-]++|"(?:[^"\\\n]|\\.)*+"|'[^'\n]*+')[ \t]*+\.[ \t]*+)"""
    rf"""{{{_MAX_DEPTH}}})"""
)
_MAX_COMPLAINTS, _MAX_PLACES = 1000, 6  # lines about one file; places of one mistake
_MAX_WIDTH = 100  # characters of a line that are shown on each side of a mistake
_PLACE = r" \(at (?:line (\d+), column (\d+)|end of document)\)$"
_CLOSING = {
    "Unterminated string": '"""',
    'Expected "\'"': "'",
    "Expected \"'''\"": "'''",
}  # what an error misses
_HERE = "\0"  # where an error is, in a line that has no such character
_TWICE = "this table is already given above"
_SAID = {
    "Cannot overwrite a value": "this key is given twice",
    "Cannot declare": _TWICE,
    "Cannot mutate": _TWICE,
}
# What usually is wrong where TOML cannot be read: a pattern of the line, in which \0 is the place
# of the error.
_SLIPS = (
    ("\0[“”„‟‘’«]|[“”„‟]\\s*\0$", "typographic quotes: write straight ones"),
    (r"""^[^"']*("[^"\\]*|'[^']*)\0$""", "a text in quotes does not end on its line"),
    (r'"""\0\S', 'these quotes end a text that begins above: one before does not end in """'),
    (r'"\0\w', r"quotes in a text: write \" for them, or single quotes around it"),
    (
        r"\{[^}]*\0$",
        "a table in braces is one line: write [criterion.with] above, and each key on a line below",
    ),
    ("\0(True|False)", "true and false have small letters"),
    (r"\d\0,\d", "a number has a decimal point, no comma"),
    (r"\\.\0", r"in double quotes, \ begins an escape: write / in a path"),
    (r"^\s*\[(part|criterion|evidence)\0?\]", "write double brackets: [[{0}]]"),
    (
        r"^\s*\[\[(part|criterion|evidence)\0\]\]",
        "an earlier [{0}] has single brackets: write [[{0}]]",
    ),
)
_MAX_GUESSES = 50  # searches for a similar name in one rubric: each takes its time
_MAX_SHOWN = 40  # characters of a value
_MAX_BITS = 1000  # of a whole number that is written out
_BARE_KEY = on_use(r"[A-Za-z0-9_-]+")


def read_toml(data: bytes, path: Path) -> tuple[str, dict[str, Any]]:
    """Return the text and the table of a TOML file; raise RubricError."""
    shown = printable_path(path)
    try:
        text = data.decode().removeprefix("\ufeff")
        if match := _LONG_KEY.search(text):
            line = text.count("\n", 0, match.start(1)) + 1
            raise RubricError((f"{shown}:{line}: a key has more than {_MAX_DEPTH} parts",))
        return text, tomli.loads(text, parse_float=Decimal)
    except UnicodeDecodeError as error:
        raise RubricError((f"{shown}{_why_not_utf8(data, error.start)}",)) from None
    except tomli.TOMLDecodeError as error:
        raise RubricError((f"{shown}:{_syntax_mistake(str(error), text)}",)) from None
    except RecursionError:
        raise RubricError((f"{shown}: lists or tables are nested too deeply",)) from None
    except (ValueError, ArithmeticError):
        raise RubricError((f"{shown}: a number has too many digits",)) from None


def raise_complaints(complaints: Sequence[tuple[TomlPath, str]], text: str, path: Path) -> None:
    """Raise RubricError with a line for each complaint, if there are any.

    The lines are in the order of the file.
    """
    if complaints:
        lines = key_lines(text)
        shown = printable_path(path)
        complaints_by_line = one_line_each(
            path, [(find_line(lines, at), what) for at, what in complaints]
        )
        more = len(complaints_by_line) - _MAX_COMPLAINTS
        rest = (f"{shown}: {more} more mistakes are not listed",) if more > 0 else ()
        raise RubricError((*complaints_by_line[:_MAX_COMPLAINTS], *rest))


def one_line_each(path: Path, complaints: Iterable[tuple[int, str]]) -> list[str]:
    """Return complaints about a file by its lines.

    What several lines share stands there once, with all of them.
    """
    places = group_values(
        (what, line) for line, what in sorted(complaints, key=lambda complaint: complaint[0])
    )
    return [
        f"{printable_path(path)}:{line}: {what}{_also(other)}"
        for what, (line, *other) in places.items()
    ]


def _also(lines: Sequence[int]) -> str:
    """Return the other lines of the same mistake, as a clause."""
    numbers = [str(line) for line in dict.fromkeys(lines)]
    if numbers:
        return f" (also line{'s' if len(numbers) > 1 else ''} {enumerated(numbers, _MAX_PLACES)})"
    return ""


def _syntax_mistake(error: str, text: str) -> str:
    """Return the place of the mistake that a message of tomli is about.

    Also return what it means, and the line.
    """
    text = text.replace("\r\n", "\n")
    lines = text.split("\n")
    said, line, column, _ = re.split(_PLACE, error)
    row, at = (int(line), int(column)) if line else (len(lines), len(lines[-1]) + 1)
    # Else the place stays; a file that is not UTF-8 text may have the character of no text.
    opened = text.rfind(_CLOSING.get(said, _HERE))
    if opened >= 0:
        row = text.count("\n", 0, opened) + 1
        at = opened - text.rfind("\n", 0, opened)
        said = "a text in quotes begins here and does not end"
    for start, words in _SAID.items():
        if said.startswith(start):
            said = words
            break
    before = lines[row - 1][max(0, at - _MAX_WIDTH) : at - 1]
    after = lines[row - 1][at - 1 : at + _MAX_WIDTH]
    # The patterns of slips name the place by a character that the text does not have.
    marked = f"{before.replace(_HERE, ' ')}{_HERE}{after.replace(_HERE, ' ')}"
    meant = said[0].lower() + said[1:]
    for pattern, words in _SLIPS:
        slip = re.search(pattern, marked)
        if slip:
            meant = words.format(*slip.groups())
            break
    around = (before + after).strip() or "an empty line"
    return f"{row}:{at}: {meant}: {printable(around)}"


def _why_not_utf8(data: bytes, at: int) -> str:
    """Return why bytes are not UTF-8 text, after a line if that is known."""
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        return ": this is UTF-16 text; save it as UTF-8"
    line = data.count(b"\n", 0, at) + 1
    return f":{line}: this is not UTF-8 text; save it as UTF-8"


def key_lines(text: str) -> _Lines:
    """Return the line of every table header and key of a valid TOML text, by its path.

    Arrays count from 0.
    """
    lines: _Lines = {(): 1}
    for line, path in _statement_paths(text):
        for length in range(len(path)):
            lines.setdefault(path[: length + 1], line)
    return lines


def _statement_paths(text: str) -> Iterator[tuple[int, TomlPath]]:
    """Yield the line and the path of every table header and key."""
    counts: _Lines = {}
    table: TomlPath = ()
    for line, tokens in _split_statements(text):
        if tokens[0] == "[":
            is_array = tokens[1] == "["
            table = _table_path(
                _key_names(tokens[1 + is_array : tokens.index("]")]), counts, is_array=is_array
            )
            yield line, table
        else:
            yield line, (*table, *_key_names(tokens[: tokens.index("=")]))


def _table_path(names: list[str], counts: _Lines, *, is_array: bool) -> TomlPath:
    """Return the path of a header's table; in an array of tables it is in the last table so far."""
    path: TomlPath = ()
    for index, name in enumerate(names):
        path = (*path, name)
        if is_array and index == len(names) - 1:
            counts[path] = counts.get(path, -1) + 1
        if path in counts:
            path = (*path, counts[path])
    return path


def find_line(lines: _Lines, path: TomlPath) -> int:
    """Return the line of a path, or of the innermost table around it that has one."""
    while path not in lines:
        path = path[:-1]
    return lines[path]


def _split_statements(text: str) -> list[tuple[int, list[str]]]:
    """Return each header and key with its value as tokens, and the line on which it begins."""
    statements = []
    line = 1
    depth = 0
    current: list[str] = []
    for match in re.finditer(_TOKEN, text):
        token = match[0]
        if token == "\n" and depth == 0:
            current = []
        elif token.strip() and not token.startswith("#"):
            if not current:
                statements.append((line, current))
            current.append(token)
            depth += (token in ("[", "{")) - (token in ("]", "}"))
        line += token.count("\n")
    return statements


def _key_names(tokens: list[str]) -> list[str]:
    """Return the keys that tokens stand for, quoted ones without their quotes."""
    names = [token for token in tokens if token != "."][:_MAX_DEPTH]
    return [
        next(iter(tomli.loads(f"{token}=0"))) if token[0] in "\"'" else token for token in names
    ]


_NOUNS = {  # tables that are not called by their names
    "adjustment": "an adjustment",
    "evidence": "an evidence entry",
}


class KeyTable(Named):
    """A table of a TOML file: what one is called, and its keys."""

    name: str
    keys: Mapping[str, TomlType]
    required: Strings = ()

    @property
    def schema(self) -> dict[str, Any]:
        """The JSON Schema of the table."""
        return {
            "type": "object",
            "properties": {key: dict(value.schema) for key, value in self.keys.items()},
            "required": list(self.required),
            "additionalProperties": False,
        }

    @property
    def rows(self) -> TomlType:
        """The type of several such tables."""
        schema = {"type": "array", "items": self.schema, "minItems": 1}
        return simple_type(f"one or more [[{self.name}]] tables", schema, _are_tables)

    @property
    def one_or_more(self) -> TomlType:
        """The type of one such table, or several."""
        schema = {**self.schema, **self.rows.schema, "type": ["object", "array"]}
        return simple_type(
            "a table, or several",
            schema,
            lambda value: isinstance(value, dict) or _are_tables(value),
        )


def _are_tables(value: Any) -> bool:
    return isinstance(value, list) and value != [] and all(isinstance(item, dict) for item in value)


class TomlRowReader:
    """Reads tables; `complaints` are the mistakes so far."""

    def __init__(self) -> None:
        self.complaints: list[tuple[TomlPath, str]] = []
        self._guesses = _MAX_GUESSES

    def row(
        self, where: TomlPath, row: TomlRow, table: KeyTable, defaults: Mapping[str, Any] = _NOTHING
    ) -> TomlRow:
        """Return the valid values of a table, converted.

        Complains of the others and of missing ones.
        """
        parsed = {**defaults}
        for key, value in row.items():
            if key not in table.keys:
                hint = self.guess(key, table.keys) or f"; it has: {', '.join(table.keys)}"
                noun = _NOUNS.get(table.name, f"a {table.name}")
                self.complain((*where, key), f"{noun} has no key {key!r}{hint}")
                continue
            try:
                parsed[key] = table.keys[key].parse(value)
            except WrongValue as error:
                self.complain((*where, key), f"{key} must be {error}, not {shorten_value(value)}")
        below = row.get("with")
        for key in table.required:
            is_below = isinstance(below, dict) and key in below  # which is a mistake of its own
            if key not in row and key not in defaults and not is_below:
                self.complain(where, f"this {table.name} has no {key}")
        return parsed

    def guess(self, name: str, known: Iterable[str]) -> str:
        """Return which known name a misspelt one may mean, as a clause.

        It is empty if none is similar.
        """
        self._guesses -= 1
        if self._guesses >= 0:
            return did_you_mean(name, known)
        return ""

    def complain(self, where: TomlPath, message: str) -> None:
        """Add a mistake in the value of a key."""
        self.complaints.append((where, message))


def shorten_value(value: Any) -> str:
    """Return a value of TOML in a few characters."""
    return cut(toml_literal(value), _MAX_SHOWN)


def toml_literal(value: Any) -> str:
    """Return a value as TOML, in one line."""
    match value:
        case bool():
            text = str(value).lower()
        case float():
            text = repr(value)
            text = f"{value:.15f}".rstrip("0") if "e" in text and 1e-15 < abs(value) < 1 else text
        case str():
            import json  # late: for a rubric with a mistake, or a new one

            text = json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
        case Mapping():
            text = f"{{ {', '.join(starmap(assignment, value.items()))} }}" if value else "{}"
        case list() | tuple():
            text = f"[{', '.join(map(toml_literal, value))}]"
        case int() if (
            value.bit_length() > _MAX_BITS
        ):  # Python refuses to write numbers of thousands of digits
            text = "a number with too many digits"
        case _:
            text = str(value)
    return text


def assignment(key: str, value: Any) -> str:
    """Return a line that sets a key."""
    return f"{key if _BARE_KEY.fullmatch(key) else toml_literal(key)} = {toml_literal(value)}"
