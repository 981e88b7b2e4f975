"""Written answers as plain text, without the signs of Markdown."""

import re

_FENCE = re.compile(r"\s*(?:```[^`]*|~~~.*)$")
_SIGNS = tuple(
    (re.compile(pattern), plain)
    for pattern, plain in (
        (r"^ {0,3}(?:> ?)+", ""),
        (r"^ {0,3}(?:#{1,6}(?:\s+|$)|#{2,6}(?=\w))|(?<=\s)#+\s*$", ""),
        (r"^\s*([-*_=])(?:\s*\1){2,}\s*$", ""),  # a rule
        # Bounded, because a text of 32,000 characters may be full of signs without a partner.
        (r"(?<![\w*\\])(\*{1,3})(?=[^\s*])(.{1,500}?)(?<=[^\s*\\])\1(?![\w*])", r"\2"),
        (r"!\[([^\[\]]{0,500})\]\([^()\s]*\)", r"[picture: \1]"),
        (r"\[([^\[\]]{1,500})\]\(([^()\s]+)\)", r"\1 (\2)"),
        (r"(?<!`)(`{1,2})(?!`)(.{1,500}?)(?<!`)\1(?!`)", r"\2"),
        (r"\\([-\\`*_{}\[\]()#+.!<>|~])", r"\1"),
    )
)


def plain_lines(markdown: str) -> list[str]:
    """Return the lines of a text without the signs of Markdown, except in code, and without empty lines around."""
    lines: list[str] = []
    is_code = False
    for line in markdown.splitlines():
        if _FENCE.match(line):
            is_code = not is_code
        else:
            lines.append(line if is_code else _plain(line))
    return "\n".join(lines).strip("\n").split("\n") if any(lines) else []


def _plain(line: str) -> str:
    for sign, plain in _SIGNS:
        line = sign.sub(plain, line)
    return line.rstrip()
