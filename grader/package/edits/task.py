"""A package whose edits are searched, beside the package of the rubric's reference solution."""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Literal

from grader.edits import Proposal
from grader.errors import InputError
from grader.package.launch.model import Launch
from grader.package.launch.places import ENDINGS, is_in_launch_folder
from grader.package.package import PYTHON_LIMIT, SETUP, Package
from grader.source import Edit, Source

Verb = Literal["set", "add", "remove", "rename", "syntax", "create", "file"]
# What is wrong and what to do, by the kind of the step; the first gives no answer away.
_WORDS: Mapping[Verb, tuple[str, str]] = {
    "set": ("{}", "correct {}"),
    "add": ("a missing part of {}", "complete {}"),
    "remove": ("{}", "remove {}"),
    "rename": ("the spelling of {}", "correct the spelling of {}"),
    "syntax": ("a syntax error{}", "correct the syntax{}"),
    "create": ("{} is missing", "create {}"),
    "file": ("the name of {}", "rename {}"),
}
_RVIZ_LIMIT = 512 * 1024


@dataclass(frozen=True)
class PackageTask:
    """A package, the one of the reference solution, if there is one, and the texts that are given to checks."""

    package: Package
    reference: Package | None = None
    given: frozenset[str] = field(default=frozenset())

    def source(self, path: str | None) -> Source | None:
        """Return the text of a file of the package as it is; None where there is none that can be read."""
        text = _text(self.package, path) if path is not None else None
        return Source(self.package.path(path or ""), text) if text is not None else None

    def file(self, package: Package | None, kind: str) -> str | None:
        """Return the path of the file of a kind in a package: the one that a check names, else another one."""
        if package is None or kind not in ("launch", "rviz"):
            return kind
        name = min((name for name in self.given if kind_of(name) == kind), default="")
        launch = next((package.launch(path) for path in package.launch_files[:1]), None)
        return package.launch_file(name) if kind == "launch" else package.rviz_file(name, launch)

    def launch(self, path: str, source: Source) -> Launch:
        """Return a launch file of the package with another text, evaluated."""
        return self.package.launch(path, source.text.encode("utf-8", "surrogateescape"))

    def wanted(self, path: str | None) -> str | None:
        """Return the text of a file of the reference, with the student's names of the package and of its frames."""
        text = _text(self.reference, path) if self.reference is not None and path is not None else None
        launch = next((self.package.launch(it) for it in self.package.launch_files[:1]), None)
        if text is not None and launch is not None and path is not None and path.endswith(".rviz"):
            for link in sorted(self.given):
                frame = launch.frames_of(link)[0] or link
                text = text.replace(f"Frame: {link}\n", f"Frame: {frame}\n")
        return self.named(text) if text is not None else None

    def named(self, text: str) -> str:
        """Return a text of the reference, or a path in it, with the student's name of the package."""
        if self.reference is None or self.reference.name == self.package.name:
            return text
        return re.sub(rf"(?<![\w.]){re.escape(self.reference.name)}(?![\w.])", lambda _: self.package.name, text)

    def created(self, path: str, like: str | None) -> list[Edit]:
        """Return the edit that creates a file like the reference's; none where it exists, or the reference has none."""
        text = self.wanted(like)
        return [Edit(self.package.path(path), 1, 1, "", text)] if text is not None and path not in self.files else []

    def renamed(self, path: str, new: str) -> Edit:
        """Return the edit that gives a file another path."""
        return Edit(self.package.path(path), 1, 1, "", "", renamed=self.package.path(new))

    @property
    def files(self) -> Iterable[str]:
        """The paths of the package's files."""
        return self.package.tree.files


def kind_of(path: str) -> str:
    """Return the kind of a file: launch, rviz, urdf, setup.py with the files that it needs, or another file itself."""
    if path.endswith((".rviz", ".urdf", ".xacro")):
        return "rviz" if path.endswith(".rviz") else "urdf"
    if path.endswith(ENDINGS) or is_in_launch_folder(path):
        return "launch"
    return SETUP if path.startswith("resource/") or path == "setup.cfg" else path


def _text(package: Package, path: str) -> str | None:
    file = package.tree.files.get(path)
    try:
        limit = _RVIZ_LIMIT if path.endswith(".rviz") else PYTHON_LIMIT
        return file.read(limit).decode("utf-8", "surrogateescape") if file is not None else None
    except InputError:
        return None


def change(edits: Iterable[Edit], verb: Verb, name: str, what: str = "") -> Proposal:
    """Return the proposal of a step; `name` is what changes, and `what` the file that it is in."""
    place = " in ".join(filter(None, (name, what)))
    cause, action = (text.format(f" in {what}" if verb == "syntax" else place) for text in _WORDS[verb])
    return Proposal(tuple(dict.fromkeys(edits)), cause, action)
