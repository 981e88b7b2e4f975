"""The problems of a package's files, with their codes and locations.

They are the same whatever the files are graded on.
"""

from collections.abc import Collection, Iterable, Iterator
from fnmatch import fnmatchcase
from functools import partial
from posixpath import basename

from grader.base.names import did_you_mean
from grader.base.problems import NO_FIXES, Fix, Fixes, Problem
from grader.base.slips import Slip, fix_together
from grader.base.source import Location, Source
from grader.base.text import enumerated, quoted
from grader.ros.installation import package_problems as kinds
from grader.ros.installation.installation import Installation, InstallError
from grader.ros.installation.places import is_of_one_machine, one_machine_only
from grader.ros.known.releases import Release
from grader.ros.launch.launch_model import Launch, LaunchFault
from grader.ros.package.package import MANIFEST, RESOURCE_INDEX, Package
from grader.ros.python.parse import SyntaxFault

_MAX_FILES = 5  # launch files, and RViz files
_MAX_FILES_NAMED = 3  # in a message


def package_problems(package: Package) -> tuple[Problem, ...]:
    """Return the problems of package.xml, setup.py, launch files and RViz files.

    Those of each file are sorted by location.
    """
    problems = build_problems(package)
    launches = {path: package.launch(path) for path in package.launch_files[:_MAX_FILES]}
    included = set()  # whose problems are those of the files that include them
    for launch in launches.values():
        included |= {package.installed.get(passed.path) for passed in launch.passed}
    for path, launch in launches.items():
        if path not in included:
            problems += launch_problems(launch)
    for path in package.rviz_files[:_MAX_FILES]:
        problems += sorted_problems(package.rviz(path).problems)
    return tuple(problems)


def build_problems(package: Package, releases: Collection[Release] = ()) -> list[Problem]:
    """Return the problems of package.xml, and of setup.py or CMakeLists.txt, in some releases."""
    problems = []
    if package.copies:
        place = Location(f"{package.copies[0]}/{MANIFEST}", 1, 1)
        problems.append(Problem(kinds.PACKAGE_TWICE, package.copies_text, place))
    if package.manifest:
        problems += sorted_problems(package.manifest.problems)
    if package.installation:
        setup = package.installation.in_releases(releases)
        problems += sorted_problems(_setup_problems(package, setup))
    return problems


def launch_problems(launch: Launch) -> list[Problem]:
    """Return the problems of a launch file, and of those that it includes."""
    return sorted_problems(_launch_problems(launch))


# Of a whole file: these are listed, where what is not known in a file is counted.
_SETUP_UNREAD = kinds.SETUP_UNKNOWN._replace(severity="warning")
_LAUNCH_UNREAD = kinds.LAUNCH_UNKNOWN._replace(severity="warning")


def sorted_problems(problems: Iterable[Problem]) -> list[Problem]:
    """Return the problems of one file in the order of their places."""
    return sorted(
        problems,
        key=lambda problem: (
            problem.location.line,
            problem.location.column,
            problem.code,
            problem.message,
        ),
    )


def _syntax_problem(setup: Installation, fault: SyntaxFault) -> Problem:
    """Return that a setup.py or CMakeLists.txt cannot be read."""
    kind = kinds.SETUP_SYNTAX
    text = setup.fault_text
    if not fault.is_certain:
        kind = _SETUP_UNREAD
        text = f"{setup.file} is not read: {fault.message}"
    fixes = NO_FIXES if setup.is_cmake else syntax_fixes(setup.source)
    return Problem(kind, text, fault.location, fixes=fixes)


def _setup_problems(package: Package, setup: Installation) -> Iterator[Problem]:
    if setup.fault:
        yield _syntax_problem(setup, setup.fault)
        return
    for error in setup.faults:
        yield Problem(kinds.SETUP_NAME, error.message, setup.location(error.at))
    for stop in setup.stops:
        at = setup.location(stop.at)
        fixes = Fixes(partial(_fix_stop, setup, stop))
        yield Problem(kinds.SETUP_STOPS, stop.message + stop.hint, at, fixes=fixes)
    for later in setup.later_stops:
        yield Problem(kinds.OLDER_ONLY, later.note, setup.location(later.at))
    for empty in setup.empty:
        message = (
            f"the pattern {empty.pattern!r} in {setup.file} matches no "
            f"file{why_no_match(package, empty.pattern)}"
        )
        yield Problem(kinds.EMPTY_GLOB, message, setup.location(empty.at))
    for argument in setup.ignored:
        yield Problem(kinds.IGNORED_ARGUMENT, argument.message, setup.location(setup.called_at))
    for unknown in setup.unknown:
        message = f"cannot be determined statically: {unknown.reason}"
        yield Problem(kinds.SETUP_UNKNOWN, message, setup.location(unknown.at))
    if not setup.is_cmake:
        yield from _naming_problems(package, setup)
    elif setup.targets:
        from grader.ros.package.cmake_problems import cmake_problems  # late: few packages have C++

        yield from cmake_problems(package, setup)


def _fix_stop(setup: Installation, stop: InstallError) -> list[Fix]:
    """Return the fix that writes what is meant in the call that stops a build, or before it."""
    text, (written, meant) = setup.source.text, stop.change
    start = setup.source.start_offset(setup.location(stop.at))
    at = text.find(written, start, text.find(")", start))
    if not meant or at < 0:
        return []
    edit = setup.source.edit(at, at + len(written), meant)
    return [Fix((edit,), f"{quoted(written)} is read as {quoted(meant)}")]


def _naming_problems(package: Package, setup: Installation) -> Iterator[Problem]:
    """Yield what is wrong with the package's name in setup.py.

    Also yield what is wrong with the entries that register the package.
    """
    start = setup.location(setup.called_at)
    declared = package.manifest.name if package.manifest else None
    is_known = not (setup.unknown or setup.stops)
    if declared is not None and setup.name is not None and setup.name != declared:
        message = f"package.xml names the package {declared!r}, setup.py names it {setup.name!r}"
        yield Problem(kinds.OTHER_NAME, message, start)
        is_known = False  # the entries are missing under one of the two names in any case
    yield from _entry_problems(package, setup, is_known=is_known)


def _entry_problems(package: Package, setup: Installation, *, is_known: bool) -> Iterator[Problem]:
    """Yield which entries that register the package are missing in setup.py."""
    start = setup.location(setup.called_at)
    targets = setup.installed()
    if is_known and RESOURCE_INDEX + package.name not in targets:
        message = (
            f"data_files has no entry for the resource index: resource/{package.name} is not "
            "installed"
        )
        yield Problem(kinds.NO_MARKER, message, start)
    if is_known and f"share/{package.name}/package.xml" not in targets:
        message = f"data_files does not install package.xml in share/{package.name}"
        yield Problem(kinds.NO_MANIFEST_ENTRY, message, start)
    elif not is_known and MANIFEST not in targets.values() and MANIFEST not in setup.source.text:
        message = (
            "setup.py does not name package.xml, which data_files should install in "
            f"share/{package.name}"
        )
        yield Problem(kinds.NO_MANIFEST_ENTRY, message, start)


def _launch_problems(launch: Launch) -> Iterator[Problem]:
    if launch.unread:
        message = f"the launch file is not read: {launch.unread}"
        yield Problem(_LAUNCH_UNREAD, message, Location(launch.source.path, 1, 1))
    if launch.syntax:
        yield launch_syntax(launch, launch.syntax)
    for fault in launch.faults:
        yield Problem(kinds.LAUNCH_FAULT, f"{fault.message}{fault.hint}", fault.location)
    for unknown in launch.unknown:
        yield Problem(kinds.LAUNCH_UNKNOWN, unknown.message, unknown.location)
    for reference in launch.references:
        if reference.path is not None and is_of_one_machine(reference.path):
            yield Problem(kinds.HARD_CODED, one_machine_only(reference.path), reference.location)


def launch_syntax(launch: Launch, syntax: LaunchFault) -> Problem:
    """Return that Python cannot read a launch file."""
    fixes = syntax_fixes(launch.source)
    return Problem(kinds.LAUNCH_SYNTAX, syntax.message, syntax.location, fixes=fixes)


def syntax_fixes(source: Source) -> Fixes:
    """Return the fix of a file that Python cannot read."""

    def find() -> list[Slip]:
        from grader.ros.python.python_slips import python_slips  # late: few problems are fixed

        return python_slips(source.text.encode("utf-8", "surrogateescape"), source.path)

    return fix_together(find)


def why_no_match(package: Package, pattern: str) -> str:
    """Return the end of a message on a pattern of setup.py that matches no file.

    It says why, or which files there are.
    """
    if "\\" in pattern:
        return ": separate the parts of a path with /, not with \\"
    folder, _, name = pattern.rpartition("/")
    if folder and folder not in package.tree.folders:
        return (
            f", because there is no folder {folder!r}{did_you_mean(folder, package.tree.folders)}"
        )
    files = [
        path for path in package.tree.files if name.strip("*") and fnmatchcase(basename(path), name)
    ]
    files = files or [path for path in package.tree.files if path.rpartition("/")[0] == folder]
    if not files:
        return f", because the folder {folder!r} is empty"
    return f"; there {'are' if len(files) > 1 else 'is'} {enumerated(files, _MAX_FILES_NAMED)}"
