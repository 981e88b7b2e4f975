"""Submissions with evidence, but without a URDF: their criteria of the URDF are failed, or need manual grading."""

from grader.classroom.gradebook.gradebook import Gradebook
from grader.grading.record import has_evidence_only
from grader.grading.rubric import Rubric


def count_evidence_only(book: Gradebook, rubric: Rubric) -> int:
    """Return how many of the submissions graded with this rubric have pictures or documents, but no URDF."""
    positions = [row.position for row in rubric.criteria if row.check.subject in ("urdf", "robot")]
    query = "SELECT result, statuses FROM grade WHERE verdict = 'graded' AND rubric = ? AND NOT is_gone"
    # Without a URDF no criterion of it passes. Few submissions are like that, so few records are read.
    found = [
        result
        for result, statuses in list(book.rows(query, rubric.sha256))
        if positions and not any(statuses[position] in "p-" for position in positions)
    ]
    return sum(has_evidence_only(book.record(result)[0]) for result in found)
