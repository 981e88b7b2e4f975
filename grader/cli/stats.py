"""grader stats: statistics of a class."""

from grader.cli.options import DueOption, FormatOption, GradebookOption
from grader.cli.output import screen
from grader.report.formats import OutputFormat


def stats(
    gradebook: GradebookOption, due: DueOption = None, output_format: FormatOption = OutputFormat.TERMINAL
) -> str:
    """Show statistics of a class: grades, criteria, common mistakes.

    They include manual marks, but not late penalties: --format json has these in the students' totals. A criterion's difficulty is
    the share of its points that the class earned; its discrimination is the correlation with the rest of the grade.

    Examples:

      grader stats --gradebook lab6.db

      grader stats --gradebook lab6.db --format json
    """
    from grader.usecases.class_summary import class_statistics

    return class_statistics(gradebook, due, output_format, screen())
