"""The URDFs of real robots that the group `oracle` installs (example-robot-data)."""

from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path

import pytest

MISSING = "the group oracle is not installed: pip install --group oracle"


def _folder() -> Path | None:
    try:
        return Path(
            str(
                distribution("example-robot-data").locate_file(
                    "cmeel.prefix/share/example-robot-data/robots"
                )
            )
        )
    except PackageNotFoundError:
        return None


FOLDER = _folder()
URDFS = sorted(FOLDER.rglob("*.urdf")) if FOLDER is not None else []
NAMES = [path.relative_to(FOLDER).as_posix() for path in URDFS] if FOLDER is not None else []

each_robot = pytest.mark.parametrize(
    "path",
    [pytest.param(path, id=name) for path, name in zip(URDFS, NAMES, strict=True)]
    or [pytest.param(Path(), id="none", marks=pytest.mark.skip(reason=MISSING))],
)
