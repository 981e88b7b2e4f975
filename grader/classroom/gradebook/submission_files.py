"""Where a graded submission is, to open it again and quote its files."""

import json
import time
from collections.abc import Mapping
from functools import cached_property
from typing import Any, NamedTuple

from grader.classroom.intake.fingerprint import fingerprint
from grader.classroom.opening import OpenedSubmission, open_class_submission
from grader.errors import InputError
from grader.files.reading import URDF_LIMIT
from grader.grading.rubric import Rubric
from grader.source import Source
from grader.submission.submission import Submission
from grader.submission.urdf import Absent, Urdf


class SubmissionFiles(NamedTuple):
    """Where a submission was when graded: paths below the class `root`, and the fingerprint and digest of the files.

    The fingerprint is empty for files that were modified just before grading, and changes if files are copied. The
    digest is of the contents.
    """

    root: str
    paths: tuple[str, ...]
    names: tuple[str, ...]
    key: str
    fingerprint: str
    digest: str = ""
    max_size: int = URDF_LIMIT  # bytes of a URDF
    attempt: int = 1
    earlier: tuple[str, ...] = ()  # the paths of earlier attempts

    @classmethod
    def of(cls, row: Mapping[str, Any]) -> "SubmissionFiles":
        """Return the files in a row of the view `grade`."""
        paths, names, attempt, earlier = json.loads(row["files"])
        known = row["key"], row["fingerprint"], row["digest"], row["max_size"], attempt, tuple(earlier)
        return cls(row["source"], tuple(paths), tuple(names), *known)

    def open(self) -> OpenedSubmission:
        """Open the submission. Raises InputError."""
        return open_class_submission(self.root, self.paths, self.names, self.key, self.max_size)


class SubmissionSources:
    """Opens a submission when one of its files is first asked for."""

    def __init__(self, files: SubmissionFiles, rubric: Rubric) -> None:
        self._files, self._rubric = files, rubric

    def source(self, path: str) -> Source | None:
        """Return the text of one file; None if it cannot be read or has changed."""
        return self.submission.source(path) if self.submission is not None else None

    @property
    def urdf(self) -> Urdf:
        """The URDF; absent if it cannot be read or has changed."""
        return self.submission.urdf if self.submission is not None else Absent()

    @cached_property
    def submission(self) -> Submission | None:
        """The submission; None if it cannot be read or has changed since it was graded."""
        files = self._files
        found = fingerprint(files.root, files.paths, time.time_ns())
        try:
            opened = files.open()
            is_unchanged = (found and found == files.fingerprint) or opened.digest == files.digest
            return opened.submission(self._rubric) if is_unchanged else None
        except InputError:
            return None
