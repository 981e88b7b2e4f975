"""Measurements of the student's page: `python benchmarks/pages.py`. Needs Chromium and Playwright for times in the browser.

Sizes and ratios hold on every machine. Times are this machine's.
"""

import os
import shutil
import statistics
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from grader.lab.grading.grade import grade
from grader.lab.rubric.rubric import load_rubric
from grader.lab.submission.opening import open_submission, read_submission
from grader.report.formats import Format, render

ROOT = Path(__file__).resolve().parent.parent
SAMPLES = (
    "reference",
    "axis-negated",
    "lidar-buried",
    "several-mistakes",
    "centimetres",
    "pictures-only",
    "empty-urdf",
)
LINKS = 60
RUNS = 5
CHROMIUM = os.environ.get("CHROMIUM") or shutil.which("chromium") or shutil.which("google-chrome")
DRAWN = "() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(performance.now()))))"


def chain(links: int) -> str:
    """Return a URDF in which every link shows a shape in a colour of its own and every joint moves."""
    return f'<robot name="chain"><link name="base_link"><visual><geometry><box size="0.4 0.4 0.2"/></geometry></visual></link>{"".join(map(_segment, range(1, links)))}</robot>'


def _segment(number: int) -> str:
    parent = "base_link" if number < 4 else f"segment_{number - 3}"
    shape = (
        '<box size="0.1 0.08 0.2"/>',
        '<cylinder radius="0.05" length="0.2"/>',
        '<sphere radius="0.07"/>',
    )[number % 3]
    kind = ("revolute", "continuous", "prismatic")[number // 3 % 3]
    red, green = number % 7 / 7, number % 11 / 11
    return f"""
  <link name="segment_{number}">
    <visual>
      <origin xyz="0 0 0.1" rpy="0.1 0 {number / 10}"/>
      <geometry>{shape}</geometry>
      <material name="colour_{number}"><color rgba="{red:.2f} {green:.2f} 0.5 1"/></material>
    </visual>
  </link>
  <joint name="joint_{number}" type="{kind}">
    <parent link="{parent}"/><child link="segment_{number}"/>
    <origin xyz="{0.15 * (number % 3 - 1):.2f} 0.01 0.21" rpy="0 {0.1 * (number % 3 - 1):.2f} 0.3"/>
    <axis xyz="0 {number % 2} 1"/><limit lower="-1.5" upper="1.5" effort="1" velocity="1"/>
  </joint>"""


def pages() -> Iterator[tuple[str, str, float]]:
    """Yield the name and the page of samples and of a robot with many links, and how long the page takes in milliseconds."""
    rubric = load_rubric("lab6")
    for name in SAMPLES:
        submission = open_submission(str(ROOT / "submissions/lab6" / name), rubric.lab)
        yield name, *_timed(grade(rubric, submission))
    yield (
        f"{LINKS} links",
        *_timed(
            grade(
                rubric,
                read_submission(chain(LINKS).encode(), identity="chain", path="my_robot.urdf"),
            )
        ),
    )


def _timed(report: Any) -> tuple[str, float]:
    times = []
    for _ in range(RUNS):
        start = time.perf_counter()
        text = render(report, Format.HTML)
        times.append(time.perf_counter() - start)
    return text, 1000 * statistics.median(times)


def main() -> None:
    """Print the table of sizes and times."""
    found = [*pages()]
    print(f"{'page':18} {'KB':>6} {'made in ms':>11}")
    for name, text, spent in found:
        print(f"{name:18} {len(text.encode()) / 1000:6.1f} {spent:11.1f}")
    if CHROMIUM is None:
        print("no Chromium: no times in the browser")
        return
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright, tempfile.TemporaryDirectory() as folder:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        print(f"\n{'page':18} {'first picture ms':>17}")
        for name, text, _ in found:
            file = Path(folder) / "page.html"
            file.write_text(text, encoding="utf-8")
            print(f"{name:18} {_in_browser(browser, file)}")
        browser.close()


def _in_browser(browser: Any, file: Path) -> str:
    """Return the time from opening a page to its first picture."""
    times = []
    for _ in range(RUNS):
        page = browser.new_page(viewport={"width": 1280, "height": 900})
        page.goto(file.as_uri())
        times.append(page.evaluate(DRAWN))
        page.close()
    return f"{statistics.median(times):17.0f}"


if __name__ == "__main__":
    main()
