"""A submission: its files, and which URDF and which package of it are graded."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING

from grader.errors import InputError, MissingElement, NotDecided
from grader.files.opening import open_tree, tree_name
from grader.files.reading import URDF_LIMIT, read_capped, read_standard_input, read_start, sha256_of
from grader.files.tree import File, Tree, make_tree
from grader.package.package import NO_PACKAGE, Package
from grader.robot.reader import Reading, Verdict
from grader.source import Source
from grader.submission.urdf import Absent, OtherCandidate, Read, Unreadable, Urdf, read_as_ros
from grader.text import printable_path, was_not_committed

if TYPE_CHECKING:
    from grader.documents.collection import DocumentCollection
    from grader.documents.evidence import Proof

STANDARD_INPUT = "-"
_NO_ARGUMENTS: Mapping[str, str] = {}
# Other files of a lab, which are never meant as a URDF.
_NO_URDFS = frozenset(
    {".py", ".md", ".rviz", ".yaml", ".yml", ".toml", ".cfg", ".json", ".png", ".jpg", ".jpeg", ".gif", ".pdf", ".docx"}
)
_NO_FILES = make_tree("", (), ())
_WANTED = "give a .urdf file, or the folder or archive that was submitted"


@dataclass(frozen=True)
class Submission:
    """The work that a student submitted. `package` is the one that is graded; `no_package` says why none is, and which there are.

    `tree` has the files of the lab, and `everything` those around it as well. `students` are the folders of several students whose
    work it holds, and `notes` say how it was read.
    """

    id: str
    urdf: Urdf
    other_candidates: tuple[OtherCandidate, ...] = ()
    tree: Tree = field(default=_NO_FILES, repr=False)
    packages: tuple[Package, ...] = field(default=(), repr=False)
    package: Package | None = field(default=None, repr=False)
    no_package: tuple[str, str] = (NO_PACKAGE, "")
    everything: Tree = field(default=_NO_FILES, repr=False)
    students: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    is_single: bool = True  # whether it is a URDF on its own, not a folder or archive
    no_documents: str = ""  # why no document is read, where grading ran out of memory with them

    @cached_property
    def documents(self) -> "DocumentCollection":
        """The documents in it, each of which is read once."""
        from grader.documents.collection import DocumentCollection  # a URDF on its own has none

        return DocumentCollection(self.tree)

    @property
    def readable_documents(self) -> "DocumentCollection | None":
        """The documents in it; None where they must not be read."""
        return None if self.no_documents else self.documents

    @cached_property
    def proofs(self) -> "tuple[Proof, ...]":
        """The pictures, films and PDF files in it."""
        from grader.documents.evidence import read_proofs

        return read_proofs(self.tree)

    @property
    def evidence(self) -> tuple[File, ...]:
        """The files that may show the work: pictures, films, PDF and Word files."""
        named = {proof.file.path for proof in self.proofs}
        return tuple(file for path, file in self.tree.files.items() if path in named or file.suffix == ".docx")

    @property
    def has_evidence_only(self) -> bool:
        """Return whether it has evidence, but no URDF."""
        return isinstance(self.urdf, Absent) and bool(self.evidence)

    @property
    def path(self) -> str | None:
        """The path of the URDF, relative to the submission."""
        return None if isinstance(self.urdf, Absent) else self.urdf.path

    @property
    def sha256(self) -> str | None:
        """The hash of the URDF's bytes."""
        return sha256_of(self.urdf.data) if isinstance(self.urdf, Read) else None

    @property
    def has_urdf(self) -> bool:
        """Return whether there is a URDF that could be read, even if ROS 2 rejects it."""
        return isinstance(self.urdf, Read)

    @property
    def unread(self) -> str:
        """The reason why the URDF could not be read; empty if it was, or if there is none."""
        return self.urdf.reason if isinstance(self.urdf, Unreadable) else ""

    @property
    def verdict(self) -> Verdict | None:
        """ROS 2's verdict on the URDF; None if it was not read, or cannot be determined."""
        return self.urdf.loaded.verdict if isinstance(self.urdf, Read) and self.urdf.loaded.is_decided else None

    @property
    def ignored(self) -> tuple[str, ...]:
        """The files that are not read, and why, in one line each."""
        return tuple(map(str, self.tree.ignored))

    def needed_package(self) -> Package:
        """Return the package that is graded; raises MissingElement without one, NotDecided if one may be in an unopened archive."""
        if self.package is not None:
            return self.package
        self._refuse_unopened("package")
        message, detail = self.no_package
        raise MissingElement("package", "", message=message, detail=detail)

    def needed_urdf(self) -> Reading:
        """Return the URDF that is graded; raises MissingElement without one, NotDecided if it cannot be read statically."""
        match self.urdf:
            case Read(reading=reading):
                if reading.robot is None and reading.undetermined:
                    raise NotDecided(reading.undetermined, reading.undetermined)
                return reading
            case Unreadable(reason=reason):
                raise NotDecided(reason, "the URDF cannot be read")
            case Absent():
                self._refuse_unopened("URDF")
        count = len(self.tree.files)
        files = f"none of the {count} files contains a <robot>" if count > 1 else "the only file contains no <robot>"
        built = next((path for path in self.tree.generated if path.lower().endswith((".urdf", ".xacro"))), "")
        detail = f"{f': {files}' if count else ''}{was_not_committed(built) if built else ''}"
        raise MissingElement("URDF", "", message="no URDF was submitted", detail=detail)

    def _refuse_unopened(self, wanted: str) -> None:
        if self.tree.unopened:
            archives = ", ".join(archive.path for archive in self.tree.unopened[:3])
            raise NotDecided(
                f"no {wanted} was found, but {archives} could not be opened", "an archive could not be opened"
            )

    def source(self, path: str) -> Source | None:
        """Return the text of one of its files, for quoting; None if it cannot be read."""
        if isinstance(self.urdf, Read) and path == self.urdf.path:
            return self.urdf.source
        file = self.everything.files.get(path)
        try:
            return Source(path, file.read(URDF_LIMIT).decode("utf-8", "replace")) if file is not None else None
        except InputError:
            return None


def read_submission(
    data: bytes, *, identity: str, path: str, arguments: Mapping[str, str] = _NO_ARGUMENTS
) -> Submission:
    """Return the submission that consists of the bytes of one URDF; `arguments` are those of xacro."""
    if not arguments:
        return Submission(identity, read_as_ros(data, path))
    from grader.submission.workspace import Surroundings  # late: most URDFs are no xacro

    return Submission(identity, read_as_ros(data, path, Surroundings(arguments=arguments)))


def open_submission(
    path: str,
    *,
    wanted: str,
    package: str = "",
    folders: Sequence[str] = (),
    limit: int = URDF_LIMIT,
    arguments: Mapping[str, str] = _NO_ARGUMENTS,
) -> Submission:
    """Read the submission at a path: a URDF, a folder, an archive, or standard input for `-`.

    `wanted` is the URDF's path in its package, `package` the package's name and `folders` the names of the lab's folder, as the
    rubric gives them. `limit` is the largest size of a URDF in bytes, `arguments` are those of xacro. Raises InputError, with one
    sentence, if the path cannot be read.
    """
    if path == STANDARD_INPUT:
        return read_submission(read_standard_input(limit), identity="stdin", path="-", arguments=arguments)
    if not path:
        raise InputError(f"the path is empty: {_WANTED}")
    place = Path(path)
    tree = open_tree(place, partial(_is_lab, folders))
    shown = printable_path(place)
    if tree is not None:
        return submission_of(
            tree,
            tree_name(place),
            wanted=wanted,
            package=package,
            folders=folders,
            limit=limit,
            shown=shown,
            arguments=arguments,
        )
    if place.suffix.lower() in _NO_URDFS:
        from grader.submission.robots import START, is_robot  # late: most URDFs are called .urdf

        if not is_robot(read_start(place, START)):
            raise InputError(f"{shown} is not a URDF: {_WANTED}")
    data = read_capped(place, limit)
    identity = printable_path(place.stem)
    return read_submission(data, identity=identity, path=printable_path(place.name), arguments=arguments)


def _is_lab(folders: Sequence[str], name: str) -> bool:
    """Return whether an archive is named like the lab's folder."""
    from grader.submission.labs import LabFolders  # late: a URDF on its own needs no search

    return LabFolders(folders).is_lab(name)


def submission_of(
    tree: Tree,
    identity: str,
    *,
    wanted: str,
    package: str = "",
    folders: Sequence[str] = (),
    limit: int = URDF_LIMIT,
    shown: str = "",
    no_documents: str = "",
    arguments: Mapping[str, str] = _NO_ARGUMENTS,
) -> Submission:
    """Return the submission that a file tree makes; raises InputError, which calls it `shown`, if there are no files."""
    if not tree.files and not tree.generated:
        reason = f": {tree.ignored[0]}" if tree.ignored else " (hidden files and build folders are ignored)"
        raise InputError(f"{shown or identity} is empty{reason}")
    # Late: a URDF on its own needs no search.
    from grader.submission.selection import select
    from grader.submission.workspace import Surroundings

    chosen = select(tree, wanted, package, folders, limit)
    urdf: Urdf = Absent()
    if chosen.urdf is not None:
        try:
            around = Surroundings(tree, chosen.package, chosen.packages, arguments)
            urdf = read_as_ros(tree.files[chosen.urdf].read(limit), chosen.urdf, around)
        except InputError as error:  # the rest of the submission is graded
            urdf = Unreadable(chosen.urdf, str(error))
    return Submission(
        identity,
        urdf,
        chosen.others,
        chosen.tree,
        chosen.packages,
        chosen.package,
        chosen.no_package,
        tree,
        chosen.students,
        chosen.notes,
        is_single=False,
        no_documents=no_documents,
    )
