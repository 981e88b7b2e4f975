"""The check of the messages, services and actions that the packages define."""

from collections.abc import Mapping

from grader.base.errors import MissingElement, NotDecided, RubricError
from grader.base.grouping import StringsByName
from grader.base.source import Location
from grader.base.text import enumerated, quoted
from grader.lab.checks.check import About
from grader.lab.checks.outcome import Outcome, failed, passed
from grader.lab.submission.submission import Submission

ABOUT = {
    "interface_has": About(causes={"field": "a field is missing, or has another type"}),
}


def interface_has(submission: Submission, *, interface: str, fields: StringsByName) -> Outcome:
    """A message, service or action of the packages has these fields, among others.

    Args:
        interface: The type, such as lab_interfaces/action/Count.
        fields: The types of the fields, as in a .msg file, by their names: `distance` of a message,
            `request.name`, `response.name`, `goal.name`, `result.name` and `feedback.name`.
    """
    package, _, name = interface.partition("/")
    if name.count("/") != 1:
        raise RubricError((f"{quoted(interface)} is no type: write package/msg/Name",))
    submission.needed_package()
    interfaces = submission.workspace.code.interfaces.get(package)
    defined = interfaces.types.get(name.replace("/", ".")) if interfaces else None
    if not defined:
        if interfaces and not interfaces.is_complete:
            raise NotDecided(f"cannot determine statically whether there is {interface}")
        raise MissingElement("interface", interface, message=f"no package defines {interface}")
    own_fields = defined.interface.fields
    known = {key: (field.type.written, field.location) for key, field in own_fields.items()}
    wrong = _find_wrong(interface, fields, known)
    if wrong is not None:
        message, detail, at = wrong
        place = at or Location(defined.path, 1, 1)
        return failed(message, place, detail=detail, cause="field")
    return passed(f"{interface} has {enumerated(fields)}")


def _find_wrong(
    interface: str, fields: StringsByName, known: Mapping[str, tuple[str, Location | None]]
) -> tuple[str, str, Location | None] | None:
    """Return the first field that is missing or has another type: a message, a detail, a place."""
    package = interface.partition("/")[0]
    for name, written in fields.items():
        if name not in known:
            detail = f"; it has {enumerated(known) or 'none'}"
            return f"{interface} has no field {quoted(name)}", detail, None
        kind, at = known[name]
        if kind not in (written, f"{package}/{written}"):
            message = f"the field {quoted(name)} of {interface} should be {written}"
            return message, f"; it is {kind}", at
    return None
