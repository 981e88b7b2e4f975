"""Grade the mutants of a rubric's reference: each must lose points, and each criterion must fail on some mutant."""

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from fnmatch import fnmatchcase
from random import Random
from typing import Literal, NamedTuple

from grader.grading.criterion import Criterion
from grader.mutation.mutants import Mutant, mutants, with_visuals
from grader.mutation.package_mutants import package_mutants
from grader.mutation.result import Loss, MutantResults, Survivor, hunk
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
    fate: Literal["caught", "same", "survived", "faulty"]
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
    fate: Literal["caught", "same", "survived", "faulty"] = "survived"
    if faults:
        fate = "faulty"
    elif any(map(trial.is_lost, results)):
        fate = "caught"
    elif trial.is_same(mutant, submission):
        fate = "same"
    failed = tuple(found.criterion.id for found in results if found.outcome.status == "failed")
    return MutantOutcome(mutant, fate, failed, faults)


class MutationTest:
    """The mutants of one reference, at most `most` of them, sampled evenly over the families."""

    def __init__(self, trial: Trial, most: int, seed: int) -> None:
        self.trial, self.seed = trial, seed
        self.all = list(mutants_of(trial))
        self.chosen = sampled(self.all, most, Random(seed))
        self.caught = self.same = 0
        self.survivors: list[Survivor] = []
        self.faults: list[Loss] = []
        self.idle = dict.fromkeys(trial.tested)

    def run(self, step: ShowStep, grade_all: GradeAll | None = None) -> MutantResults:
        """Grade the mutants and return what became of them; without `grade_all` one after the other."""
        grade_all = grade_all or self._one_by_one
        found: dict[Mutant, MutantOutcome] = {}
        for outcome in grade_all(self.chosen):
            step()
            found[outcome.mutant] = outcome
        for mutant in self.chosen:
            self._add(found[mutant])
        self._try_others(grade_all)
        return MutantResults(
            len(self.all),
            len(self.chosen),
            self.caught,
            self.same,
            tuple(found for found in self.survivors if not found.reason),
            tuple(found for found in self.survivors if found.reason),
            self._unused_patterns(),
            tuple(self.idle),
            tuple(self.faults),
        )

    def _one_by_one(self, mutants: Sequence[Mutant]) -> Iterator[MutantOutcome]:
        return (outcome_of(self.trial, mutant) for mutant in mutants)

    def _add(self, outcome: MutantOutcome) -> None:
        """Count a mutant, and keep it if it loses nothing although it is another robot, or if a check is faulty."""
        self._forget_idle(outcome)
        match outcome.fate:
            case "faulty":
                self.faults.append(Loss(outcome.mutant.id, outcome.faults, self._diff(outcome.mutant)))
            case "caught":
                self.caught += 1
            case "same":
                self.same += 1
            case "survived":
                self.survivors.append(self._survivor(outcome))

    def _forget_idle(self, outcome: MutantOutcome) -> None:
        for name in outcome.failed:
            self.idle.pop(name, None)

    def _survivor(self, outcome: MutantOutcome) -> Survivor:
        mutant = outcome.mutant
        ignored = self.trial.rubric.ignored
        reasons = (row.reason for row in ignored if any(_is_match(mutant, pattern) for pattern in row.mutants))
        return Survivor(mutant, self._diff(mutant), next(reasons, ""))

    def _diff(self, mutant: Mutant) -> str:
        if mutant.renamed:
            return f"rename {mutant.path} to {mutant.renamed}"
        if mutant.is_deleted:
            return f"delete {mutant.path}"
        text = self.trial.text(mutant.path)
        return hunk(mutant.path, text, mutant.applied(text))

    def _try_others(self, grade_all: GradeAll) -> None:
        """Find out whether mutants that were not sampled fail the criteria that no other one fails."""
        chosen = set(self.chosen)
        others = sampled([mutant for mutant in self.all if mutant not in chosen], _MAX_OTHERS, Random(self.seed))
        for start in range(0, len(others), _GROUP):
            if not self.idle:
                return
            for outcome in grade_all(others[start : start + _GROUP]):
                self._forget_idle(outcome)

    def _unused_patterns(self) -> tuple[str, ...]:
        patterns = [pattern for row in self.trial.rubric.ignored for pattern in row.mutants]
        return tuple(pattern for pattern in patterns if not any(_is_match(mutant, pattern) for mutant in self.all))


def _is_match(mutant: Mutant, pattern: str) -> bool:
    """Return whether a pattern is a mutant's id or matches it: brackets in an id are a set of characters to fnmatch."""
    return mutant.id == pattern or fnmatchcase(mutant.id, pattern)
