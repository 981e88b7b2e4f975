"""The mutants of a reference: those that a criterion may look at, and a sample of them."""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from random import Random

from grader.grading.criterion import Criterion
from grader.mutation.mutants import Mutant, mutants, with_visuals
from grader.mutation.package_mutants import package_mutants
from grader.mutation.trial import Trial
from grader.package.package import MANIFEST
from grader.submission.urdf import Read

_MESHES = (".stl", ".dae", ".obj")


def mutants_of(trial: Trial) -> Iterator[Mutant]:
    """Yield the mutants of the robot, and those of the package that a criterion may look at."""
    criteria = [trial.expected[name].criterion for name in trial.tested]
    hidden = [found.arguments.get("link", "") for found in criteria if found.check.name == "shows_nothing"]
    for path in trial.robot_files:
        yield from mutants(trial.text(path), path)
        yield from with_visuals(trial.text(path), path, hidden)
    package, urdf = trial.reference.package, trial.reference.urdf
    if package is not None:
        robot = urdf.reading.robot if isinstance(urdf, Read) else None
        links = [link.name for link in robot.links] if robot is not None else []
        found = package_mutants(package, links, trial.text)
        yield from (mutant for mutant in found if _is_looked_at(mutant, criteria))


def _is_looked_at(mutant: Mutant, criteria: Iterable[Criterion]) -> bool:
    """Return whether a criterion may look at what a mutant of a package changes: some look at its name or at meshes only."""
    subjects = {criterion.check.subject for criterion in criteria}
    if "package" in subjects:
        return True
    if mutant.path.lower().endswith(_MESHES):
        return any(criterion.check.name == "shows_mesh" for criterion in criteria)
    return "submission" in subjects and mutant.path.endswith(MANIFEST)


def sampled(every: Sequence[Mutant], most: int, random: Random) -> list[Mutant]:
    """Return at most so many mutants, in their order: of each family the same number, as far as it has as many."""
    families: dict[str, list[int]] = defaultdict(list)
    for index, mutant in enumerate(every):
        families[mutant.family].append(index)
    chosen: list[int] = []
    for number, name in enumerate(sorted(families, key=lambda name: (len(families[name]), name))):
        share = -(-(most - len(chosen)) // (len(families) - number))
        indexes = families[name]
        chosen += random.sample(indexes, min(share, len(indexes), most - len(chosen)))
    return [every[index] for index in sorted(chosen)]
