"""The explicit list of checks that a rubric can name. Other packages add theirs by entry points."""

from importlib import import_module
from typing import TYPE_CHECKING

from grader.base.errors import InputError, OutOfTime
from grader.base.text import enumerated
from grader.lab.checks.check import Check, describe

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint


ENTRY_POINTS = "grader.checks"

# Each is a function in a module of this package, which is imported when a rubric names the check:
# importing all of them takes as long as to grade a URDF.
CHECKS = (
    "loading.urdf_loads",
    "problem_codes.without_problems",
    "appearance.shows_box",
    "appearance.shows_cylinder",
    "appearance.shows_sphere",
    "appearance.shows_colour",
    "appearance.shows_grey",
    "appearance.shows_nothing",
    "structure.held_by",
    "structure.joints_named",
    "structure.root_of_tree",
    "structure.counts",
    "placement.frame_at",
    "placement.centre_at",
    "heights.bottom_at_height",
    "heights.bottoms_at_height",
    "contact.stands_on",
    "contact.clear_of",
    "heights.under_the_base",
    "heights.above_others",
    "motion.rolls_forward",
    "motion.axis_along",
    "motion.turns_about_itself",
    "driving.stands_level",
    "driving.drives_straight",
    "driving.turns_in_place",
    "driving.does_not_tip",
    "joints.joint_limits",
    "joints.joint_axis",
    "joints.mimics",
    "joints.joint_dynamics",
    "inertia.mass_is",
    "inertia.inertia_plausible",
    "collisions.collision_matches_visual",
    "collisions.collides_as",
    "meshes.shows_mesh",
    "reference.kinematics_match_reference",
    "entries.entry_is",
    "package_build.package_found",
    "package_build.package_type",
    "package_build.build_installs",
    "package_build.installs_files",
    "package_build.setup_imports",
    "launch.launch_found",
    "launch.node_runs",
    "commands.starts",
    "launch.launch_finds_files",
    "launch.launch_complete",
    "launched_graph.connects",
    "launched_graph.publishes_transform",
    "launched_graph.topic_has_type",
    "launched_graph.reaches",
    "simulation.world_has",
    "lookups.looks_up",
    "own_interfaces.interface_has",
    "node_code.publishes",
    "node_code.serves_action",
    "node_code.uses_parameter",
    "rviz.rviz_found",
    "rviz.rviz_fixed_frame",
    "rviz.rviz_shows_robot",
    "rviz.rviz_display_on",
    "xacro_source.xacro_uses",
    "names_agree.names_agree",
    "parameters.parameter_is",
    "set_parameters.takes_parameters",
    "recordings.recording_found",
    "recordings.recorded_topic",
    "recordings.recorded_value",
    "recorded_motion.drove",
    "recorded_motion.wheels_agree",
    "recorded_frames.recorded_frames_agree",
    "recorded_frames.recorded_tree",
    "manual.answered",
    "manual.evidence_shown",
    "manual.manual",
)

# Those that ask what connects after a launch.
GRAPH_CHECKS = frozenset({"connects", "publishes_transform", "topic_has_type", "reaches"})
# Those that read recordings.
RECORDING_CHECKS = frozenset(
    place.partition(".")[2] for place in CHECKS if place.startswith("record")
)
_PLACES = {place.partition(".")[2]: place for place in CHECKS}


def own_checks() -> list[Check]:
    """Return the checks that come with the grader, in the order of the catalogue."""
    return [_own_check(place) for place in CHECKS]


def _own_check(place: str) -> Check:
    module, _, name = place.partition(".")
    return describe(getattr(import_module(f"{__package__}.{module}"), name))


def check_names() -> list[str]:
    """Return the names of all checks.

    The grader's own come first, in the order of the catalogue, then those of other packages.
    """
    return [*_PLACES, *sorted(set(_entry_points()) - set(_PLACES))]


def unused_checks() -> list[tuple[str, str]]:
    """Return each check that the grader replaces, with its package.

    A check of another package is not used if the grader has its name.
    """
    entries = _entry_points()
    return sorted(
        (name, _name_package(entry))
        for name in set(_PLACES) & set(entries)
        for entry in entries[name]
    )


def find_check(name: str) -> Check | None:
    """Return the check of this name.

    A check of another package cannot replace one of the grader's own.

    Raises InputError for a check of another package that cannot be used, or that two packages have.
    """
    if name in _PLACES:
        return _own_check(_PLACES[name])
    entries = _entry_points().get(name, [])
    if len(entries) > 1:  # which of them is found first depends on the machine
        packages = enumerated(sorted(map(_name_package, entries)))
        raise InputError(
            f"the check {name} is in several packages, {packages}: uninstall all but one"
        )
    return _load_plugin(name, entries[0]) if entries else None


def usable_check(name: str) -> Check | None:
    """Return the check of this name.

    It is None for one that cannot be used: a rubric that names it is refused.
    """
    try:
        return find_check(name)
    except InputError:
        return None


def _load_plugin(name: str, entry: "EntryPoint") -> Check:
    distribution = _name_package(entry)
    try:
        return describe(entry.load(), distribution)._replace(name=name)
    except (KeyboardInterrupt, OutOfTime):
        raise
    except BaseException as error:  # noqa: BLE001  a fault of another package, which may even exit
        reason = str(error) if isinstance(error, InputError) else f"{type(error).__name__}: {error}"
        source = f"{distribution} ({entry.value.replace(':', '.')})"
        raise InputError(
            f"the check {name} of the package {source} cannot be used: {reason}"
        ) from None


def _name_package(entry: "EntryPoint") -> str:
    if entry.dist is not None:
        return entry.dist.name
    return entry.value.partition(":")[0]


def _entry_points() -> dict[str, list["EntryPoint"]]:
    from importlib.metadata import (
        entry_points,
    )  # reading the metadata of all packages takes longer than grading

    entries: dict[str, list[EntryPoint]] = {}
    for entry in entry_points(group=ENTRY_POINTS):
        entries.setdefault(entry.name, []).append(entry)
    return entries
