"""What is known of CMake and ament: the file cmake.toml."""

from collections.abc import Mapping
from functools import cache
from typing import Any, NamedTuple

from grader.ros.known.releases import Release
from grader.ros.known.typed_rows import read_file, read_row


class _GoneCommand(NamedTuple):
    """A command that later releases do not have."""

    until: Release
    instead: str


class CMakeWords(NamedTuple):
    """Commands, keywords and variables of CMake and ament; the file says what each is."""

    harmless: frozenset[str]  # commands
    target_makers: frozenset[str]  # commands that add targets of other projects
    named_targets: frozenset[str]  # commands that add a target, which is called as the first word
    opaque: frozenset[str]  # harmless commands that set unknown variables
    install_keywords: frozenset[str]
    artifacts: frozenset[str]  # the keywords that name a kind of target
    interface_keywords: frozenset[str]
    python_keywords: frozenset[str]
    auto_keywords: frozenset[str]
    target_keywords: frozenset[str]
    test_keywords: frozenset[str]  # behind the sources of a test
    without_tests: frozenset[str]  # packages without commands for tests, besides `exports`
    source_endings: tuple[str, ...]  # that a source may lack
    foreign: frozenset[str]  # how variables of CMake begin
    modules: frozenset[str]  # that only define commands
    providers: Mapping[str, str]  # packages by their commands
    exports: Mapping[str, str]  # what find_package() of a package finds as well, in words
    outputs: Mapping[str, int]  # where harmless commands name their result
    variables: Mapping[str, str]
    install_dirs: Mapping[str, str]
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
