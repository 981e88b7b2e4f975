"""Reports in the terminal: readable at any width, plain in a pipe, and never controlled by a student's text."""

from functools import cache
from io import StringIO

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rich.console import Console

from grader.base.source import Location, Source
from grader.base.text import printable
from grader.lab.grading.grade import grade
from grader.lab.grading.report import ManualMark, Report
from grader.lab.rubric.rubric import load_rubric
from grader.lab.submission.opening import read_submission
from grader.report.inspection import InspectedRobot, Inspection, main_root
from grader.report.writers.inspection_terminal import inspection_terminal
from grader.report.writers.terminal import render_terminal
from grader.report.writers.terminal_page import Page, excerpt_block
from grader.ros.urdf.kinematics import Configuration
from tests.samples import SAMPLES, opened

URDF = "submissions/lab6/reference/roscourse_sim_ws/src/my_robot/urdf/my_robot.urdf"
RUBRIC = load_rubric("lab6")
HOSTILE = (
    b'<robot name="[bold red]\x1b[31m"><link name="lidar\x1b]8;;http://x\x07"/>\n'
    b'<joint name="[/] [link=x]" type="\xe2\x80\xaefixd"><parent link="\x9b31m"/><child link="\xff\xfe"/></joint>\n'
    b'<link name="lidar"><visual><origin xyz="\x1b[2J 0 0"/></visual></link></robot>'
)


def printed(data: bytes, width: int = 80, *, terminal: bool = False) -> str:
    """Return a report and an inspection of a file's bytes for a console of this width."""
    out = StringIO()
    console = Console(
        file=out,
        width=width,
        force_terminal=terminal,
        color_system="standard" if terminal else None,
    )
    submission = read_submission(data, identity="a", path="a.urdf")
    render_terminal(grade(RUBRIC, submission), console)
    reading = submission.needed_urdf()
    robot = Configuration(reading.robot) if reading.robot is not None else None
    shown = InspectedRobot("a.urdf", reading, robot, main_root(robot) if robot else None)
    inspection_terminal(Inspection("a.urdf", (shown,)), console)
    return out.getvalue()


def test_hostile_text_is_escaped() -> None:
    """Escapes, hyperlinks, bidirectional marks and rich markup are printed as characters."""
    text = printed(HOSTILE)
    assert not any(ord(character) < 0x20 and character != "\n" for character in text)
    assert not set(text) & {"\x7f", "\x9b", "\u202e"}
    assert "[bold red]" in text
    coloured = printed(HOSTILE, terminal=True)
    assert "\x1b[2J" not in coloured
    assert "\x1b]" not in coloured
    assert "\x1b[31m[bold" not in coloured


@given(st.text(max_size=40))
def test_printable_text_is_printable(text: str) -> None:
    """No control, format or undecodable character remains, and visible text is unchanged."""
    shown = printable(text)
    assert shown.isprintable()
    shown.encode()
    if text.isprintable():
        assert shown == text


@pytest.mark.parametrize("width", [40, 60, 80, 120])
@pytest.mark.parametrize(
    "name", ["reference", "several-mistakes", "raw-xacro", "links-without-joints"]
)
def test_no_line_is_wider_than_the_terminal(name: str, width: int) -> None:
    """Text wraps and source lines are cut, in a report as in an inspection's problems."""
    out = StringIO()
    report = SAMPLES[name].grade()
    render_terminal(report, Console(file=out, width=width))
    lines = out.getvalue().splitlines()
    assert max(map(len, lines)) <= width
    assert not any(line != line.rstrip() for line in lines)


def shown(report: Report, *, verbose: bool = False) -> str:
    """Return a report at 80 columns."""
    out = StringIO()
    render_terminal(report, Console(file=out, width=80), verbose=verbose)
    return out.getvalue()


@cache
def report_of(name: str) -> Report:
    """Return a sample's report; `urdf` is that on the reference's URDF alone."""
    return grade(RUBRIC, opened(URDF)) if name == "urdf" else SAMPLES[name].grade()


def test_a_skip_without_a_failure_is_shown() -> None:
    """A manual mark may give the points of a criterion because of which others are skipped."""
    report = report_of("links-without-joints")
    results = tuple(
        result._replace(manual_mark=ManualMark(result.criterion.points, "Ada", "seen in RViz"))
        if result.criterion.id == "lidar-fixed"
        else result
        for result in report.results
    )
    text = shown(report._replace(results=results))
    assert "-8 points: lidar-frame 6, lidar-on-top 2\n  Skipped because lidar-fixed failed." in text
    assert "\u2713 lidar-fixed  1/1: Marked by Ada: seen in RViz." in text


@pytest.mark.parametrize(
    ("line", "column", "underlined"),
    [
        ('  <origin xyz="0 0 0" rpy="1 2 3"/>', 11, 'xyz="0 0 0"'),
        ('  <origin xyz = "0 0 0"/>', 11, 'xyz = "0 0 0"'),
        ("<a b='1\" 2' c='3'/>", 4, "b='1\" 2'"),
        ('    <link name="a"/>', 5, '<link name="a"/>'),
        ("\t\t<x>", 3, "<x>"),
        ('<a b="unfinished', 4, 'b="unfinished'),
    ],
)
def test_the_location_is_underlined(line: str, column: int, underlined: str) -> None:
    """The marks are below the attribute or tag, from its first character to its last."""
    out = StringIO()
    console = Console(file=out, width=80)
    Page(
        console,
        [excerpt_block(console, Source("a.urdf", f"\n{line}\n"), Location("a.urdf", 2, column), 4)],
    ).print()
    text, marks = out.getvalue().splitlines()
    start, end = marks.index("\u2500"), marks.rindex("\u2500") + 1
    assert text[start:end] == underlined


def test_a_long_line_is_cut_around_the_location() -> None:
    """The underlined text is in view, even far to the right."""
    out = StringIO()
    line = "<a>" * 500 + '<b c="d"/>'
    console = Console(file=out, width=60)
    Page(
        console, [excerpt_block(console, Source("a.urdf", line), Location("a.urdf", 1, 1504), 4)]
    ).print()
    text, marks = out.getvalue().splitlines()
    assert 'c="d"' in text
    assert max(len(text), len(marks)) <= 60
    start, end = marks.index("\u2500"), marks.rindex("\u2500") + 1
    assert text[start:end] == 'c="d"'


@pytest.mark.slow
def test_a_tree_of_thousands_of_links_is_limited() -> None:
    """A deep chain is drawn without recursion and with limited indentation; the rest is counted."""
    links = "".join(
        f'<link name="l{i}"/><joint name="j{i}" type="fixed"><parent link="l{i - 1}"/><child link="l{i}"/></joint>'
        for i in range(1, 3000)
    )
    text = printed(f'<robot name="r"><link name="l0"/>{links}</robot>'.encode())
    assert "l499" in text
    assert "l500" not in text
    assert text.count("  ... and 2500 more (--format json lists all)\n") == 2
