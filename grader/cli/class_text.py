"""What there is to say of a class, as text."""

from functools import partial

from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.statistics import statistics
from grader.classroom.run.batch import Progress
from grader.cli.options import ClassFormat
from grader.cli.output import screen
from grader.report.screen import draw

_MOST_LOOKS = 20


def class_text(standings: Grades, kind: ClassFormat, done: Progress | None = None) -> str:
    """Marks, statistics and who needs a look; `done` is what a batch has just done. Raises InputError where nothing was graded."""
    rubric = standings.newest_rubric()
    found = statistics(standings.book, rubric)
    looks = standings.needing_attention(_MOST_LOOKS)
    if kind is ClassFormat.JSON:
        from grader.report.classes_json import render_class_json

        run = None
        if done is not None:
            run = {"total": done.total, "graded": done.graded, "unchanged": done.unchanged, "errored": done.errored}
        return render_class_json(rubric, found, standings.all(), looks, run)
    from grader.report.classes import render_class

    return draw(partial(render_class, rubric.title, found, looks), screen())
