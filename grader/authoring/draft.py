"""Measure a reference, write a rubric of the facts, and keep the criteria that the reference passes."""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import chain, islice
from pathlib import Path
from typing import NamedTuple

from grader.authoring.bodies import body_facts
from grader.authoring.elements import element_facts
from grader.authoring.fact import Fact, Omission, Solution, why_invalid
from grader.authoring.ignored import ignored_mutants
from grader.authoring.joints import joint_facts, loading_facts, motion_facts, tree_facts
from grader.authoring.oddities import Doubts, oddities
from grader.authoring.package import package_facts
from grader.authoring.rubric_text import Head, criterion_ids, literal, rubric_text
from grader.authoring.shapes import shape_facts
from grader.checks.outcome import Outcome
from grader.errors import InputError
from grader.grading.grade import grade
from grader.grading.rubric import Rubric, read_rubric

MAX_FACTS = 2000  # more than the largest robots have; criteria cost the square of their number
_SEE_BELOW = "the reference does not pass it (see below)"


class Draft(NamedTuple):
    """A rubric that its reference passes, as bytes and as it is loaded; what it omits, and what looks odd in the reference."""

    data: bytes
    rubric: Rubric
    omissions: tuple[Omission, ...]
    oddities: tuple[str, ...]


def draft(solution: Solution, head: Head, path: Path) -> Draft:
    """Return a rubric for a file at `path`, with a criterion for each fact of the reference that a check can test. Raises InputError."""
    found = list(islice(_measured(solution), MAX_FACTS + 1))
    if len(found) > MAX_FACTS:
        raise InputError(
            f"the robot has more than {MAX_FACTS} facts, which is too long for a rubric: name a smaller one"
        )
    facts = _usable([it for it in found if isinstance(it, Fact)])
    omissions = [*_omissions(found)]
    ignored, doubts = list(ignored_mutants(solution)), Doubts()
    while True:
        rows = criterion_ids(facts)
        data = rubric_text(head, rows, ignored).encode()
        rubric = read_rubric(data, path)
        lost = _lost(rubric)
        if not lost:
            return Draft(data, rubric, tuple(omissions), (*oddities(solution), *doubts.lines()))
        for name, outcome in lost.items():
            fact, is_odd = rows[name], rows[name].is_doubtful and outcome.status == "failed"
            if is_odd:
                doubts.add(fact, outcome)
            if not fact.otherwise:
                why = outcome.mistake if outcome.status == "pending" else outcome.message
                omissions.append(Omission(name, _SEE_BELOW if is_odd else why))
        kept = ([fact] if name not in lost else _instead(fact) for name, fact in rows.items())
        facts = _usable(chain.from_iterable(kept))


def _instead(fact: Fact) -> list[Fact]:
    """Return the facts that count instead of one that the reference does not pass."""
    return [replace(it, about=fact.about) for it in fact.otherwise]


def _lost(rubric: Rubric) -> dict[str, Outcome]:
    """Return the criteria that the reference does not pass, with what they found; one that is skipped with that of its cause."""
    assert rubric.solution is not None
    results = {it.criterion.id: it for it in grade(rubric, rubric.solution.submission).results}
    lost = {name: it for name, it in results.items() if it.outcome.status != "passed"}
    return {name: (results[it.because] if it.because else it).outcome for name, it in lost.items()}


def _measured(solution: Solution) -> Iterator[Fact | Omission]:
    """Yield all facts in the order of the rubric."""
    yield from loading_facts(solution)
    for link in solution.links:
        joint = solution.joints.get(link.name)
        of_joint = joint_facts(solution, joint) if joint is not None else ()
        for found in chain(of_joint, shape_facts(link), body_facts(link)):
            yield replace(found, about=link.name) if isinstance(found, Fact) else found
    yield from tree_facts(solution)
    yield from motion_facts(solution)
    if solution.reading.root is not None:
        yield from element_facts(solution.reading.root)
    package, path = solution.submission.package, solution.submission.path
    if package is not None and path is not None:
        yield from package_facts(package, path.removeprefix(f"{package.folder}/") if package.holds(path) else "")
    for other in solution.submission.packages:
        if other is not package:
            yield Omission(f"the package {other.name}", "a rubric is about one package")


def _usable(facts: Iterable[Fact]) -> list[Fact]:
    """Return the facts that a rubric can hold: with arguments that the check takes, and each check with its arguments once."""
    different = {(fact.check, literal(fact.arguments)): fact for fact in facts if not why_invalid(fact)}
    return list(different.values())


def _omissions(found: Iterable[Fact | Omission]) -> Iterator[Omission]:
    for it in found:
        if isinstance(it, Omission):
            yield it
        elif why_invalid(it):
            yield Omission(it.title, why_invalid(it))
