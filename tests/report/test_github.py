"""Annotations of GitHub Actions: read back as the runner reads them, each is on its own line of the file."""

from hypothesis import given
from hypothesis import strategies as st

from grader.base.problems import Problem
from grader.base.source import Base, Location
from grader.base.text import printable
from grader.lab.grading.report import Report
from grader.report.writers.annotations import render_github
from grader.report.writers.workflow_commands import command
from grader.ros.urdf.urdf_problems import UNDEFINED_MATERIAL
from tests.report.readers import read_commands
from tests.report.workflow_commands import Command
from tests.samples import SAMPLES

MAX_ANNOTATIONS = 10  # annotations of each type that GitHub shows for a step
NAMES = {"error": "error", "warning": "warning", "note": "notice"}
LAB = Base("lab/")


def annotated(report: Report, base: Base = LAB) -> list[Command]:
    """Return the annotations of a report."""
    return read_commands(render_github(report, base))


def test_eleven_findings_are_nine_and_the_rest() -> None:
    """Ten findings are all shown; only with more does the last annotation count the rest."""
    report = SAMPLES["reference"].grade()
    for count, last in ((10, UNDEFINED_MATERIAL.code), (11, "2 more")):
        problems = tuple(
            Problem(UNDEFINED_MATERIAL, f"message {number}", Location("a.urdf", number, 1))
            for number in range(1, count + 1)
        )
        found = [
            command
            for command in annotated(report._replace(problems=problems))
            if command.name == "warning"
        ]
        assert len(found) == MAX_ANNOTATIONS
        assert found[-1].get("title") == last


def test_a_long_message_is_cut_before_escaping() -> None:
    """No escape is cut in two."""
    (reported,) = read_commands(command("error", {}, "t", "%" * 5000))
    assert reported.data == "%" * 4000 + "..."


TEXT = st.text().map(printable).filter(lambda text: text == text.strip() and text)


@given(st.sampled_from(list(NAMES.values())), TEXT, TEXT, st.lists(TEXT, min_size=1).map("\n".join))
def test_any_text_survives_escaping(name: str, path: str, title: str, text: str) -> None:
    """Colons, commas, percent signs and line breaks are unchanged in every part of a command."""
    (reported,) = read_commands(command(name, {"file": path, "line": "3"}, title, text))
    assert reported == Command(name, (("file", path), ("line", "3"), ("title", title)), text)
