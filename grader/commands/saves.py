"""The values of --save, files of reports, and of --arg, for xacro."""

import os
from collections.abc import Sequence
from pathlib import Path

from grader.errors import GraderError
from grader.report.formats import Format

Saves = tuple[tuple[Format, Path], ...]


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


def read_arguments(texts: Sequence[str]) -> dict[str, str]:
    """Return the values that `--arg` gives arguments of xacro, by their names. Raises GraderError."""
    arguments: dict[str, str] = {}
    for text in texts:
        name, equals, value = text.partition("=")
        if not equals or not name.removesuffix(":"):
            raise GraderError(f"--arg takes NAME=VALUE, an argument of the xacro file, not {text!r}")
        arguments[name.removesuffix(":")] = value  # NAME:=VALUE, as xacro takes it
    return arguments
