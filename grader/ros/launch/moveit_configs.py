"""The package moveit_configs_utils of ROS 2 Jazzy: MoveItConfigsBuilder and launch functions.

The launch functions start nodes.

The builder reads the files of a MoveIt configuration while the launch file is loaded; one that it
needs and that is not installed stops it.
"""

import posixpath
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import PurePosixPath
from typing import Any

from grader.base.grouping import StringsByName, known_values
from grader.files.limits import SETUP_ASSISTANT
from grader.ros.config.yaml_nodes import YamlFault, YamlNode, read_yaml, yaml_value
from grader.ros.installation.places import BY_MOVEIT, PREFIX, SHARE
from grader.ros.known.package_tables import StartRow, launch_functions
from grader.ros.launch.launch_classes import DESCRIPTION
from grader.ros.launch.launch_model import (
    Contents,
    Context,
    FileText,
    UnknownTable,
    UnknownText,
    texts_by_name,
)
from grader.ros.python.evaluation import Evaluation
from grader.ros.python.parse import Position
from grader.ros.python.values import (
    Call,
    EvaluationFails,
    Namespace,
    PlainFunction,
    Undetermined,
    Unknown,
    Value,
    known,
    path_text,
)

_Given = Mapping[str, Value]  # arguments by their names

_Table = dict[str, Value]

_PACKAGE = "moveit_configs_utils"
_BUILDER = f"{_PACKAGE}.moveit_configs_builder.MoveItConfigsBuilder"
_BUILDER_CLASSES = ("MoveItConfigs", "MoveItConfigsBuilder")
_LAUNCHES = f"{_PACKAGE}.launches"
_NODE = "launch_ros.actions.node.Node"
_INCLUDE = "launch.actions.include_launch_description.IncludeLaunchDescription"
_DECLARED = "launch.actions.declare_launch_argument.DeclareLaunchArgument"
_CONFIGURATION = "launch.substitutions.launch_configuration.LaunchConfiguration"
_IF, _UNLESS = (
    f"launch.conditions.{condition}"
    for condition in ("if_condition.IfCondition", "unless_condition.UnlessCondition")
)
_MAX_DEPTH = 40
_MAX_NUMBER = 50
_DEFAULT_PIPELINES = (
    "chomp",
    "ompl",
    "pilz_industrial_motion_planner",
    "stomp",
)  # of moveit_configs_utils
_PILZ = "pilz_industrial_motion_planner"
_MONITOR = {
    "publish_planning_scene": True,
    "publish_geometry_updates": True,
    "publish_state_updates": True,
    "publish_transforms_updates": True,
    "publish_robot_description": False,
    "publish_robot_description_semantic": False,
}
# The parts of a configuration in the order of to_dict. All but the last are made by default.
_PARTS = (
    "robot_description",
    "robot_description_semantic",
    "robot_description_kinematics",
    "planning_pipelines",
    "trajectory_execution",
    "planning_scene_monitor",
    "sensors_3d",
    "joint_limits",
    "moveit_cpp",
)
_DEFAULT_PARTS = _PARTS[:-1]
_PARAMETERS: Mapping[str, Sequence[str]] = {
    "robot_description": ("file_path", "mappings"),
    "robot_description_semantic": ("file_path", "mappings"),
    "trajectory_execution": ("file_path", "moveit_manage_controllers"),
    "planning_scene_monitor": tuple(_MONITOR),
    "planning_pipelines": ("default_planning_pipeline", "pipelines", "load_all"),
    **dict.fromkeys(
        (
            "robot_description_kinematics",
            "joint_limits",
            "moveit_cpp",
            "sensors_3d",
            "pilz_cartesian_limits",
        ),
        ("file_path",),
    ),
}
# What a part is called in the parameters after the name of the robot's, and the file that it is
# read from by default.
_YAML_PARTS = {
    "robot_description_kinematics": ("_kinematics", "kinematics"),
    "joint_limits": ("_planning", "joint_limits"),
    "pilz_cartesian_limits": ("_planning", "pilz_cartesian_limits"),
    "moveit_cpp": ("", "moveit_cpp"),
}


def moveit_exports() -> Mapping[str, Sequence[str]]:
    """Return the names of the modules of moveit_configs_utils."""
    of_both = ("DeclareLaunchArgument", "IfCondition", "LaunchConfiguration", "Node")
    return {
        _PACKAGE: (
            *_BUILDER_CLASSES,
            "launches",
            "launch_utils",
            "moveit_configs_builder",
            "substitutions",
        ),
        f"{_PACKAGE}.moveit_configs_builder": (
            *_BUILDER_CLASSES,
            "get_pattern_matches",
            "moveit_configs_utils_path",
        ),
        f"{_PACKAGE}.launch_utils": (
            *of_both,
            "UnlessCondition",
            "add_debuggable_node",
            "DeclareBooleanLaunchArg",
        ),
        _LAUNCHES: (
            *launch_functions(),
            *of_both,
            "add_debuggable_node",
            "DeclareBooleanLaunchArg",
            "LaunchDescription",
            "IncludeLaunchDescription",
            "ParameterValue",
            "PythonLaunchDescriptionSource",
            "SRDF",
            "os",
        ),
    }


@dataclass(slots=True)
class _Configuration:
    """A MoveIt configuration while it is built."""

    robot: str
    folder: str  # the share folder of its package
    description: str  # the name of the parameter
    doubt: Callable[[Unknown], Unknown]
    parts: dict[str, _Table] = field(default_factory=dict)

    def doubted(self, reason: str, at: Position) -> UnknownText:
        """Return a text that is not known, with the doubt whether MoveIt finds it at all."""
        unknown = UnknownText(reason, at)
        self.doubt(unknown)
        return unknown


@dataclass(slots=True)
class MoveItConfigurations:
    """The functions of moveit_configs_utils, in a launch file whose context is `context()`.

    `reads` are its files.
    """

    context: Callable[[], Context]
    reads: list[tuple[Contents, Position]]
    _built: dict[Call, _Configuration] = field(default_factory=dict)

    def functions(self) -> dict[str, Callable[[Evaluation, Call], Value]]:
        """Return the functions by their full names."""
        steps = {f"{_BUILDER}.{name}": partial(self._step, name) for name in _PARAMETERS}
        return {
            f"{_PACKAGE}.MoveItConfigsBuilder": self._build,
            _BUILDER: self._build,
            **steps,
            f"{_BUILDER}.to_moveit_configs": self._finish,
            f"{_BUILDER}.to_dict": lambda evaluation, call: (
                self._finish(evaluation, call).find("to_dict").run()
            ),
            **{f"{_LAUNCHES}.{name}": partial(self._start, name) for name in launch_functions()},
        }

    def _build(self, evaluation: Evaluation, call: Call) -> Call:
        given = _named(call, ("robot_name", "robot_description", "package_name"))
        robot, description = (
            known(given.get(argument, "robot_description"))
            for argument in ("robot_name", "robot_description")
        )
        if "robot_name" not in given or not isinstance(robot, str):
            raise EvaluationFails("MoveItConfigsBuilder needs the name of the robot")
        package = known(given.get("package_name")) or f"{robot}_moveit_config"
        for name in (_PACKAGE, package):
            if not self.context().machine.has_package(name):
                evaluation.doubted(
                    Unknown(f"whether the package {name!r} is installed is not evaluated", call.at)
                )
        made = Call(_BUILDER, [], {}, call.at)
        made.is_object = True
        self._built[made] = _Configuration(
            robot, f"{SHARE}/{package}", description, evaluation.doubted
        )
        return made

    def _step(self, name: str, _: Evaluation, call: Call) -> Call:
        assert call.owner
        self._made(self._built[call.owner], name, call.at, _named(call, _PARAMETERS[name]))
        return call.owner

    def _finish(self, _: Evaluation, call: Call) -> Namespace:
        """Return the configuration, with what is made by default, as an object with its parts."""
        assert call.owner
        configuration = self._built[call.owner]
        for name in _DEFAULT_PARTS:
            if not configuration.parts.get(name):
                self._made(configuration, name, call.at, {})
        if (
            _PILZ in configuration.parts["planning_pipelines"]
            and "pilz_cartesian_limits" not in configuration.parts
        ):
            self._made(configuration, "pilz_cartesian_limits", call.at, {})
        parts: _Table = {
            name: configuration.parts.get(name, {}) for name in (*_PARTS, "pilz_cartesian_limits")
        }
        parts["package_path"] = PurePosixPath(configuration.folder)
        parts["move_group_capabilities"] = {"capabilities": "", "disable_capabilities": ""}
        parts["to_dict"] = PlainFunction("to_dict", partial(_as_dict, parts), "holds")

        def find(name: str) -> Value:
            if name not in parts:
                raise EvaluationFails(f"MoveItConfigs has no attribute {name!r}", call.at)
            return parts[name]

        return Namespace("MoveItConfigs", find)

    def _made(self, configuration: _Configuration, name: str, at: Position, given: _Given) -> None:
        """Make a part of a configuration, as the method of this name does."""
        if name in _YAML_PARTS:
            ending, stem = _YAML_PARTS[name]
            table = self._yaml(self._path(configuration, given, f"config/{stem}.yaml"), at)
            configuration.parts[name] = (
                {configuration.description + ending: table} if ending else _spread(table)
            )
        else:
            make = {
                "robot_description": self._description,
                "robot_description_semantic": self._semantic,
                "planning_pipelines": self._pipelines,
                "trajectory_execution": self._controllers,
                "sensors_3d": self._sensors,
                "planning_scene_monitor": self._scene,
            }
            configuration.parts[name] = make[name](configuration, at, given)

    def _path(self, configuration: _Configuration, given: _Given, default: str) -> str:
        """Return the path of a file that is given, or a default, in the package."""
        value = given.get("file_path")
        text = path_text(known(value)) if value is not None else default
        if text is None:
            raise Undetermined("the path of a file for MoveIt is not evaluated")
        return posixpath.join(configuration.folder, text)

    def _names(self, configuration: _Configuration) -> Sequence[str] | None:
        """Return the names of the files that are installed in the folder config.

        Returns None where this is not known.
        """
        return self.context().machine.files_in(
            f"{configuration.folder}/config".removeprefix(f"{PREFIX}/")
        )

    def _is_there(self, path: str) -> bool:
        return self.context().find_text(path) is not None

    def _read(self, path: str, at: Position, by: str, arguments: Any = ()) -> Contents:
        contents = Contents(path, by, arguments)
        self.reads.append((contents, at))
        return contents

    def _yaml(self, path: str, at: Position) -> Value:
        """Return the table in a file that has to be there."""
        self._read(path, at, BY_MOVEIT)
        opened = self.context().machine.open_installed(
            posixpath.normpath(path).removeprefix(f"{PREFIX}/")
        )
        if opened is None:
            return UnknownTable("a file for MoveIt is not evaluated", at)
        try:
            return _read_value(read_yaml(*opened), 0)
        except (YamlFault, Undetermined, ValueError) as error:
            raise Undetermined(f"the file {opened[1]} is not evaluated: {error}", at) from None

    def _robot_of_assistant(self, configuration: _Configuration, at: Position) -> str | None:
        """Return the path of the robot that .setup_assistant names, if it names one."""
        path = f"{configuration.folder}/{SETUP_ASSISTANT}"
        table = self._yaml(path, at) if self._is_there(path) else None
        config = table.get("moveit_setup_assistant_config") if isinstance(table, dict) else None
        robot = config.get("urdf", config.get("URDF")) if isinstance(config, dict) else None
        package, file = (
            robot.get(key) if isinstance(robot, dict) else None
            for key in ("package", "relative_path")
        )
        if isinstance(package, str) and isinstance(file, str):
            return f"{SHARE}/{package}/{file}"
        return None

    def _description(self, configuration: _Configuration, at: Position, given: _Given) -> _Table:
        """Return the robot; if its file is not there, MoveIt waits for a topic."""
        path = self._path(configuration, given, f"config/{configuration.robot}.urdf.xacro")
        if "file_path" not in given:
            path = self._robot_of_assistant(configuration, at) or path
        is_there = self._is_there(path)
        if not is_there and "file_path" not in given:
            return {
                configuration.description: configuration.doubted(
                    "the file of the robot that MoveIt finds is not evaluated", at
                )
            }
        if is_there:
            contents = self._read(path, at, "xacro", _mappings(given))
        else:
            contents = Contents(path, "xacro")
        return {
            configuration.description: FileText(
                "the output of xacro is not evaluated", at, contents
            )
        }

    def _semantic(self, configuration: _Configuration, at: Position, given: _Given) -> _Table:
        path = self._path(configuration, given, f"config/{configuration.robot}.srdf")
        key = f"{configuration.description}_semantic"
        is_open = "file_path" not in given and any(
            name.endswith(".srdf") for name in self._names(configuration) or ()
        )
        if is_open and not self._is_there(path):
            return {key: configuration.doubted("the SRDF that MoveIt finds is not evaluated", at)}
        contents = self._read(path, at, "xacro", _mappings(given))
        return {key: FileText("the output of xacro is not evaluated", at, contents)}

    def _pipelines(self, configuration: _Configuration, at: Position, given: _Given) -> _Table:
        names = self._names(configuration)
        ending = "_planning.yaml"
        wanted, default = (
            known(given.get(argument)) for argument in ("pipelines", "default_planning_pipeline")
        )
        configured = [name.removesuffix(ending) for name in names or () if name.endswith(ending)]
        pipelines = wanted
        unordered = None
        if wanted is None:
            with_all = given.get("load_all", True)
            if names is None and not with_all:
                raise Undetermined("the pipelines of MoveIt are not evaluated", at)
            others = _DEFAULT_PIPELINES if with_all else ()
            pipelines = list(dict.fromkeys([*configured, *others]))
            unordered = UnknownText("the order in which files are found is not known", at)
        if not isinstance(pipelines, list | tuple):
            raise Undetermined("the pipelines of MoveIt are not evaluated", at)
        default = _default_pipeline(pipelines, default, at)
        tables = {
            pipeline: self._pipeline(configuration, pipeline, at, is_there=pipeline in configured)
            for pipeline in map(str, pipelines)
        }
        return {
            "planning_pipelines": unordered or list(pipelines),
            "default_planning_pipeline": default,
            **tables,
        }

    def _pipeline(
        self, configuration: _Configuration, name: str, at: Position, *, is_there: bool
    ) -> Value:
        if not is_there and name in _DEFAULT_PIPELINES:
            return UnknownTable(f"the default configuration of {name} is not evaluated", at)
        table = self._yaml(f"{configuration.folder}/config/{name}_planning.yaml", at)
        is_whole = name != "ompl" or (isinstance(table, dict) and "planner_configs" in table)
        if is_whole:
            return table
        return UnknownTable("the default configuration of ompl is not evaluated", at)

    def _controllers(self, configuration: _Configuration, at: Position, given: _Given) -> _Table:
        manages = given.get("moveit_manage_controllers", True)
        made = {"moveit_manage_controllers": manages}
        if "file_path" in given:
            return made | _spread(self._yaml(self._path(configuration, given, ""), at))
        ending = "_controllers.yaml"
        names = self._names(configuration)
        for name in ("moveit", "moveit2", configuration.robot):
            path = f"{configuration.folder}/config/{name}{ending}"
            if self._is_there(path):
                return made | _spread(self._yaml(path, at))
        if names is None:
            reason = "the controllers that MoveIt finds are not evaluated"
            return made | _spread(UnknownTable(reason, at))
        fitting = [name for name in names if name.endswith(ending)]
        if not fitting:
            return made
        if len(fitting) > 1:
            listed = ", ".join(sorted(fitting))
            raise EvaluationFails(
                f"MoveIt cannot choose between {listed}: give trajectory_execution a file_path", at
            )
        return made | _spread(self._yaml(f"{configuration.folder}/config/{fitting[0]}", at))

    def _sensors(self, configuration: _Configuration, at: Position, given: _Given) -> _Table:
        path = self._path(configuration, given, "config/sensors_3d.yaml")
        if not self._is_there(path):
            if self._names(configuration) is not None:
                return {}
            return _spread(UnknownTable("sensors are not evaluated", at))
        table = self._yaml(path, at)
        sensors = table.get("sensors") if isinstance(table, dict) else None
        if isinstance(sensors, list) and sensors and sensors[0]:
            return _spread(table)
        return {}

    def _scene(self, _: _Configuration, __: Position, given: _Given) -> _Table:
        return {**_MONITOR, **given}

    def _start(self, name: str, _: Evaluation, call: Call) -> Value:
        """Return the description that a function of moveit_configs_utils.launches makes."""
        given = _named(call, ("moveit_config", "launch_package_path"))
        configs = given.get("moveit_config")
        if not isinstance(configs, Namespace):
            raise Undetermined("the configuration of MoveIt is not evaluated", call.at)
        package = str(configs.find("package_path"))
        folder = given.get("launch_package_path")
        folders = {"package": package, "folder": str(known(folder)) if folder else package}
        make = _Actions(call.at, configs, folders)
        launch = launch_functions()[name]
        rows: list[StartRow | Unknown] = [
            row
            for row in launch.start
            if not row.optional or self._is_there(make.value(row.include))
        ]
        rows += self._found_in(configs, name, call.at)
        actions: list[Value] = []
        for argument, default in launch.flags.items():
            actions.append(make.argument(argument, default, is_flag=True))
        for argument, default in launch.arguments.items():
            actions.append(make.argument(argument, default, is_flag=False))
        for row in rows:
            if isinstance(row, Unknown):
                actions.append(row)
            else:
                actions += make.started(row)
        return Call(DESCRIPTION, [], {"initial_entities": actions}, call.at)

    def _found_in(
        self, configs: Namespace, name: str, at: Position
    ) -> Iterator[StartRow | Unknown]:
        """Yield the rows of what a function starts for controllers or virtual joints.

        Yields Unknown for unknown ones.
        """
        if name == "generate_spawn_controllers_launch":
            for controller in _controllers_in(configs.find("trajectory_execution"), at):
                if isinstance(controller, Unknown):
                    yield controller
                else:
                    yield StartRow("controller_manager/spawner", arguments=(controller,))
        elif name == "generate_static_virtual_joint_tfs_launch":
            srdf = next(iter(configs.find("robot_description_semantic").values()))
            if isinstance(srdf, FileText):
                text = self.context().find_text(srdf.contents.path)
            else:
                text = None
            if text is None or "xacro:" in text:
                yield Unknown("the virtual joints of the SRDF are not evaluated", at)
                return
            for words in _virtual_joints(text):
                yield StartRow("tf2_ros/static_transform_publisher", arguments=tuple(words))


def _named(call: Call, names: Sequence[str]) -> _Table:
    """Return the arguments of a call by their names, but those that are None.

    Raises EvaluationFails.
    """
    wrong = next((name for name in call.kwargs if name not in names), None)
    if wrong is not None or len(call.args) > len(names):
        what = f"no argument {wrong!r}" if wrong is not None else f"at most {len(names)} arguments"
        raise EvaluationFails(f"{call.short} takes {what}", call.at)
    given = dict(zip(names, call.args, strict=False)) | call.kwargs
    return known_values(given)


def _mappings(given: _Given) -> tuple[tuple[str, str | None], ...]:
    """Return the arguments that xacro gets; None for one that is a substitution."""
    table = given.get("mappings", {})
    if not isinstance(table, dict):
        raise Undetermined("the mappings for xacro are not evaluated")
    return texts_by_name(table)


def _read_value(node: YamlNode, depth: int) -> Value:
    """Return the value of YAML as PyYAML reads it. Raises Undetermined."""
    if depth > _MAX_DEPTH:
        raise Undetermined("it is nested too deeply")
    match node.value:
        case dict() as table:
            return {name: _read_value(entry, depth + 1) for name, entry in table.items()}
        case list() as items:
            return [_read_value(element, depth + 1) for element in items]
        case str() as text:
            if node.is_string or len(text) > _MAX_NUMBER:
                return text
            return yaml_value(text)


def _spread(table: Value) -> _Table:
    """Return a table that becomes a part of another one; unknown ones have any name."""
    if isinstance(table, dict):
        return dict(table)
    return {"": table}


def _default_pipeline(pipelines: Sequence[Value], wanted: Value, at: Position) -> Value:
    """Return the pipeline that MoveIt uses by default: the wanted one, OMPL, or the first."""
    if not pipelines:
        raise EvaluationFails("MoveIt finds no *_planning.yaml", at)
    default = wanted or ("ompl" if "ompl" in pipelines else pipelines[0])
    if default not in pipelines:
        names = ", ".join(map(str, pipelines))
        raise EvaluationFails(f"the default pipeline {default!r} is none of {names}", at)
    return default


def _as_dict(parts: _Given) -> _Table:
    entries: _Table = {}
    for name in _PARTS:
        entries |= parts[name]
    for name, table in parts["pilz_cartesian_limits"].items():
        limits = entries.get(name)
        if isinstance(limits, dict) and isinstance(table, dict):
            entries[name] = {**limits, **table}
        elif isinstance(table, Unknown):
            entries[name] = table
    return entries


@dataclass(frozen=True, slots=True)
class _Actions:
    """Makes the actions of a description from the rows of the table.

    They are made as if they were written at a place.
    """

    at: Position
    configs: Namespace
    folders: StringsByName

    def made(self, kind: str, **kwargs: Value) -> Call:
        """Return an action, condition or substitution; arguments that are None are ignored."""
        return Call(kind, [], known_values(kwargs), self.at)

    def argument(self, name: str, default: str, *, is_flag: bool) -> Call:
        """Return the declaration of a launch argument."""
        choices = ["true", "false", "True", "False"] if is_flag else None
        return self.made(
            _DECLARED, name=name, default_value=default.format(**self.folders), choices=choices
        )

    def value(self, value: Any) -> Value:
        """Return a value; "$name" is that of a launch argument."""
        if isinstance(value, str) and value.startswith("$"):
            return self.made(_CONFIGURATION, variable_name=value[1:])
        if isinstance(value, str):
            return value.format(**self.folders)
        return value

    def started(self, row: StartRow) -> list[Value]:
        """Return the node or include of a row; two nodes if one has a debugger."""
        condition = self.when(row.only_if) if row.only_if else None
        if row.include:
            source = self.value(row.include)
            return [self.made(_INCLUDE, launch_description_source=source, condition=condition)]
        package, _, executable = row.node.partition("/")
        parameters = []
        for name in row.parts:
            part = self.configs.find(name)
            parameters.append(part.run() if isinstance(part, PlainFunction) else part)
        table = {name: self.value(value) for name, value in row.parameters.items()}
        if table:
            parameters.append(table)
        parameters += map(self.value, row.files)
        node = partial(
            self.made,
            _NODE,
            package=package,
            executable=executable,
            arguments=list(map(self.value, row.arguments)),
            parameters=parameters,
            remappings=list(map(tuple, row.remappings)),
        )
        if not row.debug:
            return [node(condition=condition)]
        debugged = node(condition=self.when("debug"), prefix=["gdb --ex run --args"])
        return [node(condition=self.when("debug", _UNLESS)), debugged]

    def when(self, name: str, kind: str = _IF) -> Call:
        """Return the condition that a launch argument is true, or, of another kind, not true."""
        return self.made(kind, predicate_expression=self.value(f"${name}"))


def _controllers_in(table: _Given, at: Position) -> list[Value]:
    """Return the arguments of the spawners of the controllers that MoveIt uses."""
    manager = table.get("moveit_simple_controller_manager", {})
    names = manager.get("controller_names", []) if isinstance(manager, dict) else None
    if isinstance(names, list) and "" not in table:
        return names
    return [Unknown("the controllers of MoveIt are not evaluated", at)]


def _virtual_joints(text: str) -> Iterator[list[str]]:
    """Yield the arguments of the publishers of the virtual joints in an SRDF."""
    for joint in re.findall(r"<virtual_joint\b[^<>]*>", re.sub(r"(?s)<!--.*?-->", "", text)):
        parent = re.search(r"\bparent_frame=[\"']([^\"']*)", joint)
        child = re.search(r"\bchild_link=[\"']([^\"']*)", joint)
        frame = parent[1] if parent else ""
        link = child[1] if child else ""
        yield ["--frame-id", frame, "--child-frame-id", link]
