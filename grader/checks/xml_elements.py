"""Checks of the XML elements of a URDF, whatever reads them: Gazebo, ros2_control, transmissions."""

from collections.abc import Collection, Mapping, Sequence
from copy import deepcopy
from typing import Any

from grader.checks.check import About
from grader.checks.outcome import Outcome, failed, passed
from grader.checks.toml_types import Content, NonNegative, Scalar
from grader.errors import MissingElement, NotDecided
from grader.names import did_you_mean
from grader.robot.kinematics import Configuration
from grader.robot.reader import Reading
from grader.source import LazyLocation
from grader.submission.submission import Submission
from grader.text import enumerated, first_lines, quoted
from grader.xml.parsing import Element
from grader.xml.urdf_format import numbers_in
from grader.xml.wanted_element import (
    FoundElement,
    WantedElement,
    attribute_of,
    elements_at,
    name_of,
    readable,
    steps_of,
    texts_at,
    xml_text,
)


def _breaks_under(arguments: Mapping[str, Any]) -> Collection[str]:
    """The text of an element that ROS 2 reads is compared, not what it means."""
    frames = ("fixed joints split", "frames moved")
    is_read = arguments.get("tag") in ("link", "joint", "material")
    return (*frames, "links renamed", "joints renamed") if is_read else ()


ABOUT = {
    "element_present": About(
        ("gazebo", "ros2_control", "transmission", "sensor", "safety_controller", "calibration"),
        breaks_under=_breaks_under,
    )
}

_PARTS = ("inertial", "visual", "collision")  # of a link
_MAX_NAMED = 5  # elements and values in a message


def element_present(
    robot: Configuration,
    submission: Submission,
    *,
    tag: str,
    attributes: Mapping[str, Scalar] | None = None,
    path: str = "",
    values: Mapping[str, Content] | None = None,
    tolerance: NonNegative = 1e-6,
) -> Outcome:
    """The robot directly contains an element with the given attributes, which contains all of the given values.

    Numbers, and lists of numbers in a text, are compared as numbers; true is equal to 1, and false to 0. Xacro is
    expanded first. Comments do not count.

    Args:
        tag: The name of the element, such as gazebo, ros2_control, transmission or link, with its prefix if it has one.
        attributes: The attributes of this element, by their names.
        path: The element in it that is examined: names separated by slashes, such as "sensor/camera"; by default, the
            element itself.
        values: What the examined element contains. A key is a path in it, which ends with "@name" for an attribute,
            such as "camera/image/width" or "plugin/@filename". If elements are repeated, one of them must have the
            value; for a list of values, each must be that of a different element.
        tolerance: How far a number may be off, in the number's own unit.
    """
    wanted = WantedElement(tag, attributes or {}, path, values or {}, tolerance)
    reading = submission.needed_urdf()
    root = reading.elements
    if root is None:
        raise MissingElement("robot", "", message="the file is not well-formed XML, so it has no elements")
    outcome = _judge_elements(reading, root, wanted)
    is_dropped = (
        outcome.status == "passed" and tag == "link" and _find_wanted(_without_dropped(robot, root), wanted) is None
    )
    if outcome.status == "failed" or is_dropped:
        _check_known(reading, root, wanted)
    if is_dropped:
        link = _find_wanted(root, wanted)
        assert link is not None  # it passed
        steps = (step for key in (path, *wanted.values) for step in steps_of(key))
        part = next(step for step in steps if step in _PARTS)
        message, at = f"ROS 2 drops {wanted.inner}", _element_place(reading, link)
        raise MissingElement(part, attribute_of(link, "name") or "", message=message, location=at)
    return outcome


def _without_dropped(robot: Configuration, root: Element) -> Element:
    """Return a copy of a robot without the inertials, visuals and collisions of links that ROS 2 drops."""
    parts = (part for link in robot.known.links for part in (link.inertial, *link.visuals, *link.collisions))
    tags = {part.location.tag for part in parts if part is not None and part.location is not None}
    copy = deepcopy(root)
    for tag, element in enumerate([*copy.iter()]):
        above = element.getparent()
        if above is not None and name_of(above) == "link" and name_of(element) in _PARTS and tag not in tags:
            above.remove(element)
    return copy


def _find_wanted(root: Element, wanted: WantedElement) -> Element | None:
    """Return the first element below <robot> that has the wanted content."""
    fitting = (child for child in root if name_of(child) == wanted.tag and wanted.fits(child))
    steps = steps_of(wanted.path)
    return next((it for it in fitting if not all(map(wanted.wrong, elements_at(it, steps)))), None)


def _judge_elements(reading: Reading, root: Element, wanted: WantedElement) -> Outcome:
    if _find_wanted(root, wanted) is not None:
        return passed(f"there is {wanted.inner}{' with the expected values' if wanted.values else ''}")
    tags = [child for child in root if name_of(child) == wanted.tag]
    if not tags:
        return _no_tag(reading, root, wanted)
    fitting = [element for element in tags if wanted.fits(element)]
    if not fitting:
        return _no_attributes(reading, tags, wanted)
    found = [inner for element in fitting for inner in elements_at(element, steps_of(wanted.path))]
    if not found:
        return _no_path(reading, fitting[0], wanted)
    best = wanted.nearest(found)
    wrong = wanted.wrong(best)
    if (len(found) > 1 or wanted.identity == "@name") and wanted.identity in wrong:
        return _no_identity(reading, fitting[0], found, wanted)
    faults = [_fault_text(key, texts_at(best, key), wanted.values[key]) for key in wrong]
    first = next((text for text in texts_at(best, wrong[0]) if not wanted.has(wrong[0], text)), FoundElement("", best))
    at = _element_place(reading, first.element, first.attribute)
    return failed(f"{wanted.inner}: {'; '.join(first_lines(faults, _MAX_NAMED))}", at)


def _no_tag(reading: Reading, root: Element, wanted: WantedElement) -> Outcome:
    inside = next((element for element in root.iter() if element is not root and name_of(element) == wanted.tag), None)
    message = f"there is no <{wanted.tag}> directly in <robot>"
    if inside is not None:
        above = inside.getparent()
        detail = f"; there is one in <{name_of(above)}>" if above is not None else ""
        return failed(message, _element_place(reading, inside), detail=detail)
    meant = did_you_mean(wanted.tag, {name_of(element) for element in root})
    return failed(message, detail=meant)._replace(absent=() if meant else (wanted.element,))


def _no_attributes(reading: Reading, tags: Sequence[Element], wanted: WantedElement) -> Outcome:
    given = [{key: attribute_of(element, key) for key in wanted.attributes} for element in tags]
    texts = (" ".join(f'{key}="{value}"' for key, value in one.items() if value is not None) for one in given)
    shown = dict.fromkeys(f"<{wanted.tag} {text}>" if text else f"<{wanted.tag}>" for text in texts)
    detail = f"; the file has {enumerated([*shown], _MAX_NAMED)}"
    for key, value in wanted.attributes.items():
        found = [one[key] or "" for one in given]
        detail += did_you_mean(xml_text(value), filter(None, found))
    return failed(f"there is no {wanted.element}", _element_place(reading, tags[0]), detail=detail)


def _no_path(reading: Reading, element: Element, wanted: WantedElement) -> Outcome:
    steps = steps_of(wanted.path)
    while steps and not elements_at(element, steps[:-1]):
        steps.pop()
    above = elements_at(element, steps[:-1])[0]
    message = f"there is no {wanted.inner}"
    return failed(
        message, _element_place(reading, above), detail=did_you_mean(steps[-1], {name_of(child) for child in above})
    )


def _no_identity(reading: Reading, above: Element, found: Sequence[Element], wanted: WantedElement) -> Outcome:
    """Return the failure of elements of which none has the identifying attribute."""
    names = [text.text for element in found for text in texts_at(element, wanted.identity)]
    detail = f"; the file has {enumerated([*map(quoted, names)], _MAX_NAMED)}" if names else ""
    message = f"no {wanted.inner} has the {wanted.identity!r} {quoted(str(wanted.values[wanted.identity]))}"
    return failed(message, _element_place(reading, above), detail=detail)


def _fault_text(key: str, found: Sequence[FoundElement], expected: Content) -> str:
    """Return what is wrong with the texts at a path: 'update_rate' is 10; it should be 30."""
    wanted = expected if isinstance(expected, list) else [expected]
    should = f"it should be {enumerated([_value_text(value) for value in wanted])}"
    if not found:
        return f"{key!r} is missing; {should}"
    texts = [readable(text.text) for text in found]
    return f"{key!r} is {enumerated([*map(_value_text, texts)], _MAX_NAMED)}; {should}"


def _value_text(value: Scalar) -> str:
    text = xml_text(value)
    return text if not isinstance(value, str) or numbers_in(text) else quoted(text)


def _element_place(reading: Reading, element: Element, name: str | None = None) -> LazyLocation | None:
    assert reading.elements is not None
    tag = next(index for index, other in enumerate(reading.elements.iter()) if other is element)
    return LazyLocation(reading.source, tag, name)


def _check_known(reading: Reading, root: Element, wanted: WantedElement) -> None:
    """Raise NotDecided if xacro leaves open whether the element is there, or what it contains."""
    tags = (child for child in root if name_of(child) == wanted.tag)
    fitting = (child for child in tags if wanted.may_fit(child, reading.unresolved.get(child)))
    for element in (root, *(inner for child in fitting for inner in child.iter())):
        found = reading.unresolved.get(element)
        if found is None:
            continue
        for reason in (*found.attributes.values(), found.content):
            if reason:
                raise NotDecided(reason)
