"""One look at a workspace: what is wrong in it, and the names that its files define and use."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

from grader.app.ignoring import Selection, without_ignored
from grader.app.settings import Settings
from grader.base.problems import Problem
from grader.base.reuse import Memory
from grader.base.source import Edits, Location
from grader.files.reading import URDF_LIMIT
from grader.files.tree import Tree
from grader.report.findings import Finding, findings_in_inspection
from grader.report.inspection import InspectedRobot, Inspection
from grader.report.mistakes import Mistake
from grader.ros.api import Configuration, Read
from grader.workspace.api import NamePlaces, OpenedWorkspace, read_workspace


class ProvenFix(NamedTuple):
    """Edits with which criteria pass, as far as the hints of the rubric show them."""

    title: str
    at: Location
    edits: Edits


class Graded(NamedTuple):
    """The mistakes that cost points, and the edits that the rubric's hints show."""

    mistakes: Sequence[Mistake] = ()
    fixes: Sequence[ProvenFix] = ()


@dataclass(frozen=True, eq=False, repr=False)
class Look:
    """What was read of the files at one time."""

    tree: Tree
    opened: OpenedWorkspace
    selection: Selection
    grade: Callable[[Tree], Graded]
    again: "Callable[[Tree], Look]"  # looks at other files instead
    # Gives the last look in which a file had no error, if it has one now.
    find_clean: "Callable[[str], Look | None]"

    @cached_property
    def _inspection(self) -> Inspection:
        """What `grader inspect` says of the files."""
        opened = self.opened
        package_problems = tuple(opened.package_problems())
        robots = []
        for robot in opened.robots:
            if isinstance(robot, Read):
                problems = opened.problems_once(robot, package_problems, with_assumptions=True)
                robots.append(InspectedRobot(robot.path, robot.loaded._replace(problems=problems)))
        return Inspection(
            opened.id, tuple(robots), package_problems, opened.extent(), opened.source
        )

    @cached_property
    def findings(self) -> Sequence[Finding]:
        """What is wrong, and not ignored."""
        files = list(self.tree.files)
        shown = without_ignored(self._inspection, self.opened.whole_tree, files, self.selection)
        return findings_in_inspection(shown)

    @property
    def problems(self) -> Sequence[Problem]:
        """What is wrong, also what is ignored."""
        return self._inspection.problems

    def has_errors(self, path: str) -> bool:
        """Return whether a file has errors."""
        errors = (each.location for each in self.findings if each.severity == "error")
        return any(location.path == path for location in errors)

    @cached_property
    def names(self) -> NamePlaces:
        """The names that files define and use."""
        return NamePlaces(self.opened)

    @cached_property
    def graded(self) -> Graded:
        """The criteria that fail, and how to fix them; nothing without a rubric.

        Raises GraderError.
        """
        return self.grade(self.tree)

    @cached_property
    def robots(self) -> Mapping[str, Configuration]:
        """The robots that ROS 2 loads, with their joints at 0, by the paths of their files."""
        robots_by_path = {}
        for robot in self.opened.robots:
            model = robot.loaded.robot if isinstance(robot, Read) else None
            if model:
                robots_by_path[robot.path] = Configuration(model)
        return robots_by_path


def look_at(
    tree: Tree,
    root: Path,
    settings: Settings,
    memory: Memory,
    grade: Callable[[Tree], Graded],
    again: Callable[[Tree], Look],
    find_clean: Callable[[str], Look | None],
) -> Look:
    """Look at the files of a folder as `grader inspect` does; problems are found when asked for.

    Args:
        tree: The files.
        root: The folder.
        settings: What is ignored, and for which release the names are.
        memory: What is kept of the look before.
        grade: Grades the files when it is asked for.
        again: Looks at other files.
        find_clean: Gives the last look in which a file had no error.
    """
    opened = read_workspace(tree, tree.name, URDF_LIMIT, {}, memory, settings.stated)
    return Look(tree, opened, Selection(settings=settings, folder=root), grade, again, find_clean)
