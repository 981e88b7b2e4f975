"""The result of testing a rubric, as plain text and as JSON, schema grader/rubric-test/v1."""

import textwrap
from collections.abc import Iterator, Sequence

from grader import __version__
from grader.grading.criterion import worth
from grader.mutation.samples import Loss
from grader.mutation.testing import MutantResults, RubricTest, Survivor
from grader.report.as_json import SCORE
from grader.report.json_data import (
    COUNT,
    GRADER,
    RUBRIC,
    TEXT,
    TOTAL,
    Many,
    Maybe,
    Record,
    array,
    each,
    inner,
    mapping,
    nullable,
    rounded,
    schema_key,
    to_json,
)
from grader.text import enumerated, first_lines, format_points, printable, without_commands

_MAX_LISTED, _MAX_DIFF = 10, 14
_DEEPEST = 4  # indentation of a sentence


def render_rubric_test(test: RubricTest, width: int) -> str:
    """Return the result in lines of at most this width: what was graded, what is wrong, the score last."""
    rubric = test.reference.rubric
    lines = [f"{rubric.id}: {rubric.title}", "", *_counts(test), *_reference(test)]
    lines += _losses("These equivalents of the reference lose points:", test.equivalents.losses)
    lines += _losses("These samples differ from their expected.toml:", test.samples.different if test.samples else ())
    lines += _losses("On these mutants a check is faulty:", test.mutants.faults)
    lines += [*_survivors(test.mutants.survivors), *_idle(test.mutants)]
    percent = int(test.mutants.score * 10) / 10  # rounded down: 100 only where nothing survived
    lines += ["", f"Mutation score: {percent:g} %"]
    text = "\n".join(folded for line in lines for folded in _fold(printable(line), width))
    return without_commands(f"{text}\n")


def _fold(line: str, width: int) -> list[str]:
    """Return a line that fits: a sentence is wrapped, a line of a diff or table is cut."""
    if len(line) <= width:
        return [line]
    indent = line[: len(line) - len(line.lstrip())]
    if line.lstrip()[:1] in "+-@" or len(indent) > _DEEPEST:
        return [f"{line[: width - 3]}..."]
    return textwrap.wrap(line, width, subsequent_indent=indent + "  ", break_long_words=False, break_on_hyphens=False)


def _counts(test: RubricTest) -> Iterator[str]:
    report, equivalents, samples = test.reference, test.equivalents, test.samples
    decided = worth(
        result.criterion for result in report.results if not result.is_open or result.criterion.id in test.lost
    )
    yield f"Reference    {format_points(report.score)} of {decided.text}"
    if equivalents.tried:
        losing = _some(len(equivalents.losses), "loses", "lose")
        yield f"Equivalents  {len(equivalents.tried)} graded, {losing} points"
    else:
        yield "Equivalents  none graded: ROS 2 does not load the reference without problems"
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
    for loss in losses[:_MAX_LISTED]:
        yield from ("", f"  {loss.name}", *(f"    {name}: {message}" for name, message in loss.criteria.items()))
        yield from _diff(loss.diff)
    if len(losses) > _MAX_LISTED:
        yield from ("", f"  ... and {len(losses) - _MAX_LISTED} more")


def _survivors(survivors: Sequence[Survivor]) -> Iterator[str]:
    if survivors:
        yield from ("", "These mutants of the reference get full marks:")
    for survivor in survivors[:_MAX_LISTED]:
        yield from ("", f"  {survivor.mutant.id}", *_diff(survivor.diff))
    if survivors:
        more = f"... and {len(survivors) - _MAX_LISTED} more, which --format json lists. "
        accept = "To accept one, add it to [[test.ignore]] with a reason."
        yield from ("", f"{more if len(survivors) > _MAX_LISTED else ''}{accept}")


def _diff(diff: str) -> list[str]:
    return [f"      {line}" for line in first_lines(diff.splitlines(), _MAX_DIFF)]


def _idle(found: MutantResults) -> Iterator[str]:
    if found.idle:
        subject, verb = ("No graded mutant", "may be") if found.tried < found.total else ("No mutant", "")
        verb = verb or ("is" if len(found.idle) == 1 else "are")
        yield from (
            "",
            f"{subject} fails {enumerated(found.idle)}: {'it' if len(found.idle) == 1 else 'they'} {verb} idle.",
        )
    for pattern in found.unused:
        yield from ("", f"The pattern {pattern!r} of [[test.ignore]] matches no mutant.")


_LOSSES = Many(Record({"name": TEXT, "criteria": mapping(TEXT), "diff": TEXT}))
_SURVIVOR = Record(
    {
        **inner("mutant", {**each(TEXT, "id family path"), "line": COUNT}),
        "diff": TEXT,
        "reason": (nullable(TEXT), lambda survivor: survivor.reason or None),
    }
)
_MUTANTS = Record(
    {
        **each(TOTAL, "total tried caught"),
        "same_robot": (TOTAL, "same"),
        "ignored": (TOTAL, lambda found: len(found.ignored)),
        "survived": (TOTAL, lambda found: len(found.survivors)),
    }
)
_EQUIVALENTS = Record({"tried": array(TEXT), "lost": (_LOSSES, "losses")})
RUBRIC_TEST = Record(
    {
        **schema_key("grader/rubric-test/v1"),
        "grader": (GRADER, lambda _: {"version": __version__}),
        "rubric": (RUBRIC, "reference.rubric"),
        "score": ({"type": "number", "minimum": 0, "maximum": 100}, lambda test: rounded(float(test.mutants.score))),
        "reference": (Record({**inner("reference", SCORE), "lost": array(TEXT)}), lambda test: test),
        "equivalents": _EQUIVALENTS,
        "samples": Maybe(Record({**each(TOTAL, "tried skipped"), "different": _LOSSES})),
        "mutants": _MUTANTS,
        **inner("mutants", each(Many(_SURVIVOR), "survivors ignored")),
        "faults": (_LOSSES, "mutants.faults"),
        "unused_patterns": (array(TEXT), "mutants.unused"),
        **inner("mutants", {"idle": array(TEXT)}),
    }
)


def render_rubric_test_json(test: RubricTest) -> str:
    """Return the result of testing a rubric."""
    return to_json(RUBRIC_TEST.data(test))
