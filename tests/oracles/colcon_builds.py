"""What a colcon build installs of a package, as ROS 2 Jazzy's tools do it: colcon-core 0.21, colcon-ros, setuptools 68."""

import os
import subprocess
import sys
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple

from grader.files.limits import ignored_part
from tests.command_line import HANG_TIMEOUT

# The Python that has colcon, which is Jazzy's version; by default the one that runs the tests.
PYTHON = os.environ.get("COLCON_PYTHON", sys.executable)
# What colcon installs in any case, whatever data_files says.
IMPLIED = ("share/ament_index/resource_index/packages/my_robot", "share/my_robot/package.xml")
_ARGUMENTS = (
    "build",
    "--base-paths",
    "src",
    "--executor",
    "sequential",
    "--event-handlers",
    "console_direct+",
    "log_command-",
)


class Build(NamedTuple):
    """The result of building a package: the source of each file below the prefix, or the text of the error."""

    installed: dict[str, str]
    error: str


def build_all(packages: Iterable[tuple[Path, dict[str, str]]], processes: int = 2) -> list[Build]:
    """Build workspaces, each with a package in src/my_robot; `texts` has the path of each file by its text."""
    with ThreadPoolExecutor(processes) as pool:
        return list(pool.map(_build, packages))


def _build(package: tuple[Path, dict[str, str]]) -> Build:
    workspace, texts = package
    others = ("PYTHON", "COLCON", "SETUPTOOLS", "AMENT", "MY_")
    environment = {name: value for name, value in os.environ.items() if not name.startswith(others)}
    environment |= {
        "COLCON_HOME": str(workspace / "home"),
        "COLCON_LOG_PATH": str(workspace / "log"),
    }
    done = subprocess.run(
        [PYTHON, "-m", "colcon", *_ARGUMENTS],
        cwd=workspace,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
        timeout=HANG_TIMEOUT,
    )
    root = workspace / "install" / "my_robot"
    paths = [path for path in root.rglob("*") if path.is_file()]
    sources = {path: texts.get(path.read_text("utf-8", "replace"), "") for path in paths}
    installed = {str(path.relative_to(root)): source for path, source in sources.items()}
    has_failed = done.returncode or not (root / "share/my_robot/package.xml").exists()
    error = done.stderr.strip() or done.stdout.strip() or "the package is not built"
    own = ("lib/", "share/colcon-core/", *IMPLIED)
    wanted = {
        target: it
        for target, it in installed.items()
        if it and not ignored_part(it) and not target.startswith(own)
    }
    return Build(wanted, f"status {done.returncode}: {error}" if has_failed else "")


def is_available() -> bool:
    """Return whether the oracle's Python has colcon."""
    return not subprocess.run(
        [PYTHON, "-c", "import colcon_core, colcon_ros"], capture_output=True, check=False
    ).returncode
