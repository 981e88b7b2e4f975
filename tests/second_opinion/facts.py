"""The facts that the geometric checks of a rubric ask about, decided a second time from docs/checks.md."""

from tests.second_opinion import body_facts, motion_facts, place_facts, tree_facts

_NAMES = (
    "urdf_loads shows_box shows_cylinder shows_sphere shows_colour shows_grey shows_nothing held_by joints_named root_of_tree counts "
    "frame_at centre_at bottom_at_height bottoms_at_height stands_on clear_of under_the_base rolls_forward axis_along turns_about_itself "
    "joint_limits joint_axis kinematics_match_reference mass_is inertia_plausible collision_matches_visual"
)
_MODULES = (tree_facts, body_facts, place_facts, motion_facts)
FACTS = {
    name: next(getattr(module, name) for module in _MODULES if hasattr(module, name))
    for name in _NAMES.split()
}
