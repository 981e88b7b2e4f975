"""grader diff: who changed between two runs or gradebooks, and why, for people and programs."""

import json
import re
import shutil
from pathlib import Path
from typing import Any

import jsonschema

from grader.classroom.gradebook.gradebook import Gradebook
from tests.classroom.gradebooks import (
    batch,
    graded_as,
    grader,
    lab,
    lab_text,
    record_run,
    refusal,
    urdf,
    write_submission,
)


def diff(top: Path, *more: object) -> str:
    """Return the output without the line that names the runs."""
    done = grader("diff", top / "book.db", *more)
    assert (done.returncode, done.stderr) == (0, "")
    first, rest = done.stdout.split("\nrun 2", 1)[0], done.stdout
    assert re.match(r"From run \d+ of 20\S+ \S+ \(UTC\S*\) to run \d+ of 20\S+ \S+ \(UTC\S*\)\n", rest), first
    return rest.partition("\n")[2]


def as_json(*arguments: object) -> dict[str, Any]:
    """Return the same as JSON, valid under its schema."""
    data = json.loads(grader("diff", *arguments, "--format", "json").stdout)
    jsonschema.validate(data, json.loads(grader("schema", "diff").stdout))
    return dict(data)


def test_one_run_is_not_enough(graded_class: Path) -> None:
    """One line says what to do."""
    book = graded_class / "book.db"
    again = f"`grader batch PATH --gradebook {book}` again, or name a second gradebook"
    assert refusal(grader("diff", book)) == f"there are not two runs to compare: run {again}"


def test_all_reasons(top: Path) -> None:
    """First no change, then one reason after the other."""
    batch(top)
    assert diff(top) == "nothing changed\n"
    assert as_json(top / "book.db")["students"] == []
    (top / "class" / "anna" / "robot.urdf").write_text(urdf("2 2 2"))
    write_submission(top / "class" / "dora")
    batch(top)
    assert diff(top) == (
        "\nthe submission changed (1 student)\n  Anna Ek (anna): 6 to 3 (-3)\n    box: 2.5 to 0 (-2.5)\n    tall: 0.5 to 0 (-0.5)\n"
        "\nfirst submission (1 student)\n  Dora Fi (dora): none to 6\n"
    )
    grader("mark", "dora", "essay", "3", "--gradebook", top / "book.db")
    (top / "newer.toml").write_text(lab_text(loads="4", extra="1"))
    batch(top, rubric=top / "newer.toml")
    assert diff(top) == (
        "\nthe rubric changed (3 students)\n  loads: points 3 to 4\n  extra: added\n"
        "  loads: 3 to 4 (+1)\n  extra: none to 1\n"
        "    Anna Ek (anna): 3 to 5 (+2)\n    Ben Oh (ben): 6 to 8 (+2)\n    Ben Oh (emil): 3 to 5 (+2)\n"
        "\nthe rubric changed; manual marks changed (1 student)\n  loads: points 3 to 4\n  extra: added\n"
        "  Dora Fi (dora): 6 to 11 (+5)\n    loads: 3 to 4 (+1)\n    essay: none to 3\n    extra: none to 1\n"
    )
    assert diff(top, "--after", 2) == "nothing changed\n"
    assert refusal(grader("diff", top / "book.db", "--before", 9)) == "there is no run 9; the runs are: 1, 2, 3, 4"


def test_a_renamed_criterion(top: Path) -> None:
    """The manual mark that no longer counts is named, whether it counted in the older run or came later."""
    assert grader("mark", "anna", "essay", "3", "--gradebook", top / "book.db").returncode == 0
    assert batch(top).returncode == 0
    assert grader("mark", "ben", "essay", "2", "--gradebook", top / "book.db").returncode == 0
    (top / "newer.toml").write_text(lab_text().replace('id = "essay"', 'id = "text"'))
    done = batch(top, "--verbose", rubric=top / "newer.toml")
    shown = " ".join(done.stdout.split())
    reason = "a manual mark is of a criterion that the rubric no longer has"
    assert f"{reason} (2) Anna Ek (anna): essay Ben Oh (ben): essay" in shown
    assert diff(top) == (
        "\nthe rubric changed; the manual mark of essay no longer counts: the rubric no\nlonger has it (1 student)\n"
        "  essay: removed\n  Anna Ek (anna): 9 to 6 (-3)\n    essay: 3 to none\n"
        "\nthe rubric changed; manual marks changed; the manual mark of essay no longer\n"
        "counts: the rubric no longer has it (1 student)\n  essay: removed\n  Ben Oh (ben): 6 as before\n"
    )


def test_two_gradebooks(top: Path, tmp_path: Path) -> None:
    """Students in only one of them are reported, and the JSON form is complete."""
    shutil.copy(top / "book.db", tmp_path / "before.db")
    write_submission(top / "class" / "zoe")
    batch(top)
    grader("mark", "emil", "essay", "0", "--gradebook", top / "book.db")
    data = as_json(tmp_path / "before.db", top / "book.db")
    assert (data["from"]["run"], data["to"]["run"]) == (1, 2)
    essay = [{"id": "essay", "before": None, "after": 0}]
    assert data["students"] == [
        {
            "id": "emil",
            "name": "Ben Oh",
            "before": 3,
            "after": 3,
            "reasons": ["manual marks changed"],
            "criteria": essay,
            "rubric": [],
        },
        {
            "id": "zoe",
            "name": "",
            "before": None,
            "after": 6,
            "reasons": ["first submission"],
            "criteria": [],
            "rubric": [],
        },
    ]
    back = as_json(top / "book.db", tmp_path / "before.db")["students"]
    assert [change["reasons"] for change in back] == [["manual marks changed"], ["no longer there"]]
    both = refusal(grader("diff", top / "book.db", tmp_path / "before.db", "--before", 1))
    assert both == "--before and --after choose runs of one gradebook: give one gradebook, or omit them"
    assert "there is no gradebook" in refusal(grader("diff", top / "book.db", tmp_path / "none.db"))
    named = grader("diff", "--gradebook", top / "book.db", tmp_path / "before.db", "--format", "json").stdout
    assert json.loads(named)["students"] == back
    for books in ((), [top / "book.db"] * 3, ["--gradebook", *[top / "book.db"] * 3]):
        assert "give one gradebook, or two to compare" in refusal(grader("diff", *books))


def test_one_damaged_zip_is_a_few_lines(tmp_path: Path) -> None:
    """Criteria with the same change share a line, there are at most twelve, and a change of the verdict alone counts."""
    numbers = range(1, 31)
    for name, rubric in (
        ("few", lab(**{f"c{number}": "1" for number in numbers})),
        ("many", lab(**{f"c{number}": str(number) for number in numbers})),
    ):
        with Gradebook(tmp_path / f"{name}.db", create=True) as book:
            record_run(book, rubric, [graded_as(rubric, "anna", "ppp??" + "f" * 30)])
            record_run(book, rubric, [graded_as(rubric, "anna", "fff??" + "?" * 15 + "p" * 15, "b")])
    lines = grader("diff", tmp_path / "few.db").stdout.splitlines()
    assert lines[4:] == [
        "    loads: 3 to 0 (-3)",
        "    box: 2.5 to 0 (-2.5)",
        "    tall: 0.5 to 0 (-0.5)",
        "    c1, c2, c3 and 12 more: 0 to none each",
        "    c16, c17, c18 and 12 more: 0 to 1 (+1) each",
    ]
    lines = grader("diff", tmp_path / "many.db").stdout.splitlines()
    assert len(lines) == 4 + 12 + 1
    assert lines[-2:] == ["    c23: 0 to 23 (+23)", "    ... and 7 more"]
    reported = as_json(tmp_path / "many.db")["students"][0]["criteria"]
    assert len(reported) == 33


def test_only_the_verdict_changed(tmp_path: Path) -> None:
    """No criterion is reported if none changed."""
    rubric = lab()
    with Gradebook(tmp_path / "book.db", create=True) as book:
        record_run(book, rubric, [graded_as(rubric, "anna", "?????")])
        record_run(book, rubric, [graded_as(rubric, "anna", "?????", "b", "it is no zip")])
    assert diff(tmp_path) == (
        "\nthe submission changed; it was graded, and is unreadable (1 student)\n  anna: 0 as before\n"
    )


def test_a_long_class_is_grouped(tmp_path: Path) -> None:
    """The largest group first: what changed in the rubric, what that changed in criteria, then each student once."""
    keys = [f"s{number:03}" for number in range(120)]
    older, newer = lab(), lab(box="5")
    with Gradebook(tmp_path / "book.db", create=True) as book:
        record_run(book, older, [graded_as(older, key, "ppp??") for key in keys] + [graded_as(older, "zoe", "pfs??")])
        found = [graded_as(newer, key, "pfs??" if key == "s007" else "ppp??", key) for key in keys]
        record_run(book, newer, [*found, graded_as(newer, "zoe", "pfs??")])
    lines = diff(tmp_path).splitlines()
    assert lines[:4] == [
        "",
        "the submission changed; the rubric changed (120 students)",
        "  box: points 2.5 to 5",
        "  box: 2.5 to 5 (+2.5)",
    ]
    assert lines[4:123] == [f"    {key}: 6 to 8.5 (+2.5)" for key in keys if key != "s007"]
    assert lines[123:] == [
        "  s007: 6 to 3 (-3)",
        "    box: 2.5 to 0 (-2.5)",
        "    tall: 0.5 to 0 (-0.5)",
    ]


def test_a_change_of_the_rubric_is_named(top: Path) -> None:
    """Arguments, adjustments with their reason, extra credit, removed criteria, and what a criterion requires."""
    text = lab_text().replace("size = [1, 1, 1]", "size = [1, 1, 2]").replace('"picture"', '"photo"')
    text = text.replace('id = "essay"', 'id = "essay"\nbonus = true')
    (top / "newer.toml").write_text(text + '\n[adjust.loads]\naction = "drop"\nreason = "[b]odd[/b]\tname"\n')
    batch(top)
    grader("mark", "anna", "essay", "2", "--gradebook", top / "book.db")
    batch(top, rubric=top / "newer.toml")
    text = " ".join(diff(top).split())
    for words in (
        "loads: Not counted: [b]odd[/b] name",
        "box: size [1, 1, 1] to [1, 1, 2]",
        "Ben Oh (emil): 3 to 2.5 (-0.5)",
    ):
        assert words in text
    found = {student["id"]: student for student in as_json(top / "book.db")["students"]}
    assert found["emil"]["name"] == "Ben Oh"
    assert found["emil"]["rubric"] == [
        {"id": "loads", "key": "adjust", "before": None, "after": {"action": "drop", "reason": "[b]odd[/b] name"}},
        {"id": "box", "key": "size", "before": [1, 1, 1], "after": [1, 1, 2]},
    ]
    assert found["anna"]["criteria"][-1] == {"id": "essay", "before": None, "after": 2}
    assert found["anna"]["rubric"][-1] == {"id": "essay", "key": "bonus", "before": False, "after": True}


def test_names_are_escaped(top: Path) -> None:
    """Escape sequences and bidirectional marks in a key are escaped."""
    write_submission(top / "class" / "x[red]\x1b[31m\u202ey")
    batch(top)
    text = diff(top)
    assert "[red]" in text
    assert not set(text) & set("\x1b\u202e")


def test_other_parts(top: Path) -> None:
    """A run on one part of the rubric only is the reason for points that are no longer there."""
    batch(top)
    batch(top, "--part", "report")
    found = as_json(top / "book.db")["students"]
    assert found
    assert {tuple(student["reasons"]) for student in found} == {("graded on other parts",)}


def test_an_interrupted_run_is_not_compared_by_default(tmp_path: Path) -> None:
    """Whom the interrupted run graded again is in the comparison of the run that resumed it; a number still names it."""
    rubric = lab()
    with Gradebook(tmp_path / "book.db", create=True) as book:
        record_run(book, rubric, [graded_as(rubric, key, "fff??") for key in ("ash", "birch")])
        record_run(book, rubric, [graded_as(rubric, "ash", "pff??", "b")])
        with book.transaction():
            book.connection.execute("UPDATE run SET finished = NULL WHERE id = 2")
        assert "not two runs" in refusal(grader("diff", tmp_path / "book.db"))
        record_run(book, rubric, [graded_as(rubric, "birch", "pff??", "b")])
    run = re.compile(r"From run (\d).* to run (\d)")
    for arguments, runs, students in (
        ((), ("1", "3"), {"ash", "birch"}),
        (("--before", 2), ("2", "3"), {"birch"}),
        (("--after", 2), ("1", "2"), {"ash"}),
    ):
        done = grader("diff", tmp_path / "book.db", *arguments)
        assert (found := run.match(done.stdout)), done
        assert found.groups() == runs
        assert {key for key in ("ash", "birch") if key in done.stdout} == students


def test_students_with_the_same_grade_are_counted(tmp_path: Path) -> None:
    """If one of 79 students has another grade, one line counts the others, whose points only moved between criteria."""
    older, newer = lab(box="2.5", tall="0.5"), lab(box="1.5", tall="1.5")
    keys = [f"s{number:02}" for number in range(78)]
    with Gradebook(tmp_path / "book.db", create=True) as book:
        record_run(book, older, [graded_as(older, key, "ppp??") for key in (*keys, "zoe")])
        record_run(book, newer, [*(graded_as(newer, key, "ppp??") for key in keys), graded_as(newer, "zoe", "ppf??")])
    assert diff(tmp_path).splitlines()[1:] == [
        "the rubric changed (79 students)",
        "  box: points 2.5 to 1.5",
        "  tall: points 0.5 to 1.5",
        "  zoe: 6 to 4.5 (-1.5)",
        "    box: 2.5 to 1.5 (-1)",
        "    tall: 0.5 to 0 (-0.5)",
        "  78 students with the same grade, but other points of criteria",
    ]
    assert len(as_json(tmp_path / "book.db")["students"]) == 79


def test_a_late_penalty_is_part_of_the_grade(top: Path) -> None:
    """Adding `[late]` lists who loses points, although no criterion changed; an excuse and a final mark have no penalty."""
    (top / "roster.csv").write_text("id,late\nanna,2\nben,2\ncleo,\nemil,no\n")
    batch(top)
    assert grader("mark", "ben", "total", "9", "--gradebook", top / "book.db").returncode == 0
    batch(top)
    (top / "late.toml").write_text(lab_text() + "\n[late]\npercent_per_day = 10\n")
    batch(top, rubric=top / "late.toml")
    text = " ".join(diff(top).split())
    assert "the rubric changed; late penalty: 0 to 2.2 (1 student)" in text
    assert "anna): 6 to 3.8 (-2.2)" in text
    assert "ben" not in text
    (change,) = as_json(top / "book.db")["students"]
    assert (change["id"], change["before"], change["after"], change["criteria"]) == ("anna", 6, 3.8, [])
