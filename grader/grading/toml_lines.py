"""On which line a key of a TOML file stands; tomllib does not say."""

import re

Path = tuple[str | int, ...]

_TOKEN = re.compile(
    r'''"""(?:\\.|[^\\])*?"""|\'\'\'.*?\'\'\'|"(?:\\.|[^"\\\n])*"|'[^'\n]*'|\#[^\n]*|[\[\]{}\n=.]|[^\s"'\#\[\]{}=.]+|[ \t\r]+''',
    re.DOTALL,
)


def key_lines(text: str) -> dict[Path, int]:
    """The line of every table header and key of a valid TOML text, by its path; arrays of tables are counted from 0."""
    lines: dict[Path, int] = {(): 1}
    counts: dict[str, int] = {}
    table: Path = ()
    for line, tokens in _statements(text):
        if tokens[:2] == ["[", "["]:
            name = _names(tokens[2 : tokens.index("]")])
            index = counts[name[0]] = counts.get(name[0], -1) + 1
            table = (name[0], index, *name[1:])
        elif tokens[0] == "[":
            name = _names(tokens[1 : tokens.index("]")])
            table = (name[0], counts[name[0]], *name[1:]) if name[0] in counts else tuple(name)
        else:
            key = (*table, *_names(tokens[: tokens.index("=")])) if "=" in tokens else table
            lines.setdefault(key, line)
            continue
        lines.setdefault(table, line)
    return lines


def line_of(lines: dict[Path, int], path: Path) -> int:
    """The line of a path, or of the innermost table around it that has one."""
    while path not in lines:
        path = path[:-1]
    return lines[path]


def _statements(text: str) -> list[tuple[int, list[str]]]:
    """Each header and key with its value as tokens, and the line on which it begins."""
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
    return [token.strip("\"'") for token in tokens if token != "."]
