"""The first screen of an inspection: each error is in it, whatever else is wrong."""

import re
from collections.abc import Sequence
from io import StringIO
from random import Random

from hypothesis import given
from hypothesis import strategies as st
from rich.console import Console

from grader.base.problems import Kind, Problem
from grader.base.source import Location, Source
from grader.report.inspection import Inspection
from grader.report.writers.inspection_terminal import inspection_terminal
from grader.ros.known.releases import NOT_STATED
from grader.workspace.model.read_calls import ReadCalls
from grader.workspace.opening.extent import Extent
from grader.workspace.rules.problem_kinds import EVERY_KIND
from tests.examples import examples

SCREEN, WIDTH, MOST = 40, 80, 35
ERRORS = [kind for kind in EVERY_KIND if kind.severity == "error"]
OTHERS = [kind for kind in EVERY_KIND if kind.severity != "error"]
SEEDS = st.integers(0, 10**9)
_HEAD = re.compile(r"  (?P<code>[A-Z]+[0-9]{3}) (?P<severity>error|warning|note)\b")
EXTENT = Extent(3, 0, 2, 1, 1, 0, 0, 0, 0, 0, ReadCalls(1, 1, ()), NOT_STATED)
FOLDERS = ("src", "robot_bringup", "a", "navigation_and_mapping", "config", "launch")
NAMES = ("x.yaml", "bringup.launch.py", "a_node_with_a_very_long_name.py")
WORDS = ("the", "node", "'driver'", "src/a/config/driver.yaml:3", "has", "no", "parameter", "rate")


def problems_of(kinds: Sequence[Kind], count: int, seed: int) -> list[Problem]:
    """Return problems of some kinds at any places, a few of which have one cause."""
    random, problems = Random(seed), list[Problem]()
    for _ in range(count):
        folders = random.choices(FOLDERS, k=random.randrange(5))
        path = "/".join([*folders, random.choice(NAMES)])
        message = " ".join(random.choices(WORDS, k=random.choice((1, 8, 30))))
        at = Location(path, random.randint(1, 9999), random.randint(1, 200))
        cause = random.choice(("", "", "", "meshes"))
        problems.append(Problem(random.choice(kinds), message, at, cause=cause))
    return problems


def screen(problems: Sequence[Problem], *, verbose: bool = False) -> list[str]:
    """Return the rows that show the problems of a workspace."""
    out = StringIO()
    shown = Inspection("ws", (), tuple(problems), EXTENT, lambda path: Source(path, "a: 1\n" * 9))
    inspection_terminal(shown, Console(file=out, width=WIDTH), verbose=verbose)
    return out.getvalue().split("\n")


def causes_in(problems: Sequence[Problem]) -> dict[tuple[str, str, str], list[Problem]]:
    """Return problems by what makes one cause of them."""
    causes: dict[tuple[str, str, str], list[Problem]] = {}
    for problem in problems:
        key = (problem.code, problem.rule, problem.cause or problem.message)
        causes.setdefault(key, []).append(problem)
    return causes


@given(st.integers(0, 60), st.integers(0, 80), SEEDS)
@examples(60)
def test_each_error_is_in_the_first_rows(many: int, others: int, seed: int) -> None:
    """Each of up to 35 causes has a row of its own with its code and line; of more their number is said."""
    errors = problems_of(ERRORS, many, seed)
    causes = causes_in(errors)
    rows = screen([*problems_of(OTHERS, others, seed), *errors])[:SCREEN]
    heads = [match for row in rows if (match := _HEAD.match(row))]
    assert [head["severity"] for head in heads].count("error") == min(len(causes), MOST)
    text = "\n".join(rows)
    if len(causes) <= MOST:
        for group in causes.values():
            first = min(group, key=lambda problem: problem.location[:3])
            assert first.code in text
            assert f"{first.location.path[-16:]}:{first.location.line}" in text
    else:
        assert "more error" in text
        assert "--verbose" in text


@given(st.integers(0, 12), st.integers(0, 20), SEEDS)
@examples(40)
def test_errors_are_first_and_each_kind_of_the_others_has_a_row(
    errors: int, others: int, seed: int
) -> None:
    """Then warnings, then notes; a kind that is not spelled out has a row with how many there are."""
    doubts = problems_of(OTHERS, others, seed)
    rows = screen([*doubts, *problems_of(ERRORS, errors, seed)])
    heads = [match for row in rows if (match := _HEAD.match(row))]
    severities = [head["severity"] for head in heads]
    assert severities == sorted(severities, key=("error", "warning", "note").index)
    assert {head["code"] for head in heads} >= {problem.code for problem in doubts}


@given(st.integers(0, 50), SEEDS)
@examples(40)
def test_verbose_spells_out_each_problem(many: int, seed: int) -> None:
    """The message and the line of each are there, whatever it is grouped with."""
    problems = problems_of(EVERY_KIND, many, seed)
    text = "".join("\n".join(screen(problems, verbose=True)).split())
    for problem in problems:
        assert problem.message.replace(" ", "") in text
        assert str(problem.location.line) in text


def test_what_one_mistake_makes_is_one_row_with_its_places() -> None:
    """Equal messages of several files, and other messages of one cause, are grouped."""
    kind = ERRORS[0]
    equal = [Problem(kind, "no frame 'lasr'", Location("a.yaml", line, 3)) for line in (3, 9)]
    equal.append(Problem(kind, "no frame 'lasr'", Location("b.yaml", 4, 1)))
    meshes = [
        Problem(kind, f"no file {name}.stl", Location("a.urdf", line, 1), cause="meshes")
        for line, name in enumerate("abc", 7)
    ]
    assert screen([*equal, *meshes])[3:11] == [
        f"  {kind.code} error a.urdf:7: no file a.stl",
        "                likewise at a.urdf:8, 9",
        "                7 │ a: 1",
        "                  │ ──",
        f"  {kind.code} error a.yaml:3: no frame 'lasr'",
        "                also at a.yaml:9; b.yaml:4",
        "                3 │ a: 1",
        "                  │   ──",
    ]
