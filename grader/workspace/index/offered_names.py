"""The names of robots, packages and launches that may be written at a place."""

import re
from collections.abc import Iterable

from grader.base.patterns import on_use
from grader.base.source import Location
from grader.ros.known.package_rows import (
    find_programs,
    known_packages,
    launch_arguments,
    package_row,
)
from grader.ros.known.parameter_rows import find_rows
from grader.ros.known.parameter_texts import row_text
from grader.ros.known.released import find_releases, released_packages
from grader.ros.launch.launch_model import StartedNode
from grader.ros.nodes.node_facts import NodeFacts
from grader.workspace.graph.graph import make_graph
from grader.workspace.graph.started_controllers import defined_controllers
from grader.workspace.index.all_names import read_names
from grader.workspace.index.offers import (
    GOOD,
    POSSIBLE,
    UNLIKELY,
    Offer,
    Offers,
    offer_released,
    offers,
    package_at,
)
from grader.workspace.index.typed_places import TypedPlace
from grader.workspace.model.launches import SPAWNERS
from grader.workspace.model.workspace import Workspace

_SHARE = on_use(
    r"(?:get_package_share_(?:directory|path)|FindPackageShare)\s*\(\s*(?:package\s*=\s*)?"
    r"[\"'](?P<package>[\w.-]+)[\"']"
)
_LAUNCH_FILE = on_use(r"(?<![\w.-])[\w.-]+(?:launch\.(?:py|xml|ya?ml)|_launch\.py)")
_MIN_TYPED = 2  # letters, before all released packages are offered


def defined(workspace: Workspace, place: TypedPlace, kind: str, owner: str = "") -> Offers:
    """Yield the definitions of a kind in a workspace, first those of the file of a place.

    With an owner, they are those whose owner's name ends so.
    """
    for name in read_names(workspace).names:
        if name.kind == kind and name.role == "definition" and name.owner.endswith(owner):
            where = f"defined at {name.location.file_and_line}"
            yield Offer(name.name, kind, where, int(name.location.path != place.path))


def find_frames(workspace: Workspace, place: TypedPlace) -> Offers:
    """Yield the frames that something publishes, first those that no other one places."""
    for graph in make_graph(workspace).launched:
        children = {sent.child for sent in graph.transforms}
        for sent in graph.transforms:
            for frame in (sent.parent, sent.child):
                yield Offer(frame, "frame", f"published by {sent.by}", int(frame in children))
    for kind in ("frame", "link"):
        yield from defined(workspace, place, kind)


# --- Packages


def find_packages(workspace: Workspace, place: TypedPlace) -> Offers:
    """Yield packages: those of the workspace, those that package.xml names, and then others."""
    package = package_at(workspace, place.path)
    manifest = package.manifest if package else None
    yield from offers(workspace.own_packages, "package of the workspace")
    ranks = dict.fromkeys(known_packages(), POSSIBLE)
    ranks |= dict.fromkeys(manifest.dependencies if manifest is not None else (), GOOD)
    if len(place.typed) >= _MIN_TYPED:
        for name in released_packages():
            if name.startswith(place.typed):
                ranks.setdefault(name, UNLIKELY)
    for name, rank in ranks.items():
        yield offer_released(workspace, name, "package", find_releases(name), rank)


def find_files(workspace: Workspace, place: TypedPlace) -> Offers:
    """Yield the files of the package that is named before, below the folders that are written."""
    given = place.levels[0].given
    owner = given.get("package", "")
    below = ""
    if not owner:
        share = _SHARE.search(_read_assigned(place, given.get("0", "")))
        owner = share["package"] if share else ""
        folders = [given[key] for key in sorted(given) if "0" < key < place.levels[0].slot]
        below = "".join(f"{folder.strip('/')}/" for folder in folders)
    package = workspace.own_packages.get(owner)
    if package:
        start = f"{package.share}{below}"
        paths = [path for path in package.installed if path.startswith(start)]
        yield from offers((path.removeprefix(start) for path in paths), f"file of {owner}")


def _read_assigned(place: TypedPlace, written: str) -> str:
    """Return what is assigned to a variable in a file of Python; other expressions as they are."""
    if not written.isidentifier():
        return written
    assigned = re.search(rf"\b{written}\s*=[^=][^\n]*(?:\n\s[^\n]*){{0,3}}", place.text)
    return assigned[0] if assigned else ""


def find_programs_at(workspace: Workspace, place: TypedPlace) -> Offers:
    """Yield the programs of the package that is named beside."""
    owner = place.given("package", "pkg")
    known = (*find_programs(owner), *package_row(owner).program)
    yield from offers(known, f"program of {owner}")
    yield from defined(workspace, place, "program", owner)


# --- Launches


def find_included_arguments(workspace: Workspace, place: TypedPlace) -> Offers:
    """Yield the arguments of the launch file that is included around a place."""
    source = place.given("launch_description_source", "0")
    written = place.given("file") or _read_assigned(place, source)
    for name in _LAUNCH_FILE.findall(written):
        for path, arguments in launch_arguments().items():
            if path.endswith(f"/{name}"):
                yield from offers(arguments, f"argument of {path}")
        yield from defined(workspace, place, "launch argument", f"/{name}")


def find_controllers(workspace: Workspace, place: TypedPlace) -> Offers:
    """Return the controllers that a spawner may start."""
    if place.given("executable", "exec") in ("", *SPAWNERS):
        return defined(workspace, place, "controller")
    return ()


def topics_of_controllers(workspace: Workspace) -> Offers:
    """Yield the topics of controllers, as remappings replace them."""
    for controller in defined_controllers(workspace):
        row = controller.row
        for name, message in {**row.subscriptions, **row.publishers}.items():
            yield Offer(f"/{controller.name}/{name}", message)


def started_node(place: TypedPlace) -> StartedNode:
    """Return the node that is started around a place, by its package and program."""
    package = place.given("package", "pkg")
    program = place.given("executable", "exec", "plugin")
    return StartedNode(package, program, True, Location(place.path, 1, 1))


# --- Parameters


def find_program_parameters(workspace: Workspace, place: TypedPlace) -> Offers:
    """Yield the parameters of the program that is started around a place."""
    started = started_node(place)
    yield from declared_by(workspace.code.find_nodes(started))
    yield from known_parameters(workspace, started.program_path, "")
    yield Offer("use_sim_time", "parameter of each node", rank=GOOD)


def declared_by(nodes: Iterable[NodeFacts]) -> Offers:
    """Yield the parameters that nodes of the workspace declare."""
    for facts in nodes:
        for parameter in facts.parameters:
            if parameter.is_declared:
                text = f"declared at {parameter.location.file_and_line}"
                if parameter.default is not None:
                    text = f"default: {parameter.default}\n{text}"
                yield Offer(parameter.name or "", "parameter", text)


def known_parameters(workspace: Workspace, node: str, prefix: str) -> Offers:
    """Yield the keys below a prefix of the parameters of a well-known node.

    A prefix is the keys of tables, each with a dot.
    """
    release = workspace.releases[0] if len(workspace.releases) == 1 else None
    for row in find_rows(node, release):
        key, rest = _key_behind(row.name, prefix)
        text = "" if rest else row_text(row, release or row.until)
        yield Offer(key, f"parameter of {node}", text, int(not row.is_required))


def _key_behind(name: str, prefix: str) -> tuple[str, str]:
    """Return the part of a parameter's name behind a prefix, and what follows.

    They are empty where the name does not begin so, or where any key may be.
    """
    tables = prefix.split(".")[:-1]
    parts = name.split(".")
    pairs = zip(tables, parts, strict=False)
    is_below = all(part == table or part.startswith("<") for table, part in pairs)
    key = parts[len(tables)] if is_below and len(parts) > len(tables) else "<"
    return ("", "") if key.startswith("<") else (key, ".".join(parts[len(tables) + 1 :]))
