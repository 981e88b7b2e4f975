"""The corrections that an editor offers at what rules find: an edit that a message names is one."""

import re
from collections import Counter
from collections.abc import Mapping

import pytest

from grader.base.element_edits import edit_files
from grader.base.problems import Fix, Problem
from grader.files.reading import URDF_LIMIT
from grader.files.tree import make_tree, overlaid
from grader.ros.package.robot_file import Read
from grader.ros.python import budget
from grader.workspace.opening.all_robots import read_workspace
from grader.workspace.rules.rule_table import RULES
from tests.workspace.rule_examples import files_of_rule

pytestmark = pytest.mark.slow

_NAMES_AN_EDIT = re.compile(r"did you mean|[:;] (?:add|write) |: use \w+\(\)")
# Rules whose message names an edit that is not one place, or not one text.
_NO_EDIT = {
    "bridge-argument": "the types are not known",
    "bridge-direction": "in an argument it is one character",
    "component-macro": "it may be the class that is misspelt",
    "callback-wait": "the call is another one",
    "constructor-order": "the call moves",
    "inertia-place": "the element may be missing",
    "message-depth": "the number is not known",
    "module-installed": "the list may be computed",
    "name-valid": "the name is not known",
    "parameter-list": "there are several numbers",
    "parameter-table": "the braces hold several pairs",
    "mimic-command": "there are two ways",
    "planning-list": "the list holds several",
    "wheel-limit": "the limits go as well",
}


def _problems(files: Mapping[str, str]) -> list[Problem]:
    """Return what is wrong in the files of an example, those of robots included."""
    tree = overlaid(make_tree("ws", (), ()), {path: text.encode() for path, text in files.items()})
    opened = read_workspace(tree, "ws", URDF_LIMIT, {})
    problems = list(opened.package_problems())
    for robot in opened.robots:
        if isinstance(robot, Read):
            problems += opened.find_problems(robot)
    return problems


def _after(files: Mapping[str, str], fix: Fix) -> dict[str, str]:
    """Return the files after a fix, whose edits have to fit."""
    edited = edit_files(lambda path: files[path].encode(), fix.edits)
    assert edited is not None
    changed = {path: data.decode() for path, data in edited.items() if data is not None}
    return {**files, **changed}


@pytest.mark.parametrize("name", RULES)
def test_an_edit_that_a_message_names_is_offered(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """After the first fix, the problem is gone and no other rule finds more, unless it is a guess."""
    if name == "names-compared":  # a file that is short enough for an example asks for less
        monkeypatch.setattr(budget, "_OF_WORKSPACE", 5_000)
    files = files_of_rule(name, "wrong").files
    every = _problems(files)
    problem = next((one for one in every if one.rule == name), None)
    if problem is None:
        return  # another release is asked for, or only one of the commands says it
    fixes = [fix for fix in problem.fixes if fix.edits]
    if _NAMES_AN_EDIT.search(problem.message):
        assert bool(fixes) != (name in _NO_EDIT), problem.message
    if fixes and fixes[0].is_certain:
        before = Counter(one.label for one in every)
        changed = _problems(_after(files, fixes[0]))
        assert problem.message not in [one.message for one in changed]
        assert Counter(one.label for one in changed) <= before
