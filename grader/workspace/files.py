"""Files: the paths that launch files, xacro and YAML name, and whether a build installs a file there."""

import posixpath
import re
from collections.abc import Iterator

from grader.names import closest, near
from grader.package.launch.model import Launch
from grader.package.launch.places import PREFIX, SHARE
from grader.package.package import Package
from grader.source import Location
from grader.workspace.names import Compared, Fact, Mismatch, Undecided
from grader.workspace.workspace import Workspace

_FIND = re.compile(r"\$\(find(?:-pkg-share)? ([\w-]+)\)/?([^\"'<>\s$]*)(?=[\"'<\s])")
_PACKAGE = re.compile(r"package://([\w-]+)/([\w./-]+)(?=[\"'<\s])")
_PATH = re.compile(rf"{re.escape(SHARE)}/[^\s'\",\x00]+")


def file_facts(workspace: Workspace) -> Iterator[Fact]:
    """Yield the paths at which a build of the workspace installs no file."""
    seen: set[tuple[str, Location]] = set()
    for package, path, at in _named(workspace):
        yield Compared("files", posixpath.normpath(path).removeprefix(f"{PREFIX}/"))
        if (path, at) not in seen:
            seen.add((path, at))
            yield from _fault_of(workspace, package, path, at)
    yield from _map_images(workspace)


def _named(workspace: Workspace) -> Iterator[tuple[Package, str, Location]]:
    """Yield the paths that are named, below the prefix, with the package whose file names each."""
    for package, _, launch in workspace.launches:
        for text, at in _texts_of(launch):
            yield from ((package, path, at) for path in _PATH.findall(text or ""))
    for package in workspace.packages:
        for source in workspace.sources_of(package, (".xacro", ".urdf", ".yaml")):
            for found in (*_FIND.finditer(source.text), *_PACKAGE.finditer(source.text)):
                yield package, f"{SHARE}/{found[1]}/{found[2]}", source.at(found.start())


def _texts_of(launch: Launch) -> Iterator[tuple[str | None, Location]]:
    """Yield the texts of a launch file that may name files."""
    yield from ((reference.path, reference.location) for reference in launch.references)
    yield from ((value, passed.location) for passed in launch.passed for _, value in passed.values)
    for node in launch.nodes:
        yield from ((word, node.location) for word in node.arguments or ())
        for given in node.parameters or ():
            yield given.path, given.location
            values = (it for it in given.values.values() if isinstance(it.value, str))
            yield from ((it.value, it.location) for it in values)


def _fault_of(workspace: Workspace, package: Package, path: str, at: Location) -> Iterator[Fact]:
    """Yield that no file is installed at a path, if this is certain."""
    name, _, rest = posixpath.normpath(path).removeprefix(f"{SHARE}/").partition("/")
    owner = package.find(name)
    if owner is None:
        meant = near(name, [it.name for it in workspace.packages])
        if meant is not None and not package.depends_on(name):
            yield Mismatch("files", f"there is no package {name!r}; did you mean {meant!r}?", at)
        return
    target, setup = f"share/{name}/{rest}", owner.installation
    if not rest or target in owner.installed or any(it.startswith(f"{target}/") for it in owner.installed):
        return
    if setup is None or setup.fault is not None or setup.unknown:
        yield Undecided("files", f"cannot determine statically whether a build installs {target}")
        return
    yield _not_there(owner, target, at)


def _not_there(owner: Package, target: str, at: Location) -> Mismatch:
    """Return where else a build installs a file, or what the package has instead of it."""
    setup, name = owner.installation, posixpath.basename(target)
    assert setup is not None
    elsewhere = next((it for it in owner.installed if posixpath.basename(it) == name), None)
    own = next((it for it in owner.tree.files if posixpath.basename(it) == name), None)
    looked = f"{target} is looked for, but"
    if elsewhere is not None:
        return Mismatch("files", f"{looked} a build installs it as {elsewhere}", at)
    if own is not None:
        message = f"{looked} a build does not install {own}: no {setup.entry} names it"
        return Mismatch("files", message, at, setup.location(setup.called_at))
    meant = closest(name, map(posixpath.basename, owner.tree.files))
    guess = f"; did you mean {meant!r}?" if meant else ""
    # A file that a program writes is in a folder of its own, and like no other.
    folders = {posixpath.dirname(it) for it in owner.installed}
    is_sure = meant is not None or posixpath.dirname(target) in folders
    return Mismatch("files", f"{looked} the package has no file {name!r}{guess}", at, is_sure=is_sure)


def _map_images(workspace: Workspace) -> Iterator[Fact]:
    """Yield the images of maps that are not there."""
    for path, tree in workspace.trees:
        image = tree.get("image")
        if image is None or not image.text or tree.get("resolution") is None or image.text.startswith("/"):
            continue
        wanted = posixpath.normpath(posixpath.join(posixpath.dirname(path), image.text))
        files = workspace.submission.whole_tree.files
        if wanted not in files:
            folder = posixpath.dirname(wanted)
            meant = closest(
                posixpath.basename(wanted), [posixpath.basename(it) for it in files if posixpath.dirname(it) == folder]
            )
            guess = f"; did you mean {meant!r}?" if meant else ""
            yield Mismatch("files", f"the image of the map, {image.text!r}, does not exist{guess}", image.location)
