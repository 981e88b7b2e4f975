"""What there is to say of a package's files, whatever they are graded on: problems with their codes and places."""

from collections.abc import Iterator

from grader.package import catalogue
from grader.package.launch.model import Launch
from grader.package.launch.places import HOME, is_of_one_machine
from grader.package.package import Package
from grader.package.setup_py import Setup
from grader.problems import Problem
from grader.source import Location

_MOST_FILES = 5


def remarks(package: Package) -> tuple[Problem, ...]:
    """The problems of package.xml, setup.py, launch files and RViz files, in this order, each file's by their places."""
    found: list[Problem] = []
    if package.manifest is not None:
        found += _ordered(package.manifest.problems)
    if package.setup is not None:
        found += _ordered(_of_setup(package, package.setup))
    for path in package.launch_files[:_MOST_FILES]:
        found += _ordered(_of_launch(package.launch(path)))
    for path in package.rviz_files[:_MOST_FILES]:
        found += _ordered(package.rviz(path).problems)
    return tuple(found)


def _ordered(problems: "Iterator[Problem] | tuple[Problem, ...]") -> list[Problem]:
    return sorted(problems, key=lambda each: (each.location.line, each.location.column, each.code, each.message))


def _of_setup(package: Package, setup: Setup) -> Iterator[Problem]:
    if setup.fault is not None:
        if setup.fault.sure:
            message = f"Python cannot read setup.py: {setup.fault.message}"
            yield Problem(catalogue.SETUP_SYNTAX, message, setup.fault.location)
        else:
            yield Problem(catalogue.SETUP_UNKNOWN, f"this is not read: {setup.fault.message}", setup.fault.location)
        return
    for fault in setup.faults:
        yield Problem(catalogue.SETUP_NAME, fault.message, setup.location(fault.at))
    for stop in setup.stops:
        yield Problem(catalogue.SETUP_STOPS, stop.message + stop.hint, setup.location(stop.at))
    for empty in setup.empty:
        message = f"the pattern {empty.pattern!r} in setup.py finds nothing{package.instead(empty.pattern)}"
        yield Problem(catalogue.EMPTY_GLOB, message, setup.location(empty.at))
    for unknown in setup.unknown:
        yield Problem(catalogue.SETUP_UNKNOWN, f"this is not followed: {unknown.reason}", setup.location(unknown.at))
    yield from _of_entries(package, setup)


def _of_entries(package: Package, setup: Setup) -> Iterator[Problem]:
    start = setup.location(setup.called_at)
    targets = set(setup.installed())
    declared = package.manifest.name if package.manifest is not None else None
    if declared is not None and setup.name is not None and setup.name != declared:
        message = f"package.xml names the package {declared!r}, setup.py names it {setup.name!r}"
        yield Problem(catalogue.OTHER_NAME, message, start)
        return  # what the entries lack is all of one of the names
    if setup.unknown or setup.stops:
        return
    if f"share/ament_index/resource_index/packages/{package.name}" not in targets:
        message = f"data_files has no entry for the resource index: resource/{package.name} is not installed"
        yield Problem(catalogue.NO_MARKER, message, start)
    if f"share/{package.name}/package.xml" not in targets:
        message = f"data_files does not install package.xml to share/{package.name}"
        yield Problem(catalogue.NO_MANIFEST_ENTRY, message, start)


def _of_launch(launch: Launch) -> Iterator[Problem]:
    if launch.unread:
        yield Problem(catalogue.LAUNCH_UNKNOWN, f"this is not read: {launch.unread}", Location(launch.path, 1, 1))
    if launch.syntax is not None:
        yield Problem(catalogue.LAUNCH_SYNTAX, launch.syntax.message, launch.syntax.location)
    for fault in launch.faults:
        yield Problem(catalogue.LAUNCH_FAULT, fault.message, fault.location)
    for unknown in launch.unknown:
        yield Problem(catalogue.LAUNCH_UNKNOWN, unknown.message, unknown.location)
    for named in launch.references:
        if named.path is not None and is_of_one_machine(named.path):
            shown = named.path.replace(HOME, "~")
            yield Problem(catalogue.HARD_CODED, f"{shown}, which exists on one machine only", named.location)
