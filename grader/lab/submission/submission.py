"""A submission: its files, and which URDF and which package of it are graded."""

from collections.abc import Callable, Mapping
from dataclasses import field, replace
from functools import cached_property
from typing import TYPE_CHECKING

from grader.base.errors import MissingElement, NotDecided
from grader.base.grouping import Strings, StringsByName
from grader.base.records import Named
from grader.base.reuse import Memory
from grader.base.text import enumerated, was_not_committed
from grader.files.limits import MAX_FILE_SIZE, ROBOT_ENDINGS
from grader.files.reading import URDF_LIMIT, hash_bytes
from grader.files.tree import File, Tree, make_tree
from grader.ros.known.releases import Release
from grader.ros.package.package import NO_PACKAGE, Package
from grader.ros.package.robot_file import (
    Absent,
    Read,
    Surroundings,
    Unreadable,
    read_as_ros,
)
from grader.ros.python.budget import Budget
from grader.ros.urdf.model import Robot
from grader.ros.urdf.reader import Reading, Verdict
from grader.workspace.opening.opened import OpenedWorkspace

if TYPE_CHECKING:
    from grader.lab.documents.collection import DocumentCollection
    from grader.lab.documents.evidence import LabelledFile
    from grader.ros.package.mesh_loading import MeshLoader

# parts of a package's evaluation that take as long as reading a short URDF
_WORK_OF_READING = 1_500
_FILES_OF_READING = 200
_MAX_COST = 60  # of one reading, for hints
_NO_FILES = make_tree("", (), ())
_Arguments = StringsByName  # of launch files
_NO_ARGUMENTS: _Arguments = {}


class Lab(Named):
    """What a rubric asks for."""

    urdf: str  # its path in the package
    package: str = ""  # the name of the package
    folders: Strings = ()  # names of the lab's folder
    links: frozenset[str] = frozenset()  # the names of the robot's links
    packages: Strings = ()  # the names of all packages, if there are several
    memory: Memory | None = None  # of its submissions, where several are read
    # the packages of other people whose programs the lab asks for: they are on its machines
    installed: frozenset[str] = frozenset()
    distro: Release | None = None  # of ROS 2; None for any

    @property
    def releases(self) -> tuple[Release, ...]:
        """Its release, if it has one."""
        return (self.distro,) if self.distro is not None else ()

    @property
    def package_names(self) -> Strings:
        """The names of its packages."""
        return self.packages or (self.package,)


class Opening(Named):
    """How a submission is opened."""

    max_size: int = URDF_LIMIT  # of a URDF, in bytes
    arguments: _Arguments = _NO_ARGUMENTS  # of xacro
    no_documents: str = ""  # why no document is read, where grading ran out of memory with them
    # the texts of Word and PDF files that were read before, by path
    converted: _Arguments = _NO_ARGUMENTS
    reports: frozenset[str] = (
        frozenset()
    )  # real paths of earlier reports, which are not part of a folder


DEFAULTS = Opening()


class NoPackage(Named):
    """Why there is no package, and which there are.

    Of several packages, it has the name of the one that is missing.
    """

    message: str = NO_PACKAGE
    detail: str = ""
    name: str = ""


_NO_PACKAGE = NoPackage()


class Submission(OpenedWorkspace):
    """The work that a student submitted, with what of it is graded: a URDF, a package, documents.

    `opening.py` makes it of a path or of bytes: `selection.py` says which URDF and package it is,
    and why. Checks read it, hints make others of it with edited files, and a report quotes its
    files. A part that is missing or broken never keeps the rest from being graded: `urdf` is one of
    three states, and `needed_urdf` and `needed_package` raise what a check reports. Documents are
    read when they are needed.

    >>> from grader.lab.submission.opening import read_submission
    >>> robot = b'<robot name="arm"><link name="base"/></robot>'
    >>> submission = read_submission(robot, identity="ash", path="arm.urdf")
    >>> submission.path, submission.verdict, submission.is_single
    ('arm.urdf', 'clean', True)
    >>> submission.needed_package()
    Traceback (most recent call last):
    grader.base.errors.MissingElement: the submission has no ROS 2 package: there is no package.xml
    """

    tree: Tree = _NO_FILES  # the files of the lab
    package: Package | None = None  # the graded one
    no_package: NoPackage = _NO_PACKAGE
    lab_packages: Mapping[str, Package] = field(
        default_factory=dict
    )  # by the names that the lab gives
    several: str = ""  # the note that says that several robots fit
    other_lab: str = ""  # the folder of another lab, where it is graded
    opening: Opening = DEFAULTS
    reopen: "Callable[[Tree], Submission] | None" = None  # opens other files in the same way
    # Those of its documents that were read, by the files that they are among: copies of it have
    # them as well.
    _documents: "dict[Tree, DocumentCollection]" = field(default_factory=dict, repr=False)

    @property
    def documents(self) -> "DocumentCollection":
        """The documents in it, each of which is read once, also for copies of it that lack work."""
        from grader.lab.documents.collection import DocumentCollection  # a URDF on its own has none

        if self.tree not in self._documents:
            self._documents[self.tree] = DocumentCollection(self.tree, self.opening.converted)
        return self._documents[self.tree]

    @property
    def readable_documents(self) -> "DocumentCollection | None":
        """The documents in it; None where they must not be read."""
        return None if self.opening.no_documents else self.documents

    @cached_property
    def labelled_files(self) -> "tuple[LabelledFile, ...]":
        """The pictures, films and PDF files in it."""
        from grader.lab.documents.evidence import read_labelled_files

        return read_labelled_files(self.tree)

    @property
    def evidence_files(self) -> tuple[File, ...]:
        """The files that may show the work: pictures, films, PDF and Word files."""
        named = {labelled.file.path for labelled in self.labelled_files}
        return tuple(
            file
            for path, file in self.tree.files.items()
            if path in named or file.suffix == ".docx"
        )

    @property
    def robot(self) -> Robot | None:
        """The robot that is graded; None if there is none."""
        if isinstance(self.urdf, Read):
            return self.urdf.reading.robot
        return None

    @cached_property
    def meshes(self) -> "MeshLoader | None":
        """What loads the meshes of the robot that is graded, for pictures; None without a robot."""
        if isinstance(self.urdf, Read):
            return self.load_meshes(self.urdf)
        return None

    @cached_property
    def sha256(self) -> str | None:
        """The hash of the URDF's bytes.

        Of a URDF on its own that includes others, it is that of a list of the hashes of all.
        """
        own_hash = hash_bytes(self.urdf.data) if isinstance(self.urdf, Read) else None
        if own_hash is None or not self.besides:
            return own_hash
        hashes = [
            hash_bytes(self.whole_tree.files[path].read(MAX_FILE_SIZE)) for path in self.besides
        ]
        lines = [
            f"{file_hash} {path}\n" for file_hash, path in zip(hashes, self.besides, strict=True)
        ]
        return hash_bytes("".join([f"{own_hash}\n", *lines]).encode())

    @property
    def cost(self) -> int:
        """How much longer reading it takes than reading a short URDF."""
        of_urdf = self.urdf.reading.source.cost if isinstance(self.urdf, Read) else 0
        of_package = self.package.budget.used if self.package else 0
        return (
            of_urdf
            + len(self.whole_tree.files) // _FILES_OF_READING
            + of_package // _WORK_OF_READING
        )

    @property
    def is_costly(self) -> bool:
        """Return whether reading it takes so long that no hints are searched."""
        work = self.package.work.used if self.package else 0
        is_much = work > _MAX_COST * _WORK_OF_READING
        return self.cost > _MAX_COST or is_much or self.budget.used > self.budget.limit // 10

    @property
    def is_over_budget(self) -> bool:
        """Whether reading it takes more work than one submission may use, so not all is decided."""
        return self.budget.is_spent or any(one.budget.is_spent for one in self.packages)

    @property
    def has_urdf(self) -> bool:
        """Return whether there is a URDF that could be read, even if ROS 2 rejects it."""
        return isinstance(self.urdf, Read)

    @property
    def unread(self) -> str:
        """The reason why the URDF could not be read; empty if it was, or if there is none."""
        if isinstance(self.urdf, Unreadable):
            return self.urdf.reason
        return ""

    @property
    def verdict(self) -> Verdict | None:
        """ROS 2's verdict on the URDF; None if it was not read, or cannot be determined."""
        if isinstance(self.urdf, Read) and self.urdf.loaded.is_certain:
            return self.urdf.loaded.verdict
        return None

    @property
    def ignored(self) -> Strings:
        """The files that are not read, and why, in one line each."""
        return tuple(map(str, self.tree.ignored))

    def needed_package(self) -> Package:
        """Return the graded package.

        Raises MissingElement without one, NotDecided if an archive is unopened.
        """
        if self.package:
            return self.package
        self.refuse_unopened("package")
        message, detail, name = self.no_package
        raise MissingElement(
            "package", name, message=message, detail=detail, absent=f"package {name}".rstrip()
        )

    def with_package(self, name: str) -> "Submission":
        """Return the submission with the package that the lab gives this name as the graded one."""
        package = self.lab_packages.get(name)
        if package and package is self.package:
            return self
        if not package and self.packages:
            others = enumerated([repr(other.name) for other in self.packages])
            return replace(
                self,
                package=None,
                no_package=NoPackage(f"no package is named {name!r}", f"; there is {others}", name),
            )
        return replace(self, package=package)

    def needed_urdf(self) -> Reading:
        """Return the graded URDF.

        Raises MissingElement without one, NotDecided if it cannot be read statically.
        """
        match self.urdf:
            case Read(reading=reading):
                if not reading.robot and reading.undetermined:
                    raise NotDecided(reading.undetermined)
                return reading
            case Unreadable(reason=reason):
                raise NotDecided(reason, "the URDF cannot be read")
            case Absent(blank=blank, reason=why):
                self.refuse_unopened("URDF")
        count = len(self.tree.files)
        if count > 1:
            files = f"none of the {count} files contains a <robot>"
        else:
            files = "the only file contains no <robot>"
        built = next(
            (path for path in self.tree.generated if path.lower().endswith(ROBOT_ENDINGS)), ""
        )
        if blank:
            files = blank
        detail = f": {files}" if count or blank else ""
        if built:
            detail += was_not_committed(built)
        raise MissingElement("URDF", "", message=why, detail=detail, absent="URDF")

    def under(self, arguments: _Arguments) -> "Submission":
        """Return the submission under launch arguments.

        They apply to its launch files, and to its robot if it is xacro.
        """
        packages = self.packages + self.neighbours
        changed = self._with_packages({package: package.under(arguments) for package in packages})
        if not isinstance(self.urdf, Read) or not self.urdf.has_xacro:
            return changed
        surroundings = changed.surroundings(changed.budget)._replace(launch_arguments=arguments)
        return replace(changed, urdf=read_as_ros(self.urdf.data, self.urdf.path, surroundings))

    def renewed(self) -> "Submission":
        """Return the submission as if nothing of its packages were read.

        So what is left for one edited copy does not depend on those that were graded before.
        """
        packages = self.packages or self.neighbours
        if not packages:
            return self
        # Late: a URDF on its own needs no search.
        from grader.ros.package.finding import renewed_packages

        return self._with_packages(renewed_packages(packages, Budget(packages[0].work.limit)))

    def _with_packages(self, known: Mapping[Package, Package]) -> "Submission":
        """Return the submission with other packages in place of its own."""
        lab_packages = {}
        for name, package in self.lab_packages.items():
            lab_packages[name] = known.get(package, package)
        return replace(
            self,
            packages=tuple(map(known.__getitem__, self.packages)),
            neighbours=tuple(map(known.__getitem__, self.neighbours)),
            package=known.get(self.package, self.package) if self.package else None,
            lab_packages=lab_packages,
            budget=Budget(),
        )

    def surroundings(self, budget: Budget, tree: Tree | None = None) -> Surroundings:
        """Return the files around its URDF: its own, or other ones."""
        return Surroundings(
            budget,
            tree or self.whole_tree,
            self.package,
            self.packages or self.neighbours,
            self.opening.arguments,
            is_single=self.is_single,
            releases=(self.distro,) if self.distro is not None else (),
        )

    def refuse_unopened(self, missing: str) -> None:
        """Raise NotDecided if an archive that may hold what is missing could not be opened."""
        if self.tree.unopened:
            archives = ", ".join(archive.path for archive in self.tree.unopened[:3])
            raise NotDecided(
                f"no {missing} was found, but {archives} could not be opened",
                "an archive could not be opened",
            )
