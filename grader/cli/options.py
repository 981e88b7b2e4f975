"""Options that several commands share, and the values that shell completion suggests."""

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from grader.report.formats import Format, OutputFormat
from grader.usecases.rubrics import DEFAULT_RUBRIC

if TYPE_CHECKING:
    from grader.grading.rubric import Rubric


def rubric_ids() -> list[str]:
    """Return the ids of the shipped rubrics."""
    from grader.grading.rubric import shipped_rubrics

    return list(shipped_rubrics())


def part_ids(context: typer.Context) -> list[tuple[str, str]]:
    """Return the ids and titles of the parts of the rubric on the command line."""
    return [(part.id, part.title) for part in _rubric(context).parts]


def save_formats() -> list[str]:
    """Return the formats of `--save`, each with its equals sign."""
    return [f"{kind.value}=" for kind in Format]


def explainable(context: typer.Context) -> Iterator[tuple[str, str]]:
    """Yield every criterion, check and problem code with a description."""
    from grader.checks.registry import check_names
    from grader.report.rubrics import EVERY_KIND

    yield from ((criterion.id, criterion.title) for criterion in _rubric(context).criteria)
    yield from ((name, "a check for rubrics") for name in check_names())
    yield from ((kind.code, kind.title) for kind in EVERY_KIND)


def _rubric(context: typer.Context) -> "Rubric":
    from grader.grading.rubric import load_rubric

    default = next(param.default for param in context.command.params if param.name == "rubric")
    return load_rubric(context.params.get("rubric") or str(default or DEFAULT_RUBRIC))


PartOption = Annotated[
    list[str] | None,
    typer.Option("--part", metavar="ID", help="Grade only this part; repeatable.", autocompletion=part_ids),
]
RubricOption = Annotated[
    str, typer.Option(metavar="ID|FILE", help="The rubric: an id or a .toml file.", autocompletion=rubric_ids)
]
GradebookOption = Annotated[Path, typer.Option("--gradebook", metavar="FILE", help="The gradebook, a SQLite file.")]
MaxSizeOption = Annotated[int, typer.Option(metavar="BYTES", min=1, help="Maximum size of a URDF.")]
ArgOption = Annotated[
    list[str] | None,
    typer.Option("--arg", metavar="NAME=VALUE", help="The value of an argument of a xacro file; repeatable."),
]
DueOption = Annotated[
    str | None, typer.Option("--due", metavar="TIME", help="The deadline, such as 2026-11-20T23:59+01:00.")
]
ByOption = Annotated[str, typer.Option("--by", metavar="NAME", help="Your name in reports; default: none.")]
ClassVerboseOption = Annotated[bool, typer.Option("--verbose", help="Name all students who need attention (terminal).")]
FormatOption = Annotated[OutputFormat, typer.Option("--format", help="Output format.")]
