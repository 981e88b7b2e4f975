"""The names of a package's programs, and the one that another name may mean."""

from collections.abc import Sequence
from posixpath import basename

from grader.base.grouping import only_one
from grader.base.names import closest, near
from grader.ros.package.entry_points import entry_points
from grader.ros.package.package import Package


def program_names(package: Package) -> list[str]:
    """Return the programs that ros2 run finds in a package, and its entry points."""
    setup = package.installation
    home = f"lib/{package.name}"
    names = {entry.name for entry in entry_points(package)}
    if setup:
        for path in (*setup.programs, *(copy.target for copy in setup.copies)):
            if path.startswith(f"{home}/"):
                names.add(basename(path))
    return sorted(names)


def meant_program(name: str, programs: Sequence[str]) -> str | None:
    """Return the one of some programs that a name may mean; None without any."""
    return closest(name, programs) or near(name, programs, "node")


def program_of_module(package: Package, name: str) -> str | None:
    """Return the one entry point whose module has a name; None without one, or with several."""
    programs = {
        entry.name
        for entry in entry_points(package)
        if entry.module.split(".")[-1] == name.removesuffix(".py")
    }
    return only_one(programs)


def surely_meant_program(package: Package, name: str) -> str | None:
    """Return the program that the name of another one surely means; None where that is a guess."""
    return program_of_module(package, name) or near(name, program_names(package), "node")
