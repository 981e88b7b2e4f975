"""Whether the condition of an action holds, with the defaults of the launch arguments."""

from grader.package.launch.substitutions import Context, resolve
from grader.package.launch.truths import truth_of
from grader.static_python.values import Made, Value


def holds(condition: Value, context: Context) -> bool | None:
    """Whether a condition of a node holds with the defaults; None where only a run would tell."""
    if condition is None:
        return True
    if not isinstance(condition, Made):
        return None
    last = condition.name.rpartition(".")[2]
    if last in ("IfCondition", "UnlessCondition"):
        predicate = condition.argument(0, "predicate_expression")
        if isinstance(predicate, int | float):
            context.wrong.append(
                (f"{last} takes a text or a substitution, not {predicate}: write 'true'", condition.at)
            )
        text = resolve(predicate, context)
        known = truth_of(text)
        if known is None and isinstance(text, str):
            context.wrong.append((f"a condition is {text[:40]!r}, which is neither true nor false", condition.at))
        return known if known is None or last == "IfCondition" else not known
    if last in ("LaunchConfigurationEquals", "LaunchConfigurationNotEquals"):
        name = condition.argument(0, "launch_configuration_name")
        value = resolve(condition.argument(1, "expected_value"), context)
        actual = resolve(context.arguments.get(name) if isinstance(name, str) else None, context)
        if not isinstance(value, str) or not isinstance(actual, str):
            return None
        return (value == actual) == (last == "LaunchConfigurationEquals")
    return None
