"""The executables and libraries of a CMakeLists.txt: what they are made of."""

import posixpath
from collections.abc import Mapping, Sequence
from dataclasses import field
from itertools import pairwise

from grader.base.grouping import distinct, texts_among
from grader.base.records import Record
from grader.ros.installation.cmake.cmake_values import ROOT, Text, joined
from grader.ros.installation.file_search import PackageListing
from grader.ros.installation.installation import CmakeComponent, CmakeTarget
from grader.ros.known.cmake_words import cmake_words
from grader.ros.python.parse import Position
from grader.ros.python.values import Unknown

_OF_FILE = ("PREFIX", "OUTPUT_NAME", "SUFFIX")
_SCOPES = ("PUBLIC", "PRIVATE", "INTERFACE")
_SHARED = "SHARED"
_CPP = (".cpp", ".cc", ".cxx", ".c++", ".c")


class _Made(Record, frozen=False):
    """A target, as far as the commands before have made it."""

    kind: str
    at: Position
    is_certain: bool
    sources: list[str] = field(default_factory=list)
    links: list[str] = field(default_factory=list)
    packages: list[str] = field(default_factory=list)
    components: list[CmakeComponent] = field(default_factory=list)
    is_installed: bool = False
    properties: dict[str, Text] = field(default_factory=dict)  # that name its file


class CmakeTargets:
    """The targets that commands make, by their names."""

    def __init__(self, listing: PackageListing) -> None:
        self._listing = listing
        self._made: dict[str, _Made] = {}

    def add(
        self, name: str, kind: str, at: Position, *, is_certain: bool, texts: Sequence[Text]
    ) -> None:
        """Add an executable or a library with its sources, as they are written."""
        self._made[name] = _Made(kind, at, is_certain)
        self.add_sources(name, texts)

    def add_sources(self, name: str, texts: Sequence[Text]) -> None:
        """Add sources to a target. One that is not known leaves open which there are."""
        made = self._made.get(name)
        if not made:
            return
        for before, text in pairwise(("", *texts)):
            if isinstance(text, Unknown):
                made.is_certain = False
            elif before == "DIRECTORY":
                made.sources += self._in_folder(text)
            else:
                made.sources.append(text)

    def _in_folder(self, folder: str) -> list[str]:
        """Return the sources in a folder, as ament_auto_add_library(... DIRECTORY) lists them."""
        path = posixpath.normpath(folder.removeprefix(f"{ROOT}/"))
        files = self._listing.files
        self._listing.budget.charge(1 + len(files))
        files_beside = [file for file in files if posixpath.dirname(file) == path]
        return sorted(file for file in files_beside if file.endswith(_CPP))

    def link(self, name: str, texts: Sequence[Text]) -> None:
        """Add what target_link_libraries() names."""
        made = self._made.get(name)
        if made:
            known = texts_among(texts)
            made.links += [text for text in known if text not in _SCOPES]
            made.is_certain = made.is_certain and len(known) == len(texts)

    def depend(self, name: str, packages: Sequence[Text]) -> None:
        """Add what ament_target_dependencies() names."""
        made = self._made.get(name)
        if made:
            made.packages += texts_among(packages)

    def register(self, name: str, component: CmakeComponent) -> None:
        """Add a component that rclcpp_components registers for a library."""
        if name in self._made:
            self._made[name].components.append(component)

    def install(self, name: str) -> None:
        """Note a target that is installed."""
        if name in self._made:
            self._made[name].is_installed = True

    def set_property(self, name: str, key: str, value: Text) -> None:
        """Note a property of a target, if it is one that names its file."""
        if name in self._made and key in _OF_FILE:
            self._made[name].properties[key] = value

    def file_name(self, name: str) -> Text:
        """Return the name of the file of an executable."""
        made = self._made.get(name)
        properties = made.properties if made else {}
        parts = [properties.get("PREFIX", ""), properties.get("OUTPUT_NAME", name)]
        return joined([*parts, properties.get("SUFFIX", "")])

    def all(self, inside: Mapping[str, str | None]) -> tuple[CmakeTarget, ...]:
        """Return the targets; `inside` has the path in the package of each source."""
        targets = []
        for name, made in self._made.items():
            paths = []
            has_others = False
            for source in made.sources:
                path = inside.get(source)
                if path is not None and path in self._listing.files:
                    paths.append(path)
                elif source not in cmake_words().target_keywords and source != "DIRECTORY":
                    has_others = True
            targets.append(
                CmakeTarget(
                    name=name,
                    kind=made.kind,
                    sources=distinct(paths),
                    links=distinct(made.links),
                    packages=tuple(made.packages),
                    components=tuple(made.components),
                    at=made.at,
                    is_installed=made.is_installed,
                    is_certain=made.is_certain,
                    program=self._program(name, made),
                    has_other_sources=has_others,
                    is_shared=_SHARED in made.sources,
                )
            )
        return tuple(targets)

    def _program(self, name: str, made: _Made) -> str:
        file_name = self.file_name(name) if made.kind == "executable" else ""
        return file_name if isinstance(file_name, str) else ""

    @property
    def written_sources(self) -> set[str]:
        """The sources of all targets, as they are written."""
        return {source for made in self._made.values() for source in made.sources}
