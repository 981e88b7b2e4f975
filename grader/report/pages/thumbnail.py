"""A small picture of a robot that needs an edit: only what the edit changes differs from the reference."""

from collections.abc import Collection
from dataclasses import replace

from lxml import etree

from grader.drawing.picture import Picture, picture_of
from grader.drawing.scene import Scene
from grader.drawing.views import SIDE, TOP
from grader.grading.report import Report
from grader.report.drawing import thumbnail_element
from grader.robot.transforms import Vector, dot

_SAME_WAY = 0.9  # cosine


def thumbnail(report: Report, criteria: Collection[str]) -> str:
    """Return a picture of a graded robot as SVG, with what some criteria are about; empty if it can no longer be read."""
    picture = picture_of(report)
    if picture is None:
        return ""
    shown = _about(picture, criteria)
    element = thumbnail_element(shown, TOP if _drives_elsewhere(shown) else SIDE)
    return str(etree.tostring(element, encoding="unicode"))


def _about(picture: Picture, criteria: Collection[str]) -> Picture:
    """Return a picture with only those differences from the reference that some criteria are about."""
    callouts = tuple(
        callout for callout in picture.callouts if any(result.criterion.id in criteria for result in callout.results)
    )
    links = {callout.link for callout in callouts}
    has_wheels = any(wheel.link in links for wheel in picture.scene.wheels)
    return replace(
        picture,
        scene=picture.scene if has_wheels else replace(picture.scene, wheels=()),
        outlines=tuple(body for body in picture.outlines if body.link in links),
        frames=tuple(link for link in picture.frames if link in links),
        callouts=callouts,
    )


def _drives_elsewhere(picture: Picture) -> bool:
    """Return whether a wheel drives another way than that of the reference, which is seen from above."""
    expected = _travels(picture.reference) if picture.reference is not None else {}
    return any(
        wheel.travel is None or dot(wheel.travel, expected[wheel.link]) < _SAME_WAY
        for wheel in picture.scene.wheels
        if wheel.link in expected
    )


def _travels(scene: Scene) -> dict[str, Vector]:
    return {wheel.link: wheel.travel for wheel in scene.wheels if wheel.travel is not None}
