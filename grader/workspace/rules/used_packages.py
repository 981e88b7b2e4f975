"""The packages that the files of a package use, by which its dependencies are compared."""

import posixpath
import re
from collections.abc import Collection, Iterator, Mapping

from grader.base.names import first_part, near
from grader.base.patterns import on_use
from grader.base.records import Named
from grader.base.source import Location, Source
from grader.ros.config.yaml_nodes import YamlNode
from grader.ros.config.yaml_values import sections_in
from grader.ros.installation.installation import FoundPackage
from grader.ros.installation.places import is_launch_file
from grader.ros.known.package_rows import controller_row, is_known_controller
from grader.ros.known.released import is_released
from grader.ros.launch.launch_model import Launch
from grader.ros.package.package import Package
from grader.ros.xml.elements import first_text
from grader.workspace.model.text_files import FILES_A_PART
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import charge_guess

_FIND = on_use(r"\$\(find ([\w-]+)\)|package://([\w-]+)/")
_OF_ROS = ("rclpy", "tf2_ros")
_XACRO = "xacro"
_RUNTIME = "rosidl_default_runtime"  # what generated interfaces need
_IMPORT = on_use(r"^[ \t]*+(?:from[ \t]+(\w+)|import[ \t]+(\w[\w., \t]*))", re.MULTILINE)
_MAX_GAP = 200  # characters of blank lines and spaces before an import
_OPTIONAL = ("try:", "TYPE_CHECKING:")  # before an import that may fail
# What every launch file imports; hardly a package declares it (275 of 691 public ones do not).
_OF_LAUNCH_FILES = (
    *("launch", "launch_ros", "launch_xml", "launch_yaml", "launch_testing"),
    *("launch_testing_ros", "ament_index_python"),
)
_CALL_WORDS = ("FindPackage", "get_package_", "$(find-pkg-", "$(exec-in-pkg")  # of each call
_CALL = on_use(
    r"\b(?:FindPackageShare|FindPackagePrefix|get_package_(?:share_(?:directory|path)|prefix))\("
    r"\s*(?:package(?:_name)?\s*=\s*)?[\"'](?P<call>\w+)[\"']"
    r"|\$\((?:find-pkg-(?:share|prefix)|exec-in-pkg\s+\S+)\s+(?P<xml>\w+)\s*\)"
)
# Metapackages whose name folders of headers and modules of other packages have.
_OF_SEVERAL = ("moveit",)
_LONG_TEXT = on_use(r"\"\"\".*?\"\"\"|\'\'\'.*?\'\'\'", re.DOTALL)
CPP_FILES = (".cpp", ".cc", ".cxx", ".c++", ".hpp", ".hh", ".hxx", ".h", ".h++")
HEADERS = (".hpp", ".hh", ".hxx", ".h", ".h++")
_COMMENT = on_use(r"//[^\n]*|/\*.*?(?:\*/|\Z)|\"(?:[^\"\\\n]|\\.)*\"", re.DOTALL)
_DIRECTIVE = on_use(
    r"^[ \t]*#[ \t]*(?:(?P<open>if\w*)|(?P<close>endif)|include[ \t]*[<\"](?P<path>[\w./-]+)[>\"])"
    r"(?P<rest>[^\n]*)",
    re.MULTILINE,
)
_MAX_DIRECTIVE = 500  # characters of an #include, behind which none is searched
OF_TESTS = on_use(r"(^|/)tests?/|(^|/|_)test_|[._]test\.")
_PlacedNames = Iterator[tuple[str, Location]]  # of packages, where a file names each


class PackageUse(Named):
    """A package that a file uses.

    With `is_built`, CMake needs it, and no program that runs; with `is_for_tests`, only tests.
    """

    name: str
    location: Location
    is_built: bool = False
    is_for_tests: bool = False

    @property
    def tag(self) -> str:
        """The tag with which package.xml declares it."""
        if self.is_for_tests:
            return "test_depend"
        return "depend" if self.is_built else "exec_depend"


def used_packages(workspace: Workspace, package: Package) -> Iterator[PackageUse]:
    """Yield the packages that the files of a package use, and where."""
    for name, at in _used_at_run_time(workspace, package):
        yield PackageUse(name, at)
    names = workspace.own_packages
    for name, at in _asked_for(workspace, package):
        if name in names or is_released(name):
            yield PackageUse(name, at)
    for required, at in required_by_cmake(package):
        if required.name in names or is_released(required.name):
            yield PackageUse(required.name, at, True, required.is_for_tests)
    for name, at in _included(workspace, package, names):
        yield PackageUse(name, at, is_built=True)


def required_by_cmake(package: Package) -> Iterator[tuple[FoundPackage, Location]]:
    """Yield the packages that CMake certainly has to find, and where."""
    setup = package.installation
    for required in setup.found_packages if setup else ():
        if required.is_required and required.is_certain:
            assert setup
            yield required, setup.location(required.at)


def _used_at_run_time(workspace: Workspace, package: Package) -> _PlacedNames:
    """Yield the packages that launch files, robots, Python and controllers name."""
    for owner, _, launch in workspace.launches.files:
        if owner is package:
            yield from _launched(launch)
    generated_at = workspace.code.interfaces[package.name].location
    if generated_at:
        yield _RUNTIME, generated_at
    names = workspace.own_packages
    yield from _found_by_xacro(workspace, package, names)
    yield from _imported(workspace, package, names)
    for tree in workspace.installed.trees:
        if package.holds(tree.source.path):
            for _, section in sections_in(tree):
                yield from _controller_packages(section, names)
    yield from _hardware_packages(workspace, package, names)


def _found_by_xacro(workspace: Workspace, package: Package, names: Collection[str]) -> _PlacedNames:
    """Yield the packages of paths in URDF and xacro. A misspelt own one is a mistake of files."""
    for name, at in named_in_robots(workspace, package):
        charge_guess(workspace, names)
        if name in names or package.depends_on(name) or near(name, names) is None:
            yield name, at


def named_in_robots(workspace: Workspace, package: Package) -> _PlacedNames:
    """Yield the packages of paths in URDF and xacro."""
    for source in workspace.texts.read_sources(package, (".xacro", ".urdf")):
        for match in _FIND.finditer(source.text):
            yield match[1] or match[2], source.at(match.start())


def _launched(launch: Launch) -> _PlacedNames:
    """Yield the packages whose programs or launch files a launch file starts.

    Among them is xacro, where it prints a robot.
    """
    included = {passed.location for passed in launch.passed}  # of whose nodes these are the places
    for node in launch.nodes:
        if not node.included_by and node.location not in included:
            yield node.package, node.location
    for reference in launch.references:
        if reference.by == _XACRO:
            yield _XACRO, reference.location
    for passed in launch.passed:
        folder, _, inside = passed.path.partition("/")
        if folder == "share" and inside:
            yield first_part(inside), passed.location


def _asked_for(workspace: Workspace, package: Package) -> _PlacedNames:
    """Yield the packages for whose folder launch files, Python and C++ ask."""
    texts = workspace.texts
    launched = {
        package.path(path) for owner, path, _ in workspace.launches.files if owner is package
    }
    for source in texts.launch_sources(package):
        if source.path in launched:
            yield from calls_in(source)
    for source in texts.read_sources(package, (".py", *CPP_FILES)):
        if source.path not in launched and not OF_TESTS.search(source.path):
            yield from calls_in(source)


def _without_long_texts(text: str) -> str:
    """Return code of Python with spaces in place of docstrings and other texts of several lines."""
    return _LONG_TEXT.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), text)


def calls_in(source: Source) -> _PlacedNames:
    """Yield the packages for whose folder a text asks; a docstring of Python asks for none."""
    text = source.text
    if not any(word in text for word in _CALL_WORDS):
        return
    if source.path.endswith(".py"):
        text = _without_long_texts(text)
    for match in _CALL.finditer(text):
        word = "call" if match["call"] is not None else "xml"
        yield match[word], source.at(match.start(word))


def _imported(workspace: Workspace, package: Package, names: Collection[str]) -> _PlacedNames:
    """Yield the packages of ROS 2 or of the workspace that the Python files of a package import.

    What every launch file imports does not count there.
    """
    for imported in imported_modules(workspace, package):
        is_usual = imported.is_launched and imported.name in _OF_LAUNCH_FILES
        is_needed = imported.name in names or not imported.is_nested
        if is_needed and not is_usual and _is_of_ros(imported, names):
            yield imported.name, imported.location


def _is_of_ros(imported: "_ImportedModule", names: Collection[str]) -> bool:
    """Return whether a module is that of a package of ROS 2, or of one with these names."""
    name = imported.name
    is_known = name in names or name.endswith("_msgs") or name in _OF_ROS
    return is_known or (imported.is_installed and _is_code(name))


class _ImportedModule(Named):
    """A module that a Python file imports, which is none of its package."""

    name: str
    location: Location
    is_launched: bool  # whether a launch file imports it
    is_installed: bool  # whether a file imports it that a build installs, or a launch file
    is_nested: bool = False  # in a function, or under a condition


def imported_modules(workspace: Workspace, package: Package) -> Iterator[_ImportedModule]:
    """Yield the modules that the Python files of a package import, as far as names say."""
    modules = set()  # of the package, as far as their names say
    for path in package.tree.files:
        modules |= {part.removesuffix(".py") for part in path.split("/")}
    setup = package.installation
    installed = {*package.installed.values()}
    python_packages = setup.packages if setup else ()
    own_folders = {name.partition(".")[0] for name in python_packages}
    for source in workspace.texts.read_sources(package, (".py",)):
        is_launch = is_launch_file(source.path)
        inside = source.path.removeprefix(package.path(""))
        is_part = is_launch or inside in installed or first_part(inside) in own_folders
        is_part = is_part and not OF_TESTS.search(source.path)
        text = _without_long_texts(source.text)
        for match in _IMPORT.finditer(text):
            is_nested = not match[0].startswith(("from", "import"))
            before = text[max(0, match.start() - _MAX_GAP) : match.start()]
            if is_nested and before.rstrip().endswith(_OPTIONAL):
                continue
            for name, offset in _list_modules(match):
                if name not in modules:
                    at = source.at(offset)
                    yield _ImportedModule(name, at, is_launch, is_part, is_nested)


def _is_code(name: str) -> bool:
    """Return whether a module or a folder of headers may be that of a released package."""
    return is_released(name) and name not in _OF_SEVERAL


def _list_modules(match: re.Match[str]) -> Iterator[tuple[str, int]]:
    """Yield the modules that a line imports, with their offsets."""
    if match[1] is not None:
        yield match[1], match.start(1)
        return
    offset = match.start(2)
    for part in match[2].split(","):
        name = re.match(r"\s*(\w+)", part)
        if name:
            yield name[1], offset + name.start(1)
        offset += len(part) + 1


def _controller_packages(section: YamlNode, names: Collection[str]) -> _PlacedNames:
    """Yield the packages of the controllers that a section of the controller manager names.

    `names` are the packages of the workspace, which may have controllers of their own.
    """
    for inner in section.table.values():
        kind = inner.get("type")
        if kind and is_known_controller(kind.text):
            own_package = first_part(str(kind.text))
            yield controller_row(kind.text).package or own_package, kind.location
        elif kind and first_part(str(kind.text)) in names:
            yield first_part(str(kind.text)), kind.location


def _hardware_packages(
    workspace: Workspace, package: Package, names: Collection[str]
) -> _PlacedNames:
    """Yield the packages of the hardware of robots that no package of the workspace declares."""
    for robot in workspace.robots.known:
        for system in robot.systems:
            for plugin in system.iterfind("hardware/plugin"):
                name = re.split("/|::", first_text(plugin))[0]
                at = robot.place(plugin)
                is_there = package.holds(at.path) and (name in names or is_released(name))
                if is_there and not any(other.depends_on(name) for other in workspace.packages):
                    yield name, at


def _included(workspace: Workspace, package: Package, names: Collection[str]) -> _PlacedNames:
    """Yield the packages of ROS 2 or of the workspace whose headers C++ files include.

    They are the files that a target compiles, and headers. What is included under a condition may
    not be needed, and a folder of the workspace that has the name may have the header.
    """
    setup = package.installation
    if not setup or not setup.targets:
        return
    compiled = {path for target in setup.targets for path in target.sources}
    folders = _folders_of_headers(workspace)
    for source in workspace.texts.read_sources(package, CPP_FILES):
        inside = source.path.removeprefix(package.path(""))
        is_header = inside.endswith(HEADERS) and not OF_TESTS.search(inside)
        if inside not in compiled and not is_header:
            continue
        for header in included_headers(source):
            name = first_part(header.path)
            at = header.location
            if name == header.path:
                continue
            owners = folders.get(name, ())
            is_ros = name in names or _is_code(name)
            if is_ros and name != package.name and {*owners} <= {name}:
                yield name, at


def _folders_of_headers(workspace: Workspace) -> Mapping[str, set[str]]:
    """Return the packages of the workspace that have a folder with headers, by its name."""
    owners: dict[str, set[str]] = {}
    for package in workspace.packages:
        workspace.charge(1 + len(package.tree.files) // FILES_A_PART)
        for path in package.tree.files:
            if path.endswith(HEADERS):
                for folder in posixpath.dirname(path).split("/"):
                    owners.setdefault(folder, set()).add(package.name)
    return owners


class IncludedHeader(Named):
    """A header that a C++ file includes, by its path as it is written."""

    path: str
    location: Location
    is_quoted: bool


def included_headers(source: Source) -> Iterator[IncludedHeader]:
    """Yield the headers that a file includes under no condition.

    The guard of a header is no condition.
    """
    text = source.text[: source.text.rfind("include") + _MAX_DIRECTIVE]
    if "/*" in text:
        text = _COMMENT.sub(_without_comment, text)
    depth = 0
    is_first = True
    for directive in _DIRECTIVE.finditer(text):
        if directive["open"]:
            is_guard = is_first and directive["open"] == "ifndef"
            depth += 0 if is_guard else 1
        elif directive["close"]:
            depth = max(0, depth - 1)
        elif depth == 0:
            at = source.at(directive.start("path"))
            yield IncludedHeader(directive["path"], at, text[directive.start("path") - 1] == '"')
        is_first = False


def _without_comment(match: re.Match[str]) -> str:
    """Return blanks in place of a comment; a text in quotes as it is."""
    if match[0].startswith('"'):
        return match[0]
    return re.sub(r"[^\n]", " ", match[0])
