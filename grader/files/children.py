"""The names in a folder of a class."""

from typing import NamedTuple

from grader.files.names import BUILD_FOLDERS, IGNORED_FOLDERS, LITTER

_LITTER = LITTER | (IGNORED_FOLDERS - BUILD_FOLDERS)


class Children(NamedTuple):
    """The names in one folder, unsorted. `refused` are names that are not read, each with its reason."""

    folders: list[str]
    files: list[str]
    refused: list[tuple[str, str]]


def is_litter(name: str) -> bool:
    """Return whether a file is not worth reporting: hidden, or left by an operating system or a tool."""
    return name.startswith(".") or name in _LITTER
