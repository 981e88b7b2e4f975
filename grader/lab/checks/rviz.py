"""Checks of an RViz file: that it is there, its fixed frame, and that it shows the robot."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from grader.base.errors import MissingElement, NotDecided
from grader.base.names import did_you_mean, last_part
from grader.base.records import Named
from grader.base.source import Location
from grader.base.text import enumerated
from grader.lab.checks.check import About
from grader.lab.checks.outcome import Outcome, Status, failed, judged, passed
from grader.lab.submission.submission import Submission
from grader.ros.package.package import Package

if TYPE_CHECKING:
    from grader.ros.config.rviz import Display, RvizFile
    from grader.ros.launch.launch_model import Launch, StartedNode

# What the edits for hints may change.
ABOUT = {
    "rviz_found": About(("rviz",)),
    "rviz_fixed_frame": About(("rviz",)),
    "rviz_shows_robot": About(
        ("rviz",),
        causes={
            "display": "the display is off, draws nothing, or is of another class",
            "nodes": "the nodes that are started use other names than RViz",
        },
    ),
    "rviz_display_on": About(("rviz",)),
}

_PLUGINS = "rviz_default_plugins"
_NO_FILE = "the package has no RViz file"
_UNKNOWN_PREFIX = "the frame_prefix of robot_state_publisher is known only at run time"


def rviz_found(package: Package, *, name: str, launch: str = "") -> Outcome:
    """The package has the RViz file: that of this name, or the one that the launch file opens.

    Args:
        name: The name of the RViz file, such as view.rviz.
        launch: The name of a launch file whose RViz file also passes, under any name; by default,
            none.
    """
    opened = _read_launch(package, launch)
    path = _rviz_path(package, name, opened)
    if last_part(path) == name or (opened and path == package.rviz_opened(opened)):
        return passed(f"the RViz file is {path}")
    if opened and (
        opened.syntax or opened.unknown or not all(file.is_certain for file in opened.named("rviz"))
    ):
        message = f"cannot determine statically whether the launch file opens {path}"
        raise NotDecided(message, "cannot determine statically which files the launch file names")
    return failed(
        f"there is no RViz file {name!r}",
        detail=f"; the package has {path}{package.built('rviz', name)}",
    )


def rviz_fixed_frame(
    submission: Submission, *, name: str, frame: str, launch: str = "", where_there: bool = False
) -> Outcome:
    """The RViz file's Fixed Frame is this link, after the launch file's `frame_prefix` for
    robot_state_publisher.

    Args:
        name: The name of the RViz file, such as view.rviz.
        frame: The link in whose frame RViz should draw.
        launch: The name of a launch file whose RViz file is examined, under any name; by default,
            only `name` decides.
        where_there: Whether a package without an RViz file passes, for `carried`.
    """
    package = submission.needed_package()
    if where_there and not package.rviz_files:
        return passed(_NO_FILE)
    rviz = _read_rviz(package, name, launch)
    if rviz.conflict:
        return failed(rviz.conflict.message, rviz.conflict.location)
    opened = _read_launch(package, launch)
    frames = _frames_of_link(opened, frame)
    actual = rviz.fixed_frame
    expected = next(filter(None, frames), frame)
    if not actual:
        return failed(
            f"the RViz file sets no Fixed Frame; it should be {expected!r}", rviz.frame_location
        )
    if None in frames and actual.endswith(frame):
        raise NotDecided(_UNKNOWN_PREFIX)
    links = _known_frames(submission, opened)
    message = f"the Fixed Frame is {actual!r}"
    detail = ""
    if actual not in frames:
        message += f"; it should be {expected!r}"
        prefix = expected.removesuffix(frame)
        if prefix:
            message += f", because the frame_prefix of robot_state_publisher is {prefix!r}"
        if links and actual not in links and actual != frame:
            detail = f"; the robot has no link {actual!r}{did_you_mean(actual, links)}"
    elif links and actual not in links:
        message += ", which the robot does not have"
    return judged(
        actual in frames, message, actual, expected, at=rviz.frame_location, detail=detail
    )


def _known_frames(submission: Submission, opened: "Launch | None") -> list[str]:
    """Return the frames of the robot's links that are known.

    A robot that ROS 2 does not load may lack links, such as those of a file that is not there: of
    such a robot, there are none.
    """
    robot = submission.robot
    frames: list[str] = []
    if robot and not robot.rejected:
        for link in robot.links:
            frames += filter(None, _frames_of_link(opened, link.name))
    return frames


def rviz_shows_robot(
    package: Package,
    *,
    name: str,
    topic: str = "/robot_description",
    launch: str = "",
    where_there: bool = False,
) -> Outcome:
    """A RobotModel display of the RViz file is on, reads the robot from this topic, and has the
    prefix of its frames.

    With a launch file, the topic is that of its robot_state_publisher, which its joint state
    publisher has to reach.

    Args:
        name: The name of the RViz file, such as view.rviz.
        topic: The topic from which the display should read the robot.
        launch: The name of a launch file whose RViz file is examined, under any name; by default,
            only `name` decides.
        where_there: Whether a package without an RViz file passes, for `carried`.
    """
    if where_there and not package.rviz_files:
        return passed(_NO_FILE)
    rviz = _read_rviz(package, name, launch)
    models = [display for display in rviz.displays if display.kind == "RobotModel"]
    if not models:
        return _no_display(rviz, "RobotModel")
    opened = _read_launch(package, launch)
    verdicts = [(_judge_model(model, topic, opened), model) for model in models]
    fine = [model for verdict, model in verdicts if verdict.status == "passed"]
    if fine:
        return passed(f"the display {fine[0].name or 'RobotModel'!r} shows the robot")
    verdict, model = next(
        (pending for pending in verdicts if pending[0].status == "pending"), verdicts[0]
    )
    location = verdict.location or model.location
    return Outcome(verdict.status, verdict.reason, location=location, cause=verdict.cause)


def rviz_display_on(package: Package, *, name: str, kind: str, launch: str = "") -> Outcome:
    """The RViz file has a display of a class, such as TF or LaserScan, and it is on.

    Args:
        name: The name of the RViz file, such as view.rviz.
        kind: The class of the display, such as LaserScan; with a package, such as
            rviz_default_plugins/LaserScan, that package is required.
        launch: The name of a launch file whose RViz file is examined, under any name; by default,
            only `name` decides.
    """
    rviz = _read_rviz(package, name, launch)
    displays_of_kind = [display for display in rviz.displays if display.kind == last_part(kind)]
    owner = kind.rpartition("/")[0]
    faults = [
        _class_of_ros1(display) or _why_other_class(display, owner) or _why_off(display)
        for display in displays_of_kind
    ]
    if "" in faults:
        return passed(f"a {kind} display is on")
    if displays_of_kind:
        return failed(faults[0], displays_of_kind[0].location)
    return _no_display(rviz, kind)


def _no_display(rviz: "RvizFile", kind: str) -> Outcome:
    kinds = list(dict.fromkeys(display.kind for display in rviz.displays if display.kind))
    return failed(
        f"there is no {kind} display", detail=f"; the displays are: {enumerated(kinds) or 'none'}"
    )


def _class_of_ros1(display: "Display") -> str:
    """Return what is wrong with a display's class.

    RViz of ROS 2 has no class rviz/..., and none without a package.
    """
    right = f"in ROS 2 it is {_PLUGINS}/{display.kind}"
    if not display.package:
        return f"the class {display.kind!r} names no package; {right}"
    if display.package == "rviz":
        return f"rviz/{display.kind} is a class of ROS 1; {right}"
    return ""


def _why_other_class(display: "Display", package: str) -> str:
    if package in ("", display.package):
        return ""
    class_of_display = f"{display.package}/{display.kind}"
    wanted = f"{package}/{display.kind}"
    return f"the class of the {display.kind} display is {class_of_display}; it should be {wanted}"


def _why_off(display: "Display") -> str:
    if display.enabled:
        return ""
    return f"the {display.kind} display is off{': its group is off' if display.is_enabled else ''}"


def _frames_of_link(opened: "Launch | None", link: str) -> Sequence[str | None]:
    if opened:
        return opened.list_frames(link)
    return (link,)


class _Verdict(Named):
    """Whether a RobotModel display shows the robot, and if not, why."""

    status: Status
    reason: str = ""
    cause: str = ""
    location: Location | None = None  # of the node whose mistake it is; else the display's


def _judge_model(model: "Display", topic: str, opened: "Launch | None") -> _Verdict:
    """Return whether a RobotModel display shows the robot, and if not, why."""
    fault = _class_of_ros1(model) or _why_off(model)
    if not fault and model.package != _PLUGINS:
        return _Verdict(
            "pending",
            f"{model.package}/RobotModel is not a class of RViz itself; needs manual grading",
        )
    hidden = "its Visual Enabled is off" if not model.is_on("Visual Enabled") else model.hides_links
    if not fault and hidden:
        fault = f"the RobotModel display is on, but {hidden}, so RViz draws nothing"
    if fault:
        return _Verdict("failed", fault, "display")
    source = model.node.get("Description Source")
    if source and source.text == "File":
        return _judge_file(model, topic)
    value = model.node.get("Description Topic", "Value") or model.node.get("Description Topic")
    verdict = _judge_topic((value.text or "" if value else "").strip(), topic, _Names.of(opened))
    if verdict.status != "passed":
        return verdict
    return _judge_prefix(model, opened)


def _judge_file(model: "Display", topic: str) -> _Verdict:
    """Return the verdict on a RobotModel display that reads a file instead of a topic."""
    path = model.file
    if not path or model.reads_file_of_one_machine:
        where = f"the file {path!r} of one machine" if path else "a file, and names none"
        return _Verdict("failed", f"the RobotModel display reads {where}; it should read {topic!r}")
    return _Verdict(
        "pending",
        "the RobotModel display reads a local file instead of a topic; needs manual grading",
    )


def _judge_topic(actual: str, topic: str, names: "_Names") -> _Verdict:
    """Return whether a RobotModel display reads the robot.

    This is known by the nodes that are started or else by the topic.
    """
    described = names.described
    shown = names.shown(actual)
    if described is None or (described and None in shown):
        reason = "the topics of the nodes are known only at run time; needs manual grading"
        return _Verdict("pending", reason)
    unheard = names.unheard
    cause = "nodes"
    location = names.unheard_at
    if actual and described and (described != {topic} or shown != {actual}):
        if not described & shown:
            unheard = (
                f"RViz reads the robot from {_listed(shown)}, but it is on {_listed(described)}"
            )
            location = next((node.location for node in names.publishers if node.namespace), None)
    elif actual.strip("/") != topic.strip("/"):
        if actual:
            fault = f"reads the topic {actual!r}; it should read"
        else:
            fault = "has no Description Topic; it should be"
        unheard = f"the RobotModel display {fault} {topic!r}"
        cause = ""
        location = None
    return _Verdict("failed", unheard, cause, location) if unheard else _Verdict("passed")


class _Names(Named):
    """The nodes that a launch file certainly starts.

    It says who publishes the robot and its joints, and who shows it.
    """

    publishers: "Sequence[StartedNode]" = ()
    joints: "Sequence[StartedNode]" = ()
    viewers: "Sequence[StartedNode]" = ()

    @classmethod
    def of(cls, opened: "Launch | None") -> "_Names":
        """Return the nodes of a launch file; none if other ones may be started as well."""
        if (
            not opened
            or opened.faults
            or opened.unknown
            or any(node.when is None for node in opened.nodes)
        ):
            return cls()
        publishers = []
        joints = []
        viewers = []
        for node in opened.nodes:
            if not node.when:
                continue
            if node.is_state_publisher:
                publishers.append(node)
            elif node.executable in ("joint_state_publisher", "joint_state_publisher_gui"):
                joints.append(node)
            elif node.executable == "rviz2":
                viewers.append(node)
        return cls(publishers, joints, viewers)

    @property
    def described(self) -> set[str] | None:
        """The topics that the robot is on; None where one is known only at run time."""
        topics = {node.topic("robot_description") for node in self.publishers}
        known = {topic for topic in topics if topic is not None}
        return known if known == topics else None

    def shown(self, topic: str) -> set[str | None]:
        """Return the topics that RViz reads for the one in its file."""
        return {node.topic(topic) for node in self.viewers} or {topic}

    @property
    def _unheard(self) -> "tuple[str, StartedNode, StartedNode] | None":
        """The name of a topic, a node that publishes it and one that reads another one."""
        without_description = [node for node in self.joints if not node.has_description]
        for name, sources, readers in (
            ("joint_states", self.joints, self.publishers),
            ("robot_description", self.publishers, without_description),
            ("/tf", self.publishers, self.viewers),
        ):
            sent = {node.topic(name) for node in sources}
            read = {node.topic(name) for node in readers}
            if sent and read and None not in sent | read and not sent & read:
                return name, sources[0], readers[0]
        return None

    @property
    def unheard(self) -> str:
        """Why transforms do not get from the joints to RViz.

        It is empty if they do, or if this is not known.
        """
        if self._unheard is None:
            return ""
        name, source, reader = self._unheard
        sent = {source.topic(name)}
        read = {reader.topic(name)}
        return (
            f"{source.executable} publishes on {_listed(sent)}, but {reader.executable} reads "
            f"{_listed(read)}"
        )

    @property
    def unheard_at(self) -> Location | None:
        """Where the node is started that is in a namespace, or that has another name of a topic."""
        if self._unheard is None:
            return None
        _, source, reader = self._unheard
        return reader.location if reader.namespace and not source.namespace else source.location


def _listed(topics: set[str] | set[str | None]) -> str:
    return enumerated(sorted(topic for topic in topics if topic))


def _judge_prefix(model: "Display", opened: "Launch | None") -> _Verdict:
    """Return whether a RobotModel display finds the links' frames.

    It puts its TF Prefix and a slash before them.
    """
    node = model.node.get("TF Prefix")
    written_prefix = node.text or "" if node else ""
    # TFLinkUpdater::getLinkTransforms of rviz_default_plugins always adds the slash,
    # robot_state_publisher none.
    shown_prefix = f"{written_prefix}/" if written_prefix else ""
    prefixes = _frames_of_link(opened, "")
    if shown_prefix in prefixes:
        return _Verdict("passed")
    if None in prefixes:
        return _Verdict("pending", f"{_UNKNOWN_PREFIX}; needs manual grading")
    expected = prefixes[0] or ""
    message = (
        f"the TF Prefix of the RobotModel display is {written_prefix!r}, "
        f"so it looks for frames like '{shown_prefix}LINK'; "
    )
    return _Verdict("failed", f"{message}robot_state_publisher publishes '{expected}LINK'", "nodes")


def _read_launch(package: Package, launch: str) -> "Launch | None":
    path = package.launch_file(launch) if launch else None
    return package.launch(path).with_components() if path is not None else None


def _rviz_path(package: Package, name: str, opened: "Launch | None") -> str:
    path = package.rviz_file(name, opened)
    if path is None:
        raise package.missing("rviz", name)
    return path


def _read_rviz(package: Package, name: str, launch: str) -> "RvizFile":
    opened = _read_launch(package, launch)
    package = package.owner_of_opened(opened) if opened else package
    path = _rviz_path(package, name, opened)
    rviz = package.rviz(path)
    if rviz.unread:
        raise NotDecided(rviz.unread, "the RViz file cannot be read")
    if rviz.fault:
        raise MissingElement(
            "RViz file", path, message=rviz.fault.message, location=rviz.fault.location
        )
    return rviz
