"""Take the screenshots of the documentation: `python docs/screenshots.py`, with Chromium and the
extra `browser`.
"""

import shutil
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from playwright.sync_api import Browser

DOCS = Path(__file__).resolve().parent
SAMPLES, CLASS = DOCS.parent / "submissions/lab6", DOCS.parent / "submissions/class"
FOLDER = DOCS / "screenshots"
STUDENT = "lidar-buried"
SIZE = {"width": 1140, "height": 740}
SOFTWARE_WEBGL = ("--use-angle=swiftshader", "--enable-unsafe-swiftshader")
CHROMIUM = shutil.which("chromium") or shutil.which("google-chrome")


@contextmanager
def browser() -> Iterator["Browser"]:
    """Start a headless browser."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        started = playwright.chromium.launch(
            executable_path=CHROMIUM, args=["--no-sandbox", *SOFTWARE_WEBGL]
        )
        yield started
        started.close()


def grader(*arguments: str | Path) -> None:
    """Run the command line; a report with failures ends with exit code 1."""
    done = subprocess.run(
        [sys.executable, "-m", "grader", *map(str, arguments)],
        stdout=subprocess.DEVNULL,
        check=False,
    )
    if done.returncode > 1:
        raise SystemExit(f"grader {' '.join(map(str, arguments))}: exit code {done.returncode}")


def take(started: "Browser", page: Path, name: str) -> None:
    """Save a screenshot of the top of a page."""
    opened = started.new_page(viewport=SIZE)
    opened.goto(page.as_uri())
    opened.wait_for_load_state("load")
    opened.screenshot(path=FOLDER / f"{name}.png")
    opened.close()


def main() -> None:
    """Take all screenshots."""
    FOLDER.mkdir(exist_ok=True)
    with TemporaryDirectory() as folder, browser() as started:
        page = Path(folder, "student.html")
        grader("grade", SAMPLES / STUDENT, "--save", f"html={page}")  # as in the README
        take(started, page, "student")
        book, pages = Path(folder, "grades"), Path(folder, "pages")
        grader("batch", CLASS / "files", "--roster", CLASS / "roster.csv", "--gradebook", book)
        grader("export", "html", "--gradebook", book, "--output", pages)
        take(started, pages / "index.html", "class")


if __name__ == "__main__":
    main()
