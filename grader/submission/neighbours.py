"""A xacro file on its own, with the files that it includes from the package around it."""

from dataclasses import replace
from functools import partial
from pathlib import Path

from grader.errors import InputError, MachineError
from grader.files.folder import read_folder
from grader.files.tree import File, Tree, overlaid
from grader.package.package import MANIFEST
from grader.python.budget import Budget
from grader.submission.packages import read_packages
from grader.submission.submission import Lab, Opening, Submission
from grader.submission.surroundings import Surroundings
from grader.submission.urdf import read_as_ros
from grader.text import enumerated, printable, printable_path

_MAX_NAMED = 6


def read_with_neighbours(place: Path, data: bytes, identity: str, opening: Opening) -> Submission:
    """Return the submission that is one file of xacro, and what it reads from the package around it.

    If it reads anything, its path is relative to the nearest folder above with a package.xml, else to its own folder.
    """
    asked: list[str] = []
    alone = Surroundings(Budget(), arguments=opening.arguments, ask=asked.append)
    submission = Submission(
        identity, read_as_ros(data, printable_path(place.name), alone), opening=opening, budget=alone.budget
    )
    if not asked:
        return submission
    try:
        folder = place.parent.resolve()
        root = next((above for above in (folder, *folder.parents) if (above / MANIFEST).is_file()), folder)
        path = printable((folder / place.name).relative_to(root).as_posix())
        found = read_folder(root)
        tree = overlaid(found, {path: data}) if path in found.files or place.is_symlink() else None
    except (OSError, InputError) as error:
        MachineError.check(error, printable_path(place.name))
        tree = None
    return _with_files_around(submission, tree, path, alone) if tree is not None else submission


def _with_files_around(submission: Submission, tree: Tree, path: str, alone: Surroundings) -> Submission:
    """Return a single file with what is read for it of a tree; `alone`: its surroundings without a tree."""
    known: dict[str, bytes] = {}

    def read(file: File, limit: int, *, first: bool = False) -> bytes:
        data = file.read(limit, first=first)
        return data if first else known.setdefault(file.path, data)

    recorded = replace(tree, files={name: file._replace(read=partial(read, file)) for name, file in tree.files.items()})
    packages = read_packages(recorded, Lab(""))
    data = tree.files[path].read(tree.files[path].size)
    surroundings = alone._replace(tree=recorded, packages=packages, is_single=True, budget=Budget())
    urdf = read_as_ros(data, path, surroundings)
    besides = tuple(sorted(known.keys() - {path}))
    note = f"{enumerated(besides, _MAX_NAMED)} {'were' if len(besides) > 1 else 'was'} read besides {path}"
    return replace(
        submission,
        urdf=urdf,
        whole_tree=overlaid(tree, known),
        notes=(note,) if besides else (),
        budget=surroundings.budget,
        neighbours=packages,
        besides=besides,
    )
