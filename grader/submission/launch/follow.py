"""Goes through a launch description: which nodes it starts, which files they are given, what it includes."""

import re
from collections.abc import Callable
from dataclasses import dataclass, field

from grader.robot.source import Location
from grader.submission.launch.model import Fault, Purpose, Reference, StartedNode
from grader.submission.launch.places import SHARE
from grader.submission.launch.substitutions import UNTOLD, Contents, Context, arguments_of, holds, resolve
from grader.submission.python.values import Function, Made, Spot, Unknown, Value

_NODES = ("Node", "LifecycleNode")
_DESCRIBED = "robot_state_publisher"
_SHOWS = "rviz2"
_MOST_ACTIONS = 2_000
_MOST_DEPTH = 12
# What urdf_launch's two launch files start (ROS 2 package urdf_launch).
_URDF_LAUNCH = re.compile(r".*/share/urdf_launch/launch/(?P<name>display|description)\.launch\.py")

# Takes the path of a launch file below the prefix and the arguments for it; False where it is not among what was handed in.
Include = Callable[[str, Context], bool]


@dataclass(slots=True)
class Follower:
    """What was found so far in one launch file and those that it includes."""

    place: Callable[[Spot], Location]
    include: Include
    call: Callable[[Function, Spot], Value]
    nodes: list[StartedNode] = field(default_factory=list)
    references: list[Reference] = field(default_factory=list)
    faults: list[Fault] = field(default_factory=list)
    unknown: list[Fault] = field(default_factory=list)
    seen: set[int] = field(default_factory=set)

    def description(self, value: Value, context: Context) -> None:
        """Follow what generate_launch_description returns."""
        self._actions(value, context, when=True, depth=0)
        for name, spot in context.undeclared:
            message = f"the launch argument {name!r} is used, but DeclareLaunchArgument does not declare it before"
            self.faults.append(Fault(message, self.place(spot)))
        for message, spot in context.wrong:
            self.faults.append(Fault(message, self.place(spot)))
        context.undeclared.clear()
        context.wrong.clear()

    def _actions(self, value: Value, context: Context, *, when: bool | None, depth: int) -> None:
        if depth > _MOST_DEPTH or len(self.seen) > _MOST_ACTIONS:
            return
        match value:
            case list() | tuple():
                for each in value:
                    self._actions(each, context, when=when, depth=depth)
            case dict():
                self._actions(list(value.values()), context, when=when, depth=depth + 1)
            case Unknown():
                self.unknown.append(Fault(value.reason, self.place(value.at)))
            case Function():
                self._actions(self.call(value, Spot(1, 1)), context, when=when, depth=depth + 1)
            case Made():
                self._action(value, context, when=when, depth=depth)

    def _action(self, made: Made, context: Context, *, when: bool | None, depth: int) -> None:
        doubt = made.kwargs.get("?")
        if isinstance(doubt, Unknown):
            when = None if when else when
        when = _both(when, holds(made.kwargs.get("condition"), context))
        last = made.name.rpartition(".")[2]
        if last in ("DeclareLaunchArgument", "SetLaunchConfiguration"):
            name = resolve(made.argument(0, "name"), context)
            if isinstance(name, str):
                default = made.argument(1, "default_value", "value")
                context.arguments.setdefault(name, default)
            return
        self.seen.add(id(made))
        if last in _NODES:
            self._node(made, context, when)
        elif last == "ExecuteProcess":
            self._process(made, context, when)
        elif last == "IncludeLaunchDescription":
            self._include(made, context, when)
        else:  # a group, a timer, an event handler, a description: whatever actions it holds
            for value in [*made.args, *made.kwargs.values()]:
                if isinstance(value, list | tuple | Made | Function):
                    self._actions(value, context, when=when, depth=depth + 1)
            for each in made.calls:
                if each.name.endswith((".add_action", ".add_entity", ".append", ".extend")):
                    self._actions(
                        each.args, context, when=_both(when, None if "?" in each.kwargs else True), depth=depth
                    )

    def _node(self, made: Made, context: Context, when: bool | None) -> None:
        package = resolve(made.kwargs.get("package"), context)
        executable = resolve(made.argument(0, "executable", "node_executable", "exec"), context)
        if not isinstance(package, str) or not isinstance(executable, str):
            what = next(each for each in (package, executable) if not isinstance(each, str))
            reason = what.reason if isinstance(what, Unknown) else "which program a node is told only by a run"
            self.unknown.append(Fault(reason, self.place(made.at)))
            return
        self._started(package, executable, made, context, when)

    def _started(self, package: str, executable: str, made: Made, context: Context, when: bool | None) -> None:
        self.nodes.append(StartedNode(package, executable, when, self.place(made.at)))
        if when is False:
            return
        if executable == _DESCRIBED:
            self._described(made, context)
        elif executable == _SHOWS:
            self._shown(made.kwargs.get("arguments"), made, context)

    def _process(self, made: Made, context: Context, when: bool | None) -> None:
        words = self._words(made.argument(0, "cmd"), context)
        match words:
            case ["ros2", "run", package, executable, *_]:
                self.nodes.append(StartedNode(package, executable, when, self.place(made.at)))
            case ["rviz2" as executable, *_]:
                self.nodes.append(StartedNode(executable, executable, when, self.place(made.at)))
            case _:
                return
        if _SHOWS in words[:4] and when is not False:
            self._shown(made.argument(0, "cmd"), made, context)

    def _words(self, value: Value, context: Context) -> list[str]:
        pieces = value if isinstance(value, list | tuple) else [value] if value is not None else []
        texts = [resolve(piece, context) for piece in pieces]
        return " ".join(text if isinstance(text, str) else UNTOLD for text in texts).split()

    def _described(self, made: Made, context: Context) -> None:
        """Where robot_state_publisher gets the robot from."""
        given = made.kwargs.get("parameters")
        parameters = given if isinstance(given, list | tuple) else [given] if given is not None else []
        found = [
            each["robot_description"] for each in parameters if isinstance(each, dict) and "robot_description" in each
        ]
        if found:
            self._description_from(found[-1], made, context)
            return
        unclear = next((each for each in parameters if not isinstance(each, dict)), None)
        words = self._words(made.kwargs.get("arguments"), context)
        files = [each for each in words if not each.startswith("-") and each != UNTOLD]
        if isinstance(unclear, Unknown):
            self._refer("urdf", unclear, made)
        elif files:
            self._refer("urdf", files[0], made)
        elif UNTOLD in "".join(words) or unclear is not None:
            self._refer("urdf", Unknown("what it is given is told only by a run", made.at), made)
        else:
            message = "robot_state_publisher is started without robot_description: it has no robot to publish"
            self.references.append(Reference("urdf", None, self.place(made.at), message))

    def _description_from(self, value: Value, made: Made, context: Context) -> None:
        known = resolve(value, context)
        match known:
            case Contents(path=path, by=by):
                if by == "open" and path.endswith(".xacro"):
                    message = f"{path.rpartition('/')[2]} is read as it is, but xacro has to expand it: use Command(['xacro ', ...])"
                    self.references.append(Reference("urdf", None, self.place(made.at), message))
                    return
                self._refer("urdf", path, made, value)
            case str() if "<robot" in known:
                return
            case str():
                message = "robot_description is given the path of the URDF, not what is in it: read the file first"
                self.references.append(Reference("urdf", None, self.place(_spot(value, made)), message))
            case Unknown():
                self._refer("urdf", known, made, value)

    def _shown(self, arguments: Value, made: Made, context: Context) -> None:
        """Which configuration RViz opens."""
        if isinstance(arguments, Unknown):
            self._refer("rviz", arguments, made)
            return
        words = self._words(arguments, context)
        for index, word in enumerate(words):
            if word in ("-d", "--display-config"):
                following = words[index + 1 : index + 2]
                path = following[0] if following else ""
            elif word.startswith("-d") and not word.startswith("--"):
                path = word[2:]
            elif word.startswith("--display-config="):
                path = word.partition("=")[2]
            else:
                continue
            if UNTOLD in path:
                self._refer("rviz", self._why(arguments, made, context), made)
            elif path:
                self._refer("rviz", path, made)
            else:
                message = "rviz2 is given -d without the path of a file"
                self.references.append(Reference("rviz", None, self.place(made.at), message))
            return
        if UNTOLD in "".join(words):
            self._refer("rviz", self._why(arguments, made, context), made)
            return
        message = (
            "rviz2 is started without -d and a file, so it opens its own default instead of the lab's configuration"
        )
        self.references.append(Reference("rviz", None, self.place(made.at), message))

    def _why(self, arguments: Value, made: Made, context: Context) -> Unknown:
        pieces = arguments if isinstance(arguments, list | tuple) else [arguments]
        unknown = (resolve(piece, context) for piece in pieces)
        found = next((each for each in unknown if isinstance(each, Unknown)), None)
        return found or Unknown("which file it opens is told only by a run", made.at)

    def _refer(self, purpose: Purpose, path: "str | Unknown", made: Made, value: Value = None) -> None:
        where = self.place(_spot(value, made))
        if isinstance(path, Unknown):
            self.references.append(Reference(purpose, None, where, path.reason, sure=False))
        else:
            self.references.append(Reference(purpose, path, where))

    def _include(self, made: Made, context: Context, when: bool | None) -> None:
        if when is False:
            return
        path = resolve(made.argument(0, "launch_description_source"), context)
        given = arguments_of(made.argument(1, "launch_arguments"))
        if not isinstance(path, str) or given is None:
            reason = path.reason if isinstance(path, Unknown) else "what is included is told only by a run"
            self.unknown.append(Fault(reason, self.place(made.at)))
            return
        inner = Context(path.rpartition("/")[0], {**context.arguments, **given})
        known = _URDF_LAUNCH.fullmatch(path)
        if known is not None:
            self._urdf_launch(known["name"], made, inner, when)
        else:
            if not self.include(path, inner):
                self.unknown.append(Fault(f"it includes {path.rpartition('/')[2]}, which is not part of the submission",
                                          self.place(made.at)))  # fmt: skip
            self._refer("include", path, made)
        for name, value in inner.arguments.items():  # an include shares its arguments with what follows
            context.arguments.setdefault(name, value)

    def _urdf_launch(self, name: str, made: Made, context: Context, when: bool | None) -> None:
        """What urdf_launch's own files do with their arguments."""
        started = [_DESCRIBED]
        package, path = (
            resolve(context.arguments.get(each), context) for each in ("urdf_package", "urdf_package_path")
        )
        if isinstance(package, str) and isinstance(path, str):
            self._refer("urdf", f"{SHARE}/{package}/{path}", made)
        else:
            message = "urdf_launch needs the arguments urdf_package and urdf_package_path"
            unknown = next(each for each in (package, path) if not isinstance(each, str))
            told = context.arguments.get("urdf_package") is None or context.arguments.get("urdf_package_path") is None
            reason = message if told or not isinstance(unknown, Unknown) else unknown.reason
            self.references.append(Reference("urdf", None, self.place(made.at), reason, sure=told))
        if name == "display":
            started += ["joint_state_publisher_gui", _SHOWS]
            config = context.arguments.get("rviz_config")
            shown = resolve(config, context) if config is not None else None
            if isinstance(shown, str | Unknown):
                self._refer("rviz", shown, made)
            else:
                message = (
                    "urdf_launch is included without rviz_config, so it opens its own configuration, not the lab's"
                )
                self.references.append(Reference("rviz", None, self.place(made.at), message))
        self.nodes += [StartedNode(each, each, when, self.place(made.at)) for each in started]


def _both(one: bool | None, other: bool | None) -> bool | None:
    """Whether both conditions hold, where each may be unknown."""
    if one is False or other is False:
        return False
    return None if one is None or other is None else True


def _spot(value: Value, made: Made) -> Spot:
    return value.at if isinstance(value, Made) else made.at
