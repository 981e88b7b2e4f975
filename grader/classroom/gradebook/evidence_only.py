"""Submissions with evidence, but without a URDF or a package: their criteria are failed, or need manual grading."""

import json
from collections import Counter

from grader.classroom.gradebook.gradebook import Gradebook
from grader.grading.record import submission_of
from grader.grading.rubric import Rubric

_QUERY = "SELECT result, statuses, urdf, files FROM grade WHERE verdict = 'graded' AND rubric = ? AND NOT is_gone"


def count_evidence_only(book: Gradebook, rubric: Rubric) -> Counter[str]:
    """Return how many submissions have evidence, but no `URDF`, or one but no `package`, that this rubric grades."""
    needed = {"URDF": ("urdf", "robot"), "package": ("package",)}
    subjects = {row.check.subject for row in rubric.criteria}
    graded = {kind for kind, names in needed.items() if subjects.intersection(names)}
    package = [row.position for row in rubric.criteria if row.check.subject == "package"]
    # A record takes long to read, so those of most classes are not: with a URDF and a package of the lab, or a URDF on its own.
    found = [
        result
        for result, statuses, urdf, files in list(book.rows(_QUERY, rubric.sha256))
        if not urdf or not (any(statuses[at] == "p" for at in package) or _is_single(files))
    ]
    lacking = (submission_of(book.record(result)[0]).lacks[:1] for result in found)
    return Counter(kind for kinds in lacking for kind in kinds if kind in graded)


def _is_single(files: str) -> bool:
    paths = json.loads(files)[0]
    return len(paths) == 1 and paths[0].lower().endswith((".urdf", ".xacro"))
