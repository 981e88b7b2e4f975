"""Edits of elements that simulators and controllers read: a wrong value or attribute, a missing value, a missing element."""

from collections.abc import Iterator, Sequence
from itertools import zip_longest

from grader.edits import Proposal
from grader.robot.edits.draft import Draft, Edits, escaped
from grader.xml.element_values import (
    Found,
    Scalar,
    attribute,
    elements_at,
    is_same,
    name_of,
    steps_of,
    text_of,
    texts_at,
)
from grader.xml.parsing import Element
from grader.xml.wanted_element import WantedElement, readable

_IDENTIFYING = ("name", "type", "filename")  # attributes by which an element is recognised
_OF_ROS = ("link", "joint", "material")
_MAX_TAGS = 6  # elements whose attributes are corrected


def element_proposals(draft: Draft, reference: Draft, wanted: WantedElement) -> Iterator[Proposal]:
    """Yield edits that give a robot a wanted element: a mistyped value, a wrong reference, a forgotten sensor or plugin."""
    tags = [child for child in draft.root if name_of(child) == wanted.tag]
    fitting = [element for element in tags if wanted.fits(element)]
    found = [inner for element in fitting for inner in elements_at(element, steps_of(wanted.path))]
    if found:
        best = wanted.nearest(found)
        keys = wanted.wrong(best)
        what = f"the value of {keys[0]!r}" if len(keys) == 1 else "the values"
        edits = tuple(edit for key in keys for edit in _corrected(draft, best, key, wanted))
        yield Proposal(edits, what, f"correct {what}{{}}", wanted.inner)
    for element in tags[:_MAX_TAGS] if not fitting else ():
        wrong = [
            key
            for key, value in wanted.attributes.items()
            if not wanted._replace(attributes={key: value}).fits(element)
        ]
        edits = tuple(edit for key in wrong for edit in _written(draft, element, key, wanted.attributes[key]))
        what = f"the attribute {wrong[0]!r}" if len(wrong) == 1 else "the attributes"
        yield Proposal(edits, what, f"correct {what}{{}}", f"<{wanted.tag}>")
        for inner in elements_at(element, steps_of(wanted.path))[:1]:
            values = tuple(edit for key in wanted.wrong(inner) for edit in _corrected(draft, inner, key, wanted))
            if values:
                yield Proposal((*edits, *values), f"{what} and values", f"correct {what} and values{{}}", wanted.inner)
    if not found:
        yield from _missing(draft, reference, fitting, wanted)


def _corrected(draft: Draft, element: Element, key: str, wanted: WantedElement) -> Edits:
    """Return the edits that give an element the values at a path: in the place of other ones, else added."""
    value, found = wanted.values[key], texts_at(element, key)
    left = list(value) if isinstance(value, list) else [value]
    spare: list[Found] = []
    for text in found:
        met = next((one for one in left if is_same(readable(text.text), one, wanted.tolerance)), None)
        if met is None:
            spare.append(text)
        else:
            left.remove(met)
    edits: Edits = ()
    for one, text in zip_longest(left, spare[: len(left)]):
        if text is None:
            edits += _added(draft, element, key, one)
        elif text.attribute is not None:
            edits += _written(draft, text.element, text.attribute, one)
        else:
            edits += draft.write_text(text.element, text_of(one))
    return edits


def _written(draft: Draft, element: Element, name: str, value: Scalar) -> Edits:
    ways = draft.write(element, name, text_of(value))
    return ways[0] if ways else ()


def _added(draft: Draft, element: Element, key: str, value: Scalar) -> Edits:
    """Return the edits that add the element, or the attribute, at the end of a path with a value."""
    *steps, last = steps_of(key) or ["."]
    name = last.removeprefix("@") if last.startswith("@") else ""
    steps += [] if name or last == "." else [last]
    known = next(count for count in range(len(steps), -1, -1) if elements_at(element, steps[:count]))
    if known == len(steps) and name:
        bare = next((it for it in elements_at(element, steps) if attribute(it, name) is None), None)
        if bare is not None:
            return _written(draft, bare, name, value)
    known = min(known, len(steps) - 1)
    if known < 0:
        return ()
    *outer, inner = steps[known:]
    text = escaped(text_of(value))
    xml = f'<{inner} {name}="{text}"/>' if name else f"<{inner}>{text}</{inner}>"
    for step in reversed(outer):
        xml = f"<{step}>{xml}</{step}>"
    return draft.insert(elements_at(element, steps[:known])[0], xml)


def _missing(draft: Draft, reference: Draft, fitting: Sequence[Element], wanted: WantedElement) -> Iterator[Proposal]:
    """Add what the reference has: the whole element, or what is at the path in it, unless it is in another place of the file."""
    steps = steps_of(wanted.path)
    for child in draft.root if steps and not fitting else ():
        if name_of(child) == steps[0]:
            edits = draft.replace(child, f"{wanted.element}{draft.text(child)}</{wanted.tag}>")
            yield Proposal(
                edits, f"<{steps[0]}> is outside of <{wanted.tag}>", f"put <{steps[0]}> into {wanted.element}"
            )
    for other in reference.root:
        if name_of(other) == wanted.tag and wanted.fits(other) and elements_at(other, steps):
            inner = elements_at(other, steps[:1])[0]
            if _is_elsewhere(draft, inner):
                return
            edits = (
                draft.insert(fitting[0], reference.text(inner))
                if fitting and steps
                else draft.append(reference.text(other))
            )
            yield Proposal(edits, f"{wanted.inner} is missing", f"add {wanted.inner}")
            return


def _is_elsewhere(draft: Draft, inner: Element) -> bool:
    """Return whether an element of a simulator, or one of its name or type, is anywhere in the file: a copy would be a second one."""
    keys = [key for key in _IDENTIFYING if attribute(inner, key) is not None]
    own = (element for child in draft.root if name_of(child) not in _OF_ROS for element in child.iter())
    others = (element for element in own if name_of(element) == name_of(inner))
    return any(attribute(element, key) == attribute(inner, key) for element in others for key in keys)
