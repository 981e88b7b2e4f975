"""The packages in a file tree, and the files kept of earlier work among them."""

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from itertools import product
from posixpath import basename

from grader.base.errors import InputError
from grader.base.grouping import Strings
from grader.base.names import closest, folded
from grader.base.patterns import on_use
from grader.base.reuse import Memory
from grader.base.source import Location, Source
from grader.files.tree import Tree
from grader.ros.installation.manifest import Manifest, read_manifest
from grader.ros.installation.places import SHARE
from grader.ros.known.releases import Releases
from grader.ros.package.package import CMAKE, MANIFEST, SETUP, Package, Packages
from grader.ros.package.robot_file import launch_folders
from grader.ros.package.robots import RobotFile
from grader.ros.python.budget import Budget, whole_budget

_Packages = dict[str, Package]  # by their folders

# The files that hide a folder, with all that is below, from colcon.
IGNORING = ("COLCON_IGNORE", "AMENT_IGNORE", "CATKIN_IGNORE")
_MAX_PACKAGES = 40
# Files that are read as texts.
_TEXTS = (
    *(".py", ".xml", ".yaml", ".yml", ".urdf", ".xacro", ".launch", ".rviz", ".srdf", ".sdf"),
    *(".world", ".txt", ".cpp", ".cc", ".hpp", ".h"),
)
_MAX_MANIFEST_SIZE = 256 * 1024  # bytes
_NAMED, _IN_NAMED_FOLDER, _SIMILAR, _OTHER = range(4)  # how well a package has a name
_CAMEL = on_use(r"(?<=[^\W\d_A-Z])(?=[A-Z])")
_WORD = on_use(r"[^\W\d_]+")
_WORDS = frozenset(
    {
        "old",
        "older",
        "oldest",
        "backup",
        "backups",
        "bak",
        "copy",
        "copies",
        "kopie",
        "archive",
        "archived",
        "previous",
        "prev",
        "deprecated",
        "legacy",
        "unused",
        "trash",
        "draft",
        "drafts",
        "broken",
        "wrong",
    }
)


def is_backup(path: str) -> bool:
    """Return whether a file or folder is named like a backup.

    Examples are old_ws, my_robot - Copy, my_robot.urdf.bak.
    """
    return not _WORDS.isdisjoint(_WORD.findall(_CAMEL.sub(" ", path).casefold()))


def find_packages(tree: Tree, names: Sequence[str], most: int = _MAX_PACKAGES) -> list[str]:
    """Return the folders of packages.

    These are those with a package.xml, and those of these names with only a setup.py.
    """
    with_manifest = []
    with_setup = []
    for path in tree.files:
        folder, _, name = path.rpartition("/")
        if name == MANIFEST:
            with_manifest.append(folder)
        elif name == SETUP:
            with_setup.append(folder)
    named = [
        folder for folder in with_setup if folder not in with_manifest and basename(folder) in names
    ]
    if not with_manifest and not named:
        named = with_setup
    return sorted(with_manifest + named, key=_depth)[:most]


def read_packages(
    tree: Tree,
    urdf: str,
    name: str = "",
    names: Strings = (),
    memory: Memory | None = None,
    installed: frozenset[str] = frozenset(),
    most: int = _MAX_PACKAGES,
    *,
    releases: Releases = (),
    are_whole: bool = False,
) -> Packages:
    """Return the packages in a file tree, the one that matches best first.

    Among packages of one name it is one that is no backup, then the one with most of the files that
    are wanted, above all the URDF at its path; then the least deep, then the first in
    alphabetical order.

    Args:
        tree: The files.
        urdf: The path of the URDF in the package.
        name: The name that the package should have.
        names: The names of all packages, if there are several.
        memory: The launch files that were read for the same names.
        installed: The packages that are on the machines besides those of ROS 2.
        most: How many are read.
        releases: The releases of ROS 2 for which they are graded; none: any.
        are_whole: Whether packages also have the files of those in them, as builds copy them.
    """
    known: _Packages = {}
    cache = memory or Memory()
    wanted = names or (name,)
    folders = find_packages(tree, wanted, most)
    sizes = (file.size for file in tree.files.values() if file.name.endswith(_TEXTS))
    work = whole_budget(sizes, len(folders))
    packages = []
    for folder in folders:
        files = tree.below(folder)
        inner = _inner_folders(files, folder, folders)
        if inner and not are_whole:
            files = files.only(partial(_is_outside, inner))
        package = Package(
            folder,
            files,
            _read_manifest(files, f"{folder}/{MANIFEST}" if folder else MANIFEST),
            known,
            generated=tree.generated,
            wanted_name=name,
            wanted_packages=names,
            installed_besides=installed,
            ignored_by=_find_marker(tree, folder),
            inner=inner,
            memory=cache,
            releases=releases,
            work=work,
        )
        packages.append(package)
    copies = _copies([package for package in packages if not package.ignored_by])
    packages = [replace(one, copies=copies.get(one.folder, ())) for one in packages]
    packages.sort(
        key=lambda candidate: (
            min(_name_distance(candidate, one) for one in wanted),
            is_backup(candidate.folder),
            missing_files(candidate, urdf),
            _depth(candidate.folder),
        )
    )
    for package in packages:
        known.setdefault(package.name, package)
    return tuple(packages)


def _copies(packages: Sequence[Package]) -> dict[str, Strings]:
    """Return the folders of packages with one name that colcon finds below one folder src.

    It refuses to build any of them. It does not search in the folders of packages, and what is
    beside a folder src is another workspace.
    """
    by_place: dict[tuple[str, str], list[str]] = {}
    folders = [package.folder for package in packages]
    for package in packages:
        above, src, _ = f"/{package.folder}".partition("/src/")
        is_inner = any(package.folder.startswith(f"{other}/") for other in folders if other)
        if src and not is_inner and package.manifest:
            by_place.setdefault((above, package.name), []).append(package.folder)
    copies = dict[str, Strings]()
    for alike in by_place.values():
        if len(alike) > 1:
            ordered = sorted(alike, key=lambda folder: (is_backup(folder), _depth(folder)))
            copies |= dict.fromkeys(alike, tuple(reversed(ordered)))
    return copies


def package_around(packages: Packages, path: str | None) -> Package | None:
    """Return the innermost package that holds a file."""
    around = [package for package in packages if path is not None and package.holds(path)]
    return max(around, key=lambda package: len(package.folder), default=None)


def _depth(folder: str) -> tuple[int, str]:
    return folder.count("/") + bool(folder), folder


def missing_files(package: Package, urdf: str) -> tuple[int, bool]:
    """Return how many of its usual files a package lacks.

    Also return whether it lacks the URDF at its path.
    """
    files = package.tree.files
    has_urdf = urdf in files and files[urdf].size > 0
    usual = (has_urdf, MANIFEST in files, SETUP in files, package.launch_files, package.rviz_files)
    return sum(not present for present in usual), not has_urdf


def best_named(packages: Packages, name: str) -> Package | None:
    """Return the package that has this name, or is in a folder of this name.

    Returns any package if the name is empty.
    """
    if packages and (not name or _name_distance(packages[0], name) <= _IN_NAMED_FOLDER):
        return packages[0]
    return None


def packages_named(packages: Sequence[Package], names: Sequence[str]) -> _Packages:
    """Return the package that each name means.

    This is that of the name, else in a folder of it, else of a similar name.
    """
    chosen: _Packages = {}
    for distance, name in product((_NAMED, _IN_NAMED_FOLDER, _SIMILAR), names):
        if name in chosen:
            continue
        for package in packages:
            is_spare = package not in chosen.values()
            if is_spare and _name_distance(package, name) <= distance:
                chosen[name] = package
                break
    return chosen


def _name_distance(package: Package, name: str) -> int:
    """Return how well a package has a name; the smallest is best."""
    if package.manifest and package.manifest.name == name:
        return _NAMED
    package_name = package.manifest.name if package.manifest else package.name
    if basename(package.folder) == name or (
        package_name is not None and folded(package_name) == folded(name)
    ):
        return _IN_NAMED_FOLDER
    if package.manifest and closest(package.name, [name]):
        return _SIMILAR
    return _OTHER


def _is_outside(folders: Strings, path: str) -> bool:
    return not path.startswith(folders)


def renewed_packages(packages: Sequence[Package], work: Budget) -> dict[Package, Package]:
    """Return the packages of a workspace with another budget, as if nothing of them were read."""
    table: _Packages = {}
    renewed = {one.folder: replace(one, packages=table, work=work) for one in packages}
    for name, package in packages[0].packages.items():
        table[name] = renewed[package.folder]
    return dict(zip(packages, renewed.values(), strict=True))


def _inner_folders(files: Tree, folder: str, folders: Sequence[str]) -> Strings:
    """Return the folders of packages in a package. A stray package.xml makes none."""
    prefix = f"{folder}/" if folder else ""
    inner = []
    for other in folders:
        path = other.removeprefix(prefix)
        is_inside = other.startswith(prefix) and other != folder
        if is_inside and (f"{path}/{SETUP}" in files.files or f"{path}/{CMAKE}" in files.files):
            inner.append(f"{path}/")
    return tuple(inner)


def _read_manifest(files: Tree, path: str) -> Manifest | None:
    """Return the package.xml among the files of a package, by its path in the workspace."""
    if MANIFEST not in files.files:
        return None
    try:
        return read_manifest(files.files[MANIFEST].read(_MAX_MANIFEST_SIZE), path)
    except InputError as error:
        start = Location(path, 1, 1)
        return Manifest(Source(path, ""), None, "", (), start, start, unread=str(error))


def _find_marker(tree: Tree, folder: str) -> str:
    """Return the path of the nearest file for which colcon ignores a folder; empty without one."""
    while True:
        for marker in IGNORING:
            path = f"{folder}/{marker}" if folder else marker
            if path in tree.files:
                return path
        if not folder:
            return ""
        folder = folder.rpartition("/")[0]


def launched_paths(tree: Tree, packages: Packages, robots: Sequence[RobotFile]) -> set[str]:
    """Return the paths of the robots that launch files load, also without a package."""
    loose = [robot.path for robot in robots if not package_around(packages, robot.path)]
    launched = set()
    for package in (*packages, *launch_folders(tree, packages, loose)):
        for reference in {named.path or "" for named in package.robot_references()}:
            launched |= _paths_of_reference(reference, package, robots)
    return launched


def _paths_of_reference(reference: str, package: Package, robots: Sequence[RobotFile]) -> set[str]:
    """Return the paths of the robots that a launch file of a package may mean."""
    owner_name = reference.removeprefix(f"{SHARE}/").partition("/")[0]
    owner = package
    if owner_name not in package.names:
        owner = package.find(owner_name) or package
    source = owner.find_source(reference)
    if source:
        return {owner.path(source)}
    # Where the build is not understood, the name of the file has to do.
    file_name = basename(reference)
    alike = [robot.path for robot in robots if robot.name == file_name]
    return {path for path in alike if owner.holds(path)}
