"""Whether the condition of an action holds."""

from grader.package.launch.api import CONDITION, is_a
from grader.package.launch.model import Context, LaunchFails, NotEvaluated
from grader.package.launch.substitutions import known_text, resolve
from grader.package.launch.truth import condition
from grader.package.launch.value_types import kind_of
from grader.static_python.values import UNKNOWN_KEYS, Call, Unknown


def holds(call: Call, context: Context) -> bool | None:
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


def both(one: bool | None, other: bool | None) -> bool | None:
    """Return whether two conditions hold, each of which may be unknown."""
    return min(one, other, key=(False, None, True).index)
