"""The result of testing a rubric, with the diff of each change."""

from collections.abc import Mapping
from decimal import Decimal
from difflib import unified_diff
from typing import NamedTuple

from grader.grading.report import Report
from grader.mutation.mutants import Mutant

_CONTEXT = 2  # lines around a change


def diff(path: str, before: str, after: str) -> str:
    """Return the unified diff of two texts of a file, without a line break at its end."""
    return "\n".join(unified_diff(before.splitlines(), after.splitlines(), path, path, n=_CONTEXT, lineterm=""))


class Loss(NamedTuple):
    """A submission with criteria that are not what they must be, each with its message."""

    name: str
    criteria: Mapping[str, str]
    diff: str = ""


class Survivor(NamedTuple):
    """A mutant that loses nothing: its diff, and why the rubric ignores it."""

    mutant: Mutant
    diff: str
    reason: str = ""


class MutantResults(NamedTuple):
    """What became of the mutants: `total` exist, `tried` were graded, `same` of these turned out to be the same robot.

    `survivors` lose nothing, and the rubric does not ignore them as it does those in `ignored`. `unused` are patterns
    of the rubric that match no mutant, `idle` criteria that no mutant fails, `faults` mutants on which a check is
    faulty.
    """

    total: int
    tried: int
    caught: int
    same: int
    survivors: tuple[Survivor, ...]
    ignored: tuple[Survivor, ...]
    unused: tuple[str, ...]
    idle: tuple[str, ...]
    faults: tuple[Loss, ...] = ()

    @property
    def score(self) -> Decimal:
        """The mutation score: the share of the mutants that lose points, in percent, without those that are ignored."""
        count = self.caught + len(self.survivors)
        return Decimal(100 * self.caught) / count if count else Decimal(100)


class EquivalentResults(NamedTuple):
    """Rewritings of the reference: how many were graded, by family, which lose points, and why a family is unused."""

    tried: Mapping[str, int]
    unused: Mapping[str, str]
    losses: tuple[Loss, ...] = ()


class SampleResults(NamedTuple):
    """How many samples were graded, how many belong to another rubric, and what differs from their expected.toml."""

    tried: int
    skipped: int
    different: tuple[Loss, ...] = ()


class RubricTest(NamedTuple):
    """The result for a rubric; `samples` is None where no folder was given."""

    reference: Report
    seed: int
    mutants: MutantResults
    equivalents: EquivalentResults
    samples: SampleResults | None = None

    @property
    def lost(self) -> tuple[str, ...]:
        """The criteria that the reference does not pass, without extra credit and those for manual grading."""
        return tuple(found.criterion.id for found in self.reference.unearned)

    @property
    def is_faulty(self) -> bool:
        """Return whether a check failed to give an outcome, on the reference or a mutant."""
        return bool(self.mutants.faults) or self.reference.fault != ""

    @property
    def is_sound(self) -> bool:
        """Return whether no correct robot loses anything, and each sample what it should."""
        return not (self.lost or self.equivalents.losses or (self.samples is not None and self.samples.different))
