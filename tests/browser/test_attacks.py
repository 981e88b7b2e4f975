"""Each attack of the corpus in every text of a student, on every page: it is text and nothing else."""

import re
from collections.abc import Callable
from html import unescape
from pathlib import Path
from typing import Any

import pytest

from tests.browser.conftest import OpenPage
from tests.command_line import run
from tests.report.attacks import ATTACKS, AttackedClass, make_attacked_class
from tests.review_server import running
from tests.view_server import viewing

pytestmark = pytest.mark.exhaustive
# Opens what is folded, and searches; then returns what no page should have.
LOOK = r"""
for (const one of document.querySelectorAll('details')) one.open = true;
for (const one of document.querySelectorAll('#find')) {
  one.value = '<script>';
  for (const name of ['input', 'change']) one.dispatchEvent(new Event(name, { bubbles: true }));
}
const found = document.title === 'run' ? ['the title is changed'] : [];
const unused = 'iframe:not([sandbox]), object, embed, base, link, video, audio, marquee, math, foreignObject, animate, image, template';
for (const one of document.querySelectorAll('*')) {
  const far = (value) => { const at = new URL(value, location); return at.protocol !== location.protocol || at.host !== location.host; };
  const isPicture = (value) => one.matches('img') && /^data:image\/(png|jpeg|gif|webp);base64,/.test(value);
  const isFar = (name, value) => /href$|^src$|action$|^data$/i.test(name) && far(value) && !isPicture(value);
  const isWrong = ({ name, value }) => /^on|^srcdoc$|^style$/i.test(name) || isFar(name, value);
  if (one.matches(unused) || [...one.attributes].some(isWrong)) found.push(one.outerHTML.slice(0, 200));
}
return found;
"""
Visit = Callable[[str], Any]


@pytest.fixture(scope="module")
def attacked(tmp_path_factory: pytest.TempPathFactory) -> AttackedClass:
    """Return the class of attackers."""
    return make_attacked_class(tmp_path_factory.mktemp("attacked"))


@pytest.fixture
def visit(open_page: Callable[[str], OpenPage]) -> Visit:
    """Return a function that opens an address and returns what no page should have."""
    opened = open_page("about:blank")

    def chromium(address: str) -> Any:
        opened.page.goto(address)
        return opened.page.evaluate(f"() => {{{LOOK}}}")

    return chromium


def test_the_look_finds_what_runs(visit: Visit, tmp_path: Path) -> None:
    """The test can fail: it finds each kind of element and attribute that no page should have."""
    page = tmp_path / "page.html"
    page.write_text(
        "<!DOCTYPE html><meta charset=utf-8><title>run</title><iframe></iframe><b onclick=''></b><a href='javascript:x'></a><p style=''></p>"
    )
    assert len(visit(page.as_uri())) == 5


def test_pages_of_files(visit: Visit, attacked: AttackedClass, tmp_path: Path) -> None:
    """The page of the class, the page of each student, and that of an inspection."""
    pages = sorted(attacked.pages.glob("*.html"))
    assert len(pages) > len(ATTACKS)
    for number, folder in enumerate(attacked.folders):
        page = tmp_path / f"{number}.html"
        page.write_bytes(run(("inspect", folder, "--format", "html")).stdout)
        pages.append(page)
    found = {page.name: wrong for page in pages if (wrong := visit(page.as_uri()))}
    assert found == {}


def test_pages_of_a_view(visit: Visit, attacked: AttackedClass) -> None:
    """The page of each robot, and the list of all."""
    with viewing(attacked.folders[0].parent) as view:
        addresses = re.findall('<a href="(.*?)"', view.page().part("robots"))
        assert len(addresses) > len(ATTACKS) // 2
        found = {address: visit(view.server.url + unescape(address)) for address in addresses}
    assert {address: wrong for address, wrong in found.items() if wrong} == {}


def test_pages_of_a_review(visit: Visit, attacked: AttackedClass) -> None:
    """The page of each item, and the page at the end."""
    with running(attacked.book) as review:
        count = int(review.get("1").text.partition(" of ")[2].partition("<")[0].split(":")[0])
        assert count > len(ATTACKS)
        pages = [*map(str, range(1, count + 1)), "end"]
        assert {page: wrong for page in pages if (wrong := visit(review.url + page))} == {}
