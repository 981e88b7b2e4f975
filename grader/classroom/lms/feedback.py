"""What students get back through an LMS.

This is a comment in HTML on their grade, or their report in a zip of all.

Moodle stores the comment unchanged and has it in the next worksheet
(mod/assign/feedback/comments/locallib.php). An HTML comment at its end holds a hash of the words:
without a match, a person has changed or added some.

Moodle, "Upload multiple feedback files in a zip" (mod/assign/feedback/file/importziplib.php): the
folder `name_participant_type_plugin_` has the files of one student; before Moodle 4.1 only with the
last underscore.

Canvas, "Upload Submissions" (app/models/abstract_assignment.rb,
infer_comment_context_from_filename): the first two numbers between underscores are the user and an
attachment of the newest submission. The student sees the file under the attachment's name, each
member of a group, too.
"""

import html
import re
from collections import Counter, defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from pathlib import PurePosixPath

from grader.base.grouping import Strings, StringsByName
from grader.base.patterns import on_use
from grader.base.text import cut, first_lines, format_points
from grader.classroom.roster.roster import Student
from grader.classroom.tables import protected, spelt_out
from grader.files.reading import hash_bytes
from grader.files.zip_writing import make_tar_gz, make_zip
from grader.lab.grading.report import Result
from grader.report.criteria import is_manual

MAX_LINES = 40
_MAX_LINE = 700  # characters: with all lines less than a cell of Excel has
_MARK = on_use(r"<!-- grader ([0-9a-f]{12}) -->")
_TAG = on_use(r"<[^<>]*+>")
NamesInZip = tuple[
    dict[str, str], dict[str, str]
]  # by the student's key: the path in the zip, or why there is none
_NOT_UTF8 = on_use(r"[\ud800-\udfff]")  # no name that Canvas has given, and no zip can have it
_ARCHIVES = (".zip", ".tar.gz", ".tgz")


def lost_points(results: Iterable[Result], *, has_open_zeros: bool = False) -> Iterator[str]:
    """Yield a line for each criterion below its maximum.

    There is one, too, for a criterion with a comment, or with points that no check decides; with
    `has_open_zeros` these count as 0.
    """
    for result in results:
        mark = result.manual_mark
        criterion = result.criterion
        comment = result.comment.text if result.comment else ""
        if mark:
            comment = mark.comment
        if result.points < criterion.points or comment or result.why_given:
            is_hidden = (
                mark is not None
                or result.is_adjusted
                or (comment and result.outcome.status == "passed")
            )
            about = f"{_points_text(result, has_open_zeros=has_open_zeros)}: {criterion.title}"
            message = "" if is_hidden else result.outcome.message
            if message:
                about += f": {message}"
            yield ". ".join(text for text in (about, result.why_given, comment) if text)


def _points_text(result: Result, *, has_open_zeros: bool) -> str:
    """Return the points of a criterion, before its title."""
    points = "–" if result.is_open else format_points(result.points)
    text = f"{points} of {format_points(result.criterion.points)}"
    if result.criterion.bonus:
        text += " (extra credit)"
    if result.is_open and has_open_zeros:
        text += " (counted as 0 for now)"
    if result.outcome.status in ("failed", "skipped") and not is_manual(result):
        text += ", passes when"  # the title is no fact
    return text


def comment_html(opening: str, lines: Sequence[str]) -> str:
    """Return a comment in one line.

    It has first `opening`, which begins with Grade, then a list of lines, of many the first.
    """
    items = "".join(f"<li>{_escape(line)}</li>" for line in first_lines(lines, MAX_LINES))
    text = f"<p>{_escape(opening)}</p>"
    if items:
        text += f"<ul>{items}</ul>"
    text = protected(text)
    return f"{text}<!-- grader {_hash_of_words(text)} -->"


def is_own_comment(text: str) -> bool:
    """Return whether a comment is from `comment_html`, its words unchanged.

    Tags and spaces may have changed.
    """
    mark = _MARK.search(text)
    rest = _MARK.sub("", text, count=1)
    return (
        mark is not None
        and _split_words(rest).startswith("Grade")
        and mark[1] == _hash_of_words(rest)
    )


def _escape(text: str) -> str:
    """Return text on one line of HTML; PHP's CSV reader takes a backslash for an escape."""
    line = cut(spelt_out(" ".join(text.split())), _MAX_LINE)
    return html.escape(line, quote=False).replace("\\", "&#92;")


def _hash_of_words(text: str) -> str:
    return hash_bytes(_split_words(text).encode("utf-8", "replace"))[:12]


def _split_words(text: str) -> str:
    return " ".join(html.unescape(_TAG.sub(" ", text)).split())


def moodle_names(students: Collection[Student], report: str) -> NamesInZip:
    """Return the paths of files called `report`, by the participant numbers of students."""
    names = {}
    without = {}
    counts = Counter(student.moodle for student in students)
    for student in students:
        if not student.moodle:
            without[student.key] = (
                "has no participant number, and no row of a grading worksheet (--into)"
            )
        elif counts[student.moodle] > 1:
            without[student.key] = f"another student has participant number {student.moodle}, too"
        else:
            names[student.key] = f"Participant_{student.moodle}_assignfeedback_file_/{report}"
    return names, without


def canvas_names(submissions: Collection[tuple[Student, Strings]], report: str) -> NamesInZip:
    """Return the names for students and the paths of their files.

    A group that has the same files shares one.
    """
    ending = PurePosixPath(report).suffix
    users = defaultdict(set)
    for student, paths in submissions:
        users[paths].add(student.canvas)
    names = {}
    without = {}
    for student, paths in submissions:
        certain = [
            file for path in paths if _is_certain(file := PurePosixPath(path).name, users[paths])
        ]
        files = [file for file in certain if file.lower().endswith((ending, *_ARCHIVES))]
        if files:  # a report rather than an archive
            names[student.key] = min(
                files, key=lambda file: (not file.lower().endswith(ending), file)
            )
        elif certain:
            endings = ", ".join([ending, *_ARCHIVES])
            without[student.key] = (
                "Canvas shows a report under the name of the submitted file, which must end in "
                f"one of {endings}"
            )
        elif paths:
            without[student.key] = "no submitted file has the Canvas user id in its name"
        else:
            without[student.key] = "nothing was submitted"
    return names, without


def write_feedback(
    reports: Mapping[str, bytes], names: StringsByName, report: str
) -> tuple[bytes, dict[str, str]]:
    """Return the zip of the reports by key, and why a student's is not in it.

    Its bytes depend on the reports only.
    """
    contents = defaultdict(set)
    for key, data in reports.items():
        contents[names[key]].add(data)
    files = {}
    without = {}
    for key, data in reports.items():
        name = names[key]
        if len(contents[name]) == 1:
            files[name] = _packed(name, report, data)
        else:
            without[key] = (
                "the members of the group have different reports, and Canvas gives one to all of "
                "them"
            )
    return make_zip(files), without


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
    return (make_zip if name.lower().endswith(".zip") else make_tar_gz)({report: data})
