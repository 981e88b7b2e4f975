"""Evaluation of the condition of an action, with the defaults of the launch arguments."""

from grader.package.launch.booleans import boolean
from grader.package.launch.model import Context
from grader.package.launch.substitutions import resolve
from grader.static_python.values import Call, Value


def holds(condition: Value, context: Context) -> bool | None:
    """Return whether the condition of an action holds; None where this is known only at run time."""
    if condition is None:
        return True
    if not isinstance(condition, Call):
        return None
    kind = condition.name.rpartition(".")[2]
    if kind in ("IfCondition", "UnlessCondition"):
        predicate = condition.argument(0, "predicate_expression")
        if isinstance(predicate, int | float):
            message = f"{kind} takes a string or a substitution, not {predicate}: write 'true'"
            context.add_error(message, condition.at)
        text = resolve(predicate, context)
        value = boolean(text)
        if value is None and isinstance(text, str):
            context.add_error(f"a condition is {text[:40]!r}, expected true or false", condition.at)
        return value if value is None or kind == "IfCondition" else not value
    if kind in ("LaunchConfigurationEquals", "LaunchConfigurationNotEquals"):
        name = condition.argument(0, "launch_configuration_name")
        expected = resolve(condition.argument(1, "expected_value"), context)
        actual = resolve(context.arguments.get(name) if isinstance(name, str) else None, context)
        if isinstance(expected, str) and isinstance(actual, str):
            return (expected == actual) == (kind == "LaunchConfigurationEquals")
    return None
