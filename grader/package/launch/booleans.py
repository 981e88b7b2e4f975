"""Boolean values of ROS 2's launch: texts, and the substitutions that compare and combine them."""

from collections.abc import Sequence
from math import isclose

from grader.static_python.parse import Position
from grader.static_python.values import Call, Unknown, Value

BOOLEAN_SUBSTITUTIONS = frozenset(
    {"EqualsSubstitution", "NotEqualsSubstitution", "NotSubstitution", "AndSubstitution", "OrSubstitution",
     "IfElseSubstitution", "AllSubstitution", "AnySubstitution"}
)  # fmt: skip


def operands_of(call: Call) -> list[Value]:
    """Return the operands of a boolean substitution."""
    names = ("left", "right", "value", "condition", "if_value", "else_value")
    return [*call.args, *(call.kwargs[name] for name in names if name in call.kwargs)]


def boolean_substitution(kind: str, operands: Sequence[object], at: Position) -> str | Unknown:
    """Return the text that a boolean substitution gives."""
    texts = [operand for operand in operands if isinstance(operand, str)]
    if len(texts) != len(operands):
        unknown = (operand for operand in operands if isinstance(operand, Unknown))
        return next(unknown, Unknown("the content of a file is compared", at))
    values = [boolean(text) for text in texts]
    result: bool | str | None = None
    match kind, texts:
        case (("EqualsSubstitution" | "NotEqualsSubstitution"), [left, right]):
            result = _are_equal(left, right) == (kind == "EqualsSubstitution")
        case "NotSubstitution", [_] if values[0] is not None:
            result = not values[0]
        case "IfElseSubstitution", [_, yes, *no] if values[0] is not None:
            return yes if values[0] else "".join(no[:1])
        case (("AndSubstitution" | "AllSubstitution"), _) if None not in values:
            result = all(values)
        case (("OrSubstitution" | "AnySubstitution"), _) if None not in values:
            result = any(values)
    return Unknown("this condition is not supported", at) if result is None else str(result).lower()


def boolean(value: object) -> bool | None:
    """Return the boolean value of a text; None where launch accepts it as neither."""
    texts = {"true": True, "1": True, "false": False, "0": False}
    return texts.get(value.strip().lower()) if isinstance(value, str) else None


def _are_equal(left: str, right: str) -> bool:
    """Return whether two texts are equal to launch: true equals True, and 1 equals 1.0."""
    values = (boolean(left), boolean(right))
    if None not in values:
        return values[0] == values[1]
    try:
        return isclose(float(left), float(right))
    except ValueError:
        return left == right
