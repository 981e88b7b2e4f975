"""The geometry of solids: how far they reach in a direction, and how deep two of them overlap."""

from itertools import product

import numpy as np

from tests.second_opinion.elements import Matrix, Shape

_CLOUD = np.random.default_rng(7).normal(size=(600, 3))
_CLOUD /= np.linalg.norm(_CLOUD, axis=1)[:, None]
_QUARTERS = [
    np.array(matrix)
    for matrix in (
        np.eye(3)[list(order)] * np.array(signs)[:, None]
        for order in ((0, 1, 2), (0, 2, 1), (1, 0, 2), (1, 2, 0), (2, 0, 1), (2, 1, 0))
        for signs in product((1, -1), repeat=3)
    )
    if np.linalg.det(matrix) > 0
]


def reach(shape: Shape, rotated: Matrix, directions: Matrix) -> Matrix:
    """Return how far a solid reaches from its centre along unit directions (rows)."""
    local, size = directions @ rotated, np.abs(shape.size)
    match shape.kind:
        case "box":
            return np.abs(local) @ size / 2
        case "cylinder":
            return size[0] * np.hypot(local[:, 0], local[:, 1]) + size[1] / 2 * np.abs(local[:, 2])
    return np.full(len(directions), size[0])


def span(shape: Shape, pose: Matrix, direction: Matrix) -> tuple[float, float]:
    """Return the lowest and the highest coordinate of a solid along a unit direction."""
    middle = float(pose[:3, 3] @ direction)
    far = float(reach(shape, pose[:3, :3], np.asarray([direction]))[0])
    return middle - far, middle + far


def overlap(one: Shape, pose: Matrix, other: Shape, other_pose: Matrix, enough: float) -> float:
    """Return how far one of two solids has to move to leave the other; 0 or less if they do not overlap.

    Anything that is not more than `enough` may be an upper bound.
    """
    apart = other_pose[:3, 3] - pose[:3, 3]

    def depth(directions: Matrix) -> Matrix:
        return (
            reach(one, pose[:3, :3], directions)
            + reach(other, other_pose[:3, :3], directions)
            - directions @ apart
        )

    axes = np.vstack([pose[:3, :3].T, other_pose[:3, :3].T])
    crosses = np.cross(axes[:3, None], axes[None, 3:]).reshape(-1, 3)
    directions = np.vstack([axes, crosses, apart[None], _CLOUD])
    lengths = np.linalg.norm(directions, axis=1)
    directions = directions[lengths > 1e-9] / lengths[lengths > 1e-9][:, None]
    directions = np.vstack([directions, -directions])
    depths = depth(directions)
    best, order = float(depths.min()), np.argsort(depths)[:40]
    if best <= enough:
        return best
    starts = directions[order]
    step = 0.1
    while (
        step > 1e-11
    ):  # the depth has several minima with edges: search around the best directions, closer and closer
        near = starts[:, None, :] + step * _CLOUD[None, :40, :]
        near /= np.linalg.norm(near, axis=2)[:, :, None]
        found = depth(near.reshape(-1, 3)).reshape(len(starts), -1)
        better = found.min(axis=1) < depth(starts) - 1e-16
        starts = np.where(
            better[:, None], near[np.arange(len(starts)), found.argmin(axis=1)], starts
        )
        best = min(best, float(found.min()))
        step *= 1.0 if better.any() else 0.4
        if best <= enough:
            break
    return best


def inertia(shape: Shape, mass: float) -> Matrix:
    """Return the tensor of a uniform solid about its centre, in its own axes."""
    size = np.abs(shape.size)
    match shape.kind:
        case "box":
            squares = size**2
            return np.diag(mass / 12 * (squares.sum() - squares))
        case "cylinder":
            across = mass * (3 * size[0] ** 2 + size[1] ** 2) / 12
            return np.diag([across, across, mass * size[0] ** 2 / 2])
    return np.eye(3) * (2 / 5 * mass * size[0] ** 2)


def is_same_solid(one: Shape, other: Shape, tolerance: float) -> bool:
    """Return whether two solids are the same: kind, centre, sizes, and the place of each point of the surface."""
    if (
        one.kind != other.kind
        or np.abs(one.pose[:3, 3] - other.pose[:3, 3]).max() > tolerance + 1e-9
    ):
        return False
    sizes, others = (
        np.array(one.size),
        np.array(other.size),
    )  # a negative size differs, because simulators refuse it
    relative = one.pose[:3, :3].T @ other.pose[:3, :3]
    if one.kind == "box":
        for quarter in _QUARTERS:
            turned = relative @ quarter
            if np.abs(np.abs(quarter) @ others - sizes).max() <= tolerance + 1e-9:
                corners = np.array(list(product((-1, 1), repeat=3))) * sizes / 2
                if np.linalg.norm(corners @ turned.T - corners, axis=1).max() <= tolerance + 1e-9:
                    return True
        return False
    if np.abs(sizes - others).max() > tolerance + 1e-9:
        return False
    if one.kind == "cylinder":
        cosine = min(1.0, abs(relative[2, 2]))
        return bool(
            2 * np.sqrt((1 - cosine) / 2) * np.hypot(sizes[0], sizes[1] / 2) <= tolerance + 1e-9
        )
    return True
