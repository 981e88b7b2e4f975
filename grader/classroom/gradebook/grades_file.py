"""grades.csv: the grades of a class, written again after each run and each mark."""

from collections.abc import Iterable

from grader.base.errors import InputError
from grader.classroom.gradebook.gradebook import Gradebook, grade_table
from grader.classroom.gradebook.student_grade import StudentGrade
from grader.classroom.marks import gradebook_folder as names
from grader.classroom.tables import write_table
from grader.report.writing import save

_PRIVATE = 0o600


def write_grades(book: Gradebook, grades: Iterable[StudentGrade] | None = None) -> None:
    """Write the grades of a class, by default the current ones, into its gradebook.

    Raises InputError.
    """
    table = write_table(*grade_table(book, book if grades is None else grades))
    save(book.folder / names.GRADES, table, book.roots, _PRIVATE)


def write_grades_with(marks: int, book: Gradebook) -> None:
    """Write the grades after some marks were saved. Raises InputError, which says that they are."""
    try:
        write_grades(book)
    except InputError as error:
        saved = "the mark is saved" if marks == 1 else f"{marks} marks are saved"
        raise InputError(
            f"{saved}, {names.GRADES} is not: {error}; the next command writes it"
        ) from None
