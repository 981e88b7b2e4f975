"""The part of a submission in which its lab is searched: in a repository of several labs, the folder of this one."""

from collections.abc import Iterable, Sequence
from typing import NamedTuple

from grader.files.names import PACKAGE_FILES
from grader.files.tree import Tree
from grader.package.package import MANIFEST, Package
from grader.submission.labs import Belonging, LabFolders
from grader.submission.packages import read_packages, why_none
from grader.submission.robots import RobotFile, find_robots
from grader.submission.search import find_urdf, is_of_lab
from grader.submission.submission import Lab
from grader.submission.urdf import OtherCandidate
from grader.text import was_not_committed

_MAX_ELSEWHERE = 40
_ELSEWHERE = {
    Belonging.OTHER_LAB: "it is in the folder of another lab",
    Belonging.NO_LAB: "it is outside the folder of this lab",
}


class Scope(NamedTuple):
    """Where a lab is searched: the URDF in `search_tree`, among `robots`; documents in `tree`.

    If the lab has a folder, `tree` is only that folder, `own_folder`. `other_lab` is the folder of another lab that is
    searched instead. `elsewhere` are robots and packages in other places.
    """

    search_tree: Tree
    tree: Tree
    robots: tuple[RobotFile, ...]
    packages: tuple[Package, ...]
    no_package: tuple[str, str]
    elsewhere: tuple[OtherCandidate, ...]
    own_folder: str
    other_lab: str

    def notes(self, urdf: str | None) -> tuple[str, ...]:
        """Return the notes on the folders that were searched; `urdf` is the path of the URDF that is graded."""
        own = f"{self.own_folder}, the folder of this lab, has no" if self.own_folder else ""
        if self.other_lab:
            why = f"{own} robot and no package" if own else "no folder of this lab was found"
            return (f"{why}: {self.other_lab}, the folder of another lab, was graded",)
        if own and urdf and urdf not in self.tree.files:
            return (f"{own} URDF: {urdf}, which is outside of it, was graded",)
        return ()


class _Places(NamedTuple):
    """The places of a submission that are searched, the best first; of other labs only the one in `other_lab`."""

    labs: LabFolders
    searched: Sequence[Belonging]
    other_lab: str = ""

    def of(self, path: str) -> Belonging | None:
        """Return where a file is; None of one in the folder of another lab that is not searched."""
        place = self.labs.belonging(path)
        is_open = place is not Belonging.OTHER_LAB or (self.other_lab and path.startswith(f"{self.other_lab}/"))
        return place if is_open else None

    def nearest(self, paths: Iterable[str]) -> Sequence[Belonging]:
        """Return the best place that has one of these files; none if no place has."""
        present = set(map(self.of, paths))
        return [place for place in self.searched if place in present][:1]

    def only(self, tree: Tree, places: Sequence[Belonging]) -> Tree:
        """Return the files that are in these places."""
        if all(self.of(path) in places for path in (*tree.files, *tree.generated)):
            return tree
        return tree.only(lambda path: self.of(path) in places)


def lab_scope(tree: Tree, lab: Lab, max_size: int) -> Scope:
    """Return where a lab is searched in the files of a submission.

    Where the lab's folder exists, it decides: a file in no lab's folder is graded only if the lab's has none of its
    kind. Another lab's folder is used only if no robot and no package is anywhere else, and if the lab's folder exists,
    only for the robot that the rubric names. `max_size` is in bytes of a URDF.
    """
    robots = find_robots(tree, lab.urdf.rpartition("/")[2], max_size)
    roots = [path for path in tree.files if path.rpartition("/")[2] in PACKAGE_FILES]
    places = _places(tree, lab, robots, roots)
    has_own = any(places.labs.belonging(path) is Belonging.THIS_LAB for path in tree.files)
    search_tree = places.only(tree, places.searched)
    own_tree = places.only(tree, (Belonging.THIS_LAB,)) if has_own else search_tree
    of_robots, of_packages = places.nearest(robot.path for robot in robots), places.nearest(roots)
    packages = read_packages(places.only(tree, of_packages), lab) if of_packages else ()
    other_roots = [path for path in roots if places.of(path) not in of_packages]
    elsewhere = [robot.path for robot in robots if places.of(robot.path) not in of_robots]
    elsewhere += [path for path in other_roots if path.rpartition("/")[2] == MANIFEST]
    of_other_labs = read_packages(tree, lab) if other_roots and not packages else ()
    reason, which = why_none(packages, of_other_labs, lab.package)
    return Scope(
        search_tree,
        own_tree,
        tuple(robot for robot in robots if places.of(robot.path) in of_robots),
        packages,
        (reason, which + (_built_package(search_tree) if not packages else "")),
        tuple(OtherCandidate(path, _ELSEWHERE[places.labs.belonging(path)]) for path in elsewhere[:_MAX_ELSEWHERE]),
        next(map(places.labs.around, own_tree.files), "") if has_own else "",
        places.other_lab,
    )


def _places(tree: Tree, lab: Lab, robots: tuple[RobotFile, ...], roots: Sequence[str]) -> _Places:
    """Return the places that are searched; `roots` are the paths of manifests and setup files."""
    labs = LabFolders(lab.folders, tree.files)
    present = set(map(labs.belonging, tree.files))
    of_work = {labs.belonging(path) for path in (*(robot.path for robot in robots), *roots)}
    of_labs = tuple(robot for robot in robots if not labs.is_project(robot.path))
    is_elsewhere = of_work == {Belonging.OTHER_LAB} and any(is_of_lab(robot, lab.urdf) for robot in of_labs)
    if Belonging.THIS_LAB in present and not is_elsewhere:
        return _Places(labs, (Belonging.THIS_LAB, Belonging.NO_LAB))
    if Belonging.OTHER_LAB in present and {Belonging.OTHER_LAB} in (of_work, present):
        robot = find_urdf(tree, lab.urdf, None, of_labs or robots).path
        other_lab = labs.around(robot or next(iter([*roots, *tree.files])))
        return _Places(labs, (Belonging.OTHER_LAB, Belonging.NO_LAB), other_lab)
    return _Places(labs, (Belonging.NO_LAB,))


def _built_package(tree: Tree) -> str:
    return next((was_not_committed(path) for path in tree.generated if path.endswith(f"/{MANIFEST}")), "")
