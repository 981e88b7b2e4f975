"""The search for the package that is graded, and the reasons against the others."""

from grader.errors import InputError
from grader.files.tree import Tree
from grader.names import closest
from grader.package.manifest import Manifest, read_manifest
from grader.package.package import MANIFEST, SETUP, Package
from grader.source import Location, Source
from grader.submission.urdf_search import DEEPER, LATER

_MAX_PACKAGES = 40
_MAX_MANIFEST_SIZE = 256 * 1024  # bytes


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
    file = own.files.get(MANIFEST)
    if file is None:
        return Package(folder, own, None, known)
    path = f"{folder}/{MANIFEST}" if folder else MANIFEST
    try:
        manifest = read_manifest(file.read(_MAX_MANIFEST_SIZE), path)
    except InputError as error:
        start = Location(path, 1, 1)
        manifest = Manifest(Source(path, ""), None, "", (), start, start, unread=str(error))
    return Package(folder, own, manifest, known)
