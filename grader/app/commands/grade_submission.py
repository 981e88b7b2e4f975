"""Grade one submission and save the reports that `--save` names, and the files of `--fix`."""

from collections.abc import Callable

from grader.app.grading import GradeRequest, GradeRun, grade_request, save_reports
from grader.app.saving import check_saves
from grader.lab.rubric.rubric_files import list_files
from grader.report.writing import Warn


def grade_and_save(request: GradeRequest, warn: Warn, show: Callable[[GradeRun], None]) -> GradeRun:
    """Grade a submission, show its report, and save reports and fixed files. Raises GraderError."""
    rubric = list_files(request.rubric, request.answers) if request.saves else ()
    check_saves(request.saves, rubric, request.path)
    run = grade_request(request, warn)
    files = {}
    if request.fix and run.fix:
        from grader.app.hints_and_fix import files_to_fix  # late: few ask for it

        others = [
            *list_files(request.rubric, request.answers),
            *(file for _, file in request.saves),
        ]
        files = files_to_fix(request.fix, request.path, run.report, run.fix, run.besides, others)
    show(run)
    save_reports(request, run)
    if request.fix and run.fix:
        from grader.app.hints_and_fix import write_fix

        warn(write_fix(request.fix, request.path, run.report, run.fix, files))
    return run
