"""What the commands of a case leave: written files, and texts without what differs from run to run."""

import re
import zipfile
from collections.abc import Iterable
from datetime import UTC, datetime, timedelta
from pathlib import Path

from tests.command_line import ROOT

_TIME = r"[T ]\d\d:\d\d(:\d\d(\.\d+)?)?(Z|[+-]\d\d:?\d\d)?"


def contents(folder: Path) -> dict[str, bytes]:
    """Return the content of every file by its path."""
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


def is_shown(path: str, books: Iterable[str], patterns: Iterable[str]) -> bool:
    """Return whether a written file is shown: of a gradebook only those whose content is, and its reports."""
    inside = next(
        (path.removeprefix(f"{book}/") for book in books if path.startswith(f"{book}/")), ""
    )
    return (
        not inside
        or inside.startswith("reports/")
        or any(Path(path).match(pattern) for pattern in patterns)
    )


def kept(name: str, file: Path | zipfile.Path, patterns: Iterable[str]) -> str:
    """Return the content of a file whose name matches a pattern: text, or the members of an archive."""
    if not any(Path(name).match(pattern) for pattern in patterns):
        return ""
    if isinstance(file, Path) and zipfile.is_zipfile(file):
        with zipfile.ZipFile(file) as archive:
            members = [zipfile.Path(archive, member) for member in archive.namelist()]
            return "".join(
                f"== {member.at}\n{kept(member.at, member, patterns)}" for member in members
            )
    return file.read_bytes().decode(errors="backslashreplace")


def masked(text: str, here: Path) -> str:
    """Return a text without what differs from run to run, and a page without its styles, scripts and pictures."""
    if text.startswith("<!DOCTYPE html>"):
        text = re.sub(r"(?s)(<svg\b).*?(?=</svg>)", r"\1>", text)
        text = re.sub(
            r"(?s)(?<=<style>).*?(?=</style>)|(?<=<script>).*?(?=</script>)|&#39;sha256-.*?&#39; ?",
            "",
            text,
        )
    now = datetime.now(UTC)
    days = "|".join(f"{now - timedelta(days=days):%Y-%m-%d}" for days in (0, 1))
    return re.sub(
        f"({days}){_TIME}", "TIME", text.replace(str(here), "HERE").replace(str(ROOT), "ROOT")
    )
