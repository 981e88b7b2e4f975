"""Grade the mutants of a rubric's reference: each must lose points, and each criterion must fail on some mutant."""

from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from fnmatch import fnmatchcase
from random import Random
from typing import NamedTuple

from grader.grading.criterion import Criterion
from grader.mutation.mutants import Mutant, mutants
from grader.mutation.package_mutants import package_mutants
from grader.mutation.result import Loss, MutantResults, Survivor, diff
from grader.mutation.trial import Trial
from grader.package.package import MANIFEST
from grader.submission.urdf import Read

_MESHES = (".stl", ".dae", ".obj")


def mutants_of(trial: Trial) -> Iterator[Mutant]:
    """Yield the mutants of the robot, and those of the package that a criterion may look at."""
    criteria = [trial.expected[name].criterion for name in trial.tested]
    hidden = [found.arguments.get("link", "") for found in criteria if found.check.name == "shows_nothing"]
    for path in trial.robot_files:
        yield from mutants(trial.text(path), path, hidden)
    package, urdf = trial.reference.package, trial.reference.urdf
    if package is not None:
        robot = urdf.reading.robot if isinstance(urdf, Read) else None
        links = [link.name for link in robot.links] if robot is not None else []
        found = package_mutants(package, links, trial.text)
        yield from (mutant for mutant in found if _is_looked_at(mutant, criteria))


def _is_looked_at(mutant: Mutant, criteria: Iterable[Criterion]) -> bool:
    """Return whether a criterion may look at a mutant of a package: some look at its name or at meshes only."""
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


_MAX_OTHERS = 500  # mutants that are tried only to find out whether a criterion is idle
_GROUP = 50  # of these, after which the search may end
ShowStep = Callable[[], None]  # shows that one more mutant is graded


class MutantOutcome(NamedTuple):
    """What the criteria made of a mutant: those that fail, and the faulty ones."""

    mutant: Mutant
    fate: str  # caught, same, survived or faulty
    failed: tuple[str, ...] = ()
    faults: Mapping[str, str] = {}


GradeAll = Callable[[Sequence[Mutant]], Iterable[MutantOutcome]]  # in any order


def outcome_of(trial: Trial, mutant: Mutant) -> MutantOutcome:
    """Grade a mutant."""
    submission = trial.submission(mutant)
    if submission is None:
        return MutantOutcome(mutant, "caught")
    results = list(trial.results(mutant, submission, trial.expected))
    faults = {found.criterion.id: found.outcome.message for found in results if found.outcome.status == "errored"}
    is_lost = any(map(trial.is_lost, results))
    fate = "faulty" if faults else "caught" if is_lost else "same" if trial.is_same(mutant, submission) else "survived"
    failed = tuple(found.criterion.id for found in results if found.outcome.status == "failed")
    return MutantOutcome(mutant, fate, failed, faults)


def mutant_results(
    trial: Trial,
    every: Sequence[Mutant],
    most: int,
    seed: int,
    grade_all: GradeAll,
    step: ShowStep = lambda: None,
    others: int = _MAX_OTHERS,
) -> MutantResults:
    """Grade at most `most` of the mutants, and more of them only to find out which criteria are idle."""
    chosen = sampled(every, most, Random(seed))
    found: dict[Mutant, MutantOutcome] = {}
    for outcome in grade_all(chosen):
        step()
        found[outcome.mutant] = outcome
    outcomes = [found[mutant] for mutant in chosen]
    fates = Counter(outcome.fate for outcome in outcomes)
    survivors = [_survivor(trial, outcome.mutant) for outcome in outcomes if outcome.fate == "survived"]
    faulty = [outcome for outcome in outcomes if outcome.fate == "faulty"]
    patterns = [pattern for row in trial.rubric.ignored for pattern in row.mutants]
    left = sampled([mutant for mutant in every if mutant not in found], others, Random(seed))
    return MutantResults(
        len(every),
        len(chosen),
        fates["caught"],
        fates["same"],
        tuple(it for it in survivors if not it.reason),
        tuple(it for it in survivors if it.reason),
        tuple(it for it in patterns if not any(_is_match(mutant, it) for mutant in every)),
        _idle(trial, outcomes, left, grade_all),
        tuple(Loss(it.mutant.id, it.faults, _diff(trial, it.mutant)) for it in faulty),
    )


def _idle(
    trial: Trial, outcomes: Iterable[MutantOutcome], others: Sequence[Mutant], grade_all: GradeAll
) -> tuple[str, ...]:
    """Return the criteria that no mutant fails; others are graded only until there are none of these."""
    failed = {name for outcome in outcomes for name in outcome.failed}
    for start in range(0, len(others), _GROUP):
        if failed.issuperset(trial.tested):
            break
        failed |= {name for outcome in grade_all(others[start : start + _GROUP]) for name in outcome.failed}
    return tuple(name for name in trial.tested if name not in failed)


def _survivor(trial: Trial, mutant: Mutant) -> Survivor:
    """Return a mutant that loses nothing, with the reason for which the rubric ignores it."""
    ignored = trial.rubric.ignored
    reasons = (row.reason for row in ignored if any(_is_match(mutant, pattern) for pattern in row.mutants))
    return Survivor(mutant, _diff(trial, mutant), next(reasons, ""))


def _diff(trial: Trial, mutant: Mutant) -> str:
    if mutant.renamed:
        return f"rename {mutant.path} to {mutant.renamed}"
    if mutant.is_deleted:
        return f"delete {mutant.path}"
    text = trial.text(mutant.path)
    return diff(mutant.path, text, mutant.applied(text))


def _is_match(mutant: Mutant, pattern: str) -> bool:
    """Return whether a pattern is a mutant's id or matches it: brackets in an id are a set of characters to fnmatch."""
    return mutant.id == pattern or fnmatchcase(mutant.id, pattern)
