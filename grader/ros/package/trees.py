"""One tree of names, values and places for the files of a package.

The files are YAML, and XML such as SDF, SRDF and package.xml.

A path names entries in it. In YAML, dots separate keys, in XML slashes: `a.b`, `world/model/@name`.
As in parameters of ROS 2, a key may itself have dots: `limits.joint1.max` is found nested, as one
key, or partly so. A list is looked through, and `rows[key=value].b`, or `model[@name='box']/pose`,
takes the entries with this value.
"""

import re
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

from grader.base.errors import InputError, MissingElement, NotDecided
from grader.base.names import similar_there
from grader.base.patterns import on_use
from grader.base.source import LazyLocation, Location, Source
from grader.ros.known.gazebo_rows import gazebo
from grader.ros.known.releases import Release
from grader.ros.package.package import Package
from grader.ros.python.budget import Budget, OutOfBudget
from grader.ros.xml.elements import list_attributes, matches_value, read_name, readable, text_in
from grader.ros.xml.parsing import Element, XmlFault, XmlFile

if TYPE_CHECKING:
    from grader.ros.config.yaml_nodes import YamlNode

_MAX_TREE = 512 * 1024  # bytes
_YAML = (".yaml", ".yml", ".rviz", ".repos", ".json")  # other files are XML
_STEP = on_use(r"""([^\[\]]*)((?:\[[^\[\]=]+=(?:'[^']*'|"[^"]*"|[^\[\]'"]*)\])*)""")
_CONDITION = on_use(r"""\[([^\[\]=]+)=(?:'([^']*)'|"([^"]*)"|([^\[\]'"]*))\]""")
_MAX_LOOKED_AT = 200_000  # entries, by one search
_EXACT = 1e-6  # of numbers in conditions
_Place = Location | LazyLocation


@dataclass(frozen=True, eq=False, slots=True)
class TreeEntry:
    """An entry of a tree: an element, attribute, key or row.

    It has its text, what it contains, and its place.

    The name of an attribute begins with @, that of the root and of a row of YAML is empty.
    """

    name: str
    text: str | None  # None for tables and lists
    find_children: "Callable[[], list[TreeEntry]]"
    find_place: Callable[[], _Place]
    is_xml: bool
    is_quoted: bool = False  # a text of YAML that is no number and no boolean
    is_list: bool = False
    element: Element | None = None  # what it was made of, if it is an element
    meant: str = ""  # the name that it stands for, if Gazebo has another word for it
    meant_text: str | None = None  # likewise the text

    @property
    def children(self) -> "list[TreeEntry]":
        """The entries in it: of a list its rows."""
        return self.find_children()

    @property
    def texts(self) -> list[str]:
        """Its text, and the one that it stands for, as readable texts."""
        return [readable(text) for text in (self.text, self.meant_text) if text is not None]

    @property
    def is_nameless_sensor(self) -> bool:
        """Whether it is a sensor that Gazebo refuses, with the robot: Sensor.cc of sdformat."""
        return _is_sensor(self.element) and not any(
            child.name == "@name" and child.text for child in self.children
        )

    @property
    def place(self) -> _Place:
        """Where it is written."""
        return self.find_place()


class PathStep(NamedTuple):
    """A step of a path: a name, and values that the entry contains, by their paths in it."""

    name: str
    conditions: tuple[tuple[str, str], ...] = ()


def is_path(text: str) -> bool:
    """Return whether a text is a path: its brackets are those of conditions."""
    return all(_STEP.fullmatch(part) for part in re.split(r"[./](?![^\[]*\])", text))


def split_path(path: str, *, is_xml: bool) -> list[PathStep]:
    """Return the steps of a path; an empty path, or a dot, is the entry itself."""
    parts = re.split(r"/(?![^\[]*\])" if is_xml else r"\.(?![^\[]*\])", path)
    steps = []
    for part in parts if path not in ("", ".") else ():
        match = _STEP.fullmatch(part)
        if match and part not in ("", "."):
            conditions = []
            for key, quoted, double_quoted, plain in _CONDITION.findall(match[2]):
                conditions.append((key, quoted or double_quoted or plain))
            steps.append(PathStep(match[1], tuple(conditions)))
    return steps


def _key_lengths(entry: TreeEntry, steps: Sequence[PathStep]) -> Iterator[int]:
    """Yield how many steps may be one key of an entry: in YAML, names with dots may be."""
    for count in range(1, 2 if entry.is_xml else len(steps) + 1):
        if not any(step.conditions for step in steps[: count - 1]):
            yield count


class Search:
    """Finds entries by paths, with a limit on the entries that are looked at.

    Those of YAML may have many parents.
    """

    def __init__(self) -> None:
        self._budget = Budget(_MAX_LOOKED_AT)

    def find(self, entry: TreeEntry, steps: Sequence[PathStep]) -> list[TreeEntry]:
        """Return the entries at a path in an entry, in the order of the file.

        Raises NotDecided for too many.
        """
        try:
            return list(self._find(entry, steps))
        except OutOfBudget:
            raise NotDecided("the file has too many entries to look through") from None

    def fits(self, entry: TreeEntry, step: PathStep) -> bool:
        """Return whether an entry contains the values of a step."""
        for key, value in step.conditions:
            inner = self.find(entry, split_path(key, is_xml=entry.is_xml))
            texts = [text for row in inner for text in row.texts]
            if not any(matches_value(text, value, _EXACT) for text in texts):
                return False
        return True

    def _find(self, entry: TreeEntry, steps: Sequence[PathStep]) -> Iterator[TreeEntry]:
        if not steps:
            self._budget.charge(1)
            yield entry
            return
        children = entry.children
        self._budget.charge(1 + len(children))
        if entry.is_list and steps[0].name:
            for child in children:
                if not child.is_list:
                    yield from self._find(child, steps)
        for count in _key_lengths(entry, steps):
            name = ".".join(step.name for step in steps[:count])
            named = [child for child in children if name in (child.name, child.meant or child.name)]
            yield from self._find_below(named, steps[count - 1 :])

    def _find_below(
        self, named: Sequence[TreeEntry], steps: Sequence[PathStep]
    ) -> Iterator[TreeEntry]:
        """Yield the entries at the other steps in those that the first step names."""
        for entry in named:
            rows = entry.children if entry.is_list and steps[0].conditions else [entry]
            for row in (candidate for candidate in rows if self.fits(candidate, steps[0])):
                yield from self._find(row, steps[1:])


def xml_entry(
    element: Element,
    locate: Callable[[Element, str | None], _Place],
    releases: Sequence[Release],
    meant: str = "",
) -> TreeEntry:
    """Return the entry of an element; `locate` returns its place, or that of an attribute of it.

    In a sensor of Gazebo, a word stands for another one that the Gazebo of these releases reads as
    the same, and a topic for itself with and without a slash, since there are no namespaces.
    """
    name = read_name(element)
    text = text_in(element)
    is_topic = name == "topic" and _is_sensor(element.getparent())
    return TreeEntry(
        name,
        text,
        partial(_list_xml_children, element, locate, releases),
        partial(locate, element, None),
        is_xml=True,
        element=element,
        meant=meant,
        meant_text=_other_topic(text or "") if is_topic else None,
    )


def _other_topic(text: str) -> str:
    """Return a topic with a slash before it, or without the one that it has."""
    topic = text.strip()
    return topic.removeprefix("/") if topic.startswith("/") else f"/{topic}"


def _list_xml_children(
    element: Element,
    locate: Callable[[Element, str | None], _Place],
    releases: Sequence[Release],
) -> list[TreeEntry]:
    attributes = [
        TreeEntry(f"@{name}", value, list, partial(locate, element, name), is_xml=True)
        for name, value in list_attributes(element)
    ]
    children = list(element.iterchildren("*"))
    names = {}
    if _is_sensor(element):
        kind = next((entry.text or "" for entry in attributes if entry.name == "@type"), "")
        names = _meant_elements(kind, {read_name(child) for child in children}, releases)
        meant = gazebo().sensor_types.get(kind)
        attributes = [
            replace(entry, meant_text=meant) if entry.name == "@type" else entry
            for entry in attributes
        ]
    return [
        *attributes,
        *(
            xml_entry(child, locate, releases, names.get(read_name(child), ""))
            for child in children
        ),
    ]


def _is_sensor(element: Element | None) -> bool:
    """Return whether an element is a sensor of Gazebo: in a <gazebo> of URDF, or in SDF."""
    if element is None or read_name(element) != "sensor":
        return False
    return any(read_name(outer) in ("gazebo", "sdf") for outer in element.iterancestors())


def _meant_elements(
    kind: str, present: Collection[str], releases: Sequence[Release]
) -> dict[str, str]:
    """Return what other words in a sensor of a type stand for where these are not there."""
    return {
        word.name: word.meant
        for word in gazebo().sensor_words
        if word.meant not in present and word.is_read(kind, releases)
    }


def _yaml_entry(node: "YamlNode", name: str = "") -> TreeEntry:
    """Return the entry of a node of YAML."""
    return TreeEntry(
        name,
        node.text,
        partial(_list_yaml_children, node),
        lambda: node.location,
        is_xml=False,
        is_quoted=node.is_string,
        is_list=isinstance(node.value, list),
    )


def _list_yaml_children(node: "YamlNode") -> list[TreeEntry]:
    match node.value:
        case list(rows):
            return [_yaml_entry(row) for row in rows]
        case dict(table):
            return [_yaml_entry(value, key) for key, value in table.items()]
    return []


def read_tree(package: Package, file: str) -> TreeEntry:
    """Return the tree of a file of a package, which is found by the end of its path.

    Raises MissingElement for a file that is not there or is broken, NotDecided for one that cannot
    be read.
    """
    files = package.tree.files
    if file in files:
        matches = [file]
    else:
        matches = [path for path in files if path.endswith(f"/{file.strip('/')}")]
        if not matches and file.startswith("."):  # an ending, such as .sdf
            matches = [path for path in files if path.endswith(file)]
    if len(matches) > 1:
        raise NotDecided(
            f"several files are called {file}: {', '.join(matches[:3])}",
            "several files have the name",
        )
    if not matches:
        message = f"the package has no file {file!r}"
        meant = similar_there(file, files)
        raise MissingElement(
            "file", file, message=message, detail=meant, absent="" if meant else file
        )
    from grader.ros.config.yaml_nodes import YamlFault, read_yaml  # late: the robot needs no YAML

    [path], package_path = matches, package.path(matches[0])
    try:
        data = files[path].read(_MAX_TREE)
    except InputError as error:
        raise NotDecided(str(error), "a file cannot be read") from None
    kind = "YAML" if path.lower().endswith(_YAML) else "XML"
    try:
        if kind == "YAML":
            return _yaml_entry(read_yaml(data, package_path))
        return _read_xml(data, package_path, package.releases)
    except (YamlFault, XmlFault) as fault:
        message = f"{path} is not readable as {kind}: {fault}"
        raise MissingElement(
            "readable file", path, message=message, location=fault.location
        ) from None


def _read_xml(data: bytes, path: str, releases: Sequence[Release]) -> TreeEntry:
    file = XmlFile(data, Source.decoded(path, data))
    return xml_entry(file.root, file.location, releases)
