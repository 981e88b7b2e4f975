"""Test a rubric on its own reference solution."""

from collections.abc import Callable
from itertools import count

from grader.errors import InputError
from grader.grading.grade import grade
from grader.grading.rubric import Rubric
from grader.mutation.equivalent_test import tested_equivalents
from grader.mutation.mutation_test import MutationTest
from grader.mutation.result import RubricTest
from grader.mutation.samples import Sample, tested_samples
from grader.mutation.trial import Trial

MAX_MUTANTS = 500  # by default
Progress = Callable[[int, int], None]  # how many submissions of how many are graded


def tested(rubric: Rubric, samples: list[Sample] | None, *, seed: int, most: int, progress: Progress) -> RubricTest:
    """Return what a test of a rubric finds. Raises InputError without a reference that can be read, RubricError for wrong samples."""
    if rubric.solution is None:
        raise InputError(f'the rubric {rubric.id} has no reference: add reference = "FOLDER" with a correct solution')
    reference = rubric.solution.submission
    report = grade(rubric, reference)
    trial = Trial(report, reference)
    mutation = MutationTest(trial, most, seed)
    total = len(mutation.chosen) + len(samples or ())
    counter = count(1)

    def step() -> None:
        progress(next(counter), total)

    of_samples = tested_samples(rubric, samples, step) if samples is not None else None
    return RubricTest(report, seed, mutation.run(step), tested_equivalents(trial, seed), of_samples)
