"""Six walks from the wheel in an empty environment and folder, without a network: each command prints what is on its page.

`python -m tests.walks.test_walks` writes the outputs into the pages.
"""

import os
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

from tests.command_line import HANG_TIMEOUT, PROGRESS, ROOT, clean_environment
from tests.tutorial import follow
from tests.wheels import offline

pytestmark = pytest.mark.exhaustive

PAGES = sorted(Path(__file__).parent.glob("*.md"))
NO_NETWORK = {
    f"{scheme}_proxy": "http://127.0.0.1:9" for scheme in ("http", "https")
}  # no program listens there
NO_NETWORK["no_proxy"] = "127.0.0.1"  # the pages of the grader itself


class Walk:
    """An empty environment with the wheel, and what its commands print."""

    def __init__(self, folder: Path) -> None:
        """Build the wheel, and install it."""
        (folder / "wheels").mkdir()
        self.variables = {
            **clean_environment(),
            **NO_NETWORK,
            **offline(folder / "wheels"),
            "COLUMNS": "100",
        }
        build = (sys.executable, "-m", "hatchling", "build", "-d", folder / "wheels", "-t", "wheel")
        subprocess.run(build, cwd=ROOT, check=True, capture_output=True, timeout=HANG_TIMEOUT)
        subprocess.run(
            (sys.executable, "-m", "venv", folder / "venv"), check=True, timeout=HANG_TIMEOUT
        )
        self.variables["PATH"] = f"{folder}/venv/bin{os.pathsep}{os.environ['PATH']}"
        self.run("pip install --quiet urdf-grader", folder)

    def run(self, commands: str, folder: Path) -> tuple[str, int]:
        """Return what lines of a shell print in a folder, and the exit code of the last one; each starts in that folder."""
        printed, code = "", 0
        for line in commands.splitlines():
            done = subprocess.run(
                ("bash", "-c", line),
                cwd=folder,
                env=self.variables,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
                check=False,
                timeout=HANG_TIMEOUT,
            )
            shown = PROGRESS.sub("", done.stdout)
            printed, code = printed + shown, done.returncode
            assert line.startswith("grader ") or code == 0, (line, printed)
        return printed, code


@pytest.fixture(scope="module")
def walk(tmp_path_factory: pytest.TempPathFactory) -> Walk:
    """Return an environment in which the wheel is installed."""
    return Walk(tmp_path_factory.mktemp("walk"))


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_a_walk(walk: Walk, page: Path, tmp_path: Path) -> None:
    """What the page shows is what the installed program prints."""
    text = page.read_text(encoding="utf-8")
    followed, _ = follow(text, tmp_path, walk.run)
    assert followed == text


if __name__ == "__main__":
    with TemporaryDirectory() as environment:
        installed = Walk(Path(environment))
        for path in PAGES:
            with TemporaryDirectory() as empty:
                path.write_text(
                    follow(path.read_text(encoding="utf-8"), Path(empty), installed.run)[0],
                    encoding="utf-8",
                )
