"""The static evaluation of a setup.py gives the files that setuptools installs when it is run."""

import os
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import pytest

from grader.files.folder import read_folder
from grader.files.names import ignored_part
from grader.package.setup_py import Setup, read_setup
from grader.static_python.parse import parse
from tests.command_line import HANG_TIMEOUT
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
# The message of install_data without data files; `setup.py install` does not call it then.
_NOTHING = "TypeError: 'NoneType' object is not iterable"


class BuildRun(NamedTuple):
    """The result of running a setup.py: the source of each installed file, or the text of the error."""

    installed: dict[str, str]
    error: str
    reported: Setup


# Runs the setup.py in each folder of those on the command line, in a process of its own that has setuptools already; below the
# folder's `root`, so that a file with an absolute path is written nowhere else. The output is in its `output`.
_BUILDER = """
import os, runpy, sys, traceback
import setuptools, setuptools.command.egg_info, setuptools.dist, distutils.command.install_data

for top in sys.argv[1:]:
    child = os.fork()
    if not child:
        code = 1
        with open(f"{top}/output", "w") as output:
            os.dup2(output.fileno(), 1)
            os.dup2(output.fileno(), 2)
        os.chdir(f"{top}/my_robot")
        sys.path[0] = os.getcwd()
        install = ["--quiet", "install_data", "--root", f"{top}/root", "--install-dir", f"{top}/root/prefix"]
        sys.argv = ["setup.py", *install]
        try:
            runpy.run_path("setup.py", run_name="__main__")
            code = 0
        except SystemExit as end:
            print(end.code, file=sys.stderr)
            code = end.code if isinstance(end.code, int) else end.code is not None
        except BaseException:
            traceback.print_exc()
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)
    print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), flush=True)
"""


class Build(NamedTuple):
    """What setuptools made of a sample in a folder: the exit code, and what it printed."""

    folder: Path
    sources: dict[str, str]
    code: int
    output: str


@pytest.fixture(scope="module")
def builds(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Build]:
    """Install the data files of all samples with setuptools."""
    folders = {sample: tmp_path_factory.mktemp("sample") for sample in SAMPLES}
    sources = {sample: make_package(sample, folder / "my_robot") for sample, folder in folders.items()}
    done = subprocess.run(
        [sys.executable, "-B", "-W", "ignore", "-c", _BUILDER, *map(str, folders.values())],
        env={name: value for name, value in os.environ.items() if not name.startswith(("MY_", "SETUPTOOLS_"))},
        capture_output=True,
        text=True,
        check=True,
        timeout=HANG_TIMEOUT,
    )
    return {
        sample: Build(folder, sources[sample], int(code), (folder / "output").read_text(encoding="utf-8"))
        for (sample, folder), code in zip(folders.items(), done.stdout.split(), strict=True)
    }


def run(sample: str, builds: dict[str, Build]) -> BuildRun:
    """Return the data files that setuptools installed, and the statically determined files for the same sample."""
    top, sources, code, output = builds[sample]
    package, root = top / "my_robot", top / "root"
    reported = read_setup(parse((package / "setup.py").read_bytes(), "setup.py"), read_folder(package))
    installed = {
        os.path.relpath(path, root / "prefix")
        if path.is_relative_to(root / "prefix")
        else f"/{path.relative_to(root)}": path
        for path in root.rglob("*")
        if path.is_file()
    }
    texts = {target: path.read_text(encoding="utf-8") for target, path in installed.items()}
    return BuildRun(
        {target: sources[text] for target, text in texts.items() if not ignored_part(sources[text])},
        f"status {code}: {output}" if code and _NOTHING not in output else "",
        reported,
    )


@pytest.mark.parametrize("sample", SAMPLES)
def test_setuptools_installs_the_determined_files(sample: str, builds: dict[str, Build]) -> None:
    """Files and locations are the same; a run that fails is predicted; unknown values have their reason."""
    installed, error, reported = run(sample, builds)
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


def test_setuptools_runs(builds: dict[str, Build]) -> None:
    """The comparison is valid: setuptools installs the files that a plain setup.py lists."""
    done = run("literal_lists", builds)
    assert not done.error
    assert sorted(done.installed.values()) == [
        "launch/my_robot_rviz.launch.py",
        "package.xml",
        "resource/my_robot",
        "rviz/my_robot.rviz",
        "urdf/box.urdf",
        "urdf/my_robot.urdf",
    ]
