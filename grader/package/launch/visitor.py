"""Visit the actions of a launch description as launch does, without starting anything."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

from grader.package.launch.api import CONDITION, ENTITY, class_named, is_a
from grader.package.launch.model import Context, Findings
from grader.package.launch.parameters import evaluate_parameters
from grader.package.launch.substitutions import known_text, resolve
from grader.package.launch.value_types import BOOLEANS, boolean, items_in, kind_of
from grader.python.parse import START, Position
from grader.python.values import Call, EvaluationFails, EvaluationSignal, Function, Undetermined, Unknown, Value

_MAX_ACTIONS = 5_000
_MAX_DEPTH = 40
_LATE = ("sigterm_timeout", "sigkill_timeout", "default_value")  # arguments that are not evaluated at once
PROCESSES = ("Node", "ExecuteProcess")

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
    later: list[tuple[Value, Call, Context, bool | None]] = field(
        default_factory=list
    )  # what timers and events execute
    steps: int = 0
    depth: int = 0

    def launch(self, description: Value, context: Context, at: Position) -> None:
        """Execute a description, and then what its timers and the start of its processes execute."""
        self.visit(description, context, context.when, at)
        for _ in range(_MAX_DEPTH):
            later, self.later = self.later, []
            for actions, call, own, when in later:
                self.visit_all(actions, call, replace(own, arguments=context.arguments), when)

    def visit(self, value: Value, context: Context, when: bool | None, at: Position) -> None:
        """Visit an action."""
        self.steps += 1
        if self.depth > _MAX_DEPTH or self.steps > _MAX_ACTIONS:
            self.add_form(Undetermined("a launch file with so many actions is not evaluated"), START, when)
            return
        self.depth += 1
        try:
            if isinstance(value, Unknown):
                raise Undetermined(value.reason, value.at)
            if isinstance(value, Call) and class_named(value.name) is None:
                raise Undetermined(f"the result of {value.name} is not evaluated", value.at)
            if not isinstance(value, Call) or not is_a(value.name, ENTITY):
                hint = ": write * before it" if isinstance(value, list | tuple) else ""
                raise EvaluationFails(f"expected an action, found {kind_of(value)}{hint}", at)
        except EvaluationSignal as signal:
            self.add_form(signal, at, when)
        else:
            self.visited.add(id(value))
            self._execute(value, context, self._holds(value, context, when))
        self.depth -= 1

    def add_form(self, signal: EvaluationSignal, at: Position, when: bool | None) -> None:
        """Add an error in the form of a description: launch looks at all of it before it executes any of it."""
        at, is_silent = signal.at or at, self.findings.is_silent
        if not isinstance(signal, EvaluationFails):
            self.findings.add_unknown(str(signal), at)
            if not is_silent:
                self.findings.add_doubt(str(signal), at)
        elif when and not is_silent:
            self.findings.add_fault(str(signal), at)
        else:
            self.findings.add_doubt(str(signal), at)

    def _holds(self, call: Call, context: Context, when: bool | None) -> bool | None:
        """Return whether an action is executed: if `when`, and if its condition holds."""
        given = call.kwargs.get("condition")
        try:
            holds = _condition(given, context, call.at) if given is not None else True
        except EvaluationSignal as signal:
            self.findings.add(signal, call.at, when)
            holds = None
        return False if False in (when, holds) else None if None in (when, holds) else True

    def _execute(self, call: Call, context: Context, when: bool | None) -> None:
        kind, start = call.name.rpartition(".")[2], len(context.reads)
        self._evaluate_fields(call, context, when)
        try:
            self.kinds.get(kind, _refuse)(self, call, context, when)
        except EvaluationSignal as signal:
            self.findings.add(signal, call.at, when)
            if not isinstance(signal, EvaluationFails) and kind not in PROCESSES and when is not False:
                self.findings.add_unknown(str(signal), signal.at or call.at)
        for contents, at in context.reads[start:] if when else ():
            self.findings.refer("read", contents, Call("", [], {}, at))
        del context.reads[start:]

    def _evaluate_fields(self, call: Call, context: Context, when: bool | None) -> None:
        """Evaluate the arguments of an action that may contain substitutions."""
        cls = class_named(call.name)
        for name, parameter in cls.parameters.items() if cls is not None and when is not False else ():
            value, test = call.kwargs.get(name), parameter.check.removesuffix("?")
            if value is None or name in _LATE or (name == "output" and isinstance(value, dict)):
                continue
            try:
                _evaluate_field(value, test, context, call.at)
            except EvaluationSignal as signal:
                self.findings.add(signal, call.at, when)

    def visit_all(self, actions: Value, call: Call, context: Context, when: bool | None) -> None:
        """Visit the actions of a list."""
        try:
            items = items_in(actions)
        except Undetermined as signal:
            self.add_form(signal, call.at, when)
            return
        if items is None:
            error = EvaluationFails(f"expected a list of actions, found {kind_of(actions)}")
            self.findings.add(error, call.at, when)
        for action in items or ():
            self.visit(action, context, when, call.at)

    def perhaps(self, actions: Value, call: Call, context: Context, when: bool | None) -> None:
        """Visit what may never be executed: errors in it do not count, but for what is no action."""
        silent, self.findings.is_silent, kept, self.executed = self.findings.is_silent, True, self.executed, {}
        items = actions if isinstance(actions, list | tuple) else [actions]
        self.visit_all(items, call, context.copy(), False if when is False else None)
        self.findings.is_silent, self.executed = silent, kept


def _refuse(_: ActionVisitor, call: Call, __: Context, ___: bool | None) -> None:
    raise Undetermined(f"what {call.name.rpartition('.')[2]} does is not evaluated")


def _condition(given: Value, context: Context, at: Position) -> bool:
    if isinstance(given, Unknown):
        raise Undetermined(given.reason, given.at)
    if not isinstance(given, Call):
        raise EvaluationFails(f"condition is {kind_of(given)}, not a condition such as IfCondition(...)", at)
    kind = given.name.rpartition(".")[2]
    if not is_a(given.name, CONDITION) or kind not in ("IfCondition", "UnlessCondition"):
        raise Undetermined(f"the condition {kind} is not evaluated", given.at)
    text = known_text(given.kwargs["predicate_expression"], context, given.at)
    holds = BOOLEANS.get(text.strip().lower())
    if holds is None:
        raise EvaluationFails(f"a condition is {text[:40]!r}, expected true or false", given.at)
    return holds == (kind == "IfCondition")


def _evaluate_field(value: Value, test: str, context: Context, at: Position) -> None:
    """Evaluate an argument of an action, which has the check `test`. Raises EvaluationSignal."""
    match test:
        case "text":
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
            for name in (name for rule in items_in(value) or () for name in items_in(rule) or ()):
                resolve(name, context, at)
