"""What every HTML page has in common: escaped text, one file, a policy that allows its own script and style only."""

import hashlib
import re
import subprocess
import sys
from base64 import b64encode

import pytest
from hypothesis import given
from hypothesis import strategies as st
from lxml import html

from grader.report.pages.shell import render_page
from tests.command_line import ROOT

VALUES = {"version": "1", "title": "A page"}


def page(data: dict[str, object] | None = None, **values: str) -> str:
    return render_page("base.html", VALUES | values, data or {}, "", "")


def test_policy_allows_what_the_page_has_and_nothing_else() -> None:
    """Everything is forbidden but the inline style, by its hash."""
    text = page()
    policy = dict(
        part.split(" ", 1)
        for part in re.findall('Security-Policy" content="([^"]*)"', text)[0].replace("&#39;", "'").split("; ")
    )
    assert policy["default-src"] == "'none'"
    style = re.findall("<style>(.*?)</style>", text, re.DOTALL)[0]
    assert policy["style-src"] == f"'sha256-{b64encode(hashlib.sha256(style.encode()).digest()).decode()}'"
    assert policy["script-src"] == policy["base-uri"] == policy["form-action"] == "'none'"


@given(st.text())
def test_text_stays_text(text: str) -> None:
    """Text never becomes markup, and has no control characters."""
    found = html.fromstring(page(title=f"x{text}x"))
    title = found.findtext(".//title")
    assert title is not None
    assert title.isprintable()
    assert len(found.findall(".//*")) == len(html.fromstring(page()).findall(".//*"))


def test_unknown_values_are_an_error() -> None:
    """A template that names a value it does not get fails; NaN is no JSON."""
    with pytest.raises(Exception, match="title"):
        render_page("base.html", {"version": "1"}, {}, "", "")
    with pytest.raises(ValueError, match="JSON"):
        render_page("base.html", VALUES, {"x": float("nan")}, "", "")


def test_grade_without_html_imports_nothing_of_it() -> None:
    """A cold `grade` loads neither the templates nor the pages."""
    program = """
import sys
from grader.cli.app import run
assert run(["grade", "submissions/axis-negated", "--save", "markdown=/dev/null", "--save", "json=/dev/null"]) == 1
loaded = [name for name in sys.modules if name.startswith(("jinja2", "markupsafe", "grader.report.pages", "grader.drawing"))]
assert not loaded, loaded
"""
    subprocess.run([sys.executable, "-c", program], check=True, cwd=ROOT, stdout=subprocess.DEVNULL)
