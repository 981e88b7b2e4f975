"""Checks of an RViz file: that it is there, its fixed frame, and that it shows the robot."""

from typing import TYPE_CHECKING

from grader.checks.outcome import Outcome, Status, judged_as, passed
from grader.errors import MissingElement, NotDecided
from grader.names import did_you_mean
from grader.package.package import Package
from grader.submission.submission import Submission

if TYPE_CHECKING:
    from grader.package.launch.model import Launch
    from grader.package.rviz import Display, RvizFile

_PLUGINS = "rviz_default_plugins"


def rviz_found(package: Package, *, name: str, launch: str = "") -> Outcome:
    """The package has the RViz file: that of this name, or the one that the launch file opens."""
    opened = _followed(package, launch)
    path = package.rviz_file(name, opened)
    if path is None:
        raise _no_rviz_file(package)
    if path.rpartition("/")[2] == name or (opened is not None and path == package.rviz_opened(opened)):
        return passed(f"the RViz file is {path}")
    if opened is not None and (opened.syntax or opened.unknown or not all(each.sure for each in opened.named("rviz"))):
        return Outcome("pending", f"whether {path} is the file that the launch file opens is told only by a run")
    return judged_as("failed", f"there is no RViz file {name!r}; the package has {path}")


def rviz_fixed_frame(submission: Submission, *, name: str, frame: str, launch: str = "") -> Outcome:
    """The RViz file's Fixed Frame is this link."""
    package = submission.needed_package()
    rviz = _read(package, name, launch)
    actual = rviz.fixed_frame
    if not actual:
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
        return judged_as("failed", f"there is no RobotModel display; {_listed(rviz)}")
    verdicts = [(_fault_of(model, topic), model) for model in models]
    fine = [model for (status, _), model in verdicts if status == "passed"]
    if fine:
        return passed(f"the display {fine[0].name or 'RobotModel'!r} shows the robot")
    (status, reason), model = next((each for each in verdicts if each[0][0] == "pending"), verdicts[0])
    return judged_as(status, reason, at=model.location)


def rviz_display_on(package: Package, *, name: str, kind: str, launch: str = "") -> Outcome:
    """The RViz file has a display of a class, such as TF or LaserScan, and it is on."""
    rviz = _read(package, name, launch)
    found = [each for each in rviz.displays if each.kind == kind.rpartition("/")[2]]
    faults = [_class_of_ros1(each) or _off(each) for each in found]
    if "" in faults:
        return passed(f"a {kind} display is on")
    if not found:
        return judged_as("failed", f"there is no {kind} display; {_listed(rviz)}")
    return judged_as("failed", faults[0], at=found[0].location)


def _listed(rviz: "RvizFile") -> str:
    return f"the displays are: {', '.join(dict.fromkeys(each.kind for each in rviz.displays if each.kind)) or 'none'}"


def _class_of_ros1(display: "Display") -> str:
    """What is wrong with a display's class: RViz of ROS 2 has none that are called rviz/..., and none without a package."""
    right = f"in ROS 2 it is {_PLUGINS}/{display.kind}"
    if not display.package:
        return f"the class {display.kind!r} names no package; {right}"
    return f"rviz/{display.kind} is a class of ROS 1; {right}" if display.package == "rviz" else ""


def _off(display: "Display") -> str:
    if display.enabled:
        return ""
    inside = ", for it is in a group that is off" if display.is_enabled else ""
    return f"the {display.kind} display is off{inside}"


def _fault_of(model: "Display", topic: str) -> tuple[Status, str]:
    """What keeps a RobotModel display from showing the robot."""
    fault = _class_of_ros1(model) or _off(model)
    if fault:
        return "failed", fault
    if model.package != _PLUGINS:
        return "pending", f"{model.package}/RobotModel is a class that RViz does not come with: a person has to look"
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


def _followed(package: Package, launch: str) -> "Launch | None":
    path = package.launch_file(launch) if launch else None
    return package.launch(path) if path is not None else None


def _no_rviz_file(package: Package) -> MissingElement:
    return MissingElement("RViz file in the package", "", message=package.missing_message("rviz"))


def _read(package: Package, name: str, launch: str) -> "RvizFile":
    path = package.rviz_file(name, _followed(package, launch))
    if path is None:
        raise _no_rviz_file(package)
    rviz = package.rviz(path)
    if rviz.unread:
        raise NotDecided(rviz.unread)
    if rviz.fault is not None:
        raise MissingElement("RViz file", path, message=rviz.fault.message, location=rviz.fault.location)
    return rviz
