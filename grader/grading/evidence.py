"""The evidence in a report: what was found for each piece that the lab asks for."""

from collections.abc import Sequence
from itertools import chain
from typing import TYPE_CHECKING

from grader.checks.manual import evidence_shown
from grader.grading.report import EvidenceResult
from grader.grading.rubric import Evidence, Rubric
from grader.submission.submission import Submission
from grader.text import enumerated

if TYPE_CHECKING:
    from grader.documents.evidence_files import EvidenceFile

_MAX_PICTURES = 50
_MAX_UNREAD = 4


def evidence_of(
    rubric: Rubric, submission: Submission, chosen: Sequence[str]
) -> "tuple[tuple[EvidenceResult, ...], tuple[EvidenceFile, ...]]":
    """Return the evidence that the lab asks for, and the other pictures of the submission."""
    wanted = [evidence for evidence in rubric.evidence if evidence.part in chosen]
    if not wanted:
        return (), ()
    from grader.documents.evidence import find_all_evidence  # a URDF on its own has none
    from grader.documents.evidence_files import as_evidence

    graded = {evidence.id: _graded_names(evidence, rubric) for evidence in wanted}
    # A file that may be meant for several pieces is listed where a criterion lists it, too.
    ordered = sorted(wanted, key=lambda evidence: not graded[evidence.id])
    names = [tuple(dict.fromkeys((*evidence.names, *graded[evidence.id]))) for evidence in ordered]
    found = find_all_evidence(submission.labelled_files, names, submission.readable_documents)
    by_id = {evidence.id: one for evidence, one in zip(ordered, found, strict=True)}
    found_files = tuple(EvidenceResult(evidence, *by_id[evidence.id]) for evidence in wanted)
    listed = {file.path for one in found for file in (*one.files, *one.possible)}
    others = [labelled for labelled in submission.labelled_files if labelled.file.path not in listed]
    return found_files, as_evidence(others[:_MAX_PICTURES])


def _graded_names(evidence: Evidence, rubric: Rubric) -> tuple[str, ...]:
    """Return the names of the criteria about a piece of evidence: a file that counts for a criterion is not missing."""
    shown = (row.arguments["names"] for row in rubric.criteria if row.check.function is evidence_shown)
    return tuple(chain.from_iterable(names for names in shown if set(names) & set(evidence.names)))


def not_searched(submission: Submission, found_files: Sequence[EvidenceResult]) -> tuple[str, ...]:
    """Return a note on the documents that may have evidence, but were not read."""
    if all(found.files for found in found_files):
        return ()
    documents = submission.readable_documents
    if documents is None:
        return ()
    from grader.documents.evidence import DOCUMENTS

    unread = documents.named(DOCUMENTS)[1]
    return (f"not searched for evidence: {enumerated(list(map(str, unread)), _MAX_UNREAD)}",) if unread else ()
