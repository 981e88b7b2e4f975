"""Where the files of a workspace say why a message of a log was said, besides findings of rules."""

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import NamedTuple

from grader.base.source import Location
from grader.ros.known.output_rows import OutputPlace, OutputRow
from grader.ros.known.released import is_released
from grader.ros.package.package import CMAKE, MANIFEST, SETUP, Package
from grader.workspace.graph.transform_edges import edges_in
from grader.workspace.log.log_messages import LogMessage
from grader.workspace.opening.opened import OpenedWorkspace

_MAX_FRAMES = 30  # of a traceback
_FRAME = re.compile(
    r'File "(?P<path>[^"]{1,400})", line (?P<line>[0-9]{1,7}), in (?P<function>\S{1,200})'
)
_INSTALLED = re.compile(r"/(?:install|build)/(?P<package>[\w-]{1,100})/(?P<path>\S[^\n]{0,400})")
_MODULES = re.compile(r"(?:site|dist)-packages/")
_PACKAGES = re.compile(r"^[ \t]*+packages[ \t]*+=", re.MULTILINE)
_COMMAND = re.compile(r"\bCommand\(")
_MAX_TEXT = 512 * 1024  # bytes of a file in which a line is searched


class _PlacedAnswer(NamedTuple):
    """What explains a message at a place of the workspace."""

    location: Location
    text: str


class KnownMessage(NamedTuple):
    """A message of a log that a row knows, with the names in it."""

    message: LogMessage
    row: OutputRow
    groups: Mapping[str, str]

    def said(self, **more: str) -> str:
        """Return what the row says of a place, with the names of the message and others."""
        return self.row.otherwise.format_map({**self.groups, **more})


def placed_answers(opened: OpenedWorkspace, known: KnownMessage) -> Sequence[_PlacedAnswer]:
    """Return what the place of a row says of a message; nothing where the files do not prove it.

    Raises NotDecided where the budget of the workspace is spent.
    """
    search = _SEARCHES.get(known.row.place)
    if search is None:
        return ()
    return [*search(opened, known)]


def _source_path(opened: OpenedWorkspace, path: str) -> str | None:
    """Return the file of the workspace that a path of a log means, such as one below install/.

    Each is looked for where a build copies it from, then by its longest end.
    """
    files = opened.whole_tree.files
    match = _INSTALLED.search(path)
    for package in opened.workspace.packages if match is not None else ():
        assert match is not None
        if package.name != match["package"]:
            continue
        inside = match["path"]
        source = package.installed.get(inside) or _MODULES.split(inside)[-1]
        if package.path(source) in files:
            return package.path(source)
    parts = path.strip("/").split("/")
    ends = ("/".join(parts[start:]) for start in range(max(0, len(parts) - 20), len(parts) - 1))
    return next((end for end in ends if end in files), None)


def _of_package(opened: OpenedWorkspace, known: KnownMessage) -> Iterator[_PlacedAnswer]:
    """Yield that a package is not built, or that it is not installed and a launch file needs it."""
    name = known.groups["package"]
    for package in opened.packages:
        if name == package.name:
            folder = package.folder or "the folder"
            text = (
                f"the package is in {folder}, so it is not built, or install/setup.bash is not "
                "sourced in this terminal"
            )
            yield _PlacedAnswer(Location(package.path(MANIFEST), 1, 1), text)
            return
    releases = opened.workspace.releases
    if not is_released(name, releases):
        return
    distro = releases[0] if len(releases) == 1 else "DISTRO"
    apt = f"sudo apt install ros-{distro}-{name.replace('_', '-')}"
    for package, place in _find_uses(opened, name):
        text = f"the package {name!r} is not installed: {apt}"
        if not package.depends_on(name):
            text += f"; package.xml of {package.name!r} does not declare it"
        yield _PlacedAnswer(place, text)
        return


def _find_uses(opened: OpenedWorkspace, name: str) -> Iterator[tuple[Package, Location]]:
    """Yield the packages that start a node of a package, or whose builds look for it."""
    for package, node in opened.workspace.launches.nodes:
        if node.package == name:
            yield package, node.location
    sought = re.compile(rf"(?i)\bfind_package[ \t]*+\([ \t]*+{re.escape(name)}(?![\w-])")
    for package in opened.packages:
        text = package.tree.read(CMAKE, _MAX_TEXT)
        place = _line_with(sought, package.path(CMAKE), text) if text is not None else None
        if place is not None:
            yield package, place


def _of_parameter(opened: OpenedWorkspace, known: KnownMessage) -> Iterator[_PlacedAnswer]:
    """Yield where a parameter is missing: the section around it is there."""
    *above, last = known.row.key.split("/")
    keys = [part.format_map(known.groups) for part in above]
    for _, tree in opened.workspace.installed.trees:
        section = tree.get(*keys)
        name = last.format_map(known.groups)
        if section is None or not isinstance(section.value, dict) or name in section.value:
            continue
        if name != last and tree.get(name) is None:
            continue  # the file says nothing of it
        yield _PlacedAnswer(tree.key_location(*keys), known.said())


def _of_traceback(opened: OpenedWorkspace, known: KnownMessage) -> Iterator[_PlacedAnswer]:
    """Yield the last line of a traceback that is in a file of the workspace, with its text."""
    places = []
    for match in [*_FRAME.finditer(known.message.text)][-_MAX_FRAMES:]:
        path = _source_path(opened, match["path"])
        source = opened.source(path) if path is not None else None
        if source is None:
            continue
        line = " ".join(source.line(int(match["line"])).split())
        # Python prints the line: the file is the one that ran if it is the same.
        if line and known.message.text[match.end() :].lstrip().startswith(line):
            places.append(Location(source.path, int(match["line"]), 1))
    if places:
        yield _PlacedAnswer(places[-1], known.said())


def _of_programs(opened: OpenedWorkspace, known: KnownMessage) -> Iterator[_PlacedAnswer]:
    """Yield that a build of a package installs no program in the folder of its programs."""
    name = known.groups["package"]
    folder = f"lib/{name}"
    for package in opened.packages:
        installation = package.installation
        if package.name != name or installation is None:
            continue
        place = Location(installation.source.path, 1, 1)
        paths = (*package.installed, *installation.programs)
        if any(path.startswith(f"{folder}/") for path in paths):
            continue
        if package.is_cmake and not installation.unknown:
            reason = f"CMakeLists.txt has no install(TARGETS ... DESTINATION {folder})"
            yield _PlacedAnswer(place, known.said(reason=reason))
        elif not package.is_cmake and installation.scripts_folder != folder:
            reason = f"setup.cfg has no install_scripts=$base/{folder}"
            yield _PlacedAnswer(place, known.said(reason=reason))


def _of_module(opened: OpenedWorkspace, known: KnownMessage) -> Iterator[_PlacedAnswer]:
    """Yield that setup.py does not install a module that its package has."""
    path = known.groups["module"].replace(".", "/")
    for package in opened.packages:
        is_there = f"{path}.py" in package.tree.files or f"{path}/__init__.py" in package.tree.files
        setup, installation = package.tree.read(SETUP, _MAX_TEXT), package.installation
        if not is_there or setup is None or installation is None:
            continue
        if known.groups["module"] in installation.packages:
            continue
        place = _line_with(_PACKAGES, package.path(SETUP), setup)
        if place is not None and "/" in path:
            yield _PlacedAnswer(place, known.said())


def _line_with(pattern: "re.Pattern[str]", path: str, data: bytes) -> Location | None:
    text = data.decode("utf-8", "replace")
    match = pattern.search(text)
    if match is None:
        return None
    return Location(path, text.count("\n", 0, match.end()) + 1, 1)


def _of_spaced_path(opened: OpenedWorkspace, known: KnownMessage) -> Iterator[_PlacedAnswer]:
    """Yield where a launch file gives a command a path that has a space on this machine."""
    path = _source_path(opened, known.groups["path"])
    if path is None or " " not in known.groups["path"]:
        return
    name = path.rpartition("/")[2]
    for package in opened.packages:
        for source in opened.workspace.texts.launch_sources(package):
            match = _COMMAND.search(source.text) if name in source.text else None
            if match is not None:
                yield _PlacedAnswer(source.at(match.start()), known.said())


def paths_of_publishers(opened: OpenedWorkspace, frame: str) -> frozenset[str]:
    """Return the parameter files of the nodes that publish a frame, in the workspace.

    Raises NotDecided where the budget of the workspace is spent.
    """
    workspace = opened.workspace
    paths = set[str]()
    for number, (_, launch) in enumerate(workspace.launches.roots):
        edges = [edge for edge in edges_in(workspace, number) if frame in (edge.parent, edge.child)]
        places = {edge.location[:2] for edge in edges}
        for node in launch.nodes:
            if node.location[:2] in places:
                given = [workspace.installed.find_source(one.path) for one in node.parameters or ()]
                paths.update(path for path in given if path is not None)
    return frozenset(paths)


_Search = Callable[[OpenedWorkspace, KnownMessage], Iterator[_PlacedAnswer]]
_SEARCHES: Mapping[OutputPlace, _Search] = {
    "package": _of_package,
    "parameter": _of_parameter,
    "traceback": _of_traceback,
    "module": _of_module,
    "programs": _of_programs,
    "spaced path": _of_spaced_path,
}
