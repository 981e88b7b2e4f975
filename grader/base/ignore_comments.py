"""Comments that ignore the problems of a line: `# grader:ignore REF004, topic-type`.

A blank after the colon would make YAML of the comment: in a URDF it then ends the parameter
robot_description, which is read as YAML.
"""

import re
from collections.abc import Iterator
from functools import partial
from itertools import pairwise
from typing import NamedTuple

from grader.base.problems import Kind, Problem
from grader.base.source import Location, Source
from grader.base.text import comment_spans

_MARK = "grader:ignore"
MARK = _MARK.encode()
_NAME = r"(?:[A-Z]++[0-9]*+|[a-z]++(?:-[a-z]++)++)"  # of a code or a rule
_COMMENT = re.compile(rf"{_MARK}\b[ \t]*({_NAME}(?:[ \t]*,[ \t]*{_NAME})*)?")
_XML = (".xml", ".urdf", ".xacro", ".launch", ".sdf", ".world", ".srdf")
_SLASHES = (".cpp", ".cc", ".cxx", ".c", ".hpp", ".hh", ".h")
_NUMBER_SIGN = (".py", ".yaml", ".yml", ".rviz", ".cfg", ".cmake", "CMakeLists.txt")
COMMENTED = (*_XML, *_SLASHES, *_NUMBER_SIGN)  # the ends of the names of files with comments

_warning = partial(Kind, severity="warning", effect="other")
_USELESS = _warning("IGN001", "Comment that ignores nothing")
COMMENT_CATALOGUE = (_USELESS,)


class IgnoreComment(NamedTuple):
    """A comment that ignores problems in some lines.

    It names them by their codes, the beginnings of these, or their rules.
    """

    location: Location
    codes: tuple[str, ...]
    last: int  # the last of these lines; the first is that of its location

    def matching(self, problem: Problem) -> list[str]:
        """Return the codes by which it ignores a problem."""
        if not self._is_beside(problem.location) and not self._is_beside(problem.around):
            return []
        return [code for code in self.codes if problem.is_meant_by(code)]

    def _is_beside(self, where: Location | None) -> bool:
        """Return whether a place is in the lines of which it ignores problems."""
        if where is None or where.path != self.location.path:
            return False
        return self.location.line <= where.line <= self.last

    def useless_problem(self, codes: list[str]) -> Problem:
        """Return the problem that codes of it ignore nothing."""
        if codes:
            lines = f"line {self.last}"
            if self.last > self.location.line + 1:
                lines = f"lines {self.location.line + 1} to {self.last}"
            message = f"{_MARK} {', '.join(codes)}: no such problem is in {lines}"
        else:
            message = f"{_MARK} names no code, and ignores nothing: write {_MARK} REF001"
        return Problem(_USELESS, message, self.location)


def read_ignore_comments(path: str, text: str) -> Iterator[IgnoreComment]:
    """Yield the comments of a file that ignore problems.

    A comment beside something ignores problems of its line. One that is alone in its lines ignores
    those of the next line; in XML those of the whole tag that begins there, since no comment can be
    in it.
    """
    source = Source(path, text)
    marks = iter(_COMMENT.finditer(text))
    mark = next(marks, None)
    for start, end in _xml_comments(text) if path.endswith(_XML) else _line_comments(path, text):
        while mark is not None and mark.start() < start:
            mark = next(marks, None)
        last = 0
        while mark is not None and mark.start() < end:
            last = last or _last_line(source, start, end)
            yield IgnoreComment(
                source.at(mark.start()),
                tuple(mark[1].replace(",", " ").split() if mark[1] else ()),
                last,
            )
            mark = next(marks, None)


def _last_line(source: Source, start: int, end: int) -> int:
    """Return the last line of which a comment ignores problems."""
    text = source.text
    line = text.rfind("\n", 0, start) + 1
    beside = text[line:start] + text[end : _end_of_line(text, end)]
    is_alone = beside.strip("\ufeff \t\r") == ""
    return _line_after(source, end) if is_alone else source.at(end).line


def _xml_comments(text: str) -> Iterator[tuple[int, int]]:
    """Yield where each comment of XML starts and ends."""
    for start, end in comment_spans(text):
        yield start, end + len("-->")


def _line_comments(path: str, text: str) -> Iterator[tuple[int, int]]:
    """Yield where each comment in a line with a mark starts and ends."""
    signs = ("//", "/*") if path.endswith(_SLASHES) else ("#",)
    mark = text.find(_MARK)
    while mark >= 0:
        line, end = text.rfind("\n", 0, mark) + 1, _end_of_line(text, mark)
        places = sorted(text.find(sign, line, end) for sign in signs)
        starts = [place for place in places if place >= 0]
        yield from pairwise((*starts, end))
        mark = text.find(_MARK, end)


def _end_of_line(text: str, at: int) -> int:
    end = text.find("\n", at)
    return len(text) if end < 0 else end


def _line_after(source: Source, end: int) -> int:
    """Return the line after a comment; the last one of the tag that begins there."""
    text = source.text
    start = _end_of_line(text, end) + 1
    close = text.find(">", start)
    if text[start : _end_of_line(text, start)].lstrip().startswith("<") and close >= 0:
        return source.at(close).line
    return source.at(min(start, len(text))).line
