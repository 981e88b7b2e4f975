"""A submission: one URDF so far, wherever it stands in what was handed in."""

import os
from dataclasses import dataclass, field
from pathlib import Path

from grader.errors import InputError
from grader.robot.reader import Reading, read_urdf
from grader.submission.files import URDF_LIMIT, printable_path, read_capped, read_standard_input, sha256_of
from grader.submission.find import find_urdf

STANDARD_INPUT = "-"
_ARCHIVES = (".zip", ".tar", ".tar.gz", ".tgz", ".gz", ".7z", ".rar")


@dataclass(frozen=True, slots=True)
class Submission:
    """What was handed in. `path` is relative to it, `passed_over` names the URDFs that are not graded."""

    id: str
    path: str
    data: bytes = field(repr=False)
    urdf: Reading
    passed_over: tuple[str, ...] = ()

    @property
    def sha256(self) -> str:
        """The hash of the URDF's bytes."""
        return sha256_of(self.data)


def read_submission(data: bytes, *, identity: str, path: str, passed_over: tuple[str, ...] = ()) -> Submission:
    """The submission that the bytes of one URDF make."""
    return Submission(identity, path, data, read_urdf(data, path), passed_over)


def open_submission(path: str, *, wanted: str, limit: int = URDF_LIMIT) -> Submission:
    """Read a URDF file, the URDF of a folder (`wanted`: where the rubric expects it), or standard input for `-`.

    Raises InputError, with one plain sentence, for what cannot be read.
    """
    if path == STANDARD_INPUT:
        return read_submission(read_standard_input(limit), identity="stdin", path="-")
    if not path:
        raise InputError("the path is empty")
    place = Path(path)
    try:
        is_folder = place.is_dir()
        if not is_folder and not os.path.lexists(place):
            raise InputError(f"{printable_path(place)} does not exist")
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise InputError(f"cannot read {printable_path(place)}: {reason}") from None
    if not is_folder and place.name.lower().endswith(_ARCHIVES):
        raise InputError(f"{printable_path(place)} is an archive, which this version does not open: unpack it first")
    if not is_folder:
        identity = printable_path(place.stem)
        return read_submission(read_capped(place, limit), identity=identity, path=printable_path(place.name))
    chosen, others = find_urdf(place, wanted)
    name = printable_path(chosen.as_posix())
    data = read_capped(place / chosen, limit)
    identity = printable_path(place.resolve().name or "submission")
    return read_submission(
        data, identity=identity, path=name, passed_over=tuple(printable_path(each.as_posix()) for each in others)
    )
