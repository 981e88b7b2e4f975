"""One line for each outcome of the cases of the checks, and for each wording of outcomes and notes of the samples."""

from collections.abc import Iterator
from pathlib import Path

from tests.checks.cases import CASES
from tests.checks.outcomes import ask, row, wording
from tests.checks.package_cases import PACKAGE_CASES, PENDING_CASES
from tests.checks.submissions import REFERENCE
from tests.samples import SAMPLES

FILES = {name: Path(__file__).parent / f"outcomes-of-{name}.txt" for name in ("cases", "samples")}


def outcomes_of_cases() -> Iterator[str]:
    """Yield what a check measures in the robot or submission that passes, and in the one that fails."""
    for case in (*CASES, *PACKAGE_CASES):
        for tried in (case.passing, case.failing):
            yield row(case.name, ask(case.check, tried, **case.arguments)._asdict())
    for pending in PENDING_CASES:
        for submitted in (REFERENCE, pending.without):
            yield row(pending.name, ask(pending.check, submitted, **pending.arguments)._asdict())


def outcomes_of_samples() -> Iterator[str]:
    """Yield what failed or needs manual grading in the samples, and what is noted about them, each wording once."""
    seen = set()
    for name, sample in SAMPLES.items():
        report = sample.grade()
        wrong = [result for result in report.results if result.outcome.status in ("failed", "pending")]
        rows = [row(f"{name}: {result.criterion.id}", result.outcome._asdict()) for result in wrong]
        rows += [f"{name}: message {note}" for note in report.notes]
        for found in rows:
            if wording(found) not in seen:
                seen.add(wording(found))
                yield found


ROWS = {"cases": outcomes_of_cases, "samples": outcomes_of_samples}
