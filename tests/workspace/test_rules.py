"""Each rule of a workspace has one entry and a name of its own, and some code names it."""

import ast
import re
from importlib import import_module
from textwrap import indent

from grader.lab.checks.registry import check_names
from grader.lab.rubric.rubric import load_rubric, shipped_rubrics
from grader.workspace.rules.names import DEFINED
from grader.workspace.rules.rule_table import (
    FAMILIES,
    NAME_CATALOGUE,
    RULES,
    Rule,
    list_readers,
)
from tests.command_line import ROOT, run
from tests.workspace.rule_examples import EXAMPLES

_MODULES = {
    path.stem: import_module(f"grader.workspace.rules.{path.stem}")
    for path in sorted((ROOT / "grader/workspace/rules").glob("*.py"))
}
_ENTRIES = {
    name: value
    for module in _MODULES.values()
    for name, value in vars(module).items()
    if isinstance(value, Rule)
}


def test_the_table_has_every_entry_and_every_reader() -> None:
    """As `python docs/make.py` writes rules.json, which commands read that need no finder."""
    assert {rule.name: rule for rule in _ENTRIES.values()} == dict(RULES)
    readers = {
        f"{stem}.{name}"
        for stem, module in _MODULES.items()
        for name, value in vars(module).items()
        if re.fullmatch(r"[a-z]\w*_facts", name) and value.__module__ == module.__name__
    }
    assert {place for place in readers if not place.startswith("reading.")} == {*list_readers()}


def test_an_entry_says_why_and_what_the_terminal_prints() -> None:
    """Why it matters is in whole sentences; each example of a symptom has its pattern."""
    for rule in RULES.values():
        assert re.fullmatch(r"[A-Za-z'<].{20,170}\.", rule.why), rule.name
        for symptom in rule.symptoms:
            match = re.search(symptom.pattern, symptom.example)
            assert match is not None, rule.name
            assert {*symptom.within} <= match.groupdict().keys(), rule.name


def test_names_are_unique_and_no_check_or_criterion_has_one() -> None:
    """`--select`, `--ignore` and `explain` take any of them."""
    assert len({rule.name for rule in _ENTRIES.values()}) == len(_ENTRIES)
    criteria = {row.id for name in shipped_rubrics() for row in load_rubric(name).criteria}
    assert RULES.keys().isdisjoint({*check_names(), *criteria})
    assert [name for name in RULES if not re.fullmatch(r"[a-z]+(-[a-z]+)+", name)] == []


def test_a_sentence_says_what_is_right() -> None:
    """It is one sentence, and no two rules have the same."""
    sentences = [rule.sentence for rule in RULES.values()]
    assert len({*sentences}) == len(sentences)
    assert [text for text in sentences if not re.fullmatch(r"[A-Z<a-z].*[\w>)]\.", text)] == []


def test_every_rule_is_named_by_a_finder() -> None:
    """An entry without code that finds what breaks it is an entry too many."""
    folder = ROOT / "grader/workspace"
    texts = [path.read_text(encoding="utf-8") for path in folder.rglob("*.py")]
    uses = re.sub(r"(?m)^\w+ = Rule\(", "", "\n".join(texts))
    nodes = [path.read_text(encoding="utf-8") for path in (ROOT / "grader/ros/nodes").rglob("*.py")]
    faults = {*re.findall(r'CodeFault\(\s*"([a-z-]+)"', "\n".join(nodes))}
    assert faults <= RULES.keys()
    named = faults | {rule.name for rule in DEFINED.values()}
    unused = [
        name
        for name, rule in _ENTRIES.items()
        if rule.name not in named and not re.search(rf"\b{name}\b", uses)
    ]
    assert unused == []
    assert [kind for kind in DEFINED if f'Use("{kind}"' not in uses] == []


def test_a_function_finds_what_breaks_one_rule() -> None:
    """A finder that makes the findings of two rules is two functions."""
    several = {}
    for path in (ROOT / "grader/workspace/rules").glob("*.py"):
        for function in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(function, ast.FunctionDef):
                names = {node.id for node in ast.walk(function) if isinstance(node, ast.Name)}
                several[f"{path.stem}.{function.name}"] = names & _ENTRIES.keys()
    assert sum(map(bool, several.values())) > 100
    assert {name: rules for name, rules in several.items() if len(rules) > 1} == {}


def test_every_kind_of_names_has_a_rule() -> None:
    """A certain finding of each family that a rubric can ask for is an error or a declared warning."""
    kinds = {kind for rule in RULES.values() for kind in (rule.kind, rule.doubtful)}
    assert kinds == {*NAME_CATALOGUE}
    assert {rule.family for rule in RULES.values()} >= {*FAMILIES}


def test_problems_are_selected_and_ignored_by_the_names_of_rules() -> None:
    """Also by several, and beside codes; an unknown name is refused with the nearest one."""
    path = "submissions/diffdrive/spawner-misspelt"
    assert run(("inspect", path, "--select", "controller-defined")).returncode == 1
    assert run(("inspect", path, "--select", "topic-type,file-installed")).returncode == 0
    assert run(("inspect", path, "--ignore", "controller-defined")).returncode == 0
    done = run(("inspect", path, "--ignore", "controller-definde"))
    assert (done.returncode, done.stdout) == (2, b"")
    assert b"did you mean 'controller-defined'?" in done.stderr


def test_a_rule_is_explained() -> None:
    """By what is right and why, with its codes, what was found in public and its own example."""
    text = run(("explain", "topic-type")).stdout.decode()
    assert text.startswith("topic-type: a rule of `grader inspect`\n\nPublishers and subscriptions")
    assert "REF007 (error)" in text
    assert RULES["topic-type"].why.split(".")[0] in " ".join(text.split())
    assert re.search(r"In \d+ public workspaces: (\d+ true, \d+ false|no finding)\.", text)
    assert "REF009 (warning)" in text
    wrong = EXAMPLES["topic-type"]["wrong"].strip()
    assert f"Wrong:\n\n{indent(wrong, '    ')}\n" in text
