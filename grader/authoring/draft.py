"""Write a rubric: try the facts of a reference on it, and write those that it passes in TOML, as a person would.

Each criterion has the usual tolerances of its check; those about one link follow each other under its heading.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from itertools import chain, islice
from pathlib import Path
from typing import Any, NamedTuple

from grader.authoring.facts import (
    Fact,
    Omission,
    Solution,
    element_facts,
    measure_facts,
    name_facts,
    package_facts,
    robot_facts,
)
from grader.checks.outcome import Outcome
from grader.checks.registry import find_check
from grader.checks.toml_types import WrongValue
from grader.errors import InputError, MissingElement, NotDecided
from grader.grading.rubric import Rubric, read_rubric
from grader.grading.toml_file import assignment, read_toml, toml_literal
from grader.robot.shapes import UnknownShape
from grader.submission.submission import Submission
from grader.text import capitalised, printable

_WIDTH = 120  # columns


# The arguments that all criteria of a check get, with their unit: room for rounding, but not for mistakes.
_METRES, _DEGREES = ({"tolerance": 0.002}, "metres"), ({"tolerance": 1.0}, "degrees")
_USUAL: Mapping[str, tuple[Mapping[str, float], str]] = {
    **dict.fromkeys(("shows_box", "shows_cylinder", "shows_sphere"), _METRES),
    "shows_colour": ({"tolerance": 0.01}, "of a channel from 0 to 1"),
    "frame_at": ({"tolerance": 0.002, "angle": 1.0}, "metres, degrees; rpy is in radians"),
    "centre_at": _METRES,
    **dict.fromkeys(("joint_limits", "joint_axis"), _DEGREES),
    "mass_is": ({"tolerance": 0.001}, "kilograms"),
    "inertia_plausible": ({"tolerance": 2.0}, "percent"),
    "collision_matches_visual": _METRES,
    "collides_as": ({"tolerance": 0.002}, "metres; rpy is in radians"),
    "kinematics_match_reference": ({"samples": 20}, "random positions, besides the ends of each range"),
}
_ROBOT, _PACKAGE = "robot", "package"
_MAX_ID = 60


_Subjects = Mapping[str, Any]  # what checks examine, by the names of their parameters

_MAX_FACTS = 2000  # more than the largest robots have; criteria cost the square of their number


class Head(NamedTuple):
    """What a rubric says of the lab."""

    id: str
    title: str
    reference: str  # the path of the solution, relative to the rubric
    urdf: str  # its path in the package
    packages: tuple[str, ...]  # their names
    schema: str = ""  # the path of a JSON Schema for editors


class _DraftCriterion(NamedTuple):
    """A criterion of a new rubric: a fact that the reference passes, and what the check says of it."""

    fact: Fact
    title: str

    @property
    def is_of_package(self) -> bool:
        """Whether the package is needed for it."""
        return self.fact.package is not None


class RubricDraft(NamedTuple):
    """A rubric that its reference passes, as bytes and loaded, and what it omits."""

    data: bytes
    rubric: Rubric
    omissions: tuple[Omission, ...]


def draft(submission: Submission, solution: Solution | None, head: Head, path: Path) -> RubricDraft:
    """Return a rubric for a file at `path` with a criterion for each fact that a check can test.

    Without a robot it has no `solution`. Raises InputError.
    """
    of_robot = chain(robot_facts(solution), element_facts(solution)) if solution is not None else ()
    measured = measure_facts(solution) if solution is not None else ()
    of_packages = chain(package_facts(submission), name_facts(submission), measured)
    found = list(islice(chain(of_robot, of_packages), _MAX_FACTS + 1))
    if len(found) > _MAX_FACTS:
        raise InputError(
            f"the reference has more than {_MAX_FACTS} facts, which is too long for a rubric: name a smaller one"
        )
    subjects: dict[str, Any] = {"submission": submission}
    if solution is not None:
        subjects |= {"urdf": solution.reading, "robot": solution.robot, "reference": solution.robot}
    tried = [it if isinstance(it, Omission) else _tried(subjects, it) for it in found]
    facts = ((it.fact, it) for it in tried if isinstance(it, _DraftCriterion))
    rows = {(fact.check, fact.package, toml_literal([fact.args, fact.arguments])): row for fact, row in facts}
    data = _rubric_text(head, [*rows.values()]).encode()
    return RubricDraft(data, read_rubric(data, path), tuple(it for it in tried if isinstance(it, Omission)))


def _tried(subjects: _Subjects, fact: Fact) -> _DraftCriterion | Omission:
    """Return the first of the facts that the reference passes; or what it does not pass, and why."""
    reasons = []
    for one in (fact, *fact.otherwise):
        try:
            outcome = _outcome(subjects, one)
        except (MissingElement, NotDecided, UnknownShape) as error:
            reasons.append(str(error))
            continue
        except WrongValue as error:
            reasons.append(f"an argument must be {error}")
            continue
        if outcome.status == "passed":
            return _DraftCriterion(one, capitalised(one.title or outcome.message))
        reasons.append(outcome.mistake if outcome.status == "pending" else outcome.message)
    return Omission(fact.words, reasons[0])


def _outcome(subjects: _Subjects, fact: Fact) -> Outcome:
    """Return what a check says of the reference; raise WrongValue for an argument that it does not take."""
    check = find_check(fact.check)
    assert check is not None
    _, read = read_toml(f"it = {toml_literal(fact.arguments)}".encode(), Path())
    given = {name: check.parameters[name].type.parse(value) for name, value in read["it"].items()}
    usual, _ = _USUAL.get(fact.check, ({}, ""))
    arguments = {name: str(it).lower() if isinstance(it, bool) else it for name, it in fact.args.items()}
    submission = subjects["submission"].under(arguments) if arguments else subjects["submission"]
    if fact.package:
        submission = submission.with_package(fact.package)
    known = {**subjects, "submission": submission, "package": submission.package}
    return check.outcome((known[name] for name in check.examined), {**usual, **given})


def _rubric_text(head: Head, rows: Sequence[_DraftCriterion]) -> str:
    """Return a rubric with a criterion for each row; those with one heading follow each other."""
    of_package = sum(row.is_of_package for row in rows)
    part = _ROBOT if of_package < len(rows) else _PACKAGE
    lines = [*_head_lines(head, len(rows)), *_default_lines(part, {row.fact.check for row in rows})]
    if part == _ROBOT:
        lines += _part_lines(_ROBOT, "The robot", "urdf", len(rows) - of_package)
    if of_package:
        title = "The package" if len(head.packages) == 1 else "The packages"
        lines += _part_lines(_PACKAGE, title, "package", of_package)
    about, named = "", _with_ids(rows)
    names = {row.fact.words: name for name, row in named.items()}
    for name, row in named.items():
        if row.fact.about != about:
            about = row.fact.about
            lines += ["", f"# --- {printable(about)} ".ljust(_WIDTH, "-")]
        causes = [names[words] for words in row.fact.causes if words in names]
        lines += _criterion_lines(name, row, part, causes)
    return "\n".join(lines) + "\n"


def _with_ids(rows: Sequence[_DraftCriterion]) -> dict[str, _DraftCriterion]:
    """Return the rows by ids of what they are about and their checks, such as upper-arm-mass-is."""
    found: dict[str, _DraftCriterion] = {}
    numbers: dict[str, int] = {}  # the last that each name got
    for row in rows:
        name = words = re.sub(r"[\W_]+", "-", row.fact.words.lower()).strip("-")[:_MAX_ID].strip("-")
        while name in found:
            numbers[words] = numbers.get(words, 1) + 1
            name = f"{words}-{numbers[words]}"
        found[name] = row
    return found


def _head_lines(head: Head, points: int) -> Iterator[str]:
    if head.schema:
        yield f"#:schema {head.schema}"
    yield assignment("id", head.id)
    yield assignment("title", head.title)
    yield f"{assignment('reference', head.reference)}  # the solution that must get full marks"
    if head.urdf:
        yield f"{assignment('urdf', head.urdf)}  # where a package keeps the file that is graded"
    if len(head.packages) == 1:
        yield f"{assignment('package', head.packages[0])}  # the name of the package that is graded"
    elif head.packages:
        yield f"{assignment('packages', list(head.packages))}  # the names of the packages that are graded"
    yield assignment("points", points)


def _default_lines(part: str, checks: set[str]) -> Iterator[str]:
    yield from ("", "[defaults]", assignment("part", part), assignment("points", 1))
    usual = {name: given for name, given in _USUAL.items() if name in checks}
    if usual:
        yield from ("", "[defaults.with]")
    yield from (f"{assignment(name, arguments)}  # {unit}" for name, (arguments, unit) in usual.items())


def _part_lines(name: str, title: str, needs: str, points: int) -> Iterator[str]:
    yield from ("", "[[part]]", assignment("id", name), assignment("title", title))
    yield from (assignment("needs", needs), assignment("points", points))


def _criterion_lines(name: str, row: _DraftCriterion, part: str, causes: list[str]) -> Iterator[str]:
    fact = row.fact
    yield from ("", "[[criterion]]", assignment("id", name))
    if row.is_of_package and part == _ROBOT:
        yield assignment("part", _PACKAGE)
    if fact.package:
        yield assignment("package", fact.package)
    yield assignment("about", printable(fact.about))
    yield assignment("title", printable(row.title))
    yield f"check = {toml_literal(fact.check)}"
    if fact.args:
        yield assignment("args", fact.args)
    check, given = fact.instead
    carried = {"from": causes, "check": check, "with": given}
    is_line = len(assignment("carried", carried)) <= _WIDTH
    if causes and is_line:
        yield assignment("carried", carried)
    is_short = len(assignment("with", fact.arguments)) <= _WIDTH
    if is_short and fact.arguments:
        yield assignment("with", fact.arguments)
    elif fact.arguments:
        yield from ("", "[criterion.with]")
        yield from _table_lines("criterion.with", fact.arguments)
    if causes and not is_line:
        yield from ("", "[criterion.carried]", *_toml_lines("from", causes))
        yield from (assignment("check", check), assignment("with", given))


def _table_lines(table: str, values: Mapping[str, Any]) -> Iterator[str]:
    for key, value in sorted(values.items(), key=lambda item: isinstance(item[1], Mapping)):
        if not isinstance(value, Mapping) or len(assignment(key, value)) <= _WIDTH:
            yield from _toml_lines(key, value)
            continue
        yield from ("", f"[{table}.{key}]")
        for inner, item in value.items():
            yield from _toml_lines(inner, item)


def _toml_lines(key: str, value: Any) -> Iterator[str]:
    """Yield a line that sets a key, or, of a list that is too long for one, a line for each item."""
    line = assignment(key, value)
    if len(line) <= _WIDTH or not isinstance(value, list):
        yield line
        return
    yield f"{line.partition(' = ')[0]} = ["
    yield from (f"    {toml_literal(item)}," for item in value)
    yield "]"
