"""Test a rubric on its own reference solution."""

from collections.abc import Callable

from grader.errors import InputError
from grader.grading.grade import grade, open_reference
from grader.grading.rubric import Rubric
from grader.mutation.mutation_test import MutationTest
from grader.mutation.result import EquivalentResults, RubricTest
from grader.mutation.trial import Trial

MAX_MUTANTS = 500  # by default
Progress = Callable[[int, int], None]  # how many submissions of how many are graded


def tested(rubric: Rubric, *, seed: int, most: int, progress: Progress) -> RubricTest:
    """Return what a test of a rubric finds. Raises InputError without a reference that can be read."""
    if not rubric.reference:
        raise InputError(f'the rubric {rubric.id} names no reference: add reference = "FOLDER" with a correct solution')
    reference = open_reference(rubric)
    report = grade(rubric, reference)
    trial = Trial(report, reference)
    mutation = MutationTest(trial, most, seed)
    total, done = len(mutation.chosen), 0

    def step() -> None:
        nonlocal done
        done += 1
        progress(done, total)

    return RubricTest(report, seed, mutation.run(step), EquivalentResults({}, {}))
