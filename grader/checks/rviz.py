"""Checks of an RViz file: that it is there, its fixed frame, and that it shows the robot."""

from typing import TYPE_CHECKING

from grader.checks.outcome import Outcome, judged_as, passed
from grader.errors import MissingElement
from grader.robot.names import did_you_mean
from grader.submission.package import NO_PACKAGE, Package
from grader.submission.submission import Submission

if TYPE_CHECKING:
    from grader.submission.rviz import Display, RvizFile

_PLUGINS = "rviz_default_plugins"


def rviz_found(package: Package, *, name: str, launch: str = "") -> Outcome:
    """The package has the RViz file: that of this name, or the one that the launch file opens."""
    path = _file(package, name, launch)
    if path is None:
        raise _no_rviz_file()
    if path.rpartition("/")[2] == name or path == _opened(package, launch):
        return passed(f"the RViz file is {path}")
    return judged_as("failed", f"there is no RViz file {name!r}; the package has {path}")


def rviz_fixed_frame(submission: Submission, *, name: str, frame: str, launch: str = "") -> Outcome:
    """The RViz file's Fixed Frame is this link."""
    package = submission.package
    if package is None:
        raise MissingElement("package", "", message=NO_PACKAGE)
    rviz = _read(package, name, launch)
    actual = rviz.fixed_frame
    if actual is None:
        return judged_as("failed", f"the RViz file sets no Fixed Frame, expected {frame!r}", at=rviz.frame_location)
    robot = submission.urdf.robot if submission.urdf is not None else None
    links = [link.name for link in robot.links] if robot is not None else []
    message = f"the Fixed Frame is {actual!r}"
    if actual == frame:
        lacking = links and frame not in links
        return Outcome("passed", message + (", which the robot does not have" if lacking else ""), actual, frame)
    message += f", expected {frame!r}"
    if links and actual not in links:
        message += f"; the robot has no link {actual!r}{did_you_mean(actual, links)}"
    return Outcome("failed", message, actual, frame, location=rviz.frame_location)


def rviz_shows_robot(package: Package, *, name: str, topic: str = "/robot_description", launch: str = "") -> Outcome:
    """A RobotModel display of the RViz file is on, and reads the robot from this topic."""
    rviz = _read(package, name, launch)
    models = [each for each in rviz.displays if each.kind == "RobotModel"]
    if not models:
        kinds = ", ".join(dict.fromkeys(each.kind for each in rviz.displays if each.kind)) or "none"
        return judged_as("failed", f"there is no RobotModel display; the displays are: {kinds}")
    verdicts = [(_fault_of(model, topic), model) for model in models]
    fine = [model for (status, _), model in verdicts if status == "passed"]
    if fine:
        return passed(f"the display {fine[0].name or 'RobotModel'!r} shows the robot")
    (status, reason), model = verdicts[0]
    at = model.location if status == "failed" else None
    return Outcome("failed" if status == "failed" else "pending", reason, location=at)


def rviz_display_on(package: Package, *, name: str, kind: str, launch: str = "") -> Outcome:
    """The RViz file has a display of a class, such as TF or LaserScan, and it is on."""
    rviz = _read(package, name, launch)
    found = [each for each in rviz.displays if each.kind == kind.rpartition("/")[2]]
    if any(each.enabled and each.package != "rviz" for each in found):
        return passed(f"a {kind} display is on")
    if not found:
        return judged_as("failed", f"there is no {kind} display")
    return judged_as(
        "failed", f"the {kind} display is {'off' if found[0].package != 'rviz' else 'of ROS 1'}", at=found[0].location
    )


def _fault_of(model: "Display", topic: str) -> tuple[str, str]:
    """What keeps a RobotModel display from showing the robot."""
    if model.package != _PLUGINS:
        other = f"{model.package}/RobotModel"
        hint = "a class of ROS 1" if model.package == "rviz" else "a class that RViz does not come with"
        return (
            "failed" if model.package == "rviz" else "pending",
            f"{other} is {hint}; in ROS 2 it is {_PLUGINS}/RobotModel",
        )
    if not model.enabled:
        return "failed", "the RobotModel display is off"
    node = model.node
    if not model.is_on("Visual Enabled"):
        return "failed", "the RobotModel display is on, but Visual Enabled is off in it, so nothing is drawn"
    source = node.get("Description Source")
    if source is not None and source.text == "File":
        return "pending", "the RobotModel display reads a file of one machine instead of a topic: a person has to look"
    value = node.get("Description Topic", "Value") or node.get("Description Topic")
    actual = (value.text or "" if value is not None else "").strip()
    if actual.strip("/") == topic.strip("/"):
        return "passed", ""
    if not actual:
        return "failed", f"the RobotModel display has no Description Topic; expected {topic!r}"
    return "failed", f"the RobotModel display reads the topic {actual!r}, expected {topic!r}"


def _opened(package: Package, launch: str) -> str | None:
    """The RViz file that the launch file opens, if that can be told."""
    path = package.launch_file(launch) if launch else None
    if path is None:
        return None
    named = [package.source_of(each.path) for each in package.launch(path).named("rviz") if each.path is not None]
    return next((each for each in named if each is not None), None)


def _file(package: Package, name: str, launch: str) -> str | None:
    path = package.launch_file(launch) if launch else None
    return package.rviz_file(name, package.launch(path) if path is not None else None)


def _no_rviz_file() -> MissingElement:
    return MissingElement("RViz file in the package", "", message="the package has no RViz file: none ends in .rviz")


def _read(package: Package, name: str, launch: str) -> "RvizFile":
    path = _file(package, name, launch)
    if path is None:
        raise _no_rviz_file()
    rviz = package.rviz(path)
    if rviz.fault is not None:
        raise MissingElement("RViz file", path, message=rviz.fault.message, location=rviz.fault.location)
    return rviz
