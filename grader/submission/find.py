"""Which URDF and which package of a submission are the ones that were meant."""

import re
from typing import NamedTuple

from grader.errors import InputError
from grader.files.tree import File, Tree
from grader.names import closest
from grader.package.manifest import Manifest, read_manifest
from grader.package.package import MANIFEST, SETUP, Package
from grader.source import Location, Source
from grader.submission.urdf import OtherCandidate

_SNIFFED = 4096  # bytes in which <robot has to stand
_MOST_SNIFFED = 400
_MOST_PACKAGES = 40
_MANIFEST_LIMIT = 256 * 1024
_TEXTS = frozenset({"", ".urdf", ".xacro", ".xml", ".txt", ".sdf"})
_ROBOT = re.compile(rb"<\s*robot[\s>/]")


class Found(NamedTuple):
    """The file that is graded, if there is one, and those that might have been."""

    path: str | None
    other_candidates: tuple[OtherCandidate, ...]


class _Candidate(NamedTuple):
    """How good a file is, best first: the tuple sorts."""

    of_another: bool  # in a package of the same name that is not graded: that of another member of a team
    tier: int
    outside: bool
    depth: int
    path: str


_TIERS = (
    "",
    "it has the right name, but does not stand at {wanted}",
    "its name only begins as that of {wanted} does",
    "it has another name than {wanted}",
    "it is not named as a URDF",
    "it is empty",
)


def find_urdf(tree: Tree, wanted: str, package: str | None = None) -> Found:
    """The URDF that is graded.

    `wanted` is the path that the rubric gives, such as urdf/my_robot.urdf. A file at the end of whose path it stands comes first,
    then one with its name, then one whose name begins alike, then any .urdf, then any text with <robot in it. Among equals
    come those in `package` (a folder), then the nearest to the top, then the first in the alphabet. What stands in another
    package of that name, such as a team mate's, comes behind all that.
    """
    ranked = sorted(_candidates(tree, wanted, package))
    if not ranked:
        return Found(None, _generated(tree))
    best, *others = ranked
    other_candidates = [OtherCandidate(each.path, _reason(best, each, wanted)) for each in others]
    return Found(best.path, (*other_candidates, *_generated(tree)))


def find_packages(tree: Tree, wanted: str) -> list[str]:
    """The folders of packages: those with a package.xml, and those of the wanted name that hold at least a setup.py."""
    with_manifest = [path.rpartition("/")[0] for path in tree.files if path.rpartition("/")[2] == "package.xml"]
    with_setup = [path.rpartition("/")[0] for path in tree.files if path.rpartition("/")[2] == "setup.py"]
    named = [folder for folder in with_setup if folder not in with_manifest and folder.rpartition("/")[2] == wanted]
    if not with_manifest and not named:
        named = with_setup
    folders = sorted([*with_manifest, *named], key=lambda folder: (folder.count("/") + bool(folder), folder))
    return folders[:_MOST_PACKAGES]


def _candidates(tree: Tree, wanted: str, package: str | None) -> list[_Candidate]:
    parts = [part for part in wanted.split("/") if part not in ("", ".")]
    stem = parts[-1].split(".")[0].lower()
    found: list[_Candidate] = []
    sniffed = 0
    others = _others(tree, package)
    for path, file in tree.files.items():
        outside = package is not None and not path.startswith(package + "/" if package else "")
        steps = path.split("/")
        is_named = steps[-1].lower().endswith(".urdf") or steps[-1] == parts[-1]
        if not is_named:
            if file.suffix not in _TEXTS or sniffed >= _MOST_SNIFFED or not file.size or steps[-1] in _NO_ROBOTS:
                continue
            sniffed += 1
            if not _is_robot(file):
                continue
        if is_named and not file.size:
            tier = 5
        elif steps[-len(parts) :] == parts:
            tier = 0
        elif steps[-1] == parts[-1]:
            tier = 1
        elif steps[-1].lower().startswith(stem):
            tier = 2
        else:
            tier = 3 if is_named else 4
        found.append(_Candidate(path.startswith(others), tier, outside, len(steps), path))
    return found


def _others(tree: Tree, package: str | None) -> tuple[str, ...]:
    """Where the packages begin that are named as the one that is graded."""
    name = (package or "").rpartition("/")[2]
    folders = [path.rpartition("/")[0] for path in tree.files if path.rpartition("/")[2] == "package.xml"]
    return tuple(f"{each}/" for each in folders if name and each != package and each.rpartition("/")[2] == name)


_OUTSIDE = "it stands outside of the package that is graded"
_NO_ROBOTS = frozenset({"package.xml", "CMakeLists.txt", "requirements.txt", "COLCON_IGNORE", "LICENSE"})


def _is_robot(file: File) -> bool:
    try:
        return _ROBOT.search(file.read(_SNIFFED, first=True)) is not None
    except InputError:
        return False


def _reason(best: _Candidate, other: _Candidate, wanted: str) -> str:
    if other.of_another and not best.of_another:
        return _OUTSIDE
    if other.tier != best.tier:
        return _TIERS[other.tier].format(wanted=wanted)
    if other.outside != best.outside:
        return _OUTSIDE
    if other.depth != best.depth:
        return "it is equally good, but stands deeper in the folders"
    return "it is equally good, but comes later in the alphabet"


def _generated(tree: Tree) -> tuple[OtherCandidate, ...]:
    return tuple(OtherCandidate(path, "a build made it: only the source is graded") for path in tree.generated[:20])


def read_packages(tree: Tree, wanted: str, urdf: str = "") -> tuple[Package, ...]:
    """The packages of a submission, the one that was meant first: that of the wanted name.

    Among packages of one name it is the one that holds most of what a lab asks for, the URDF at its path before all; then the
    nearest to the top, then the first in the alphabet.
    """
    known: dict[str, Package] = {}
    found = [_read_package(tree, folder, known) for folder in find_packages(tree, wanted)]
    found.sort(
        key=lambda package: (
            _distance(package, wanted),
            _lacks(package, urdf),
            package.folder.count("/") + bool(package.folder),
            package.folder,
        )
    )
    for package in found:
        known.setdefault(package.name, package)
    return tuple(found)


def _lacks(package: Package, urdf: str) -> tuple[int, bool]:
    """How many of its usual files a package lacks, and whether it lacks the wanted URDF."""
    files = package.tree.files
    is_there = urdf in files and files[urdf].size > 0
    usual = (is_there, MANIFEST in files, SETUP in files, package.launch_files, package.rviz_files)
    return sum(not each for each in usual), not is_there


def why_not(graded: Package, other: Package, urdf: str) -> str:
    """Why another package than this one is graded."""
    if other.name != graded.name:
        return f"the package {graded.name!r} is graded, not {other.name!r}"
    if _lacks(other, urdf) != _lacks(graded, urdf):
        return "the package that is graded holds more of what the lab asks for"
    if other.folder.count("/") != graded.folder.count("/"):
        return "it is equally good, but stands deeper in the folders"
    return "it is equally good, but comes later in the alphabet"


def _distance(package: Package, wanted: str) -> int:
    if package.manifest is not None and package.manifest.name == wanted:
        return 0
    if package.folder.rpartition("/")[2] == wanted:
        return 1
    return 2 if package.manifest is not None and closest(package.name, [wanted]) else 3


def _read_package(tree: Tree, folder: str, known: dict[str, Package]) -> Package:
    own = tree.below(folder)
    file = own.files.get(MANIFEST)
    path = f"{folder}/{MANIFEST}" if folder else MANIFEST
    if file is None:
        return Package(folder, own, None, known)
    try:
        manifest = read_manifest(file.read(_MANIFEST_LIMIT), path)
    except InputError as error:
        start = Location(path, 1, 1)
        manifest = Manifest(Source(path, ""), None, "", (), start, start, unread=str(error))
    return Package(folder, own, manifest, known)
