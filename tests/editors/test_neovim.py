"""Neovim with the configuration of docs/editors/: what somebody sees, corrects and renames."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from tests.command_line import HANG_TIMEOUT, ROOT, clean_environment, run

CONFIGURATION = ROOT / "docs/editors/grader.lua"
HERE = Path(__file__).parent
SAMPLE = ROOT / "submissions/diffdrive/joint-misspelt/diffdrive_robot"
OLD, NEW = "base_footprint", "ground_link"

pytestmark = [
    pytest.mark.exhaustive,
    pytest.mark.skipif(shutil.which("nvim") is None, reason="needs Neovim"),
]


@pytest.fixture(params=["grader.toml", ".git/HEAD", "notes"])
def workspace(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    """Return a workspace with a lab in which a joint is misspelt; the last is inspected as a package."""
    shutil.copytree(SAMPLE, tmp_path / "ws" / SAMPLE.name)
    marker = tmp_path / "ws" / request.param
    marker.parent.mkdir(exist_ok=True)
    marker.touch()
    return tmp_path / "ws"


def run_neovim(script: Path, folder: Path, beside: Path) -> dict[str, Any]:
    """Return the results of a script, which runs in Neovim as a user has it."""
    plugins = beside / "config/nvim/plugin"
    plugins.mkdir(parents=True)
    shutil.copy(CONFIGURATION, plugins)
    programs = beside / "bin"
    programs.mkdir()
    command = programs / "grader"
    command.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m grader "$@"\n')
    command.chmod(0o755)
    variables = {
        "PATH": f"{programs}{os.pathsep}{os.environ['PATH']}",
        "RESULTS": str(beside / "results.json"),
        **{
            f"XDG_{kind}_HOME": str(beside / kind.lower())
            for kind in ("CONFIG", "DATA", "STATE", "CACHE")
        },
    }
    subprocess.run(
        ["nvim", "--headless", "-n", "-c", f"luafile {script}"],
        cwd=folder, env={**clean_environment(), **variables}, timeout=2 * HANG_TIMEOUT, check=True,
        stdin=subprocess.DEVNULL,
    )  # fmt: skip
    results: dict[str, Any] = json.loads((beside / "results.json").read_text(encoding="utf-8"))
    return results


def test_a_joint_is_corrected_and_a_link_renamed(workspace: Path, tmp_path: Path) -> None:
    """The problem is at its line, one correction removes it, and nothing is wrong after the renaming in two files."""
    results = run_neovim(HERE / "neovim.lua", workspace, tmp_path)
    assert "failure" not in results, results["failure"]
    [problem] = results["problems"]
    assert problem.startswith("13: ") and "'wheel_left_joint'" in problem
    assert results["actions"][0] == "Change 'wheel_left_joint' to 'left_wheel_joint'"
    assert "\n".join(results["screen"]) + "\n" == (HERE / "screen.txt").read_text(encoding="utf-8")
    changed = []
    for path in SAMPLE.rglob("*.*"):
        before = path.read_text(encoding="utf-8")
        after = workspace / SAMPLE.name / path.relative_to(SAMPLE)
        correct = before.replace("wheel_left_joint", "left_wheel_joint")
        assert after.read_text(encoding="utf-8") == correct.replace(OLD, NEW)
        if OLD in before:
            changed.append(path.name)
    assert sorted(changed) == ["controllers.yaml", "diffdrive.urdf.xacro"]
    assert run(("inspect", workspace, "--format", "concise")).stdout == b""
