"""Pieces of the difference to the reference that one mistake needs together: those of a link, or of one element."""

from collections.abc import Iterator

from grader.hints.robot.difference import RobotDifference
from grader.hints.robot.elements import Set, end_of
from grader.hints.robot.pieces import STRUCTURE, Piece
from grader.xml.parsing import Element

_MAX_NAMED = 3  # values whose mistakes are named one by one
_FRAME = "the frame of {!r} and what it shows"


def whole_links(difference: RobotDifference) -> Iterator[Piece]:
    """Yield where each link and what it shows are, also with what it carries; and all its values."""
    links: dict[str, list[Set]] = {}
    for piece in difference.pieces:
        own = links.setdefault(piece.link, [])
        own += [one for one in piece.sets if one not in own and one.attribute != "name"]
    for link, sets in links.items():
        poses = [one for one in sets if "origin" in (one.tag, one.owner.tag) or "axis" in (one.tag, one.owner.tag)]
        carried = {joint for joint in difference.draft.joints() if end_of(joint, "parent") == link}
        after = [
            one for own in links.values() for one in own if not carried.isdisjoint((one.owner, one.owner.getparent()))
        ]
        groups = (poses, _FRAME), (poses + after, f"{_FRAME} and carries"), (sets, "the values of {!r}")
        for those, text in groups if link in difference.known else ():
            yield from _group(difference, link, those, text.format(link))


def _group(difference: RobotDifference, link: str, sets: list[Set], what: str) -> Iterator[Piece]:
    changed = {(one.owner, one.tag): one for one in sets}
    if len(changed) < 2:
        return
    if len(changed) == len(sets) <= _MAX_NAMED:
        what = " and ".join(difference.of_sets([one]).cause for one in changed.values())
    yield Piece(what, link, tuple(dict.fromkeys(sets)), (), STRUCTURE)


def whole_elements(difference: RobotDifference) -> Iterator[Piece]:
    """Yield the changes in one element together, and in one child of the robot; of links and joints no values."""
    for is_owner in (False, True):
        groups: dict[Element, list[Piece]] = {}
        for piece in difference.pieces:
            owner = difference.draft.owner(piece.around) if piece.around is not None else difference.draft.root
            has_values = owner.tag in ("link", "joint", "material", "robot")
            is_removed = not piece.sets and not any(edit.new for edit in piece.edits)
            if piece.around is not None and not is_removed and (piece.edits or not has_values):
                groups.setdefault(owner if is_owner else piece.around, []).append(piece)
        for pieces in (those for element, those in groups.items() if element is not difference.draft.root):
            cause = " and ".join(dict.fromkeys(piece.cause for piece in pieces))
            edits = tuple(edit for piece in pieces for edit in piece.edits)
            sets = tuple(one for piece in pieces for one in piece.sets)
            if len(pieces) > 1:
                yield Piece(cause, pieces[0].link, sets, edits, STRUCTURE)
