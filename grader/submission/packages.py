"""The graded package of a submission, and the reasons against the others and against files kept of
earlier work.
"""

import posixpath
import re
from collections.abc import Sequence
from itertools import product
from pathlib import PurePosixPath

from grader.errors import InputError
from grader.files.tree import Tree
from grader.names import closest, folded
from grader.package.manifest import Manifest, read_manifest
from grader.package.package import CMAKE, MANIFEST, NO_PACKAGE, SETUP, Package
from grader.source import Location, Source
from grader.submission.submission import Lab
from grader.text import enumerated, quoted

# The files that hide a folder, with all that is below, from colcon.
_IGNORING = ("COLCON_IGNORE", "AMENT_IGNORE", "CATKIN_IGNORE")
_MAX_PACKAGES = 40
_MAX_NAMED = 5  # packages in a message
_MAX_MANIFEST_SIZE = 256 * 1024  # bytes
_NAMED, _IN_NAMED_FOLDER, _SIMILAR, _OTHER = range(4)
DEEPER = "it matches equally well, but is deeper in the folders"
LATER = "it matches equally well, but comes later in alphabetical order"
BACKUP = "it is named like a backup"
_CAMEL = re.compile(r"(?<=[^\W\d_A-Z])(?=[A-Z])")
_WORD = re.compile(r"[^\W\d_]+")
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
    """Return whether a file or folder is named like a backup: old_ws, my_robot - Copy,
    my_robot.urdf.bak.
    """
    return not _WORDS.isdisjoint(_WORD.findall(_CAMEL.sub(" ", path).casefold()))


def find_packages(tree: Tree, names: Sequence[str]) -> list[str]:
    """Return the folders of packages: those with a package.xml, and those of these names with only
    a setup.py.
    """
    with_manifest, with_setup = (
        [path.rpartition("/")[0] for path in tree.files if path.rpartition("/")[2] == file]
        for file in (MANIFEST, SETUP)
    )
    named = [
        folder
        for folder in with_setup
        if folder not in with_manifest and folder.rpartition("/")[2] in names
    ]
    if not with_manifest and not named:
        named = with_setup
    return sorted([*with_manifest, *named], key=_depth)[:_MAX_PACKAGES]


def read_packages(tree: Tree, lab: Lab) -> tuple[Package, ...]:
    """Return the packages of a submission, the one that matches best first: that of the name that
    the lab gives.

    Among packages of one name it is one that is no backup, then the one with most of the files that
    a lab asks for, above all the URDF at its path; then the least deep, then the first in
    alphabetical order.
    """
    known: dict[str, Package] = {}
    folders = find_packages(tree, lab.package_names)
    packages = [_read_package(tree, folder, folders, known, lab) for folder in folders]
    packages.sort(
        key=lambda it: (
            min(_name_distance(it, name) for name in lab.package_names),
            is_backup(it.folder),
            _missing_files(it, lab.urdf),
            _depth(it.folder),
        )
    )
    for package in packages:
        known.setdefault(package.name, package)
    return tuple(packages)


def best_named(packages: tuple[Package, ...], name: str) -> Package | None:
    """Return the package that has this name, or is in a folder of this name; any if the name is
    empty.
    """
    for package in packages[:1]:
        return package if not name or _name_distance(package, name) <= _IN_NAMED_FOLDER else None
    return None


def packages_of_lab(packages: Sequence[Package], names: Sequence[str]) -> dict[str, Package]:
    """Return the package that each name means: that of the name, else in a folder of it, else of a
    similar name.
    """
    found: dict[str, Package] = {}
    for distance, name in product((_NAMED, _IN_NAMED_FOLDER, _SIMILAR), names):
        spare = (
            it
            for it in packages
            if it not in found.values() and _name_distance(it, name) <= distance
        )
        if name not in found and (package := next(spare, None)) is not None:
            found[name] = package
    return found


def package_around(packages: tuple[Package, ...], path: str | None) -> Package | None:
    """Return the innermost package that holds a file."""
    around = [package for package in packages if path is not None and package.holds(path)]
    return max(around, key=lambda package: len(package.folder), default=None)


def why_none(
    packages: tuple[Package, ...], elsewhere: tuple[Package, ...], name: str
) -> tuple[str, str]:
    """Return why none of these packages has this name, nor one `elsewhere`, outside of the lab; and
    which there are.
    """
    names = [
        f"{quoted(package.name)} in {package.folder or 'the submission'}"
        for package in packages or elsewhere
    ]
    there = f"; there {'are' if len(names) > 1 else 'is'} {enumerated(names, _MAX_NAMED)}"
    if packages:
        broken = (
            it.manifest.refusals
            for it in packages
            if it.manifest is not None and it.manifest.refusals
        )
        for problem, *_ in broken:
            there += (
                f"; {problem.message} (line {problem.location.line} of {problem.location.path})"
            )
            break
        return f"no package is named {name!r}, and none contains the graded URDF", there
    return ("no package was submitted for this lab", there) if names else (NO_PACKAGE, "")


def why_not(graded: Package | None, other: Package, urdf: str) -> str:
    """Return why another package than this one is graded, or none."""
    if graded is None:
        return f"the package {other.name!r} has another name, and does not contain the graded URDF"
    if other.name != graded.name:
        return f"the package {graded.name!r} is graded, not {other.name!r}"
    if is_backup(other.folder) and not is_backup(graded.folder):
        return BACKUP
    if _missing_files(other, urdf) != _missing_files(graded, urdf):
        return "the package that is graded has more of the files that the lab asks for"
    return DEEPER if other.folder.count("/") != graded.folder.count("/") else LATER


def _depth(folder: str) -> tuple[int, str]:
    return folder.count("/") + bool(folder), folder


def _missing_files(package: Package, urdf: str) -> tuple[int, bool]:
    """Return how many of its usual files a package lacks, and whether it lacks the URDF at its
    path.
    """
    files = package.tree.files
    has_urdf = urdf in files and files[urdf].size > 0
    usual = (has_urdf, MANIFEST in files, SETUP in files, package.launch_files, package.rviz_files)
    return sum(not present for present in usual), not has_urdf


def _name_distance(package: Package, name: str) -> int:
    if package.manifest is not None and package.manifest.name == name:
        return _NAMED
    own = package.manifest.name if package.manifest is not None else package.name
    if package.folder.rpartition("/")[2] == name or (
        own is not None and folded(own) == folded(name)
    ):
        return _IN_NAMED_FOLDER
    return _SIMILAR if package.manifest is not None and closest(package.name, [name]) else _OTHER


def _read_package(
    tree: Tree, folder: str, folders: Sequence[str], known: dict[str, Package], lab: Lab
) -> Package:
    own = tree.below(folder)
    prefix = f"{folder}/" if folder else ""
    nested = (it.removeprefix(prefix) for it in folders if it.startswith(prefix) and it != folder)
    inner = tuple(
        f"{it}/"
        for it in nested
        if not own.files.keys().isdisjoint((f"{it}/{SETUP}", f"{it}/{CMAKE}"))
    )
    if inner:  # what is in a package in this one is that package's; a stray package.xml makes none
        own = own.only(lambda path: not path.startswith(inner))
    path = f"{folder}/{MANIFEST}" if folder else MANIFEST
    start = Location(path, 1, 1)
    manifest = None
    try:
        if MANIFEST in own.files:
            manifest = read_manifest(own.files[MANIFEST].read(_MAX_MANIFEST_SIZE), path)
    except InputError as error:
        manifest = Manifest(Source(path, ""), None, "", (), start, start, unread=str(error))
    above = [folder, *map(str, PurePosixPath(folder).parents)] if folder else [""]
    markers = (
        posixpath.normpath(f"{path}/{name}").lstrip("/") for path in above for name in _IGNORING
    )
    ignored_by = next((path for path in markers if path in tree.files), "")
    return Package(
        folder, own, manifest, known, tree.generated, lab.package, lab.packages, ignored_by
    )
