"""Export a class as pages for a browser: one for each student, and the class's page."""

from pathlib import Path

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.run.pool import Processes, processors
from grader.errors import GraderError
from grader.report.formats import Format
from grader.usecases import Warn
from grader.usecases.class_hints import HintOptions, ProgressDisplay, search_class_hints
from grader.usecases.class_reports import REPORT_SECONDS, refuse_report_folder, write_reports
from grader.usecases.class_summary import read_deadline, warn_of_due


def export_pages(gradebook: Path, folder: Path | None, due: str | None, progress: ProgressDisplay, warn: Warn) -> None:
    """Write the pages of a gradebook's class into a folder. Raises GraderError."""
    if folder is None:
        raise GraderError("export html writes a folder of pages: name it with --output DIR")
    deadline = read_deadline(due)
    with Gradebook(gradebook) as book:
        refuse_report_folder(folder, (Format.HTML,), sorted({Path(run.source) for run in book.runs()}))
        if due:
            warn_of_due(due, Grades(book).newest_rubric(), warn)
        search_class_hints(book, HintOptions(), progress, warn, reports=True, statistics=True)
    with Processes(processors(), REPORT_SECONDS) as executor, progress("writing pages") as show:
        write_reports(executor, gradebook, folder, (Format.HTML,), deadline, warn, show)
