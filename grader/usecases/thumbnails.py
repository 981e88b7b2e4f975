"""Draw small pictures of robots that need the edits of a class, each with what that edit changes."""

from collections.abc import Collection
from concurrent.futures import Executor
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

from grader.classroom.gradebook.fixes import CommonFix
from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.drawing.picture import Picture, picture_of
from grader.drawing.scene import Scene
from grader.drawing.views import SIDE, TOP
from grader.robot.transforms import dot

_MAX_TRIED = 3  # students whose submissions may have changed since they were graded
_SAME_WAY = 0.9  # cosine


def thumbnails(executor: Executor, book: Path, fixes: Collection[CommonFix]) -> dict[str, str]:
    """Return a picture as SVG of a robot that needs each edit, by the action; none where it can no longer be read."""
    tasks = {
        fix.action: executor.submit(thumbnail, str(book), fix.students[:_MAX_TRIED], fix.criteria) for fix in fixes
    }
    found = {}
    for action, task in tasks.items():
        with suppress(Exception):  # whatever a robot does to its picture: the page is complete without it
            found[action] = task.result()
    return found


def thumbnail(book: str, keys: Collection[str], criteria: Collection[str]) -> str:
    """Return a picture of the first of some students' robots that can be read; empty if there is none."""
    from lxml import etree

    from grader.report.drawing import thumbnail_element

    with Gradebook(Path(book)) as opened:
        grades = Grades(opened)
        for key in keys:
            picture = picture_of(grades.report(grades.find(key)))
            if picture is not None:
                shown = _about(picture, criteria)
                view = TOP if _drives_elsewhere(shown) else SIDE
                return str(etree.tostring(thumbnail_element(shown, view), encoding="unicode"))
    return ""


def _about(picture: Picture, criteria: Collection[str]) -> Picture:
    """Return a picture with only those differences from the reference that some criteria are about."""
    callouts = tuple(
        callout for callout in picture.callouts if any(result.criterion.id in criteria for result in callout.results)
    )
    links = {callout.link for callout in callouts}
    wheels = tuple(wheel for wheel in picture.scene.wheels if wheel.link in links)
    return replace(
        picture,
        scene=picture.scene if wheels else replace(picture.scene, wheels=()),
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


def _travels(scene: Scene) -> dict[str, tuple[float, float, float]]:
    return {wheel.link: wheel.travel for wheel in scene.wheels if wheel.travel is not None}
