"""grader review: a class by a sheet for a spreadsheet, one section, numbers in place of names, what is refused."""

import csv
from collections import Counter
from pathlib import Path

import pytest

from tests.checks.submissions import gif
from tests.classroom.desk_class import ANSWERS, PICTURES, STUDENTS, make_desk_class
from tests.classroom.gradebooks import batch, grader, lab_text, refusal, write_submission
from tests.review_server import marks_in, running

# Keys with names and file names that occur nowhere else in an output.
NAMES = {"u7701": "Zebulon Ash", "u7702": "Wilhelmina Birch", "u7703": "Ignatius Cedar"}
ROSTER = "id,name,section\nu7701,Zebulon Ash,Lab A\nu7702,Wilhelmina Birch,Lab B\nu7703,Ignatius Cedar,Lab A\n"


@pytest.fixture
def book(tmp_path: Path) -> Path:
    """Return the gradebook of a class of three in two sections; the names of their files contain their names."""
    for (key, name), words in zip(
        NAMES.items(), ("The red roots.", "=1+1", "The red roots."), strict=True
    ):
        folder = tmp_path / "class" / key
        write_submission(folder, answer=words)
        (folder / "answers.md").rename(folder / f"answers {name}.md")
        (folder / "screen.png").rename(folder / f"screen {name}.png")
        (folder / f"screen 2 {name}.png").write_bytes(b"<svg/>" if key == "u7701" else gif())
    (tmp_path / "roster.csv").write_text(ROSTER)
    (tmp_path / "small.toml").write_text(lab_text())
    assert batch(tmp_path).returncode == 0
    return tmp_path / "book"


def sheet_of(book: Path, *options: object) -> list[dict[str, str]]:
    """Return the rows of a new sheet."""
    file = book.parent / f"sheet{len([*book.parent.glob('*.csv')])}.csv"
    done = grader("review", "--gradebook", book, "--sheet", file, *options)
    assert done.returncode == 0, done.stderr
    assert f"grader mark --import {file} --gradebook {book}" in done.stdout
    with file.open(encoding="utf-8-sig", newline="") as opened:
        return list(csv.DictReader(opened))


@pytest.mark.slow
def test_a_class_is_marked_by_a_sheet(tmp_path: Path) -> None:
    """121 students, 40 with answers: a row for each answer, which `mark --import` gives to all who have it."""
    make_desk_class(tmp_path)
    book, sheet = tmp_path / "book", tmp_path / "sheet.csv"
    done = grader(
        "batch", tmp_path / "class", "--gradebook", book, "--roster", tmp_path / "roster.csv"
    )
    assert done.returncode == 0, done.stderr
    written = grader("review", "--gradebook", book, "--sheet", sheet).stdout
    assert written.startswith(f"87 items written for {3 * STUDENTS} marks")
    with sheet.open(newline="") as file:
        rows = list(csv.DictReader(file))
    with sheet.open("w", newline="") as file:
        writer = csv.DictWriter(file, rows[0], delimiter=";")  # as a spreadsheet may save it
        writer.writeheader()
        for row in rows:
            most = 2 if row["criterion"] == "evidence-webcam" else 4
            writer.writerow(
                {
                    **row,
                    "points": "0" if row["text"].startswith("No ") else f"{most},0",
                    "comment": "read",
                }
            )
    done = grader("mark", "--import", sheet, "--gradebook", book, "--by", "Kim")
    assert done.stdout == f"{sheet}: {3 * STUDENTS} recorded, 0 the same as before\n"
    assert Counter((criterion, points) for _, criterion, points, _ in marks_in(book)) == {
        ("answer-floating-link", "0"): STUDENTS - ANSWERS,
        ("answer-floating-link", "4"): ANSWERS,
        ("answer-launch-nodes", "0"): STUDENTS - ANSWERS,
        ("answer-launch-nodes", "4"): ANSWERS,
        ("evidence-webcam", "0"): STUDENTS - PICTURES,
        ("evidence-webcam", "2"): PICTURES,
    }
    assert sheet_of(book) == []


@pytest.mark.slow
def test_a_student_without_a_robot_and_answers_is_one_row(tmp_path: Path) -> None:
    """Its points are the grade; a sheet of one criterion or without names has all rows."""
    for key in ("u1", "u2", "u3"):
        write_submission(tmp_path / "class" / key, answer=key)
    for name in ("u1/robot.urdf", "u1/answers.md", "u1/screen.png", "u3/robot.urdf"):
        (tmp_path / "class" / name).unlink()
    (tmp_path / "class/u1/all.pdf").write_bytes(b"%PDF-1.4\n")
    (tmp_path / "roster.csv").write_text("id,name\nu1,Ada\nu2,Bo\nu3,Cy\n")
    (tmp_path / "small.toml").write_text(lab_text())
    assert batch(tmp_path).returncode == 0
    book = tmp_path / "book"
    *others, row = sheet_of(book)
    assert {other["students"] for other in others} == {"u2", "u3"}
    assert (row["criterion"], row["students"]) == ("grade", "u1")
    assert "u1" in {other["students"] for other in sheet_of(book, "--criterion", "essay")}
    assert len(sheet_of(book, "--anonymous")) > len(others) + 1
    file = tmp_path / "sheet.csv"
    file.write_text("criterion,answer,points,students\ngrade,,3,u9\n")
    assert "u9" in refusal(grader("mark", "--import", file, "--gradebook", book))
    file.write_text("criterion,answer,points,students\ngrade,,3,u1\n")
    done = grader("mark", "--import", file, "--gradebook", book)
    assert done.stdout == f"{file}: 1 recorded, 0 the same as before\n"
    assert sheet_of(book) == others


def test_the_sheet_has_what_there_is_to_read(book: Path) -> None:
    """The answer and its file, pictures, and who has it; no cell is a formula, and marked items are missing."""
    first, formula, *pictures = sheet_of(book)
    where = "answers Zebulon Ash.md, line 1 in u7701"
    assert first["text"].split("\n")[-2:] == ["The red roots.", where]
    assert [first[name] for name in ("criterion", "students", "points", "maximum")] == [
        "essay",
        "u7701; u7703",
        "",
        "4",
    ]
    assert "'=1+1" in formula["text"]
    assert [row["text"].count(" in u770") for row in pictures] == [2, 2, 2]
    assert str(book.parent) not in str((first, formula, *pictures))
    assert [
        row["students"] for row in sheet_of(book, "--section", "lab b", "--criterion", "essay")
    ] == ["u7702"]
    assert grader("mark", "u7702", "essay", "1", "--gradebook", book).returncode == 0
    assert [row["students"] for row in sheet_of(book, "--criterion", "essay")] == ["u7701; u7703"]


def test_a_sheet_marks_those_whom_it_names(book: Path) -> None:
    """Not those with the same answer who are in another section, or marked already; without names all of them.

    A final mark, or an excuse, which came after the sheet does not stop the import.
    """
    assert grader("mark", "u7701", "essay", "4", "--gradebook", book, "--by", "Lee").returncode == 0
    [row] = sheet_of(book, "--section", "Lab A", "--criterion", "essay")
    file = book.parent / "filled.csv"
    assert (
        grader("mark", "u7703", "total", "excused", "--gradebook", book, "--by", "Mo").returncode
        == 0
    )
    for students, points in ((row["students"], "4"), ("", "2")):
        file.write_text(f"criterion,answer,points,students\nessay,{row['answer']},2,{students}\n")
        assert grader("mark", "--import", file, "--gradebook", book).returncode == 0
        assert [mark[2] for mark in marks_in(book)] == [points, "2", "excused"]


def test_a_sheet_is_never_overwritten(book: Path) -> None:
    """It may have marks in it."""
    file = book.parent / "marked.csv"
    file.write_text("mine")
    why = refusal(grader("review", "--gradebook", book, "--sheet", file))
    assert why == f"{file} exists, perhaps with marks in it: name another file for --sheet"
    assert file.read_text() == "mine"


@pytest.mark.slow
def test_an_anonymous_review(book: Path) -> None:
    """No name, key, path or file name: not in pages, captions, addresses and messages, and not in a sheet."""
    with running(book, by="Kim", is_anonymous=True) as served:
        pages = [served.get(f"{number}").text for number in range(1, 6)]
        assert "".join(pages).count("<figure>") > 1
        assert "The red roots." in "".join(pages)
        sent = served.mark("1", "3", "good")
        newer = served.mark("1", "2", "bad", shown="")
        (book / "marks" / "kim.csv").unlink()
        lost = served.mark("2", "2")
        end = served.get("end").text
    assert "changed" in newer["error"] and "no longer in marks/kim.csv" in lost["error"]
    assert "submission 1" in pages[0] + pages[1]
    words = [
        *NAMES,
        *(word for name in NAMES.values() for word in name.split()),
        str(book.parent / "class"),
        "screen 2",
    ]
    for text in (*pages, str(sent), str(newer), str(lost), end, str(sheet_of(book, "--anonymous"))):
        assert [word for word in words if word in text] == []


def test_model_answers(book: Path) -> None:
    """Those in the rubric are on the page; the rubric's own file of them is not in the gradebook, and --answers names it."""
    with running(book) as served:
        assert "Because of the roots." in served.get("1").text
    text = (book / "rubric" / "small.toml").read_text()
    (book / "rubric" / "small.toml").write_text(
        text.replace('answer = "Because of the roots.", ', "")
    )
    (book.parent / "answers.toml").write_text('essay = "Model roots."\n')
    with running(book) as served:
        assert "Because of the roots." not in served.get("1").text
    with running(book, answers=book.parent / "answers.toml") as served:
        assert "Model roots." in served.get("1").text
    (book.parent / "answers.toml").write_text('esay = "Model roots."\n')
    refused = refusal(
        grader("review", "--gradebook", book, "--answers", book.parent / "answers.toml")
    )
    assert "has no question 'esay'; did you mean 'essay'" in refused


@pytest.mark.parametrize(
    ("options", "why"),
    [
        (("--section", ""), "--section is empty: name a section, or omit it to review all"),
        (("--criterion", "esay"), "did you mean 'essay'"),
    ],
)
def test_what_is_refused(options: tuple[str, ...], why: str, book: Path) -> None:
    """An empty section would be all: a script with an unset variable gets a line instead."""
    assert why in refusal(grader("review", "--gradebook", book, *options))


def test_nothing_to_review(book: Path) -> None:
    """Where all students have final marks, nothing is served."""
    for key in NAMES:
        assert grader("mark", key, "total", "5", "--gradebook", book).returncode == 0
    assert grader("review", "--gradebook", book).stdout == "nothing needs manual grading\n"
