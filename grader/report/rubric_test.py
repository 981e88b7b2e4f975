"""The result of testing a rubric, as plain text and as JSON, schema grader/rubric-test/v1."""

import textwrap
from collections.abc import Iterator, Sequence
from os.path import commonprefix
from typing import Any

from grader import __version__
from grader.grading.worth import worth
from grader.mutation.result import Loss, Margin, MutantResults, RubricTest, Survivor
from grader.report.json_data import exact, rounded, to_json
from grader.text import counted, enumerated, first_lines, format_points, printable, without_commands

_MAX_OF_GROUP, _MAX_GROUPS, _MAX_DIFF, _MAX_LOSSES = 3, 12, 14, 10
_DEEPEST = 4  # indentation of a sentence
_AROUND = 20  # characters of a long line before what changes


def render_rubric_test(test: RubricTest, width: int) -> str:
    """Return the result in lines of at most this width: what was graded, what is wrong, the score last."""
    rubric = test.reference.rubric
    lines = [f"{rubric.id}: {rubric.title}", "", *_counts(test), *_reference(test)]
    lines += _losses("These equivalents of the reference lose points:", test.equivalents.losses)
    lines += _losses("These samples differ from their expected.toml:", test.samples.different if test.samples else ())
    lines += _losses("On these mutants a check is faulty:", test.mutants.faults)
    lines += [*_survivors(test.mutants.survivors), *_idle(test.mutants), *_near(test.mutants.margins)]
    lines += ["", f"Mutation score: {_percent(test.mutants)} %"]
    text = "\n".join(folded for line in lines for folded in _folded(printable(line), width))
    return without_commands(f"{text}\n")


def _folded(line: str, width: int) -> list[str]:
    """Return a line that fits: a sentence is wrapped, a line of a diff or table is cut."""
    if len(line) <= width:
        return [line]
    indent = line[: len(line) - len(line.lstrip())]
    if line.lstrip()[:1] in "+-@" or len(indent) > _DEEPEST:
        return [f"{line[: width - 3]}..."]
    return textwrap.wrap(line, width, subsequent_indent=indent + "  ", break_long_words=False, break_on_hyphens=False)


def _percent(found: MutantResults) -> str:
    """Return the score, rounded down: 100 only where nothing survived."""
    return f"{int(found.score * 10) / 10:g}"


def _counts(test: RubricTest) -> Iterator[str]:
    report, equivalents, samples = test.reference, test.equivalents, test.samples
    decided = worth(
        result.criterion for result in report.results if not result.is_open or result.criterion.id in test.lost
    )
    yield f"Reference    {format_points(report.score)} of {decided.text}"
    if equivalents.tried:
        losing = _some(len(equivalents.losses), "loses", "lose")
        yield f"Equivalents  {sum(equivalents.tried.values())} graded, {losing} points"
    else:
        yield f"Equivalents  none graded: {next(iter(equivalents.unused.values()), '')}"
    if samples is not None:
        skipped = f", {samples.skipped} of other rubrics skipped" if samples.skipped else ""
        differ = _some(len(samples.different), "differs", "differ")
        yield f"Samples      {samples.tried} graded, {differ} from expected.toml{skipped}"
    found = test.mutants
    sample = f" of {found.total}" if found.tried < found.total else ""
    same = f", {found.same} {'is' if found.same == 1 else 'are'} the same robot" if found.same else ""
    ignored = f", {len(found.ignored)} ignored by the rubric" if found.ignored else ""
    survive = _some(len(found.survivors), "survives", "survive")
    yield f"Mutants      {found.tried}{sample} graded, {found.caught} lose points{same}{ignored}, {survive}"


def _some(count: int, one: str, several: str) -> str:
    return f"{count or 'none'} {one if count == 1 else several}"


def _reference(test: RubricTest) -> Iterator[str]:
    if test.lost:
        yield from ("", "The reference does not get full marks:")
    for result in test.reference.results:
        if result.criterion.id in test.lost:
            yield f"  {result.criterion.id}: {result.outcome.message}"


def _losses(title: str, losses: Sequence[Loss]) -> Iterator[str]:
    if losses:
        yield from ("", title)
    for loss in losses[:_MAX_LOSSES]:
        yield from ("", f"  {loss.name}", *(f"    {name}: {message}" for name, message in loss.criteria.items()))
        yield from _diff(loss.diff)
    if len(losses) > _MAX_LOSSES:
        yield from ("", f"  ... and {len(losses) - _MAX_LOSSES} more")


def _survivors(survivors: Sequence[Survivor]) -> Iterator[str]:
    """Yield the survivors by what may catch them, the most frequent first."""
    groups: dict[str, list[Survivor]] = {}
    for survivor in survivors:
        groups.setdefault(survivor.suggestion, []).append(survivor)
    if groups:
        yield from ("", "These mutants of the reference get full marks:")
    ordered = sorted(groups.items(), key=lambda group: -len(group[1]))
    for suggestion, group in ordered[:_MAX_GROUPS]:
        yield from ("", f"{counted(len(group), 'mutant')}: {suggestion}")
        for survivor in group[:_MAX_OF_GROUP]:
            yield from (f"  {survivor.mutant.id}", *_diff(survivor.diff))
        if len(group) > _MAX_OF_GROUP:
            yield f"  ... and {len(group) - _MAX_OF_GROUP} more"
    hidden = sum(len(group) for _, group in ordered[_MAX_GROUPS:])
    if hidden:
        yield from ("", f"... and {counted(hidden, 'other mutant')}")
    if hidden or any(len(group) > _MAX_OF_GROUP for _, group in ordered):
        yield "--format json lists all. To accept one, add it to [[test.ignore]] with a reason."


def _diff(diff: str) -> list[str]:
    """Return the lines of a diff; of a long line that changes, what is around the change."""
    lines = first_lines(diff.splitlines(), _MAX_DIFF)
    changed = [line[1:] for line in lines[3:] if line[:1] in "+-"]
    before = len(commonprefix(changed)) - _AROUND if len(changed) == 2 else 0  # noqa: RUF071  of texts, not of paths
    if before > _AROUND:
        lines = [
            f"{line[0]}...{line[1 + before :]}" if line[:1] in "+-" and i > 2 else line for i, line in enumerate(lines)
        ]
    return [f"      {line}" for line in lines]


def _idle(found: MutantResults) -> Iterator[str]:
    if found.idle:
        yield from (
            "",
            f"No mutant fails {enumerated(found.idle)}: {'it is' if len(found.idle) == 1 else 'they are'} idle.",
        )
    for pattern in found.unused:
        yield from ("", f"The pattern {pattern!r} of [[test.ignore]] matches no mutant.")


def _near(margins: Sequence[Margin]) -> Iterator[str]:
    for margin in margins:
        if margin.is_near:
            off, limit = _length(margin.reference, margin), _length(margin.tolerance, margin)
            yield from ("", f"The reference is near the limit of {margin.criterion}: {off} off, {limit} allowed.")


def _length(value: float, margin: Margin) -> str:
    if margin.unit == "m":
        return f"{value * 1000:.3g} mm"
    return f"{value:.3g} {margin.unit}".rstrip()


def render_rubric_test_json(test: RubricTest) -> str:
    """Return the result of testing a rubric."""
    report, rubric, samples = test.reference, test.reference.rubric, test.samples
    return to_json(
        {
            "schema": "grader/rubric-test/v1",
            "grader": {"version": __version__},
            "rubric": {"id": rubric.id, "title": rubric.title, "sha256": rubric.sha256},
            "seed": test.seed,
            "score": rounded(float(test.mutants.score)),
            "reference": {
                "score": exact(report.score),
                "max_score": exact(report.max_score),
                "pending": exact(report.pending),
                "lost": list(test.lost),
            },
            "equivalents": {
                "tried": dict(test.equivalents.tried),
                "unused": dict(test.equivalents.unused),
                "lost": list(map(_loss, test.equivalents.losses)),
            },
            "samples": {
                "tried": samples.tried,
                "skipped": samples.skipped,
                "different": list(map(_loss, samples.different)),
            }
            if samples is not None
            else None,
            "mutants": {
                "total": test.mutants.total,
                "tried": test.mutants.tried,
                "caught": test.mutants.caught,
                "same_robot": test.mutants.same,
                "ignored": len(test.mutants.ignored),
                "survived": len(test.mutants.survivors),
            },
            "survivors": list(map(_survivor, test.mutants.survivors)),
            "ignored": list(map(_survivor, test.mutants.ignored)),
            "faults": list(map(_loss, test.mutants.faults)),
            "unused_patterns": list(test.mutants.unused),
            "idle": list(test.mutants.idle),
            "margins": list(map(_margin, test.mutants.margins)),
        }
    )


def _survivor(survivor: Survivor) -> dict[str, Any]:
    mutant = survivor.mutant
    return {
        "id": mutant.id,
        "family": mutant.family,
        "path": mutant.path,
        "line": mutant.line,
        "diff": survivor.diff,
        "suggestion": survivor.suggestion,
        "reason": survivor.reason or None,
    }


def _loss(loss: Loss) -> dict[str, Any]:
    return {"name": loss.name, "criteria": dict(loss.criteria), "diff": loss.diff}


def _margin(margin: Margin) -> dict[str, Any]:
    return {
        "criterion": margin.criterion,
        "unit": margin.unit or None,
        "tolerance": rounded(margin.tolerance),
        "reference": rounded(margin.reference),
        "is_near": margin.is_near,
    }
