"""Edits of the links, joints and materials of a robot themselves: names, types, ends, and what is missing or too much."""

from collections.abc import Iterator
from itertools import islice

from grader.edits import KNOWN, REWRITTEN, TOGETHER, Proposal
from grader.names import closest
from grader.robot.edits.draft import Draft, Edits, child_of, end_of
from grader.robot.edits.materials import material
from grader.xml.parsing import Element

_MAX_NAMES = 4  # links or materials that may be meant


def structure_proposals(draft: Draft, reference: Draft, link: str, *, is_moved: bool) -> Iterator[Proposal]:
    """Yield edits that give a link, its joint and what it shows the structure that the reference has."""
    if draft.link(link) is None:
        yield from missing_link(draft, reference, link)
    else:
        yield from duplicates(draft, link)
        yield from parts(draft, reference, link)
        yield from shape(draft, reference, link)
        yield from material(draft, reference, link)
    if is_moved and (draft.link(link) is not None or draft.joint_of(link) is not None):
        yield from joint(draft, reference, link)


def missing_link(draft: Draft, reference: Draft, link: str) -> Iterator[Proposal]:
    """Rename a link whose name is misspelt, else restore it: a forgotten link, base instead of base_link."""
    others = [other.get("name") or "" for other in draft.links()]
    unknown = [name for name in others if reference.link(name) is None]
    near = closest(link, unknown)
    for name in islice(dict.fromkeys([*([near] if near else []), *unknown]), _MAX_NAMES):
        of = f"the link that should be {link!r}"
        yield Proposal(renamed(draft, name, link), "the name", "correct the name{}", of, link)
        own = draft.link(name)
        if own is not None and any(end_of(found, role) == link for found in draft.joints() for role in _ENDS):
            yield from (
                Proposal(edits, "the name", "correct the name{}", of, link) for edits in draft.set(own, "name", link)
            )
    twice = [other for other in draft.links() if others.count(other.get("name") or "") > 1]
    for second in twice:
        for edits in draft.set(second, "name", link):
            yield Proposal(
                edits,
                "the name{}, which another link has",
                "correct the name{}",
                f"the link that should be {link!r}",
                link,
            )
    missing = reference.link(link)
    if missing is not None:
        text, other = reference.text(missing), reference.joint_of(link)
        if draft.joint_of(link) is None and other is not None:
            text += f"\n\n{reference.text(other)}"
        rank = REWRITTEN if near else KNOWN
        edits = (*draft.append(text), *_materials(draft, reference, missing))
        yield Proposal(edits, f"the link {link!r} is missing", f"add the link {link!r}", "", link, rank)


def _materials(draft: Draft, reference: Draft, link: Element) -> Edits:
    """Return the edits that define the materials of a link of the reference where the robot has none of their names."""
    names = [found.get("name") or "" for found in link.iter("material")]
    texts = [
        reference.text(found)
        for name in names
        if draft.material(name) is None
        for found in [reference.material(name)]
        if found is not None
    ]
    return draft.insert(draft.root, "\n".join(texts)) if texts else ()


_ENDS = ("parent", "child")


def renamed(draft: Draft, old: str, new: str) -> Edits:
    """Return the edit that gives a link another name, also where joints name it."""
    own = draft.link(old)
    edits = draft.set(own, "name", new)[0] if own is not None else ()
    for found in draft.joints():
        for role in _ENDS:
            end = child_of(found, role)
            if end is not None and end.get("link") == old:
                edits += draft.set(end, "link", new)[0]
    return tuple(dict.fromkeys(edits))  # a parameter of xacro can be both names


def duplicates(draft: Draft, link: str) -> Iterator[Proposal]:
    """Remove a second link of the same name, or one of two parent joints: pasted twice."""
    same = [other for other in draft.links() if other.get("name") == link]
    joints = [found for found in draft.joints() if end_of(found, "child") == link]
    names = [found.get("name") for found in joints]
    for found in reversed(same) if len(same) > 1 else ():
        yield Proposal(draft.remove(found), "the second link of this name", "remove one{}", f"the links {link!r}", link)
    for found in reversed(joints) if len(joints) > 1 else ():
        cause = "the second joint of this name" if names.count(found.get("name")) > 1 else "a second parent joint"
        yield Proposal(draft.remove(found), cause, "remove one{}", f"the joints of {link!r}", link)


def joint(draft: Draft, reference: Draft, link: str) -> Iterator[Proposal]:
    """Connect a loose link; correct the type, the ends and the name of a joint: fixed wheels, exchanged parent and child."""
    own, other, of = draft.joint_of(link), reference.joint_of(link), f"the joint of {link!r}"
    if own is None:
        yield from loose(draft, reference, link)
        return
    yield from exchanged_ends(draft, own, of, link)
    if other is None:
        if own.get("type") != "fixed":
            yield from (
                Proposal(edits, "the type", "make the type fixed{}", of, link)
                for edits in draft.set(own, "type", "fixed")
            )
        return
    for name, verb in (("type", "set the type{}"), ("name", "correct the name{}")):
        value = other.get(name) or ""
        if own.get(name) != value:
            action = f"{verb} to {value}" if name == "type" else verb
            yield from (Proposal(edits, f"the {name}", action, of, link) for edits in draft.set(own, name, value))
    for role in _ENDS:
        yield from joint_end(draft, own, role, end_of(other, role), link)
    for tag in ("origin", "axis", "limit", "mimic", "dynamics"):
        yield from inner(draft, reference, own, other, tag, of, link)


def exchanged_ends(draft: Draft, own: Element, of: str, link: str) -> Iterator[Proposal]:
    """Exchange the parent and the child of a joint, as they are written."""
    parent, child = (child_of(own, role) for role in _ENDS)
    if parent is not None and child is not None and end_of(own, "parent") and end_of(own, "child"):
        edits = draft.exchange(parent, child, "link")
        yield Proposal(edits, "parent and child{} are swapped", "swap parent and child{}", of, link)


def joint_end(draft: Draft, own: Element, role: str, wanted: str, link: str) -> Iterator[Proposal]:
    """Name the right link as a joint's parent or child: a misspelt name, a wheel on the lidar, a joint without child."""
    of, end = f"the joint of {link!r}", child_of(own, role)
    if end is None:
        yield Proposal(
            draft.insert(own, f'<{role} link="{wanted}"/>'),
            f"the {role}{{}} is missing",
            f"name the {role}{{}}",
            of,
            link,
        )
    elif end.get("link") != wanted:
        yield from (
            Proposal(edits, f"the {role}", f"make {wanted!r} the {role}{{}}", of, link)
            for edits in draft.set(end, "link", wanted)
        )


def loose(draft: Draft, reference: Draft, link: str) -> Iterator[Proposal]:
    """Connect a link that no joint has as its child: one whose name the joint misspells, or one without a joint."""
    of, other = f"the joint of {link!r}", reference.joint_of(link)
    for found in draft.joints():
        child = end_of(found, "child")
        if draft.link(child) is None:
            yield from joint_end(draft, found, "child", link, link)
        elif other is not None and (child, end_of(found, "parent")) == (end_of(other, "parent"), link):
            yield from exchanged_ends(draft, found, of, link)
    if other is not None:
        same = next((found for found in draft.joints() if found.get("name") == other.get("name")), None)
        if same is not None:
            yield from exchanged_ends(draft, same, of, link)
            yield from joint_end(draft, same, "child", link, link)
            whole = draft.replace(same, reference.text(other))
            yield Proposal(whole, "the joint", "correct the joint{}", f"the link {link!r}", link, TOGETHER)
        yield Proposal(
            draft.append(reference.text(other)),
            "the joint{} is missing",
            "add the joint{}",
            f"link {link!r}",
            link,
        )


def shape(draft: Draft, reference: Draft, link: str) -> Iterator[Proposal]:
    """Give a link the shape that it should show, or none: no geometry, a sphere for a cylinder, a footprint that is visible."""
    own, other = draft.link(link), reference.link(link)
    if own is None or other is None:
        return
    of = f"the visual of {link!r}"
    visual, wanted = child_of(own, "visual"), child_of(other, "visual")
    if wanted is None:
        shown = list(own.iterchildren("visual"))
        if shown:
            edits: Edits = sum((draft.remove(found) for found in shown), ())
            yield Proposal(edits, "the visual{} should not be there", f"remove the visual of {link!r}", "", link)
        return
    if visual is None:
        yield Proposal(
            draft.insert(own, reference.text(wanted)),
            "the visual{} is missing",
            f"add the visual of {link!r}",
            "",
            link,
        )
        return
    for extra in list(own.iterchildren("visual"))[1:]:
        yield Proposal(draft.remove(extra), "the second visual", f"remove the second visual of {link!r}", "", link)
    yield from inner(draft, reference, visual, wanted, "geometry", of, link)
    yield Proposal(
        draft.replace(visual, reference.text(wanted)), "the visual", "correct the visual{}", of, link, REWRITTEN
    )


def parts(draft: Draft, reference: Draft, link: str) -> Iterator[Proposal]:
    """Correct or remove what a link does not show: an inertial without mass, with which ROS 2 drops the visual."""
    own, other = draft.link(link), reference.link(link)
    for tag in ("inertial", "collision"):
        if own is not None and other is not None:
            yield from inner(draft, reference, own, other, tag, f"the link {link!r}", link)


def inner(
    draft: Draft, reference: Draft, own: Element, other: Element, tag: str, of: str, link: str
) -> Iterator[Proposal]:
    """Insert or replace a child of an element as the reference has it: no geometry, a limit without effort, no axis."""
    found, wanted = child_of(own, tag), child_of(other, tag)
    if wanted is None:
        if found is not None and tag not in ("origin", "axis"):
            yield Proposal(
                draft.remove(found), f"an error in the <{tag}>{{}}", f"correct or remove the <{tag}>{{}}", of, link
            )
    elif found is None:
        yield Proposal(
            draft.insert(own, reference.text(wanted)),
            f"the <{tag}>{{}} is missing",
            f"add the <{tag}>{{}}",
            of,
            link,
        )
    elif _content(found) != _content(wanted):
        yield Proposal(
            draft.replace(found, reference.text(wanted)), f"the <{tag}>", f"correct the <{tag}>{{}}", of, link
        )


def _content(element: Element) -> list[tuple[str, dict[str, str]]]:
    return [(str(inner.tag), {str(key): str(value) for key, value in inner.attrib.items()}) for inner in element.iter()]
