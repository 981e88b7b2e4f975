"""A small file for each kind of problem. A ¦ marks the tag or attribute of the problem."""

from dataclasses import dataclass
from itertools import pairwise

from tests.robot.edge_cases.case import joint, links, robot

_TWO = links("a", "b")


@dataclass(frozen=True, slots=True)
class ProblemSample:
    """A file with a problem of this code at the ¦; `also` lists the other codes in it."""

    code: str
    name: str
    marked: str
    also: str = ""

    @property
    def data(self) -> bytes:
        """Return the file without the mark."""
        return self.marked.replace("¦", "").encode("utf-8", "surrogateescape")

    @property
    def location(self) -> tuple[int, int]:
        """Return line and column of the mark, counted from 1 in characters."""
        before = self.marked[: self.marked.index("¦")]
        return before.count("\n") + 1, len(before) - before.rfind("\n")


def lines(*rows: str) -> str:
    """Return a robot with these lines."""
    return "\n".join(('<robot name="r">', *rows, "</robot>", ""))


def in_link(*rows: str) -> str:
    """Return a robot with a link that contains these lines."""
    return lines('  <link name="a">', *(f"    {row}" for row in rows), "  </link>")


def in_joint(*rows: str, kind: str = "continuous") -> str:
    """Return a robot with a joint that contains these lines."""
    head = f'  {_TWO}\n  <joint name="j" type="{kind}">\n    <parent link="a"/><child link="b"/>'
    return lines(head, *(f"    {row}" for row in rows), "  </joint>")


def in_visual(*rows: str) -> str:
    """Return a robot with a visual that contains these lines and a shape."""
    return in_link("<visual>", *rows, '<geometry><sphere radius="1"/></geometry>', "</visual>")


def _paths() -> str:
    names = [f"l{index}" for index in range(26)]
    pairs = (joint(one, other, f"j{one}{side}") for one, other in pairwise(names) for side in "xy")
    return robot(links(*names).replace("<link", "¦<link", 1) + "".join(pairs))


_AXIS = '<axis xyz="0 0 1"/>'
_LIMIT = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'
_SHAPE = '<geometry><sphere radius="1"/></geometry>'
_COLOUR = '<color rgba="1 0 0 1"/>'

SAMPLES: tuple[ProblemSample, ...] = (
    ProblemSample("URDF001", "attribute-without-name", lines(_TWO, '  ¦<parent="a"/>'), also="URDF015"),
    ProblemSample("URDF001", "comma-between-attributes", lines('  <link name="a"¦, b="c"/>'), also="URDF015"),
    ProblemSample("URDF001", "attribute-without-value", lines("  <link ¦name/>"), also="URDF015"),
    ProblemSample("URDF001", "attribute-without-quotes", lines("  <link ¦name=a/>"), also="URDF015"),
    ProblemSample("URDF001", "typographic-quotes", lines("  <link ¦name=\u201ca\u201d/>"), also="URDF015"),
    ProblemSample("URDF001", "attribute-twice", lines('  <link name="a" ¦name="b"/>'), also="URDF015"),
    ProblemSample("URDF001", "tag-not-closed", lines('  ¦<link name="a"', '  <link name="b"/>'), also="URDF015"),
    ProblemSample("URDF001", "quote-not-closed", lines('  ¦<link name="a/>', '  <link name="b"/>'), also="URDF015"),
    ProblemSample("URDF001", "no-tag-name", lines("  ¦<1/>")),
    ProblemSample("URDF002", "closed-by-another", lines('  <link name="a">', "  ¦</lnk>"), also="URDF015"),
    ProblemSample(
        "URDF015", "closed-here", lines('  <link name="a">', "    <inertial>", "  ¦</link>"), also="URDF002 URDF040"
    ),
    ProblemSample("URDF002", "never-closed", '<robot name="r">\n  ¦<link name="a">\n', also="URDF015"),
    ProblemSample("URDF003", "empty", "¦"),
    ProblemSample("URDF003", "blank", "¦\n\n"),
    ProblemSample("URDF004", "comment", lines("  ¦<!-- a")),
    ProblemSample("URDF004", "cdata", lines("  ¦<![CDATA[ a")),
    ProblemSample("URDF004", "declaration", '¦<?xml version="1.0"\n<robot name="r"/>'),
    ProblemSample("URDF005", "declaration-inside", lines('  <link name="a"/>', "  ¦<?xml version='1.0'?>")),
    ProblemSample("URDF005", "comment-before", "<!-- c -->\n¦<?xml version='1.0'?>\n" + lines('  <link name="a"/>')),
    ProblemSample("URDF006", "text-after-root", lines(_TWO) + "\n¦text"),
    ProblemSample("URDF007", "499-levels", lines(*["<a>"] * 497, "¦<a>", *["</a>"] * 498)),
    ProblemSample("URDF008", "utf-16", "¦\udcff\udcfe<\0r\0o\0b\0o\0t\0/\0>\0"),
    ProblemSample("URDF009", "bare-ampersand", lines('  <link ¦name="a & b"/>')),
    ProblemSample("URDF009", "control-character", lines('  <link name="a¦\x01"/>')),
    ProblemSample("URDF009", "prefix", lines('  <link name="a"/>', "  ¦<x:y/>")),
    ProblemSample("URDF009", "dashes-in-comment", lines('  <link name="a"/>', "  ¦<!-- a -- b -->")),
    ProblemSample("URDF010", "doctype", "\n¦<!DOCTYPE robot>\n" + lines('<link name="a"/>')),
    ProblemSample("URDF011", "nul", lines('<link name="a"/>') + "¦\0rest"),
    ProblemSample("URDF011", "stray-closing-tag", lines('<link name="a"/>') + "¦</robot>\n<robot/>", also="URDF009"),
    ProblemSample("URDF012", "second-root", lines('<link name="a"/>') + "¦<link name='b'/>"),
    ProblemSample("URDF013", "other-root", "\n ¦<sdf/>"),
    ProblemSample("URDF013", "other-root-of-the-dialect", "¦<sdf><![CDATA[]]></sdf>"),
    ProblemSample("URDF014", "xacro-tag", lines('<link name="a"/>', "  ¦<xacro:macro name='m'/>"), also="URDF009"),
    ProblemSample("URDF014", "expression", lines('<!-- ${a} -->  <link name="¦${b}"/>')),
    ProblemSample("URDF020", "robot-without-name", '\n¦<robot version="1.0"><link name="a"/></robot>'),
    ProblemSample("URDF021", "version", '<robot name="r"\n  ¦version="2.0"><link name="a"/></robot>'),
    ProblemSample("URDF022", "no-links", '\n ¦<robot name="r"/>'),
    ProblemSample("URDF030", "link-without-name", lines("  ¦<link/>")),
    ProblemSample("URDF031", "link-twice", lines('  <link name="a"/>', '  <link ¦name="a"/>')),
    ProblemSample(
        "URDF032",
        "joint-twice",
        lines(_TWO, joint("a", "b"), '<joint type="fixed"\n ¦name="j"><parent link="a"/><child link="b"/></joint>'),
    ),
    ProblemSample(
        "URDF033",
        "material-twice",
        lines('<link name="a"/>', *(f'<material {mark}name="m">{_COLOUR}</material>' for mark in ("", "¦"))),
    ),
    ProblemSample(
        "URDF034",
        "joint-without-name",
        lines(_TWO, ' ¦<joint type="fixed"><parent link="a"/><child link="b"/></joint>'),
    ),
    ProblemSample(
        "URDF040",
        "inertial-without-mass",
        in_link("¦<inertial>", '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>', "</inertial>"),
    ),
    ProblemSample(
        "URDF040",
        "mass-of-a-word",
        in_link(
            '<inertial><mass ¦value="heavy"/>',
            '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>',
            "</inertial>",
        ),
    ),
    ProblemSample("URDF041", "visual-without-geometry", in_link("¦<visual/>")),
    ProblemSample("URDF041", "empty-geometry", in_link("<visual>", "¦<geometry/>", "</visual>")),
    ProblemSample("URDF041", "unknown-shape", in_link("<visual><geometry>", "¦<cone/>", "</geometry></visual>")),
    ProblemSample("URDF041", "box-without-size", in_link("<visual><geometry>", "¦<box/>", "</geometry></visual>")),
    ProblemSample(
        "URDF041", "comma-in-size", in_link("<visual><geometry>", '<box ¦size="1, 1, 1"/>', "</geometry></visual>")
    ),
    ProblemSample(
        "URDF041",
        "cylinder-height",
        in_link("<visual><geometry>", '¦<cylinder radius="1" height="2"/>', "</geometry></visual>"),
        also="URDF091",
    ),
    ProblemSample("URDF041", "visual-origin", in_visual('<origin ¦xyz="1 2"/>')),
    ProblemSample("URDF041", "visual-rpy", in_visual('<origin xyz="1 2 3" ¦rpy="a b c"/>')),
    ProblemSample("URDF041", "mesh-without-file", in_link("<visual><geometry>", "¦<mesh/>", "</geometry></visual>")),
    ProblemSample(
        "URDF041",
        "mesh-scale",
        in_link("<visual><geometry>", '<mesh filename="m" ¦scale="1"/>', "</geometry></visual>"),
    ),
    ProblemSample("URDF041", "nameless-material", in_visual(f"¦<material>{_COLOUR}</material>")),
    ProblemSample("URDF042", "collision-without-geometry", in_link("¦<collision/>")),
    ProblemSample(
        "URDF042", "collision-radius", in_link('<collision><geometry><sphere ¦radius="1m"/></geometry></collision>')
    ),
    ProblemSample("URDF043", "printf", in_visual('<origin ¦xyz="%n 0 0"/>'), also="URDF041"),
    ProblemSample("URDF050", "nameless-material", lines('<link name="a"/>', f" ¦<material>{_COLOUR}</material>")),
    ProblemSample("URDF051", "nowhere", in_visual('<material ¦name="m"/>')),
    ProblemSample(
        "URDF051",
        "later",
        lines(
            f'<link name="a"><visual>{_SHAPE}<material ¦name="m"/></visual></link>',
            f'<link name="b"><visual>{_SHAPE}<material name="m">{_COLOUR}</material></visual></link>',
            joint("a", "b"),
        ),
    ),
    ProblemSample(
        "URDF052",
        "colour-of-255",
        lines('<link name="a"/>', '<material name="m"><color ¦rgba="255 0 0 255"/></material>'),
    ),
    ProblemSample("URDF052", "colour-in-a-link", in_visual('<material name="m"><color ¦rgba="red"/></material>')),
    ProblemSample(
        "URDF053", "three-channels", lines('<link name="a"/>', '<material name="m"><color ¦rgba="1 0 0"/></material>')
    ),
    ProblemSample("URDF054", "no-colour", lines('<link name="a"/>', ' ¦<material name="m"/>')),
    ProblemSample(
        "URDF055",
        "otherwise",
        lines(
            f'<material name="m">{_COLOUR}</material>',
            f'<link name="a"><visual>{_SHAPE}<material ¦name="m"><color rgba="0 0 0 1"/></material></visual></link>',
        ),
    ),
    ProblemSample(
        "URDF060", "type-missing", lines(_TWO, ' ¦<joint name="j"><parent link="a"/><child link="b"/></joint>')
    ),
    ProblemSample(
        "URDF061",
        "type-unknown",
        lines(_TWO, ' <joint name="j" ¦type="rigid"><parent link="a"/><child link="b"/></joint>'),
    ),
    ProblemSample("URDF062", "joint-origin", in_joint('<origin ¦xyz="1,2,3"/>', _AXIS)),
    ProblemSample("URDF062", "joint-rpy", in_joint('<origin xyz="1 2 3" ¦rpy="0 0"/>', _AXIS)),
    ProblemSample("URDF063", "axis", in_joint('<axis ¦xyz="z"/>')),
    ProblemSample(
        "URDF064",
        "no-limit",
        lines(_TWO, f' <joint name="j" ¦type="revolute"><parent link="a"/><child link="b"/>{_AXIS}</joint>'),
    ),
    ProblemSample("URDF065", "no-effort", in_joint(_AXIS, '¦<limit velocity="1"/>')),
    ProblemSample("URDF065", "bad-velocity", in_joint(_AXIS, '<limit effort="1" ¦velocity="fast"/>')),
    ProblemSample("URDF066", "empty-dynamics", in_joint(_AXIS, "¦<dynamics/>")),
    ProblemSample("URDF066", "bad-damping", in_joint(_AXIS, '<dynamics ¦damping="a"/>')),
    ProblemSample("URDF067", "mimic-of-nothing", in_joint(_AXIS, "¦<mimic/>")),
    ProblemSample("URDF067", "mimic-multiplier", in_joint(_AXIS, '<mimic joint="k" ¦multiplier="a"/>')),
    ProblemSample("URDF068", "no-k-velocity", in_joint(_AXIS, "¦<safety_controller/>")),
    ProblemSample("URDF069", "calibration", in_joint(_AXIS, '<calibration ¦rising="a"/>')),
    ProblemSample(
        "URDF070", "no-parent", lines('<link name="a"/>', ' ¦<joint name="j" type="fixed"><child link="a"/></joint>')
    ),
    ProblemSample(
        "URDF070", "no-child", lines('<link name="a"/>', ' ¦<joint name="j" type="fixed"><parent link="a"/></joint>')
    ),
    ProblemSample(
        "URDF070",
        "parent-without-link",
        lines('<link name="a"/>', ' <joint name="j" type="fixed">¦<parent/><child link="a"/></joint>'),
    ),
    ProblemSample(
        "URDF070",
        "parent-of-empty-name",
        lines('<link name="a"/>', ' <joint name="j" type="fixed"><parent ¦link=""/><child link="a"/></joint>'),
    ),
    ProblemSample(
        "URDF071",
        "unknown-parent",
        lines('<link name="a"/>', ' <joint name="j" type="fixed"><parent ¦link="x"/><child link="a"/></joint>'),
    ),
    ProblemSample(
        "URDF071",
        "unknown-child",
        lines('<link name="a"/>', ' <joint name="j" type="fixed"><parent link="a"/><child ¦link="x"/></joint>'),
    ),
    ProblemSample(
        "URDF072",
        "no-axis",
        lines(_TWO, ' ¦<joint name="j" type="continuous"><parent link="a"/><child link="b"/></joint>'),
    ),
    ProblemSample("URDF073", "zero-axis", in_joint('<axis ¦xyz="0 0 0"/>')),
    ProblemSample("URDF073", "axis-without-xyz", in_joint("¦<axis/>")),
    ProblemSample("URDF074", "long-axis", in_joint('<axis ¦xyz="0 0 2"/>')),
    ProblemSample(
        "URDF075", "no-range", in_joint(_AXIS, '<limit ¦lower="0" effort="1" velocity="1"/>', kind="revolute")
    ),
    ProblemSample(
        "URDF075",
        "range-upside-down",
        in_joint(_AXIS, '<limit ¦lower="1" upper="-1" effort="1" velocity="1"/>', kind="prismatic"),
    ),
    ProblemSample("URDF076", "missing-joint", in_joint(_AXIS, '<mimic ¦joint="k"/>')),
    ProblemSample("URDF076", "itself", in_joint(_AXIS, '<mimic ¦joint="j"/>')),
    ProblemSample(
        "URDF077",
        "floating",
        lines(_TWO, ' <joint name="j" ¦type="floating"><parent link="a"/><child link="b"/></joint>'),
    ),
    ProblemSample(
        "URDF077",
        "planar",
        lines(_TWO, f' <joint name="j" ¦type="planar"><parent link="a"/><child link="b"/>{_AXIS}</joint>'),
    ),
    ProblemSample(
        "URDF078", "negative-radius", in_link('<visual><geometry><sphere ¦radius="-1"/></geometry></visual>')
    ),
    ProblemSample(
        "URDF078",
        "negative-length",
        in_link('<visual><geometry><cylinder radius="1" ¦length="-1"/></geometry></visual>'),
    ),
    ProblemSample(
        "URDF078", "negative-edge", in_link('<collision><geometry><box ¦size="1 -1 1"/></geometry></collision>')
    ),
    ProblemSample(
        "URDF079",
        "limits-in-degrees",
        in_joint(_AXIS, '<limit ¦lower="-90" upper="90" effort="1" velocity="1"/>', kind="revolute"),
    ),
    ProblemSample(
        "URDF079",
        "one-limit-in-degrees",
        in_joint(_AXIS, '<limit lower="-1.57" ¦upper="360" effort="1" velocity="1"/>', kind="revolute"),
    ),
    ProblemSample("URDF080", "loose-link", lines(_TWO, joint("a", "b"), ' <link ¦name="c"/>')),
    ProblemSample("URDF081", "no-root", lines(_TWO, " ¦" + joint("a", "b"), joint("b", "a", "k"))),
    ProblemSample(
        "URDF082",
        "reached-loop",
        lines(links("a", "b", "c"), joint("a", "b"), " ¦" + joint("b", "c", "k"), joint("c", "b", "l")),
        also="URDF084",
    ),
    ProblemSample(
        "URDF083", "detached-loop", lines(links("a", "b", "c"), " ¦" + joint("b", "c"), joint("c", "b", "k"))
    ),
    ProblemSample("URDF084", "two-parents", lines(_TWO, joint("a", "b"), " ¦" + joint("a", "b", "k"))),
    ProblemSample("URDF085", "too-many-paths", _paths(), also="URDF084"),
    ProblemSample("URDF090", "second-origin", in_visual('<origin xyz="0 0 0"/>', "¦<origin/>")),
    ProblemSample(
        "URDF090",
        "second-shape",
        in_link('<visual><geometry><sphere radius="1"/>¦<box size="1 1 1"/></geometry></visual>'),
    ),
    ProblemSample("URDF091", "misspelt-tag", lines('<link name="a"/>', ' ¦<lnk name="b"/>')),
    ProblemSample("URDF091", "misspelt-attribute", in_visual('<origin ¦rpyy="1 2 3"/>')),
    ProblemSample("URDF091", "known-attribute-of-others", in_visual('<origin ¦pos="1 2 3"/>')),
    ProblemSample("URDF091", "misplaced-tag", in_link(f'¦<material name="m">{_COLOUR}</material>')),
    ProblemSample("URDF092", "degrees", in_joint('<origin ¦rpy="90 0 0"/>', _AXIS)),
    ProblemSample(
        "URDF093",
        "inertia-of-the-root",
        in_link(
            '¦<inertial><mass value="1"/>', '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>', "</inertial>"
        ),
    ),
    ProblemSample("URDF094", "colon", lines('<link name="a"/>', " ¦<!-- note: this -->")),
    ProblemSample("URDF094", "tab", lines('<link name="a"/>', " <!-- fine -->¦<!-- a\tb -->")),
    ProblemSample(
        "URDF099", "more-problems-than-are-listed", lines(*['<link name="a"/>'] * 1200) + "¦", also="URDF031"
    ),
)
