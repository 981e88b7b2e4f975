"""Name the reports of a class as an LMS expects them, and write them into a zip.

Moodle, "Upload multiple feedback files in a zip" (mod/assign/feedback/file/importziplib.php): the folder
`name_participant_type_plugin_` has the files of one student; before Moodle 4.1 only with the last underscore.

Canvas, "Upload Submissions" (app/models/abstract_assignment.rb, infer_comment_context_from_filename): the first two
numbers between underscores are the user and an attachment of the newest submission. The student sees the file under the
attachment's name, each member of a group, too.
"""

import re
from collections import Counter, defaultdict
from collections.abc import Collection, Mapping
from pathlib import PurePosixPath

from grader.classroom.roster import Student
from grader.files.zip_writing import tar_gz_of, zip_of

Names = tuple[dict[str, str], dict[str, str]]  # by the student's key: the path in the zip, or why there is none
_NOT_UTF8 = re.compile(r"[\ud800-\udfff]")  # no name that Canvas has given, and no zip can have it
_ARCHIVES = (".zip", ".tar.gz", ".tgz")


def moodle_names(students: Collection[Student], report: str) -> Names:
    """Return the paths of files called `report`, by the participant numbers of students."""
    names, without, counts = dict[str, str](), dict[str, str](), Counter(student.moodle for student in students)
    for student in students:
        if student.moodle and counts[student.moodle] == 1:
            names[student.key] = f"Participant_{student.moodle}_assignfeedback_file_/{report}"
        elif student.moodle:
            without[student.key] = f"another student has participant number {student.moodle}, too"
        else:
            without[student.key] = "has no participant number, and no row of a grading worksheet (--into)"
    return names, without


def canvas_names(submissions: Collection[tuple[Student, tuple[str, ...]]], report: str) -> Names:
    """Return the names for students and the paths of their files; a group that has the same files shares one."""
    names, users, ending = dict[str, str](), defaultdict[tuple[str, ...], set[str]](set), PurePosixPath(report).suffix
    for student, paths in submissions:
        users[paths].add(student.canvas)
    for student, paths in submissions:
        files = [PurePosixPath(path).name for path in paths if path.lower().endswith((ending, *_ARCHIVES))]
        if certain := [file for file in files if _is_certain(file, users[paths])]:
            names[student.key] = min(certain, key=lambda file: (not file.lower().endswith(ending), file))
    why = f"submitted no {ending} file or archive with the Canvas user id in its name"
    return names, {student.key: why for student, _ in submissions if student.key not in names}


def write_feedback(reports: Mapping[str, bytes], names: Mapping[str, str], report: str) -> tuple[bytes, dict[str, str]]:
    """Return the zip of the reports by key, whose bytes depend on them only, and why a student's is not in it."""
    contents = defaultdict[str, set[bytes]](set)
    for key, data in reports.items():
        contents[names[key]].add(data)
    why = "the members of the group have different reports, and Canvas gives one to all of them"
    without = {key: why for key in reports if len(contents[names[key]]) > 1}
    files = {name: _packed(name, report, *found) for name, found in contents.items() if len(found) == 1}
    return zip_of(files), without


def _is_certain(file: str, users: Collection[str]) -> bool:
    """Return whether Canvas finds one of the users by a file's name."""
    words = file.split("_")
    ids = [word for word in words if re.fullmatch("[0-9]+", word)]
    is_ignored = words[-1].startswith("link") or file.startswith("._") or _NOT_UTF8.search(file)
    return len(ids) > 1 and ids[0] in users and not is_ignored


def _packed(name: str, report: str, data: bytes) -> bytes:
    """Return a report, in an archive if its name is that of one."""
    if not name.lower().endswith(_ARCHIVES):
        return data
    return (zip_of if name.lower().endswith(".zip") else tar_gz_of)({report: data})
