"""grader stats: what a class did and did not understand."""

from grader.cli.options import ClassFormat, DueOption, FormatOption, GradebookOption
from grader.cli.output import emit


def stats(gradebook: GradebookOption, due: DueOption = None, output_format: FormatOption = ClassFormat.TERMINAL) -> int:
    """Show how a class did, and what went wrong most often.

    That is the marks, and each criterion's difficulty and discrimination. Marks by hand are in it; what being late costs is only in the students' totals of --format json.

    Examples:

      grader stats --gradebook lab6.db

      grader stats --gradebook lab6.db --format json
    """
    from grader.classroom.gradebook.gradebook import Gradebook
    from grader.classroom.gradebook.grades import Grades
    from grader.classroom.gradebook.lateness import read_time
    from grader.cli.class_text import class_text

    with Gradebook(gradebook) as book:
        emit(class_text(Grades(book, read_time(due) if due else None), output_format))
    return 0
