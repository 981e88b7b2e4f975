"""What of a reference becomes a criterion of a draft, and what the handout leaves open.

These are the options of `grader rubric new`.
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

from grader.base.errors import MissingElement, NotDecided
from grader.base.grouping import StringsByName
from grader.base.names import last_part
from grader.base.text import texts_in
from grader.lab.authoring.expectations import Expectation, Omission
from grader.lab.checks.check import LINK_ARGUMENTS
from grader.ros.urdf.kinematics import Configuration
from grader.workspace.rules.rule_table import FAMILIES

# What --without takes besides the families of names: words for the checks of a draft.
_KINDS = {
    "shapes": ("shows_box", "shows_cylinder", "shows_sphere", "shows_mesh", "centre_at"),
    "colours": ("shows_colour",),
    "masses": ("mass_is",),
    "inertia": ("inertia_plausible",),
    "collision": ("collision_matches_visual", "collides_as"),
    "limits": ("joint_limits",),
    "dynamics": ("joint_dynamics",),
    "mimics": ("mimics",),
    "motion": ("kinematics_match_reference",),
    "elements": ("entry_is",),
    "rviz": ("rviz_found", "rviz_fixed_frame", "rviz_shows_robot", "rviz_display_on"),
    "nodes": (
        "node_runs",
        "starts",
        "looks_up",
        "interface_has",
        "publishes",
        "serves_action",
        "uses_parameter",
        "takes_parameters",
        "connects",
        "publishes_transform",
    ),
    "worlds": ("world_has",),
    "installs": ("build_installs", "installs_files"),
    "measures": ("parameter_is",),
}
WITHOUT = (*_KINDS, *FAMILIES)
# Without these, names cannot be compared.
_OF_NAMES = ("urdf_loads", "package_found", "setup_imports", "launch_complete", "names_agree")
# Checks of what has a name, with the arguments; launch files may have any name anyway.
_NAMED_BY = {
    "package_found": ("name",),
    "parameter_is": ("node",),
    "connects": ("from", "to"),
    "publishes_transform": ("parent", "child"),
    "looks_up": ("target", "source"),
    "publishes": ("topic",),
    "serves_action": ("action",),
    "uses_parameter": ("node",),
}
_MAX_MOVED = 20  # links that @moved:1 to @moved:20 name
_OPENED = ("publishes", "subscribes", "serves", "calls")
_ASKED = ("nodes", "not", "spawns", "active", *_OPENED)


class DraftChoice(NamedTuple):
    """What a draft has criteria about.

    The command line makes it; `draft` asks it of each expectation.

    >>> expectation = Expectation("arm", "mass_is", {"link": "arm", "mass": 2.0}, "arm mass_is")
    >>> DraftChoice(without=frozenset({"masses"})).takes(expectation)
    False
    """

    without: frozenset[str] = frozenset()  # some of `WITHOUT`
    is_names_only: bool = False
    free: frozenset[str] = frozenset()  # names that a submission may choose
    has_equal_weights: bool = False
    total: int | None = None  # points of all criteria

    def takes(self, expectation: Expectation) -> bool:
        """Return whether there is to be a criterion for an expectation."""
        if self.is_names_only and expectation.check not in _OF_NAMES:
            return False
        if expectation.check == "names_agree":
            return expectation.arguments["of"] not in self.without
        return not any(expectation.check in _KINDS.get(word, ()) for word in self.without)

    def freed(
        self, expectation: Expectation, robot: Configuration | None
    ) -> Expectation | Omission | None:
        """Return an expectation that asks for none of the free names.

        It is None if nothing is left of it, and what is omitted where no place in the tree names a
        link.
        """
        if not self.free:
            return expectation
        names = _NAMED_BY.get(expectation.check, ())
        if any(self._is_free(expectation.arguments.get(name)) for name in names):
            return None
        selectors = {}
        for link in self._free_links(expectation, robot):
            selector = _select_link(robot, link) if robot else None
            if selector is None:
                return Omission(
                    expectation.words, f"no place in the tree names the free link {link}"
                )
            selectors[link] = selector
        placed = self._without_names(_with_selectors(expectation, selectors))
        if not placed:
            return None
        carried = [
            one._replace(arguments=_by_selectors(one.arguments, selectors))
            for one in expectation.carried
        ]
        others = [_with_selectors(one, selectors) for one in expectation.otherwise]
        return placed._replace(carried=carried, otherwise=others)

    def _free_links(self, expectation: Expectation, robot: Configuration | None) -> set[str]:
        """Return the free links that an expectation, or what counts instead, names."""
        if not robot:
            return set()
        named = set()
        for arguments in (expectation.arguments, *(one.arguments for one in expectation.carried)):
            given = [value for key, value in arguments.items() if key in LINK_ARGUMENTS]
            named |= {name for name in texts_in(given) if robot.robot.has_link(name)}
        return named & self.free

    def _without_names(self, expectation: Expectation) -> Expectation | None:
        """Return an expectation without free names as values; None if it asks for nothing else."""
        arguments = dict(expectation.arguments)
        title = expectation.title
        for name in sorted(self.free) if "at" in arguments else ():
            title = title.replace(f" of {name!r}", "")
            for key in ("@name", "@reference", "joint/@name"):
                arguments["at"] = arguments["at"].replace(f"[{key}='{name}']", "")
        for key in ("values", "joints", *_ASKED):
            if key in arguments:
                arguments[key] = self._kept(arguments[key])
                if not arguments[key]:
                    del arguments[key]
        is_value_free = any(self._is_free(arguments.get(key)) for key in ("value", "has"))
        asks = {"node_runs": _ASKED, "joints_named": ("joints",)}.get(expectation.check)
        is_empty = asks is not None and not any(key in arguments for key in asks)
        if is_value_free or is_empty:
            return None
        return expectation._replace(arguments=arguments, title=title)

    def _kept(self, given: Any) -> Any:
        """Return the items of a list or table that name nothing free."""
        if isinstance(given, Mapping):
            return {
                key: value
                for key, value in given.items()
                if not self._is_free(key) and not self._is_free(value)
            }
        return [item for item in given if not self._is_free(item)]

    def _is_free(self, value: Any) -> bool:
        """Return whether a value is a free name, or a list with one.

        It also is if it ends in one, as the path of a file or the name of a topic does.
        """
        if isinstance(value, list):
            return any(map(self._is_free, value))
        if not isinstance(value, str):
            return False
        return value in self.free or last_part(value) in self.free


def _select_link(robot: Configuration, link: str) -> str | None:
    """Return the place in the tree that names a link; None if there is none."""
    for selector in ("@root", "@tip", *(f"@moved:{at}" for at in range(1, _MAX_MOVED + 1))):
        try:
            if robot.selected_name(selector) == link:
                return selector
        except (MissingElement, NotDecided):
            continue
    return None


def _with_selectors(expectation: Expectation, selectors: StringsByName) -> Expectation:
    """Return an expectation with places in the tree for the names of links."""
    title = expectation.title
    for link, selector in selectors.items():
        title = title.replace(repr(link), selector)
    return expectation._replace(
        arguments=_by_selectors(expectation.arguments, selectors), title=title
    )


def _by_selectors(arguments: Mapping[str, Any], selectors: StringsByName) -> Mapping[str, Any]:
    """Return arguments with places in the tree for the names of links."""
    placed = dict(arguments)
    for key in LINK_ARGUMENTS:
        match placed.get(key):
            case list() as names:
                placed[key] = [selectors.get(name, name) for name in names]
            case str(name):
                placed[key] = selectors.get(name, name)
    return placed
