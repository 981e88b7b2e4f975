"""Random shapes in random poses, and points on and in them: computed with numpy, without the code of drawings."""

from math import pi
from typing import Any

import numpy as np
from hypothesis import strategies as st

from grader.base.transforms import Transform, rotation_from_rpy
from grader.report.drawing.picture import Body, Scene
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.model import Box, Cylinder, Link, Robot, Sphere
from grader.ros.urdf.shapes import Shape

Points = Any  # an array of shape (n, 3)

_SIZES = st.floats(0.02, 0.5)
_ANGLES = st.one_of(st.floats(-pi, pi), st.sampled_from([0.0, pi / 2.0, -1.57]))
ROTATIONS = st.builds(lambda *rpy: rotation_from_rpy(rpy), _ANGLES, _ANGLES, _ANGLES)
POSES = st.builds(Transform, ROTATIONS, st.tuples(*[st.floats(-0.3, 0.3)] * 3))
SHAPES = st.one_of(
    st.builds(Box, st.tuples(_SIZES, _SIZES, _SIZES)),
    st.builds(Cylinder, st.floats(0.02, 0.25), _SIZES),
    st.builds(Sphere, st.floats(0.02, 0.25)),
)


def scene_with(shapes: list[Shape], poses: list[Transform]) -> Scene:
    """Return a scene of a robot of one link that shows these shapes."""
    robot = Configuration(Robot("r", (Link("a"),)))
    bodies = tuple(
        Body("a", shape, pose, (0.5, 0.5, 0.5, 1.0))
        for shape, pose in zip(shapes, poses, strict=True)
    )
    return Scene(robot, "a", {"a": Transform()}, bodies, (), ())


def surface(shape: Shape) -> Points:
    """Return points on the surface of a shape, in its frame: at most 1.5 degrees, or a tenth of a face, apart."""
    turn = np.linspace(0.0, 2.0 * pi, 241)
    if isinstance(shape, Box):
        grid = np.stack(np.meshgrid(*[np.linspace(-0.5, 0.5, 11)] * 3), axis=-1).reshape(-1, 3)
        return grid[np.abs(grid).max(axis=1) > 0.49] * np.array(shape.size)
    if isinstance(shape, Cylinder):
        across = np.stack([np.cos(turn), np.sin(turn)], axis=-1)
        levels = np.linspace(-0.5, 0.5, 5) * shape.length
        side = [np.column_stack([shape.radius * across, np.full(len(turn), z)]) for z in levels]
        caps = [
            np.column_stack([0.5 * shape.radius * across, np.full(len(turn), z)])
            for z in levels[[0, -1]]
        ]
        return np.concatenate(side + caps)
    polar, around = np.meshgrid(np.linspace(0.0, pi, 121), turn)
    flat = np.sin(polar)
    ball = np.stack([flat * np.cos(around), flat * np.sin(around), np.cos(polar)], axis=-1)
    return shape.radius * ball.reshape(-1, 3)


def contains(shape: Shape, pose: Transform, points: Points, grown: float) -> Any:
    """Return for each point whether it is in a shape that is grown on each side; a negative number shrinks it."""
    local = (points - np.array(pose.translation)) @ np.array(pose.matrix)[:3, :3]
    if isinstance(shape, Box):
        return np.all(np.abs(local) <= np.array(shape.size) / 2.0 + grown, axis=1)
    if isinstance(shape, Cylinder):
        across = np.hypot(local[:, 0], local[:, 1])
        return (across <= shape.radius + grown) & (
            np.abs(local[:, 2]) <= shape.length / 2.0 + grown
        )
    return np.linalg.norm(local, axis=1) <= shape.radius + grown


def placed(pose: Transform, points: Points) -> Points:
    """Return points of a shape's frame in the frame of the pose."""
    return points @ np.array(pose.matrix)[:3, :3].T + np.array(pose.translation)
