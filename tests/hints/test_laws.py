"""Laws of hints: no number that nobody meant, no expression that is built, and all of them together hold."""

import re
from collections.abc import Iterable, Iterator
from math import isclose, pi
from random import Random

import pytest

from grader.base.source import Edit
from grader.lab.authoring.mutants import mutants
from grader.lab.grading.grade import grade
from grader.lab.grading.report import Report
from grader.lab.hints.hinting import fixed, hinted
from grader.lab.rubric.rubric import Rubric
from grader.lab.submission.edited import content
from grader.lab.submission.submission import Submission
from grader.ros.package.robot_file import Read
from tests.hints.students import MISTAKES
from tests.hints.trials import BASES, Base
from tests.samples import LAB6, SAMPLES, reference

_NUMBER = re.compile(r"(?<![\w.])[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?(?![\w.])")
_EXPRESSION = re.compile(r"\$\{[^}]*\}|\$\([^)]*\)")
_FACTORS = (1.0, 2.0, 0.5, 1e-2, 1e-3, pi / 180, 1 / 255)  # another unit, twice, half
_MUTANTS = 3


def numbers_in(text: str) -> list[float]:
    """Return the numbers of a text, without those in expressions."""
    return [float(found[0]) for found in _NUMBER.finditer(_EXPRESSION.sub(" ", text))]


def _texts(submission: Submission) -> Iterator[str]:
    if not isinstance(submission.urdf, Read):
        return
    yield submission.urdf.data.decode("utf-8", "replace")
    for path in submission.whole_tree.files:
        if path.endswith((".xacro", ".urdf", ".yaml", ".yml")):
            yield (content(submission, path) or b"").decode("utf-8", "replace")
    root = submission.urdf.reading.elements
    if root is not None:  # what xacro makes of expressions
        yield " ".join(
            value for element in root.iter() for value in map(str, element.attrib.values())
        )


def meant(submission: Submission, rubric: Rubric) -> list[float]:
    """Return the numbers that a hint may write: those of the reference, and the student's, also in another unit."""
    own = [value for text in _texts(submission) for value in numbers_in(text)]
    like = [value for text in _texts(reference(rubric)) for value in numbers_in(text)]
    return [abs(value) for value in like] + [
        abs(value) * factor for value in own for factor in _FACTORS
    ]


def strange(edits: Iterable[Edit], submission: Submission, rubric: Rubric) -> list[str]:
    """Return what edits write and nobody meant: a number, or an expression that is not in the old text."""
    known = meant(submission, rubric)
    found = []
    for edit in edits:
        old, new = numbers_in(edit.old), numbers_in(edit.new)
        for value in (value for value in new if value not in old and value != 0.0):
            if not any(isclose(abs(value), one, rel_tol=2e-3, abs_tol=1e-6) for one in known):
                found.append(f"{edit.old} -> {edit.new}: {value}")
        built = set(_EXPRESSION.findall(edit.new)) - set(_EXPRESSION.findall(edit.old))
        text = "".join(_texts(submission))
        found += [
            f"{edit.old} -> {edit.new}: {one}"
            for one in built
            if one not in text and not _is_respelt(one, text)
        ]
    return found


def _is_respelt(expression: str, text: str) -> bool:
    """Return whether each word of an expression is one of the text: a name that is corrected."""
    return (
        all(word in text for word in re.findall(r"[^\W\d]\w*", expression)) and len(expression) < 80
    )


def hold(submission: Submission, rubric: Rubric) -> Report:
    """Check the laws of a submission's hints, and return its report."""
    report = grade(rubric, submission)
    found = hinted(report, submission, "edit")
    hints = {
        id(result.hint): result.hint for result in found.report.results if result.hint is not None
    }
    assert not found.faults
    places = [(edit.path, edit.line, edit.column) for edit in found.edits if edit.old]
    assert len(places) == len(set(places))
    fix = fixed(found, submission)
    is_robot = isinstance(submission.urdf, Read)
    robots = (
        [edit for edit in found.edits if edit.path.endswith((".urdf", ".xacro"))]
        if is_robot
        else []
    )
    assert strange(robots, submission, rubric) == []
    shown = {hint.shown_by: hint for hint in hints.values()}
    promised = sum(sum(hint.gains.values()) for hint in shown.values())
    assert fix.report.score >= report.score + promised
    assert bool(found.edits) == (fix.report.score > report.score)
    assert bool(fix.files) == bool(found.edits)
    before = {result.criterion.id: result.points for result in report.results}
    assert all(result.points >= before[result.criterion.id] for result in fix.report.results)
    if found.edits and is_robot and report.submission.verdict != "rejected":
        assert fix.report.submission.verdict != "rejected"
    return report


@pytest.mark.parametrize("name", SAMPLES)
def test_the_hints_of_a_sample_hold(name: str) -> None:
    """No number that nobody meant; all hints together load, and gain at least what they promise."""
    hold(SAMPLES[name].open(), SAMPLES[name].rubric)


@pytest.mark.slow
@pytest.mark.parametrize("name", MISTAKES)
def test_the_hints_for_a_mistake_of_students_hold(name: str) -> None:
    """The same for each listed mistake."""
    mistake = MISTAKES[name]
    hold(mistake.base.changed(mistake.text), LAB6)


@pytest.mark.slow
@pytest.mark.parametrize("name", BASES)
def test_the_hints_of_mutants_hold(name: str) -> None:
    """The same for mutants of each correct robot, and for several mistakes in one."""
    random = Random(name)
    for submission in _mutated(BASES[name], random):
        hold(submission, LAB6)


def _mutated(base: Base, random: Random) -> Iterator[Submission]:
    text = base.text
    for _ in range(_MUTANTS):
        yield base.changed(random.choice(list(mutants(base.text))).applied(base.text))
        text = random.choice(list(mutants(text))).applied(text)
        yield base.changed(text)
