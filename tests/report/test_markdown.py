"""Markdown: a report's text never changes its structure, and a cut report is still Markdown."""

import re
from functools import cache
from pathlib import Path
from textwrap import indent

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from grader.grading.report import Report
from grader.report.markdown import cut_markdown, render_markdown
from grader.report.markdown_text import code, escaped, fenced
from grader.text import printable
from tests.report.hostile import TEXT
from tests.report.readers import read_as_github, read_markdown
from tests.report.reports import half_points
from tests.samples import SAMPLES

NOTICE = "The report is cut off here, because it is too long."
ELEMENTS = {"div", "h1", "h2", "h3", "p", "ul", "li", "code", "pre", "em", "strong"}
JOINER = "\u2060"  # prevents GitHub from finding a mention
# A part or group with its points, a criterion with its mark and its points.
GROUP, ITEM = re.compile(r".+ \([0-9.]+/[0-9.]+\)"), re.compile("[\u2713\u2717\u2212?!] [0-9.]+/[0-9.]+ .+")


@cache
def report_of(name: str) -> Report:
    """Return a sample's report."""
    return SAMPLES[name].grade()


@pytest.mark.parametrize("name", SAMPLES)
def test_the_structure_is_that_of_the_report(name: str) -> None:
    """The score is the only top heading; each part has one, each criterion is an item in its group; code is code."""
    report = report_of(name)
    root = read_as_github(render_markdown(report))
    (top,) = root.findall("h1")
    assert top.text_content() == f"{report.score} / {report.max_score} points: {report.rubric.title}"
    more = ("Evidence", "Other problems in the file", "Other problems in the files")
    parts = [heading.text_content() for heading in root.findall("h2")]
    assert [part.rpartition(" (")[0] for part in parts if part not in more] == [
        report.rubric.part(part).title for part in report.parts
    ]
    assert all(GROUP.fullmatch(heading.text_content()) for heading in root.findall("h3"))
    items = [element.text_content().strip().split("\n")[0] for element in root.iterfind(".//li")]
    criteria = [item for item in items if ITEM.fullmatch(item)]
    for shown, result in zip(criteria, report.results, strict=True):
        status = result.outcome.status
        assert (result.criterion.title in shown) == (
            status in ("passed", "pending")
        )  # a failed title without its status would look like a fact
        assert (result.criterion.id in shown) == (status != "passed")
    assert {element.tag for element in root.iter()} <= ELEMENTS
    assert any(
        _plain(paragraph.text_content()).endswith(f"sha256 {report.rubric.sha256}")
        for paragraph in root.findall("p")[:4]
    )


def _plain(text: str) -> str:
    return text.replace(JOINER, "")


@pytest.mark.parametrize("name", SAMPLES)
def test_every_fence_is_closed(name: str) -> None:
    """Each block of code ends before the next paragraph."""
    for token in read_markdown(render_markdown(report_of(name))):
        if token.type == "fence":
            assert token.info == "text"
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
    written = layout.format(escaped(text))
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
    root = read_as_github(f"- x\n\n{indent(fenced(lines), '  ')}\n\ny\n")
    assert [element.tag for element in root.iter()] == ["div", "ul", "li", "p", "pre", "code", "p"]
    assert root.find(".//code").text_content() == "".join(f"{line}\n" for line in lines)


def test_feedback_is_one_line(tmp_path: Path) -> None:
    """A line break in a rubric's text becomes a space."""
    assert "*Two lines.*" in render_markdown(half_points(tmp_path))
