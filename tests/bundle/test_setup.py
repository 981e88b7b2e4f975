"""setup.sh, run as Gradescope runs it once for each autograder."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.bundle.gradescope import Autograder, unpacked
from tests.command_line import HANG_TIMEOUT
from tests.wheels import offline

pytestmark = pytest.mark.exhaustive

WORD = """
import pypdf
from importlib.metadata import distribution
print(*(distribution(each).locate_file("") for each in ("pypdf", "numpy", "lxml")))
"""
# The tools of a base image, for a PATH with other Pythons than this one.
TOOLS = ("bash", "env", "dirname", "cat", "rm", "touch")


def set_up(source: Path, start: Path, **variables: str) -> subprocess.CompletedProcess[str]:
    """Run setup.sh from some folder."""
    return subprocess.run(
        [source / "setup.sh"],
        cwd=start,
        env={**os.environ, **variables},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
        timeout=HANG_TIMEOUT,
    )


def test_from_the_zip_to_a_grade(bundle: Path, tmp_path: Path) -> None:
    """pip installs the requirements (here from local wheels), and the reference gets its points."""
    root = tmp_path / "auto grader"
    source = unpacked(bundle, root / "source")
    (tmp_path / "wheels").mkdir()
    done = set_up(source, tmp_path, **offline(tmp_path / "wheels"))
    assert done.returncode == 0, done.stdout
    assert done.stdout.endswith("setup.sh: the grader is ready\n")
    assert "lab6" in done.stdout
    installed = subprocess.run(
        [root / "venv/bin/python", "-I", "-c", WORD], capture_output=True, text=True, check=True
    )
    assert installed.stdout.count(str(root / "venv")) == 3
    (tmp_path / "again").mkdir()
    autograder = Autograder(tmp_path / "again", source, root / "venv")
    autograder.submit("reference")
    assert autograder.run()["score"] == 90


def image(folder: Path, **programs: str) -> str:
    """Return the PATH of a machine that has these programs, which are shell scripts."""
    target = folder / "bin"
    target.mkdir()
    for name in TOOLS:
        (target / name).symlink_to(shutil.which(name) or name)
    for name, script in programs.items():
        path = target / name.replace("_", ".").replace("apt.get", "apt-get")
        path.write_text(f"#!{shutil.which('bash')}\n{script}\n")
        path.chmod(0o755)
    return str(target)


APT = 'echo "$*" >>"$LOG"; [ "$1" = update ] || touch "$LOG.done"'
NEW = '[ -e "$LOG.done" ] || { case $* in *ensurepip*) exit 1 ;; esac; exit 0; }; echo it runs >>"$LOG"; exit 0'
OLD = "exit 1"


@pytest.mark.parametrize(
    ("python3", "packages"),
    [(OLD, "python3.11 python3.11-venv"), (NEW, "python3-venv")],
    ids=["22.04", "24.04"],
)
def test_python_is_installed_if_needed(
    source: Path, tmp_path: Path, python3: str, packages: str
) -> None:
    """setup.sh installs a newer Python beside an old one, or the venv package for a new one; the system's Python stays."""
    newer = {"python3_11": '[ -e "$LOG.done" ] && echo it runs >>"$LOG"'} if python3 == OLD else {}
    path = image(tmp_path, python3=python3, apt_get=APT, **newer)
    (tmp_path / "root").mkdir()
    shutil.copytree(source, tmp_path / "root" / "source")
    set_up(tmp_path / "root" / "source", tmp_path, PATH=path, LOG=str(tmp_path / "log"))
    lines = (tmp_path / "log").read_text().splitlines()
    assert lines[:2] == [
        "update --quiet",
        f"install --yes --quiet --no-install-recommends {packages}",
    ]
    assert "it runs" in lines[2:]


@pytest.mark.parametrize(
    "programs", [{}, {"apt_get": "exit 100", "python3": OLD}], ids=["nothing", "no network"]
)
def test_without_a_python(source: Path, tmp_path: Path, programs: dict[str, str]) -> None:
    """The build fails, and its last line says what to do."""
    done = set_up(source, tmp_path, PATH=image(tmp_path, **programs))
    assert done.returncode == 1
    assert done.stdout.splitlines()[-1].startswith(
        "setup.sh: could not install Python 3.11 or newer. Choose a newer base image"
    )


def test_a_rubric_broken_after_bundling(bundle: Path, tmp_path: Path) -> None:
    """A rubric that was broken in the unpacked files is detected when the image is built."""
    source = unpacked(bundle, tmp_path / "source")
    (source / "autograder.json").write_text(
        '{"rubric": "source/rubric.toml", "sha256": "", "seconds": 1}'
    )
    (source / "rubric.toml").write_text("id = 1\n")
    check = [sys.executable, "-I", "source/autograder.py", "--check"]
    done = subprocess.run(check, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (2, "")
