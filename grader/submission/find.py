"""Which URDF of a folder is the one that was meant."""

import os
from pathlib import Path

from grader.errors import InputError
from grader.submission.files import printable_path

# Products of a build, tools' folders and other people's code: what a student wrote is not in them.
_IGNORED = frozenset(
    {"build", "install", "log", "node_modules", "site-packages", "venv", "env", "__pycache__", "__MACOSX"}
)
_MOST_FILES = 50_000


def find_urdf(folder: Path, wanted: str) -> tuple[Path, tuple[Path, ...]]:
    """The URDF of a folder that is graded, and those passed over, relative to the folder.

    `wanted` is the path that the rubric gives, such as urdf/my_robot.urdf. A file at the end of whose path it stands comes
    first, then one with its name, then any .urdf; among equals the one nearest to the top, then the first in the alphabet.
    Raises InputError where there is none.
    """
    found = _urdfs(folder)
    if not found:
        raise InputError(
            f"{printable_path(folder)} holds no .urdf file (build, install, log and hidden folders are skipped)"
        )
    parts = Path(wanted).parts

    def rank(path: Path) -> tuple[bool, bool, int, str]:
        return (path.parts[-len(parts) :] != parts, path.name != parts[-1], len(path.parts), path.as_posix())

    best, *others = sorted(found, key=rank)
    return best, tuple(others)


def _urdfs(folder: Path) -> list[Path]:
    top = os.path.realpath(folder)
    found: list[Path] = []
    seen = 0

    def refuse(error: OSError) -> None:
        if not found and error.filename == os.fspath(folder):
            raise InputError(f"cannot read {printable_path(folder)}: {error.strerror}")

    for where, folders, files in os.walk(folder, onerror=refuse):
        folders[:] = sorted(name for name in folders if name not in _IGNORED and not name.startswith("."))
        seen += len(files) + len(folders)
        if seen > _MOST_FILES:
            raise InputError(
                f"{printable_path(folder)} holds more than {_MOST_FILES} files: name the package or the URDF"
            )
        for name in files:
            if name.lower().endswith(".urdf") and not name.startswith("."):
                path = Path(where, name)
                if os.path.realpath(path).startswith(top + os.sep):  # a link that leads out is not theirs to hand in
                    found.append(path.relative_to(folder))
    return found
