"""Reports in the terminal: readable at any width, plain in a pipe, and never controlled by a student's text."""

from functools import cache
from io import StringIO

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rich.console import Console
from rich.text import Text

from grader.grading.grade import grade
from grader.grading.report import ManualMark, Report
from grader.grading.rubric import load_rubric
from grader.report.console import block, excerpt_block, put
from grader.report.inspection import Inspection, inspection_terminal, main_root
from grader.report.order import FailedCriterion, earned_text, groups, in_order
from grader.report.terminal import render_terminal
from grader.robot.kinematics import Configuration
from grader.source import Location, Source
from grader.submission.opening import read_submission
from grader.text import printable
from tests.samples import REPORTED, SAMPLES, opened

URDF = "submissions/lab6/reference/roscourse_sim_ws/src/my_robot/urdf/my_robot.urdf"
LIDAR = """\
\u2717 lidar-frame  -6 points  my_robot.urdf:30:13
  The frame 'lidar' is at 0.15 0 0.2 m in 'base_link'; it should be at 0.15 0
  0.225 m (z 25 mm too small).
  30 \u2502 <origin xyz="0.15 0 0.2"/>
     \u2502         \u2500\u2500\u2500\u2500\u2500\u2500\u2500\u2500\u2500\u2500\u2500\u2500\u2500\u2500\u2500\u2500
  The joint's origin places the lidar's frame, and every scan is measured in
  that frame: if the frame is turned, so is what the lidar sees. The visual's
  origin moves only the shape. Halfway from the middle to the front is 0.6 / 4;
  the top is the base's height plus half of the lidar's."""
RUBRIC = load_rubric("lab6")
HOSTILE = (
    b'<robot name="[bold red]\x1b[31m"><link name="lidar\x1b]8;;http://x\x07"/>\n'
    b'<joint name="[/] [link=x]" type="\xe2\x80\xaefixd"><parent link="\x9b31m"/><child link="\xff\xfe"/></joint>\n'
    b'<link name="lidar"><visual><origin xyz="\x1b[2J 0 0"/></visual></link></robot>'
)


def printed(data: bytes, width: int = 80, *, terminal: bool = False) -> str:
    """Return a report and an inspection of a file's bytes for a console of this width."""
    out = StringIO()
    console = Console(file=out, width=width, force_terminal=terminal, color_system="standard" if terminal else None)
    submission = read_submission(data, identity="a", path="a.urdf")
    render_terminal(grade(RUBRIC, submission), console)
    reading = submission.needed_urdf()
    robot = Configuration(reading.robot) if reading.robot is not None else None
    inspection_terminal(Inspection("a.urdf", reading, robot, main_root(robot) if robot else None), console)
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
@pytest.mark.parametrize("name", ["reference", "several-mistakes", "raw-xacro", "links-without-joints"])
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


def costs(report: Report) -> list[FailedCriterion]:
    """Return the failures that cost points."""
    return [failure for failure in in_order(report).failures if not failure.result.why_given]


every_sample = pytest.mark.parametrize("name", [*REPORTED, "urdf"])


@every_sample
def test_the_score_comes_last(name: str) -> None:
    """Above it are the summary and the next command, where the eye is when the command ends."""
    report = report_of(name)
    *_, before, last = shown(report).splitlines()
    assert last == f"{report.score}/{report.max_score}  {report.rubric.title}"
    if report.counts("failed"):
        assert "grader explain " in " ".join(f"{shown(report).splitlines()[-3]} {before}".split())
    else:
        assert before.startswith(("Nothing to fix", "Next: "))


@every_sample
def test_a_report_is_short(name: str) -> None:
    """With at most three failures it takes at most 26 rows; others take at most five rows each."""
    report = report_of(name)
    rows, number = len(shown(report).splitlines()), len(costs(report))
    assert rows <= (26 if number <= 3 else 24 + 5 * (number - 3))


@every_sample
def test_failures_come_first_and_the_costliest_first(name: str) -> None:
    """First comes what keeps ROS 2 from loading the file. Each has what it costs and where; three have their source line."""
    report = report_of(name)
    is_rejected = report.submission.verdict == "rejected"
    ranks = [
        (not (is_rejected and failure.result.criterion.check.subject == "urdf"), -failure.lost)
        for failure in costs(report)
        if report.submission.package is not None or report.rubric.part(failure.result.criterion.part).needs != "package"
    ]
    assert ranks == sorted(ranks)
    cards = shown(report).split("\n\u2717 ")[1:]
    for number, (failure, card) in enumerate(zip(costs(report), cards, strict=False)):
        where = failure.result.outcome.location
        words = " ".join(card.split())
        assert words.startswith(f"{failure.result.criterion.id} -{failure.lost} point")
        assert ("skipped" in words) >= bool(failure.skipped)
        if where is not None:
            assert f"{where.path}:{where.line}:{where.column}" in card
            source = report.submission.source(where.path)
            is_seen = source is not None and source.line(where.line).strip() != ""
            assert (f"\n  {where.line} \u2502 " in card) == (is_seen and number < 3)


@pytest.mark.parametrize("name", ["lidar-buried", "cylinder-height", "sensors/nothing-included"])
def test_a_full_report_shows_whole_texts(name: str) -> None:
    """With `verbose`, messages, explanations and what is skipped are not cut."""
    report = report_of(name)
    words = " ".join(shown(report, verbose=True).split())
    for failure in costs(report):
        assert printable(failure.result.outcome.message)[1:] in words
        assert " ".join(failure.result.criterion.feedback.split()) in words
        assert f"Passes when: {failure.result.criterion.title}" in words
    assert words.count("skipped because of it") == sum(bool(failure.skipped) for failure in costs(report))


def test_the_marked_line_and_the_feedback() -> None:
    """A whole failure, as a student reads it."""
    assert shown(SAMPLES["lidar-buried"].alone.grade()).split("\n\n")[1] == LIDAR


@every_sample
def test_groups_with_lost_points_are_listed(name: str) -> None:
    """They have their points; those without lost points are listed where there is room for them."""
    report = report_of(name)
    words = " ".join(shown(report).split())
    for group in groups(report):
        is_open = all(result.is_open for result in group.results)
        is_full = all(result.points == result.criterion.points for result in group.results)
        assert is_full or is_open or f"{group.title} {earned_text(*group.results)}" in words
    assert "The left wheel 14/14" in " ".join(shown(SAMPLES["lidar-offset-in-visual"].alone.grade()).split())


def test_what_needs_manual_grading_has_a_line_each() -> None:
    """The name, the points, and where the answer or the picture is; without one, that it was not found."""
    manual = shown(report_of("reference")).split("\n\n")[1]
    assert manual.splitlines() == [
        "10 points need manual grading",
        "? evidence-webcam (2): evidence/Task3_Step3.png",
        "? answer-floating-link (4): answers.md:9",
        "? answer-launch-nodes (4): answers.md:16",
    ]
    assert "answer-launch-nodes (10): not found" in shown(report_of("pictures-only"))
    undecided = shown(report_of("xacro-from-another-package"))
    assert "left-wheel-gray and 17 more (40): The package" in undecided
    assert undecided.splitlines()[-2] == "Next: grader explain urdf-loads"


def test_answers_and_passed_criteria_are_shown_with_verbose() -> None:
    """The short report has neither; what was found is the same."""
    report = report_of("reference")
    short, whole = shown(report), shown(report, verbose=True)
    for words in ("The robot is gone.", "The base's box stands on the ground plane", "Task1_Step8.png"):
        assert (words in short, words in whole) == (False, True)


def test_an_error_that_is_carried_forward_is_one_line() -> None:
    """It names the criteria that keep their points, and where the mistake is counted."""
    report = report_of("base-half-sunk")
    line = "Not deducted: lidar-on-top (caused by base-on-ground)."
    assert line in " ".join(shown(report).split())
    assert "\u2717 lidar-on-top" not in shown(report)
    assert "\u2717 lidar-on-top  0 points" in shown(report, verbose=True)


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
    assert "Skipped because lidar-fixed failed: lidar-frame and lidar-on-top (8 points)." in text
    assert "\u2713 lidar-fixed  1/1: Marked by Ada: seen in RViz." in text


def test_other_problems_are_short() -> None:
    """Of each kind of error and warning the first one; notes are counted."""
    text = " ".join(shown(report_of("rviz-of-ros1")).split())
    assert "RVZ002 warning my_robot.rviz:11 and 1 more: rviz/Grid is a class of ROS 1" in text
    assert shown(report_of("rviz-of-ros1"), verbose=True).count("RVZ002 warning") == 2
    assert "1 note: --verbose shows it" in shown(report_of("base-origin-in-geometry"))
    assert "did you mean 'length'?" in shown(report_of("cylinder-height"), verbose=True)


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
    put(console, excerpt_block(console, Source("a.urdf", f"\n{line}\n"), Location("a.urdf", 2, column), 4))
    text, marks = out.getvalue().splitlines()
    start, end = marks.index("\u2500"), marks.rindex("\u2500") + 1
    assert text[start:end] == underlined


def test_a_long_line_is_cut_around_the_location() -> None:
    """The underlined text is in view, even far to the right."""
    out = StringIO()
    line = "<a>" * 500 + '<b c="d"/>'
    console = Console(file=out, width=60)
    put(console, excerpt_block(console, Source("a.urdf", line), Location("a.urdf", 1, 1504), 4))
    text, marks = out.getvalue().splitlines()
    assert 'c="d"' in text
    assert max(len(text), len(marks)) <= 60
    start, end = marks.index("\u2500"), marks.rindex("\u2500") + 1
    assert text[start:end] == 'c="d"'


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


@pytest.mark.parametrize(
    ("width", "shown"),
    [
        (26, "the lowest point is at"), (28, "the lowest point is at"), (29, "the lowest point is at 50 mm"),
        (40, "the lowest point is at 50 mm below the"),
    ],
)  # fmt: skip
def test_a_number_and_its_unit_are_not_cut(width: int, shown: str) -> None:
    """The text ends before a number whose unit has no room."""
    text = Text("the lowest point is at 50 mm below the ground, and more")
    assert block(Console(width=width), text, 0, most=1).plain.rstrip("\u2026.") == shown
