"""A small picture of a robot that needs an edit: it shows only the differences that the edit removes."""

from collections.abc import Collection
from dataclasses import replace

from lxml import etree

from grader.drawing.curves import SIDE, TOP
from grader.drawing.picture import Picture, picture_of
from grader.drawing.scene import Scene
from grader.grading.report import Report
from grader.report.drawing import thumbnail_element
from grader.robot.transforms import Vector, dot

_SAME_WAY = 0.9  # cosine


def thumbnail(report: Report, criteria: Collection[str]) -> str:
    """Return a picture of a graded robot as SVG, with the differences that some criteria are about.

    It is empty if none of them is about a link, or if the robot can no longer be read.
    """
    picture = picture_of(report)
    shown = _about(picture, criteria) if picture is not None else None
    if shown is None or not any(callout.link for callout in shown.callouts):
        return ""
    element = thumbnail_element(shown, TOP if _drives_elsewhere(shown) else SIDE)
    return str(etree.tostring(element, encoding="unicode"))


def _about(picture: Picture, criteria: Collection[str]) -> Picture:
    """Return a picture with only those differences from the reference that some criteria are about.

    A frame is shown only if neither a shape nor an arrow shows the difference.
    """
    callouts = tuple(
        callout for callout in picture.callouts if any(result.criterion.id in criteria for result in callout.results)
    )
    links = {callout.link for callout in callouts}
    wheels = links.intersection(wheel.link for wheel in picture.scene.wheels)
    outlines = tuple(body for body in picture.outlines if body.link in links)
    seen = wheels.union(body.link for body in outlines)
    return replace(
        picture,
        scene=picture.scene if wheels else replace(picture.scene, wheels=()),
        outlines=outlines,
        frames=tuple(link for link in picture.frames if link in links - seen),
        callouts=callouts,
    )


def _drives_elsewhere(picture: Picture) -> bool:
    """Return whether a wheel drives in another direction than the reference's, which is visible from above."""
    expected = _travels(picture.reference) if picture.reference is not None else {}
    return any(
        wheel.travel is None or dot(wheel.travel, expected[wheel.link]) < _SAME_WAY
        for wheel in picture.scene.wheels
        if wheel.link in expected
    )


def _travels(scene: Scene) -> dict[str, Vector]:
    return {wheel.link: wheel.travel for wheel in scene.wheels if wheel.travel is not None}
