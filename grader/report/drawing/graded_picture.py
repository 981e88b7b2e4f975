"""The picture of a graded robot: differences from the reference, and failed criteria."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from typing import Any

from grader.base.errors import InputError
from grader.base.text import texts_in
from grader.base.transforms import Transform
from grader.lab.grading.report import Report, Result
from grader.lab.rubric.criterion import Criterion
from grader.lab.rubric.rubric import Rubric
from grader.report.content import failures
from grader.report.criteria import write_points
from grader.report.drawing.picture import Body, Callout, Picture, Scene, make_scene
from grader.ros.api import Configuration

_SUBJECTS = ("link", "links", "wheels")  # the arguments of a check that name what it examines


def draw_report(report: Report) -> Picture | None:
    """Return the picture of a graded robot.

    It is None if there is no robot, or if it can no longer be read.
    """
    if not report.submission.robot or not report.submission.robot.links:
        return None
    robot = Configuration(report.submission.robot)
    solution = _reference(report.rubric)
    frame, reference_frame = _frames(report.rubric, robot, solution)
    if frame is None:
        return None
    wheels = list(dict.fromkeys(_wheels(report.rubric, robot)))
    scene = make_scene(robot, frame, wheels, report.submission.meshes)
    reference = None
    if solution and reference_frame:
        reference = make_scene(solution, reference_frame, wheels)
    lost = [entry.result for entry in failures(report) if _is_marked(entry.result)]
    by_link = _by_link(lost, robot, solution)
    callouts = []
    for number, (link, results) in enumerate(by_link.items(), 1):
        point = scene.centre(link)
        if point is None and reference:
            point = reference.centre(link)
        names = tuple(result.id for result in results)
        callouts.append(Callout(number, link, point, names, write_points(results)))
    driving = _find_driving(report.rubric, robot, wheels)
    if not reference:
        return Picture(scene, (), (), tuple(callouts), driving)
    outlines, frames = _expected(scene, reference, by_link)
    return Picture(scene, outlines, frames, tuple(callouts), driving)


def _reference(rubric: Rubric) -> Configuration | None:
    """Return the reference solution; None if the hint level does not show it."""
    if not rubric.solution or rubric.hints in ("none", "place"):
        return None
    with suppress(InputError):
        return rubric.solution.robot
    return None


def _frames(
    rubric: Rubric, robot: Configuration, solution: Configuration | None
) -> tuple[str | None, str | None]:
    """Return the links in whose frames both robots are drawn: the rubric's base, else the roots."""
    tree = robot.main_tree
    base = robot.selected_or_name(rubric.base)
    if not solution:
        return (base if base in tree else next(iter(tree), None)), None
    other_tree = solution.main_tree
    other_base = solution.selected_or_name(rubric.base)
    if base in tree and other_base in other_tree:
        return base, other_base
    return next(iter(tree), None), next(iter(other_tree), None)


def _wheels(rubric: Rubric, robot: Configuration) -> Iterator[str]:
    """Yield the links that the rubric expects to roll."""
    for criterion in rubric.criteria:
        if criterion.check.about.picture == "wheel":
            given = criterion.arguments
            for name in given["wheels"] if "wheels" in given else [given["link"]]:
                yield robot.selected_or_name(str(name))


def _find_driving(rubric: Rubric, robot: Configuration, wheels: Sequence[str]) -> Mapping[str, Any]:
    """Return the wheels that drive a robot, and what the first criterion on them says besides."""
    for criterion in rubric.criteria:
        given = criterion.arguments
        if criterion.check.name == "drives_straight":
            named = [robot.selected_or_name(wheel) for wheel in given["wheels"]]
            others = {key: given[key] for key in ("base", "forward", "rollers") if key in given}
            return {"wheels": named, **others}
    return {"wheels": wheels}


def _is_marked(result: Result) -> bool:
    """Return whether a picture marks a criterion.

    It failed on the robot, and its points are lost.
    """
    return (
        result.criterion.check.is_of_robot
        and result.outcome.status == "failed"
        and result.is_lost
        and not result.manual_mark
    )


def _by_link(
    lost: Sequence[Result], robot: Configuration, solution: Configuration | None
) -> dict[str, list[Result]]:
    """Return the criteria by the link that they are about, in the order of the mistakes.

    The key is "" for several links, or none.
    """
    results_by_link: dict[str, list[Result]] = {}
    for result in lost:
        links = list(_links(result.criterion, robot, solution))
        results_by_link.setdefault(links[0] if len(links) == 1 else "", []).append(result)
    return results_by_link


def _links(
    criterion: Criterion, robot: Configuration, solution: Configuration | None
) -> Iterator[str]:
    """Yield the links that a criterion examines and that one of the robots has."""
    subject = next(
        (criterion.arguments[key] for key in _SUBJECTS if key in criterion.arguments), None
    )
    for link in dict.fromkeys(robot.selected_or_name(name) for name in texts_in(subject)):
        if robot.robot.has_link(link) or (solution and solution.robot.has_link(link)):
            yield link


def _expected(
    scene: Scene, reference: Scene, by_link: Mapping[str, Sequence[Result]]
) -> tuple[tuple[Body, ...], tuple[Transform, ...]]:
    """Return the bodies and the frames of the reference that the failed criteria are about."""
    links_with_shape = {body.link for body in scene.bodies}
    shapes = set[str]()
    frames = set[str]()
    for link, results in by_link.items():
        kinds = {result.criterion.check.about.picture for result in results}
        if "outline" in kinds or link not in links_with_shape:
            shapes.add(link)
        if "frame" in kinds or link not in scene.poses:
            frames.add(link)
    outlines = tuple(body for body in reference.bodies if body.link in shapes)
    return outlines, tuple(pose for link, pose in reference.poses.items() if link in frames)
