"""Joints. Almost any error in a joint stops the whole robot from loading."""

from tests.robot.edge_cases.case import EdgeCase, clean, joint, links, one_joint, rejected, robot

_TYPE = "six types, spelt exactly so"
_LIMIT = "revolute and prismatic joints need a limit"
_LIMITS = "any limit needs effort and velocity, and numbers throughout"
_UNCHECKED = "limits are not compared"
_AXIS = "an axis must be a vector, unless the joint is fixed or floating"
_ORIGIN = "a malformed origin rejects the robot"
_DYNAMICS = "dynamics need damping or friction"
_SAFETY = "a safety_controller needs k_velocity"
_CALIBRATION = "calibration needs nothing, but numbers where given"
_MIMIC = "a mimic needs the name of a joint, which need not exist"
_ENDS = "a joint needs parent and child, both links of the robot"
_NAME = "a joint needs a name of its own"
_FIRST = "of repeated elements the first counts"
_IGNORED = "unknown tags and attributes are ignored"
_DIRECT = "only direct children of robot count"
_CASE = "names are case-sensitive"

_GOOD_LIMIT = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'
_KINDS = ("fixed", "revolute", "continuous", "prismatic", "planar", "floating")
_FREE = ("fixed", "continuous", "planar", "floating")
_MOVING = ("revolute", "continuous", "prismatic", "planar")


def _kind(kind: str) -> str:
    return one_joint(_GOOD_LIMIT, kind)


TYPES: tuple[EdgeCase, ...] = (
    *(clean(f"type-{kind}-with-limit", _TYPE, _kind(kind)) for kind in _KINDS),
    *(clean(f"type-{kind}-bare", _LIMIT, one_joint("", kind)) for kind in _FREE),
    *(rejected(f"type-{kind}-bare", _LIMIT, one_joint("", kind)) for kind in ("revolute", "prismatic")),
    *(rejected(f"type-{kind}-empty-limit", _LIMITS, one_joint("<limit/>", kind)) for kind in _KINDS),
    rejected("type-missing", _TYPE, one_joint().replace(' type="fixed"', "")),
    rejected("type-empty", _TYPE, _kind("")),
    rejected("type-capital", _TYPE, _kind("Fixed")),
    rejected("type-leading-space", _TYPE, _kind(" fixed")),
    rejected("type-trailing-newline", _TYPE, _kind("fixed\n")),
    rejected("type-misspelt", _TYPE, _kind("continous")),
    rejected("type-attribute-in-capitals", _CASE, one_joint().replace(" type=", " Type=")),
    rejected("type-as-element", _TYPE, one_joint("<type>fixed</type>").replace(' type="fixed"', "")),
    rejected("limit-in-capitals", _CASE, one_joint(_GOOD_LIMIT.replace("limit", "Limit"), "revolute")),
    rejected("limit-outside-joint", _LIMIT, one_joint("", "revolute").replace("</robot>", f"{_GOOD_LIMIT}</robot>")),
    rejected("limit-nested", _LIMIT, one_joint(f"<limits>{_GOOD_LIMIT}</limits>", "revolute")),
)


def _revolute(limit: str) -> str:
    return one_joint(limit, "revolute")


LIMITS: tuple[EdgeCase, ...] = (
    clean("limit-effort-and-velocity", _LIMITS, _revolute('<limit effort="1" velocity="1"/>')),
    clean("limit-only-lower", _LIMITS, _revolute('<limit lower="-1" effort="1" velocity="1"/>')),
    clean("limit-crossed", _UNCHECKED, _revolute('<limit lower="1" upper="-1" effort="1" velocity="1"/>')),
    clean("limit-in-degrees", _UNCHECKED, _revolute('<limit lower="-180" upper="180" effort="1" velocity="1"/>')),
    clean("limit-negative-effort", _UNCHECKED, _revolute('<limit effort="-1" velocity="-1"/>')),
    clean("limit-more-attributes", _IGNORED, _revolute('<limit effort="1" velocity="1" acceleration="x" jerk=""/>')),
    rejected("limit-without-effort", _LIMITS, _revolute('<limit lower="-1" upper="1" velocity="1"/>')),
    rejected("limit-bad-upper", _LIMITS, _revolute('<limit upper="pi" effort="1" velocity="1"/>')),
    rejected("limit-empty-upper", _LIMITS, _revolute('<limit upper="" effort="1" velocity="1"/>')),
    rejected("limit-bad-velocity", _LIMITS, _revolute('<limit effort="1" velocity="1 "/>')),
    rejected("limit-infinite-velocity", _LIMITS, _revolute('<limit effort="1" velocity="1e999"/>')),
    rejected("limit-effort-in-capitals", _CASE, _revolute('<limit Effort="1" velocity="1"/>')),
    clean("limit-lower-in-capitals", _CASE, _revolute('<limit Lower="x" effort="1" velocity="1"/>')),
    rejected("limit-bad-on-fixed", _LIMITS, one_joint('<limit upper="x" effort="1" velocity="1"/>')),
    rejected("limit-range-on-continuous", _LIMITS, one_joint('<limit lower="-1" upper="1"/>', "continuous")),
    rejected("limit-effort-on-floating", _LIMITS, one_joint('<limit effort="1"/>', "floating")),
    clean("limit-twice-second-bad", _FIRST, _revolute(f"{_GOOD_LIMIT}<limit/>")),
    rejected("limit-twice-first-bad", _FIRST, _revolute(f"<limit/>{_GOOD_LIMIT}")),
)


def _moving(body: str, kind: str) -> str:
    return one_joint(f"{_GOOD_LIMIT}{body}", kind)


AXES: tuple[EdgeCase, ...] = (
    *(clean(f"axis-plain-{kind}", _AXIS, _moving('<axis xyz="0 0 1"/>', kind)) for kind in _KINDS),
    *(rejected(f"axis-malformed-{kind}", _AXIS, _moving('<axis xyz="0 0"/>', kind)) for kind in _MOVING),
    *(clean(f"axis-malformed-{kind}", _AXIS, _moving('<axis xyz="0 0"/>', kind)) for kind in ("fixed", "floating")),
    *(clean(f"axis-empty-element-{kind}", _AXIS, _moving("<axis/>", kind)) for kind in _KINDS),
    clean("axis-zero", _AXIS, _moving('<axis xyz="0 0 0"/>', "revolute")),
    clean("axis-long", _AXIS, _moving('<axis xyz="0 3 4"/>', "prismatic")),
    clean("axis-with-only-rpy", _AXIS, _moving('<axis rpy="0 0 1"/>', "revolute")),
    clean("axis-with-bad-rpy", _IGNORED, _moving('<axis xyz="0 0 1" rpy="x"/>', "revolute")),
    clean("axis-xyz-in-capitals", _CASE, _moving('<axis XYZ="x"/>', "revolute")),
    rejected("axis-letter", _AXIS, _moving('<axis xyz="z"/>', "continuous")),
    rejected("axis-tab", _AXIS, _moving('<axis xyz="0\t0 1"/>', "planar")),
    clean("axis-twice-second-bad", _FIRST, _moving('<axis xyz="0 0 1"/><axis xyz="x"/>', "revolute")),
    rejected("axis-twice-first-bad", _FIRST, _moving('<axis xyz="x"/><axis xyz="0 0 1"/>', "revolute")),
    clean("axis-twice-first-bare", _FIRST, _moving('<axis/><axis xyz="x"/>', "revolute")),
    rejected("axis-bad-off-the-tree", _AXIS, one_joint('<axis xyz="x"/>', "planar").replace('"a"/><c', '"b"/><c')),
)

ORIGINS: tuple[EdgeCase, ...] = (
    clean("origin-empty-element", _ORIGIN, one_joint("<origin/>")),
    clean("origin-only-rpy", _ORIGIN, one_joint('<origin rpy="1 2 3"/>')),
    clean("origin-in-degrees", "angles are not checked", one_joint('<origin rpy="90 0 180"/>')),
    clean("origin-other-attributes", _IGNORED, one_joint('<origin x="x" y="" quat_xyzw="a"/>')),
    clean("origin-attributes-in-capitals", _CASE, one_joint('<origin XYZ="x" Rpy="y"/>')),
    clean("origin-in-capitals", _CASE, one_joint('<Origin xyz="x"/>')),
    clean("origin-nested", "only direct children count", one_joint('<frame><origin xyz="x"/></frame>')),
    clean("origin-as-text", _IGNORED, one_joint("<origin>x y z</origin>")),
    *(rejected(f"origin-bad-xyz-{kind}", _ORIGIN, _moving('<origin xyz="0 0"/>', kind)) for kind in _KINDS),
    *(rejected(f"origin-bad-rpy-{kind}", _ORIGIN, _moving('<origin rpy="0 0 x"/>', kind)) for kind in _KINDS),
    rejected("origin-empty-xyz", _ORIGIN, one_joint('<origin xyz="" rpy="0 0 0"/>')),
    rejected("origin-empty-rpy", _ORIGIN, one_joint('<origin xyz="0 0 0" rpy=""/>')),
    clean("origin-twice-second-bad", _FIRST, one_joint('<origin/><origin xyz="x"/>')),
    rejected("origin-twice-first-bad", _FIRST, one_joint('<origin xyz="x"/><origin/>')),
)

EXTRAS: tuple[EdgeCase, ...] = (
    clean("dynamics-both", _DYNAMICS, one_joint('<dynamics damping="1" friction="1"/>')),
    clean("dynamics-damping", _DYNAMICS, one_joint('<dynamics damping="1"/>')),
    rejected("dynamics-empty", _DYNAMICS, one_joint("<dynamics/>")),
    rejected("dynamics-other-attributes", _DYNAMICS, one_joint('<dynamics spring="1"/>')),
    rejected("dynamics-in-other-case", _CASE, one_joint('<dynamics Damping="1"/>')),
    rejected("dynamics-bad-damping", _DYNAMICS, one_joint('<dynamics damping="x"/>')),
    rejected("dynamics-bad-friction", _DYNAMICS, one_joint('<dynamics damping="1" friction=""/>')),
    clean("dynamics-twice-second-bad", _FIRST, one_joint('<dynamics damping="1"/><dynamics/>')),
    rejected("dynamics-twice-first-bad", _FIRST, one_joint('<dynamics/><dynamics damping="1"/>')),
    clean("safety-velocity", _SAFETY, one_joint('<safety_controller k_velocity="1"/>')),
    rejected("safety-empty", _SAFETY, one_joint("<safety_controller/>")),
    rejected("safety-without-velocity", _SAFETY, one_joint('<safety_controller k_position="1"/>')),
    rejected("safety-bad-velocity", _SAFETY, one_joint('<safety_controller k_velocity="x"/>')),
    rejected("safety-bad-position", _SAFETY, one_joint('<safety_controller k_velocity="1" k_position=""/>')),
    rejected("safety-bad-lower", _SAFETY, one_joint('<safety_controller k_velocity="1" soft_lower_limit="x"/>')),
    clean("safety-misspelt", _IGNORED, one_joint("<safety/>")),
    clean("safety-twice-second-bad", _FIRST, one_joint('<safety_controller k_velocity="1"/><safety_controller/>')),
    clean("calibration-empty", _CALIBRATION, one_joint("<calibration/>")),
    clean("calibration-both", _CALIBRATION, one_joint('<calibration rising="0" falling="1"/>')),
    clean("calibration-other-attribute", _IGNORED, one_joint('<calibration reference_position="x"/>')),
    rejected("calibration-bad-rising", _CALIBRATION, one_joint('<calibration rising="x"/>')),
    rejected("calibration-empty-falling", _CALIBRATION, one_joint('<calibration falling=""/>')),
    clean("calibration-twice-second-bad", _FIRST, one_joint('<calibration/><calibration rising="x"/>')),
    clean("mimic-plain", _MIMIC, one_joint('<mimic joint="j"/>')),
    clean("mimic-all", _MIMIC, one_joint('<mimic joint="j" multiplier="-1" offset="0.5"/>')),
    clean("mimic-missing-joint", _MIMIC, one_joint('<mimic joint="nope"/>')),
    clean("mimic-zero", _MIMIC, one_joint('<mimic joint="j" multiplier="0"/>')),
    rejected("mimic-empty", _MIMIC, one_joint("<mimic/>")),
    rejected("mimic-without-joint", _MIMIC, one_joint('<mimic multiplier="1" offset="0"/>')),
    rejected("mimic-joint-in-capitals", _CASE, one_joint('<mimic Joint="j"/>')),
    rejected("mimic-joint-name", _MIMIC, one_joint('<mimic joint_name="j"/>')),
    rejected("mimic-bad-multiplier", _MIMIC, one_joint('<mimic joint="j" multiplier="x"/>')),
    rejected("mimic-empty-multiplier", _MIMIC, one_joint('<mimic joint="j" multiplier=""/>')),
    rejected("mimic-bad-offset", _MIMIC, one_joint('<mimic joint="j" offset="1,0"/>')),
    clean("mimic-twice-second-bad", _FIRST, one_joint('<mimic joint="j"/><mimic/>')),
    rejected("mimic-twice-first-bad", _FIRST, one_joint('<mimic/><mimic joint="j"/>')),
    clean("joint-unknown-children", _IGNORED, one_joint("<hardwareInterface/><spring_reference/><friction/>")),
    clean("joint-unknown-attributes", _IGNORED, one_joint().replace('name="j"', 'name="j" axis="x" limit="y"')),
)


def _ends(ends: str, *more: str) -> str:
    return robot(f'{links("a", "b", *more)}<joint name="j" type="fixed">{ends}</joint>')


_PARENT = '<parent link="a"/>'
_CHILD = '<child link="b"/>'

ENDS: tuple[EdgeCase, ...] = (
    clean("ends-child-first", _ENDS, _ends(_CHILD + _PARENT)),
    rejected("ends-none", _ENDS, _ends("")),
    rejected("ends-no-parent", _ENDS, _ends(_CHILD)),
    rejected("ends-no-child", _ENDS, _ends(_PARENT)),
    rejected("ends-parent-without-link", _ENDS, _ends("<parent/>" + _CHILD)),
    rejected("ends-child-without-link", _ENDS, _ends(_PARENT + "<child/>")),
    rejected("ends-parent-empty", _ENDS, _ends('<parent link=""/>' + _CHILD)),
    rejected("ends-child-empty", _ENDS, _ends(_PARENT + '<child link=""/>')),
    rejected("ends-parent-name", _ENDS, _ends('<parent name="a"/>' + _CHILD)),
    rejected("ends-parent-in-capitals", _CASE, _ends('<Parent link="a"/>' + _CHILD)),
    rejected("ends-parent-link-in-capitals", _CASE, _ends('<parent Link="a"/>' + _CHILD)),
    rejected("ends-as-attributes", _ENDS, _ends("").replace("></joint", ' parent="a" child="b"></joint')),
    rejected("ends-parent-unknown", _ENDS, _ends('<parent link="nope"/>' + _CHILD)),
    rejected("ends-child-unknown", _ENDS, _ends(_PARENT + '<child link="nope"/>')),
    rejected("ends-child-other-case", _ENDS, _ends(_PARENT + '<child link="B"/>')),
    rejected("ends-both-unknown", _ENDS, robot(links("a") + joint("x", "y"))),
    rejected("ends-unknown-beside-whole-tree", _ENDS, robot(links("a", "b") + joint("a", "b") + joint("b", "c", "k"))),
    rejected("ends-link-of-empty-name-as-parent", _ENDS, robot(links("", "b") + joint("", "b"))),
    rejected("ends-link-of-empty-name-as-child", _ENDS, robot(links("a", "") + joint("a", ""))),
    clean("ends-parent-twice-second-bad", _FIRST, _ends(_PARENT + '<parent link="nope"/>' + _CHILD)),
    rejected("ends-parent-twice-first-bad", _FIRST, _ends('<parent link="nope"/>' + _PARENT + _CHILD)),
    rejected("ends-child-twice-first-bare", _FIRST, _ends(_PARENT + "<child/>" + _CHILD)),
    rejected("ends-child-twice-second-loose", _FIRST, _ends(_PARENT + _CHILD + '<child link="c"/>', "c")),
    rejected("joint-without-name", _NAME, one_joint().replace(' name="j"', "")),
    rejected("joint-name-in-capitals", _CASE, one_joint().replace(' name="j"', ' Name="j"')),
    clean("joint-empty-name", "a joint may have an empty name", one_joint().replace('name="j"', 'name=""')),
    clean("joint-name-of-link", "joints and links have names of their own", one_joint().replace('"j"', '"a"')),
    rejected("joints-of-one-name", _NAME, robot(links("a", "b", "c") + joint("a", "b") + joint("b", "c"))),
    rejected("joints-of-one-name-alike", _NAME, robot(links("a", "b") + joint("a", "b") * 2)),
    clean("joints-of-two-cases", _NAME, robot(links("a", "b", "c") + joint("a", "b", "j") + joint("b", "c", "J"))),
    rejected("joint-empty-element", _NAME, robot(f"{links('a')}<joint/>")),
    clean("joint-in-transmission", _DIRECT, robot(f"{links('a')}<transmission><joint/></transmission>")),
    rejected("joint-in-link", _DIRECT, robot(f'{links("b")}<link name="a">{joint("a", "b")}</link>')),
)

CASES = TYPES + LIMITS + AXES + ORIGINS + EXTRAS + ENDS
