"""Files that no other file names.

They are parameters that no node gets, and parts of a robot that nothing includes.
"""

from collections import Counter
from collections.abc import Collection, Iterator, Mapping
from posixpath import basename, dirname, splitext

from grader.base.patterns import on_use
from grader.base.source import Location, Source
from grader.files.tree import Tree
from grader.ros.package.made_paths import MadePath, made_paths
from grader.ros.package.package import Package
from grader.workspace.model.workspace import Workspace

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
_TEXTS_BY_NAME = ("Dockerfile", "Makefile", "justfile", "CMakeLists.txt")
# Those that may make a path of variables.
_MAKERS = (*(kind for kind in _TEXTS if kind not in (".md", ".rviz", ".json")), "CMakeLists.txt")
_MAX_TEXT = 512 * 1024  # bytes
_WORD = on_use(rb"[\w-]+")
_BY_USUAL_NAMES = b"moveit_configs_utils"  # it finds the files of a package by their usual names
_OF_MAP = frozenset(
    {b"image", b"resolution"}
)  # the keys of a map, which is chosen when the robot starts


def unused_files(workspace: Workspace) -> Iterator[Location]:
    """Yield the installed files whose names no other file of the workspace has.

    A name is compared with or without the ending. Other files may also make it of variables. The
    files beside one whose name is the default of a launch argument are the other choices.
    """
    unnamed = [*_unnamed(workspace)]
    made = {*_made(workspace)} if unnamed else set()
    offered = {*_offered(workspace)} if unnamed else set()
    for path in unnamed:
        kind = (dirname(path), splitext(path)[1])
        if kind not in offered and not any(pattern.matches(path) for pattern in made):
            yield Location(path, 1, 1)


def _offered(workspace: Workspace) -> Iterator[tuple[str, str]]:
    """Yield the folders and endings of files whose names are values of launch arguments.

    A value that is a whole path says nothing of other files.
    """
    names = set()
    for launch in workspace.launches.every:
        names |= {value for _, value in launch.values if value.endswith(_KINDS)}
    names = {name for name in names if not name.startswith("/")}
    for package in workspace.packages if names else ():
        for path in _installed_data(package):
            workspace.charge(len(names))
            if any(f"/{path}".endswith(f"/{name}") for name in names):
                folder = dirname(package.path(path))
                yield folder, splitext(path)[1]


def _unnamed(workspace: Workspace) -> Iterator[str]:
    """Yield the paths of the installed files whose names no other file has."""
    words = _words_of_files(workspace)
    counts: Counter[bytes] = Counter()
    configured: set[bytes] = set()  # the words of files that look for others by their usual names
    for words_of_file in words.values():
        counts.update(words_of_file)
        if _BY_USUAL_NAMES in words_of_file:
            configured |= words_of_file
    for package in workspace.packages:
        files = [package.path(path) for path in package.tree.files]
        is_configured = package.name.encode() in configured
        if is_configured or any(_BY_USUAL_NAMES in words.get(file, ()) for file in files):
            continue
        for path in _installed_data(package):
            own_words = words.get(package.path(path), frozenset())
            is_map = own_words >= _OF_MAP
            if not is_map and not _is_named(path, own_words, counts):
                yield package.path(path)


def _installed_data(package: Package) -> list[str]:
    """Return the installed files of the kinds that other files name, without those of tests."""
    paths = {*package.installed.values()} - {*package.launch_files}
    return [
        path for path in sorted(paths) if path.endswith(_KINDS) and "test" not in path.split("/")
    ]


def _is_named(path: str, words: Collection[bytes], counts: Mapping[bytes, int]) -> bool:
    """Return whether another file than that with these words has the name of one."""
    stem = basename(path).partition(".")[0].encode()
    return counts[stem] > (stem in words)


def _made(workspace: Workspace) -> Iterator[MadePath]:
    """Yield the ends of the paths that texts of the workspace make of variables."""
    for source in workspace.texts.every_source(_MAKERS):
        yield from workspace.folder.recall(_made_in, source.path, source.text)


def _made_in(path: str, text: str) -> list[MadePath]:
    return [*made_paths(Source(path, text))]


def _words_of_files(workspace: Workspace) -> dict[str, frozenset[bytes]]:
    """Return the words of each text, also of those outside of packages."""
    words = {}
    for package in workspace.packages:
        for path in package.tree.files:
            data = _text(package.tree, path)
            if data is not None:
                words[package.path(path)] = workspace.folder.recall(_words, data)
    for path in workspace.tree.files:
        data = _text(workspace.tree, path) if path not in words else None
        if data is not None:
            words[path] = workspace.folder.recall(_words, data)
    return words


def _text(tree: Tree, path: str) -> bytes | None:
    """Return the bytes of a file that is a text; None for another one."""
    is_text = path.endswith(_TEXTS) or basename(path) in _TEXTS_BY_NAME
    return tree.read(path, _MAX_TEXT) if is_text else None


def _words(data: bytes) -> frozenset[bytes]:
    return frozenset(_WORD.findall(data))
