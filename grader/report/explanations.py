"""Rubrics, checks and problem codes in plain text.

They come with what docs/examples/ has for a code or a check.
"""

import textwrap
from collections.abc import Iterable, Iterator, Mapping

from grader.base.errors import InputError
from grader.base.names import did_you_mean
from grader.base.problems import Kind
from grader.base.text import counted, enumerated, format_points, printable, sentence, shell_quoted
from grader.base.toml_file import assignment, toml_literal
from grader.files.limits import ROBOT_ENDINGS
from grader.lab.checks.check import Check
from grader.lab.checks.manual import MANUAL_CHECKS, answered, manual, picture_named
from grader.lab.checks.registry import check_names, find_check, unused_checks
from grader.lab.rubric.criterion import Criterion, worth
from grader.lab.rubric.rubric import Rubric, shipped_rubrics
from grader.report.criteria import model_lines
from grader.report.examples import example_blocks, explain_kind
from grader.report.json_data import exact, to_json
from grader.ros.api import parameter_explanation, releases_explanation
from grader.workspace.api import EVERY_KIND, RULES, Rule, known_rows, public_findings

_WIDTH = 80
_FOR_INSTRUCTORS = "For instructors: how it is checked\n----------------------------------"
_RELEASES = "releases"  # explains which releases of ROS 2 are known
_MAX_SIMILAR = 6  # criteria that are named
CAUSES_OF_CHECK = "Causes of a failure, besides `wrong`, `missing` and `slip`, for `feedback`"
EFFECTS = {
    "rejects": "ROS 2 rejects the file.",
    "undetermined": "The criteria that depend on it need manual grading.",
    "drops": "ROS 2 loads the file, but drops content of it.",
    "loads": "ROS 2 loads the file.",
    "other": "",
}


def rubric_size(rubric: Rubric) -> str:
    """Return the size of a rubric: 56 criteria, 100 points."""
    criteria = counted(len(rubric.criteria), "criterion", "criteria")
    return f"{criteria}, {worth(rubric.criteria).text}"


def rubric_summary(rubric: Rubric) -> str:
    """Return a rubric's title and size: Lab 6 (56 criteria, 100 points)."""
    return f"{rubric.title} ({rubric_size(rubric)})"


def rubric_overview(rubric: Rubric) -> str:
    """Return the parts and criteria of a rubric, with the model answers that it was loaded with."""
    lines = [
        f"{rubric.id}: {rubric.title} ({worth(rubric.criteria).text})",
        f"sha256 {rubric.sha256}",
    ]
    for part in rubric.parts:
        criteria = [criterion for criterion in rubric.criteria if criterion.part == part.id]
        lines += ["", f"{part.id}: {part.title}"]
        width = max((len(criterion.id) for criterion in criteria), default=0)
        for criterion in criteria:
            points = format_points(criterion.points)
            bonus = " (bonus)" if criterion.bonus else ""
            lines.append(
                f"  {criterion.id:<{width}}  {points:>4}  {printable(criterion.title)}{bonus}"
            )
            if criterion.adjustment:
                lines.append(textwrap.indent(_fill(sentence(criterion.adjustment.message)), "    "))
            if criterion.answer:
                answer = printable(" ".join(model_lines(criterion)))
                lines.append(textwrap.indent(_fill(f"Model answer: {answer}"), "    "))
    return "\n".join(lines) + "\n"


def rubric_json(rubric: Rubric) -> str:
    """Return the parts and criteria of a rubric as JSON."""
    parts = []
    for part in rubric.parts:
        criteria = [
            {
                "id": criterion.id,
                "title": criterion.title,
                "points": exact(criterion.points),
                "bonus": criterion.bonus,
                "check": criterion.check.name,
            }
            for criterion in rubric.criteria
            if criterion.part == part.id
        ]
        parts.append({"id": part.id, "title": part.title, "criteria": criteria})
    values = {
        "id": rubric.id,
        "title": rubric.title,
        "sha256": rubric.sha256,
        "points": exact(rubric.points),
        "parts": parts,
    }
    return to_json(values)


def checks_text() -> str:
    """Return every check.

    It has the package that it comes from, the fact that it tests, and its arguments.
    """
    listed = []
    for name in check_names():
        try:
            check = find_check(name)
        except InputError as error:  # a broken plug-in must not hide the other checks
            listed.append(f"{name}\n  {error}\n")
            continue
        if check:
            fact = textwrap.indent(_fill(check.documentation.fact), "  ")
            listed.append(f"{name} ({check.distribution or 'grader'})\n{fact}\n{_arguments(check)}")
    listed += [
        f"{name} ({package})\n  Not used: the grader has a check of this name.\n"
        for name, package in unused_checks()
    ]
    return "\n".join(listed)


def explanation(name: str, rubric: Rubric) -> str:
    """Return the explanation of a name.

    It is a code, a criterion, a check, a parameter of a well-known node or the known releases.
    Raises InputError for another name.
    """
    for kind in EVERY_KIND:
        if kind.code == name.upper():
            return _explain_kind(kind)
    if name in RULES:
        return _rule_text(RULES[name])
    for criterion in rubric.criteria:
        if criterion.id == name:
            return _paragraphs(_criterion_texts(criterion, rubric))
    check = find_check(name)
    if check:
        return _explain_check(check)
    fact = releases_explanation() if name == _RELEASES else parameter_explanation(name)
    if fact:
        return fact
    guess = _guess_name(name, rubric)
    raise InputError(f"there is no problem code, rule, criterion or check {name!r}{guess}")


def _explain_kind(kind: Kind) -> str:
    """Return the explanation of a problem code."""
    texts = [
        f"{kind.code} ({kind.severity}): {kind.title}",
        _fill(explain_kind(kind)),
        EFFECTS[kind.effect],
    ]
    texts.append(_terminal_text(kind.code))
    return _paragraphs([*texts, _rules_text(kind), *_examples(kind.code)])


def _explain_check(check: Check) -> str:
    """Return the explanation of a check."""
    source = f", from the package {check.distribution}" if check.distribution else ""
    texts = [
        f"{check.name}: a check for rubrics{source}",
        *map(_fill, check.documentation.paragraphs),
    ]
    return _paragraphs(
        [*texts, _arguments(check).rstrip("\n"), _causes(check), *_examples(check.name)]
    )


def _guess_name(name: str, rubric: Rubric) -> str:
    """Return what an unknown name may mean, or where the names are listed, after a semicolon."""
    criteria = [criterion.id for criterion in rubric.criteria]
    known = [kind.code for kind in EVERY_KIND] + list(RULES) + criteria + check_names()
    lists = (
        f"`{rubric.shown_by}` lists the criteria, `grader rubric checks` lists the checks, "
        "reports show the codes, and a parameter of a well-known node is NODE.NAME"
    )
    begun = [criterion_id for criterion_id in criteria if criterion_id.startswith(name)]
    if begun:
        verb = "is" if len(begun) == 1 else "are"
        similar = f"; there {verb} {enumerated(begun, _MAX_SIMILAR)}: `grader explain {begun[0]}`"
    elif name in shipped_rubrics():
        similar = f"; `grader rubric show {name}` shows the rubric"
    elif name.lower().endswith(ROBOT_ENDINGS):
        similar = f"; `grader inspect {shell_quoted(name)}` lists the problems of a file"
    else:
        similar = ""
    return similar or did_you_mean(name, known) or f"; {lists}"


def list_rules(kind: Kind) -> list[Rule]:
    """Return the rules of workspaces that a kind of problem has."""
    return [rule for rule in RULES.values() if rule.has(kind)]


def list_outputs(name: str) -> list[str]:
    """Return what the terminal prints where a rule is broken, or where a file has a problem."""
    return [row.example for row in known_rows() if name in row.rules]


def _terminal_text(name: str) -> str:
    """Return the same as a list; empty without any."""
    outputs = [f"    {output}" for output in list_outputs(name)]
    return "\n".join(["In the terminal:", "", *outputs]) if outputs else ""


def _rules_text(kind: Kind) -> str:
    """Return the rules of a kind, one a line."""
    lines = [f"  {rule.name}: {rule.sentence}" for rule in list_rules(kind)]
    return "\n".join(["Rules:", "", *lines]) if lines else ""


def _rule_text(rule: Rule) -> str:
    """Return the explanation of a rule, with that of its codes."""
    texts = [f"{rule.name}: a rule of `grader inspect`", rule.sentence, _fill(rule.why)]
    texts.append(_terminal_text(rule.name))
    for kind in dict.fromkeys((rule.kind, rule.doubtful)):
        texts.append(_fill(f"{kind.code} ({kind.severity}): {kind.title}. {explain_kind(kind)}"))
    return _paragraphs([*texts, public_findings(rule.name), *_examples(rule.name)])


def _paragraphs(texts: Iterable[str]) -> str:
    return "\n\n".join(text for text in texts if text) + "\n"


def _criterion_texts(criterion: Criterion, rubric: Rubric) -> Iterator[str]:
    """Yield what a student needs, then how the criterion is checked."""
    yield f"{criterion.id} ({worth((criterion,)).text}, part {criterion.part} of {rubric.id})"
    yield _fill(f"Passes when: {criterion.title}.")
    yield _fill(_task_text(criterion))
    if criterion.adjustment:
        yield _fill(sentence(criterion.adjustment.message))
    yield from map(_fill, criterion.feedback.values())
    if criterion.requires:
        yield _fill(f"Skipped unless these passed: {', '.join(criterion.requires)}.")
    causes = [cause for carried in criterion.carried for cause in carried.causes]
    if causes:
        names = enumerated(dict.fromkeys(causes), word="or")
        yield _fill(f"No points are lost for what is due to a mistake in {names} alone.")
    yield _FOR_INSTRUCTORS
    pose = _pose_text(criterion.at) if criterion.at else ""
    given = " ".join(f"{name}:={value}" for name, value in criterion.args.items())
    launched = f"Launch files and the robot are read under the arguments {given}." if given else ""
    yield _check_text("Check", criterion.check, criterion.arguments, pose, launched)
    yield from _carried_texts(criterion)


def _carried_texts(criterion: Criterion) -> Iterator[str]:
    """Yield the checks that count instead after mistakes of other criteria."""
    for carried in criterion.carried:
        failures = f"If it fails and {enumerated(carried.causes, word='or')} failed before it"
        yield _check_text(
            f"{failures}, the points are given if this check passes",
            carried.check,
            carried.arguments,
            _pose_text(carried.at) if carried.at else "",
        )


def _task_text(criterion: Criterion) -> str:
    """Return what a person grades: a question or a picture; empty for what a program decides."""
    if criterion.check.function is answered:
        return f"Question: {criterion.arguments['question']} A person grades the answer."
    if criterion.check.function is manual:
        return f"{criterion.arguments['question']} A person decides it."
    if criterion.check.function in MANUAL_CHECKS:
        picture = picture_named(criterion.arguments["names"])
        return f"Hand in {picture} or a document that shows it. A person grades it."
    return ""


def _pose_text(at: Mapping[str, float]) -> str:
    positions = ", ".join(f"{name} = {value:g}" for name, value in at.items())
    return f"The robot is posed: {positions} (degrees or metres); its other joints are at 0."


def _check_text(title: str, check: Check, arguments: Mapping[str, object], *more: str) -> str:
    given = ", ".join(
        assignment(key, value) for key, value in arguments.items() if value is not None
    )
    texts = [f"{title}: {check.name}. {check.documentation.fact}"]
    if given:
        texts.append(f"With {given}.")
    texts += [*more, f"`grader explain {check.name}` explains the check."]
    return "\n".join(_fill(text) for text in texts if text)


def _arguments(check: Check) -> str:
    lines = []
    for parameter in check.parameters.values():
        default = "" if parameter.required else f", default: {default_text(parameter.default)}"
        meaning = _fill(check.documentation.arguments.get(parameter.name, ""), _WIDTH - 6)
        lines += [
            f"    {parameter.name}: {parameter.type.name}{default}\n",
            textwrap.indent(f"{meaning}\n", " " * 6),
        ]
    return "".join(line for line in lines if line.strip())


def _causes(check: Check) -> str:
    if not check.about.causes:
        return ""
    lines = [f"{CAUSES_OF_CHECK}:", ""]
    lines += [f"    {cause}: {meaning}" for cause, meaning in check.about.causes.items()]
    return "\n".join(lines)


def _fill(text: str, width: int = _WIDTH) -> str:
    return textwrap.fill(
        " ".join(text.split()), width, break_long_words=False, break_on_hyphens=False
    )


def _examples(name: str) -> Iterator[str]:
    """Yield these blocks as paragraphs."""
    for block in example_blocks(name):
        yield f"{block.title}:\n\n{textwrap.indent(block.text, '    ')}"


def default_text(value: object) -> str:
    """Return a default as a rubric has it, one that is not given as `not checked`."""
    return "not checked" if value is None else toml_literal(value)
