"""Two edits of which the second repairs what the first breaks: what cannot be tried costs only its own hint."""

from typing import Any

import pytest

from grader.grading.hints.hinting import hinted
from grader.grading.hints.trials import Trials
from tests.samples import SAMPLES


def test_an_edit_that_does_not_fit_costs_only_its_hint(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every trial that continues from another one fails: the search ends without a fault, and the points stay."""
    sample = SAMPLES["arm/tool-on-the-forearm"]
    report, apply, refused = sample.grade(), Trials.apply, 0

    def only_whole(self: Trials, *arguments: Any, whole: bool = False, **named: Any) -> Any:
        nonlocal refused
        refused += not whole
        return apply(self, *arguments, whole=True, **named) if whole else None

    monkeypatch.setattr(Trials, "apply", only_whole)
    found = hinted(report, sample.open(), "edit")
    assert refused > 0
    assert not found.faults
    assert [row.points for row in found.report.results] == [row.points for row in report.results]
