"""Grade a submission.

A grading has the parts that are graded, the decided criteria, the evidence, and the notes of the
report.
"""

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from decimal import Decimal
from itertools import chain
from typing import TYPE_CHECKING

from grader.base.errors import InputError, MissingElement, NotDecided
from grader.base.grouping import Strings
from grader.base.names import closest
from grader.base.problems import Problem, in_order
from grader.base.slips import Slip
from grader.base.text import counted_points, enumerated, quoted
from grader.lab.checks.manual import MANUAL_CHECKS, evidence_shown
from grader.lab.grading.deciding import another_robot, decide
from grader.lab.grading.report import EvidenceResult, Meant, Report, Result, without_gifts
from grader.lab.rubric.criterion import Evidence
from grader.lab.rubric.rubric import Rubric
from grader.lab.submission.submission import Submission
from grader.ros.package.mesh_files import mesh_problems
from grader.ros.package.robot_file import Read
from grader.ros.python.budget import Budget
from grader.ros.urdf.kinematics import Configuration

if TYPE_CHECKING:
    from grader.lab.documents.evidence import EvidenceFile
    from grader.ros.urdf.conventions import Convention

_NOT_EXPANDED = (
    "the URDF is xacro, but is loaded without xacro; everything but its loading is graded on "
    "its expansion"
)
_MAX_PICTURES = 50
_MAX_UNREAD = 4
_OF_COLOUR_OR_SHAPE = {"shows_box", "shows_cylinder", "shows_sphere", "shows_colour", "shows_grey"}
_MIN_OF_CONVENTION = 2  # criteria that a convention decides


def grade(
    rubric: Rubric,
    submission: Submission,
    parts: Sequence[str] = (),
    *,
    is_one_of_class: bool = False,
    is_explained: bool = True,
) -> Report:
    """Return the report on a submission for all parts of the rubric, or the named ones.

    Raises InputError for others.

    A single URDF is graded only on parts that need no more, unless it `is_one_of_class`: a class is
    graded on the same parts. Unless it `is_explained`, no note says what its failures have in
    common, or what hides the base.
    """
    is_whole = is_one_of_class or not submission.is_single
    chosen, notes = _choose_parts(rubric, submission, parts, is_whole=is_whole)
    another = another_robot(rubric, submission.robot)
    wanted = {criterion.id for criterion in rubric.criteria if criterion.part in chosen}
    results = tuple(decide(rubric, submission, wanted))
    meant = None
    if any(map(_may_be_explained, results)):
        slips = _list_slips(submission)
        if slips:
            from grader.lab.grading.slips import judge_as_meant  # late: many submissions have none

            results, meant = judge_as_meant(rubric, submission, slips, results)
    robot_owner = submission if not meant else meant.submission
    if any(result.is_lost for result in results):
        from grader.lab.grading.not_known import judge_known  # late: few elements are dropped

        paying = {paid.payer for paid in meant.paid} if meant else ()
        results = tuple(judge_known(rubric, robot_owner, results, wanted, paying))
        if meant:  # hints begin with what it has
            known = judge_known(rubric, robot_owner, meant.results, wanted)
            meant = meant._replace(results=tuple(known))
    results = without_gifts(results, submission)
    problems = _find_problems(rubric, submission, chosen, meant)
    evidence, other_pictures = _find_evidence(rubric, submission, chosen if is_whole else ())
    notes.append(_note_on_unread(submission, evidence))
    by_convention: frozenset[str] = frozenset()
    if is_explained:
        notes.append(_note_on_other_package(rubric, submission))
        notes.append(_note_on_hidden_base(rubric, submission))
        note, by_convention = _explain_by_convention(rubric, robot_owner, results)
        notes.append(note)
    if (
        submission.is_costly
        and rubric.hints != "none"
        and any(result.is_lost for result in results)
    ):
        notes.append("no hints were searched, because reading this robot takes too much work")
    return Report(
        submission=submission,
        rubric=rubric,
        parts=chosen,
        results=results,
        problems=problems,
        evidence=evidence,
        other_pictures=other_pictures,
        notes=tuple(filter(None, notes)),
        another_robot=another.mistake if another else "",
        by_convention=by_convention,
        meant=meant,
    )


def _may_be_explained(result: Result) -> bool:
    """Return whether a slip may explain that a criterion has not passed."""
    is_manual = result.criterion.check.function in MANUAL_CHECKS
    return result.is_lost or (result.is_open and not is_manual)


def _list_slips(submission: Submission) -> list[Slip]:
    """Return the slips in the files of a submission that may explain points that are not given."""
    if submission.is_costly:
        return []
    slips = []
    if isinstance(submission.urdf, Read):
        # Late: robots that are right have none.
        from grader.ros.package.robot_readings import RobotReadings

        readings = RobotReadings(submission.urdf, submission.renewed().surroundings(Budget()))
        slips = [*readings.find_slips(), *submission.urdf.slips]
    packages = [submission.package, *submission.lab_packages.values()]
    for package in dict.fromkeys(filter(None, packages)):
        from grader.ros.nodes.python.package_slips import (
            package_slips,  # late: many have no package
        )

        slips += package_slips(package)
    return slips


def _find_problems(
    rubric: Rubric, submission: Submission, chosen: Sequence[str], meant: Meant | None
) -> tuple[Problem, ...]:
    """Return the problems of the URDF and, where a part needs it, of the package."""
    problems: tuple[Problem, ...] = ()
    if isinstance(submission.urdf, Read):
        meshes = mesh_problems(submission.urdf, submission.packages, submission.tree)
        problems = in_order((*submission.urdf.problems, *meshes))
    if meant:
        from grader.lab.grading.slips import problems_as_meant  # late, as above

        problems = in_order(problems_as_meant(problems, meant))
    if submission.package and any(rubric.part(part).needs == "package" for part in chosen):
        # Late: a URDF on its own needs none of what reads a package.
        from grader.ros.package.found_problems import package_problems

        problems += package_problems(submission.package)
    return problems


def _choose_parts(
    rubric: Rubric, submission: Submission, named: Sequence[str], *, is_whole: bool
) -> tuple[Strings, list[str]]:
    """Return the graded parts, and notes for the report.

    What is not whole is graded only on parts that need a URDF.
    """
    for name in named:
        if rubric.part(name).needs != "urdf" and not is_whole:
            raise InputError(
                f"{name} needs more than a URDF: give the folder or archive that was submitted"
            )
    parts = [part for part in rubric.parts if not named or part.id in named]
    chosen = tuple(part.id for part in parts if part.needs == "urdf" or is_whole)
    notes = [*submission.notes, *_notes_on_xacro(submission)]
    if _is_outside_of_package(submission):
        notes.append("the graded URDF is outside the graded package")
    skipped = [part.id for part in parts if part.id not in chosen]
    if skipped:
        notes.append(_note_on_skipped(chosen, skipped))
    return chosen, notes


def _note_on_skipped(chosen: Sequence[str], skipped: Sequence[str]) -> str:
    """Return a note on parts that are not graded because they need more than a URDF."""
    only = enumerated(chosen) or "nothing"
    verb = "need" if len(skipped) > 1 else "needs"
    return f"only {only} is graded: {enumerated(skipped)} {verb} the whole folder"


def _is_outside_of_package(submission: Submission) -> bool:
    """Return whether the graded URDF is not in the folder of the graded package."""
    package = submission.package
    path = submission.path
    if not package or path is None:
        return False
    return not path.startswith(f"{package.folder}/" if package.folder else "")


def _find_evidence(
    rubric: Rubric, submission: Submission, chosen: Sequence[str]
) -> "tuple[tuple[EvidenceResult, ...], tuple[EvidenceFile, ...]]":
    """Return the evidence that the lab asks for, and the other pictures.

    Neither the lab nor a criterion names these.
    """
    wanted = [evidence for evidence in rubric.evidence if evidence.part in chosen]
    criteria = [row for row in rubric.criteria if row.part in chosen]
    manual = [row for row in criteria if row.check.function in MANUAL_CHECKS]
    if not (wanted or manual):
        return (), ()
    from grader.lab.documents.evidence import as_evidence, find_evidence

    labelled_files = submission.labelled_files
    results = []
    named_files = []
    known: set[str] = set()  # names of evidence that was searched
    for evidence in wanted:
        names = tuple(dict.fromkeys((*evidence.names, *_names_in_criteria(evidence, rubric))))
        files = find_evidence(labelled_files, names, submission.readable_documents)
        results.append(EvidenceResult(evidence, *files))
        known.update(names)
        named_files += [*files.files, *files.possible]
    for row in manual:
        if row.check.function is evidence_shown and known.isdisjoint(row.arguments["names"]):
            names = row.arguments["names"]
            files = find_evidence(labelled_files, names, submission.readable_documents)
            named_files += [*files.files, *files.possible]
    listed = {file.path for file in named_files}
    others = [labelled for labelled in labelled_files if labelled.file.path not in listed]
    return tuple(results), as_evidence(others[:_MAX_PICTURES])


def _names_in_criteria(evidence: Evidence, rubric: Rubric) -> Strings:
    """Return the names of the criteria about a piece of evidence.

    A file that counts for a criterion is not missing.
    """
    shown = (
        row.arguments["names"] for row in rubric.criteria if row.check.function is evidence_shown
    )
    return tuple(chain.from_iterable(names for names in shown if set(names) & set(evidence.names)))


def _note_on_unread(submission: Submission, evidence: Sequence[EvidenceResult]) -> str:
    """Return a note on the documents that may have evidence, but were not read.

    It is empty if there are none.
    """
    if all(result.files for result in evidence) or not (documents := submission.readable_documents):
        return ""
    from grader.lab.documents.evidence import DOCUMENTS

    unread = documents.named(DOCUMENTS)[1]
    if unread:
        return f"not searched for evidence: {enumerated(map(str, unread), _MAX_UNREAD)}"
    return ""


def _note_on_other_package(rubric: Rubric, submission: Submission) -> str:
    """Return a note on a package that is not that of the lab, nor a misspelt one; else nothing."""
    name = submission.package.name if submission.package else ""
    wanted = list(filter(None, rubric.lab.package_names))
    if not name or not wanted or name in wanted or closest(name, wanted):
        return ""
    names = enumerated(map(repr, wanted))
    return f"this is the package {name!r}; the rubric {rubric.id} is for {names}"


def _note_on_hidden_base(rubric: Rubric, submission: Submission) -> str:
    """Return a note on a link that hides all that the base shows; empty without one.

    The points stay: a part may be there to protect another one.
    """
    is_asked = any(
        row.check.name in _OF_COLOUR_OR_SHAPE and row.arguments["link"] == rubric.base
        for row in rubric.criteria
    )
    if not submission.robot or not is_asked:
        return ""
    from grader.lab.checks.visuals import hiding_link  # late: it is loaded with the criteria

    hiding = ""
    with suppress(MissingElement, NotDecided):
        hiding = hiding_link(Configuration(submission.robot), rubric.base)
    if not hiding:
        return ""
    return f"{quoted(hiding)} hides all that {quoted(rubric.base)} shows: look at the robot"


def _explain_by_convention(
    rubric: Rubric, submission: Submission, results: Sequence[Result]
) -> tuple[str, frozenset[str]]:
    """Return a note on frames of the whole robot that are rotated or moved alike.

    Also return the criteria that it explains.

    Both are empty if there is nothing to explain. The points stay: the lab says where its frames
    are. The note says that they are lost by one decision, not by many mistakes.
    """
    lost = set()
    passed = set()
    decided = set()
    for result in results:
        name = result.criterion.id
        check = result.criterion.check
        if check.subject == "robot" and result.is_lost:
            lost.add(name)
        if check.is_of_robot:
            decided.add(name)
            if result.outcome.status == "passed":
                passed.add(name)
    convention = _find_convention(rubric, submission) if len(lost) >= _MIN_OF_CONVENTION else None
    if not convention or not isinstance(submission.urdf, Read):
        return "", frozenset()
    reading = submission.urdf.reading._replace(robot=convention.robot)
    other = replace(submission, urdf=submission.urdf._replace(reading=reading))
    passed_after = {}
    for result in decide(rubric, other, decided):
        if result.outcome.status == "passed":
            passed_after[result.criterion.id] = result.criterion.points
    gained = frozenset(lost & passed_after.keys())
    if len(gained) < _MIN_OF_CONVENTION or not passed <= passed_after.keys():
        return "", frozenset()
    points = counted_points(sum((passed_after[name] for name in gained), Decimal(0)))
    decision = f"one decision, {points}"
    return f"everything is {convention.description} relative to the handout: {decision}", gained


def _find_convention(rubric: Rubric, submission: Submission) -> "Convention | None":
    """Return how all frames of a robot are turned or moved, compared with the reference."""
    robot = submission.robot
    if not robot or not rubric.solution:
        return None
    from grader.ros.urdf.conventions import find_convention  # late: most robots lose few points

    with suppress(InputError):
        return find_convention(Configuration(robot), rubric.solution.robot, rubric.base)
    return None


def _notes_on_xacro(submission: Submission) -> list[str]:
    if not isinstance(submission.urdf, Read) or not submission.urdf.is_expanded:
        return []
    return [
        "the URDF is xacro: it was expanded, as xacro does before ROS 2 reads it"
        if not submission.urdf.as_it_stands
        else _NOT_EXPANDED
    ]
