"""Rubrics, checks and problems in plain text, for those who write rubrics and those who are graded by them."""

import inspect
import textwrap

from grader.checks.registry import Check, check_names, find_check
from grader.errors import InputError
from grader.grading.arguments import type_words
from grader.grading.rubric import Criterion, Rubric
from grader.names import did_you_mean
from grader.package.catalogue import PACKAGE_CATALOGUE
from grader.problems import Kind
from grader.robot.catalogue import CATALOGUE
from grader.text import format_points, printable

_WIDTH = 80
EVERY_KIND = (*CATALOGUE, *PACKAGE_CATALOGUE)
EFFECTS = {
    "rejects": "ROS 2 rejects the file.",
    "drops": "ROS 2 loads the file, but drops content of it.",
    "loads": "ROS 2 loads the file.",
    "other": "",
}


def rubric_text(rubric: Rubric) -> str:
    """A rubric part by part, a line for each criterion, and the model answers that it was loaded with."""
    lines = [f"{rubric.id}: {rubric.title} ({format_points(rubric.points)} points)", f"sha256 {rubric.sha256}"]
    for part in rubric.parts:
        rows = [each for each in rubric.criteria if each.part == part.id]
        lines += ["", f"{part.id}: {part.title}"]
        width = max((len(each.id) for each in rows), default=0)
        for each in rows:
            lines.append(f"  {each.id:<{width}}  {format_points(each.points):>4}  {printable(each.title)}")
            if each.answer:
                lines.append(textwrap.indent(_filled(f"Model answer: {printable(each.answer)}"), "    "))
    return "\n".join(lines) + "\n"


def checks_text() -> str:
    """Every check with the fact that it states and the arguments that it takes."""
    return "\n".join(map(_listed, check_names()))


def _listed(name: str) -> str:
    try:
        check = find_check(name)
    except InputError as error:  # another package's fault must not hide the other checks
        return f"{name}\n  {error}\n"
    return _check_lines(check) if check is not None else ""


def explanation(name: str, rubric: Rubric) -> str:
    """What is to say about a code, a criterion or a check; raises InputError for a name that is none of them."""
    for kind in EVERY_KIND:
        if kind.code == name.upper():
            return _kind_text(kind)
    for criterion in rubric.criteria:
        if criterion.id == name:
            return _criterion_text(criterion, rubric)
    check = find_check(name)
    if check is not None:
        return _check_text(check)
    known = [kind.code for kind in EVERY_KIND] + [each.id for each in rubric.criteria] + check_names()
    lists = f"; {rubric.shown_by} lists the criteria, grader rubric checks the checks, and reports name the codes"
    guess = did_you_mean(name, known) or lists
    raise InputError(f"there is nothing to explain under {name!r}{guess}")


def _kind_text(kind: Kind) -> str:
    effect = f"\n{EFFECTS[kind.effect]}\n" if EFFECTS[kind.effect] else ""
    return f"{kind.code} ({kind.severity}): {kind.title}\n\n{_filled(kind.explanation)}\n{effect}"


def _criterion_text(criterion: Criterion, rubric: Rubric) -> str:
    lines = [
        f"{criterion.id} (points: {format_points(criterion.points)}; part {criterion.part} of {rubric.id})",
        "",
        _filled(f"Passes when: {criterion.title}."),
    ]
    if criterion.feedback:
        lines += ["", _filled(criterion.feedback)]
    if criterion.requires:
        lines += ["", _filled(f"Decided only if these passed: {', '.join(criterion.requires)}.")]
    given = ", ".join(f"{key} = {_toml(value)}" for key, value in criterion.arguments.items())
    lines += ["", _filled(f"How it is decided: {criterion.check.name}. {criterion.check.fact}")]
    if given:
        lines += [_filled(f"With {given}.")]
    return "\n".join(lines) + "\n"


def _check_text(check: Check) -> str:
    text = "\n\n".join(_filled(each) for each in (inspect.getdoc(check.function) or "").split("\n\n"))
    return f"{check.name}: a check that a rubric can name\n\n{text}\n{_arguments(check)}"


def _check_lines(check: Check) -> str:
    return f"{check.name}\n{textwrap.indent(_filled(check.fact), '  ')}\n{_arguments(check)}"


def _arguments(check: Check) -> str:
    lines = []
    for each in check.parameters.values():
        default = "" if each.required else f", {_toml(each.default)} unless told"
        lines.append(f"    {each.name}: {type_words(each.type)}{default}\n")
    return "".join(lines)


def _toml(value: object) -> str:
    match value:
        case bool():
            return str(value).lower()
        case str():
            return f'"{value}"'
        case float():
            return f"{value:g}"
        case list() | tuple():
            return f"[{', '.join(map(_toml, value))}]"
        case dict():
            return "{ " + ", ".join(f"{key} = {_toml(each)}" for key, each in value.items()) + " }"
        case _:
            return str(value)


def _filled(text: str) -> str:
    return textwrap.fill(" ".join(text.split()), _WIDTH, break_long_words=False, break_on_hyphens=False)
