"""The files that the grader has written: of all that it reads, only these are replaced."""

import os
import stat
from collections.abc import Iterable
from pathlib import Path

from grader.base.errors import InputError
from grader.base.patterns import on_use
from grader.base.text import printable_path
from grader.files.reading import read_start

_MAX_START = 4096  # bytes of a file, in which its mark is
_TEXT_ENDINGS = (".txt", ".concise")  # of reports that are empty without a finding
# How each format begins, in the order of the rows.
_MARKS = (
    rb'\s*\{\s*"schema": "(?:grader|classroom50)/',  # every JSON of the grader, and Classroom 50's
    rb'\{\n "score": [0-9.]+,\n "output": "#',  # Gradescope's
    rb'\{\n "\$schema": ".*\n.*\n.*\n "tool": \{"driver": \{"name": "grader"',  # SARIF
    rb'\[(?:\]\n\Z|\n \{"description": ".*"check_name": )',  # code quality
    rb"<\?xml version='1.0' encoding='utf-8'\?>\n<testsuites name=",  # JUnit
    rb'<svg xmlns="http://www.w3.org/2000/svg" class="drawing" ',
    rb'<!DOCTYPE html>\n(?:.*\n){1,9}<meta name="generator" content="grader ',
    rb"::(?:notice|warning|error) ",  # annotations of GitHub
    rb".+:[0-9]+:[0-9]+: [A-Za-z0-9_-]+ ",  # concise
    rb"digraph graph_of_launch \{\n",
    rb"flowchart LR\n(?:  [nt][0-9]+[\[(]|\Z)",
    rb"# .+: .*\n\n\*\*.*points",  # Markdown
    # On a terminal: a submission, a robot, a workspace, a graph.
    rb".+: .*\n(?:.*\n)?.*[0-9] points\b",
    rb".+:\s+(?:ROS 2\s+(?:loads|rejects)|xacro that cannot)\s",
    rb".+:\s+(?:[0-9]+ (?:error|warning|note)s?\b|no (?:other )?problems|the\s+names\s+agree)",
    rb".+:\s+[0-9]+\s+nodes?,\s+[0-9]+\s+connections?,\s",
    rb"(?:\xef\xbb\xbf)?id.name.section.status.grade\b",  # the grades of a class
    rb"PK\x03\x04\x14\x00\x00\x00\x08\x00\x00\x00!\x00",  # a spreadsheet of XlsxWriter
    rb"PK\x05\x06\x00{18}\Z",  # feedback: a zip without files, and one of reports
    rb"PK\x03\x04\x14\x00\x00\x00\x00\x00\x00\x00!\x00(?s:.{16}[^\x00]{0,400}?)report\.(?:html|md)",
)
_MARK = on_use(b"|".join(_MARKS))


def refuse_other_file(
    option: str, file: Path, folders: Iterable[Path], header: bytes | None = None
) -> None:
    """Raise InputError if an existing file may be read, and the grader has not written it.

    It may be read if it is in one of the folders, also by another path or a link. A table whose
    first line is `header` is taken for one that the grader has written.
    """
    path = Path(os.path.realpath(file))
    try:
        status = path.stat()
    except (OSError, ValueError):  # it does not exist
        return
    is_outside = {Path(os.path.realpath(each)) for each in folders}.isdisjoint(path.parents)
    if not stat.S_ISREG(status.st_mode) or (is_outside and status.st_nlink == 1):
        return
    if _is_written(path, header):
        return
    raise InputError(
        f"cannot write {printable_path(file)}: it exists, and the grader did not write it; name "
        f"another file for {option}"
    )


def _is_written(path: Path, header: bytes | None) -> bool:
    """Return whether a file begins as one that the grader has written, or with the header."""
    start = read_start(path, _MAX_START)
    if not start:
        return path.suffix in _TEXT_ENDINGS and path.name != "CMakeLists.txt"
    return start.partition(b"\n")[0] == header or _MARK.match(start) is not None
