"""The project as others get it: a repository with a tag, made anew from the files that are published."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent.parent
PUBLISHED = ("pyproject.toml", "README.md", "LICENSE", "action.yml", ".pre-commit-hooks.yaml", "grader", "rubrics")


def git(folder: Path, *arguments: str) -> None:
    """Run git with a name of its own, whatever the machine's settings are."""
    named = {f"GIT_{who}_{what}": "test@example.org" for who in ("AUTHOR", "COMMITTER") for what in ("NAME", "EMAIL")}
    environment = {**os.environ, **named, "GIT_CONFIG_GLOBAL": os.devnull}
    done = subprocess.run(["git", *arguments], cwd=folder, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def repository(folder: Path, *, tag: str = "") -> Path:
    """Make a repository of what stands in a folder."""
    git(folder, "init", "--quiet")
    git(folder, "add", "--all")
    git(folder, "commit", "--quiet", "--allow-empty", "--message", "All")
    if tag:
        git(folder, "tag", tag)
    return folder


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
