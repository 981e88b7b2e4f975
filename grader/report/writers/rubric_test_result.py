"""The result of testing a rubric, as plain text and as JSON, schema grader/rubric-test/v1."""

import re
import textwrap
from collections.abc import Iterator, Sequence
from os.path import commonprefix

from grader import __version__
from grader.base.text import (
    counted,
    enumerated,
    first_lines,
    format_points,
    printable,
    without_commands,
)
from grader.files.limits import ROBOT_ENDINGS
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

_MAX_LISTED, _MAX_DIFF = 10, 14
_DEEPEST = 4  # indentation of a sentence
_OF_ELEMENT = ("element deleted", "visual added")  # families of mutants whose place is no attribute
_NUMBER_OF_ID = re.compile(r" \(\d+\)$")  # of equal ones


def render_rubric_test(test: RubricTest, width: int) -> str:
    """Return the result in lines of at most this width: what was graded, what is wrong, the score
    last.
    """
    results = test.reference.results
    lost = [
        f"  {it.criterion.id}: {it.outcome.message}"
        for it in results
        if it.criterion.id in test.lost
    ]
    lines = [f"{test.reference.rubric.id}: {test.reference.rubric.title}", "", *_count_lines(test)]
    if lost:
        lines += ["", "The reference does not get full marks:", *lost]
    differing = test.samples.different if test.samples else ()
    lines += _listed("These equivalents of the reference lose points:", test.losses, width)
    lines += _listed("These samples differ from their expected.toml:", differing, width)
    lines += _listed("On these mutants a check is faulty:", test.faults, width)
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
    percent = int(test.score * 10) / 10  # rounded down: 100 only where nothing survived
    lines += ["", f"Mutation score: {percent:g} %"]
    text = "\n".join(folded for line in lines for folded in _fold(printable(line), width))
    return without_commands(f"{text}\n")


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
    indent = line[: len(line) - len(line.lstrip())]
    if line.lstrip()[:1] in "+-@" or len(indent) > _DEEPEST:
        return [f"{line[: width - 3]}..."]
    return textwrap.wrap(
        line, width, subsequent_indent=indent + "  ", break_long_words=False, break_on_hyphens=False
    )


def _count_lines(test: RubricTest) -> Iterator[str]:
    report, samples = test.reference, test.samples
    decided = worth(
        it.criterion for it in report.results if not it.is_open or it.criterion.id in test.lost
    )
    yield f"Reference    {format_points(report.score)} of {decided.text}"
    if test.equivalents:
        yield (
            f"Equivalents  {len(test.equivalents)} graded, "
            f"{_count_or_none(len(test.losses), 'loses', 'lose')} points"
        )
    else:
        yield "Equivalents  none graded: ROS 2 does not load the reference without problems"
    if samples is not None:
        skipped = f", {samples.skipped} of other rubrics skipped" if samples.skipped else ""
        differ = _count_or_none(len(samples.different), "differs", "differ")
        yield f"Samples      {samples.tried} graded, {differ} from expected.toml{skipped}"
    sample = f" of {test.total}" if test.tried < test.total else ""
    same = f", {test.same} {'is' if test.same == 1 else 'are'} the same robot" if test.same else ""
    ignored = f", {len(test.ignored)} ignored by the rubric" if test.ignored else ""
    survive = _count_or_none(len(test.survivors), "survives", "survive")
    yield (
        f"Mutants      {test.tried}{sample} graded, {test.caught} lose points{same}{ignored}, "
        f"{survive}"
    )


def _count_or_none(count: int, one: str, several: str) -> str:
    return f"{count or 'none'} {one if count == 1 else several}"


def _by_element(test: RubricTest) -> list[Loss]:
    """Return the mutants that survive: those of one element, or of one line of another file, with
    the first diff.
    """
    groups: dict[str, list[str]] = {}
    diffs: dict[str, str] = {}
    for mutant, diff, _ in test.survivors:
        label = _NUMBER_OF_ID.sub("", mutant.id.partition(": ")[2].partition(" -> ")[0])
        of_attribute = " " in label and mutant.family not in _OF_ELEMENT
        element = label.rpartition(" ")[0] if of_attribute else label
        is_of_robot = mutant.path.endswith(ROBOT_ENDINGS)
        if is_of_robot:
            place = f"{element} in {mutant.path}"
        else:
            place = f"{mutant.path}, line {mutant.line}"
        groups.setdefault(place, []).append(mutant.id)
        diffs.setdefault(place, diff)
    return [
        Loss(
            "\n    ".join([f"{place}: {len(ids)} mutants", *first_lines(ids, _MAX_LISTED)]),
            {},
            diffs[place],
        )
        if len(ids) > 1
        else Loss(ids[0], {}, diffs[place])
        for place, ids in groups.items()
    ]


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
    changed = [it for it in lines if it[:1] in ("-", "+") and it[:4] not in ("--- ", "+++ ")]
    shared = commonprefix([it[1:] for it in changed]) if len(changed) > 1 else ""  # noqa: RUF071  of texts, not of paths
    start = max(len(shared) - room // 3, 0)
    return [
        f"{it[0]}...{it[1 + start :]}" if it in changed and start and len(it) > room else it
        for it in lines
    ]


_LOSSES = Many(JsonObject({"name": TEXT, "criteria": mapping(TEXT), "diff": TEXT}))
_SURVIVOR = JsonObject(
    {
        **inner("mutant", {**each(TEXT, "id family path"), "line": COUNT}),
        "diff": TEXT,
        "reason": (nullable(TEXT), lambda survivor: survivor.reason or None),
    }
)
_MUTANTS = JsonObject(
    {
        **each(TOTAL, "total tried caught"),
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
        "faults": _LOSSES,
        "unused_patterns": (array(TEXT), "unused"),
        **each(array(TEXT), "idle unexamined"),
    }
)


def render_rubric_test_json(test: RubricTest) -> str:
    """Return the result of testing a rubric."""
    return to_json(RUBRIC_TEST.data(test))
