"""The check of the problems of a submission: of its URDF, of xacro, and of its packages."""

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from typing import Annotated, Any

from grader.base.errors import MissingElement, NotDecided
from grader.base.problems import Problem
from grader.base.text import MAX_NAMED, counted, enumerated
from grader.base.toml_types import Constraint
from grader.lab.checks.check import About, everything
from grader.lab.checks.outcome import Outcome, failed, passed, pending
from grader.lab.submission.submission import Submission
from grader.ros.package.robot_file import Read
from grader.ros.urdf.reader import Reading
from grader.ros.urdf.urdf_problems import UNLISTED
from grader.workspace.rules.problem_kinds import EVERY_KIND
from grader.workspace.rules.rule_table import RULES

_OF_ROBOT = ("URDF", "XACRO")
_OF_PACKAGES = ("PKG", "LCH", "RVZ", "REF")
_GROUPS = _OF_ROBOT + _OF_PACKAGES  # what the codes of these problems begin with
_KINDS = {kind.code: kind for kind in EVERY_KIND if kind.code.startswith(_GROUPS)}
_NAMES = [*_KINDS, *_OF_PACKAGES, *RULES]
_KNOWN = Constraint(
    (
        "codes or rules of problems, such as URDF012 or goal-state (`grader explain CODE` "
        "describes one), or PKG, LCH, RVZ or REF for all codes that begin so"
    ),
    lambda names: set(names) <= set(_NAMES),
    {"items": {"enum": _NAMES}},
)
_Names = Annotated[list[str], _KNOWN]


def without_problems(urdf: Reading, submission: Submission, *, problems: _Names) -> Outcome:
    """The URDF, or the packages, have none of these problems, as `grader inspect` lists them.

    A warning counts as an error does; a note counts only if its code or rule is named. What cannot
    be determined statically needs manual grading.

    Args:
        problems: Codes of problems, such as "URDF051" or "PKG020", names of rules, such as
            "goal-state", and beginnings of codes: "PKG", "LCH", "RVZ" or "REF". A list of codes of
            URDF and xacro needs no package.
    """
    assert isinstance(submission.urdf, Read)  # else there is none that is needed
    reported = [problem for problem in submission.urdf.problems if problem.code in problems]
    certain = [problem for problem in reported if problem.kind.effect != "undetermined"]
    if certain:
        return _fail_with_problems(certain)
    open_ones = [
        problem
        for problem in submission.urdf.problems
        if problem.kind.effect == "undetermined" or problem.kind is UNLISTED
    ]
    if open_ones:
        first = open_ones[0]
        return pending(f"{first.message}; needs manual grading", first.message, first.location)
    if not urdf.robot:
        raise MissingElement(
            "robot", "", message="ROS 2 cannot read the file, so there is no robot"
        )
    return passed(f"the URDF has none of the problems {enumerated(problems, MAX_NAMED)}")


def _packages_without_problems(submission: Submission, *, problems: Sequence[str]) -> Outcome:
    """Return whether the graded packages have none of these problems, nor has the URDF."""
    submission.needed_package()
    packages = submission.lab_packages.values()
    certain = []
    for problem in submission.package_problems():
        is_asked = _is_asked(problem, problems)
        if is_asked and any(package.holds(problem.location.path) for package in packages):
            certain.append(problem)
    if isinstance(submission.urdf, Read):
        of_robot = submission.urdf.problems
        certain += [problem for problem in of_robot if _is_asked(problem, problems)]
    if certain:
        return _fail_with_problems(certain)
    shown = enumerated(problems, MAX_NAMED)
    for reason in _why_open(submission, problems):
        cause = f"cannot determine statically whether there are problems {shown}"
        raise NotDecided(f"{cause}: {reason}", cause)
    return passed(f"the packages have none of the problems {shown}")


def _is_asked(problem: Problem, names: Collection[str]) -> bool:
    """Return whether a problem has one of the codes or rules, or a code that begins with one."""
    if problem.code in names or problem.rule in names:
        return True
    return problem.kind.severity != "note" and problem.code.rstrip("0123456789") in names


def _why_open(submission: Submission, names: Sequence[str]) -> Iterator[str]:
    """Yield why problems of some codes or rules may not be known."""
    from grader.workspace.rules.reading import read_agreement  # late: few rubrics ask for it

    undecided = read_agreement(submission.workspace).undecided
    for rule in RULES.values():
        codes = {rule.name, rule.kind.code}
        if rule.family in undecided and not codes.isdisjoint(names):
            yield undecided[rule.family]
    if any(name.startswith("PKG") for name in names):
        for package in submission.lab_packages.values():
            setup = package.installation
            if setup and setup.doubt is not None:
                yield f"{setup.doubt.reason} (line {setup.doubt.at.line} of {setup.file})"
    if any(name.startswith("LCH") for name in names):
        yield from filter(None, [submission.workspace.launches.unknown_nodes])


def _function_for(arguments: Mapping[str, Any]) -> Callable[..., Outcome]:
    """Return what is called: codes of URDF and xacro need no package."""
    if all(name.startswith(_OF_ROBOT) for name in arguments.get("problems", ())):
        return without_problems
    return _packages_without_problems


# Another text for the same robot may have problems of its own.
ABOUT = {
    "without_problems": About(
        breaks_under=everything, is_of_writing=True, function_for=_function_for
    )
}


def _fail_with_problems(reported: Sequence[Problem]) -> Outcome:
    first = reported[0]
    more = len(reported) - 1
    others = f" (and {counted(more, 'more such problem')})" if more else ""
    outcome = failed(
        f"{first.label}: {first.message}{others}", first.location, problem=first.message
    )
    return outcome._replace(mistake=f"{first.code}: {first.kind.title}")
