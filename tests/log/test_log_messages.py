"""The reader of logs: it never raises, is bounded, and cuts what is no message."""

from hypothesis import given
from hypothesis import strategies as st

from grader.workspace.log.log_messages import MAX_LINES, MAX_LOG, LogMessage, read_messages

_PARTS = st.sampled_from(
    [
        "\x1b[31m",
        "\x1b]0;title\x07",
        "[rviz2-2] ",
        "[ERROR] ",
        "[17.25] ",
        "[rviz2]: ",
        "Traceback (most recent call last):",
        "\n",
        "\r\n",
        "  ",
        "CMake Error at CMakeLists.txt:3 (find_package):",
        "ValueError: wrong",
        "- lab:",
        "\t",
        "é\u2028",
    ]
)
_LOGS = st.lists(st.one_of(_PARTS, st.text(max_size=20)), max_size=60).map("".join)


@given(st.one_of(st.binary(max_size=2000), _LOGS.map(lambda text: text.encode("utf-8", "replace"))))
def test_any_bytes_are_messages(data: bytes) -> None:
    """Each message has a line of the log, no control characters and single spaces, and no line is in two."""
    messages = read_messages(data)
    lines = data.decode("utf-8", "replace").replace("\r\n", "\n").split("\n")
    numbers = [message.line for message in messages]
    assert len(set(numbers)) == len(numbers)
    for message in messages:
        assert 1 <= message.line <= len(lines)
        assert message.text == " ".join(message.text.split())
        assert not any(letter in message.text for letter in "\x1b\x07\x00\n")


@given(_LOGS)
def test_colours_change_nothing(text: str) -> None:
    """A log with colours is read as one without."""
    plain = text.replace("\x1b[31m", "").replace("\x1b]0;title\x07", "")
    coloured = plain.replace("[", "\x1b[1;32m[").replace("]", "]\x1b[0m")
    assert read_messages(coloured.encode()) == read_messages(plain.encode())


def test_only_the_end_of_a_log_is_read() -> None:
    """A line keeps its number if only lines are cut."""
    data = "".join(f"error: {number}\n" for number in range(1, MAX_LINES + 51)).encode()
    messages = read_messages(data)
    assert len(messages) == MAX_LINES
    assert (messages[0].line, messages[0].text) == (51, "error: 51")
    assert read_messages(b"x" * (2 * MAX_LOG) + b"\nerror: last")[-1].text == "error: last"


def _read(text: str) -> list[LogMessage]:
    return [*read_messages(text.encode())]


def test_prefixes_are_cut() -> None:
    """Those of ros2 launch, of a node, of a log file, and of colcon."""
    [node] = _read("[gazebo-1] [ERROR] [1699874992.286789116] [controller_manager]: no type")
    assert node == LogMessage(1, "no type", "gazebo", "ERROR", "controller_manager")
    [of_file] = _read("1699874992.2867891 [ERROR] [launch]: stopped")
    assert of_file == LogMessage(1, "stopped", "", "ERROR", "launch")
    [of_colcon] = _read("[0.223s] ERROR:colcon:colcon build: stopped")
    assert of_colcon.text == "ERROR:colcon:colcon build: stopped"
    [bare] = _read("[INFO] nothing behind it")
    assert (bare.severity, bare.text) == ("INFO", "nothing behind it")


def test_lines_are_joined() -> None:
    """Those of a traceback, of CMake, of a list of colcon and of an exception in launch; others begin a message."""
    trace = 'Traceback (most recent call last):\n  File "a.py", line 1, in <module>\n    f()\nValueError: no\nmore'
    first, more = _read(trace)
    text = 'Traceback (most recent call last): File "a.py", line 1, in <module> f() ValueError: no'
    assert (first.text, first.is_traceback, more.text, more.line) == (text, True, "more", 5)
    [cmake] = _read(
        "CMake Error at CMakeLists.txt:3 (find_package):\n\n  By not providing\n  a file"
    )
    assert cmake.text == "CMake Error at CMakeLists.txt:3 (find_package): By not providing a file"
    [copies] = _read("Duplicate package names not supported:\n- lab:\n  - a/lab\n  - b/lab")
    assert copies.text.endswith("supported: - lab: - a/lab - b/lab")
    launch = (
        "[ERROR] [launch]: Caught exception in launch: failed\nUsage: xacro\n\nxacro: error: no"
    )
    joined, other = _read(f"{launch}\n[INFO] [launch]: end")
    assert joined.text == "Caught exception in launch: failed Usage: xacro xacro: error: no"
    assert other.text == "end"
    assert len(_read("Traceback (most recent call last):\nTraceback (most recent call last):")) == 2


def test_lines_of_other_processes_between_are_apart() -> None:
    """A message goes on after the line of another process; a line with a prefix begins one."""
    log = "[a-1] Error: wrong\n[b-2] hello\n[a-1]    at line 7\n[a-1] [INFO] [1.5] [a]: on"
    assert [(message.line, message.text) for message in _read(log)] == [
        (1, "Error: wrong at line 7"),
        (2, "hello"),
        (4, "on"),
    ]


def test_a_message_has_an_end() -> None:
    """At most 40 lines are joined."""
    assert len(_read("error:\n" + "  more\n" * 100)) == 3
