"""The stories of CONTRIBUTING, performed in a copy of the project: its steps are sufficient."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.checkout import checkout
from tests.command_line import HANG_TIMEOUT

pytestmark = pytest.mark.exhaustive

CHECK = '''

def shows_cube(robot: Configuration, *, link: str, distance: NonNegative, tolerance: NonNegative) -> Outcome:
    """A link shows a cube whose opposite faces have the given distance in metres.

    Args:
        link: The link that is examined.
        distance: The distance of opposite faces, in metres.
        tolerance: How far each length may be off, in metres.
    """
    return shows_box(robot, link=link, size=(distance, distance, distance), tolerance=tolerance)
'''
ROWS = """\
with = { link = "base", distance = 0.2, tolerance = 0.002 }
meshes = "failed"

[edges]
tolerance = [["0.2 0.2 0.2", "0.2 0.2 {}", 0.2, 1]]

[[row]]
about = "Opposite faces have the distance."
scene = "base"
edits = [["0.6 0.4", "0.2 0.2"]]

[[row]]
scene = "base"
"""
EXAMPLE = """
[shows_cube]
with = { link = "base", distance = 0.2, tolerance = 0.002 }
wrong = '<link name="base"><visual><geometry><box size="0.2 0.2 0.3"/></geometry></visual></link>'
right = '<link name="base"><visual><geometry><box size="0.2 0.2 0.2"/></geometry></visual></link>'
"""
RUBRIC = """\
id = "lab0"
title = "Lab 0: one box"
reference = "robot.urdf"

[[part]]
id = "model"
title = "The model"

[[criterion]]
id = "box"
part = "model"
title = "The base shows a box 0.6 x 0.4 x 0.2"
points = 2
check = "shows_box"
with = { link = "base", size = [0.6, 0.4, 0.2], tolerance = 0.002 }
"""
REFERENCE = """\
<?xml version="1.0"?>
<robot name="box">
  <link name="base"><visual><geometry><box size="0.6 0.4 0.2"/></geometry></visual></link>
</robot>
"""
FORMAT = '''"""A report as one line: the submission and its score."""

from grader.lab.grading.report import Report
from grader.base.text import printable


def render_line(report: Report) -> str:
    """Return a report in one line."""
    return f"{printable(report.submission.id)}: {report.score} of {report.max_score}\\n"
'''
LMS = """\
SAKAI = Form(
    "Sakai",
    {"login": "student id", "name": "name"},
    ("login",),
    re.compile(r"(?P<title>.*?) \\[(?P<maximum>[0-9.,]+)\\]"),
)
"""

NEWER = """\
controller_server:
  ros__parameters:
    controller_plugins: ["FollowPath"]
    a_parameter_of_a_newer_release: 1.0
"""
RULE = '''"""What the author of a launch file left in it."""

from collections.abc import Iterator

from grader.base.source import Source
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import Compared, Fact, Mismatch, warning
from grader.workspace.rules.rule_table import ONE_MACHINE, Rule

_NOTE_LEFT = Rule(
    "note-left",
    "machine",
    ONE_MACHINE,
    "No launch file has a note of its author.",
    why="A reader does not know whether the file is finished.",
    wrong="Node(package='turtlesim', executable='turtlesim_node', name='FIXME'),",
    right="Node(package='turtlesim', executable='turtlesim_node', name='turtle'),",
)


def author_note_facts(workspace: Workspace) -> Iterator[Fact]:
    """Yield the notes of authors in launch files."""
    for package in workspace.packages:
        for source in workspace.texts.launch_sources(package):
            yield Compared("machine")
            yield from _notes(source)


def _notes(source: Source) -> Iterator[Mismatch]:
    """Yield the first note of an author in a launch file."""
    at = source.text.find("FIXME")
    if at >= 0:
        yield warning(_NOTE_LEFT, "the launch file has a note of its author", source.at(at))
'''
VARIANT = """
[[variant]]
about = "a word of a note in lower case is no note"
of = "note-left"
text = "Node(package='turtlesim', executable='turtlesim_node', name='fixme'),"
found = false
"""


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """Return a copy of the project that may be changed."""
    return checkout(tmp_path / "project")


def replace(path: Path, old: str, new: str) -> None:
    """Replace the first occurrence of a text in a file, which must exist."""
    text = path.read_text(encoding="utf-8")
    assert old in text, f"{path} does not hold {old!r}"
    path.write_text(text.replace(old, new, 1), encoding="utf-8")


def python(project: Path, *arguments: str) -> None:
    """Run Python in the copy of the project, with its modules; show the output if it fails."""
    done = subprocess.run(
        [sys.executable, *arguments],
        cwd=project,
        env={**os.environ, "PYTHONPATH": str(project)},
        capture_output=True,
        text=True,
        check=False,
        timeout=3 * HANG_TIMEOUT,  # it runs some hundred tests
    )
    assert done.returncode == 0, done.stdout[-5000:] + done.stderr[-5000:]


def passes(project: Path, *tests: str, new: str = "") -> None:
    """Run tests in the copy of the project: those of the README's command, and each case of what is new."""
    options = ("-m", "pytest", "-q", "-n0", "-p", "no:cacheprovider", "--no-header")
    python(project, *options, "-m", "not slow and not exhaustive", *tests)
    if new:  # fails if no test has a case of it
        python(project, *options, "-m", "not exhaustive", "-k", new, *tests)


def add_to_changelog(project: Path, line: str) -> None:
    """Add a line to the unreleased changes."""
    replace(project / "CHANGELOG.md", "## [Unreleased]\n", f"## [Unreleased]\n\n- {line}\n")


def test_a_new_check(project: Path) -> None:
    """A check is a function, a line of the registry, a sample, an example and a line of the changelog; the catalogue is generated."""
    for file, text in (
        ("grader/lab/checks/appearance.py", CHECK),
        ("docs/examples/checks.toml", EXAMPLE),
    ):
        with (project / file).open("a", encoding="utf-8") as opened:
            opened.write(text)
    replace(
        project / "grader/lab/checks/registry.py",
        "CHECKS = (\n",
        'CHECKS = (\n    "appearance.shows_cube",\n',
    )
    (project / "tests/corpus/checks/shows_cube.toml").write_text(ROWS, encoding="utf-8")
    python(project, "-m", "tests.checks", "shows_cube")
    python(project, "docs/make.py")
    add_to_changelog(project, "The check `shows_cube`.")
    passes(
        project,
        "tests/test_registry.py",
        "tests/test_catalogue_examples.py",
        "tests/test_architecture.py",
        "tests/test_docs.py",
        "tests/checks",
        new="shows_cube",
    )


def test_a_new_release(project: Path) -> None:
    """A release is a name, its second name and its Ubuntu; the tables know nothing of it, and nothing is wrong for it."""
    replace(project / "grader/ros/known/releases.py", '"rolling"', '"mighty", "rolling"')
    stated = project / "grader/workspace/model/stated_releases.py"
    replace(stated, "|Ridley", "|Mantaray|Ridley")
    replace(
        stated,
        '("lyrical",)),\n',
        '("lyrical",)),\n    **dict.fromkeys(("28.04", "zesty"), ("mighty",)),\n',
    )
    python(project, "docs/make.py")
    for cases in ("ignoring", "releases", "schema"):
        python(project, "-m", "tests.corpus", cases)
    add_to_changelog(project, "The release `mighty`.")
    workspace = project / "workspace"
    shutil.copytree(project / "rubrics/lab6/my_robot", workspace / "src/my_robot")
    (workspace / "src/my_robot/params.yaml").write_text(NEWER, encoding="utf-8")
    (workspace / "README.md").write_text("For ROS 2 Mighty Mantaray on Ubuntu 28.04.\n")
    python(project, "-m", "grader", "inspect", str(workspace))
    python(project, "-m", "grader", "inspect", str(workspace), "--distro", "mighty")
    passes(
        project,
        "tests/known",
        "tests/parameters",
        "tests/workspace/test_stated_releases.py",
        "tests/corpus",
        "tests/test_docs.py",
    )


def test_a_new_rubric(project: Path) -> None:
    """A rubric is a TOML file and its reference solution."""
    (project / "rubrics/lab0").mkdir()
    (project / "rubrics/lab0/rubric.toml").write_text(RUBRIC, encoding="utf-8")
    (project / "rubrics/lab0/robot.urdf").write_text(REFERENCE, encoding="utf-8")
    python(project, "-m", "grader", "rubric", "check", "lab0")
    passes(
        project,
        "tests/test_submissions.py",
        "tests/grading",
        "tests/bundle",
        "tests/cli/test_answers.py",
        new="lab0",
    )


def test_a_new_rule(project: Path) -> None:
    """A rule is an entry with its function, a variant and a line of the changelog; the pages are made, and it fits the budget."""
    rules = project / "grader/workspace/rules"
    (rules / "author_notes.py").write_text(RULE, encoding="utf-8")
    with (project / "tests/workspace/rule_variants.toml").open("a", encoding="utf-8") as variants:
        variants.write(VARIANT)
    add_to_changelog(project, "The rule `note-left`.")
    python(project, "docs/make.py")
    passes(
        project,
        "tests/workspace",
        "tests/test_architecture.py",
        "tests/test_misconfigurations.py",
        "tests/test_docs.py",
        new="note",
    )


def test_a_new_format(project: Path) -> None:
    """A format is a module, a row of the registry, a row of the documentation and a line of the changelog."""
    (project / "grader/report/writers/line.py").write_text(FORMAT, encoding="utf-8")
    row, last = '    LINE = "line", "writers.line:render_line"', '"writers.svg:render_svg"\n'
    replace(project / "grader/report/formats.py", last, f"{last}{row}\n")
    replace(
        project / "docs/command-line.md",
        "| `markdown` |",
        "| `line` | logs | one line |\n| `markdown` |",
    )
    add_to_changelog(project, "The format `line`.")
    python(
        project,
        "-m",
        "grader",
        "grade",
        "submissions/lab6/several-mistakes",
        "--format",
        "line",
        "--fail-under",
        "0",
    )
    passes(
        project,
        "tests/report",
        "tests/cli/test_save.py",
        "tests/submission",
        "tests/test_architecture.py",
        "tests/test_docs.py",
        new="line",
    )


def test_a_new_lms(project: Path) -> None:
    """A grade file of an LMS is a form, and its name in the documentation."""
    forms = project / "grader/classroom/lms/forms.py"
    replace(forms, "FORMS = {", f"{LMS}FORMS = {{")
    replace(forms, "BRIGHTSPACE)}", "BRIGHTSPACE, SAKAI)}")
    replace(project / "docs/command-line.md", "|brightspace|", "|brightspace|sakai|")
    book, exported, filled = (
        str(project / name) for name in ("class-grades", "sakai.csv", "upload.csv")
    )
    Path(exported).write_text("Student ID,Name,Lab 6 [100]\nash,Ash,\n", encoding="utf-8")
    shutil.copytree(project / "submissions/lab6/reference", project / "class/ash")
    python(project, "-m", "grader", "batch", "class", "--gradebook", book)
    export = (
        "export",
        "sakai",
        "--gradebook",
        book,
        "--into",
        exported,
        "--output",
        filled,
        "--pending-as-zero",
    )
    python(project, "-m", "grader", *export)
    assert (
        Path(filled).read_text(encoding="utf-8") == "Student ID,Name,Lab 6 [100]\nash,Ash,90.00\n"
    )
    passes(project, "tests/classroom/lms", "tests/test_docs.py")
