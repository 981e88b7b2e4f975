"""The files that others copy or name are valid, and the pages that show them show them as they are."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.ci.runner import load

ROOT = Path(__file__).parent.parent.parent
SCHEMAS = {
    "action.yml": "vendor.github-actions",
    "docs/ci/student-repository.yml": "vendor.github-workflows",
    "docs/ci/class.yml": "vendor.github-workflows",
    "docs/ci/gitlab-ci.yml": "vendor.gitlab-ci",
}


@pytest.mark.parametrize("name", SCHEMAS)
def test_the_file_is_what_its_host_takes(name: str) -> None:
    """An action, a workflow and a GitLab job satisfy the schemas that are published for them."""
    done = subprocess.run(
        [sys.executable, "-m", "check_jsonschema", "--builtin-schema", SCHEMAS[name], str(ROOT / name)],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_schemas_refuse_what_is_wrong(tmp_path: Path) -> None:
    """A step with a misspelt key is refused, so that the test above can fail."""
    text = (ROOT / "docs/ci/student-repository.yml").read_text(encoding="utf-8").replace("runs-on:", "run-on:")
    (tmp_path / "bad.yml").write_text(text, encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "-m", "check_jsonschema", "--builtin-schema", "vendor.github-workflows", tmp_path / "bad.yml"],
        capture_output=True,
        check=False,
    )
    assert done.returncode == 1


def test_hooks_are_valid() -> None:
    """pre-commit takes the file of hooks."""
    done = subprocess.run(
        [sys.executable, "-m", "pre_commit", "validate-manifest", str(ROOT / ".pre-commit-hooks.yaml")], check=False
    )
    assert done.returncode == 0


def test_the_page_shows_the_files() -> None:
    """What an instructor copies from the page is what is tested here."""
    page = (ROOT / "docs/ci.md").read_text(encoding="utf-8")
    shown = re.findall(r"```(?:yaml|python)\n(.*?)```", page, re.DOTALL)
    for name in ("student-repository.yml", "class.yml", "gitlab-ci.yml", "classroom50.py"):
        assert (ROOT / "docs/ci" / name).read_text(encoding="utf-8") in shown, name


def test_the_page_tells_of_each_input_and_output() -> None:
    """Every input and output of the action is in the page's tables."""
    page = (ROOT / "docs/ci.md").read_text(encoding="utf-8")
    action = load(ROOT / "action.yml")
    for name in (*action["inputs"], *action["outputs"]):
        assert f"| `{name}` |" in page, name
