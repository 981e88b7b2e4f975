"""The rubric, roster and handed-out robots of a class: from the command, else from the last run into the gradebook."""

from collections.abc import Iterator, Sequence
from pathlib import Path

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.intake.roster import Roster, roster_from_json
from grader.classroom.intake.roster_file import read_roster
from grader.classroom.run.worker import robot_hashes
from grader.errors import InputError
from grader.grading.answers import load_with_answers
from grader.grading.rubric import Rubric
from grader.submission.opening import open_submission
from grader.text import counted, enumerated, printable_path, shell_quoted
from grader.usecases.rubrics import DEFAULT_RUBRIC
from grader.usecases.terminal import Warn

_MAX_NAMED = 5


def handed_out_hashes(files: Sequence[Path], rubric: Rubric) -> Iterator[str]:
    """Yield the hashes of the robots that the course handed out. Raises InputError for a file without a robot."""
    for path in files:
        hashes = robot_hashes(open_submission(str(path), rubric.lab))
        if not any(hashes):
            raise InputError(f"--ignore-file {printable_path(path)}: there is no URDF in it")
        yield from filter(None, hashes)


def rubric_of(name: str | None, gradebook: Path, warn: Warn) -> Rubric:
    """Return the rubric with answers, so that `review` has them on any machine; without a name that of the last run.

    If the file of the last run no longer exists, its text in the gradebook counts.
    """
    if name is None and gradebook.exists():
        with Gradebook(gradebook) as book:
            run = book.newest_run()
            last = book.rubric(run.rubric, answers=True) if run is not None else None
        if last is not None:
            rubric = load_with_answers(str(last.path)) if last.path.exists() else last
            if not rubric.is_shipped:
                warn(f"rubric of the last run: {printable_path(rubric.path)}")
            return rubric
    return load_with_answers(name or DEFAULT_RUBRIC)


def warn_of_parts(book: Gradebook, wanted: tuple[str, ...], rubric: Rubric, warn: Warn) -> None:
    """Say that the last run graded fewer parts than this one, which grades all."""
    last = Grades(book).parts if not wanted and book.newest_run() is not None else ()
    if last and set(last) < {criterion.part for criterion in rubric.criteria}:
        options = " ".join(f"--part {shell_quoted(part)}" for part in last)
        warn(
            f"the last run graded {', '.join(last)} only, and this one grades all parts: "
            f"pass {options} to grade the same"
        )


def roster_of(file: Path | None, gradebook: Path, warn: Warn) -> Roster | None:
    """Return the roster, or that of an earlier run into the gradebook, with the LMS ids that the gradebook knows.

    Say so if the roster has fewer students than that of the earlier run.
    """
    roster = read_roster(file) if file is not None else None
    if not gradebook.exists():
        return roster
    with Gradebook(gradebook) as book:
        earlier = roster_from_json(book.roster_entries())
        missing = (
            []
            if roster is None or earlier is None
            else [student.key for student in earlier.students if roster.entry(student.key) is None]
        )
        if missing and roster is not None and earlier is not None and len(roster.entries) < len(earlier.entries):
            warn(
                f"the roster has {counted(len(roster.entries), 'student')}, "
                f"but the gradebook's roster has {len(earlier.entries)}."
                f" Missing on the new one: {enumerated(missing, _MAX_NAMED)}"
            )
        roster = roster or earlier
        return roster.with_lms_numbers(book.students()) if roster is not None else None
