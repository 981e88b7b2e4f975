"""A package whose edits are searched, beside the package of the rubric's reference solution."""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from posixpath import basename, dirname, join, split

from grader.base.names import closest
from grader.base.source import Edit, Source
from grader.lab.hints.edits import Proposal, Proposals
from grader.ros.installation.places import is_launch_file, is_launch_named
from grader.ros.launch.launch_model import Launch
from grader.ros.package.package import MANIFEST, SETUP, Package
from grader.ros.python.budget import PYTHON_LIMIT

_RVIZ_LIMIT = 512 * 1024
WHAT = {"launch": "the launch file", "rviz": "the RViz file", "urdf": "the URDF"}
_MAX_NAMES = 2  # of files that may be the one that is meant
_MAX_LAUNCH_FILES = 3


@dataclass(frozen=True)
class PackageTask:
    """A package, and the texts that are given to checks.

    It also has the one of the reference solution, if there is one.
    """

    package: Package
    reference: Package | None = None
    given: frozenset[str] = field(default=frozenset())

    def source(self, path: str | None) -> Source | None:
        """Return the text of a file of the package as it is.

        It is None where there is none that can be read.
        """
        text = _text(self.package, path) if path is not None else None
        if text is not None:
            return Source(self.package.path(path or ""), text)
        return None

    def file(self, package: Package | None, kind: str) -> str | None:
        """Return the path of the file of a kind in a package.

        This is the one that a check names, else another one.
        """
        if not package or kind not in ("launch", "rviz"):
            return kind
        name = min((name for name in self.given if _classify_file(name) == kind), default="")
        launch = next(map(package.launch, package.launch_files[:1]), None)
        if kind == "launch":
            return package.launch_file(name)
        return package.rviz_file(name, launch)

    def launch(self, path: str, source: Source) -> Launch:
        """Return a launch file of the package with another text, evaluated."""
        return self.package.launch(path, source.text.encode("utf-8", "surrogateescape"))

    def wanted(self, path: str | None) -> str | None:
        """Return the text of a file of the reference, with the student's name of the package."""
        text = _text(self.reference, path) if self.reference and path is not None else None
        return self.named(text) if text is not None else None

    def named(self, text: str) -> str:
        """Return a text or a path of the reference with the student's name of the package."""
        if not self.reference or self.reference.name == self.package.name:
            return text
        return re.sub(
            rf"(?<![\w.]){re.escape(self.reference.name)}(?![\w.])",
            lambda _: self.package.name,
            text,
        )

    def renamed(self, path: str, new: str) -> Edit:
        """Return the edit that gives a file another path."""
        return Edit(self.package.path(path), 1, 1, "", "", renamed=self.package.path(new))

    @property
    def files(self) -> Iterable[str]:
        """The paths of the package's files."""
        return self.package.tree.files


def _classify_file(path: str) -> str:
    """Return the kind of a file.

    This is launch, rviz, urdf, setup.py with the files that it needs, or another file itself.
    """
    if path.endswith((".rviz", ".urdf", ".xacro")):
        return "rviz" if path.endswith(".rviz") else "urdf"
    if is_launch_file(path):
        return "launch"
    if path.startswith("resource/") or path == "setup.cfg":
        return SETUP
    return path


def _text(package: Package, path: str) -> str | None:
    data = package.tree.read(path, _RVIZ_LIMIT if path.endswith(".rviz") else PYTHON_LIMIT)
    return data.decode("utf-8", "surrogateescape") if data is not None else None


def change(edits: Iterable[Edit], cause: str) -> Proposal:
    """Return a proposal, with each edit once."""
    return Proposal(tuple(dict.fromkeys(edits)), cause)


def file_proposals(task: PackageTask, kind: str) -> Proposals:
    """Yield edits that give a file the name that it has in the reference."""
    wanted = [task.named(path) for path in task.reference.tree.files] if task.reference else []
    names = {basename(path) for path in wanted} | task.given
    for path in dict.fromkeys(wanted):
        folder, name = split(path)
        if _classify_file(path) != kind or any(_is_named(file, name, kind) for file in task.files):
            continue
        same_kind = [
            file
            for file in task.files
            if kind in (_classify_file(file), dirname(file)) or file.startswith(f"{folder}/")
        ]
        yield from _rename(
            task, kind, name, [file for file in same_kind if basename(file) not in names]
        )


def _is_named(path: str, name: str, kind: str) -> bool:
    return basename(path) == name or (kind == "launch" and is_launch_named(path, name))


def _rename(task: PackageTask, kind: str, name: str, files: Sequence[str]) -> Proposals:
    """Yield edits that give one of these files a name: the one with the most similar name first.

    Xacro stays xacro.
    """
    spare = {
        basename(file): file for file in files if file.endswith(".xacro") <= name.endswith(".xacro")
    }
    others = list(spare)[:_MAX_NAMES]
    nearest = closest(name, spare)
    if nearest is not None:
        others.insert(0, nearest)
    for other in dict.fromkeys(others):
        new = join(dirname(spare[other]), name)
        yield change([task.renamed(spare[other], new)], f"the name of {WHAT.get(kind, 'a file')}")


def package_names(task: PackageTask, new: str) -> Proposals:
    """Yield edits that give the package one name in all its files.

    The package has another name or several.
    """
    names = _other_names(task, new)
    if not names:
        return
    word = re.compile(rf"(?<![\w.])({'|'.join(map(re.escape, names))})(?![\w.])")
    edits = []
    for path in (MANIFEST, SETUP, "setup.cfg", *task.package.launch_files[:_MAX_LAUNCH_FILES]):
        source = task.source(path)
        if source:
            edits += [source.edit(*match.span(), new) for match in word.finditer(source.text)]
    if f"resource/{new}" not in task.files:
        moved = [name for name in names if f"resource/{name}" in task.files]
        edits += [task.renamed(f"resource/{name}", f"resource/{new}") for name in moved]
    yield change(edits, "the name of the package")


def _other_names(task: PackageTask, new: str) -> list[str]:
    """Return the names of the package in its files that differ from the new one.

    They are those of its manifest and setup.py, and names like the new one in paths of its share
    folder. There are none if the manifest has no name.
    """
    manifest = task.package.manifest
    setup = task.package.installation
    if not manifest or manifest.name is None:
        return []
    shares = [path.split("/")[1] for path in task.package.installed if path.startswith("share/")]
    own_names = [manifest.name, setup.name if setup else None]
    similar = [name for name in shares if closest(name, [new])]
    return [name for name in dict.fromkeys([*own_names, *similar]) if name and name != new]
