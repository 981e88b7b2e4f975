"""Nearly identical work: robots that differ in their Gazebo elements only, and files of a package."""

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tests.classroom.class_runs import grader, without_hints
from tests.samples import ROOT

REFERENCE = ROOT / "rubrics/lab6/my_robot"
URDF = (REFERENCE / "urdf/my_robot.urdf").read_text(encoding="utf-8")
OWN = URDF.replace("0.15 0 0.225", "0.15 0 0.2")  # a mistake
SETUP, LAUNCH, RVIZ = "setup.py", "launch/my_robot_rviz.launch.py", "rviz/my_robot.rviz"
PARTS = "the same links, joints and materials; "


def with_colours(urdf: str, colour: str, count: int = 5) -> str:
    """Return a robot with Gazebo elements of a colour."""
    links = (f'<gazebo reference="l{at}">\n  <material>{colour}</material>\n</gazebo>\n' for at in range(count))
    return urdf.replace("</robot>", f"{''.join(links)}</robot>")


def write_package(folder: Path, urdf: str = URDF, **changes: Callable[[str], str]) -> None:
    """Write the reference's package with another URDF, and changes of setup.py, the launch file and the RViz file."""
    shutil.copytree(REFERENCE, folder)
    (folder / "urdf/my_robot.urdf").write_text(urdf, encoding="utf-8")
    for name, path in (("setup", SETUP), ("launch", LAUNCH), ("rviz", RVIZ)):
        text = (folder / path).read_text(encoding="utf-8")
        (folder / path).write_text(changes.get(name, str)(text), encoding="utf-8")


def write_robots(top: Path, **robots: str) -> None:
    """Write a class of single URDFs."""
    (top / "class").mkdir(exist_ok=True)
    for name, urdf in robots.items():
        (top / f"class/{name}.urdf").write_text(urdf, encoding="utf-8")


def identical(top: Path, *more: object) -> list[tuple[str, str]]:
    """Return the students with identical work, and what is the same, of the class that is graded now."""
    options = ("--gradebook", top / "g.db", "--rubric", without_hints(), "--format", "json", *map(str, more))
    done = grader("batch", *map(str, (top / "class", *options)))
    assert done.returncode == 0, done.stderr
    found: list[dict[str, Any]] = json.loads(done.stdout)["identical"]
    return [(" ".join(work["students"]), work["equal"]) for work in found]


# --- Robots -----------------------------------------------------------------------------------------------------------


def test_white_space_and_five_colours(tmp_path: Path) -> None:
    """The line says what is the same, and how many lines differ in what."""
    spaced = with_colours(OWN, "Gazebo/Blue").replace("  <", "\t<").replace("<!--", "<!-- mine")
    write_robots(tmp_path, ann=with_colours(OWN, "Gazebo/Red"), bob=spaced, eve=URDF)
    assert identical(tmp_path) == [("ann bob", f"{PARTS}5 lines of <gazebo> differ")]
    shown = " ".join(grader("stats", "--gradebook", tmp_path / "g.db").stdout.split())
    assert f"ann and bob: {PARTS}5 lines of <gazebo> differ" in shown


def test_one_more_line(tmp_path: Path) -> None:
    """Of three robots, the most lines that one has alone are counted."""
    more = with_colours(OWN, "Gazebo/Red").replace("</robot>", '<transmission name="t"/></robot>')
    write_robots(tmp_path, ann=with_colours(OWN, "Gazebo/Red"), bob=more)
    assert identical(tmp_path) == [("ann bob", f"{PARTS}1 line of <transmission> differs")]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("0.6 0.4 0.2", "0.60 0.4 0.2"),
        ('name="white"', 'name="light"'),
        ('name="my_robot"', 'name="my_robot" version="1"'),
    ],
)
def test_how_the_robot_is_written_counts(old: str, new: str, tmp_path: Path) -> None:
    """Equal numbers alone are no identical work: students of one lab write the same numbers."""
    assert old in OWN
    other = with_colours(OWN.replace(old, new), "Gazebo/Blue")
    write_robots(tmp_path, ann=with_colours(OWN, "Gazebo/Red"), bob=other)
    expected = [("ann bob", f"{PARTS}5 lines of <gazebo> differ")] if "version" in new else []
    assert identical(tmp_path) == expected


def test_the_robot_that_was_handed_out(tmp_path: Path) -> None:
    """The reference, and what --ignore-file names, with other Gazebo elements are no identical work."""
    handout = OWN.replace("0.05", "0.06")
    (tmp_path / "start.urdf").write_text(handout, encoding="utf-8")
    robots = {"ann": URDF, "bob": URDF, "eve": handout, "joe": handout}
    colours = ("Red", "Blue", "Green", "Black")
    write_robots(
        tmp_path, **{name: with_colours(robots[name], colour) for name, colour in zip(robots, colours, strict=True)}
    )
    assert identical(tmp_path) == [("eve joe", f"{PARTS}5 lines of <gazebo> differ")]
    assert identical(tmp_path, "--ignore-file", tmp_path / "start.urdf") == []


def test_what_many_share_was_handed_out(tmp_path: Path) -> None:
    """If more than four students, or a tenth of the class, build on the same robot, it is the lab's."""
    write_robots(tmp_path, **{f"s{at}": with_colours(OWN, f"Gazebo/{at}") for at in range(4)})
    assert identical(tmp_path) == [("s0 s1 s2 s3", f"{PARTS}5 lines of <gazebo> differ")]
    write_robots(tmp_path, s4=with_colours(OWN, "Gazebo/4"))
    assert identical(tmp_path) == []


# --- Packages ---------------------------------------------------------------------------------------------------------


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
    write_package(tmp_path / "class/joe", URDF)
    assert identical(tmp_path) == [("ann bob", "the same setup.py and RViz files")]


def test_all_files_of_a_package(tmp_path: Path) -> None:
    """A package without a URDF counts as well; a team's shared submission does not."""

    def changed(text: str) -> str:
        return f"{text}\nX = 1\n"

    for name in ("ann", "bob"):
        write_package(tmp_path / "class" / name, setup=changed, launch=changed, rviz=lambda text: f"{text}X: 1\n")
        shutil.rmtree(tmp_path / "class" / name / "urdf")
    (tmp_path / "class/bob/readme.md").write_text("mine", encoding="utf-8")
    assert identical(tmp_path) == [("ann bob", "the same setup.py, launch files and RViz files")]


def test_files_that_were_handed_out(tmp_path: Path) -> None:
    """A starter package that --ignore-file names, and what more than four students have, are no identical work."""

    def starter(text: str) -> str:
        return f"{text}\nX = 1\n"

    write_package(tmp_path / "start", setup=starter, launch=starter)
    for name in ("ann", "bob"):
        write_package(
            tmp_path / "class" / name,
            OWN.replace("0.05", f"0.0{len(name)}{name == 'ann':d}"),
            setup=starter,
            launch=starter,
        )
    assert [equal for _, equal in identical(tmp_path)] == ["the same setup.py and launch files"]
    assert identical(tmp_path, "--ignore-file", tmp_path / "start") == []
    (tmp_path / "g.db").unlink()
    for at in range(3):
        write_package(tmp_path / f"class/s{at}", OWN.replace("0.05", f"0.1{at}"), setup=starter, launch=starter)
    assert identical(tmp_path) == []
