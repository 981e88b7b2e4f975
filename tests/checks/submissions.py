"""Submissions as values: files by their paths, and the submission read from them, without a disk."""

import struct
import zlib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from grader.base.errors import InputError
from grader.files.tree import File, IgnoredFile, make_tree
from grader.lab.submission.opening import make_submission
from grader.lab.submission.submission import Lab, Submission

FOLDER = "my_robot"
MANIFEST = "my_robot/package.xml"
SETUP = "my_robot/setup.py"
URDF = "my_robot/urdf/my_robot.urdf"
LAUNCH = "my_robot/launch/my_robot_rviz.launch.py"
RVIZ = "my_robot/rviz/my_robot.rviz"
ANSWERS = "answers.md"
WEBCAM = "Task3_Step3.png"

_RUBRICS = Path(__file__).parents[2] / "rubrics" / "lab6"


@dataclass(frozen=True)
class Submitted:
    """The files of a submission by their paths."""

    files: Mapping[str, str | bytes]

    @cached_property
    def submission(self) -> Submission:
        """Return the submission that the grader reads from the files."""
        files = [
            file_of(path, self.data(path)) for path in self.files if not path.startswith("install/")
        ]
        tree = make_tree(
            "submission",
            files,
            (),
            ignored=[
                IgnoredFile(path, "is a rar archive", is_closed=True)
                for path in self.files
                if path.endswith(".rar")
            ],
            generated=[path for path in self.files if path.startswith("install/")],
        )
        return make_submission(tree, "submission", Lab("urdf/my_robot.urdf", FOLDER))

    def data(self, path: str) -> bytes:
        """Return the bytes of a file."""
        content = self.files[path]
        return content.encode() if isinstance(content, str) else content

    def with_files(self, files: Mapping[str, str | bytes]) -> "Submitted":
        """Return a copy with these files added or replaced."""
        return Submitted({**self.files, **files})

    def without(self, *paths: str) -> "Submitted":
        """Return a copy without some files or folders, all of which must exist."""
        left = dict(self.files)
        for path in paths:
            gone = [name for name in left if name == path or name.startswith(path + "/")]
            assert gone, f"{path} is not among {sorted(left)}"
            for name in gone:
                del left[name]
        return Submitted(left)

    def renaming(self, old: str, new: str) -> "Submitted":
        """Return a copy with a file or folder under another path."""
        moved = {
            path: path.replace(old, new, 1)
            for path in self.files
            if path == old or path.startswith(old + "/")
        }
        assert moved, f"{old} is not among {sorted(self.files)}"
        return Submitted({moved.get(path, path): content for path, content in self.files.items()})


def png(width: int = 640, height: int = 480) -> bytes:
    """Return an empty PNG."""

    def chunk(kind: bytes, data: bytes) -> bytes:
        return (
            struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        )

    header = struct.pack(">IIBBBBB", width, height, 1, 0, 0, 0, 0)
    rows = zlib.compress(bytes((1 + (width + 7) // 8) * height))
    return (
        b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", rows) + chunk(b"IEND", b"")
    )


def gif(width: int = 320, height: int = 240) -> bytes:
    """Return the beginning of a GIF, which contains its size."""
    return b"GIF89a" + struct.pack("<HH", width, height) + b"\x00\x00\x00\x3b"


def jpeg(width: int = 800, height: int = 600) -> bytes:
    """Return the beginning of a JPEG, which contains its size."""
    return (
        b"\xff\xd8\xff\xc0\x00\x11\x08"
        + struct.pack(">HH", height, width)
        + b"\x03\x01\x11\x00\x02\x11\x00\x03\x11\x00\xff\xd9"
    )


def file_of(path: str, data: bytes) -> File:
    """Return a file with these bytes."""

    def read(limit: int, *, first: bool = False) -> bytes:
        if len(data) > limit and not first:
            raise InputError(f"{path} is larger than {limit} bytes")
        return data[:limit]

    return File(path, len(data), read)


_FOLDER = _RUBRICS / FOLDER
_ANSWERS = """\
# Lab 6

## Task 1, step 15

The robot vanishes: two links have no parent, and a robot has one root.

## Task 2, step 2

robot_state_publisher publishes the transforms, rviz2 shows them.
"""
REFERENCE = Submitted(
    {
        **{
            f"{FOLDER}/{path.relative_to(_FOLDER).as_posix()}": path.read_text(encoding="utf-8")
            for path in sorted(_FOLDER.rglob("*"))
            if path.is_file() and "__pycache__" not in path.parts
        },
        ANSWERS: _ANSWERS,
        "Task1_Step8.png": png(),
        "Task1_Step18.png": png(),
        "Task1_Step36.png": png(),
        "Task2_Step6.png": png(),
        WEBCAM: png(),
    }
)
