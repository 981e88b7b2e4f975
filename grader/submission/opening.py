"""Opens a submission: a URDF, a folder, an archive or standard input."""

from functools import partial
from pathlib import Path

from grader.errors import InputError
from grader.files.opening import open_tree, tree_name
from grader.files.reading import read_capped, read_standard_input, read_start
from grader.files.tree import Tree
from grader.python.budget import Budget
from grader.submission.submission import DEFAULTS, Lab, Opening, Submission
from grader.submission.urdf import Absent, Unreadable, Urdf, read_as_ros
from grader.text import printable_path

STANDARD_INPUT = "-"
# Other files of a lab, which are never meant as a URDF.
_NO_URDFS = frozenset(
    {".py", ".md", ".rviz", ".yaml", ".yml", ".toml", ".cfg", ".json", ".png", ".jpg", ".jpeg", ".gif", ".pdf", ".docx"}
)
_TABLES = frozenset({".csv", ".tsv", ".xlsx", ".xls", ".ods"})
_EXPECTED = "give a .urdf file, or the folder or archive that was submitted"


def read_submission(data: bytes, *, identity: str, path: str, opening: Opening = DEFAULTS) -> Submission:
    """Return the submission that consists of the bytes of one URDF."""
    if not opening.arguments and b"xacro" not in data:
        return Submission(identity, read_as_ros(data, path))
    from grader.submission.surroundings import Surroundings  # late: most URDFs are no xacro

    surroundings = Surroundings(Budget(), arguments=opening.arguments)
    return Submission(identity, read_as_ros(data, path, surroundings), opening=opening, budget=surroundings.budget)


def open_submission(path: str, lab: Lab, opening: Opening = DEFAULTS, *, with_neighbours: bool = False) -> Submission:
    """Read the submission at a path: a URDF, a folder, an archive, or standard input for `-`.

    `with_neighbours` reads the files that a single xacro file includes from the package around it. Raises InputError,
    with one sentence, if the path cannot be read.
    """
    if path == STANDARD_INPUT:
        return read_submission(read_standard_input(opening.max_size), identity="stdin", path="-", opening=opening)
    if not path:
        raise InputError(f"the path is empty: {_EXPECTED}")
    place = Path(path)
    if place.suffix.lower() in _TABLES and place.is_file():
        raise InputError(f"{printable_path(place)} is a table, not a submission: {_EXPECTED}")
    tree = open_tree(place, partial(_is_lab, lab))
    shown = printable_path(place)
    if tree is not None:
        identity = tree.name if place.is_dir() else tree_name(place)
        return submission_of(tree, identity, lab, opening, shown=shown)
    if place.suffix.lower() in _NO_URDFS:
        from grader.submission.robots import START, is_robot  # late: most URDFs are called .urdf

        if not is_robot(read_start(place, START)):
            raise InputError(f"{shown} is not a URDF: {_EXPECTED}")
    data = read_capped(place, opening.max_size)
    identity = printable_path(place.stem)
    if with_neighbours and b"xacro" in data:
        from grader.submission.neighbours import read_with_neighbours  # late: most URDFs are no xacro

        return read_with_neighbours(place, data, identity, opening)
    return read_submission(data, identity=identity, path=printable_path(place.name), opening=opening)


def _is_lab(lab: Lab, name: str) -> bool:
    """Return whether an archive is named like the lab's folder."""
    from grader.submission.labs import LabFolders  # late: a URDF on its own needs no search

    return LabFolders(lab.folders).is_lab(name)


def submission_of(tree: Tree, identity: str, lab: Lab, opening: Opening = DEFAULTS, *, shown: str = "") -> Submission:
    """Return the submission that a file tree makes; raises InputError, which names it `shown`, if it has no files."""
    if not tree.files and not tree.generated:
        reason = f": {tree.ignored[0]}" if tree.ignored else " (hidden files and build folders are ignored)"
        raise InputError(f"{shown or identity} is empty{reason}")
    # Late: a URDF on its own needs no search.
    from grader.submission.selection import select
    from grader.submission.surroundings import Surroundings

    chosen = select(tree, lab, opening)
    urdf: Urdf = Absent()
    surroundings = Surroundings(Budget(), tree, chosen.package, chosen.packages, opening.arguments)
    if (path := chosen.choice.path) is not None:
        try:
            urdf = read_as_ros(tree.files[path].read(opening.max_size), path, surroundings)
        except InputError as error:  # the rest of the submission is graded
            urdf = Unreadable(path, str(error))
    return Submission(
        identity,
        urdf,
        other_candidates=chosen.others,
        tree=chosen.tree,
        packages=chosen.packages,
        package=chosen.package,
        no_package=chosen.no_package,
        whole_tree=tree,
        several=chosen.several,
        notes=chosen.notes,
        is_single=False,
        other_lab=chosen.other_lab,
        opening=opening,
        budget=surroundings.budget,
        reopen=partial(submission_of, identity=identity, lab=lab, opening=opening),
    )
