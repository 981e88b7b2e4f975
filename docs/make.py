"""Write the pages that are made from the code: `python docs/make.py`. The tests fail where they are out of date."""

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
    """The text of every made page by its file name."""
    return {"problems.md": problems(), "checks.md": checks(), "report.svg": picture()}


def problems() -> str:
    """The catalogue of what can be wrong with a URDF."""
    lines = [
        "# Problems",
        "",
        "<!-- made by docs/make.py from grader/robot/catalogue.py and grader/package/catalogue.py -->",
        "",
        "What `grader grade` and `grader inspect` can say of a URDF (`URDF`), a package (`PKG`), a launch file (`LCH`) and an RViz",
        "file (`RVZ`). Codes never change their meaning. An *error* keeps ROS 2 (Jazzy) from loading the file, or a build or launch",
        "from working; a *warning* changes what is shown or done; a *note* is worth knowing.",
        "`grader explain URDF051` prints an entry.",
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
    """The checks that a rubric can name."""
    lines = [
        "# Checks",
        "",
        "<!-- made by docs/make.py from grader/checks -->",
        "",
        "What a criterion of a rubric can name as its `check`, with the arguments that its `with` table gives. Lengths are",
        "metres, angles degrees, colour channels 0 to 1. Checks of a robot measure with forward kinematics, all joints at 0",
        "unless they move one themselves; checks of a package read its files and run none of them.",
    ]
    for function in CHECKS:
        check = describe(function)
        lines += ["", f"## {check.name}", "", escaped(check.fact)]
        if check.parameters:
            lines += ["", "| argument | what | |", "|---|---|---|"]
        for each in check.parameters.values():
            default = "needed" if each.required else f"`{each.default}` unless told"
            lines.append(f"| `{each.name}` | {each.type.name} | {default} |")
    return "\n".join(lines) + "\n"


def picture() -> str:
    """A real report as a terminal shows it."""
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
