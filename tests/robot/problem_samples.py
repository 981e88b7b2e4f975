"""One small file for each kind of problem. A ¦ is before the tag or attribute that the problem is about."""

from dataclasses import dataclass
from itertools import pairwise

from tests.robot.edge_cases.case import joint, links, robot

_TWO = links("a", "b")


@dataclass(frozen=True, slots=True)
class Sample:
    """A file with a problem of this code where the ¦ is; `also` are the other codes that come with it."""

    code: str
    name: str
    marked: str
    also: str = ""

    @property
    def data(self) -> bytes:
        """The file without the mark."""
        return self.marked.replace("¦", "").encode("utf-8", "surrogateescape")

    @property
    def place(self) -> tuple[int, int]:
        """Line and column of the mark, counted from 1 in characters."""
        before = self.marked[: self.marked.index("¦")]
        return before.count("\n") + 1, len(before) - before.rfind("\n")


def lines(*rows: str) -> str:
    """A robot with these rows."""
    return "\n".join(('<robot name="r">', *rows, "</robot>", ""))


def in_link(*rows: str) -> str:
    """A robot with one link that contains these rows."""
    return lines('  <link name="a">', *(f"    {row}" for row in rows), "  </link>")


def in_joint(*rows: str, kind: str = "continuous") -> str:
    """A robot with one joint that contains these rows."""
    head = f'  {_TWO}\n  <joint name="j" type="{kind}">\n    <parent link="a"/><child link="b"/>'
    return lines(head, *(f"    {row}" for row in rows), "  </joint>")


def in_visual(*rows: str) -> str:
    """A robot with one visual that contains these rows and a shape."""
    return in_link("<visual>", *rows, '<geometry><sphere radius="1"/></geometry>', "</visual>")


def _paths() -> str:
    names = [f"l{index}" for index in range(26)]
    pairs = (joint(one, other, f"j{one}{side}") for one, other in pairwise(names) for side in "xy")
    return robot(links(*names).replace("<link", "¦<link", 1) + "".join(pairs))


_AXIS = '<axis xyz="0 0 1"/>'
_LIMIT = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'
_SHAPE = '<geometry><sphere radius="1"/></geometry>'
_COLOUR = '<color rgba="1 0 0 1"/>'

SAMPLES: tuple[Sample, ...] = (
    Sample("URDF001", "attribute-without-name", lines(_TWO, '  ¦<parent="a"/>')),
    Sample("URDF001", "comma-between-attributes", lines('  <link name="a"¦, b="c"/>')),
    Sample("URDF001", "attribute-without-value", lines("  <link ¦name/>")),
    Sample("URDF001", "attribute-without-quotes", lines("  <link ¦name=a/>")),
    Sample("URDF001", "typographic-quotes", lines("  <link ¦name=\u201ca\u201d/>")),
    Sample("URDF001", "attribute-twice", lines('  <link name="a" ¦name="b"/>')),
    Sample("URDF001", "tag-not-closed", lines('  ¦<link name="a"', '  <link name="b"/>')),
    Sample("URDF001", "quote-not-closed", lines('  ¦<link name="a/>', '  <link name="b"/>')),
    Sample("URDF001", "no-tag-name", lines("  ¦<1/>")),
    Sample("URDF002", "closed-by-another", lines('  <link name="a">', "  ¦</lnk>")),
    Sample("URDF002", "never-closed", '<robot name="r">\n  ¦<link name="a">\n'),
    Sample("URDF003", "empty", "¦"),
    Sample("URDF003", "blank", "¦\n\n"),
    Sample("URDF004", "comment", lines("  ¦<!-- a")),
    Sample("URDF004", "cdata", lines("  ¦<![CDATA[ a")),
    Sample("URDF004", "declaration", '¦<?xml version="1.0"\n<robot name="r"/>'),
    Sample("URDF005", "declaration-inside", lines("  ¦<?xml version='1.0'?>")),
    Sample("URDF005", "comment-before", "<!-- c -->\n¦<?xml version='1.0'?>\n" + lines(_TWO)),
    Sample("URDF006", "text-after-root", lines(_TWO) + "\n¦text"),
    Sample("URDF007", "499-levels", lines(*["<a>"] * 497, "¦<a>", *["</a>"] * 498)),
    Sample("URDF008", "utf-16", "¦\udcff\udcfe<\0r\0o\0b\0o\0t\0/\0>\0"),
    Sample("URDF009", "bare-ampersand", lines('  <link ¦name="a & b"/>')),
    Sample("URDF009", "control-character", lines('  <link name="a¦\x01"/>')),
    Sample("URDF009", "prefix", lines('  <link name="a"/>', "  ¦<x:y/>")),
    Sample("URDF009", "dashes-in-comment", lines('  <link name="a"/>', "  ¦<!-- a -- b -->")),
    Sample("URDF010", "doctype", "\n¦<!DOCTYPE robot>\n" + lines('<link name="a"/>')),
    Sample("URDF011", "nul", lines('<link name="a"/>') + "¦\0rest"),
    Sample("URDF011", "stray-closing-tag", lines('<link name="a"/>') + "¦</robot>\n<robot/>", also="URDF009"),
    Sample("URDF012", "second-root", lines('<link name="a"/>') + "¦<link name='b'/>"),
    Sample("URDF013", "other-root", "\n ¦<sdf/>"),
    Sample("URDF013", "other-root-of-the-dialect", "¦<sdf><![CDATA[]]></sdf>"),
    Sample("URDF014", "xacro-tag", lines('<link name="a"/>', "  ¦<xacro:macro name='m'/>"), also="URDF009"),
    Sample("URDF014", "expression", lines('<!-- ${a} -->  <link name="¦${b}"/>')),
    Sample("URDF020", "robot-without-name", '\n¦<robot version="1.0"><link name="a"/></robot>'),
    Sample("URDF021", "version", '<robot name="r"\n  ¦version="2.0"><link name="a"/></robot>'),
    Sample("URDF022", "no-links", '\n ¦<robot name="r"/>'),
    Sample("URDF030", "link-without-name", lines("  ¦<link/>")),
    Sample("URDF031", "link-twice", lines('  <link name="a"/>', '  <link ¦name="a"/>')),
    Sample(
        "URDF032",
        "joint-twice",
        lines(_TWO, joint("a", "b"), '<joint type="fixed"\n ¦name="j"><parent link="a"/><child link="b"/></joint>'),
    ),
    Sample(
        "URDF033",
        "material-twice",
        lines('<link name="a"/>', *(f'<material {mark}name="m">{_COLOUR}</material>' for mark in ("", "¦"))),
    ),
    Sample(
        "URDF034",
        "joint-without-name",
        lines(_TWO, ' ¦<joint type="fixed"><parent link="a"/><child link="b"/></joint>'),
    ),
    Sample(
        "URDF040",
        "inertial-without-mass",
        in_link("¦<inertial>", '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>', "</inertial>"),
    ),
    Sample(
        "URDF040",
        "mass-of-a-word",
        in_link(
            '<inertial><mass ¦value="heavy"/>',
            '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>',
            "</inertial>",
        ),
    ),
    Sample("URDF041", "visual-without-geometry", in_link("¦<visual/>")),
    Sample("URDF041", "empty-geometry", in_link("<visual>", "¦<geometry/>", "</visual>")),
    Sample("URDF041", "unknown-shape", in_link("<visual><geometry>", "¦<cone/>", "</geometry></visual>")),
    Sample("URDF041", "box-without-size", in_link("<visual><geometry>", "¦<box/>", "</geometry></visual>")),
    Sample("URDF041", "comma-in-size", in_link("<visual><geometry>", '<box ¦size="1, 1, 1"/>', "</geometry></visual>")),
    Sample(
        "URDF041",
        "cylinder-height",
        in_link("<visual><geometry>", '¦<cylinder radius="1" height="2"/>', "</geometry></visual>"),
        also="URDF091",
    ),
    Sample("URDF041", "visual-origin", in_visual('<origin ¦xyz="1 2"/>')),
    Sample("URDF041", "visual-rpy", in_visual('<origin xyz="1 2 3" ¦rpy="a b c"/>')),
    Sample("URDF041", "mesh-without-file", in_link("<visual><geometry>", "¦<mesh/>", "</geometry></visual>")),
    Sample(
        "URDF041",
        "mesh-scale",
        in_link("<visual><geometry>", '<mesh filename="m" ¦scale="1"/>', "</geometry></visual>"),
    ),
    Sample("URDF041", "nameless-material", in_visual(f"¦<material>{_COLOUR}</material>")),
    Sample("URDF042", "collision-without-geometry", in_link("¦<collision/>")),
    Sample(
        "URDF042", "collision-radius", in_link('<collision><geometry><sphere ¦radius="1m"/></geometry></collision>')
    ),
    Sample("URDF043", "printf", in_visual('<origin ¦xyz="%n 0 0"/>'), also="URDF041"),
    Sample("URDF050", "nameless-material", lines('<link name="a"/>', f" ¦<material>{_COLOUR}</material>")),
    Sample("URDF051", "nowhere", in_visual('<material ¦name="m"/>')),
    Sample(
        "URDF051",
        "later",
        lines(
            f'<link name="a"><visual>{_SHAPE}<material ¦name="m"/></visual></link>',
            f'<link name="b"><visual>{_SHAPE}<material name="m">{_COLOUR}</material></visual></link>',
            joint("a", "b"),
        ),
    ),
    Sample(
        "URDF052",
        "colour-of-255",
        lines('<link name="a"/>', '<material name="m"><color ¦rgba="255 0 0 255"/></material>'),
    ),
    Sample("URDF052", "colour-in-a-link", in_visual('<material name="m"><color ¦rgba="red"/></material>')),
    Sample(
        "URDF053", "three-channels", lines('<link name="a"/>', '<material name="m"><color ¦rgba="1 0 0"/></material>')
    ),
    Sample("URDF054", "no-colour", lines('<link name="a"/>', ' ¦<material name="m"/>')),
    Sample(
        "URDF055",
        "otherwise",
        lines(
            f'<material name="m">{_COLOUR}</material>',
            f'<link name="a"><visual>{_SHAPE}<material ¦name="m"><color rgba="0 0 0 1"/></material></visual></link>',
        ),
    ),
    Sample("URDF060", "type-missing", lines(_TWO, ' ¦<joint name="j"><parent link="a"/><child link="b"/></joint>')),
    Sample(
        "URDF061",
        "type-unknown",
        lines(_TWO, ' <joint name="j" ¦type="Fixed"><parent link="a"/><child link="b"/></joint>'),
    ),
    Sample("URDF062", "joint-origin", in_joint('<origin ¦xyz="1,2,3"/>', _AXIS)),
    Sample("URDF062", "joint-rpy", in_joint('<origin xyz="1 2 3" ¦rpy="0 0"/>', _AXIS)),
    Sample("URDF063", "axis", in_joint('<axis ¦xyz="z"/>')),
    Sample(
        "URDF064",
        "no-limit",
        lines(_TWO, f' <joint name="j" ¦type="revolute"><parent link="a"/><child link="b"/>{_AXIS}</joint>'),
    ),
    Sample("URDF065", "no-effort", in_joint(_AXIS, '¦<limit velocity="1"/>')),
    Sample("URDF065", "bad-velocity", in_joint(_AXIS, '<limit effort="1" ¦velocity="fast"/>')),
    Sample("URDF066", "empty-dynamics", in_joint(_AXIS, "¦<dynamics/>")),
    Sample("URDF066", "bad-damping", in_joint(_AXIS, '<dynamics ¦damping="a"/>')),
    Sample("URDF067", "mimic-of-nothing", in_joint(_AXIS, "¦<mimic/>")),
    Sample("URDF067", "mimic-multiplier", in_joint(_AXIS, '<mimic joint="k" ¦multiplier="a"/>')),
    Sample("URDF068", "no-k-velocity", in_joint(_AXIS, "¦<safety_controller/>")),
    Sample("URDF069", "calibration", in_joint(_AXIS, '<calibration ¦rising="a"/>')),
    Sample(
        "URDF070", "no-parent", lines('<link name="a"/>', ' ¦<joint name="j" type="fixed"><child link="a"/></joint>')
    ),
    Sample(
        "URDF070", "no-child", lines('<link name="a"/>', ' ¦<joint name="j" type="fixed"><parent link="a"/></joint>')
    ),
    Sample(
        "URDF070",
        "parent-without-link",
        lines('<link name="a"/>', ' <joint name="j" type="fixed">¦<parent/><child link="a"/></joint>'),
    ),
    Sample(
        "URDF070",
        "parent-of-empty-name",
        lines('<link name="a"/>', ' <joint name="j" type="fixed"><parent ¦link=""/><child link="a"/></joint>'),
    ),
    Sample(
        "URDF071",
        "unknown-parent",
        lines('<link name="a"/>', ' <joint name="j" type="fixed"><parent ¦link="x"/><child link="a"/></joint>'),
    ),
    Sample(
        "URDF071",
        "unknown-child",
        lines('<link name="a"/>', ' <joint name="j" type="fixed"><parent link="a"/><child ¦link="x"/></joint>'),
    ),
    Sample(
        "URDF072",
        "no-axis",
        lines(_TWO, ' ¦<joint name="j" type="continuous"><parent link="a"/><child link="b"/></joint>'),
    ),
    Sample("URDF073", "zero-axis", in_joint('<axis ¦xyz="0 0 0"/>')),
    Sample("URDF073", "axis-without-xyz", in_joint("¦<axis/>")),
    Sample("URDF074", "long-axis", in_joint('<axis ¦xyz="0 0 2"/>')),
    Sample("URDF075", "no-range", in_joint(_AXIS, '<limit ¦lower="0" effort="1" velocity="1"/>', kind="revolute")),
    Sample(
        "URDF075",
        "range-upside-down",
        in_joint(_AXIS, '<limit ¦lower="1" upper="-1" effort="1" velocity="1"/>', kind="prismatic"),
    ),
    Sample("URDF076", "missing-joint", in_joint(_AXIS, '<mimic ¦joint="k"/>')),
    Sample("URDF076", "itself", in_joint(_AXIS, '<mimic ¦joint="j"/>')),
    Sample(
        "URDF077",
        "floating",
        lines(_TWO, ' <joint name="j" ¦type="floating"><parent link="a"/><child link="b"/></joint>'),
    ),
    Sample(
        "URDF077",
        "planar",
        lines(_TWO, f' <joint name="j" ¦type="planar"><parent link="a"/><child link="b"/>{_AXIS}</joint>'),
    ),
    Sample("URDF078", "negative-radius", in_link('<visual><geometry><sphere ¦radius="-1"/></geometry></visual>')),
    Sample(
        "URDF078",
        "negative-length",
        in_link('<visual><geometry><cylinder radius="1" ¦length="-1"/></geometry></visual>'),
    ),
    Sample("URDF078", "negative-edge", in_link('<collision><geometry><box ¦size="1 -1 1"/></geometry></collision>')),
    Sample("URDF080", "loose-link", lines(_TWO, joint("a", "b"), ' <link ¦name="c"/>')),
    Sample("URDF081", "no-root", lines(_TWO, " ¦" + joint("a", "b"), joint("b", "a", "k"))),
    Sample(
        "URDF082",
        "reached-loop",
        lines(links("a", "b", "c"), joint("a", "b"), " ¦" + joint("b", "c", "k"), joint("c", "b", "l")),
        also="URDF084",
    ),
    Sample("URDF083", "detached-loop", lines(links("a", "b", "c"), " ¦" + joint("b", "c"), joint("c", "b", "k"))),
    Sample("URDF084", "two-parents", lines(_TWO, joint("a", "b"), " ¦" + joint("a", "b", "k"))),
    Sample("URDF085", "too-many-paths", _paths(), also="URDF084"),
    Sample("URDF090", "second-origin", in_visual('<origin xyz="0 0 0"/>', "¦<origin/>")),
    Sample(
        "URDF090",
        "second-shape",
        in_link('<visual><geometry><sphere radius="1"/>¦<box size="1 1 1"/></geometry></visual>'),
    ),
    Sample("URDF091", "misspelt-tag", lines('<link name="a"/>', ' ¦<lnk name="b"/>')),
    Sample("URDF091", "misspelt-attribute", in_visual('<origin ¦rpyy="1 2 3"/>')),
    Sample("URDF091", "known-attribute-of-others", in_visual('<origin ¦pos="1 2 3"/>')),
    Sample("URDF091", "misplaced-tag", in_link(f'¦<material name="m">{_COLOUR}</material>')),
    Sample("URDF092", "degrees", in_joint('<origin ¦rpy="90 0 0"/>', _AXIS)),
    Sample(
        "URDF093",
        "inertia-of-the-root",
        in_link(
            '¦<inertial><mass value="1"/>', '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>', "</inertial>"
        ),
    ),
    Sample("URDF094", "colon", lines('<link name="a"/>', " ¦<!-- note: this -->")),
    Sample("URDF094", "tab", lines('<link name="a"/>', " <!-- fine -->¦<!-- a\tb -->")),
    Sample("URDF099", "more-problems-than-are-listed", lines(*['<link name="a"/>'] * 1200) + "¦", also="URDF031"),
)
