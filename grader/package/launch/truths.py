"""What launch takes for true and false: texts, and the substitutions that compare and join them."""

from collections.abc import Sequence
from math import isclose

from grader.static_python.values import Made, Spot, Unknown, Value

LOGIC = frozenset(
    {"EqualsSubstitution", "NotEqualsSubstitution", "NotSubstitution", "AndSubstitution", "OrSubstitution",
     "IfElseSubstitution", "AllSubstitution", "AnySubstitution"}
)  # fmt: skip
_OPERANDS = ("left", "right", "value", "condition", "if_value", "else_value")


def operands_of(made: Made) -> list[Value]:
    """What a substitution for true and false is given."""
    return [*made.args, *(made.kwargs[name] for name in _OPERANDS if name in made.kwargs)]


def logical(kind: str, operands: "Sequence[object]", spot: Spot) -> str | Unknown:
    """What launch's substitutions for true and false come to."""
    unknown = next((each for each in operands if isinstance(each, Unknown)), None)
    texts = [each for each in operands if isinstance(each, str)]
    if len(texts) != len(operands):
        return unknown or Unknown("the content of a file is compared", spot)
    truths = [truth_of(each) for each in texts]
    match kind, texts:
        case (("EqualsSubstitution" | "NotEqualsSubstitution"), [left, right]):
            return str(_are_equal(left, right) == (kind == "EqualsSubstitution")).lower()
        case "NotSubstitution", [_] if truths[0] is not None:
            return str(not truths[0]).lower()
        case "IfElseSubstitution", [_, yes, *no] if truths[0] is not None:
            return yes if truths[0] else "".join(no[:1])
        case (("AndSubstitution" | "AllSubstitution"), _) if None not in truths:
            return str(all(truths)).lower()
        case (("OrSubstitution" | "AnySubstitution"), _) if None not in truths:
            return str(any(truths)).lower()
    return Unknown("this condition is not followed", spot)


def _are_equal(left: str, right: str) -> bool:
    """Whether two texts say the same to launch, which takes true and True, 1 and 1.0 for equal."""
    truths = (truth_of(left), truth_of(right))
    if None not in truths:
        return truths[0] == truths[1]
    try:
        return isclose(float(left), float(right))
    except ValueError:
        return left == right


def truth_of(value: object) -> bool | None:
    """Whether a text says true or false to launch; None where it says neither."""
    if not isinstance(value, str):
        return None
    return {"true": True, "1": True, "false": False, "0": False}.get(value.strip().lower())
