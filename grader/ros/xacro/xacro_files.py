"""The files that a xacro file names: where they are in the workspace, and what is in them."""

import re
from collections.abc import Collection
from itertools import starmap
from posixpath import basename, dirname, join, normpath, split
from typing import Protocol

from grader.base.errors import InputError, NotDecided
from grader.base.merge_conflicts import describe_conflicts, find_conflicts
from grader.base.names import near
from grader.base.patterns import on_use
from grader.base.source import Edits, Source
from grader.ros.python.budget import Budget
from grader.ros.python.values import EvaluationFails, Undetermined
from grader.ros.xacro.scopes import UnknownName, XacroFails
from grader.ros.xacro.texts import INSTALLED
from grader.ros.xacro.xacro_nodes import XacroNode, read_nodes
from grader.ros.xml.parsing import XMLSyntaxError

_SHARED = on_use(
    rf"{INSTALLED}/(?P<package>[^/]+)/share/(?P=package)(?:/+(?P<inside>.+))", re.DOTALL
)
_ADDED = on_use(r".*\.(?:urdf|xacro)(.*)", re.IGNORECASE | re.DOTALL)
_MAX_OPEN = 50  # files that include each other
_MAX_PATH = 1_000  # characters
_OF_FILE, _OF_NAME = (
    50,
    20,
)  # what looking for one, and comparing its name with another one, are charged


class SurroundingFiles(Protocol):
    """The files around a xacro file: those of its workspace."""

    @property
    def budget(self) -> Budget:
        """The budget of the workspace."""

    @property
    def paths(self) -> Collection[str]:
        """The paths of the files."""

    @property
    def is_part(self) -> bool:
        """Whether the files may be a part of any package, because there is none among them."""

    @property
    def called(self) -> str:
        """What messages call the files, such as a workspace."""

    def read(self, path: str) -> bytes:
        """Return the bytes of a file. Raises InputError, NotDecided."""

    def package(self, name: str) -> str | None:
        """Return the folder of a package."""

    def installed(self, package: str, inside: str) -> str | None:
        """Return the file that a build installs at a path in a package. Raises Undetermined."""

    def ask(self, name: str) -> object:
        """Note the name of a file that is looked for."""


class FileFails(XacroFails):
    """A file that is not there."""


class XmlFails(EvaluationFails):
    """A file that is not well-formed XML, with the edits that repair it, and what these assume."""

    def __init__(self, message: str, repair: Edits = (), assumed: str = "") -> None:
        super().__init__(message)
        self.repair = repair
        self.assumed = assumed


class Files:
    """The files that are open while a document is expanded, innermost last."""

    def __init__(self, workspace: SurroundingFiles, path: str) -> None:
        self._workspace = workspace
        self._budget = workspace.budget
        self.open = [path]
        self.documents: dict[str, XacroNode] = {}  # every file that was read, as it is written
        self.broken: dict[str, Source] = {}  # the files that are no XML
        self.followed: dict[
            tuple[str, int], list[str]
        ] = {}  # the tags that include files, and the paths of these

    def require_package(self, name: str) -> None:
        """Raise Undetermined for a package that is not among the files."""
        if not self.has_package(name):
            raise self._absent(name)

    def _absent(self, package: str) -> Undetermined:
        called = self._workspace.called
        return Undetermined(f"the package {package} is not part of the {called}")

    def has_package(self, name: str) -> bool:
        """Return whether a package is, or may be, part of the workspace."""
        return (
            self._workspace.is_part
            or not self._workspace.paths
            or self._workspace.package(name) is not None
        )

    def path(self, text: str) -> str:
        """Return the path in the workspace of a file that the innermost file names.

        Raises Undetermined.
        """
        if len(text) > _MAX_PATH:
            raise Undetermined("the path of a file is too long")
        self._budget.charge(_OF_FILE + len(self._workspace.paths) * (1 + text.count("/")))
        self._workspace.ask(text)
        shared = _SHARED.fullmatch(text)
        if shared:
            path = self._share_path(shared["package"], normpath(shared["inside"]))
        else:
            path = normpath(join(dirname(self.open[-1]), text))
        if text.startswith(f"{INSTALLED}/") and not shared:
            raise FileFails(
                f"there is no file {text.partition('/share/')[2]}: is a slash missing after "
                "$(find ...)?"
            )
        if path.startswith(("/", "../")) or path == "..":
            raise Undetermined(f"{text} is outside the {self._workspace.called}")
        renamed = path + self._extra_ending()
        if path not in self._workspace.paths and renamed in self._workspace.paths:
            return renamed
        return path

    def _extra_ending(self) -> str:
        """Return what an upload without the package added to the innermost file's name.

        An example is .txt of a.xacro.txt.
        """
        added = _ADDED.fullmatch(basename(self.open[-1])) if self._workspace.is_part else None
        return added[1] if added else ""

    def _share_path(self, package: str, inside: str) -> str:
        """Return the path of a file that $(find package) names."""
        folder = self._workspace.package(package)
        source = self._workspace.installed(package, inside)
        if folder is None and source is None:
            raise self._absent(package)
        if source is not None:
            return source
        return normpath(join(folder or "", inside))

    def read(self, path: str) -> bytes:
        """Return the bytes of a file.

        Raises FileFails for one that does not exist, and Undetermined.
        """
        try:
            return self._workspace.read(path)
        except InputError as error:
            raise self._not_found(path, str(error)) from None
        except NotDecided as error:
            raise Undetermined(str(error)) from None

    def nodes(self, path: str) -> XacroNode:
        """Return the root element of an included file."""
        if self.open.count(path) and len(self.open) > _MAX_OPEN:
            raise FileFails(f"{path} includes itself again and again")
        data = self.read(path)
        try:
            self.documents[path] = read_nodes(data, path, self._budget)
        except XMLSyntaxError as error:
            raise self._not_xml(path, data, error.msg) from None
        return self.documents[path]

    def _not_found(self, path: str, message: str) -> FileFails:
        """Return the error for a file that does not exist, with the one surely meant."""
        # a path that is not text, or has controls, cannot be written in the file
        paths = [other for other in self._workspace.paths if other.isprintable()]
        self._budget.charge(len(self._workspace.paths))
        folder, name = split(path)
        beside = [other for other in paths if dirname(other) == folder]
        names = [basename(other) for other in beside]
        self._budget.charge(_OF_NAME * len(names))
        same = [other for other in paths if other.lower() == path.lower()]
        if len(same) != 1:
            unknown = UnknownName(name, dict.fromkeys(names), "file", near(name, names))
            return FileFails(message, unknown)
        # The part from the first folder that differs is what is misspelt.
        parts = path.split("/")
        others = same[0].split("/")
        while parts[0] == others[0]:
            del parts[0], others[0]
        meant = "/".join(others)
        unknown = UnknownName("/".join(parts), {meant: None}, "file", meant)
        return FileFails(f"{message}, but {same[0]}: capital letters count", unknown)

    def _not_xml(self, path: str, data: bytes, message: str) -> XmlFails:
        """Return the error for an included file that is not well-formed XML.

        The error has what repairs the file.
        """
        from grader.ros.xml.repair import repair  # late: few files are broken

        source = self.broken[path] = Source.decoded(path, data)
        self._budget.charge(1, len(data))
        repaired = repair(source.text)
        edits = tuple(starmap(source.edit, repaired.changes)) if not repaired.is_lossy else ()
        conflicts = find_conflicts(source.text)
        assumed = (
            "; ".join(assumption.message for assumption in repaired.assumed[:3])
            or "the first version is read"
        )
        if conflicts:
            return XmlFails(
                f"{path} has {describe_conflicts(source.text, conflicts)}", edits, assumed
            )
        return XmlFails(f"{path} is not well-formed XML: {message}", edits, assumed)
