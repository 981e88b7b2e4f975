"""What of a submission is graded: the files of this lab, and of these the URDF and the package."""

from collections.abc import Iterable, Sequence
from typing import NamedTuple

from grader.files.tree import Tree
from grader.package.package import MANIFEST, SETUP, Package
from grader.submission.labs import Belonging, LabFolders, lab_words
from grader.submission.packages import best_named, package_around, read_packages, why_none, why_not
from grader.submission.robots import RobotFile, find_robots
from grader.submission.search import find_urdf, is_wanted
from grader.submission.students import Work, students_beside, students_in
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

    `packages` are all of the lab, and `no_package` says why none of them is graded, and which there are. `students` are the folders of several students, if
    the submission holds theirs. `other_lab` is the folder of another lab that is graded.
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
    """Select what is graded, given what the rubric says: the URDF's path, the package's name, the names of the lab's folder.

    Where the lab's folder exists, it decides: a file in no lab's folder is graded only if the lab's has none of its kind. Another
    lab's folder is used only if no robot and no package is anywhere else, and if the lab's folder exists, only for the robot that the
    rubric names. `limit` is in bytes of a URDF.
    """
    robots = find_robots(tree, wanted.rpartition("/")[2], limit)
    roots = [path for path in tree.files if path.rpartition("/")[2] in (MANIFEST, SETUP)]
    scope = _Scope(tree, robots, roots, wanted, folders)
    lab_of_robots, lab_of_packages = scope.nearest(robot.path for robot in robots), scope.nearest(roots)
    candidates = tuple(
        robot for robot in robots if lab_of_robots is not None and scope.lab(robot.path) == lab_of_robots
    )
    packages = read_packages(scope.only(lab_of_packages), package, wanted) if lab_of_packages is not None else ()
    named = best_named(packages, package)
    preferred = named or next(iter(packages), None)
    urdf, others = find_urdf(scope.tree, wanted, preferred.folder if preferred else None, candidates)
    graded = named or package_around(packages, urdf)
    others += tuple(
        OtherCandidate(it.path(MANIFEST), why_not(graded, it, wanted)) for it in packages if it is not graded
    )
    elsewhere = [robot.path for robot in robots if lab_of_robots is None or scope.lab(robot.path) != lab_of_robots]
    passed = [path for path in roots if lab_of_packages is None or scope.lab(path) != lab_of_packages]
    elsewhere += [path for path in passed if path.rpartition("/")[2] == MANIFEST]
    others += tuple(OtherCandidate(path, scope.why_not(path)) for path in elsewhere[:_MAX_ELSEWHERE])
    names = {it.folder: it.name for it in packages}
    works = [Work(it.path.rpartition("/")[0], is_wanted(it, wanted)) for it in candidates[:_MAX_WORKS] if it.size]
    works += [Work(folder, is_wanted=True) for folder, name in names.items() if name == package]
    lab = {word for name in folders for word in lab_words(name)}
    students = students_in(works, names, lab, package) if len(works) > 1 else ()
    of_other_labs = read_packages(tree, package, wanted) if passed and not packages else ()
    reason, which = why_none(packages, of_other_labs, package)
    no_package = reason, which + (_built_package(scope.tree) if not packages else "")
    notes = list(scope.notes(urdf))
    if urdf is not None and not students:
        own, beside = students_beside(urdf.rpartition("/")[0], scope.documents.folders, names, lab, package)
        notes += [_BESIDE.format(others=enumerated(beside, _MAX_NAMED), own=own)] if beside else []
    return Selection(
        scope.documents, urdf, graded, packages, no_package, others, tuple(notes), students, scope.other_lab
    )


class _Scope:
    """The part of a submission in which its lab is searched: `tree`, and `documents` without what is outside of the lab's folder."""

    def __init__(
        self, tree: Tree, robots: Sequence[RobotFile], roots: Sequence[str], wanted: str, folders: Sequence[str]
    ) -> None:
        self._whole = tree
        self._labs = LabFolders(folders, tree.files)
        self.other_lab = ""
        present = set(map(self._labs.belonging, tree.files))
        work = {self._labs.belonging(path) for path in (*(robot.path for robot in robots), *roots)}
        has_own = Belonging.THIS_LAB in present
        of_labs = [robot for robot in robots if not self._labs.is_project(robot.path)]
        is_elsewhere = work == {Belonging.OTHER_LAB} and any(is_wanted(robot, wanted) for robot in of_labs)
        if has_own and not is_elsewhere:
            self._allowed = [Belonging.THIS_LAB, Belonging.NO_LAB]
        elif work == {Belonging.OTHER_LAB} or present == {Belonging.OTHER_LAB}:
            best = find_urdf(tree, wanted, None, tuple(of_labs or robots)).path or next(iter([*roots, *tree.files]))
            self.other_lab = self._labs.around(best)
            self._allowed = [Belonging.OTHER_LAB, Belonging.NO_LAB]
        else:
            self._allowed = [Belonging.NO_LAB]
        self.tree = self.only(*self._allowed)
        self.documents = self.only(Belonging.THIS_LAB) if has_own else self.tree
        self._own = next(map(self._labs.around, self.documents.files), "") if has_own else ""

    def lab(self, path: str) -> Belonging | None:
        """Return where a file is; None of one in the folder of another lab that is not graded."""
        found = self._labs.belonging(path)
        if found is Belonging.OTHER_LAB and not (self.other_lab and path.startswith(f"{self.other_lab}/")):
            return None
        return found

    def nearest(self, paths: Iterable[str]) -> Belonging | None:
        """Return where the nearest of these files are: in the lab's folder, or else in no lab's folder; None if nowhere."""
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
