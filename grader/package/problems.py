"""The problems of a package's files, whatever they are graded on, with their codes and locations."""

from collections.abc import Iterable, Iterator

from grader.package import catalogue
from grader.package.launch.model import Launch
from grader.package.launch.places import HOME, is_of_one_machine
from grader.package.package import Package
from grader.package.setup_py import Setup
from grader.problems import Problem
from grader.source import Location

_MAX_FILES = 5  # launch files, and RViz files


def package_problems(package: Package) -> tuple[Problem, ...]:
    """Return the problems of package.xml, setup.py, launch files and RViz files, each file's sorted by location."""
    found: list[Problem] = []
    if package.manifest is not None:
        found += _sorted(package.manifest.problems)
    if package.setup is not None:
        found += _sorted(_setup_problems(package, package.setup))
    for path in package.launch_files[:_MAX_FILES]:
        found += _sorted(_launch_problems(package.launch(path)))
    for path in package.rviz_files[:_MAX_FILES]:
        found += _sorted(package.rviz(path).problems)
    return tuple(found)


def _sorted(problems: Iterable[Problem]) -> list[Problem]:
    return sorted(problems, key=lambda it: (it.location.line, it.location.column, it.code, it.message))


def _setup_problems(package: Package, setup: Setup) -> Iterator[Problem]:
    if setup.fault is not None:
        if setup.fault.sure:
            message = f"Python cannot read setup.py: {setup.fault.message}"
            yield Problem(catalogue.SETUP_SYNTAX, message, setup.fault.location)
        else:
            yield Problem(catalogue.SETUP_UNKNOWN, f"setup.py is not read: {setup.fault.message}", setup.fault.location)
        return
    for error in setup.faults:
        yield Problem(catalogue.SETUP_NAME, error.message, setup.location(error.at))
    for stop in setup.stops:
        yield Problem(catalogue.SETUP_STOPS, stop.message + stop.hint, setup.location(stop.at))
    for empty in setup.empty:
        message = f"the pattern {empty.pattern!r} in setup.py matches no file{package.pattern_hint(empty.pattern)}"
        yield Problem(catalogue.EMPTY_GLOB, message, setup.location(empty.at))
    for unknown in setup.unknown:
        message = f"cannot be determined statically: {unknown.reason}"
        yield Problem(catalogue.SETUP_UNKNOWN, message, setup.location(unknown.at))
    yield from _entry_problems(package, setup)


def _entry_problems(package: Package, setup: Setup) -> Iterator[Problem]:
    start = setup.location(setup.called_at)
    targets = set(setup.installed())
    declared = package.manifest.name if package.manifest is not None else None
    if declared is not None and setup.name is not None and setup.name != declared:
        message = f"package.xml names the package {declared!r}, setup.py names it {setup.name!r}"
        yield Problem(catalogue.OTHER_NAME, message, start)
        return  # the entries are missing under one of the two names in any case
    if setup.unknown or setup.stops:
        return
    if f"share/ament_index/resource_index/packages/{package.name}" not in targets:
        message = f"data_files has no entry for the resource index: resource/{package.name} is not installed"
        yield Problem(catalogue.NO_MARKER, message, start)
    if f"share/{package.name}/package.xml" not in targets:
        message = f"data_files does not install package.xml in share/{package.name}"
        yield Problem(catalogue.NO_MANIFEST_ENTRY, message, start)


def _launch_problems(launch: Launch) -> Iterator[Problem]:
    if launch.unread:
        message = f"the launch file is not read: {launch.unread}"
        yield Problem(catalogue.LAUNCH_UNKNOWN, message, Location(launch.path, 1, 1))
    if launch.syntax is not None:
        yield Problem(catalogue.LAUNCH_SYNTAX, launch.syntax.message, launch.syntax.location)
    for fault in launch.faults:
        yield Problem(catalogue.LAUNCH_FAULT, fault.message, fault.location)
    for unknown in launch.unknown:
        yield Problem(catalogue.LAUNCH_UNKNOWN, unknown.message, unknown.location)
    for reference in launch.references:
        if reference.path is not None and is_of_one_machine(reference.path):
            message = f"the path {reference.path.replace(HOME, '~')} exists on one machine only"
            yield Problem(catalogue.HARD_CODED, message, reference.location)
