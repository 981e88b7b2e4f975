"""Written answers as plain text: Markdown without the signs of headings, bold text, code and links."""

import re
from functools import reduce

_FENCE = r"\s*(?:```|~~~)[\w-]*\s*$"
# What is certain to be Markdown: "> 5 mm", a[i](j), **/*.urdf and a rule of dashes are not.
_SIGNS = (
    (r"^ {0,3}#{1,6}(?:\s+|(?<=##)(?=\w))", ""),
    (r"\*\*(?=[^\s*/])([^*]{1,500}?)(?<=[^\s*/])\*\*", r"\1"),
    (r"(?<!`)`([^`]{1,500})`(?!`)", r"\1"),
    (r"!\[([^\[\]]{0,500})\]\([^()\s]{1,500}\)", r"[picture: \1]"),
    (r"\[([^\[\]]{1,500})\]\((https?://[^()\s]{1,500})\)", r"\1 (\2)"),
)


def plain_lines(markdown: str) -> list[str]:
    """Return the lines of a text without these signs, except in code, and without empty lines around."""
    lines: list[str] = []
    is_code = False
    for line in markdown.splitlines():
        if re.match(_FENCE, line):
            is_code = not is_code
            continue
        plain = reduce(lambda text, sign: re.sub(sign[0], sign[1], text), () if is_code else _SIGNS, line)
        lines.append(plain.rstrip())
    return "\n".join(lines).strip("\n").split("\n") if any(lines) else []
