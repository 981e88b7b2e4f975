"""What the functions that a launch file in Python calls give."""

import re
from collections.abc import Callable
from functools import partial
from io import StringIO
from typing import Any

import yaml

from grader.package.launch.api import LaunchClass, class_named, exports
from grader.package.launch.arguments import bind, check
from grader.package.launch.model import UnknownText, not_evaluated
from grader.package.launch.places import HOME, WORKING_FOLDER
from grader.static_python.calls import Calls
from grader.static_python.evaluation import Evaluation, record
from grader.static_python.knowledge import known, path_text
from grader.static_python.library import standard_functions
from grader.static_python.values import Call, ExpressionFails, Undetermined, Unknown, Value

_MAX_YAML = 20_000  # characters


_Run = Callable[[Evaluation, Call], Value]


class LaunchFunctions(dict[str, Any]):
    """The functions by full name, with every class of launch and its methods."""

    def get(self, name: str, default: Any = None) -> Any:
        """Return a function; None for one that is not evaluated."""
        found = super().get(name)
        return found if found is not None else _function_of(name) or default

    def __contains__(self, name: object) -> bool:
        return self.get(str(name)) is not None


def _function_of(name: str) -> _Run | None:
    """Return the constructor of a class of launch, or one that fails: of a name that is not there."""
    owner, _, own = name.rpartition(".")
    names, cls = exports().get(owner), class_named(owner)
    if names is not None and own in names:
        made = class_named(names[own])
        return partial(_construct, made) if made is not None else None
    if names is not None or (cls is not None and own not in cls.methods and not own.startswith("_")):
        return partial(_fail, f"{cls.short if cls is not None else owner} has no {own!r}")
    return None


def _construct(cls: LaunchClass, evaluation: Evaluation, call: Call) -> Value:
    call.name = cls.name
    bind(cls, call)
    doubt = check(cls, call)
    if doubt is not None:
        evaluation.doubted(Unknown(not_evaluated(doubt.reason), doubt.at))
    return record(evaluation, call)


def _fail(message: str, *_: object) -> Value:
    raise ExpressionFails(message)


def add_action(evaluation: Evaluation, call: Call) -> Value:
    """Record an action that is added to a description."""
    if len(call.args) + len(call.kwargs) != 1:
        raise ExpressionFails(f"{call.name.rpartition('.')[2]} takes one action")
    record(evaluation, call)


def safe_load(evaluation: Evaluation, call: Call) -> Value:
    """Return what a short YAML text without anchors and tags contains."""
    given = call.argument(0, "stream")
    text = given.read() if isinstance(given, StringIO) else given
    if not isinstance(text, str) or len(text) > _MAX_YAML or re.search(r"(^|\s)[&*!]", text):
        raise Undetermined("this YAML is not evaluated")
    try:
        return evaluation.budget.checked(yaml.safe_load(text))
    except (yaml.YAMLError, ValueError, RecursionError):
        raise ExpressionFails("this text is not YAML") from None


def variable(_: Evaluation, call: Call) -> Value:
    """Return a variable of the environment: whether it is set is not known."""
    name, default = known(call.argument(0, "key")), known(call.argument(1, "default"))
    if name == "HOME":
        return HOME
    reason = "the environment is not evaluated"
    if call.name.endswith("__getitem__"):
        raise Undetermined(reason)
    return (UnknownText if isinstance(default, str) else Unknown)(reason, call.at)


def join_paths(evaluation: Calls, call: Call) -> Value:
    """Return what os.path.join returns; it fails for substitutions."""
    if any(isinstance(value, Call) and class_named(value.name) is not None for value in call.args):
        raise ExpressionFails("os.path.join takes strings, not substitutions: use PathJoinSubstitution([...])")
    return evaluation.call_value(standard_functions(WORKING_FOLDER)["os.path.join"], call)


def expand_user(_: Evaluation, call: Call) -> Value:
    """Return a path with the home folder in place of ~."""
    text = path_text(known(call.args[0])) if call.args else None
    return re.sub("^~", HOME, text) if text is not None else Unknown("a path is not evaluated", call.at)
