"""Text that attacks a page, and a class whose students write it wherever they can, graded, marked and exported."""

import csv
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from tests.classroom.gradebooks import grader
from tests.report.hostile import HOSTILE, SLOTS, write_submission

# Each does something where a page forgets to escape: between tags, in quotes, in a script, in a style, in an address, in a
# template, in a name that the page's own script looks up.
ATTACKS: tuple[str, ...] = tuple(HOSTILE["attacks"])


class AttackedClass(NamedTuple):
    """A class with one student for each attack: the folders of the submissions, the gradebook, the exported pages."""

    folders: tuple[Path, ...]
    book: Path
    pages: Path


def make_attacked_class(top: Path, attacks: Sequence[str] = ATTACKS) -> AttackedClass:
    """Grade a class with each attack in the names, files, robots, answers, comments and marks of a student."""
    rows, folders = [["id", "name", "section"]], []
    for number, text in enumerate(attacks):
        visible = text.replace("\0", "\x01")
        folders.append(top / "class" / f"{number} {visible.replace('/', chr(0x2215))}")
        write_submission(folders[-1], dict.fromkeys((*SLOTS, "box", "setup", "frame"), text))
        rows.append([folders[-1].name, visible, visible])
    (top / "class" / ATTACKS[7].replace("/", "\u2215")).with_suffix(".zip").write_bytes(b"no zip")
    with (top / "roster.csv").open("w", encoding="utf-8", newline="") as file:
        csv.writer(file).writerows(rows)
    with (top / "marks.csv").open("w", encoding="utf-8", newline="") as file:
        marks = [[row[0], "lidar-frame", "1", row[1]] for row in rows[1:]]
        csv.writer(file).writerows([["student", "criterion", "points", "comment"], *marks])
    book, pages = top / "book", top / "pages"
    for command in (
        ("batch", top / "class", "--gradebook", book, "--roster", top / "roster.csv"),
        ("mark", "--import", top / "marks.csv", "--by", ATTACKS[0], "--gradebook", book),
        ("export", "html", "--gradebook", book, "--output", pages),
    ):
        done = grader(*command)
        assert done.returncode == 0, done.stderr[-1000:]
    return AttackedClass((*folders,), book, pages)
