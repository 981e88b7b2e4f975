"""Execute the actions of a launch description as launch does, without starting anything: nodes, includes, arguments."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import ClassVar

from grader.package.launch.api import CONDITION, ENTITY, SOURCE, class_named, is_a
from grader.package.launch.effects import EFFECTS
from grader.package.launch.known_files import start_known_file
from grader.package.launch.model import Context, Findings, LaunchFails, LaunchSignal, NotEvaluated, Resolved
from grader.package.launch.nodes import evaluate_node, evaluate_process, start_node, start_process
from grader.package.launch.parameters import evaluate_parameters
from grader.package.launch.substitutions import boolean, condition, known_text, resolve
from grader.package.launch.value_types import items_in, kind_of
from grader.static_python.parse import START, Position
from grader.static_python.values import UNKNOWN_KEYS, Call, Function, QualifiedName, Undetermined, Unknown, Value

_MAX_ACTIONS = 5_000
_MAX_DEPTH = 40
CIRCULAR_INCLUDE = "it includes itself"
_HANDLER = "launch.event_handler.BaseEventHandler"
_LATE = ("sigterm_timeout", "sigkill_timeout", "default_value")  # arguments that are not evaluated at once

# Takes the path of a launch file below the prefix and the context for it; returns why it is not read, or nothing.
Include = Callable[[str, Context], str]


@dataclass(slots=True)
class ActionVisitor:
    """A visitor of actions that adds its findings. `when` is whether an action is executed, None if this is unknown."""

    findings: Findings
    include: Include
    call_function: Callable[[Function, Position, Sequence[Value] | None, Context], Value]
    visited: set[int] = field(default_factory=set)  # the ids of the calls that are part of the description
    executed: dict[int, bool | None] = field(default_factory=dict)  # the processes, by id: each is executed once
    later: list[tuple[Value, Call, Context, Call | None]] = field(
        default_factory=list
    )  # what timers and events execute
    is_loaded: bool = True  # whether an action is part of the description as it is loaded
    steps: int = 0
    depth: int = 0

    def launch(self, description: Value, context: Context, at: Position) -> None:
        """Execute a description, and then what its timers and the start of its processes execute."""
        self.visit(description, context, context.when, at)
        for _ in range(_MAX_DEPTH):
            later, self.later = self.later, []
            for actions, call, own, target in later:
                is_certain = context.when if target is None else self.executed.get(id(target), False)
                self._actions(actions, call, replace(own, arguments=context.arguments), is_certain)

    def visit(self, value: Value, context: Context, when: bool | None, at: Position) -> None:
        """Visit an action."""
        self.steps += 1
        if self.depth > _MAX_DEPTH or self.steps > _MAX_ACTIONS:
            self.findings.add_unknown("a launch file with so many actions is not evaluated", START)
            self.findings.add_doubt("a launch file with so many actions is not evaluated", START)
            return
        self.depth += 1
        try:
            if isinstance(value, Unknown):
                raise NotEvaluated(value.reason, value.at)
            if isinstance(value, Call) and class_named(value.name) is None:
                raise NotEvaluated(f"the result of {value.name} is not evaluated", value.at)
            if not isinstance(value, Call) or not is_a(value.name, ENTITY):
                hint = ": write * before it" if isinstance(value, list | tuple) else ""
                raise LaunchFails(f"expected an action, found {kind_of(value)}{hint}", at)
        except LaunchSignal as signal:
            self._add_of_form(signal, context, when)
        else:
            self.visited.add(id(value))
            try:
                executed = _both(when, self._holds(value, context))
            except LaunchSignal as signal:
                self.findings.add(signal, when)
                executed = None if when is not False else False
            self._execute(value, context, executed)
        self.depth -= 1

    def _add_of_form(self, signal: LaunchSignal, context: Context, when: bool | None) -> None:
        """Add an error in the form of a description: launch looks at all of it before it executes any of it."""
        if isinstance(signal, NotEvaluated):
            self.findings.add_unknown(str(signal), signal.at)
        silent, self.findings.is_silent = self.findings.is_silent, self.findings.is_silent and not self.is_loaded
        self.findings.add(signal, context.when if self.is_loaded else when)
        self.findings.is_silent = silent

    def _holds(self, call: Call, context: Context) -> bool | None:
        """Return whether the condition of an action holds; None where this is not known. Raises LaunchSignal."""
        given = call.kwargs.get("condition")
        if given is None:
            return True
        if isinstance(given, Unknown):
            raise NotEvaluated(given.reason, given.at)
        if not isinstance(given, Call):
            raise LaunchFails(f"condition is {kind_of(given)}, not a condition such as IfCondition(...)", call.at)
        kind = given.name.rpartition(".")[2]
        if not is_a(given.name, CONDITION) or kind == "Condition":
            raise NotEvaluated(f"the condition {kind} is not evaluated", given.at)
        if kind in ("IfCondition", "UnlessCondition"):
            text = known_text(given.kwargs["predicate_expression"], context, given.at)
            return condition(text, given.at) == (kind == "IfCondition")
        wanted = given.kwargs["expected_value"]
        expected = resolve(wanted, context, given.at) if wanted is not None else None
        name = given.kwargs["launch_configuration_name"]
        if not isinstance(name, str):
            raise NotEvaluated("the name of this launch configuration is not evaluated", given.at)
        actual = context.arguments.get(name)
        if (
            isinstance(actual, Unknown)
            or isinstance(expected, Unknown)
            or (actual is None and UNKNOWN_KEYS in context.arguments)
        ):
            return None
        return (expected == actual) == (kind == "LaunchConfigurationEquals")

    def _execute(self, call: Call, context: Context, when: bool | None) -> None:
        kind, start = call.name.rpartition(".")[2], len(context.reads)
        self._fields(call, context, when)
        own = self._EXECUTES.get(kind)
        try:
            if own is not None:
                own(self, call, context, when)
            elif kind in EFFECTS:
                EFFECTS[kind](self.findings, call, context, when)
            elif kind not in self._IDLE:
                raise NotEvaluated(f"what {kind} does is not evaluated", call.at)
        except LaunchSignal as signal:
            self.findings.add(signal, when)
            if isinstance(signal, NotEvaluated) and kind not in self._PROCESSES and when is not False:
                self.findings.add_unknown(str(signal), signal.at)
        for contents, at in context.reads[start:] if when else ():
            self.findings.refer("read", contents, Call("", [], {}, at))
        del context.reads[start:]

    def _fields(self, call: Call, context: Context, when: bool | None) -> None:
        """Evaluate the arguments of an action that may contain substitutions."""
        cls = class_named(call.name)
        for name, parameter in cls.parameters.items() if cls is not None and when is not False else ():
            value, test = call.kwargs.get(name), parameter.check.removesuffix("?")
            if value is None or name in _LATE:
                continue
            try:
                _evaluate(value, name, test, context, call.at)
            except LaunchSignal as signal:
                self.findings.add(signal, when)
            except Undetermined as error:
                self.findings.add_doubt(str(error), call.at)

    def _actions(self, actions: Value, call: Call, context: Context, when: bool | None) -> None:
        """Visit the actions of a list."""
        try:
            items = items_in(actions)
            if items is None:
                raise LaunchFails(f"expected a list of actions, found {kind_of(actions)}", call.at)
        except Undetermined as error:
            self.findings.add_unknown(str(error), call.at)
            self.findings.add_doubt(str(error), call.at)
        except LaunchSignal as signal:
            self.findings.add(signal, when)
        else:
            for action in items:
                self.visit(action, context, when, call.at)

    def _description(self, call: Call, context: Context, when: bool | None) -> None:
        self._actions(call.kwargs.get("initial_entities") or [], call, context, when)
        for method in call.method_calls:
            if method.name.endswith((".add_action", ".add_entity")):
                self._actions([*method.args, *method.kwargs.values()], method, context, when)

    def _group(self, call: Call, context: Context, when: bool | None) -> None:
        """Visit a group: what it sets ends with it, unless scoped is False."""
        own = call.kwargs.get("launch_configurations") or {}
        is_scoped, inner = bool(call.kwargs.get("scoped", True)), context
        if is_scoped:
            inner = context.copy()
            if not call.kwargs.get("forwarding", True):
                inner.arguments, inner.environment = {}, {}
        for name, value in own.items() if when is not False else ():
            inner.arguments[known_text(name, context, call.at)] = resolve(value, context, call.at)
        self._actions(call.kwargs["actions"], call, inner, when)

    def _timer(self, call: Call, context: Context, when: bool | None) -> None:
        period = call.kwargs["period"]
        if not isinstance(period, str | float):
            try:
                float(known_text(period, context, call.at))
            except ValueError:
                raise NotEvaluated("a timer whose period is no number is not evaluated", call.at) from None
        self._defer(call.kwargs["actions"], call, context, when, None)

    def _defer(self, actions: Value, call: Call, context: Context, when: bool | None, target: Call | None) -> None:
        """Execute actions after all others if they certainly are executed; else see only which nodes they may start."""
        if when:
            self.later.append((actions, call, context, target))
        else:
            self._perhaps(actions, call, context, when and None)

    def _perhaps(self, actions: Value, call: Call, context: Context, when: bool | None) -> None:
        """Visit what may never be executed: errors in it do not count, but for what is no action."""
        silent, self.findings.is_silent, kept, self.executed = self.findings.is_silent, True, self.executed, {}
        self._actions(actions if isinstance(actions, list | tuple) else [actions], call, context.copy(), when)
        self.findings.is_silent, self.executed = silent, kept

    def _register(self, call: Call, context: Context, when: bool | None) -> None:
        handler = call.kwargs["event_handler"]
        if isinstance(handler, Unknown):
            raise NotEvaluated(handler.reason, handler.at)
        if not isinstance(handler, Call) or not is_a(handler.name, _HANDLER):
            error = LaunchFails(f"expected an event handler, found {kind_of(handler)}", call.at)
            self._add_of_form(error, context, when)
            return
        target = handler.kwargs.get("target_action")
        for name, value in handler.kwargs.items():
            if (name.startswith("on_") or name == "entities") and not isinstance(value, QualifiedName | None):
                actions = self.call_function(value, handler.at, None, context) if isinstance(value, Function) else value
                is_certain = handler.name.endswith("OnProcessStart") and isinstance(target, Call) and value is actions
                listed = actions if isinstance(actions, list | tuple) else [actions]
                if is_certain:
                    self._defer(listed, handler, context, when, target)
                elif actions is not None and not handler.name.endswith("OnProcessIO"):
                    loaded, self.is_loaded = (
                        self.is_loaded,
                        self.is_loaded and value is actions and not handler.name.endswith("OnShutdown"),
                    )
                    self._perhaps(listed, handler, context, when and None)
                    self.is_loaded = loaded

    def _opaque_function(self, call: Call, context: Context, when: bool | None) -> None:
        function, args = call.kwargs["function"], call.kwargs.get("args") or []
        if not isinstance(function, Function) or not isinstance(args, list | tuple) or call.kwargs.get("kwargs"):
            raise NotEvaluated("the result of this OpaqueFunction is not evaluated", call.at)
        if when is False:
            return
        arguments = (Call("launch.launch_context.LaunchContext", [], {}, call.at), *args)
        found = self.call_function(function, call.at, arguments if when else None, context)
        loaded, self.is_loaded = self.is_loaded, False
        if isinstance(found, Unknown):
            self.findings.add(NotEvaluated(found.reason, found.at), when)
        elif found is not None:
            self._actions(found, call, context, when)
        self.is_loaded = loaded

    def _include(self, call: Call, context: Context, when: bool | None) -> None:
        if when is False:
            return
        source = call.kwargs["launch_description_source"]
        if isinstance(source, Call) and is_a(source.name, SOURCE):
            source = source.kwargs.get("launch_file_path", Unknown("this launch description is not evaluated", call.at))
        given = _launch_arguments(call.kwargs.get("launch_arguments"), context, call.at)
        path = known_text(source, context, call.at)
        arguments = {**context.arguments, **given}
        inner = replace(context, path=path, arguments=arguments, when=when, reads=[], given=frozenset(given))
        reason = self.include(path, inner)
        if reason and not start_known_file(self.findings, path, call, inner):
            self.findings.refer("include", path, call)
            if reason == CIRCULAR_INCLUDE:
                raise LaunchFails(reason, call.at)
            self.findings.add_unknown(reason, call.at)
        elif not reason:
            self.findings.refer("include", path, call)
        context.arguments.update(inner.arguments)  # an included file shares its arguments with the actions that follow
        if reason:
            context.arguments[UNKNOWN_KEYS] = Unknown(reason, call.at)

    def _process(self, call: Call, context: Context, when: bool | None) -> None:
        """Start a process, which an action can do once only."""
        before, self.executed[id(call)] = self.executed.get(id(call), False), when
        start = start_node if "executable" in call.kwargs else start_process
        start(self.findings, call, context, when)
        if when is not False and before is not False:
            message = f"the same {call.name.rpartition('.')[2]} is executed twice: make two of them"
            raise LaunchFails(message, call.at) if before and when else NotEvaluated(message, call.at)
        if when is not False:
            (evaluate_node if "executable" in call.kwargs else evaluate_process)(call, context)
        on_exit = call.kwargs.get("on_exit")
        if isinstance(on_exit, list):
            self._perhaps(on_exit, call, context, when and None)
        elif not isinstance(on_exit, Function | Call | Unknown | QualifiedName | None):
            raise NotEvaluated("this value of on_exit is not evaluated", call.at)
        if composed := call.kwargs.get("composable_node_descriptions"):
            self._load(
                Call(call.name, [], {"target_container": "", "composable_node_descriptions": composed}, call.at),
                context,
                when,
            )

    def _load(self, call: Call, context: Context, when: bool | None) -> None:
        """Evaluate the nodes that a container loads."""
        self.findings.add_unknown("the nodes of a container are not supported", call.at)
        target = call.kwargs["target_container"]
        if when is not False and not (isinstance(target, Call) and is_a(target.name, ENTITY)):
            resolve(target, context, call.at)
        nodes = items_in(call.kwargs["composable_node_descriptions"])
        if nodes is None:
            raise LaunchFails("composable_node_descriptions has to be a list: put [ ] around it", call.at)
        for node in nodes:
            if not isinstance(node, Call) or not node.name.endswith("ComposableNode"):
                raise NotEvaluated("this composable node is not evaluated", call.at)
            self._fields(node, context, _both(when, self._holds(node, context)))

    # What each kind of action does, besides the evaluation of its arguments and what EFFECTS lists.
    _PROCESSES: ClassVar = ("Node", "LifecycleNode", "ExecuteProcess", "ComposableNodeContainer")
    _IDLE: ClassVar = frozenset({"LogInfo", "SetRemap", "SetROSLogDir", "ResetEnvironment", "LifecycleTransition"})
    _EXECUTES: ClassVar[Mapping[str, Callable[..., None]]] = {
        **dict.fromkeys(_PROCESSES, _process), **dict.fromkeys(("TimerAction", "ROSTimer"), _timer),
        "IncludeLaunchDescription": _include, "LaunchDescription": _description, "GroupAction": _group,
        "RegisterEventHandler": _register, "OpaqueFunction": _opaque_function, "LoadComposableNodes": _load,
    }  # fmt: skip


def _evaluate(value: Value, name: str, test: str, context: Context, at: Position) -> None:
    """Evaluate an argument of an action, which has the check `test`. Raises LaunchSignal, and Undetermined."""
    match test:
        case "text" if not (name == "output" and isinstance(value, dict)):
            resolve(value, context, at)
        case "texts" | "mapping":
            pairs = value.items() if isinstance(value, dict) else ((item,) for item in items_in(value) or ())
            for item in (item for pair in pairs for item in pair):
                resolve(item, context, at)
        case "bool" if not isinstance(value, bool):
            boolean(known_text(value, context, at), at)
        case "parameters":
            evaluate_parameters(value, context, at)
        case "remappings":
            for rule in items_in(value) or ():
                resolve(rule[0], context, at), resolve(rule[1], context, at)


def _both(one: bool | None, other: bool | None) -> bool | None:
    """Return whether two conditions hold, each of which may be unknown."""
    return min(one, other, key=(False, None, True).index)


def _launch_arguments(given: Value, context: Context, at: Position) -> dict[str, Resolved]:
    """Return the launch arguments that an include passes on. Raises LaunchSignal."""
    try:
        pairs = items_in(given) if given is not None else []
    except Undetermined as error:
        raise NotEvaluated(str(error), at) from None
    found: dict[str, Resolved] = {}
    for pair in pairs or ():
        if isinstance(pair, Unknown):
            raise NotEvaluated(pair.reason, pair.at)
        if not isinstance(pair, list | tuple | str) or len(pair) != 2:
            raise LaunchFails("launch_arguments takes pairs of a name and a value", at)
        for part in pair:
            if not isinstance(part, str | Call | Unknown | list | tuple):
                raise LaunchFails(f"the value of a launch argument is {kind_of(part)}, not a string", at)
        found[known_text(pair[0], context, at)] = resolve(pair[1], context, at)
    return found
