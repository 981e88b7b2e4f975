"""Opens a submission: a URDF, a folder, an archive or standard input."""

import os
import re
from dataclasses import replace
from functools import partial
from pathlib import Path

from grader.base.errors import InputError
from grader.base.text import printable_path
from grader.files.opening import open_tree, tree_name
from grader.files.tree import Tree
from grader.lab.submission.submission import DEFAULTS, Lab, Opening, Submission
from grader.ros.package.robot_file import (
    Absent,
    Read,
    Surroundings,
    Unreadable,
    Urdf,
    read_as_ros,
)
from grader.ros.python.budget import Budget
from grader.workspace.opening.opened import OpenedWorkspace
from grader.workspace.opening.opening import (
    STANDARD_INPUT,
    first_step,
    open_file,
    read_alone,
    refuse_empty,
    refuse_other_files,
)

_NO_LAB = Lab("robot.urdf")  # any robot, and any package
_MAX_BLANK = 4000  # bytes of a file without a robot


def read_submission(
    data: bytes, *, identity: str, path: str, lab: Lab = _NO_LAB, opening: Opening = DEFAULTS
) -> Submission:
    """Return the submission that consists of the bytes of one URDF.

    A URDF without content is none.
    """
    if _is_blank(data):
        return Submission(identity, Absent(path), opening=opening)
    return _as_submission(read_alone(data, identity, path, _alone(lab, opening)), lab, opening)


def _alone(lab: Lab, opening: Opening) -> Surroundings:
    """Return the surroundings of a URDF with no files around it."""
    return Surroundings(Budget(), arguments=opening.arguments, releases=lab.releases)


def _as_submission(opened: OpenedWorkspace, lab: Lab, opening: Opening) -> Submission:
    """Return the submission that is a URDF on its own."""
    return Submission(
        opened.id,
        opened.urdf,
        whole_tree=opened.whole_tree,
        notes=opened.notes,
        besides=opened.besides,
        distro=lab.distro,
        neighbours=opened.neighbours,
        around=opened.around,
        budget=opened.budget,
        opening=opening,
    )


def open_submission(
    path: str, lab: Lab, opening: Opening = DEFAULTS, *, with_neighbours: bool = False
) -> Submission:
    """Read the submission at a path: a URDF, a folder, an archive, or standard input for `-`.

    `with_neighbours` reads the files that a single xacro file includes from the package around it,
    and meshes from there for a picture.
    Raises InputError, with one sentence, if the path cannot be read.
    """
    place = Path(path)
    if path != STANDARD_INPUT:
        refuse_other_files(path)
        tree = open_tree(place, partial(_is_lab, lab))
        if tree:
            identity = tree.name if place.is_dir() else tree_name(place)
            if opening.reports and place.is_dir():
                tree = tree.only(
                    lambda inside: os.path.realpath(place / inside) not in opening.reports
                )
            refuse_empty(tree, printable_path(place), first_step(tree, place, lab.package))
            return make_submission(tree, identity, lab, opening)
    opened = open_file(
        path, opening.max_size, _alone(lab, opening), with_neighbours=with_neighbours
    )
    urdf = opened.urdf
    if isinstance(urdf, Read) and lab is not _NO_LAB:
        has_neighbours = with_neighbours and path != STANDARD_INPUT and b"xacro" in urdf.data
        if not has_neighbours and _is_blank(urdf.data):
            opened = replace(opened, urdf=Absent(urdf.path))
    return _as_submission(opened, lab, opening)


def open_with_packages(path: str) -> Submission:
    """Return a submission in which all of its packages are graded, the one with the URDF first.

    Raises InputError.
    """
    from grader.ros.package.finding import is_backup, package_around  # late: many have no package

    submission = open_submission(path, _NO_LAB)
    urdf = submission.urdf
    distro = urdf.reading.needed_release if isinstance(urdf, Read) else None
    if distro is not None:
        submission = open_submission(path, _NO_LAB._replace(distro=distro))
    main = package_around(submission.packages, submission.path) or submission.package
    packages = [
        package.name
        for package in submission.packages
        if package is not main and not is_backup(package.folder)
    ]
    if not main or not packages:
        return submission
    path_inside = (submission.path or _NO_LAB.urdf).removeprefix(main.path(""))
    names = tuple(dict.fromkeys([main.name, *packages]))
    return open_submission(path, Lab(path_inside, packages=names, distro=distro))


def _is_blank(data: bytes) -> bool:
    """Return whether a file holds nothing but a declaration and comments: no robot is begun."""
    if len(data) > _MAX_BLANK:
        return False
    text = data.decode("utf-8-sig", "replace")
    return not re.sub(r"(?s)<\?xml[^<>]*\?>|<!--.*?(?:-->|\Z)", "", text).strip()


def _is_lab(lab: Lab, name: str) -> bool:
    """Return whether an archive is named like the lab's folder."""
    from grader.lab.submission.labs import LabFolders  # late: a URDF on its own needs no search

    return LabFolders(lab.folders).is_lab(name)


def make_submission(
    tree: Tree, identity: str, lab: Lab, opening: Opening = DEFAULTS, *, shown: str = ""
) -> Submission:
    """Return the submission that a file tree makes.

    Raises InputError, which names it `shown`, if it has no files.
    """
    refuse_empty(tree, shown or identity)
    # Late: a URDF on its own needs no search.
    from grader.lab.submission.selection import select

    chosen = select(tree, lab, opening)
    urdf: Urdf = Absent()
    budget = Budget()
    surroundings = Surroundings(
        budget, tree, chosen.package, chosen.packages, opening.arguments, releases=lab.releases
    )
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
        reopen=partial(make_submission, identity=identity, lab=lab, opening=opening),
    )
