"""The site of the documentation: it is complete, loads nothing from elsewhere, and its search works from disk."""

import re
from collections.abc import Iterator
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any
from urllib.parse import unquote, urlsplit

import pytest
from lxml import html

from tests.command_line import ROOT

if TYPE_CHECKING:
    from playwright.sync_api import Browser

pytestmark = [
    pytest.mark.exhaustive,
    pytest.mark.filterwarnings("default"),
]  # the warnings of Sphinx' own dependencies


@pytest.fixture(scope="module")
def builder() -> ModuleType:
    """Return docs/build_site.py."""
    pytest.importorskip("sphinx", reason="Sphinx is not installed: pip install --group site")
    spec = spec_from_file_location("build_site", ROOT / "docs" / "build_site.py")
    assert spec and spec.loader
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def site(builder: ModuleType, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of the built site."""
    folder = tmp_path_factory.mktemp("site")
    builder.build(folder)
    return folder


def parsed(page: Path) -> Any:
    """Return the elements of a page."""
    return html.fromstring(page.read_bytes())


def references(site: Path, path: str) -> Iterator[tuple[Path, str]]:
    """Yield each page with each value of these attributes."""
    for page in site.glob("*.html"):
        for value in parsed(page).xpath(path):
            yield page, str(value)


def test_links_and_anchors_lead_somewhere(builder: ModuleType, site: Path) -> None:
    """A link is a file of the site and an id in it, or a file of the repository, or another website."""
    ids = {page: set(parsed(page).xpath("//@id")) for page in site.glob("*.html")}
    links = [
        (page, link)
        for page, link in references(site, "//@href | //@src")
        if not link.startswith("data:")
    ]
    assert len(links) > 1000
    for page, link in links:
        if file := re.match(rf"{builder.REPOSITORY}/(?:blob|tree)/main/([^#]+)", link):
            assert (ROOT / file[1]).exists(), (page.name, link)
        elif not urlsplit(link).scheme:
            path, anchor = unquote(urlsplit(link).path), unquote(urlsplit(link).fragment)
            target = site / path if path else page
            assert target.is_file(), (page.name, link)
            assert not anchor or anchor in ids[target], (page.name, link)


def test_nothing_is_loaded_from_elsewhere(site: Path) -> None:
    """Scripts, styles, fonts and pictures are files of the site."""
    loaded = [link for _, link in references(site, "//@src | //link[not(@rel='canonical')]/@href")]
    styles = "".join(path.read_text(encoding="utf-8") for path in site.rglob("*.css"))
    loaded += re.findall(r"""(?:url\(|@import )["']?([^"')]+)""", styles)
    assert not [link for link in loaded if urlsplit(link).netloc]


def test_every_page_is_built(builder: ModuleType, site: Path) -> None:
    """Each page of docs/ and each file of the project that belongs to the site is in it."""
    assert {Path(name).stem for name in builder.PAGES.values()} <= {
        page.stem for page in site.glob("*.html")
    }


@pytest.mark.parametrize(
    ("page", "before", "after"),
    [
        ("urdf.md", "(problems.md)", "(nowhere.md)"),
        ("urdf.md", "(problems.md)", "(problems.md#nowhere)"),
        ("grade-one-submission.md", "(xacro.md#edits)", "(#nowhere)"),
        ("index.md", "\nurdf\n", "\n"),
    ],
)
def test_a_mistake_fails_the_build(  # so that the others can fail
    builder: ModuleType,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    page: str,
    before: str,
    after: str,
) -> None:
    """A link to no page, a link to no heading, and a page in no section are errors."""
    texts = dict(builder.sources())
    assert before in texts[page]
    texts[page] = texts[page].replace(before, after)
    monkeypatch.setattr(builder, "sources", texts.items)
    with pytest.raises(Exception, match=r"nowhere|toctree"):
        builder.build(tmp_path)


def test_a_link_to_a_missing_file_fails_the_build(builder: ModuleType) -> None:
    """A link that leaves the site must be a file of the project."""
    with pytest.raises(FileNotFoundError):
        builder.target(ROOT / "docs" / "ci.md", "ci/nothing.yml")


@pytest.mark.parametrize("width", [390, 820, 1440])
def test_pages_fit_and_the_search_works_from_disk(
    browser: "Browser", site: Path, width: int
) -> None:
    """No page is wider than the window, the search finds a word, and nothing but files is requested."""
    page = browser.new_page(viewport={"width": width, "height": 900})
    requests: list[str] = []
    page.on("request", lambda request: requests.append(request.url))
    for file in sorted(site.glob("*.html")):
        page.goto(file.as_uri())
        assert page.evaluate("document.documentElement.scrollWidth <= innerWidth"), file.name
    page.goto(f"{(site / 'search.html').as_uri()}?q=pinocchio")
    page.wait_for_selector("#search-results li a")
    assert "Contributing" in page.locator("#search-results").inner_text()
    assert all(url.startswith(("file:", "data:")) for url in requests)
    page.close()
