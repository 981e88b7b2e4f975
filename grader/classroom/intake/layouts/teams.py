"""Team repositories: `<team>/Lab6/<Surname>/...` or `<team>/lab6/<login>/lab/...`, a folder of the lab with one for each student.

A lab folder may as well hold a package or a workspace, so only what cannot be one is taken for students. Teams without such a
folder stay one hand-in each.
"""

import re
from collections.abc import Callable
from dataclasses import replace

from grader.classroom.intake.layouts.folders import find_submissions as find_folder_submissions
from grader.classroom.intake.layouts.layout import IgnoredFiles, SubmissionList, listed
from grader.classroom.intake.listing import Children, Listing
from grader.classroom.intake.names import ending_of
from grader.classroom.students import ClassSubmission

_MAX_TEAMS = 10_000  # beyond which nobody looks for teams unasked
_MAX_NAMES = 1_000  # in one folder
_MAX_SEEN = 300  # entries that are looked at for a URDF
_PARTS = frozenset(
    {
        "src", "urdf", "launch", "rviz", "config", "resource", "resources", "test", "tests", "build", "install", "log",
        "logs", "docs", "doc", "images", "image", "img", "pictures", "picture", "pics", "screenshots", "screenshot", "evidence",
        "answers", "report", "reports", "meshes", "mesh", "worlds", "world", "webots", "models", "model", "params", "maps",
        "include", "scripts", "media", "assets", "code", "final", "old", "backup", "solution", "solutions", "package", "packages",
        "workspace", "ros", "ros2", "homework", "videos", "video", "data",
    }
)  # fmt: skip
_PART = re.compile(
    r"(?:(?:task|part|step|exercise|ex|(?:pre|post)?[ _-]?lab|question|q|version|v|attempt|submission|try)[ _-]?\d*"
    r"|my_?robot.*|.*_(?:ws|description|bringup|gazebo|interfaces|msgs|pkg|package|robot|sim|control))"
)
_PACKAGE = frozenset({"package.xml", "setup.py", "CMakeLists.txt"})


def lab_folder(rubric_id: str) -> re.Pattern[str]:
    """What a lab's folder may be called: of `lab6` it is Lab6, lab_6 and Lab 06."""
    words = re.findall(r"[^\W\d_]+|\d+", rubric_id.casefold())
    parts = [f"0*{int(word)}" if word.isdecimal() else re.escape(word) for word in words]
    return re.compile(r"[\s_-]*".join(parts) or r"(?!)", re.IGNORECASE)


def find_labs(
    listing: Listing,
    children: Children,
    start: str,
    rubric_id: str,
    knows: Callable[[str], bool] | None,
    *,
    is_told: bool = False,
) -> dict[str, str]:
    """The lab folders that hold students' folders, each with its team; `is_told` where the user says that there are teams."""
    labs: dict[str, str] = {}
    pattern = lab_folder(rubric_id)
    if len(children.folders) > _MAX_TEAMS and not is_told:
        return labs
    for team in sorted(children.folders):
        for name in sorted(listing.children(start + team, _MAX_NAMES).folders):
            lab = f"{start}{team}/{name}"
            if pattern.fullmatch(name) and _holds_students(listing, lab, knows, is_told=is_told):
                labs[lab] = team
    return labs


def find_submissions(
    listing: Listing,
    children: Children,
    start: str,
    ignored: IgnoredFiles,
    rubric_id: str,
    knows: Callable[[str], bool] | None,
    labs: dict[str, str],
) -> SubmissionList:
    """The hand-ins of the students in these lab folders, and of the teams without one."""
    teams = set(labs.values())
    rest = children._replace(folders=[name for name in children.folders if name not in teams])
    alone = find_folder_submissions(listing, rest, start, ignored, rubric_id, knows)
    hand_ins = [alone.hand_in(index) for index in range(len(alone))]
    for lab, team in labs.items():
        shelf = find_folder_submissions(listing, listing.children(lab), f"{lab}/", ignored)
        hand_ins += (_of_team(shelf.hand_in(index), team) for index in range(len(shelf)))
    return replace(listed(hand_ins), contested=alone.contested)


def _of_team(hand_in: ClassSubmission, team: str) -> ClassSubmission:
    """A submission in a team's folder: its key has the team in front, so that no other team can take it over."""
    student = hand_in.student
    name = student.login or student.key
    return replace(hand_in, student=replace(student, key=f"{team}/{name}", name=name, login=name, team=team))


def is_part(name: str) -> bool:
    """Whether a folder is called like a part of a package, a workspace or a report, and so hardly like a student."""
    lower = name.lower()
    return lower in _PARTS or _PART.fullmatch(lower) is not None


def is_package(children: Children) -> bool:
    """Whether a folder looks like one submission: it has a package's files, or folders that are called like parts of one."""
    return not _PACKAGE.isdisjoint(children.files) or any(is_part(name) for name in children.folders)


def _holds_students(listing: Listing, lab: str, knows: Callable[[str], bool] | None, *, is_told: bool) -> bool:
    inner = listing.children(lab, _MAX_NAMES)
    names = inner.folders + [name.removesuffix(ending_of(name)) for name in inner.files if ending_of(name)]
    if not names or is_package(inner):
        return False
    known = sum(map(knows, names)) if knows else 0
    if known and known >= min(len(names), 2):
        return True
    if is_told:
        return bool(inner.folders)
    within = [_has_robot(listing, f"{lab}/{name}") for name in inner.folders]
    return within.count(True) >= 2 and None not in within


def _has_robot(listing: Listing, folder: str) -> bool | None:
    """Whether a URDF or a package is somewhere in a folder; None where the folder is itself a package."""
    waiting = [folder]
    left = _MAX_SEEN
    while waiting and left > 0:
        where = waiting.pop(0)
        children = listing.children(where, left)
        left -= len(children.folders) + len(children.files) + 1
        if "package.xml" in children.files:
            return True if where != folder else None
        if any(name.lower().endswith(".urdf") for name in children.files):
            return True
        waiting += [f"{where}/{name}" for name in sorted(children.folders)]
    return False
