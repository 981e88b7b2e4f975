"""What packages have, where files name it: packages, programs, files, types and plug-ins."""

import re
from collections.abc import Iterator, Mapping
from functools import cached_property

from grader.base import markup
from grader.base.patterns import on_use
from grader.base.source import Location, Source, SourceOf
from grader.ros.interfaces.interface_types import FieldType
from grader.ros.nodes.node_facts import NodeProgram
from grader.ros.package.package import Package
from grader.workspace.graph.bridge_rows import bridge_rows
from grader.workspace.index.written_names import (
    Role,
    Span,
    WrittenName,
    WrittenNames,
    span_of_name,
    written_name,
)
from grader.workspace.model.text_files import CODE_ENDINGS, CPP_ENDINGS
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.files import PathInFile, named_paths
from grader.workspace.rules.plugin_classes import described_classes, named_classes
from grader.workspace.rules.used_packages import used_packages

_COMMENT = on_use(r"<!--.*?(?:-->|\Z)", re.DOTALL)
_DEPENDENCY = on_use(
    r"<(?:(?:build|buildtool|exec|run|test|doc)_(?:export_)?)?depend\b[^<>]*+>\s*+(?P<name>[\w-]++)"
)
_TYPE_IN_CPP = on_use(r"\b(\w++)::(msg|srv|action)::(\w++)")
_HEADER = on_use(r"[<\"](?P<package>\w++)/(?P<part>msg|srv|action)/(?P<name>\w++)\.h(?:pp)?[>\"]")
_TYPE = "message type"
_FILE = "file"
_PROGRAM = "program"


class PackageNames:
    """Reads the names of what packages have."""

    def __init__(self, workspace: Workspace, source_of: SourceOf) -> None:
        self._workspace = workspace
        self._source_of = source_of

    def names(self) -> WrittenNames:
        """Yield the names. Raises NotDecided."""
        for package in self._workspace.packages:
            yield from self._packages(package)
            yield from self._programs(package)
            yield from self._types(package)
        for _, node in self._workspace.launches.launched:
            yield from self._written(node.location, _PROGRAM, node.executable, "use", node.package)
            yield from self._written(node.location, "package", node.package, "use")
        for named in named_paths(self._workspace):
            yield from self._file(named)
        for row in bridge_rows(self._workspace):
            name = row.ros_type.replace(".", "/")
            yield from self._written(row.ros_type_location, _TYPE, name, "use")
        yield from self._plugins()

    def _written(
        self, at: Location, kind: str, name: str, role: Role, owner: str = ""
    ) -> WrittenNames:
        """Yield a name in what begins at a place, if it is written there."""
        source = self._source_of(at.path)
        if not source:
            return
        start = source.start_offset(at)
        span: Span | None = (start, start + len(name))
        if not source.text.startswith(name, start):
            span = span_of_name(source, at, kind, name, role)
        if span is None or source.text[slice(*span)] != name:
            is_cmake = source.path.endswith("CMakeLists.txt")
            end = source.text.find(")" if is_cmake else "\n", start)
            word = re.compile(rf"(?<![\w-]){re.escape(name)}(?![\w-])")
            match = word.search(source.text, start, end if end >= 0 else len(source.text))
            span = match.span() if match else None
        if span is not None:
            yield written_name(source, span, kind, name, role, owner)

    def _packages(self, package: Package) -> WrittenNames:
        """Yield the name of a package, and those of the packages that its files name."""
        manifest = package.manifest
        if manifest and manifest.name:
            yield from self._written(manifest.name_location, "package", manifest.name, "definition")
            text = _COMMENT.sub(lambda comment: " " * len(comment[0]), manifest.source.text)
            for match in _DEPENDENCY.finditer(text):
                source = manifest.source
                yield written_name(source, match.span("name"), "package", match["name"], "use")
        for used in used_packages(self._workspace, package):
            yield from self._written(used.location, "package", used.name, "use")

    def _programs(self, package: Package) -> WrittenNames:
        """Yield the programs of a package, with the functions that they call."""
        code = self._workspace.code.by_package.get(package.name)
        for program in code.programs if code else ():
            at = program.location
            yield from self._written(at, _PROGRAM, program.name, "definition", package.name)
            yield from self._function(package, program)
        setup = package.installation
        for target in setup.targets if setup else ():
            if setup and target.kind == "executable":
                name = target.program or target.name
                at = setup.location(target.at)
                yield from self._written(at, _PROGRAM, name, "definition", package.name)

    def _function(self, package: Package, program: NodeProgram) -> WrittenNames:
        """Yield the function of a program, in its file and where setup.py names it."""
        path = package.path(program.path)
        source = self._source_of(path) if program.path else None
        if not source:
            return
        if not program.function:
            yield _of_file(path, _PROGRAM, program.name, package.name)
            return
        name = re.escape(program.function)
        pattern = rf"(?m)^[ \t]*+(?:async[ \t]++)?(?:def|int)[ \t]++(?P<name>{name})[ \t]*+\("
        defined = re.search(pattern, source.text)
        if not defined:
            return
        span = defined.span("name")
        yield written_name(source, span, _PROGRAM, program.name, "definition", package.name)
        setup = self._source_of(program.location.path)
        if not setup or path.endswith(CPP_ENDINGS):
            return
        start = setup.start_offset(program.location)
        used = re.compile(rf"[\w.]++:{name}").search(setup.text, start)
        if used and "\n" not in setup.text[start : used.start()]:
            yield written_name(source, span, "function", used[0], "definition", package.name)
            yield written_name(setup, used.span(), "function", used[0], "use", package.name)

    def _types(self, package: Package) -> WrittenNames:
        """Yield the types of messages that a package defines and uses."""
        interfaces = self._workspace.code.interfaces[package.name]
        for name, defined in interfaces.types.items():
            full = f"{package.name}/{name.replace('.', '/')}"
            yield _of_file(defined.path, _TYPE, full)
            for section in defined.interface.sections:
                for field in section.fields.values():
                    yield from self._type_of_field(package, field.type, field.location)
        for imported in self._workspace.code.by_package[package.name].imports:
            yield from self._imported(imported.name, imported.location)
        for source in self._workspace.texts.read_sources(package, CPP_ENDINGS):
            for match in _TYPE_IN_CPP.finditer(source.text):
                full = "/".join(match.groups())
                yield written_name(source, match.span(3), _TYPE, full, "use")
            for match in _HEADER.finditer(source.text):
                full = self._headers.get((match["package"], match["part"], match["name"]), "")
                if full:
                    yield written_name(source, match.span("name"), _TYPE, full, "use")

    def _type_of_field(
        self, package: Package, kind: FieldType, at: Location | None
    ) -> WrittenNames:
        source = self._source_of(at.path) if at else None
        owner = kind.package or package.name
        if not source or not at or kind.name[:1].islower():
            return
        start = source.start_offset(at)
        written = re.compile(rf"(?:[\w/]++(?<=/))?(?P<name>{re.escape(kind.name)})\b")
        match = written.match(source.text, start)
        if match:
            yield written_name(source, match.span("name"), _TYPE, f"{owner}/msg/{kind.name}", "use")

    @cached_property
    def _headers(self) -> Mapping[tuple[str, str, str], str]:
        """The types of own packages by package, part and the name of the header."""
        types = {}
        for package, interfaces in self._workspace.code.interfaces.items():
            for name in interfaces.types:
                part, _, last = name.partition(".")
                header = re.sub(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", "_", last)
                types[package, part, header.lower()] = f"{package}/{part}/{last}"
        return types

    def _imported(self, name: str, at: Location) -> WrittenNames:
        """Yield a type where Python imports it, and where the file uses it."""
        source = self._source_of(at.path)
        last = name.rpartition(".")[2]
        if not source or not source.path.endswith(".py"):
            return
        word = re.compile(rf"(?<![\w.\"'])(?:{re.escape(last)})(?![\w\"'])")
        for match in word.finditer(source.text, source.start_offset(at)):
            yield written_name(source, match.span(), _TYPE, name.replace(".", "/"), "use")

    def _file(self, named: PathInFile) -> WrittenNames:
        """Yield a file of a package, and where the file that names its path writes it."""
        path = self._workspace.installed.find_source(named.path)
        source = self._source_of(named.location.path)
        if path is None or not source:
            return
        yield _of_file(path, _FILE, path)
        for span in _spans_of_path(source, named):
            yield written_name(source, span, _FILE, path, "use")

    def _plugins(self) -> WrittenNames:
        """Yield the classes of pluginlib: where they are described and written, and their names."""
        for described in described_classes(self._workspace):
            source = self._source_of(described.location.path)
            written = None
            if source:
                start = source.start_offset(described.location)
                attribute = markup.attribute(source.text, start, "name")
                written = attribute or markup.attribute(source.text, start, "type")
            if source and written:
                name = described.name
                yield written_name(source, written.value, "plugin", name, "definition")
                yield from self._class(described.package, described.type, name)
        for named in named_classes(self._workspace):
            yield from self._written(named.location, "plugin", named.name, "use")
        yield from self._components()

    def _components(self) -> WrittenNames:
        """Yield the classes and packages of the components that launch files load."""
        for launch in self._workspace.launches.outermost:
            for component in launch.components:
                if component.package and component.plugin:
                    at = component.location
                    name = component.plugin
                    yield from self._written(at, "plugin", name, "use")
                    yield from self._written(at, "package", component.package, "use")
                    yield from self._class(component.package, name, name)

    def _class(self, package: str, kind: str, name: str) -> WrittenNames:
        """Yield the class of C++ that a plug-in is."""
        cls = re.escape(kind.rpartition("::")[2])
        pattern = re.compile(
            rf"(?m)^[ \t]*+(?:class|struct)\s++(?:[A-Z_]++\s++)?(?P<name>{cls})\b[^;{{}}]*+\{{"
        )
        owner = self._workspace.own_packages.get(package)
        texts = self._workspace.texts
        for source in texts.read_sources(owner, CPP_ENDINGS) if owner else ():
            match = pattern.search(source.text)
            if match:
                yield written_name(source, match.span("name"), "plugin", name, "definition")


def _of_file(path: str, kind: str, name: str, owner: str = "") -> WrittenName:
    """Return what a whole file defines."""
    start = Location(path, 1, 1, end_line=1, end_column=1)
    return WrittenName(kind, name, "definition", start, owner, is_made=True)


def _spans_of_path(source: Source, named: PathInFile) -> Iterator[Span]:
    """Yield where a file writes a path, or the parts of it that it joins to a folder."""
    parts = named.path.rpartition("share/")[2].split("/")[1:]
    tails = ["/".join(parts[first:]) for first in range(len(parts))]
    if source.path.endswith(CODE_ENDINGS):
        tails = [rf"(?<=[\"'/]){re.escape(tail)}(?=[\"'])" for tail in tails if tail]
    else:
        tails = [rf"(?<=/){re.escape(tail)}(?![\w./-])" for tail in tails[:1] if tail]
    for match in re.finditer("|".join(tails), source.text) if tails else ():
        yield match.span()
