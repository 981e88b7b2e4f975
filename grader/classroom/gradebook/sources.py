"""Read the source files of a graded submission for quoting, as long as they have not changed since."""

import time
from functools import cached_property
from typing import NamedTuple

from grader.classroom.intake.fingerprint import fingerprint
from grader.classroom.intake.opening import open_submission
from grader.errors import InputError
from grader.grading.rubric import Rubric
from grader.source import Source
from grader.submission.submission import Submission


class SubmissionFiles(NamedTuple):
    """The location of a submission when it was graded: paths below the class `root`, and the fingerprint of the files."""

    root: str
    paths: tuple[str, ...]
    names: tuple[str, ...]
    key: str
    fingerprint: str


class SubmissionSources:
    """Opens a submission when one of its files is first asked for."""

    def __init__(self, files: SubmissionFiles, rubric: Rubric) -> None:
        self._files, self._rubric = files, rubric

    def __call__(self, path: str) -> Source | None:
        """Return the text of one file; None if it cannot be read or has changed."""
        return self._submission.source(path) if self._submission is not None else None

    @cached_property
    def _submission(self) -> Submission | None:
        root, paths, names, key, stored = self._files
        if not stored or fingerprint(root, paths, time.time_ns()) != stored:
            return None
        try:
            return open_submission(root, paths, names, key).submission(self._rubric)
        except InputError:
            return None
