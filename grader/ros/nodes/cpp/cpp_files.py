"""The C++ files of a package, and which of them a build compiles into one program or library."""

from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from typing import NamedTuple

from grader.base.errors import InputError
from grader.base.grouping import Strings
from grader.base.patterns import on_use
from grader.base.source import Location
from grader.ros.cpp.declarations import CppFile
from grader.ros.cpp.literals import TEXTS, text_of_literal
from grader.ros.cpp.syntax import MAX_BYTES, parse_cpp
from grader.ros.cpp.unit import CppUnit, resolve_include
from grader.ros.installation.installation import CmakeTarget
from grader.ros.package.package import Package

_SOURCES = (".cpp", ".cc", ".cxx", ".c++")
_HEADERS = (".hpp", ".hh", ".hxx", ".h", ".h++", ".ipp", ".tpp")
# What a statement that is no C++, or a macro, must not have: what makes, declares or opens
# something, or is given a node, or sets what a name may be made of.
_LOST = on_use(
    r"\b(?:create_\w+|declare_parameters?|get_parameter\w*|has_parameter|Subscriber|add_node|spin"
    r"|class|struct|namespace|template|using|main|make_(?:shared|unique)|\w+_from_this"
    r"|new(?!\s+(?:bool|char|double|float|int)\b)|Node|LifecycleNode|RCLCPP_COMPONENTS\w*)\b"
    r"|[({,=]\s*\*?this\s*[,)};]|\b(?=\w*[nN]ode)\w++\s*+[,)};]"
)
_MAX_FILES = 200  # of one package
_MAX_LINKED = 50  # targets


class _UnreadCpp(NamedTuple):
    """A C++ file that is not read, or not as a whole, and why."""

    reason: str
    location: Location


class CompiledTarget(NamedTuple):
    """A target of CMake with the files that are compiled into it, and own headers of these."""

    target: CmakeTarget
    at: Location  # in CMakeLists.txt
    unit: CppUnit
    unread: tuple[_UnreadCpp, ...]


class CppFiles:
    """The C++ files of a package. Each is read once, when it is first needed."""

    def __init__(self, package: Package) -> None:
        self._package = package
        self._files: dict[str, CppFile | _UnreadCpp] = {}

    @cached_property
    def _paths(self) -> Mapping[str, object]:
        endings = _SOURCES + _HEADERS
        unread = self._package.inner
        paths = [path for path in self._package.tree.files if path.endswith(endings)]
        return dict.fromkeys(path for path in paths if not path.startswith((*unread, "test/")))

    @cached_property
    def _targets(self) -> Mapping[str, CmakeTarget]:
        setup = self._package.installation
        return {target.name: target for target in (setup.targets if setup else ())}

    @cached_property
    def compiled(self) -> tuple[CompiledTarget, ...]:
        """The targets that have sources in C++, without those of tests."""
        setup = self._package.installation
        units: dict[Strings, CppUnit] = {}
        compiled = []
        for target in self._targets.values():
            paths = list(self._compiled_into(target))
            if not any(path.endswith(_SOURCES) for path in paths):
                continue
            files, unread = self._read_all(paths)
            key = tuple(file.syntax.source.path for file in files)
            unit = units.setdefault(key, CppUnit(files))
            assert setup
            compiled.append(CompiledTarget(target, setup.location(target.at), unit, unread))
        return tuple(compiled)

    def _compiled_into(self, target: CmakeTarget) -> Iterator[str]:
        """Yield the sources of a target, and of the own libraries that it links."""
        pending = [target.name]
        seen = set[str]()
        while pending and len(seen) < _MAX_LINKED:
            name = pending.pop(0)
            made = self._targets.get(name)
            if name in seen or not made:
                continue
            seen.add(name)
            pending += made.links
            yield from (path for path in made.sources if path in self._paths)

    def _read_all(self, paths: Sequence[str]) -> tuple[list[CppFile], tuple[_UnreadCpp, ...]]:
        """Return files with the headers of the package that they include."""
        files = []
        unread = []
        pending = list(paths)
        seen = set()
        while pending:
            path = pending.pop(0)
            if path in seen:
                continue
            seen.add(path)
            file = self.read(path)
            if isinstance(file, _UnreadCpp):
                unread.append(file)
                continue
            files.append(file)
            self._package.work.charge(1 + len(file.includes))
            error = _lost_in(file)
            if error:
                unread.append(_UnreadCpp("this is no C++ that is known", error))
            for included in file.includes:
                header = resolve_include(path, included, self._paths)
                if header is not None:
                    pending.append(header)
        return files, tuple(unread)

    def read(self, path: str) -> CppFile | _UnreadCpp:
        """Return what a file declares, or why it is not read. It never raises."""
        if path not in self._files:
            self._files[path] = self._read(path)
        return self._files[path]

    def texts_with(self, part: str) -> tuple[tuple[str, Location], ...]:
        """Return the texts in the files read so far that have a part, with their places."""
        texts = []
        for file in self._files.values():
            if isinstance(file, CppFile) and part in file.syntax.source.text:
                for node in file.of_kind(*TEXTS):
                    text = text_of_literal(node) or ""
                    if part in text:
                        texts.append((text, node.location))
        return tuple(texts)

    @property
    def read_paths(self) -> frozenset[str]:
        """The paths of the files that are read so far."""
        return frozenset(path for path, file in self._files.items() if isinstance(file, CppFile))

    def _read(self, path: str) -> CppFile | _UnreadCpp:
        full = self._package.path(path)
        start = Location(full, 1, 1)
        if len(self._files) >= _MAX_FILES:
            return _UnreadCpp("the package has too many files", start)
        try:
            data = self._package.tree.files[path].read(MAX_BYTES)
        except InputError as error:
            return _UnreadCpp(str(error), start)
        syntax = parse_cpp(data, full, self._package.work)
        if syntax.unread:
            return _UnreadCpp(syntax.unread, start)
        return CppFile(syntax)


def may_hide(text: str) -> bool:
    """Return whether a text that is not read may make, open or declare something."""
    return _LOST.search(text) is not None


def _lost_in(file: CppFile) -> Location | None:
    """Return where a file is no C++ that is known, and a node may be made, open or declare more."""
    for statement in file.syntax.broken:
        if may_hide(statement.text):
            return file.syntax.error or statement.location
    return file.syntax.error
