"""The student's page says what the terminal says with `--verbose`, failures first, and nothing of the submission is markup."""

import json
import sys
from collections.abc import Callable
from dataclasses import replace
from decimal import Decimal
from pathlib import Path
from typing import Any

import pytest
from lxml import html

from grader.checks.outcome import Outcome
from grader.grading.grade import grade
from grader.grading.graded_submission import Grade
from grader.grading.report import ManualMark, Report
from grader.report.formats import Format, render
from grader.report.pages.student import render_html
from grader.submission.opening import read_submission
from tests.command_line import run
from tests.report.reports import AXLE, adjusted, hinted, marked
from tests.samples import LAB6, ROOT, SAMPLES, opened

sys.path.insert(0, str(ROOT / "benchmarks"))  # a folder of scripts
from pages import chain

MAX_SIZE = 300_000  # bytes


def read(text: str | bytes) -> Any:
    """Return the root of a page."""
    return html.document_fromstring(text)


def test_page_has_score_and_failures_first() -> None:
    """The score is large, and the costliest failure is the first one."""
    page = read(run(("grade", "submissions/lab6/axis-negated/my_robot/urdf/my_robot.urdf", "--format", "html")).stdout)
    assert page.find_class("score")[0].text_content().strip() == "64 / 70 points"
    first = page.xpath("//article")[0]
    assert first.get("id") == "criterion-left-wheel-forward"


def test_page_shows_hints_with_their_lines() -> None:
    """A hint has its message and the lines of its diff, the old ones and the new ones."""
    page = read(render_html(hinted()))
    card = page.get_element_by_id("criterion-right-wheel-forward")
    assert 'Change rpy="1.57 0 0" to' in card.find_class("hint")[0].text_content()
    assert [line.text.strip() for line in card.iter("del")] == ['-      <origin xyz="-0.15 -0.2 0" rpy="1.57 0 0" />']


def test_page_marks_the_place_in_the_source() -> None:
    """The lines around a place have their numbers, and what is meant is marked."""
    page = read(render_html(hinted()))
    source = page.get_element_by_id("criterion-right-wheel-forward").find_class("source")[0]
    assert [int(number.text) for number in source.find_class("line-number")] == [71, 72, 73, 74, 75]
    assert [mark.text for mark in source.iter("mark")] == ['rpy="1.57 0 0"']


def test_page_shows_manual_marks() -> None:
    """A manual mark overrides the check, with the grader's name and comment."""
    text = read(render_html(marked())).text_content()
    assert "Marked by Ada: so it is." in text


@pytest.mark.parametrize(("answers", "count"), [((), 0), (("--answers", "rubrics/lab6/answers.toml"), 1)])
def test_model_answers_need_the_option(answers: tuple[str, ...], count: int) -> None:
    """Model answers are on the page with --answers only."""
    page = read(run(("grade", "submissions/lab6/reference", "--format", "html", *answers)).stdout)
    assert ("Model answer:" in page.text_content()) == bool(count)


def test_page_of_sixty_links_is_small() -> None:
    """Score, failures, three views and the robot in 3-D with 59 joints that move take less than 300 KB."""
    page = render(grade(LAB6, read_submission(chain(60).encode(), identity="x", path="x.urdf")), Format.HTML)
    assert len(page.encode()) < MAX_SIZE
    assert len(read(page).xpath("//input[@type='range']")) == 59


def test_number_of_a_failure_is_that_of_the_picture() -> None:
    """A failure has the number under which the views call its link out."""
    page = read(render_html(hinted()))
    pins = {pin.get("data-show") for pin in page.find_class("pin")}
    assert pins == {text.text for text in page.xpath("//*[@class='number']//*[text()]")}
    assert pins == {"1", "2", "3", "4"}  # the fifth is about several links: it has no place in the picture
    assert "see below" not in page.text_content()  # as in a picture of its own, which lists the criteria


def shares(page: Any) -> tuple[list[str], list[str]]:
    """Return the widths of the bar's parts, and the words below it."""
    bars = [part.get("width") for part in page.find_class("bar")[0].findall("rect")] if page.find_class("bar") else []
    return bars, [words.text_content().strip() for words in page.xpath("//*[@class='shares']/span")]


def test_bar_explains_its_colours() -> None:
    """What is earned, needs manual grading and is lost stands below it; without points to grade there is no such part."""
    page = read(run(("grade", "submissions/lab6/right-wheel-mirrored/my_robot/urdf", "--format", "html")).stdout)
    assert shares(page) == (["63.0%", "10.0%", "27.0%"], ["Earned: 63", "Needs manual grading: 10", "Lost: 27"])
    page = read(run(("grade", "submissions/lab6/reference", "--part", "task1", "--format", "html")).stdout)
    assert shares(page) == (["100.0%"], ["Earned: 70"])


def test_excused_student_has_no_bar() -> None:
    """No points count."""
    report = SAMPLES["reference"].grade()._replace(grade=Grade(points=None))
    assert shares(read(render_html(report))) == ([], [])


def test_every_criterion_has_its_title_behind_its_status() -> None:
    """On cards and in the list of all criteria; so that the title of a failed one does not read as a fact."""
    page = read(run(("grade", "submissions/lab6/axis-negated/my_robot/urdf/my_robot.urdf", "--format", "html")).stdout)
    name, title = "left-wheel-forward", "Failed: A positive turn of the left wheel drives the base forward"
    heading = page.get_element_by_id(f"criterion-{name}").find("h3").text_content()
    (row,) = (row.text_content() for row in page.iter("tr") if f"#criterion-{name}" in row.xpath(".//a/@href"))
    for text in (heading, row):
        assert f"{title} {name}" in " ".join(text.split())


def test_what_the_same_edit_fixes_is_inside_of_the_first_card() -> None:
    """It is folded there, with what was found; the hint is not repeated."""
    page = read(render_html(hinted()))
    first, also = (page.get_element_by_id(f"criterion-{name}") for name in AXLE)
    assert also in first.xpath("./details//article")
    assert first.xpath("./details/summary")[0].text == "Fixed by the same edit: 1 more criterion"
    assert not also.find_class("hint")
    assert "180 degrees off" in also.text_content()


def test_mark_in_place_of_a_hint_hides_no_other_card() -> None:
    """The card of a manual mark shows no edit: what the same edit fixes has its own card."""
    mark = ManualMark(Decimal(0), "Ada", "")
    report = hinted()
    results = (one._replace(manual_mark=mark if one.criterion.id == AXLE[0] else None) for one in report.results)
    page = read(render_html(report._replace(results=tuple(results))))
    assert not page.get_element_by_id(f"criterion-{AXLE[0]}").xpath(".//article")
    assert "180 degrees off" in page.get_element_by_id(f"criterion-{AXLE[1]}").text_content()


def test_corrected_criteria_each_have_a_card() -> None:
    """Also if the checks have the same reason to need manual grading: their points and reasons are others."""
    pending = Outcome("pending", "the same reason")
    report = adjusted()
    corrected = [one.criterion.id for one in report.results if one.is_adjusted]
    results = tuple(one._replace(outcome=pending) if one.is_adjusted else one for one in report.results)
    page = read(render_html(report._replace(results=results)))
    assert {f"criterion-{name}" for name in corrected} <= set(page.xpath("//article/@id"))


def test_submission_that_cannot_be_opened_says_so_once(tmp_path: Path) -> None:
    """One card for all criteria with the same reason, which the list of all criteria leads to; the others have theirs."""
    (tmp_path / "lab.zip").write_bytes(b"PK\3\4 no archive")
    page = read(run(("grade", tmp_path, "--format", "html")).stdout)
    cards = page.xpath("//article")
    assert [card.get("id") for card in cards] == [
        f"criterion-{name}" for name in ("urdf-loads", "evidence-webcam", "answer-floating-link", "answer-launch-nodes")
    ]
    assert "The same holds for 43 more criteria" in cards[0].text_content()
    assert page.text_content().count("lab.zip could not be opened") == 1
    assert page.xpath("//tr//a/@href").count("#criterion-urdf-loads") == 44


def test_submission_that_could_not_be_graded_says_so_once(tmp_path: Path) -> None:
    """Of a class: its reason is that of the whole submission, also for questions."""
    (tmp_path / "class").mkdir()
    (tmp_path / "class" / "ada.zip").write_bytes(b"PK\3\4 no archive")
    run(
        (
            "batch",
            tmp_path / "class",
            "--gradebook",
            tmp_path / "c.db",
            "--reports",
            tmp_path,
            "--report-format",
            "html",
        )
    )
    page = read((tmp_path / "ada.html").read_bytes())
    assert len(page.xpath("//article")) == 1
    assert "The same holds for 46 more criteria" in page.text_content()


@pytest.mark.parametrize("name", ["pictures-only", "reference"])
def test_what_needs_manual_grading_has_no_points_yet(name: str) -> None:
    """It shows a dash, never 0."""
    page = read(render_html(SAMPLES[name].grade()))
    found = [row.findtext("td") for row in page.iter("tr") if "Needs manual grading" in row.text_content()]
    assert found
    assert all(text.startswith("–/") for text in found)


def mark_of_the_cause() -> Report:
    """Return a report in which a manual mark overrides a failure that others are skipped because of."""
    report = SAMPLES["empty-urdf"].grade()
    cause = next(result.because for result in report.results if result.because)
    given = [
        result._replace(manual_mark=ManualMark(result.criterion.points, "Ada", ""))
        if result.criterion.id == cause
        else result
        for result in report.results
    ]
    return report._replace(results=tuple(given))


@pytest.mark.parametrize(
    "report",
    [marked, hinted, mark_of_the_cause, *(SAMPLES[name].grade for name in ("axis-negated", "empty-urdf"))],
)
def test_every_link_of_a_page_has_a_target(report: Callable[[], Report]) -> None:
    """A criterion that is skipped leads to the card of its cause."""
    page = read(render_html(report()))
    targets = {link.removeprefix("#") for link in page.xpath("//a/@href")}
    assert targets <= set(page.xpath("//@id"))
    assert any(target.startswith("criterion-") for target in targets)


def test_page_says_why_it_has_no_picture() -> None:
    """Nothing was submitted that a picture could show, or it is no longer there."""
    assert "no robot could be read from the submission" in render_html(SAMPLES["pictures-only"].grade())
    report = SAMPLES["lidar-buried"].grade()
    gone = report._replace(submission=replace(report.submission, originals=None))
    assert "has changed or moved since it was graded" in render_html(gone)


def test_late_penalty_is_a_note() -> None:
    """Notes on the whole submission stand below the score."""
    report = SAMPLES["reference"].grade()._replace(notes=("2 days late: -10 points",))
    assert [note.text for note in read(render_html(report)).find_class("note")] == ["Note: 2 days late: -10 points"]


def inspected(*arguments: object) -> Any:
    """Return the page of an inspection."""
    return read(run(("inspect", *arguments, "--format", "html")).stdout)


def test_inspection_shows_problems_tree_and_poses() -> None:
    """A rejected URDF: its verdict, the problem with its line, the tree, and where each link is or why it has no place."""
    page = inspected(SAMPLES["lidar-without-joint"].path)
    assert page.xpath("//header//strong")[0].text == "ROS 2 rejects it"
    assert [mark.text for mark in page.iter("mark")] == ['name="lidar"']
    assert "caster_wheel  base_caster_wheel_joint: fixed" in page.text_content()
    rows = {row[0].text_content(): [cell.text for cell in row[1:]] for row in page.iter("tr")}
    assert rows["base_link"] == ["box 0.6 x 0.4 x 0.2 m", "0 0 0.1", "base_joint (fixed) from base_footprint"]
    assert rows["lidar"][1] == "no chain of joints leads from 'base_footprint' to 'lidar'"


def test_inspection_starts_at_the_given_positions() -> None:
    """`--joint` sets the sliders; a mimic joint follows and cannot be moved."""
    page = inspected(SAMPLES["arm/axis-sign"].path, "--joint", "joint_2=0.5")
    values = {slider.get("value") for slider in page.xpath("//input[@type='range']")}
    assert values == {"0.0", "28.64789"}


def test_inspection_of_what_is_no_robot(tmp_path: Path) -> None:
    """Text that is no XML has a page with the problem, and no picture."""
    file = tmp_path / "x.urdf"
    file.write_text("<robot name='x'><lin")
    page = inspected(file)
    assert page.find_class("error-card")
    assert not page.xpath("//canvas")


@pytest.mark.parametrize(("level", "is_shown"), [("none", False), ("place", False), ("cause", True), ("edit", True)])
def test_reference_is_as_secret_as_the_hints(level: Any, is_shown: bool) -> None:
    """Below the level `cause` no number of the reference is in the page, and no button shows it."""
    report = SAMPLES["lidar-buried"].grade()
    page = read(render_html(report._replace(rubric=replace(report.rubric, hints=level))))
    data = json.loads(page.get_element_by_id("data").text)
    assert (data["reference"] is not None) == is_shown
    assert bool(page.xpath("//button[@data-mode='reference']")) == is_shown


JOINTS = """<robot name="r"><link name="a"/><link name="b"/><link name="c"/><link name="d"/><link name="e"/><link name="f"/><link name="g"/><link name="h"/>
<joint name="turn" type="revolute"><parent link="a"/><child link="b"/><limit lower="-0.5" upper="1" effort="1" velocity="1"/></joint>
<joint name="slide" type="prismatic"><parent link="a"/><child link="c"/><limit lower="0.1" upper="0.2" effort="1" velocity="1"/></joint>
<joint name="spin" type="continuous"><parent link="a"/><child link="d"/></joint>
<joint name="copy" type="continuous"><parent link="a"/><child link="e"/><mimic joint="turn" offset="0.1"/></joint>
<joint name="endless" type="revolute"><parent link="a"/><child link="f"/><limit lower="-1e308" upper="1e308" effort="1" velocity="1"/></joint>
<joint name="back" type="revolute"><parent link="a"/><child link="h"/><limit lower="1" upper="-1" effort="1" velocity="1"/></joint>
<joint name="plane" type="planar"><parent link="a"/><child link="g"/></joint></robot>"""


def test_sliders_have_the_range_of_their_joint(tmp_path: Path) -> None:
    """Degrees or mm within the limits and 0; half a turn without usable limits; odd limits are named; a mimic joint follows; a planar joint stays."""
    (tmp_path / "r.urdf").write_text(JOINTS)
    page = inspected(tmp_path / "r.urdf")
    found = {
        slider.getparent().find_class("joint-name")[0].text_content(): [
            slider.get(key) for key in ("min", "max", "value", "data-unit", "disabled")
        ]
        for slider in page.xpath("//input[@type='range']")
    }
    assert found == {
        "turn": ["-28.64789", "57.29578", "0.0", "\u00b0", None],
        "slide (starts outside its limits)": ["0.0", "200.0", "0.0", "mm", None],
        "spin": ["-180.0", "180.0", "0.0", "\u00b0", None],
        "copy (follows turn)": ["-180.0", "180.0", "5.729578", "\u00b0", "disabled"],
        "back (its limits are reversed)": ["-180.0", "180.0", "0.0", "\u00b0", None],
        "endless": ["-180.0", "180.0", "0.0", "\u00b0", None],
    }
    assert "'plane' is planar: it stays at 0 here." in page.text_content()


@pytest.mark.parametrize(
    ("change", "free", "has_button"),
    [
        (("", ""), [True, True], True),
        (('<child link="right_wheel"/>', '<child link="right_wheel"/><mimic joint="base_left_wheel_joint"/>'), [True, False], True),
        (('type="continuous"', 'type="revolute"'), [False, False], False),
    ],
)  # fmt: skip
def test_only_continuous_joints_of_their_own_are_driven(
    change: tuple[str, str], free: list[bool], has_button: bool, tmp_path: Path
) -> None:
    """`Drive` neither turns a mimic joint against the one that it follows, nor a revolute joint beyond its limits."""
    text = (ROOT / "submissions/lab6/axis-negated/my_robot/urdf/my_robot.urdf").read_text()
    assert change[0] in text
    (tmp_path / "my_robot.urdf").write_text(text.replace(*change))
    page = render_html(grade(LAB6, opened(tmp_path)))
    data = json.loads(read(page).get_element_by_id("data").text_content())
    assert [wheel["free"] for wheel in data["robot"]["wheels"]] == free
    assert ('data-part="drive"' in page) is has_button


def test_an_answer_keeps_its_lines() -> None:
    """Each line of a written answer is a line of its own."""
    page = read(run(("grade", "submissions/lab6/reference", "--format", "html")).stdout)
    first = page.find_class("answer")[0].text_content()
    assert len(first.strip().splitlines()) > 2 and "\\x0a" not in first


def test_what_is_not_deducted_says_so() -> None:
    """A criterion that fails only because of an earlier mistake is no plain failure."""
    page = read(run(("grade", "submissions/lab6/broken-tag-origin/my_robot/urdf", "--format", "html")).stdout)
    assert "Failed, but not deducted:" in page.get_element_by_id("criterion-lidar-on-top").find("h3").text_content()
