"""What of a rubric a submission is graded on, and the evidence that is shown beside it."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from grader.errors import InputError
from grader.grading.report import Exhibits
from grader.grading.rubric import Rubric
from grader.submission.submission import Submission
from grader.submission.urdf import Read

if TYPE_CHECKING:
    from grader.documents.evidence import Exhibit

_MOST_PICTURES = 50
_XACRO = "the URDF is xacro: its properties and numbers were worked out, as xacro does before ROS 2 reads it"


def chosen_parts(
    rubric: Rubric, submission: Submission, named: Sequence[str]
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """The parts that are graded, and what to say of those that are not: a URDF alone has no package."""
    for name in named:
        if submission.is_single and rubric.part(name).needs != "urdf":
            raise InputError(f"{name} needs more than a URDF: name the folder or archive that was handed in")
    parts = [rubric.part(name) for name in dict.fromkeys(named)] or list(rubric.parts)
    graded = {part.id for part in parts if part.needs == "urdf" or not submission.is_single}
    chosen = tuple(part.id for part in rubric.parts if part.id in graded)
    left = [part.id for part in parts if part.id not in graded]
    notes: tuple[str, ...] = (_XACRO,) if isinstance(submission.urdf, Read) and submission.urdf.is_expanded else ()
    package, path = submission.package, submission.path
    if package is not None and path is not None and not path.startswith(f"{package.folder}/" if package.folder else ""):
        notes += ("the URDF that is graded stands outside of the package that is graded",)
    if not left:
        return chosen, notes
    alone = f"a single URDF is graded on {_and(chosen)} only: {_and(left)} need the folder or archive it is in"
    return chosen, (*notes, alone)


def _and(names: Sequence[str]) -> str:
    return " and ".join([", ".join(names[:-1]), names[-1]]) if len(names) > 1 else "".join(names) or "nothing"


def exhibits_of(
    rubric: Rubric, submission: Submission, chosen: Sequence[str]
) -> "tuple[tuple[Exhibits, ...], tuple[Exhibit, ...]]":
    """The evidence that the lab asks for, and the other pictures of a submission that has any of either."""
    asked = [each for each in rubric.evidence if each.part in chosen]
    if not asked or submission.is_single:
        return (), ()
    from grader.documents.evidence import describe, find_evidence  # a URDF on its own comes with none

    found = tuple(Exhibits(each, find_evidence(submission.proofs, each.names)) for each in asked)
    shown = {exhibit.path for each in found for exhibit in each.files}
    left = [proof for proof in submission.proofs if proof.file.path not in shown]
    return found, describe(left[:_MOST_PICTURES])
