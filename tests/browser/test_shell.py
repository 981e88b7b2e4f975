"""A browser applies the policy of a page: what is not its own does nothing."""

from collections.abc import Callable
from pathlib import Path

import pytest

from grader.report.pages.shell import Assets, render_page
from tests.browser.conftest import OpenPage

pytestmark = pytest.mark.exhaustive
HOSTILE = "<script>document.title='run'</script><img src=x onerror=\"document.title='run'\"><style>body{color:red}</style>"


def test_browser_refuses_what_the_policy_does_not_name(
    open_page: Callable[..., OpenPage], tmp_path: Path
) -> None:
    """Markup that were to get into a page neither runs, nor loads, nor styles."""
    file = tmp_path / "page.html"
    text = render_page("base.html", {"version": "1", "title": "A page"}, {}, Assets())
    file.write_text(text.replace("</main>", f"{HOSTILE}</main>"), encoding="utf-8")
    opened = open_page(file)
    assert opened.page.title() == "A page"
    assert opened.page.evaluate("getComputedStyle(document.body).color") != "rgb(255, 0, 0)"
    assert any("Content Security Policy" in message for message in opened.messages)
    opened.messages.clear()
    opened.requests.clear()


def test_escaped_text_is_quiet(open_page: Callable[..., OpenPage], tmp_path: Path) -> None:
    """The same text as a value is shown as it is, and the console stays empty."""
    file = tmp_path / "page.html"
    values = {"version": "1", "title": HOSTILE}
    file.write_text(render_page("base.html", values, {"x": HOSTILE}, Assets()), encoding="utf-8")
    assert open_page(file).page.title() == HOSTILE
