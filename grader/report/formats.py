"""The formats of a report: the one registry from which options, completion, files and documentation take them."""

import os
from enum import StrEnum
from functools import partial
from importlib import import_module
from typing import TYPE_CHECKING, Any, Literal, Self

from grader.report.screen import Screen, draw
from grader.text import without_commands

if TYPE_CHECKING:
    from grader.grading.report import Report
    from grader.report.inspection import Inspection
    from grader.report.locations import Base

Need = Literal["", "console", "base", "identity", "picture"]


class Format(StrEnum):
    """A format of a report: its name, the ending of its files, `module:function` in this package, and what that function needs.

    The function takes the report and returns text. With the need `console` it prints on a rich console instead; `base` is where
    the submission is in its repository; `identity` is whose result it is, from Classroom 50's environment; `picture` is the relative address
    of the robot's drawing that is saved with the report.
    """

    ending: str
    function: str
    needs: Need

    # The endings differ, so that one folder can contain a report in every format under one name.
    TERMINAL = "terminal", "txt", "terminal:render_terminal", "console"
    MARKDOWN = "markdown", "md", "markdown:render_markdown", "picture"
    JSON = "json", "json", "as_json:render_json"
    JUNIT = "junit", "xml", "junit:render_junit", "base"
    SARIF = "sarif", "sarif", "sarif:render_sarif", "base"
    GITHUB = "github", "github.txt", "annotations:render_github", "base"
    GRADESCOPE = "gradescope", "gradescope.json", "platforms:render_gradescope"
    CLASSROOM50 = "classroom50", "classroom50.json", "platforms:render_classroom50", "identity"
    HTML = "html", "html", "pages.student:render_html"
    CODECLIMATE = "codeclimate", "codeclimate.json", "annotations:render_codeclimate", "base"
    SVG = "svg", "svg", "drawing:render_svg"

    def __new__(cls, name: str, ending: str = "", function: str = "", needs: Need = "") -> Self:
        """Return a member with its row; the defaults are for a look-up by name alone."""
        member = str.__new__(cls, name)
        member._value_ = name
        member.ending, member.function, member.needs = ending, function, needs
        return member


class InspectFormat(StrEnum):
    """A format of an inspection: its name and `module:function` in this package; with the need `console` it prints."""

    function: str
    needs: Need

    TERMINAL = "terminal", "inspection:inspection_terminal", "console"
    JSON = "json", "inspection:inspection_json"
    SVG = "svg", "drawing:inspection_svg"
    HTML = "html", "pages.robot:inspection_html"

    def __new__(cls, name: str, function: str = "", needs: Need = "") -> Self:
        """Return a member with its row."""
        member = str.__new__(cls, name)
        member._value_ = name
        member.function, member.needs = function, needs
        return member


class OutputFormat(StrEnum):
    """The formats of a class, and of the changes between two runs."""

    TERMINAL = "terminal"
    JSON = "json"


# The record or the schema of each JSON document: its title, and where it is.
_SCHEMAS = {
    "report": ("report", "as_json:REPORT"),
    "inspect": ("inspection", "inspection:INSPECTION"),
    "rubric-test": ("rubric test", "rubric_test:RUBRIC_TEST"),
    "class": ("class", "class_schemas:CLASS"),
    "diff": ("diff", "class_schemas:DIFF"),
}


def json_schema(name: str) -> dict[str, Any]:
    """Return the schema of a report, rubric, inspection, class, diff or rubric test."""
    from grader.grading.schema import rubric_schema

    if name == "rubric":
        return rubric_schema()
    title, place = _SCHEMAS[name]
    draft = "https://json-schema.org/draft/2020-12/schema"
    return {"$schema": draft, "title": f"grader {title}", **_imported(place).schema}


def render(
    report: "Report",
    kind: Format,
    base: "Base | None" = None,
    screen: Screen | None = None,
    *,
    verbose: bool = False,
    picture: str = "",
) -> str:
    """Return a report in a format, for a screen or a file; only that format's module is imported.

    `base` is where the submission is in its repository; without it its paths are the repository's. The format `terminal` shows
    everything only if `verbose`; `picture` is the address of the drawing that a Markdown report shows. Raises InputError if the
    environment does not say whose result it is (Classroom 50).
    """
    function = _imported(kind.function)
    if kind.needs == "console":
        return draw(partial(function, report, verbose=verbose), screen)
    text: str = function(report, *needed(kind, base, picture))
    return text if kind is Format.GITHUB else without_commands(text)  # whose lines are commands


def render_inspection(inspection: "Inspection", kind: InspectFormat, screen: Screen) -> str:
    """Return an inspection in a format, for a screen or a file."""
    function = _imported(kind.function)
    if kind.needs == "console":
        return draw(partial(function, inspection), screen)
    return without_commands(function(inspection))


def _imported(place: str) -> Any:
    module, _, name = place.partition(":")
    return getattr(import_module(f"grader.report.{module}"), name)


def needed(kind: Format, base: "Base | None" = None, picture: str = "") -> tuple[object, ...]:
    """Return what the function of a format takes after the report. Raises InputError if it cannot be had."""
    if kind.needs == "base":
        from grader.report.locations import Base

        return (base or Base(),)
    if kind.needs == "identity":
        from grader.report.platforms import identity_from

        return (identity_from(os.environ),)
    if kind.needs == "picture":
        return (picture,)
    return ()
