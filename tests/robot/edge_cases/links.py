"""Links: geometry, visuals, collisions and inertia. No error in a link stops a robot from loading."""

from tests.robot.edge_cases.case import (
    EdgeCase,
    clean,
    degraded,
    geometry,
    links,
    one_joint,
    one_link,
    rejected,
    robot,
    visual,
)

_SHAPE = "a shape needs its attributes"
_KIND = "the first element of a geometry is its shape"
_UNCHECKED = "sizes, masses and inertia are not checked"
_FIRST = "of repeated elements the first counts"
_IGNORED = "unknown tags and attributes are ignored"
_CASE = "names are case-sensitive"
_ORIGIN = "a bad origin loses its visual or collision"
_GEOMETRY = "a visual or collision needs a geometry"
_LOST = "a bad visual loses those after it and the collisions"
_INERTIAL = "a bad inertial loses the visuals and collisions"
_TWICE = "a link name must not be used twice"
_NAME = "a link without name is called nothing"

_BOX = '<geometry><box size="1 1 1"/></geometry>'
_BAD = "<geometry><box/></geometry>"

_SHAPES = {
    "box": '<box size="1 2 3"/>',
    "box-negative": '<box size="-1 1 1"/>',
    "sphere": '<sphere radius="1"/>',
    "sphere-negative": '<sphere radius="-1"/>',
    "cylinder": '<cylinder radius="1" length="2"/>',
    "mesh": '<mesh filename="package://a/b.stl"/>',
    "mesh-scaled": '<mesh filename="a.dae" scale="0.001 0.001 0.001"/>',
    "mesh-scale-of-zero": '<mesh filename="a.dae" scale="0 0 0"/>',
    "mesh-empty-filename": '<mesh filename=""/>',
    "mesh-missing-file": '<mesh filename="file:///no/such/file.stl"/>',
    "mesh-xacro-filename": '<mesh filename="$(find a)/b.stl"/>',
}
_NO_SHAPES = {
    "box-without-size": "<box/>",
    "box-empty-size": '<box size=""/>',
    "box-two-numbers": '<box size="1 1"/>',
    "box-size-in-capitals": '<box Size="1 1 1"/>',
    "box-dimensions": '<box width="1" height="1" depth="1"/>',
    "box-size-in-element": "<box><size>1 1 1</size></box>",
    "sphere-without-radius": "<sphere/>",
    "sphere-word": '<sphere radius="big"/>',
    "cylinder-without-attributes": "<cylinder/>",
    "cylinder-without-length": '<cylinder radius="1"/>',
    "cylinder-without-radius": '<cylinder length="1"/>',
    "cylinder-bad-length": '<cylinder radius="1" length="2m"/>',
    "cylinder-bad-radius": '<cylinder radius="1 " length="2"/>',
    "mesh-without-filename": "<mesh/>",
    "mesh-filename-in-capitals": '<mesh Filename="a.stl"/>',
    "mesh-scale-one-number": '<mesh filename="a" scale="0.001"/>',
    "mesh-scale-empty": '<mesh filename="a" scale=""/>',
    "capsule": '<capsule radius="1" length="2"/>',
    "box-in-capitals": '<Box size="1 1 1"/>',
    "box-with-prefix": '<urdf:box size="1 1 1"/>',
    "nothing": "",
    "comment": "<!-- <box/> -->",
}


def _colliding(shape: str) -> str:
    return one_link(f"<collision><geometry>{shape}</geometry></collision>")


SHAPES: tuple[EdgeCase, ...] = (
    *(clean(f"visual-{name}", _UNCHECKED, geometry(shape)) for name, shape in _SHAPES.items()),
    *(degraded(f"visual-{name}", _SHAPE, geometry(shape)) for name, shape in _NO_SHAPES.items()),
    *(clean(f"collision-{name}", _UNCHECKED, _colliding(shape)) for name, shape in _SHAPES.items()),
    *(degraded(f"collision-{name}", _SHAPE, _colliding(shape)) for name, shape in _NO_SHAPES.items()),
    clean("two-shapes", _KIND, geometry('<box size="1 1 1"/><sphere radius="1"/>')),
    degraded("two-shapes-first-bad", _KIND, geometry('<sphere/><box size="1 1 1"/>')),
    degraded("two-shapes-first-unknown", _KIND, geometry('<origin/><box size="1 1 1"/>')),
    clean("text-before-shape", _KIND, geometry('text<box size="1 1 1"/>')),
    clean("comment-before-shape", _KIND, geometry('<!-- <sphere/> --><box size="1 1 1"/>')),
    clean("shape-with-children", _IGNORED, geometry('<box size="1 1 1"><sphere/></box>')),
    clean("shape-with-more-attributes", _IGNORED, geometry('<box size="1 1 1" radius="x" length=""/>')),
    clean("two-geometries", _FIRST, one_link(f"<visual>{_BOX}{_BAD}</visual>")),
    degraded("two-geometries-first-bad", _FIRST, one_link(f"<visual>{_BAD}{_BOX}</visual>")),
    degraded("two-geometries-first-empty", _FIRST, one_link(f"<visual><geometry/>{_BOX}</visual>")),
)

VISUALS = (
    degraded("visual-empty", _GEOMETRY, one_link("<visual/>")),
    degraded("visual-only-origin", _GEOMETRY, one_link("<visual><origin/></visual>")),
    degraded("visual-shape-without-geometry", _GEOMETRY, one_link('<visual><box size="1 1 1"/></visual>')),
    degraded("visual-geometry-in-capitals", _CASE, one_link(visual("").replace("geometry", "Geometry"))),
    degraded("visual-geometry-empty", _GEOMETRY, one_link("<visual><geometry/></visual>")),
    clean("visual-in-capitals", _CASE, one_link("<Visual/><VISUAL/>")),
    clean("visual-outside-link", _IGNORED, robot(f"{links('a')}<visual/><collision/><inertial/>")),
    clean("visuals-of-one-name", _IGNORED, one_link(f'<visual name="v">{_BOX}</visual>' * 2)),
    clean("visual-origin-empty", _ORIGIN, one_link(visual("<origin/>"))),
    degraded("visual-origin-bad-xyz", _ORIGIN, one_link(visual('<origin xyz="0 0"/>'))),
    degraded("visual-origin-bad-rpy", _ORIGIN, one_link(visual('<origin rpy="0, 0, 0"/>'))),
    clean("visual-origin-other-attributes", _IGNORED, one_link(visual('<origin XYZ="x" yaw="1" quat_xyzw="0 0 0"/>'))),
    clean("visual-origin-twice-second-bad", _FIRST, one_link(visual('<origin/><origin xyz="x"/>'))),
    degraded("visual-origin-twice-first-bad", _FIRST, one_link(visual('<origin xyz="x"/><origin/>'))),
    clean("visual-origin-in-geometry", _KIND, geometry('<box size="1 1 1"/><origin xyz="x"/>')),
    clean("collision-material-ignored", _IGNORED, one_link(f"<collision>{_BOX}<material/></collision>")),
    clean("visuals-several", _LOST, one_link(visual("") * 3 + f"<collision>{_BOX}</collision>" * 3)),
    degraded("visuals-first-bad", _LOST, one_link("<visual/>" + visual("") * 2)),
    degraded("visuals-middle-bad", _LOST, one_link(visual("") + "<visual/>" + visual(""))),
    degraded("visuals-all-bad", _LOST, one_link("<visual/>" * 3)),
    degraded("collisions-first-bad", _LOST, one_link(f"<collision/><collision>{_BOX}</collision>")),
    degraded("collisions-last-bad", _LOST, one_link(f"<collision>{_BOX}</collision><collision/>")),
    degraded("visual-bad-after-collision", _LOST, one_link(f"<collision>{_BOX}</collision><visual/>")),
    degraded("visual-bad-in-child-link", _LOST, one_joint().replace('b"/>', 'b"><visual/></link>', 1)),
    degraded(
        "visual-bad-and-inertial-without-inertia", _LOST, one_link('<inertial><mass value="1"/></inertial><visual/>')
    ),
)

_TENSOR = 'ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"'
_INERTIA = f"<inertia {_TENSOR}/>"
_MASS = '<mass value="1"/>'


def _inertial(body: str) -> str:
    return one_link(f"<inertial>{body}</inertial>")


INERTIALS: tuple[EdgeCase, ...] = (
    clean("inertial", _INERTIAL, _inertial(f"<origin/>{_MASS}{_INERTIA}")),
    clean("inertial-mass-of-zero", _UNCHECKED, _inertial(f'<mass value="0"/>{_INERTIA}')),
    clean("inertial-mass-negative", _UNCHECKED, _inertial(f'<mass value="-1"/>{_INERTIA}')),
    clean("inertial-not-definite", _UNCHECKED, _inertial(_MASS + _INERTIA.replace("1", "-1"))),
    clean("inertial-triangle-inequality", _UNCHECKED, _inertial(_MASS + _INERTIA.replace('ixx="1"', 'ixx="9"'))),
    clean("inertial-of-zeros", _UNCHECKED, _inertial(_MASS + _INERTIA.replace("1", "0"))),
    clean("inertial-more-attributes", _IGNORED, _inertial(f"{_MASS}<inertia {_TENSOR} iyx='x'/>")),
    degraded("inertial-empty", _INERTIAL, _inertial("")),
    degraded("inertial-without-mass", _INERTIAL, _inertial(_INERTIA)),
    degraded("inertial-mass-without-value", _INERTIAL, _inertial(f"<mass/>{_INERTIA}")),
    degraded("inertial-mass-empty", _INERTIAL, _inertial(f'<mass value=""/>{_INERTIA}')),
    degraded("inertial-mass-word", _INERTIAL, _inertial(f'<mass value="heavy"/>{_INERTIA}')),
    degraded("inertial-mass-in-capitals", _CASE, _inertial(f'<Mass value="1"/>{_INERTIA}')),
    degraded("inertial-mass-twice-first-bad", _FIRST, _inertial(f"<mass/>{_MASS}{_INERTIA}")),
    clean("inertial-mass-twice-second-bad", _FIRST, _inertial(f"{_MASS}<mass/>{_INERTIA}")),
    *(
        degraded(f"inertial-without-{name}", _INERTIAL, _inertial(_MASS + _INERTIA.replace(name, f"{name}-")))
        for name in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
    ),
    *(
        degraded(f"inertial-bad-{name}", _INERTIAL, _inertial(_MASS + _INERTIA.replace(f'{name}="', f'{name}="x')))
        for name in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
    ),
    degraded("inertial-tensor-in-capitals", _CASE, _inertial(_MASS + _INERTIA.replace("ixx", "Ixx"))),
    degraded("inertial-bad-origin", _INERTIAL, _inertial(f'<origin xyz="0 0"/>{_MASS}{_INERTIA}')),
    degraded("inertial-bad-origin-rpy", _INERTIAL, _inertial(f'<origin rpy="0\t0\t0"/>{_MASS}{_INERTIA}')),
    degraded("inertial-twice-first-bad", _FIRST, one_link(f"<inertial/><inertial>{_MASS}{_INERTIA}</inertial>")),
    degraded("inertial-bad-with-visual", _INERTIAL, one_link(f"<inertial/>{visual('')}<collision>{_BOX}</collision>")),
    degraded("inertial-bad-after-visual", _INERTIAL, one_link(f"{visual('')}<inertial/>")),
    degraded("inertial-bad-and-visual-bad", _INERTIAL, one_link("<inertial/><visual/>")),
)

NAMES = (
    clean("link-empty-name", "a link may have an empty name", robot(links(""))),
    clean("link-blank-name", "any link name is fine", robot(links(" "))),
    clean("link-unknown-children", _IGNORED, one_link("<gazebo/><sensor/><contact><lateral_friction/></contact>")),
    clean("link-unknown-attributes", _IGNORED, robot('<link name="a" type="x" self_collide="1"/>')),
    degraded("link-without-name", _NAME, robot("<link/>")),
    degraded("link-without-name-with-visual", _NAME, robot(f"<link>{visual('')}</link>")),
    degraded("link-name-in-capitals", _CASE, robot('<link Name="a"/>')),
    rejected("link-without-name-beside-another", "two roots", robot(f"{links('a')}<link/>")),
    rejected("links-without-name", _TWICE, robot("<link/><link/>")),
    rejected("link-without-name-and-link-of-empty-name", _TWICE, robot(f"<link/>{links('')}")),
    rejected("links-of-one-name-apart", _TWICE, robot(links("a", "b", "a"))),
    rejected("links-of-one-name-one-bad", _TWICE, robot(f'{links("a")}<link name="a"><visual/></link>')),
)

CASES = SHAPES + VISUALS + INERTIALS + NAMES
