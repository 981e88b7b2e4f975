"""Where launch files look for files, and whether a build installs them there."""

from posixpath import basename, join, normpath
from typing import TYPE_CHECKING, Literal

from grader.base.errors import InputError, MissingElement
from grader.base.names import closest, is_misspelling
from grader.base.records import Named
from grader.base.source import Location, Source
from grader.base.text import enumerated
from grader.files.reading import URDF_LIMIT
from grader.ros.installation.places import (
    BY_MOVEIT,
    BY_UTF8,
    HOME,
    PREFIX,
    ROS,
    WORKING_FOLDER,
    is_of_one_machine,
    one_machine_only,
    share_parts,
    where_written,
)
from grader.ros.package.installed_files import Lookup, look_up
from grader.ros.package.package import Package
from grader.ros.python.values import OBJECT

if TYPE_CHECKING:
    from grader.ros.launch.launch_model import Launch, NamedFile, Purpose
    from grader.ros.package.installed_robot import InstalledRobot

_WORDS = {
    "urdf": "URDF",
    "rviz": "RViz file",
    "include": "launch file",
    "launch": "launch file",
    "read": "file",
}
_ENDINGS = {
    "urdf": (".urdf", ".xacro"),
    "rviz": (".rviz",),
    "include": (".py", ".xml", ".launch", ".yaml", ".yml"),
    "read": ("",),
}
DROPS_FOLDERS = "joining a path that begins with / drops the folders before it"


class FilePlace(Named):
    """Where a launch file looks for a file, or why it is not there.

    The state is `missing` if a build does not install it.

    `mistake` is the text without what differs between students, `cause` one of those of the check
    `launch_finds_files`.
    """

    file: "NamedFile"
    state: Literal["found", "wrong", "unknown", "missing"]
    text: str = ""
    mistake: str = ""
    cause: str = ""

    @property
    def is_local(self) -> bool:
        """Whether the path exists on one machine only."""
        return self.file.path is not None and is_of_one_machine(self.file.path)

    def location_in(self, source: Source) -> Location:
        """Return where a path of one machine is written, or else where the file is used."""
        at = self.file.location
        if self.is_local and at.path == source.path:
            return where_written(source, self.file.path or "") or at
        return at

    @property
    def problem(self) -> str:
        """The message of the problem that a path of one machine is."""
        return one_machine_only(self.file.path) if self.file.path else ""

    @property
    def is_of_robot(self) -> bool:
        """Whether it is a URDF or an RViz file, or what MoveIt reads."""
        return self.file.purpose not in ("include", "read") or self.file.by == BY_MOVEIT

    @property
    def stops_launch(self) -> bool:
        """Whether ros2 launch stops if it does not find the file."""
        return self.file.purpose in ("read", "include") or self.file.by != ""

    def is_in_misnamed(self, package: Package) -> bool:
        """Return whether the file is looked for below a wrong name of the package.

        No package of this name is on the machine.
        """
        owner, _ = share_parts(self.file.path or "")
        return self.state == "wrong" and bool(owner) and not package.find(owner)

    def with_parts(self, package: Package) -> "FilePlace":
        """Return the place of a robot's file, or where something that it needs is not installed."""
        if self.state != "found" or self.file.purpose not in ("urdf", "read") or not self.text:
            return self
        missing = self.installed_robot(package).missing
        if not missing:
            return self
        mistake = "the robot needs a file that a build does not install"
        detail = (
            f"{basename(self.text)} needs {enumerated(missing)}, which a build does not "
            "install there"
        )
        return FilePlace(self.file, "wrong", detail, mistake, "needs")

    def installed_robot(self, package: Package) -> "InstalledRobot":
        """Return the robot in the installed file."""
        # Late: most launch files open a URDF without xacro.
        from grader.ros.package.installed_robot import read_installed

        return read_installed(
            package, self.text, dict(self.file.arguments) if self.file.by == "xacro" else None
        )


def find_places(
    package: Package, launch: "Launch", *purposes: "Purpose", built: bool
) -> list[FilePlace]:
    """Return where a launch file looks for files.

    Raises MissingElement for one that a build does not install.
    """
    places = [_find_place(package, file, built=built) for file in launch.named(*purposes)]
    present = {basename(path) for other in package.packages.values() for path in other.tree.files}
    for place in places:
        is_needed = built or basename(place.file.path or "") not in present
        if (
            place.state == "missing"
            and is_needed
            and not any(wrong.state == "wrong" for wrong in places)
        ):
            raise _missing_file(package, place)
    return places


def _missing_file(package: Package, place: FilePlace) -> MissingElement:
    """Return what the package is missing for a named file.

    It has the kinds and names that the checks of packages use.
    """
    setup = package.installation
    purpose = place.file.purpose
    name = package.folder
    if setup and setup.misspelt is not None:
        return package.without_data_files(setup.misspelt.message)
    kind = f"installed {purpose}"
    looked_for = basename(place.file.path or "")
    if not setup or setup.fault:
        kind = "setup.py"
    elif not setup.is_called:
        kind = "call of setup"
    elif not any(
        path.lower().endswith(_ENDINGS[purpose]) or basename(path) == looked_for
        for path in package.tree.files
    ):
        kind = f"{_WORDS[purpose]} in the package"
        name = ""
    cause = "" if kind == f"installed {purpose}" else "missing"
    return MissingElement(kind, name, message=place.text, location=place.file.location, cause=cause)


def _find_place(package: Package, file: "NamedFile", *, built: bool) -> FilePlace:
    """Return whether a launch file finds a file that it names."""
    if file.path is None or file.reason:
        state: Literal["wrong", "unknown"] = "wrong" if file.is_certain else "unknown"
        return FilePlace(file, state, file.reason, cause="given")
    if OBJECT in file.path:
        name = file.path.rpartition(OBJECT)[0].rpartition("<")[2]
        reason = (
            f"{name}(...) is made part of a text, which is not its value then: use "
            "PathJoinSubstitution([...])"
        )
        return FilePlace(file, "wrong", reason, cause="given")
    what = _WORDS[file.purpose]
    path = normpath(file.path)
    owner, rest = share_parts(path)
    if owner:
        other = package.find(owner)
        if not other:
            return _place_in_unknown(package, owner, rest, file)
        place = _place_in_package(other, f"share/{owner}/{rest}", file)
        is_there = basename(rest) in map(basename, other.tree.files)
        return (
            place._replace(state="missing")
            if place.state == "unknown" and is_there and not built
            else place
        )
    fault = _fault_of_path(package, path)
    if fault:
        reason = f"the launch file looks for the {what} at {fault}"
        return FilePlace(file, "wrong", reason, cause="local")
    return FilePlace(
        file, "unknown", f"the {what} {path.removeprefix(PREFIX)} is not part of the package"
    )


def _fault_of_path(package: Package, path: str) -> str:
    """Return a path that is not below a share folder, with why no file is there.

    It is empty where that is not known.
    """
    if is_of_one_machine(path):
        return f"{path.replace(HOME, '~')}, which exists on one machine only"
    if path.startswith(WORKING_FOLDER) or not path.startswith("/"):
        shown = path.removeprefix(WORKING_FOLDER + "/")
        if shown.startswith("~"):
            return f"{shown}, but nothing replaces ~ by the home folder"
        return f"{shown}, relative to the folder that ros2 launch is started from"
    if not path.startswith((PREFIX, ROS)) and basename(path) in map(basename, package.tree.files):
        return f"{path}: {DROPS_FOLDERS}"
    return ""


def _place_in_unknown(package: Package, owner: str, rest: str, file: "NamedFile") -> FilePlace:
    """Return what is known of a path in the share folder of an unknown package.

    The package is not part of the workspace.

    Raises MissingElement if it should be.
    """
    if owner in package.wanted_packages:
        raise MissingElement("package", owner, message=f"no package is named {owner!r}")
    what = _WORDS[file.purpose]
    fault = "" if package.depends_on(owner) else _fault_of_owner(package, owner, rest, what)
    if fault:
        return FilePlace(file, "wrong", fault, cause="name")
    if file.purpose == "include":
        return FilePlace(file, "found")
    return FilePlace(
        file, "unknown", f"the {what} is in {owner!r}, which is not part of the submission"
    )


def _fault_of_owner(package: Package, owner: str, rest: str, what: str) -> str:
    """Return how the name of a package that is not part of the workspace is wrong.

    It is empty where that is not known.
    """
    # A path may lack a slash after the package's name: get_package_share_directory(...) +
    # 'my_robot.urdf'.
    more = owner.removeprefix(package.name)
    is_known = more in package.tree.folders if rest else more in map(basename, package.tree.files)
    if owner.startswith(package.name) and is_known:
        path = join("share", owner, rest).rstrip("/")
        return (
            f"the launch file looks for the {what} at {path}: a slash is missing after "
            f"{package.name!r}"
        )
    if is_misspelling(owner, package.name):
        return (
            f"the launch file looks in a package {owner!r}, but the graded package is named "
            f"{package.name!r}"
        )
    return ""


def _place_in_package(owner: Package, target: str, file: "NamedFile") -> FilePlace:
    """Return whether a build of a package installs a file at the path where it is looked for."""
    lookup = look_up(owner, target)
    setup = owner.installation
    what = _WORDS[file.purpose]
    match lookup.state:
        case "unknown":
            return FilePlace(
                file, "unknown", f"cannot determine statically whether a build installs {target}"
            )
        case "no build":
            return FilePlace(file, "missing", f"a build installs no {what}: {lookup.text}")
        case "installed" if setup and setup.misspelt is not None:
            return FilePlace(
                file, "missing", f"a build does not install the {what}: {setup.misspelt.message}"
            )
        case "installed":
            return _place_not_utf8(owner, lookup.path, file) or FilePlace(file, "found", target)
    return _place_not_there(owner, target, lookup, file)


def _place_not_utf8(owner: Package, path: str, file: "NamedFile") -> FilePlace | None:
    """Return where reading a file stops the launch file, because its text is not UTF-8.

    Returns None where it does not.
    """
    try:
        if file.by in BY_UTF8:
            owner.tree.files[path].read(URDF_LIMIT).decode()
    except UnicodeDecodeError as error:
        line = error.object.count(b"\n", 0, error.start) + 1
        mistake = (
            f"reading the {_WORDS[file.purpose]} stops the launch file with a "
            "UnicodeDecodeError: it is not UTF-8"
        )
        detail = f" (line {line} of {basename(path)}); save it as UTF-8"
        return FilePlace(file, "wrong", mistake + detail, mistake, "encoding")
    except InputError:
        pass  # other criteria report it
    return None


def _installing_line(owner: Package, target: str) -> str:
    """Return the line of the build file that installs a file, for the end of a sentence."""
    setup = owner.installation
    for copy in setup.copies if setup else ():
        if copy.target == target and setup:
            return f" ({setup.file}:{copy.at.line})"
    return ""


def _place_not_there(owner: Package, target: str, lookup: Lookup, file: "NamedFile") -> FilePlace:
    """Return where else a build installs a file, or what the package has instead of it."""
    message = f"the launch file looks for the {_WORDS[file.purpose]} at {target}, but {lookup.text}"
    if lookup.state == "elsewhere":
        message += _installing_line(owner, lookup.path)
        # Outside of the package's folder, at the path where the launch file looks in it: that is
        # the fault of setup.py.
        is_at_path = f"/{lookup.path}".endswith(f"/{target.removeprefix(owner.share)}")
        is_of_setup = is_at_path and not lookup.path.startswith(owner.share)
        return FilePlace(file, "missing" if is_of_setup else "wrong", message)
    if lookup.state == "not installed":
        return FilePlace(file, "missing", message)
    names = {*map(basename, owner.tree.files)}
    names.discard(basename(file.location.path))
    alike = sorted(name for name in names if name.lower().endswith(_ENDINGS[file.purpose]))
    is_include = file.purpose == "include"
    if not alike and not is_include:
        return FilePlace(file, "missing", message)
    similar = _similar_file(target, alike, is_include=is_include)
    if similar is not None:
        message += f"; there is {similar!r}"
    return FilePlace(file, "wrong", message, cause="name")


def _similar_file(target: str, alike: list[str], *, is_include: bool) -> str | None:
    """Return the file that is meant: of a similar name, else the only one of its kind."""
    similar = closest(basename(target), alike)
    if similar is None and len(alike) == 1 and not is_include:
        return alike[0]
    return similar
