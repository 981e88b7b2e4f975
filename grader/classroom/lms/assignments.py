"""Find the column of an assignment in an LMS file: by the title that the user names, or by the names of the rubric."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from grader.classroom.lms.filling import FillOptions
from grader.errors import InputError
from grader.text import counted, enumerated

_MAX_LISTED = 20


@dataclass(frozen=True, slots=True)
class GradeColumn:
    """A column that can be written: its index and header, and for an assignment its title and the number in the LMS."""

    index: int
    header: str
    title: str = ""
    number: str = ""
    maximum: str = ""

    @property
    def names(self) -> tuple[str, ...]:
        """The names that can be given for it, besides its header."""
        return tuple(filter(None, (self.title, self.number)))


def find_assignment(columns: Sequence[GradeColumn], options: FillOptions, lms: str, example: str) -> GradeColumn:
    """Return the column for the grade; raises InputError if none or several can be meant.

    `lms` is the name of the LMS, `example` the header of an assignment there.
    """
    return _column_by_name(columns, options) if options.column else _column_of_rubric(columns, options, lms, example)


def assignment_warnings(columns: Sequence[GradeColumn], chosen: GradeColumn, options: FillOptions) -> Iterator[str]:
    """Yield what to check about the columns: other assignments in the file."""
    others = sum(column != chosen and bool(column.title) for column in columns)
    if others and not options.only:
        whose = "its" if others == 1 else "their"
        yield (
            f"the file has {counted(others, 'other assignment')}: importing it resets {whose} grades to those "
            "at the time of the export, unless you pass --only"
        )


def _column_by_name(columns: Sequence[GradeColumn], options: FillOptions) -> GradeColumn:
    """Return the column with this header, title or number."""
    wanted = options.column.strip()
    exact = [column for column in columns if column.header == wanted]
    found = exact or [column for column in columns if wanted in column.names]
    if len(found) != 1:
        which = "more than one column" if found else "no writable column"
        raise InputError(f"{options.shown} has {which} {wanted!r}; the columns are: {_list(found or columns)}")
    return found[0]


def _column_of_rubric(columns: Sequence[GradeColumn], options: FillOptions, lms: str, example: str) -> GradeColumn:
    """Return the only assignment whose title is a name of the rubric, contains or is part of one.

    Raises InputError if there is none, or several. An only assignment with another title may be the grade of other
    work.
    """
    assignments = [column for column in columns if column.title]
    joined = {"".join(_words(name)) for name in options.rubric_names} - {""}
    same = [column for column in assignments if "".join(_words(column.title)) in joined]
    similar = [column for column in assignments if _names_rubric(column.title, options.rubric_names)]
    candidates = same or similar
    if len(candidates) == 1:
        return candidates[0]
    if not assignments:
        raise InputError(
            f"{options.shown} has no column of an assignment, such as {example!r}, but: {_list(columns)};"
            f" create the assignment in {lms}, and export again"
        )
    names = enumerated([repr(name) for name in options.rubric_names], word="or")
    what = "several possible columns" if candidates else f"no column with a title like {names}"
    raise InputError(f"{options.shown} has {what}, choose one with --column: {_list(candidates or assignments)}")


def _names_rubric(title: str, rubric_names: tuple[str, ...]) -> bool:
    """Return whether an assignment's title contains a name of the rubric, or is part of one."""
    words = _words(title)
    return any(_is_similar(words, _words(name)) for name in rubric_names)


def _words(text: str) -> list[str]:
    return re.findall(r"[^\W\d_]+|\d+", text.casefold())


def _is_similar(left: list[str], right: list[str]) -> bool:
    """Return whether one has all words of the other, side by side: Lab 6 and lab6, Lab 6: wheeled base, not Lab 61."""
    short, long = sorted((left, right), key=len)
    return bool(short) and any(long[at : at + len(short)] == short for at in range(len(long) - len(short) + 1))


def _list(columns: Sequence[GradeColumn]) -> str:
    return enumerated([repr(column.header) for column in columns], _MAX_LISTED) or "none"
