"""Commands of a launch file that give the contents of a file: xacro and cat."""

import re
import shlex
from collections.abc import Sequence

from grader.package.launch.model import Contents, LaunchFails, NotEvaluated, Resolved
from grader.static_python.parse import Position
from grader.static_python.values import MAX_TEXT, Unknown

PART_UNKNOWN = "\0"  # stands in a command for a part that is unknown


def command_output(texts: Sequence[Resolved], at: Position) -> Contents:
    """Return the contents of the file that a command prints, whose parts have these texts. Raises LaunchSignal."""
    command = "".join(text if isinstance(text, str) else PART_UNKNOWN for text in texts).strip()[:MAX_TEXT]
    if glued := re.match(r"(xacro|cat)(?=/)", command):
        raise LaunchFails(f"a space is missing between {glued[1]} and the path: write '{glued[1]} '", at)
    try:
        words = shlex.split(command)
    except ValueError:
        raise LaunchFails("the quotes in this command are not closed", at) from None
    if not words:
        raise LaunchFails("this command is empty", at)
    found = _file_of(words[3:] if words[:3] == ["ros2", "run", "xacro"] else words)
    if found is None:
        unknown = next((text.reason for text in texts if isinstance(text, Unknown)), "")
        raise NotEvaluated(f"the output of this command is not evaluated{unknown and ': ' + unknown}", at)
    return found


def _file_of(words: list[str]) -> Contents | None:
    """Return the contents of the one file that xacro or cat prints; None for any other command."""
    program = words[0].rpartition("/")[2].removesuffix(".py") if words else ""
    files = [word for word in words[1:] if not word.startswith("-") and ":=" not in word]
    if program not in ("xacro", "cat") or "-o" in words or len(files) != 1:
        return None
    if not files[0] or PART_UNKNOWN in files[0]:
        return None
    if program != "xacro":
        return Contents(files[0], "cat") if words[1:] == files else None
    given = (word.split(":=", 1) for word in words[1:] if ":=" in word)
    return Contents(files[0], "xacro", tuple((name, None if PART_UNKNOWN in it else it) for name, it in given))
