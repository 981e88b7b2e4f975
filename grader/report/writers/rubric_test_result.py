"""The result of testing a rubric, as plain text and as JSON, schema grader/rubric-test/v1."""

import textwrap
from collections import Counter
from collections.abc import Iterator, Sequence
from os.path import commonprefix

from grader import __version__
from grader.base.patterns import on_use
from grader.base.text import (
    counted,
    enumerated,
    first_lines,
    format_points,
    indent_of,
    printable,
    without_commands,
)
from grader.files.limits import ROBOT_ENDINGS
from grader.lab.authoring.mutants import Mutant
from grader.lab.authoring.rubric_test import RubricTest
from grader.lab.authoring.samples import Loss
from grader.lab.rubric.criterion import worth
from grader.report.json_data import (
    COUNT,
    GRADER,
    RUBRIC,
    TEXT,
    TOTAL,
    JsonObject,
    Many,
    Maybe,
    array,
    each,
    inner,
    mapping,
    nullable,
    rounded,
    schema_key,
    to_json,
)
from grader.report.writers.as_json import SCORE

_MAX_LISTED = 10
_MAX_DIFF = 14
_DEEPEST = 4  # indentation of a sentence
_OF_ELEMENT = ("element deleted", "visual added")  # mutations whose place is no attribute
_NUMBER_OF_ID = on_use(r" \(\d+\)$")  # of equal ones


def render_rubric_test(test: RubricTest, width: int) -> str:
    """Return the result in lines of at most this width.

    They say what was graded and what is wrong; the score comes last.
    """
    lines = [f"{test.reference.rubric.id}: {test.reference.rubric.title}", "", *_count_lines(test)]
    if test.lost:
        lines += ["", "The reference does not get full marks:"]
        for result in test.reference.results:
            if result.id in test.lost:
                lines.append(f"  {result.id}: {result.outcome.message}")
    differing = test.samples.different if test.samples else ()
    lines += _listed("These equivalents of the reference lose points:", test.losses, width)
    lines += _listed("These samples differ from their expected.toml:", differing, width)
    lines += _listed("On these mutants a check is faulty:", test.faults, width)
    lines += _listed(
        "These mutants take more work than one submission may use, and do not count:",
        test.over_budget,
        width,
    )
    lines += _listed("These mutants of the reference get full marks:", _by_element(test), width)
    if test.survivors:
        lines += ["", "To accept a mutant, add it to [[test.ignore]] with a reason."]
    if test.idle:
        mutant = "mutant" if test.tried == test.total else "graded mutant"
        lines += ["", f"Idle criteria, which no {mutant} fails: {enumerated(test.idle)}"]
    if test.unexamined:
        lines += ["", unexamined_line(test.unexamined, test.files)]
    for pattern in test.unused:
        lines += ["", f"The pattern {pattern!r} of [[test.ignore]] matches no mutant."]
    if test.is_interrupted:
        left = test.total - test.tried
        lines += ["", f"Interrupted: {counted(left, 'mutant')} and the equivalents are left."]
    lines += _kind_lines(test)
    percent = int(test.score * 10) / 10  # rounded down: 100 only where nothing survived
    so_far = " so far" if test.is_interrupted else ""
    lines += ["", f"Mutation score{so_far}: {percent:g} %"]
    text = "\n".join(folded for line in lines for folded in _fold(printable(line), width))
    return without_commands(f"{text}\n")


def _kind_lines(test: RubricTest) -> Iterator[str]:
    """Yield the score of each kind, if there are several, and why mutants may survive."""
    if len(test.kinds) > 1:
        shown = [f"{kind.kind} {kind.caught}/{kind.graded}" for kind in test.kinds]
        yield from ("", f"By kind: {', '.join(shown)}")
    given = {row.reason for row in test.reference.rubric.ignored}
    reasons = Counter(mutant.reason for mutant in test.ignored if mutant.reason not in given)
    for reason, count in reasons.items():
        yield from ("", f"{counted(count, 'mutant')} may survive: {reason}.")


def unexamined_line(paths: Sequence[str], count: int) -> str:
    """Return which of the files of a reference no criterion looks at."""
    return (
        f"No criterion looks at {enumerated(paths, _MAX_LISTED)}: {len(paths)} of "
        f"{counted(count, 'file')}"
    )


def _fold(line: str, width: int) -> list[str]:
    """Return a line that fits: a sentence is wrapped, a line of a diff or table is cut."""
    if len(line) <= width:
        return [line]
    indent = indent_of(line)
    if line.lstrip()[:1] in "+-@" or len(indent) > _DEEPEST:
        return [f"{line[: width - 3]}..."]
    return textwrap.wrap(
        line, width, subsequent_indent=indent + "  ", break_long_words=False, break_on_hyphens=False
    )


def _count_lines(test: RubricTest) -> Iterator[str]:
    report = test.reference
    samples = test.samples
    decided = worth(
        result.criterion
        for result in report.results
        if not result.is_open or result.id in test.lost
    )
    yield f"Reference    {format_points(report.score)} of {decided.text}"
    if test.equivalents:
        lose = _count_or_none(len(test.losses), "loses", "lose")
        yield f"Equivalents  {len(test.equivalents)} graded, {lose} points"
    elif not test.is_interrupted and report.submission.path is None:
        yield "Equivalents  none of this reference"
    elif not test.is_interrupted:
        yield "Equivalents  none graded: ROS 2 does not load the reference without problems"
    if samples:
        differ = _count_or_none(len(samples.different), "differs", "differ")
        line = f"Samples      {samples.tried} graded, {differ} from expected.toml"
        if samples.skipped:
            line += f", {samples.skipped} of other rubrics skipped"
        yield line
    yield _mutants_line(test)


def _mutants_line(test: RubricTest) -> str:
    """Return how many mutants were graded, and what became of them."""
    line = f"Mutants      {test.tried}"
    if test.tried < test.total:
        line += f" of {test.total}"
    line += f" graded, {test.caught} lose points"
    if test.same:
        line += f", {test.same} {'is' if test.same == 1 else 'are'} the same robot"
    if test.ignored:
        line += f", {len(test.ignored)} ignored"
    if test.over_budget:
        line += f", {len(test.over_budget)} over budget"
    return f"{line}, {_count_or_none(len(test.survivors), 'survives', 'survive')}"


def _count_or_none(count: int, one: str, several: str) -> str:
    return f"{count or 'none'} {one if count == 1 else several}"


def _by_element(test: RubricTest) -> list[Loss]:
    """Return the mutants that survive, with the first diff.

    Those of one element, or of one line of another file, are together.
    """
    groups: dict[str, list[str]] = {}
    diffs: dict[str, str] = {}
    for mutant, diff, _ in test.survivors:
        place = _place(mutant)
        groups.setdefault(place, []).append(mutant.id)
        diffs.setdefault(place, diff)
    losses = []
    for place, ids in groups.items():
        name = ids[0]
        if len(ids) > 1:
            listed = first_lines(ids, _MAX_LISTED)
            name = "\n    ".join([f"{place}: {len(ids)} mutants", *listed])
        losses.append(Loss(name, {}, diffs[place]))
    return losses


def _place(mutant: Mutant) -> str:
    """Return the element, or the line of another file, that a mutant changes."""
    if not mutant.path.endswith(ROBOT_ENDINGS):
        return f"{mutant.path}, line {mutant.line}"
    _, _, change = mutant.id.partition(": ")
    element = _NUMBER_OF_ID.sub("", change.partition(" -> ")[0])
    if " " in element and mutant.mutation not in _OF_ELEMENT:
        element = element.rpartition(" ")[0]  # without its attribute
    return f"{element} in {mutant.path}"


def _listed(title: str, losses: Sequence[Loss], width: int) -> Iterator[str]:
    if losses:
        yield from ("", title)
    for loss in losses[:_MAX_LISTED]:
        criteria = (f"    {name}: {message}" for name, message in loss.criteria.items())
        yield from ("", *f"  {loss.name}".split("\n"), *criteria)
        diff = first_lines(loss.diff.splitlines(), _MAX_DIFF)
        yield from (f"      {line}" for line in _cut(diff, width - len("      ")))
    if len(losses) > _MAX_LISTED:
        yield from ("", f"  ... and {len(losses) - _MAX_LISTED} more, which --format json lists")


def _cut(lines: Sequence[str], room: int) -> list[str]:
    """Return the lines of a diff; those that are too long begin shortly before the change."""
    changed = [
        line for line in lines if line[:1] in ("-", "+") and line[:4] not in ("--- ", "+++ ")
    ]
    shared = commonprefix([line[1:] for line in changed]) if len(changed) > 1 else ""  # noqa: RUF071  of texts, not of paths
    start = max(len(shared) - room // 3, 0)
    return [
        f"{line[0]}...{line[1 + start :]}"
        if line in changed and start and len(line) > room
        else line
        for line in lines
    ]


_LOSSES = Many(JsonObject({"name": TEXT, "criteria": mapping(TEXT), "diff": TEXT}))
_SURVIVOR = JsonObject(
    {
        **inner("mutant", {"id": TEXT}),
        "family": (TEXT, "mutant.mutation"),
        **inner("mutant", {"path": TEXT, "line": COUNT}),
        "diff": TEXT,
        "reason": (nullable(TEXT), lambda survivor: survivor.reason or None),
    }
)
_MUTANTS = JsonObject(
    {
        **each(TOTAL, "total tried caught"),
        "kinds": (
            Many(JsonObject({"kind": TEXT, **each(TOTAL, "caught graded")})),
            lambda test: test.kinds,
        ),
        "same_robot": (TOTAL, "same"),
        "ignored": (TOTAL, lambda test: len(test.ignored)),
        "survived": (TOTAL, lambda test: len(test.survivors)),
    }
)
_EQUIVALENTS = JsonObject({"tried": (array(TEXT), "equivalents"), "lost": (_LOSSES, "losses")})
RUBRIC_TEST = JsonObject(
    {
        **schema_key("grader/rubric-test/v1"),
        "grader": (GRADER, lambda _: {"version": __version__}),
        "rubric": (RUBRIC, "reference.rubric"),
        "score": (
            {"type": "number", "minimum": 0, "maximum": 100},
            lambda test: rounded(float(test.score)),
        ),
        "reference": (
            JsonObject({**inner("reference", SCORE), "lost": array(TEXT)}),
            lambda test: test,
        ),
        "equivalents": (_EQUIVALENTS, lambda test: test),
        "samples": Maybe(JsonObject({**each(TOTAL, "tried skipped"), "different": _LOSSES})),
        "mutants": (_MUTANTS, lambda test: test),
        **each(Many(_SURVIVOR), "survivors ignored"),
        **each(_LOSSES, "faults over_budget"),
        "unused_patterns": (array(TEXT), "unused"),
        **each(array(TEXT), "idle unexamined"),
    }
)


def render_rubric_test_json(test: RubricTest) -> str:
    """Return the result of testing a rubric."""
    return to_json(RUBRIC_TEST.data(test))
