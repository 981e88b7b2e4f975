"""Which check to try for a mutant that survived: a table of what it changes."""

from collections.abc import Collection, Iterator, Sequence
from typing import NamedTuple

from grader.grading.criterion import Criterion
from grader.grading.rubric import Rubric
from grader.mutation.mutants import Mutant
from grader.mutation.references import texts
from grader.robot.model import Robot
from grader.text import enumerated


class Rule(NamedTuple):
    """The checks that look at an attribute or tag. `inside` are tags that must be around it, `@name` names an attribute."""

    what: str
    checks: tuple[str, ...]
    inside: str = ""


# What ROS 2 does with a mutant, and the check that looks at that.
_VERDICTS = {
    "rejected": ("ROS 2 rejects it, and no criterion says so", "urdf_loads"),
    "degraded": ("ROS 2 drops content of it, and no criterion says so", "without_problems"),
}
_MEASURED = ("link", "links", "joints", "leader", "name", "file", "files")
# The first rule that matches counts.
_RULES = (
    Rule("limit", ("joint_limits",)),
    Rule("safety_controller", ("element_present",)),
    Rule("calibration", ("element_present",)),
    Rule("dynamics", ("joint_dynamics",)),
    Rule("mimic", ("mimics",)),
    Rule("axis", ("joint_axis", "axis_along")),
    Rule("mass", ("mass_is",)),
    Rule("inertial", ("inertia_plausible", "mass_is")),
    Rule("collision", ("collision_matches_visual", "collides_as")),
    Rule("gazebo", ("element_present",)),
    Rule("ros2_control", ("element_present",)),
    Rule("transmission", ("element_present",)),
    Rule("sensor", ("element_present",)),
    Rule("mesh", ("shows_mesh",)),
    Rule("box", ("shows_box",)),
    Rule("cylinder", ("shows_cylinder",)),
    Rule("sphere", ("shows_sphere",)),
    Rule("material", ("shows_colour", "shows_grey")),
    Rule("@type", ("held_by", "counts"), "joint"),
    Rule("@name", ("joints_named",), "joint"),
    Rule("parent", ("held_by",)),
    Rule("child", ("held_by",)),
    Rule("origin", ("centre_at", "bottom_at_height"), "visual"),
    Rule("origin", ("frame_at", "kinematics_match_reference"), "joint"),
    Rule("visual", ("shows_box", "shows_cylinder", "shows_sphere", "shows_mesh", "shows_nothing")),
    Rule("joint", ("held_by", "counts", "urdf_loads")),
    Rule("link", ("counts", "urdf_loads")),
    Rule("xacro:property", ("xacro_uses",)),
    Rule("xacro:macro", ("xacro_uses",)),
    Rule("xacro:include", ("xacro_uses",)),
    Rule("package.xml", ("package_found", "package_type")),
    Rule("setup.py", ("build_installs", "installs_files", "setup_imports")),
    Rule("launch", ("launch_starts", "launch_finds_files", "launch_found")),
    Rule("rviz", ("rviz_display_on", "rviz_fixed_frame", "rviz_found")),
    Rule("file", ("installs_files", "build_installs")),
)


def suggestion(
    mutant: Mutant,
    rubric: Rubric,
    robot: Robot | None,
    verdict: str,
    tolerated: Collection[str],
    known: Collection[str],
) -> str:
    """Return what may catch a mutant that survived, as a clause.

    `robot` is the reference's, `verdict` what ROS 2 does with the mutant, `tolerated` are the criteria that measure another value
    than on the reference, `known` the checks that exist.
    """
    used = {criterion.check.name for criterion in rubric.criteria}
    effect, check = _VERDICTS.get(verdict, ("", ""))
    if check in known and check not in used:
        return f"{effect}; try {check}"
    checks = [name for name in _checks_for(mutant.tags) if name in known]
    names = _names(mutant, robot)
    near = [found for found in rubric.criteria if found.check.name in checks and names & _measured(found)]
    others = [name for name in checks if name not in {found.check.name for found in near}][:2]
    tolerant = [found.id for found in near if found.id in tolerated]
    if tolerant:
        return f"{enumerated(tolerant, 3)} {'measures' if len(tolerant) == 1 else 'measure'} it, within the tolerance"
    attempt = f"try {enumerated(others, word='or')}" if others else "check the arguments" if near else ""
    if near:
        ids = enumerated([found.id for found in near], 3)
        return f"{ids} {'passes' if len(near) == 1 else 'pass'} nevertheless; {attempt}"
    return f"no criterion looks at it; {attempt}" if attempt else "no criterion looks at it, and no check does"


def _checks_for(tags: Sequence[str]) -> Iterator[str]:
    for rule in _RULES:
        if rule.what in tags and (not rule.inside or rule.inside in tags):
            yield from rule.checks
            return


def _measured(criterion: Criterion) -> set[str]:
    """Return the names of what a criterion measures, without the frames that it measures in."""
    return {name for key in _MEASURED for name in texts(criterion.arguments.get(key, ""))}


def _names(mutant: Mutant, robot: Robot | None) -> set[str]:
    """Return the names in the place of a mutant, with the links that a joint moves, and those that a material colours."""
    names = set(mutant.id.partition(": ")[2].partition(" -> ")[0].replace("/", " ").split())
    if robot is None:
        return names
    moved = {joint.child for joint in robot.joints if joint.name in names}
    while below := {joint.child for joint in robot.joints if joint.type == "fixed" and joint.parent in moved} - moved:
        moved |= below
    shown = {link.name for link in robot.links for visual in link.visuals if visual.material_name in names}
    return names | moved | shown
