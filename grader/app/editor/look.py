"""One look at a workspace: what is wrong in it, and the names that its files define and use."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from grader.app.ignoring import Selection, without_ignored
from grader.app.settings import Settings
from grader.base.reuse import Memory
from grader.files.reading import URDF_LIMIT
from grader.files.tree import Tree
from grader.report.findings import Finding, findings_in_inspection
from grader.report.inspection import InspectedRobot, Inspection
from grader.ros.package.robot_file import Read
from grader.ros.urdf.kinematics import Configuration
from grader.ros.workspace.all_robots import read_workspace
from grader.ros.workspace.names import Definition, Mismatch, Use
from grader.ros.workspace.opened import OpenedWorkspace
from grader.ros.workspace.reading import names_in, read_agreement


@dataclass(frozen=True, eq=False, repr=False)
class Look:
    """What was read of the files at one time."""

    tree: Tree
    opened: OpenedWorkspace
    findings: Sequence[Finding]
    settings: Settings

    @cached_property
    def mismatches(self) -> Mapping[tuple[str, str, int], Mismatch]:
        """What does not agree, by its message, file and line."""
        found = {}
        for mismatch in read_agreement(self.opened.workspace).mismatches:
            at = mismatch.location
            found[mismatch.message, at.path, at.line] = mismatch
        return found

    def mismatch_of(self, finding: Finding) -> Mismatch | None:
        """Return the names that do not agree for which there is a finding; None for another one."""
        at = finding.location
        return self.mismatches.get((finding.message, at.path, at.line))

    @cached_property
    def names(self) -> "Names":
        """The names that files define and use."""
        return Names(names_in(self.opened.workspace))

    @cached_property
    def robots(self) -> Mapping[str, Configuration]:
        """The robots that ROS 2 loads, with their joints at 0, by the paths of their files."""
        found = {}
        for robot in self.opened.robots:
            model = robot.loaded.robot if isinstance(robot, Read) else None
            if model is not None:
                found[robot.path] = Configuration(model)
        return found


class Names:
    """The names of a workspace: where they are defined and used."""

    def __init__(self, facts: Sequence[Definition | Use]) -> None:
        self.facts = facts

    def in_file(self, path: str) -> list[Definition | Use]:
        """Return the names in a file."""
        return [fact for fact in self.facts if fact.location.path == path]

    def same(self, fact: Definition | Use) -> list[Definition | Use]:
        """Return each place that means the same name."""
        return [other for other in self.facts if _are_same(fact, other)]

    def of_kinds(self, kinds: Sequence[str]) -> list[Definition]:
        """Return the definitions of some kinds of names."""
        return [it for it in self.facts if isinstance(it, Definition) and it.kind in kinds]


def _are_same(fact: Definition | Use, other: Definition | Use) -> bool:
    """Return whether two facts are about one name; of two owners, both have their own."""
    if fact_key(fact) != fact_key(other):
        return False
    return not fact.owner or not other.owner or fact.owner == other.owner


def fact_key(fact: Definition | Use) -> tuple[str, str]:
    """Return the kind and the name that a fact is about. Links are frames."""
    return "frame" if fact.kind == "link" else fact.kind, fact.name


def look_at(tree: Tree, root: Path, settings: Settings, memory: Memory) -> Look:
    """Look at the files of a folder as `grader inspect` does; with what is kept of the look
    before.
    """
    opened = read_workspace(tree, tree.name, URDF_LIMIT, {}, memory)
    opened = opened.of_release(settings.distro, settings.file.name if settings.file else "")
    robots = []
    for robot in opened.robots:
        if isinstance(robot, Read):
            reading = robot.loaded._replace(problems=opened.problems_of(robot))
            robots.append(InspectedRobot(robot.path, reading))
    found = tuple(opened.package_problems())
    extent = opened.extent()
    inspection = Inspection(opened.id, tuple(robots), found, extent, opened.source)
    selection = Selection(settings=settings, folder=root)
    shown = without_ignored(inspection, opened.whole_tree, [*tree.files], selection)
    memory.forget_unused()
    return Look(tree, opened, findings_in_inspection(shown), settings)
