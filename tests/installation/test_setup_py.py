"""The static evaluation of a setup.py gives the files that a colcon build installs.

`python -m tests.installation.test_setup_py` builds the samples again and writes what colcon does.
"""

import json
from collections.abc import Iterable
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

from tests.differential.colcons import difference, evaluated
from tests.installation.my_robot import SAMPLES, make_package
from tests.oracles.colcon_builds import Build, build_all, is_available

_RECORDED = Path(__file__).with_name("setup_samples.expected")

# The samples that are not decided, or not wholly, and the reason; no other sample may have one.
UNKNOWN: dict[str, str] = {
    "comprehension_first_of_a_listing": "line 1: the result depends on the order of the files in a folder, or on __file__",
    "data_files_in_setup_cfg": "line 3: the section [options.data_files] of setup.cfg is not evaluated",
    "destination_with_dots": "line 5: the target share/my_robot/../my_robot/rviz is not supported",
    "environment_chooses_the_setup": "line 4: the value of os.environ is not evaluated",
    "environment_condition": "line 6: os.environ.get is not evaluated",
    "files_are_made": "line 4: shutil.copy is not evaluated",
    "folder_name_for_the_package": "line 4: the name of a folder on the machine is not known",
    "function_that_yields": "line 7: a generator function is not evaluated",
    "function_with_global": "line 8: a statement of the kind Global is not evaluated",
    "hidden_file_named": "line 12: urdf/.hidden.urdf is an ignored file",
    "packages_in_setup_cfg": "line 3: the section [options] of setup.cfg is not evaluated; line 3: the section [options.packages.find] of setup.cfg is not evaluated",
    "same_target_twice": "line 13: several files are installed as share/my_robot/box.urdf: other/box.urdf and urdf/box.urdf",
    "two_sources_for_one_target": "line 15: several files are installed as share/my_robot/meshes/two.stl: meshes/a/two.stl and meshes/two.stl",
    "version_executed": "line 3: exec is not evaluated",
}


def build_samples(samples: Iterable[str] = SAMPLES) -> dict[str, Build]:
    """Build samples with colcon."""
    with TemporaryDirectory() as name:
        folders = [Path(name, sample) for sample in samples]
        texts = [make_package(folder.name, folder / "src/my_robot") for folder in folders]
        builds = build_all(zip(folders, texts, strict=True))
        return {folder.name: build for folder, build in zip(folders, builds, strict=True)}


def recorded() -> dict[str, Build]:
    """Return what colcon does with each sample: the installed files by path, or the last line of the error."""
    table: dict[str, dict[str, str] | str] = json.loads(_RECORDED.read_text(encoding="utf-8"))
    return {
        name: Build({}, found) if isinstance(found, str) else Build(found, "")
        for name, found in table.items()
    }


def _plain(build: Build) -> dict[str, str] | str:
    lines = [
        line for line in build.error.splitlines() if line.strip() and not line.startswith("Failed ")
    ]
    # The command that failed has the path of the oracle's Python in it.
    return (
        lines[-1].strip().split(" '[")[0][:100] if lines else dict(sorted(build.installed.items()))
    )


@pytest.mark.parametrize("sample", SAMPLES)
def test_colcon_installs_the_determined_files(sample: str, tmp_path: Path) -> None:
    """Files and locations are the same; a build that fails is predicted; unknown values have their reason."""
    make_package(sample, tmp_path / "my_robot")
    setup, ignored = evaluated(tmp_path / "my_robot")
    build = recorded()[sample]
    assert difference(build, setup, ignored) is None
    reasons = "; ".join(f"line {unknown.at.line}: {unknown.reason}" for unknown in setup.unknown)
    if sample in UNKNOWN or not build.error:
        assert reasons == UNKNOWN.get(sample, "")


@pytest.mark.exhaustive
@pytest.mark.skipif(not is_available(), reason="needs colcon: see CONTRIBUTING.md")
def test_colcon_does_what_is_recorded() -> None:
    """A build of every fifth sample installs the recorded files, or fails."""
    built, known = build_samples(list(SAMPLES)[::5]), recorded()
    assert {name: None if it.error else it.installed for name, it in built.items()} == {
        name: None if known[name].error else known[name].installed for name in built
    }


if __name__ == "__main__":
    _RECORDED.write_text(
        json.dumps({name: _plain(it) for name, it in build_samples().items()}, indent=1) + "\n"
    )
