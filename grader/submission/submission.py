"""A submission: what was handed in, which URDF and which package of it are graded, and what was passed over."""

from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from grader.errors import InputError, MissingElement, NotDecided
from grader.files.opening import open_tree, tree_name
from grader.files.reading import URDF_LIMIT, read_capped, read_standard_input, sha256_of
from grader.files.tree import PassedOver, Tree, make_tree
from grader.package.package import NO_PACKAGE, Package
from grader.robot.catalogue import RAW_XACRO
from grader.robot.reader import Reading, Verdict, read_urdf
from grader.source import Source
from grader.text import printable_path

if TYPE_CHECKING:
    from grader.documents.collection import DocumentCollection
    from grader.documents.evidence import Proof

Xacro = Literal["none", "expanded", "left"]

STANDARD_INPUT = "-"
# Files that a hand-in is made of; nobody means to have them graded as a URDF.
_NO_URDFS = frozenset(
    {".py", ".md", ".rviz", ".yaml", ".yml", ".toml", ".cfg", ".json", ".png", ".jpg", ".jpeg", ".gif", ".pdf", ".docx"}
)
_NO_FILES = make_tree("", (), ())


@dataclass(frozen=True)
class Submission:
    """What was handed in. `path` is that of the URDF, relative to it; without a URDF `path`, `data` and `urdf` are None.

    `is_single` tells a URDF on its own from a folder or archive. `packages` begins with the one that is graded. `xacro` tells
    whether the URDF is xacro that is expanded before ROS 2 reads it: `urdf` is then what it comes to, if that could be worked
    out, and left to a person if not. `unread` says why the URDF at `path` could not be read, where it is too large or damaged.
    `no_documents` says why no document is read, where grading was lost with them.
    """

    id: str
    path: str | None
    data: bytes | None = field(repr=False)
    urdf: Reading | None
    passed_over: tuple[PassedOver, ...] = ()
    tree: Tree = field(default=_NO_FILES, repr=False)
    packages: tuple[Package, ...] = field(default=(), repr=False)
    is_single: bool = True
    xacro: Xacro = "none"
    unread: str = ""
    no_documents: str = ""

    @cached_property
    def documents(self) -> "DocumentCollection":
        """The documents in it, each of which is read once."""
        from grader.documents.collection import DocumentCollection  # a URDF on its own has none

        return DocumentCollection(self.tree)

    @cached_property
    def proofs(self) -> "tuple[Proof, ...]":
        """The pictures, films and PDF files in it."""
        from grader.documents.evidence import read_proofs

        return read_proofs(self.tree)

    @property
    def sha256(self) -> str | None:
        """The hash of the URDF's bytes."""
        return sha256_of(self.data) if self.data is not None else None

    @property
    def has_urdf(self) -> bool:
        """Whether there is a URDF that could be read, whatever ROS 2 makes of it."""
        return self.urdf is not None

    @property
    def verdict(self) -> Verdict | None:
        """What ROS 2 makes of the URDF; None where there is none, or nobody can tell."""
        return self.urdf.verdict if self.urdf is not None and self.xacro != "left" else None

    @property
    def left_out(self) -> tuple[str, ...]:
        """What was not taken in, and why, in one line each."""
        return self.tree.left_out

    @property
    def package(self) -> Package | None:
        """The package that is graded."""
        return self.packages[0] if self.packages else None

    def needed_package(self) -> Package:
        """The package that is graded; raises MissingElement where there is none, NotDecided where that cannot be told."""
        if self.package is not None:
            return self.package
        if self.unopened:
            raise NotDecided(f"no package was found, but {', '.join(self.unopened[:3])} could not be opened")
        raise MissingElement("package", "", message=NO_PACKAGE)

    def needed_urdf(self) -> Reading:
        """The URDF that is graded; raises MissingElement where there is none, NotDecided where that cannot be told."""
        if self.unread:
            raise NotDecided(self.unread)
        if self.xacro == "left" and self.path is not None:
            name = self.path.rpartition("/")[2]
            raise NotDecided(f"{name} is xacro that is not worked out here (ros2 run xacro xacro {name} does)")
        if self.urdf is not None:
            return self.urdf
        if self.unopened:
            raise NotDecided(f"no URDF was found, but {', '.join(self.unopened[:3])} could not be opened")
        count = len(self.tree.files)
        files = f"none of the {count} files holds a <robot>" if count > 1 else "the only file holds no <robot>"
        message = f"no URDF was submitted: {files}" if count else "no URDF was submitted"
        raise MissingElement("URDF", "", message=message)

    @property
    def unopened(self) -> tuple[str, ...]:
        """The archives in it that could not be opened, though something to grade may be in them."""
        return self.tree.unopened

    def source(self, path: str) -> Source | None:
        """The text of one of its files, for quoting; None where it cannot be read."""
        if self.urdf is not None and path == self.path and self.data is not None:
            written = self.xacro == "expanded"  # what the student wrote is quoted, not what it comes to
            return Source(path, self.data.decode("utf-8", "replace")) if written else self.urdf.source
        file = self.tree.files.get(path)
        try:
            return Source(path, file.read(URDF_LIMIT).decode("utf-8", "replace")) if file is not None else None
        except InputError:
            return None


def read_submission(data: bytes, *, identity: str, path: str) -> Submission:
    """The submission that the bytes of one URDF make."""
    reading, xacro = _read(data, path, None)
    return Submission(identity, path, data, reading, xacro=xacro)


def _read(data: bytes, path: str, package: Package | None) -> tuple[Reading, Xacro]:
    """A URDF as ROS 2 gets to read it: expanded, if it is xacro by its name or the package's launch file has xacro read it."""
    reading = read_urdf(data, path)
    if not any(problem.kind is RAW_XACRO for problem in reading.problems):
        return reading, "none"
    name = path.rpartition("/")[2]
    readers = package.robot_readers(name) if package is not None else set()
    if (readers and readers != {"xacro"}) or (not readers and (".xacro" not in name or name.endswith(".urdf"))):
        return reading, "none"
    from grader.xacro.properties import expand

    expanded = expand(reading.source.text)
    if expanded is None:
        return reading, "left"
    return read_urdf(expanded.encode("utf-8", "surrogateescape"), path), "expanded"


def open_submission(path: str, *, wanted: str, package: str = "", limit: int = URDF_LIMIT) -> Submission:
    """Read what was handed in at a path: a URDF, a folder, an archive, or standard input for `-`.

    `wanted` is where the rubric expects the URDF in its package, `package` the name that it expects this one to have.
    Raises InputError, with one plain sentence, for what cannot be read.
    """
    if path == STANDARD_INPUT:
        return read_submission(read_standard_input(limit), identity="stdin", path="-")
    if not path:
        raise InputError("the path is empty: name a .urdf, or the folder or archive that was handed in")
    place = Path(path)
    tree = open_tree(place)
    if tree is None and place.suffix.lower() in _NO_URDFS:
        raise InputError(
            f"{printable_path(place)} is no URDF: name a .urdf, or the folder or archive that was handed in"
        )
    if tree is None:
        identity = printable_path(place.stem)
        return read_submission(read_capped(place, limit), identity=identity, path=printable_path(place.name))
    shown = printable_path(place)
    return submission_of(tree, tree_name(place), wanted=wanted, package=package, limit=limit, shown=shown)


def submission_of(
    tree: Tree,
    identity: str,
    *,
    wanted: str,
    package: str = "",
    limit: int = URDF_LIMIT,
    shown: str = "",
    no_documents: str = "",
) -> Submission:
    """The submission that a tree of files makes; raises InputError, which calls it `shown`, where there are none."""
    if not tree.files and not tree.generated:
        raise InputError(f"{shown or identity} is empty{_because(tree)}")
    from grader.submission.find import find_urdf, read_packages, why_not

    packages = read_packages(tree, package, wanted)
    found = find_urdf(tree, wanted, packages[0].folder if packages else None)
    others = [PassedOver(each.path("package.xml"), why_not(packages[0], each, wanted)) for each in packages[1:]]
    data, unread = None, ""
    try:
        data = tree.files[found.path].read(limit) if found.path is not None else None
    except InputError as error:  # the rest of the hand-in is graded all the same
        unread = str(error)
    reading: Reading | None = None
    xacro: Xacro = "none"
    if data is not None and found.path is not None:
        reading, xacro = _read(data, found.path, packages[0] if packages else None)
    passed_over = (*found.passed_over, *others)
    return Submission(
        identity,
        found.path,
        data,
        reading,
        passed_over,
        tree,
        packages,
        is_single=False,
        xacro=xacro,
        unread=unread,
        no_documents=no_documents,
    )


def _because(tree: Tree) -> str:
    return f": {tree.left_out[0]}" if tree.left_out else " (hidden files and folders of builds are not looked at)"
