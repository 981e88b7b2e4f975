"""Checks of what the code of nodes does: frames of messages, goals of actions, and parameters."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from grader.base.errors import MissingElement, NotDecided
from grader.base.names import last_part
from grader.base.source import Location
from grader.base.text import enumerated, quoted
from grader.lab.checks.check import About
from grader.lab.checks.launching import (
    OPENS,
    Launched,
    check_open,
    fail_absent,
    full_name,
    launch_together,
    type_name,
)
from grader.lab.checks.outcome import Outcome, failed, judged, passed
from grader.lab.submission.submission import Submission
from grader.ros.package.package import Package

if TYPE_CHECKING:
    from grader.ros.api import EndpointKind

ABOUT = {
    "publishes": About(("launch",), causes={**OPENS, "frame": "a message has another frame"}),
    "serves_action": About(
        ("launch",),
        causes={
            **OPENS,
            "type": "a type differs",
            "goals": "the code of the server does not do this with goals",
        },
    ),
    "uses_parameter": About(causes={"unused": "a parameter changes nothing"}),
}
_PUBLISHERS: "Sequence[EndpointKind]" = ("publisher",)
_SERVERS: "Sequence[EndpointKind]" = ("action server",)


def publishes(
    package: Package,
    submission: Submission,
    *,
    topic: str,
    frame_id: str,
    launch: str | None = None,
) -> Outcome:
    """A node publishes a topic with messages of this frame, which its code or a parameter names.

    A frame that comes from the input of the node needs manual grading, and so do nodes that are not
    part of the submission.

    Args:
        topic: The topic.
        frame_id: The frame in the header of its messages.
        launch: The name of the launch file; default: all launch files together.
    """
    from grader.workspace.api import names_text  # late: few rubrics ask for it

    name, wanted = full_name(topic), frame_id.removeprefix("/")
    launched = launch_together(package, submission, launch)
    ends = launched.graph.ends(_PUBLISHERS, name)
    if all(placed.doubt for placed in ends):
        check_open(launched, f"a node publishes {name}", ends, _PUBLISHERS)
        return launched.failure or fail_absent(launched, _PUBLISHERS, "publishes", name)
    frames = _find_frames(launched, name)
    if {*frames} == {wanted}:
        return passed(f"{name} is published in the frame {quoted(wanted)}")
    is_open = not frames or frames.keys() & {"", wanted}
    if is_open or names_text(submission.workspace, wanted):
        cause = f"cannot determine statically in which frame {name} is published"
        raise NotDecided(cause, "cannot determine statically in which frame a topic is published")
    shown = enumerated(map(quoted, frames))
    message = f"{name} is published in the frame {shown}; it should be {quoted(wanted)}"
    return failed(message, next(iter(frames.values())), cause="frame")


def _find_frames(launched: Launched, topic: str) -> dict[str, Location]:
    """Return the frames in the messages of a topic, each with where code sets it."""
    from grader.workspace.api import frames_published  # late: few rubrics ask for it

    frames: dict[str, Location] = {}
    for workspace, number in launched.graph.launches:
        for node in workspace.launches.roots[number][1].nodes:
            frames.update(frames_published(workspace, node, topic))
    return frames


def serves_action(
    package: Package,
    submission: Submission,
    *,
    action: str,
    type: str | None = None,  # noqa: A002  a rubric calls it so
    feedback: bool = False,
    cancel: bool = False,
    rejects: bool = False,
    launch: str | None = None,
) -> Outcome:
    """A node serves an action, and its code does with goals what is asked.

    When and how it does so is not examined. Code that is in another file than the server needs
    manual grading.

    Args:
        action: The action.
        type: Its type: nav2_msgs/action/Wait.
        feedback: Whether it publishes feedback.
        cancel: Whether it accepts to cancel a goal, and ends it as cancelled.
        rejects: Whether it rejects some goals.
        launch: The name of the launch file; default: all launch files together.
    """
    from grader.workspace.api import lack_of_goals  # late: as above

    name, wanted = full_name(action), type_name(type or "")
    launched = launch_together(package, submission, launch)
    ends = launched.graph.ends(_SERVERS, name)
    if all(placed.doubt for placed in ends):
        check_open(launched, f"a node serves {name}", ends, _SERVERS)
        return launched.failure or fail_absent(launched, _SERVERS, "serves", name)
    server = next(placed.end for placed in ends if not placed.doubt)
    if wanted not in ("", server.type):
        message = f"{name} has the type {server.type}; it should be {wanted}"
        return failed(message, server.location, cause="type")
    asked = {"feedback": feedback, "cancel": cancel, "rejects": rejects}
    for argument in filter(asked.get, asked):
        lack = lack_of_goals(submission.workspace, server.location, argument)
        if lack:
            return failed(f"the server of {name} {lack}", server.location, cause="goals")
    return judged(True, f"a node serves {name} with {server.type}", server.type)


def uses_parameter(submission: Submission, *, node: str, parameter: str) -> Outcome:
    """The code of a node uses the value of a parameter, for more than to print it.

    Args:
        node: The name of the node.
        parameter: The name of the parameter.
    """
    from grader.workspace.api import find_parameter_use  # late: few rubrics ask for it

    submission.needed_package()
    name = last_part(node)
    use = find_parameter_use(submission.workspace, name, parameter)
    shown = f"the parameter {quoted(parameter)} of {name}"
    if use.is_used:
        return passed(f"code uses {shown}")
    if use.doubt:
        cause = f"cannot determine statically whether code uses {shown}"
        raise NotDecided(f"{cause}: {use.doubt}", "whether code uses a parameter is not known")
    if not use.at:
        message = f"no code has {shown}"
        raise MissingElement("parameter", f"{name} {parameter}", message=message)
    return failed(f"nothing depends on {shown}", use.at, cause="unused")
