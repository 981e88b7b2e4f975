"""What the actions of a launch description do as launch executes them, without starting anything.

`ActionVisitor` visits them; the functions below it are what each kind of action does: nodes,
includes, arguments, timers, events.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import field, replace
from typing import Protocol

from grader.base.grouping import are_texts, as_list
from grader.base.records import Named, Record
from grader.ros.installation.places import PREFIX, SHARE
from grader.ros.launch.call_arguments import describe_kind, items_in
from grader.ros.launch.components import load_by_command, load_components, start_container
from grader.ros.launch.launch_classes import (
    CONDITION,
    ENTITY,
    SOURCE,
    SUBSTITUTION,
    class_named,
    is_a,
)
from grader.ros.launch.launch_model import (
    NAMESPACE,
    Context,
    Findings,
    GivenParameters,
    PassedArguments,
    Resolved,
    When,
    texts_by_name,
)
from grader.ros.launch.lifecycle_events import read_event
from grader.ros.launch.node_parameters import (
    TO_ALL,
    evaluate_parameters,
    set_for_all,
)
from grader.ros.launch.started_commands import StartedCommand
from grader.ros.launch.started_nodes import (
    REMAPS,
    ends_by_itself,
    evaluate_node,
    evaluate_process,
    namespace_below,
    start_known_file,
    start_node,
    start_process,
)
from grader.ros.launch.substitutions import (
    CONDITIONS,
    PART_UNKNOWN,
    boolean,
    condition_holds,
    known_text,
    listed,
    resolve,
)
from grader.ros.python.interpreter import SEARCHED_VARIABLES
from grader.ros.python.parse import START, Position
from grader.ros.python.values import (
    Call,
    EvaluationFails,
    EvaluationSignal,
    Function,
    MissingValue,
    QualifiedName,
    Undetermined,
    Unknown,
    Value,
)

_MAX_ACTIONS = 5_000
_OF_ACTION = 100  # parts of the work that a workspace may ask for
_MAX_DEPTH = 40
_MAX_PERIOD = 60.0  # seconds that a person waits for a timer
_LATE = (
    "sigterm_timeout",
    "sigkill_timeout",
    "default_value",
)  # arguments that are not evaluated at once
_PROCESSES = ("Node", "LifecycleNode", "ExecuteProcess")


class NotIncluded(Named):
    """Why an included launch file is not read."""

    reason: str
    is_circular: bool = False


# Reads a launch file by its path below the prefix, in a context.
Include = Callable[[str, Context], NotIncluded | None]


class _CallFunction(Protocol):
    """Calls a function of the file; without arguments, with ones that are not known."""

    def __call__(
        self,
        function: Function | Call,
        at: Position,
        args: Sequence[Value] | None,
        context: Context,
        named: Mapping[str, Value] = ...,
    ) -> Value:
        """Return its value."""


class ActionVisitor(Record, frozen=False):
    """A visitor of actions that adds its findings.

    `when` is whether an action is executed, None if this is unknown.
    """

    findings: Findings
    include: Include
    call_function: _CallFunction
    visited: set[Call] = field(default_factory=set)  # what is part of the description
    executed: dict[Call, When] = field(default_factory=dict)  # the processes: each is executed once
    # the processes that are executed when an event happens which may not happen
    perhaps_executed: set[Call] = field(default_factory=set)
    # What timers and events execute, and the process whose start or end does.
    later: list[tuple[Value, Call, Context, When, Value]] = field(default_factory=list)
    # what the current node is given, evaluated up to the first error or doubt
    parameters: dict[Call, Iterator[GivenParameters]] = field(default_factory=dict)
    steps: int = 0
    depth: int = 0
    # the handler of changes of a state whose actions are visited, and whether it is registered
    state_handler: tuple[Call, When] | None = None

    def launch(self, description: Value, context: Context, at: Position) -> None:
        """Execute a description, and then what its timers and events execute.

        The events are the start and end of its processes.
        """
        self.visit(description, context, context.when, at)
        for _ in range(_MAX_DEPTH):
            later = self.later
            self.later = []
            started = [self._is_started(target) for *_, target in later]
            for (actions, call, inner_context, when, target), is_started in zip(
                later, started, strict=True
            ):
                if is_started is False and any(started):
                    # Another event may start the process.
                    self.later.append((actions, call, inner_context, when, target))
                    continue
                inner = replace(
                    inner_context, arguments=context.arguments, has_others=context.has_others
                )
                self.visit_all(actions, call, inner, is_started if when else None)

    def _is_started(self, target: Value) -> When:
        """Return whether the process is started on which an action waits.

        Returns True if it waits on none.
        """
        if not isinstance(target, Call):
            return True
        if target in self.executed:
            return self.executed[target]
        is_open = target in self.perhaps_executed or bool(self.findings.unknown)
        return None if is_open else False

    def visit(self, value: Value, context: Context, when: When, at: Position) -> None:
        """Visit an action, or each of those of which it is one."""
        self.steps += 1
        is_left = context.budget.take_of_whole(_OF_ACTION)
        if self.depth > _MAX_DEPTH or self.steps > _MAX_ACTIONS or not is_left:
            self.add_form(
                Undetermined("a launch file with so many actions is not evaluated"), START, when
            )
            return
        self.depth += 1
        if isinstance(value, Unknown) and value.candidates:
            for candidate in value.candidates:
                for action in listed(candidate) if candidate is not None else ():
                    self.visit(action, context, when and None, at)
        else:
            self._visit_action(value, context, when, at)
        self.depth -= 1

    def _visit_action(self, value: Value, context: Context, when: When, at: Position) -> None:
        try:
            if isinstance(value, Unknown):
                raise value.as_signal(value.at)
            if isinstance(value, Call) and not class_named(value.name):
                raise Undetermined(f"the result of {value.name} is not evaluated", value.at)
            if not isinstance(value, Call) or not is_a(value.name, ENTITY):
                hint = ": write * before it" if isinstance(value, list | tuple) else ""
                raise EvaluationFails(f"expected an action, found {describe_kind(value)}{hint}")
        except EvaluationSignal as signal:
            self.add_form(signal, at, when)
        else:
            self.visited.add(value)
            self._execute(value, context, self._holds(value, context, when))

    def add_form(self, signal: EvaluationSignal, at: Position, when: When) -> None:
        """Add an error in the form of a description.

        Launch looks at all of it before it executes any of it.
        """
        at = signal.at or at
        is_silent = self.findings.is_silent
        if not isinstance(signal, EvaluationFails):
            follows = isinstance(signal, Undetermined) and signal.follows_error
            self.findings.add_unknown(str(signal), at, follows_error=follows)
            if not is_silent:
                self.findings.add_doubt(str(signal), at)
        elif when and not is_silent:
            self.findings.add_fault(str(signal), at)
        else:
            self.findings.add_doubt(str(signal), at)

    def _holds(self, call: Call, context: Context, when: When) -> When:
        """Return whether an action is executed: if `when`, and if its condition holds."""
        given = call.kwargs.get("condition")
        try:
            holds = _condition_holds(given, context) if given is not None else True
        except EvaluationSignal as signal:
            self.findings.add(signal, call.at, when)
            holds = None
        if when is False or holds is False:
            return False
        return True if when and holds else None

    def _execute(self, call: Call, context: Context, when: When) -> None:
        kind = call.short
        start = len(context.reads)
        first_fault = len(context.faults)
        self._evaluate_fields(call, context, when)
        try:
            if when is not False or kind not in _EFFECTS:
                _KINDS.get(kind, _refuse_action)(self, call, context, when)
        except EvaluationSignal as signal:
            self.findings.add(signal, call.at, when)
            if (
                not isinstance(signal, EvaluationFails)
                and kind not in _PROCESSES
                and when is not False
            ):
                follows = isinstance(signal, Undetermined) and signal.follows_error
                self.findings.add_unknown(str(signal), signal.at or call.at, follows_error=follows)
        if when:
            for contents, at in context.reads[start:]:
                self.findings.refer("read", contents, Call("", [], {}, at))
        del context.reads[start:]
        for message, at in context.faults[first_fault:]:
            self.findings.add(EvaluationFails(message, at), call.at, when)
        del context.faults[first_fault:]

    def _evaluate_fields(self, call: Call, context: Context, when: When) -> None:
        """Evaluate the arguments of an action that may contain substitutions."""
        cls = class_named(call.name)
        if not cls:
            return
        for name, parameter in cls.parameters.items():
            value = call.kwargs.get(name)
            if value is None or name in _LATE or (name == "output" and isinstance(value, dict)):
                continue
            if parameter.check == "parameters":
                location = self.findings.locate(call.at)
                self.parameters[call], signal = evaluate_parameters(call, context, location)
            else:
                signal = _evaluate_field(value, parameter.check, context, call.at)
            if signal:
                self.findings.add(signal, call.at, when)

    def visit_all(self, actions: Value, call: Call, context: Context, when: When) -> None:
        """Visit the actions of a list, or those of each that it may be."""
        if isinstance(actions, Unknown) and actions.candidates:
            for candidate in actions.candidates:
                if candidate is not None:
                    self.visit_all(candidate, call, context, when and None)
            return
        try:
            items = items_in(actions)
        except Undetermined as signal:
            self.add_form(signal, call.at, when)
            return
        if items is None:
            error = EvaluationFails(f"expected a list of actions, found {describe_kind(actions)}")
            self.findings.add(error, call.at, when)
        for action in items or ():
            self.visit(action, context, when, call.at)

    def perhaps(self, actions: Value, call: Call, context: Context, when: When) -> None:
        """Visit what may never be executed.

        Errors in it do not count, but for what is no action.
        """
        was_silent = self.findings.is_silent
        executed = self.executed
        self.findings.is_silent = True
        self.executed = {}
        inner = context.copy()
        inner.to_all = {name: list(given) for name, given in context.to_all.items()}
        self.visit_all(listed(actions), call, inner, False if when is False else None)
        self.perhaps_executed.update(self.executed)
        self.findings.is_silent = was_silent
        self.executed = executed


def _refuse_action(_: ActionVisitor, call: Call, __: Context, ___: When) -> None:
    raise Undetermined(f"what {call.short} does is not evaluated")


def _condition_holds(given: Value, context: Context) -> bool:
    if isinstance(given, Unknown):
        raise given.as_signal(given.at)
    if not isinstance(given, Call) or is_a(given.name, SUBSTITUTION):
        raise EvaluationFails(
            f"condition is {describe_kind(given)}, not a condition such as IfCondition(...)"
        )
    kind = given.short
    if not is_a(given.name, CONDITION) or kind not in CONDITIONS:
        raise Undetermined(f"the condition {kind} is not evaluated", given.at)
    return condition_holds(given, context)


def _start_container(visitor: ActionVisitor, call: Call, context: Context, when: When) -> None:
    """Note a container and the components in it; what these do is not evaluated."""
    start_container(visitor.findings, call, context, when)
    if when is not False:
        evaluate_node(call, context)
    _refuse_action(visitor, call, context, when)


def _load_components(visitor: ActionVisitor, call: Call, context: Context, when: When) -> None:
    """Note the components that are loaded into a container; what these do is not evaluated."""
    load_components(visitor.findings, call, context, when)
    _refuse_action(visitor, call, context, when)


def _texts_in(value: Value) -> Sequence[Value]:
    """Return the items of a list, or the keys and values of a dict. Raises Undetermined."""
    if not isinstance(value, dict):
        return items_in(value) or ()
    texts: list[Value] = []
    for pair in value.items():
        texts += pair
    return texts


def _evaluate_field(
    value: Value, check: str, context: Context, at: Position
) -> EvaluationSignal | None:
    """Evaluate an argument of an action by its check; return the error or doubt in it."""
    try:
        match check:
            case "text":
                resolve(value, context, at)
            case "texts" | "mapping":
                for item in _texts_in(value):
                    resolve(item, context, at)
            case "bool" if not isinstance(value, bool):
                boolean(known_text(value, context))
            case "remappings":
                for rule in items_in(value) or ():
                    for name in items_in(rule) or ():
                        resolve(name, context, at)
    except EvaluationSignal as signal:
        return signal
    return None


def _visit_description(visitor: ActionVisitor, call: Call, context: Context, when: When) -> None:
    visitor.visit_all(call.kwargs.get("initial_entities") or [], call, context, when)
    for method in call.method_calls:
        if method.name.endswith((".add_action", ".add_entity")):
            visitor.visit_all([*method.args, *method.kwargs.values()], method, context, when)


def _declare_argument(visitor: ActionVisitor, call: Call, context: Context, when: When) -> None:
    name = call.kwargs.get("name")
    default = call.kwargs.get("default_value")
    if not isinstance(name, str):
        raise Undetermined("the name of this launch argument is not evaluated")
    visitor.findings.declared.append(name)
    if when is False:
        return
    is_given = name in context.given
    if name in context.arguments and call.kwargs.get("condition") is not None:
        is_given = True
    if default is None and not is_given:
        context.arguments[name] = Unknown(f"the launch argument {name!r} has no default", call.at)
        raise MissingValue(f"the launch argument {name!r} has no default, and no value is given")
    if name not in context.arguments:
        _set_argument(name, default, call, context, when)
    value = context.arguments[name]
    if isinstance(value, str):
        visitor.findings.values.append((name, value))
    if when:
        _check_choice(name, value, call)


def _check_choice(name: str, value: Value, call: Call) -> None:
    """Raise for the value of an argument that is not one of its choices, or may be none."""
    choices = call.kwargs.get("choices")
    if choices is None:
        return
    if not isinstance(value, str) or not isinstance(choices, list | tuple):
        raise Undetermined(f"whether {name!r} is one of its choices is not evaluated")
    if value not in choices:
        raise EvaluationFails(f"the value {value!r} of {name!r} is not one of its choices")


def _assign_argument(visitor: ActionVisitor, call: Call, context: Context, when: When) -> None:
    del visitor
    name = known_text(call.kwargs["name"], context)
    _set_argument(name, call.kwargs["value"], call, context, when)


def _set_argument(name: str, value: Value, call: Call, context: Context, when: When) -> None:
    uncertain = Unknown(f"the launch argument {name!r} is set under a condition", call.at)
    try:
        context.arguments[name] = resolve(value, context, call.at) if when else uncertain
    except EvaluationSignal as signal:
        context.arguments[name] = signal.as_unknown(call.at)
        raise


def _set_environment(visitor: ActionVisitor, call: Call, context: Context, when: When) -> None:
    del visitor, when
    variable = known_text(call.kwargs["name"], context)
    if not variable or "=" in variable:
        raise EvaluationFails(f"an environment variable cannot be called {variable!r}")
    if variable in SEARCHED_VARIABLES:
        raise Undetermined(f"what is found with another {variable} is not evaluated")


def _push_namespace(visitor: ActionVisitor, call: Call, context: Context, when: When) -> None:
    del visitor
    namespace: Resolved = namespace_below(call.kwargs["namespace"], context)
    if not when:
        namespace = Unknown("the namespace is set under a condition", call.at)
    context.arguments[NAMESPACE] = namespace


def _set_remap(visitor: ActionVisitor, call: Call, context: Context, when: When) -> None:
    del visitor
    rules = context.to_all.setdefault(REMAPS, [])
    rules.append(None)  # until it is known
    rule = tuple(known_text(call.kwargs[name], context) for name in ("src", "dst"))
    rules[-1] = rule if when else None


def _set_parameter(visitor: ActionVisitor, call: Call, context: Context, when: When) -> None:
    """Give a parameter, or those of a file, to all nodes that follow."""
    visitor.findings.sets_parameters = True
    if when is False:
        return
    location = visitor.findings.locate(call.at)
    given = context.to_all.setdefault(TO_ALL, [])
    given.append(
        GivenParameters(
            location, unknown="whether a parameter is set for all nodes is not evaluated"
        )
    )
    if "filename" in call.kwargs:
        file = GivenParameters(location, known_text(call.kwargs["filename"], context))
        visitor.findings.refer("read" if when else "parameters", file.path, call)
    else:
        file = set_for_all(call.kwargs["name"], call.kwargs["value"], context, call.at, location)
    given[-1] = file if when else given[-1]


def _set_time(visitor: ActionVisitor, call: Call, context: Context, when: When) -> None:
    """Set the clock of launch itself: no node gets the parameter."""
    del visitor, context, when
    if not isinstance(call.kwargs["value"], bool):
        raise Undetermined("the value of SetUseSimTime is not evaluated")


def _do_nothing(visitor: ActionVisitor, call: Call, context: Context, when: When) -> None:
    """Do nothing: its arguments are evaluated."""


def _shut_down(visitor: ActionVisitor, call: Call, context: Context, when: When) -> None:
    """Refuse what ends the launch; another state of a node with a lifecycle starts nothing."""
    del context
    event = call.kwargs.get("event")
    if isinstance(event, Call) and event.short == "ChangeState":
        handler, is_registered = visitor.state_handler or (None, when)
        change = read_event(event, handler) if is_registered else None
        visitor.findings.state_events.append(change)
        return
    if not visitor.findings.is_silent:
        raise Undetermined("what a shutdown stops is not evaluated")


def _visit_group(visitor: ActionVisitor, call: Call, context: Context, when: When) -> None:
    """Visit a group: what it sets ends with it, unless scoped is False."""
    inner = context.copy() if call.kwargs.get("scoped", True) else context
    given = call.kwargs.get("launch_configurations") or {}
    if not isinstance(given, dict):
        raise Undetermined("what this group sets is not evaluated")
    if inner is not context:
        before = inner.arguments if call.kwargs.get("forwarding", True) else {}
        inner.arguments = {**before, **_launch_arguments(list(given.items()), context, call.at)}
    visitor.visit_all(call.kwargs["actions"], call, inner, when)


def _start_timer(visitor: ActionVisitor, call: Call, context: Context, when: When) -> None:
    period = call.kwargs["period"]
    if not isinstance(period, float) and when is not False:
        text = known_text(period, context)
        try:
            period = float(text)
        except ValueError:
            raise EvaluationFails(f"the period {text[:40]!r} of a timer is no number") from None
    if when and period <= _MAX_PERIOD:
        visitor.later.append((call.kwargs["actions"], call, context, when, None))
    else:
        visitor.perhaps(call.kwargs["actions"], call, context, when)


def _register_handler(visitor: ActionVisitor, call: Call, context: Context, when: When) -> None:
    handler = call.kwargs["event_handler"]
    kind = handler.short if isinstance(handler, Call) else ""
    if isinstance(handler, Call) and kind == "OnStateTransition":
        outer = visitor.state_handler
        visitor.state_handler = (handler, when)
        visitor.perhaps(handler.kwargs["entities"], handler, context, when)
        visitor.state_handler = outer
        return
    if kind not in ("OnProcessExit", "OnProcessStart"):
        visitor.add_form(Undetermined("this event handler is not evaluated"), call.at, when)
        return
    value = handler.kwargs.get("on_exit", handler.kwargs.get("on_start"))
    if isinstance(value, Function):
        actions = visitor.call_function(value, handler.at, None, context)
    else:
        actions = value
    target = handler.kwargs.get("target_action")
    happens = kind == "OnProcessStart" or ends_by_itself(target, context)
    if happens and value is actions and when is not False:
        executed = as_list(actions)
        visitor.later.append((executed, handler, context, when, target))
    elif not isinstance(actions, QualifiedName | None):
        visitor.perhaps(actions, handler, context, when)


def _call_opaque_function(visitor: ActionVisitor, call: Call, context: Context, when: When) -> None:
    function = call.kwargs["function"]
    args = call.kwargs.get("args") or []
    named = call.kwargs.get("kwargs") or {}
    is_known = isinstance(args, list | tuple) and isinstance(named, dict) and are_texts(named)
    if not isinstance(function, Function | Call) or not is_known:
        raise Undetermined("the result of this OpaqueFunction is not evaluated")
    arguments = (Call("launch.launch_context.LaunchContext", [], {}, call.at), *args)
    given = arguments if when else None
    returned = visitor.call_function(function, call.at, given, context, named)
    if isinstance(returned, Unknown) and not returned.candidates:
        visitor.findings.add(returned.as_signal(), returned.at, when)
    elif returned is not None:
        visitor.visit_all(returned, call, context, when)


def _include_file(visitor: ActionVisitor, call: Call, context: Context, when: When) -> None:
    source = call.kwargs["launch_description_source"]
    if isinstance(source, Call) and is_a(source.name, SOURCE):
        source = source.kwargs.get(
            "launch_file_path", Unknown("this launch description is not evaluated", call.at)
        )
    given = _launch_arguments(call.kwargs.get("launch_arguments"), context, call.at)
    path = known_text(source, context)
    at = visitor.findings.locate(call.at)
    passed = PassedArguments(path.removeprefix(f"{PREFIX}/"), texts_by_name(given), at, when)
    visitor.findings.passed.append(passed)
    inner = replace(
        context,
        path=path,
        arguments={**context.arguments, **given},
        when=when,
        reads=[],
        faults=[],
        given=frozenset(given),
    )
    inner.included_by = (*context.included_by, context.path.removeprefix(f"{PREFIX}/"))
    fault = visitor.include(path, inner)
    if fault and not start_known_file(visitor.findings, path, call, inner):
        visitor.findings.refer("include", path, call)
        if fault.is_circular:
            raise EvaluationFails(fault.reason)
        visitor.findings.add_unknown(fault.reason, call.at)
    elif not fault:
        visitor.findings.refer("include", path, call)
    # An included file shares its arguments with the actions that follow.
    context.arguments.update(inner.arguments)
    context.has_others = inner.has_others or fault is not None


def _launch_arguments(given: Value, context: Context, at: Position) -> dict[str, Resolved]:
    """Return the launch arguments that an include passes on. Raises EvaluationSignal."""
    pairs = items_in(given) if given is not None else []
    arguments = {}
    for pair in pairs or ():
        if not isinstance(pair, list | tuple | str) or len(pair) != 2:
            raise Undetermined("launch_arguments that are no pairs are not evaluated")
        for item in pair:
            if not isinstance(item, str | Call | Unknown | list | tuple):
                raise EvaluationFails(
                    f"the value of a launch argument is {describe_kind(item)}, not a string"
                )
        arguments[known_text(pair[0], context)] = resolve(pair[1], context, at)
    return arguments


def _launch_by_command(
    visitor: ActionVisitor, call: Call, words: list[str], context: Context, when: When
) -> bool:
    """Add what `ros2 launch` starts of a well-known package; return whether a command does that.

    The file is launched on its own: it gets nothing from this one but its arguments.
    """
    match words:
        case ["ros2", "launch", package, file, *arguments]:
            path = f"{SHARE}/{package}/launch/{file}"
        case _:
            return False
    given: dict[str, Resolved] = {}
    for word in arguments:
        name, separator, value = word.partition(":=")
        if not separator or PART_UNKNOWN in name:
            return False
        given[name] = Unknown("an argument", call.at) if PART_UNKNOWN in value else value
    alone = replace(context, arguments=given, to_all={}, included_by=(), when=when)
    if not start_known_file(visitor.findings, path, call, alone):
        return False
    at = visitor.findings.locate(call.at)
    passed = PassedArguments(path.removeprefix(f"{PREFIX}/"), texts_by_name(given), at, when)
    visitor.findings.passed.append(passed)
    visitor.findings.unknown = [row for row in visitor.findings.unknown if row.location != at]
    return True


def _is_read_command(
    visitor: ActionVisitor, call: Call, words: list[str], context: Context, when: When
) -> bool:
    """Return whether a command has no words left, or loads or launches what is known."""
    if when is False or not words:
        return not words
    is_loaded = load_by_command(visitor.findings, call, words, when)
    return is_loaded or _launch_by_command(visitor, call, words, context, when)


def _execute_process(visitor: ActionVisitor, call: Call, context: Context, when: When) -> None:
    """Start a process, which an action can do once only."""
    before = visitor.executed.get(call, False)
    visitor.executed[call] = when
    if "executable" in call.kwargs:
        evaluate = evaluate_node
        start_node(visitor.findings, call, context, when, visitor.parameters.pop(call, ()))
    else:
        evaluate = evaluate_process
        words = start_process(visitor.findings, call, context, when)
        if not _is_read_command(visitor, call, words, context, when):
            command = StartedCommand(tuple(words), when, visitor.findings.locate(call.at))
            visitor.findings.commands.append(command)
    if when is not False and before is not False:
        message = f"the same {call.short} is executed twice: make two of them"
        kind = EvaluationFails if before and when else Undetermined
        raise kind(message)
    if when is not False:
        evaluate(call, context)
    on_exit = call.kwargs.get("on_exit")
    if isinstance(on_exit, list) and when and ends_by_itself(call, context):
        visitor.later.append((on_exit, call, context, when, call))
    elif isinstance(on_exit, list):
        visitor.perhaps(on_exit, call, context, when)
    elif not isinstance(on_exit, Function | Call | Unknown | QualifiedName | None):
        raise Undetermined("this value of on_exit is not evaluated")


_ActionFunction = Callable[[ActionVisitor, Call, Context, bool | None], None]
# What each kind of action does that needs no visit if it is certainly not executed.
_EFFECTS = {
    **dict.fromkeys(("LogInfo", "Log", "LogDebug", "LogWarning", "LogError"), _do_nothing),
    "SetLaunchConfiguration": _assign_argument,
    **dict.fromkeys(("SetEnvironmentVariable", "AppendEnvironmentVariable"), _set_environment),
    "IncludeLaunchDescription": _include_file,
    "OpaqueFunction": _call_opaque_function,
    **dict.fromkeys(("Shutdown", "EmitEvent"), _shut_down),
    "PushROSNamespace": _push_namespace,
    "SetRemap": _set_remap,
    "SetUseSimTime": _set_time,
    "ComposableNodeContainer": _start_container,
    "LoadComposableNodes": _load_components,
}
# What each kind of action does, besides the evaluation of its arguments.
_KINDS = {
    **_EFFECTS,
    **dict.fromkeys(_PROCESSES, _execute_process),
    "LaunchDescription": _visit_description,
    "DeclareLaunchArgument": _declare_argument,
    "DeclareBooleanLaunchArgument": _declare_argument,
    "GroupAction": _visit_group,
    "TimerAction": _start_timer,
    "RegisterEventHandler": _register_handler,
    **dict.fromkeys(("SetParameter", "SetParametersFromFile"), _set_parameter),
}
