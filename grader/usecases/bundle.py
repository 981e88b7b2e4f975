"""Write the autograder zip for Gradescope."""

from pathlib import Path

from grader.bundle.gradescope import autograder_zip
from grader.checks.manual import MANUAL_CHECKS
from grader.errors import GraderError
from grader.grading.criterion import worth
from grader.grading.rubric import Rubric, load_rubric
from grader.text import format_points, printable
from grader.usecases.rubrics import rubric_summary
from grader.usecases.writing import save_bytes


def write_bundle(platform: str, output: Path, rubric: str) -> str:
    """Write the bundle and return what to do next, in two lines. Raises GraderError."""
    if output.suffix.lower() != ".zip":
        raise GraderError(f"{platform} takes a zip: give a name that ends in .zip, not {str(output)!r}")
    rules = load_rubric(rubric)
    save_bytes(output, autograder_zip(rules))
    return printable(f"wrote {output}: {rubric_summary(rules)}") + "\n" + printable(f"next: {_next_step(rules)}") + "\n"


def _next_step(rubric: Rubric) -> str:
    asked = (criterion for criterion in rubric.criteria if criterion.check.function in MANUAL_CHECKS)
    manual = [criterion for criterion in asked if criterion.adjustment is None]
    points = worth(manual)
    step = f"upload it under Configure Autograder; autograder points: {format_points(rubric.points - points.points)}"
    if not manual:
        return step
    listed = ", ".join(f"{criterion.id} ({worth((criterion,)).short})" for criterion in manual)
    return f"{step}; manual grading: {points.text} for {listed}"
