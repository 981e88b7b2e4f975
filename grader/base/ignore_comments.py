"""Comments that ignore the problems of a line: `# grader:ignore REF004, topic-type`.

A blank after the colon would make YAML of the comment: in a URDF it then ends the parameter
robot_description, which is read as YAML.
"""

from collections.abc import Iterator
from functools import partial
from itertools import pairwise

from grader.base.grouping import Span, Strings
from grader.base.patterns import on_use
from grader.base.problems import Kind, Problem
from grader.base.records import Named
from grader.base.source import Edit, Location, Source
from grader.base.text import comment_spans

_MARK = "grader:ignore"
MARK = _MARK.encode()
_NAME = r"(?:[A-Z]++[0-9]*+|[a-z]++(?:-[a-z]++)++)"  # of a code or a rule
_COMMENT = on_use(rf"{_MARK}\b[ \t]*({_NAME}(?:[ \t]*,[ \t]*{_NAME})*)?")
_XML = (".xml", ".urdf", ".xacro", ".launch", ".sdf", ".world", ".srdf")
_SLASHES = (".cpp", ".cc", ".cxx", ".c", ".hpp", ".hh", ".h")
_NUMBER_SIGN = (".py", ".yaml", ".yml", ".rviz", ".cfg", ".cmake", "CMakeLists.txt")
COMMENTED = (*_XML, *_SLASHES, *_NUMBER_SIGN)  # the ends of the names of files with comments

_warning = partial(Kind, severity="warning", effect="other")
_USELESS = _warning("IGN001", "Comment that ignores nothing")
COMMENT_CATALOGUE = (_USELESS,)


class IgnoreComment(Named):
    """A comment that ignores problems in some lines.

    It names them by their codes, the beginnings of these, or their rules.
    """

    location: Location
    codes: Strings
    last: int  # the last of these lines; the first is that of its location

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
        while mark and mark.start() < start:
            mark = next(marks, None)
        last = 0
        while mark and mark.start() < end:
            last = last or _last_line(source, start, end)
            yield IgnoreComment(
                source.at(mark.start()),
                tuple(mark[1].replace(",", " ").split() if mark[1] else ()),
                last,
            )
            mark = next(marks, None)


def ignoring_edit(source: Source, at: Location, name: str) -> Edit | None:
    """Return the edit after which a comment ignores a problem, by its code or its rule.

    In XML the comment is above the tag. It is None where a file has no comments, or a text over
    several lines would hold this one.
    """
    if source.path.endswith(_XML):
        return _edit_above(source, source.start_offset(at), name)
    end = _end_of_line(source.text, source.start_offset(at))
    before = source.text[:end]
    is_in_text = before.endswith("\\") or before.count('"""') % 2 or before.count("'''") % 2
    if is_in_text or not source.path.endswith(COMMENTED):
        return None
    if _MARK in before.rpartition("\n")[2]:
        return source.edit(end, end, f", {name}")
    sign = "//" if source.path.endswith(_SLASHES) else "#"
    return source.edit(end, end, f"  {sign} {_MARK} {name}")


def _edit_above(source: Source, at: int, name: str) -> Edit | None:
    """Return the edit that writes a comment above the tag of an element, if none is there."""
    text = source.text
    tag = text.rfind("<", 0, at + 1)
    start = text.rfind("\n", 0, max(tag, 0)) + 1
    above = text[:start].rstrip("\n").rpartition("\n")[2]
    if tag < 0 or text.startswith("<?", tag) or _MARK in above:
        return None
    indent = text[start:tag] if text[start:tag].isspace() else ""
    return source.edit(start, start, f"{indent}<!-- {_MARK} {name} -->\n")


def _last_line(source: Source, start: int, end: int) -> int:
    """Return the last line of which a comment ignores problems."""
    text = source.text
    line = text.rfind("\n", 0, start) + 1
    beside = text[line:start] + text[end : _end_of_line(text, end)]
    is_alone = beside.strip("\ufeff \t\r") == ""
    return _line_after(source, end) if is_alone else source.at(end).line


def _xml_comments(text: str) -> Iterator[Span]:
    """Yield where each comment of XML starts and ends."""
    for start, end in comment_spans(text):
        yield start, end + len("-->")


def _line_comments(path: str, text: str) -> Iterator[Span]:
    """Yield where each comment in a line with a mark starts and ends."""
    signs = ("//", "/*") if path.endswith(_SLASHES) else ("#",)
    mark = text.find(_MARK)
    while mark >= 0:
        line = text.rfind("\n", 0, mark) + 1
        end = _end_of_line(text, mark)
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
