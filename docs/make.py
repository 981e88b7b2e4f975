"""Write the pages that are generated from the code: `python docs/make.py`. The tests fail if they are out of date."""

import re
from io import StringIO
from pathlib import Path

from rich.console import Console

from grader.checks.registry import CHECKS, describe
from grader.grading.grade import grade
from grader.grading.rubric import load_rubric
from grader.report.rubrics import EFFECTS, EVERY_KIND
from grader.report.terminal import render_terminal
from grader.submission.submission import open_submission

DOCS = Path(__file__).resolve().parent
SHOWN = DOCS.parent / "submissions" / "lidar-offset-in-visual" / "my_robot.urdf"


def pages() -> dict[str, str]:
    """Return the text of every generated page by its file name."""
    return {"problems.md": problems(), "checks.md": checks(), "report.svg": picture()}


def problems() -> str:
    """Return the catalogue of problems."""
    lines = [
        "# Problems",
        "",
        "<!-- made by docs/make.py from grader/robot/catalogue.py and grader/package/catalogue.py -->",
        "",
        "The problems that `grader grade` and `grader inspect` report: of a URDF (`URDF`), a package (`PKG`), a launch file (`LCH`)",
        "and an RViz file (`RVZ`). A code never changes its meaning. With an *error*, ROS 2 (Jazzy) does not load the file, or a",
        "build or launch fails. A *warning* changes what ROS 2 shows or does. A *note* is information.",
        "`grader explain URDF051` prints one entry.",
        "",
        "| code | | problem |",
        "|---|---|---|",
    ]
    lines += [
        f"| [{kind.code}](#{kind.code.lower()}) | {kind.severity} | {escaped(kind.title)} |" for kind in EVERY_KIND
    ]
    for kind in EVERY_KIND:
        lines += [
            "",
            f"## {kind.code}",
            "",
            f"**{escaped(kind.title)}** ({kind.severity}). {EFFECTS[kind.effect]}".rstrip(),
            "",
        ]
        lines += [escaped(kind.explanation)]
    return "\n".join(lines) + "\n"


def checks() -> str:
    """Return the catalogue of checks."""
    lines = [
        "# Checks",
        "",
        "<!-- made by docs/make.py from grader/checks -->",
        "",
        "A criterion of a rubric names one of these checks as its `check`, and gives the arguments in its `with` table. Lengths",
        "are in metres, angles in degrees, colour channels from 0 to 1. Checks of a robot use forward kinematics with every joint",
        "at 0, unless they move a joint themselves. Checks of a package read its files and run none of them.",
    ]
    for function in CHECKS:
        check = describe(function)
        lines += ["", f"## {check.name}", "", escaped(check.fact)]
        if check.parameters:
            lines += ["", "| argument | type | default |", "|---|---|---|"]
        for parameter in check.parameters.values():
            default = "required" if parameter.required else f"`{parameter.default}`"
            lines.append(f"| `{parameter.name}` | {parameter.type.name} | {default} |")
    return "\n".join(lines) + "\n"


def picture() -> str:
    """Return the picture of a report in a terminal, as SVG."""
    rubric = load_rubric("lab6")
    report = grade(rubric, open_submission(str(SHOWN), wanted=rubric.urdf, package=rubric.package))
    console = Console(
        record=True, width=80, file=StringIO(), force_terminal=True, color_system="truecolor", highlight=False
    )
    render_terminal(report, console)
    drawing = console.export_svg(title="grader grade my_robot", unique_id="grader-report")
    return re.sub(r"\s*@font-face \{.*?\}", "", drawing, flags=re.DOTALL)  # nothing is fetched to look at it


def escaped(text: str) -> str:
    """Text with its tags shown rather than taken for HTML."""
    return text.replace("<", "&lt;").replace("|", "\\|")


if __name__ == "__main__":
    for name, text in pages().items():
        (DOCS / name).write_text(text, encoding="utf-8")
