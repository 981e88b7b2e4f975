"""The settings of `grader inspect`: keys of a grader.toml, or of [tool.grader] in a pyproject.toml.

`grade` and `batch` never read them: what a student ignores is graded.
"""

import os
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from grader.base.errors import InputError
from grader.base.grouping import Strings
from grader.base.names import did_you_mean
from grader.base.records import Named
from grader.base.toml_file import KeyTable, TomlRowReader, raise_complaints, read_toml
from grader.base.toml_types import simple_type, toml_type
from grader.files.reading import read_capped
from grader.ros.api import Release, StatedReleases
from grader.workspace.api import EVERY_KIND, RULES

_NAMES = ("grader.toml", "pyproject.toml")
_MAX_SIZE = 256 * 1024  # bytes of such a file
_CODES = toml_type(Strings)
_TEXT = simple_type(
    "a text",
    {"type": "string", "minLength": 1},
    lambda value: isinstance(value, str) and value != "",
)
_TABLE = KeyTable(
    "table of settings",
    {
        "ignore": _CODES,
        "per-file-ignores": toml_type(Mapping[str, Strings]),
        "distro": toml_type(Release),
        "rubric": _TEXT,
    },
)


class Settings(Named):
    """What a project says about its inspection."""

    file: Path | None = None  # that says so; None without one
    ignore: Strings = ()  # codes of problems, or their beginnings
    per_file_ignores: Mapping[str, Strings] = {}  # the same by patterns of paths
    distro: Release | None = None  # of ROS 2
    rubric: str | None = None  # an id or a file

    @property
    def stated(self) -> StatedReleases | None:
        """The release that it gives, and the file that does; None without one."""
        if not self.file or self.distro is None:
            return None
        return StatedReleases((self.distro,), (self.file.name,))


def read_settings(path: str) -> Settings:
    """Return the settings of the nearest file at or above a path; of a file its folder is meant.

    Raises GraderError.
    """
    if path == "-":
        return Settings()
    # Path.is_dir raises for a name that is too long before Python 3.14.
    folder = Path(path if os.path.isdir(path) else os.path.dirname(path) or os.curdir)  # noqa: PTH112, PTH120
    real = Path(os.path.realpath(folder))
    for above in (real, *real.parents):
        for name in _NAMES:
            file = above / name
            if file.is_file() and not file.is_symlink():
                settings = _read_file(file)
                if settings:
                    return settings
    return Settings()


def _read_file(file: Path) -> Settings | None:
    """Return the settings in a file; None for a pyproject.toml without them. Raises GraderError."""
    shown = Path(os.path.relpath(file))
    data = read_capped(file, _MAX_SIZE, shown=str(shown), advice="")
    keys: Strings = ()
    if file.name == _NAMES[1]:
        keys = ("tool", "grader")
        if b"grader" not in data:  # its mistakes are not read
            return None
    text, table = read_toml(data, shown)
    for key in keys:
        inner = table.get(key)
        if not isinstance(inner, dict):
            return None
        table = inner
    reader = TomlRowReader()
    row = reader.row(keys, table, _TABLE)
    for code, why in _unknown_codes(row.get("ignore", ())):
        reader.complain((*keys, "ignore"), f"ignore: {code}{why}")
    for pattern, codes in row.get("per-file-ignores", {}).items():
        for code, why in _unknown_codes(codes):
            reader.complain((*keys, "per-file-ignores", pattern), f"per-file-ignores: {code}{why}")
    raise_complaints(reader.complaints, text, shown)
    fields = {key.replace("-", "_"): value for key, value in row.items()}
    return Settings(file, **fields)


def read_codes(option: str, texts: Iterable[str]) -> Strings:
    """Return the codes that an option names, with or without commas. Raises InputError."""
    codes = tuple(code.strip() for text in texts for code in text.split(","))
    for code, why in _unknown_codes(codes):
        raise InputError(f"{option}: {code}{why}")
    return codes


def _unknown_codes(codes: Iterable[str]) -> Iterator[tuple[str, str]]:
    """Yield the texts that no code begins with, between quotes, and what is wrong with each."""
    known = [kind.code for kind in EVERY_KIND]
    for code in codes:
        is_code = bool(code) and any(known_code.startswith(code) for known_code in known)
        if not is_code and code not in RULES:
            guess = did_you_mean(code, known) or did_you_mean(code, RULES)
            yield repr(code), f" is no problem code, its beginning or a rule{guess}"
