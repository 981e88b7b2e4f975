"""What is wrong in a workspace, as an editor lists it."""

from collections.abc import Sequence
from pathlib import Path

from lsprotocol import types as lsp

from grader.app.editor.look import Look
from grader.app.editor.text_ranges import TextRanges
from grader.base.source import Base, Location
from grader.report.findings import Finding, place_in_repository

SOURCE = "grader"
_SEVERITIES = {
    "error": lsp.DiagnosticSeverity.Error,
    "warning": lsp.DiagnosticSeverity.Warning,
    "note": lsp.DiagnosticSeverity.Information,
}
_MAX_SHOWN = 300  # in one file


def diagnostics_of(
    look: Look, root: Path, graded: Sequence[Finding] = ()
) -> dict[str, list[lsp.Diagnostic]]:
    """Return what is wrong with the files of a folder, by their paths: the problems, and the
    criteria of a rubric that fail.
    """
    ranges = TextRanges(look, root)
    shown: dict[str, list[lsp.Diagnostic]] = {}
    for finding in (*look.findings, *graded):
        path, at = place_in_repository(finding, Base())
        if path not in look.tree.files:
            path, at = next(iter(look.tree.files), path), None
        of_file = shown.setdefault(path, [])
        if len(of_file) < _MAX_SHOWN:
            of_file.append(_diagnostic(look, ranges, finding, at or Location(path, 1, 1)))
    return shown


def _diagnostic(look: Look, ranges: TextRanges, finding: Finding, at: Location) -> lsp.Diagnostic:
    rule = finding.rule
    return lsp.Diagnostic(
        ranges.range(at),
        finding.message,
        severity=_SEVERITIES[finding.severity],
        code=rule.id,
        code_description=lsp.CodeDescription(rule.page) if rule.page else None,
        source=SOURCE,
        related_information=_related(look, ranges, finding) or None,
    )


def _related(
    look: Look, ranges: TextRanges, finding: Finding
) -> list[lsp.DiagnosticRelatedInformation]:
    """Return the other places of a finding: what was meant, and the calls of macros."""
    found = []
    for name, call in finding.location.calls:
        text = f"the macro {name} is called here"
        found.append(lsp.DiagnosticRelatedInformation(ranges.place(call), text))
    mismatch = look.mismatch_of(finding)
    if mismatch is not None and mismatch.related is not None:
        text = "this is what it is compared with"
        found.append(lsp.DiagnosticRelatedInformation(ranges.place(mismatch.related), text))
    return found
