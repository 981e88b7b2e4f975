"""The texts of packages in which names are searched, and XML files of Gazebo and MoveIt."""

import posixpath
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from functools import cache, cached_property

from grader.base.errors import InputError
from grader.base.grouping import Strings
from grader.base.patterns import on_use
from grader.base.records import Record
from grader.base.source import Source
from grader.base.text import comment_spans
from grader.files.tree import parents
from grader.ros.installation.places import is_launch_file
from grader.ros.package.package import Package
from grader.ros.xml.parsing import XmlFault, XmlFile
from grader.workspace.model.code_text import is_script
from grader.workspace.model.workspace_folder import WorkspaceFolder

CPP_ENDINGS = (".cpp", ".cc", ".cxx", ".c", ".hpp", ".hh", ".hxx", ".ipp", ".tpp", ".h")
CODE_ENDINGS = (".py", *CPP_ENDINGS)
_MAX_FILES = 60  # of one kind in a package
# What is charged as one part: names of files that are compared, and characters of a text in which
# something is searched.
FILES_A_PART = 8
_SEARCHED_A_PART = 512
MAX_YAML = 512 * 1024  # bytes
_TEXTS = (".yaml", ".yml", ".urdf", ".xacro", ".srdf", ".sdf", ".world", ".rviz", ".py", ".xml")
_OWN_FOLDERS = frozenset({"config", "launch", "maps", "params", "rviz", "urdf", "worlds"})
_PROGRAMS = (".py", ".cpp", ".cc", ".hpp", ".sh", "CMakeLists.txt")
_WITH_LINES = (".yaml", ".yml", ".py")  # files whose comments begin with #
_COMMENT_LINE = on_use(r"(?:^|(?<=\s))#[^\n]*")


class TextFiles(Record):
    """The texts of the files of packages, and the XML files of Gazebo and MoveIt.

    Names are searched in the texts. Each file is read once.
    """

    folder: WorkspaceFolder

    @cached_property
    def sdf_files(self) -> tuple[XmlFile, ...]:
        """The models and worlds of Gazebo that can be read."""
        return tuple(self._xml_files((".sdf", ".world")))

    @cached_property
    def srdf_files(self) -> tuple[XmlFile, ...]:
        """The descriptions of robots for MoveIt that can be read."""
        return tuple(self._xml_files((".srdf",)))

    def _xml_files(self, endings: Strings) -> Iterator[XmlFile]:
        for package in self.folder.packages:
            for path in [file for file in package.tree.files if file.endswith(endings)][
                :_MAX_FILES
            ]:
                with suppress(InputError, XmlFault):
                    data = package.tree.files[path].read(MAX_YAML)
                    yield XmlFile(data, Source(package.path(path), data.decode("utf-8", "replace")))

    def read_sources(self, package: Package, endings: Strings) -> Iterator[Source]:
        """Yield the texts of the files of a package with these endings, without those of tests."""
        return self._sources(package, self._paths(package, endings))

    def every_source(self, endings: Strings) -> Iterator[Source]:
        """Yield the same of all packages that are built."""
        for package in self.folder.packages:
            yield from self.read_sources(package, endings)

    def launch_sources(self, package: Package) -> Iterator[Source]:
        """Yield the texts of the launch files of a package."""
        return self._sources(package, package.launch_files)

    def _sources(self, package: Package, paths: Iterable[str]) -> Iterator[Source]:
        for path in read_paths(package, paths):
            source = self._read_text(package, path)
            if source:
                self.folder.charge(1 + len(source.text) // _SEARCHED_A_PART)
                yield source

    @cached_property
    def _paths(self) -> Callable[[Package, Strings], Sequence[str]]:
        """The paths of the files of a package with some endings, searched once."""
        return cache(_paths_ending)

    @cached_property
    def _read_text(self) -> Callable[[Package, str], Source | None]:
        """A reader of texts without comments that reads each once."""
        return cache(_without_comments)

    @cached_property
    def launch_texts(self) -> Strings:
        """The texts of the launch files, of those of ROS 1 too."""
        sources: list[Source] = []
        for package in self.folder.packages:
            sources += self._sources(package, package.launch_files)
        sources += self.every_source((".launch",))
        return tuple(source.text for source in sources)

    def searched_launch_texts(self) -> Strings:
        """Return the texts of the launch files, to search something in each. Raises NotDecided."""
        self.folder.charge(1 + sum(map(len, self.launch_texts)) // _SEARCHED_A_PART)
        return self.launch_texts

    def loose_texts(self, endings: Strings) -> Iterator[str]:
        """Yield the texts of the files with these endings that are in no package, as a README."""
        folders = tuple(package.path("") for package in self.folder.found_packages)
        paths = [path for path in self.folder.tree.files if path.endswith(endings)]
        loose = [path for path in paths if not path.startswith(folders)]
        for path in loose[:_MAX_FILES]:
            data = self.folder.tree.read(path, MAX_YAML) or b""
            self.folder.charge(1 + len(data) // _SEARCHED_A_PART)
            yield data.decode("utf-8", "replace")

    @cached_property
    def _provisions(self) -> tuple[str, str]:
        """What .repos files, .gitmodules and YAML for rosdep say, and what a README and images say.

        Each is one text in small letters, in which - is written as _.
        """
        sources: list[str] = []
        words: list[str] = []
        files = [*self.folder.tree.files.values(), *self.folder.tree.settings()]
        for file in files:
            name = file.name.lower()
            is_source = file.suffix in (".repos", ".rosinstall") or name == ".gitmodules"
            is_source = is_source or ("rosdep" in name and name.endswith((".yaml", ".yml")))
            is_word = name.startswith("readme") or "dockerfile" in name
            is_word = is_word or file.suffix in (".md", ".rst", ".sh", ".bash")
            if (not is_source and not is_word) or file.size > MAX_YAML:
                continue
            with suppress(InputError):
                text = file.read(MAX_YAML).decode("utf-8", "replace")
                self.folder.charge(1 + len(text) // _SEARCHED_A_PART)
                (sources if is_source else words).append(text)
        return _as_words(sources), _as_words(words)

    def is_provided(self, name: str, *, in_words: bool = False) -> bool:
        """Return whether a .repos file, .gitmodules or YAML for rosdep names a package.

        With `in_words`, a README, a script or an image may name it as well.
        """
        sources, words = self._provisions
        wanted = re.compile(rf"\b{re.escape(_as_words([name]))}\b")
        self.folder.charge(1 + len(sources) // _SEARCHED_A_PART)
        return bool(wanted.search(sources)) or (in_words and bool(wanted.search(words)))

    @cached_property
    def python_texts(self) -> Strings:
        """The texts of the Python files."""
        return tuple(source.text for source in self.every_source((".py",)))

    @cached_property
    def has_plugin(self) -> Callable[[str], bool]:
        """Whether a package describes a plugin of a name for pluginlib, searched once for each."""
        return cache(self._has_plugin)

    def _has_plugin(self, name: str) -> bool:
        named = f'name="{name}"'
        return any(named in source.text for source in self.every_source((".xml",)))

    def is_nowhere(self, owner: Package, target: str) -> bool:
        """Return whether a file of text that the package does not have is surely nowhere.

        What the limits of reading, a submodule or a link leave out may be there, and an own program
        may write a file that it names.
        """
        if not target.endswith(_TEXTS) or self.folder.tree.ignored or owner.tree.links:
            return False
        folders = parents(target.removeprefix(owner.share))
        if any(self._may_be_submodule(owner, folder) for folder in folders):
            return False
        name = posixpath.basename(target)
        for source in self.every_source(_PROGRAMS):
            if name in source.text and not is_launch_file(source.path):
                return False
        return True

    def _may_be_submodule(self, owner: Package, folder: str) -> bool:
        """Return whether a folder of a package is one that git has not fetched."""
        self.folder.charge(len(owner.tree.files) // FILES_A_PART)
        if folder not in owner.tree.folders or posixpath.basename(folder) in _OWN_FOLDERS:
            return False
        return not any(path.startswith(f"{folder}/") for path in owner.tree.files)


def read_code(texts: TextFiles, package: Package) -> list[Source]:
    """Return the texts of the code of a package, without its launch files."""
    launches = {package.path(path) for path in package.launch_files}
    sources = texts.read_sources(package, CODE_ENDINGS)
    return [source for source in sources if source.path not in launches]


def _as_words(texts: Iterable[str]) -> str:
    """Return texts as one, in which small letters and underscores stand for the others."""
    return "\n".join(texts).lower().replace("-", "_")


def _paths_ending(package: Package, endings: Strings) -> Sequence[str]:
    """Return the paths of the files of a package with some endings.

    A program without an ending may be one of Python.
    """
    paths = [path for path in package.tree.files if path.endswith(endings)]
    if ".py" in endings:
        scripts = dict.fromkeys(script.source for script in package.python_scripts)
        paths += [path for path in scripts if not path.endswith(endings)]
    return paths


def _without_comments(package: Package, path: str) -> Source | None:
    """Return the text of a file with blanks in place of comments; None if it cannot be read."""
    data = package.tree.read(path, MAX_YAML)
    if data is None:
        return None
    text = data.decode("utf-8", "replace")
    if path.endswith(_WITH_LINES) or is_script(path):
        return Source(package.path(path), _COMMENT_LINE.sub(_blank, text))
    return Source(package.path(path), _without_xml_comments(text))


def _without_xml_comments(text: str) -> str:
    pieces = list[str]()
    outside = 0
    for start, end in comment_spans(text):
        pieces += (text[outside:start], _blanks(text[start : end + len("-->")]))
        outside = end + len("-->")
    return "".join((*pieces, text[outside:]))


def read_paths(package: Package, paths: Iterable[str]) -> list[str]:
    """Return the paths of a package's files that are read.

    These are no tests, none of packages in it, and not too many.
    """
    unread = ("test/", *package.inner)
    return [path for path in paths if not path.startswith(unread)][:_MAX_FILES]


def _blank(match: re.Match[str]) -> str:
    return _blanks(match[0])


def _blanks(comment: str) -> str:
    """Return blanks in place of a comment, so that places stay the same."""
    return re.sub(r"\S", " ", comment)
