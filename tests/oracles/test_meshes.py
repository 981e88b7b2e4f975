"""Mesh files have the triangles that trimesh reads: those of real robots, and those that it writes."""

import io
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from grader.ros.mesh.triangles import Triangles, read_triangles
from grader.ros.xml.parsing import parse_xml
from tests.oracles.example_robots import FOLDER, MISSING

pytestmark = [
    pytest.mark.exhaustive,
    pytest.mark.skipif(
        find_spec("trimesh") is None or find_spec("collada") is None, reason=MISSING
    ),
]
_ENDINGS = (".stl", ".obj", ".dae")
FILES = [
    path
    for path in sorted(FOLDER.rglob("*") if FOLDER is not None else ())
    if path.suffix.lower() in _ENDINGS
]
_FOLDERS = sorted({path.relative_to(FOLDER).parts[0] for path in FILES}) if FOLDER else []
# Robots one of whose meshes has a texture that pycollada does not read: it gives no triangles then.
_UNREAD_BY_TRIMESH = {"anymal_foot.dae"}


def trimesh_triangles(data: bytes, ending: str) -> np.ndarray:
    """Return the triangles that trimesh reads, shape (n, 3, 3), in metres."""
    import trimesh

    if ending == "obj":  # materials need Pillow
        lines = data.splitlines()
        data = b"\n".join(it for it in lines if not it.startswith((b"mtllib", b"usemtl", b"vt")))
    scene = trimesh.load_scene(io.BytesIO(data), file_type=ending, process=False)
    corners = np.asarray(scene.to_mesh().triangles)
    unit = parse_xml(data).find("{*}asset/{*}unit") if ending == "dae" else None
    return corners * float(unit.get("meter", "1")) if unit is not None else corners


def area(corners: np.ndarray) -> float:
    """Return the area of triangles."""
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return float(np.linalg.norm(normals, axis=1).sum() / 2.0)


def compare(data: bytes, name: str) -> None:
    """Assert that both read as many triangles with the same area in the same box."""
    own = read_triangles(data, name)
    assert isinstance(own, Triangles), own
    corners = own.corners.astype(float)
    other = trimesh_triangles(data, name.rpartition(".")[2].lower())
    assert len(other) == own.count
    low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    size = float((high - low).max())
    assert other.min(axis=(0, 1)) == pytest.approx(low, abs=1e-5 * size)
    assert other.max(axis=(0, 1)) == pytest.approx(high, abs=1e-5 * size)
    assert area(other) == pytest.approx(area(corners), rel=1e-4)


@pytest.mark.parametrize("folder", _FOLDERS)
def test_meshes_of_real_robots(folder: str) -> None:
    """Every file that is not too large."""
    for path in FILES:
        is_read = path.stat().st_size < 9 * 2**20 and path.name not in _UNREAD_BY_TRIMESH
        if path.relative_to(FOLDER or Path()).parts[0] == folder and is_read:
            compare(path.read_bytes(), path.name)


@pytest.mark.skipif(not FILES, reason=MISSING)
def test_there_are_enough_meshes() -> None:
    """Hundreds in each format but one, of which there are dozens."""
    counts = {ending: sum(it.suffix.lower() == ending for it in FILES) for ending in _ENDINGS}
    assert counts[".stl"] > 200 and counts[".dae"] > 200 and counts[".obj"] > 50


@pytest.mark.parametrize("ending", ["stl", "stl_ascii", "obj", "dae"])
@pytest.mark.parametrize("shape", ["box", "cylinder", "icosphere", "annulus"])
def test_meshes_that_trimesh_writes(shape: str, ending: str) -> None:
    """Its triangles are read again, as it wrote them."""
    import trimesh

    sizes: dict[str, dict[str, Any]] = {
        "box": {"extents": (0.3, 0.2, 0.1)},
        "cylinder": {"radius": 0.1, "height": 0.05},
        "icosphere": {"radius": 0.2},
        "annulus": {"r_min": 0.1, "r_max": 0.2, "height": 0.05},
    }
    made = getattr(trimesh.creation, shape)(**sizes[shape])
    exported = made.export(file_type=ending)
    data = exported.encode() if isinstance(exported, str) else exported
    found = read_triangles(data, f"a.{ending[:3]}")
    assert isinstance(found, Triangles), found
    assert found.corners == pytest.approx(np.asarray(made.triangles), abs=1e-6)
