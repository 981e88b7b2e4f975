"""Open what is at a path: a URDF, a folder or an archive.

A URDF on its own is read with what it reads from the package around it; a folder or archive with
its packages and all of its robots.
"""

from collections.abc import Collection, Iterable, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path

from grader.base.errors import InputError, MachineError
from grader.base.text import enumerated, printable, printable_path
from grader.files.folder import file_at
from grader.files.limits import is_recording
from grader.files.opening import open_tree, tree_name
from grader.files.reading import read_capped, read_standard_input, read_start
from grader.files.tree import File, Tree, make_tree, overlaid
from grader.ros.known.releases import StatedReleases
from grader.ros.package.package import MANIFEST, Package
from grader.ros.package.robot_file import Read, Surroundings, read_as_ros
from grader.ros.python.budget import Budget
from grader.workspace.opening.opened import OpenedWorkspace

STANDARD_INPUT = "-"  # as the path of a URDF
# Files that are never meant as a URDF.
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
_MAX_NAMED = 6  # files in a note
_MAX_LEVELS = 4  # above a package, at which its workspace may be
_EXPECTED = "give a .urdf file, or the folder or archive that was submitted"


def open_workspace(
    path: str, max_size: int, arguments: Mapping[str, str], stated: StatedReleases | None = None
) -> OpenedWorkspace:
    """Return the packages and all robots at a path, or the URDF that it is.

    Args:
        path: A file, a folder, an archive, or `-` for a URDF on standard input.
        max_size: The largest size of a robot, in bytes.
        arguments: The arguments of xacro that the user gives, by name.
        stated: The release of ROS 2 that an option or a setting gives; without it, the files of a
            workspace state releases.

    Raises:
        InputError: The path cannot be read; the message is one sentence.
    """
    place = Path(path)
    tree = open_tree(place) if path not in ("", STANDARD_INPUT) else None
    if not tree and is_recording(path):
        tree = make_tree(place.stem, [file_at(place, printable_path(place.name), "")], ())
    if not tree:
        alone = Surroundings(Budget(), arguments=arguments)
        if stated:
            alone = alone._replace(releases=stated.releases)
        opened = open_file(path, max_size, alone, with_neighbours=True)
        if not isinstance(opened.urdf, Read):
            return opened
        from grader.ros.package.robot_readings import read_as_meant  # late: `grade` needs none

        around = alone._replace(tree=opened.whole_tree, packages=opened.neighbours)
        return replace(opened, urdf=read_as_meant(opened.urdf, around))
    # Late: a URDF on its own needs no search.
    from grader.files.gitignore import without_git_ignored
    from grader.workspace.opening.all_robots import read_workspace

    identity = tree_name(place)
    if place.is_dir():
        tree, identity = without_git_ignored(tree, place), tree.name
    refuse_empty(tree, printable_path(place), first_step(tree, place, ""))
    return read_workspace(tree, identity, max_size, arguments, stated=stated)


def open_file(
    path: str, max_size: int, alone: Surroundings, *, with_neighbours: bool
) -> OpenedWorkspace:
    """Return the URDF in a file, or on standard input for `-`, where no files are around it.

    `with_neighbours` reads the files that a xacro file includes from the package around it, and
    meshes from there for a picture. Raises InputError as `open_workspace`.
    """
    if path == STANDARD_INPUT:
        return read_alone(read_standard_input(max_size), "stdin", "-", alone)
    refuse_other_files(path)
    place = Path(path)
    if place.suffix.lower() in _NO_URDFS:
        from grader.ros.package.robots import is_robot  # late: most URDFs are called .urdf

        if not is_robot(partial(read_start, place)):
            raise InputError(f"{printable_path(place)} is not a URDF: {_EXPECTED}")
    data = read_capped(place, max_size)
    identity = printable_path(place.stem)
    if with_neighbours and b"xacro" in data:
        opened = _read_with_neighbours(place, data, identity, alone)
    else:
        opened = read_alone(data, identity, printable_path(place.name), alone)
    if with_neighbours:
        return replace(opened, around=partial(_read_around, place))
    return opened


def read_alone(data: bytes, identity: str, path: str, alone: Surroundings) -> OpenedWorkspace:
    """Return what the bytes of one URDF are; xacro finds no other files."""
    urdf = read_as_ros(data, path, alone)
    return OpenedWorkspace(identity, urdf, budget=alone.budget)


def refuse_other_files(path: str) -> None:
    """Raise InputError for an empty path, and for a table."""
    if not path:
        raise InputError(f"the path is empty: {_EXPECTED}")
    place = Path(path)
    if place.suffix.lower() in _TABLES and place.is_file():
        raise InputError(f"{printable_path(place)} is a table, not a submission: {_EXPECTED}")


def _read_with_neighbours(
    place: Path, data: bytes, identity: str, alone: Surroundings
) -> OpenedWorkspace:
    """Return one file of xacro, and what it reads from the package around it.

    If it reads anything, its path is relative to the nearest folder above with a package.xml, else
    to its own folder.
    """
    # Late: most URDFs are no xacro.
    from grader.files.folder import read_folder

    asked: list[str] = []
    alone = alone._replace(ask=asked.append)
    urdf = read_as_ros(data, printable_path(place.name), alone)
    opened = OpenedWorkspace(identity, urdf, budget=alone.budget)
    if not asked:
        return opened
    try:
        folder = place.parent.resolve()
        root = next(
            (above for above in (folder, *folder.parents) if (above / MANIFEST).is_file()), folder
        )
        root = _workspace_around(root, _packages_in(asked) - {root.name})
        path = printable((folder / place.name).relative_to(root).as_posix())
        folder_tree = read_folder(root)
        tree = (
            overlaid(folder_tree, {path: data})
            if path in folder_tree.files or place.is_symlink()
            else None
        )
    except (OSError, InputError) as error:
        MachineError.check(error, printable_path(place.name))
        tree = None
    if tree:
        return _with_files_around(opened, tree, path, alone)
    return opened


def _read_around(place: Path, names: Collection[str]) -> tuple[tuple[Package, ...], Tree]:
    """Return the packages around a file, and the files that they are among.

    They are read to find those of some packages. Without a package.xml, the files are those of
    the folder that is called as one of them.
    """
    # Late: few robots have meshes.
    from grader.files.folder import read_folder
    from grader.ros.package.finding import read_packages

    nothing = ((), make_tree("", (), ()))
    try:
        folder = place.parent.resolve()
        above = (folder, *folder.parents)
        package = next((parent for parent in above if (parent / MANIFEST).is_file()), None)
        root = next((parent for parent in above if parent.name in names), None)
        if package:
            root = _workspace_around(package, {*names} - {package.name})
        if not root:
            return nothing
        tree = read_folder(root)
    except (OSError, InputError) as error:
        MachineError.check(error, printable_path(place.name))
        return nothing
    return read_packages(tree, ""), tree


def _workspace_around(package: Path, names: Collection[str]) -> Path:
    """Return the folder of a workspace in which packages of these names are.

    It is that of a package in which another one is beside it, or the nearest src or repository
    above; without any, the package.
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
    opened: OpenedWorkspace, tree: Tree, path: str, alone: Surroundings
) -> OpenedWorkspace:
    """Return a single file with what is read for it of a tree.

    `alone` is its surroundings without a tree.
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
        opened,
        urdf=urdf,
        whole_tree=overlaid(tree, known),
        notes=(note,) if besides else (),
        budget=surroundings.budget,
        neighbours=packages,
        besides=besides,
    )


def refuse_empty(tree: Tree, shown: str, advice: str = "") -> None:
    """Raise InputError if a tree has no files."""
    if not tree.files and not tree.generated:
        if tree.ignored:
            reason = f": {tree.ignored[0]}"
        else:
            reason = f" (hidden files and build folders are ignored){advice}"
        raise InputError(f"{shown} is empty{reason}")


def first_step(tree: Tree, place: Path, package: str) -> str:
    """Return what to do first where a folder has no files; empty for an archive."""
    if not place.is_dir():
        return ""
    what = f"the package {package}" if package else "a package"
    where = printable_path(place / "src") if "src" in tree.folders else "it"
    return f": create {what} in {where}, or name the folder that holds your files"
