"""What is wrong in a workspace, as an editor lists it."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from lsprotocol import types as lsp

from grader.app.editor.look import Look
from grader.app.editor.text_ranges import TextRanges
from grader.base.source import Base, Location, SourceOf
from grader.files.limits import ROBOT_ENDINGS
from grader.report.findings import Finding, place_in_repository
from grader.report.mistakes import Mistake
from grader.ros.api import RECOVERED

SOURCE = "grader"
_SEVERITIES = {
    "error": lsp.DiagnosticSeverity.Error,
    "warning": lsp.DiagnosticSeverity.Warning,
    "note": lsp.DiagnosticSeverity.Information,
}
_MAX_SHOWN = 300  # in one file
# Codes of problems that one mistake makes where their words overlap: the first one is shown, and
# the other is said with it. An empty code stands for any.
_ONE_MISTAKE = (
    ("URDF041", "URDF091"),  # a shape without a size, and the word that is there instead
    ("URDF090", "URDF091"),  # what does not belong into a geometry
    ("REF002", "URDF096"),  # a joint that is missing, by two names of one comparison
    ("XACRO006", "REF032"),  # a package that is missing
    ("RVZ004", "REF022"),  # a path that only one machine has
    ("", "URDF095"),  # what Python's XML parser refuses, which ROS 2 accepts
)
_Diagnostics = dict[str, list[lsp.Diagnostic]]  # by path


@dataclass
class _Shown:
    """One diagnostic: what is wrong, what else is said about it and where, and what it costs."""

    finding: Finding
    notes: list[tuple[Location, str]] = field(default_factory=list)
    costs: list[str] = field(default_factory=list)
    joined: list[Finding] = field(default_factory=list)  # others that the same mistake makes

    def is_reported_by(self, mistake: Mistake) -> bool:
        """Return whether a mistake of a rubric reports it, or what is joined to it."""
        every = (self.finding, *self.joined)
        return any((one.message, one.location) in mistake.reported for one in every)

    @property
    def message(self) -> str:
        """What is wrong, with the points that it costs in parentheses."""
        if self.costs:
            return f"{self.finding.message} ({'; '.join(self.costs)})"
        return self.finding.message


_ShownRows = list[_Shown]


def make_diagnostics(look: Look, root: Path, graded: Sequence[Mistake] = ()) -> _Diagnostics:
    """Return what is wrong with the files of a folder, by their paths.

    These are the problems, and the mistakes that lose points of a rubric. What a problem costs is
    said with it.
    """
    ranges = TextRanges(look, root)
    shown: _Diagnostics = {}
    problems = _join_same(_join_assumptions(look.findings), ranges)
    for one in _join_mistakes(problems, graded, look.opened.source):
        path, at = place_in_repository(one.finding, Base())
        if path not in look.tree.files:
            path = next(iter(look.tree.files), path)
            at = None
        of_file = shown.setdefault(path, [])
        if len(of_file) < _MAX_SHOWN:
            of_file.append(_diagnostic(look, ranges, one, at or Location(path, 1, 1)))
    return shown


def _join_assumptions(findings: Iterable[Finding]) -> _ShownRows:
    """Return problems, each with what is assumed because of it."""
    shown = []
    assumed = []
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
        if not host:
            alone.append(one)
        else:
            host.notes.append((at, one.finding.message))
    return shown + alone


def _join_same(shown: Iterable[_Shown], ranges: TextRanges) -> _ShownRows:
    """Return problems, each with the others that the same mistake makes."""
    kept = []
    by_cause: dict[tuple[str, str, str], _Shown] = {}
    by_line: dict[tuple[str, int], _ShownRows] = {}
    for one in shown:
        rule = one.finding.rule
        cause = one.finding.cause
        host = by_cause.setdefault((rule.id, rule.name, cause), one) if cause else one
        of_line = by_line.setdefault(one.finding.location[:2], [])
        if host is one:
            hosts = (other for other in of_line if _is_one_mistake(other, one, ranges))
            host = next(hosts, one)
        if host is one:
            kept.append(one)
            of_line.append(one)
        else:
            _join(host, one, ranges)
    return kept


def _join(host: _Shown, other: _Shown, ranges: TextRanges) -> None:
    """Add a problem to one that the same mistake makes; the word is the shorter one of both."""
    host.joined.append(host.finding)
    host.joined.append(other.finding)
    first = host.finding
    second = other.finding
    codes = (second.rule.id, first.rule.id)
    if codes in _ONE_MISTAKE or ("", first.rule.id) in _ONE_MISTAKE:
        first, second = second, first
    text = second.message
    if first.rule != second.rule:
        text = f"{second.rule.id}: {text}"
    host.notes.append((second.location, text))
    host.notes += other.notes
    word = first.location
    if word[:2] == second.location[:2]:
        width = _width(ranges.range(word))
        if _width(ranges.range(second.location)) < width:
            word = second.location._replace(calls=word.calls)
    host.finding = first._replace(location=word)


def _is_one_mistake(one: _Shown, other: _Shown, ranges: TextRanges) -> bool:
    """Return whether two problems of a line are at one word, and one mistake makes both."""
    first = one.finding
    second = other.finding
    codes = {first.rule.id, second.rule.id}
    if len(codes) == 1:
        calls = first.location.calls, second.location.calls
        return first.location[:3] == second.location[:3] and calls[0] != calls[1]
    is_known = any(codes == {*pair} or (not pair[0] and pair[1] in codes) for pair in _ONE_MISTAKE)
    if not is_known:
        return False
    at = ranges.range(first.location)
    beside = ranges.range(second.location)
    return at.start <= beside.end and beside.start <= at.end


def _width(at: lsp.Range) -> tuple[int, int]:
    return at.end.line - at.start.line, at.end.character - at.start.character


def _may_be_cause(finding: Finding, at: Location) -> bool:
    """Return whether a problem may be why something is assumed at a place."""
    is_near = finding.severity == "error" or finding.location.line == at.line
    return finding.location.path == at.path and is_near


def _distance(finding: Finding, at: Location) -> tuple[bool, bool, int]:
    where = finding.location
    return where.line != at.line, finding.severity != "error", abs(where.column - at.column)


def _join_mistakes(
    shown: Sequence[_Shown], graded: Iterable[Mistake], source_of: SourceOf
) -> _ShownRows:
    """Add to each problem the mistakes that report it, and to others the warnings.

    The warnings are at the same attribute of a robot as the other mistake. Return both.
    """
    left = list(shown)
    others = []
    for mistake in graded:
        finding = mistake.finding
        one = next((reported for reported in left if reported.is_reported_by(mistake)), None)
        if not one:
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
    return left + others


def _is_same_word(problem: Finding, criterion: Finding, source_of: SourceOf) -> bool:
    """Return whether a warning is at the attribute that a criterion is about.

    At a tag, they may be about different things.
    """
    at = problem.location
    if problem.severity == "error" or at != criterion.location:
        return False
    source = source_of(at.path)
    if not source or not at.path.endswith(ROBOT_ENDINGS):
        return False
    return source.line(at.line)[at.column - 1 : at.column] not in ("", "<")


def _diagnostic(look: Look, ranges: TextRanges, shown: _Shown, at: Location) -> lsp.Diagnostic:
    finding = shown.finding
    rule = finding.rule
    return lsp.Diagnostic(
        ranges.range(at),
        f"{shown.message} ({rule.name})" if rule.name else shown.message,
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

    These are what was meant, the calls of macros, and the criteria that fail by it.
    """
    related_places = []
    for name, call in shown.finding.location.calls:
        text = f"the macro {name} is called here"
        related_places.append(lsp.DiagnosticRelatedInformation(ranges.place(call), text))
    related = shown.finding.related
    if related:
        text = "this is what it is compared with"
        related_places.append(lsp.DiagnosticRelatedInformation(ranges.place(related), text))
    for at, text in shown.notes:
        if at.path in look.tree.files:
            related_places.append(lsp.DiagnosticRelatedInformation(ranges.place(at), text))
    return related_places
