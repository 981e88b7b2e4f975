"""What of a submission is graded: where its lab is searched, and of these files the URDF and the package."""

from collections.abc import Collection, Sequence
from typing import NamedTuple

from grader.files.names import PACKAGE_FILES
from grader.files.tree import Tree
from grader.package.package import MANIFEST, Package
from grader.submission.labs import Belonging, LabFolders
from grader.submission.packages import best_named, package_around, read_packages, why_none, why_not
from grader.submission.robots import find_robots
from grader.submission.search import ELSEWHERE, UrdfChoice, find_urdf
from grader.submission.submission import Lab, Opening
from grader.submission.urdf import OtherCandidate
from grader.text import enumerated, was_not_committed

_MAX_ELSEWHERE = 40
_MAX_NAMED = 5  # robots in a note


class Selection(NamedTuple):
    """Where a lab is searched, and what of it is graded: the URDF of `choice`, and `package`; documents are in `tree`.

    If the lab has a folder, `tree` is only that folder, `own_folder`. `other_lab` is the folder of another lab that is
    searched as well. `no_package` says why none of the `packages` is graded, and which there are. `others` are robots
    and packages that are not graded, `notes` are on the choice, and `several` is the one if several robots fit.
    """

    choice: UrdfChoice
    tree: Tree
    packages: tuple[Package, ...]
    no_package: tuple[str, str]
    others: tuple[OtherCandidate, ...]
    own_folder: str
    other_lab: str
    package: Package | None = None
    notes: tuple[str, ...] = ()
    several: str = ""


def select(tree: Tree, lab: Lab, opening: Opening) -> Selection:
    """Select what is graded of the files of a submission."""
    found = _searched(tree, lab, opening)
    packages, (urdf, others, fitting) = found.packages, found.choice
    named, around = best_named(packages, lab.package), package_around(packages, urdf)
    graded = around if named is None or (around is not None and around.name == named.name) else named
    others += tuple(
        OtherCandidate(it.path(MANIFEST), why_not(graded, it, lab.urdf)) for it in packages if it is not graded
    )
    several = ""
    if fitting:
        which = f"{urdf} was graded, not {enumerated(fitting, _MAX_NAMED)}"
        several = f"{len(fitting) + 1} robots fit this lab: {which}; to grade another one, name its file or folder"
    notes = tuple(filter(None, (several, _note(found))))
    return found._replace(package=graded, others=others + found.others, notes=notes, several=several)


def _note(found: Selection) -> str:
    """Return the note on the folders that were searched, if there is one."""
    why, urdf = f"{found.own_folder}, the folder of this lab, has no robot of this lab", found.choice.path
    if found.other_lab:
        why = why if found.own_folder else "no folder of this lab was found"
        return f"{why}: {found.other_lab}, the folder of another lab, was graded"
    is_outside = found.own_folder and urdf and urdf not in found.tree.files
    return f"{why}: {urdf}, which is outside of it, was graded" if is_outside else ""


class _Places(NamedTuple):
    """The places of a submission that are searched; of other labs only the one in `other_lab`."""

    labs: LabFolders
    other_lab: str

    def of(self, path: str) -> Belonging | None:
        """Return where a file is; None of one in the folder of another lab that is not searched."""
        place = self.labs.belonging(path)
        is_open = place is not Belonging.OTHER_LAB or (self.other_lab and path.startswith(f"{self.other_lab}/"))
        return place if is_open else None

    def only(self, tree: Tree, places: Collection[Belonging]) -> Tree:
        """Return the files that are in these places."""
        if all(self.of(path) in places for path in (*tree.files, *tree.generated)):
            return tree
        return tree.only(lambda path: self.of(path) in places)


def _searched(tree: Tree, lab: Lab, opening: Opening) -> Selection:
    """Return where a lab is searched in the files of a submission, and which of its robots is graded.

    Another lab's folder is searched only if its robot is graded, or if there is nothing else. Where the lab's folder
    exists, no robot of a final project is graded.
    """
    labs = LabFolders(lab.folders, tree.files)
    robots = find_robots(tree, lab.urdf.rpartition("/")[2], opening.max_size)
    roots = [path for path in tree.files if path.rpartition("/")[2] in PACKAGE_FILES]
    has_own = any(labs.belonging(path) is Belonging.THIS_LAB for path in tree.files)
    projects = {it.path for it in robots if labs.belonging(it.path) is Belonging.OTHER_LAB and labs.is_project(it.path)}
    projects = projects if has_own or len(projects) < len(robots) else set()
    choice = find_urdf(tree, lab, tuple(it for it in robots if it.path not in projects), labs, opening)
    places = _Places(labs, _other_lab(tree, labs, choice.path, () if has_own else roots))
    search_tree = places.only(tree, tuple(Belonging))
    own_tree = places.only(tree, (Belonging.THIS_LAB,)) if has_own else search_tree
    of_packages = min((place for place in map(places.of, roots) if place is not None), default=None)
    packages = read_packages(places.only(tree, (of_packages,)), lab) if of_packages is not None else ()
    other_roots = [path for path in roots if places.of(path) is None or places.of(path) is not of_packages]
    elsewhere = [*sorted(projects), *(path for path in other_roots if path.rpartition("/")[2] == MANIFEST)]
    of_other_labs = read_packages(tree, lab) if other_roots and not packages else ()
    reason, which = why_none(packages, of_other_labs, lab.package)
    built = next((was_not_committed(path) for path in search_tree.generated if path.endswith(f"/{MANIFEST}")), "")
    return Selection(
        choice,
        own_tree,
        packages,
        (reason, which + ("" if packages else built)),
        tuple(OtherCandidate(path, ELSEWHERE[labs.belonging(path)]) for path in elsewhere[:_MAX_ELSEWHERE]),
        next(map(labs.around, own_tree.files), "") if has_own else "",
        places.other_lab,
    )


def _other_lab(tree: Tree, labs: LabFolders, urdf: str | None, roots: Sequence[str]) -> str:
    """Return the folder of another lab that is searched: that of the URDF; without one, if there is nothing else."""
    if urdf is not None:
        return labs.around(urdf) if labs.belonging(urdf) is Belonging.OTHER_LAB else ""
    others = {Belonging.OTHER_LAB}
    is_only = others in (set(map(labs.belonging, roots)), set(map(labs.belonging, tree.files)))
    return labs.around(next(iter([*roots, *tree.files]))) if is_only else ""
