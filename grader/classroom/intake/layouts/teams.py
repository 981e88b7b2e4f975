"""The teams layout: `<team>/Lab6/<Surname>/...` or `<team>/lab6/<login>/lab/...`, with a folder for each student.

A lab folder may also contain a package or a workspace, so only folders that cannot be part of one count as students. A
team without such a lab folder is one submission. If the layout was named, the class folder may itself be a team's
repository.
"""

import re
from collections.abc import Collection, Mapping
from dataclasses import replace

from grader.classroom.intake.layouts.folders import FolderSubmissions
from grader.classroom.intake.layouts.layout import ClassFolder, Submissions
from grader.classroom.intake.names import ending_of, stems_of
from grader.classroom.listing import Children, ClassListing
from grader.classroom.students import ClassSubmission
from grader.files.names import PACKAGE_FILES
from grader.submission.labs import Belonging, LabFolders, lab_words
from grader.submission.students import is_part
from grader.text import enumerated, printable_path

_MAX_TEAMS = 10_000  # with more folders, the layout has to be named
_MAX_NAMES = 1_000  # in one folder
_MAX_NAMED = 10
_MAX_ENTRIES = 300  # that are searched for a URDF
_PARTS = frozenset(
    {
        "src", "urdf", "launch", "rviz", "config", "resource", "resources", "test", "tests", "build", "install", "log",
        "logs", "docs", "doc", "images", "image", "img", "pictures", "picture", "pics", "screenshots", "screenshot",
        "evidence", "answers", "report", "reports", "meshes", "mesh", "worlds", "world", "webots", "models", "model",
        "params", "maps", "include", "scripts", "media", "assets", "code", "final", "old", "backup", "solution",
        "solutions", "package", "packages", "workspace", "ros", "ros2", "homework", "videos", "video", "data",
    }
)  # fmt: skip
_PART = re.compile(
    # task_2, ex3, prelab, post-lab, v2
    r"(?:(?:task|part|step|exercise|ex|(?:pre|post)?[ _-]?lab|question|q|version|v|attempt|submission|try)[ _-]?\d*"
    # my_robot_v2, and the endings of ROS packages and workspaces: lidar_bringup, dev_ws
    r"|my_?robot.*|.*_(?:ws|description|bringup|gazebo|interfaces|msgs|pkg|package|robot|sim|control))"
)
_ROBOT = re.compile(r"\.urdf$|xacro|urdf\b")  # in names of files
_PACKAGE = PACKAGE_FILES | {"CMakeLists.txt"}


def find_labs(folder: ClassFolder) -> dict[str, str]:
    """Return the lab folders with students' folders, each with its team; empty for the repository of one team."""
    start, names = folder.start, LabFolders(folder.lab_folders)
    labs = dict.fromkeys(_labs_below(folder, names, start) if folder.is_explicit else (), "")
    if labs or (len(folder.children.folders) > _MAX_TEAMS and not folder.is_explicit):
        return labs
    own = [name for name in folder.children.folders if not folder.is_explicit and _is_of_student(folder, name)]
    for team in sorted(set(folder.children.folders).difference(own)):
        labs |= dict.fromkeys(_labs_below(folder, names, f"{start}{team}/"), team)
    return labs


def _labs_below(folder: ClassFolder, names: LabFolders, start: str) -> list[str]:
    """Return a team's folders of the lab that hold students'; if none has a robot, another lab's, as `grade` does."""
    below = sorted(folder.listing.children(start.rstrip("/"), _MAX_NAMES).folders)
    own = [start + name for name in below if names.is_lab(name) and _holds_students(folder, start + name)]
    if not folder.is_explicit or any(_has_robot(folder.listing, lab) for lab in own):
        return own
    others = [start + name for name in below if names.belonging(f"{name}/") is Belonging.OTHER_LAB]
    certain = replace(folder, is_explicit=False)
    holding = (lab for lab in others if not names.is_project(f"{lab}/") and _holds_students(certain, lab))
    chosen = next((lab for lab in holding if _has_robot(folder.listing, lab)), "")
    if chosen and all(len(_names_in(folder, lab)) == 1 for lab in (*own, chosen)):
        return []  # of one student: the whole repository is graded, so that the evidence in the lab's folder counts
    return [chosen] if chosen else own


def _names_in(folder: ClassFolder, lab: str) -> Collection[str]:
    inner = folder.listing.children(lab, _MAX_NAMES)
    return stems_of(inner.folders, inner.files)


def find_submissions(folder: ClassFolder) -> Submissions:
    """Return the submissions of the students in lab folders, and of the teams without one."""
    labs = find_labs(folder)
    alone = FolderSubmissions(replace(folder, children=_beside(folder, labs)))
    found = [alone.submission(index) for index in range(len(alone))]
    for lab, team in labs.items():
        inner = folder.listing.children(lab)
        parts = [name for name in inner.folders if _is_part(folder, name)]
        folder.ignored.add_all(f"{lab}/", ((name, "is named like a part of a submission") for name in parts))
        inner = inner._replace(folders=[name for name in inner.folders if name not in parts])
        members = FolderSubmissions(ClassFolder(folder.listing, inner, f"{lab}/", folder.ignored))
        found += (_of_team(members.submission(index), team) for index in range(len(members)))
    names = LabFolders(folder.lab_folders)
    others = [printable_path(lab) for lab in labs if names.belonging(f"{lab}/") is Belonging.OTHER_LAB]
    notes = (
        f"{enumerated(others, _MAX_NAMED)}: another lab is graded, because there is no robot in the folder of this lab",
    )
    return Submissions(found, contested=alone.contested, notes=notes if others else ())


def _beside(folder: ClassFolder, labs: Mapping[str, str]) -> Children:
    """Return what is beside the teams' labs and may be a submission; the rest is ignored, with the reason."""
    teams = {path.removeprefix(folder.start).partition("/")[0] for path in labs}
    rest = folder.children._replace(folders=[name for name in folder.children.folders if name not in teams])
    if "" in labs.values():
        outside = "is outside the folder of the lab"
        folder.ignored.add_all(folder.start, ((name, outside) for name in (*rest.folders, *rest.files)))
        return Children([], [], rest.refused)
    if not folder.lab_folders:
        return rest
    without = [name for name in rest.folders if _has_no_lab(folder, name)]
    reason = f"has no folder {folder.lab_folders[0]!r}, no folder of another lab and no robot"
    folder.ignored.add_all(folder.start, ((name, reason) for name in without))
    return rest._replace(folders=[name for name in rest.folders if name not in without])


def _has_no_lab(folder: ClassFolder, team: str) -> bool:
    """Return whether a repository holds no folder of any lab, no robot and no archive, and is on no roster."""
    if folder.roster is not None and folder.roster.knows_submission(team):
        return False
    names, below = LabFolders(folder.lab_folders), folder.listing.children(folder.start + team, _MAX_NAMES)
    has_lab = any(names.belonging(f"{name}/") is not Belonging.NO_LAB for name in (team, *below.folders))
    return not has_lab and _has_robot(folder.listing, folder.start + team, archives=True) is False


def _is_of_student(folder: ClassFolder, name: str) -> bool:
    """Return whether a folder is one student's by the roster: then it is not split, whatever is in it."""
    return folder.roster is not None and folder.roster.knows(name)


def _of_team(submission: ClassSubmission, team: str) -> ClassSubmission:
    """Return a submission in a team's folder with the team in its key, so that no other team can take it over."""
    student = submission.student
    name = student.login or student.key
    key = f"{team}/{name}" if team else name
    return replace(submission, student=replace(student, key=key, name=name, login=name, team=team))


def is_package(children: Children) -> bool:
    """Return whether a folder looks like one submission: a package's files, or folders named like parts of one."""
    return not _PACKAGE.isdisjoint(children.files) or any(
        name in _PARTS or _PART.fullmatch(name) for name in map(str.lower, children.folders)
    )


def _holds_students(folder: ClassFolder, lab: str) -> bool:
    inner = folder.listing.children(lab, _MAX_NAMES)
    names = stems_of(inner.folders, inner.files)
    if not names or not _PACKAGE.isdisjoint(inner.files) or (is_package(inner) and not folder.is_explicit):
        return False
    known = sum(map(folder.roster.knows_surname, names)) if folder.roster is not None else 0
    if known and known >= min(len(names), 2):
        return True
    if folder.is_explicit:
        return not all(_is_part(folder, name) for name in inner.folders)
    within = [_has_robot(folder.listing, f"{lab}/{name}") for name in inner.folders]
    return within.count(True) >= 2 and None not in within


def _is_part(folder: ClassFolder, name: str) -> bool:
    """Return whether a folder beside those of students is none of them."""
    lab = {word for own in folder.lab_folders for word in lab_words(own)}
    return is_part(name, lab) and not (folder.roster is not None and folder.roster.knows_surname(name))


def _has_robot(listing: ClassListing, top: str, *, archives: bool = False) -> bool | None:
    """Return whether a URDF or package (or archive) is below a folder; None if the folder is itself a package."""
    waiting = [top]
    left = _MAX_ENTRIES
    while waiting and left > 0:
        folder = waiting.pop(0)
        children = listing.children(folder, left)
        left -= len(children.folders) + len(children.files) + 1
        if "package.xml" in children.files:
            return True if folder != top else None
        if any(_ROBOT.search(name.lower()) or (archives and ending_of(name)) for name in children.files):
            return True
        waiting += [f"{folder}/{name}" for name in sorted(children.folders)]
    return False
