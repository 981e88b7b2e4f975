"""The files that users copy are valid, and the page links to them."""

import json
import re
import shutil
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
    "docs/ci/code-scanning.yml": "vendor.github-workflows",
    "docs/ci/gitlab-ci.yml": "vendor.gitlab-ci",
    "docs/ci/gitlab-code-quality.yml": "vendor.gitlab-ci",
    ".github/dependabot.yml": "vendor.dependabot",
    ".github/ISSUE_TEMPLATE/config.yml": "vendor.github-issue-config",
    **{
        f".github/ISSUE_TEMPLATE/{name}.yml": "vendor.github-issue-forms"
        for name in ("bug", "feature", "rubric-question", "wrong-mark")
    },
    **{
        str(path.relative_to(ROOT)): "vendor.github-workflows"
        for path in (ROOT / ".github" / "workflows").iterdir()
    },
}


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", SCHEMAS)
def test_the_file_is_valid_for_its_host(name: str) -> None:
    """An action, a workflow and a GitLab job satisfy their published schemas."""
    done = subprocess.run(
        [
            sys.executable,
            "-m",
            "check_jsonschema",
            "--builtin-schema",
            SCHEMAS[name],
            str(ROOT / name),
        ],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr


WORKFLOWS = (
    "action.yml",
    "docs/ci/class.yml",
    "docs/ci/code-scanning.yml",
    "docs/ci/student-repository.yml",
)


def zizmor(*files: str | Path) -> subprocess.CompletedProcess[str]:
    """Return zizmor's audit of a workflow, without the network; the exit code is not 0 above the severity "low"."""
    program = Path(sys.executable).with_name("zizmor")
    options = ("--offline", "--no-progress", "--no-config", "--min-severity", "medium")
    return subprocess.run([program, *options, *files], capture_output=True, text=True, check=False)


@pytest.mark.exhaustive
def test_zizmor_finds_nothing() -> None:
    """Actions are pinned, permissions are few, no expression is in a script, no token is left in a checkout."""
    done = zizmor(*(ROOT / name for name in WORKFLOWS))
    assert done.returncode == 0, done.stdout + done.stderr
    assert "No findings to report" in done.stdout + done.stderr


@pytest.mark.exhaustive
def test_zizmor_finds_nothing_in_our_own_workflows() -> None:
    """Nor in what runs in this repository, not even among the findings that zizmor calls pedantic."""
    done = zizmor("--persona", "pedantic", ROOT / ".github")
    assert done.returncode == 0, done.stdout + done.stderr
    assert "No findings to report" in done.stdout + done.stderr


def test_no_token_stays_in_a_checkout() -> None:
    """Checkouts drop their tokens, actions are pinned to a commit followed by its version, permissions are read-only."""
    for name in WORKFLOWS[1:]:
        text, workflow = (ROOT / name).read_text(encoding="utf-8"), load(ROOT / name)
        assert workflow["permissions"] == {"contents": "read"}
        steps = [
            step for job in workflow["jobs"].values() for step in job["steps"] if "uses" in step
        ]
        for step in steps:
            if step["uses"].startswith("actions/checkout@"):
                assert step["with"]["persist-credentials"] is False
            if not step["uses"].startswith("YOUR-ORG/"):
                assert re.search(
                    rf"{step['uses']} # v[0-9]+\.[0-9]+\.[0-9]+$", text, re.MULTILINE
                ), step["uses"]
                assert re.fullmatch(r"[a-z/-]+@[0-9a-f]{40}", step["uses"])


@pytest.mark.exhaustive
def test_hooks_are_valid() -> None:
    """pre-commit accepts the file of hooks."""
    done = subprocess.run(
        [
            sys.executable,
            "-m",
            "pre_commit",
            "validate-manifest",
            str(ROOT / ".pre-commit-hooks.yaml"),
        ],
        check=False,
    )
    assert done.returncode == 0


def test_the_page_links_to_the_files() -> None:
    """The files that an instructor copies are those that are tested here."""
    page = (ROOT / "docs/ci.md").read_text(encoding="utf-8")
    for path in (ROOT / "docs/ci").iterdir():
        assert f"(ci/{path.name})" in page, path.name


def test_the_page_on_editors_links_to_its_files() -> None:
    """Those for editors are tested with the format concise."""
    page = (ROOT / "docs/editors.md").read_text(encoding="utf-8")
    for path in (ROOT / "docs/editors").iterdir():
        assert f"(editors/{path.name})" in page, path.name


def test_the_page_lists_each_input_and_output() -> None:
    """Every input and output of the action is in the page's tables."""
    page = (ROOT / "docs/ci.md").read_text(encoding="utf-8")
    action = load(ROOT / "action.yml")
    for name in (*action["inputs"], *action["outputs"]):
        assert f"| `{name}` |" in page, name


@pytest.mark.exhaustive
def test_the_commands_of_the_image(tmp_path: Path, published: Path) -> None:
    """What the Dockerfile runs makes an environment in which a robot can be graded. The image itself is not built."""
    text = (ROOT / "Dockerfile").read_text(encoding="utf-8")
    ignored = (ROOT / ".dockerignore").read_text(encoding="utf-8").split()
    shutil.copytree(
        ROOT, tmp_path / "source", ignore=lambda folder, _: ignored if Path(folder) == ROOT else []
    )
    shutil.copy(published / "YOUR-ORG/grader/requirements.lock", tmp_path / "source")
    subprocess.run([sys.executable, "-m", "venv", tmp_path / "venv"], check=True)
    runs = re.findall(r"^RUN (?:--mount=\S+ )?pip (.*)$", text, re.MULTILINE)
    assert len(runs) == 2
    assert re.search(r"^FROM python:3\.\d+-slim@sha256:[0-9a-f]{64}$", text, re.MULTILINE)
    for run in runs:
        arguments = re.sub(r"/(?=source)", f"{tmp_path}/", run)
        subprocess.run(f"{tmp_path}/venv/bin/pip {arguments}", shell=True, check=True)
    robot = ROOT / "rubrics/lab6/my_robot/urdf/my_robot.urdf"
    entry = json.loads(re.findall(r"^ENTRYPOINT (.*)$", text, re.MULTILINE)[0])
    done = subprocess.run(
        [tmp_path / "venv/bin" / entry[0], "grade", robot],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr


def test_the_devcontainer_installs_the_checkout() -> None:
    """It is JSON, and installs an extra that exists."""
    settings = json.loads((ROOT / ".devcontainer/devcontainer.json").read_text(encoding="utf-8"))
    assert settings["image"].startswith("mcr.microsoft.com/devcontainers/python:")
    assert (
        settings["postCreateCommand"]
        == "python -m pip install --quiet --editable '.[test,documents]'"
    )
