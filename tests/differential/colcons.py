"""Random packages: whether the grader states that `colcon build` succeeds, and what it states that a build installs.

The kinds: colcon installs the files or ends with an error; `undetermined` is what the grader leaves to a person.
"""

import os
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

from grader.files.folder import read_folder
from grader.ros.installation.installation import Installation
from grader.ros.package.finding import read_packages
from grader.ros.package.package import Package
from tests.differential.compared import Compared
from tests.installation.my_robot import write_package
from tests.installation.setup_grammar import other_files, setup_py
from tests.oracles.colcon_builds import IMPLIED, Build, build_all


def compare(numbers: range) -> Iterator[Compared]:
    """Compare the packages of some seeds."""
    with TemporaryDirectory() as name:
        folders = [Path(name, str(number)) for number in numbers]
        sources = [
            write_package(folder / "src/my_robot", setup_py(seed), other_files(seed))
            for seed, folder in zip(numbers, folders, strict=True)
        ]
        done = build_all(zip(folders, sources, strict=True), os.cpu_count() or 1)
        for seed, folder, build in zip(numbers, folders, done, strict=True):
            setup, ignored = evaluated(folder / "src/my_robot")
            is_open = setup.doubt is not None or bool(setup.unknown)
            kind = "undetermined" if is_open else "failed" if build.error else "installed"
            yield Compared(seed, kind, difference(build, setup, ignored))


def evaluated(folder: Path) -> tuple[Installation, str]:
    """Return what the grader states of the package in a folder, and for which file colcon ignores it."""
    package = package_in(folder)
    assert package.installation is not None
    return package.installation, package.ignored_by


def package_in(folder: Path) -> Package:
    """Return the package in a folder."""
    return read_packages(read_folder(folder), "urdf/my_robot.urdf", "my_robot")[0]


def difference(build: Build, reported: Installation, ignored: str = "") -> str | None:
    """Return how what is stated differs from what colcon does; None if it does not."""
    foretold = [*filter(None, [ignored, reported.fault]), *reported.faults, *reported.stops]
    foretold += [] if reported.is_called else ["no call of setup()"]
    if build.error:
        last = build.error.strip()[-300:]
        return (
            None
            if foretold or reported.doubt
            else f"colcon fails, the grader does not say so: {last}"
        )
    if foretold:
        return f"colcon succeeds, the grader says that it fails: {foretold[0]}"
    if reported.doubt:
        return None
    stated = {
        target: it
        for target, it in reported.installed().items()
        if not target.startswith(("lib/", *IMPLIED))
    }
    wrong = stated.items() - build.installed.items()
    if wrong:
        return f"the grader says that {min(wrong)} is installed; colcon installs {sorted(build.installed.items())[:4]}"
    missing = build.installed.items() - stated.items()
    return (
        f"colcon installs {min(missing)}, the grader does not say so"
        if missing and not reported.unknown
        else None
    )
