"""What is known of CMake and ament: the file cmake.toml."""

from collections.abc import Mapping
from functools import cache
from typing import Any

from grader.base.grouping import Strings, StringsByName
from grader.base.records import Named
from grader.ros.known.releases import Release
from grader.ros.known.typed_rows import read_file, read_row

_Words = frozenset[str]


class _GoneCommand(Named):
    """A command that later releases do not have."""

    until: Release
    instead: str


class CMakeWords(Named):
    """Commands, keywords and variables of CMake and ament; the file says what each is."""

    harmless: _Words  # commands
    target_makers: _Words  # commands that add targets of other projects
    named_targets: _Words  # commands that add a target, which is called as the first word
    opaque: _Words  # harmless commands that set unknown variables
    install_keywords: _Words
    artifacts: _Words  # the keywords that name a kind of target
    interface_keywords: _Words
    python_keywords: _Words
    auto_keywords: _Words
    target_keywords: _Words
    test_keywords: _Words  # behind the sources of a test
    without_tests: _Words  # packages without commands for tests, besides `exports`
    source_endings: Strings  # that a source may lack
    foreign: _Words  # how variables of CMake begin
    modules: _Words  # that only define commands
    providers: StringsByName  # packages by their commands
    exports: StringsByName  # what find_package() of a package finds as well, in words
    outputs: Mapping[str, int]  # where harmless commands name their result
    variables: StringsByName
    install_dirs: StringsByName
    gone: Mapping[str, Any]  # what later releases do not have, by command
    oldest_minimum: Mapping[str, tuple[int, ...]]

    def gone_command(self, name: str) -> _GoneCommand | None:
        """Return since when there is no command of a name; None for one that all releases have."""
        row = self.gone.get(name)
        return read_row(_GoneCommand, row) if row is not None else None


@cache
def cmake_words() -> CMakeWords:
    """Return what is known of CMake and ament."""
    return read_file(CMakeWords, "cmake")
