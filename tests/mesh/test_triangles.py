"""Every format gives the triangles that were written, or one reason; fewer triangles keep the shape."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.ros.mesh.triangles import Triangles, read_triangles
from tests.examples import examples
from tests.mesh.mesh_files import (
    CUBE,
    CUBE_POINTS,
    INPUTS,
    WRITERS,
    Triangle,
    binary_stl,
    collada,
    collada_with,
    obj,
    text_stl,
)

_NUMBERS = st.floats(-1e6, 1e6, width=32)
_POINTS = st.tuples(_NUMBERS, _NUMBERS, _NUMBERS)
TRIANGLES = st.lists(st.tuples(_POINTS, _POINTS, _POINTS), min_size=1, max_size=12)
_SQUARE = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 1.0, 0.0), (0.0, 1.0, 0.0)]
_HALVES = [[_SQUARE[0], _SQUARE[1], _SQUARE[2]], [_SQUARE[0], _SQUARE[2], _SQUARE[3]]]


def read(data: bytes, name: str = "a.dae") -> Triangles:
    """Return the triangles of a file that can be read."""
    found = read_triangles(data, name)
    assert isinstance(found, Triangles), found
    return found


@pytest.mark.parametrize("name", WRITERS)
@given(triangles=TRIANGLES)
@examples(10)
def test_the_triangles_are_those_that_were_written(name: str, triangles: list[Triangle]) -> None:
    """In their order, as 32-bit floats, with the box around them."""
    found = read(WRITERS[name](triangles), name)
    assert (found.corners.dtype, found.count) == (np.float32, len(triangles))
    assert found.corners.tolist() == np.array(triangles).tolist()
    points = np.array(triangles).reshape(-1, 3)
    assert found.bounds == (tuple(points.min(axis=0)), tuple(points.max(axis=0)))


@pytest.mark.parametrize(
    ("data", "name"),
    [
        (binary_stl(CUBE, head=b"solid of a binary file"), "a.stl"),
        (text_stl(CUBE).replace(b"vertex", b"VERTEX").replace(b"\n", b"\r\n"), "a.stl"),
        (b"\n " + text_stl(CUBE), "a.stl"),
        (obj(CUBE).replace(b"f 1 2", b"f 1 \\\n2") + b"\nl 1 2\np 1\nvn 0 0 1", "A.OBJ"),
    ],
)
def test_other_spellings_of_a_file(data: bytes, name: str) -> None:
    """A binary STL may begin with `solid`, a text may have other line breaks and capitals."""
    assert read(data, name).corners.tolist() == np.array(CUBE).tolist()


@pytest.mark.parametrize(
    "surface",
    [
        f"<polylist>{INPUTS}<vcount>4 2 1 0</vcount><p>0 0 1 0 2 0 3 0 0 0 1 0 2 0</p></polylist>",
        f"<polygons>{INPUTS}<p>0 0 1 0 2 0 3 0</p></polygons>",
        f"<trifans>{INPUTS}<p>0 0 1 0 2 0 3 0</p></trifans>",
        f"<triangles>{INPUTS}<p>0 0 1 0 2 0 0 0 2 0 3 0</p></triangles><lines>{INPUTS}<p>0 0 1 0</p></lines>",
        f"<triangles>{INPUTS}<p>0 0 1 0 2 0</p></triangles><triangles>{INPUTS}<p>0 0 2 0 3 0</p></triangles>",
    ],
)
def test_primitives_of_collada(surface: str) -> None:
    """Polygons become fans of triangles; lines are no triangles."""
    assert read(collada_with(surface, _SQUARE)).corners.tolist() == np.array(_HALVES).tolist()


def test_polygons_of_obj() -> None:
    """They become fans of triangles."""
    data = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0 1\nf 1 2 3 4\nf 1 2\n"
    assert read(data, "a.obj").corners.tolist() == np.array(_HALVES).tolist()


def test_strips_of_collada() -> None:
    """Three corners in a row are a triangle."""
    surface = f"<tristrips>{INPUTS}<p>0 0 1 0 2 0 3 0</p><p>1 0 2 0</p></tristrips>"
    expected = [_SQUARE[:3], _SQUARE[1:]]
    assert read(collada_with(surface, _SQUARE)).corners.tolist() == np.array(expected).tolist()


@pytest.mark.parametrize("axis", ["X_UP", "Y_UP", "Z_UP"])
def test_unit_counts_and_up_axis_does_not(axis: str) -> None:
    """RViz ignores the axis, and scales by the unit."""
    asset = f"<unit name='millimeter' meter='0.001'/><up_axis>{axis}</up_axis>"
    assert read(collada(CUBE, asset=asset)).bounds[1] == pytest.approx((0.001, 0.002, 0.003))


@pytest.mark.parametrize(
    ("node", "low", "high"),
    [
        ("<translate>1 2 3</translate><instance_geometry url='#g'/>", (1, 2, 3), (2, 4, 6)),
        ("<scale>1 -1 2</scale><instance_geometry url='#g'/>", (0, -2, 0), (1, 0, 6)),
        ("<rotate>0 0 2 90</rotate><instance_geometry url='#g'/>", (-2, 0, 0), (0, 1, 3)),
        (
            "<translate>10 0 0</translate><rotate>0 0 1 90</rotate><instance_geometry url='#g'/>",
            (8, 0, 0),
            (10, 1, 3),
        ),
        (
            (
                "<matrix>0 -1 0 5 1 0 0 0 0 0 1 0 0 0 0 1</matrix><node><translate>1 0 0</translate>"
                "<instance_geometry url='#g'/></node>"
            ),
            (3, 1, 0),
            (5, 2, 3),
        ),
        (
            "<instance_geometry url='#g'/><node><translate>1 0 0</translate><instance_node url='#m'/></node>",
            (0, 0, 0),
            (2, 2, 4),
        ),
        ("<instance_controller url='#c'/>", (0, 0, 0), (1, 2, 3)),
    ],
)
def test_nodes_place_geometries(node: str, low: Triangle, high: Triangle) -> None:
    """By their transformations in order, inside each other, and by way of other nodes and skins."""
    nodes = (
        "<node id='m'><translate>0 0 1</translate><instance_geometry url='#g'/></node>"
        "<controller id='c'><skin source='#g'/></controller>"
    )
    bounds = read(collada(CUBE, node=node, nodes=nodes)).bounds
    assert np.array(bounds) == pytest.approx(np.array([low, high]), abs=1e-6)


_SOLID = b"solid a\nfacet\nouter loop\n"
_WITHIN = "<instance_geometry url='#g'/>"
_TENFOLD = "".join(
    f"<!ENTITY {name} '{f'&{below};' * 10}'>"
    for below, name in zip("abcdefgh", "bcdefghi", strict=True)
)
_BOMB = f"<!DOCTYPE COLLADA [<!ENTITY a '9'>{_TENFOLD}]>"
_DEEP = "<node>" * 300 + "</node>" * 300
_DOUBLED = "".join(
    f"<node id='m{number}'><instance_node url='#m{number + 1}'/><instance_node url='#m{number + 1}'/></node>"
    for number in range(40)
)
FAULTS: dict[str, tuple[bytes, str, str]] = {
    "other format": (b"ply", "a.ply", "is not read: only STL, OBJ and COLLADA files are"),
    "no ending": (b"", "stl", "is not read: only STL, OBJ and COLLADA files are"),
    "large stl": (
        bytes(20 * 2**20 + 1),
        "a.stl",
        "is larger than 20 MiB, the limit for .stl files",
    ),
    "large obj": (bytes(9 * 2**20 + 1), "a.obj", "is larger than 9 MiB, the limit for .obj files"),
    "short stl": (b"a", "a.stl", "is broken: it is shorter than the head of a binary STL file"),
    "huge count": (
        binary_stl(CUBE, count=2**32 - 1),
        "a.stl",
        "is broken: its size is not that of the 4,294,967,295 triangles it announces",
    ),
    "cut": (
        binary_stl(CUBE)[:-1],
        "a.stl",
        "is broken: its size is not that of the 12 triangles it announces",
    ),
    "no triangles": (binary_stl([]), "a.stl", "has no triangles"),
    "many triangles": (
        binary_stl([])[:80] + (400_001).to_bytes(4, "little") + bytes(50 * 400_001),
        "a.stl",
        "has more than 400,000 triangles, the limit",
    ),
    "nan": (
        binary_stl([((0.0, 0.0, float("nan")), CUBE_POINTS[0], CUBE_POINTS[1])]),
        "a.stl",
        "is broken: a coordinate is not a finite number",
    ),
    "empty text": (b"solid a\nendsolid a\n", "a.stl", "has no triangles"),
    "no number": (
        _SOLID + b"vertex 0 0 o\n",
        "a.stl",
        "is broken: line 4 has a coordinate that is not a number",
    ),
    "few numbers": (
        _SOLID + b"vertex 0 0\n",
        "a.stl",
        "is broken: line 4 has fewer than three coordinates",
    ),
    "few corners": (
        _SOLID + b"vertex 0 0 0\nendloop\n",
        "a.stl",
        "is broken: line 5 ends a facet that does not have three corners",
    ),
    "cut text": (
        _SOLID + b"vertex 0 0 0\n",
        "a.stl",
        "is broken: its last facet does not have three corners",
    ),
    "infinite": (
        b"v 0 0 0\nv 1 0 0\nv 0 1e39 0\nf 1 2 3",
        "a.obj",
        "is broken: a coordinate is not a finite number",
    ),
    "no faces": (b"v 0 0 0\n", "a.obj", "has no triangles"),
    "corner out of range": (
        b"v 0 0 0\nf 1 1 2",
        "a.obj",
        "is broken: a triangle has a corner that is not among the points",
    ),
    "corner before the first": (
        b"v 0 0 0\nf 1 1 -2",
        "a.obj",
        "is broken: a triangle has a corner that is not among the points",
    ),
    "corner zero": (
        b"v 0 0 0\nf 0 1 1",
        "a.obj",
        "is broken: line 2 has a corner that is not among the points",
    ),
    "huge corner": (
        b"v 0 0 0\nf 1 1 " + b"9" * 40,
        "a.obj",
        "is broken: line 2 has a corner that is not among the points",
    ),
    "no corner": (b"f a b c", "a.obj", "is broken: line 1 has a corner that is not a number"),
    "large face": (
        b"v 0 0 0\nf " + b"1 " * 400_003,
        "a.obj",
        "has more than 400,000 triangles, the limit",
    ),
    "not xml": (b"<COLLADA>\n<a></b>", "a.dae", "is broken: line 2 is not XML"),
    "empty dae": (b"", "a.dae", "is broken: line 1 is not XML"),
    "other root": (b"<a/>", "a.dae", "is broken: its root is not <COLLADA>"),
    "no scene": (b"<COLLADA/>", "a.dae", "is broken: it has no scene"),
    "node of itself": (
        collada(CUBE, node="<instance_node url='#n'/>"),
        "a.dae",
        "has more than 10,000 nodes, the limit",
    ),
    "doubled nodes": (
        collada(CUBE, node="<instance_node url='#m0'/>", nodes=_DOUBLED + "<node id='m40'/>"),
        "a.dae",
        "has more than 10,000 nodes, the limit",
    ),
    "doubled geometries": (
        collada(CUBE * 500, node="<instance_geometry url='#g'/>" * 100),
        "a.dae",
        "has more than 400,000 triangles, the limit",
    ),
    "no such element": (
        collada(CUBE, node="<instance_geometry url='#'/>"),
        "a.dae",
        "is broken: it names an element that is not in it",
    ),
    "another file": (
        collada(CUBE, node="<instance_geometry url='other.dae#g'/>"),
        "a.dae",
        "is broken: it names an element that is not in it",
    ),
    "lookat": (
        collada(CUBE, node="<lookat>0 0 0 1 0 0 0 0 1</lookat>" + _WITHIN),
        "a.dae",
        "is placed by a <lookat>, which is not read",
    ),
    "short matrix": (
        collada(CUBE, node="<matrix>1 0 0</matrix>" + _WITHIN),
        "a.dae",
        "is broken: a <matrix> does not have 16 numbers",
    ),
    "overflow": (
        collada(
            CUBE,
            node="<scale>1e300 1e300 1e300</scale><node><scale>1e300 0 0</scale>"
            + _WITHIN
            + "</node>",
        ),
        "a.dae",
        "is broken: a coordinate is not a finite number",
    ),
    "unit": (
        collada(CUBE, asset="<unit meter='nan'/>"),
        "a.dae",
        "is broken: its unit is not a length",
    ),
    "index out of range": (
        collada_with(f"<triangles>{INPUTS}<p>0 0 1 0 4 0</p></triangles>", _SQUARE),
        "a.dae",
        "is broken: a triangle has a corner that is not among the points",
    ),
    "negative index": (
        collada_with(f"<triangles>{INPUTS}<p>0 0 1 0 -1 0</p></triangles>", _SQUARE),
        "a.dae",
        "is broken: a triangle has a corner that is not among the points",
    ),
    "huge index": (
        collada_with(f"<triangles>{INPUTS}<p>0 0 1 0 {'9' * 30} 0</p></triangles>", _SQUARE),
        "a.dae",
        "is broken: it has a number that cannot be read",
    ),
    "half a triangle": (
        collada_with(f"<triangles>{INPUTS}<p>0 0 1 0</p></triangles>", _SQUARE),
        "a.dae",
        "is broken: the corners of its triangles are not complete",
    ),
    "half a corner": (
        collada_with(f"<triangles>{INPUTS}<p>0 0 1 0 2</p></triangles>", _SQUARE),
        "a.dae",
        "is broken: the corners of its triangles are not complete",
    ),
    "huge polygon": (
        collada_with(
            f"<polylist>{INPUTS}<vcount>{2**62} {2**62}</vcount><p>0 0</p></polylist>", _SQUARE
        ),
        "a.dae",
        "is broken: the corners of its polygons are not complete",
    ),
    "huge offset": (
        collada_with(
            "<triangles><input semantic='VERTEX' source='#v' offset='9999999999'/></triangles>", []
        ),
        "a.dae",
        "is broken: an attribute is not a whole number",
    ),
    "no positions": (
        collada_with(
            "<triangles><input semantic='VERTEX' source='#s' offset='0'/><p>0 0 0</p></triangles>",
            [],
        ),
        "a.dae",
        "is broken: its vertices have no positions",
    ),
    "flat positions": (
        collada_with(
            f"<triangles>{INPUTS}<p>0 0 0 0 0 0</p></triangles>",
            _SQUARE,
            accessor="<technique_common><accessor stride='2'/></technique_common>",
        ),
        "a.dae",
        "is broken: its positions do not have three coordinates",
    ),
    "word": (
        collada_with(f"<triangles>{INPUTS}<p>0 0 1 0 x 0</p></triangles>", _SQUARE),
        "a.dae",
        "is broken: it has a number that cannot be read",
    ),
    "outside entity": (
        collada(
            CUBE,
            start="<!DOCTYPE COLLADA [<!ENTITY a SYSTEM 'file:///etc/passwd'>]>",
            node="<translate>&a;</translate>" + _WITHIN,
        ),
        "a.dae",
        "is broken: a <translate> does not have 3 numbers",
    ),
}


@pytest.mark.parametrize("name", FAULTS)
def test_a_hostile_or_broken_file_has_a_reason(name: str) -> None:
    """Nothing is allocated for what a file only announces; nodes and entities are not followed beyond limits."""
    data, path, reason = FAULTS[name]
    assert read_triangles(data, path) == reason


@pytest.mark.parametrize(
    "data",
    [
        collada(CUBE, node=_DEEP),
        collada(CUBE, start=_BOMB, node="<translate>&i;</translate>" + _WITHIN),
        collada(CUBE, start=_BOMB, asset="<unit meter='&i;'/>"),
    ],
    ids=["depth", "entities", "entities in an attribute"],
)
def test_xml_beyond_the_limits_of_the_parser(data: bytes) -> None:
    """Elements inside each other, and entities that multiply, are refused."""
    reason = read_triangles(data, "a.dae")
    assert isinstance(reason, str)
    assert reason.endswith(" is not XML")


@pytest.mark.slow
@given(TRIANGLES, st.integers(1, 12))
@examples(40)
def test_reduced_triangles_are_few_and_inside(triangles: list[Triangle], most: int) -> None:
    """At most as many as asked for, none outside of the box, and all if they are few enough."""
    whole = read(binary_stl(triangles), "a.stl")
    reduced = whole.reduced(most)
    assert reduced.count <= most
    assert reduced.corners.dtype == np.float32
    if len(triangles) <= most:
        assert reduced is whole
    elif reduced.count:
        (low, high), (least, largest) = whole.bounds, reduced.bounds
        room = 1e-6 * max(map(abs, (*low, *high)), default=0.0)
        assert all(a - room <= b for a, b in zip(low, least, strict=True))
        assert all(b <= a + room for a, b in zip(high, largest, strict=True))


@pytest.mark.parametrize("most", [100, 500, 2000])
def test_a_reduced_sphere_is_a_sphere(most: int) -> None:
    """Of 20,000 triangles a good part of the allowed ones is left, near the surface."""
    turn, rise = np.meshgrid(np.linspace(0, 2 * np.pi, 201), np.linspace(0, np.pi, 51))
    ball = np.stack([np.cos(turn) * np.sin(rise), np.sin(turn) * np.sin(rise), np.cos(rise)], -1)
    corners = (
        [ball[:-1, :-1], ball[:-1, 1:], ball[1:, 1:]],
        [ball[:-1, :-1], ball[1:, 1:], ball[1:, :-1]],
    )
    halves = [np.stack(three, axis=2).reshape(-1, 3, 3) for three in corners]
    whole = Triangles(np.concatenate(halves).astype(np.float32))
    assert whole.count == 20_000
    reduced = whole.reduced(most)
    assert most / 4 <= reduced.count <= most
    distances = np.linalg.norm(reduced.corners.reshape(-1, 3), axis=1)
    assert abs(distances - 1.0).max() <= 4.0 / most**0.5
