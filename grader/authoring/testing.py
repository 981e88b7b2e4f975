"""Test a rubric: mutants of its reference must lose points, equivalents nothing, samples what they declare."""

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from decimal import Decimal
from difflib import unified_diff
from fnmatch import fnmatchcase
from functools import lru_cache
from pathlib import Path
from random import Random
from typing import NamedTuple

from grader.authoring.mutants import Mutant
from grader.authoring.samples import Loss, Sample, SampleResults, tested_samples
from grader.authoring.trial import MutantOutcome, Trial
from grader.grading.report import Report
from grader.grading.rubric import Rubric, read_rubric

_MAX_MUTANTS = 5000  # of larger robots a sample is graded
_CONTEXT = 2  # lines around a change

GradeAll = Callable[[Sequence[Mutant]], Iterable[MutantOutcome]]  # in any order
Progress = Callable[[int, int], None]  # how many submissions of how many are graded


class Survivor(NamedTuple):
    """A mutant that loses nothing: its diff, and why the rubric ignores it."""

    mutant: Mutant
    diff: str
    reason: str = ""


class RubricTest(NamedTuple):
    """The result for a rubric.

    `total` mutants exist, and `tried` were graded: `caught` lose points, `same` are the same robot, `survivors` lose
    nothing, nor do those that the rubric ignores (`ignored`), and on `faults` a check is faulty. `unused` are patterns
    of the rubric that match no mutant, `idle` criteria that no mutant fails. `equivalents` are the families that were
    tried, `losses` those that lose points. `samples` is None where no folder was given.
    """

    reference: Report
    total: int
    tried: int
    caught: int
    same: int
    survivors: tuple[Survivor, ...]
    ignored: tuple[Survivor, ...]
    unused: tuple[str, ...]
    idle: tuple[str, ...]
    faults: tuple[Loss, ...]
    equivalents: tuple[str, ...]
    losses: tuple[Loss, ...]
    samples: SampleResults | None = None

    @property
    def score(self) -> Decimal:
        """The mutation score: the share of the mutants that lose points, in percent, without those that are ignored."""
        count = self.caught + len(self.survivors)
        return Decimal(100 * self.caught) / count if count else Decimal(100)

    @property
    def lost(self) -> tuple[str, ...]:
        """The criteria that the reference does not pass, without extra credit and those for manual grading."""
        return tuple(found.criterion.id for found in self.reference.unearned)

    @property
    def is_faulty(self) -> bool:
        """Return whether a check failed to give an outcome, on the reference or a mutant."""
        return bool(self.faults) or self.reference.fault != ""

    @property
    def is_sound(self) -> bool:
        """Return whether no correct robot loses anything, and each sample what it should."""
        return not (self.lost or self.losses or (self.samples is not None and self.samples.different))


def run_rubric_test(
    rubric: Rubric, samples: list[Sample] | None, progress: Progress, grade_all: GradeAll
) -> RubricTest:
    """Return the test of a rubric. Raises InputError without a readable reference, RubricError for wrong samples.

    `grade_all` grades mutants elsewhere, as `mutant_outcomes` does.
    """
    trial = Trial(rubric)
    every = [*trial.mutants()]
    chosen = every if len(every) <= _MAX_MUTANTS else Random(0).sample(every, _MAX_MUTANTS)
    total = len(chosen) + len(samples or ())
    of_samples = tested_samples(rubric, samples, lambda done: progress(done, total)) if samples is not None else None
    outcomes = []
    for outcome in grade_all(chosen):
        outcomes.append(outcome)
        progress(len(samples or ()) + len(outcomes), total)
    return _result(trial, every, outcomes, of_samples)


def mutant_outcomes(data: bytes, path: str, mutants: Sequence[Mutant]) -> list[MutantOutcome]:
    """Grade mutants of the reference of the rubric in a file."""
    return [*map(_trial_from(data, path).outcome, mutants)]


@lru_cache(maxsize=1)
def _trial_from(data: bytes, path: str) -> Trial:
    return Trial(read_rubric(data, Path(path)))


def _result(
    trial: Trial, every: Sequence[Mutant], outcomes: Iterable[MutantOutcome], samples: SampleResults | None
) -> RubricTest:
    """Return the result of a test: `outcomes` are those of the mutants that were graded, in any order."""
    places = {mutant: place for place, mutant in enumerate(every)}
    graded = sorted(outcomes, key=lambda outcome: places[outcome.mutant])
    fates = Counter(outcome.fate for outcome in graded)
    survivors = [_survivor(trial, outcome.mutant) for outcome in graded if outcome.fate == "survived"]
    failed = {name for outcome in graded for name in outcome.failed}
    patterns = [pattern for row in trial.rubric.ignored for pattern in row.mutants]
    tried = [*trial.equivalents()]
    return RubricTest(
        reference=trial.report,
        total=len(every),
        tried=len(graded),
        caught=fates["caught"],
        same=fates["same"],
        survivors=tuple(it for it in survivors if not it.reason),
        ignored=tuple(it for it in survivors if it.reason),
        unused=tuple(it for it in patterns if not any(_is_match(mutant, it) for mutant in every)),
        idle=tuple(one.id for one in trial.tested if one.id not in failed),
        faults=tuple(Loss(it.mutant.id, it.faults, _diff(trial, it.mutant)) for it in graded if it.fate == "faulty"),
        equivalents=tuple(it.family for it, _ in tried),
        losses=tuple(
            Loss(it.family, lost, diff(trial.robot_files[0], it.before, it.text)) for it, lost in tried if lost
        ),
        samples=samples,
    )


def _survivor(trial: Trial, mutant: Mutant) -> Survivor:
    """Return a mutant that loses nothing, with the reason for which the rubric ignores it."""
    ignored = trial.rubric.ignored
    reasons = (row.reason for row in ignored if any(_is_match(mutant, pattern) for pattern in row.mutants))
    return Survivor(mutant, _diff(trial, mutant), next(reasons, ""))


def _diff(trial: Trial, mutant: Mutant) -> str:
    if mutant.is_deleted:
        return f"rename {mutant.path} to {mutant.renamed}" if mutant.renamed else f"delete {mutant.path}"
    text = trial.text(mutant.path)
    return diff(mutant.path, text, mutant.applied(text))


def diff(path: str, before: str, after: str) -> str:
    """Return the unified diff of two texts of a file, without a line break at its end."""
    return "\n".join(unified_diff(before.splitlines(), after.splitlines(), path, path, n=_CONTEXT, lineterm=""))


def _is_match(mutant: Mutant, pattern: str) -> bool:
    """Return whether a pattern is a mutant's id or matches it: brackets in an id are a set of characters to fnmatch."""
    return mutant.id == pattern or fnmatchcase(mutant.id, pattern)
