"""The result of testing a rubric, as plain text."""

from collections.abc import Iterator, Sequence

from grader.mutation.margins import Margin
from grader.mutation.result import Loss, MutantResults, RubricTest, Survivor
from grader.text import counted, counted_points, enumerated, first_lines, format_points, printable

_MAX_SURVIVORS, _MAX_DIFF, _MAX_LOSSES = 20, 14, 10
_NOTHING = 1e-3  # of a tolerance


def render_rubric_test(test: RubricTest) -> str:
    """Return the result in plain text: what is wrong first, the score last."""
    rubric = test.reference.rubric
    lines = [f"{rubric.id}: {printable(rubric.title)}", "", *_reference(test), *_equivalents(test), *_samples(test)]
    lines += [*_mutants(test.mutants), *_survivors(test.mutants.survivors), *_idle(test.mutants)]
    lines += [*_margins(test.mutants.margins), "", _score(test.mutants)]
    return "\n".join(lines) + "\n"


def _reference(test: RubricTest) -> Iterator[str]:
    report = test.reference
    score, most = format_points(report.score), counted_points(report.max_score - report.pending)
    yield f"Reference    {score} of {most}"
    for result in report.results:
        if result.criterion.id in test.lost:
            yield f"  {result.criterion.id}: {printable(result.outcome.message)}"


def _equivalents(test: RubricTest) -> Iterator[str]:
    found = test.equivalents
    yield f"Equivalents  {sum(found.tried.values())} graded, {_lose(len(found.losses))}"
    yield from _losses(found.losses)


def _samples(test: RubricTest) -> Iterator[str]:
    if test.samples is None:
        return
    skipped = f", {test.samples.skipped} of other rubrics skipped" if test.samples.skipped else ""
    different = len(test.samples.different)
    differ = "all as expected" if not different else f"{different} {'differs' if different == 1 else 'differ'}"
    yield f"Samples      {test.samples.tried} graded, {differ}{skipped}"
    yield from _losses(test.samples.different)


def _lose(count: int) -> str:
    return f"{count or 'none'} {'loses' if count == 1 else 'lose'} points"


def _losses(losses: Sequence[Loss]) -> Iterator[str]:
    lines: list[str] = []
    for loss in losses[:_MAX_LOSSES]:
        lines += ["", f"  {printable(loss.name)}"]
        lines += [f"    {name}: {printable(message)}" for name, message in loss.criteria.items()]
        lines += [f"    {line}" for line in _diff(loss.diff)]
    yield from lines
    if len(losses) > _MAX_LOSSES:
        yield f"  ... and {len(losses) - _MAX_LOSSES} more"


def _mutants(found: MutantResults) -> Iterator[str]:
    sample = f" of {found.total}" if found.tried < found.total else ""
    same = f", {counted(found.same, 'is', 'are')} the same robot" if found.same else ""
    ignored = f", {len(found.ignored)} ignored by the rubric" if found.ignored else ""
    count = len(found.survivors)
    survive = f"{count or 'none'} {'survives' if count == 1 else 'survive'}"
    yield f"Mutants      {found.tried}{sample} graded, {found.caught} lose something{same}{ignored}, {survive}"


def _survivors(survivors: Sequence[Survivor]) -> Iterator[str]:
    if not survivors:
        return
    yield from ("", "These mutants get full marks:")
    for survivor in survivors[:_MAX_SURVIVORS]:
        yield from ("", f"  {printable(survivor.mutant.id)}", f"    {printable(survivor.suggestion)}")
        yield from (f"    {line}" for line in _diff(survivor.diff))
    if len(survivors) > _MAX_SURVIVORS:
        yield from ("", f"  ... and {len(survivors) - _MAX_SURVIVORS} more: --format json lists all")


def _diff(diff: str) -> list[str]:
    return first_lines([printable(line) for line in diff.splitlines()], _MAX_DIFF)


def _idle(found: MutantResults) -> Iterator[str]:
    if found.idle:
        verb = "is" if len(found.idle) == 1 else "are"
        yield from ("", f"No mutant fails {enumerated(found.idle)}, which {verb} idle.")
    for pattern in found.unused:
        yield from ("", f"The pattern {printable(pattern)!r} in [[test.ignore]] matches no mutant.")


def _margins(margins: Sequence[Margin]) -> Iterator[str]:
    if not margins:
        return
    width = max(len(margin.criterion) for margin in margins)
    yield from ("", f"{'Tolerances':{width + 2}}{'tolerance':>12}{'reference':>12}{'passed':>12}{'caught':>12}")
    for margin in margins:
        values = (margin.tolerance, margin.reference, margin.passed, margin.caught)
        cells = ["-" if value is None else _length(value, margin) for value in values]
        near = "  the reference is near the limit" if margin.is_near else ""
        yield f"  {margin.criterion:{width}}" + "".join(f"{cell:>12}" for cell in cells) + near


def _length(value: float, margin: Margin) -> str:
    value = value if value > margin.tolerance * _NOTHING else 0.0
    if margin.unit == "m":
        return f"{value * 1000:.3g} mm"
    return f"{value:.3g} {margin.unit}".rstrip()


def _score(found: MutantResults) -> str:
    return f"Mutation score: {found.score:.1f} %"
