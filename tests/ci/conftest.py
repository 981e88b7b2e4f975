"""The project as users get it: a repository with a tag, made from the published files."""

import os
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path
from unittest.mock import patch

import pytest

from tests.command_line import HANG_TIMEOUT, ROOT
from tests.wheels import LOCK, offline

PUBLISHED = (
    "pyproject.toml",
    "README.md",
    "LICENSE",
    "action.yml",
    ".pre-commit-hooks.yaml",
    "grader",
    "rubrics",
)


def git(folder: Path, *arguments: str) -> None:
    """Return a function that runs git with its own user name."""
    named = {
        f"GIT_{who}_{what}": "test@example.org"
        for who in ("AUTHOR", "COMMITTER")
        for what in ("NAME", "EMAIL")
    }
    done = subprocess.run(
        ["git", *arguments],
        cwd=folder,
        env={**os.environ, **named},
        capture_output=True,
        text=True,
        check=False,
        timeout=HANG_TIMEOUT,
    )
    assert done.returncode == 0, done.stderr


def repository(folder: Path, *, tag: str = "") -> Path:
    """Make a repository of the files in a folder."""
    git(folder, "init", "--quiet")
    git(folder, "add", "--all")
    git(folder, "commit", "--quiet", "--allow-empty", "--message", "All")
    if tag:
        git(folder, "tag", tag)
    return folder


@pytest.fixture(scope="package", autouse=True)
def installed_offline(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Have pip install the grader for real, and its dependencies from wheels that point to the packages installed here."""
    with patch.dict(os.environ, offline(tmp_path_factory.mktemp("wheels"))):
        yield


@pytest.fixture(scope="package")
def published(installed_offline: None, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder that acts as the git host, with the project as YOUR-ORG/grader, tagged v1."""
    if shutil.which("git") is None:
        pytest.skip("git is not installed")
    host = tmp_path_factory.mktemp("host")
    project = host / "YOUR-ORG" / "grader"
    project.mkdir(parents=True)
    for name in PUBLISHED:
        source = ROOT / name
        if source.is_dir():
            shutil.copytree(source, project / name, ignore=shutil.ignore_patterns("__pycache__"))
        else:
            shutil.copy(source, project / name)
    shutil.copy(Path(os.environ["PIP_FIND_LINKS"], LOCK), project)
    repository(project, tag="v1")
    return host
