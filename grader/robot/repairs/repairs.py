"""The edits that undo one problem of a robot, by its kind and place, the most plausible first."""

from collections.abc import Callable, Iterable, Iterator
from itertools import chain

from grader.edits import Proposal
from grader.problems import Kind, Problem
from grader.robot import catalogue
from grader.robot.repairs.connections import end_repairs, loop_repairs, root_repairs
from grader.robot.repairs.elements import (
    attribute_repairs,
    child_repairs,
    removal,
    shape_repairs,
    spelling_repairs,
    value_repairs,
)
from grader.robot.repairs.materials import colour_repairs, material_repairs
from grader.robot.repairs.names import duplicate_repairs, limit_repairs, name_repairs, type_repairs
from grader.robot.repairs.site import Robots, Site

_MAX_PROBLEMS = 30  # that are tried for one step
_MAX_PROPOSALS = 16  # of one problem

Repair = Callable[[Site], Iterable[Proposal]]


def _children(*tags: str) -> Repair:
    return lambda site: chain.from_iterable(child_repairs(site, tag) for tag in tags if _holds(site, tag))


def _holds(site: Site, tag: str) -> bool:
    return site.element.tag in {"geometry": ("visual", "collision")}.get(tag, ("inertial",))


def _removed(*tags: str) -> Repair:
    return lambda site: removal(site, tags)


def _version(site: Site) -> Iterator[Proposal]:
    yield from site.set(site.element, "version", "1.0", "the version of URDF", 'write version="1.0"')


_SHAPE = (value_repairs, attribute_repairs, shape_repairs, _children("geometry"))
_EXTRA = (value_repairs, attribute_repairs, _removed("limit", "dynamics", "mimic", "safety_controller", "calibration"))

# What undoes each kind of problem. What is not here is no mistake in the text, or one that the search for criteria undoes.
_REPAIRS: dict[Kind, tuple[Repair, ...]] = {
    catalogue.ROBOT_WITHOUT_NAME: (attribute_repairs, name_repairs),
    catalogue.BAD_VERSION: (_version,),
    catalogue.LINK_WITHOUT_NAME: (attribute_repairs, name_repairs),
    catalogue.DUPLICATE_LINK: (duplicate_repairs,),
    catalogue.DUPLICATE_JOINT: (duplicate_repairs,),
    catalogue.DUPLICATE_MATERIAL: (duplicate_repairs,),
    catalogue.JOINT_WITHOUT_NAME: (attribute_repairs, name_repairs),
    catalogue.BAD_INERTIAL: (value_repairs, attribute_repairs, _children("mass", "inertia"), _removed("inertial")),
    catalogue.BAD_VISUAL: (*_SHAPE, name_repairs, _removed("material"), _removed("visual")),
    catalogue.BAD_COLLISION: (*_SHAPE, _removed("collision")),
    catalogue.FORMAT_DIRECTIVE: (value_repairs,),
    catalogue.UNNAMED_MATERIAL: (attribute_repairs, name_repairs, _removed("material")),
    catalogue.UNDEFINED_MATERIAL: (material_repairs,),
    catalogue.BAD_COLOUR: (value_repairs,),
    catalogue.COLOUR_COUNT: (value_repairs,),
    catalogue.COLOURLESS_MATERIAL: (colour_repairs,),
    catalogue.TYPE_MISSING: (attribute_repairs, type_repairs),
    catalogue.TYPE_UNKNOWN: (type_repairs,),
    catalogue.BAD_JOINT_ORIGIN: (value_repairs,),
    catalogue.BAD_AXIS: (value_repairs,),
    catalogue.LIMIT_MISSING: (limit_repairs,),
    catalogue.BAD_LIMIT: _EXTRA,
    catalogue.BAD_DYNAMICS: _EXTRA,
    catalogue.BAD_MIMIC: _EXTRA,
    catalogue.BAD_SAFETY: _EXTRA,
    catalogue.BAD_CALIBRATION: _EXTRA,
    catalogue.NO_PARENT_OR_CHILD: (end_repairs,),
    catalogue.UNKNOWN_LINK: (end_repairs,),
    catalogue.TWO_ROOTS: (root_repairs,),
    catalogue.NO_ROOT: (loop_repairs,),
    catalogue.CYCLE: (loop_repairs,),
    catalogue.DETACHED_CYCLE: (loop_repairs,),
    catalogue.MISSPELT: (spelling_repairs,),
}
# Problems that ROS 2 does not report, but that may be the cause of others.
_CAUSES = (catalogue.MISSPELT,)


def repairable(problems: Iterable[Problem]) -> list[Problem]:
    """Return the problems that there are repairs for: first what ROS 2 ignores silently, then causes, then consequences."""
    found = [problem for problem in problems if problem.kind in _REPAIRS]
    return sorted(found, key=lambda problem: (problem.kind not in _CAUSES, problem.kind.is_consequence))[:_MAX_PROBLEMS]


def repairs_of(robots: Robots, problem: Problem) -> list[Proposal]:
    """Return the edits that may undo a problem."""
    site = robots.site(problem)
    if site is None:
        return []
    found: dict[object, Proposal] = {}
    for proposal in chain.from_iterable(repair(site) for repair in _REPAIRS[problem.kind]):
        if proposal.edits:
            found.setdefault(proposal.edits, proposal)
        if len(found) == _MAX_PROPOSALS:
            break
    return list(found.values())
