"""Which check to try for a mutant that survived: one that looks at what it changes."""

from collections.abc import Collection, Iterable, Sequence

from grader.checks.check import Check
from grader.grading.criterion import Criterion
from grader.grading.rubric import Rubric
from grader.mutation.mutants import Mutant
from grader.mutation.trial import texts
from grader.robot.model import Robot
from grader.text import enumerated

# What ROS 2 does with a mutant, and the check that looks at that.
_VERDICTS = {
    "rejected": ("ROS 2 rejects it, and no criterion says so", "urdf_loads"),
    "degraded": ("ROS 2 drops content of it, and no criterion says so", "without_problems"),
}
_MEASURED = ("link", "links", "joints", "leader", "name", "file", "files")


def suggestion(
    mutant: Mutant,
    rubric: Rubric,
    robot: Robot | None,
    verdict: str,
    tolerated: Collection[str],
    known: Sequence[Check],
) -> str:
    """Return what may catch a mutant that survived, as a clause.

    `robot` is the reference's, `verdict` what ROS 2 does with the mutant, `tolerated` are the criteria that measure
    another value than on the reference, `known` the checks that exist, which declare what they look at.
    """
    used = {criterion.check.name for criterion in rubric.criteria}
    effect, check = _VERDICTS.get(verdict, ("", ""))
    if check in (it.name for it in known) and check not in used:
        return f"{effect}; try {check}"
    checks = _checks_for(mutant.tags, known)
    names = _names(mutant, robot)
    near = [found for found in rubric.criteria if found.check.name in checks and names & _measures(found)]
    others = [name for name in checks if name not in {found.check.name for found in near}][:2]
    tolerant = [found.id for found in near if found.id in tolerated]
    if tolerant:
        return f"{_list(tolerant, 'measure')} it, within the tolerance"
    attempt = f"; try {enumerated(others, word='or')}" if others else "; check the arguments" if near else ""
    if near:
        return f"{_list([found.id for found in near], 'pass')} nevertheless{attempt}"
    return f"no criterion looks at it{attempt or ', and no check does'}"


def _list(ids: Sequence[str], verb: str) -> str:
    """Return the first criteria with a verb."""
    ending = "" if len(ids) > 1 else "es" if verb.endswith("s") else "s"
    return f"{enumerated(ids, 3)} {verb}{ending}"


def _checks_for(tags: Sequence[str], known: Iterable[Check]) -> list[str]:
    """Return the checks that look at what changed: at the innermost of the tags around it that any check looks at."""
    depths = {check.name: max((_depth(place, tags) for place in check.about.looks_at), default=0) for check in known}
    deepest = max(depths.values(), default=0)
    return [name for name, depth in depths.items() if depth == deepest > 0]


def _depth(place: str, tags: Sequence[str]) -> int:
    """Return how deep a place such as `limit`, `visual/origin` or `joint@type` is in the tags, from 1; else 0."""
    names = place.replace("@", "/@").split("/")
    return tags.index(names[-1]) + 1 if all(name in tags for name in names) else 0


def _measures(criterion: Criterion) -> set[str]:
    """Return the names of what a criterion measures, without the frames that it measures in."""
    return {name for key in _MEASURED for name in texts(criterion.arguments.get(key, ""))}


def _names(mutant: Mutant, robot: Robot | None) -> set[str]:
    """Return the names in the place of a mutant, with the links that its joints move and its materials colour."""
    names = set(mutant.id.partition(": ")[2].partition(" -> ")[0].replace("/", " ").split())
    if robot is None:
        return names
    moved = {joint.child for joint in robot.joints if joint.name in names}
    while below := {joint.child for joint in robot.joints if joint.type == "fixed" and joint.parent in moved} - moved:
        moved |= below
    shown = {link.name for link in robot.links for visual in link.visuals if visual.material_name in names}
    return names | moved | shown
