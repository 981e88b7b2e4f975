"""Opens a submission: a URDF, a folder, an archive or standard input."""

import os
import re
from collections.abc import Collection, Iterable, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path

from grader.base.errors import InputError, MachineError
from grader.base.text import enumerated, printable, printable_path
from grader.files.opening import open_tree, tree_name
from grader.files.reading import read_capped, read_standard_input, read_start
from grader.files.tree import File, Tree, make_tree, overlaid
from grader.lab.submission.submission import DEFAULTS, Lab, Opening, Submission
from grader.ros.package.package import MANIFEST, Package
from grader.ros.package.robot_file import (
    Absent,
    Read,
    Surroundings,
    Unreadable,
    Urdf,
    read_as_ros,
)
from grader.ros.python.budget import Budget
from grader.ros.workspace.opened import OpenedWorkspace

STANDARD_INPUT = "-"
# Other files of a lab, which are never meant as a URDF.
_NO_URDFS = frozenset(
    {
        ".py",
        ".md",
        ".rviz",
        ".yaml",
        ".yml",
        ".toml",
        ".cfg",
        ".json",
        ".png",
        ".jpg",
        ".jpeg",
        ".gif",
        ".pdf",
        ".docx",
    }
)
_TABLES = frozenset({".csv", ".tsv", ".xlsx", ".xls", ".ods"})
_NO_LAB = Lab("robot.urdf")  # any robot, and any package
_MAX_BLANK = 4000  # bytes of a file without a robot
_MAX_NAMED = 6  # files in a note
_MAX_LEVELS = 4  # above a package, at which its workspace may be
_EXPECTED = "give a .urdf file, or the folder or archive that was submitted"


def read_submission(
    data: bytes, *, identity: str, path: str, opening: Opening = DEFAULTS, is_graded: bool = True
) -> Submission:
    """Return the submission that consists of the bytes of one URDF. If it is graded, a URDF without
    content is none.
    """
    if is_graded and _is_blank(data):
        return Submission(identity, Absent(path), opening=opening)
    if not opening.arguments and b"xacro" not in data:
        return Submission(identity, read_as_ros(data, path))
    surroundings = Surroundings(Budget(), arguments=opening.arguments)
    return Submission(
        identity, read_as_ros(data, path, surroundings), opening=opening, budget=surroundings.budget
    )


def open_submission(
    path: str, lab: Lab, opening: Opening = DEFAULTS, *, with_neighbours: bool = False
) -> Submission:
    """Read the submission at a path: a URDF, a folder, an archive, or standard input for `-`.

    `with_neighbours` reads the files that a single xacro file includes from the package around it,
    and meshes from there for a picture.
    Raises InputError, with one sentence, if the path cannot be read.
    """
    if path == STANDARD_INPUT:
        data = read_standard_input(opening.max_size)
        return read_submission(
            data, identity="stdin", path="-", opening=opening, is_graded=lab is not _NO_LAB
        )
    if not path:
        raise InputError(f"the path is empty: {_EXPECTED}")
    place = Path(path)
    if place.suffix.lower() in _TABLES and place.is_file():
        raise InputError(f"{printable_path(place)} is a table, not a submission: {_EXPECTED}")
    tree = open_tree(place, partial(_is_lab, lab))
    shown = printable_path(place)
    if tree is not None:
        identity = tree.name if place.is_dir() else tree_name(place)
        if opening.reports and place.is_dir():
            tree = tree.only(lambda inside: os.path.realpath(place / inside) not in opening.reports)
        _refuse_empty(tree, shown, _first_step(tree, place, lab.package))
        return submission_of(tree, identity, lab, opening)
    if place.suffix.lower() in _NO_URDFS:
        from grader.ros.package.robots import is_robot  # late: most URDFs are called .urdf

        if not is_robot(partial(read_start, place)):
            raise InputError(f"{shown} is not a URDF: {_EXPECTED}")
    data = read_capped(place, opening.max_size)
    identity = printable_path(place.stem)
    if with_neighbours and b"xacro" in data:
        submission = _read_with_neighbours(place, data, identity, opening)
    else:
        submission = read_submission(
            data,
            identity=identity,
            path=printable_path(place.name),
            opening=opening,
            is_graded=lab is not _NO_LAB,
        )
    if with_neighbours:
        return replace(submission, around=partial(_read_around, place))
    return submission


def open_workspace(path: str, max_size: int, arguments: Mapping[str, str]) -> OpenedWorkspace:
    """Read the packages and all robots at a path, whatever they are for. Raises InputError."""
    place = Path(path)
    tree = open_tree(place) if path not in ("", STANDARD_INPUT) else None
    if tree is None:
        return open_submission(path, _NO_LAB, Opening(max_size, arguments), with_neighbours=True)
    # Late: a URDF on its own needs no search.
    from grader.files.gitignore import without_git_ignored
    from grader.ros.workspace.all_robots import read_workspace

    identity = tree_name(place)
    if place.is_dir():
        tree, identity = without_git_ignored(tree, place), tree.name
    _refuse_empty(tree, printable_path(place), _first_step(tree, place, ""))
    return read_workspace(tree, identity, max_size, arguments)


def open_with_packages(path: str) -> Submission:
    """Return a submission in which all of its packages are graded, the one with the URDF first.
    Raises InputError.
    """
    from grader.ros.package.finding import is_backup, package_around  # late: many have no package

    submission = open_submission(path, _NO_LAB)
    main = package_around(submission.packages, submission.path) or submission.package
    packages = [
        it.name for it in submission.packages if it is not main and not is_backup(it.folder)
    ]
    if main is None or not packages:
        return submission
    urdf = (submission.path or _NO_LAB.urdf).removeprefix(main.path(""))
    return open_submission(path, Lab(urdf, packages=tuple(dict.fromkeys([main.name, *packages]))))


def _read_with_neighbours(place: Path, data: bytes, identity: str, opening: Opening) -> Submission:
    """Return the submission that is one file of xacro, and what it reads from the package around
    it.

    If it reads anything, its path is relative to the nearest folder above with a package.xml, else
    to its own folder.
    """
    # Late: most URDFs are no xacro.
    from grader.files.folder import read_folder

    asked: list[str] = []
    alone = Surroundings(Budget(), arguments=opening.arguments, ask=asked.append)
    submission = Submission(
        identity,
        read_as_ros(data, printable_path(place.name), alone),
        opening=opening,
        budget=alone.budget,
    )
    if not asked:
        return submission
    try:
        folder = place.parent.resolve()
        root = next(
            (above for above in (folder, *folder.parents) if (above / MANIFEST).is_file()), folder
        )
        root = _workspace_around(root, _packages_in(asked) - {root.name})
        path = printable((folder / place.name).relative_to(root).as_posix())
        found = read_folder(root)
        tree = overlaid(found, {path: data}) if path in found.files or place.is_symlink() else None
    except (OSError, InputError) as error:
        MachineError.check(error, printable_path(place.name))
        tree = None
    if tree is not None:
        return _with_files_around(submission, tree, path, alone)
    return submission


def _read_around(place: Path, names: Collection[str]) -> tuple[tuple[Package, ...], Tree]:
    """Return the packages around a file, and the files that they are among, to find those of some
    packages; without a package.xml, the files of the folder that is called as one of them.
    """
    # Late: few robots have meshes.
    from grader.files.folder import read_folder
    from grader.ros.package.finding import read_packages

    nothing: tuple[tuple[Package, ...], Tree] = ((), make_tree("", (), ()))
    try:
        folder = place.parent.resolve()
        above = (folder, *folder.parents)
        package = next((it for it in above if (it / MANIFEST).is_file()), None)
        root = next((it for it in above if it.name in names), None)
        if package is not None:
            root = _workspace_around(package, {*names} - {package.name})
        if root is None:
            return nothing
        tree = read_folder(root)
    except (OSError, InputError) as error:
        MachineError.check(error, printable_path(place.name))
        return nothing
    return read_packages(tree, ""), tree


def _workspace_around(package: Path, names: Collection[str]) -> Path:
    """Return the folder of a workspace in which packages of these names are: that of a package, one
    in which another one is beside it, or the nearest src or repository above; without any the
    package.
    """
    if any((package.parent / name / MANIFEST).is_file() for name in names):
        return package.parent
    if names and (package / MANIFEST).is_file():
        for above in (*package.parents,)[:_MAX_LEVELS]:
            if above.name == "src" or (above / ".git").exists():
                return above
    return package


def _packages_in(asked: Iterable[str]) -> set[str]:
    """Return the packages in which files are looked for."""
    from grader.ros.xacro.texts import INSTALLED

    return {text.split("/")[2] for text in asked if text.startswith(f"{INSTALLED}/")}


def _with_files_around(
    submission: Submission, tree: Tree, path: str, alone: Surroundings
) -> Submission:
    """Return a single file with what is read for it of a tree; `alone`: its surroundings without a
    tree.
    """
    from grader.ros.package.finding import read_packages

    known: dict[str, bytes] = {}

    def read(file: File, limit: int, *, first: bool = False) -> bytes:
        data = file.read(limit, first=first)
        if first:
            return data
        return known.setdefault(file.path, data)

    recorded = replace(
        tree,
        files={name: file._replace(read=partial(read, file)) for name, file in tree.files.items()},
    )
    packages = read_packages(recorded, "")
    data = tree.files[path].read(tree.files[path].size)
    surroundings = alone._replace(tree=recorded, packages=packages, is_single=True, budget=Budget())
    urdf = read_as_ros(data, path, surroundings)
    besides = tuple(sorted(known.keys() - {path}))
    note = (
        f"{enumerated(besides, _MAX_NAMED)} {'were' if len(besides) > 1 else 'was'} read "
        f"besides {path}"
    )
    return replace(
        submission,
        urdf=urdf,
        whole_tree=overlaid(tree, known),
        notes=(note,) if besides else (),
        budget=surroundings.budget,
        neighbours=packages,
        besides=besides,
    )


def _refuse_empty(tree: Tree, shown: str, advice: str = "") -> None:
    """Raise InputError if a tree has no files."""
    if not tree.files and not tree.generated:
        if tree.ignored:
            reason = f": {tree.ignored[0]}"
        else:
            reason = f" (hidden files and build folders are ignored){advice}"
        raise InputError(f"{shown} is empty{reason}")


def _first_step(tree: Tree, place: Path, package: str) -> str:
    """Return what to do first where a folder has no files; empty for an archive."""
    if not place.is_dir():
        return ""
    what = f"the package {package}" if package else "a package"
    where = printable_path(place / "src") if "src" in tree.folders else "it"
    return f": create {what} in {where}, or name the folder that holds your files"


def _is_blank(data: bytes) -> bool:
    """Return whether a file holds nothing but a declaration and comments: no robot is begun."""
    if len(data) > _MAX_BLANK:
        return False
    text = data.decode("utf-8-sig", "replace")
    return not re.sub(r"(?s)<\?xml.*?\?>|<!--.*?-->", "", text).strip()


def _is_lab(lab: Lab, name: str) -> bool:
    """Return whether an archive is named like the lab's folder."""
    from grader.lab.submission.labs import LabFolders  # late: a URDF on its own needs no search

    return LabFolders(lab.folders).is_lab(name)


def submission_of(
    tree: Tree, identity: str, lab: Lab, opening: Opening = DEFAULTS, *, shown: str = ""
) -> Submission:
    """Return the submission that a file tree makes; raises InputError, which names it `shown`, if
    it has no files.
    """
    _refuse_empty(tree, shown or identity)
    # Late: a URDF on its own needs no search.
    from grader.lab.submission.selection import select

    chosen = select(tree, lab, opening)
    urdf: Urdf = Absent()
    budget = Budget()
    surroundings = Surroundings(budget, tree, chosen.package, chosen.packages, opening.arguments)
    was_read = chosen.choice.read_in(surroundings)
    if was_read is not None:
        urdf, budget = was_read
    elif (path := chosen.choice.path) is not None:
        try:
            urdf = read_as_ros(tree.files[path].read(opening.max_size), path, surroundings)
        except InputError as error:  # the rest of the submission is graded
            urdf = Unreadable(path, str(error))
    if isinstance(urdf, Read) and _is_blank(urdf.data):
        urdf = Absent(urdf.path)
    return Submission(
        identity,
        urdf,
        other_candidates=chosen.others,
        tree=chosen.tree,
        packages=chosen.packages,
        package=chosen.package,
        no_package=chosen.no_package,
        lab_packages=chosen.lab_packages,
        whole_tree=tree,
        distro=lab.distro,
        several=chosen.several,
        notes=chosen.notes,
        is_single=False,
        other_lab=chosen.other_lab,
        opening=opening,
        budget=budget,
        reopen=partial(submission_of, identity=identity, lab=lab, opening=opening),
    )
