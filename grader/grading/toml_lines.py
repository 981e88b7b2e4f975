"""The line of every key of a TOML file, which tomllib does not report."""

import re
import tomllib
from collections.abc import Iterator

Path = tuple[str | int, ...]

_MAX_DEPTH = 20  # keys in a path: no rubric nests deeper, and the paths of a deeper key grow with its square

_TOKEN = re.compile(
    r'''"""(?:\\.|[^\\])*?"""(?!")|\'\'\'.*?\'\'\'(?!\')|"(?:\\.|[^"\\\n])*"|'[^'\n]*'|\#[^\n]*|[\[\]{}\n=.]|[^\s"'\#\[\]{}=.]+|[ \t\r]+''',
    re.DOTALL,
)


def key_lines(text: str) -> dict[Path, int]:
    """Return the line of every table header and key of a valid TOML text, by its path; arrays count from 0."""
    lines: dict[Path, int] = {(): 1}
    for line, path in _statement_paths(text):
        for length in range(len(path)):
            lines.setdefault(path[: length + 1], line)
    return lines


def _statement_paths(text: str) -> Iterator[tuple[int, Path]]:
    """Yield the line and the path of every table header and key."""
    counts: dict[Path, int] = {}
    table: Path = ()
    for line, tokens in _statements(text):
        if tokens[0] == "[":
            is_array = tokens[1] == "["
            table = _table(_names(tokens[1 + is_array : tokens.index("]")]), counts, is_array=is_array)
            yield line, table
        else:
            yield line, (*table, *_names(tokens[: tokens.index("=")]))


def _table(names: list[str], counts: dict[Path, int], *, is_array: bool) -> Path:
    """Return the path of a header's table; in an array of tables it is in the last table so far."""
    path: Path = ()
    for index, name in enumerate(names):
        path = (*path, name)
        if is_array and index == len(names) - 1:
            counts[path] = counts.get(path, -1) + 1
        if path in counts:
            path = (*path, counts[path])
    return path


def line_of(lines: dict[Path, int], path: Path) -> int:
    """Return the line of a path, or of the innermost table around it that has one."""
    while path not in lines:
        path = path[:-1]
    return lines[path]


def _statements(text: str) -> list[tuple[int, list[str]]]:
    """Return each header and key with its value as tokens, and the line on which it begins."""
    statements: list[tuple[int, list[str]]] = []
    line, depth = 1, 0
    current: list[str] = []
    for match in _TOKEN.finditer(text):
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


def _names(tokens: list[str]) -> list[str]:
    """Return the keys that tokens stand for, quoted ones without their quotes."""
    names = [token for token in tokens if token != "."][:_MAX_DEPTH]
    return [next(iter(tomllib.loads(f"{token}=0"))) if token[0] in "\"'" else token for token in names]
