"""Visit the actions of a launch description as launch does, without starting anything."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

from grader.package.launch.api import ENTITY, class_named, is_a
from grader.package.launch.conditions import both, holds
from grader.package.launch.effects import EFFECTS
from grader.package.launch.fields import evaluate_field
from grader.package.launch.model import Context, Findings, LaunchFails, LaunchSignal, NotEvaluated
from grader.package.launch.value_types import items_in, kind_of
from grader.static_python.parse import START, Position
from grader.static_python.values import Call, Function, Undetermined, Unknown, Value

_MAX_ACTIONS = 5_000
_MAX_DEPTH = 40
_LATE = ("sigterm_timeout", "sigkill_timeout", "default_value")  # arguments that are not evaluated at once
PROCESSES = ("Node", "LifecycleNode", "ExecuteProcess", "ComposableNodeContainer")
_IDLE = frozenset({"LogInfo", "SetRemap", "SetROSLogDir", "ResetEnvironment", "LifecycleTransition"})

# Takes the path of a launch file below the prefix and the context for it; returns why it is not read, or nothing.
Include = Callable[[str, Context], str]


@dataclass(slots=True)
class ActionVisitor:
    """A visitor of actions that adds its findings. `when` is whether an action is executed, None if this is unknown."""

    findings: Findings
    include: Include
    call_function: Callable[[Function, Position, Sequence[Value] | None, Context], Value]
    kinds: "Mapping[str, Callable[[ActionVisitor, Call, Context, bool | None], None]]"  # what each kind of action does
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
                self.visit_all(actions, call, replace(own, arguments=context.arguments), is_certain)

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
            self.add_of_form(signal, context, when)
        else:
            self.visited.add(id(value))
            try:
                executed = both(when, holds(value, context))
            except LaunchSignal as signal:
                self.findings.add(signal, when)
                executed = None if when is not False else False
            self._execute(value, context, executed)
        self.depth -= 1

    def add_of_form(self, signal: LaunchSignal, context: Context, when: bool | None) -> None:
        """Add an error in the form of a description: launch looks at all of it before it executes any of it."""
        if isinstance(signal, NotEvaluated):
            self.findings.add_unknown(str(signal), signal.at)
        silent, self.findings.is_silent = self.findings.is_silent, self.findings.is_silent and not self.is_loaded
        self.findings.add(signal, context.when if self.is_loaded else when)
        self.findings.is_silent = silent

    def _execute(self, call: Call, context: Context, when: bool | None) -> None:
        kind, start = call.name.rpartition(".")[2], len(context.reads)
        self.evaluate_fields(call, context, when)
        own = self.kinds.get(kind)
        try:
            if own is not None:
                own(self, call, context, when)
            elif kind in EFFECTS:
                EFFECTS[kind](self.findings, call, context, when)
            elif kind not in _IDLE:
                raise NotEvaluated(f"what {kind} does is not evaluated", call.at)
        except LaunchSignal as signal:
            self.findings.add(signal, when)
            if isinstance(signal, NotEvaluated) and kind not in PROCESSES and when is not False:
                self.findings.add_unknown(str(signal), signal.at)
        for contents, at in context.reads[start:] if when else ():
            self.findings.refer("read", contents, Call("", [], {}, at))
        del context.reads[start:]

    def evaluate_fields(self, call: Call, context: Context, when: bool | None) -> None:
        """Evaluate the arguments of an action that may contain substitutions."""
        cls = class_named(call.name)
        for name, parameter in cls.parameters.items() if cls is not None and when is not False else ():
            value, test = call.kwargs.get(name), parameter.check.removesuffix("?")
            if value is None or name in _LATE:
                continue
            try:
                evaluate_field(value, name, test, context, call.at)
            except LaunchSignal as signal:
                self.findings.add(signal, when)
            except Undetermined as error:
                self.findings.add_doubt(str(error), call.at)

    def visit_all(self, actions: Value, call: Call, context: Context, when: bool | None) -> None:
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

    def defer(self, actions: Value, call: Call, context: Context, when: bool | None, target: Call | None) -> None:
        """Execute actions after all others if they certainly are executed; else see only which nodes they may start."""
        if when:
            self.later.append((actions, call, context, target))
        else:
            self.perhaps(actions, call, context, when and None)

    def perhaps(self, actions: Value, call: Call, context: Context, when: bool | None) -> None:
        """Visit what may never be executed: errors in it do not count, but for what is no action."""
        silent, self.findings.is_silent, kept, self.executed = self.findings.is_silent, True, self.executed, {}
        self.visit_all(actions if isinstance(actions, list | tuple) else [actions], call, context.copy(), when)
        self.findings.is_silent, self.executed = silent, kept
