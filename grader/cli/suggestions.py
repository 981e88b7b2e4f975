"""Suggestions for shell completion: rubrics, parts, formats, and names to explain."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

import typer

if TYPE_CHECKING:
    from grader.grading.rubric import Rubric

SHELLS = ["bash", "zsh", "fish"]


def rubric_ids() -> list[str]:
    """Return the ids of the shipped rubrics."""
    from grader.grading.rubric import shipped_rubrics

    return list(shipped_rubrics())


def part_ids(context: typer.Context) -> list[tuple[str, str]]:
    """Return the ids and titles of the parts of the rubric on the command line."""
    return [(part.id, part.title) for part in _rubric(context).parts]


def save_formats() -> list[str]:
    """Return the formats of `--save`, each with its equals sign."""
    from grader.report.formats import Format

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

    default = next(str(param.default) for param in context.command.params if param.name == "rubric")
    return load_rubric(context.params.get("rubric") or default)
