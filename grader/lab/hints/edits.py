"""Edits that hints propose: made for the elements of a text, applied to it, and to the files of
a submission.
"""

import re
from collections.abc import Iterable, Mapping
from dataclasses import replace
from decimal import Decimal
from math import isclose
from os.path import commonprefix
from typing import NamedTuple

from grader.base import markup
from grader.base.source import Certainty, Edit, Edits, Source
from grader.files.reading import URDF_LIMIT
from grader.files.tree import overlaid
from grader.lab.submission.submission import Submission
from grader.ros.package.robot_file import Read, read_as_ros
from grader.ros.python.budget import Budget

MAX_IN_HINT = 4  # edits, links, criteria or places that a hint names
_SAME = 1e-3  # relative: -1.57 is -pi/2
_PIECE = re.compile(r"(\s*)(\S+)")


class Proposal(NamedTuple):
    """An edit that may undo a mistake, in the words and with the order in which it is tried.

    The generators of `generators.py` make proposals from the difference to the reference solution,
    from the student's own numbers, and from the files of a package. The search grades the
    submission with each, and makes those that gain points a `FoundHint`.

    >>> from grader.base.source import Source
    >>> source = Source("a.urdf", '<origin rpy="1.57 0 0"/>')
    >>> edit = with_attribute(source, 0, "rpy", "-1.57 0 0")
    >>> found = Proposal((edit,), "the sign of the roll of the origin")
    >>> found.edits
    (Edit(path='a.urdf', line=1, column=9, old='rpy="1.57 0 0"', new='rpy="-1.57 0 0"',
    renamed=''),)
    >>> edited(source.text, source.path, found.edits)
    '<origin rpy="-1.57 0 0"/>'
    """

    edits: Edits
    cause: str  # what is wrong, for a hint at the level `cause`
    link: str = ""  # that is moved or changed
    # of equal gains, a lower one is taken first: the reference's values before other numbers
    rank: int = 0
    way: int = 0  # counts the ways to make the same change in xacro, the most plausible first
    shared: frozenset[str] = frozenset()  # the links that come from the same text of xacro

    @property
    def places(self) -> frozenset[tuple[str, int, int]]:
        """Where the text changes."""
        return frozenset((edit.path, edit.line, edit.column) for edit in self.edits)

    @property
    def size(self) -> int:
        """How much text changes: the number of edits counts more than their length."""
        return sum(100 + _change_size(edit.old, edit.new) for edit in self.edits)


class FoundHint(NamedTuple):
    """What a hint says: an edit that gains points when it is graded, or words for a part that is
    missing.
    """

    proposal: Proposal
    gains: Mapping[str, Decimal]  # the criteria that pass with it, each with the points
    certainty: Certainty = "preferred"
    is_late: bool = False  # whether the gains are those after the edits of earlier hints
    words: str = ""  # that say what is missing, for which there is no edit
    # another edit that cannot be told apart: both are named, neither is made
    alternative: Proposal | None = None

    @property
    def edits(self) -> Edits:
        """The edits to make."""
        if self.alternative is None:
            return self.proposal.edits
        return ()


def _change_size(old: str, new: str) -> int:
    """Return the number of characters that differ: without those that both begin or end with."""
    start = len(commonprefix((old, new)))  # noqa: RUF071  of texts, not of paths
    end = len(commonprefix((old[start:][::-1], new[start:][::-1])))  # noqa: RUF071
    return len(old) + len(new) - 2 * (start + end)


def element_text(source: Source, start: int) -> str:
    """Return the text of the element at an offset."""
    return source.text[start : markup.element_end(source.text, start)]


def with_attribute(source: Source, start: int, attribute: str, value: str) -> Edit:
    """Return the edit that sets an attribute of the start tag at an offset, or adds it."""
    found = markup.attribute(source.text, start, attribute)
    if found is None:
        end = markup.name_end(source.text, start)
        return source.edit(start, end, f'{source.text[start:end]} {attribute}="{value}"')
    head, tail = (
        source.text[found.start : found.value_start],
        source.text[found.value_end : found.end],
    )
    return source.edit(found.start, found.end, f"{head}{value}{tail}")


def with_child(source: Source, start: int, xml: str) -> Edit:
    """Return the edit that inserts an element as the first child of the one at an offset."""
    text, newline = source.text, "\r\n" if "\r\n" in source.text else "\n"
    end, is_empty = markup.head_end(text, start)
    indent = markup.child_indentation(text, start)
    child = f"{newline}{indent}{markup.indented(xml, indent, newline)}"
    if not is_empty:
        return source.edit(end, end, child)
    slash = text.rfind("/", start, end)
    name = text[start + 1 : markup.name_end(text, start)].strip()
    closing = f"{newline}{markup.indentation(text, start)}</{name}>"
    return source.edit(start, end, f"{text[start:slash].rstrip()}>{child}{closing}")


def without_element(source: Source, start: int) -> Edit:
    """Return the edit that removes the element at an offset, with its line where nothing else is
    on it.
    """
    end = markup.element_end(source.text, start)
    indent = markup.indentation(source.text, start)
    line = start - len(indent)
    is_alone = source.text[end : end + 2].startswith(("\n", "\r\n")) and (
        line == 0 or source.text[line - 1] == "\n"
    )
    if is_alone:
        return source.edit(line, source.text.find("\n", end) + 1, "")
    return source.edit(start, end, "")


def with_element(source: Source, start: int, xml: str) -> Edit:
    """Return the edit that replaces the element at an offset by another one."""
    newline = "\r\n" if "\r\n" in source.text else "\n"
    indent = markup.indentation(source.text, start)
    return source.edit(
        start, markup.element_end(source.text, start), markup.indented(xml, indent, newline)
    )


def merged(old: str, new: str) -> str:
    """Return a new list of numbers with those that stay, and the space between all, as the old
    text writes them.
    """
    before, after = _PIECE.findall(old), new.split()
    if len(before) != len(after):
        return new
    pieces = zip(before, after, strict=True)
    return "".join(
        (" " if space.strip(" ") else space) + _merge_one(piece, other)
        for (space, piece), other in pieces
    )


def _merge_one(old: str, new: str) -> str:
    """Return the new number, written as the old one where it is the same or only its sign
    changes.
    """
    try:
        before, after = float(old), float(new)
    except ValueError:
        return new
    if isclose(before, after, rel_tol=_SAME, abs_tol=_SAME / 100):
        return old
    if isclose(before, -after, rel_tol=_SAME):
        if before < 0:
            return old.lstrip("-")
        return f"-{old.lstrip('+')}"
    return new


def edited(text: str, path: str, edits: Iterable[Edit]) -> str | None:
    """Return the text of a file after edits; None if they overlap, or if the text is not what they
    replace.
    """
    source = Source(path, text)
    pieces: list[str] = []
    position = 0
    for start, edit in _offsets(source, edits):
        if start < position or not text.startswith(edit.old, start):
            return None
        pieces += (text[position:start], edit.new)
        position = start + len(edit.old)
    return "".join((*pieces, text[position:]))


def _offsets(source: Source, edits: Iterable[Edit]) -> list[tuple[int, Edit]]:
    return sorted(
        ((source.offset(edit.line, edit.column), edit) for edit in edits), key=lambda pair: pair[0]
    )


_Files = Mapping[
    str, bytes | None
]  # the new content of files by path; None for one that is no longer there


def edited_files(submission: Submission, edits: Iterable[Edit]) -> _Files | None:
    """Return the files of a submission that edits change; None where the edits do not fit."""
    by_path: dict[str, list[Edit]] = {}
    for edit in edits:
        by_path.setdefault(edit.path, []).append(edit)
    files: dict[str, bytes | None] = {}
    for path, of_file in by_path.items():
        before = content(submission, path)
        text = (before or b"").decode("utf-8", "surrogateescape")
        renamed = next((edit.renamed for edit in of_file if edit.renamed), "")
        after = edited(text, path, [edit for edit in of_file if not edit.renamed])
        if after is None:
            return None
        if renamed:
            files[path] = None
        files[renamed or path] = after.encode("utf-8", "surrogateescape")
    return files


def content(submission: Submission, path: str) -> bytes | None:
    """Return the bytes of a file of a submission; None where it has none that can be read."""
    if isinstance(submission.urdf, Read) and path == submission.urdf.path:
        return submission.urdf.data
    return submission.whole_tree.read(path, URDF_LIMIT)


def with_urdf(submission: Submission, files: _Files) -> Submission:
    """Return a submission with only the URDF read again: for edits of the URDF and of xacro that it
    includes.
    """
    urdf = submission.urdf
    assert isinstance(urdf, Read)
    is_renamed = files.get(urdf.path, b"") is None
    path = next((new for new, data in files.items() if data is not None and is_renamed), urdf.path)
    if submission.whole_tree.files:
        whole_tree = overlaid(submission.whole_tree, files)
    else:
        whole_tree = submission.whole_tree
    surroundings = submission.surroundings(Budget(), whole_tree)
    read = read_as_ros(files.get(path) or urdf.data, path, surroundings)
    return replace(submission, urdf=read, whole_tree=whole_tree, budget=surroundings.budget)


def with_files(submission: Submission, files: _Files) -> Submission:
    """Return a submission that is read again from scratch with other files. Raises InputError."""
    if submission.reopen is None:
        return with_urdf(submission, files)
    return submission.reopen(overlaid(submission.whole_tree, files))
