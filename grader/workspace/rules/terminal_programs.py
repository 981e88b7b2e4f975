"""Programs that read keys or lines, which a launch file starts without a terminal.

The standard input of what `ros2 launch` starts is a pipe that nothing writes to.
"""

import re

from grader.base.patterns import on_use
from grader.ros.known.package_rows import program_row
from grader.ros.launch.launch_model import StartedNode
from grader.workspace.model.code_text import code_alone
from grader.workspace.model.text_files import CODE_ENDINGS
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Compared,
    Facts,
    warning,
)
from grader.workspace.rules.rule_table import MAY_WAIT, Rule, Symptom

# What reads or changes the settings of a terminal, and that it is the one of the standard input.
_KEYS = on_use(r"\b(?:tcgetattr|setraw|setcbreak)\s*+\(")
_STANDARD = on_use(r"\bstdin\b|\bSTDIN_FILENO\b|\btcgetattr\s*+\(\s*+0\b|\bkfd\s*+[=({]\s*+0\b")
# What reads keys or lines in Python without naming the standard input.
_ALSO = on_use(r"\bcurses\.(?:wrapper|initscr)\b|(?<![\w.])input\s*+\(")
# Code that looks whether there is a terminal or an option, opens another one, or goes on without.
_OTHERWISE = on_use(
    r"\bisatty\b|\bopenpty\b|\btermios\.error\b|\bEOFError\b|\bargv\b|\bargparse\b|[tT]hread"
    r"|\b(?:def|import|for|as)\s++input\b"
)
_IF_MAIN = on_use(r"^if\s++__name__\b", re.MULTILINE)  # what follows is run by no entry point
_OTHER_TERMINAL = on_use(r"/dev/tty\b|['\"]launch-prefix['\"]")
_PORT = "/dev/tty"  # also of another device


_PROGRAM_TERMINAL = Rule(
    "program-terminal",
    "wiring",
    MAY_WAIT,
    "A program that reads keys or lines is started in a terminal.",
    why=(
        "ros2 launch does not pass keys to a program. It waits without end, or it stops with "
        "'Inappropriate ioctl for device'."
    ),
    symptoms=(
        Symptom(
            "no-terminal",
            pattern=(
                r"\ATraceback \(most recent call last\): File "
                r'"(?:[^"\s]{0,300}/)?(?P<program>[^/"\s]{1,100}+)", line [0-9]{1,6}, in '
                r"<module>.{0,4000}? termios\.error: \(25, "
            ),
            source="python/cpython 02ea82ae, Modules/termios.c:89",
            sentence="A program that reads keys has no terminal.",
            example=(
                'Traceback (most recent call last): File "/opt/ros/jazzy/lib/'
                'teleop_twist_keyboard/teleop_twist_keyboard", line 33, in <module> main() '
                "termios.error: (25, 'Inappropriate ioctl for device')"
            ),
            within=("program",),
        ),
    ),
    wrong="Node(package='teleop_twist_keyboard', executable='teleop_twist_keyboard'),",
    right="""
Node(package='teleop_twist_keyboard', executable='teleop_twist_keyboard', prefix='xterm -e'),
""",
)


def terminal_facts(workspace: Workspace) -> Facts:
    """Yield the programs that read keys or lines, and that are started without a terminal.

    Of own programs the file of their only node is read. Nothing is said of one that is started by
    another program, such as xterm, or that may do otherwise: for an option, or in a thread.
    """
    if any(map(_OTHER_TERMINAL.search, workspace.texts.launch_texts)):
        return
    said = set()
    for _, node in workspace.launches.launched:
        if node.when is False or node.has_prefix or node.location in said:
            continue
        yield Compared("wiring")
        if program_row(*node.program).reads_keys or _reads_keys(workspace, node):
            said.add(node.location)
            message = (
                f"{node.executable} reads keys or lines, and ros2 launch gives it no terminal: "
                "start it with the prefix xterm -e, or with ros2 run in another terminal"
            )
            yield warning(_PROGRAM_TERMINAL, message, node.location)


def _reads_keys(workspace: Workspace, node: StartedNode) -> bool:
    """Return whether the file of an own node reads keys or lines."""
    path, text = _find_file(workspace, node)
    if _PORT in text or (not _KEYS.search(text) and not _ALSO.search(text)):
        return False
    code = _IF_MAIN.split(code_alone(text, path), maxsplit=1)[0]
    if _OTHERWISE.search(code):
        return False
    if path.endswith(".py") and _ALSO.search(code):
        return True
    return _KEYS.search(code) is not None and _STANDARD.search(code) is not None


def _find_file(workspace: Workspace, node: StartedNode) -> tuple[str, str]:
    """Return the path and the text of the file of an own node; empty for another one."""
    facts = workspace.code.own_node(node)
    package = workspace.find_package(node)
    if not facts or not package:
        return "", ""
    path = facts.location.path
    sources = workspace.texts.read_sources(package, CODE_ENDINGS)
    return path, next((source.text for source in sources if source.path == path), "")
