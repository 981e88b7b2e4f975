"""What axe-core (Deque) finds on pages: nothing that is serious, in the light, in the dark and on a telephone."""

import os
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from tests.browser.conftest import OpenPage
from tests.classroom.gradebooks import batch, make_class, urdf
from tests.command_line import ROOT, run
from tests.review_server import running
from tests.samples import SAMPLES
from tests.view_server import viewing

if TYPE_CHECKING:
    from playwright.sync_api import Page

pytestmark = pytest.mark.exhaustive
Open = Callable[..., OpenPage]
AXE = Path(os.environ.get("AXE") or "axe.min.js")
# A rule that is off by default: the words of a button are in its name.
OPTIONS = '{rules: {"label-content-name-mismatch": {enabled: true}}}'
NARROW, WIDE = {"width": 390, "height": 844}, {"width": 1366, "height": 900}


@pytest.fixture(scope="module")
def axe() -> str:
    """Return the script of axe-core."""
    if not AXE.is_file():
        pytest.skip("AXE is not the axe.min.js of the npm package axe-core")
    return AXE.read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def classroom(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of a small class, its gradebook and its pages; the size of a robot is open."""
    top = tmp_path_factory.mktemp("class")
    make_class(top)
    unknown = urdf("$(env SIDE) 1 1").replace(
        "<robot ", '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" '
    )
    (top / "class" / "emil" / "robot.urdf").unlink()
    (top / "class" / "emil" / "robot.urdf.xacro").write_text(unknown)
    done = batch(top, "--reports", top / "pages", "--report-format", "html")
    assert done.returncode == 0, done.stderr
    return top


def assert_accessible(page: "Page", axe: str) -> None:
    """Assert that nothing serious or critical is found in both schemes and widths."""
    page.evaluate(axe)
    for scheme in ("light", "dark"):
        for size in (WIDE, NARROW):
            page.set_viewport_size(size)
            page.emulate_media(color_scheme=scheme)
            found: Any = page.evaluate(f"() => axe.run(document, {OPTIONS})")
            serious = [
                (one["id"], one["help"], [node["html"] for node in one["nodes"]])
                for one in found["violations"]
                if one["impact"] in ("serious", "critical")
            ]
            assert serious == [], (scheme, size)


@pytest.mark.parametrize("name", ["several-mistakes", "reference", "arm/elbow-to-the-side"])
def test_page_of_a_student(open_page: Open, tmp_path: Path, axe: str, name: str) -> None:
    """With its robot, mistakes, sliders and buttons; also while it drives."""
    sample = SAMPLES[name]
    file = tmp_path / "page.html"
    rubric = sample.rubric.id
    file.write_bytes(run(("grade", sample.path, "--rubric", rubric, "--format", "html")).stdout)
    page = open_page(file).page
    assert_accessible(page, axe)
    if page.locator("#space-drive").is_visible():
        page.locator("#space-drive").click()
        assert_accessible(page, axe)


def test_page_of_an_inspection(open_page: Open, tmp_path: Path, axe: str) -> None:
    """With and without problems."""
    paths = [Path("rubrics/arm/arm.urdf"), SAMPLES["several-mistakes"].path]
    for number, path in enumerate(paths):
        file = tmp_path / f"{number}.html"
        file.write_bytes(run(("inspect", ROOT / path, "--format", "html")).stdout)
        assert_accessible(open_page(file).page, axe)


def test_page_of_a_class(open_page: Open, classroom: Path, axe: str) -> None:
    """With its table, pictures of robots, bars and lists."""
    assert_accessible(open_page(classroom / "pages/index.html").page, axe)


def test_pages_of_a_review(open_page: Open, classroom: Path, axe: str) -> None:
    """Answers, a robot, and the list of keys."""
    with running(classroom / "book") as review:
        robots = 0
        for number in range(1, 5):
            page = open_page(f"{review.url}{number}").page
            assert_accessible(page, axe)
            robots += page.locator("#space-canvas").count()
        assert robots
        page.locator("#help-button").click()
        assert_accessible(page, axe)


def test_page_of_a_graph(open_page: Open, tmp_path: Path, axe: str) -> None:
    """With its drawing, open nodes and findings, and its transforms."""
    folders = ("rubrics/diffdrive", "submissions/diffdrive/velocities-unstamped")
    for number, name in enumerate(folders):
        file = tmp_path / f"{number}.html"
        file.write_bytes(run(("graph", ROOT / name, "--format", "html")).stdout)
        page = open_page(file).page
        assert_accessible(page, axe)
        page.locator(".item.node").first.click()
        assert_accessible(page, axe)
        page.locator("#tab-frames").click()
        assert_accessible(page, axe)
    with viewing(ROOT / folders[0]) as view:
        assert_accessible(open_page(f"{view.server.url}graph!").page, axe)
        page = open_page(view.server.url).page
        page.get_by_text("Explain an output of the terminal").click()
        assert_accessible(page, axe)
