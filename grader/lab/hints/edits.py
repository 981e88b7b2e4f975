"""Edits that hints propose, and what they gain."""

from collections.abc import Iterator, Mapping, Sequence
from decimal import Decimal
from os.path import commonprefix

from grader.base.records import Named
from grader.base.source import Certainty, Edits

MAX_IN_HINT = 4  # edits, links, criteria or places that a hint names


class Proposal(Named):
    """An edit that may undo a mistake, in the words and with the order in which it is tried.

    The generators of `generators.py` make proposals from the difference to the reference solution,
    from the student's own numbers, and from the files of a package. The search grades the
    submission with each, and makes those that gain points a `FoundHint`.

    >>> from grader.base.element_edits import with_attribute
    >>> from grader.base.source import Source
    >>> source = Source("a.urdf", '<origin rpy="1.57 0 0"/>')
    >>> edit = with_attribute(source, 0, "rpy", "-1.57 0 0")
    >>> found = Proposal((edit,), "the sign of the roll of the origin")
    >>> found.edits
    (Edit(path='a.urdf', line=1, column=9, old='rpy="1.57 0 0"', new='rpy="-1.57 0 0"',
    renamed=''),)
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


Proposals = Iterator[Proposal]


class FoundHint(Named):
    """What a hint says.

    This is an edit that gains points when it is graded, or words for a part that is missing.
    """

    proposal: Proposal
    gains: Mapping[str, Decimal]  # the criteria that pass with it, each with the points
    certainty: Certainty = "preferred"
    # the edits of the earlier hints that it needs: the gains are those after them
    after: Sequence[Edits] = ()
    words: str = ""  # that say what is missing, for which there is no edit
    # another edit that cannot be told apart: both are named, neither is made
    alternative: Proposal | None = None
    equal: Proposal | None = None  # another edit that gains as much, which is only named

    @property
    def edits(self) -> Edits:
        """The edits to make."""
        if not self.alternative:
            return self.proposal.edits
        return ()


def _change_size(old: str, new: str) -> int:
    """Return the number of characters that differ: without those that both begin or end with."""
    start = len(commonprefix((old, new)))  # noqa: RUF071  of texts, not of paths
    end = len(commonprefix((old[start:][::-1], new[start:][::-1])))  # noqa: RUF071
    return len(old) + len(new) - 2 * (start + end)
