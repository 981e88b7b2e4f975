"""Validate a rubric's TOML: every mistake is collected, with the path of the key that it is in."""

from collections.abc import Collection, Iterator, Mapping
from decimal import Decimal
from functools import cache
from typing import Any

from grader.base.errors import InputError
from grader.base.grouping import Strings
from grader.base.text import enumerated, texts_in
from grader.base.toml_file import KeyTable, TomlPath, TomlRow, TomlRowReader, shorten_value
from grader.base.toml_types import WrongValue
from grader.lab.checks.check import LINK_ARGUMENTS, Check
from grader.lab.checks.registry import check_names, find_check
from grader.lab.rubric import keys
from grader.lab.rubric.criterion import DEADLINE, GRADE, TOTAL
from grader.ros.urdf.link_tree import JOINT_OF, is_selector

_MAX_LISTED = 20  # names in one message
_RESERVED = {TOTAL: "final marks", GRADE: "grades", DEADLINE: "deadlines"}  # ids

BoundCheck = tuple[Check, TomlRow]
BoundCarried = tuple[
    Strings, Check, TomlRow, Mapping[str, float]
]  # the possible causes, the fact that counts instead, and its own positions of joints

_PENALTIES = ("percent_per_day", "points_per_day", "points")  # of a late policy, one at least
_Places = Mapping[str, int]  # of criteria, by id
_TomlRows = list[TomlRow]
Complaint = tuple[TomlPath, str]  # where it belongs, and the text


class Validation:
    """One pass over a parsed rubric.

    Where `complaints` is empty, the rows contain the converted values of a rubric.

    `bound` has the check of each criterion with its arguments, in the order of the rows, `carried`
    what its `carried` says.
    """

    def __init__(self, table: TomlRow) -> None:
        self._reader = TomlRowReader()
        self._row = self._reader.row
        self._guess = self._reader.guess
        self._complain = self._reader.complain
        self.bound: list[BoundCheck] = []
        self.carried: list[list[BoundCarried]] = []
        # Causes in `carried` that are no criteria, such as one that was deleted, with their places.
        self.unknown_causes: list[Complaint] = []
        self._find_check = cache(find_check)
        self._check_names = cache(check_names)
        self.rubric = self._row((), table, keys.RUBRIC)
        self._defaults: TomlRow = {}
        self._default_arguments: dict[str, TomlRow] = {}
        self._read_defaults()
        self.parts = self._read_rows("part", keys.PART)
        self.criteria = self._read_rows("criterion", keys.CRITERION, self._defaults)
        self.evidence = self._read_rows("evidence", keys.EVIDENCE)
        self.late = None
        if "late" in self.rubric:
            self.late = self._row(("late",), self.rubric["late"], keys.LATE)
            if not any(key in self.rubric["late"] for key in _PENALTIES):
                self._complain(("late",), f"this late policy has no {' or '.join(_PENALTIES)}")
        self.ignored = self._read_ignored()
        part_ids = self._find_positions("part")
        positions = self._find_positions("criterion")
        self._check_part(("defaults",), self._defaults, part_ids)
        self._check_criteria(part_ids, positions)
        for index, row in enumerate(self.evidence):
            self._check_part(("evidence", index), row, part_ids)
        main = self.rubric.get("package", "")
        packages = self.rubric.get("packages", ())
        if main and packages and main not in packages:
            self._complain(("package",), f"packages does not list the package {main!r}")
        self.adjusted = self._read_adjustments(positions)
        self._check_totals()

    @property
    def complaints(self) -> list[Complaint]:
        """The mistakes, each with the path of its key."""
        return self._reader.complaints

    def _check_criteria(self, part_ids: Collection[str], positions: _Places) -> None:
        for index, row in enumerate(self.criteria):
            where = ("criterion", index)
            if "part" in self.rubric["criterion"][index]:
                self._check_part(where, row, part_ids)
            self._check_order((*where, "requires"), row, positions)
            self._check_package(where, row)
            if (bound := self._bind_check(where, row)) is not None:
                self.bound.append(bound)
                self._check_subject(where, row, bound[0])
                self._check_causes((*where, "feedback"), row, bound[0])
            given = row.get("carried", [])
            tables: list[tuple[TomlPath, TomlRow]]
            if isinstance(given, dict):
                tables = [((*where, "carried"), given)]
            else:
                tables = [((*where, "carried", i), table) for i, table in enumerate(given)]
            carried = []
            for place, table in tables:
                bound_table = self._bind_carried(place, row, table, positions)
                if bound_table:
                    carried.append(bound_table)
            self.carried.append(carried)
            if use := _RESERVED.get(row.get("id", "")):
                self._complain(
                    (*where, "id"),
                    f"the id {row['id']!r} is reserved for {use}: choose another one",
                )

    def _check_package(self, where: TomlPath, row: TomlRow) -> None:
        """Complain of a package that is none of several packages of the rubric."""
        packages = self.rubric.get("packages", ())
        if "package" in row and row["package"] not in packages:
            hint = (
                self._guess(row["package"], packages)
                or f"; there are: {enumerated(packages, _MAX_LISTED) or 'none'}"
            )
            self._complain((*where, "package"), f"packages has no {row['package']!r}{hint}")

    def _read_rows(
        self, key: str, table: KeyTable, defaults: Mapping[str, Any] | None = None
    ) -> _TomlRows:
        rows = enumerate(self.rubric.get(key, ()))
        return [self._row((key, index), row, table, defaults or {}) for index, row in rows]

    def _read_ignored(self) -> _TomlRows:
        """Return the tables of mutants that may keep full marks."""
        test = self._row(("test",), self.rubric.get("test", {}), keys.TEST)
        return [
            self._row(("test", "ignore", index), row, keys.IGNORE)
            for index, row in enumerate(test.get("ignore", ()))
        ]

    def _read_defaults(self) -> None:
        """Read the default values of criteria, and the default arguments of checks.

        Criteria have them unless they give others.
        """
        defaults = self._row(("defaults",), self.rubric.get("defaults", {}), keys.DEFAULTS)
        for name, given in defaults.pop("with", {}).items():
            where = ("defaults", "with", name)
            check = self._look_up_check(where, name)
            if not isinstance(given, dict):
                self._complain(
                    where, f"the arguments of {name} must be a table, not {shorten_value(given)}"
                )
            elif check:
                unset = dict.fromkeys(
                    given
                )  # invalid ones are complained of once, not at each criterion
                self._default_arguments[name] = unset | self._parse_arguments(where, check, given)
        self._defaults = defaults

    def _check_subject(self, where: TomlPath, row: TomlRow, check: Check) -> None:
        """Complain of a pose or a comparison that a check cannot have.

        This is a pose for a check that examines no robot, or a comparison without a reference.
        """
        if "at" in row and "robot" not in check.examined:
            self._complain(
                (*where, "at"),
                f"at poses the robot, but the check {check.name} does not examine it",
            )
        if "args" in row and not {"robot", "urdf", "package"}.intersection(check.examined):
            message = (
                f"args gives launch arguments, but the check {check.name} examines neither the "
                "robot nor a package"
            )
            self._complain((*where, "args"), message)
        arguments = row.get("with", {})
        links = list(texts_in([value for key, value in arguments.items() if key in LINK_ARGUMENTS]))
        places = [*row.get("at", ()), *links]
        unknown = [text for text in places if text.startswith("@") and not is_selector(text)]
        unknown += [text for text in links if text.startswith(JOINT_OF)]
        for name in unknown:
            self._complain(
                where,
                f"no link is named by {name!r}: write @root, @tip, or @moved:1, @moved:2 and so on",
            )
        if "reference" in check.examined and not self.rubric.get("reference"):
            message = (
                f"the check {check.name} compares with the reference solution: the rubric needs "
                "the key reference"
            )
            self._complain((*where, "check"), message)

    def _check_causes(self, where: TomlPath, row: TomlRow, check: Check) -> None:
        """Complain of feedback on a cause that no failure of the check has."""
        for cause in row.get("feedback", {}):
            if cause and cause not in check.causes:
                there = f"; there are: {', '.join(check.causes)}"
                hint = self._guess(cause, check.causes) or there
                message = f"the check {check.name} has no cause {cause!r}{hint}"
                self._complain((*where, cause), message)

    def _find_positions(self, key: str) -> dict[str, int]:
        """Return the position of the first row with each id.

        Complain of later ones with the same id.
        """
        positions: dict[str, int] = {}
        for index, row in enumerate(self.rubric.get(key, ())):
            name = row.get("id")
            if isinstance(name, str) and positions.setdefault(name, index) != index:
                self._complain((key, index, "id"), f"the {key} {name!r} is already used")
        return positions

    def _check_part(self, where: TomlPath, row: TomlRow, parts: Collection[str]) -> None:
        part = row.get("part")
        if part is not None and part not in parts:
            hint = (
                self._guess(part, parts)
                or f"; there are: {enumerated(parts, _MAX_LISTED) or 'none'}"
            )
            self._complain((*where, "part"), f"there is no part {part!r}{hint}")

    def _check_order(self, where: TomlPath, row: TomlRow, positions: _Places) -> None:
        """Complain of ids in `requires` that are not those of criteria above it.

        Also complain of `carried` from the criterion itself.
        """
        given: Any = self.rubric  # also of a list with other mistakes in it
        for key in where:
            given = given[key] if isinstance(key, int) else given.get(key, {})
        index = int(where[1])
        is_required = where[-1] == "requires"
        if not isinstance(given, list):
            return
        for name in given:
            if not isinstance(name, str) or positions.get(name, index) < index:
                continue
            if name == row.get("id"):
                message = "requires itself" if is_required else "is carried from itself"
            elif not is_required:
                if name not in positions:
                    self.unknown_causes.append((where, name))
                continue
            elif name in positions:
                below = "which is below: a criterion can only require those above it"
                message = f"requires {name!r}, {below}"
            else:
                message = f"requires {name!r}, which does not exist{self._guess(name, positions)}"
            self._complain(where, message)

    def _bind_carried(
        self, where: TomlPath, row: TomlRow, table: TomlRow, positions: _Places
    ) -> BoundCarried | None:
        carried = self._row(where, table, keys.CARRIED)
        self._check_order((*where, "from"), row, positions)
        bound = self._bind_check(where, carried)
        if bound is None or "from" not in carried:
            return None
        causes = tuple(name for name in carried["from"] if name in positions)
        # Where all its causes are deleted, nothing is carried.
        return (causes, *bound, carried.get("at", {})) if causes else None

    def _read_adjustments(self, positions: _Places) -> dict[str, TomlRow]:
        """Return the adjustments by criterion."""
        for name in (adjusted := self.rubric.get("adjust", {})):
            if name not in positions:
                hint = self._guess(name, positions)
                self._complain(("adjust", name), f"adjusts {name!r}, which does not exist{hint}")
            elif not isinstance(adjusted[name], dict):
                message = (
                    f"the adjustment of {name} must be a table, not {shorten_value(adjusted[name])}"
                )
                self._complain(("adjust", name), message)
        return {
            name: self._row(("adjust", name), row, keys.ADJUSTMENT)
            for name, row in adjusted.items()
            if isinstance(row, dict)
        }

    def _bind_check(self, where: TomlPath, row: TomlRow) -> BoundCheck | None:
        """Return the check of a row with its converted arguments.

        It is None if there is no such check.
        """
        name = row.get("check")
        given = row.get("with", {})
        check = self._look_up_check((*where, "check"), name) if name is not None else None
        if not check:
            return None
        arguments = self._parse_arguments((*where, "with"), check, given)
        defaults = self._default_arguments.get(check.name, {})
        for key, parameter in check.parameters.items():
            if parameter.required and key not in given and key not in defaults:
                self._complain(
                    (*where, "with"), f"the check {check.name} needs {key}: {parameter.type.name}"
                )
        arguments = {
            **{key: value for key, value in defaults.items() if key not in given},
            **arguments,
        }
        return check.for_arguments(arguments), arguments

    def _parse_arguments(self, where: TomlPath, check: Check, given: TomlRow) -> TomlRow:
        """Return the valid arguments of a check, converted; complain of the others."""
        arguments = {}
        for key, value in given.items():
            parameter = check.parameters.get(key)
            if not parameter:
                known = [parameter for parameter in check.parameters if parameter not in given]
                hint = (
                    self._guess(key, known)
                    or f"; it takes: {', '.join(check.parameters) or 'nothing'}"
                )
                if key in keys.CRITERION.keys:
                    hint = ": it is a key of the criterion, which belongs above [criterion.with]"
                self._complain((*where, key), f"the check {check.name} takes no {key!r}{hint}")
                continue
            try:
                arguments[key] = parameter.type.parse(value)
            except WrongValue as error:
                self._complain(
                    (*where, key),
                    f"{key} of {check.name} must be {error}, not {shorten_value(value)}",
                )
        return arguments

    def _look_up_check(self, where: TomlPath, name: str) -> Check | None:
        try:
            check = self._find_check(name)
        except InputError as error:  # in another package
            self._complain(where, str(error))
            return None
        if not check:
            hint = self._guess(name, self._check_names()) or "; `grader rubric checks` lists them"
            self._complain(where, f"there is no check {name!r}{hint}")
        return check

    def _owners_of_totals(self) -> Iterator[tuple[TomlPath, TomlRow, str, _TomlRows]]:
        """Yield the rubric and its parts, each with its place before, its name and its criteria."""
        yield (), self.rubric, "the rubric", self.criteria
        by_part: dict[str, _TomlRows] = {}
        for row in self.criteria:
            by_part.setdefault(row.get("part", ""), []).append(row)
        for index, part in enumerate(self.parts):
            name = part.get("id", "")
            yield ("part", index), part, f"part {name!r}", by_part.get(name, [])

    def _check_totals(self) -> None:
        """Compare declared totals with the sums, where all points are valid."""
        if any("points" not in row for row in self.criteria):
            return
        for where, owner, name, rows in self._owners_of_totals():
            actual = sum((row["points"] for row in rows if not row.get("bonus")), Decimal(0))
            if owner.get("points", actual) != actual:
                without = " without extra credit" if any(row.get("bonus") for row in rows) else ""
                message = (
                    f"{name} declares {owner['points']} points, but its criteria add up to "
                    f"{actual}{without}"
                )
                self._complain((*where, "points"), message)
