"""List, copy, check and bundle rubrics."""

import os
import re
from pathlib import Path
from typing import TYPE_CHECKING

from grader.base.errors import GraderError, RubricError
from grader.base.text import counted, format_points, printable, printable_path, shell_quoted
from grader.lab.rubric.rubric_files import list_files, load_named
from grader.report.invocation import ExitCode
from grader.report.writing import Warn, make_folder, save_bytes

if TYPE_CHECKING:
    from grader.lab.rubric.rubric import Rubric


def list_rubrics() -> str:
    """Return a line for each rubric that comes with the grader."""
    from grader.lab.rubric.rubric import load_rubric, shipped_rubrics
    from grader.report.explanations import rubric_summary

    return "".join(
        f"{rubric.id}  {rubric_summary(rubric)}\n" for rubric in map(load_rubric, shipped_rubrics())
    )


def copy(name: str, folder: Path) -> str:
    """Copy the files of a shipped rubric; return what was written, and the next step.

    Raises GraderError.
    """
    from shutil import copyfile, copytree, ignore_patterns

    from grader.lab.rubric.rubric import load_rubric, shipped_rubrics

    file = shipped_rubrics().get(name)
    if not file:
        raise GraderError(
            f"{printable_path(name)} is not a rubric of the grader: {', '.join(shipped_rubrics())}"
        )
    copies = {
        source: folder / name / source.relative_to(file.parent)
        for source in list_files(name)
        if source.exists()
    }
    if there := list(filter(os.path.lexists, copies.values())):
        raise GraderError(f"{printable_path(there[0])} exists already: nothing was copied")
    for source, target in copies.items():
        make_folder(target.parent)
        if source.is_dir():
            copytree(
                source, target, ignore=ignore_patterns("__pycache__")
            )  # pip compiles the files of a package
        else:
            copyfile(source, target)
    if not (
        file.parent / load_rubric(name).answers
    ).exists():  # students have the package, without the answers
        text = copies[file].read_text(encoding="utf-8")
        copies[file].write_text(re.sub(r"(?m)^answers = .*\n", "", text), encoding="utf-8")
    lines = [
        *map(str, copies.values()),
        f"next: change it, then `grader rubric check {shell_quoted(copies[file])}`",
    ]
    return "".join(f"{printable(line)}\n" for line in lines)


def check(name: str, warn: Warn) -> tuple[str, ExitCode]:
    """Check a rubric, and return a summary and the exit code.

    The code is 1 if criteria cannot be decided on the reference solution.

    Raises RubricError, with all mistakes in the file, or if the reference loses points.
    """
    from grader.lab.authoring.rubric_check import likely_mistakes, reference_failures
    from grader.lab.rubric.model_answers import load_with_answers, missing_answers
    from grader.report.explanations import rubric_size

    try:
        rubric = load_with_answers(name)
    except RubricError as error:
        raise RubricError((*error.complaints, *_lines_on_the_rest(name, warn))) from None
    if missing_answers(rubric) and not rubric.is_shipped:
        warn(missing_answers(rubric))
    for message in likely_mistakes(rubric):
        warn(printable(f"warning: {message}"))
    summary = f"{rubric.id}: {rubric_size(rubric)}, no mistakes found"
    if not rubric.solution:
        return f"{summary}\n", ExitCode.PASSED
    failures = reference_failures(rubric)
    if failures.is_failed:
        raise RubricError(tuple(map(printable, failures.lines)))
    if not failures.lines:
        return f"{summary}; its reference gets full marks\n", ExitCode.PASSED
    criteria = counted(failures.undecided, "criterion", "criteria")
    summary += f"; its reference does not get full marks: {criteria} cannot be decided on it"
    return "".join(f"{printable(line)}\n" for line in (summary, *failures.lines)), ExitCode.FAILED


def _lines_on_the_rest(name: str, warn: Warn) -> list[str]:
    """Return what the reference does not pass of the correct criteria of a rubric.

    The rubric has mistakes. Warn of likely ones.
    """
    from grader.files.reading import read_capped
    from grader.lab.authoring.rubric_check import likely_mistakes, reference_failures
    from grader.lab.rubric.rubric import find_rubric, read_correct_rows

    path = find_rubric(name)
    try:
        rubric = read_correct_rows(read_capped(path, advice=""), path)
        if not rubric:
            return []
        for message in likely_mistakes(rubric):
            warn(printable(f"warning: {message}"))
        if rubric.solution is None:
            return []
        failures = reference_failures(rubric)
        return list(map(printable, failures.lines)) if failures.is_failed else []
    except GraderError:  # there is no more to say of a file or reference that cannot be read
        return []


def bundle(platform: str, output: Path, name: str) -> str:
    """Write the autograder zip for a platform; return what to do next, in two lines.

    Raises GraderError.
    """
    from grader.app.bundle.gradescope import autograder_zip
    from grader.report.explanations import rubric_summary

    if output.suffix.lower() != ".zip":
        raise GraderError(
            f"{platform} takes a zip: give a name that ends in .zip, not {str(output)!r}"
        )
    rubric = load_named(name)
    save_bytes(output, autograder_zip(rubric))
    lines = f"wrote {output}: {rubric_summary(rubric)}", f"next: {_next_step(rubric)}"
    return "".join(f"{printable(line)}\n" for line in lines)


def _next_step(rubric: "Rubric") -> str:
    from grader.lab.checks.manual import MANUAL_CHECKS
    from grader.lab.rubric.criterion import worth

    asked = (
        criterion for criterion in rubric.criteria if criterion.check.function in MANUAL_CHECKS
    )
    manual = [criterion for criterion in asked if not criterion.adjustment]
    points = worth(manual)
    step = (
        "upload it under Configure Autograder; autograder points: "
        f"{format_points(rubric.points - points.points)}"
    )
    if not manual:
        return step
    listed = ", ".join(f"{criterion.id} ({worth((criterion,)).short})" for criterion in manual)
    return f"{step}; manual grading: {points.text} for {listed}"
