"""The values of --save, files with the pictures among them that other reports link to, and of --arg, for xacro."""

import os
from collections.abc import Iterator, Sequence
from pathlib import Path
from urllib.parse import quote

from grader.errors import GraderError
from grader.report.formats import Format

Saves = tuple[tuple[Format, Path], ...]

_PICTURES = (Format.HTML, Format.SVG)


def read_saves(texts: Sequence[str]) -> Saves:
    """Return the formats and files that `--save` names. Raises GraderError."""
    saves = tuple(map(_read_save, texts))
    files = [os.path.realpath(file) for _, file in saves if file.is_file() or not file.exists()]
    for _, file in saves:
        if files.count(os.path.realpath(file)) > 1:
            raise GraderError(f"--save names {file} twice, and one file cannot hold two reports")
    return saves


def _read_save(text: str) -> tuple[Format, Path]:
    kind, equals, file = text.partition("=")
    if kind not in list(Format) or not equals or file in ("", "-"):
        raise GraderError(f"--save takes FORMAT=FILE with one of the formats {', '.join(Format)}, not {text!r}")
    # The shell expands no ~ after `=`; Path.expanduser raises for an unknown user.
    return Format(kind), Path(os.path.expanduser(file))  # noqa: PTH111


def picture_beside(file: Path, saves: Saves) -> str:
    """Return the address, relative to a file, of the SVG that the same run saves; empty if there is none.

    It is also empty if both files have only the root of the file system in common.
    """
    for kind, picture in saves:
        if kind is Format.SVG and _is_regular(picture) and _is_regular(file):
            # Symlinks as they are named: Path.resolve would follow them.
            paths = [os.path.abspath(path.parent) for path in (file, picture)]  # noqa: PTH100
            try:
                is_near = os.path.commonpath(paths) != os.path.abspath(os.sep)  # noqa: PTH100
            except ValueError:  # on different drives
                continue
            if is_near or paths[0] == paths[1]:
                return address(os.path.relpath(Path(paths[1], picture.name), paths[0]))
    return ""


def address(path: str) -> str:
    """Return a relative path as an address, with special characters escaped."""
    return quote(os.fsencode(path.replace(os.sep, "/")))


def saved_pictures(saves: Saves) -> Iterator[str]:
    """Yield the files with pictures that a run saves; of paths outside the current folder, only the name."""
    for kind, file in saves:
        if kind in _PICTURES and _is_regular(file):
            yield file.name if file.is_absolute() or ".." in file.parts else file.as_posix()


def _is_regular(file: Path) -> bool:
    return file.is_file() or not file.exists()


def read_arguments(texts: Sequence[str]) -> dict[str, str]:
    """Return the values that `--arg` gives arguments of xacro, by their names. Raises GraderError."""
    arguments: dict[str, str] = {}
    for text in texts:
        name, equals, value = text.partition("=")
        if not equals or not name.removesuffix(":"):
            raise GraderError(f"--arg takes NAME=VALUE, an argument of the xacro file, not {text!r}")
        arguments[name.removesuffix(":")] = value  # NAME:=VALUE, as xacro takes it
    return arguments
