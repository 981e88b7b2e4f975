"""The arguments of actions, evaluated as launch does before it executes them."""

from grader.package.launch.model import Context, LaunchFails, NotEvaluated, Resolved
from grader.package.launch.parameters import evaluate_parameters
from grader.package.launch.substitutions import known_text, resolve
from grader.package.launch.truth import boolean
from grader.package.launch.value_types import items_in, kind_of
from grader.static_python.parse import Position
from grader.static_python.values import Call, Undetermined, Unknown, Value


def evaluate_field(value: Value, name: str, test: str, context: Context, at: Position) -> None:
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


def launch_arguments(given: Value, context: Context, at: Position) -> dict[str, Resolved]:
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
