"""Files that no other file names: parameters that no node gets, parts of a robot that nothing
includes.
"""

import posixpath
import re
from collections import Counter
from collections.abc import Iterator

from grader.base.source import Location
from grader.ros.package.package import Package
from grader.ros.workspace.workspace import Workspace

_KINDS = (".yaml", ".yml", ".xacro", ".urdf", ".rviz", ".srdf")
_TEXTS = (
    *_KINDS,
    ".py",
    ".xml",
    ".launch",
    ".txt",
    ".cpp",
    ".hpp",
    ".cc",
    ".h",
    ".md",
    ".sh",
    ".json",
    ".sdf",
    ".world",
)
_MAX_TEXT = 512 * 1024  # bytes
_WORD = re.compile(rb"[\w-]+")
_BY_USUAL_NAMES = b"moveit_configs_utils"  # it finds the files of a package by their usual names
_OF_MAP = frozenset(
    {b"image", b"resolution"}
)  # the keys of a map, which is chosen when the robot starts


def unused_files(workspace: Workspace) -> Iterator[Location]:
    """Yield the installed files whose names no other file of the workspace has, with or without the
    ending.
    """
    words: dict[str, frozenset[bytes]] = {}
    for package in workspace.packages:
        words.update(_words(package))
    counts: Counter[bytes] = Counter()
    for words_of_file in words.values():
        counts.update(words_of_file)
    for package in workspace.packages:
        files = [package.path(path) for path in package.tree.files]
        if any(_BY_USUAL_NAMES in words.get(file, ()) for file in files):
            continue
        for path in sorted({*package.installed.values()} - {*package.launch_files}):
            if not path.endswith(_KINDS) or "test" in path.split("/"):
                continue
            own_words = words.get(package.path(path), frozenset())
            stem = posixpath.basename(path).partition(".")[0].encode()
            is_named = counts[stem] > (stem in own_words)
            if not is_named and not own_words >= _OF_MAP:
                yield Location(package.path(path), 1, 1)


def _words(package: Package) -> Iterator[tuple[str, frozenset[bytes]]]:
    """Yield the words of each text of a package."""
    for path in package.tree.files:
        data = package.tree.read(path, _MAX_TEXT) if path.endswith(_TEXTS) else None
        if data is not None:
            yield package.path(path), frozenset(_WORD.findall(data))
