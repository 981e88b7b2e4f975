"""Goes through a launch description: which nodes it starts, which files they are given, what it includes."""

import re
from collections.abc import Callable
from dataclasses import dataclass, field

from grader.names import did_you_mean
from grader.package.launch.conditions import holds
from grader.package.launch.model import Fault, StartedNode
from grader.package.launch.named_files import DESCRIBED, SHOWS, NamedFiles
from grader.package.launch.substitutions import UNTOLD, Context, arguments_of, resolve
from grader.source import Location
from grader.static_python.values import Function, Made, Named, Spot, Unknown, Value

_NODES = ("Node", "LifecycleNode")
_MOST_ACTIONS = 5_000
_MOST_DEPTH = 40
CIRCLE = "it includes itself, without end"
# What urdf_launch's two launch files start (ROS 2 package urdf_launch).
_URDF_LAUNCH = re.compile(r".*/share/urdf_launch/launch/(?P<name>display|description)\.launch\.py")
# Actions that start nothing.
_IDLE = re.compile(r"(?:Set|Unset|Push|Pop|Log|Append|Prepend|Reset|Replace|Clear|Emit|Shutdown|Unregister)\w*")
_NO_PACKAGE = Unknown("a node without a package is a program of the machine", Spot(1, 1))
_IN_CONTAINERS = ("ComposableNodeContainer", "LoadComposableNodes", "ComposableNode", "ComposableLifecycleNode")
# What launch_ros.actions.Node takes, and what it hands on to launch.actions.ExecuteProcess (ROS 2 Jazzy).
_NODE_TAKES = frozenset(
    {"package", "executable", "name", "namespace", "exec_name", "parameters", "remappings", "ros_arguments", "arguments",
     "prefix", "cwd", "env", "additional_env", "shell", "sigterm_timeout", "sigkill_timeout", "emulate_tty", "output",
     "output_format", "cached_output", "log_cmd", "on_exit", "respawn", "respawn_delay", "respawn_max_retries", "condition",
     "autostart", "?", "**"}
)  # fmt: skip

# Takes the path of a launch file below the prefix and the arguments for it; says why it is not followed, if it is not.
Include = Callable[[str, Context], str]


@dataclass(slots=True)
class Follower:
    """What was found so far in one launch file and those that it includes."""

    place: Callable[[Spot], Location]
    include: Include
    call: Callable[[Function, Spot, tuple[Value, ...]], Value]
    nodes: list[StartedNode] = field(default_factory=list)
    faults: list[Fault] = field(default_factory=list)
    unknown: list[Fault] = field(default_factory=list)
    seen: set[int] = field(default_factory=set)
    steps: int = 0
    files: NamedFiles = field(init=False)

    def __post_init__(self) -> None:
        self.files = NamedFiles(self.place)

    def description(self, value: Value, context: Context) -> None:
        """Follow what generate_launch_description returns."""
        self._actions(value, context, when=context.when, depth=0)

    def _actions(self, value: Value, context: Context, *, when: bool | None, depth: int) -> None:
        self.steps += 1
        if depth > _MOST_DEPTH or self.steps > _MOST_ACTIONS:
            self._untold("it holds more than is followed", Spot(1, 1))
            return
        match value:
            case list() | tuple():
                for each in value:
                    if self.steps > _MOST_ACTIONS:
                        return
                    self._actions(each, context, when=when, depth=depth + 1)
            case dict():
                self._actions(list(value.values()), context, when=when, depth=depth + 1)
            case Unknown():
                self._untold(value.reason, value.at)
            case Named():
                self._untold(f"what {value.name} gives is told only by a run", Spot(1, 1))
            case Made():
                undeclared, wrong = len(context.undeclared), len(context.wrong)
                executed = self._when(value, context, when)
                self._complain(context, undeclared, wrong, sure=when is True)  # the launch comes to its condition
                self._action(value, context, when=executed, depth=depth)
                self._complain(context, undeclared, wrong, sure=executed is True)

    def _complain(self, context: Context, undeclared: int, wrong: int, *, sure: bool) -> None:
        """Report what was wrong with an action, if it is certain that the launch comes to it."""
        messages = [
            (f"the launch argument {name!r} is used, but DeclareLaunchArgument does not declare it before", spot)
            for name, spot in context.undeclared[undeclared:]
        ]
        for message, spot in [*messages, *context.wrong[wrong:]] if sure else ():
            self.faults.append(Fault(message, self.place(spot)))
        del context.undeclared[undeclared:], context.wrong[wrong:]

    def _untold(self, reason: str, spot: Spot) -> None:
        fault = Fault(reason, self.place(spot))
        if fault not in self.unknown[-3:]:
            self.unknown.append(fault)

    def _when(self, made: Made, context: Context, when: bool | None) -> bool | None:
        """Whether an action is executed: `when` is whether that around it is."""
        if "?" in made.kwargs or "**" in made.kwargs:
            when = None if when else when
        return _both(when, holds(made.kwargs.get("condition"), context))

    def _action(self, made: Made, context: Context, *, when: bool | None, depth: int) -> None:
        self.seen.add(id(made))
        last = made.name.rpartition(".")[2]
        match last:
            case "DeclareLaunchArgument" | "DeclareBooleanLaunchArgument" | "SetLaunchConfiguration":
                self._set(made, context, when, declares=last.startswith("Declare"))
            case _ if last in _NODES:
                self._node(made, context, when)
            case "ExecuteProcess" | "ExecuteLocal":
                self._process(made, context, when)
            case "IncludeLaunchDescription":
                self._include(made, context, when)
            case "LaunchDescription":
                self._launch_description(made, context, when, depth)
            case "GroupAction":
                self._group(made, context, when, depth)
            case "TimerAction" | "RosTimer":
                _needs_list(made, made.argument(1, "actions"), context)
                self._actions(made.argument(1, "actions"), context, when=when, depth=depth + 1)
            case "RegisterEventHandler":
                self._actions(made.argument(0, "event_handler"), context, when=when, depth=depth + 1)
            case _ if last.startswith("On") and last[2:3].isupper():
                self._handler(made, context, when if last == "OnProcessStart" else when and None, depth)
            case "OpaqueFunction":
                self._opaque(made, context, when, depth)
            case _ if last in _IN_CONTAINERS:
                self._untold("what a container of nodes starts is not followed", made.at)
            case _ if _IDLE.fullmatch(last) and made.name.startswith(("launch.", "launch_ros.")):
                self.files.sets_parameters |= last in ("SetParameter", "SetParametersFromFile")
            case _ if not made.name.startswith("?."):
                self._untold(f"what {last} starts is told only by a run", made.at)

    def _set(self, made: Made, context: Context, when: bool | None, *, declares: bool) -> None:
        """A launch argument that is declared, or set: from here on it has a value."""
        name = resolve(made.argument(0, "name"), context)
        if when is False or not isinstance(name, str) or (declares and name in context.arguments):
            return
        value = made.argument(1, "default_value", "value")
        _check_value(made, name, value, context, declares=declares)
        if when is None:
            known: Value = Unknown(f"the launch argument {name!r} is set under a condition", made.at)
        elif value is None:
            known = Unknown(f"the launch argument {name!r} has no default", made.at)
        else:
            known = resolve(value, context)
        context.arguments[name] = known

    def _launch_description(self, made: Made, context: Context, when: bool | None, depth: int) -> None:
        given = made.argument(0, "initial_entities")
        if isinstance(given, Made) or len(made.args) > 1:
            context.wrong.append(("LaunchDescription takes one list: put [ ] around what is launched", made.at))
        self._listed(list(made.args[1:]) if len(made.args) > 1 else [], made, context, when, depth)
        self._listed(given, made, context, when, depth)
        for each in made.calls:
            if each.name.endswith((".add_action", ".add_entity")):
                self._listed(each.args, each, context, _both(when, None if "?" in each.kwargs else True), depth)

    def _listed(self, value: Value, made: Made, context: Context, when: bool | None, depth: int) -> None:
        """The actions of a description, which may not be in lists of their own."""
        if isinstance(value, list | tuple) and any(isinstance(each, list | tuple) for each in value):
            context.wrong.append(("an action is expected here, and this is a list of some: write * before it", made.at))
        self._actions(value if value is not None else [], context, when=when, depth=depth + 1)

    def _group(self, made: Made, context: Context, when: bool | None, depth: int) -> None:
        """A group of actions: what is set in it ends with it, unless scoped is False."""
        before = dict(context.arguments)
        own = made.kwargs.get("launch_configurations")
        for name, value in own.items() if isinstance(own, dict) else ():
            context.arguments[str(name)] = resolve(value, context)
        _needs_list(made, made.argument(0, "actions"), context)
        self._actions(made.argument(0, "actions"), context, when=when, depth=depth + 1)
        if made.kwargs.get("scoped", True) is not False:
            context.arguments.clear()
            context.arguments.update(before)

    def _handler(self, made: Made, context: Context, when: bool | None, depth: int) -> None:
        """What is started when something happens: it is certain only of the start of another process."""
        for name, value in made.kwargs.items():
            if name.startswith("on_") or name == "entities":
                made_now = self.call(value, made.at, ()) if isinstance(value, Function) else value
                self._actions(made_now if made_now is not None else [], context, when=when, depth=depth + 1)

    def _opaque(self, made: Made, context: Context, when: bool | None, depth: int) -> None:
        function, args = made.argument(0, "function"), made.kwargs.get("args") or []
        if not isinstance(function, Function) or not isinstance(args, list | tuple) or made.kwargs.get("kwargs"):
            self._untold("what an OpaqueFunction gives is told only by a run", made.at)
            return
        given = self.call(function, made.at, (Made("launch.LaunchContext", [], {}, made.at), *args))
        self._actions(given if given is not None else [], context, when=when, depth=depth + 1)

    def _node(self, made: Made, context: Context, when: bool | None) -> None:
        for name in made.kwargs.keys() - _NODE_TAKES:
            context.wrong.append((f"Node takes no argument {name!r}{did_you_mean(name, _NODE_TAKES)}", made.at))
        if made.args:
            context.wrong.append(("Node takes its arguments by name: package=..., executable=...", made.at))
        if made.kwargs.keys().isdisjoint(("executable", "node_executable", "**")):
            context.wrong.append(("a node has no executable: it is not said which program it is", made.at))
        package = resolve(made.kwargs.get("package", _NO_PACKAGE), context)
        executable = resolve(made.kwargs.get("executable", made.kwargs.get("node_executable")), context)
        if not isinstance(package, str) or not isinstance(executable, str):
            what = next(each for each in (package, executable) if not isinstance(each, str))
            reason = what.reason if isinstance(what, Unknown) else "which program a node is, is told only by a run"
            self._untold(reason, made.at)
            return
        self._started(package, executable, made, context, when)

    def _started(self, package: str, executable: str, made: Made, context: Context, when: bool | None) -> None:
        self.nodes.append(StartedNode(package, executable, when, self.place(made.at)))
        if when is False:
            return
        for name in ("parameters", "arguments", "remappings"):
            if isinstance(made.kwargs.get(name), str | dict):
                context.wrong.append((f"{name} has to be a list: put [ ] around it", made.at))
        if executable == DESCRIBED:
            self.files.described(made, context)
        elif executable == SHOWS:
            self.files.shown(made.kwargs.get("arguments", made.kwargs.get("**")), made, context)

    def _process(self, made: Made, context: Context, when: bool | None) -> None:
        """A command that starts a node: ros2 run, or rviz2 by itself."""
        command = made.argument(0, "cmd")
        words = self.files.words(command, context)
        if made.kwargs.get("shell") is True:
            words = " ".join(words).split()
        match words:
            case ["ros2", "run", package, executable, *rest]:
                self._started(package, executable, _as_node(made, rest), context, when)
            case ["rviz2" as executable, *rest]:
                self._started(executable, executable, _as_node(made, rest), context, when)
            case ["ros2", "launch", *_] if when is not False:
                self._untold("it starts ros2 launch once more", made.at)

    def _include(self, made: Made, context: Context, when: bool | None) -> None:
        if when is False:
            return
        path = resolve(made.argument(0, "launch_description_source"), context)
        given = arguments_of(made.argument(1, "launch_arguments"), context, made.at)
        if not isinstance(path, str) or given is None:
            self._untold(
                path.reason if isinstance(path, Unknown) else "what is included is told only by a run", made.at
            )
            return
        inner = Context(path.rpartition("/")[0], {**context.arguments, **given}, when=when, left=context.left)
        known = _URDF_LAUNCH.fullmatch(path)
        if known is not None:
            started = self.files.urdf_launch(known["name"], made, inner)
            self.nodes += [StartedNode(each, each, when, self.place(made.at)) for each in started]
        else:
            self._included(path, made, inner, when)
        context.arguments.update(inner.arguments)  # an include shares its arguments with what follows

    def _included(self, path: str, made: Made, inner: Context, when: bool | None) -> None:
        reason = self.include(path, inner)
        if reason == CIRCLE and when:
            self.faults.append(Fault(reason, self.place(made.at)))
        elif reason:
            self._untold(reason, made.at)
        self.files.refer("include", path, made)


def _check_value(made: Made, name: str, value: Value, context: Context, *, declares: bool) -> None:
    """Note a value of a launch argument that launch does not take."""
    given = made.kwargs.get("choices")
    choices = list(given) if declares and isinstance(given, list | tuple) else []
    if declares and len(made.args) > 1:
        context.wrong.append(("DeclareLaunchArgument takes its default by name: default_value=...", made.at))
    if choices and all(isinstance(each, str) for each in [value, *choices]) and value not in choices:
        context.wrong.append((f"the default {value!r} of {name!r} is none of its choices", made.at))
    if isinstance(value, int | float):
        told = str(value).lower() if isinstance(value, bool) else str(value)
        context.wrong.append((f"the value of a launch argument is a text: write {told!r}", made.at))


def _needs_list(made: Made, actions: Value, context: Context) -> None:
    if isinstance(actions, Made):
        last = made.name.rpartition(".")[2]
        context.wrong.append((f"{last} takes a list of actions: put [ ] around them", made.at))


def _both(one: bool | None, other: bool | None) -> bool | None:
    """Whether both conditions hold, where each may be unknown."""
    if one is False or other is False:
        return False
    return None if one is None or other is None else True


def _as_node(made: Made, words: list[str]) -> Made:
    """A command as the node that it starts."""
    arguments: list[Value] = [Unknown("a part of the command is told only by a run", made.at) if word == UNTOLD else word
                              for word in words]  # fmt: skip
    return Made(made.name, [], {"arguments": arguments}, made.at)
