"""Test a rubric on its own reference solution, whose equivalents must lose nothing."""

from collections import Counter
from collections.abc import Callable, Collection, Sequence
from functools import lru_cache
from itertools import count
from pathlib import Path

from grader.errors import InputError
from grader.grading.deciding import decide
from grader.grading.grade import grade
from grader.grading.rubric import Rubric, read_rubric
from grader.mutation.equivalents import FAMILIES, Equivalent, breaking, equivalents
from grader.mutation.mutants import Mutant
from grader.mutation.mutation_test import GradeAll, MutantOutcome, mutant_results, mutants_of, outcome_of
from grader.mutation.result import EquivalentResults, Loss, RubricTest, diff
from grader.mutation.samples import Sample, tested_samples
from grader.mutation.trial import Trial
from grader.submission.editing import with_urdf
from grader.submission.opening import read_submission
from grader.submission.submission import Submission
from grader.submission.urdf import Read


def tested_equivalents(trial: Trial, seed: int) -> EquivalentResults:
    """Return which rewritings of the reference lose points."""
    urdf = trial.reference.urdf
    if not isinstance(urdf, Read) or urdf.loaded.verdict != "clean" or urdf.reading.root is None:
        return EquivalentResults({}, dict.fromkeys(FAMILIES, "ROS 2 does not load the reference without problems"))
    assert urdf.reading.robot is not None
    tried: Counter[str] = Counter()
    losses: list[Loss] = []
    for equivalent in equivalents(trial.rubric, urdf.reading.root, urdf.reading.robot, trial.kept, seed):
        tried[equivalent.family] += 1
        submission = _submission(trial.reference, urdf, equivalent)
        results = decide(trial.rubric, submission, _criteria_to_pass(trial, submission, equivalent))
        lost = {result.criterion.id: result.outcome.message for result in results if trial.is_lost(result)}
        if lost:
            losses.append(Loss(equivalent.name, lost, diff(urdf.path, equivalent.before, equivalent.text)))
    unused = {name: "there is nothing to change" for name in FAMILIES if name not in tried}
    return EquivalentResults(dict(tried), unused, tuple(losses))


def _submission(reference: Submission, urdf: Read, equivalent: Equivalent) -> Submission:
    """Return the reference with another text of its robot; a URDF that becomes xacro is graded on its own."""
    data = equivalent.text.encode()
    if not equivalent.is_xacro or (urdf.is_expanded and urdf.as_it_stands is None):
        return with_urdf(reference, {urdf.path: data})
    name = urdf.path.rpartition("/")[2]
    return read_submission(data, identity=reference.id, path=f"{name.removesuffix('.xacro')}.xacro")


def _criteria_to_pass(trial: Trial, submission: Submission, equivalent: Equivalent) -> Collection[str]:
    """Return the criteria on the robot that must still pass; for a URDF on its own, those that need nothing else."""
    criteria = (trial.expected[name].criterion for name in trial.tested)
    others = ("package", "submission") if submission.is_single else ("package",)
    return [it.id for it in criteria if it.check.subject not in others and not breaking(it, equivalent.families)]


Progress = Callable[[int, int], None]  # how many submissions of how many are graded


def run_rubric_test(
    rubric: Rubric, samples: list[Sample] | None, seed: int, most: int, progress: Progress, grade_all: GradeAll
) -> RubricTest:
    """Return the test of a rubric. Raises InputError without a readable reference, RubricError for wrong samples.

    `grade_all` grades mutants elsewhere, as `mutant_outcomes` does.
    """
    trial = _trial_of(rubric)
    every = [*mutants_of(trial)]
    total = min(most, len(every)) + len(samples or ())
    counter = count(1)

    def step() -> None:
        progress(next(counter), total)

    of_samples = tested_samples(rubric, samples, step) if samples is not None else None
    mutants = mutant_results(trial, every, most, seed, grade_all, step)
    return RubricTest(trial.report, seed, mutants, tested_equivalents(trial, seed), of_samples)


def mutant_outcomes(data: bytes, path: str, mutants: Sequence[Mutant]) -> list[MutantOutcome]:
    """Grade mutants of the reference of the rubric in a file."""
    trial = _trial_from(data, path)
    return [outcome_of(trial, mutant) for mutant in mutants]


@lru_cache(maxsize=1)
def _trial_from(data: bytes, path: str) -> Trial:
    return _trial_of(read_rubric(data, Path(path)))


def _trial_of(rubric: Rubric) -> Trial:
    if rubric.solution is None:
        raise InputError(f'the rubric {rubric.id} has no reference: add reference = "FOLDER" with a correct solution')
    reference = rubric.solution.submission
    return Trial(grade(rubric, reference), reference)
