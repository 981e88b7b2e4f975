"""Markdown: a report's text never changes its structure, and a cut report is still Markdown."""

import re
from functools import cache
from pathlib import Path
from textwrap import indent

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from grader.grading.report import Report
from grader.report.markdown import code, cut_markdown, escape, fence, render_markdown
from grader.report.order import earned_text, groups, in_order
from grader.text import printable
from tests.report.hostile import TEXT
from tests.report.readers import read_as_github, read_markdown
from tests.report.reports import half_points
from tests.samples import REPORTED, SAMPLES

NOTICE = "The report is cut off here, because it is too long."
ELEMENTS = {"div", "h1", "h2", "p", "ul", "li", "code", "pre", "em", "strong", "details", "summary"}
TITLES = ("Failed", "Needs manual grading", "Marked manually", "Passed", "Evidence")
JOINER = "\u2060"  # prevents GitHub from finding a mention
ITEM = re.compile("[\u2713\u2717\u2212?!] (?:[0-9.]+|–)/[0-9.]+ .+")  # a criterion with its mark and its points


@cache
def report_of(name: str) -> Report:
    """Return a sample's report."""
    return SAMPLES[name].grade()


@pytest.mark.parametrize("name", REPORTED)
def test_the_structure_is_that_of_the_report(name: str) -> None:
    """The score is the only top heading; failures come first, costliest first, and what passed is folded below them."""
    report = report_of(name)
    root = read_as_github(render_markdown(report))
    (top,) = root.findall("h1")
    assert top.text_content() == f"{report.score} / {report.max_score} points: {report.rubric.title}"
    titles = [
        heading.text_content() for heading in root.findall("h2") if "Other problems" not in heading.text_content()
    ]
    assert titles == [title for title in TITLES if title in titles]
    order = in_order(report)
    items = [element.text_content().strip().split("\n")[0] for element in root.iterfind(".//li")]
    criteria = [item for item in items if ITEM.fullmatch(item)]
    listed = [*(failure.result for failure in order.failures), *order.pending]
    for shown, result in zip(criteria, listed, strict=False):
        # A failed title without its status would look like a fact.
        assert (result.criterion.title in shown) == (result.outcome.status == "pending")
        assert result.criterion.id in shown
    assert criteria[len(listed) :] == [
        f"\u2713 {result.points}/{result.points} {result.criterion.title}" for result in order.passed
    ]
    skipped = [result.criterion.id for result in report.results if result.outcome.status == "skipped"]
    assert all(re.search(rf"Skipped because [^:]+:[^(]*\b{name}\b", root.text_content()) for name in skipped)
    assert {element.tag for element in root.iter()} <= ELEMENTS
    assert any(
        _plain(paragraph.text_content()).endswith(f"sha256 {report.rubric.sha256}")
        for paragraph in root.findall("p")[:4]
    )


@pytest.mark.parametrize("name", ["reference", "several-mistakes", "footprint-missing"])
def test_what_passed_is_folded_by_group(name: str) -> None:
    """Each fold says what it is about and its points, and holds the criteria that passed and nothing else."""
    report = report_of(name)
    folds = read_as_github(render_markdown(report)).findall("details")
    expected = {
        f"{group.title} {earned_text(*group.results)}": [
            result.criterion.title for result in group.results if result.outcome.status == "passed"
        ]
        for group in groups(report)
    }
    assert {fold.find("summary").text_content() for fold in folds} == {
        title for title, passed in expected.items() if passed
    }
    for fold in folds:
        passed = expected[fold.find("summary").text_content()]
        assert [item.text_content().strip().split(" ", 2)[2] for item in fold.iterfind("ul/li")] == passed


def _plain(text: str) -> str:
    return text.replace(JOINER, "")


@pytest.mark.parametrize("name", REPORTED)
def test_every_fence_is_closed(name: str) -> None:
    """Each block of code ends before the next paragraph."""
    for token in read_markdown(render_markdown(report_of(name))):
        if token.type == "fence":
            assert token.info in ("text", "diff")
            assert not ITEM.search(token.content)
            assert "sha256" not in token.content


@given(st.sampled_from(["reference", "several-mistakes", "pictures-only", "setup-as-created"]), st.integers(-5, 20_000))
def test_a_cut_report_keeps_its_limit(name: str, most: int) -> None:
    """It is never longer, keeps whole blocks from the beginning, and a notice says that something is missing."""
    whole = render_markdown(report_of(name))
    text = cut_markdown(report_of(name), most)
    assert len(text.encode()) <= max(0, most)
    if len(whole.encode()) <= most:
        assert text == whole
    elif text:
        kept, notice, _ = text.rpartition(f"**{NOTICE}**")
        assert notice
        assert whole.startswith(kept)
        before, reported = _contents(whole), _contents(kept)
        assert reported == before[: len(reported)]
        assert read_as_github(text).findall("p")[-1].text_content().startswith(NOTICE)
        assert text.count("<details>") == text.count("</details>")
    else:
        assert most < 200


def _contents(text: str) -> list[tuple[str, str]]:
    return [(token.type, token.content) for token in read_markdown(text) if token.content]


# The places where text may be, with the text before it.
LAYOUTS = {"{}\n": "", "- \u2717 {}\n": "\u2717", "# {}\n": "", "*{}*\n": "", "- \u2717\n\n  {}\n": "\u2717"}


@pytest.mark.parametrize("layout", LAYOUTS)
@given(text=(TEXT | st.text()).map(printable))
def test_escaped_text_is_shown_unchanged(layout: str, text: str) -> None:
    """In a paragraph, an item or a heading: nothing in it is markup, a link or HTML, and no character is lost."""
    if not text.strip():
        return
    written = layout.format(escape(text))
    root = read_as_github(written)
    assert _plain(root.text_content()).strip().removeprefix(LAYOUTS[layout]).strip() == text.strip()
    own = read_as_github(layout.format("plain"))
    assert [element.tag for element in root.iter()] == [element.tag for element in own.iter()]
    assert not {token.type for token in read_markdown(written)} - {
        token.type for token in read_markdown(layout.format("plain"))
    }
    assert not re.search(r"@\w|#\d", root.text_content())


@given((TEXT | st.text() | st.text("` a", min_size=1)).map(printable).filter(str.strip))
@example("`" * 79 + "<b>")
@example("`" * 90 + "<b>")
def test_inline_code_is_shown_unchanged(text: str) -> None:
    """Backticks in it do not end it; with more of them than GitHub supports it becomes plain text."""
    root = read_as_github(f"- x {code(text)} y\n")
    is_code = "`" * 80 not in text
    assert [element.tag for element in root.iter()] == ["div", "ul", "li", *(["code"] if is_code else [])]
    assert _plain(root.text_content()).strip() == (f"x {text} y" if is_code else f"x {text.strip()} y")


@given(st.lists((TEXT | st.text() | st.text("`~ a")).map(printable).filter(str.strip)))
@example(["`" * 300, "# h"])
@example(["   " + "`" * 90, "~" * 300, "<b>"])
def test_a_code_block_ends_at_its_fence(lines: list[str]) -> None:
    """Whatever its content, at any length: GitHub counts at most 255 backticks of a fence."""
    root = read_as_github(f"- x\n\n{indent(fence(lines), '  ')}\n\ny\n")
    assert [element.tag for element in root.iter()] == ["div", "ul", "li", "p", "pre", "code", "p"]
    assert root.find(".//code").text_content() == "".join(f"{line}\n" for line in lines)


def test_feedback_is_one_line(tmp_path: Path) -> None:
    """A line break in a rubric's text becomes a space."""
    assert "*Two lines.*" in render_markdown(half_points(tmp_path))
