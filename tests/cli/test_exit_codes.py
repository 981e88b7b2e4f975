"""The table of exit codes in docs/command-line.md: each of its cells is performed."""

import re
import shutil
import zipfile
from pathlib import Path
from typing import Any

import pytest

from grader.lab.checks.outcome import Outcome, judged
from grader.lab.checks.registry import find_check
from grader.ros.urdf.kinematics import Configuration
from tests.authoring.robots import TOP, write_rubric
from tests.classroom.class_runs import HOSTILE_RUBRIC
from tests.command_line import ROOT, run, run_with_input

LAB6 = ROOT / "submissions/lab6"
LARGE = f'<robot name="r"><!--{1_100_000 * "x"}--><link name="base"/></robot>'
LAUNCH = '<launch><node pkg="demo_nodes_cpp" exec="talker"/></launch>'
MESH = '<visual><geometry><mesh filename="package://ash/meshes/wheel.stl"/></geometry></visual>'
ROLLING = f"""<robot name="r"><link name="base"/><link name="wheel">{MESH}</link>
<joint name="j" type="continuous"><parent link="base"/><child link="wheel"/><axis xyz="0 0 1"/></joint></robot>"""
ROLLS = """\
[[criterion]]
id = "forward"
part = "model"
title = "It drives forward"
points = 4
check = "rolls_forward"
with = { link = "wheel", base = "base", tolerance = 5 }
"""
FRAME = """\
[[criterion]]
id = "frame"
part = "model"
title = "The frame is there"
points = 1
check = "frame_at"
with = { link = "b", relative_to = "a", xyz = [1, 2, 3], tolerance = 0.002 }
"""
LINKS = '<link name="a"/><link name="b"/><joint name="j" type="fixed"><parent link="a"/><child link="b"/>'
FRAMES = f'<robot name="r">{LINKS}<origin xyz="1 2 3"/></joint></robot>'
# What a command is called with by the first column of the table and the code.
EXAMPLES: dict[tuple[str, int], list[str]] = {
    ("grade", 0): [
        "grade LAB6/reference",
        "grade LAB6/several-mistakes --fail-under 0 --hints none",
    ],
    ("grade", 1): [
        "grade LAB6/several-mistakes --hints none",
        "grade LAB6/reference --fail-under 100",
        "grade LAB6/duplicate-link --fail-under 0 --hints none",
        "grade large --hints none",
    ],
    ("grade", 2): ["grade none", "grade large/r.urdf", "grade --colour", "grade damaged.zip"],
    ("grade", 3): [
        "grade raises.urdf --rubric HOSTILE",
        "grade raises.urdf --rubric HOSTILE --fail-under 0",
    ],
    ("inspect, graph", 0): [
        "inspect LAB6/reference",
        "inspect package",
        "inspect large --max-size 2000000",
        "inspect large-and-small",
        "inspect LAB6/duplicate-link --ignore URDF",
        "inspect LAB6/duplicate-link --write-baseline known.json",
        "graph package",
    ],
    ("inspect, graph", 1): [
        "inspect LAB6/duplicate-link",
        "inspect rejected.urdf",
        "inspect SPAWNER",
        "graph SPAWNER",
    ],
    ("inspect, graph", 2): [
        "inspect none",
        "inspect large",
        "inspect large --save json=report.json",
        "inspect large --write-baseline known.json",
        "inspect large-xacro",
        "inspect large.zip",
        "inspect large-xacro.zip",
        "inspect damaged.zip",
        "inspect damaged-member.zip",
        "inspect damaged-xacro.zip",
        "inspect two-large",
        "graph large",
        "graph large --save json=report.json",
    ],
    ("batch", 0): ["batch class --gradebook new --rubric arm.toml --jobs 1"],
    ("batch", 2): ["batch none --gradebook new --rubric arm.toml"],
    ("export", 0): ["export csv --gradebook book"],
    ("export", 1): ["export csv --gradebook book --strict"],
    ("export", 2): ["export csv --gradebook none"],
    ("rubric check", 0): ["rubric check arm.toml"],
    ("rubric check", 1): ["rubric check rolls/arm.toml"],
    ("rubric check", 2): ["rubric check broken.toml"],
    ("rubric test", 0): ["rubric test arm.toml --fail-under 0"],
    ("rubric test", 1): ["rubric test arm.toml --fail-under 100"],
    ("rubric test", 2): ["rubric test broken.toml"],
    ("rubric test", 3): ["rubric test frame/arm.toml"],
    ("others", 0): [
        "rubric list",
        "rubric show lab6",
        "rubric checks",
        "explain URDF001",
        "schema report",
        "stats --gradebook book",
        "mark anna loads 1 --gradebook book",
        "rubric copy arm copy",
        "bundle gradescope out.zip",
    ],
    ("others", 2): [
        "rubric show none.toml",
        "explain nothing",
        "stats --gradebook none",
        "diff --gradebook none",
        "mark nobody loads 1 --gradebook book",
        "review --gradebook none",
        "view none",
        "bundle gradescope none/out.zip",
    ],
}


def _write_workspaces(folder: Path) -> None:
    """Write packages with a robot that is too large, and archives of them."""
    for name, robots in {
        "package": (),
        "large": ("r.urdf",),
        "large-xacro": ("r.urdf.xacro",),
        "two-large": ("r.urdf", "s.urdf"),
        "large-and-small": ("r.urdf", "small.urdf"),
    }.items():
        shutil.copytree(ROOT / "submissions/lab6/pictures-only", folder / name)
        (folder / name / "package.xml").write_text(
            '<package format="3"><name>bot</name><version>0.1.0</version><description>d</description>'
            '<maintainer email="a@example.org">A</maintainer><license>MIT</license></package>'
        )
        (folder / name / "launch").mkdir()
        (folder / name / "launch/talk.launch.xml").write_text(LAUNCH)
        for robot in robots:
            text = LARGE if robot != "small.urdf" else '<robot name="s"><link name="base"/></robot>'
            (folder / name / robot).write_text(text)
        shutil.make_archive(str(folder / name), "zip", folder, name)
    for name, robot in (("damaged-member", "r.urdf"), ("damaged-xacro", "r.urdf.xacro")):
        path = folder / f"{name}.zip"
        with zipfile.ZipFile(path, "w") as archive:
            archive.write(folder / "package/package.xml", "bot/package.xml")
            archive.writestr(f"bot/{robot}", '<robot name="r"><link name="base_link"/></robot>')
        path.write_bytes(path.read_bytes().replace(b"base_link", b"base_lunk"))
    (folder / "damaged.zip").write_bytes((folder / "large.zip").read_bytes()[:1000])


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with what the examples name."""
    folder = tmp_path_factory.mktemp("codes")
    _write_workspaces(folder)
    write_rubric(folder)
    for name, text, robot in (("rolls", TOP + ROLLS, ROLLING), ("frame", TOP + FRAME, FRAMES)):
        (folder / name).mkdir()
        write_rubric(folder / name, text, robot)
    (folder / "broken.toml").write_text("id = ")
    (folder / "rejected.urdf").write_text(
        '<robot name="r"><link name="a"/><link name="a"/></robot>'
    )
    (folder / "raises.urdf").write_text('<robot name="raises"><link name="base_link"/></robot>')
    for student, text in (("anna", FRAMES), ("ben", "<robot"), ("kim", LARGE)):
        (folder / "class" / student).mkdir(parents=True)
        (folder / "class" / student / "r.urdf").write_text(text)
    (folder / "class/lea.zip").write_bytes(b"PK\x03\x04")
    done = run_with_input(
        ["batch", "class", "--gradebook", "book", "--rubric", "arm.toml", "--jobs", "1"],
        b"",
        folder=folder,
    )
    assert done.returncode == 0, done.stderr
    (folder / "book/marks/kim.csv").write_text(
        "time,by,student,criterion,points,comment,submission\n,Kim,nobody,loads,1,,\n"
    )
    return folder


def _cells() -> set[tuple[str, int]]:
    """Return the cells of the table in the documentation that are not empty."""
    page = (ROOT / "docs/command-line.md").read_text(encoding="utf-8")
    section = page.partition("## Exit codes\n")[2].partition("\n## ")[0]
    header, _, *rows = [line for line in section.splitlines() if line.startswith("|")]
    codes = [cell.strip() for cell in header.split("|")[2:-1]]
    cells = set()
    for row in rows:
        name, *texts = [cell.strip() for cell in row.split("|")[1:-1]]
        for code, text in zip(codes, texts, strict=True):
            if text:
                cells.add((name.replace("`", ""), int(code)))
    return cells


def test_every_cell_is_performed() -> None:
    """The table has the cells of the examples, and no others."""
    assert _cells() == EXAMPLES.keys()


def _calls() -> list[Any]:
    calls = []
    for (name, code), lines in EXAMPLES.items():
        calls += [pytest.param(name, code, line, id=f"{code}: {line}") for line in lines]
    return calls


@pytest.mark.usefixtures("hostile_checks")
@pytest.mark.parametrize(("name", "code", "line"), _calls())
def test_the_table_is_true(
    name: str, code: int, line: str, place: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each example ends with its code; 2 has a reason on standard error, and changes no file."""
    shutil.copytree(place, tmp_path / "copy")
    if (name, code) == ("rubric test", 3):
        _make_faulty(monkeypatch)
    words = line.replace("LAB6", str(LAB6)).replace("HOSTILE", str(HOSTILE_RUBRIC))
    words = words.replace("SPAWNER", str(ROOT / "submissions/diffdrive/spawner-misspelt"))
    before = _files(tmp_path / "copy")
    done = run_with_input(words.split(), b"", folder=tmp_path / "copy")
    assert done.returncode == code, (done.stdout, done.stderr)
    if code == 2:
        assert done.stderr.startswith(b"grader: ")
        assert _files(tmp_path / "copy") == before


def _files(folder: Path) -> dict[Path, bytes]:
    return {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def _make_faulty(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the check of a frame divide by a number, which is zero in a mutant."""

    def divides(robot: Configuration, *, link: str, **_: Any) -> Outcome:
        origin = robot.parent_joints[link].origin
        assert origin is not None
        return judged(1 / origin.xyz[0] > 0, "it is ahead")

    frame_at = find_check("frame_at")
    assert frame_at is not None
    faulty = frame_at._replace(function=divides)
    monkeypatch.setattr(
        "grader.lab.rubric.validation.find_check",
        lambda name: faulty if name == "frame_at" else find_check(name),
    )


@pytest.mark.parametrize(
    ("name", "level"),
    [("large", "error"), ("large-xacro", "error"), ("large-and-small", "warning")],
)
def test_an_annotation_says_what_is_not_read(name: str, level: str, place: Path) -> None:
    """It names the file and its limit, and is an error if no other robot is read."""
    done = run(("inspect", place / name, "--format", "github"))
    pattern = rf"::{level} [^:]*title=not read::r\.urdf\S* is larger than 1 MiB"
    assert re.search(pattern, done.stdout.decode()), done.stdout
