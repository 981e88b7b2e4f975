"""Outlines and the order of shapes in a view, compared with sampled points and with rays."""

from itertools import product
from math import cos, pi, sin

import numpy as np
from hypothesis import example, given
from hypothesis import strategies as st

from grader.drawing.curves import FRONT, SIDE, TOP, Curve, View, inner_edges, outline
from grader.drawing.sheet import Seen, projection
from grader.robot.model import Box
from grader.robot.shapes import Shape
from grader.robot.transforms import Rotation, Transform, Vector, rotation_from_rpy
from tests.drawing.shapes import POSES, ROTATIONS, SHAPES, Points, contains, placed, scene_with, surface
from tests.examples import examples

VIEWS = (TOP, SIDE, FRONT)
EXACT = 0.0005  # metres
SHARES = np.linspace(0.0, 1.0, 91)
TO_VIEWER = np.linspace(0.0, 1.5, 1501)  # metres, 1 mm apart


def points_of(curves: tuple[Curve, ...]) -> Points:
    """Return points on curves of a view, along them."""
    return np.array([curve.at(share)[:2] for curve in curves for share in SHARES])


@given(SHAPES, POSES, st.sampled_from(VIEWS))
@example(Box((0.5, 0.5, 0.5)), Transform(rotation_from_rpy((pi / 2.0, 2.0, 0.0))), FRONT)  # edges above each other
@examples(10)
def test_outline_is_that_of_the_sampled_surface(shape: Shape, pose: Transform, view: View) -> None:
    """The surface reaches as far as the outline in 16 directions and is inside of it, to 0.5 mm."""
    T_view_shape = view.T_view_frame @ pose
    sampled = placed(T_view_shape, surface(shape))[:, :2]
    drawn = points_of(outline(shape, T_view_shape))
    for number in range(16):
        direction = np.array([cos(number * pi / 8.0), sin(number * pi / 8.0)])
        assert abs((sampled @ direction).max() - (drawn @ direction).max()) <= EXACT
    edges = np.roll(drawn, -1, axis=0) - drawn
    is_long = np.linalg.norm(edges, axis=1) > 1e-6
    starts, edges = drawn[is_long], edges[is_long]
    outward = np.column_stack([edges[:, 1], -edges[:, 0]]) / np.linalg.norm(edges, axis=1)[:, None]
    outward *= np.sign(np.sum((starts - T_view_shape.translation[:2]) * outward, axis=1))[:, None]
    assert (sampled @ outward.T - np.sum(starts * outward, axis=1)).max() <= EXACT


@given(SHAPES, POSES, st.sampled_from(VIEWS))
@examples(10)
def test_inner_edge_is_hidden_where_a_ray_to_the_viewer_enters_the_shape(
    shape: Shape, pose: Transform, view: View
) -> None:
    """Rays from three places on an edge are sampled: those of an edge that faces the viewer stay outside, to 0.5 mm."""
    T_view_shape = view.T_view_frame @ pose
    for curve, faces_viewer in inner_edges(shape, T_view_shape):
        for share in (0.2, 0.5, 0.8):
            ray = np.array(curve.at(share)) + np.outer(TO_VIEWER, (0.0, 0.0, 1.0))
            if faces_viewer:
                assert not contains(shape, T_view_shape, ray, -0.0005).any()
            else:
                assert contains(shape, T_view_shape, ray[1:], 0.0005).any()


@given(
    st.lists(
        st.tuples(SHAPES, ROTATIONS, st.sampled_from([*product((-0.8, 0.0, 0.8), repeat=3)])),
        max_size=8,
        unique_by=lambda item: item[2],
    ),
    st.sampled_from(VIEWS),
)
@examples(10)
def test_shape_in_front_is_painted_last(shapes: list[tuple[Shape, Rotation, Vector]], view: View) -> None:
    """At the centre of each shape the one painted last is the one that a ray from the viewer meets first."""
    poses = [Transform(rotation, place) for _, rotation, place in shapes]
    drawn = projection(scene_with([shape for shape, _, _ in shapes], poses), view)
    for body in drawn:
        x, y, _ = body.pose.translation
        assert painted_last(drawn, x, y) == nearest(drawn, x, y)


def painted_last(drawn: list[Seen], x: float, y: float) -> int:
    """Return the position of the last body whose outline has a place inside."""
    return max(index for index, depth in enumerate(depths(drawn, x, y)) if depth is not None)


def nearest(drawn: list[Seen], x: float, y: float) -> int:
    """Return the position of the body whose surface is nearest to the viewer at a place."""
    found = [(depth, index) for index, depth in enumerate(depths(drawn, x, y)) if depth is not None]
    return max(found)[1]


def depths(drawn: list[Seen], x: float, y: float) -> list[float | None]:
    """Return the nearest depth of each body on a ray, from points 1 mm apart."""
    line = np.column_stack([np.full(4001, x), np.full(4001, y), np.linspace(-2.0, 2.0, 4001)])
    inside = [line[contains(body.body.shape, body.pose, line, 0.0), 2] for body in drawn]
    return [float(points.max()) if len(points) else None for points in inside]
