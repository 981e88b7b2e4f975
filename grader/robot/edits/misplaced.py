"""Edits that move an element to where ROS 2 looks for it: a joint in a link, an origin beside the visual."""

from collections.abc import Iterator
from itertools import islice

from grader.edits import MOVED, Proposal
from grader.robot.edits.draft import Draft
from grader.xml.parsing import Element
from grader.xml.urdf_format import CHILDREN

_MAX_ELEMENTS, _MAX_MOVED = 3000, 6


def misplaced(draft: Draft) -> Iterator[Proposal]:
    """Yield edits that move elements which ROS 2 ignores where they are."""
    return islice(_moved(draft), _MAX_MOVED)


def _moved(draft: Draft) -> Iterator[Proposal]:
    for element in islice(draft.root.iter(), 1, _MAX_ELEMENTS):
        tag, parent = str(element.tag), element.getparent()
        if parent is None or tag in CHILDREN.get(str(parent.tag), (tag,)):
            continue
        for place in _places(draft, element, parent):
            text = draft.text(element)
            there = draft.append(text) if place is draft.root else draft.insert(place, text)
            cause, action = (
                f"<{tag}> is inside <{parent.tag}>; it belongs in <{place.tag}>",
                f"move the <{tag}> into <{place.tag}>",
            )
            yield Proposal((*draft.remove(element), *there), cause, action, rank=MOVED)


def _places(draft: Draft, element: Element, parent: Element) -> Iterator[Element]:
    """Yield the elements around or beside an element that may contain it."""
    tag = str(element.tag)
    for near in (*element.iterancestors(), *parent.iter(), *_before(element)):
        is_free = near is draft.root or near.find(tag) is None
        if near not in (parent, element) and tag in CHILDREN.get(str(near.tag), ()) and is_free:
            yield near


def _before(element: Element) -> Iterator[Element]:
    """Yield the element before another one, and what is in it."""
    previous = element.getprevious()
    if previous is not None:
        yield from previous.iter()
