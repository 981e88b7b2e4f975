"""Write what is generated into the pages: `python docs/make.py`. The tests fail if a page is out of
date.
"""

import re
from collections.abc import Iterator
from io import StringIO
from pathlib import Path
from typing import get_args

from rich.console import Console
from rich.text import Text

from grader.app.cli.explain import SchemaName
from grader.app.commands.schemas import json_schema
from grader.lab.checks.registry import own_checks
from grader.lab.grading.grade import grade
from grader.lab.grading.report import Report
from grader.lab.hints.hinting import hinted
from grader.lab.rubric.keys import (
    ADJUSTMENT,
    CARRIED,
    CRITERION,
    DEFAULTS,
    EVIDENCE,
    IGNORE,
    LATE,
    PART,
    RUBRIC,
    TEST,
)
from grader.lab.rubric.rubric import load_rubric
from grader.lab.submission.opening import open_submission
from grader.report.examples import example_blocks, explanation_of
from grader.report.explanations import CAUSES_OF_CHECK, EFFECTS, default_text
from grader.report.json_data import to_json
from grader.report.writers.terminal import render_terminal
from grader.ros.workspace.problem_kinds import EVERY_KIND

KEYS = {
    "The rubric": RUBRIC,
    "[[part]]": PART,
    "[[criterion]]": CRITERION,
    "[criterion.carried]": CARRIED,
    "[defaults]": DEFAULTS,
    "[[evidence]]": EVIDENCE,
    "[late]": LATE,
    "[adjust.CRITERION]": ADJUSTMENT,
    "[test]": TEST,
    "[[test.ignore]]": IGNORE,
}
LANGUAGES = {
    ".launch": "xml",
    ".yaml": "yaml",
    ".md": "markdown",
    ".py": "python",
    ".rviz": "yaml",
    ".toml": "toml",
    ".txt": "text",
    ".urdf": "xml",
    ".xacro": "xml",
    ".xml": "xml",
}
DOCS = Path(__file__).resolve().parent
SAMPLE = DOCS.parent / "submissions/lab6/lidar-offset-in-visual/my_robot/urdf/my_robot.urdf"


def pages() -> dict[str, str]:
    """Return the text of each page with generated content by its file name."""
    report = sample_report()
    return {
        "problems.md": filled("problems.md", problems()),
        "checks.md": filled("checks.md", checks()),
        "rubric-reference.md": filled("rubric-reference.md", keys()),
        "grade-one-submission.md": filled(
            "grade-one-submission.md", ["```", terminal(report).rstrip(), "```"]
        ),
        "report.svg": picture(report),
        **{f"schemas/{name}.json": to_json(json_schema(name)) for name in get_args(SchemaName)},
    }


def filled(name: str, lines: Iterator[str] | list[str]) -> str:
    """Return a page with these lines between its two comments on generated text."""
    text = (DOCS / name).read_text(encoding="utf-8")
    content = "\n".join(lines)
    return re.sub(
        r"(<!-- generated .*?-->\n).*?(?=<!-- end)",
        lambda found: f"{found[1]}\n{content}\n\n",
        text,
        flags=re.DOTALL,
    )


def problems() -> Iterator[str]:
    """Yield a list of all problems, and a section for each with what `grader explain` prints."""
    for kind in EVERY_KIND:
        yield f"- [`{kind.code}`](#{kind.code.lower()}) ({kind.severity}): {escaped(kind.title)}"
    yield ""
    for kind in EVERY_KIND:
        effect = f" {EFFECTS[kind.effect]}".rstrip()
        yield from (f"## {kind.code}", "", f"{escaped(kind.title)} ({kind.severity}).", "")
        yield from (escaped(explanation_of(kind)) + effect, "", *example(kind.code))


def checks() -> Iterator[str]:
    """Yield a list of all checks, and a section for each with what `grader explain` prints."""
    for check in own_checks():
        yield f"- [`{check.name}`](#{check.name}): {escaped(check.documentation.paragraphs[0])}"
    yield ""
    for check in own_checks():
        yield from (f"## `{check.name}`", "")
        for paragraph in check.documentation.paragraphs:
            yield from (escaped(paragraph), "")
        if check.parameters:
            yield from ("| argument | meaning | type | default |", "|---|---|---|---|")
        for name, parameter in check.parameters.items():
            default = "required" if parameter.required else f"`{default_text(parameter.default)}`"
            meaning = escaped(check.documentation.arguments[name])
            yield f"| `{name}` | {meaning} | {parameter.type.name} | {default} |"
        if check.parameters:
            yield ""
        if check.about.causes:
            yield from (f"{CAUSES_OF_CHECK}:", "")
            for cause, meaning in check.about.causes.items():
                yield f"- `{cause}`: {escaped(meaning)}"
            yield ""
        yield from example(check.name)


def keys() -> Iterator[str]:
    """Yield a section for each table of a rubric, with a line for each key."""
    for title, table in KEYS.items():
        yield from (f"### {title}", "")
        for name, kind in table.keys.items():
            needed = ", required" if name in table.required else ""
            yield (
                f"- `{name}` ({kind.name.removeprefix('a ')}{needed}): "
                f"{escaped(kind.schema['description'])}"
            )
        yield ""


def example(name: str) -> Iterator[str]:
    """Yield the code blocks of the example of a problem or a check."""
    for title, file, text in example_blocks(name):
        yield from (f"{title}:", "", f"```{LANGUAGES[Path(file).suffix]}", text, "```", "")


def sample_report() -> Report:
    """Return the report on a sample submission."""
    rubric = load_rubric("lab6")
    submission = open_submission(str(SAMPLE), rubric.lab)
    return hinted(grade(rubric, submission), submission, rubric.hints).report


def terminal(report: Report) -> str:
    """Return a report as it is printed without a terminal."""
    output = StringIO()
    render_terminal(report, Console(width=80, file=output, color_system=None, highlight=False))
    return output.getvalue()


def picture(report: Report) -> str:
    """Return a report as a drawing of a terminal, in SVG."""
    output = StringIO()
    render_terminal(
        report, Console(width=80, file=output, force_terminal=True, color_system="truecolor")
    )
    console = Console(record=True, width=80, file=StringIO())
    console.print(Text.from_ansi(output.getvalue()), end="")
    drawing = console.export_svg(title="grader grade my_robot", unique_id="grader-report")
    return re.sub(
        r"\s*@font-face \{.*?\}", "", drawing, flags=re.DOTALL
    )  # a viewer fetches no fonts


def escaped(text: str) -> str:
    """Return text in which tags are not HTML, asterisks are no emphasis, and bars do not end a
    table cell.
    """
    return re.sub(
        r"(`[^`]*`)|([<*])", lambda found: found[1] or {"<": "&lt;", "*": r"\*"}[found[2]], text
    ).replace("|", "\\|")


if __name__ == "__main__":
    for name, text in pages().items():
        (DOCS / name).parent.mkdir(exist_ok=True)
        (DOCS / name).write_text(text, encoding="utf-8")
