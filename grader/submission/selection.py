"""What of a submission is graded: where its lab is searched, and of these files the URDF and the package."""

from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

from grader.files.names import PACKAGE_FILES
from grader.files.tree import Tree
from grader.package.package import MANIFEST, Package
from grader.submission.labs import Belonging, LabFolders, lab_words
from grader.submission.packages import best_named, package_around, read_packages, why_none, why_not
from grader.submission.robots import RobotFile, find_robots
from grader.submission.search import find_urdf, is_of_lab
from grader.submission.students import StudentWork, students_beside, students_in
from grader.submission.submission import Lab
from grader.submission.urdf import OtherCandidate
from grader.text import enumerated, was_not_committed

_MAX_ELSEWHERE = 40
_MAX_WORKS = 1000  # robots of which the student is determined
_MAX_NAMED = 5  # folders in a note
_ELSEWHERE = {
    Belonging.OTHER_LAB: "it is in the folder of another lab",
    Belonging.NO_LAB: "it is outside the folder of this lab",
}
_BESIDE = "{others} may be of other students, but were read as well: grade {own} to leave them out"


class Selection(NamedTuple):
    """The files of the lab, the URDF and the package that are graded, the other candidates, and notes on the choice.

    `packages` are all of the lab, and `no_package` says why none of them is graded, and which there are. `students` are
    the folders of several students, if the submission holds theirs. `other_lab` is the folder of another lab that is
    graded.
    """

    tree: Tree
    urdf: str | None
    package: Package | None
    packages: tuple[Package, ...]
    no_package: tuple[str, str]
    others: tuple[OtherCandidate, ...]
    notes: tuple[str, ...]
    students: tuple[str, ...]
    other_lab: str


class LabScope(NamedTuple):
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


def select(tree: Tree, lab: Lab, max_size: int) -> Selection:
    """Select what is graded of the files of a submission; `max_size` is in bytes of a URDF."""
    scope = lab_scope(tree, lab, max_size)
    packages = scope.packages
    named = best_named(packages, lab.package)
    preferred = named or next(iter(packages), None)
    urdf, others = find_urdf(scope.search_tree, lab.urdf, preferred.folder if preferred else None, scope.robots)
    graded = named or package_around(packages, urdf)
    others += tuple(
        OtherCandidate(it.path(MANIFEST), why_not(graded, it, lab.urdf)) for it in packages if it is not graded
    )
    names = {package.folder: package.name for package in packages}
    words = {word for name in lab.folders for word in lab_words(name)}
    students = _students(scope, names, words, lab)
    notes = scope.notes(urdf)
    if urdf is not None and not students:
        own, beside = students_beside(urdf.rpartition("/")[0], scope.tree.folders, names, words, lab.package)
        notes += (_BESIDE.format(others=enumerated(beside, _MAX_NAMED), own=own),) if beside else ()
    others += scope.elsewhere
    return Selection(scope.tree, urdf, graded, packages, scope.no_package, others, notes, students, scope.other_lab)


def _students(scope: LabScope, names: Mapping[str, str], words: set[str], lab: Lab) -> tuple[str, ...]:
    """Return the folders of the students if the robots and packages are of several; `names` are those of packages."""
    robots = (robot for robot in scope.robots[:_MAX_WORKS] if robot.size)
    works = [StudentWork(robot.path.rpartition("/")[0], is_of_lab(robot, lab.urdf)) for robot in robots]
    works += [StudentWork(folder, is_of_lab=True) for folder, name in names.items() if name == lab.package]
    return students_in(works, names, words, lab.package) if len(works) > 1 else ()


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


def lab_scope(tree: Tree, lab: Lab, max_size: int) -> LabScope:
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
    return LabScope(
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
