"""The names under which an LMS gives uploaded feedback files to students.

Moodle, "Upload multiple feedback files in a zip" (mod/assign/feedback/file/importziplib.php): a folder named
`name_participant_type_plugin` contains the files of one student. The name must have no underscore. Files that begin
with a dot or `~` are ignored. A file of the same name replaces an earlier one.

Canvas, "Upload Submissions" (app/models/abstract_assignment.rb, infer_comment_context_from_filename): underscores
separate the words of a file name, and LATE is ignored. The first two numbers, or after `anon` the next two words, are
the user and an attachment of the newest submission. The file is shown under the attachment's name, so a report must
have the same file type: for an archive, it is an archive that contains the report. In a group that is graded together,
each member gets the comment (generate_comments_from_files).
"""

import re
import unicodedata
from collections.abc import Collection, Sequence
from pathlib import PurePosixPath

from grader.classroom.students import Student

_MAX_NAME = 60
# Can be read in one way: doejane_LATE_12345_678_robot.urdf, LATE_anon_7kQzB_678_robot.urdf, but not with a third number
# between underscores, as in doejane_7_101_555_robot.urdf.
_PLAIN = re.compile(r"(?:[^_0-9][^_]*(?:_LATE)?_[0-9]+|(?:LATE_)?anon_[^_]+)_[0-9]+_(?![0-9]+_).+", re.DOTALL)
_NOT_UTF8 = re.compile(r"[\ud800-\udfff]")  # no name that Canvas has given, and no zip can have it
_TEXT = frozenset({".txt", ".urdf", ".xacro", ".xml", ".py", ".yaml", ".yml", ".rst"})
ARCHIVES = (".zip", ".tar.gz", ".tgz")


def moodle_folder(student: Student, participant: str) -> str:
    """Return the folder of a student's feedback files; letters, digits and spaces of the name are kept."""
    name = unicodedata.normalize("NFC", student.name or student.key)
    words = "".join(letter if letter.isalnum() or letter in "-'" else " " for letter in name).split()
    return f"{' '.join(words)[:_MAX_NAME].strip() or 'Participant'}_{participant}_assignfeedback_file"


def canvas_target(name: str) -> tuple[str, str] | None:
    """Return whose submission and which attachment Canvas finds by the name of an upload; None if it ignores it."""
    words = [word for word in name.split("_") if word != "LATE"]
    if not words or words[-1].startswith("link") or name.startswith("._") or _NOT_UTF8.search(name):
        return None
    found = words[1:3] if words[0] == "anon" else [word for word in words if re.fullmatch("[0-9]+", word)][:2]
    return (found[0], found[1]) if len(found) == 2 and found[1].isdecimal() else None


def canvas_upload_name(names: Sequence[str], members: Collection[Student], ending: str) -> tuple[str, str]:
    """Return the name under which Canvas gives a report to a submission's students; else an empty name and the reason.

    `names` are the files of the newest attempt, `members` the students whose submission it is, `ending` that of the
    report.
    """
    users = {student.canvas for student in members} - {""}
    certain = [name for name in names if _is_certain(name, users)]
    fitting = sorted((rank, name) for name in certain if (rank := _rank(name, ending)) is not None)
    if fitting:
        return fitting[0][1], ""
    if certain:
        advice = "; Markdown could be" if PurePosixPath(certain[0]).suffix.lower() in _TEXT else ""
        return "", f"Canvas would show the report as {certain[0]!r}, which could not be opened{advice}"
    why = "Canvas would find another student, or none, by the name" if names else "submitted no file in Canvas"
    return "", f"{why} {names[0]!r}" if names else why


def _is_certain(name: str, users: Collection[str]) -> bool:
    """Return whether Canvas finds the correct student: the name has one reading, or the user is one of `users`."""
    target = canvas_target(name)
    return target is not None and (target[0] in users or (not users and _PLAIN.fullmatch(name) is not None))


def _rank(name: str, ending: str) -> int | None:
    """Return how well a report with an ending can be opened under a name, 0 for best; None if it cannot."""
    own = PurePosixPath(name).suffix.lower()
    if own == ending:
        return 0
    if name.lower().endswith(ARCHIVES):
        return 1
    return 2 if ending == ".md" and own in _TEXT else None
