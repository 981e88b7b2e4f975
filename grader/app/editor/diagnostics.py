"""What is wrong in a workspace, as an editor lists it."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from lsprotocol import types as lsp

from grader.app.editor.look import Look
from grader.app.editor.text_ranges import TextRanges
from grader.base.source import Base, Location
from grader.files.limits import ROBOT_ENDINGS
from grader.report.findings import Finding, place_in_repository
from grader.report.locations import SourceOf
from grader.report.mistakes import Mistake
from grader.ros.api import RECOVERED

SOURCE = "grader"
_SEVERITIES = {
    "error": lsp.DiagnosticSeverity.Error,
    "warning": lsp.DiagnosticSeverity.Warning,
    "note": lsp.DiagnosticSeverity.Information,
}
_MAX_SHOWN = 300  # in one file


@dataclass
class _Shown:
    """One diagnostic: what is wrong, what else is said about it and where, and what it costs."""

    finding: Finding
    notes: list[tuple[Location, str]] = field(default_factory=list)
    costs: list[str] = field(default_factory=list)

    @property
    def key(self) -> tuple[str, Location]:
        """The message and the place of what is wrong."""
        return self.finding.message, self.finding.location

    @property
    def message(self) -> str:
        """What is wrong, with the points that it costs in parentheses."""
        if self.costs:
            return f"{self.finding.message} ({'; '.join(self.costs)})"
        return self.finding.message


def diagnostics_of(
    look: Look, root: Path, graded: Sequence[Mistake] = ()
) -> dict[str, list[lsp.Diagnostic]]:
    """Return what is wrong with the files of a folder, by their paths.

    The problems, and the mistakes that lose points of a rubric. What a problem costs is said
    with it.
    """
    ranges = TextRanges(look, root)
    shown: dict[str, list[lsp.Diagnostic]] = {}
    problems = _join_assumptions(look.findings)
    for one in _join_mistakes(problems, graded, look.opened.source):
        path, at = place_in_repository(one.finding, Base())
        if path not in look.tree.files:
            path, at = next(iter(look.tree.files), path), None
        of_file = shown.setdefault(path, [])
        if len(of_file) < _MAX_SHOWN:
            of_file.append(_diagnostic(look, ranges, one, at or Location(path, 1, 1)))
    return shown


def _join_assumptions(findings: Iterable[Finding]) -> list[_Shown]:
    """Return problems, each with what is assumed because of it."""
    shown: list[_Shown] = []
    assumed: list[_Shown] = []
    for finding in findings:
        if finding.rule.id == RECOVERED.code:
            assumed.append(_Shown(finding))
        else:
            shown.append(_Shown(finding))
    alone = []
    for one in assumed:
        at = one.finding.location
        hosts = [candidate for candidate in shown if _may_be_cause(candidate.finding, at)]
        host = min(hosts, key=lambda candidate: _distance(candidate.finding, at), default=None)
        if host is None:
            alone.append(one)
        else:
            host.notes.append((at, one.finding.message))
    return [*shown, *alone]


def _may_be_cause(finding: Finding, at: Location) -> bool:
    """Return whether a problem may be why something is assumed at a place."""
    is_near = finding.severity == "error" or finding.location.line == at.line
    return finding.location.path == at.path and is_near


def _distance(finding: Finding, at: Location) -> tuple[bool, bool, int]:
    where = finding.location
    return where.line != at.line, finding.severity != "error", abs(where.column - at.column)


def _join_mistakes(
    shown: Sequence[_Shown], graded: Iterable[Mistake], source_of: SourceOf
) -> list[_Shown]:
    """Add to each problem the mistakes that report it, and to others the warnings.

    The warnings are at the same attribute of a robot as the other mistake. Return both.
    """
    left, others = [*shown], []
    for mistake in graded:
        finding = mistake.finding
        one = next((reported for reported in left if reported.key in mistake.reported), None)
        if one is None:
            one = _Shown(finding)
            others.append(one)
            for same in [same for same in left if _is_same_word(same.finding, finding, source_of)]:
                left.remove(same)
                one.notes.append((finding.location, f"{same.finding.rule.id}: {same.message}"))
        elif mistake.advice:
            one.notes.append((finding.location, mistake.advice))
        if mistake.names == one.finding.rule.id:
            one.costs.append(mistake.cost)
        else:
            one.costs.append(f"{mistake.cost}: {mistake.names}")
        for other in mistake.besides:
            one.notes.append((other.location, f"{other.rule.id}: {other.message}"))
    return [*left, *others]


def _is_same_word(problem: Finding, criterion: Finding, source_of: SourceOf) -> bool:
    """Return whether a warning is at the attribute that a criterion is about.

    At a tag, they may be about different things.
    """
    at = problem.location
    if problem.severity == "error" or at != criterion.location:
        return False
    source = source_of(at.path)
    if source is None or not at.path.endswith(ROBOT_ENDINGS):
        return False
    return source.line(at.line)[at.column - 1 : at.column] not in ("", "<")


def _diagnostic(look: Look, ranges: TextRanges, shown: _Shown, at: Location) -> lsp.Diagnostic:
    finding = shown.finding
    rule = finding.rule
    return lsp.Diagnostic(
        ranges.range(at),
        shown.message,
        severity=_SEVERITIES[finding.severity],
        code=rule.id,
        code_description=lsp.CodeDescription(rule.page) if rule.page else None,
        source=SOURCE,
        related_information=_related(look, ranges, shown) or None,
    )


def _related(
    look: Look, ranges: TextRanges, shown: _Shown
) -> list[lsp.DiagnosticRelatedInformation]:
    """Return the other places of a diagnostic.

    What was meant, the calls of macros, the criteria that fail by it.
    """
    related_places = []
    for name, call in shown.finding.location.calls:
        text = f"the macro {name} is called here"
        related_places.append(lsp.DiagnosticRelatedInformation(ranges.place(call), text))
    related = shown.finding.related
    if related is not None:
        text = "this is what it is compared with"
        related_places.append(lsp.DiagnosticRelatedInformation(ranges.place(related), text))
    for at, text in shown.notes:
        if at.path in look.tree.files:
            related_places.append(lsp.DiagnosticRelatedInformation(ranges.place(at), text))
    return related_places
