"""Repairs of the tree: unknown links, links that are not connected, loops of joints."""

from collections import Counter
from collections.abc import Iterator
from itertools import islice

from grader.edits import Proposal
from grader.names import closest
from grader.robot.edits.draft import child_of, end_of, escaped
from grader.robot.edits.structure import loose, renamed
from grader.robot.repairs.elements import child_repairs
from grader.robot.repairs.site import Site
from grader.xml.parsing import Element

_MAX_NAMES = 4
_ENDS = ("parent", "child")


def end_repairs(site: Site) -> Iterator[Proposal]:
    """Name the link that a joint's parent or child is: a misspelt name, none at all, <Child>, <child name=...>."""
    joint = site.owner
    own = Site(site.robots, joint, None)
    links = [link.get("name") or "" for link in site.draft.links()]
    for role in _ENDS:
        end = child_of(joint, role)
        if end is None:
            yield from child_repairs(own, role)
            for name in _plausible(own, role):
                edits = site.draft.insert(joint, f'<{role} link="{name}"/>')
                yield own.propose(edits, f"the {role} is missing", f"name the {role}")
            continue
        given = end.get("link")
        if given in links:
            continue
        for attribute in map(str, end.keys()):
            if attribute != "link":
                edits = site.draft.rename_attribute(end, attribute, "link")
                yield own.propose(edits, "the name of the attribute link", "correct the name of the attribute link")
        is_known = bool(given) and site.robots.reference.link(given or "") is not None
        if given and is_known:  # the joint has the right name, and the link another one
            yield from _link_repairs(site, given)
        near = closest(given or "", links)
        names = dict.fromkeys([*([near] if near else []), *_plausible(own, role)])
        for name in names:
            ways = (
                site.draft.set(end, "link", name)
                if given is not None
                else [site.draft.add_attributes(end, {"link": name})]
            )
            for edits in ways:
                yield own.propose(edits, f"the name of the {role}", f"correct the name of the {role}")
        if given and not is_known:
            yield from _link_repairs(site, given)
    yield own.propose(site.draft.remove(joint), "a joint that connects nothing", "remove the joint")


def _plausible(site: Site, role: str) -> list[str]:
    """Return the links that may be the parent or child of a joint."""
    like = end_of(site.like, role) if site.like is not None else ""
    links = [like] if like and site.draft.link(like) is not None else []
    other = end_of(site.element, "parent" if role == "child" else "child")
    loose_links = [name for name in site.robots.loose_links() if name != other]
    links += loose_links[: _MAX_NAMES if role == "child" else 1]
    return list(dict.fromkeys(links))


def _link_repairs(site: Site, wanted: str) -> Iterator[Proposal]:
    """Rename a link, or add it, for a joint that names it."""
    names = [link.get("name") or "" for link in site.draft.links()]
    unknown = [name for name in names if site.robots.reference.link(name) is None]
    near = closest(wanted, unknown)
    others = (name for name in site.robots.loose_links() if name in unknown)
    for name in dict.fromkeys([*([near] if near else []), *islice(others, _MAX_NAMES)]):
        edits = renamed(site.draft, name, wanted)
        yield site.propose(edits, "the name of a link", "correct the name of the link")
    like = site.robots.reference.link(wanted)
    if like is not None:
        edits = site.draft.append(site.robots.reference.text(like))
        yield Proposal(edits, f"the link {wanted!r} is missing", f"add the link {wanted!r}", "", wanted)
    else:
        edits = site.draft.append(f'<link name="{escaped(wanted)}"/>')
        yield Proposal(edits, "the link of a joint is missing", "add the link that the joint names")


def root_repairs(site: Site) -> Iterator[Proposal]:
    """Connect the links that are not connected: as the reference does, by a joint that names another link, by a new joint."""
    draft, roots = site.draft, site.robots.loose_links()
    wanted = {
        link.get("name"): site.robots.reference.joint_of(link.get("name") or "")
        for link in site.robots.reference.links()
    }
    children = Counter(end_of(joint, "child") for joint in draft.joints())
    for joint in draft.joints():
        end = child_of(joint, "child")
        for root in roots if end is not None and children[end.get("link") or ""] > 1 else ():
            of = f"the joint of {root!r}" if wanted.get(root) is not None else ""
            for edits in draft.write(end, "link", root) if end is not None else ():
                yield Proposal(edits, "the child of a joint", "correct the child", of)
    for root in roots:
        if wanted.get(root) is not None:
            yield from loose(draft, site.robots.reference, root)
    yield from loop_repairs(site)
    known = [root for root in roots if site.robots.reference.link(root) is not None] or roots
    for root in roots:
        if root not in known[:1] and site.robots.reference.link(root) is None:
            edits = draft.append(
                f'<joint name="{root}_joint" type="fixed">\n  <parent link="{known[0]}"/>\n  <child link="{root}"/>\n</joint>'
            )
            yield Proposal(edits, "a link that is not connected", "connect the link with a joint")
            own = draft.link(root)
            if own is not None:
                yield Proposal(draft.remove(own), "a link that is not connected", "remove the link")


def loop_repairs(site: Site) -> Iterator[Proposal]:
    """Exchange parent and child of a joint, name another parent or child, or remove it."""
    draft = site.draft
    known = {joint.get("name") for joint in site.robots.reference.joints()}
    unknown = (joint for joint in draft.joints() if joint.get("name") not in known)
    for joint in islice(unknown, _MAX_NAMES):
        yield Proposal(draft.remove(joint), "a joint that closes a loop", "remove the joint")
    for joint in draft.joints():
        own, ends = Site(site.robots, joint, None), _ends(joint)
        names = [end.get("link") or "" for _, end in ends]
        if len(names) < len(_ENDS) or not all(names):
            continue
        for role, end in ends:
            yield from _as_reference(own, role, end)
        for name in site.robots.loose_links() if site.owner is joint else ():
            yield from own.set(ends[0][1], "link", name, "the parent", "correct the parent")
        if names[0] != names[1]:
            edits = (draft.set(end, "link", name)[0] for (_, end), name in zip(ends, names[::-1], strict=True))
            yield own.propose(sum(edits, ()), "parent and child are swapped", "swap parent and child")
            continue
        for name in site.robots.loose_links():
            for role, end in ends:
                yield from own.set(end, "link", name, f"the {role}", f"correct the {role}")
    if site.owner.tag == "joint":
        yield site.propose(draft.remove(site.owner), "a joint that closes a loop", "remove the joint")


def _ends(joint: Element) -> list[tuple[str, Element]]:
    """Return the elements that name the parent and the child of a joint."""
    ends = ((role, child_of(joint, role)) for role in _ENDS)
    return [(role, end) for role, end in ends if end is not None]


def _as_reference(site: Site, role: str, end: Element) -> Iterator[Proposal]:
    """Name the link that the reference has as parent or child of the joint of this name, or with this child."""
    joints = site.robots.reference.joints()
    named = next((other for other in joints if other.get("name") == site.element.get("name")), None)
    for name in dict.fromkeys(end_of(like, role) for like in (named, site.like) if like is not None):
        if name and name != end.get("link") and site.draft.link(name) is not None:
            yield from site.set(end, "link", name, f"the {role}", f"make {name!r} the {role}")
