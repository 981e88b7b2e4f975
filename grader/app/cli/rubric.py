"""grader rubric and grader bundle.

List, show, write, check and test rubrics, and pack one for a grading platform.
"""

from pathlib import Path
from typing import Annotated, Literal

import typer
from typer import Argument, Option

from grader.app.cli.options import AnswersOption, FormatOption, RubricOption
from grader.app.cli.streams import TERMINAL, warn
from grader.app.commands import rubrics
from grader.base.errors import InputError
from grader.lab.rubric.rubric_files import DEFAULT_RUBRIC, load_named
from grader.report.formats import OutputFormat
from grader.report.writing import write_stdout

rubric = typer.Typer(
    help=(
        """List, write, check, test and review rubrics; list the checks.

Examples:

  grader rubric list

  grader rubric show lab6

  grader rubric new my_lab.toml --from solution.urdf

  grader rubric check my_lab.toml

  grader rubric test my_lab.toml
"""
    ),
    no_args_is_help=True,
)
RubricArgument = Annotated[
    str,
    Argument(
        metavar="ID|FILE",
        help="The rubric: an id or a .toml file.",
    ),
]


@rubric.command("list")
def list_rubrics() -> str:
    """List the rubrics that come with the grader.

    Examples:

      grader rubric list
    """
    return rubrics.list_rubrics()


@rubric.command("show")
def show_rubric(
    name: RubricArgument,
    answers: AnswersOption = None,
    output_format: FormatOption = OutputFormat.TERMINAL,
) -> str:
    """Show the parts and criteria of a rubric with their points.

    Examples:

      grader rubric show lab6

      grader rubric show my_lab.toml --answers my_lab.answers.toml
    """
    from grader.report.explanations import rubric_json, rubric_overview

    shown = load_named(name, answers)
    return rubric_json(shown) if output_format == "json" else rubric_overview(shown)


@rubric.command("sheet")
def write_sheet(
    name: RubricArgument,
    output_format: Annotated[
        Literal["markdown", "html"], Option("--format", help="Output format.")
    ] = "markdown",
    picture: Annotated[
        bool, Option("--picture", help="Show a picture of the reference (html).")
    ] = False,
) -> str:
    """Write what students get: tasks, points, and what to submit.

    It has nothing of the reference but with --picture.

    Examples:

      grader rubric sheet lab6 > sheet.md

      grader rubric sheet my_lab.toml --format html > sheet.html
    """
    from grader.report.pages.sheet import write_sheet as write

    return write(load_named(name), output_format, has_picture=picture)


@rubric.command("checks")
def list_checks() -> str:
    """List the checks for rubrics, with their arguments.

    `grader explain` describes one of them in detail.

    Examples:

      grader rubric checks
    """
    from grader.report.explanations import checks_text

    return checks_text()


@rubric.command("new")
def new_rubric(
    file: Annotated[Path, Argument(metavar="FILE", help="The .toml file to write.")],
    reference: Annotated[
        str,
        Option(
            "--from",
            metavar="PATH",
            help="The reference: a URDF, xacro, package, workspace or archive.",
            show_default="the recording",
        ),
    ] = "",
    recording: Annotated[
        Path | None, Option(metavar="PATH", help="A recording in the reference.")
    ] = None,
    force: Annotated[bool, Option("--force", help="Replace FILE if it exists.")] = False,
    without: Annotated[
        list[str] | None,
        Option(
            metavar="KINDS",
            help="Omit kinds of criteria, such as colours,masses,inertia,collision, or "
            "families of names.",
        ),
    ] = None,
    names_only: Annotated[
        bool,
        Option(
            "--names-only", help="Only what names have to agree on, and that the packages build."
        ),
    ] = False,
    free: Annotated[
        list[str] | None,
        Option(
            metavar="NAME",
            help="A name that the handout leaves open: of a link, joint, node, topic or file. "
            "Repeatable.",
        ),
    ] = None,
    weights: Annotated[
        Literal["importance", "equal"],
        Option(help="What matters gets more points, or all criteria get equal ones."),
    ] = "importance",
    total: Annotated[
        int | None, Option(metavar="POINTS", min=1, help="The points of all criteria together.")
    ] = None,
) -> str:
    """Write a rubric from a reference solution.

    It has a criterion for each fact that can be measured, also of a recording. It is graded on the
    reference, which must get full marks. The output lists the facts that no check can test.

    What ROS 2 does not care about is free: names of launch files and of `<ros2_control>`, files
    that are only named, the build type. With nodes, controllers or a world in the solution, so are
    colours, dynamics, effort, velocity, names of sensors and initial values: these are comments.

    Examples:

      grader rubric new my_lab.toml --from solution.urdf

      grader rubric new my_lab.toml --from my_lab/my_robot

      grader rubric new my_lab.toml --from solution.urdf --force

      grader rubric new my_lab.toml --from my_lab --without colours,masses

      grader rubric new my_lab.toml --from my_lab --recording my_lab/drive
    """
    from grader.app.commands.rubric_making import draft_choice, write_rubric

    choice = draft_choice(
        without or (), free or (), is_names_only=names_only, weights=weights, total=total
    )
    path = reference or str(recording or "")
    if not path:
        raise InputError("give --from PATH, or --recording PATH")
    return write_rubric(file, path, warn, choice, force=force, recording=recording)


@rubric.command("copy")
def copy_rubric(
    name: Annotated[
        str,
        Argument(metavar="ID", help="A rubric of the grader."),
    ],
    folder: Annotated[
        Path, Argument(metavar="FOLDER", help="The folder to write into: FOLDER/ID.")
    ],
) -> str:
    """Copy a rubric with its files, to change it.

    Examples:

      grader rubric copy lab6 rubrics
    """
    return rubrics.copy(name, folder)


@rubric.command("check")
def check_rubric(file: RubricArgument) -> int:
    """Check a rubric and its reference solution.

    Exits 2 if there are mistakes, and lists all of them with their lines; 1 if automatic criteria
    cannot be decided on the reference, such as the radius of a wheel that is a mesh.

    Examples:

      grader rubric check my_lab.toml
    """
    text, code = rubrics.check(file, warn)
    write_stdout(text)
    return code


@rubric.command("test")
def run_test(
    name: RubricArgument,
    folder: Annotated[
        Path | None,
        Argument(
            metavar="[FOLDER]", help="A folder with samples: submissions with an expected.toml."
        ),
    ] = None,
    fail_under: Annotated[
        str | None, Option(metavar="N|N%", help="Exit 1 if the mutation score is less, in percent.")
    ] = None,
    output_format: FormatOption = OutputFormat.TERMINAL,
    are_all: Annotated[bool, Option("--all", help="Grade all mutants, not a sample.")] = False,
    seed: Annotated[int, Option(metavar="N", help="Draw another sample of the mutants.")] = 0,
) -> int:
    """Test a rubric on variants of its reference and on samples.

    The reference and its equivalents must keep full marks; every mutant must lose points. Mutants
    that get full marks are listed with their diff. Of more than 600 mutants, a sample over all
    kinds is graded.

    Exit codes: 0 no correct robot loses points, all samples are as expected, and the score reaches
    --fail-under; 1 otherwise; 2 the rubric is broken or has no reference; 3 a check is faulty.

    Examples:

      grader rubric test lab6

      grader rubric test my_lab.toml samples --fail-under 100%
    """
    from grader.app.commands.rubric_making import test_rubric

    is_json = output_format is OutputFormat.JSON
    text, code = test_rubric(
        name, folder, fail_under, is_json, TERMINAL, are_all_graded=are_all, seed=seed
    )
    write_stdout(text)
    return code


@rubric.command("review")
def review_rubric(
    gradebook: Annotated[
        Path | None,
        Argument(metavar="[GRADEBOOK]", help="The gradebook (default: the only one here)."),
    ] = None,
) -> str:
    """Show what to look at before grades go out.

    Criteria that all submissions pass or fail, those that need manual grading most, and equal
    robots with different results: there the rubric may be wrong, or the handout unclear.

    Examples:

      grader rubric review

      grader rubric review lab6-grades
    """
    from grader.app.cli.options import only_gradebook
    from grader.classroom.reports.class_figures import rubric_review

    return rubric_review(gradebook or only_gradebook(), TERMINAL)


def bundle(
    platform: Annotated[
        Literal["gradescope"], Argument(metavar="PLATFORM", help="The platform: gradescope.")
    ],
    file: Annotated[Path | None, Argument(metavar="[OUT.zip]", help="The file to write.")] = None,
    output: Annotated[Path | None, Option(metavar="FILE", help="The file to write.")] = None,
    rubric: RubricOption = DEFAULT_RUBRIC,
) -> str:
    """Write an autograder zip for Gradescope.

    Upload it to Gradescope: it installs the grader there and grades submissions against the rubric.

    Examples:

      grader bundle gradescope --output autograder.zip

      grader bundle gradescope --output autograder.zip --rubric my_lab.toml
    """
    given = [path for path in (file, output) if path]
    if len(given) != 1:
        raise InputError("name the file to write once: --output autograder.zip")
    return rubrics.bundle(platform, given[0], rubric)
