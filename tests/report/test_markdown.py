"""Markdown: a report's text never changes its structure, and a cut report is still Markdown."""

import re
from functools import cache
from textwrap import indent

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from grader.base.text import printable
from grader.lab.grading.report import Report
from grader.report.writers.escaped_markdown import code, escape, fence
from grader.report.writers.markdown import cut_markdown, render_markdown
from tests.report.hostile import TEXT
from tests.report.readers import read_as_github, read_markdown
from tests.samples import SAMPLES

NOTICE = "The report is cut off here, because it is too long."
JOINER = "\u2060"  # prevents GitHub from finding a mention


@cache
def report_of(name: str) -> Report:
    """Return a sample's report."""
    return SAMPLES[name].grade()


def _plain(text: str) -> str:
    return text.replace(JOINER, "")


@pytest.mark.slow
@given(
    st.sampled_from(["reference", "several-mistakes", "pictures-only", "setup-as-created"]),
    st.integers(-5, 20_000),
)
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
LAYOUTS = {
    "{}\n": "",
    "- \u2717 {}\n": "\u2717",
    "# {}\n": "",
    "*{}*\n": "",
    "- \u2717\n\n  {}\n": "\u2717",
}


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
    assert [element.tag for element in root.iter()] == [
        "div",
        "ul",
        "li",
        *(["code"] if is_code else []),
    ]
    assert _plain(root.text_content()).strip() == (
        f"x {text} y" if is_code else f"x {text.strip()} y"
    )


@given(st.lists((TEXT | st.text() | st.text("`~ a")).map(printable).filter(str.strip)))
@example(["`" * 300, "# h"])
@example(["   " + "`" * 90, "~" * 300, "<b>"])
def test_a_code_block_ends_at_its_fence(lines: list[str]) -> None:
    """Whatever its content, at any length: GitHub counts at most 255 backticks of a fence."""
    root = read_as_github(f"- x\n\n{indent(fence(lines), '  ')}\n\ny\n")
    assert [element.tag for element in root.iter()] == ["div", "ul", "li", "p", "pre", "code", "p"]
    assert root.find(".//code").text_content() == "".join(f"{line}\n" for line in lines)
