"""Commands in a launch file: the words of a command line, and the file that xacro or cat reads."""

import re
import shlex

PART_UNKNOWN = "\0"  # stands in a command for a part that is unknown
_NO_SPACE = re.compile(r"(xacro|cat)(?=/)")


def file_read(command: str, errors: list[str]) -> tuple[str, str]:
    """Return the program, xacro or cat, of a command and the file that it reads, or empty strings; errors are added."""
    if glued := _NO_SPACE.match(command):
        errors.append(f"a space is missing between {glued[1]} and the path: write '{glued[1]} '")
        command = f"{glued[1]} {command[glued.end() :]}"
    try:
        words = shlex.split(command)
    except ValueError:
        errors.append("the quotes in this command are not closed")
        return "", ""
    if words[:3] == ["ros2", "run", "xacro"]:
        words = words[3:]
    program = words[0].rpartition("/")[2].removesuffix(".py") if words else ""
    files = [word for word in words[1:] if not word.startswith("-") and ":=" not in word]
    if program not in ("xacro", "cat", "type") or "-o" in words or len(files) != 1 or PART_UNKNOWN in files[0]:
        return "", ""
    return ("xacro" if program == "xacro" else "cat"), files[0]


def split_words(text: str, errors: list[str]) -> list[str]:
    """Return the words of a piece of a command line; what is wrong with its quotes is added to `errors`."""
    try:
        return shlex.split(text)
    except ValueError:
        errors.append("quotes cannot enclose a substitution in a line of arguments: remove them")
        return text.replace("'", " ").replace('"', " ").split()


def display_config(words: list[str]) -> str | None:
    """Return the file that the arguments of rviz2 name with -d; None without -d."""
    for index, word in enumerate(words):
        if word in ("-d", "--display-config"):
            return "".join(words[index + 1 : index + 2])
        if word.startswith("--display-config="):
            return word.partition("=")[2]
        if word.startswith("-d"):
            return word[2:].removeprefix("=")
    return None
