"""Outlines and the order of shapes in a view, compared with sampled points and with rays; places of labels."""

from itertools import product
from math import cos, pi, sin

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from grader.base.transforms import Rotation, Transform, Vector, rotation_from_rpy
from grader.report.drawing.picture import Body, Picture
from grader.report.drawing.views import FreePlaces, Panel, from_back_to_front, hull, make_panels
from grader.ros.urdf.model import Box
from grader.ros.urdf.shapes import Shape
from tests.examples import examples
from tests.report.drawing.shapes import (
    POSES,
    ROTATIONS,
    SHAPES,
    contains,
    placed,
    scene_with,
    surface,
)

pytestmark = pytest.mark.slow

DIRECTIONS = [np.array([cos(number * pi / 8.0), sin(number * pi / 8.0)]) for number in range(16)]


def panels(shapes: list[Shape], poses: list[Transform]) -> tuple[Panel, ...]:
    return make_panels(Picture(scene_with(shapes, poses), (), (), ()))


@given(SHAPES, POSES)
@example(
    Box((0.5, 0.5, 0.5)), Transform(rotation_from_rpy((pi / 2.0, 2.0, 0.0)))
)  # edges above each other
@examples(10)
def test_outline_is_that_of_the_sampled_surface(shape: Shape, pose: Transform) -> None:
    """The surface reaches as far as the outline in 16 directions of each view: to 0.3 % of a radius and a tenth of a pixel."""
    scene, points = scene_with([shape], [pose]), placed(pose, surface(shape))
    for panel in panels([shape], [pose]):
        drawn = np.array(panel.outline(scene.bodies[0]))
        sampled = np.array(
            [panel.place((x, y, z)) for x, y, z in points[:: max(1, len(points) // 3000)]]
        )
        size = np.ptp(drawn, axis=0).max()
        for direction in DIRECTIONS:
            assert (
                abs((sampled @ direction).max() - (drawn @ direction).max()) <= 0.2 + 0.003 * size
            )


@given(st.lists(st.tuples(st.integers(-9, 9), st.integers(-9, 9)), min_size=1, max_size=30))
@examples(30)
def test_a_hull_is_convex_and_has_all_points_inside(points: list[tuple[int, int]]) -> None:
    """Each corner is one of the points, and each point is to the same side of every edge."""
    corners = hull(np.array(points, float))
    assert {*corners} <= {(float(x), float(y)) for x, y in points}
    if len({*points}) > 2:
        for (a, b), (c, d) in zip(corners, corners[1:] + corners[:1], strict=True):
            assert all((c - a) * (y - b) - (d - b) * (x - a) >= 0.0 for x, y in points)


@given(
    st.lists(
        st.tuples(SHAPES, ROTATIONS, st.sampled_from([*product((-0.8, 0.0, 0.8), repeat=3)])),
        min_size=1,
        max_size=8,
        unique_by=lambda item: item[2],
    ),
    st.integers(0, 2),
)
@examples(10)
def test_shape_in_front_is_painted_last(
    shapes: list[tuple[Shape, Rotation, Vector]], view: int
) -> None:
    """At the centre of each shape the one painted last is the one that a ray from the viewer meets first."""
    poses = [Transform(rotation, place) for _, rotation, place in shapes]
    scene = scene_with([shape for shape, _, _ in shapes], poses)
    panel = panels([shape for shape, _, _ in shapes], poses)[view]
    drawn, near = from_back_to_front(scene.bodies, panel), np.array(panel.near)
    line = np.outer(np.linspace(-2.0, 2.0, 4001), near)
    for body in drawn:
        centre = np.array(body.T_frame_shape.translation)
        found = [_depth(other, line + centre - near * (centre @ near)) for other in drawn]
        met = [(depth, index) for index, depth in enumerate(found) if depth is not None]
        assert max(met)[1] == max(index for _, index in met)


def _depth(body: Body, ray: object) -> float | None:
    """Return where a ray from the viewer meets a body first; None if it does not."""
    inside = contains(body.shape, body.T_frame_shape, ray, 0.0)
    return float(np.flatnonzero(inside).max()) if inside.any() else None


def test_labels_take_places_of_their_own() -> None:
    """The first place that is free and in the view; without one, none."""
    (panel, *_) = panels([Box((0.6, 0.4, 0.2))], [Transform()])
    places, size = FreePlaces(panel), (10.0, 10.0)
    near = panel.place((0.0, 0.0, 0.0))
    far = (near[0] + 20.0, near[1])
    assert places.take([near, far], size) == near
    assert places.take([near, far], size) == far
    assert places.take([near, far], size) is None
    assert places.take([(panel.left, panel.top)], size) is None
