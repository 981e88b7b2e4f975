"""Files: the paths that launch files, xacro and YAML name, and whether a build installs a file
there.
"""

import posixpath
import re
from collections.abc import Iterator
from typing import NamedTuple

from grader.base.names import closest, near
from grader.base.source import Location
from grader.ros.build.installation import Installation
from grader.ros.build.places import PREFIX, SHARE
from grader.ros.known.known import known
from grader.ros.launch.launch_model import Launch
from grader.ros.package.installed_files import (
    are_installs_known,
    is_surely_absent,
    look_up,
    share_parts,
)
from grader.ros.package.package import Package
from grader.ros.workspace.names import Compared, Correction, Fact, Mismatch, Undecided, corrections
from grader.ros.workspace.workspace import Workspace

# A path ends at a quote, a tag or a space, in YAML's flow style and in a substitution also at a
# comma or a bracket.
_FIND = re.compile(
    r"\$\(find(?:-pkg-share)? ([\w-]+)\)/?((?:[^\"'<>\s$,()[\]{}]|,(?=\w))*)(?=[\"'<\s,)\]}])"
)
_PACKAGE = re.compile(r"package://([\w-]+)/([\w./-]+)(?=[\"'<\s,\]}])")
_PATH = re.compile(rf"{re.escape(SHARE)}/[^\s'\",\x00]+")


def file_facts(workspace: Workspace) -> Iterator[Fact]:
    """Yield the paths at which a build of the workspace installs no file."""
    seen: set[tuple[str, Location]] = set()
    for package, path, at, is_read, is_output in _named(workspace):
        yield Compared("files", posixpath.normpath(path).removeprefix(f"{PREFIX}/"))
        if (path, at) not in seen:
            seen.add((path, at))
            for fact in _fault_of(workspace, package, path, at, is_output=is_output):
                yield (
                    fact._replace(is_sure=fact.is_sure and is_read)
                    if isinstance(fact, Mismatch)
                    else fact
                )
    yield from _map_images(workspace)
    yield from _models(workspace)


class _Named(NamedTuple):
    """A path below the prefix, with the package whose file names it, and whether it is certainly
    looked for.

    `is_output`: whether an own node, which is given the path, may write the file.
    """

    package: Package
    path: str
    location: Location
    is_read: bool
    is_output: bool = False


def _named(workspace: Workspace) -> Iterator[_Named]:
    """Yield the paths that are named."""
    for package, own, launch in workspace.launches:
        # From the folder of the sources, a launch file finds what is beside it.
        if own in package.installed.values():
            beside = ""
        else:
            beside = f"{package.share}{posixpath.dirname(own)}/"
        for text, at, is_read, is_output in _texts_of(workspace, launch):
            for path in _PATH.findall(text or ""):
                is_beside = bool(beside) and path.startswith(f"{PREFIX}/{beside}")
                yield _Named(package, path, at, is_read and not is_beside, is_output)
    for package in workspace.packages:
        for source in workspace.sources_of(package, (".xacro", ".urdf", ".yaml")):
            of_robot = source.path.endswith(".yaml") or source.path in (
                workspace.robot_files or (source.path,)
            )
            for found in (*_FIND.finditer(source.text), *_PACKAGE.finditer(source.text)):
                yield _Named(
                    package, f"{SHARE}/{found[1]}/{found[2]}", source.at(found.start()), of_robot
                )


def _texts_of(
    workspace: Workspace, launch: Launch
) -> Iterator[tuple[str | None, Location, bool, bool]]:
    """Yield the texts of a launch file that may name files, whether they are used, and whether own
    nodes get them.
    """
    for passed in launch.passed:
        for _, value in passed.values:
            yield (value, passed.location, True, False)
    for node in launch.nodes:
        # The launch file that includes it may never start it, whatever the arguments.
        is_read = node.when is not False or not node.included_by
        is_own = workspace.package_of(node) is not None
        yield from ((word, node.location, is_read, is_own) for word in node.arguments or ())
        for given in node.parameters or ():
            yield given.path, given.location, is_read, False
            values = (it for it in given.values.values() if isinstance(it.value, str))
            yield from ((it.value, it.location, is_read, is_own) for it in values)
    for reference in launch.references:
        yield (reference.path, reference.location, True, False)


def _fault_of(
    workspace: Workspace, package: Package, path: str, at: Location, *, is_output: bool
) -> Iterator[Fact]:
    """Yield that no file is installed at a path, if this is certain."""
    name, rest = share_parts(path)
    owner = package.find(name)
    if owner is None:
        meant = near(name, [it.name for it in workspace.packages])
        if meant is not None and not package.depends_on(name):
            message = f"there is no package {name!r}; did you mean {meant!r}?"
            yield Mismatch("files", message, at, corrections=corrections(name, at, meant))
        return
    target = f"share/{name}/{rest}"
    if (
        not rest
        or rest in known()["written"]
        or target in owner.installed
        or any(it.startswith(f"{target}/") for it in owner.installed)
    ):
        return
    if not workspace.means_one(package, name):
        yield Undecided("files", f"several packages are named {name!r}")
        return
    if not are_installs_known(owner):
        yield Undecided("files", f"whether a build installs {target} is not evaluated")
        return
    inside = target.removeprefix(owner.share)
    if inside in owner.tree.folders:
        yield from _no_folder(owner, inside, f"a build installs no {target}", at)
    else:
        yield _not_there(owner, target, at, is_output=is_output)


def _not_there(owner: Package, target: str, at: Location, *, is_output: bool) -> Mismatch:
    """Return where else a build installs a file, or what the package has instead of it."""
    setup, name = owner.installation, posixpath.basename(target)
    assert setup is not None
    start = Location(setup.source.path, 1, 1)
    found, missing = look_up(owner, target), f"a build installs no {target}"
    if found.state == "elsewhere":
        message = f"{missing}: it installs the file as {found.path}"
        return Mismatch(
            "files", message, at, corrections=_of_folders(target, found.path, at, start)
        )
    if found.state == "not installed":
        either, called_at = _of_install(setup, found.path, start), setup.location(setup.called_at)
        return Mismatch(
            "files",
            f"{missing}: no {setup.entry} names {found.path}",
            at,
            called_at,
            corrections=either,
        )
    meant = closest(name, map(posixpath.basename, owner.tree.files))
    guess = f"; did you mean {meant!r}?" if meant else ""
    message = f"{missing}: the package has no file {name!r}{guess}"
    is_sure = is_surely_absent(owner, target) and not is_output
    return Mismatch("files", message, at, None, is_sure, corrections(name, at, meant))


def _no_folder(owner: Package, inside: str, missing: str, at: Location) -> Iterator[Mismatch]:
    """Yield where else a build installs what is in a folder, if anywhere. CMake also makes folders
    that stay empty.
    """
    setup = owner.installation
    assert setup is not None
    other = next((it for it in owner.installed.items() if it[1].startswith(f"{inside}/")), None)
    may_be_made = setup.is_cmake and posixpath.basename(inside) in setup.source.text
    if other is not None:
        message = f"{missing}: it installs {other[1]} as {other[0]}"
        yield Mismatch("files", message, at, is_sure=not may_be_made)
    elif not may_be_made:
        yield Mismatch("files", f"{missing}: it installs no file of the folder {inside}", at)


def _of_folders(
    target: str, elsewhere: str, at: Location, start: Location
) -> tuple[Correction, ...]:
    """Return the correction of the one folder in which a path differs from that at which the file
    is installed.
    """
    if target.count("/") != elsewhere.count("/"):
        return ()
    pairs = [
        it for it in zip(target.split("/"), elsewhere.split("/"), strict=True) if it[0] != it[1]
    ]
    if len(pairs) == 1:
        return corrections(pairs[0][0], at, pairs[0][1], start)
    return ()


def _of_install(setup: Installation, own: str, start: Location) -> tuple[Correction, ...]:
    """Return the correction of a path in setup.py or CMakeLists.txt that does not exist, into one
    that has the file.
    """
    wrong = [it.path for it in setup.stops] + [posixpath.dirname(it.pattern) for it in setup.empty]
    pairs = ((path.rstrip("/"), closest(path, [own, posixpath.dirname(own)])) for path in wrong)
    return next((corrections(path, start, meant) for path, meant in pairs if meant is not None), ())


def _map_images(workspace: Workspace) -> Iterator[Fact]:
    """Yield the images of maps that are not there."""
    for path, tree in workspace.trees:
        image = tree.get("image")
        if (
            image is None
            or not image.text
            or tree.get("resolution") is None
            or image.text.startswith("/")
        ):
            continue
        wanted = posixpath.normpath(posixpath.join(posixpath.dirname(path), image.text))
        files = workspace.tree.files
        if wanted not in files:
            folder = posixpath.dirname(wanted)
            meant = closest(
                posixpath.basename(wanted),
                [posixpath.basename(it) for it in files if posixpath.dirname(it) == folder],
            )
            guess = f"; did you mean {meant!r}?" if meant else ""
            message = f"the image of the map, {image.text!r}, does not exist{guess}"
            either = corrections(posixpath.basename(wanted), image.location, meant)
            yield Mismatch("files", message, image.location, corrections=either)


def _models(workspace: Workspace) -> Iterator[Fact]:
    """Yield models that worlds include, and whose names are similar to those of the workspace."""
    files = [path for package in workspace.packages for path in package.tree.files]
    models = {
        posixpath.basename(posixpath.dirname(it))
        for it in files
        if it.endswith(("/model.sdf", "/model.config"))
    }
    for file in workspace.sdf_files:
        for element in file.root.iter("uri"):
            name = (element.text or "").strip().removeprefix("model://").partition("/")[0]
            if (element.text or "").strip().startswith("model://"):
                meant = near(name, models)
            else:
                meant = None
            if meant is not None and name not in models:
                at = file.location(element)
                message = f"there is no model {name!r}; did you mean {meant!r}?"
                yield Mismatch("files", message, at, corrections=corrections(name, at, meant))
