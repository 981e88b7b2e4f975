"""The rubric, roster and handed-out robots of a class: from the command, else from the last run into the gradebook."""

from collections.abc import Iterator, Sequence
from datetime import datetime
from pathlib import Path

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.marks import EXTENSION
from grader.classroom.gradebook.run_writer import save_answers
from grader.classroom.intake.roster import Roster, roster_from_json
from grader.classroom.intake.roster_file import read_roster
from grader.classroom.lateness import read_time, time_text
from grader.classroom.run.worker import work_hashes
from grader.errors import InputError
from grader.grading.answers import load_with_answers, read_answers
from grader.grading.rubric import Rubric
from grader.submission.opening import open_submission
from grader.text import counted, enumerated, named, people_text, printable, printable_path, shell_quoted
from grader.usecases.class_summary import read_deadline
from grader.usecases.rubrics import DEFAULT_RUBRIC
from grader.usecases.terminal import Warn

_MAX_NAMED = 5
_EXTENDED = "SELECT key FROM current_mark JOIN student ON student.id = student WHERE criterion = ?"


def handed_out_hashes(files: Sequence[Path], rubric: Rubric) -> Iterator[str]:
    """Yield the hashes of the work that the course handed out. Raises InputError for a file without any."""
    for path in files:
        hashes = work_hashes(open_submission(str(path), rubric.lab))
        if not hashes:
            raise InputError(f"--ignore-file {printable_path(path)}: there is no URDF and no package in it")
        yield from hashes


def rubric_of(name: str | None, gradebook: Path, answers: Path | None, warn: Warn) -> Rubric:
    """Return the rubric with answers, so that `review` has them on any machine; without a name that of the last run.

    If the file of the last run no longer exists, its text in the gradebook counts.
    """
    if name is None and gradebook.exists():
        with Gradebook(gradebook) as book:
            run = book.newest_run()
            last = book.rubric(run.rubric, answers=True) if run is not None else None
        if last is not None:
            if last.path.exists():
                rubric = load_with_answers(str(last.path), answers)
            else:
                rubric = read_answers(last, answers) if answers is not None else last
            if not rubric.is_shipped:
                warn(f"rubric of the last run: {printable_path(rubric.path)}")
            return rubric
    return load_with_answers(name or DEFAULT_RUBRIC, answers)


def deadline_of(due: str | None, gradebook: Path, warn: Warn) -> datetime | None:
    """Return the deadline of `--due`, else that of the last run. Raises InputError."""
    if due is None and gradebook.exists():
        with Gradebook(gradebook) as book:
            run = book.newest_run()
        if run is not None and run.deadline:
            deadline = read_time(run.deadline)
            warn(f"deadline of the last run: {time_text(deadline, deadline.tzinfo)} (--due changes it)")
            return deadline
    return read_deadline(due)


def keep_answers(gradebook: Path, answers: Path) -> None:
    """Save the model answers in a file in a gradebook, for this review and later ones. Raises InputError."""
    with Gradebook(gradebook) as book:
        rubric = read_answers(Grades(book).newest_rubric(), answers)
        book.check_writable()
        with book.transaction():
            save_answers(book, rubric)


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
    """Return the roster, or that of an earlier run into the gradebook, with the LMS ids that the gradebook knows."""
    roster = read_roster(file) if file is not None else None
    if not gradebook.exists():
        return roster
    with Gradebook(gradebook) as book:
        earlier = roster_from_json(book.roster_entries())
        for line in _roster_changes(roster, earlier, book) if roster is not None else ():
            warn(printable(line))
        roster = roster or earlier
        return roster.with_lms_numbers(book.students()) if roster is not None else None


def _roster_changes(roster: Roster, earlier: Roster | None, book: Gradebook) -> Iterator[str]:
    """Yield that a roster has fewer students than the earlier one, and whose deadline in it does not count."""
    missing = [one.key for one in (earlier.students if earlier is not None else ()) if roster.entry(one.key) is None]
    if earlier is not None and missing and len(roster.entries) < len(earlier.entries):
        count = f"the roster has {counted(len(roster.entries), 'student')}, but the gradebook's roster has"
        yield f"{count} {len(earlier.entries)}. Missing on the new one: {enumerated(missing, _MAX_NAMED)}"
    extended = {key for (key,) in book.rows(_EXTENDED, EXTENSION)}
    own = (one.student for one in roster.entries if (one.due or one.extension_days) and one.student.key in extended)
    if names := [named(one.key, one.name) for one in own]:
        yield f"the deadline of `grader extend` counts, not that of the roster: {people_text(names, _MAX_NAMED)}"
