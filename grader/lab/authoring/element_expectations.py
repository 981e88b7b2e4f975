"""Expectations of the elements for simulators and controllers, which ROS 2 itself does not read."""

import re
from collections import Counter
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from math import isfinite
from typing import Any

from grader.base.grouping import StringsByName, as_list
from grader.base.patterns import on_use
from grader.base.text import enumerated
from grader.lab.authoring.expectations import (
    CarriedExpectation,
    Expectation,
    Expectations,
    Omission,
    Solution,
    are_joints_free,
    longest_title,
)
from grader.ros.installation.places import is_of_one_machine
from grader.ros.package.robot_file import Read, read_as_ros
from grader.ros.package.trees import is_path, split_path
from grader.ros.python.budget import Budget
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.link_tree import JOINT_OF
from grader.ros.xml.elements import (
    foreign_elements,
    list_attributes,
    read_name,
    readable,
    text_in,
    xml_text,
)
from grader.ros.xml.parsing import Element
from grader.workspace.rules.controllers import needed_interfaces
from grader.workspace.rules.reading import read_agreement

_MAX_VALUES = 500  # in one element of <robot>: a check compares each with each
_NUMBER = on_use(r"[-+]?(?:\d++\.?\d*+|\.\d++)(?:[eE][-+]?\d++)?")
_CONDITION = on_use(r"\[[^\[\]=@]*@[^=@\[\]]+='([^']*)'\]")
_REFERENCE = on_use(r"\[(@reference|joint/@name)='([^']*)'\]")
_JOINT_KEY = on_use(r"(?:^|[/_])joints?$|joint_names?$|(?:^|/)joint/@name$")
_TRUTH = {"true": True, "false": False}
_FILE = on_use(r"/[\w.-]+\.(ya?ml|xml|xacro|urdf|sdf|srdf|world|rviz|config)$")
_SMALL = 0.05  # below it, the usual tolerance of numbers is too large
_SHARE = 0.01  # of a small number: its tolerance
_MAX_TITLE = 100  # characters
_INTERFACE = "command_interface/@name"
_NAMED_FREELY = ("ros2_control", "transmission")
_OF_ARGUMENTS = ("urdf_loads", "files names_agree", "arguments names_agree")
# The paths of values that are details: see `Expectation.is_detail`.
_DETAIL = on_use(
    r"\A(gazebo/sensor/(.*/)?(@name|\w*frame_id|always_on|visualize|format|horizontal_fov"
    r"|(noise|clip)(/.*)?)"
    r"|ros2_control/joint/\w+/param(/.*)?"
    r"|gazebo/(?!sensor|plugin).*)"
)
# Likewise of a joint that mimics another one.
_DETAIL_OF_MIMIC = on_use(r"ros2_control/joint/state_interface(/.*)?")
_CONDITIONS = on_use(r"\[[^\[\]]*\]")
_Values = dict[str, Any]
_Arguments = Mapping[str, Any]  # of entry_is


def element_expectations(solution: Solution, causes: Collection[str]) -> Expectations:
    """Yield the values in each element for simulators and controllers.

    `causes` change the arguments of xacro.

    What a controller needs of a joint is left to the names of controllers.
    """
    covered = needed_interfaces(solution.submission.workspace)
    robot = solution.robot.robot
    joints = {joint.name for joint in robot.joints}
    links = {link.name for link in robot.links}
    selectors = {}
    for joint in robot.joints if are_joints_free(solution) else ():
        if joint.name not in links and "'" not in joint.child:
            selectors[joint.name] = f"{JOINT_OF}{joint.child}"
    joints.update(selectors.values())
    agreement = read_agreement(solution.submission.workspace)

    def asked(entry: Expectation | Omission) -> Expectation | Omission:
        if isinstance(entry, Omission):
            return entry
        if agreement.holds("topics"):
            entry = _without_topics(entry)
        if agreement.holds("files"):
            entry = _without_files(entry)
        entry = _by_links(entry, selectors)
        return entry._replace(title=_title(entry))

    without_launch = _root_without_launch_files(solution)
    without = (
        None if without_launch is None else list(map(asked, _entries(without_launch, covered)))
    )
    met: Counter[str] = Counter()
    for entry in map(asked, _entries(solution.root, covered)):
        if isinstance(entry, Omission):
            yield entry
            continue
        met[entry.words] += 1
        carried = list(_carried_from_names(entry, joints, links))
        if without is not None:
            others = [
                one.arguments
                for one in without
                if isinstance(one, Expectation) and one.words == entry.words
            ]
            other = others[met[entry.words] - 1] if len(others) >= met[entry.words] else None
            carried += _carried_from_launch(entry, other, (*_OF_ARGUMENTS, *causes))
        yield entry._replace(carried=carried)


def details_apart(expectations: Expectations, robot: Configuration) -> Expectations:
    """Yield expectations, of those about an element first all but its details, then these."""
    mimics: set[str] = set()
    for joint in robot.robot.joints:
        if joint.mimic:
            mimics.update((joint.name, f"{JOINT_OF}{joint.child}"))
    for expectation in expectations:
        if isinstance(expectation, Expectation) and expectation.check == "entry_is":
            yield from _with_details_apart(expectation, mimics)
        else:
            yield expectation


def _with_details_apart(expectation: Expectation, mimics: Collection[str]) -> Iterator[Expectation]:
    """Yield an expectation without details, if something else is left of it, and its details."""
    values = expectation.arguments.get("values", {})
    details = [_DETAIL]
    if values.get("@name") in mimics:
        details.append(_DETAIL_OF_MIMIC)
    kept = _without_details(expectation.arguments, details)
    if kept == expectation.arguments:
        yield expectation
        return
    if kept.get("values"):
        carried = []
        for one in expectation.carried:
            if "at" in one.arguments:
                carried.append(one._replace(arguments=_without_details(one.arguments, details)))
            else:
                carried.append(one)
        main = expectation._replace(arguments=kept, carried=carried)
        yield main._replace(title=_title(main))
    rest = {}
    for key, value in values.items():
        if key == "@name" or key not in kept.get("values", {}):
            rest[key] = value
    apart = expectation._replace(
        arguments=_entry(expectation.arguments["at"], rest),
        words=f"{expectation.words} details",
        carried=(),
    )
    yield apart._replace(title=_title(apart), is_detail=True)


def _without_details(arguments: _Arguments, details: Collection[re.Pattern[str]]) -> _Arguments:
    """Return the arguments of entry_is without the values that are details."""
    path = _CONDITIONS.sub("", arguments["at"])
    kept = _with_values(
        arguments,
        lambda key, _: not any(detail.fullmatch(f"{path}/{key}") for detail in details),
    )
    is_whole = len(kept.get("values", {})) == len(arguments.get("values", {}))
    return arguments if is_whole else kept


def _with_values(arguments: _Arguments, is_kept: Callable[[str, Any], bool]) -> _Arguments:
    """Return the arguments of entry_is with those of its values, by their paths, that are kept."""
    values = {}
    for path, value in arguments.get("values", {}).items():
        if is_kept(path, value):
            values[path] = value
    return _entry(arguments["at"], values)


def _without_topics(expectation: Expectation) -> Expectation:
    """Return an expectation without the names of topics, which need only agree."""
    arguments = _with_values(expectation.arguments, lambda path, _: not path.endswith("topic"))
    return expectation._replace(arguments=arguments)


def _without_files(expectation: Expectation) -> Expectation:
    """Return an expectation without the paths of files, whose names are free.

    A build has to install them.
    """
    arguments = _with_values(
        expectation.arguments,
        lambda _, value: not (isinstance(value, str) and _FILE.search(value)),
    )
    return expectation._replace(arguments=arguments)


def _by_links(expectation: Expectation, selectors: StringsByName) -> Expectation:
    """Return an expectation with joints named by the links that they hold.

    `selectors` has these by the names of joints.
    """
    at = expectation.arguments["at"]
    values = expectation.arguments.get("values", {})
    is_joint = at.endswith("/joint")
    is_of_system = at.startswith("ros2_control")
    at = _REFERENCE.sub(
        lambda reference: f"[{reference[1]}='{selectors.get(reference[2], reference[2])}']", at
    )

    def named(key: str, value: Any) -> Any:
        if not (is_of_system or _JOINT_KEY.search(key) or (is_joint and key == "@name")):
            return value
        if isinstance(value, list):
            return [selectors.get(name, name) for name in value]
        return selectors.get(value, value)

    return expectation._replace(
        arguments=_entry(at, {key: named(key, value) for key, value in values.items()})
    )


def _carried_from_names(
    expectation: Expectation, joints: Collection[str], links: Collection[str]
) -> Iterator[CarriedExpectation]:
    """Yield what counts instead of an expectation if names of joints or links are wrong."""
    without_links = _weakened(expectation.arguments, links)
    weaker = _weakened(without_links, joints)
    if weaker != expectation.arguments:
        of_joints = ("joints_named", "controllers names_agree") if weaker != without_links else ()
        yield CarriedExpectation((*of_joints, "frames names_agree"), expectation.check, weaker)


def _root_without_launch_files(solution: Solution) -> Element | None:
    """Return the <robot> if no launch file gives arguments to xacro.

    It is None where there is no robot.
    """
    urdf = solution.submission.urdf
    submission = solution.submission
    if not isinstance(urdf, Read) or not urdf.is_expanded:
        return None
    around = submission.surroundings(Budget())._replace(graded=None)
    reading = read_as_ros(urdf.data, urdf.path, around).reading
    return None if not reading.robot else reading.root


def _carried_from_launch(
    expectation: Expectation, other: _Arguments | None, causes: Sequence[str]
) -> list[CarriedExpectation]:
    """Return what counts instead of an expectation if launch files give xacro no arguments.

    This is what stays true without them.
    """
    if other == expectation.arguments:
        return []
    if other is None:
        return [CarriedExpectation(causes, "urdf_loads")]
    others = other.get("values", {})
    same = _with_values(expectation.arguments, lambda key, value: others.get(key) == value)
    return [CarriedExpectation(causes, expectation.check, same)]


def _weakened(arguments: _Arguments, names: Collection[str]) -> _Arguments:
    """Return the arguments without conditions and values that are names of joints and links."""
    at = _CONDITION.sub(
        lambda condition: "" if condition[1] in names else condition[0], arguments["at"]
    )
    return _with_values(
        {**arguments, "at": at}, lambda _, expected: not _names_any(expected, names)
    )


def _names_any(value: Any, names: Collection[str]) -> bool:
    """Return whether a value is a name, or a list with one."""
    return any(isinstance(word, str) and word in names for word in as_list(value))


def _entry(at: str, values: _Arguments) -> _Arguments:
    """Return the arguments of entry_is, with a tolerance for numbers that are small."""
    if not values:
        return {"at": at}
    numbers = []
    for value in values.values():
        numbers += [abs(item) for item in as_list(value) if isinstance(item, float) and item]
    least = min(numbers, default=_SMALL)
    if least < _SMALL:
        return {"at": at, "values": values, "tolerance": float(f"{least * _SHARE:.1g}")}
    return {"at": at, "values": values}


def _title(expectation: Expectation) -> str:
    """Return what a criterion asks of an element, in a sentence that names its joint or link."""
    steps = split_path(expectation.arguments["at"], is_xml=True)
    values = dict(expectation.arguments.get("values", {}))
    outer = f"<{steps[0].name}>"
    subjects = [
        value for key, value in steps[0].conditions if key in ("@reference", "@name", "joint/@name")
    ]
    if subjects:
        outer += f" of {_subject_text(subjects[0])}"
    inner = f"<{steps[-1].name}>"
    if "@name" in values and steps[-1].name == "joint":
        name = str(values.pop("@name"))
        inner = _subject_text(name) if name.startswith(JOINT_OF) else f"the joint {name!r}"
    elif "@name" in values:
        inner += f" {values.pop('@name')!r}"
    details = [f"{_key_text(key)} {_value_words(value)}" for key, value in values.items()]
    start = f"in {outer}, {inner}" if len(steps) > 1 else outer
    if not details:
        return f"there is {inner} in {outer}" if len(steps) > 1 else f"there is {outer}"
    return longest_title(f"{start} has", details, _MAX_TITLE, f"{start} is as in the reference")


def _subject_text(name: str) -> str:
    if name.startswith(JOINT_OF):
        return f"the joint of {name.removeprefix(JOINT_OF)!r}"
    return repr(name)


def _key_text(key: str) -> str:
    """Return the path of a value in words: command interface for command_interface/@name."""
    words = key.replace("/@name", "").replace("@", "").replace("/", " ").replace("_", " ")
    return " ".join(words.split())


def _value_words(value: Any) -> str:
    if isinstance(value, list):
        return enumerated(map(_value_words, value))
    text = xml_text(value)
    return _subject_text(text) if text.startswith(JOINT_OF) else text


def _entries(root: Element, covered: Collection[str]) -> Expectations:
    """Yield the values in each element, or why it is omitted.

    The interfaces that are `covered` are not among them.
    """
    for element in foreign_elements(root):
        about = f"<{read_name(element)}>"
        if sum(1 + len(inner.attrib) for inner in element.iter()) > _MAX_VALUES:
            yield Omission(
                _label(element), f"it has more than {_MAX_VALUES} elements and attributes"
            )
            continue
        conditions = _conditions(element)
        for label, path, values in _element_values(element):
            at = f"{read_name(element)}{conditions}{f'/{path}' if path else ''}"
            _drop_free(values, read_name(element))
            if (read_name(element), path) == ("ros2_control", "joint"):
                _drop_covered(values, covered)
            if is_path(at):
                yield Expectation(about, "entry_is", _entry(at, values), label)
            else:
                yield Omission(label, "a path cannot name it")


def _conditions(element: Element) -> str:
    """Return what tells an element from others like it, as conditions of a path.

    The names of <ros2_control> and <transmission> are free: a transmission is that of its joint.
    """
    tag = read_name(element)
    texts = [
        f"[@{key}='{value}']"
        for key, value in list_attributes(element)
        if key != "name" or tag not in _NAMED_FREELY
    ]
    joints = element.findall("joint") if tag == "transmission" else []
    if len(joints) == 1 and joints[0].get("name"):
        texts.append(f"[joint/@name='{joints[0].get('name')}']")
    return "".join(texts)


def _drop_free(values: _Values, tag: str) -> None:
    """Remove the names of actuators, which nothing refers to."""
    if tag == "transmission":
        values.pop("@name", None)
        for key in [key for key in values if key.endswith("actuator/@name")]:
            del values[key]


def _drop_covered(values: _Values, covered: Collection[str]) -> None:
    """Remove the command interfaces of a joint if controllers need all of them."""
    interfaces = as_list(values.get(_INTERFACE, []))
    if interfaces and all(
        f"{values.get('@name')}/{interface}" in covered for interface in interfaces
    ):
        del values[_INTERFACE]


def _element_values(element: Element) -> Iterator[tuple[str, str, _Values]]:
    """Yield the plain values in an element, then those in its children.

    The children are those that have elements or attributes.

    Each has a label, the path of the child, and values by their paths in it.
    """
    plain: _Values = {}
    deep = []
    for child in _children(element):
        if _children(child) or child.attrib:
            deep.append(child)
        else:
            _add(plain, read_name(child), _value(text_in(child)))
    if plain or not deep:
        yield _label(element), "", plain
    for child in deep:
        yield f"{_label(element)} {_label(child)}", read_name(child), _values_by_path(child)


def _values_by_path(element: Element, path: str = "") -> _Values:
    """Return all attributes and texts in an element by their paths; of repeated ones a list."""
    values_by_path: _Values = {}
    for key, text in element.attrib.items():
        _add(values_by_path, f"{path}@{key!s}", _value(str(text)))
    for child in _children(element):
        inner = f"{path}{read_name(child)}"
        if not _children(child) and (text_in(child) or not child.attrib):
            _add(values_by_path, inner, _value(text_in(child)))
        for key, value in _values_by_path(child, f"{inner}/").items():
            _add(values_by_path, key, value)
    return values_by_path


def _add(values: _Values, key: str, value: Any) -> None:
    """Add a value; of several values with one path, a list.

    A path that exists on one machine only is none, nor is an empty text: what it becomes, an
    argument may say.
    """
    if isinstance(value, str) and (not value or is_of_one_machine(value)):
        return
    if key not in values:
        values[key] = value
    else:
        values[key] = as_list(values[key]) + as_list(value)


def _value(text: str) -> str | bool | int | float:
    """Return the text of an element or attribute as a rubric writes it.

    This is a number, true or false, else a string.
    """
    word = readable(text.strip())
    if word in _TRUTH:
        return _TRUTH[word]
    if _NUMBER.fullmatch(word) and isfinite(number := float(word)):
        if re.fullmatch(r"-?(?:0|[1-9]\d{0,14})", word):
            return int(word)
        return number
    return " ".join(word.split())


def _children(element: Element) -> list[Element]:
    return [child for child in element if isinstance(child.tag, str)]


def _label(element: Element) -> str:
    """Return the tag and the name of an element, if that is not free."""
    tag = read_name(element)
    keys = () if tag in _NAMED_FREELY else ("reference", "name", "filename", "type")
    return f"{tag} {next((str(element.get(key)) for key in keys if element.get(key)), '')}"
