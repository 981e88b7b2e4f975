"""How sure a hint is: whether another edit that the search knows works as well."""

import json
from typing import Any

import pytest

from grader.edits import Proposal
from grader.grading.hints.hinting import hinted
from grader.grading.hints.slots import slots
from grader.grading.hints.solving import Solver
from grader.grading.hints.state_edits import StateEdits
from grader.grading.hints.trials import Trials, costs_of, is_worse
from grader.grading.report import Hint
from grader.submission.submission import Submission
from grader.submission.urdf import Read
from tests.command_line import run
from tests.examples import spread
from tests.hints.trials import graded, reference_draft, with_edits
from tests.samples import ROOT, SAMPLES, Sample

CASES = {
    "lidar-buried": {"only"},
    "green-0-1-0": {"only"},
    "lidar-missing": {"only"},
    "right-wheel-mirrored-into-base": {"preferred"},  # the axis may be negated as well, which gains less
    "caster-at-the-back": {"preferred"},  # the shape may be moved as well
    "caster-too-small": {"preferred"},  # two values together, of which not all pairs are tried
    "folder-misspelt-in-setup": {"preferred"},  # a package can be written in other ways
    "tag-not-closed": {"preferred"},  # repairs of the syntax are not all graded
    "setup-syntax-error": {"one of several"},  # the bracket belongs to this line or to the next one
    "several-mistakes": {"only", "preferred"},
}
ROBOTS = ["lidar-buried", "green-0-1-0", "lidar-missing", "several-mistakes"]


def hints_of(name: str, *options: str) -> list[dict[str, Any]]:
    """Return the hints of a sample as JSON."""
    done = run(("grade", ROOT / "submissions/lab6" / name, "--format", "json", *options))
    return [hint for result in json.loads(done.stdout)["results"] for hint in result["hints"]]


@pytest.mark.parametrize(("name", "certain"), spread(CASES.items(), 5))
def test_real_mistakes(name: str, certain: set[str]) -> None:
    """The same at each level; only what is one of several says so in words."""
    for level in ("place", "cause", "edit"):
        assert {hint["certainty"] for hint in hints_of(name, "--hints", level)} == certain
        shown = " ".join(run(("grade", ROOT / "submissions/lab6" / name, "--hints", level)).stdout.decode().split())
        assert ("Other edits are as good." in shown) == ("one of several" in certain)


def test_what_is_not_looked_at_is_preferred(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without a budget for other edits no hint is the only one, and the hints are the same."""
    before = hints_of("several-mistakes")
    monkeypatch.setattr("grader.grading.hints.choice._MAX_LOOK_STEPS", 0)
    after = hints_of("several-mistakes")
    assert {hint["certainty"] for hint in after} == {"preferred"}
    assert [hint["edits"] for hint in after] == [hint["edits"] for hint in before] != []


def others_of(sample: Sample, hint: Hint) -> list[Proposal]:
    """Return the edits of one robot element elsewhere that, graded from scratch, work for the hint's costliest criterion."""
    submission, rubric = sample.open(), sample.rubric
    before = graded(submission, rubric)
    trials = Trials(rubric, submission, before)
    costs = costs_of(before)
    name = max(hint.gains, key=lambda name: costs.get(name, 0))
    options = StateEdits(trials, trials.start, reference_draft(rubric.id), lambda: None)
    assert options.draft is not None
    criterion = before[name].criterion
    solver = Solver(options.quick, options.difference, name, before[name].outcome)
    solved = (
        solver.pieces(slots(options.draft, *options.targets(criterion))) if criterion.check.subject == "robot" else ()
    )
    places = {(edit.path, edit.line, edit.column) for edit in hint.edits}
    text = _text(with_edits(submission, hint.edits))
    found = []
    for proposal in (it for piece in (*options.relevant(criterion), *solved) for it in options.proposals(piece)):
        try:
            changed = with_edits(submission, proposal.edits)
        except AssertionError:  # two edits of the same text
            continue
        after = graded(changed, rubric)
        is_proven = after[name].outcome.status == "passed" and not any(is_worse(before[it], after[it]) for it in before)
        if is_proven and not proposal.places >= places and _text(changed) != text:
            found.append(proposal)
    return found


def _text(submission: Submission) -> list[bytes]:
    assert isinstance(submission.urdf, Read)
    return submission.urdf.data.split()


def _is_parsed(submission: Submission) -> bool:
    return isinstance(submission.urdf, Read) and submission.urdf.reading.root is not None


def only_hints(sample: Sample) -> list[Hint]:
    """Return the hints of a robot that are called the only one, without those that need an earlier one."""
    report = hinted(sample.grade(), sample.open(), "edit").report
    hints = {result.hint.shown_by: result.hint for result in report.results if result.hint is not None}
    alone = [hint for hint in hints.values() if not any({*hint.edits} > {*one.edits} for one in hints.values())]
    return [hint for hint in alone if hint.certainty == "only"]


@pytest.mark.parametrize("name", ROBOTS)
def test_no_other_place_works_for_an_only_hint(name: str) -> None:
    """Each difference to the reference and each solved number at another place is applied, and graded from scratch."""
    hints = only_hints(SAMPLES[name])
    assert hints
    assert [others_of(SAMPLES[name], hint) for hint in hints] == [[]] * len(hints)


@pytest.mark.exhaustive
def test_no_other_place_works_for_the_only_hints_of_all_samples() -> None:
    """The same for every sample whose robot can be read."""
    samples = [sample for sample in SAMPLES.values() if _is_parsed(sample.open())]
    found = [(sample.name, others_of(sample, hint)) for sample in samples for hint in only_hints(sample)]
    assert len(found) > 80
    assert [(name, others) for name, others in found if others] == []
