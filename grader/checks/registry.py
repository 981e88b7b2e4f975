"""The explicit list of checks that a rubric can name. Other packages add theirs by entry points."""

import inspect
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from importlib import import_module
from itertools import takewhile
from typing import TYPE_CHECKING, Any, Literal, get_args, get_type_hints

from grader.checks.about import About
from grader.checks.outcome import Outcome
from grader.checks.toml_types import TomlType, toml_type
from grader.errors import InputError, OutOfTime
from grader.text import enumerated

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

    from grader.checks.docstring import Documentation

ENTRY_POINTS = "grader.checks"

# Each is a function in a module of this package, which is imported when a rubric names the check: importing all of them
# takes as long as to grade a URDF.
CHECKS = (
    "tree.urdf_loads",
    "problems.without_problems",
    "appearance.shows_box",
    "appearance.shows_cylinder",
    "appearance.shows_sphere",
    "appearance.shows_colour",
    "appearance.shows_grey",
    "appearance.shows_nothing",
    "tree.held_by",
    "tree.joints_named",
    "tree.root_of_tree",
    "tree.counts",
    "placement.frame_at",
    "placement.centre_at",
    "heights.bottom_at_height",
    "heights.bottoms_at_height",
    "contact.stands_on",
    "contact.clear_of",
    "heights.under_the_base",
    "motion.rolls_forward",
    "motion.axis_along",
    "motion.turns_about_itself",
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
    "elements.element_present",
    "package.package_found",
    "package.package_type",
    "package.build_installs",
    "package.installs_files",
    "package.setup_imports",
    "launch.launch_found",
    "launch.launch_starts",
    "launch.launch_finds_files",
    "rviz.rviz_found",
    "rviz.rviz_fixed_frame",
    "rviz.rviz_shows_robot",
    "rviz.rviz_display_on",
    "xacro_source.xacro_uses",
    "manual.answered",
    "manual.evidence_shown",
)

_PLACES = {place.partition(".")[2]: place for place in CHECKS}

# The arguments of checks that name links, or list their names.
LINK_ARGUMENTS = ("link", "leader", "relative_to", "parent", "holds", "on", "of", "base", "links", "wheels")

Subject = Literal["urdf", "robot", "package", "submission", "reference"]
SUBJECTS: tuple[Subject, ...] = get_args(Subject)


@dataclass(frozen=True, slots=True)
class Parameter:
    """One argument of a check: its annotation, and its default if it has one."""

    name: str
    annotation: Any
    required: bool
    default: object = None

    @property
    def type(self) -> TomlType:
        """The type of the TOML value that a rubric gives."""
        return toml_type(self.annotation)


@dataclass(frozen=True, slots=True)
class Check:
    """A check, as a rubric names it.

    `examined` are the objects that it gets, the main one first: the URDF as it was read, its robot, the package, the
    whole submission, or the robot of the reference solution. `distribution` is the installed package that the check
    comes from; empty for the grader's own. `about` is what its module declares of it.
    """

    name: str
    function: Callable[..., Outcome]
    examined: tuple[Subject, ...]
    parameters: Mapping[str, Parameter]
    distribution: str = ""
    about: About = field(default_factory=About)

    @property
    def subject(self) -> Subject:
        """The main object that it examines."""
        return self.examined[0]

    @property
    def documentation(self) -> "Documentation":
        """What its docstring says. The fact is true of a submission that passes."""
        from grader.checks.docstring import documentation  # late: grading does not read it

        return documentation(self.function)


def describe(function: Callable[..., Outcome], distribution: str = "") -> Check:
    """Return the check that a function is: its signature is the schema of the rubric's `with` table.

    Raises InputError for a signature that is no schema.
    """
    hints = get_type_hints(function, include_extras=True)
    subject, *rest = inspect.signature(function).parameters.values()
    for parameter in (subject, *rest):
        if parameter.kind not in (parameter.KEYWORD_ONLY, parameter.POSITIONAL_OR_KEYWORD):
            raise InputError(f"its argument {parameter} cannot be given by name")
        if parameter.name not in hints:
            raise InputError(f"its argument {parameter.name} has no annotation")
    also = list(takewhile(_is_subject, rest))
    parameters = {}
    for name, default in ((parameter.name, parameter.default) for parameter in rest[len(also) :]):
        is_required = default is inspect.Parameter.empty
        parameters[name] = Parameter(name, hints[name], is_required, None if is_required else default)
    main = subject.name if subject.name in SUBJECTS else "robot"
    examined = tuple(
        name for given in (main, *(parameter.name for parameter in also)) for name in SUBJECTS if name == given
    )
    name = function.__name__
    about = getattr(sys.modules.get(function.__module__), "ABOUT", {}).get(name, About())
    if not isinstance(about, About):
        raise InputError(f"ABOUT says of {name} what is no About(...)")
    return Check(name, function, examined, parameters, distribution, about)


def _is_subject(parameter: inspect.Parameter) -> bool:
    """Return whether a parameter after the first is another object that is examined: it is no keyword-only argument."""
    return parameter.kind is parameter.POSITIONAL_OR_KEYWORD and parameter.name in SUBJECTS


def own_checks() -> list[Check]:
    """Return the checks that come with the grader, in the order of the catalogue."""
    return [_own(place) for place in CHECKS]


def _own(place: str) -> Check:
    module, _, name = place.partition(".")
    return describe(getattr(import_module(f"{__package__}.{module}"), name))


def check_names() -> list[str]:
    """Return the names of all checks: the grader's own in the order of the catalogue, then those of other packages."""
    return [*_PLACES, *sorted(set(_entry_points()) - set(_PLACES))]


def unused_checks() -> list[tuple[str, str]]:
    """Return each check of another package that is not used because the grader has its name, with that package."""
    entries = _entry_points()
    return sorted((name, _package_of(entry)) for name in set(_PLACES) & set(entries) for entry in entries[name])


def find_check(name: str) -> Check | None:
    """Return the check of this name; a check of another package cannot replace one of the grader's own.

    Raises InputError for a check of another package that cannot be used, or that two packages have.
    """
    if name in _PLACES:
        return _own(_PLACES[name])
    entries = _entry_points().get(name, [])
    if len(entries) > 1:  # which of them is found first depends on the machine
        packages = enumerated(sorted(map(_package_of, entries)))
        raise InputError(f"the check {name} is in several packages, {packages}: uninstall all but one")
    return _load(name, entries[0]) if entries else None


def usable_check(name: str) -> Check | None:
    """Return the check of this name; None for one that cannot be used: a rubric that names it is refused."""
    try:
        return find_check(name)
    except InputError:
        return None


def declared(place: str) -> Callable[..., Any]:
    """Return the function that a check declares, as "module:function"."""
    module, _, name = place.partition(":")
    function: Callable[..., Any] = getattr(import_module(module), name)
    return function


def _load(name: str, entry: "EntryPoint") -> Check:
    distribution = _package_of(entry)
    try:
        return replace(describe(entry.load(), distribution), name=name)
    except (KeyboardInterrupt, OutOfTime):
        raise
    except BaseException as error:  # noqa: BLE001  a fault of another package, which may even exit
        reason = str(error) if isinstance(error, InputError) else f"{type(error).__name__}: {error}"
        source = f"{distribution} ({entry.value.replace(':', '.')})"
        raise InputError(f"the check {name} of the package {source} cannot be used: {reason}") from None


def _package_of(entry: "EntryPoint") -> str:
    return entry.dist.name if entry.dist is not None else entry.value.partition(":")[0]


def _entry_points() -> dict[str, list["EntryPoint"]]:
    from importlib.metadata import entry_points  # reading the metadata of all packages takes longer than grading

    found: dict[str, list[EntryPoint]] = {}
    for entry in entry_points(group=ENTRY_POINTS):
        found.setdefault(entry.name, []).append(entry)
    return found
