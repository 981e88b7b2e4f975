"""Text that Markdown shows as it is: escaped, as code, as a code block."""

import re
from collections.abc import Sequence

from grader.base.patterns import on_use

_HTML = {"<": "&lt;", ">": "&gt;", "&": "&amp;"}
_ACTIVE = on_use(
    r"[\\`*\[\]<>&|~$#]|(?<![^\W_])_|_(?![^\W_])"  # an underscore inside a word is plain text
    # GitHub makes links of bare addresses
    r"|(?<=http):(?=//)|(?<=https):(?=//)|(?<=ftp):(?=//)|(?<=www)\.",
    re.IGNORECASE,
)
_OPENING = on_use(r"^([-+=]|\d+[.)](?= |$))")  # a list, rule or heading at the start of a line
# GitHub looks for mentions and issue numbers after it has rendered Markdown, so escapes do not
# prevent them.
MENTION = on_use(r"@|#(?=\d)")
_FENCE = on_use(r"`{3,}")
# backticks: GitHub's parser takes no more to start code, and counts those of a block to 255
_MAX_FENCE = 80


def escape(text: str) -> str:
    """Return one line of printable text that Markdown shows as it is."""
    plain = _ACTIVE.sub(lambda match: _HTML.get(match[0]) or f"\\{match[0]}", text.strip())
    plain = _OPENING.sub(lambda match: f"{match[0][:-1]}\\{match[0][-1]}", plain)
    return MENTION.sub("\\g<0>\u2060", plain)


def escape_words(text: str) -> str:
    """Return one line of printable text in which what is between backticks is code."""
    parts = text.strip().split("`")
    if len(parts) % 2 == 0 or "``" in text:
        return escape(text)
    return "".join(
        code(part) if number % 2 else _keep_spaces(part) for number, part in enumerate(parts)
    )


def _keep_spaces(text: str) -> str:
    """Return escaped text with the spaces around it."""
    inner = text.strip(" ")
    if inner:
        return text.replace(inner, escape(inner))
    return text


def code(text: str) -> str:
    """Return printable text as inline code; as plain text if it has too many backticks."""
    longest = max((len(match[0]) for match in re.finditer(r"`+", text)), default=0)
    if longest >= _MAX_FENCE:
        return escape(text)
    fence = "`" * (longest + 1)
    space = " " if not text or text[0] in "` " or text[-1] in "` " else ""
    return f"{fence}{space}{text}{space}{fence}"


def fence(lines: Sequence[str], language: str = "text") -> str:
    """Return printable lines, none of them blank, as a code block that nothing in them can end."""
    fence = "`" * max(
        (len(match[0]) + 1 for line in lines for match in _FENCE.finditer(line)), default=3
    )
    if len(fence) > _MAX_FENCE:
        return "\n".join(f"    {line}" for line in lines)
    return "\n".join((f"{fence}{language}", *lines, fence))
