"""What a build of a package installs, as far as it is certain.

It is the result of its setup.py or CMakeLists.txt.
"""

from collections.abc import Collection, Sequence
from posixpath import basename, dirname, splitext

from grader.base.grouping import Strings, are_texts
from grader.base.names import closest
from grader.base.records import Named
from grader.base.source import Location, Source
from grader.ros.installation.file_search import EmptyGlob
from grader.ros.known.releases import Release, is_before
from grader.ros.python.evaluation import PythonError
from grader.ros.python.parse import START, Position, SyntaxFault, location_in
from grader.ros.python.values import Unknown, Value

_Names = Strings


class InstalledFile(Named):
    """One installed file: its path in the package, and its path below the prefix.

    `at` is the position that installs it.
    """

    source: str
    target: str
    at: Position


class InstallError(Named):
    """Something that cannot be installed, so that the build stops."""

    path: str
    reason: str
    at: Position
    hint: str = ""  # what the path may mean instead
    by: str = "data_files"  # what lists the path
    change: tuple[str, str] = ("", "")  # what is written in the call, and what is meant by it

    @property
    def message(self) -> str:
        """The error that stops the build, as part of a sentence."""
        if self.path:
            return f"{self.by} lists {self.path!r}, but {self.reason}"
        return self.reason


class LaterStop(Named):
    """What stops a build from a release on."""

    reason: str  # as part of a sentence
    since: Release
    at: Position
    instead: str  # what is right in all releases

    @property
    def note(self) -> str:
        """What is said where no release is stated."""
        return f"from {self.since.title()} on, {self.reason}: {self.instead}"


class IgnoredArgument(Named):
    """An argument that setup() does not have: setuptools ignores it, with a warning."""

    name: str
    meant: str | None  # the argument with a similar name

    @property
    def message(self) -> str:
        """What is wrong with it, as a sentence."""
        return f"setup() has no argument {self.name}" + (
            f"; did you mean {self.meant}?" if self.meant else ""
        )


class GeneratedInterfaces(Named):
    """What rosidl_generate_interfaces() makes code of, and the packages it may use.

    It has the paths of .msg, .srv and .action files, of which those in `files` are there, and the
    packages whose messages these may use.

    Where it is not certain that it is called, or with what, `is_certain` is False.
    """

    at: Position
    files: _Names = ()
    dependencies: _Names = ()
    is_certain: bool = True
    needs_group: bool = True  # whether package.xml has to make the package a member of a group


class CmakeComponent(Named):
    """A class that rclcpp_components loads from a library, and the program that starts it."""

    plugin: str  # sensors::Lidar
    at: Position
    executable: str = ""


class CmakeTarget(Named):
    """An executable or a library that CMake makes.

    Where it is not `is_certain`, it may have other sources, or not be made.
    """

    name: str
    kind: str  # executable, library or unknown
    sources: _Names  # paths in the package
    links: _Names  # what target_link_libraries() names
    packages: _Names  # what ament_target_dependencies() names
    components: tuple[CmakeComponent, ...]
    at: Position
    is_installed: bool
    is_certain: bool
    program: str = ""  # the name of its file; empty for a library, or where it is not known
    has_other_sources: bool = False  # that the package does not have: a build may make them
    is_shared: bool = False  # whether it is a library that programs load when they start


class FoundPackage(Named):
    """A package that find_package() of CMake looks for.

    Where it is not certain that it is called, as under a condition, `is_certain` is False.
    """

    name: str
    at: Position
    is_required: bool
    is_certain: bool
    is_for_tests: bool = False  # below if(BUILD_TESTING)


class UnclosedExpression(Named):
    """A generator expression of CMake, `$<...>`, that is not closed."""

    command: str
    target: str
    text: str  # of the argument
    at: Position

    @property
    def message(self) -> str:
        """What is wrong, as a sentence."""
        return (
            f"{self.command}() has a generator expression that is not closed: {self.text} lacks >"
        )


class KnownPrograms(Named):
    """The programs that a build installs: paths below the prefix, and names in setup.py."""

    executed: frozenset[str]  # that Linux may execute
    targets: frozenset[str]  # of all files
    listed: frozenset[str] | None  # in console_scripts; None where these are not known


class Installation(Named):
    """The result of a setup.py or CMakeLists.txt.

    `fault` is set if it cannot be parsed: nothing else is known then.

    What certainly stops a setup.py is read as if it was fixed, and a misspelt data_files as what it
    means: `copies` are the files that are installed then.
    """

    source: Source
    fault: SyntaxFault | None = None
    name: str | None = None
    copies: tuple[InstalledFile, ...] = ()
    # The paths below the prefix of what a build makes and `ros2 run` may start.
    programs: _Names = ()
    stops: tuple[InstallError, ...] = ()
    empty: tuple[EmptyGlob, ...] = ()
    faults: tuple[PythonError, ...] = ()
    unknown: tuple[
        Unknown, ...
    ] = ()  # with any of these, a file that is not among the copies may be installed as well
    # the first that is not evaluated, so that the file may not get to its end
    doubt: Unknown | None = None
    is_called: bool = True
    called_at: Position = START
    files_at: Position = START  # of the argument data_files; of the call without it
    entry_points: Value = None  # what setup() is given
    ignored: tuple[IgnoredArgument, ...] = ()  # arguments that setup() does not have
    scripts_folder: str = "bin"  # below the prefix, for console_scripts
    scripts: _Names = ()  # likewise, of files that CMake installs with the right to execute them
    packages: _Names = ()  # the Python packages, as far as they are known
    interfaces: tuple[GeneratedInterfaces, ...] = ()  # one for each call in CMakeLists.txt
    targets: tuple[CmakeTarget, ...] = ()  # of CMake
    later_stops: tuple[LaterStop, ...] = ()  # in releases that may not be meant
    found_packages: tuple[FoundPackage, ...] = ()  # of CMake, in their order
    unclosed: tuple[UnclosedExpression, ...] = ()  # of CMake, which do not stop it

    def in_releases(self, releases: Collection[Release]) -> "Installation":
        """Return it as it is built for some releases.

        What stops a build in all of them stops it; what does in one, or in no stated one, may
        stop it.
        """
        stops = list(self.stops)
        left = []
        for stop in self.later_stops:
            if releases and not any(is_before(release, stop.since) for release in releases):
                text = f"{stop.reason} from {stop.since.title()} on"
                stops.append(InstallError("", text, stop.at, f": {stop.instead}"))
            elif not releases:
                left.append(stop)
        return self._replace(stops=tuple(stops), later_stops=tuple(left))

    @property
    def console_scripts(self) -> Value:
        """What setup() is given as console_scripts; None if that is not known."""
        points = self.entry_points if self.entry_points is not None else {}
        return points.get("console_scripts", []) if isinstance(points, dict) else None

    def empty_for(self, files: Sequence[str], word: str | None) -> EmptyGlob | None:
        """Return the pattern without a match that is meant for one of these files.

        It is found by the folder or ending of the file, or by a word in it.
        """
        folders = {dirname(path) for path in files}
        endings = tuple({splitext(path)[1] for path in files} - {""})
        for glob in self.empty:
            folder = dirname(glob.pattern)
            if folder in folders or (folder and closest(folder, folders)):
                return glob
            if glob.pattern.endswith(endings):  # no text ends with one of no endings
                return glob
        if word is not None:
            for glob in self.empty:
                if word in glob.pattern.lower():
                    return glob
        return None

    def has_program(self, name: str, package: str, programs: KnownPrograms) -> bool | None:
        """Return whether a build installs a program where `ros2 run` looks for it.

        The result is None where this is not known. `programs` are those of `known_programs`.
        """
        if self.fault:
            return None
        path = f"lib/{package}/{name}"
        if path in programs.executed or path in programs.targets:
            # CMake takes the right to execute from the files of install(FILES ...) and
            # install(DIRECTORY ...).
            return path in programs.executed or not self.is_cmake
        if programs.listed is None or self.unknown:
            return None
        return name in programs.listed and self.scripts_folder == f"lib/{package}"

    def known_programs(self) -> KnownPrograms:
        """Return the programs that a build installs."""
        scripts = self.console_scripts
        listed = None
        if isinstance(scripts, list) and are_texts(scripts):
            listed = frozenset(script.partition("=")[0].strip() for script in scripts)
        executed = frozenset(self.programs + self.scripts)
        return KnownPrograms(executed, frozenset(copy.target for copy in self.copies), listed)

    def location(self, position: Position) -> Location:
        """Return the location of a position in the file."""
        return location_in(self.source, position)

    @property
    def file(self) -> str:
        """The name of the file: setup.py or CMakeLists.txt."""
        return basename(self.source.path)

    @property
    def is_cmake(self) -> bool:
        """Whether it is a CMakeLists.txt."""
        return self.file != "setup.py"

    @property
    def is_unknown_after_error(self) -> bool:
        """Whether what is installed is unknown only because of an error that stops Python."""
        return bool(self.unknown and self.faults) and all(
            reason.follows_error for reason in self.unknown
        )

    @property
    def fault_text(self) -> str:
        """Why the file is not read, as part of a sentence; empty if it is."""
        if not self.fault:
            return ""
        return (
            f"{'CMake' if self.is_cmake else 'Python'} cannot read {self.file}: "
            f"{self.fault.message}"
        )

    @property
    def unread(self) -> str:
        """Why it is not known what the file does, as part of a sentence.

        It is empty if it is, or if it certainly fails.
        """
        if not self.fault or self.fault.is_certain:
            return ""
        return f"{self.file} cannot be read ({self.fault.message})"

    @property
    def entries(self) -> str:
        """What lists the installed files: data_files in setup.py, install() in CMakeLists.txt."""
        return f"{'install()' if self.is_cmake else 'data_files'} in {self.file}"

    @property
    def entry(self) -> str:
        """One of these: entry of data_files in setup.py, install() in CMakeLists.txt."""
        if self.is_cmake:
            return self.entries
        return f"entry of {self.entries}"

    @property
    def misspelt(self) -> IgnoredArgument | None:
        """The argument that stands for data_files, so that a build installs none of its files."""
        return next((argument for argument in self.ignored if argument.meant == "data_files"), None)

    def installed(self) -> dict[str, str]:
        """Return each installed file's source by its path below the prefix."""
        return {copy.target: copy.source for copy in self.copies}
