"""What of a submission is graded: the files of this lab, and of these the URDF and the package."""

from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

from grader.files.tree import Tree
from grader.package.package import MANIFEST, SETUP, Package
from grader.submission.labs import Belonging, LabFolders, lab_words
from grader.submission.packages import best_named, package_around, read_packages, why_none, why_not
from grader.submission.robots import RobotFile, find_robots
from grader.submission.search import find_urdf, is_wanted
from grader.submission.students import StudentWork, students_beside, students_in
from grader.submission.urdf import OtherCandidate
from grader.text import enumerated, was_not_committed

_MAX_ELSEWHERE = 40
_MAX_WORKS = 1000  # robots of which the student is determined
_MAX_NAMED = 5  # folders in a note
_BESIDE = "{others} may be of other students, but were read as well: grade {own} to leave them out"
_ELSEWHERE = {
    Belonging.OTHER_LAB: "it is in the folder of another lab",
    Belonging.NO_LAB: "it is outside the folder of this lab",
}


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


def select(tree: Tree, wanted: str, package: str, folders: Sequence[str], limit: int) -> Selection:
    """Select what is graded, given the rubric's path of the URDF, name of the package and names of the lab's folder.

    Where the lab's folder exists, it decides: a file in no lab's folder is graded only if the lab's has none of its
    kind. Another lab's folder is used only if no robot and no package is anywhere else, and if the lab's folder exists,
    only for the robot that the rubric names. `limit` is in bytes of a URDF.
    """
    scope = _LabScope(tree, wanted, folders, limit)
    packages = scope.packages(package, wanted)
    named = best_named(packages, package)
    preferred = named or next(iter(packages), None)
    urdf, others = find_urdf(scope.tree, wanted, preferred.folder if preferred else None, tuple(scope.robots))
    graded = named or package_around(packages, urdf)
    others += tuple(
        OtherCandidate(it.path(MANIFEST), why_not(graded, it, wanted)) for it in packages if it is not graded
    )
    others += tuple(OtherCandidate(path, scope.why_not(path)) for path in scope.elsewhere[:_MAX_ELSEWHERE])
    names = {it.folder: it.name for it in packages}
    lab = {word for name in folders for word in lab_words(name)}
    students = _students(scope.robots, names, lab, wanted, package)
    notes = scope.notes(urdf)
    if urdf is not None and not students:
        own, beside = students_beside(urdf.rpartition("/")[0], scope.documents.folders, names, lab, package)
        notes += (_BESIDE.format(others=enumerated(beside, _MAX_NAMED), own=own),) if beside else ()
    no_package = scope.no_package(packages, package, wanted)
    return Selection(scope.documents, urdf, graded, packages, no_package, others, notes, students, scope.other_lab)


def _students(
    robots: Sequence[RobotFile], names: Mapping[str, str], lab: set[str], wanted: str, package: str
) -> tuple[str, ...]:
    """Return the folders of the students if the robots and packages are of several; `names` are those of packages."""
    works = [StudentWork(it.path.rpartition("/")[0], is_wanted(it, wanted)) for it in robots[:_MAX_WORKS] if it.size]
    works += [StudentWork(folder, is_wanted=True) for folder, name in names.items() if name == package]
    return students_in(works, names, lab, package) if len(works) > 1 else ()


class _LabScope:
    """The part of a submission in which its lab is searched: `tree`, and `documents` only from the lab's folder.

    `robots` are the candidates in it, `elsewhere` are other robots and packages.
    """

    def __init__(self, tree: Tree, wanted: str, folders: Sequence[str], limit: int) -> None:
        self._whole = tree
        self._labs = LabFolders(folders, tree.files)
        robots = find_robots(tree, wanted.rpartition("/")[2], limit)
        roots = [path for path in tree.files if path.rpartition("/")[2] in (MANIFEST, SETUP)]
        self.other_lab = ""
        has_own = self._find_labs(robots, roots, wanted)
        self.tree = self.only(*self._allowed)
        self.documents = self.only(Belonging.THIS_LAB) if has_own else self.tree
        self._own = next(map(self._labs.around, self.documents.files), "") if has_own else ""
        lab_of_robots, self._lab_of_packages = self.nearest(robot.path for robot in robots), self.nearest(roots)
        self.robots = [it for it in robots if lab_of_robots is not None and self.lab(it.path) == lab_of_robots]
        self._passed = [
            path for path in roots if self._lab_of_packages is None or self.lab(path) != self._lab_of_packages
        ]
        own = {robot.path for robot in self.robots}
        self.elsewhere = [robot.path for robot in robots if robot.path not in own]
        self.elsewhere += [path for path in self._passed if path.rpartition("/")[2] == MANIFEST]

    def _find_labs(self, robots: Sequence[RobotFile], roots: Sequence[str], wanted: str) -> bool:
        """Find out which labs' folders are searched; return whether there is one of this lab."""
        present = set(map(self._labs.belonging, self._whole.files))
        work = {self._labs.belonging(path) for path in (*(robot.path for robot in robots), *roots)}
        has_own = Belonging.THIS_LAB in present
        of_labs = [robot for robot in robots if not self._labs.is_project(robot.path)]
        is_elsewhere = work == {Belonging.OTHER_LAB} and any(is_wanted(robot, wanted) for robot in of_labs)
        self._allowed = [Belonging.NO_LAB]
        if has_own and not is_elsewhere:
            self._allowed.insert(0, Belonging.THIS_LAB)
        elif Belonging.OTHER_LAB in present and {Belonging.OTHER_LAB} in (work, present):
            robot = find_urdf(self._whole, wanted, None, tuple(of_labs or robots)).path
            self.other_lab = self._labs.around(robot or next(iter([*roots, *self._whole.files])))
            self._allowed.insert(0, Belonging.OTHER_LAB)
        return has_own

    def packages(self, package: str, wanted: str) -> tuple[Package, ...]:
        """Return the packages of the lab."""
        lab = self._lab_of_packages
        return read_packages(self.only(lab), package, wanted) if lab is not None else ()

    def no_package(self, packages: tuple[Package, ...], package: str, wanted: str) -> tuple[str, str]:
        """Return why no package is graded, and which there are."""
        of_other_labs = read_packages(self._whole, package, wanted) if self._passed and not packages else ()
        reason, which = why_none(packages, of_other_labs, package)
        return reason, which + (_built_package(self.tree) if not packages else "")

    def lab(self, path: str) -> Belonging | None:
        """Return where a file is; None of one in the folder of another lab that is not graded."""
        found = self._labs.belonging(path)
        if found is Belonging.OTHER_LAB and not (self.other_lab and path.startswith(f"{self.other_lab}/")):
            return None
        return found

    def nearest(self, paths: Iterable[str]) -> Belonging | None:
        """Return where the nearest of these files are: in the lab's folder, or else in no lab's; None if nowhere."""
        present = set(map(self.lab, paths))
        return next((lab for lab in self._allowed if lab in present), None)

    def only(self, *labs: Belonging) -> Tree:
        """Return the files that are there."""
        if all(self.lab(path) in labs for path in (*self._whole.files, *self._whole.generated)):
            return self._whole
        return self._whole.only(lambda path: self.lab(path) in labs)

    def why_not(self, path: str) -> str:
        """Return why a file that is not as near as others is not graded."""
        return _ELSEWHERE[self._labs.belonging(path)]

    def notes(self, urdf: str | None) -> tuple[str, ...]:
        """Return the notes on the folders that were searched."""
        if self.other_lab:
            why = f"{self._own}, the folder of this lab, has no robot and no package" if self._own else ""
            return (
                f"{why or 'no folder of this lab was found'}: {self.other_lab}, the folder of another lab, was graded",
            )
        if self._own and urdf and self.lab(urdf) is Belonging.NO_LAB:
            return (f"{self._own}, the folder of this lab, has no URDF: {urdf}, which is outside of it, was graded",)
        return ()


def _built_package(tree: Tree) -> str:
    return next((was_not_committed(path) for path in tree.generated if path.endswith(f"/{MANIFEST}")), "")
