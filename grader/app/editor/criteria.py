"""The criteria of a rubric that the files of an editor do not meet."""

from grader.app.editor.look import Graded, ProvenFix
from grader.app.hints_and_fix import add_hints
from grader.files.tree import Tree
from grader.lab.grading.grade import grade
from grader.lab.rubric.rubric_files import load_named
from grader.lab.submission.opening import make_submission
from grader.report.mistakes import mistakes_in_report


def grade_files(name: str, tree: Tree, identity: str) -> Graded:
    """Grade the files of an editor.

    Args:
        name: The id of the rubric, or its file.
        tree: The files.
        identity: The name of the folder.

    Raises:
        GraderError: The rubric or the files cannot be read.
    """
    rubric = load_named(name, None)
    submission = make_submission(tree, identity, rubric.lab)
    report = grade(rubric, submission)
    report, _ = add_hints(report, submission, None, lambda _: None, is_fixed=False)
    fixes = {}
    for result in report.results:
        hint = result.hint
        if hint and hint.edits:
            fixes[hint.edits] = ProvenFix(hint.message, hint.at, hint.edits)
    return Graded(tuple(mistakes_in_report(report)), tuple(fixes.values()))
