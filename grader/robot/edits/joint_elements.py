"""Edits of the limits, the mimic and the dynamics of a joint."""

from collections.abc import Iterator, Mapping
from math import radians
from typing import NamedTuple

from grader.edits import KNOWN, Proposal
from grader.robot.edits.draft import Draft, Edits, child_of, end_of, escaped
from grader.robot.edits.families import Slot, named, number
from grader.robot.edits.poses import Poses
from grader.robot.edits.values import values_of
from grader.xml.parsing import Element

# The numbers of each element, in the order in which COMPONENTS names them.
_ELEMENTS = {
    "limit": ("lower", "upper", "effort", "velocity"),
    "mimic": ("multiplier", "offset"),
    "dynamics": ("damping", "friction"),
}
_DEFAULTS = {"lower": 0.0, "upper": 0.0, "multiplier": 1.0, "offset": 0.0, "damping": 0.0, "friction": 0.0}
_SAME = 1e-3  # numbers that differ by less are the same, but for rounding


class _Leader(NamedTuple):
    """The link whose joint is mimicked, and the name of that joint."""

    link: str
    joint: str


def joint_elements(draft: Draft, reference: Draft, poses: Poses, link: str) -> Iterator[Proposal]:
    """Correct swapped limits, limits in degrees, a sign, a number, the joint that is mimicked; add an element that is missing."""
    joint, other = draft.joint_of(link), reference.joint_of(link)
    for tag, names in _ELEMENTS.items() if joint is not None else ():
        assert joint is not None
        element, like = child_of(joint, tag), child_of(other, tag) if other is not None else None
        known = {name: value for name in names if like is not None and (value := _value(like, name)) is not None}
        given = _given(poses, joint, link, names)
        given = {name: known[name] if abs(known.get(name, value + 1.0) - value) < _SAME else value for name, value in given.items()}  # fmt: skip
        leader = _leader(draft, reference, like) if tag == "mimic" and like is not None else None
        if element is None:
            yield from _added(draft, joint, tag, {**known, **given}, leader, link)
            continue
        renamed: list[Edits] = []
        if leader is not None and element.get("joint") != leader.joint:
            renamed = draft.write(element, "joint", leader.joint)
            for edits in renamed:
                action = f"mimic the joint of {leader.link!r}"
                yield Proposal(edits, "the joint in the <mimic>{}", action, _of(link), link, KNOWN)
        yield from _corrected(draft, element, given or known, renamed or [()], link)


def _of(link: str) -> str:
    return f"the joint of {link!r}"


def _given(poses: Poses, joint: Element, link: str, names: tuple[str, ...]) -> dict[str, float]:
    """Return the numbers that criteria expect, as the file has them: angles in radians."""
    given = {name: values[0] for name in names for values in poses.given(link, name)}
    turns = joint.get("type") == "revolute"
    return {name: radians(value) if turns and name in ("lower", "upper") else value for name, value in given.items()}


def _value(element: Element, name: str) -> float | None:
    """Return a number, its default if it is not given; None if it has none, or cannot be read."""
    text = element.get(name)
    if text is None:
        return _DEFAULTS.get(name)
    values = values_of(text)
    return values[0] if len(values) == 1 else None


def _leader(draft: Draft, reference: Draft, mimic: Element) -> _Leader | None:
    """Return what is mimicked in the reference, with the name that the joint has in the draft."""
    names = (found for found in reference.joints() if found.get("name") == mimic.get("joint"))
    link = next((end_of(found, "child") for found in names), "")
    joint = draft.joint_of(link) if link else None
    name = joint.get("name") if joint is not None else None
    return _Leader(link, name) if name is not None else None


def _added(
    draft: Draft, joint: Element, tag: str, wanted: Mapping[str, float], leader: _Leader | None, link: str
) -> Iterator[Proposal]:
    """Yield the edit that adds an element with the numbers that differ from the defaults, if all that it needs is known."""
    numbers = {name: value for name, value in wanted.items() if value != _DEFAULTS.get(name)} or wanted
    if not numbers or (tag == "mimic" and leader is None) or (tag == "limit" and len(wanted) < len(_ELEMENTS[tag])):
        return
    texts = {"joint": escaped(leader.joint)} if leader is not None else {}
    texts |= {name: number(value) for name, value in numbers.items()}
    attributes = " ".join(f'{name}="{text}"' for name, text in texts.items())
    edits = draft.insert(joint, f"<{tag} {attributes}/>")
    yield Proposal(edits, f"the <{tag}>{{}} is missing", f"add the <{tag}>{{}}", _of(link), link, KNOWN)


def _corrected(
    draft: Draft, element: Element, wanted: Mapping[str, float], before: list[Edits], link: str
) -> Iterator[Proposal]:
    """Yield the edits that set each wrong number of an element alone, those that are far off, and all, after other edits."""
    actual = {name: _value(element, name) for name in _ELEMENTS[str(element.tag)]}
    wrong = [name for name in actual if actual[name] != wanted.get(name, actual[name])]
    slot = Slot(str(element.tag), tuple(value or 0.0 for value in actual.values()))
    far = tuple(name for name in wrong if abs((actual[name] or 0.0) - wanted[name]) > _SAME)
    for names in dict.fromkeys((*((name,) for name in wrong), far, tuple(wrong))):
        values = {name: wanted[name] if name in names else actual[name] for name in actual}
        change, _ = named(slot, tuple(value or 0.0 for value in values.values()))
        cause = change.cause
        if not any(name in element.attrib for name in names):
            called = " and ".join(slot.component(list(actual).index(name)) for name in names)
            cause = f"{called}{{}} {'is' if len(names) == 1 else 'are'} missing"
        ways = before if len(names) == len(wrong) else [()]
        for name in names:
            ways = [(*way, *more) for way in ways for more in draft.set(element, name, number(wanted[name]))]
        for edits in ways if names else ():
            yield Proposal(edits, cause, change.action, _of(link), link, KNOWN)
