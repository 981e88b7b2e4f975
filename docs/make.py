"""Write what is generated into the pages: `python docs/make.py`. The tests fail if a page is out of
date.
"""

import json
import re
import tomllib
from collections import Counter
from collections.abc import Iterator
from importlib import import_module
from io import StringIO
from itertools import chain
from pathlib import Path
from typing import Any, get_args

from rich.console import Console
from rich.text import Text

from grader.app.cli.explain import SchemaName
from grader.app.commands.schemas import json_schema
from grader.base.text import enumerated
from grader.lab.checks.check import Check
from grader.lab.checks.registry import CHECKS, own_checks
from grader.lab.grading.grade import grade
from grader.lab.grading.report import Report
from grader.lab.hints.hinting import hinted
from grader.lab.rubric.keys import (
    ADJUSTMENT,
    CARRIED,
    CRITERION,
    DEFAULTS,
    EVIDENCE,
    IGNORE,
    LATE,
    PART,
    RUBRIC,
    TEST,
)
from grader.lab.rubric.rubric import load_rubric
from grader.lab.submission.opening import open_submission
from grader.report.examples import example_blocks, explain_kind, make_blocks
from grader.report.explanations import (
    CAUSES_OF_CHECK,
    EFFECTS,
    default_text,
    list_outputs,
    list_rules,
)
from grader.report.json_data import to_json
from grader.report.writers.terminal import render_terminal
from grader.ros.known.package_files import IndexedKey, facts_in_file, packages_with_files
from grader.ros.known.parameter_rows import NodeRows, known_nodes, node_rows
from grader.ros.known.releases import RELEASES
from grader.workspace.rules.problem_kinds import EVERY_KIND
from grader.workspace.rules.rule_table import RULES, Rule, list_readers, reload_rules

KEYS = {
    "The rubric": RUBRIC,
    "[[part]]": PART,
    "[[criterion]]": CRITERION,
    "[criterion.carried]": CARRIED,
    "[defaults]": DEFAULTS,
    "[[evidence]]": EVIDENCE,
    "[late]": LATE,
    "[adjust.CRITERION]": ADJUSTMENT,
    "[test]": TEST,
    "[[test.ignore]]": IGNORE,
}
LANGUAGES = {
    ".srv": "text",
    ".cfg": "ini",
    ".cpp": "cpp",
    ".hpp": "cpp",
    ".launch": "xml",
    ".msg": "text",
    ".obj": "text",
    ".pgm": "text",
    ".sdf": "xml",
    ".yaml": "yaml",
    ".md": "markdown",
    ".py": "python",
    ".rviz": "yaml",
    ".srdf": "xml",
    ".toml": "toml",
    ".txt": "text",
    ".urdf": "xml",
    ".xacro": "xml",
    ".xml": "xml",
}
DOCS = Path(__file__).resolve().parent
WORKSPACES = DOCS.parent / "tests/workspace/public_workspaces.toml"
RULES_FILE = "grader/workspace/rules/rules.json"
NEWER_RULES = DOCS.parent / "tests/workspace/public_rules.toml"
SAMPLE = DOCS.parent / "submissions/lab6/lidar-offset-in-visual/my_robot/urdf/my_robot.urdf"


def pages() -> dict[str, str]:
    """Return the text of each page with generated content by its file name."""
    report = sample_report()
    return {
        "problems.md": filled("problems.md", problems()),
        "checks.md": filled("checks.md", checks()),
        "misconfigurations.md": filled("misconfigurations.md", misconfigurations()),
        "rules.md": filled("rules.md", rules_in_public()),
        "known-parameters.md": filled("known-parameters.md", known_parameters()),
        "rubric-reference.md": filled("rubric-reference.md", keys()),
        "grade-one-submission.md": filled(
            "grade-one-submission.md", ["```", terminal(report).rstrip(), "```"]
        ),
        "report.svg": picture(report),
        "../grader/ros/known/index.toml": index_of_packages(),
        f"../{RULES_FILE}": table_of_rules(),
        **{f"schemas/{name}.json": to_json(json_schema(name)) for name in get_args(SchemaName)},
    }


def filled(name: str, lines: Iterator[str] | list[str]) -> str:
    """Return a page with these lines between its two comments on generated text."""
    text = (DOCS / name).read_text(encoding="utf-8")
    content = "\n".join(lines)
    return re.sub(
        r"(<!-- generated .*?-->\n).*?(?=<!-- end)",
        lambda found: f"{found[1]}\n{content}\n\n",
        text,
        flags=re.DOTALL,
    )


def problems() -> Iterator[str]:
    """Yield a list of all problems, and a section for each with what `grader explain` prints."""
    for kind in EVERY_KIND:
        yield f"- [`{kind.code}`](#{kind.code.lower()}) ({kind.severity}): {escaped(kind.title)}"
    yield ""
    for kind in EVERY_KIND:
        effect = f" {EFFECTS[kind.effect]}".rstrip()
        yield from (f"## {kind.code}", "", f"{escaped(kind.title)} ({kind.severity}).", "")
        yield from (escaped(explain_kind(kind)) + effect, "")
        yield from outputs(kind.code)
        rules = list_rules(kind)
        for rule in rules:
            yield f"- [`{rule.name}`](#{rule.name}): {escaped(rule.sentence)}"
        own_rules = [rule for rule in rules if rule.kind == kind]
        yield ""
        if not own_rules:
            yield from example(kind.code)
        for rule in own_rules:
            yield from (f"### `{rule.name}`", "", escaped(f"{rule.sentence} {rule.why}"), "")
            yield from outputs(rule.name)
            yield from example(rule.name)


def outputs(name: str) -> Iterator[str]:
    """Yield what the terminal prints where a rule is broken, or where a file has a problem."""
    listed = [f"- `` {output} ``" for output in list_outputs(name)]
    if listed:
        yield from ("In the terminal:", "", *listed, "")


# What one may want to ask, and the modules of the checks that do.
QUESTIONS = {
    "Does the URDF load, and is it well written?": ("loading", "problem_codes", "xacro_source"),
    "What does the robot show?": ("appearance", "meshes"),
    "Which links and joints does it have?": ("structure", "joints"),
    "Where are things?": ("placement", "heights", "contact"),
    "How does it move and stand?": ("motion", "driving", "reference"),
    "What do links weigh, and what do they collide with?": ("inertia", "collisions"),
    "Which values do files and nodes have?": ("entries", "parameters"),
    "Does the package build and install its files?": ("package_build",),
    "What does a launch file start, and what do the nodes do?": (
        "launch",
        "commands",
        "simulation",
        "lookups",
        "own_interfaces",
        "node_code",
        "set_parameters",
    ),
    "How do nodes work together?": ("launched_graph",),
    "What does RViz show?": ("rviz",),
    "Does everything fit together?": ("names_agree",),
    "What did the robot do in a recording?": (
        "recordings",
        "recorded_motion",
        "recorded_frames",
    ),
    "What did the student write or show?": ("manual",),
}


def checks() -> Iterator[str]:
    """Yield a list of all checks by what they ask, and a section for each, as `explain` prints."""
    yield from checks_by_question()
    for check in own_checks():
        yield from check_section(check)


def checks_by_question() -> Iterator[str]:
    """Yield the checks in lists, one for each question."""
    modules = {place.partition(".")[2]: place.partition(".")[0] for place in CHECKS}
    assert {*modules.values()} == {*chain.from_iterable(QUESTIONS.values())}
    for question, asking in QUESTIONS.items():
        yield from (f"### {question}", "")
        for check in own_checks():
            if modules[check.name] in asking:
                fact = escaped(check.documentation.paragraphs[0])
                yield f"- [`{check.name}`](#{check.name}): {fact}"
        yield ""


def check_section(check: Check) -> Iterator[str]:
    """Yield the section of a check."""
    yield from (f"## `{check.name}`", "")
    for paragraph in check.documentation.paragraphs:
        yield from (escaped(paragraph), "")
    if check.parameters:
        yield from ("| argument | meaning | type | default |", "|---|---|---|---|")
    for name, parameter in check.parameters.items():
        default = "required" if parameter.required else f"`{default_text(parameter.default)}`"
        meaning = escaped(check.documentation.arguments[name])
        yield f"| `{name}` | {meaning} | {parameter.type.name} | {default} |"
    if check.parameters:
        yield ""
    if check.about.causes:
        yield from (f"{CAUSES_OF_CHECK}:", "")
        for cause, meaning in check.about.causes.items():
            yield f"- `{cause}`: {escaped(meaning)}"
        yield ""
    yield from example(check.name)


def rules_in_public() -> Iterator[str]:
    """Yield how many findings of each rule in public workspaces were true, and the workspaces."""
    table = tomllib.loads(WORKSPACES.read_text(encoding="utf-8"))
    workspaces = table["workspace"]
    places: dict[tuple[str, str], Counter[bool]] = {}
    for workspace in workspaces:
        for error in workspace.get("error", ()):
            counts = places.setdefault((error["code"], error.get("rule", "")), Counter())
            counts[error["is_true"]] += len(error["places"])
    yield from ("| rule, or code without rules | true |", "|---|---|")
    for (code, rule), counts in sorted(places.items()):
        yield f"| {link_to_rule(rule or code)} | {counts[True]}/{counts.total()} |"
    newer = tomllib.loads(NEWER_RULES.read_text(encoding="utf-8"))
    counted = {rule for _, rule in places} | {rule["name"] for rule in newer["rule"]}
    yield from rules_without_findings(counted, table["without_findings"])
    yield from list_newer_rules(newer["rule"], newer["workspaces"])
    yield from ("| workspace | errors |", "|---|---|")
    without_errors = []
    for workspace in workspaces:
        name, commit = workspace["repository"], workspace["commit"]
        link = f"[{name}](https://github.com/{name}/tree/{commit})"
        count = sum(len(error["places"]) for error in workspace.get("error", ()))
        if count:
            yield f"| {link} | {count} |"
        else:
            without_errors.append(link)
    yield from ("", f"These have no errors: {enumerated(without_errors)}.")


def link_to_rule(name: str) -> str:
    """Return a link from the name of a rule, or from a code, to its section of the problems."""
    return f"[`{name}`](problems.md#{name.lower()})"


def list_newer_rules(rules: list[dict[str, Any]], usual_count: int) -> Iterator[str]:
    """Yield a table of the newer rules with findings, and lists of the others by workspaces."""
    silent: dict[int, list[str]] = {}
    yield from ("Newer rules, also their warnings and notes:", "")
    yield from ("| rule | workspaces | true |", "|---|---|---|")
    for rule in rules:
        count, found = rule.get("workspaces", usual_count), rule["true"] + rule["false"]
        if found:
            yield f"| {link_to_rule(rule['name'])} | {count} | {rule['true']}/{found} |"
        else:
            silent.setdefault(count, []).append(f"`{rule['name']}`")
    yield from ("", "These found nothing:", "")
    for count, names in sorted(silent.items(), reverse=True):
        yield f"- in {count} workspaces: {enumerated(names)}"
    yield ""


def rules_without_findings(counted: set[str], without_findings: list[str]) -> Iterator[str]:
    """Yield the rules of errors that are not counted: without findings, and not yet run."""
    errors = [kind for kind in EVERY_KIND if kind.severity == "error"]
    of_errors = [rule.name for kind in errors for rule in list_rules(kind) if rule.kind == kind]
    others = [name for name in of_errors if name not in counted]
    silent = [f"`{name}`" for name in others if name in without_findings]
    yield from ("", f"These rules found no error: {enumerated(silent)}.", "")
    new = [f"`{name}`" for name in others if name not in without_findings]
    if new:
        yield from (f"Not yet run on public workspaces: {enumerated(new)}.", "")


def known_parameters() -> Iterator[str]:
    """Yield the packages with parameters of nodes, in a table."""
    packages: dict[str, list[NodeRows]] = {}
    for node in known_nodes():
        rows = node_rows(node)
        assert rows is not None, node
        packages.setdefault(re.split("/|::", node)[0], []).append(rows)
    yield "| package | nodes and plugins | rows | read from | up to |"
    yield "|---|---|---|---|---|"
    for package, nodes in packages.items():
        names = ", ".join(f"`{re.split('/|::', known.node)[-1]}`" for known in nodes)
        count = sum(len(known.own_rows) for known in nodes)
        source = nodes[0].source.partition(",")[0]
        last = max((known.read for known in nodes), key=RELEASES.index).title()
        yield f"| {package} | {names} | {count} | {source} | {last} |"


def index_of_packages() -> str:
    """Return the packages that have each fact of which readers need those of all packages."""
    lines = [
        "# The packages that have a fact, for readers of all that have it. Written by docs/make.py."
    ]
    for key in get_args(IndexedKey):
        packages = [package for package in sorted(packages_with_files()) if has_fact(package, key)]
        lines.append(f"{key} = {json.dumps(packages)}")
    return "\n".join(lines) + "\n"


def table_of_rules() -> str:
    """Return rules.json: the entries of rules, the functions that read facts, and public findings.

    New functions come after those that the table has: the order of what is found stays.
    """
    before = list_readers()
    readers: set[str] = set()
    rows: dict[str, str] = {}
    for path in sorted((DOCS.parent / "grader/workspace/rules").glob("*.py")):
        module = import_module(f"grader.workspace.rules.{path.stem}")
        for name, value in vars(module).items():
            if isinstance(value, Rule):
                rows[value.name] = json.dumps(row_of_rule(value))
            is_own = getattr(value, "__module__", "") == module.__name__
            if is_own and re.fullmatch(r"[a-z]\w*_facts", name) and path.stem != "reading":
                readers.add(f"{path.stem}.{name}")
    kept = [place for place in before if place in readers]
    order = [*kept, *sorted(readers.difference(kept))]
    rules = ",\n".join(f"{json.dumps(name)}: {row}" for name, row in rows.items())
    public = json.dumps(public_findings_by_rule(), indent=0)
    places = json.dumps(order, indent=0)
    return f'{{"readers": {places},\n"public": {public},\n"rules": {{\n{rules}\n}}}}\n'


def row_of_rule(rule: Rule) -> dict[str, Any]:
    """Return an entry as data, with its kinds by their codes."""
    defaults = Rule._field_defaults
    row = {key: value for key, value in rule._asdict().items() if value != defaults.get(key)}
    del row["name"]
    row["kind"] = rule.kind.code
    if rule.doubtful_kind is not None:
        row["doubtful_kind"] = rule.doubtful_kind.code
    if rule.symptoms:
        row["symptoms"] = [symptom._asdict() for symptom in rule.symptoms]
    return row


def public_findings_by_rule() -> dict[str, str]:
    """Return for each rule that was counted how often it was true in public workspaces."""
    table = tomllib.loads(WORKSPACES.read_text(encoding="utf-8"))
    newer = tomllib.loads(NEWER_RULES.read_text(encoding="utf-8"))
    counts = {name: Counter[bool]() for name in table["without_findings"] if name in RULES}
    for workspace in table["workspace"]:
        for error in workspace.get("error", ()):
            if "rule" in error:
                places = counts.setdefault(error["rule"], Counter())
                places[error["is_true"]] += len(error["places"])
    numbers = {name: (len(table["workspace"]), count) for name, count in counts.items()}
    for rule in newer["rule"]:
        count = Counter({True: rule["true"], False: rule["false"]})
        numbers[rule["name"]] = rule.get("workspaces", newer["workspaces"]), count
    return {
        name: f"In {workspaces} public workspaces: {_judged(count)}."
        for name, (workspaces, count) in sorted(numbers.items())
    }


def _judged(count: Counter[bool]) -> str:
    """Return how many findings were true, and how many were not."""
    return f"{count[True]} true, {count[False]} false" if count.total() else "no finding"


def has_fact(package: str, key: str) -> bool:
    """Return whether a package, or a program, controller or launch file of it has a fact."""
    facts = facts_in_file(package)
    parts = [facts.get(kind, {}).values() for kind in ("program", "controller", "launch")]
    return any(key in table for table in chain([facts], *parts))


def misconfigurations() -> Iterator[str]:
    """Yield how many kinds of misconfiguration are found, a row for each kind, a section for each
    that is found, and the files of the examples.
    """
    kinds = tomllib.loads((DOCS / "examples/kinds.toml").read_text(encoding="utf-8"))
    frames = tomllib.loads((DOCS / "examples/frames.toml").read_text(encoding="utf-8"))
    rules = {rule.name: rule._asdict() for rule in RULES.values()}
    yield from counts(kinds)
    yield from ("", "| kind | what goes wrong | found as |", "|---|---|---|")
    for name, kind in kinds.items():
        said = f"[{name}](#{anchor(name)})" if "codes" in kind else name
        found_as = codes(kind) or escaped(kind["reason"])
        yield f"| {said} | {escaped(kind['explanation'])} | {found_as} |"
    yield ""
    for name, kind in kinds.items():
        if "codes" in kind:
            yield from (f"## {name}", "", escaped(kind["explanation"]), "")
            yield f"- Found as: {codes(kind)}"
            yield f"- Covers: {escaped(kind['scope'])}"
            yield from (f"- Source: {escaped(kind['source'])}", "")
            yield from example_of_kind(kind, rules)
    yield from ("## Files of the examples", "")
    beside: set[str] = set()
    for kind in kinds.values():
        beside.update(files_beside(rules.get(kind.get("rule", ""), kind)))
    for file in sorted(beside):
        yield from (f"### `{file}`", "")
        yield from code_block(file, without_placeholder(frames[file]).rstrip())


def files_beside(example: dict[str, Any]) -> list[str]:
    """Return the files beside an example that are as their frames."""
    return [file for file, text in example.get("beside", {}).items() if not text]


def without_placeholder(frame: str) -> str:
    """Return a frame with nothing in it."""
    return re.sub(r"(?m)^ *EXAMPLE\n", "", frame)


def counts(kinds: dict[str, Any]) -> Iterator[str]:
    """Yield how many kinds there are, how many files can show, and how many are found."""
    of_files = {name for name, kind in kinds.items() if kind.get("in_files", True)}
    found = {name for name, kind in kinds.items() if "codes" in kind}
    by_tools = {name for name, kind in kinds.items() if kind.get("tools")}
    yield (
        f"`grader inspect` finds {len(found)} of the {len(of_files)} kinds that files can show. "
        'For many kinds it finds only some mistakes: "Covers" lists which. '
        f"Together, the tools of the study find {len(by_tools)} of all {len(kinds)} kinds. None of "
        f"them finds {len(found - by_tools)} that `grader inspect` finds."
    )
    yield from ("", "| category | kinds | files can show | found |", "|---|---|---|---|")
    groups = [Counter(map(category, names)) for names in (kinds, of_files, found)]
    for title in dict.fromkeys(map(category, kinds)):
        yield f"| {title} | {' | '.join(str(group[title]) for group in groups)} |"
    yield f"| all | {' | '.join(str(group.total()) for group in groups)} |"


def category(name: str) -> str:
    """Return the category of a kind of misconfiguration."""
    return name.partition(": ")[0]


def codes(kind: dict[str, Any]) -> str:
    """Return links to the codes of a kind of misconfiguration; empty if it is not found."""
    return ", ".join(f"[`{code}`](problems.md#{code.lower()})" for code in kind.get("codes", ()))


def example_of_kind(kind: dict[str, Any], rules: dict[str, Any]) -> Iterator[str]:
    """Yield the example of a kind of misconfiguration, or where it is."""
    shown = rules.get(kind.get("rule", ""), kind)
    if "wrong" not in shown:
        code = kind["codes"][0]
        yield from (f"Example: that of [{code}](problems.md#{code.lower()}).", "")
        return
    files = [f"[`{file}`](#{anchor(file)})" for file in files_beside(shown)]
    for block in make_blocks({"frame": Rule._field_defaults["frame"], **shown}):
        said = f", in `{block.file}`" if block.file not in block.title else ""
        beside = f", beside {enumerated(files)}" if files and said else ""
        yield from (f"{block.title}{said}{beside}:", "")
        yield from code_block(block.file, block.text)


def code_block(file: str, text: str) -> Iterator[str]:
    """Yield the text of a file as a code block in its language."""
    yield from (f"```{LANGUAGES[Path(file).suffix]}", text.strip("\n"), "```", "")


def anchor(heading: str) -> str:
    """Return the anchor that GitHub gives a heading."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def keys() -> Iterator[str]:
    """Yield a section for each table of a rubric, with a line for each key."""
    for title, table in KEYS.items():
        yield from (f"### {title}", "")
        for name, kind in table.keys.items():
            needed = ", required" if name in table.required else ""
            yield (
                f"- `{name}` ({kind.name.removeprefix('a ')}{needed}): "
                f"{escaped(kind.schema['description'])}"
            )
        yield ""


def example(name: str) -> Iterator[str]:
    """Yield the code blocks of the example of a problem or a check."""
    for block in example_blocks(name):
        yield from (f"{block.title}:", "")
        yield from code_block(block.file, block.text)


def sample_report() -> Report:
    """Return the report on a sample submission."""
    rubric = load_rubric("lab6")
    submission = open_submission(str(SAMPLE), rubric.lab)
    return hinted(grade(rubric, submission), submission, rubric.hints).report


def terminal(report: Report) -> str:
    """Return a report as it is printed without a terminal."""
    output = StringIO()
    render_terminal(report, Console(width=80, file=output, color_system=None, highlight=False))
    return output.getvalue()


def picture(report: Report) -> str:
    """Return a report as a drawing of a terminal, in SVG."""
    output = StringIO()
    render_terminal(
        report, Console(width=80, file=output, force_terminal=True, color_system="truecolor")
    )
    console = Console(record=True, width=80, file=StringIO())
    console.print(Text.from_ansi(output.getvalue()), end="")
    drawing = console.export_svg(title="grader grade my_robot", unique_id="grader-report")
    return re.sub(
        r"\s*@font-face \{.*?\}", "", drawing, flags=re.DOTALL
    )  # a viewer fetches no fonts


def escaped(text: str) -> str:
    """Return text in which tags are not HTML, asterisks are no emphasis, and bars do not end a
    table cell.
    """
    return re.sub(
        r"(`[^`]*`)|([<*])", lambda found: found[1] or {"<": "&lt;", "*": r"\*"}[found[2]], text
    ).replace("|", "\\|")


if __name__ == "__main__":
    (DOCS.parent / RULES_FILE).write_text(table_of_rules(), encoding="utf-8")
    reload_rules()  # from which the pages are made
    for name, text in pages().items():
        (DOCS / name).parent.mkdir(exist_ok=True)
        (DOCS / name).write_text(text, encoding="utf-8")
