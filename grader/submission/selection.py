"""What of a submission is graded: the files of this lab, and of these the URDF and the package."""

from collections.abc import Mapping
from typing import NamedTuple

from grader.files.tree import Tree
from grader.package.package import MANIFEST, Package
from grader.submission.labs import lab_words
from grader.submission.packages import best_named, package_around, why_not
from grader.submission.scope import Scope, lab_scope
from grader.submission.search import find_urdf, is_of_lab
from grader.submission.students import StudentWork, students_beside, students_in
from grader.submission.submission import Lab
from grader.submission.urdf import OtherCandidate
from grader.text import enumerated

_MAX_WORKS = 1000  # robots of which the student is determined
_MAX_NAMED = 5  # folders in a note
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


def _students(scope: Scope, names: Mapping[str, str], words: set[str], lab: Lab) -> tuple[str, ...]:
    """Return the folders of the students if the robots and packages are of several; `names` are those of packages."""
    robots = (robot for robot in scope.robots[:_MAX_WORKS] if robot.size)
    works = [StudentWork(robot.path.rpartition("/")[0], is_of_lab(robot, lab.urdf)) for robot in robots]
    works += [StudentWork(folder, is_of_lab=True) for folder, name in names.items() if name == lab.package]
    return students_in(works, names, words, lab.package) if len(works) > 1 else ()
