"""Rubrics, checks and problem codes in plain text, and a rubric as Markdown for the lab's handout."""

import textwrap
from collections.abc import Iterable, Iterator, Mapping, Sequence

from grader.checks.check import Check
from grader.checks.manual import MANUAL_CHECKS
from grader.checks.registry import check_names, find_check, unused_checks
from grader.errors import InputError
from grader.grading.criterion import Criterion, Part, worth
from grader.grading.rubric import Rubric
from grader.names import did_you_mean
from grader.package.catalogue import PACKAGE_CATALOGUE
from grader.problems import Kind
from grader.report.details import model_lines, sentence
from grader.report.examples import examples, explanation_of, toml_text
from grader.report.markdown import code, escape
from grader.robot.catalogue import CATALOGUE
from grader.text import enumerated, format_points, printable
from grader.xacro.catalogue import XACRO_CATALOGUE

_WIDTH = 80
EVERY_KIND = (*CATALOGUE, *XACRO_CATALOGUE, *PACKAGE_CATALOGUE)
EFFECTS = {
    "rejects": "ROS 2 rejects the file.",
    "undetermined": "The criteria that depend on it need manual grading.",
    "drops": "ROS 2 loads the file, but drops content of it.",
    "loads": "ROS 2 loads the file.",
    "other": "",
}


def rubric_overview(rubric: Rubric) -> str:
    """Return the parts and criteria of a rubric, with the model answers that it was loaded with."""
    lines = [f"{rubric.id}: {rubric.title} ({worth(rubric.criteria).text})", f"sha256 {rubric.sha256}"]
    for part in rubric.parts:
        criteria = [criterion for criterion in rubric.criteria if criterion.part == part.id]
        lines += ["", f"{part.id}: {part.title}"]
        width = max((len(criterion.id) for criterion in criteria), default=0)
        for criterion in criteria:
            points = format_points(criterion.points)
            bonus = " (bonus)" if criterion.bonus else ""
            lines.append(f"  {criterion.id:<{width}}  {points:>4}  {printable(criterion.title)}{bonus}")
            if criterion.adjustment is not None:
                lines.append(textwrap.indent(_fill(sentence(criterion.adjustment.message)), "    "))
            if criterion.answer:
                answer = printable(" ".join(model_lines(criterion)))
                lines.append(textwrap.indent(_fill(f"Model answer: {answer}"), "    "))
    return "\n".join(lines) + "\n"


def checks_text() -> str:
    """Return every check with the package that it comes from, the fact that it tests, and its arguments."""
    listed = []
    for name in check_names():
        try:
            check = find_check(name)
        except InputError as error:  # a broken plug-in must not hide the other checks
            listed.append(f"{name}\n  {error}\n")
            continue
        if check is not None:
            fact = textwrap.indent(_fill(check.documentation.fact), "  ")
            listed.append(f"{name} ({check.distribution or 'grader'})\n{fact}\n{_arguments(check)}")
    for name, package in unused_checks():
        listed.append(f"{name} ({package})\n  Not used: the grader has a check of this name.\n")
    return "\n".join(listed)


def kind_of(code: str) -> Kind | None:
    """Return the kind of problem with a code; None if there is none."""
    return next((kind for kind in EVERY_KIND if kind.code == code), None)


def explanation(name: str, rubric: Rubric) -> str:
    """Return the explanation of a code, a criterion or a check. Raises InputError for another name."""
    kind = kind_of(name.upper())
    if kind is not None:
        texts = [f"{kind.code} ({kind.severity}): {kind.title}", _fill(explanation_of(kind)), EFFECTS[kind.effect]]
        return _paragraphs([*texts, *examples(kind.code)])
    for criterion in rubric.criteria:
        if criterion.id == name:
            return _paragraphs(_criterion_texts(criterion, rubric))
    check = find_check(name)
    if check is not None:
        source = f", from the package {check.distribution}" if check.distribution else ""
        texts = [f"{check.name}: a check for rubrics{source}", *map(_fill, check.documentation.paragraphs)]
        return _paragraphs([*texts, _arguments(check).rstrip("\n"), *examples(check.name)])
    known = [kind.code for kind in EVERY_KIND] + [criterion.id for criterion in rubric.criteria] + check_names()
    lists = (
        f"`{rubric.shown_by}` lists the criteria, `grader rubric checks` lists the checks, and reports show the codes"
    )
    raise InputError(
        f"there is no problem code, criterion or check {name!r}{did_you_mean(name, known) or f'; {lists}'}"
    )


def _paragraphs(texts: Iterable[str]) -> str:
    return "\n\n".join(filter(None, texts)) + "\n"


def _criterion_texts(criterion: Criterion, rubric: Rubric) -> Iterator[str]:
    yield f"{criterion.id} ({worth((criterion,)).text}, part {criterion.part} of {rubric.id})"
    yield _fill(f"Passes when: {criterion.title}.")
    if criterion.adjustment is not None:
        yield _fill(sentence(criterion.adjustment.message))
    yield _fill(criterion.feedback)
    if criterion.requires:
        yield _fill(f"Skipped unless these passed: {', '.join(criterion.requires)}.")
    positions = ", ".join(f"{name} = {value:g}" for name, value in criterion.at.items())
    pose = f"The robot is posed: {positions} (degrees or metres); its other joints are at 0." if positions else ""
    yield _check_text("Check", criterion.check, criterion.arguments, pose)
    for causes, check, arguments in criterion.carried:
        failures = f"If it fails and {enumerated(causes, word='or')} failed before it"
        yield _check_text(f"{failures}, the points are given if this check passes", check, arguments)


def _check_text(title: str, check: Check, arguments: Mapping[str, object], *more: str) -> str:
    given = ", ".join(f"{key} = {toml_text(value)}" for key, value in arguments.items())
    texts = (f"{title}: {check.name}. {check.documentation.fact}", f"With {given}." if given else "", *more)
    texts += (f"`grader explain {check.name}` explains the check.",)
    return "\n".join(map(_fill, filter(None, texts)))


def _arguments(check: Check) -> str:
    lines = []
    for parameter in check.parameters.values():
        default = "" if parameter.required else f", default: {toml_text(parameter.default)}"
        meaning = _fill(check.documentation.arguments.get(parameter.name, ""), _WIDTH - 6)
        lines += [f"    {parameter.name}: {parameter.type.name}{default}\n", textwrap.indent(f"{meaning}\n", " " * 6)]
    return "".join(line for line in lines if line.strip())


def _fill(text: str, width: int = _WIDTH) -> str:
    return textwrap.fill(" ".join(text.split()), width, break_long_words=False, break_on_hyphens=False)


_EXAMINED = {
    "urdf": "The URDF is examined.",
    "package": "The ROS 2 package is examined.",
    "files": "All submitted files are examined.",
}


def render_handout(rubric: Rubric) -> str:
    """Return the parts of a rubric, each with a table of its criteria and their points."""
    blocks = [f"# {_text(rubric.title)}", f"{worth(rubric.criteria).text} in total."]
    for part in rubric.parts:
        criteria = [criterion for criterion in rubric.criteria if criterion.part == part.id]
        if criteria:
            blocks += _part(part, criteria)
    return "\n\n".join(blocks) + "\n"


def _part(part: Part, criteria: Sequence[Criterion]) -> Iterator[str]:
    yield f"## {_text(part.title)} ({worth(criteria).text})"
    yield _EXAMINED[part.needs]
    rows = [["criterion", "about", "what should be true", "points"], ["---", "---", "---", "---:"]]
    rows += map(_row, criteria, [None, *criteria])
    columns = [0, 1, 2, 3] if any(criterion.about for criterion in criteria) else [0, 2, 3]
    yield "\n".join(f"| {' | '.join(row[column] for column in columns)} |" for row in rows)


def _row(criterion: Criterion, before: Criterion | None) -> list[str]:
    """Return the cells of a criterion; its heading only where the one before has another."""
    name = code(printable(criterion.id)).replace("|", "\\|")
    about = "" if before is not None and before.about == criterion.about else _text(criterion.about)
    manual = " *(graded manually)*" if criterion.check.function in MANUAL_CHECKS else ""
    adjusted = f" *({_text(criterion.adjustment.message)})*" if criterion.adjustment is not None else ""
    return [name, about, _text(criterion.title) + manual + adjusted, worth((criterion,)).short]


def _text(text: str) -> str:
    return escape(printable(" ".join(text.split())))
