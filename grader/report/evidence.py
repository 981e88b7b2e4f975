"""The evidence of a report: which pieces the lab asks for, and the files that were found for each."""

from collections.abc import Iterator
from itertools import groupby

from grader.grading.report import Exhibits, Report
from grader.text import enumerated, printable

_MAX_LISTED, _MAX_MISSING = 12, 2


def evidence(report: Report) -> Iterator[tuple[str, list[tuple[str, bool]]]]:
    """Yield the title of each part with its pieces of evidence, and whether files were found; then the other pictures."""
    parts = {part.id: part.title for part in report.rubric.parts}
    for part, exhibits in groupby(report.exhibits, key=lambda exhibits: exhibits.evidence.part):
        yield printable(parts[part]), [(_exhibits_text(found), bool(found.files)) for found in exhibits]
    if report.others:
        yield "Other pictures and documents", [(printable(exhibit.words), True) for exhibit in report.others]


def evidence_line(report: Report) -> str:
    """Return how many pieces of evidence were found, and which were not; empty if the lab asks for none."""
    found = sum(bool(exhibits.files) for exhibits in report.exhibits)
    uncertain = [_exhibits_text(exhibits) for exhibits in report.exhibits if exhibits.perhaps and not exhibits.files]
    missing = [exhibits.evidence.title for exhibits in report.exhibits if not (exhibits.files or exhibits.perhaps)]
    texts = [f"Evidence: {found or 'none'} of {len(report.exhibits)} found", *uncertain]
    texts += (
        [f"missing: {enumerated(missing, _MAX_MISSING)}"] if missing and len(missing) < len(report.exhibits) else []
    )
    return printable("; ".join(texts)) if report.exhibits else ""


def _exhibits_text(found: Exhibits) -> str:
    """Return a piece of evidence with its files, or with those that are perhaps meant."""
    files = ", ".join(exhibit.words for exhibit in found.files)
    perhaps = enumerated([exhibit.words for exhibit in found.perhaps], _MAX_LISTED, "or")
    return printable(f"{found.evidence.title}: {files or (f'perhaps {perhaps}' if perhaps else 'missing')}")
