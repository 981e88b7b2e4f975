"""Equal and nearly equal work: robots that differ in their Gazebo elements only, and files of a package."""

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.classroom.gradebooks import grader
from tests.samples import ROOT

REFERENCE = ROOT / "rubrics/lab6/my_robot"
URDF = (REFERENCE / "urdf/my_robot.urdf").read_text(encoding="utf-8")
OWN = URDF.replace("0.15 0 0.225", "0.15 0 0.2")  # a mistake
SETUP, LAUNCH, RVIZ = "setup.py", "launch/my_robot_rviz.launch.py", "rviz/my_robot.rviz"
PARTS = "the same links, joints and materials"


def with_colours(urdf: str, colour: str) -> str:
    """Return a robot with Gazebo elements of a colour."""
    links = (f'<gazebo reference="l{at}">\n  <material>{colour}</material>\n</gazebo>\n' for at in range(5))
    return urdf.replace("</robot>", f"{''.join(links)}</robot>")


def write_package(folder: Path, urdf: str = URDF, **changes: Callable[[str], str]) -> None:
    """Write the reference's package with another URDF, and changes of setup.py, the launch file and the RViz file."""
    shutil.copytree(REFERENCE, folder)
    (folder / "urdf/my_robot.urdf").write_text(urdf, encoding="utf-8")
    for name, path in (("setup", SETUP), ("launch", LAUNCH), ("rviz", RVIZ)):
        text = (folder / path).read_text(encoding="utf-8")
        (folder / path).write_text(changes.get(name, str)(text), encoding="utf-8")


def equal(top: Path, *more: object, **robots: str) -> list[tuple[str, str]]:
    """Write single URDFs, grade the class, and return the students with equal work, and what is the same."""
    (top / "class").mkdir(exist_ok=True)
    for name, urdf in robots.items():
        (top / f"class/{name}.urdf").write_text(urdf, encoding="utf-8")
    done = grader("batch", top / "class", "--gradebook", top / "book", "--format", "json", "--jobs", 1, *more)
    assert done.returncode == 0, done.stderr
    return [(" ".join(work["students"]), work["equal"]) for work in json.loads(done.stdout)["equal"]]


def test_white_space_and_five_colours(tmp_path: Path) -> None:
    """The list and `stats` say what is the same."""
    spaced = with_colours(OWN, "Gazebo/Blue").replace("  <", "\t<").replace("<!--", "<!-- mine")
    assert equal(tmp_path, ann=with_colours(OWN, "Gazebo/Red"), bob=spaced, eve=URDF) == [("ann bob", PARTS)]
    assert f"  ann and bob: {PARTS}\n" in grader("stats", "--gradebook", tmp_path / "book").stdout


@pytest.mark.parametrize(
    ("old", "new", "found"),
    [
        ("0.6 0.4 0.2", "0.60 0.4 0.2", []),
        ('name="white"', 'name="light"', []),
        ('name="my_robot"', 'name="my_robot" version="1"', [("ann bob", PARTS)]),
    ],
)
def test_how_the_robot_is_written_counts(old: str, new: str, found: list[object], tmp_path: Path) -> None:
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
    assert equal(tmp_path, **robots, kim=robots["bob"]) == [("bob kim", "the same file"), ("eve joe", PARTS)]
    assert equal(tmp_path, "--ignore-file", tmp_path / "start.urdf") == [("bob kim", "the same file")]


def test_what_many_share_was_handed_out(tmp_path: Path) -> None:
    """If more than four students, or a tenth of the class, build on the same robot, it is the lab's."""
    robots = {f"s{at}": with_colours(OWN, f"Gazebo/{at}") for at in range(5)}
    last = robots.pop("s4")
    assert equal(tmp_path, **robots) == [("s0 s1 s2 s3", PARTS)]
    assert equal(tmp_path, s4=last) == []


def test_two_files_of_a_package(tmp_path: Path) -> None:
    """They are the same but for comments, white space, quotes and the state of the window; one alone does not count."""

    def setup(text: str) -> str:
        return f"{text}\nprint('x')\n"

    def rviz(text: str) -> str:
        return text.replace("Grid", "Floor")

    write_package(tmp_path / "class/ann", OWN, setup=setup, rviz=rviz)
    write_package(
        tmp_path / "class/bob",
        URDF.replace("0.05", "0.06"),
        setup=lambda text: "# mine\n" + setup(text).replace("'", '"').replace("    ", "\t"),
        rviz=lambda text: rviz(text) + "Window Geometry:\n  Height: 99\n",
        launch=lambda text: f"{text}X = 1\n",
    )
    write_package(tmp_path / "class/eve", URDF, setup=setup)
    assert equal(tmp_path) == [("ann bob", "the same setup.py and RViz files")]


def test_files_that_were_handed_out(tmp_path: Path) -> None:
    """A starter package that --ignore-file names, and what more than four students have, are no equal work."""

    def starter(text: str) -> str:
        return f"{text}\nX = 1\n"

    write_package(tmp_path / "start", setup=starter, launch=starter)
    for at, name in enumerate(("ann", "bob", "s0", "s1", "s2")):
        if at == 2:
            assert equal(tmp_path) == [("ann bob", "the same setup.py and launch files")]
            assert equal(tmp_path, "--ignore-file", tmp_path / "start") == []
        write_package(tmp_path / "class" / name, OWN.replace("0.05", f"0.1{at}"), setup=starter, launch=starter)
    shutil.rmtree(tmp_path / "book")
    assert equal(tmp_path) == []
