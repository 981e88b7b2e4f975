"""Write a rubric from the expectations of a reference.

They are tried on the reference. Those that it passes are written in TOML, as a person would.

Each criterion has the usual tolerances of its check; those about one link follow each other under
its heading.
"""

import re
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from decimal import Decimal
from itertools import chain, cycle, islice
from pathlib import Path
from textwrap import shorten
from typing import Any, NamedTuple

from grader.base.errors import InputError, MissingElement, NotDecided
from grader.base.grouping import StringsByName
from grader.base.text import capitalised, cut, printable
from grader.base.toml_file import assignment, read_toml, toml_literal
from grader.base.toml_types import WrongValue
from grader.lab.authoring.draft_choice import DraftChoice
from grader.lab.authoring.element_expectations import details_apart, element_expectations
from grader.lab.authoring.expectations import (
    CarriedExpectation,
    Expectation,
    Omission,
    Solution,
    robot_expectations,
)
from grader.lab.authoring.package_expectations import (
    measure_expectations,
    name_expectations,
    naming_expectations,
    package_expectations,
    value_expectations,
    words_of_launches,
)
from grader.lab.authoring.recording_expectations import recording_expectations
from grader.lab.checks.outcome import Outcome
from grader.lab.checks.registry import find_check
from grader.lab.grading.subjects import without_selectors
from grader.lab.rubric.rubric import Rubric, read_rubric
from grader.lab.submission.submission import Submission
from grader.ros.known.releases import Release
from grader.ros.recording.recording import Recording
from grader.ros.urdf.shapes import UnknownShape
from grader.workspace.api import has_programs

_WIDTH = 120  # columns


# The arguments that all criteria of a check get, with their unit: room for rounding, but not for
# mistakes.
_METRES = ({"tolerance": 0.002}, "metres")
_DEGREES = ({"tolerance": 1.0}, "degrees")
_USUAL: Mapping[str, tuple[Mapping[str, float], str]] = {
    **dict.fromkeys(("shows_box", "shows_cylinder", "shows_sphere"), _METRES),
    "shows_colour": ({"tolerance": 0.01}, "of a channel from 0 to 1"),
    "frame_at": (
        {"tolerance": 0.002, "angle": 1.0},
        "metres, degrees (180: any orientation); rpy is in radians",
    ),
    "centre_at": _METRES,
    **dict.fromkeys(("joint_limits", "joint_axis"), _DEGREES),
    "mass_is": ({"tolerance": 0.001}, "kilograms"),
    "entry_is": ({"tolerance": 0.001}, "in the number's own unit"),
    "inertia_plausible": ({"tolerance": 2.0}, "percent"),
    "collision_matches_visual": _METRES,
    "collides_as": ({"tolerance": 0.002}, "metres; rpy is in radians"),
    "kinematics_match_reference": (
        {"samples": 20},
        "random positions, besides the ends of each range",
    ),
}
_ROBOT = "robot"
_PACKAGE = "package"
_RECORDING = "recording"
# The titles of the parts, and what they need.
_PARTS = {
    _ROBOT: ("The robot", "urdf"),
    _PACKAGE: ("The packages", "package"),
    _RECORDING: ("The recording", "files"),
}
_WHOLE = 100  # points
_LEAST_OF_MEAN, _MOST_OF_MEAN = 0.5, 2  # of the mean points, for one criterion
_USUAL_MEAN = 2  # points of a criterion, if no total is asked for
_LEAST_MEAN = 1.5  # units of a criterion, in which weights can count
_STEPS = tuple(map(Decimal, ("1", "0.5", "0.25", "0.1", "0.05", "0.01")))  # of points
# The kinds of things that a solution has, which share the points evenly.
_JOINTS = "joints"
_SHAPES = "shapes"
_MASSES = "masses"
_SIMULATION = "simulation"
_BUILDS = "builds"
_LAUNCHES = "launch files"
_RVIZ = "RViz"
_NODES = "nodes"
_NAMES = "names"
_PARAMETERS = "parameters"
_RECORDINGS = "recordings"
_CHECKS_BY_KIND = {
    _SHAPES: "shows_box shows_cylinder shows_sphere shows_mesh shows_colour shows_nothing "
    "centre_at collides_as collision_matches_visual",
    _MASSES: "mass_is inertia_plausible",
    _SIMULATION: "entry_is world_has",
    _BUILDS: "urdf_loads package_found package_type setup_imports build_installs installs_files "
    "without_problems",
    _LAUNCHES: "node_runs starts launch_complete",
    _NODES: "connects publishes_transform looks_up takes_parameters interface_has publishes "
    "serves_action uses_parameter",
    _RVIZ: "rviz_found rviz_fixed_frame rviz_shows_robot rviz_display_on",
    _PARAMETERS: "parameter_is",
    _RECORDINGS: "recording_found recorded_topic drove wheels_agree recorded_frames_agree "
    "recorded_tree",
}
_KIND_BY_CHECK = {
    check: kind for kind, checks in _CHECKS_BY_KIND.items() for check in checks.split()
}
_OF_NODES = ("topics", "services", "interfaces", "code", "transforms")
_OF_CODE = frozenset({"publishes", "subscribes", "serves", "calls", "active"})
_WHEN_CORRECTED = "When the reference is corrected"  # the heading of what is wrong in it
# Checks of what matters most, and of what matters less, or others are about as well.
_HEAVY = (
    "urdf_loads",
    "frame_at",
    "joint_axis",
    "joint_limits",
    "mimics",
    "names_agree",
    "node_runs",
    "parameter_is",
)
_LIGHT = (
    "shows_colour",
    "mass_is",
    "inertia_plausible",
    "collision_matches_visual",
    "collides_as",
    "joint_dynamics",
    "kinematics_match_reference",
    "package_found",
    "package_type",
    "rviz_display_on",
)
_EVERYTHING = DraftChoice()
_MAX_COMMENT = 10_000  # columns
_MAX_VALUES = 20  # of a node, that are written as comments
_MAX_ID = 60
_MAX_TITLE = 100


_Subjects = Mapping[str, Any]  # what checks examine, by the names of their parameters

# More than the largest robots have: criteria cost the square of their number.
_MAX_EXPECTATIONS = 2000
_Rows = Sequence[Expectation]  # criteria
_Lines = Iterator[str]


class Head(NamedTuple):
    """What a rubric says of the lab."""

    id: str
    title: str
    reference: str  # the path of the solution, relative to the rubric
    urdf: str  # its path in the package
    packages: Sequence[str]  # their names
    schema: str = ""  # the path of a JSON Schema for editors
    distro: Release | None = None  # of ROS 2, if the URDF needs a newer one than Jazzy


class RubricDraft(NamedTuple):
    """A rubric that its reference passes, as bytes and loaded, and what it omits."""

    data: bytes
    rubric: Rubric
    omissions: Sequence[Omission]


def draft(
    submission: Submission,
    solution: Solution | None,
    head: Head,
    path: Path,
    choice: DraftChoice = _EVERYTHING,
    recorded: tuple[Recording, str] | None = None,
) -> RubricDraft:
    """Return a rubric for a file at `path`, with a criterion for each expectation.

    Other values are in it as comments. Without a robot it has no `solution`; `recorded` is a
    recording with the name of criteria about it. Raises InputError.
    """
    chosen, details = _chosen_expectations(submission, solution, choice, recorded)
    subjects: dict[str, Any] = {"submission": submission}
    if solution:
        subjects |= {"urdf": solution.reading, "robot": solution.robot, "reference": solution.robot}
    rows_by_expectation = {}
    omissions = []
    values: dict[str, list[Expectation]] = {}
    for expectation in chosen:
        row = expectation if isinstance(expectation, Omission) else _tried(subjects, expectation)
        if isinstance(row, Omission):
            omissions.append(row)
            if row.expectation:
                corrected = row.expectation._replace(title=capitalised(row.expectation.title))
                values.setdefault(_WHEN_CORRECTED, []).append(corrected)
        else:
            arguments = toml_literal([row.args, row.arguments])
            rows_by_expectation[row.check, row.package, arguments] = row
    rows = list(rows_by_expectation.values())
    for detail in details:
        tried = _tried(subjects, detail)
        if isinstance(tried, Expectation):
            values.setdefault(detail.about, []).append(tried)
    if submission.packages and not choice.is_names_only:
        values |= _values(subjects, submission, {row.words for row in rows})
    data = _rubric_text(head, rows, values, choice).encode()
    return RubricDraft(data, read_rubric(data, path), tuple(omissions))


def _chosen_expectations(
    submission: Submission,
    solution: Solution | None,
    choice: DraftChoice,
    recorded: tuple[Recording, str] | None,
) -> tuple[list[Expectation | Omission], list[Expectation]]:
    """Return the expectations of a reference that are chosen, without the names that are free.

    The details that a solution with programs leaves free, and those of a recording, are apart.
    Raises InputError for too many.
    """
    started = list(words_of_launches(submission))
    of_robot: Iterable[Expectation | Omission] = ()
    measured: Iterable[Expectation] = ()
    if solution:
        of_robot = chain(robot_expectations(solution), element_expectations(solution, started))
        if has_programs(submission.workspace):
            of_robot = details_apart(iter(of_robot), solution.robot)
        measured = chain(measure_expectations(solution), naming_expectations(solution))
    of_packages = chain(package_expectations(submission), name_expectations(submission), measured)
    of_recording = recording_expectations(*recorded, solution) if recorded is not None else ()
    chosen: list[Expectation | Omission] = []
    robot = solution.robot if solution else None
    for expectation in islice(chain(of_robot, of_packages, of_recording), _MAX_EXPECTATIONS + 1):
        if isinstance(expectation, Omission):
            chosen.append(expectation)
        elif choice.takes(expectation) and (freed := choice.freed(expectation, robot)):
            chosen.append(freed)
    if len(chosen) > _MAX_EXPECTATIONS:
        raise InputError(
            f"the reference has more than {_MAX_EXPECTATIONS} facts, which is too long for a "
            "rubric: name a smaller one"
        )
    is_free = has_programs(submission.workspace)
    details = [
        expectation
        for expectation in chosen
        if isinstance(expectation, Expectation)
        and expectation.is_detail
        and (is_free or expectation.is_recorded)
    ]
    return [expectation for expectation in chosen if expectation not in details], details


def _values(
    subjects: _Subjects, submission: Submission, known: Collection[str]
) -> Mapping[str, list[Expectation]]:
    """Return the values of parameters that the reference certainly gets, by the names of nodes."""
    rows_by_subject: dict[str, list[Expectation]] = {}
    expectations = (
        expectation
        for expectation in value_expectations(submission)
        if expectation.words not in known
    )
    for expectation in islice(expectations, _MAX_EXPECTATIONS):
        row = _tried(subjects, expectation)
        if isinstance(row, Expectation):
            rows_by_subject.setdefault(row.about, []).append(row)
    return rows_by_subject


def _tried(subjects: _Subjects, expectation: Expectation) -> Expectation | Omission:
    """Return the first of the expectations that the reference passes.

    If it passes none, return what it does not pass, and why.
    """
    reasons = []
    for one in (expectation, *expectation.otherwise):
        try:
            outcome = _outcome(subjects, one)
        except (MissingElement, NotDecided, UnknownShape) as error:
            reasons.append(str(error))
            continue
        except WrongValue as error:
            reasons.append(f"an argument must be {error}")
            continue
        if outcome.status == "passed":
            carried = [carried for carried in one.carried if _holds(subjects, one, carried)]
            title = capitalised(_cut_title(one.title or outcome.message))
            return one._replace(carried=carried, title=title)
        reasons.append(outcome.mistake if outcome.status == "pending" else outcome.message)
    return Omission(expectation.words, reasons[0])


def _cut_title(text: str) -> str:
    """Return a title that is not too long, without a part of a number or word."""
    words = shorten(text, _MAX_TITLE, placeholder=" ...")
    return (
        words if len(text) > _MAX_TITLE and len(words) > _MAX_TITLE // 2 else cut(text, _MAX_TITLE)
    )


def _holds(subjects: _Subjects, expectation: Expectation, carried: CarriedExpectation) -> bool:
    """Return whether the reference passes what counts instead of an expectation."""
    try:
        instead = expectation._replace(check=carried.check, arguments=carried.arguments)
        return _outcome(subjects, instead).status == "passed"
    except (MissingElement, NotDecided, UnknownShape, WrongValue):
        return False


def _outcome(subjects: _Subjects, expectation: Expectation) -> Outcome:
    """Return what a check says of the reference.

    Raise WrongValue for an argument that it does not take.
    """
    check = find_check(expectation.check)
    assert check
    check = check.for_arguments(expectation.arguments)
    _, read = read_toml(f"it = {toml_literal(expectation.arguments)}".encode(), Path())
    given = {}
    for name, value in read["it"].items():
        given[name] = check.parameters[name].type.parse(value)
    if "robot" in subjects:
        given = without_selectors(given, subjects["robot"])
    usual, _ = _USUAL.get(expectation.check, ({}, ""))
    arguments = {}
    for name, value in expectation.args.items():
        arguments[name] = str(value).lower() if isinstance(value, bool) else value
    submission = subjects["submission"]
    if arguments:
        submission = submission.under(arguments)
    if expectation.package:
        submission = submission.with_package(expectation.package)
    known = {**subjects, "submission": submission, "package": submission.package}
    return check.outcome((known[name] for name in check.examined), {**usual, **given})


def _rubric_text(
    head: Head,
    rows: _Rows,
    values: Mapping[str, _Rows],
    choice: DraftChoice,
) -> str:
    """Return a rubric with a criterion for each row; those with one heading follow each other."""
    criteria = sorted(rows, key=lambda row: list(_PARTS).index(_part(row)))
    of_robot = [row for row in rows if _part(row) == _ROBOT]
    points = _points(of_robot, criteria[len(of_robot) :], choice)
    checks = set()
    for row in rows:
        checks.add(row.check)
        checks.update(carried.check for carried in row.carried)
    part = _part(criteria[0])
    usual = Counter(points).most_common(1)[0][0]
    lines = [*_head_lines(head), *_default_lines(part, usual, checks)]
    if any(row.carried for row in rows):
        lines += ["", "# carried: not deducted if only these criteria caused the failure"]
    for name in dict.fromkeys(map(_part, criteria)):
        title, needs = _PARTS[name]
        if name == _PACKAGE and len(head.packages) == 1:
            title = "The package"
        lines += ["", "[[part]]", assignment("id", name), assignment("title", title)]
        lines.append(assignment("needs", needs))
    shown = {node: criteria_of_node[:_MAX_VALUES] for node, criteria_of_node in values.items()}
    named = _with_ids([*criteria, *chain.from_iterable(shown.values())])
    ids = {row.words: name for name, row in named.items()}
    # A criterion refers to no value, which is only a comment.
    of_criteria = {row.words: ids[row.words] for row in criteria}
    layout = _Layout(part, usual, of_criteria)
    about = ""
    for (name, row), worth in zip(named.items(), points, strict=False):
        if row.about != about:
            about = row.about
            lines += ["", f"# --- {printable(about)} ".ljust(_WIDTH, "-")]
        lines += layout.criterion(name, row, worth)
    if shown:
        lines += _value_lines(layout._replace(ids=ids), values)
    return "\n".join(lines) + "\n"


def _points(
    of_robot: _Rows,
    of_package: _Rows,
    choice: DraftChoice,
) -> list[Decimal]:
    """Return the points of criteria, first of those of the robot.

    Those of packages are about things of several kinds, such as joints, builds and nodes: each kind
    has an equal share, in which criteria have the weights of their checks. A robot without a
    package has these weights alone, unless a total is asked for.
    """
    rows = [*of_robot, *of_package]
    weights = [_weight(row, choice) for row in rows]
    is_of_one_kind = choice.has_equal_weights or not of_package
    if is_of_one_kind and choice.total is None:
        return list(map(Decimal, weights))
    kinds = [_ROBOT if is_of_one_kind else _choose_share(row) for row in rows]
    return _shared(kinds, weights, choice.total)


def _part(row: Expectation) -> str:
    """Return the part of the rubric that has what is needed for a criterion."""
    if row.is_recorded:
        return _RECORDING
    return _ROBOT if row.package is None else _PACKAGE


def _choose_share(row: Expectation) -> str:
    """Return the kind of thing that a criterion is about, which has its share of the points."""
    if row.check == "names_agree":
        return _NODES if row.arguments["of"] in _OF_NODES else _NAMES
    if row.check == "node_runs" and not _OF_CODE.isdisjoint(row.arguments):
        return _NODES
    return _KIND_BY_CHECK.get(row.check, _JOINTS)


def _weight(row: Expectation, choice: DraftChoice) -> int:
    """Return how much a criterion counts beside others."""
    is_effort = row.check == "joint_limits" and "lower" not in row.arguments
    if choice.has_equal_weights or is_effort:
        return 1
    if row.check in _HEAVY:
        return 3
    return 1 if row.check in _LIGHT else 2


def _shared(kinds: Sequence[str], weights: Sequence[int], total: int | None) -> list[Decimal]:
    """Return the points of criteria: at least half the mean, and at most twice the mean.

    Half of the points are shared evenly by the criteria, so that one of many joints still costs
    something. The other half is shared evenly by the kinds, in which the weights count.

    Without a total, it is the least multiple of 100 with a mean of two points. With one, points
    have as few decimals as leave most criteria some. Raises InputError for too few.
    """
    count = len(kinds)
    unit = Decimal(1)
    if total is None:
        total = _WHOLE * -(-_USUAL_MEAN * count // _WHOLE)
    else:
        if total / _STEPS[-1] < count:
            raise InputError(f"{count} criteria cannot share {total} points: give more")
        fine = [step for step in _STEPS if total / step >= _LEAST_MEAN * count]
        unit = fine[0] if fine else _STEPS[-1]
    units = int(total / unit)
    least = _LEAST_OF_MEAN * units / count
    counts = Counter(kinds)
    shares = _even_shares(units, list(counts.values()))
    exact = [0.0] * count
    for kind, share in zip(counts, shares, strict=True):
        places = [place for place, name in enumerate(kinds) if name == kind]
        whole = sum(weights[place] for place in places)
        for place in places:
            exact[place] = least + (share - least * len(places)) * weights[place] / whole
    return [number * unit for number in _apportioned(units, exact)]


def _even_shares(units: int, counts: Sequence[int]) -> list[float]:
    """Return how many units kinds have, by the numbers of their criteria."""
    mean = units / sum(counts)
    most = [_MOST_OF_MEAN * mean * count for count in counts]
    fixed = [_LEAST_OF_MEAN * mean * count for count in counts]
    left = (units - sum(fixed)) / len(counts)
    for _ in counts:
        capped = [
            share - part for share, part in zip(most, fixed, strict=True) if share - part < left
        ]
        others = len(counts) - len(capped)
        left = (units - sum(fixed) - sum(capped)) / others if others else left
    return [min(share, part + left) for share, part in zip(most, fixed, strict=True)]


def _apportioned(points: int, weights: Sequence[float]) -> list[int]:
    """Return whole points by weights, at least one for each.

    The rest goes to the largest remainders, of equal ones to the first.
    """
    total = sum(weights)
    exact = [points * weight / total for weight in weights]
    shares = [max(1, int(number)) for number in exact]
    order = sorted(range(len(weights)), key=lambda at: shares[at] - exact[at])
    for at in cycle(order):
        left = points - sum(shares)
        if left == 0:
            break
        if left > 0:
            shares[at] += 1
        elif shares[at] > 1:
            shares[at] -= 1
    return shares


def _value_lines(layout: "_Layout", values: Mapping[str, _Rows]) -> _Lines:
    """Yield comments with criteria for values of parameters, and how many more there are."""
    yield from (
        "",
        "# --- Other values: remove the first # of all lines of one, and give it points ".ljust(
            _WIDTH, "-"
        ),
    )
    for node, rows in values.items():
        for row in rows[:_MAX_VALUES]:
            plain = row._replace(about="")
            lines = layout.criterion(layout.ids[row.words], plain, Decimal(0), _MAX_COMMENT)
            for line in lines:
                yield f"# {line}" if line else ""
        if len(rows) > _MAX_VALUES:
            yield from ("", f"# # {len(rows) - _MAX_VALUES} more of {printable(node)}")


def _with_ids(rows: _Rows) -> dict[str, Expectation]:
    """Return the rows by ids of what they are about and their checks, such as upper-arm-mass-is."""
    rows_by_name = {}
    numbers: dict[str, int] = {}  # the last that each name got
    for row in rows:
        name = words = re.sub(r"[\W_]+", "-", row.words.lower()).strip("-")[:_MAX_ID].strip("-")
        while name in rows_by_name:
            numbers[words] = numbers.get(words, 1) + 1
            name = f"{words}-{numbers[words]}"
        rows_by_name[name] = row
    return rows_by_name


def _head_lines(head: Head) -> _Lines:
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
        yield (
            f"{assignment('packages', list(head.packages))}  # the names of the packages that "
            "are graded"
        )
    if head.distro is not None:
        yield f"{assignment('distro', head.distro)}  # the release of ROS 2, which reads the URDF"


def _default_lines(part: str, points: Decimal, checks: set[str]) -> _Lines:
    yield from ("", "[defaults]", assignment("part", part), assignment("points", points))
    usual = {name: given for name, given in _USUAL.items() if name in checks}
    if usual:
        yield from ("", "[defaults.with]")
    yield from (
        f"{assignment(name, arguments)}  # {unit}" for name, (arguments, unit) in usual.items()
    )


class _Layout(NamedTuple):
    """How criteria are written: what they need not say, and the ids of others by their words."""

    part: str
    points: Decimal
    ids: StringsByName

    def criterion(
        self, name: str, row: Expectation, points: Decimal, width: int = _WIDTH
    ) -> _Lines:
        """Yield the lines of a criterion."""
        yield ""
        if row.check == "frame_at" and "rpy" in row.arguments:
            yield (
                "# The frame itself has to be rotated, as in the solution, and not only its shapes."
            )
            yield "# If any orientation is correct, replace rpy by angle = 180."
        yield from ("[[criterion]]", assignment("id", name))
        if _part(row) != self.part:
            yield assignment("part", _part(row))
        if row.package:
            yield assignment("package", row.package)
        if row.about:
            yield assignment("about", printable(row.about))
        if points != self.points:
            yield assignment("points", points)
        yield assignment("title", printable(row.title))
        yield f"check = {toml_literal(row.check)}"
        if row.args:
            yield assignment("args", row.args)
        tables = list(self._carried(row))
        is_line = len(tables) == 1 and len(assignment("carried", tables[0])) <= width
        if is_line:
            yield assignment("carried", tables[0])
        yield from _with_lines("criterion", row.arguments, width)
        for table in () if is_line else tables:
            yield from ("", "[[criterion.carried]]", *_toml_lines("from", table["from"]))
            yield assignment("check", table["check"])
            yield from _with_lines("criterion.carried", table["with"])

    def _carried(self, expectation: Expectation) -> Iterator[Mapping[str, Any]]:
        """Yield what counts instead of an expectation, and after which mistakes.

        It yields nothing if no criteria are about these.
        """
        for one in expectation.carried:
            causes = [self.ids[words] for words in dict.fromkeys(one.causes) if words in self.ids]
            if causes:
                yield {"from": causes, "check": one.check, "with": one.arguments}


def _with_lines(table: str, arguments: Mapping[str, Any], width: int = _WIDTH) -> _Lines:
    """Yield the arguments of a check in one line, or in a table below the others."""
    if len(assignment("with", arguments)) <= width:
        if arguments:
            yield assignment("with", arguments)
        return
    yield from ("", f"[{table}.with]")
    tables = {}
    for key, value in arguments.items():
        if isinstance(value, Mapping) and len(assignment(key, value)) > _WIDTH:
            tables[key] = value
        else:
            yield from _toml_lines(key, value)
    for key, value in tables.items():
        yield from ("", f"[{table}.with.{key}]")
        for inner, item in value.items():
            yield from _toml_lines(inner, item)


def _toml_lines(key: str, value: Any) -> _Lines:
    """Yield a line that sets a key, or, of a list that is too long for one, lines of items."""
    line = assignment(key, value)
    if len(line) <= _WIDTH or not isinstance(value, list):
        yield line
        return
    yield f"{line.partition(' = ')[0]} = ["
    row = ""
    for item in value:
        text = f"{toml_literal(item)},"
        if row and len(f"{row} {text}") > _WIDTH:
            yield row
            row = ""
        row = f"{row} {text}" if row else f"    {text}"
    yield from (row, "]")
