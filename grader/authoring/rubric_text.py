"""The text of a new rubric, in TOML as a person writes it: its keys, default tolerances, a criterion for each fact."""

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from grader.authoring.fact import THE_PACKAGE, Fact
from grader.grading.toml_rows import assignment, toml_literal
from grader.text import printable

WIDTH = 120  # columns


def toml_lines(key: str, value: Any) -> Iterator[str]:
    """Yield a line that sets a key, or, of a list that is too long for one, a line for each item."""
    line = assignment(key, value)
    if len(line) <= WIDTH or not isinstance(value, list):
        yield line
        return
    yield f"{line.partition(' = ')[0]} = ["
    yield from (f"    {toml_literal(item)}," for item in value)
    yield "]"


# The arguments that all criteria of a check get, with their unit: room for rounding, but not for mistakes.
_METRES, _DEGREES = ({"tolerance": 0.002}, "metres"), ({"tolerance": 1.0}, "degrees")
USUAL: Mapping[str, tuple[Mapping[str, float], str]] = {
    **dict.fromkeys(("shows_box", "shows_cylinder", "shows_sphere"), _METRES),
    "shows_colour": ({"tolerance": 0.01}, "of a channel from 0 to 1"),
    "frame_at": ({"tolerance": 0.002, "angle": 1.0}, "metres, degrees"),
    "centre_at": _METRES,
    **dict.fromkeys(("joint_limits", "joint_axis"), _DEGREES),
    "mass_is": ({"tolerance": 0.001}, "kilograms"),
    "inertia_plausible": ({"tolerance": 2.0}, "percent"),
    **dict.fromkeys(("collision_matches_visual", "collides_as"), _METRES),
    "kinematics_match_reference": ({"samples": 20}, "random positions, besides the ends of each range"),
}
_ROBOT, _PACKAGE = "robot", "package"
_MAX_ID = 60


class Head(NamedTuple):
    """What a rubric says of the lab. `reference` is a path relative to the rubric.

    `package` is empty without one, and so is `schema`, the path of a JSON Schema for editors.
    """

    id: str
    title: str
    reference: str
    urdf: str
    package: str
    schema: str = ""


class Row(NamedTuple):
    """A criterion: a fact that the reference passes, and what the check says of it."""

    fact: Fact
    title: str

    @property
    def is_of_package(self) -> bool:
        """Whether the package is needed for it."""
        return self.fact.about == THE_PACKAGE


def rubric_text(head: Head, rows: Sequence[Row]) -> str:
    """Return a rubric with a criterion for each row; those with one heading follow each other."""
    of_package = sum(row.is_of_package for row in rows)
    lines = [
        *_head(head, len(rows)),
        *_defaults({row.fact.check for row in rows}),
        *_part(_ROBOT, "The robot", "urdf", len(rows) - of_package),
        *(_part(_PACKAGE, "The package", "package", of_package) if of_package else ()),
    ]
    about = ""
    for name, row in _by_id(rows).items():
        if row.fact.about != about:
            about = row.fact.about
            lines += ["", f"# --- {printable(about)} ".ljust(WIDTH, "-")]
        lines += _criterion(name, row)
    return "\n".join(lines) + "\n"


def _by_id(rows: Sequence[Row]) -> dict[str, Row]:
    """Return the rows by ids of what they are about and their checks, such as upper-arm-mass-is."""
    found: dict[str, Row] = {}
    numbers: dict[str, int] = {}  # the last that each name got
    for row in rows:
        name = words = re.sub(r"[\W_]+", "-", row.fact.words.lower()).strip("-")[:_MAX_ID].strip("-")
        while name in found:
            numbers[words] = numbers.get(words, 1) + 1
            name = f"{words}-{numbers[words]}"
        found[name] = row
    return found


def _head(head: Head, points: int) -> Iterator[str]:
    yield from [f"#:schema {head.schema}"] if head.schema else []
    yield from (assignment("id", head.id), assignment("title", head.title))
    yield f"{assignment('reference', head.reference)}  # the solution that must get full marks"
    yield f"{assignment('urdf', head.urdf)}  # where a package keeps the file that is graded"
    yield from (
        [f"{assignment('package', head.package)}  # the name of the package that is graded"] if head.package else []
    )
    yield assignment("points", points)


def _defaults(checks: set[str]) -> Iterator[str]:
    yield from ("", "[defaults]", assignment("part", _ROBOT), assignment("points", 1))
    usual = {name: given for name, given in USUAL.items() if name in checks}
    yield from ("", "[defaults.with]") if usual else ()
    yield from (f"{assignment(name, arguments)}  # {unit}" for name, (arguments, unit) in usual.items())


def _part(name: str, title: str, needs: str, points: int) -> Iterator[str]:
    yield from ("", "[[part]]", assignment("id", name), assignment("title", title))
    yield from (assignment("needs", needs), assignment("points", points))


def _criterion(name: str, row: Row) -> Iterator[str]:
    fact = row.fact
    yield from ("", "[[criterion]]", assignment("id", name))
    yield from [assignment("part", _PACKAGE)] if row.is_of_package else []
    yield from (assignment("about", printable(fact.about)), assignment("title", printable(row.title)))
    yield f"check = {toml_literal(fact.check)}"
    if len(assignment("with", fact.arguments)) <= WIDTH:
        yield from [assignment("with", fact.arguments)] if fact.arguments else []
        return
    yield from ("", "[criterion.with]")
    for key, value in sorted(fact.arguments.items(), key=lambda item: isinstance(item[1], Mapping)):
        is_long = isinstance(value, Mapping) and len(assignment(key, value)) > WIDTH
        yield from ("", f"[criterion.with.{key}]") if is_long else ()
        for inner, item in value.items() if is_long else ((key, value),):
            yield from toml_lines(inner, item)
