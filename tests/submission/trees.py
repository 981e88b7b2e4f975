"""Repositories as values: robots and packages at paths, and what the grader makes of them."""

from collections.abc import Mapping
from functools import partial

from grader.files.tree import File, make_tree
from grader.lab.submission.opening import make_submission
from grader.lab.submission.submission import Lab, Submission

FOLDERS = ("Lab6",)
ROBOT = b"<?xml version='1.0'?><robot name='my_robot'><link name='base_link'/></robot>"
BOX = b"<robot name='box'><link name='box'/></robot>"
PICTURE = b"\x89PNG"


def manifest(name: str) -> bytes:
    """Return a package.xml with this name."""
    return f'<package format="3"><name>{name}</name></package>'.encode()


def package(folder: str, name: str = "my_robot", *, urdf: bool = True) -> dict[str, bytes]:
    """Return the files of a package."""
    files = {
        f"{folder}/package.xml": manifest(name),
        f"{folder}/setup.py": b"",
        f"{folder}/launch/a.launch.py": b"",
    }
    return {**files, f"{folder}/urdf/my_robot.urdf": ROBOT} if urdf else files


def submission(
    files: Mapping[str, bytes], *generated: str, folders: tuple[str, ...] = FOLDERS
) -> Submission:
    """Return the submission that these files make for lab 6; `generated` are paths of a build."""
    found = [File(path, len(data), partial(_read, data)) for path, data in files.items()]
    tree = make_tree("repo", found, (), generated=generated)
    return make_submission(tree, "repo", Lab("urdf/my_robot.urdf", "my_robot", folders))


def others(graded: Submission) -> dict[str, str]:
    """Return the other candidates, each with its reason."""
    return {other.path: other.reason for other in graded.other_candidates}


def _read(data: bytes, limit: int, *, first: bool = False) -> bytes:
    del first
    return data[:limit]
