"""The search for the URDF and the package that are graded, and the reasons against the other candidates."""

import re
from typing import NamedTuple

from grader.errors import InputError
from grader.files.tree import File, Tree
from grader.names import closest
from grader.package.manifest import Manifest, read_manifest
from grader.package.package import MANIFEST, SETUP, Package
from grader.source import Location, Source
from grader.submission.urdf import OtherCandidate

_SNIFFED_SIZE = 4096  # bytes in which <robot has to be
_MAX_SNIFFED = 400  # files
_MAX_GENERATED = 20
_MAX_PACKAGES = 40
_MAX_MANIFEST_SIZE = 256 * 1024  # bytes
_TEXT_SUFFIXES = frozenset({"", ".urdf", ".xacro", ".xml", ".txt", ".sdf"})
_NEVER_URDF = frozenset({"package.xml", "CMakeLists.txt", "requirements.txt", "COLCON_IGNORE", "LICENSE"})
_ROBOT = re.compile(rb"<\s*robot[\s>/]")
_EXACT, _SAME_NAME, _SAME_START, _OTHER_NAME, _NOT_NAMED, _EMPTY = range(6)
_TIERS = {
    _SAME_NAME: "it has the expected name, but is not at {wanted}",
    _SAME_START: "its name only starts like that of {wanted}",
    _OTHER_NAME: "its name differs from that of {wanted}",
    _NOT_NAMED: "it is not named like a URDF",
    _EMPTY: "it is empty",
}
_OUTSIDE = "it is outside the package that is graded"
_GENERATED = "a build generated it: only source files are graded"
DEEPER = "it matches equally well, but is deeper in the folders"
LATER = "it matches equally well, but comes later in alphabetical order"


class UrdfChoice(NamedTuple):
    """The path of the URDF that is graded, if there is one, and the other candidates."""

    path: str | None
    others: tuple[OtherCandidate, ...]


class _Candidate(NamedTuple):
    """A file that may be the URDF; the best match sorts first."""

    in_other_package: bool  # in another package with the name of the graded one: that of a team mate
    tier: int
    outside: bool
    depth: int
    path: str


def find_urdf(tree: Tree, wanted: str, package: str | None = None) -> UrdfChoice:
    """Return the URDF that is graded.

    `wanted` is the path that the rubric gives, such as urdf/my_robot.urdf. A file whose path ends in it comes first, then one
    with its name, then one whose name starts alike, then any .urdf, then any text with <robot in it. Among equals come those in
    `package` (a folder), then the least deep, then alphabetical order. Files of another package with that package's name,
    such as a team mate's, come last.
    """
    generated = tuple(OtherCandidate(path, _GENERATED) for path in tree.generated[:_MAX_GENERATED])
    ranked = sorted(_candidates(tree, wanted, package))
    if not ranked:
        return UrdfChoice(None, generated)
    best, *others = ranked
    found = [OtherCandidate(other.path, _reason(best, other, wanted)) for other in others]
    return UrdfChoice(best.path, (*found, *generated))


def _candidates(tree: Tree, wanted: str, package: str | None) -> list[_Candidate]:
    parts = [part for part in wanted.split("/") if part not in ("", ".")]
    stem = parts[-1].split(".")[0].lower()
    found: list[_Candidate] = []
    sniffed = 0
    others = _same_named_packages(tree, package)
    for path, file in tree.files.items():
        steps = path.split("/")
        name = steps[-1]
        is_named = name.lower().endswith(".urdf") or name == parts[-1]
        if not is_named:
            if file.suffix not in _TEXT_SUFFIXES or sniffed >= _MAX_SNIFFED or not file.size or name in _NEVER_URDF:
                continue
            sniffed += 1
            if not _has_robot(file):
                continue
        if is_named and not file.size:
            tier = _EMPTY
        elif steps[-len(parts) :] == parts:
            tier = _EXACT
        elif name == parts[-1]:
            tier = _SAME_NAME
        elif name.lower().startswith(stem):
            tier = _SAME_START
        else:
            tier = _OTHER_NAME if is_named else _NOT_NAMED
        outside = package is not None and not path.startswith(package + "/" if package else "")
        found.append(_Candidate(path.startswith(others), tier, outside, len(steps), path))
    return found


def _same_named_packages(tree: Tree, package: str | None) -> tuple[str, ...]:
    """Return how paths in the other packages start that have the name of the graded one."""
    name = (package or "").rpartition("/")[2]
    folders = [path.rpartition("/")[0] for path in tree.files if path.rpartition("/")[2] == "package.xml"]
    return tuple(f"{folder}/" for folder in folders if name and folder != package and folder.rpartition("/")[2] == name)


def _has_robot(file: File) -> bool:
    try:
        return _ROBOT.search(file.read(_SNIFFED_SIZE, first=True)) is not None
    except InputError:
        return False


def _reason(best: _Candidate, other: _Candidate, wanted: str) -> str:
    if other.in_other_package and not best.in_other_package:
        return _OUTSIDE
    if other.tier != best.tier:
        return _TIERS[other.tier].format(wanted=wanted)
    if other.outside != best.outside:
        return _OUTSIDE
    return DEEPER if other.depth != best.depth else LATER


def find_packages(tree: Tree, wanted: str) -> list[str]:
    """Return the folders of packages: those with a package.xml, and those of the wanted name with at least a setup.py."""
    with_manifest, with_setup = (
        [path.rpartition("/")[0] for path in tree.files if path.rpartition("/")[2] == name]
        for name in (MANIFEST, SETUP)
    )
    named = [folder for folder in with_setup if folder not in with_manifest and folder.rpartition("/")[2] == wanted]
    if not with_manifest and not named:
        named = with_setup
    return sorted([*with_manifest, *named], key=_depth)[:_MAX_PACKAGES]


def read_packages(tree: Tree, wanted: str, urdf: str = "") -> tuple[Package, ...]:
    """Return the packages of a submission, the one to grade first: that of the wanted name.

    Among packages of one name it is the one with most of the files that a lab asks for, above all the URDF at its path; then
    the least deep, then the first in alphabetical order.
    """
    known: dict[str, Package] = {}
    found = [_read_package(tree, folder, known) for folder in find_packages(tree, wanted)]
    found.sort(key=lambda package: (_distance(package, wanted), _missing(package, urdf), _depth(package.folder)))
    for package in found:
        known.setdefault(package.name, package)
    return tuple(found)


def why_not(graded: Package, other: Package, urdf: str) -> str:
    """Return why another package than this one is graded."""
    if other.name != graded.name:
        return f"the package {graded.name!r} is graded, not {other.name!r}"
    if _missing(other, urdf) != _missing(graded, urdf):
        return "the package that is graded has more of the files that the lab asks for"
    return DEEPER if other.folder.count("/") != graded.folder.count("/") else LATER


def _depth(folder: str) -> tuple[int, str]:
    return folder.count("/") + bool(folder), folder


def _missing(package: Package, urdf: str) -> tuple[int, bool]:
    """Return how many of its usual files a package lacks, and whether it lacks the wanted URDF."""
    files = package.tree.files
    has_urdf = urdf in files and files[urdf].size > 0
    usual = (has_urdf, MANIFEST in files, SETUP in files, package.launch_files, package.rviz_files)
    return sum(not present for present in usual), not has_urdf


def _distance(package: Package, wanted: str) -> int:
    if package.manifest is not None and package.manifest.name == wanted:
        return 0
    if package.folder.rpartition("/")[2] == wanted:
        return 1
    return 2 if package.manifest is not None and closest(package.name, [wanted]) else 3


def _read_package(tree: Tree, folder: str, known: dict[str, Package]) -> Package:
    own = tree.below(folder)
    path = f"{folder}/{MANIFEST}" if folder else MANIFEST
    start = Location(path, 1, 1)
    manifest = None
    try:
        if MANIFEST in own.files:
            manifest = read_manifest(own.files[MANIFEST].read(_MAX_MANIFEST_SIZE), path)
    except InputError as error:
        manifest = Manifest(Source(path, ""), None, "", (), start, start, unread=str(error))
    return Package(folder, own, manifest, known)
