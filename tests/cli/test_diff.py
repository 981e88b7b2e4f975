"""grader diff: who changed between two runs or gradebooks, and why, for a person and for programs."""

import json
import re
import shutil
from pathlib import Path
from typing import Any

import jsonschema

from tests.classroom.gradebooks import batch, grader, hand_in, lab_text, refusal, urdf


def diff(top: Path, *more: object) -> str:
    """What it says, without the line that names the runs."""
    done = grader("diff", top / "book.db", *more)
    assert (done.returncode, done.stderr) == (0, "")
    first, rest = done.stdout.split("\nrun 2", 1)[0], done.stdout
    assert re.match(r"From run \d+ of 20\S+ to run \d+ of 20\S+\n", rest), first
    return rest.partition("\n")[2]


def as_json(*arguments: object) -> dict[str, Any]:
    """The same as JSON, which the schema knows."""
    data = json.loads(grader("diff", *arguments, "--format", "json").stdout)
    jsonschema.validate(data, json.loads(grader("schema", "diff").stdout))
    return dict(data)


def test_one_run_is_not_enough(graded_class: Path) -> None:
    """One line says what to do."""
    why = "there are no two runs to compare: grade again first, or name another gradebook"
    assert refusal(grader("diff", graded_class / "book.db")) == why


def test_all_reasons(top: Path) -> None:
    """Nothing changed, then one thing after the other did."""
    batch(top)
    assert diff(top) == "nothing changed\n"
    assert as_json(top / "book.db")["students"] == []
    (top / "class" / "anna" / "robot.urdf").write_text(urdf("2 2 2"))
    hand_in(top / "class" / "dora")
    batch(top)
    assert diff(top) == (
        "anna: 6 to 3 (-3)\n  the submission changed\n    box: 2.5 to 0 (-2.5)\n    tall: 0.5 to 0 (-0.5)\n"
        "dora: none to 6\n  handed in for the first time\n"
    )
    grader("mark", "dora", "essay", "3", "--gradebook", top / "book.db")
    (top / "newer.toml").write_text(lab_text(loads="4", extra="1"))
    batch(top, rubric=top / "newer.toml")
    assert diff(top).endswith(
        "dora: 6 to 11 (+5)\n  the rubric changed; marked by hand\n"
        "    loads: 3 to 4 (+1)\n    essay: none to 3\n    extra: none to 1\n"
        "emil: 3 to 5 (+2)\n  the rubric changed\n    loads: 3 to 4 (+1)\n    extra: none to 1\n"
    )
    assert diff(top, "--to", 2) == "nothing changed\n"
    assert refusal(grader("diff", top / "book.db", "--from", 9)) == "there is no run 9; there are: 1, 2, 3, 4"


def test_two_gradebooks(top: Path, tmp_path: Path) -> None:
    """Who was in one only is told, and the JSON form has all of it."""
    shutil.copy(top / "book.db", tmp_path / "before.db")
    hand_in(top / "class" / "zoe")
    batch(top)
    grader("mark", "emil", "essay", "0", "--gradebook", top / "book.db")
    data = as_json(tmp_path / "before.db", top / "book.db")
    assert (data["from"]["run"], data["to"]["run"]) == (1, 2)
    essay = [{"id": "essay", "before": None, "after": 0}]
    assert data["students"] == [
        {"id": "emil", "before": 3, "after": 3, "because": ["marked by hand"], "criteria": essay},
        {"id": "zoe", "before": None, "after": 6, "because": ["handed in for the first time"], "criteria": []},
    ]
    back = as_json(top / "book.db", tmp_path / "before.db")["students"]
    assert [each["because"] for each in back] == [["marked by hand"], ["not there any more"]]
    both = refusal(grader("diff", top / "book.db", tmp_path / "before.db", "--from", 1))
    assert both == "--from and --to are runs of one gradebook: name one, or leave them out"
    assert "there is no gradebook" in refusal(grader("diff", top / "book.db", tmp_path / "none.db"))


def test_names_are_harmless(top: Path) -> None:
    """A key that would colour or turn the terminal is spelt out."""
    hand_in(top / "class" / "x[red]\x1b[31m\u202ey")
    batch(top)
    text = diff(top)
    assert "[red]" in text
    assert not set(text) & set("\x1b\u202e")
