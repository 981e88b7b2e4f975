"""The gradebook: one SQLite file with the results of the checks and the manual marks, which no run changes."""

import sqlite3
import zlib
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path
from typing import NamedTuple

from grader.classroom.gradebook.database import BUSY_TIMEOUT, Database
from grader.classroom.gradebook.stored import STORED_SUBMISSIONS, STUDENT_COLUMNS, StoredSubmission
from grader.classroom.students import Student
from grader.errors import GraderError, InputError
from grader.grading.answers import with_answers
from grader.grading.rubric import Rubric, read_rubric

_RUN_COLUMNS = "id, started, coalesce(finished, ''), source, layout, rubric, version, last_mark, deadline"


class Run(NamedTuple):
    """One run of `grader batch`. `finished` is empty if it was interrupted, `last_mark` the newest mark when it began."""

    id: int
    started: str
    finished: str
    source: str
    layout: str
    rubric: str
    version: str
    last_mark: int
    deadline: str


class Gradebook(Database):
    """An open gradebook, for reading; `RunWriter` and `marks` write into it."""

    def nothing_graded(self) -> InputError:
        """Return the error for a gradebook without a run."""
        command = f"grader batch PATH --gradebook {self.shown}"
        return InputError(f"nothing has been graded into {self.shown} yet: run `{command}`")

    def runs(self) -> list[Run]:
        """Return all runs, the oldest first."""
        return [Run(*row) for row in self.rows(f"SELECT {_RUN_COLUMNS} FROM run ORDER BY id")]

    def newest_run(self) -> Run | None:
        """Return the newest run, or None."""
        row = self.first(f"SELECT {_RUN_COLUMNS} FROM run ORDER BY id DESC LIMIT 1")
        return None if row is None else Run(*row)

    def roster_entries(self) -> Iterator[str]:
        """Yield the rows of the newest roster, as JSON, in the order of the keys."""
        query = "SELECT roster_entry FROM student WHERE is_on_roster = 1 AND roster_entry <> '' ORDER BY key"
        for (entry,) in self.rows(query):
            yield str(entry)

    def students(self) -> Iterator[Student]:
        """Yield every student, in the order of the keys."""
        for row in self.rows(f"SELECT {', '.join(STUDENT_COLUMNS)} FROM student ORDER BY key"):
            yield Student(*row)

    def stored_submissions(self) -> Iterator[StoredSubmission]:
        """Yield the newest submission of each student, in the order of the keys, unaffected by later writes."""
        with self.input_errors(), closing(sqlite3.connect(self.path, timeout=BUSY_TIMEOUT)) as snapshot:
            for row in snapshot.execute(STORED_SUBMISSIONS):
                yield StoredSubmission.from_row(row)

    def rubric(self, sha256: str, *, answers: bool = False) -> Rubric:
        """Return a stored rubric, with or without model answers; raises RubricError if this grader cannot read it."""
        row = self.first("SELECT text, path FROM rubric WHERE sha256 = ?", sha256)
        if row is None:
            raise GraderError(f"the gradebook {self.shown} has no rubric {sha256[:12]}")
        rubric = read_rubric(row[0], Path(row[1]), answers=answers)
        if not answers:
            return rubric
        return with_answers(
            rubric, dict(self.rows("SELECT criterion, text FROM model_answer WHERE rubric = ?", sha256))
        )

    def record(self, result: int) -> tuple[str, str]:
        """Return the record of a result and the template that it is stored against (empty without one)."""
        query = "SELECT record, coalesce(text, '') FROM result LEFT JOIN template ON sha256 = template WHERE id = ?"
        ((record, template),) = self.rows(query, result)
        return zlib.decompress(record).decode(), str(template)
