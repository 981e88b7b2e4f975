"""Random setup.py: what is stated as installed against what setuptools installs.

The kinds: setuptools installs the files or ends with an error; `undetermined` is what the grader leaves to a person.
"""

from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

from grader.files.folder import read_folder
from grader.package.setup_py import Setup, read_setup
from grader.static_python.parse import parse
from tests.differential.compared import Compared
from tests.oracles.setuptools_builds import Build, build_all, build_of
from tests.package.my_robot import write_package
from tests.package.setup_grammar import setup_py


def compare(numbers: range) -> Iterator[Compared]:
    """Compare the setup.py of some seeds."""
    with TemporaryDirectory() as name:
        folders = [Path(name, str(number)) for number in numbers]
        sources = [
            write_package(folder / "my_robot", setup_py(seed)) for seed, folder in zip(numbers, folders, strict=True)
        ]
        done = build_all(folders)
        for seed, folder, texts, result in zip(numbers, folders, sources, done, strict=True):
            package = folder / "my_robot"
            build = build_of(folder, texts, *result)
            reported = read_setup(parse((package / "setup.py").read_bytes(), "setup.py"), read_folder(package))
            kind = "undetermined" if reported.unknown else "failed" if build.error else "installed"
            yield Compared(seed, kind, difference(build, reported))


def difference(build: Build, reported: Setup) -> str | None:
    """Return how what is stated differs from what setuptools does; None if it does not."""
    foretold = [*filter(None, [reported.fault]), *reported.faults, *reported.stops]
    if build.error:
        last = build.error.strip().rpartition("\n")[2]
        return None if foretold or reported.unknown else f"setuptools fails, the grader does not say so: {last}"
    if foretold:
        return f"setuptools succeeds, the grader says that it fails: {foretold[0]}"
    wrong = reported.installed().items() - build.installed.items()
    if wrong:
        return (
            f"the grader says that {min(wrong)} is installed; setuptools installs {sorted(build.installed.items())[:4]}"
        )
    missing = build.installed.items() - reported.installed().items()
    return (
        f"setuptools installs {min(missing)}, the grader does not say so" if missing and not reported.unknown else None
    )
