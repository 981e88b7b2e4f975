"""The wheel and the sdist: their contents and metadata, and what works in an empty environment without a checkout."""

import json
import os
import re
import shutil
import subprocess
import sys
import tarfile
import tomllib
import zipfile
from collections.abc import Sequence
from email import message_from_string
from pathlib import Path

import pytest

from tests.command_line import HANG_TIMEOUT, ROOT, clean_environment

pytestmark = pytest.mark.slow

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
URLS = PROJECT["project"]["urls"]
SITE, REPOSITORY = URLS["Documentation"], URLS["Repository"]
_ADDRESS = r"https://[\w./#%-]*urdf-grader[\w./#%-]*"
ANSWERS = "answers.toml"
RAW = REPOSITORY.replace("github.com", "raw.githubusercontent.com")


def do(words: Sequence[object], folder: Path, **variables: str) -> subprocess.CompletedProcess[str]:
    """Run a program in a folder."""
    return subprocess.run(
        [str(word) for word in words],
        cwd=folder,
        env={**clean_environment(), **variables},
        capture_output=True,
        text=True,
        encoding="utf-8",
        check=False,
        timeout=HANG_TIMEOUT,
    )


def build(source: Path, target: Path, *kinds: str) -> Path:
    """Build distributions of the project in a folder."""
    options = [word for kind in kinds for word in ("-t", kind)]
    done = do((sys.executable, "-m", "hatchling", "build", "-d", target, *options), source)
    assert done.returncode == 0, done.stderr
    return target


@pytest.fixture(scope="session")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of the wheel and the sdist."""
    return build(ROOT, tmp_path_factory.mktemp("dist"), "wheel", "sdist")


def contents(wheel: Path) -> dict[str, bytes]:
    """Return the files of a wheel."""
    with zipfile.ZipFile(wheel) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


@pytest.mark.exhaustive
def test_the_wheel_has_no_model_answers_and_no_samples(built: Path) -> None:
    """It has the package, and the rubrics with their references; the sdist has what the README's first command needs, too."""
    (wheel,), (sdist,) = built.glob("*.whl"), built.glob("*.tar.gz")
    files = contents(wheel)
    answers = [path for path in (ROOT / "rubrics").rglob("*") if path.name.endswith(ANSWERS)]
    secrets = [
        text.encode()
        for path in answers
        for text in tomllib.loads(path.read_text(encoding="utf-8")).values()
    ]
    assert secrets
    assert not [name for name, data in files.items() if any(text in data for text in secrets)]
    assert {Path(name).parts[0] for name in files} == {
        "grader",
        next(name for name in files if "METADATA" in name)[:-9],
    }
    rubrics = {
        f"grader/{path.relative_to(ROOT)}"
        for path in (ROOT / "rubrics").rglob("*")
        if path.is_file()
    }
    assert {name for name in files if name.startswith("grader/rubrics/")} == {
        name for name in rubrics if not name.endswith((ANSWERS, ".pyc"))
    }
    with tarfile.open(sdist) as archive:
        names = {name.partition("/")[2] for name in archive.getnames()}
    assert {
        "submissions/lab6/lidar-buried/expected.toml",
        "rubrics/lab6/rubric.toml",
        "LICENSE",
        "README.md",
        "pyproject.toml",
    } <= names
    assert not [
        name
        for name in names
        if name.endswith(ANSWERS)
        or re.match(r"tests|benchmarks|submissions/(?!lab6/lidar-buried/)", name)
    ]


@pytest.mark.exhaustive
def test_the_sdist_builds_the_same_wheel(built: Path, tmp_path: Path) -> None:
    """A packager gets the files of the checkout, and the same bytes."""
    with tarfile.open(next(built.glob("*.tar.gz"))) as archive:
        archive.extractall(tmp_path, filter="data")
    again = build(next(tmp_path.iterdir()), tmp_path / "dist", "wheel")
    (first,), (second,) = built.glob("*.whl"), again.glob("*.whl")
    assert contents(second) == contents(first)
    assert second.read_bytes() == first.read_bytes()


@pytest.mark.exhaustive
def test_the_index_accepts_the_metadata(built: Path) -> None:
    """`twine check` passes, and the README's links lead to pages and files of the project, at the project's addresses."""
    pytest.importorskip("twine")
    done = do((sys.executable, "-m", "twine", "check", "--strict", *built.iterdir()), built)
    assert done.returncode == 0, done.stdout
    (wheel,) = built.glob("*.whl")
    (metadata,) = (data for name, data in contents(wheel).items() if name.endswith("METADATA"))
    shown = message_from_string(metadata.decode())
    assert shown["Author"] == PROJECT["project"]["authors"][0]["name"]
    assert shown["License-Expression"] == "Apache-2.0"
    links = re.findall(r"\]\(([^)]+)\)", str(shown.get_payload()))
    assert len(links) > 5
    for link in links:
        assert is_there(link), link


def is_there(link: str) -> bool:
    """Return whether an address of the project leads to a page of its documentation or to a file of the repository."""
    if link.startswith(SITE):
        name = re.sub(r"(\.html)?(#.*)?$", "", link.removeprefix(SITE))
        return (ROOT / "docs" / f"{name or 'index'}.md").exists()
    found = re.match(
        rf"(?:{re.escape(REPOSITORY)}/(?:blob|tree)|{re.escape(RAW)})/main/([^#]+)", link
    )
    if found:
        return (ROOT / found[1]).exists()
    own = re.fullmatch(
        rf"{re.escape(REPOSITORY)}/(security/(policy|advisories/new)|releases/tag/v[0-9.]+)", link
    )
    return own is not None or link in URLS.values() or not link.startswith((REPOSITORY, RAW))


def test_addresses_of_the_project_exist() -> None:
    """What the code and the pages cite is a page of the site or a file of the repository."""
    pages = [*ROOT.glob("*.md"), *(ROOT / "docs").glob("*.md"), *(ROOT / "grader").rglob("*.py")]
    found = {
        link for page in pages for link in re.findall(_ADDRESS, page.read_text(encoding="utf-8"))
    }
    assert found
    assert [link for link in found if not is_there(link.rstrip("."))] == []


@pytest.fixture(scope="session")
def installed(built: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the command of the wheel, installed with its dependencies into an empty environment."""
    environment = tmp_path_factory.mktemp("empty") / "venv"
    for words in (
        (sys.executable, "-m", "venv", environment),
        (environment / "bin" / "pip", "install", "--quiet", *built.glob("*.whl")),
    ):
        done = do(words, built)
        assert done.returncode == 0, done.stderr
    return environment / "bin" / "grader"


@pytest.fixture
def lab(installed: Path, tmp_path: Path) -> Path:
    """Return a folder with a copy of lab6 and its reference, made by the installed command."""
    done = do((installed, "rubric", "copy", "lab6", "lab"), tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    assert not list(tmp_path.rglob(f"*{ANSWERS}"))
    return tmp_path


@pytest.mark.exhaustive
def test_one_submission(installed: Path, lab: Path) -> None:
    """The reference passes; a mistake is shown with its cause; no command prints a model answer."""
    robot = lab / "lab" / "lab6" / "my_robot" / "urdf" / "my_robot.urdf"
    assert do((installed, "grade", robot), lab).returncode == 0
    robot.write_text(robot.read_text(encoding="utf-8").replace("0.225", "0.2"), encoding="utf-8")
    done = do((installed, "grade", robot, "--save", "html=report.html"), lab)
    assert (done.returncode, done.stderr) == (1, "")
    assert "z of the joint origin of 'lidar'" in done.stdout
    assert (lab / "report.html").exists()
    for words in (
        ("rubric", "check", "lab6"),
        ("rubric", "show", "lab6"),
        ("explain", "URDF051"),
        ("schema", "report"),
    ):
        done = do((installed, *words), lab)
        assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.exhaustive
def test_a_class(installed: Path, lab: Path) -> None:
    """A class is graded, marked, exported; the model answers come from a file that the installation has not."""
    answers = ROOT / "rubrics/lab6/answers.toml"
    for name in ("ash", "birch"):
        shutil.copytree(ROOT / "submissions/lab6/reference", lab / "class" / name)
    book = ("--gradebook", "lab6")
    done = do((installed, "batch", "class", *book, "--answers", answers), lab)
    assert done.returncode == 0, done.stderr
    assert do((installed, "mark", "ash", "answer-floating-link", "4", *book), lab).returncode == 0
    sheet = ("--criterion", "answer-floating-link", "--answers", answers, "--sheet", "items.csv")
    assert do((installed, "review", *book, *sheet), lab).stdout.startswith("1 item written")
    exported = do((installed, "export", "csv", *book, "--pending-as-zero"), lab).stdout
    assert re.search(r"^ash,.*94", exported, re.MULTILINE)
    assert do((installed, "export", "html", *book, "--output", "pages"), lab).returncode == 0
    assert do((installed, "bundle", "gradescope", "out.zip"), lab).returncode == 0


@pytest.mark.exhaustive
def test_ci_of_a_student(installed: Path, lab: Path) -> None:
    """A job of GitHub Actions gets its report and its summary."""
    shutil.copytree(ROOT / "submissions/lab6/several-mistakes/my_robot/urdf", lab / "repository")
    job = {"GITHUB_ACTIONS": "true", "GITHUB_STEP_SUMMARY": str(lab / "summary.md")}
    done = do((installed, "grade", ".", "--save", "json=../report.json"), lab / "repository", **job)
    assert done.returncode == 1
    assert "::error " in done.stderr
    assert json.loads((lab / "report.json").read_text(encoding="utf-8"))["score"] == 43
    assert "43" in (lab / "summary.md").read_text(encoding="utf-8")
    assert os.listdir(lab / "repository")
