"""One line for each outcome of the cases of the checks, and for each wording of outcomes and notes of the samples."""

import re
from collections.abc import Iterator, Mapping
from pathlib import Path

from grader.checks.outcome import Outcome
from tests.checks.cases import CASES
from tests.checks.outcomes import ask
from tests.checks.package_cases import PACKAGE_CASES, PENDING_CASES
from tests.checks.submissions import REFERENCE
from tests.samples import SAMPLES

FILES = {name: Path(__file__).parent / f"outcomes-of-{name}.txt" for name in ("cases", "samples")}
# What differs between outcomes of one wording: names in quotes, numbers and paths.
_DATA = re.compile(r"'[^']*'|\"[^\"]*\"|[-\d.]+|\S*/\S*")


def outcomes_of_cases() -> Iterator[str]:
    """Yield what a check measures in the robot or submission that passes, and in the one that fails."""
    for case in (*CASES, *PACKAGE_CASES):
        for tried in (case.passing, case.failing):
            yield row(case.name, ask(case.check, tried, **case.arguments))
    for pending in PENDING_CASES:
        for submitted in (REFERENCE, pending.without):
            yield row(pending.name, ask(pending.check, submitted, **pending.arguments))


def outcomes_of_samples() -> Iterator[str]:
    """Yield what failed or needs manual grading in the samples, and what is noted about them, each wording once."""
    seen = set()
    for name, sample in SAMPLES.items():
        report = sample.grade()
        rows = [
            (f"{result.criterion.check.name} {result.outcome.message}", row(result.criterion.id, result.outcome))
            for result in report.results
            if result.outcome.status in ("failed", "pending")
        ]
        rows += [(note, f"note: {note}") for note in report.notes]
        for text, line in rows:
            wording = _DATA.sub("", text)
            if wording not in seen:
                seen.add(wording)
                yield f"{name}: {line}"


def row(name: str, outcome: Outcome) -> str:
    """Return an outcome in one line, with the fields that it has."""
    at = outcome.location
    fields = outcome._replace(location=None, unit=None)._asdict() | {"at": at and f"{at.path}:{at.line}:{at.column}"}
    unit = f" {outcome.unit}" if outcome.unit else ""
    texts = (
        (key, _shown(value) + unit * (key == "measured")) for key, value in fields.items() if value not in (None, "")
    )
    return f"{name}: " + "; ".join(map(" ".join, texts))


def _shown(value: object) -> str:
    if isinstance(value, tuple):
        return f"({', '.join(map(_shown, value))})"
    if isinstance(value, Mapping):
        return f"{{{', '.join(f'{key}: {_shown(one)}' for key, one in value.items())}}}"
    return f"{round(value, 9) + 0.0:.6g}" if isinstance(value, float) else str(value).replace("\n", "\\n")


ROWS = {"cases": outcomes_of_cases, "samples": outcomes_of_samples}
