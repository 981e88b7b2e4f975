"""The parts of a rubric that a submission is graded on, and the evidence that the report lists."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from grader.errors import InputError
from grader.grading.report import Exhibits
from grader.grading.rubric import Rubric
from grader.submission.submission import Submission
from grader.submission.urdf import Read
from grader.text import enumerated

if TYPE_CHECKING:
    from grader.documents.evidence import Exhibit

_MAX_PICTURES = 50
_EXPANDED = "the URDF is xacro: its properties and expressions were evaluated, as xacro does before ROS 2 reads it"
_ELSEWHERE = "the graded URDF is outside the graded package"


def chosen_parts(
    rubric: Rubric, submission: Submission, named: Sequence[str]
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return the graded parts, and notes for the report: a single URDF is graded only on parts that need no package."""
    for name in named:
        if submission.is_single and rubric.part(name).needs != "urdf":
            raise InputError(f"{name} needs more than a URDF: give the folder or archive that was submitted")
    parts = [rubric.part(name) for name in dict.fromkeys(named)] or list(rubric.parts)
    graded = {part.id for part in parts if part.needs == "urdf" or not submission.is_single}
    chosen = tuple(part.id for part in rubric.parts if part.id in graded)
    skipped = [part.id for part in parts if part.id not in graded]
    notes = [_EXPANDED] if isinstance(submission.urdf, Read) and submission.urdf.is_expanded else []
    package, path = submission.package, submission.path
    if package is not None and path is not None and not path.startswith(f"{package.folder}/" if package.folder else ""):
        notes.append(_ELSEWHERE)
    if skipped:
        only = enumerated(chosen) or "nothing"
        notes.append(
            f"a single URDF is graded on {only} only: {enumerated(skipped)} need the folder or archive it is in"
        )
    return chosen, tuple(notes)


def exhibits_of(
    rubric: Rubric, submission: Submission, chosen: Sequence[str]
) -> "tuple[tuple[Exhibits, ...], tuple[Exhibit, ...]]":
    """Return the evidence that the lab asks for, and the other pictures of the submission."""
    wanted = [evidence for evidence in rubric.evidence if evidence.part in chosen]
    if not wanted or submission.is_single:
        return (), ()
    from grader.documents.evidence import describe, find_evidence  # a URDF on its own has none

    found = tuple(Exhibits(evidence, find_evidence(submission.proofs, evidence.names)) for evidence in wanted)
    listed = {exhibit.path for exhibits in found for exhibit in exhibits.files}
    others = [proof for proof in submission.proofs if proof.file.path not in listed]
    return found, describe(others[:_MAX_PICTURES])
