"""The check of commands that a launch file executes which are no nodes."""

from typing import TYPE_CHECKING

from grader.base.errors import NotDecided
from grader.base.text import enumerated
from grader.lab.checks.check import About
from grader.lab.checks.launching import STOPS, evaluate_launch, fault_that_stops, path_of_launch
from grader.lab.checks.outcome import Outcome, failed, passed
from grader.ros.package.package import Package

if TYPE_CHECKING:
    from collections.abc import Sequence

    from grader.ros.launch.launch_model import Launch
    from grader.ros.launch.started_commands import StartedCommand

ABOUT = {
    "starts": About(
        ("launch",),
        causes={
            **STOPS,
            "command": "a command is not executed, or under another condition",
            "words": "a command lacks a word",
        },
    )
}
_OTHER_RECORDER = "rosbag2_transport"  # whose programs record without a command


def starts(
    package: Package,
    *,
    launch: str,
    command: list[str],
    words: list[str] | None = None,
    absent: bool = False,
) -> Outcome:
    """The launch file executes a command that is no node, with the defaults of its arguments or
    those of the criterion's `args`.

    Args:
        launch: The file's name, such as rover.launch.py.
        command: The words with which the command begins, such as `["ros2", "bag", "record"]`.
        words: Other words that it has, in any order; topics with a slash or without.
        absent: Whether it must not be executed.
    """
    evaluated = evaluate_launch(package, launch)
    if evaluated.faults:
        raise fault_that_stops(path_of_launch(package, launch), evaluated)
    shown = f"`{' '.join(command)}`"
    alike = [each for each in evaluated.commands if list(each.words[: len(command)]) == command]
    executed = [each for each in alike if each.when is not False]
    if absent:
        return _judge_absent(shown, executed, is_open=_may_execute(evaluated))
    fitting = [each for each in executed if not _find_lacking(each.words, words or [])]
    if any(each.when for each in fitting):
        return passed(f"the launch file executes {shown}")
    if fitting or _may_execute(evaluated):
        raise _not_decided(shown)
    if executed:
        lacking = enumerated(_find_lacking(executed[0].words, words or []))
        return failed(f"the command {shown} lacks {lacking}", executed[0].location, cause="words")
    message = f"the launch file does not execute {shown}"
    detail = ": a condition keeps it from starting" if alike else ""
    at = alike[0].location if alike else None
    return failed(message, at, detail=detail, cause="command")


def _judge_absent(shown: str, executed: "Sequence[StartedCommand]", *, is_open: bool) -> Outcome:
    """Return whether none of these commands is executed."""
    for command in executed:
        if command.when:
            message = f"the launch file executes {shown}; it should not"
            return failed(message, command.location, cause="command")
    if executed or is_open:
        raise _not_decided(shown)
    return passed(f"the launch file does not execute {shown}")


def _not_decided(shown: str) -> NotDecided:
    cause = f"cannot determine statically whether the launch file executes {shown}"
    return NotDecided(cause, cause)


def _find_lacking(command: "Sequence[str]", words: "Sequence[str]") -> list[str]:
    """Return the words that a command lacks."""
    known = {word.removeprefix("/") for word in command}
    return [word for word in words if word.removeprefix("/") not in known]


def _may_execute(launch: "Launch") -> bool:
    """Return whether a launch may execute a command that is not known, or record otherwise."""
    records = any(node.package == _OTHER_RECORDER for node in launch.nodes)
    return bool(launch.unknown) or records
