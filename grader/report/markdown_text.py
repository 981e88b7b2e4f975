"""Printable text in Markdown (CommonMark, and as GitHub reads it): escaped, as code, or in a folded block."""

import html
import re

_HTML = {"<": "&lt;", ">": "&gt;", "&": "&amp;"}
_ACTIVE = re.compile(
    r"[\\`*\[\]<>&|~$#]|(?<![^\W_])_|_(?![^\W_])"  # an underscore inside a word is plain text
    r"|(?<=http):(?=//)|(?<=https):(?=//)|(?<=ftp):(?=//)|(?<=www)\.",  # GitHub makes links of bare addresses
    re.IGNORECASE,
)
_OPENING = re.compile(r"^([-+=]|\d+[.)](?= |$))")  # a list, rule or heading at the start of a line
# GitHub looks for mentions and issue numbers after it has rendered Markdown, so escapes do not prevent them.
_MENTION = re.compile(r"@|#(?=\d)")
_FENCE = re.compile(r"`{3,}")
_MAX_FENCE = 80  # backticks: GitHub's parser takes no more to start code, and counts those of a block to 255


def escaped(text: str) -> str:
    """Return one line of printable text that Markdown shows as it is."""
    plain = _ACTIVE.sub(lambda found: _HTML.get(found[0]) or f"\\{found[0]}", text.strip())
    plain = _OPENING.sub(lambda found: f"{found[0][:-1]}\\{found[0][-1]}", plain)
    return _MENTION.sub("\\g<0>\u2060", plain)


def code(text: str) -> str:
    """Return printable text as inline code; as plain text if it has too many backticks."""
    longest = max((len(found[0]) for found in re.finditer(r"`+", text)), default=0)
    if longest >= _MAX_FENCE:
        return escaped(text)
    fence = "`" * (longest + 1)
    space = " " if not text or text[0] in "` " or text[-1] in "` " else ""
    return f"{fence}{space}{text}{space}{fence}"


def fenced(lines: list[str], language: str = "text") -> str:
    """Return printable lines, none of them blank, as a code block that nothing in them can end."""
    fence = "`" * max((len(found[0]) + 1 for line in lines for found in _FENCE.finditer(line)), default=3)
    if len(fence) > _MAX_FENCE:
        return "\n".join(f"    {line}" for line in lines)
    return "\n".join((f"{fence}{language}", *lines, fence))


def folded(summary: str, lines: list[str]) -> str:
    """Return Markdown below a line of printable text that unfolds it."""
    shown = _MENTION.sub("\\g<0>\u2060", html.escape(summary))
    # CommonMark reads Markdown in HTML only after an empty line.
    return "\n".join(("<details>", f"<summary>{shown}</summary>", "", *lines, "", "</details>"))
