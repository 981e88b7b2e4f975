"""The static evaluation of a setup.py gives the files that setuptools installs when it is run."""

from pathlib import Path

import pytest

from grader.files.folder import read_folder
from grader.package.setup_py import Setup, read_setup
from grader.static_python.parse import parse
from tests.oracles.setuptools_builds import Build, build_all, build_of
from tests.package.my_robot import SAMPLES, make_package

# The samples with unknown values, and the reason; no other sample may have any.
UNKNOWN = {
    "comprehension_first_of_a_listing": "the order of the files in a folder, or of a set",
    "data_files_in_setup_cfg": "data_files is set in setup.cfg",
    "destination_with_dots": "the target share/my_robot/../my_robot/rviz is not supported",
    "environment_chooses_the_setup": "known only at run time",
    "environment_condition": "known only at run time",
    "environment_in_destination": "a format of this kind is not supported",
    "files_are_made": "setup.py itself makes or changes files",
    "folder_name_for_the_package": "the name of the package's folder",
    "function_that_yields": "a generator function is not supported",
    "hidden_file_named": "is an ignored file",
    "list_slice_replaced": "this assignment to an item is not supported",
    "listing_until_found": "the order of the files in a folder, or of a set",
    "package_data_too": "package_data may install files, too",
    "same_target_twice": "several files are installed as share/my_robot/box.urdf: other/box.urdf and urdf/box.urdf",
    "slash_behind_a_file": "depends on the version of setuptools",
    "try_a_module_that_is_not_there": "an earlier error may have been caught",
    "two_sources_for_one_target": "several files are installed as share/my_robot/meshes/two.stl",
    "walk_that_is_steered": "list of folders is changed",
    "working_folder_is_left": "a change of the working folder",
}


@pytest.fixture(scope="module")
def builds(tmp_path_factory: pytest.TempPathFactory) -> dict[str, tuple[Build, Setup]]:
    """Install the data files of all samples with setuptools, and determine them statically."""
    folders = {sample: tmp_path_factory.mktemp("sample") for sample in SAMPLES}
    sources = {sample: make_package(sample, folder / "my_robot") for sample, folder in folders.items()}
    done = build_all(folders.values())
    return {
        sample: (build_of(folder, sources[sample], *result), setup_of(folder / "my_robot"))
        for (sample, folder), result in zip(folders.items(), done, strict=True)
    }


def setup_of(package: Path) -> Setup:
    """Return the statically determined files of a package."""
    return read_setup(parse((package / "setup.py").read_bytes(), "setup.py"), read_folder(package))


@pytest.mark.parametrize("sample", SAMPLES)
def test_setuptools_installs_the_determined_files(sample: str, builds: dict[str, tuple[Build, Setup]]) -> None:
    """Files and locations are the same; a run that fails is predicted; unknown values have their reason."""
    (installed, error), reported = builds[sample]
    foretold = [*filter(None, [reported.fault]), *reported.faults, *reported.stops]
    reason = "; ".join(unknown.reason for unknown in reported.unknown)
    if sample in UNKNOWN:
        assert UNKNOWN[sample] in reason
        assert not foretold
        assert reported.installed().items() <= installed.items()
    elif error:
        assert foretold, error
    else:
        assert not foretold
        assert not reason
        assert reported.installed() == installed


def test_setuptools_runs(builds: dict[str, tuple[Build, Setup]]) -> None:
    """The comparison is valid: setuptools installs the files that a plain setup.py lists."""
    done, _ = builds["literal_lists"]
    assert not done.error
    assert sorted(done.installed.values()) == [
        "launch/my_robot_rviz.launch.py",
        "package.xml",
        "resource/my_robot",
        "rviz/my_robot.rviz",
        "urdf/box.urdf",
        "urdf/my_robot.urdf",
    ]
