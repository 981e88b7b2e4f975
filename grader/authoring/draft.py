"""Measure a reference, write a rubric of the facts, and keep the criteria that the reference passes."""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import chain
from pathlib import Path
from typing import NamedTuple

from grader.authoring.bodies import body_facts
from grader.authoring.elements import element_facts
from grader.authoring.fact import Fact, Omission, is_finite
from grader.authoring.ignored import ignored_mutants
from grader.authoring.joints import joint_facts
from grader.authoring.oddities import oddities
from grader.authoring.package import package_facts
from grader.authoring.rubric_text import Head, criterion_ids, rubric_text
from grader.authoring.shapes import shape_facts
from grader.authoring.solution import Solution
from grader.authoring.toml_text import literal
from grader.authoring.whole import loading_facts, motion_facts, tree_facts
from grader.checks.registry import find_check
from grader.grading.grade import grade
from grader.grading.rubric import Rubric, read_rubric

_ODD_IF_FAILED = ("inertia_plausible", "collision_matches_visual")


class Draft(NamedTuple):
    """A rubric that its reference passes, as bytes and as it is loaded; what it omits, and what looks odd in the reference."""

    data: bytes
    rubric: Rubric
    omissions: tuple[Omission, ...]
    oddities: tuple[str, ...]


def draft(solution: Solution, head: Head, path: Path) -> Draft:
    """Return a rubric for a file at `path`, with a criterion for each fact of the reference that a check can tell."""
    found = list(_measured(solution))
    facts = criterion_ids(_different([it for it in found if isinstance(it, Fact) and is_finite(it.arguments)]))
    omissions = [_omitted(it) for it in found if isinstance(it, Omission) or not is_finite(it.arguments)]
    odd, ignored = list(oddities(solution)), list(ignored_mutants(solution))
    while True:
        data = rubric_text(head, facts, ignored).encode()
        rubric = read_rubric(data, path)
        assert rubric.solution is not None
        results = grade(rubric, rubric.solution.submission).results
        lost = [result for result in results if result.outcome.status != "passed"]
        if not lost:
            return Draft(data, rubric, tuple(omissions), tuple(odd))
        for result in lost:
            name, outcome = result.criterion.id, result.outcome
            omissions.append(Omission(name, outcome.mistake if outcome.status == "pending" else outcome.message))
            if outcome.status == "failed" and facts.pop(name).check in _ODD_IF_FAILED:
                odd.append(f"{outcome.message}: is the solution right?")
            facts.pop(name, None)


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


def _omitted(found: Fact | Omission) -> Omission:
    return found if isinstance(found, Omission) else Omission(found.title, "a value is not a finite number")


def _different(facts: Iterable[Fact]) -> list[Fact]:
    """Return the facts of which each check with its arguments occurs once, and whose check there is."""
    different = {(fact.check, literal(fact.arguments)): fact for fact in facts if find_check(fact.check) is not None}
    return list(different.values())
