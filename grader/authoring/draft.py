"""Measure a reference, write a rubric of the facts, and keep the criteria that the reference passes."""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import chain, islice
from pathlib import Path
from typing import NamedTuple

from grader.authoring.rubric_text import Head, criterion_ids, rubric_text
from grader.checks.measures.fact import THE_FILE, THE_PACKAGE, THE_ROBOT, Fact, Measure, Omission, Solution
from grader.checks.outcome import Outcome
from grader.checks.registry import check_names, declared, usable_check
from grader.checks.toml_types import WrongValue
from grader.errors import InputError
from grader.grading.grade import grade
from grader.grading.rubric import Rubric, read_rubric
from grader.grading.toml_file import read_toml
from grader.grading.toml_rows import toml_literal

MAX_FACTS = 2000  # more than the largest robots have; criteria cost the square of their number


class RubricDraft(NamedTuple):
    """A rubric that its reference passes, as bytes and loaded, and what it omits."""

    data: bytes
    rubric: Rubric
    omissions: tuple[Omission, ...]


def draft(solution: Solution, head: Head, path: Path) -> RubricDraft:
    """Return a rubric for a file at `path` with a criterion for each fact that a check can test. Raises InputError."""
    found = _measure(solution)
    if len(found) > MAX_FACTS:
        raise InputError(
            f"the robot has more than {MAX_FACTS} facts, which is too long for a rubric: name a smaller one"
        )
    facts = _usable([it for it in found if isinstance(it, Fact)])
    omissions = [*_omissions(found)]
    while True:
        rows = criterion_ids(facts)
        data = rubric_text(head, rows).encode()
        rubric = read_rubric(data, path)
        lost = _losses(rubric)
        if not lost:
            return RubricDraft(data, rubric, tuple(omissions))
        for name, outcome in lost.items():
            if not rows[name].otherwise:
                omissions.append(Omission(name, outcome.mistake if outcome.status == "pending" else outcome.message))
        kept = (
            [fact] if name not in lost else [replace(instead, about=fact.about) for instead in fact.otherwise]
            for name, fact in rows.items()
        )
        facts = _usable(chain.from_iterable(kept))


def _losses(rubric: Rubric) -> dict[str, Outcome]:
    """Return what the reference does not pass, with the outcome; for a skipped criterion, that of its cause."""
    assert rubric.solution is not None
    results = {it.criterion.id: it for it in grade(rubric, rubric.solution.submission).results}
    lost = {name: it for name, it in results.items() if it.outcome.status != "passed"}
    return {name: (results[it.because] if it.because else it).outcome for name, it in lost.items()}


def _measure(solution: Solution) -> list[Fact | Omission]:
    """Return what the checks measure: first the file, then each link, the robot, elements and the package."""
    found = list(islice(chain.from_iterable(_measures_of(name, solution) for name in check_names()), MAX_FACTS + 1))
    headings = [THE_FILE, *(link.name for link in solution.links), THE_ROBOT]
    others = dict.fromkeys(it.about for it in found if isinstance(it, Fact) and it.about not in headings)
    headings += [*sorted(others, key=THE_PACKAGE.__eq__)]
    ranks = {about: rank for rank, about in enumerate(headings)}
    found.sort(key=lambda it: ranks[it.about] if isinstance(it, Fact) else 0)
    unused = (other for other in solution.submission.packages if other is not solution.submission.package)
    return [*found, *(Omission(f"the package {other.name}", "a rubric is about one package") for other in unused)]


def _measures_of(name: str, solution: Solution) -> Iterator[Fact | Omission]:
    """Yield what a check measures, if it does. Raises InputError for a check of another package that fails at it."""
    check = usable_check(name)
    if check is None or not check.about.measure:
        return
    try:
        measure: Measure = declared(check.about.measure)
        yield from measure(solution)
    except Exception as error:
        if not check.distribution:
            raise
        reason = f"{type(error).__name__}: {error}"
        raise InputError(f"the check {name} of the package {check.distribution} cannot measure: {reason}") from None


def _usable(facts: Iterable[Fact]) -> list[Fact]:
    """Return the facts that a rubric can hold: with arguments that the check takes, and without duplicates."""
    different = {(fact.check, toml_literal(fact.arguments)): fact for fact in facts if not _why_invalid(fact)}
    return list(different.values())


def _omissions(found: Iterable[Fact | Omission]) -> Iterator[Omission]:
    for it in found:
        if isinstance(it, Omission):
            yield it
        elif _why_invalid(it):
            yield Omission(it.title, _why_invalid(it))


def _why_invalid(fact: Fact) -> str:
    """Return why the check does not take the arguments of a fact, such as a negative mass; empty if it does."""
    check = usable_check(fact.check)
    if check is None:
        return f"there is no check {fact.check}"
    for name, value in fact.arguments.items():
        try:
            _, read = read_toml(f"it = {toml_literal(value)}".encode(), Path())
            check.parameters[name].type.parse(read["it"])
        except WrongValue as error:
            return f"{name} must be {error}"
    return ""
