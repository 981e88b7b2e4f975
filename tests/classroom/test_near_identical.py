"""Equal and nearly equal work: robots that differ in their Gazebo elements only."""

import json
from pathlib import Path

import pytest

from tests.classroom.gradebooks import grader
from tests.samples import ROOT

pytestmark = pytest.mark.slow

URDF = (ROOT / "rubrics/lab6/my_robot/urdf/my_robot.urdf").read_text(encoding="utf-8")
OWN = URDF.replace("0.15 0 0.225", "0.15 0 0.2")  # a mistake
PARTS = "the same links, joints and materials"


def with_colours(urdf: str, colour: str) -> str:
    """Return a robot with Gazebo elements of a colour."""
    links = (
        f'<gazebo reference="l{at}">\n  <material>{colour}</material>\n</gazebo>\n'
        for at in range(5)
    )
    return urdf.replace("</robot>", f"{''.join(links)}</robot>")


def equal(top: Path, *more: object, **robots: str) -> list[tuple[str, str]]:
    """Write single URDFs, grade the class, and return the students with equal work, and what is the same."""
    (top / "class").mkdir(exist_ok=True)
    for name, urdf in robots.items():
        (top / f"class/{name}.urdf").write_text(urdf, encoding="utf-8")
    done = grader(
        "batch", top / "class", "--gradebook", top / "book", "--format", "json", "--jobs", 1, *more
    )
    assert done.returncode == 0, done.stderr
    return [
        (" ".join(work["students"]), work["equal"]) for work in json.loads(done.stdout)["equal"]
    ]


def test_white_space_and_five_colours(tmp_path: Path) -> None:
    """The list and `stats` say what is the same."""
    spaced = with_colours(OWN, "Gazebo/Blue").replace("  <", "\t<").replace("<!--", "<!-- mine")
    assert equal(tmp_path, ann=with_colours(OWN, "Gazebo/Red"), bob=spaced, eve=URDF) == [
        ("ann bob", PARTS)
    ]
    assert f"  ann and bob: {PARTS}\n" in grader("stats", "--gradebook", tmp_path / "book").stdout


@pytest.mark.parametrize(
    ("old", "new", "found"),
    [
        ("0.6 0.4 0.2", "0.60 0.4 0.2", []),
        ('name="white"', 'name="light"', []),
        ('name="my_robot"', 'name="my_robot" version="1"', [("ann bob", PARTS)]),
    ],
)
def test_how_the_robot_is_written_counts(
    old: str, new: str, found: list[object], tmp_path: Path
) -> None:
    """Equal numbers alone are no equal work: students of one lab write the same numbers."""
    assert old in OWN
    other = with_colours(OWN.replace(old, new), "Gazebo/Blue")
    assert equal(tmp_path, ann=with_colours(OWN, "Gazebo/Red"), bob=other) == found


def test_the_robot_that_was_handed_out(tmp_path: Path) -> None:
    """The reference, and what --ignore-file names, with other Gazebo elements are no equal work; the same file is."""
    handout = OWN.replace("0.05", "0.06")
    (tmp_path / "start.urdf").write_text(handout, encoding="utf-8")
    given = {"ann": URDF, "bob": URDF, "eve": handout, "joe": handout}
    robots = {name: with_colours(urdf, f"Gazebo/{name}") for name, urdf in given.items()}
    assert equal(tmp_path, **robots, kim=robots["bob"]) == [
        ("bob kim", "the same file"),
        ("eve joe", PARTS),
    ]
    assert equal(tmp_path, "--ignore-file", tmp_path / "start.urdf") == [
        ("bob kim", "the same file")
    ]


def test_what_many_share_was_handed_out(tmp_path: Path) -> None:
    """If more than four students, or a tenth of the class, build on the same robot, it is the lab's."""
    robots = {f"s{at}": with_colours(OWN, f"Gazebo/{at}") for at in range(5)}
    last = robots.pop("s4")
    assert equal(tmp_path, **robots) == [("s0 s1 s2 s3", PARTS)]
    assert equal(tmp_path, s4=last) == []
