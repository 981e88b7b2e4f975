"""The repositories of teams: `{team}/Lab6/{student}`, and the work of a team without such folders."""

import re
from collections.abc import Collection, Iterator
from dataclasses import replace

from grader.classroom.grouping import ClassSubmission, files_below, one_each
from grader.classroom.layouts import PATTERNS, ClassFolder, is_submission
from grader.classroom.listing import ClassListing
from grader.classroom.people import People
from grader.classroom.roster import Student
from grader.files.names import PACKAGE_FILES
from grader.submission.labs import Belonging
from grader.submission.students import is_part

_ROBOT = re.compile(r"\.urdf$|xacro|urdf\b|/package\.xml$")


def teams(folder: ClassFolder) -> Iterator[ClassSubmission]:
    """Yield the submissions of the students in lab folders, and of the teams without one."""
    labs = dict(team_labs(folder))
    rest = [name for name in folder.children.folders if name not in labs.values()]
    yield from one_each(replace(folder, children=folder.children._replace(folders=rest)), "folders")
    for lab, team in labs.items():
        inner = folder.listing.children(lab)
        members = replace(folder, start=f"{lab}/", people=People(()), rubric_id="")
        parts = _parts(folder, inner.folders, team)
        members.ignore(parts, "is named like a part of a submission")
        kept = inner._replace(folders=[name for name in inner.folders if name not in parts])
        for found in one_each(replace(members, children=kept), "folders"):
            name = found.student.login
            yield found._replace(student=Student(f"{team}/{name}", name, login=name, group=team))


def team_labs(folder: ClassFolder) -> Iterator[tuple[str, str]]:
    """Yield the lab folders with students' folders, each with its team.

    A folder of a student stays whole, unless the user has named the layout.
    """
    names = folder.labs
    for team in sorted(folder.children.folders):
        if folder.is_explicit or not folder.people.knows_student(team):
            top = folder.start + team
            below = folder.listing.children(top, 1000).folders
            labs = [f"{top}/{name}" for name in below if names.is_lab(name)]
            others = [name for name in below if names.belonging(f"{name}/") is Belonging.OTHER_LAB]
            others = [f"{top}/{name}" for name in others if not names.is_project(f"{name}/")]
            labs = [lab for lab in labs if _holds_students(folder, lab, team)]
            if not _is_elsewhere(folder.listing, labs, others):
                yield from ((lab, team) for lab in labs)


def _is_elsewhere(listing: ClassListing, labs: list[str], others: list[str]) -> bool:
    """Return whether the robot of an only student is in another lab's folder."""
    are_alone = [len(listing.children(lab).folders) for lab in labs] == [1]
    return are_alone and not _has_robot(listing, labs[0]) and any(_has_robot(listing, lab) for lab in others)


def _holds_students(folder: ClassFolder, lab: str, team: str) -> bool:
    """Return whether the folders in a lab's are those of students, and not the parts of one submission."""
    inner = folder.listing.children(lab, 1000)
    parts = _parts(folder, inner.folders, team)
    names = [f"{name}/" for name in inner.folders] + list(filter(is_submission, inner.files))
    if not PACKAGE_FILES.isdisjoint(inner.files) or not names:
        return False
    known = sum(folder.people.knows(PATTERNS["folders"].sub(r"\g<login>", name), team) for name in names)
    if folder.is_explicit:
        return bool(known) or len(parts) < len(inner.folders)
    tops = [f"{lab}/{name}" for name in inner.folders]
    is_package = any(folder.listing.has(f"{top}/package.xml") for top in tops)
    are_robots = not is_package and sum(_has_robot(folder.listing, top) for top in tops) > 1
    return not parts and (known >= min(len(names), 2) or are_robots)


def _has_robot(listing: ClassListing, top: str) -> bool:
    return any(_ROBOT.search(path.lower()) for path in files_below(listing, top))


def _parts(folder: ClassFolder, names: Collection[str], team: str) -> list[str]:
    """Return the names in a lab's folder that are those of parts of a submission, and not of students."""
    return [name for name in names if is_part(name, folder.lab_words) and not folder.people.knows(name, team)]
