"""The file that a command of a launch file prints, for xacro and cat; and how Python opens one."""

import re
import shlex
from collections.abc import Sequence

from grader.package.launch.model import Contents, Context, Resolved
from grader.static_python.parse import Position
from grader.static_python.values import MAX_TEXT, Call, Unknown

PART_UNKNOWN = "\0"  # stands in a command for a part that is unknown


def command_output(texts: Sequence[Resolved], context: Context, at: Position) -> Resolved:
    """Return the contents of the file that a command prints, whose parts have these texts."""
    command = "".join(text if isinstance(text, str) else PART_UNKNOWN for text in texts).strip()[:MAX_TEXT]
    unknown = [text for text in texts if isinstance(text, Unknown)]
    if glued := re.match(r"(xacro|cat)(?=/)", command):
        message = f"a space is missing between {glued[1]} and the path: write '{glued[1]} '"
        context.add_error(message, at)
        unknown.insert(0, Unknown(message, at))
        command = f"{glued[1]} {command[glued.end() :]}"
    try:
        words = shlex.split(command)
    except ValueError:
        message = "the quotes in this command are not closed"
        context.add_error(message, at)
        return Unknown(message, at)
    unknown.append(Unknown("the output of this command is known only at run time", at))
    return _file_of(words[3:] if words[:3] == ["ros2", "run", "xacro"] else words) or unknown[0]


def _file_of(words: list[str]) -> Contents | None:
    """Return the contents of the one file that xacro or cat prints; None for any other command."""
    program = words[0].rpartition("/")[2].removesuffix(".py") if words else ""
    files = [word for word in words[1:] if not word.startswith("-") and ":=" not in word]
    if program not in ("xacro", "cat", "type") or "-o" in words or len(files) != 1:
        return None
    if not files[0] or PART_UNKNOWN in files[0]:
        return None
    if program != "xacro":
        return Contents(files[0], "cat")
    given = (word.split(":=", 1) for word in words[1:] if ":=" in word)
    return Contents(files[0], "xacro", tuple((name, None if PART_UNKNOWN in it else it) for name, it in given))


def opened_by(call: Call) -> str:
    """Return how a call of open, or of codecs.open, reads a file: "open" if as UTF-8, strictly, else "decode"."""
    position = 2 if call.name.startswith("codecs.") else 3
    mode, encoding, errors = (
        call.argument(1, "mode"),
        call.argument(position, "encoding"),
        call.argument(position + 1, "errors"),
    )
    is_utf8 = encoding is None or str(encoding).lower().replace("_", "-") in ("utf-8", "utf8")
    return "open" if is_utf8 and errors in (None, "strict") and "b" not in str(mode) else "decode"
