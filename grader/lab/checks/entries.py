"""The check of the entries of a file: of the expanded robot, of YAML, SDF, SRDF and package.xml."""

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from copy import deepcopy
from typing import Annotated, Any, NamedTuple

from grader.base.errors import MissingElement, NotDecided
from grader.base.grouping import as_list
from grader.base.names import similar_there
from grader.base.pairing import most_pairs
from grader.base.patterns import on_use
from grader.base.source import LazyLocation
from grader.base.text import MAX_NAMED, enumerated, first_lines, quoted
from grader.base.toml_types import Constraint, Content, NonNegative, Scalar
from grader.lab.checks.check import MIMIC_TURNED, About
from grader.lab.checks.outcome import Outcome, failed, passed
from grader.lab.submission.submission import Submission
from grader.ros.known.releases import Release
from grader.ros.package.package import Package
from grader.ros.package.trees import (
    PathStep,
    Search,
    TreeEntry,
    is_path,
    read_tree,
    split_path,
    xml_entry,
)
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.reader import Reading
from grader.ros.xml.elements import matches_value, read_name, readable, xml_text
from grader.ros.xml.parsing import Element
from grader.ros.xml.urdf_format import numbers_in

_ROBOT = "robot"
_IN_ROBOT = "directly in <robot>"
_PARTS = ("inertial", "visual", "collision")  # of a link
_IDENTIFYING = ("@name", "@reference", "@filename", "@type")  # the first that a rubric gives
_USES = ("@world", "@controllers", "@bridge")  # of files
_GIVEN = "@parameters/"  # before the name of a node
_LIBRARY = "@filename"  # of a plugin
_LIBRARY_FILE = on_use(r"lib(.+)\.so")
_TOLERANCE = 1e-6  # of numbers, where a rubric gives none
_SLACK = 1e-12  # a tolerance includes its end
_Path = Annotated[str, Constraint("a path such as gazebo[@reference='lidar']/sensor", is_path)]
_Entries = Sequence[TreeEntry]
_Scalars = list[Scalar] | None


def _breaks_under(arguments: Mapping[str, Any]) -> Collection[str]:
    """The text of an element that ROS 2 reads is compared, not what it means."""
    frames = ("fixed joints split", "frames moved")
    steps = split_path(arguments.get("at") or "", is_xml=True)
    is_read = (
        arguments.get("file", _ROBOT) == _ROBOT
        and bool(steps)
        and steps[0].name in ("link", "joint", "material")
    )
    return (*frames, "links renamed", "joints renamed", MIMIC_TURNED) if is_read else ()


def entry_is(
    robot: Configuration,
    submission: Submission,
    *,
    file: str = _ROBOT,
    at: _Path = "",
    value: Content | None = None,
    one_of: _Scalars = None,
    has: _Scalars = None,
    values: Mapping[str, Content] | None = None,
    tolerance: NonNegative = _TOLERANCE,
    only: bool = False,
    absent: bool = False,
) -> Outcome:
    """The expanded robot, or a file of the package, has an entry at a path, with the given values.

    The file is YAML, or XML such as SDF, SRDF and package.xml. Numbers, and lists of numbers in a
    text of XML, are compared as numbers; in XML, true is equal to 1, and false to 0. In YAML, a
    quoted text is neither a number nor a boolean. Comments do not count. If several entries are at
    the path, one of them must be as expected.

    Args:
        file: The end of the path of a file in the package, such as "config/nav.yaml" or ".sdf", or
            the use of a file of any package: "@world" that is launched, "@controllers", which has
            their types, "@bridge", which has its rows, or "@parameters/filter", which the node
            `filter` is given; "robot" is the expanded robot.
        at: The path of the entry below the root: in XML "gazebo[@reference='lidar']/sensor/@type",
            in YAML "ros__parameters.limits.max" or "[ros_topic_name=/scan].gz_type_name". A
            condition in brackets is a value that the entry contains. A key of YAML may contain
            dots, and lists are looked through.
        value: The value of the entry; for a list, the items of a list in YAML, in order, or values
            of several entries.
        one_of: Values of which the entry has one.
        has: Values that the items of a list, or several entries, have in any order.
        values: What the entry contains: values by their paths in it, such as "camera/image/width"
            or "plugin/@filename"; a list as for `value`.
        tolerance: How far a number may be off, in the number's own unit.
        only: Whether a list has no items, or the path no entries, besides those of `value` or
            `has`.
        absent: Whether there must be no such entry, with the values that are given, if any.
    """
    assert file == _ROBOT  # else it is _entry_of_file that is called
    reading = submission.needed_urdf()
    root = reading.elements
    if root is None:
        raise MissingElement(
            "robot", "", message="the file is not well-formed XML, so it has no elements"
        )
    releases = submission.package.releases if submission.package else ()
    steps = [_with_names(step, robot) for step in split_path(at, is_xml=True)]
    wanted = _Wanted(steps, value, one_of, has, values or {}, tolerance, only, absent)
    tree = _robot_entry(reading, root, releases)
    outcome = _judge(tree, wanted, _IN_ROBOT)
    if absent:
        if outcome.status == "passed":
            _check_known(reading, tree, wanted)
        return outcome
    if outcome.status == "passed":
        if wanted.first.name != "link":
            return outcome
        if wanted.found_in(_robot_entry(reading, _kept(robot, root), releases)):
            return outcome
        _check_known(reading, tree, wanted)
        raise _dropped_part(tree, wanted)
    _check_known(reading, tree, wanted)
    return outcome


def _entry_of_file(
    package: Package, submission: Submission, *, file: str, at: str = "", **expected: Any
) -> Outcome:
    """Return whether a file of a package has an entry; the arguments are those of entry_is."""
    if file in _USES or file.startswith(_GIVEN):
        from grader.workspace.api import used_file  # late: few rubrics ask for it

        package, file = used_file(submission.workspace, file)
    tree = read_tree(package, file)
    wanted = _Wanted(split_path(at, is_xml=tree.is_xml), **expected)
    return _judge(tree, wanted, f"directly in <{tree.name}>" if tree.is_xml else f"in {file}")


ABOUT = {
    "entry_is": About(
        ("gazebo", "ros2_control", "transmission", "sensor", "safety_controller", "calibration"),
        breaks_under=_breaks_under,
        function_for=lambda arguments: (
            entry_is if arguments.get("file", _ROBOT) == _ROBOT else _entry_of_file
        ),
    )
}


class _Wanted(NamedTuple):
    """What a rubric looks for."""

    steps: list[PathStep]
    value: Content | None = None
    one_of: _Scalars = None
    has: _Scalars = None
    values: Mapping[str, Content] = {}
    tolerance: float = _TOLERANCE
    only: bool = False  # no other items, or no other entries
    absent: bool = False  # no such entry

    @property
    def first(self) -> PathStep:
        """The first step of the path; an empty one for the root."""
        if self.steps:
            return self.steps[0]
        return PathStep("")

    @property
    def is_valued(self) -> bool:
        """Whether more is wanted than that the entry is there."""
        return bool(self.values) or (self.value, self.one_of, self.has) != (None, None, None)

    @property
    def identity(self) -> str:
        """The key of the attribute that identifies one of several elements.

        It is empty if the values have none.
        """
        return next((key for key in _IDENTIFYING if isinstance(self.values.get(key), str)), "")

    def found_in(self, tree: TreeEntry) -> bool:
        """Return whether a tree has the entry with its values."""
        search = Search()
        entries = search.find(tree, self.steps)
        if not entries or not self.has_own(entries):
            return False
        return not all(self.wrong(search, entry) for entry in entries)

    def has_own(self, entries: _Entries) -> bool:
        """Return whether the entries at the path have the value themselves.

        It is enough that several of them have the values together.
        """
        if self.value is not None and not self._have(entries, self.value):
            return False
        if self.one_of is not None and not self._has_any(entries, self.one_of):
            return False
        if self.only and len(_expand_list(entries)) != self._count_expected():
            return False
        return self.has is None or self._are_among(_expand_list(entries), self.has)

    def _count_expected(self) -> int:
        """Return how many items are expected."""
        expected = self.has if self.has is not None else self.value
        return len(expected) if isinstance(expected, list) else 1

    def _has_any(self, entries: _Entries, values: Sequence[Scalar]) -> bool:
        return any(self.equals(entry, value) for entry in entries for value in values)

    def wrong(self, search: Search, entry: TreeEntry) -> list[str]:
        """Return the keys of the values that an entry does not contain."""
        return [
            key
            for key, value in self.values.items()
            if not self._have(_inside(search, entry, key), value)
        ]

    def nearest(self, search: Search, entries: _Entries) -> TreeEntry:
        """Return the entry with the identifying attribute and the most of the other values."""
        wrong = {entry: self.wrong(search, entry) for entry in entries}
        return min(entries, key=lambda entry: (self.identity in wrong[entry], len(wrong[entry])))

    def equals(self, entry: TreeEntry, expected: Scalar) -> bool:
        """Return whether a text is an expected value.

        In YAML, a text in quotes is no number and no boolean.
        """
        if entry.text is None:
            return False
        if entry.name == _LIBRARY and isinstance(expected, str):
            return any(_library_name(text) == _library_name(expected) for text in entry.texts)
        if entry.is_xml or isinstance(expected, str):
            return any(matches_value(text, expected, self.tolerance) for text in entry.texts)
        if entry.is_quoted:
            return False
        if isinstance(expected, bool):
            return entry.text.lower() in (
                ("true", "yes", "on", "y") if expected else ("false", "no", "off", "n")
            )
        numbers = numbers_in(entry.text) or ()
        return len(numbers) == 1 and abs(numbers[0] - expected) <= self.tolerance + _SLACK

    def _have(self, entries: _Entries, expected: Content) -> bool:
        """Return whether an entry is a value.

        For a list, return whether one is the list, or several have its items.
        """
        if not isinstance(expected, list):
            return self._has_any(entries, [expected])
        lists = [entry.children for entry in entries if entry.is_list]
        for items in lists:
            if len(items) == len(expected) and all(map(self.equals, items, expected)):
                return True
        return self._are_among(entries, expected)

    def _are_among(self, entries: _Entries, expected: Sequence[Scalar]) -> bool:
        """Return whether each expected value is that of a different entry, in any order."""

        def fitting(value: Scalar) -> list[int]:
            return [index for index, entry in enumerate(entries) if self.equals(entry, value)]

        return len(most_pairs([fitting(value) for value in expected])) == len(expected)


def _library_name(text: str) -> str:
    """Return the name of the library of a plugin, which Gazebo finds with and without lib and .so.

    Any other text stays as it is.
    """
    match = _LIBRARY_FILE.fullmatch(text)
    return match[1] if match else text


def _inside(search: Search, entry: TreeEntry, key: str) -> list[TreeEntry]:
    return search.find(entry, split_path(key, is_xml=entry.is_xml))


def _expand_list(entries: _Entries) -> list[TreeEntry]:
    """Return entries, with the items of a list in its place."""
    items = []
    for entry in entries:
        items += entry.children if entry.is_list else [entry]
    return items


def _judge(tree: TreeEntry, wanted: _Wanted, where: str) -> Outcome:
    search = Search()
    entries = search.find(tree, wanted.steps)
    if wanted.absent:
        return _judge_absence(tree, search, entries, wanted)
    if not entries:
        return _no_entry(tree, search, wanted, where)
    shown = _shown(wanted.steps, tree)
    if not wanted.has_own(entries):
        return failed(f"{shown} is {_texts(entries)}; {_should(wanted)}", entries[0].place)
    best = wanted.nearest(search, entries)
    wrong = wanted.wrong(search, best)
    if not wrong:
        rest = " with the expected values" if wanted.is_valued else ""
        outcome = passed(f"there is {shown}{rest}")
        if "@type" in wanted.values and best.is_nameless_sensor:
            outcome = failed(f"{shown} has no name, so Gazebo refuses the robot", best.place)
        return outcome
    if wanted.identity in wrong and (len(entries) > 1 or wanted.identity == "@name"):
        return _no_identity(tree, search, entries, wanted)
    faults = [_fault_text(key, _inside(search, best, key), wanted.values[key]) for key in wrong]
    first = wanted.values[wrong[0]]
    values = as_list(first)
    at = best
    for entry in _inside(search, best, wrong[0]):
        if not any(wanted.equals(entry, value) for value in values):
            at = entry
            break
    return failed(f"{shown}: {'; '.join(first_lines(faults, MAX_NAMED))}", at.place)


def _judge_absence(tree: TreeEntry, search: Search, entries: _Entries, wanted: _Wanted) -> Outcome:
    """Return whether there is no entry at the path, or none with the values."""
    shown = _shown(wanted.steps, tree)
    values = " with these values" if wanted.is_valued else ""
    if not wanted.found_in(tree):
        return passed(f"there is no {shown}{values}")
    named = next((entry for entry in entries if not wanted.wrong(search, entry)), entries[0])
    return failed(f"there is {shown}{values}; there should be none", named.place)


def _no_entry(tree: TreeEntry, search: Search, wanted: _Wanted, where: str) -> Outcome:
    """Return the failure of a path that leads to nothing.

    It is at the first step that has no entry, or none that fits.
    """
    steps = wanted.steps
    depth = max(count for count in range(len(steps)) if search.find(tree, steps[:count]))
    above = search.find(tree, steps[:depth])[0]
    step = steps[depth]
    shown = _shown(steps[: depth + 1], tree)
    if step.conditions:
        named = search.find(tree, [*steps[:depth], PathStep(step.name)])
        if named:
            return _none_fits(search, named, step, shown)
    if depth or where != _IN_ROBOT:
        place = f" {where}" if not depth or not tree.is_xml else ""
        names = [child.name for child in above.children if child.name]
        message = f"there is no {shown}{place}"
        return failed(message, above.place, detail=similar_there(step.name, names))
    message = f"there is no <{step.name}> {where}"
    for outer, inner in _nested(tree):
        if inner.name == step.name:
            return failed(message, inner.place, detail=f"; there is one in <{outer.name}>")
    meant = similar_there(step.name, {child.name for child in tree.children})
    return failed(message, detail=meant)._replace(absent=() if meant else (shown,))


def _nested(entry: TreeEntry) -> Iterator[tuple[TreeEntry, TreeEntry]]:
    """Yield everything in an entry, each after what it is in."""
    for child in entry.children:
        yield entry, child
        yield from _nested(child)


def _none_fits(search: Search, named: _Entries, step: PathStep, shown: str) -> Outcome:
    """Return the failure of entries of which none has the values of the conditions."""
    rows = _expand_list(named) or list(named)
    known: dict[str, None] = {}  # the entries, as they would be named
    texts: dict[str, list[str]] = {key: [] for key, _ in step.conditions}  # that the file has
    for row in rows:
        given = []
        for key, others in texts.items():
            text = next((readable(entry.text or "") for entry in _inside(search, row, key)), None)
            if text is not None:
                given.append((key, text))
                others.append(text)
        known[_shown([PathStep(step.name, tuple(given))], rows[0])] = None
    detail = f"; the file has {enumerated(known, MAX_NAMED)}"
    for key, value in step.conditions if len(known) > MAX_NAMED else ():
        detail += similar_there(value, filter(None, texts[key]))
    return failed(f"there is no {shown}", rows[0].place, detail=detail)


def _no_identity(tree: TreeEntry, search: Search, entries: _Entries, wanted: _Wanted) -> Outcome:
    """Return the failure of elements of which none has the identifying attribute."""
    names = []
    for entry in entries:
        names += [quoted(inner.text or "") for inner in _inside(search, entry, wanted.identity)]
    detail = f"; the file has {enumerated(names, MAX_NAMED)}" if names else ""
    identity = quoted(str(wanted.values[wanted.identity]))
    message = f"no {_shown(wanted.steps, tree)} has the {wanted.identity!r} {identity}"
    return failed(message, search.find(tree, wanted.steps[:1])[0].place, detail=detail)


def _shown(steps: Sequence[PathStep], tree: TreeEntry) -> str:
    """Return a path in words: <sensor> in <gazebo reference="lidar">; 'limits.max'."""
    if not tree.is_xml:
        texts = [step.name + _conditions_text(step.conditions) for step in steps]
        return repr(".".join(texts)) if texts else "the file"
    tags = [_tag(step) for step in steps if not step.name.startswith("@")]
    if len(tags) > 1:
        shown = f"{''.join(tags[1:])} in {tags[0]}"
    else:
        shown = (tags or [f"<{tree.name}>"])[0]
    if steps and steps[-1].name.startswith("@"):
        return f"{steps[-1].name} of {shown}"
    return shown


def _tag(step: PathStep) -> str:
    attributes = ""
    others = []
    for key, value in step.conditions:
        if key.startswith("@"):
            attributes += f' {key[1:]}="{value}"'
        else:
            others.append((key, value))
    return f"<{step.name}{attributes}>{_conditions_text(others)}"


def _conditions_text(conditions: Iterable[tuple[str, str]]) -> str:
    return "".join(f"[{key}={value}]" for key, value in conditions)


def _fault_text(key: str, entries: _Entries, expected: Content) -> str:
    """Return what is wrong with the texts at a path: 'update_rate' is 10; it should be 30."""
    values = as_list(expected)
    should = f"it should be {enumerated(map(_value_text, values))}"
    if entries:
        return f"{key!r} is {_texts(entries)}; {should}"
    return f"{key!r} is missing; {should}"


def _texts(entries: _Entries) -> str:
    """Return the texts of entries, or of the items of lists."""
    return enumerated(map(_entry_text, _expand_list(entries)), MAX_NAMED) or "empty"


def _entry_text(entry: TreeEntry) -> str:
    if entry.text is None:
        return "a table"
    if entry.is_quoted:
        return f'"{entry.text}"'
    return _value_text(readable(entry.text))


def _should(wanted: _Wanted) -> str:
    """Return what an entry should be."""
    only = " and nothing else" if wanted.only else ""
    if wanted.has is not None:
        return f"it should have {enumerated(map(_value_text, wanted.has))}{only}"
    if wanted.one_of is not None:
        return f"it should be {enumerated(map(_value_text, wanted.one_of), word='or')}"
    expected = wanted.value if isinstance(wanted.value, list) else [wanted.value or ""]
    return f"it should be {enumerated(map(_value_text, expected))}{only}"


def _value_text(value: Scalar) -> str:
    text = xml_text(value)
    if not isinstance(value, str) or numbers_in(text):
        return text
    return quoted(text)


# --- The robot
# ----------------------------------------------------------------------


def _robot_entry(reading: Reading, root: Element, releases: Sequence[Release]) -> TreeEntry:
    """Return the entry of a robot, whose elements are those of a reading or of a copy."""

    def locate(element: Element, attribute: str | None) -> LazyLocation:
        tag = next((index for index, other in enumerate(root.iter()) if other is element), 0)
        return LazyLocation(reading.source, tag, attribute)

    return xml_entry(root, locate, releases)


def _with_names(step: PathStep, robot: Configuration) -> PathStep:
    """Return a step whose conditions have names, not selectors."""
    conditions = []
    for key, value in step.conditions:
        conditions.append((key, robot.selected_name(value)))
    return step._replace(conditions=tuple(conditions))


def _kept(robot: Configuration, root: Element) -> Element:
    """Return a copy of a robot without what ROS 2 drops.

    These are inertials, visuals and collisions of links.
    """
    kept_tags = set()
    for link in robot.known.links:
        for part in (link.inertial, *link.visuals, *link.collisions):
            if part and part.location is not None:
                kept_tags.add(part.location.tag)
    copy = deepcopy(root)
    for tag, element in enumerate(list(copy.iter())):
        link_element = element.getparent()
        is_part = read_name(element) in _PARTS and tag not in kept_tags
        if is_part and link_element is not None and read_name(link_element) == "link":
            link_element.remove(element)
    return copy


def _dropped_part(tree: TreeEntry, wanted: _Wanted) -> MissingElement:
    """Return the error for a part of a link that ROS 2 drops."""
    links = Search().find(tree, wanted.steps[:1])
    below = wanted._replace(steps=wanted.steps[1:])
    link = next(link for link in links if below.found_in(link))
    steps = list(wanted.steps)
    for key in wanted.values:
        steps += split_path(key, is_xml=True)
    part = next(step.name for step in steps if step.name in _PARTS)
    name = next((child.text for child in link.children if child.name == "@name"), "")
    message = f"ROS 2 drops {_shown(wanted.steps, tree)}"
    return MissingElement(part, name or "", message=message, location=link.place)


def _check_known(reading: Reading, tree: TreeEntry, wanted: _Wanted) -> None:
    """Raise NotDecided if xacro leaves open whether the element is there, or what it contains."""
    assert tree.element is not None  # it is that of <robot>
    elements = [tree.element]
    for child in tree.children:
        is_named = child.name == wanted.first.name or not wanted.steps
        if is_named and child.element is not None and _may_fit(child, wanted.first, reading):
            elements += child.element.iter()
    for element in elements:
        unresolved = reading.unresolved.get(element)
        if unresolved:
            for reason in (*unresolved.attributes.values(), unresolved.content):
                if reason:
                    raise NotDecided(reason)


def _may_fit(entry: TreeEntry, step: PathStep, reading: Reading) -> bool:
    """Return whether an element can have the attributes of a step.

    Not all of the element may be known.
    """
    conditions = [(key, value) for key, value in step.conditions if key.startswith("@")]
    unresolved = reading.unresolved.get(entry.element) if entry.element is not None else None
    if unresolved:
        open_keys = {f"@{name}" for name in unresolved.attributes}
        conditions = [pair for pair in conditions if pair[0] not in open_keys]
        if unresolved.content is not None:
            known = {child.name for child in entry.children}
            conditions = [pair for pair in conditions if pair[0] in known]
    return Search().fits(entry, PathStep(step.name, tuple(conditions)))
