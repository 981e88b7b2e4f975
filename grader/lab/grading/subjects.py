"""The objects that checks examine.

They are the URDF of a submission, its robot in a pose, its package, and the reference.
"""

from collections.abc import Mapping, Sequence
from math import radians
from typing import Any

from grader.base.errors import MissingElement
from grader.base.grouping import StringsByName
from grader.base.problems import Problem
from grader.base.quantities import point
from grader.base.source import Source
from grader.base.text import enumerated, quoted
from grader.lab.checks.check import Check, Subject
from grader.lab.rubric.criterion import Criterion
from grader.lab.rubric.rubric import ReferenceSolution, Rubric
from grader.lab.submission.submission import Submission
from grader.ros.package.robot_file import Read
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.link_tree import JOINT_OF
from grader.ros.urdf.model import Joint

_SLIDING = ("prismatic",)
_TURNING = ("revolute", "continuous")
_Positions = Mapping[str, float]  # of joints


class Subjects:
    """What of a submission is examined.

    Raises InputError if a check needs a reference solution that cannot be read.
    """

    def __init__(
        self, rubric: Rubric, submission: Submission, arguments: StringsByName | None = None
    ) -> None:
        """Take the arguments of launch files, `arguments`.

        Under them the submission and the reference are examined.
        """
        solution = rubric.solution if rubric.compares_with_reference else None
        if arguments:
            submission = submission.under(arguments)
            solution = solution.under(arguments) if solution else None
        self._rubric = rubric
        self._under: dict[tuple[tuple[str, str], ...], Subjects] = {}
        self.submission = submission
        self.problems: Sequence[Problem] = ()
        self.robot: Configuration | None = None
        self.source: Source | None = None
        self._known: dict[Subject, object] = {"submission": submission}
        self._packaged: dict[str, Submission] = {}
        self._posed: dict[tuple[tuple[str, float], ...], Configuration] = {}
        if solution:
            self._known["reference"] = self._with_transforms(solution.robot, solution)
        if isinstance(submission.urdf, Read):
            self._take_urdf(submission.urdf)

    def _take_urdf(self, urdf: Read) -> None:
        """Take the URDF of the submission and its robot."""
        reading = urdf.reading
        self.source = reading.source
        self.problems = reading.problems
        if reading.is_meant:  # what ROS 2 rejects is corrected
            remaining = [
                problem for problem in reading.problems if problem.kind.effect != "rejects"
            ]
            self.problems = tuple(remaining)
        if reading.robot:
            robot = Configuration(reading.robot, is_guarded=bool(reading.unresolved))
            reading = reading._replace(robot=robot.robot)
            self.robot = self._with_transforms(robot, self.submission)
            self._known["robot"] = self.robot
        self._known["urdf"] = urdf.as_it_stands or reading

    def _with_transforms(
        self, robot: Configuration, owner: Submission | ReferenceSolution
    ) -> Configuration:
        paths = self._rubric.transforms
        if not paths:
            return robot
        submission = owner if isinstance(owner, Submission) else owner.submission
        package = submission.package
        if not package:
            return robot
        from grader.ros.package.static_transforms import (
            with_transforms,  # late: few rubrics ask for them
        )

        known = with_transforms(robot.known, package, paths, submission.source)
        return Configuration(known, is_guarded=True)

    def under(self, arguments: StringsByName) -> "Subjects":
        """Return what is examined under launch arguments, which is read once."""
        if not arguments:
            return self
        key = tuple(sorted(arguments.items()))
        if key not in self._under:
            self._under[key] = Subjects(self._rubric, self.submission, arguments)
        return self._under[key]

    def of(self, check: Check, criterion: Criterion) -> list[object]:
        """Return what a check examines for a criterion.

        This is its package, and the robot with the joints at its positions.

        Raises MissingElement or NotDecided for what the submission does not have.
        """
        known = self._known
        at = criterion.at
        if criterion.package:
            known = {**known, "submission": self._with_package(criterion.package)}
        subjects = [
            known[name] if name in known else self._needed_subject(name, known)
            for name in check.examined
        ]
        if at:
            for index, subject in enumerate(subjects):
                if isinstance(subject, Configuration) and subject is self.robot:
                    subjects[index] = self._pose_robot(subject, at)
        return subjects

    def _with_package(self, name: str) -> Submission:
        """Return the submission with another graded package.

        It is one for all criteria of the package, so that its names are compared once.
        """
        if name not in self._packaged:
            self._packaged[name] = self.submission.with_package(name)
        return self._packaged[name]

    def pose_text(self, at: _Positions) -> str:
        """Return the positions of joints that are there.

        For example, this is 'joint_2' at 40 degrees and 'slide' at 0.1 m.
        """
        assert self.robot
        joints = joints_at(self.robot, at)
        return enumerated(
            [f"{quoted(joint.name)} at {point((value,))} {unit}" for joint, value, unit in joints]
        )

    def named(self, check: Check, arguments: Mapping[str, Any]) -> Mapping[str, Any]:
        """Return the arguments of a check with the names of links.

        They have selectors, which mean these links.

        A check that compares two robots looks for the links in each of them.

        Raises MissingElement or NotDecided for a selector that names no link, or several.
        """
        if not self.robot or "reference" in check.examined:
            return arguments
        return {key: without_selectors(value, self.robot) for key, value in arguments.items()}

    def _pose_robot(self, robot: Configuration, at: _Positions) -> Configuration:
        key = tuple(at.items())
        if key not in self._posed:
            joints = [(_find_joint(robot, name), value) for name, value in key]
            positions = {
                joint.name: radians(value) if joint.type in _TURNING else value
                for joint, value in joints
            }
            for name in positions:
                _check_name(robot, name)
            self._posed[key] = robot.at(positions)
        return self._posed[key]

    def _needed_subject(self, name: Subject, known: Mapping[Subject, Any]) -> object:
        """Return the package.

        Raise MissingElement or NotDecided for any other subject that a submission lacks.
        """
        if name == "package":
            return known["submission"].needed_package()
        self.submission.needed_urdf()
        raise MissingElement(
            "robot", "", message="ROS 2 cannot read the file, so there is no robot"
        )


def check_selectors(robot: Configuration, criterion: Criterion) -> None:
    """Raise MissingElement or NotDecided if a selector does not have one link.

    A criterion names a link by a place that no link has, or several have.
    """
    carried = [dict(one.arguments) for one in criterion.carried]
    joints = [*criterion.at, *(name for one in criterion.carried for name in one.at)]
    without_selectors([dict(criterion.arguments), *carried, joints], robot)


def joints_at(robot: Configuration, at: _Positions) -> list[tuple[Joint, float, str]]:
    """Return the joints that a criterion puts at positions.

    Each has the position and its unit, m or degrees.

    Raises MissingElement or NotDecided for one that is not there.
    """
    joints = [(_find_joint(robot, name), value) for name, value in at.items()]
    return [(joint, value, "m" if joint.type in _SLIDING else "degrees") for joint, value in joints]


def _find_joint(robot: Configuration, name: str) -> Joint:
    """Return a joint that turns or slides.

    It is found by its name or by a selector of the link that it moves.
    """
    named = name
    if not robot.robot.has_joint(name):
        named = robot.selected_name(name)
    if named != name and not name.startswith(JOINT_OF):
        joint_above = robot.parent_joints.get(named)
        if not joint_above:
            raise MissingElement("joint", name, message=f"no joint moves {name}")
        return joint_above
    joint = robot.joint(named)
    if joint.type not in (_TURNING + _SLIDING):
        at = joint.location and joint.location._replace(attribute="type")
        message = (
            f"the joint {quoted(named)} is {joint.type or 'of no type'}; it should turn or slide"
        )
        raise MissingElement("moving joint", name, message=message, location=at)
    return joint


def without_selectors(value: Any, robot: Configuration) -> Any:
    """Return a value with names in place of selectors; raises MissingElement and NotDecided."""
    match value:
        case str():
            return robot.selected_name(value)
        case list() | tuple():
            return type(value)(without_selectors(item, robot) for item in value)
        case Mapping():
            return {key: without_selectors(item, robot) for key, item in value.items()}
    return value


def _check_name(robot: Configuration, name: str) -> None:
    """Raise MissingElement if several joints with this name turn or slide.

    Positions are given by the joint's name.
    """
    joints = [
        joint
        for joint in robot.known.joints
        if joint.name == name and joint.type in (_TURNING + _SLIDING)
    ]
    if len(joints) > 1:
        message = f"{len(joints)} joints are called {quoted(name)}; each needs a name of its own"
        raise MissingElement("own name", name, message=message, location=joints[1].location)
