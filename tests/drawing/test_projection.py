"""Outlines, hidden edges and the order of shapes in a view, compared with sampled points and with rays."""

from itertools import product
from math import cos, pi, sin

import numpy as np
from hypothesis import Phase, example, given, settings
from hypothesis import strategies as st

from grader.drawing.curves import Curve, outline
from grader.drawing.order import MAX_PAIRS, Seen
from grader.drawing.projection import Projection, projection
from grader.drawing.views import FRONT, SIDE, TOP, View
from grader.robot.model import Box, Cylinder, Sphere
from grader.robot.shapes import Shape
from grader.robot.transforms import Rotation, Transform, Vector, rotation_from_rpy
from tests.drawing.shapes import POSES, ROTATIONS, SHAPES, Points, contains, placed, scene_with, surface

VIEWS = (TOP, SIDE, FRONT)
EXACT = 0.0005  # metres
SHARES = np.linspace(0.0, 1.0, 91)
TO_VIEWER = np.linspace(0.0, 1.5, 1501)  # metres, 1 mm apart
SCENES = st.lists(st.tuples(SHAPES, POSES), min_size=3, max_size=6)


def points_of(curves: tuple[Curve, ...]) -> Points:
    """Return points on curves of a view, along them."""
    return np.array([curve.at(share)[:2] for curve in curves for share in SHARES])


@given(SHAPES, POSES, st.sampled_from(VIEWS))
@example(Box((0.5, 0.5, 0.5)), Transform(rotation_from_rpy((pi / 2.0, 2.0, 0.0))), FRONT)  # edges above each other
@settings(max_examples=60)
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


@given(SCENES, st.sampled_from(VIEWS))
@settings(max_examples=40, phases=set(Phase) - {Phase.shrink})
def test_edges_are_hidden_where_a_ray_to_the_viewer_enters_a_shape(
    shapes: list[tuple[Shape, Transform]], view: View
) -> None:
    """Rays are marched in steps: from visible edges they meet no shape, from hidden ones they do, each to 2 mm."""
    drawn = projection(scene_with(*map(list, zip(*shapes, strict=True))), view)
    for stroke in drawn.visible:
        for ray in rays(stroke.curve):
            assert not any(contains(body.body.shape, body.pose, ray, -0.002).any() for body in drawn.bodies)
    for stroke in drawn.hidden:
        for ray in rays(stroke.curve):
            own = [body for body in drawn.bodies if is_on_surface(body, ray[:1])]
            assert len(own) > 1 or any(meets(body, ray, is_own=body in own) for body in drawn.bodies)


def is_on_surface(body: Seen, point: Points) -> bool:
    """Return whether a point is on the surface of a body, to 3 mm."""
    shape, pose = body.body.shape, body.pose
    return bool(contains(shape, pose, point, 0.003)[0] and not contains(shape, pose, point, -0.003)[0])


def meets(body: Seen, ray: Points, *, is_own: bool) -> bool:
    """Return whether a ray enters a body: its own, grown by 0.5 mm, from 1 mm on, or another one, grown by 2 mm."""
    return bool(contains(body.body.shape, body.pose, ray[is_own:], 0.0005 if is_own else 0.002).any())


def rays(curve: Curve) -> list[Points]:
    """Return points from three places on a curve to the viewer."""
    return [np.array(curve.at(share)) + np.outer(TO_VIEWER, (0.0, 0.0, 1.0)) for share in (0.2, 0.5, 0.8)]


@given(
    st.lists(
        st.tuples(SHAPES, ROTATIONS, st.sampled_from([*product((-0.8, 0.0, 0.8), repeat=3)])),
        max_size=8,
        unique_by=lambda item: item[2],
    ),
    st.sampled_from(VIEWS),
)
@settings(max_examples=60)
def test_shape_in_front_is_painted_last(shapes: list[tuple[Shape, Rotation, Vector]], view: View) -> None:
    """At the centre of each shape the one painted last is the one that a ray from the viewer meets first."""
    poses = [Transform(rotation, place) for _, rotation, place in shapes]
    drawn = projection(scene_with([shape for shape, _, _ in shapes], poses), view)
    for body in drawn.bodies:
        x, y, _ = body.pose.translation
        assert painted_last(drawn, x, y) == nearest(drawn, x, y)


def painted_last(drawn: Projection, x: float, y: float) -> int:
    """Return the position of the last body whose outline has a place inside."""
    return max(index for index, depth in enumerate(depths(drawn, x, y)) if depth is not None)


def nearest(drawn: Projection, x: float, y: float) -> int:
    """Return the position of the body whose surface is nearest to the viewer at a place."""
    found = [(depth, index) for index, depth in enumerate(depths(drawn, x, y)) if depth is not None]
    return max(found)[1]


def depths(drawn: Projection, x: float, y: float) -> list[float | None]:
    """Return the nearest depth of each body on a ray, from points 1 mm apart."""
    line = np.column_stack([np.full(4001, x), np.full(4001, y), np.linspace(-2.0, 2.0, 4001)])
    inside = [line[contains(body.body.shape, body.pose, line, 0.0), 2] for body in drawn.bodies]
    return [float(points.max()) if len(points) else None for points in inside]


def test_buried_part_is_hidden_exactly() -> None:
    """The rim of a cylinder that stands 20 mm deep in a box is hidden below the box's top, and its sides from there."""
    drawn = projection(
        scene_with([Box((0.4, 0.4, 0.2)), Cylinder(0.1, 0.06)], [Transform(), Transform(translation=(0.0, 0.0, 0.11))]),
        SIDE,
    )
    sides = sorted(stroke.curve.at(share)[1] for stroke in drawn.hidden for share in (0.0, 1.0))
    assert sides[0] == sides[1]  # the lower rim
    assert abs(sides[0] - 0.08) < 1e-9
    assert abs(sides[-1] - 0.1) <= 2e-4  # the top of the box


def test_touching_shape_is_not_hidden() -> None:
    """A wheel beside a base and a caster below it are seen whole: a surface that touches hides nothing."""
    wheel = Transform(rotation_from_rpy((pi / 2.0, 0.0, 0.0)), (0.0, -0.225, 0.0))
    drawn = projection(
        scene_with(
            [Box((0.6, 0.4, 0.2)), Cylinder(0.1, 0.05), Sphere(0.05)],
            [Transform(), wheel, Transform(translation=(0.2, 0.0, -0.15))],
        ),
        VIEWS[0],
    )
    assert [stroke.curve.at(0.0)[2] for stroke in drawn.hidden if stroke.curve.at(0.0)[2] > -0.1] == []


def test_too_many_overlaps_are_bounded() -> None:
    """Shapes that all overlap are drawn without hidden edges, and the drawing knows it."""
    count = 120
    assert count * (count - 1) / 2 > MAX_PAIRS
    drawn = projection(
        scene_with(
            [Box((0.1, 0.1, 0.1))] * count, [Transform(translation=(0.0, 0.0, 0.001 * n)) for n in range(count)]
        ),
        SIDE,
    )
    assert not drawn.is_complete
    assert len(drawn.bodies) == count
