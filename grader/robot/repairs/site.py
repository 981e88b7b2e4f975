"""Where a problem of a robot is, and what the reference has there."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

from grader.edits import Proposal
from grader.problems import Problem
from grader.robot.edits.draft import Draft, Edits, child_of, end_of
from grader.source import Location
from grader.xml.parsing import Element

_MAX_NAMES = 3


@dataclass(frozen=True)
class Robots:
    """A draft with its problems, and the reference."""

    draft: Draft
    reference: Draft
    problems: tuple[Problem, ...]

    @cached_property
    def places(self) -> dict[Location, tuple[Element, str | None]]:
        """The element and attribute at each place."""
        return self.draft.places()

    def site(self, problem: Problem) -> "Site | None":
        """Return where a problem is."""
        found = self.places.get(problem.location)
        return Site(self, *found) if found is not None else None

    def unused_links(self) -> list[str]:
        """Return the links of the reference that the robot lacks, first those that its joints name."""
        named = [end_of(joint, role) for joint in self.draft.joints() for role in ("parent", "child")]
        names = [link.get("name") or "" for link in self.reference.links()]
        missing = [name for name in names if self.draft.link(name) is None]
        unknown = dict.fromkeys(name for name in named if name and self.draft.link(name) is None)
        return list(dict.fromkeys([*unknown, *missing]))

    def loose_links(self) -> list[str]:
        """Return the links that no joint has as its child."""
        children = {end_of(joint, "child") for joint in self.draft.joints()}
        names = [link.get("name") or "" for link in self.draft.links()]
        return [name for name in names if name and name not in children]

    def unused_joints(self, joint: Element) -> list[str]:
        """Return names that no other joint has: that of the reference, those of links without a joint, one after its child."""
        child = end_of(joint, "child")
        likes = (self.reference.joint_of(name) for name in (child, *self.loose_links()))
        names = [like.get("name") or "" for like in likes if like is not None]
        taken = {other.get("name") for other in self.draft.joints()}
        own = f"{child or 'new'}_joint"
        names += [own, f"{own}_2"]
        return [name for name in dict.fromkeys(names) if name and name not in taken][:_MAX_NAMES]


@dataclass(frozen=True)
class Site:
    """The element of a problem, and its attribute if it is one."""

    robots: Robots
    element: Element
    attribute: str | None

    @property
    def draft(self) -> Draft:
        """The robot that is being edited."""
        return self.robots.draft

    @cached_property
    def owner(self) -> Element:
        """The link or joint, or the material under the robot, that the element is in; the root if it is in none."""
        found = self.element
        while (parent := found.getparent()) is not None and parent is not self.draft.root:
            found = parent
        return found

    @cached_property
    def link(self) -> str:
        """The name of the link that the element belongs to: of its link, or of the child of its joint."""
        return end_of(self.owner, "child") if self.owner.tag == "joint" else self.owner.get("name") or ""

    @property
    def of(self) -> str:
        """Whose the element is, by the names of the reference only."""
        if self.owner.tag not in ("link", "joint") or self.robots.reference.link(self.link) is None:
            return ""
        inner = self._path[0] if self._path else ""
        if self.owner.tag == "joint":
            return f"the joint of {self.link!r}"
        return (
            f"the {inner} of {self.link!r}"
            if inner in ("visual", "collision", "inertial")
            else f"the link {self.link!r}"
        )

    @cached_property
    def _path(self) -> list[str]:
        path: list[str] = []
        found = self.element
        while found is not self.owner and (parent := found.getparent()) is not None:
            path.append(str(found.tag))
            found = parent
        return path[::-1]

    @cached_property
    def like(self) -> Element | None:
        """The element of the reference that this one should be like."""
        reference = self.robots.reference
        find = {"link": reference.link, "joint": reference.joint_of, "material": reference.material}.get(
            str(self.owner.tag)
        )
        if find is None:
            return None
        name = self.owner.get("name") or "" if self.owner.tag == "material" else self.link
        found: Element | None = find(name)
        if found is None and self.owner.tag == "joint":
            found = next((joint for joint in reference.joints() if joint.get("name") == self.owner.get("name")), None)
        for tag in self._path:
            inner = child_of(found, tag) if found is not None else None
            if inner is None and tag == "collision" and found is not None:
                inner = child_of(found, "visual")
            found = inner
        return found

    def propose(self, edits: Edits, cause: str, action: str) -> Proposal:
        """Return a proposal for this place."""
        return Proposal(edits, cause, action, self.of, self.link)

    def set(self, element: Element, attribute: str, value: str, cause: str, action: str) -> Iterator[Proposal]:
        """Yield the ways to give an attribute another value."""
        for edits in self.draft.write(element, attribute, value):
            yield self.propose(edits, cause, action)
