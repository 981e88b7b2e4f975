"""What is wrong with the values of a well-known node, by the rows of its parameters.

A value may have no effect, be of another type or release, be missing, or not be accepted.
"""

import operator
import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from functools import cache, lru_cache
from typing import Any

from grader.base.grouping import Strings, StringsByName
from grader.base.names import MAX_GUESSES, are_of_one_side, closest, is_misspelling, near
from grader.base.patterns import on_use
from grader.base.records import Named
from grader.base.source import Location
from grader.base.text import enumerated, quoted
from grader.ros.known.parameter_rows import (
    COVERED,
    ParameterRow,
    find_rows,
    node_rows,
)
from grader.ros.known.releases import RELEASES, Release, other_name
from grader.ros.launch.launch_model import ParameterValue
from grader.ros.python.parse import START
from grader.ros.python.values import Unknown
from grader.workspace.rules.names import (
    Mismatch,
    Mismatches,
    warning,
)
from grader.workspace.rules.rule_table import (
    NO_EFFECT,
    NO_PARAMETER,
    NO_SUCH_PARAMETER,
    OTHER_RELEASE,
    Rule,
    Symptom,
)
from grader.workspace.rules.shared_symptoms import (
    TYPE_EXPECTED,
)

ParameterValues = Mapping[str, ParameterValue]  # by their names

_MAX_TABLES = 100  # of plugins in a node
_PLAIN = on_use(r"[\w ./:+,-]*")
_CLASS_KEYS = ("plugin", "type")  # of a section of parameters of a plugin
_MANY_UNKNOWN = 5  # parameters, from which on they may be those of another program
_MAX_LIBRARIES = 3  # that a message names
_MAX_NAMED = 300  # parameters of which a misspelt one may be one
_WORDS = {
    bool: "a boolean",
    int: "an integer",
    float: "a double",
    str: "a string",
}  # as ROS 2 calls them
# The same, as generate_parameter_library calls them.
_DECLARED = {
    "bool": "a boolean",
    "int": "an integer",
    "double": "a double",
    "string": "a string",
    "bool_array": "a list of booleans",
    "int_array": "a list of integers",
    "double_array": "a list of doubles",
    "string_array": "a list of strings",
}
_NOT_KNOWN = Unknown("its default is not known", START)


class GivenNode(Named):
    """The parameters that a node, a controller or a plugin gets."""

    node: str  # whose rows count
    said: str  # what messages call it
    values: ParameterValues
    # Where a missing parameter is said; None where other files may give the node more.
    at: Location | None
    # The places of values that other nodes get too: they need not be parameters of this one.
    shared: frozenset[Location] = frozenset()
    prefix: str = ""  # of names, which the file does not have

    def shown(self, name: str) -> str:
        """Return the name of a parameter as the file has it."""
        return name.removeprefix(self.prefix)


class _RowFinding(Named):
    name: str  # of the parameter
    mismatch: Mismatch


class _RowTable(Named):
    """The rows of a node or of one of its plugins, whose parameters begin with a prefix."""

    prefix: str
    rows: "_RowIndex"
    is_open: bool
    takes_any_type: bool


class _RowIndex(Named):
    """The rows of a release: all by their names, those of one name each, and those of many."""

    all_rows: Mapping[str, ParameterRow]
    by_name: Mapping[str, ParameterRow]
    patterns: Sequence[ParameterRow]


class _ParameterMatch(Named):
    """A row that has a name, in its table, with what stands in place of the angle brackets."""

    table: _RowTable
    row: ParameterRow
    parts: Sequence[str]

    def full_name(self, name: str) -> str:
        """Return the full name of another parameter of the same table and the same parts."""
        for place, part in zip(self.row.places, self.parts, strict=True):
            name = name.replace(f"<{place}>", part)
        return f"{self.table.prefix}{name}"


_PARAMETER_NAME = Rule(
    "parameter-name",
    "parameters",
    NO_SUCH_PARAMETER,
    "The parameters of a well-known node are those that it has.",
    why=(
        "ROS 2 ignores a value for an undeclared parameter without a message. The node runs "
        "with its default, so the setting seems to do nothing."
    ),
    wrong="""
Node(package='robot_localization', executable='ekf_node', parameters=[{'two_d_mod': True}]),
""",
    right="""
Node(package='robot_localization', executable='ekf_node', parameters=[{'two_d_mode': True}]),
""",
)


def wrong_values(given: GivenNode, stated: Sequence[Release]) -> Mismatches:
    """Yield what is wrong with the parameters of a node in each of the stated releases.

    Without a stated release, it is all that the rows are of. A value that is right in one of them
    is right.
    """
    known = node_rows(given.node)
    if not known or not all(map(known.is_known_in, stated)):
        return
    read = [release for release in COVERED if known.is_known_in(release)]
    readers = {release: _NodeReader(given, release) for release in read}
    releases = [release for release in stated or read if known.is_in(release)]
    for finding in _findings_in_all([readers[release] for release in releases]):
        if finding.mismatch.rule is _PARAMETER_NAME:
            having = [release for release, reader in readers.items() if reader.has(finding.name)]
            yield _of_other_release(given, finding, having, stated)
        else:
            yield finding.mismatch


def _findings_in_all(readers: "Sequence[_NodeReader]") -> Iterator[_RowFinding]:
    """Yield what is wrong as each of some releases reads the parameters, as the first says it."""
    by_release = []
    for reader in readers:
        by_release.append({(each.mismatch.rule, each.name): each for each in reader.findings()})
    for key, finding in by_release[0].items() if by_release else ():
        if all(key in findings for findings in by_release):
            yield finding


def default_in(given: GivenNode, name: str, release: Release) -> Any:
    """Return the value that a node has in a release for a parameter that it does not get.

    The result is Unknown where that is not known, None where it has none.
    """
    return _NodeReader(given, release).default(name)


_PARAMETER_RELEASE = Rule(
    "parameter-release",
    "parameters",
    OTHER_RELEASE,
    "The parameters of a well-known node are those of the stated release.",
    why=(
        "A node of another release does not declare the parameter, so the value is ignored "
        "without a message. Settings from a tutorial then have no effect."
    ),
    wrong="""
controller_manager:
  ros__parameters:
    drive_controller: {type: diff_drive_controller/DiffDriveController}
drive_controller:
  ros__parameters:
    left_wheel_names: [left_joint]
    right_wheel_names: [right_joint]
    wheel_separation: 0.3
    wheel_radius: 0.05
    use_stamped_vel: true
""",
    right="""
controller_manager:
  ros__parameters:
    drive_controller: {type: diff_drive_controller/DiffDriveController}
drive_controller:
  ros__parameters:
    left_wheel_names: [left_joint]
    right_wheel_names: [right_joint]
    wheel_separation: 0.3
    wheel_radius: 0.05
""",
    frame="controllers.yaml",
    beside={
        "drive/rover.urdf": "",
    },
)


def _of_other_release(
    given: GivenNode, finding: _RowFinding, releases: Sequence[Release], stated: Sequence[Release]
) -> Mismatch:
    """Return that a name is one of other releases, if it is; else that it is not known."""
    if not releases or not stated:
        return finding.mismatch
    name = finding.name
    at = given.values[name].location if name in given.values else finding.mismatch.location
    for owner in (f"{given.node}/", f"{given.node.rpartition('/')[2]}/"):
        other = other_name("parameter", owner + name, stated, shown=owner)
        if other:
            return warning(_PARAMETER_RELEASE, other.message, at)
    if RELEASES.index(releases[-1]) < RELEASES.index(stated[0]):
        gone = RELEASES[RELEASES.index(releases[-1]) + 1]
        text = f"there is no parameter {name!r} from {gone.title()} on"
    else:
        text = f"there is no parameter {name!r} before {releases[0].title()}"
    return warning(_PARAMETER_RELEASE, text, at)


PARAMETER_REQUIRED = Rule(
    "parameter-required",
    "parameters",
    NO_PARAMETER,
    "A node gets the parameters without which it stops.",
    why=(
        "The node prints an error and ends, so ros2 launch reports that the process has died. A"
        " lifecycle node fails to configure."
    ),
    symptoms=(
        Symptom(
            "no-critics",
            pattern=r"No critics defined for (?P<plugin>[\w.-]{1,200}+)",
            source=(
                "ros-navigation/navigation2 a3a97043e, nav2_dwb_controller/dwb_core/src/"
                "dwb_local_planner.cpp:164"
            ),
            sentence="The local planner gets no list of critics.",
            example="No critics defined for FollowPath",
            within=("plugin",),
        ),
        Symptom(
            "parameter-not-set",
            pattern=(
                r"Statically typed parameter '(?P<parameter>[\w./-]{1,200}+)' must be initialized"
            ),
            source="ros2/rclcpp a0a2a067d, rclcpp/include/rclcpp/exceptions/exceptions.hpp:297",
            sentence="A parameter without a default gets no value.",
            example="Statically typed parameter 'joint_name' must be initialized.",
            within=("parameter",),
        ),
    ),
    wrong="Node(package='robot_state_publisher', executable='robot_state_publisher'),",
    right="""
Node(
    package='robot_state_publisher',
    executable='robot_state_publisher',
    parameters=[{'robot_description': robot}],
),
""",
)

PARAMETER_TYPE = Rule(
    "parameter-type",
    "parameters",
    NO_PARAMETER,
    "A parameter has the type that its node declares.",
    is_of_type=True,
    why=(
        "Nodes do not convert types: 2 is no double and '2.0' is no number. The declaration "
        "raises InvalidParameterTypeException, and the node ends at its start."
    ),
    symptoms=(
        Symptom(
            "parameter-invalid-type",
            pattern=r"parameter '(?P<parameter>[\w./-]{1,200}+)' has invalid type:",
            source="ros2/rclcpp a0a2a067d, rclcpp/include/rclcpp/exceptions/exceptions.hpp:280",
            sentence="A parameter has another type than its node declares.",
            example="parameter 'rate' has invalid type: Wrong parameter type",
            within=("parameter",),
        ),
        TYPE_EXPECTED,
        Symptom(
            "parameter-set",
            pattern=(
                r"Trying to set parameter '(?P<parameter>[\w.-]{1,200}+)' to .{0,200}?expecting "
                r"type '"
            ),
            source="ros2/rclpy ba72a01, rclpy/rclpy/exceptions.py:116",
            sentence="A parameter has another type than its node declares.",
            example=(
                "Trying to set parameter 'speed' to '1' of type 'INTEGER', expecting type "
                "'Type.DOUBLE': speed"
            ),
            within=("parameter",),
        ),
    ),
    wrong="Node(package='rover', executable='joystick', parameters=[{'speed': 'fast'}]),",
    right="Node(package='rover', executable='joystick', parameters=[{'speed': 2.0}]),",
    beside={
        "joystick.py": "",
    },
)

_PARAMETER_VALUE = Rule(
    "parameter-value",
    "parameters",
    NO_PARAMETER,
    "A parameter has a value that its node accepts.",
    why=(
        "The node validates the value and refuses it with an error at its start. It stops, or "
        "the controller is not loaded."
    ),
    symptoms=(
        Symptom(
            "library-registered",
            pattern=r"ID \[(?P<type>\w{1,200}+)\] already registered",
            source="BehaviorTree/BehaviorTree.CPP 879522c, src/bt_factory.cpp:211",
            sentence=(
                "Two libraries have one node of behavior trees: the navigator loads its own "
                "libraries itself."
            ),
            example="Original error: ID [ComputePathToPose] already registered",
            within=("type",),
        ),
        Symptom(
            "library-not-loaded",
            pattern=r"Could not load library: (?:lib)?(?P<library>[\w.-]{1,200}?)(?:\.so)?: ",
            source="BehaviorTree/BehaviorTree.CPP 879522c, src/shared_library_UNIX.cpp:26",
            sentence="No installed package has the library.",
            example=(
                "Could not load library: libnav2_spin_action_bt_nod.so: cannot open shared "
                "object file: No such file or directory"
            ),
            within=("library",),
        ),
    ),
    wrong="""
controller_manager:
  ros__parameters:
    drive_controller: {type: diff_drive_controller/DiffDriveController}
drive_controller:
  ros__parameters:
    left_wheel_names: [left_joint]
    right_wheel_names: [right_joint]
    wheel_separation: 0.3
    wheel_radius: 0.0
""",
    right="""
controller_manager:
  ros__parameters:
    drive_controller: {type: diff_drive_controller/DiffDriveController}
drive_controller:
  ros__parameters:
    left_wheel_names: [left_joint]
    right_wheel_names: [right_joint]
    wheel_separation: 0.3
    wheel_radius: 0.05
""",
    frame="controllers.yaml",
    beside={
        "drive/rover.urdf": "",
    },
)


class _NodeReader:
    """The parameters of a node, as one release reads them."""

    def __init__(self, given: GivenNode, release: Release) -> None:
        self._given = given
        self._release = release
        self._values = given.values
        self._tables: list[_RowTable] = []
        self._unread: list[str] = []  # prefixes of plugins that are not known
        self._is_complete = True  # whether the rows of all plugins are read
        self._lists: dict[str, Collection[str] | None] = {}  # by their names
        self._add_tables()

    def has(self, name: str) -> bool:
        """Return whether there is a parameter of a name."""
        return self._match(name) is not None

    def default(self, name: str) -> Any:
        """Return the default of a parameter; Unknown where it is not known, None without one."""
        match = self._match(name)
        if not match:
            return _NOT_KNOWN if self._may_have_more() else None
        row = match.row
        if row.is_required:
            return None
        if row.only_with and match.full_name(row.only_with) not in self._values:
            return None
        is_read = bool(row.only_with) or all(
            self._items(match.table, place) for place in row.places
        )
        return row.default if is_read and row.default is not None else _NOT_KNOWN

    def _may_have_more(self) -> bool:
        """Return whether the node may have parameters that no row is of."""
        if self._unread or not self._is_complete:
            return True
        return any(table.is_open for table in self._tables)

    def findings(self) -> Iterator[_RowFinding]:
        """Yield what is wrong."""
        unmatched = {}
        said = set()  # the switches without which values have no effect
        for name, value in self._values.items():
            match = self._match(name)
            if not match:
                unmatched[name] = value
                continue
            switch = self._switch_off(match)
            # The default says nothing, whether it is read or not; nor does zero, which generators
            # write for a limit that is off.
            is_number = not isinstance(value.value, bool)
            is_default = is_number and value.value in (match.row.default, 0)
            if not switch:
                yield from self._value_findings(name, value, match)
            elif switch.name not in said and not is_default:
                said.add(switch.name)
                yield switch.finding(self._given, name, value)
        # So many may be those of another program of this name, built from its own source.
        is_another = len(unmatched) >= _MANY_UNKNOWN and 2 * len(unmatched) > len(self._values)
        if not is_another and self._is_complete:
            yield from self._name_findings(unmatched)

    def _name_findings(self, unmatched: ParameterValues) -> Iterator[_RowFinding]:
        """Yield the parameters that there are not, and those without which the node stops."""
        meant: dict[str, str] = {}  # the parameters that misspelt ones stand for
        unread: dict[str, _RowFinding] = {}
        for name, value in unmatched.items():
            if self._is_under_unread(name):
                continue
            near_name = self._near(name) if len(unread) < MAX_GUESSES else None
            if near_name is not None:
                meant.setdefault(near_name, name)
            finding = self._unknown(name, value, near_name)
            if finding:
                unread.setdefault(finding.name, finding)
        if self._given.at:
            yield from self._missing(meant, unread)
        yield from unread.values()

    def _add_tables(self) -> None:
        waiting = [("", self._given.node)]
        while waiting and len(self._tables) < _MAX_TABLES:
            prefix, node = waiting.pop(0)
            known = node_rows(node)
            is_known = known is not None and known.is_known_in(self._release)
            if not known or not is_known or not known.is_in(self._release):
                self._unread.append(prefix)
                continue
            index = _index(node, self._release)
            is_open = self._release in known.open_in
            self._tables.append(_RowTable(prefix, index, is_open, known.takes_any_type))
            for row in index.all_rows.values():
                if row.is_class:
                    waiting += self._plugins(prefix, row)
        self._is_complete = not waiting

    def _plugins(self, prefix: str, row: ParameterRow) -> Iterator[tuple[str, str]]:
        """Yield the classes that a parameter names, with the prefix of their parameters."""
        for name, given in self._values.items():
            if not name.startswith(prefix) or not row.pattern.fullmatch(name[len(prefix) :]):
                continue
            above, dot, _ = name.rpartition(".")
            if isinstance(given.value, str):
                yield above + dot, given.value.replace("/", "::")

    def _match(self, name: str) -> _ParameterMatch | None:
        """Return the row of a parameter."""
        for table in self._tables:
            if not name.startswith(table.prefix):
                continue
            own_name = name[len(table.prefix) :]
            row = table.rows.by_name.get(own_name)
            if row:
                return _ParameterMatch(table, row, ())
            for row in table.rows.patterns:
                match = row.pattern.fullmatch(own_name)
                if match and self._are_listed(table, row, match.groups()):
                    return _ParameterMatch(table, row, match.groups())
        return None

    def _are_listed(self, table: _RowTable, row: ParameterRow, parts: Sequence[str]) -> bool:
        """Return whether the lists that a name of a row takes its parts from have them."""
        for place, part in zip(row.places, parts, strict=True):
            items = self._items(table, place)
            if items is not None and part not in items:
                return False
        return True

    def _items(self, table: _RowTable, place: str) -> Collection[str] | None:
        """Return the entries of the list that a part of a name is one of; None for any."""
        name = f"{table.prefix}{place}"
        if name not in self._lists:
            row = table.rows.by_name.get(place)
            given = self._values.get(name)
            if given:
                self._lists[name] = _entries(given.value)
            else:
                self._lists[name] = _entries(row.default) or None if row else None
        return self._lists[name]

    def _is_under_unread(self, name: str) -> bool:
        """Return whether a parameter may be one of a plugin that is not known."""
        if any(prefix and name.startswith(prefix) for prefix in self._unread):
            return True
        parts = name.split(".")
        for count in range(1, len(parts)):
            for key in _CLASS_KEYS:
                kind = ".".join((*parts[:count], key))
                if kind in self._values and not self._match(kind):
                    return True
        return False

    def _switch_off(self, match: _ParameterMatch) -> "_OffSwitch | None":
        """Return the parameter by whose value another one has no effect; None if it has one."""
        row = match.row
        is_whole = self._given.at is not None
        needed = match.full_name(row.only_with)
        if row.only_with and is_whole and needed not in self._values:
            return _OffSwitch(needed, f" without {needed}")
        for switch, wanted in row.unless.items():
            own_row = match.table.rows.all_rows.get(switch)
            switch_name = match.full_name(switch)
            if not own_row:
                continue
            if switch_name in self._values:
                value = self._values[switch_name].value
                place = f" ({self._values[switch_name].location.file_and_line})"
            elif is_whole:
                value = own_row.default
                place = ", by default"
            else:
                continue
            if type(value) is type(wanted) and value != wanted:
                shown = self._given.shown(switch_name)
                return _OffSwitch(switch_name, f": {shown} is {_shown(value)}{place}")
        return None

    def _other_type(
        self, name: str, given: ParameterValue, match: _ParameterMatch
    ) -> _RowFinding | None:
        """Return that a value has another type than its node declares.

        A text that a launch file replaces may stand for the value.
        """
        actual = type_in_words(given.value)
        declared = _DECLARED.get(match.row.type, "")
        if not declared or not actual or actual == declared:
            return None
        message = (
            f"the parameter {self._given.shown(name)!r} is given {actual}{given.remark}; "
            f"{self._given.said} declares {declared}, and stops"
        )
        return self._certain(
            PARAMETER_TYPE, name, message, given.location, names_of_types(declared, actual)
        )

    def _value_findings(
        self, name: str, given: ParameterValue, match: _ParameterMatch
    ) -> Iterator[_RowFinding]:
        """Yield that a value has another type, or that its node does not accept it."""
        other_type = self._other_type(name, given, match)
        if not other_type:
            yield from self._not_accepted(name, given, match)
        elif not match.table.takes_any_type and not _is_placeholder(given.value):
            yield other_type

    def _not_accepted(
        self, name: str, given: ParameterValue, match: _ParameterMatch
    ) -> Iterator[_RowFinding]:
        """Yield the values that a node does not accept, and stops at."""
        wrong = _beyond(match.row, given.value)
        if wrong:
            message = (
                f"the parameter {self._given.shown(name)!r} is {_shown(given.value)}; "
                f"{self._given.said} {wrong}"
            )
            yield self._certain(_PARAMETER_VALUE, name, message, given.location)
        wrong = self._wrong_library(name, match.row, given.value)
        if wrong:
            message = f"{self._given.said} {wrong}"
            nodes = tuple(map(_name_of_tree_node, _list_values(given.value)))
            yield self._certain(_PARAMETER_VALUE, name, message, given.location, nodes)

    def _wrong_library(self, name: str, row: ParameterRow, value: Any) -> str:
        """Return, in words, that a node stops at a library of plugins; empty if it does not.

        A parameter that is no list names a class of them.
        """
        listed = _list_values(value) if row.libraries else []
        twice = [item for item in listed if item in row.libraries]
        if twice and row.loads_libraries:
            return (
                f"loads {enumerated(twice, _MAX_LIBRARIES)} itself, and stops where {name} has "
                "the same: list only other libraries"
            )
        unknown = [item for item in listed if item not in row.libraries]
        what = "stops", "library"
        if isinstance(value, str):
            what = "loads nothing", "class"
        return self._missing_library(row, unknown, what)

    def _missing_library(
        self, row: ParameterRow, unknown: Sequence[str], what: tuple[str, str]
    ) -> str:
        """Return that a library is misspelt or of another release; empty if none surely is.

        `what` says what the node does, and what is not there.
        """
        does, noun = what
        others = self._libraries_of_releases(row)
        for name in unknown:
            meant = near(name, row.libraries)
            if name in others or meant is not None:
                guess = f"; did you mean {quoted(meant)}?" if meant is not None else ""
                return f"{does}: {self._release.title()} has no {noun} {quoted(name)}{guess}"
        return ""

    def _libraries_of_releases(self, row: ParameterRow) -> set[str]:
        """Return the libraries that a parameter may list in any release."""
        libraries: set[str] = set()
        for other in find_rows(self._given.node):
            if other.name == row.name:
                libraries.update(other.libraries)
        return libraries

    def _certain(
        self, rule: Rule, name: str, message: str, at: Location, names: Strings = ()
    ) -> _RowFinding:
        return _RowFinding(name, Mismatch(rule, message, at, names=(name, *names)))

    def _near(self, name: str) -> str | None:
        """Return the parameter that another name surely stands for: one part of it is misspelt."""
        candidates = {}  # the parts that are misspelt, by what they stand for
        corrected_names = {}  # the names, by the same
        for table in self._tables:
            if not name.startswith(table.prefix):
                continue
            own_parts = name[len(table.prefix) :].split(".")
            for row in table.rows.all_rows.values():
                corrected = _corrected(own_parts, row.name.split("."))
                if not corrected:
                    continue
                full = table.prefix + ".".join(corrected.parts)
                if full not in self._values and self.has(full):
                    candidates[corrected.meant] = corrected.part
                    corrected_names[corrected.meant] = full
        parts = set(candidates.values())
        meant = near(parts.pop(), candidates) if len(parts) == 1 else None
        return corrected_names[meant] if meant is not None else None

    def _unknown(
        self, name: str, value: ParameterValue, near_name: str | None
    ) -> _RowFinding | None:
        """Return that there is no parameter of a name, or of the table that it is in."""
        if value.location in self._given.shared:
            return None
        at = value.name_location
        if near_name is not None:
            return self._misspelt(name, at, near_name)
        table = next(
            candidate for candidate in reversed(self._tables) if name.startswith(candidate.prefix)
        )
        if table.is_open or "" in self._unread:
            return None
        section = self._first_unknown(name, table)
        similar = closest(section, self._names(table), is_clear=True)
        guess = ""
        if similar and is_misspelling(section, similar) and are_of_one_side(section, similar):
            guess = f"; did you mean {quoted(similar)}?"
        message = f"{self._given.said} has no parameter {quoted(section)}{guess}"
        mismatch = warning(_PARAMETER_NAME, message, at)
        return _RowFinding(section, mismatch)

    def _misspelt(self, name: str, at: Location, near_name: str) -> _RowFinding:
        """Return that a name surely stands for another parameter."""
        old = name.rpartition(".")[2]
        new = near_name.rpartition(".")[2]
        message = (
            f"{self._given.said} has no parameter {quoted(self._given.shown(name))}; did you "
            f"mean {quoted(self._given.shown(near_name))}?"
        )
        return _RowFinding(name, warning(_PARAMETER_NAME, message, at).correcting(old, new))

    def _first_unknown(self, name: str, table: _RowTable) -> str:
        """Return a name up to the first part with which no parameter begins."""
        parts = name[len(table.prefix) :].split(".")
        for count in range(1, len(parts)):
            start = parts[:count]
            if not any(self._begins(table, row, start) for row in table.rows.all_rows.values()):
                return table.prefix + ".".join(start)
        return name

    def _begins(self, table: _RowTable, row: ParameterRow, start: Sequence[str]) -> bool:
        """Return whether the name of a row may begin with some parts."""
        parts = row.name.split(".")
        for own_part, part in zip(parts, start, strict=False):
            place = own_part[1:-1] if own_part.startswith("<") and own_part.endswith(">") else ""
            items = self._items(table, place) if place else None
            is_other = own_part != part and "<" not in own_part
            if is_other or (items is not None and part not in items):
                return False
        return len(parts) >= len(start) or parts[-1] == "<**>"

    def _names(self, table: _RowTable) -> list[str]:
        return [f"{table.prefix}{name}" for name in table.rows.by_name][:_MAX_NAMED]

    def _missing(
        self, meant: StringsByName, unread: dict[str, _RowFinding]
    ) -> Iterator[_RowFinding]:
        """Yield the parameters without which a node stops, and that it does not get."""
        at = self._given.at
        assert at
        for table in self._tables:
            for row, name in self._required(table):
                if name in self._values:
                    continue
                message = (
                    f"{self._given.said} stops without the parameter {name}, which it does not get"
                )
                wrong = meant.get(name) or closest(name, unread)
                if wrong is None or wrong not in self._values:
                    yield self._certain(PARAMETER_REQUIRED, name, message, at)
                    continue
                unread.pop(wrong, None)
                value = self._values[wrong]
                place = value.name_location
                text = f"{message}; did you mean it by {wrong!r}?"
                mismatch = Mismatch(PARAMETER_REQUIRED, text, place)
                old = wrong.rpartition(".")[2]
                new = row.name.rpartition(".")[2]
                yield _RowFinding(name, mismatch.correcting(old, new))

    def _required(self, table: _RowTable) -> Iterator[tuple[ParameterRow, str]]:
        """Yield the rows without which a node stops, with the names that it needs.

        Of a row with a part for the value of another parameter, it is the name with the value
        that is given.
        """
        for row in table.rows.all_rows.values():
            if not row.is_required:
                continue
            if not row.places:
                yield row, f"{table.prefix}{row.name}"
                continue
            (place,) = row.places
            given = self._values.get(f"{table.prefix}{place}")
            if given and isinstance(given.value, str):
                yield row, f"{table.prefix}{row.name.replace(f'<{place}>', given.value)}"


_PARAMETER_EFFECT = Rule(
    "parameter-effect",
    "parameters",
    NO_EFFECT,
    "The parameters of a well-known node have an effect under the values of others.",
    why=(
        "The node accepts the value without a warning and does not use it. Its behaviour stays "
        "the same, whatever the value is."
    ),
    wrong="""
Node(package='robot_localization', executable='ekf_node', parameters=[{'odom0_relative': True}]),
""",
    right="""
Node(
    package='robot_localization',
    executable='ekf_node',
    parameters=[{'odom0': 'wheels/odom', 'odom0_relative': True}],
),
""",
)


class _OffSwitch(Named):
    """A parameter by whose value, or absence, others have no effect."""

    name: str
    words: str

    def finding(self, given: GivenNode, name: str, value: ParameterValue) -> _RowFinding:
        """Return that a parameter has no effect."""
        at = value.name_location
        message = f"{given.said} does not use {given.shown(name)}{self.words}"
        mismatch = warning(_PARAMETER_EFFECT, message, at)
        return _RowFinding(name, mismatch)


@cache
def _index(node: str, release: Release) -> _RowIndex:
    rows = {row.name: row for row in find_rows(node, release)}
    by_name = {name: row for name, row in rows.items() if not row.places}
    patterns = [row for row in rows.values() if row.places]
    return _RowIndex(rows, by_name, patterns)


def _entries(value: Any) -> Collection[str] | None:
    """Return the entries of a list, or the words of a text; None for what is not known."""
    if isinstance(value, str):
        return frozenset(value.split())
    return frozenset(map(str, value)) if isinstance(value, list) else None


class _Corrected(Named):
    """A name with one part corrected."""

    parts: Sequence[str]
    part: str
    meant: str


@lru_cache(maxsize=4096)
def _may_mean(part: str, own_part: str) -> bool:
    """Return whether a part of a name may be a misspelt one; each release asks for the same."""
    return near(part, [own_part]) is not None


def _corrected(parts: Sequence[str], wanted: Sequence[str]) -> _Corrected | None:
    """Return a name with the one part corrected that differs from a row's.

    The result is None if not one does, or not surely.
    """
    if len(parts) != len(wanted):
        return None
    corrected = []
    changed = []
    for part, own_part in zip(parts, wanted, strict=True):
        meant = own_part
        if "<#>" in own_part:
            digits = "".join(character for character in part if character.isdigit())
            meant = own_part.replace("<#>", digits) if digits else part
        elif "<" in own_part:
            meant = part
        if meant != part:
            changed.append((part, meant))
        corrected.append(meant)
    if len(changed) != 1 or not _may_mean(*changed[0]):
        return None
    return _Corrected(corrected, *changed[0])


def type_in_words(value: Any) -> str:
    """Return the type that ROS 2 gives a value, in words; empty where it is not known."""
    if isinstance(value, list | tuple):
        kinds = {type_in_words(item) for item in value}
        if len(kinds) == 1 and kinds != {""}:
            return f"a list of {kinds.pop().partition(' ')[2]}s"
        return ""
    return _WORDS.get(type(value), "")


def names_of_types(declared: str, actual: str) -> Strings:
    """Return how rclcpp calls the types that a parameter has and is given, which are in words.

    >>> names_of_types("a list of doubles", "an integer")
    ('double_array', 'integer')
    """
    names = []
    for words in (declared, actual):
        kind = words.rsplit(" ", 1)[-1].replace("boolean", "bool")
        names.append(f"{kind.removesuffix('s')}_array" if " list " in words else kind)
    return tuple(names)


def _list_values(value: Any) -> list[str]:
    """Return the names that a parameter has: a list of them, or one."""
    if isinstance(value, list):
        return [str(item) for item in value]
    return [value] if isinstance(value, str) else []


def _name_of_tree_node(library: object) -> str:
    """Return the node of behavior trees that a library of Nav2 has: ComputePathToPose."""
    stem = re.sub(r"^nav2_|(?:_action|_condition|_service|_node)?_bt_node$", "", str(library))
    return "".join(word.capitalize() for word in stem.split("_"))


def _is_placeholder(value: Any) -> bool:
    """Return whether a text may be one that a launch file replaces, such as KEEPOUT_ENABLED."""
    return isinstance(value, str) and (value.isupper() or not _PLAIN.fullmatch(value))


def _beyond(row: ParameterRow, value: Any) -> str:
    """Return what a node needs in place of a value, in words; empty for one that it accepts."""
    if isinstance(value, list):
        return _beyond_list(row, value)
    if row.one_of and isinstance(value, str) and value not in row.one_of:
        return f"needs {enumerated(map(_shown, row.one_of), word='or')}, and stops"
    if isinstance(value, bool) or not isinstance(value, int | float):
        return ""
    bounds = (
        (row.above, operator.le, "more than"),
        (row.below, operator.ge, "less than"),
        (row.lower, operator.lt, "at least"),
        (row.upper, operator.gt, "at most"),
    )
    for bound, is_beyond, words in bounds:
        if bound is not None and is_beyond(value, bound):
            return f"needs {words} {bound:g}, and stops"
    return ""


def _beyond_list(row: ParameterRow, value: Sequence[Any]) -> str:
    if row.size is not None and len(value) != row.size:
        return f"needs {row.size} values, and stops"
    others = [item for item in value if row.entries and item not in row.entries]
    if others:
        return f"knows no {_shown(others[0])} there, and stops"
    return ""


def _shown(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float | int):
        return f"{value:g}"
    if isinstance(value, list):
        return "[" + ", ".join(_shown(item) for item in value) + "]"
    return quoted(str(value))
