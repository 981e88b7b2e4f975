"""Opens a submission: a URDF, a folder, an archive or standard input."""

from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path

from grader.errors import InputError
from grader.files.opening import open_tree, tree_name
from grader.files.reading import URDF_LIMIT, read_capped, read_standard_input, read_start
from grader.files.tree import Tree
from grader.submission.submission import Submission
from grader.submission.urdf import Absent, Unreadable, Urdf, read_as_ros
from grader.text import printable_path

STANDARD_INPUT = "-"
_NO_ARGUMENTS: Mapping[str, str] = {}
# Other files of a lab, which are never meant as a URDF.
_NO_URDFS = frozenset(
    {".py", ".md", ".rviz", ".yaml", ".yml", ".toml", ".cfg", ".json", ".png", ".jpg", ".jpeg", ".gif", ".pdf", ".docx"}
)
_WANTED = "give a .urdf file, or the folder or archive that was submitted"


def read_submission(
    data: bytes, *, identity: str, path: str, arguments: Mapping[str, str] = _NO_ARGUMENTS
) -> Submission:
    """Return the submission that consists of the bytes of one URDF; `arguments` are those of xacro."""
    if not arguments and b"xacro" not in data:
        return Submission(identity, read_as_ros(data, path))
    from grader.submission.workspace import Surroundings  # late: most URDFs are no xacro

    around = Surroundings(arguments=arguments)
    return Submission(identity, read_as_ros(data, path, around), arguments=arguments, budget=around.budget)


def open_submission(
    path: str,
    *,
    wanted: str,
    package: str = "",
    folders: Sequence[str] = (),
    limit: int = URDF_LIMIT,
    arguments: Mapping[str, str] = _NO_ARGUMENTS,
    with_neighbours: bool = False,
) -> Submission:
    """Read the submission at a path: a URDF, a folder, an archive, or standard input for `-`.

    `wanted` is the URDF's path in its package, `package` the package's name and `folders` the names of the lab's
    folder, as the rubric gives them. `limit` is the largest size of a URDF in bytes, `arguments` are those of xacro.
    `with_neighbours` reads the files that a single xacro file includes from the package around it. Raises InputError,
    with one sentence, if the path cannot be read.
    """
    if path == STANDARD_INPUT:
        return read_submission(read_standard_input(limit), identity="stdin", path="-", arguments=arguments)
    if not path:
        raise InputError(f"the path is empty: {_WANTED}")
    place = Path(path)
    tree = open_tree(place, partial(_is_lab, folders))
    shown = printable_path(place)
    if tree is not None:
        return submission_of(
            tree,
            tree_name(place),
            wanted=wanted,
            package=package,
            folders=folders,
            limit=limit,
            shown=shown,
            arguments=arguments,
        )
    if place.suffix.lower() in _NO_URDFS:
        from grader.submission.robots import START, is_robot  # late: most URDFs are called .urdf

        if not is_robot(read_start(place, START)):
            raise InputError(f"{shown} is not a URDF: {_WANTED}")
    data = read_capped(place, limit)
    identity = printable_path(place.stem)
    if with_neighbours and b"xacro" in data:
        from grader.submission.neighbours import read_with_neighbours  # late: most URDFs are no xacro

        return read_with_neighbours(place, data, identity, arguments)
    return read_submission(data, identity=identity, path=printable_path(place.name), arguments=arguments)


def _is_lab(folders: Sequence[str], name: str) -> bool:
    """Return whether an archive is named like the lab's folder."""
    from grader.submission.labs import LabFolders  # late: a URDF on its own needs no search

    return LabFolders(folders).is_lab(name)


def submission_of(
    tree: Tree,
    identity: str,
    *,
    wanted: str,
    package: str = "",
    folders: Sequence[str] = (),
    limit: int = URDF_LIMIT,
    shown: str = "",
    no_documents: str = "",
    arguments: Mapping[str, str] = _NO_ARGUMENTS,
) -> Submission:
    """Return the submission that a file tree makes; raises InputError, which names it `shown`, if it has no files."""
    if not tree.files and not tree.generated:
        reason = f": {tree.ignored[0]}" if tree.ignored else " (hidden files and build folders are ignored)"
        raise InputError(f"{shown or identity} is empty{reason}")
    # Late: a URDF on its own needs no search.
    from grader.submission.selection import select
    from grader.submission.workspace import Surroundings

    chosen = select(tree, wanted, package, folders, limit)
    urdf: Urdf = Absent()
    around = Surroundings(tree, chosen.package, chosen.packages, arguments)
    if chosen.urdf is not None:
        try:
            urdf = read_as_ros(tree.files[chosen.urdf].read(limit), chosen.urdf, around)
        except InputError as error:  # the rest of the submission is graded
            urdf = Unreadable(chosen.urdf, str(error))
    return Submission(
        identity,
        urdf,
        chosen.others,
        chosen.tree,
        chosen.packages,
        chosen.package,
        chosen.no_package,
        tree,
        chosen.students,
        chosen.notes,
        is_single=False,
        other_lab=chosen.other_lab,
        no_documents=no_documents,
        arguments=arguments,
        budget=around.budget,
        reopen=partial(
            submission_of,
            identity=identity,
            wanted=wanted,
            package=package,
            folders=folders,
            limit=limit,
            shown=shown,
            no_documents=no_documents,
            arguments=arguments,
        ),
    )
