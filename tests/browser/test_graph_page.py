"""The page of a graph in a browser: hover, click, keys, filter and tabs."""

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.browser.conftest import OpenPage
from tests.command_line import ROOT, run

pytestmark = pytest.mark.exhaustive
Open = Callable[..., OpenPage]


@pytest.fixture
def page_of_graph(open_page: Open, tmp_path: Path) -> OpenPage:
    """Open the page of the graph of a reference."""
    file = tmp_path / "graph.html"
    file.write_bytes(run(("graph", ROOT / "rubrics/diffdrive", "--format", "html")).stdout)
    return open_page(file)


def test_hover_and_focus_mark_the_arrows_of_an_item(page_of_graph: OpenPage) -> None:
    """And say what it is."""
    page = page_of_graph.page
    item = page.locator(".item", has_text="/drive_circle")
    item.hover()
    assert page.locator(".arrow.near").count() == 1
    assert (
        page.locator("#about").inner_text() == "node /drive_circle, diffdrive_robot/drive_circle.py"
    )
    page.mouse.move(0, 0)
    assert page.locator(".arrow.near").count() == 0
    item.focus()
    assert page.locator(".arrow.near").count() == 1


def test_a_click_opens_a_node(page_of_graph: OpenPage) -> None:
    """A topic opens its nodes; keys do the same."""
    page = page_of_graph.page
    assert page.locator("details[open]").count() == 0
    page.locator(".item.topic", has_text="/cmd_vel").click()
    assert page.locator("details[open]").count() == 2
    page.locator(".item.node", has_text="/rviz").focus()
    page.keyboard.press("Enter")
    assert page.locator("details[open]").count() == 3
    page.locator(".item.node", has_text="/controller_manager").focus()
    page.keyboard.press("a")
    assert page.locator("details[open]").count() == 3


def test_a_filter_dims_the_rest(page_of_graph: OpenPage) -> None:
    """What a named item connects to stays."""
    page = page_of_graph.page
    page.locator("#filter").fill("cmd_vel")
    shown = page.locator(".item:not(.dim)")
    assert shown.count() == 3
    assert page.locator("details:visible").count() == 2
    page.locator("#filter").fill("")
    assert page.locator(".dim").count() == 0


def test_transforms_are_a_tab(page_of_graph: OpenPage) -> None:
    """One of the two parts is there at a time."""
    page = page_of_graph.page
    assert page.locator("#frames").is_hidden()
    page.locator("#tab-frames").click()
    assert page.locator("#graph").is_hidden()
    assert "base_footprint" in page.locator("#frames").inner_text()
    page.locator("#tab-graph").click()
    assert page.locator("#graph").is_visible()
