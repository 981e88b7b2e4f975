"""CMakeLists.txt compared with CMake: what is installed, and whether a build succeeds."""

from pathlib import Path
from typing import Any

import pytest

from tests.installation.cmake_grammar import FILES, cmake_lists
from tests.oracles.example_robots import MISSING

pytestmark = pytest.mark.exhaustive

pytest.importorskip("cmake", reason=MISSING)
PACKAGES = 150
MOST_OPEN = 0.15  # of the packages


def test_generated_packages_are_built_as_by_cmake(tmp_path: Path) -> None:
    """What is certain agrees with CMake; most of the packages are certain."""
    from tests.oracles.cmake_builds import build, difference, read

    wrong: dict[int, Any] = {}
    left_open = 0
    for seed in range(PACKAGES):
        folder = tmp_path / str(seed) / "bot"
        for path, text in {**FILES, "CMakeLists.txt": cmake_lists(seed)}.items():
            (folder / path).parent.mkdir(parents=True, exist_ok=True)
            (folder / path).write_text(text)
        found = read(folder)
        left_open += bool(found.doubt or found.unknown)
        differs = difference(found, build(folder, folder.parent))
        if differs:
            wrong[seed] = differs
    assert not wrong
    assert left_open <= MOST_OPEN * PACKAGES
