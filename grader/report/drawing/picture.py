"""The content of a picture of a graded robot: the scene, differences from the reference, failed criteria."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import NamedTuple

from grader.errors import InputError
from grader.grading.criterion import Criterion
from grader.grading.report import Report, Result
from grader.grading.rubric import Rubric
from grader.hints.targets import selected
from grader.report.drawing.scene import Body, Scene, scene_of
from grader.robot.kinematics import Configuration
from grader.robot.link_tree import texts_in
from grader.robot.transforms import Transform, Vector

_SUBJECTS = ("link", "links", "wheels")  # the arguments of a check that name what it examines


class Callout(NamedTuple):
    """The criteria that failed on a link, and the point that marks it in the picture, in metres in the scene's frame.

    `point` is None if the link has no pose in the picture; `link` is empty for criteria on the whole robot.
    """

    number: int
    link: str
    point: Vector | None
    results: tuple[Result, ...]


@dataclass(frozen=True, slots=True)
class Picture:
    """What a picture of a graded robot shows.

    `outlines` are the bodies of the reference where shapes or their places failed, and `frames` its poses of links
    whose frames failed; also where the robot has none. Both are empty if the hint level does not show the reference.
    """

    scene: Scene
    outlines: tuple[Body, ...]
    frames: tuple[Transform, ...]
    callouts: tuple[Callout, ...]


def plain_picture(robot: Configuration | None, frame: str | None) -> Picture | None:
    """Return the picture of a robot that is not graded, in the frame of one of its links; None without either."""
    return Picture(scene_of(robot, frame), (), (), ()) if robot is not None and frame is not None else None


def picture_of(report: Report) -> Picture | None:
    """Return the picture of a graded robot; None if there is no robot, or if it can no longer be read."""
    if report.submission.robot is None or not report.submission.robot.links:
        return None
    robot = Configuration(report.submission.robot)
    solution = _reference(report.rubric)
    frame, reference_frame = _frames(report.rubric, robot, solution)
    if frame is None:
        return None
    wheels = [*_wheels(report.rubric, robot)]
    scene = scene_of(robot, frame, wheels)
    reference = scene_of(solution, reference_frame, wheels) if solution is not None and reference_frame else None
    lost = [result for result in report.results if _is_marked(result)]
    about = _by_link(lost, robot, solution)
    outlines, frames = _expected(scene, reference, about) if reference is not None else ((), ())
    callouts = tuple(
        Callout(
            number,
            link,
            scene.centre(link) or (reference.centre(link) if reference is not None else None),
            tuple(results),
        )
        for number, (link, results) in enumerate(about.items(), 1)
    )
    return Picture(scene, outlines, frames, callouts)


def _reference(rubric: Rubric) -> Configuration | None:
    """Return the reference solution; None if the hint level does not show it."""
    if rubric.solution is None or rubric.hints in ("none", "place"):
        return None
    with suppress(InputError):
        return rubric.solution.robot
    return None


def _frames(rubric: Rubric, robot: Configuration, solution: Configuration | None) -> tuple[str | None, str | None]:
    """Return the links in whose frames both robots are drawn: the rubric's base, else the roots."""
    trees = [one.main_tree if one is not None else () for one in (robot, solution)]
    own, other = (selected(one, rubric.base) if one is not None else None for one in (robot, solution))
    if own in trees[0] and (other is None or other in trees[1]):
        return own, other
    return next(iter(trees[0]), None), next(iter(trees[1]), None)


def _wheels(rubric: Rubric, robot: Configuration) -> Iterator[str]:
    """Yield the links that the rubric expects to roll."""
    for criterion in rubric.criteria:
        if criterion.check.about.picture == "wheel":
            yield selected(robot, str(criterion.arguments["link"]))


def _is_marked(result: Result) -> bool:
    """Return whether a picture marks a criterion: it failed on the robot, and its points are lost."""
    is_about_robot = result.criterion.check.subject in ("urdf", "robot")
    return is_about_robot and result.outcome.status == "failed" and result.is_lost and result.manual_mark is None


def _by_link(lost: Sequence[Result], robot: Configuration, solution: Configuration | None) -> dict[str, list[Result]]:
    """Return the criteria by the link that they are about, in the rubric's order; by "" for several links, or none."""
    found: dict[str, list[Result]] = {}
    for result in lost:
        links = [*_links(result.criterion, robot, solution)]
        found.setdefault(links[0] if len(links) == 1 else "", []).append(result)
    return found


def _links(criterion: Criterion, robot: Configuration, solution: Configuration | None) -> Iterator[str]:
    """Yield the links that a criterion examines and that one of the robots has."""
    subject = next((criterion.arguments[key] for key in _SUBJECTS if key in criterion.arguments), None)
    for link in dict.fromkeys(selected(robot, name) for name in texts_in(subject)):
        if robot.robot.has_link(link) or (solution is not None and solution.robot.has_link(link)):
            yield link


def _expected(
    scene: Scene, reference: Scene, about: Mapping[str, Sequence[Result]]
) -> tuple[tuple[Body, ...], tuple[Transform, ...]]:
    """Return the bodies and the frames of the reference that the failed criteria are about."""
    kinds = {link: {it.criterion.check.about.picture for it in results} for link, results in about.items()}
    shown = {body.link for body in scene.bodies}
    shapes = {link for link, found in kinds.items() if "outline" in found or link not in shown}
    frames = {link for link, found in kinds.items() if "frame" in found or link not in scene.poses}
    outlines = tuple(body for body in reference.bodies if body.link in shapes)
    return outlines, tuple(pose for link, pose in reference.poses.items() if link in frames)
