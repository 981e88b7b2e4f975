"""What nodes in Python do wrong with actions."""

import ast
from collections.abc import Mapping, Sequence

from grader.base.records import Named
from grader.ros.nodes.message_uses import CodePart, FunctionKey
from grader.ros.nodes.node_facts import (
    CodeFault,
    CodeFaults,
)
from grader.ros.python.constants import dotted
from grader.ros.python.parse import AnyFunction, Code, own_parameters
from grader.ros.python.walking import walk

# What sets the state of a goal: rclpy/rclpy/action/server.py of jazzy.
_CANCELS = "canceled"
_ENDING_STATES = frozenset({"succeed", "abort", _CANCELS})
# The fields of the answer that has the result of an action, and what each message has.
_OF_RESULT = frozenset({"status", "result", "get_fields_and_field_types"})


class RegisteredGoal(Named):
    """A function that executes the goals of an action, and the call that is given it."""

    function: AnyFunction
    call: ast.Call


def goals_without_state(code: Code, registered: Sequence[RegisteredGoal]) -> CodeFaults:
    """Yield functions that end without setting the state of their goal: rclpy aborts it then.

    One that gives the goal to something else, or keeps it, may set it there. A function that only
    cancels goals sets no state of the others.
    """
    for goal in registered:
        function = goal.function
        names = own_parameters(function)
        if len(names) != 1 or function.decorator_list:
            continue
        used = _list_attributes(names[0], function)
        if used is None:
            continue
        states = _ENDING_STATES.intersection(used)
        if states - {_CANCELS} or not _paths_without_state(function.body).returns:
            continue
        of_goal = "a goal that nobody cancels" if states else "its goal"
        message = (
            f"{function.name}() sets no state of {of_goal}, so rclpy aborts it; "
            f"call {names[0]}.succeed()"
        )
        at = code.at(function)
        place = code.at(goal.call)
        yield CodeFault("goal-state", message, at, place, is_certain=False)


def rejected_goals(code: Code, registered: Sequence[RegisteredGoal]) -> CodeFaults:
    """Yield functions that answer each goal without GoalResponse.ACCEPT: rclpy rejects all goals.

    One that raises an error, or answers with what is computed, may accept goals elsewhere.
    """
    if "register_goal_callback" in code.text:
        return
    for goal in registered:
        function = goal.function
        nodes = walk(function)
        answers = [node.value for node in nodes if isinstance(node, ast.Return)]
        may_differ = bool(function.decorator_list) or any(
            isinstance(node, ast.Raise | ast.Yield | ast.YieldFrom) for node in nodes
        )
        if not may_differ and all(map(_is_rejection, answers)):
            message = (
                f"{function.name}() answers no goal with GoalResponse.ACCEPT, so rclpy rejects "
                "each, and executes none"
            )
            at = code.at(function)
            place = code.at(goal.call)
            yield CodeFault("goal-state", message, at, place, is_certain=False)


def _is_rejection(answer: ast.expr | None) -> bool:
    """Return whether an answer rejects a goal: what is no GoalResponse does so as well."""
    if not answer or isinstance(answer, ast.Constant):
        return True
    return dotted(answer).endswith("GoalResponse.REJECT")


class _OpenPaths(Named):
    """How statements are left on paths on which nothing has cancelled the goal."""

    reaches_end: bool = True
    breaks: bool = False
    returns: bool = False

    def joined(self, other: "_OpenPaths") -> "_OpenPaths":
        """Return the paths of two branches."""
        return _OpenPaths(*(one or two for one, two in zip(self, other, strict=True)))


_NO_PATH = _OpenPaths(reaches_end=False)
_LEAVING = {
    ast.Return: _NO_PATH._replace(returns=True),
    ast.Break: _NO_PATH._replace(breaks=True),
    ast.Raise: _NO_PATH,
    ast.Continue: _NO_PATH,
}


def _paths_without_state(body: Sequence[ast.stmt]) -> _OpenPaths:
    """Return how statements may be left before a call that cancels the goal."""
    paths = _OpenPaths()
    for statement in body:
        inner = _paths_through(statement)
        paths = inner._replace(
            breaks=paths.breaks or inner.breaks, returns=paths.returns or inner.returns
        )
        if not paths.reaches_end:
            break
    return paths


def _paths_through(statement: ast.stmt) -> _OpenPaths:
    """Return how one statement may be left."""
    match statement:
        case ast.Expr(value=ast.Call(func=ast.Attribute(attr=name))) if name == _CANCELS:
            return _NO_PATH
        case ast.While() | ast.For() | ast.AsyncFor():
            return _paths_of_loop(statement)
        case ast.Try() | ast.TryStar():
            return _paths_of_try(statement)
    paths = _LEAVING.get(type(statement), _NO_PATH)
    for branch in _list_branches(statement):
        paths = paths.joined(_paths_without_state(branch))
    return paths


def _list_branches(statement: ast.stmt) -> list[list[ast.stmt]]:
    """Return the blocks of a statement of which one runs; one without blocks does nothing."""
    match statement:
        case ast.If(body=body, orelse=orelse):
            return [body, orelse]
        case ast.With(body=body) | ast.AsyncWith(body=body):
            return [body]
        case ast.Match(cases=cases):
            return [[], *(case.body for case in cases)]  # none of them may match
    return [] if type(statement) in _LEAVING else [[]]


def _paths_of_loop(loop: ast.While | ast.For | ast.AsyncFor) -> _OpenPaths:
    """Return how a loop may be left: by its condition, or by a break."""
    inside = _paths_without_state(loop.body)
    after = _paths_without_state(loop.orelse)
    match loop:
        case ast.While(test=ast.Constant(value=value)) if value:
            after = _NO_PATH
    reaches_end = inside.breaks or after.reaches_end
    return _OpenPaths(reaches_end, after.breaks, inside.returns or after.returns)


def _paths_of_try(statement: ast.Try | ast.TryStar) -> _OpenPaths:
    """Return how a try statement may be left; what its finally block does counts on each path."""
    paths = _paths_without_state(statement.body + statement.orelse)
    for handler in statement.handlers:
        paths = paths.joined(_paths_without_state(handler.body))
    last = _paths_without_state(statement.finalbody)
    if not last.reaches_end:
        return last
    return _OpenPaths(paths.reaches_end, paths.breaks or last.breaks, paths.returns or last.returns)


def _list_attributes(name: str, function: AnyFunction) -> set[str] | None:
    """Return the attributes of a variable that a function uses; None where it is used otherwise."""
    used = set()
    owners = set()
    for node in walk(function):
        if isinstance(node, ast.Attribute):
            owners.add(node.value)
            if isinstance(node.value, ast.Name) and node.value.id == name:
                used.add(node.attr)
    for node in walk(function):
        if isinstance(node, ast.Name) and node.id == name and node not in owners:
            return None
    return used


def loops_without_transforms(
    code: Code,
    registered: Sequence[RegisteredGoal],
    methods: Mapping[FunctionKey, AnyFunction],
) -> CodeFaults:
    """Yield loops of goals that look up transforms, which one thread does not read meanwhile."""
    own_methods = {name: function for (_, name), function in methods.items()}
    for goal in registered:
        function = goal.function
        if isinstance(function, ast.AsyncFunctionDef):
            continue
        for node in walk(function):
            if isinstance(node, ast.While) and _looks_up(node, own_methods):
                message = (
                    f"the loop in {function.name}() looks up transforms, and rclpy.spin() has one "
                    "thread, which reads none until the loop ends; use a MultiThreadedExecutor"
                )
                at = code.at(node)
                place = code.at(goal.call)
                yield CodeFault("callback-wait", message, at, place, is_certain=False)
                break


def _looks_up(loop: ast.While, methods: Mapping[str, AnyFunction]) -> bool:
    """Return whether a loop looks up a transform, itself or by a method that it calls."""
    nodes = walk(loop)
    for node in list(nodes):
        match node:
            case ast.Call(func=ast.Attribute(value=ast.Name(id="self"), attr=name)):
                if name in methods:
                    nodes += walk(methods[name])
    for node in nodes:
        match node:
            case ast.Call(func=ast.Attribute(attr="lookup_transform")):
                return True
    return False


def answers_for_results(
    code: Code,
    parts: Sequence[CodePart],
    methods: Mapping[FunctionKey, AnyFunction],
) -> CodeFaults:
    """Yield fields of a result that are read of the answer, which has it as its field `result`."""
    callbacks: dict[FunctionKey, set[bool]] = {}
    for part in parts:
        results = _result_futures(part)
        for call in part.calls:
            match call.func:
                case ast.Attribute(attr="add_done_callback", value=future) if call.args:
                    name = dotted(call.args[0])
                    is_result = dotted(future) in results or _asks_for_result(future)
                    key = (part.of, name.removeprefix("self."))
                    callbacks.setdefault(key, set()).add(is_result)
    for key, kinds in callbacks.items():
        function = methods.get(key)
        if kinds == {True} and function:
            yield from _wrong_fields(code, function)


def _result_futures(part: CodePart) -> set[str]:
    """Return the variables that a function binds to the future of a result, and to nothing else."""
    made: dict[str, set[bool]] = {}
    for node in walk(part.node):
        match node:
            case ast.Assign(targets=[ast.Name() | ast.Attribute() as to], value=value):
                made.setdefault(dotted(to), set()).add(_asks_for_result(value))
    return {name for name, kinds in made.items() if kinds == {True}}


def _asks_for_result(node: ast.expr) -> bool:
    match node:
        case ast.Call(func=ast.Attribute(attr="get_result_async")):
            return True
    return False


def _wrong_fields(code: Code, function: AnyFunction) -> CodeFaults:
    """Yield the fields that the callback of a result reads of `future.result()`."""
    names = own_parameters(function)
    if len(names) != 1:
        return
    answers = {f"{names[0]}.result"}
    bound: dict[str, set[bool]] = {}
    for node in walk(function):
        match node:
            case ast.Assign(targets=[ast.Name(id=name)], value=value):
                bound.setdefault(name, set()).add(_is_answer(value, answers))
    variables = {name for name, kinds in bound.items() if kinds == {True}}
    for node in walk(function):
        match node:
            case ast.Attribute(attr=field, value=value, ctx=ast.Load()):
                is_variable = isinstance(value, ast.Name) and value.id in variables
                is_wrong = field not in _OF_RESULT and not field.startswith("_")
                if is_wrong and (is_variable or _is_answer(value, answers)):
                    message = (
                        f"the answer to get_result_async() has no field {field}: the result is "
                        f"{names[0]}.result().result"
                    )
                    at = code.at(node)
                    yield CodeFault("action-result", message, at)


def _is_answer(node: ast.expr, answers: set[str]) -> bool:
    return isinstance(node, ast.Call) and not node.args and dotted(node.func) in answers
