"""The mass properties of boxes, cylinders and spheres agree with pinocchio's and with trimesh's to 1e-9."""

from collections.abc import Sequence
from random import Random
from typing import Any

import numpy as np
import pytest

from grader.base.transforms import Transform, Vector, rotation_from_rpy
from grader.ros.urdf.mass_properties import Tensor, uniform_solid
from grader.ros.urdf.model import Box, Capsule, Cylinder, Sphere
from grader.ros.urdf.shapes import Shape
from tests.oracles.example_robots import MISSING

pytestmark = pytest.mark.exhaustive

pin: Any = pytest.importorskip("pinocchio", reason=MISSING)
primitives: Any = pytest.importorskip("trimesh.primitives", reason=MISSING)

_BODIES = 300


def random_vector(random: Random, most: float) -> Vector:
    """Return a vector with coordinates up to `most` in size."""
    return (random.uniform(-most, most), random.uniform(-most, most), random.uniform(-most, most))


def random_shapes(random: Random) -> list[tuple[Shape, Transform]]:
    """Return one to four shapes at random poses."""
    edges = [random.uniform(0.01, 2.0) for _ in range(8)]
    round_ones = (Cylinder(edges[3], edges[4]), Sphere(edges[5]), Capsule(edges[6], edges[7]))
    made = (Box((edges[0], edges[1], edges[2])), *round_ones)
    chosen = random.choices(made, k=random.randint(1, 4))
    return [
        (it, Transform(rotation_from_rpy(random_vector(random, 4.0)), random_vector(random, 1.0)))
        for it in chosen
    ]


def by_pinocchio(shapes: Sequence[tuple[Shape, Transform]], mass: float) -> tuple[Any, Any]:
    """Return the centre of mass and the inertia matrix that pinocchio computes."""
    total = sum(shape.volume for shape, _ in shapes)
    body = pin.Inertia.Zero()
    for shape, pose in shapes:
        part = mass * shape.volume / total
        match shape:
            case Box(size=size):
                own = pin.Inertia.FromBox(part, *size)
            case Cylinder(radius=radius, length=length):
                own = pin.Inertia.FromCylinder(part, radius, length)
            case Capsule(radius=radius, length=length):
                own = pin.Inertia.FromCapsule(part, radius, length)
            case _:
                own = pin.Inertia.FromSphere(part, shape.radius)
        body += own.se3Action(pin.SE3(np.array(pose)))
    return body.lever, body.inertia


def by_trimesh(shape: Shape, pose: Transform, mass: float) -> tuple[Any, Any]:
    """Return the centre of mass and the inertia matrix that trimesh computes for one shape."""
    where = np.array(pose)
    match shape:
        case Box(size=size):
            body = primitives.Box(extents=size, transform=where)
        case Cylinder(radius=radius, length=length):
            body = primitives.Cylinder(radius=radius, height=length, transform=where)
        case _:
            body = primitives.Sphere(radius=shape.radius, center=pose.translation)
    return body.center_mass, body.moment_inertia * (mass / body.volume)


def matrix(inertia: Tensor) -> Any:
    """Return an inertia as a matrix."""
    xx, xy, xz, yy, yz, zz = inertia
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def test_pinocchio() -> None:
    """One to four shapes of one density at random poses."""
    random = Random(15)
    for _ in range(_BODIES):
        shapes, mass = random_shapes(random), random.uniform(0.01, 5.0)
        body = uniform_solid(shapes, mass)
        centre, inertia = by_pinocchio(shapes, mass)
        assert np.allclose(body.centre, centre, rtol=0, atol=1e-9), shapes
        assert np.allclose(matrix(body.inertia), inertia, rtol=0, atol=1e-9), shapes


def test_trimesh() -> None:
    """Single shapes at random poses, with an oracle that has other formulas."""
    random = Random(16)
    for _ in range(_BODIES):
        (shape, pose), mass = random_shapes(random)[0], random.uniform(0.01, 5.0)
        if isinstance(shape, Capsule):  # there a mesh of triangles, which is smaller
            continue
        body = uniform_solid([(shape, pose)], mass)
        centre, inertia = by_trimesh(shape, pose, mass)
        assert np.allclose(body.centre, centre, rtol=0, atol=1e-9), shape
        assert np.allclose(matrix(body.inertia), inertia, rtol=0, atol=1e-9), shape
