"""Options that several commands share, their headings in the help, and the values that shell completion suggests."""

from collections import defaultdict
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeVar

import typer
from typer.core import TyperCommand

from grader.report.formats import Format, OutputFormat
from grader.usecases.rubrics import DEFAULT_RUBRIC

if TYPE_CHECKING:
    from grader.grading.rubric import Rubric

# The headings of the help; an option is under the same one in all commands.
_GROUPS = {
    "Gradebook and rubric": "gradebook rubric expect-rubric part answers hints keep from",
    "Input": "roster layout assignment ignore-file add arg joint relative-to max-size",
    "Selection": "criterion section anonymous before after compare",
    "Grades": "due pending-as-zero",
    "Marks": "comment list-comments excused undo by missing import",
    "File of the LMS": "into strict column any-maximum only",
    "Run": "jobs timeout force cluster fail-under watch mutants seed port",
    "Output": "format output save fix sheet excel reports report-format csv feedback feedback-format verbose",
}
_GROUP_OF = {f"--{name}": group for group, names in _GROUPS.items() for name in names.split()}
_OTHER = "Options"
_Function = TypeVar("_Function", bound=Callable[..., Any])


class _Command(TyperCommand):
    def format_options(self, ctx: Any, formatter: Any) -> None:
        """Write the arguments, then the options of each group."""
        groups = defaultdict[str, list[tuple[str, str]]](list)
        for parameter in self.get_params(ctx):
            record = parameter.get_help_record(ctx)
            is_argument = parameter.param_type_name == "argument"
            group = "Arguments" if is_argument else _GROUP_OF.get(parameter.opts[-1], _OTHER)
            groups[group] += [record] if record is not None else []
        for group in ("Arguments", *_GROUPS, _OTHER):
            if groups[group]:
                with formatter.section(group):
                    formatter.write_dl(groups[group])


class Commands(typer.Typer):
    """A group of commands whose help lists the options under headings."""

    def command(self, name: str | None = None, **settings: Any) -> Callable[[_Function], _Function]:
        """Add a function as a command, as typer does."""
        return super().command(name, cls=_Command, **settings)


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
GradebookOption = Annotated[Path, typer.Option("--gradebook", metavar="FOLDER", help="The gradebook, a folder.")]
MaxSizeOption = Annotated[int, typer.Option(metavar="BYTES", min=1, help="Maximum size of a URDF.")]
AnswersOption = Annotated[
    Path | None, typer.Option("--answers", metavar="FILE", help="The .toml file with the model answers.")
]
ArgOption = Annotated[
    list[str] | None,
    typer.Option("--arg", metavar="NAME=VALUE", help="The value of an argument of a xacro file; repeatable."),
]
DueOption = Annotated[
    str | None, typer.Option("--due", metavar="TIME", help="The deadline, such as 2026-11-20T23:59+01:00.")
]
ByOption = Annotated[str, typer.Option("--by", metavar="NAME", help="Your name in reports; default: none.")]
FormatOption = Annotated[OutputFormat, typer.Option("--format", help="Output format.")]
