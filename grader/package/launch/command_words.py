"""The words of a command that a launch file starts."""

import shlex

from grader.package.launch.commands import PART_UNKNOWN
from grader.package.launch.model import Context
from grader.package.launch.substitutions import COMMAND_LINE, resolve
from grader.static_python.values import Call, Value


def command_words(value: Value, context: Context) -> list[str]:
    """Return the words of a command: each item of a list is one word, a line of XML or YAML is split."""
    words: list[str] = []
    for piece in items_in(value):
        is_line = isinstance(piece, Call) and piece.name == COMMAND_LINE
        words += _line_words(piece, context) if is_line else [_word(piece, context)]
    return words


def items_in(value: Value) -> list[Value] | tuple[Value, ...]:
    """Return the items of a value that may be a list."""
    return value if isinstance(value, list | tuple) else [value] if value is not None else []


def _word(value: Value, context: Context) -> str:
    text = resolve(value, context)
    return text if isinstance(text, str) else PART_UNKNOWN


def _line_words(line: Call, context: Context) -> list[str]:
    """Return the words of a line as launch splits it: its strings are split, the values of substitutions are not."""
    words = [""]
    for piece in line.args:
        if not isinstance(piece, str):
            words[-1] += _word(piece, context)
            continue
        try:
            found = shlex.split(piece)
        except ValueError:
            message = "quotes cannot enclose a substitution in a line of arguments: remove them"
            context.add_error(message, line.at)
            found = piece.replace("'", " ").replace('"', " ").split()
        if piece[:1].isspace() or not found:
            words.append("")
        words[-1] += "".join(found[:1])
        words += [*found[1:], *([""] if piece[-1:].isspace() else [])]
    return [word for word in words if word]
