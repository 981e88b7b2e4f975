"""Comments that ignore the problems of a line: `# grader:ignore REF004, topic-type`.

A blank after the colon would make YAML of the comment: in a URDF it then ends the parameter
robot_description, which is read as YAML.
"""

import re
from collections.abc import Iterator
from functools import partial
from typing import NamedTuple

from grader.base.problems import Kind, Problem
from grader.base.source import Location, Source

_MARK = "grader:ignore"
MARK = _MARK.encode()
_NAME = r"(?:[A-Z]+[0-9]*|[a-z]+(?:-[a-z]+)+)"  # of a code or a rule
_COMMENT = re.compile(rf"{_MARK}\b[ \t]*({_NAME}(?:[ \t]*,[ \t]*{_NAME})*)?")
_XML = (".xml", ".urdf", ".xacro", ".launch", ".sdf", ".world", ".srdf")
_SLASHES = (".cpp", ".cc", ".cxx", ".c", ".hpp", ".hh", ".h")
_NUMBER_SIGN = (".py", ".yaml", ".yml", ".rviz", ".cfg", ".cmake", "CMakeLists.txt")
COMMENTED = (*_XML, *_SLASHES, *_NUMBER_SIGN)  # the ends of the names of files with comments

_warning = partial(Kind, severity="warning", effect="other")
_USELESS = _warning("IGN001", "Comment that ignores nothing")
COMMENT_CATALOGUE = (_USELESS,)


class IgnoreComment(NamedTuple):
    """A comment that ignores problems in some lines, by their codes, the beginnings of these, or
    their rules.
    """

    location: Location
    codes: tuple[str, ...]
    last: int  # the last of these lines; the first is that of its location

    def matching(self, problem: Problem) -> list[str]:
        """Return the codes by which it ignores a problem."""
        where = problem.location
        if where.path != self.location.path or not self.location.line <= where.line <= self.last:
            return []
        return [code for code in self.codes if problem.is_meant_by(code)]

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
    for found in _COMMENT.finditer(text):
        start, end = _comment_around(path, text, found)
        if start < 0:
            continue
        line = text.rfind("\n", 0, start) + 1
        beside = text[line:start] + text[end : _end_of_line(text, end)]
        is_alone = beside.strip("\ufeff \t\r") == ""
        last = _line_after(source, end) if is_alone else source.at(end).line
        codes = tuple(re.findall(_NAME, found[1] or ""))
        yield IgnoreComment(source.at(found.start()), codes, last)


def _comment_around(path: str, text: str, found: re.Match[str]) -> tuple[int, int]:
    """Return where the comment around a mark starts and ends; -1 if it is in none."""
    if path.endswith(_XML):
        start, end = text.rfind("<!--", 0, found.start()), text.find("-->", found.end())
        if start < 0 or end < 0 or "-->" in text[start : found.start()]:
            return -1, -1
        return start, end + len("-->")
    line = text.rfind("\n", 0, found.start()) + 1
    signs = ("//", "/*") if path.endswith(_SLASHES) else ("#",)
    starts = [text.find(sign, line, found.start()) for sign in signs]
    return max(starts), _end_of_line(text, found.end())


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
