"""Workflow commands, as the runner of GitHub Actions finds them in the output of a step."""

import re
from collections.abc import Iterator, Sequence
from typing import NamedTuple

# Every command that any runner has supported, in any case.
REGISTERED = frozenset(
    {
        "add-mask",
        "add-matcher",
        "add-path",
        "debug",
        "echo",
        "endgroup",
        "error",
        "group",
        "internal-set-repo-path",
    }
    | {
        "notice",
        "remove-matcher",
        "save-state",
        "set-env",
        "set-output",
        "stop-commands",
        "warning",
    }
)
# What a runner reads as one character, in this order: an escaped percent sign last.
_DATA = (("%0D", "\r"), ("%0A", "\n"), ("%25", "%"))
_PROPERTY = (("%0D", "\r"), ("%0A", "\n"), ("%3A", ":"), ("%2C", ","), ("%25", "%"))
_OLDER = (("%3B", ";"), ("%0D", "\r"), ("%0A", "\n"), ("%5D", "]"), ("%25", "%"))
# Culture-sensitive comparisons of .NET ignore these.
_UNSEEN = re.compile(
    "[\u00ad\u034f\u061c\u180e\u200b-\u200f\u202a-\u202e\u2060-\u206f\ufe00-\ufe0f\ufeff]"
)


class Command(NamedTuple):
    """A command: its name in lower case, its properties in order, and its data, all unescaped."""

    name: str
    properties: tuple[tuple[str, str], ...]
    data: str

    def get(self, key: str) -> str | None:
        """Return a property; the last one counts if it is given twice."""
        return dict(self.properties).get(key)


def commands(log: str) -> list[Command]:
    """Return every command in a log, in both forms that a runner knows."""
    return [_command for line in re.split("\r\n|\r|\n", log) for _command in _commands(line)]


def _commands(line: str) -> Iterator[Command]:
    """Yield the command on a line, if any, by any rule that a runner has ever used."""
    for read in dict.fromkeys((line, _UNSEEN.sub("", line))):
        found = _newer(read.lstrip()) or _older(read)
        if found is not None:
            yield found
            return


def _newer(line: str) -> Command | None:
    """Return a command `::name key=value,key=value::data` at the start of a line."""
    inside, end, data = line[2:].partition("::")
    if not line.startswith("::") or not end:
        return None
    return _command(inside, ",", _PROPERTY, _unescaped(data, _DATA))


def _older(line: str) -> Command | None:
    """Return a command `##[name key=value;key=value]data` anywhere in a line."""
    _, start, rest = line.partition("##[")
    inside, end, data = rest.partition("]")
    return _command(inside, ";", _OLDER, _unescaped(data, _OLDER)) if start and end else None


def _command(
    inside: str, separator: str, escapes: Sequence[tuple[str, str]], data: str
) -> Command | None:
    name, _, listed = inside.partition(" ")
    if name.lower() not in REGISTERED:
        return None
    pairs = (item.partition("=") for item in listed.strip().split(separator))
    properties = tuple(
        (key, _unescaped(value, escapes)) for key, _, value in pairs if key and value
    )
    return Command(name.lower(), properties, data)


def _unescaped(text: str, escapes: Sequence[tuple[str, str]]) -> str:
    for escaped, plain in escapes:
        text = text.replace(escaped, plain)
    return text
