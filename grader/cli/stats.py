"""grader stats: what a class did and did not understand."""

from grader.cli.options import ClassFormat, DueOption, FormatOption, GradebookOption
from grader.cli.output import emit


def stats(gradebook: GradebookOption, due: DueOption = None, output_format: FormatOption = ClassFormat.TERMINAL) -> int:
    """Show how a class did: the marks, each criterion's difficulty and discrimination, what went wrong most often.

    Marks by hand are in it; what being late costs is only in the students' totals of --format json.

    Example:

      grader stats --gradebook lab6.db
    """
    from grader.classroom.gradebook import Gradebook
    from grader.classroom.lateness import read_time
    from grader.classroom.standings import Standings
    from grader.cli.class_text import class_text

    with Gradebook(gradebook) as book:
        emit(class_text(Standings(book, read_time(due) if due else None), output_format))
    return 0
