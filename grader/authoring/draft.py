"""Try the facts of a reference on it, and write a rubric of those that it passes."""

from itertools import chain, islice
from pathlib import Path
from typing import NamedTuple

from grader.authoring.elements import element_facts
from grader.authoring.fact import Fact, Omission, Solution
from grader.authoring.facts import robot_facts
from grader.authoring.package_facts import package_facts
from grader.authoring.rubric_text import USUAL, Head, Row, rubric_text
from grader.checks.outcome import Outcome
from grader.checks.registry import find_check
from grader.checks.toml_types import WrongValue
from grader.errors import InputError, MissingElement, NotDecided
from grader.grading.rubric import Rubric, read_rubric
from grader.grading.toml_file import read_toml
from grader.grading.toml_rows import toml_literal
from grader.robot.shapes import UnknownShape
from grader.text import capitalised

MAX_FACTS = 2000  # more than the largest robots have; criteria cost the square of their number


class RubricDraft(NamedTuple):
    """A rubric that its reference passes, as bytes and loaded, and what it omits."""

    data: bytes
    rubric: Rubric
    omissions: tuple[Omission, ...]


def draft(solution: Solution, head: Head, path: Path) -> RubricDraft:
    """Return a rubric for a file at `path` with a criterion for each fact that a check can test. Raises InputError."""
    facts = chain(robot_facts(solution), element_facts(solution), package_facts(solution))
    found = list(islice(facts, MAX_FACTS + 1))
    if len(found) > MAX_FACTS:
        raise InputError(
            f"the robot has more than {MAX_FACTS} facts, which is too long for a rubric: name a smaller one"
        )
    tried = [it if isinstance(it, Omission) else _tried(solution, it) for it in found]
    rows = {(row.fact.check, toml_literal(row.fact.arguments)): row for row in tried if isinstance(row, Row)}
    data = rubric_text(head, [*rows.values()]).encode()
    return RubricDraft(data, read_rubric(data, path), tuple(it for it in tried if isinstance(it, Omission)))


def _tried(solution: Solution, fact: Fact) -> Row | Omission:
    """Return the first of the facts that the reference passes; or what it does not pass, and why."""
    reasons = []
    for one in (fact, *fact.otherwise):
        try:
            outcome = _outcome(solution, one)
        except (MissingElement, NotDecided, UnknownShape) as error:
            reasons.append(str(error))
            continue
        except WrongValue as error:
            reasons.append(f"an argument must be {error}")
            continue
        if outcome.status == "passed":
            return Row(one, capitalised(one.title or outcome.message))
        reasons.append(outcome.mistake if outcome.status == "pending" else outcome.message)
    return Omission(fact.words, reasons[0])


def _outcome(solution: Solution, fact: Fact) -> Outcome:
    """Return what a check says of the reference; raise WrongValue for an argument that it does not take."""
    check = find_check(fact.check)
    assert check is not None
    _, read = read_toml(f"it = {toml_literal(fact.arguments)}".encode(), Path())
    given = {name: check.parameters[name].type.parse(value) for name, value in read["it"].items()}
    usual, _ = USUAL.get(fact.check, ({}, ""))
    known = {
        "urdf": solution.reading,
        "robot": solution.robot,
        "reference": solution.robot,
        "submission": solution.submission,
        "package": solution.submission.package,
    }
    return check.function(*(known[name] for name in check.examined), **{**usual, **given})
