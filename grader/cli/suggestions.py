"""What the shell may offer for a word that is being typed: rubrics, parts, formats, and names that can be explained."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

import typer

if TYPE_CHECKING:
    from grader.grading.rubric import Rubric

SHELLS = ("bash", "zsh", "fish")


def shells() -> list[str]:
    """The shells in which commands can be completed."""
    return list(SHELLS)


def rubric_ids() -> list[str]:
    """The ids of the rubrics that come with the grader."""
    from grader.grading.rubric import shipped_rubrics

    return list(shipped_rubrics())


def part_ids(context: typer.Context) -> list[tuple[str, str]]:
    """The parts of the rubric that is named on the same line, each with its title."""
    return [(part.id, part.title) for part in _rubric(context).parts]


def save_formats() -> list[str]:
    """The beginnings of what `--save` takes."""
    from grader.report.formats import Format

    return [f"{kind.value}=" for kind in Format]


def explainable(context: typer.Context) -> Iterator[tuple[str, str]]:
    """Everything that can be explained, each with what it is: criteria, checks, and the codes of problems."""
    from grader.checks.registry import check_names
    from grader.report.rubrics import EVERY_KIND

    yield from ((each.id, each.title) for each in _rubric(context).criteria)
    yield from ((name, "a check that a rubric can name") for name in check_names())
    yield from ((kind.code, kind.title) for kind in EVERY_KIND)


def _rubric(context: typer.Context) -> "Rubric":
    from grader.grading.rubric import load_rubric

    unless_told = next(str(each.default) for each in context.command.params if each.name == "rubric")
    return load_rubric(context.params.get("rubric") or unless_told)
