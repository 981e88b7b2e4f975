"""The project as others get it: a repository with a tag, made anew from the files that are published."""

import os
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path
from unittest.mock import patch

import pytest

from tests.command_line import PATIENCE, ROOT
from tests.wheels import offline

PUBLISHED = ("pyproject.toml", "README.md", "LICENSE", "action.yml", ".pre-commit-hooks.yaml", "grader", "rubrics")


def git(folder: Path, *arguments: str) -> None:
    """Run git with a name of its own."""
    named = {f"GIT_{who}_{what}": "test@example.org" for who in ("AUTHOR", "COMMITTER") for what in ("NAME", "EMAIL")}
    done = subprocess.run(
        ["git", *arguments], cwd=folder, env={**os.environ, **named}, capture_output=True, text=True, check=False,
        timeout=PATIENCE,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr


def repository(folder: Path, *, tag: str = "") -> Path:
    """Make a repository of what stands in a folder."""
    git(folder, "init", "--quiet")
    git(folder, "add", "--all")
    git(folder, "commit", "--quiet", "--allow-empty", "--message", "All")
    if tag:
        git(folder, "tag", tag)
    return folder


@pytest.fixture(scope="package", autouse=True)
def installed_offline(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Have pip install the grader for real, and for what it needs wheels that lead to what is installed here."""
    with patch.dict(os.environ, offline(tmp_path_factory.mktemp("wheels"))):
        yield


@pytest.fixture(scope="session")
def published(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a host with the project as YOUR-ORG/grader, tagged v1."""
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
    repository(project, tag="v1")
    return host
