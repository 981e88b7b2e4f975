"""Files that are missing or named otherwise than in the reference, and the name of the package in all its files."""

import posixpath
import re
from collections.abc import Iterator, Mapping, Sequence

from grader.edits import Proposal
from grader.names import closest
from grader.package.edits.task import PackageTask, change, kind_of
from grader.package.launch.places import is_launch_named
from grader.package.package import MANIFEST, SETUP
from grader.source import Edit

WHAT = {"launch": "the launch file", "rviz": "the RViz file", "urdf": "the URDF"}
_MAX_NAMES = 2  # of files that may be the one that is meant
_MAX_LAUNCH_FILES = 3


def file_proposals(task: PackageTask, kind: str) -> Iterator[Proposal]:
    """Yield edits that give a file the name that it has in the reference, or create it."""
    likes = {task.named(path): path for path in (task.reference.tree.files if task.reference is not None else ())}
    names = {posixpath.basename(path) for path in likes} | task.given
    wanted = {path: like for path, like in likes.items() if kind_of(path) == kind}
    for path in wanted:
        folder, name = posixpath.split(path)
        if any(_is_named(it, name, kind) for it in task.files):
            continue
        own = [it for it in task.files if kind in (kind_of(it), posixpath.dirname(it)) or it.startswith(f"{folder}/")]
        yield from _renamed(task, kind, name, [it for it in own if posixpath.basename(it) not in names])
        if path not in task.files and kind != "urdf" and (path == kind or SETUP in task.files):
            what = WHAT.get(kind, kind if path == kind else "a file of the resource index")
            yield change(_created(task, path, wanted), "create", what)


def _created(task: PackageTask, path: str, wanted: Mapping[str, str]) -> list[Edit]:
    """Return the edits that create a file of the reference; with setup.py the other files that it needs."""
    needed = [path, *(other for other in wanted if path == SETUP != other)]
    return [edit for new in needed for edit in task.created(new, wanted[new])]


def _is_named(path: str, name: str, kind: str) -> bool:
    return posixpath.basename(path) == name or (kind == "launch" and is_launch_named(path, name))


def _renamed(task: PackageTask, kind: str, name: str, files: Sequence[str]) -> Iterator[Proposal]:
    """Yield edits that give one of these files a name: the one with the most similar name first."""
    spare = {posixpath.basename(it): it for it in files}
    for other in dict.fromkeys([*filter(None, [closest(name, spare)]), *[*spare][:_MAX_NAMES]]):
        new = posixpath.join(posixpath.dirname(spare[other]), name)
        yield change([task.renamed(spare[other], new)], "file", WHAT.get(kind, "a file"))


def package_names(task: PackageTask, new: str) -> Iterator[Proposal]:
    """Yield edits that give the package one name in all its files, for a package that has another or several."""
    manifest, setup = task.package.manifest, task.package.setup
    if manifest is None or manifest.name is None:
        return
    shares = [path.split("/")[1] for path in task.package.installed if path.startswith("share/")]
    others = [name for name in shares if closest(name, [new])]
    names = dict.fromkeys([manifest.name, *([setup.name] if setup and setup.name else []), *others])
    names.pop(new, None)
    word = re.compile(rf"(?<![\w.])({'|'.join(map(re.escape, names))})(?![\w.])")
    edits: list[Edit] = []
    for path in (MANIFEST, SETUP, "setup.cfg", *task.package.launch_files[:_MAX_LAUNCH_FILES]) if names else ():
        source = task.source(path)
        edits += [source.edit(*it.span(), new) for it in word.finditer(source.text)] if source is not None else []
    moved = [task.renamed(f"resource/{old}", f"resource/{new}") for old in names if f"resource/{old}" in task.files]
    edits += moved if f"resource/{new}" not in task.files else []
    yield change(edits, "set", "the name of the package")
