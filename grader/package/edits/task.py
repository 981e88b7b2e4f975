"""A package whose edits are searched, beside the package of the rubric's reference solution."""

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from functools import cached_property

from grader.edits import KNOWN, REWRITTEN, Proposal
from grader.errors import InputError
from grader.package.edits.python_file import PythonFile
from grader.package.package import PYTHON_LIMIT, SETUP, Package
from grader.source import Edit, Source

_RVIZ_LIMIT = 512 * 1024


@dataclass(frozen=True)
class Task:
    """A package, and the one of the reference solution, if there is one."""

    package: Package
    reference: Package | None = None
    _found: dict[str, list[Proposal]] = field(default_factory=dict, repr=False)

    def once(self, name: str, make: Callable[[], Iterable[Proposal]]) -> list[Proposal]:
        """Return proposals that several criteria need, made only once."""
        if name not in self._found:
            self._found[name] = list(make())
        return self._found[name]

    def source(self, path: str) -> Source | None:
        """Return the text of a file of the package as it is; None where there is none that can be read."""
        text = _text(self.package, path)
        return Source(self.package.path(path), text) if text is not None else None

    def python(self, path: str) -> PythonFile | None:
        """Return a Python file of the package."""
        source = self.source(path)
        return PythonFile(source) if source is not None else None

    @cached_property
    def setup(self) -> PythonFile | None:
        """The package's setup.py."""
        return self.python(SETUP)

    def wanted(self, path: str | None) -> str | None:
        """Return the text of a file of the reference, for a package of the student's name."""
        text = _text(self.reference, path) if self.reference is not None and path is not None else None
        if text is None or self.reference is None or self.reference.name == self.package.name:
            return text
        return re.sub(rf"(?<![\w.]){re.escape(self.reference.name)}(?![\w.])", self.package.name, text)

    def created(self, path: str, like: str | None) -> list[Edit]:
        """Return the edit that creates a file like one of the reference; nothing where it exists, or the reference has none."""
        text = self.wanted(like)
        return [Edit(self.package.path(path), 1, 1, "", text)] if text is not None and path not in self.files else []

    def renamed(self, path: str, new: str) -> Edit:
        """Return the edit that gives a file another path."""
        return Edit(self.package.path(path), 1, 1, "", "", renamed=self.package.path(new))

    @property
    def files(self) -> Iterable[str]:
        """The paths of the package's files."""
        return self.package.tree.files


def _text(package: Package, path: str) -> str | None:
    file = package.tree.files.get(path)
    try:
        limit = _RVIZ_LIMIT if path.endswith(".rviz") else PYTHON_LIMIT
        return file.read(limit).decode("utf-8", "surrogateescape") if file is not None else None
    except InputError:
        return None


def proposal(edits: Iterable[Edit], cause: str, action: str, *, is_rewrite: bool = False) -> Proposal:
    """Return a proposal that makes each edit once."""
    return Proposal(tuple(dict.fromkeys(edits)), cause, action, rank=REWRITTEN if is_rewrite else KNOWN)
