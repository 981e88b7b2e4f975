"""The check of parameters: the values that nodes get, wherever they are written.

They are also measured on the robot.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from math import dist
from typing import Any, Literal

from grader.base.errors import MissingElement, NotDecided, RubricError
from grader.base.grouping import as_list
from grader.base.names import closest, similar_there
from grader.base.text import enumerated, quoted
from grader.base.toml_types import Content, NonNegative, Scalar
from grader.base.transforms import Vector
from grader.lab.checks.outcome import Outcome, failed, passed
from grader.lab.checks.visuals import main_visual
from grader.lab.submission.submission import Submission
from grader.ros.launch.launch_model import ParameterValue
from grader.ros.package.package import Package
from grader.ros.python.values import Unknown
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.model import Cylinder, Sphere
from grader.ros.urdf.visuals import placed
from grader.workspace.model.workspace import Workspace

_Measure = Literal["radius", "length", "distance", "lower", "upper", "velocity", "effort"]
_EXACT = 1e-6
_DIGITS = 6  # after the point, as a measure has rounding errors
_Scalars = list[Scalar] | None


def parameter_is(
    submission: Submission,
    package: Package,
    *,
    node: str,
    parameter: str,
    value: Content | None = None,
    one_of: _Scalars = None,
    has: _Scalars = None,
    measure: _Measure | None = None,
    links: list[str] | None = None,
    tolerance: NonNegative = _EXACT,
    where_given: bool = False,
    or_default: bool = False,
) -> Outcome:
    """A node gets this value of a parameter, wherever it is written, under the criterion's `args`
    if it has some.

    Parameter files, values in launch files and arguments of the node count as in ROS 2. Controllers
    get those of the controller manager's files, and those that their spawner is given.

    Args:
        node: The name of the node, or of the controller, without its namespace.
        parameter: The name of the parameter, with dots for those in tables.
        value: The value that it should have; for a list all items, in order.
        one_of: Values of which it should have one.
        has: Values that a list should have among its items.
        measure: The measure of the robot that the value should equal: the radius or length of the
            shape of the first link, the distance between two links, or a limit of the joint that
            moves the first one. Of a wheel, the centre of its shape counts; of any other link, its
            frame.
        links: The links that are measured.
        tolerance: How far a number may be off, in the number's own unit.
        where_given: Whether a node that does not get the parameter passes, for `carried`, if no
            parameter file has another value.
        or_default: Whether a default counts where the node runs and does not get the parameter: of
            a node of the submission the value that its code declares, of a well-known node that of
            the rubric's release. `where_given` is for nodes without a default.
    """
    del package  # without one, there are no parameters
    try:
        said, parameter_value = _value_or_default(
            submission, node, parameter, or_default=or_default
        )
    except MissingElement:
        if not where_given:
            raise
        meant = value
        if measure is not None:
            meant = None
            with suppress(MissingElement):
                meant = measured(submission, measure, links or [])
        other = _written_otherwise(submission, parameter, meant, tolerance)
        if not other:
            return passed(f"nothing gives {parameter} to {node}")
        parameter_value = other
        said = f"a parameter file has {parameter} ="
    if isinstance(parameter_value.value, Unknown):
        cause = f"the parameter {parameter} of {node} cannot be determined statically"
        raise NotDecided(f"{cause}: {parameter_value.value.reason}", cause)
    if measure is not None:
        value = measured(submission, measure, links or [])
    actual = parameter_value.value
    wanted, fits = _compare_value(actual, value, one_of, has, tolerance)
    message = f"{said} {_text(actual)}"
    if measure is not None:
        wanted += f", the {measure} of {enumerated(map(quoted, links or []))} in the robot"
    unknown = submission.workspace.launches.unknown_includes
    if not fits and unknown:
        cause = "cannot determine statically which arguments a launch file gets"
        raise NotDecided(f"{cause}: {unknown}", cause)
    return passed(message) if fits else failed(f"{message}; it {wanted}", parameter_value.location)


def _compare_value(
    actual: Any,
    value: Content | None,
    one_of: _Scalars,
    has: _Scalars,
    tolerance: float,
) -> tuple[str, bool]:
    """Return what a value should be, in words, and whether it is so."""
    wanted = ""
    fits = True
    if value is not None:
        shown = round(value, _DIGITS) if isinstance(value, float) else value
        wanted = f"should be {_text(shown)}"
        fits = _equal(actual, value, tolerance)
    if one_of is not None:
        wanted = f"should be {enumerated(map(_text, one_of), word='or')}"
        fits = _has(one_of, actual, tolerance)
    if has is not None:
        items = as_list(actual)
        wanted = f"should have {enumerated(map(_text, has))}"
        fits = all(_has(items, expected, tolerance) for expected in has)
    return wanted, fits


def _value_or_default(
    submission: Submission, node: str, parameter: str, *, or_default: bool
) -> tuple[str, ParameterValue]:
    """Return the value that a node gets, or else its default, after the words for that.

    Raises MissingElement and NotDecided, as `find_value` does.
    """
    try:
        return f"{quoted(node)} gets {parameter} =", find_value(submission, node, parameter)
    except MissingElement:
        default = submission.default_value(node, parameter) if or_default else None
        if not default:
            raise
        return f"{quoted(node)} uses the default {parameter} =", default


def _written_otherwise(
    submission: Submission, parameter: str, value: Any, tolerance: float
) -> ParameterValue | None:
    """Return what parameter files have for a parameter, of whatever node.

    It is None if one of them has the value, or none has a value that is known.
    """
    written = submission.workspace.installed.written_values(parameter)
    known = [
        value_written for value_written in written if not isinstance(value_written.value, Unknown)
    ]
    has_it = value is None or any(
        _equal(value_written.value, value, tolerance) for value_written in known
    )
    return None if has_it else next(iter(known), None)


def find_value(submission: Submission, node: str, parameter: str) -> ParameterValue:
    """Return the value that a node gets.

    Raises MissingElement if it gets none, NotDecided where that is not known.
    """
    workspace = submission.workspace
    given = workspace.parameters.owners.get(node, [])
    values = [
        node_values.values[parameter] for node_values in given if parameter in node_values.values
    ]
    if len({repr(value.value) for value in values}) == 1 and len(values) == len(given):
        return values[0]
    unknown = (
        next((node_values.unknown for node_values in given if node_values.unknown), "")
        or workspace.launches.unknown_nodes
    )
    if unknown:
        raise NotDecided(
            f"the parameters of {quoted(node)} are not known: {unknown}",
            "parameters of a node are not known",
        )
    if values:
        places = enumerated([value.location.file_and_line for value in values])
        raise NotDecided(
            f"{quoted(node)} gets different values of {parameter}: {places}",
            "a parameter has several values",
        )
    if not given:
        raise _explain_nothing_given(workspace, node)
    raise _explain_missing_parameter(submission, node, parameter)


def _explain_nothing_given(workspace: Workspace, node: str) -> NotDecided | MissingElement:
    """Return the error of a node that nothing gives parameters to."""
    for other in workspace.launches.nodes:
        is_own = workspace.find_package(other) is not None
        if (is_own or other.parameters) and workspace.code.find_name(other) is None:
            cause = "the name of a node is only in its program"
            return NotDecided(f"{cause}: {other.package}/{other.executable}", cause)
    there = similar_there(node, workspace.parameters.owners)
    message = f"nothing gives parameters to a node {quoted(node)}{there}"
    return MissingElement("parameters of the node", node, message=message)


def _explain_missing_parameter(submission: Submission, node: str, parameter: str) -> MissingElement:
    """Return the error of a node that gets other parameters, but not this one."""
    written = {}
    for node_values in submission.workspace.parameters.owners[node]:
        for name, value in node_values.values.items():
            written[name] = value.location
    message = (
        f"{node} does not get the parameter {quoted(parameter)}{similar_there(parameter, written)}"
    )
    at = written.get(closest(parameter, written) or "", next(iter(written.values()), None))
    return MissingElement("parameter", f"{node} {parameter}", message=message, location=at)


def _equal(actual: Any, wanted: Any, tolerance: float) -> bool:
    """Return whether a value is a wanted one: numbers within a tolerance, lists item by item."""
    match actual, wanted:
        case (list(), list()):
            return len(actual) == len(wanted) and all(
                map(_equal, actual, wanted, [tolerance] * len(actual))
            )
        case (bool() | str(), bool() | str()):
            return (type(actual), actual) == (type(wanted), wanted)
        case (int() | float(), int() | float()) if not isinstance(actual, bool) and not isinstance(
            wanted, bool
        ):
            return abs(actual - wanted) <= tolerance
    return False


def _has(values: Sequence[Any], wanted: Any, tolerance: float) -> bool:
    return any(_equal(value, wanted, tolerance) for value in values)


def _text(value: Any) -> str:
    if isinstance(value, list):
        return f"[{', '.join(map(_text, value))}]"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return quoted(value)
    return f"{value:.12g}"


def measured(submission: Submission, measure: _Measure, links: list[str]) -> float:
    """Return a measure of the robot, in metres or radians.

    Raises MissingElement for a link that is not there.
    """
    robot = submission.needed_urdf().robot
    if not robot:
        raise MissingElement(
            "robot", "", message="ROS 2 cannot read the file, so there is no robot"
        )
    if len(links) != 1 + (measure == "distance"):
        raise RubricError(
            (
                (
                    f"parameter_is measures a {measure}: give "
                    f"{'two links' if measure == 'distance' else 'a link'}"
                ),
            )
        )
    measurement = measures(Configuration(robot), links).get(measure)
    if measurement is None:
        raise MissingElement("measure", links[0], message=f"{quoted(links[0])} has no {measure}")
    return measurement()


def measures(robot: Configuration, links: list[str]) -> Mapping[str, Callable[[], float]]:
    """Return what can be measured of one link, or of two.

    This is a radius, a distance, or the limits of a joint.

    Args:
        robot: The robot.
        links: The names of one or two links.
    """
    return dict(_measures(robot, links))


def _place(robot: Configuration, link: str, relative_to: str) -> Vector:
    """Return the centre of a cylinder or sphere that a joint turns without end.

    For another link, return where its frame is.
    """
    joint = robot.parent_joints.get(link)
    if joint and joint.type == "continuous" and robot.robot.link(link).visuals:
        visual = main_visual(robot, link)
        if isinstance(visual.geometry, Cylinder | Sphere):
            return placed(robot, link, visual, relative_to).pose.translation
    return robot.pose(link, relative_to=relative_to).translation


def _measures(robot: Configuration, links: list[str]) -> Iterator[tuple[str, Callable[[], float]]]:
    first = robot.robot.link(links[0])
    if len(links) > 1:
        yield "distance", lambda: dist(*(_place(robot, link, links[0]) for link in links))
        return
    for visual in first.visuals:
        match visual.geometry:
            case Cylinder(radius=radius, length=length):
                yield "radius", lambda: radius
                yield "length", lambda: length
            case Sphere(radius=radius):
                yield "radius", lambda: radius
    joint = next(
        (moving for moving in reversed(robot.chain(links[0])) if moving.type != "fixed"), None
    )
    if joint and joint.limit is not None:
        limit = joint.limit
        yield from (("lower", lambda: limit.lower), ("upper", lambda: limit.upper))
        yield from (("velocity", lambda: limit.velocity), ("effort", lambda: limit.effort))
