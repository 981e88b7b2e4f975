"""The names in worlds and models of Gazebo, and in the commands of Markdown."""

from grader.base.names import last_part
from grader.base.patterns import on_use
from grader.base.source import Location, Source, SourceOf
from grader.ros.known.gazebo_rows import gazebo
from grader.workspace.index.written_names import WrittenName, WrittenNames, written_name
from grader.workspace.model.workspace import Workspace

_MODEL = (".sdf", ".world")
_NAMED = on_use(r"<(?P<tag>link|joint)\s+name\s*=\s*[\"'](?P<name>[^\"'<]+)")
_TEXT = on_use(r"<(?P<tag>\w++)>\s*+(?P<name>[^<>\s]++)\s*+</")
_COMMAND = on_use(
    r"\bros2[ \t]+(?P<verb>launch|run)[ \t]+(?P<package>[\w-]+)[ \t]+(?P<target>[\w.-]+)"
    r"(?P<rest>[^\n`]*)"
)
_PASSED = on_use(r"\b(?P<name>\w++):=")


def names_in_texts(workspace: Workspace, source_of: SourceOf) -> WrittenNames:
    """Yield the links and joints of models, the frames of plugins, and what commands start."""
    for path in workspace.tree.files:
        source = source_of(path) if path.endswith((*_MODEL, ".md")) else None
        if source and path.endswith(_MODEL):
            yield from _names_in_model(source)
        elif source:
            yield from _names_in_commands(workspace, source)


def _names_in_model(source: Source) -> WrittenNames:
    """Yield the links and joints of a file, which owns them, and the frames that plugins name."""
    for match in _NAMED.finditer(source.text):
        kind = match["tag"]
        name = match["name"]
        yield written_name(source, match.span("name"), kind, name, "definition", source.path)
    table = gazebo()
    kinds = dict.fromkeys(table.frame_elements + table.odometry_elements, "frame")
    kinds |= dict.fromkeys(table.joint_elements, "joint")
    for match in _TEXT.finditer(source.text):
        tag = match["tag"]
        span = match.span("name")
        name = match["name"]
        if tag in ("parent", "child"):
            yield written_name(source, span, "link", name, "use", source.path)
        elif tag in kinds:
            yield written_name(source, span, kinds[tag], name, "use")


def _names_in_commands(workspace: Workspace, source: Source) -> WrittenNames:
    """Yield the packages, programs, launch files and launch arguments of commands."""
    for match in _COMMAND.finditer(source.text):
        package = workspace.own_packages.get(match["package"])
        if not package:
            continue
        name = match["target"]
        span = match.span("target")
        yield written_name(source, match.span("package"), "package", package.name, "use")
        if match["verb"] == "run":
            yield written_name(source, span, "program", name, "use", package.name)
            continue
        for path in package.launch_files:
            if last_part(path) == name:
                whole = package.path(path)
                yield written_name(source, span, "file", whole, "use")
                yield WrittenName("file", whole, "definition", Location(whole, 1, 1))
        for passed in _PASSED.finditer(source.text, *match.span("rest")):
            owner = f"{package.share}launch/{name}"
            at = passed.span("name")
            yield written_name(source, at, "launch argument", passed["name"], "use", owner)
