"""The text of a kept hand-in's files for quoting, as long as they are what they were when it was graded."""

import time
from typing import NamedTuple

from grader.classroom.intake.opening import fingerprint, open_submission
from grader.errors import InputError
from grader.grading.rubric import Rubric
from grader.source import Source
from grader.submission.submission import Submission


class SubmissionFiles(NamedTuple):
    """Where a hand-in was when it was graded: below the class folder or archive `root`; what it looked like then."""

    root: str
    paths: tuple[str, ...]
    names: tuple[str, ...]
    key: str
    fingerprint: str


class SubmissionSources:
    """Opens a hand-in when the first of its lines is asked for."""

    def __init__(self, files: SubmissionFiles, rubric: Rubric) -> None:
        self._files, self._rubric = files, rubric
        self._submission: Submission | None = None
        self._is_open = False

    def __call__(self, path: str) -> Source | None:
        """The text of one file; None where it cannot be read, or is another by now."""
        if not self._is_open:
            self._is_open = True
            self._submission = self._open()
        return self._submission.source(path) if self._submission is not None else None

    def _open(self) -> Submission | None:
        root, paths, names, key, kept = self._files
        if not kept or fingerprint(root, paths, time.time_ns()) != kept:
            return None
        try:
            return open_submission(root, paths, names, key).submission(self._rubric)
        except InputError:
            return None
