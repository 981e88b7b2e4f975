"""Text of a submission for Markdown: read as text wherever it is shown, never as markup, HTML, a link or a mention."""

import re

_HTML = {"<": "&lt;", ">": "&gt;", "&": "&amp;"}
_ACTIVE = re.compile(
    r"[\\`*\[\]<>&|~$#]|(?<![^\W_])_|_(?![^\W_])"  # an underscore inside a word is none of Markdown's
    r"|(?<=http):(?=//)|(?<=https):(?=//)|(?<=ftp):(?=//)|(?<=www)\.",  # GitHub makes links of bare addresses
    re.IGNORECASE,
)
_OPENING = re.compile(r"^([-+=]|\d+[.)](?= |$))")  # a list, a rule or a heading, where a line begins with it
# GitHub looks for mentions and for numbers of issues when Markdown is rendered already, so that no escape keeps them out.
_MENTION = re.compile(r"@|#(?=\d)")
_FENCE = re.compile(r"`{3,}")
_LONGEST = 80  # backticks: GitHub's parser takes no more for the beginning of code, and counts those of a block to 255


def escaped(text: str) -> str:
    """Printable text, one line of it, that Markdown shows as it is."""
    plain = _ACTIVE.sub(lambda found: _HTML.get(found[0]) or f"\\{found[0]}", text.strip())
    plain = _OPENING.sub(lambda found: f"{found[0][:-1]}\\{found[0][-1]}", plain)
    return _MENTION.sub("\\g<0>\u2060", plain)


def code(text: str) -> str:
    """Printable text as code in a line; as plain text where no parser would see where the code ends."""
    longest = max((len(found[0]) for found in re.finditer(r"`+", text)), default=0)
    if longest >= _LONGEST:
        return escaped(text)
    fence = "`" * (longest + 1)
    space = " " if not text or text[0] in "` " or text[-1] in "` " else ""
    return f"{fence}{space}{text}{space}{fence}"


def fenced(lines: list[str]) -> str:
    """Printable lines, none of them blank, as a block of code; nothing in them can end it."""
    fence = "`" * max((len(found[0]) + 1 for line in lines for found in _FENCE.finditer(line)), default=3)
    if len(fence) > _LONGEST:
        return "\n".join(f"    {line}" for line in lines)
    return "\n".join((f"{fence}text", *lines, fence))
