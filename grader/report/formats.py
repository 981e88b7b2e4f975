"""The formats of a report.

This is the one registry from which options, completion, files and documentation take them.
"""

import os
from enum import StrEnum
from functools import partial
from importlib import import_module
from typing import TYPE_CHECKING, Any, Literal, Self

from grader.base.text import without_commands
from grader.report.screen import Screen, draw

if TYPE_CHECKING:
    from grader.base.source import Base
    from grader.lab.grading.report import Report
    from grader.report.inspection import Inspection
    from grader.report.shown_graph import ShownGraph

_Need = Literal["", "console", "base", "identity", "findings"]


class FormatRow(StrEnum):
    """A format.

    It has its name, `module:function` in this package, what that function needs, and the ending
    of its files.

    The function takes the report and returns text. With the need `console` it prints on a rich
    console instead; `base` is where the submission is in its repository; `identity` is whose result
    it is, from Classroom 50's environment. With the need `findings`, it takes these in place of the
    report, then the base, and what gives the texts of files.
    """

    function: str
    needs: _Need
    ending: str

    def __new__(cls, name: str, function: str = "", needs: _Need = "", ending: str = "") -> Self:
        """Return a member with its row; the defaults are for a look-up by name alone."""
        member = str.__new__(cls, name)
        member._value_ = name
        member.function = function
        member.needs = needs
        member.ending = ending or name
        return member


class Format(FormatRow):
    """The formats of a report.

    Their endings differ, so that one folder can contain a report in all of them.
    """

    TERMINAL = "terminal", "writers.terminal:render_terminal", "console", "txt"
    MARKDOWN = "markdown", "writers.markdown:render_markdown", "", "md"
    JSON = "json", "writers.as_json:render_json"
    JUNIT = "junit", "writers.junit:render_junit", "base", "xml"
    GITHUB = "github", "writers.annotations:render_github", "base", "github.txt"
    GRADESCOPE = "gradescope", "writers.platforms:render_gradescope", "", "gradescope.json"
    CLASSROOM50 = (
        "classroom50",
        "writers.platforms:render_classroom50",
        "identity",
        "classroom50.json",
    )
    HTML = "html", "pages.student:render_html"
    SVG = "svg", "writers.svg:render_svg"
    CONCISE = "concise", "writers.concise:render_concise", "findings"
    SARIF = "sarif", "writers.sarif:render_sarif", "findings"
    CODEQUALITY = (
        "codequality",
        "writers.codequality:render_codequality",
        "findings",
        "codequality.json",
    )


class InspectFormat(FormatRow):
    """The formats of an inspection."""

    TERMINAL = "terminal", "writers.inspection_terminal:inspection_terminal", "console"
    JSON = "json", "writers.inspection_json:inspection_json"
    GITHUB = "github", "writers.inspection_github:inspection_github"
    SVG = "svg", "writers.inspection_svg:inspection_svg"
    HTML = "html", "pages.inspection_page:inspection_html"
    CONCISE = "concise", "writers.concise:render_concise", "findings"
    JUNIT = "junit", "writers.inspection_junit:inspection_junit", "", "xml"
    SARIF = "sarif", "writers.sarif:render_sarif", "findings"
    CODEQUALITY = (
        "codequality",
        "writers.codequality:render_codequality",
        "findings",
        "codequality.json",
    )


class GraphFormat(FormatRow):
    """The formats of a graph."""

    TEXT = "text", "writers.graph_text:graph_text", "console", "txt"
    JSON = "json", "writers.graph_json:graph_json"
    DOT = "dot", "writers.graph_diagrams:graph_dot"
    MERMAID = "mermaid", "writers.graph_diagrams:graph_mermaid", "", "mmd"
    HTML = "html", "pages.graph_page:graph_html"


class OutputFormat(StrEnum):
    """The formats of a class, and of the changes between two runs."""

    TERMINAL = "terminal"
    JSON = "json"


# The object or the schema of each JSON document: its title, and where it is.
_SCHEMAS = {
    "report": ("report", "writers.as_json:REPORT"),
    "inspect": ("inspection", "writers.inspection_json:INSPECTION"),
    "graph": ("graph", "writers.graph_json:GRAPH"),
    "rubric-test": ("rubric test", "writers.rubric_test_result:RUBRIC_TEST"),
}


def json_schema(name: str) -> dict[str, Any]:
    """Return the schema of a report, an inspection, a graph or a rubric test."""
    from grader.report.json_data import make_schema  # late: most commands need no JSON

    title, place = _SCHEMAS[name]
    return make_schema(title, _load(place))


def render(
    report: "Report",
    kind: Format,
    base: "Base | None" = None,
    screen: Screen | None = None,
    *,
    verbose: bool = False,
) -> str:
    """Return a report in a format, for a screen or a file; only that format's module is imported.

    `base` is where the submission is in its repository; without it its paths are the repository's.
    The format `terminal` shows everything only if `verbose`.
    Raises InputError if the environment does not say whose result it is (Classroom 50).
    """
    if kind.needs == "findings":
        from grader.base.source import Base
        from grader.report.mistakes import findings_in_report

        return _render(
            findings_in_report(report), kind, None, base or Base(), report.submission.source
        )
    return _render(report, kind, screen, *list_inputs(kind, base), verbose=verbose)


def render_inspection(
    inspection: "Inspection",
    kind: InspectFormat,
    screen: Screen | None = None,
    *,
    verbose: bool = False,
) -> str:
    """Return an inspection in a format, for a screen or a file.

    The format `terminal` spells out everything only if `verbose`.
    """
    if kind.needs == "findings":
        from grader.report.findings import findings_in_inspection

        findings = findings_in_inspection(inspection)
        return _render(findings, kind, None, inspection.base, inspection.source)
    return _render(inspection, kind, screen, verbose=verbose)


def render_graph(shown: "ShownGraph", kind: GraphFormat, screen: Screen | None = None) -> str:
    """Return a graph in a format, for a screen or a file."""
    return _render(shown, kind, screen)


def _render(
    shown: object, kind: FormatRow, screen: Screen | None, *inputs: object, **options: bool
) -> str:
    """Return what is shown in a format; options are for the terminal."""
    function = _load(kind.function)
    if kind.needs == "console":
        return draw(partial(function, shown, **options), screen)
    text: str = function(shown, *inputs)
    return text if kind == Format.GITHUB else without_commands(text)  # whose lines are commands


def _load(place: str) -> Any:
    module, _, name = place.partition(":")
    return getattr(import_module(f"grader.report.{module}"), name)


def list_inputs(kind: Format, base: "Base | None" = None) -> tuple[object, ...]:
    """Return what the function of a format takes after the report.

    Raises InputError if it cannot be had.
    """
    match kind.needs:
        case "base":
            from grader.base.source import Base

            return (base or Base(),)
        case "identity":
            from grader.report.writers.platforms import identity_from

            return (identity_from(os.environ),)
    return ()
