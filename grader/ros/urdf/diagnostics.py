"""The problems that are found in a URDF while it is read, each with its location.

They are found in its elements and their values.
"""

from collections.abc import Callable, Iterable, Mapping
from functools import cached_property
from itertools import chain
from math import nan
from typing import TYPE_CHECKING, TypeVar

from grader.base.errors import MissingElement
from grader.base.names import MAX_GUESSES, closest, did_you_mean
from grader.base.patterns import on_use
from grader.base.problems import NO_FIXES, Effect, Fix, Fixes, Kind, Problem
from grader.base.source import Edit, Edits, LazyLocation
from grader.base.text import cut, enumerated, quoted
from grader.base.transforms import FULL_TURN, Transform, Vector, rotation_from_quaternion
from grader.ros.urdf import urdf_problems
from grader.ros.urdf.model import Joint, Origin, Robot, UnresolvedPart, UnresolvedParts
from grader.ros.urdf.numbers import NumberError, number, quaternion, vector
from grader.ros.urdf.versions import WITH_CAPSULES, UrdfFormat, UrdfVersion, in_words
from grader.ros.xml.parsing import Element, Elements, XmlDocument
from grader.ros.xml.urdf_format import TAGS

if TYPE_CHECKING:
    from grader.ros.urdf.meant import MeantName

_FORMAT_DIRECTIVE = on_use(r"%[-+ #0-9.$*'hlLqjzt]*n")  # %n, %1$n, %hhn
_MAX_PROBLEMS = 1000
_PRINTED = frozenset(
    {"origin", "box", "cylinder", "capsule", "sphere", "mass"}
)  # whose values urdfdom uses as printf's format
_OF_MISSING = (
    urdf_problems.UNKNOWN_LINK,
    urdf_problems.TWO_ROOTS,
    urdf_problems.NO_ROOT,
    urdf_problems.NO_LINKS,
    urdf_problems.MIMIC_TARGET,
    urdf_problems.CONTROLLED_JOINT,
)
_KEPT = ("visual", "collision", "inertial")
_ZERO: Vector = (0.0, 0.0, 0.0)
_NOTHING: UnresolvedParts = {}

_FIRST_FORMAT = UrdfFormat()

_Value = TypeVar("_Value")


class Problems:
    """The problems of one file, and the locations of its elements."""

    def __init__(
        self,
        document: XmlDocument,
        root: Element,
        urdf_format: UrdfFormat = _FIRST_FORMAT,
        *,
        keeps_dropped: bool = False,
    ) -> None:
        """With `keeps_dropped`, elements that ROS 2 drops are read with what is known of them."""
        self.format = urdf_format
        self.keeps_dropped = keeps_dropped
        self.source = document.source
        self.root = root
        self.unresolved = document.unresolved
        self.is_broken = document.root is None  # whether tags in the text are broken
        self.rewrites = document.rewrites
        self.robot: Robot | None = None  # that was read of the file
        self.listed: list[Problem] = []
        self.effects: set[Effect] = set()
        self.unlisted = 0
        self._guesses = MAX_GUESSES  # of names
        self._elements = list(root.iter())
        self._indices = {element: index for index, element in enumerate(self._elements)}

    def location(self, element: Element) -> LazyLocation:
        """Return the location of an element, to be computed when it is needed."""
        return LazyLocation(self.source, self._indices[element])

    def parts(self, element: Element) -> UnresolvedParts:
        """Return what xacro left unresolved of a link, joint or material, by child tag.

        The key of an attribute is "@name".
        """
        if not self.unresolved:
            return _NOTHING
        parts: dict[str, UnresolvedPart] = {}
        for inner in element.iter():
            unresolved = self.unresolved.get(inner)
            if not unresolved:
                continue
            above = inner
            while (
                above is not element
                and (parent := above.getparent()) is not element
                and parent is not None
            ):
                above = parent
            # What xacro refuses in an element that is kept is one value that is not known.
            is_value = self.keeps_dropped and above.tag in _KEPT
            for name, reason in unresolved.attributes.items():
                if is_value and not reason:
                    continue
                key = f"@{name}" if inner is element else str(above.tag)
                parts.setdefault(
                    key, UnresolvedPart(reason, self.location(inner)._replace(attribute=name))
                )
            if unresolved.content is not None:
                key = "" if inner is element else str(above.tag)
                parts.setdefault(key, UnresolvedPart(unresolved.content, self.location(inner)))
        return parts

    def is_unresolved(self, element: Element) -> bool:
        """Return whether xacro left anything in an element unresolved."""
        return bool(self.unresolved) and any(inner in self.unresolved for inner in element.iter())

    def _explains(self, kind: Kind, element: Element, attribute: str | None) -> bool:
        """Return whether what xacro left unresolved explains a problem."""
        unresolved = self.unresolved.get(element)
        of_root = self.unresolved.get(self.root)
        if kind in _OF_MISSING and of_root and of_root.content is not None:
            return True
        return unresolved is not None and (
            attribute in unresolved.attributes
            if attribute and element.get(attribute)
            else unresolved.content is not None
        )

    def line(self, element: Element) -> int:
        """Return the line of an element, counted from 1."""
        source, start = self.source.element(self._indices[element])
        return source.at(start).line

    def element(self, joint: Joint) -> Element:
        """Return the element that a joint was read from."""
        return self.root if not joint.location else self._elements[joint.location.tag]

    def add(
        self,
        kind: Kind,
        message: str,
        element: Element,
        attribute: str | None = None,
        subject: str = "",
    ) -> None:
        """Add a problem at an element, unless xacro left that unresolved.

        The place is that of one of its attributes if it has it.
        """
        if self.unresolved and self._explains(kind, element, attribute):
            return
        self.effects.add(kind.effect)
        if len(self.listed) < _MAX_PROBLEMS:
            location = self.source.tag(self._indices[element], attribute)
            fixes = NO_FIXES
            if kind.effect == "rejects" or kind in urdf_problems.OF_SLIPS:
                fixes = Fixes(lambda: self._fixes_at(element, attribute))
            self.listed.append(Problem(kind, message, location, subject, fixes=fixes))
        else:
            self.unlisted += 1

    def ignores(self, element: Element, attribute: str, since: UrdfVersion) -> bool:
        """Return whether ROS 2 ignores an attribute, and add a problem then.

        It ignores one of a newer version than the file.
        """
        if self.format.version >= since:
            return False
        file_version = in_words(self.format.version)
        if self.format.warns:
            message = (
                f"ROS 2 ignores {attribute} in a file of version {file_version}: write "
                f'<robot version="{in_words(since)}">'
            )
            self.add(urdf_problems.NEWER_ATTRIBUTE, message, element, attribute)
        elif attribute == "quat_xyzw":
            message = (
                "ROS 2 ignores quat_xyzw, which turns nothing: write rpy (ROS 2 Lyrical reads it "
                f"in a file of version {in_words(since)})"
            )
            self.add(urdf_problems.IGNORED_QUATERNION, message, element, attribute)
        return True

    def _fixes_at(self, element: Element, attribute: str | None) -> Iterable[Fix]:
        """Return the fix of an element or an attribute that surely is another one."""
        fix = self._fixes.get((element, attribute))
        return [fix] if fix else []

    def list_fixes(self) -> Iterable[Fix]:
        """Return the fixes of all words that surely are others, those of one element together."""
        by_element: dict[Element, dict[Fix, None]] = {}
        for (element, _), fix in self._fixes.items():
            by_element.setdefault(element, {})[fix] = None
        together: dict[Fix, None] = {}
        for fixes in by_element.values():
            edits = tuple(chain.from_iterable(fix.edits for fix in fixes))
            together[Fix(edits, enumerated([fix.assumption for fix in fixes]))] = None
        return together

    @cached_property
    def _fixes(self) -> Mapping[tuple[Element, str | None], Fix]:
        # Late: few problems are fixed.
        from grader.ros.urdf.meant import find_meant_names
        from grader.ros.urdf.robot_slips import RobotSlips

        slips = RobotSlips(self.root, self.source, self.unresolved).at_places()
        fixes = {place: slip.fix for place, slip in slips.items() if slip.edits}
        meant = find_meant_names(self.root, self.robot) if self.robot else ()
        for names in meant:
            edits: dict[Edit, None] = {}
            for name in names:
                edits |= dict.fromkeys(self._edits_of(name))
            sentences = dict.fromkeys(name.sentence for name in names)
            fix = Fix(tuple(edits), enumerated(sentences))
            fixes |= {(name.element, name.attribute): fix for name in names if edits}
        return fixes

    def _edits_of(self, name: "MeantName") -> Edits:
        """Return the edits that write a name as it is meant."""
        # Late: few names are repeated or pasted.
        from grader.base import markup
        from grader.base.element_edits import escaped, with_attribute
        from grader.ros.xml.tinyxml2 import decode

        index = self._indices[name.element]
        value = escaped(name.meant)
        if self.rewrites is not None:
            return next(iter(self.rewrites(index, name.attribute, (name.written, value))), ())
        source, start = self.source.element(index)
        there = markup.attribute(source.text, start, name.attribute)
        is_whole = there is not None and decode(source.text[slice(*there.value)]) == name.written
        return (with_attribute(source, start, name.attribute, value),) if is_whole else ()

    def duplicate(self, kind: Kind, element: Element, first: Element) -> None:
        """Add that an element has the name of an earlier one of its kind."""
        name = quoted(element.get("name") or "")
        message = (
            f"the {element.tag} {name} is already defined in line {self.line(first)}; ROS 2 "
            "rejects the file"
        )
        self.add(kind, message, element, "name")

    def closest(self, name: str, known: Iterable[str]) -> str | None:
        """Return the known name that is most like this one, if one is close."""
        self._guesses -= 1
        if self._guesses >= 0:
            return closest(name, known)
        return None

    def did_you_mean(self, name: str, known: Iterable[str]) -> str:
        """Return the end of a message: `; did you mean 'x'?`.

        Returns nothing if no known name is close.
        """
        self._guesses -= 1
        if self._guesses >= 0:
            return did_you_mean(name, known)
        return ""

    def check_printed(self, text: str, element: Element, attribute: str | None = None) -> None:
        """Add a problem if ROS 2 passes this text to printf and it can crash there.

        It can crash, as on Jazzy, if it contains a directive.
        """
        if self.format.warns:
            return
        if "%" in text and _FORMAT_DIRECTIVE.search(text):
            message = (
                "ROS 2 passes this value to printf as a format, where %n writes to memory: it "
                "can crash"
            )
            self.add(urdf_problems.FORMAT_DIRECTIVE, message, element, attribute)


class ElementReader:
    """Reads one element that ROS 2 keeps or loses as a whole.

    Every defect in it is a problem of one kind.

    A value that cannot be read is a problem and sets `failed`. A number is NaN then, any other
    value its default.
    """

    __slots__ = ("_consequence", "_kind", "_link", "_problems", "failed", "unknown")

    def __init__(
        self,
        problems: Problems,
        kind: Kind,
        consequence: str = "ROS 2 rejects the file",
        link: str = "",
    ) -> None:
        """`consequence` says what ROS 2 does about a defect.

        The name of the `link` is put where it has {}.
        """
        self._problems = problems
        self._kind = kind
        self._consequence = consequence
        self._link = link
        self.failed = False
        # why values are not known, by the tag and the attribute or child that should have them
        self.unknown: dict[tuple[str, str], MissingElement] = {}

    def fail(
        self, reason: str, element: Element, attribute: str | None = None, *, lacks: str = ""
    ) -> None:
        """Add a problem: the element is lost.

        `lacks` is the attribute or child that the element does not have.
        """
        self.failed = True
        if self._problems.keeps_dropped:
            from grader.ros.urdf.not_known import missing_value  # late: few elements are dropped

            at = self._problems.location(element)._replace(attribute=attribute).resolve()
            key = str(element.tag), attribute or lacks
            open_values = self._problems.unresolved.get(element)
            if open_values and attribute in open_values.attributes:
                reason = f"xacro cannot expand {attribute} of <{element.tag}>"
            self.unknown.setdefault(key, missing_value(reason, at))
        consequence = self._consequence.format(quoted(self._link))
        self._problems.add(self._kind, f"{reason}; {consequence}", element, attribute, self._link)

    def number(self, element: Element, attribute: str) -> float:
        """Return an attribute's number, or its default if it is not given.

        It is a problem if the attribute has none.
        """
        if attribute in element.attrib:
            return self._value(element, attribute, number, nan)
        default = TAGS[element.tag].attributes[attribute].default
        if default is None:
            self.fail(f"<{element.tag}> has no {attribute}", element, lacks=attribute)
        return float(default or nan)

    def vector(self, element: Element, attribute: str, default: Vector = _ZERO) -> Vector:
        """Return an attribute's three numbers, or the default if it is not given."""
        return self._value(element, attribute, vector, default)

    def origin(self, element: Element | None) -> Origin:
        """Return an <origin>: the identity if there is none."""
        if element is None:
            return Origin()
        xyz = self._value(element, "xyz", vector, _ZERO)
        has_quaternion = "quat_xyzw" in element.attrib
        if has_quaternion and not self._problems.ignores(element, "quat_xyzw", WITH_CAPSULES):
            rpy = self._turn(element)
        else:
            rpy = self._value(element, "rpy", vector, _ZERO)
        if rpy != _ZERO and max(map(abs, rpy)) > FULL_TURN and not self.failed:
            angle = next(
                (angle for angle in rpy if abs(angle) > FULL_TURN and angle % 15 == 0), None
            )
            if angle is not None:
                message = (
                    f"rpy is in radians, and {angle:g} is more than a full turn: is it in degrees?"
                )
                self._problems.add(urdf_problems.DEGREES, message, element, "rpy")
        return Origin(xyz, rpy, self._problems.location(element))

    def _turn(self, element: Element) -> Vector:
        """Return the roll, pitch and yaw of a quaternion; a zero one turns nothing."""
        if "rpy" in element.attrib:
            self.fail("<origin> has both rpy and quat_xyzw", element, "quat_xyzw")
            return _ZERO
        value = self._value(element, "quat_xyzw", quaternion, (0.0, 0.0, 0.0, 1.0))
        return Transform(rotation_from_quaternion(value)).rpy

    def _value(
        self, element: Element, attribute: str, parse: Callable[[str], _Value], default: _Value
    ) -> _Value:
        text = element.get(attribute)
        if text is None:
            return default
        try:
            return parse(text)
        except NumberError as error:
            self.fail(
                f"cannot read {attribute}={quote_value(text)} of <{element.tag}>: {error}",
                element,
                attribute,
            )
            if element.tag in _PRINTED:
                self._problems.check_printed(text, element, attribute)
            return default


def first_children(element: Element) -> Elements:
    """Return the first child of each name: urdfdom reads no other."""
    first: Elements = {}
    for child in element:
        first.setdefault(child.tag, child)
    return first


def quote_value(text: str) -> str:
    """Return a value of the file between double quotes, cut where it is very long."""
    return f'"{cut(text, 60)}"'
