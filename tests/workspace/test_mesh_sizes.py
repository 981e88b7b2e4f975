"""Meshes in millimetres: what is reported, and what may be right."""

import pytest

from grader.files.reading import URDF_LIMIT
from grader.files.tree import make_tree, overlaid
from grader.workspace.opening.all_robots import read_workspace
from tests.mesh.mesh_files import CUBE, binary_stl, obj, text_stl

pytestmark = pytest.mark.slow

_MANIFEST = "<package format='3'><name>arm</name><version>1.0.0</version></package>"
_BOX = '<collision><geometry><box size="0.3 0.2 0.1"/></geometry></collision>'
_HEAD = '<link name="head"/><joint name="neck" type="fixed"><origin xyz="0 0 0.2"/><parent link="base"/><child link="head"/></joint>'


def _shape(scale: float | None, file: str = "a.stl") -> str:
    attribute = f' scale="{scale} {scale} {scale}"' if scale is not None else ""
    mesh = f'<mesh filename="package://arm/meshes/{file}"{attribute}/>'
    return f"<visual><geometry>{mesh}</geometry></visual>"


def _found(link: str, data: bytes, file: str = "a.stl") -> list[str]:
    """Return what is reported of a robot, whose meshes are 3 units long."""
    robot = f'<robot name="arm"><link name="base">{link}</link>{_HEAD}</robot>'
    texts = {
        "arm/package.xml": _MANIFEST.encode(),
        "arm/arm.urdf": robot.encode(),
        f"arm/meshes/{file}": data,
    }
    opened = read_workspace(overlaid(make_tree("ws", (), ()), texts), "ws", URDF_LIMIT, {})
    return [f"{it.code} {it.message}" for it in opened.mesh_size_problems()]


def _scaled(factor: float) -> list[tuple[tuple[float, float, float], ...]]:
    return [
        tuple((x * factor, y * factor, z * factor) for x, y, z in triangle) for triangle in CUBE
    ]


@pytest.mark.parametrize(
    ("file", "data"),
    [
        ("a.stl", binary_stl(_scaled(100.0))),  # type: ignore[arg-type]
        ("a.STL", text_stl(_scaled(100.0))),  # type: ignore[arg-type]
        ("a.obj", obj(_scaled(100.0))),  # type: ignore[arg-type]
    ],
)
def test_a_mesh_in_millimetres(file: str, data: bytes) -> None:
    """A mesh 300 units long needs the scale 0.001 beside a collision of 0.3 m."""
    [problem] = _found(_shape(None, file) + _BOX, data, file)
    assert problem == (
        f"REF018 the mesh 'package://arm/meshes/{file}' of 'base' is 300 m long, but its collision "
        "is 0.3 m: is it in millimetres or in metres? See its scale"
    )
    assert _found(_shape(0.001, file) + _BOX, data, file) == []


def test_a_mesh_that_is_scaled_twice() -> None:
    """A mesh in metres with the scale of millimetres is too small to be seen."""
    data = binary_stl(_scaled(0.1))  # type: ignore[arg-type]
    [problem] = _found(_shape(0.001) + _BOX, data)
    assert "is 0.0003 m long, but its collision is 0.3 m" in problem
    assert _found(_shape(None) + _BOX, data) == []


def test_two_scales_of_one_mesh() -> None:
    """A mesh is compared with another one of its link that has a plausible size."""
    data = binary_stl(_scaled(100.0))  # type: ignore[arg-type]
    [problem] = _found(_shape(None) + _shape(0.001), data)
    assert "is 300 m long, but its other mesh is 0.3 m" in problem


def test_a_mesh_beside_which_there_is_nothing() -> None:
    """A link of more than 100 m is too large for joints of 0.2 m."""
    [problem] = _found(_shape(None), binary_stl(_scaled(100.0)))  # type: ignore[arg-type]
    assert "but the longest <origin> of a joint is 0.2 m" in problem


@pytest.mark.parametrize("factor", [0.001, 0.01, 0.1, 1.0, 10.0])
def test_sizes_that_may_be_right(factor: float) -> None:
    """Another ratio than about 1000 is no unit, and a small placeholder is no shape."""
    assert _found(_shape(None) + _BOX, binary_stl(_scaled(factor))) == []  # type: ignore[arg-type]
    tiny = _BOX.replace("0.3 0.2 0.1", "0.0003 0.0003 0.0003")
    assert _found(_shape(None) + tiny, binary_stl(_scaled(0.1))) == []  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "data", [b"", b"solid", b"version https://git-lfs.github.com/spec/v1\n", bytes(200)]
)
def test_files_that_are_no_meshes(data: bytes) -> None:
    """Of a file that cannot be read, nothing is known."""
    assert _found(_shape(None) + _BOX, data) == []
    assert _found(_shape(None, "a.dae") + _BOX, data, "a.dae") == []
