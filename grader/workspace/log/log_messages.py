"""The messages of a log: without colours and prefixes, and with the lines that continue them."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from grader.base.patterns import on_use

MAX_LOG = 1024 * 1024  # bytes, of which the last ones are read
MAX_LINES = 2000  # the last ones are read
_MAX_WIDTH = 2000  # characters of a line
_MAX_CONTINUED = 40  # lines of a message
# What a terminal does not show: colours and other commands, titles, and the rest of the controls.
_CONTROLS = on_use(
    "\x1b\\[[0-?]*+[ -/]*+[@-~]"
    "|\x1b\\][^\x07\x1b]{0,200}+(?:\x07|\x1b\\\\)?"
    "|[\x00-\x08\x0b-\x1f\x7f]"
)
_PROCESS = on_use(r"\[(?P<name>[\w.+-]{1,100}?)-[0-9]{1,6}\] ?+")
_TIME = on_use(r"(?:[0-9]{1,12}\.[0-9]{1,12}s? |\[[0-9]{1,12}\.[0-9]{1,12}s?\] ?)")
_SEVERITY = on_use(r"\[(?P<severity>DEBUG|INFO|WARN|WARNING|ERROR|FATAL|CRITICAL)\] ?+")
_LOGGER = on_use(r"\[(?P<name>[\w./-]{1,200})\]: ?+")
_OF_BUILD = on_use(r"---(?: stderr: (?P<package>[\w.-]{1,100}+))?")  # of colcon, or its end
_TRACEBACK = ("Traceback (most recent call last):", '  File "')  # the first may be missing
# Messages that are said in several lines, none of which has a prefix of its own.
_OPEN_ENDED = ("Caught exception in launch", "CMake Error at ", "CMake Warning at ")
# What ros2_control says in several lines, which only in the first have a process.
_BLOCKS = ("Not acceptable command interfaces combination", "Not acceptable state interfaces")
_IN_BLOCKS = ("[", "]", "Start interfaces:", "Stop interfaces:", "Not existing:", "Not available:")
_INCLUDING = "In file included from "  # a compiler, before the line in another file
_LINKER = "/usr/bin/ld: "  # which says in another line what is not defined
_OF_OBJECT = ":(.text"
_LISTS = (
    *("- ", "when ", "instantiated ", "included from", "in file:", "Check that:"),
    *("Call Stack (", "processing file:"),
)


class LogMessage(NamedTuple):
    r"""A message of a log, which a program said in one line or several.

    >>> text = "[rviz2-2] [ERROR] [17.5] [rviz2]: no frame\n[rviz2-2]   at line 9\n"
    >>> [message] = read_messages(text.encode())
    >>> message.line, message.process, message.severity, message.logger, message.text
    (1, 'rviz2', 'ERROR', 'rviz2', 'no frame at line 9')
    """

    line: int  # where it begins, from 1
    text: str  # in one line, with single spaces
    process: str = ""  # the program that ros2 launch started; empty without one
    severity: str = ""
    logger: str = ""  # the name of the node
    is_traceback: bool = False
    package: str = ""  # that colcon builds; empty if it does not say so


class _LogLine(NamedTuple):
    number: int
    text: str  # without its prefix
    process: str
    severity: str
    logger: str
    package: str = ""

    @property
    def begins(self) -> bool:
        """Whether it has a prefix with which messages begin."""
        return bool(self.severity or self.logger)


def read_messages(data: bytes) -> tuple[LogMessage, ...]:
    """Return the messages of a log, of a long one the last ones. It never raises.

    Lines are counted from the first that is read if the log is larger than its limits.
    """
    lines = data[-MAX_LOG:].decode("utf-8", "replace").replace("\r\n", "\n").split("\n")
    first = max(0, len(lines) - MAX_LINES - 1)
    read = []
    package = ""
    for number, text in enumerate(lines[first:], first + 1):
        line = _without_prefix(number, text)
        of_build = _OF_BUILD.fullmatch(line.text)
        if of_build:
            package = of_build["package"] or ""
        elif line.text or line.begins:
            read.append(line._replace(package=package))
    messages = _joined(read)
    return tuple(sorted(messages, key=lambda message: message.line))


def _without_prefix(number: int, text: str) -> _LogLine:
    """Return a line without colours, and its prefix apart.

    ros2 launch puts the process before the line of a node, which has severity, time and name.
    """
    text = _CONTROLS.sub("", text.expandtabs(1)[: 2 * _MAX_WIDTH])[:_MAX_WIDTH]
    names = {"process": "", "severity": "", "logger": ""}
    rest = text
    for key, pattern in (
        ("", _TIME),
        ("process", _PROCESS),
        ("severity", _SEVERITY),
        ("", _TIME),
        ("logger", _LOGGER),
    ):
        match = pattern.match(rest)
        if not match or (key == "logger" and not names["severity"]):
            continue
        if key:
            names[key] = match[1]
        rest = rest[match.end() :]
    return _LogLine(number, rest.rstrip(), **names)


def _joined(lines: Sequence[_LogLine]) -> Iterator[LogMessage]:
    """Yield the messages, each with the lines that continue it."""
    waiting: dict[str, list[_LogLine]] = {}
    last = ""
    for line in lines:
        is_block = last in waiting and waiting[last][0].text.startswith(_BLOCKS)
        if line.process or line.begins or not is_block:
            last = line.process
        open_lines = waiting.get(last)
        if open_lines and _continues(open_lines, line):
            open_lines.append(line)
            continue
        if open_lines:
            yield _make_message(open_lines)
        waiting[last] = [line]
    for open_lines in waiting.values():
        yield _make_message(open_lines)


def _continues(before: Sequence[_LogLine], line: _LogLine) -> bool:
    """Return whether a line continues the message of the same process."""
    if line.begins or len(before) >= _MAX_CONTINUED:
        return False
    first = before[0].text
    text = line.text
    if first.startswith(_BLOCKS):
        return text.startswith((" ", *_IN_BLOCKS))
    if text.startswith((_TRACEBACK[0], *_OPEN_ENDED)):
        return False
    if first.startswith(_TRACEBACK):
        return text.startswith(" ") or before[-1].text.startswith((" ", *_TRACEBACK))
    is_object = first.startswith(_LINKER) and _OF_OBJECT in text
    if is_object or first.startswith(_OPEN_ENDED[:1]) or before[-1].text.startswith(_INCLUDING):
        return True
    return text.startswith((" ", *_LISTS)) and not text.startswith(_TRACEBACK)


def _make_message(lines: Sequence[_LogLine]) -> LogMessage:
    first = lines[0]
    words = " ".join(line.text for line in lines).split()
    is_traceback = first.text.startswith(_TRACEBACK)
    return LogMessage(
        first.number,
        " ".join(words),
        first.process,
        first.severity,
        first.logger,
        is_traceback,
        first.package,
    )
