"""The check of names: those that files of the packages use are defined in one of them."""

from collections.abc import Sequence
from typing import Annotated

from grader.base.errors import NotDecided
from grader.base.text import enumerated, first_lines
from grader.base.toml_types import Constraint
from grader.lab.checks.check import About
from grader.lab.checks.outcome import Outcome, failed, passed
from grader.lab.submission.submission import Submission
from grader.ros.package.robot_file import Read
from grader.workspace.rules.rule_table import FAMILIES, Family

ABOUT = {
    "names_agree": About(
        causes={
            "similar": "a name is similar to one that is defined",
            "type": "a value or a topic has another type",
        }
    )
}
_ROBOT = "robot"
_CAUSES = [*FAMILIES, _ROBOT]
_Causes = Annotated[
    list[str],
    Constraint(
        f"families of names, or {_ROBOT}",
        lambda causes: set(causes) <= set(_CAUSES),
        {"items": {"enum": _CAUSES}},
    ),
]
_OF_START = "controller-started"  # the rule of controllers that no spawner starts
_MAX_IN_MESSAGE = 3  # mistakes, and places of each
_Line = tuple[str | int, ...]


def names_agree(
    submission: Submission,
    *,
    of: Family,
    where_started: bool = False,
    not_at: _Causes | None = None,
) -> Outcome:
    """The names that files of the packages use are defined: files, frames, parameters, programs and
    so on.

    A name fails only if everything that could define it was read: one that a package outside of the
    submission may define does not fail. Names that other packages of the submission use do not
    count.

    Args:
        of: What is named: files, frames, controllers, parameters, arguments, programs, topics,
            dependencies, services (and actions) or interfaces (messages, services, actions and
            their fields); or code, of which nothing may certainly stop a node, or keep it from
            working; values (numbers that contradict the robot) or transforms (that are no tree).
        where_started: Whether controllers pass that no spawner starts, for `carried`.
        not_at: Families, or "robot" for errors of the URDF and xacro: a name in a line where one of
            these is wrong as well does not count, for `carried`.
    """
    from grader.workspace.rules.reading import (  # late: few rubrics ask for it
        read_agreement,
        wrong_names,
    )

    submission.needed_package()
    workspace = submission.workspace
    wrong = wrong_names(workspace, of, submission.lab_packages.values())
    if where_started:
        wrong = [mismatch for mismatch in wrong if mismatch.rule.name != _OF_START]
    known_lines = _wrong_lines(submission, not_at or ())
    wrong = [mismatch for mismatch in wrong if mismatch.location[:2] not in known_lines]
    agreement = read_agreement(workspace)
    undecided = agreement.undecided
    if wrong:
        places: dict[str, dict[str, None]] = {}
        for mismatch in wrong:
            text = f"{mismatch.rule.name}: {mismatch.message}"
            places.setdefault(text, {})[mismatch.location.file_and_line] = None
        (first, (_, *also)), *others = places.items()
        texts = [f"{at}: {message}{_also(more)}" for message, (at, *more) in others]
        message = "; ".join([f"{first}{_also(also)}", *first_lines(texts, _MAX_IN_MESSAGE - 1)])
        cause = ""
        if wrong[0].rule.is_of_type:
            cause = "type"
        elif wrong[0].corrections:
            cause = "similar"
        problem = wrong[0].message
        return failed(message, wrong[0].location, problem=problem, mistake=first, cause=cause)
    if of in undecided:
        reason = undecided[of]
        cause = f"cannot determine statically whether the names of {of} agree"
        raise NotDecided(f"{cause}: {reason}", cause)
    count = agreement.counts.get(of)
    words = f" ({count.words})" if count and count.words else ""
    return passed(f"the names of {of} agree{words}")


def _wrong_lines(submission: Submission, families: Sequence[str]) -> set[_Line]:
    """Return the files and lines where names of families, or the robot, are wrong."""
    from grader.workspace.rules.reading import wrong_names  # late: as above

    lines: set[_Line] = set()
    for family in FAMILIES:
        if family in families:
            names = wrong_names(submission.workspace, family, submission.lab_packages.values())
            lines.update(mismatch.location[:2] for mismatch in names)
    if _ROBOT in families and isinstance(submission.urdf, Read):
        for problem in submission.urdf.problems:
            if problem.kind.severity == "error":
                lines.add(problem.location[:2])
    return lines


def _also(places: list[str]) -> str:
    """Return the further places of one mistake, in parentheses; empty without one."""
    if places:
        return f" (also {enumerated(places, _MAX_IN_MESSAGE)})"
    return ""
