"""The rows of a rubric's TOML, checked: every mistake is noted with the path of the key that it is in."""

from collections.abc import Collection, Iterable, Mapping
from datetime import datetime
from decimal import Decimal
from functools import cache
from itertools import islice
from typing import Any

from grader.checks.registry import Check, check_names, find_check
from grader.errors import InputError
from grader.grading.arguments import bind
from grader.grading.toml_lines import Path
from grader.names import did_you_mean

_TEXT, _NUMBER, _TEXTS, _TABLE = "a text", "a number", "a list of texts", "a table"
_TIME = "a date and time with its offset, such as 2026-11-20T23:59:00+01:00"
_RUBRIC = {"id": _TEXT, "title": _TEXT, "reference": _TEXT, "urdf": _TEXT, "package": _TEXT, "points": _NUMBER}
_RUBRIC |= {"answers": _TEXT}
_PART = {"id": _TEXT, "title": _TEXT, "needs": _TEXT, "points": _NUMBER}
_CRITERION = {
    "id": _TEXT,
    "part": _TEXT,
    "about": _TEXT,
    "title": _TEXT,
    "points": _NUMBER,
    "check": _TEXT,
    "with": _TABLE,
    "requires": _TEXTS,
    "feedback": _TEXT,
}
_EVIDENCE = {"id": _TEXT, "part": _TEXT, "title": _TEXT, "names": _TEXTS}
_LATE = {"due": _TIME, "grace_minutes": _NUMBER, "percent_per_day": _NUMBER, "floor_percent": _NUMBER}
_MOST_POINTS = 1_000_000
_MAX_GUESSES = 50  # searches for a similar name in one rubric: each takes its time
_MAX_LISTED = 20  # names in one message
_DECIMALS = 4  # of points: gradebooks keep them as whole numbers of ten-thousandths
_NEEDS = ("urdf", "package", "files")
_OPTIONAL = {"reference", "urdf", "package", "answers", "needs", "about", "with", "requires", "feedback"}
_OPTIONAL |= {"due", "grace_minutes", "floor_percent"}


Bound = tuple[Check, dict[str, Any]]


class Rows:
    """One pass over a parsed rubric. Where `complaints` stays empty, the table holds what a rubric needs.

    `bound` has the check of each criterion with its arguments, in the order of the rows.
    """

    def __init__(self, table: dict[str, Any]) -> None:
        self.table = table
        self.complaints: list[tuple[Path, str]] = []
        self.bound: list[Bound] = []
        self._guesses = _MAX_GUESSES
        self._check_named, self._check_names = cache(find_check), cache(check_names)
        self._keys(
            (),
            table,
            {**_RUBRIC, "part": "tables", "criterion": "tables", "evidence": "tables", "late": _TABLE},
            "rubric",
        )
        parts, rows = self._rows("part"), self._rows("criterion")
        for index, row in enumerate(parts):
            self._keys(("part", index), row, _PART, "part")
            needs = row.get("needs", "urdf")
            if needs not in _NEEDS and isinstance(needs, str):
                self._complain(("part", index, "needs"), f"a part cannot need {needs!r}{_listed(_NEEDS)}")
        self._unique("part", parts)
        self._unique("criterion", rows)
        part_ids, positions = _positions(parts), _positions(rows)
        for index, row in enumerate(rows):
            self._criterion(index, row, part_ids, positions)
        for index, row in enumerate(self._rows("evidence") if "evidence" in table else []):
            self._keys(("evidence", index), row, _EVIDENCE, "piece of evidence")
            self._part(("evidence", index), row, part_ids)
        self._totals(parts, rows)
        if isinstance(table.get("late"), dict):
            self._late(table["late"])

    def _late(self, row: dict[str, Any]) -> None:
        self._keys(("late",), row, _LATE, "late policy")
        for key, most in (("percent_per_day", 100), ("floor_percent", 100), ("grace_minutes", _MOST_POINTS)):
            value = row.get(key, 0)
            if _has_type(value, _NUMBER) and not (Decimal(value).is_finite() and 0 <= value <= most):
                self._complain(("late", key), f"{key} must be a number from 0 to {most}, not {value}")

    def _part(self, where: Path, row: dict[str, Any], parts: Collection[str]) -> None:
        part = row.get("part")
        if isinstance(part, str) and part not in parts:
            self._complain((*where, "part"), f"there is no part {part!r}{self._guess(part, parts) or _listed(parts)}")

    def _criterion(self, index: int, row: dict[str, Any], parts: Collection[str], positions: dict[str, int]) -> None:
        where: Path = ("criterion", index)
        self._keys(where, row, _CRITERION, "criterion")
        self._part(where, row, parts)
        self._requires(index, row, positions)
        name, given = row.get("check"), row.get("with", {})
        check = self._check((*where, "check"), name) if isinstance(name, str) else None
        if check is None or not isinstance(given, dict):
            return
        arguments, faults = bind(check, given)
        for key, fault in faults:
            self._complain((*where, "with", *key), fault)
        self.bound.append((check, arguments))

    def _check(self, where: Path, name: str) -> Check | None:
        try:
            check = self._check_named(name)
        except InputError as error:  # another package's
            self._complain(where, str(error))
            return None
        if check is None:
            guess = self._guess(name, self._check_names()) or "; `grader rubric checks` lists them"
            self._complain(where, f"there is no check {name!r}{guess}")
        return check

    def _requires(self, index: int, row: dict[str, Any], positions: dict[str, int]) -> None:
        required = row.get("requires", [])
        if not isinstance(required, list):
            return
        for name in required:
            if not isinstance(name, str) or positions.get(name, index) < index:
                continue
            if name == row.get("id"):
                message = "requires itself"
            elif name in positions:
                message = f"requires {name!r}, which stands below: a criterion can only require those above it"
            else:
                message = f"requires {name!r}, which does not exist{self._guess(name, positions)}"
            self._complain(("criterion", index, "requires"), message)

    def _guess(self, name: str, known: Iterable[str]) -> str:
        self._guesses -= 1
        return did_you_mean(name, known) if self._guesses >= 0 else ""

    def _rows(self, key: str) -> list[dict[str, Any]]:
        rows = self.table.get(key)
        if isinstance(rows, list) and rows and all(isinstance(row, dict) for row in rows):
            return rows
        need = f"a rubric has at least one [[{key}]]" if key in ("part", "criterion") else f"each {key} is a [[{key}]]"
        self._complain((key,), need)
        return []

    def _keys(self, where: Path, row: dict[str, Any], known: Mapping[str, str], what: str) -> None:
        for key, value in row.items():
            if key not in known:
                hint = self._guess(key, known) or f"; it has: {', '.join(known)}"
                self._complain((*where, key), f"a {what} has no key {key!r}{hint}")
            elif not _has_type(value, known[key]):
                self._complain((*where, key), f"{key} must be {known[key]}, not {_type_name(value, known[key])}")
            elif key == "points" and not (Decimal(value).is_finite() and value >= 0):
                self._complain((*where, key), f"points must be a number of at least 0, not {value}")
            elif key == "points" and value > _MOST_POINTS:
                self._complain((*where, key), f"points must be a number of at most {_MOST_POINTS}")
            elif key == "points" and Decimal(value).scaleb(_DECIMALS) % 1:
                self._complain((*where, key), f"points have at most {_DECIMALS} decimals, not as many as {value}")
            elif key in ("id", "title", "urdf") and not value.strip():
                self._complain((*where, key), f"{key} must not be empty")
            elif key == "id" and (not value.isprintable() or " " in value):
                self._complain((*where, key), f"an id is one printable word, not {value!r}")
            elif key == "urdf" and value.rstrip("/").split("/")[-1] in ("", ".", ".."):
                self._complain((*where, key), f"urdf must be the path of a file, not {value!r}")
            elif key == "answers" and not _is_below(value):
                self._complain((*where, key), f"answers must be a .toml file in the rubric's folder, not {value!r}")
        needed = [key for key in known if key not in _OPTIONAL and (key != "points" or what == "criterion")]
        for key in needed:
            if key not in row and known[key] not in ("tables", _TABLE):
                self._complain(where, f"this {what} has no {key}")

    def _unique(self, key: str, rows: list[dict[str, Any]]) -> None:
        seen: set[str] = set()
        for index, row in enumerate(rows):
            name = row.get("id")
            if isinstance(name, str) and name in seen:
                self._complain((key, index, "id"), f"there is a {key} {name!r} already")
            elif isinstance(name, str):
                seen.add(name)

    def _totals(self, parts: list[dict[str, Any]], rows: list[dict[str, Any]]) -> None:
        """Compare declared totals with the sums, where all the points that they are made of can be read."""
        points = [(row.get("part"), row.get("points")) for row in rows]
        if not all(_is_countable(value) for _, value in points):
            return
        declared: list[tuple[Path, Any, str, list[Any]]] = [
            (("points",), self.table.get("points"), "the rubric", [value for _, value in points])
        ]
        of_part: dict[str, list[Any]] = {}
        for part, value in points:
            if isinstance(part, str):
                of_part.setdefault(part, []).append(value)
        for index, row in enumerate(parts):
            name = row.get("id")
            own = of_part.get(name, []) if isinstance(name, str) else []
            declared.append((("part", index, "points"), row.get("points"), f"part {name!r}", own))
        for where, total, what, values in declared:
            actual = sum(map(Decimal, values), Decimal(0))
            if _has_type(total, _NUMBER) and Decimal(total) != actual:
                self._complain(where, f"{what} declares {total} points, but its criteria add up to {actual}")

    def _complain(self, where: Path, what: str) -> None:
        self.complaints.append((where, what))


def _positions(rows: list[dict[str, Any]]) -> dict[str, int]:
    """Return the position of the first row with each id."""
    positions: dict[str, int] = {}
    for index, row in enumerate(rows):
        if isinstance(row.get("id"), str):
            positions.setdefault(row["id"], index)
    return positions


def _listed(names: Collection[str]) -> str:
    more = f" and {len(names) - _MAX_LISTED} more" if len(names) > _MAX_LISTED else ""
    return f"; there are: {', '.join(islice(names, _MAX_LISTED)) or 'none'}{more}"


def _is_below(path: str) -> bool:
    """Whether a path names a TOML file in the rubric's folder or below, on every system."""
    return path.endswith(".toml") and not set(path) & set("\\:\0") and ".." not in path.split("/") and path[0] != "/"


def _is_countable(value: object) -> bool:
    if not isinstance(value, int | Decimal) or isinstance(value, bool):
        return False
    return Decimal(value).is_finite() and value <= _MOST_POINTS


def _has_type(value: object, wanted: str) -> bool:
    if wanted == _NUMBER:
        return isinstance(value, int | Decimal) and not isinstance(value, bool)
    if wanted == _TEXTS:
        return isinstance(value, list) and all(isinstance(each, str) for each in value)
    if wanted == _TABLE:
        return isinstance(value, dict)
    if wanted == _TIME:
        return isinstance(value, datetime) and value.tzinfo is not None
    return wanted != _TEXT or isinstance(value, str)


def _type_name(value: object, wanted: str) -> str:
    match value:
        case bool():
            return "true or false"
        case str():
            return _TEXT
        case int() | Decimal():
            return _NUMBER
        case list():
            return "a list with other values" if wanted == _TEXTS else "a list"
        case dict():
            return _TABLE
        case _:
            return "a date or time"
