"""Harnesses of what is read of mesh files for pictures."""

from collections.abc import Callable, Iterable, Mapping
from functools import partial

import numpy as np

from grader.ros.mesh.triangles import Triangles, read_triangles
from tests.fuzz.harness import check_message
from tests.mesh.mesh_files import CUBE, WRITERS
from tests.mesh.test_triangles import FAULTS


def mesh(data: bytes, name: str) -> None:
    """A mesh has finite triangles in the box around them, also when they are reduced, or a reason why it is not shown."""
    found = read_triangles(data, name)
    if not isinstance(found, Triangles):
        check_message(found)
        assert len(found) < 200
        return
    assert found.corners.dtype == np.float32
    assert found.corners.shape == (found.count, 3, 3)
    assert found.count > 0
    low, high = found.bounds
    assert all(-np.inf < a <= b < np.inf for a, b in zip(low, high, strict=True))
    reduced = found.reduced(5)
    assert reduced.count <= 5
    assert np.isfinite(reduced.corners).all()


def seeds(ending: str) -> Iterable[bytes]:
    """Yield a small mesh in a format, and those that are broken."""
    yield from (write(CUBE[:3]) for name, write in WRITERS.items() if name.lower().endswith(ending))
    yield from (data for data, path, _ in FAULTS.values() if path.endswith(ending))


MESHES: Mapping[str, Callable[[bytes], None]] = {
    ending: partial(mesh, name=f"a.{ending}") for ending in ("stl", "obj", "dae")
}
