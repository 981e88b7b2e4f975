"""The evidence in a report: what was found for each piece that the lab asks for."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from grader.grading.report import Exhibits
from grader.grading.rubric import Rubric
from grader.submission.submission import Submission
from grader.text import enumerated

if TYPE_CHECKING:
    from grader.documents.evidence import Exhibit

_MAX_PICTURES = 50
_MAX_UNREAD = 4


def exhibits_of(
    rubric: Rubric, submission: Submission, chosen: Sequence[str]
) -> "tuple[tuple[Exhibits, ...], tuple[Exhibit, ...]]":
    """Return the evidence that the lab asks for, and the other pictures of the submission."""
    wanted = [evidence for evidence in rubric.evidence if evidence.part in chosen]
    if not wanted:
        return (), ()
    from grader.documents.evidence import describe, find_evidence  # a URDF on its own has none

    proofs, documents = submission.proofs, submission.readable_documents
    found = tuple(Exhibits(evidence, *find_evidence(proofs, evidence.names, documents)) for evidence in wanted)
    listed = {exhibit.path for exhibits in found for exhibit in (*exhibits.files, *exhibits.perhaps)}
    others = [proof for proof in submission.proofs if proof.file.path not in listed]
    return found, describe(others[:_MAX_PICTURES])


def not_searched(submission: Submission, exhibits: Sequence[Exhibits]) -> tuple[str, ...]:
    """Return a note on the documents that may have evidence, but were not read."""
    if all(found.files for found in exhibits):
        return ()
    documents = submission.readable_documents
    if documents is None:
        return ()
    from grader.documents.evidence import DOCUMENTS

    unread = documents.named(DOCUMENTS)[1]
    return (f"not searched for evidence: {enumerated(list(map(str, unread)), _MAX_UNREAD)}",) if unread else ()
