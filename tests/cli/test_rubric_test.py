"""grader rubric test: the reference and its equivalents lose nothing, mutants something, samples what they say."""

import json
from pathlib import Path
from typing import Any

import jsonschema
import pytest

from grader.checks.outcome import Outcome, judged
from grader.checks.registry import find_check
from grader.grading.rubric import shipped_rubrics
from grader.robot.kinematics import Configuration
from tests.command_line import Done, run
from tests.mutation.robots import ARM, BOX, TOP, write_rubric
from tests.samples import SAMPLES

IGNORE = '[[test.ignore]]\nmutants = ["type: joint ? type*", "nothing: *"]\nreason = "Only a tool."\n'
PENDING = '[[criterion]]\nid = "by-hand"\npart = "model"\ntitle = "It is shown"\npoints = 1\ncheck = "evidence_shown"\nwith = { names = ["a"] }\n'
LINKS = '<link name="a"/><link name="b"/><joint name="j" type="fixed"><parent link="a"/><child link="b"/>'
SMALL = f'<robot name="r">{LINKS}<origin xyz="1 2 3" rpy="0.1 0.2 0.3"/></joint></robot>'
EXACT = """\
[[criterion]]
id = "frame"
part = "model"
title = "The frame is there"
points = 1
check = "frame_at"
with = { link = "b", relative_to = "a", xyz = [1, 2, 3], rpy = [0.1, 0.2, 0.3], tolerance = 0.002, angle = 1 }
"""
FIXED = """\
[[criterion]]
id = "fixed"
part = "model"
title = "It is fixed"
points = 1
check = "held_by"
with = { link = "b", parent = "a", joint_type = "fixed" }
"""


def command(*arguments: object) -> Done:
    """Run the command."""
    return run(("rubric", "test", *arguments))


def data(*arguments: object) -> dict[str, Any]:
    """Return the result as JSON, valid under its schema."""
    found: dict[str, Any] = json.loads(command(*arguments, "--format", "json").stdout)
    jsonschema.validate(found, json.loads(run(("schema", "rubric-test")).stdout))
    return found


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", shipped_rubrics())
def test_a_shipped_rubric_catches_every_mutant(name: str) -> None:
    """Or says in the rubric why not; no criterion is idle, no pattern unused, no correct robot loses points, no sample differs."""
    found = data(name, f"submissions/{name}", "--mutants", 100_000)
    assert (found["score"], found["survivors"], found["idle"], found["unused_patterns"]) == (100, [], [], [])
    assert found["equivalents"]["lost"] == found["reference"]["lost"] == []
    assert sum(found["equivalents"]["tried"].values()) >= 30
    assert found["mutants"]["caught"] > 5 * len(found["ignored"])
    own = sum(sample.expected.rubric == name for sample in SAMPLES.values())
    assert own
    assert found["samples"] == {"tried": own, "skipped": 0, "different": []}


@pytest.fixture(scope="module")
def arm(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """Return the result for the arm with all its mutants."""
    return data(write_rubric(tmp_path_factory.mktemp("arm")), "--mutants", 5000)


def test_survivors_are_listed_with_their_diff_and_a_suggestion(tmp_path: Path, arm: dict[str, Any]) -> None:
    """Grouped by what may catch them; the exit code is 0 because no correct robot loses points."""
    done = command(write_rubric(tmp_path), "--mutants", 300)
    text = done.stdout.decode()
    assert done.returncode == 0
    assert "\nThese mutants of the reference get full marks:\n" in text
    assert " mutants: no criterion looks at it; try frame_at" in text
    assert "      --- birch.urdf\n      +++ birch.urdf\n      @@ -" in text
    listed = {row["id"]: row for row in arm["survivors"]}
    row = listed["number x10: joint base_plate/origin xyz.z"]
    assert row["suggestion"] == "no criterion looks at it; try frame_at or kinematics_match_reference"
    assert (
        '-    <origin xyz="0 0 0.11" rpy="0 0 3.14159"/>\n+    <origin xyz="0 0 1.1" rpy="0 0 3.14159"/>' in row["diff"]
    )
    assert (row["path"], row["line"]) == ("birch.urdf", 25)
    assert "number x10: joint tool_joint/origin xyz.z" not in listed  # tool-frame catches it
    assert "number negated: joint tool_joint/origin xyz.x" not in listed  # -0 is the same robot
    counts = arm["mutants"]
    assert counts["tried"] == counts["caught"] + counts["same_robot"] + counts["ignored"] + counts["survived"]
    assert arm["score"] == pytest.approx(100 * counts["caught"] / (counts["caught"] + counts["survived"]), abs=1e-6)


@pytest.mark.parametrize(
    ("mutant", "suggestion"),
    [
        ("number +0.05: joint slide/origin xyz.x", "no criterion looks at it; try frame_at"),
        (
            "number x10: joint finger_joint/origin xyz.x",
            "tool-frame passes nevertheless; try kinematics_match_reference",
        ),
    ],
)
def test_a_suggestion_names_a_check_or_the_criterion_that_looks(
    arm: dict[str, Any], mutant: str, suggestion: str
) -> None:
    """A check that would look at it; or a criterion that does, and passes: its tolerance or its arguments let the mutant pass."""
    listed = {row["id"]: row["suggestion"] for row in arm["survivors"]}
    assert listed[mutant].startswith(suggestion)


def test_a_mutant_that_ros_2_rejects_suggests_urdf_loads(tmp_path: Path) -> None:
    """A rubric without that check would give full marks to a file that shows nothing."""
    found = data(write_rubric(tmp_path, TOP.partition("[[criterion]]")[0] + EXACT, SMALL), "--mutants", 5000)
    listed = {row["id"]: row["suggestion"] for row in found["survivors"]}
    assert listed["attribute deleted: joint j name"] == "ROS 2 rejects it, and no criterion says so; try urdf_loads"


def test_a_mutant_within_a_tolerance_says_whose(tmp_path: Path) -> None:
    """The criterion looks at it: the rubric has no hole there."""
    found = data(write_rubric(tmp_path, TOP + EXACT.replace("0.002", "0.06"), SMALL), "--mutants", 5000)
    listed = {row["id"]: row["suggestion"] for row in found["survivors"]}
    assert listed["number +0.05: joint j/origin xyz.x"] == "frame measures it, within the tolerance"


def test_the_rubric_ignores_mutants_with_a_reason(tmp_path: Path) -> None:
    """They do not count for the score; a pattern that matches no mutant is reported."""
    rubric = write_rubric(tmp_path, TOP + EXACT + IGNORE, SMALL)
    without = data(write_rubric(tmp_path / "..", TOP + EXACT, SMALL), "--mutants", 5000)
    found = data(rubric, "--mutants", 5000)
    assert len(found["ignored"]) == 3 == len(without["survivors"])
    assert {row["reason"] for row in found["ignored"]} == {"Only a tool."}
    assert (found["survivors"], found["score"]) == ([], 100)
    assert without["score"] < 100
    assert found["unused_patterns"] == ["nothing: *"]
    exact = IGNORE.replace("type: joint ? type*", "type: joint j type -> planar")
    assert len(data(write_rubric(tmp_path, TOP + EXACT + exact, SMALL), "--mutants", 5000)["ignored"]) == 1
    write_rubric(tmp_path, TOP + EXACT + IGNORE, SMALL)
    assert "The pattern 'nothing: *' of [[test.ignore]] matches no mutant." in command(rubric).stdout.decode()


@pytest.mark.parametrize(
    ("ignore", "complaint"),
    [
        ('[[test.ignore]]\nmutants = ["a"]\n', "this test.ignore has no reason"),
        ('[[test.ignore]]\nreason = "a"\n', "this test.ignore has no mutants"),
        ('[[test.ignore]]\nmutants = []\nreason = "a"\n', "mutants must be at least one pattern"),
        ('[[test.ignore]]\nmutants = ["a"]\nreason = " "\n', "reason must be a non-empty string"),
        ("[test]\nignored = 1\n", "a test table has no key 'ignored'; did you mean 'ignore'?"),
    ],
)
def test_an_incomplete_ignore_is_a_mistake_of_the_rubric(tmp_path: Path, ignore: str, complaint: str) -> None:
    """Both keys are required; the exit code is 2."""
    done = command(write_rubric(tmp_path, TOP + ignore))
    assert done.returncode == 2
    assert complaint in done.stderr.decode()


def test_an_idle_criterion_is_named(tmp_path: Path) -> None:
    """No mutant fails it, not even one that was not sampled; a criterion that always needs manual grading is not counted."""
    anywhere = EXACT.replace('"frame"', '"anywhere"').replace("0.002", "1000").replace("angle = 1", "angle = 181")
    rubric = write_rubric(tmp_path, TOP + EXACT + anywhere + PENDING, SMALL)
    assert data(rubric, "--mutants", 0)["idle"] == ["anywhere"]
    assert "No mutant fails anywhere: it is idle." in command(rubric).stdout.decode()


def test_a_reference_near_a_limit_is_reported(tmp_path: Path) -> None:
    """JSON says of each tolerance how far off the reference is."""
    text = (TOP + EXACT).replace("xyz = [1, 2, 3]", "xyz = [1, 2, 3.0015]")
    (margin,) = data(write_rubric(tmp_path, text, SMALL))["margins"]
    assert margin == {
        "criterion": "frame", "unit": "m", "tolerance": 0.002, "reference": 0.0015, "is_near": True,
    }  # fmt: skip
    shown = command(tmp_path / "arm.toml").stdout.decode()
    assert "The reference is near the limit of frame: 1.5 mm off, 2 mm allowed." in shown


def test_fail_under_decides_by_the_score(tmp_path: Path) -> None:
    """In percent, with or without the sign."""
    rubric = write_rubric(tmp_path, TOP + EXACT, SMALL)
    assert command(rubric, "--fail-under", "10%").returncode == 0
    assert command(rubric, "--fail-under", "99").returncode == 1
    exact = write_rubric(tmp_path, TOP + EXACT + FIXED, SMALL)
    assert command(exact, "--fail-under", "100", "--mutants", 5000).returncode == 0
    for wrong in ("101", "-1", "a", "101%"):
        assert command(rubric, "--fail-under", wrong).returncode == 2


def test_a_reference_that_loses_points_fails(tmp_path: Path) -> None:
    """The criteria and their messages are listed, and the exit code is 1."""
    done = command(write_rubric(tmp_path, TOP + BOX.replace("0.12", "0.2")), "--mutants", 20)
    assert done.returncode == 1
    assert (
        "The reference does not get full marks:\n  plate-box: 'plate' shows a box 0.1 0.12 0.02 m"
        in done.stdout.decode()
    )
    assert data(tmp_path / "arm.toml", "--mutants", 20)["reference"]["lost"] == ["plate-box"]


def test_a_reference_that_ros_2_does_not_load_has_no_equivalents(tmp_path: Path) -> None:
    """The reason is said instead of a number; the reference has lost points by then."""
    done = command(write_rubric(tmp_path, TOP, SMALL.replace("</robot>", '<link name="c"/></robot>')), "--mutants", 5)
    assert done.returncode == 1
    line = "Equivalents none graded: ROS 2 does not load the reference without problems"
    assert line in " ".join(done.stdout.decode().split())


def test_an_equivalent_that_loses_points_fails(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A check that looks at the numbers of a file, not at the robot, is found out."""

    def is_written(robot: Configuration, *, link: str, **_: Any) -> Outcome:
        joint = robot.parent_joints.get(link)
        rpy = joint.origin.rpy if joint is not None and joint.origin is not None else (0.0, 0.0, 0.0)
        return judged(rpy == (0.1, 0.2, 0.3), f"the rpy is {rpy[0]:.2f}")

    frame_at = find_check("frame_at")
    assert frame_at is not None
    textual = frame_at._replace(function=is_written)
    monkeypatch.setattr(
        "grader.grading.validation.find_check", lambda name: textual if name == "frame_at" else find_check(name)
    )
    done = command(write_rubric(tmp_path, TOP + EXACT, SMALL), "--mutants", 20)
    assert done.returncode == 1
    text = done.stdout.decode()
    assert "These equivalents of the reference lose points:\n\n  fixed joints split 1\n    frame: the rpy is" in text
    assert '-<origin xyz="1 2 3" rpy="0.1 0.2 0.3"/>' in text


def test_a_check_that_is_faulty_on_a_mutant_is_not_a_catch(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It is named with the mutant, and the exit code is 3."""

    def divides(robot: Configuration, *, link: str, **_: Any) -> Outcome:
        origin = robot.parent_joints[link].origin
        assert origin is not None
        return judged(1 / origin.xyz[0] > 0, "it is ahead")

    frame_at = find_check("frame_at")
    assert frame_at is not None
    plain = frame_at._replace(function=divides)
    monkeypatch.setattr(
        "grader.grading.validation.find_check", lambda name: plain if name == "frame_at" else find_check(name)
    )
    found = data(write_rubric(tmp_path, TOP + EXACT, SMALL), "--mutants", 5000)
    assert "number zero: joint j/origin xyz.x" in [row["name"] for row in found["faults"]]
    assert all(row["criteria"]["frame"].startswith("the grader itself failed") for row in found["faults"])
    counts = found["mutants"]
    others = counts["caught"] + counts["same_robot"] + counts["ignored"] + counts["survived"]
    assert counts["tried"] == others + len(found["faults"])
    done = command(tmp_path / "arm.toml")
    assert done.returncode == 3
    assert "On these mutants a check is faulty:\n\n  " in done.stdout.decode()


def _sample(folder: Path, name: str, expected: str, robot: str = ARM) -> None:
    (folder / name).mkdir(parents=True)
    (folder / name / "birch.urdf").write_text(robot, encoding="utf-8")
    (folder / name / "expected.toml").write_text(expected, encoding="utf-8")


def test_samples_must_get_what_they_expect(tmp_path: Path) -> None:
    """Those of another rubric are skipped and counted; each difference is explained, and the exit code is 1."""
    rubric, samples = write_rubric(tmp_path), tmp_path / "samples"
    broken = ARM.replace('size="0.1 0.12 0.02"', 'size="1 1 1"')
    _sample(samples, "fine", 'path = "birch.urdf"\nverdict = "clean"\nlost = []\n')
    _sample(samples, "large", 'rubric = "arm"\npath = "birch.urdf"\nlost = ["plate-box"]\n', broken)
    _sample(samples, "other", 'rubric = "lab6"\npath = "birch.urdf"\nlost = ["base-box"]\n')
    done = command(rubric, samples, "--mutants", 0)
    assert done.returncode == 0
    line = "Samples 2 graded, none differ from expected.toml, 1 of other rubrics skipped"
    assert line in " ".join(done.stdout.decode().split())
    _sample(samples, "wrong", 'path = "birch.urdf"\nverdict = "rejected"\nlost = ["tool-frame"]\n', broken)
    found = data(rubric, samples, "--mutants", 0)["samples"]
    assert (found["tried"], found["skipped"]) == (3, 1)
    (different,) = found["different"]
    assert different["name"] == "wrong"
    assert list(different["criteria"]) == ["verdict", "plate-box", "tool-frame"]
    assert different["criteria"]["verdict"] == "is clean, expected rejected"
    assert different["criteria"]["plate-box"].startswith("loses its points, expected: passes: 'plate' shows a box")
    assert different["criteria"]["tool-frame"].startswith("passes, expected: loses its points")
    assert command(rubric, samples, "--mutants", 0).returncode == 1


@pytest.mark.parametrize(
    ("expected", "complaint"),
    [
        ('lots = ["plate-box"]\n', "expected.toml:1: an expected.toml has no key 'lots'; did you mean 'lost'?"),
        ('verdict = "fine"\n', "verdict must be one of clean, degraded, rejected, missing"),
        ('lost = "plate-box"\n', "lost must be a list of ids of criteria"),
        ('lost = ["plat-box"]\n', "the rubric arm has no criterion 'plat-box'; did you mean 'plate-box'?"),
        ("lost = [\n", "invalid value: an empty line"),
    ],
)
def test_a_broken_sample_is_refused(tmp_path: Path, expected: str, complaint: str) -> None:
    """With its file and line, and exit code 2."""
    rubric = write_rubric(tmp_path)
    _sample(tmp_path / "samples", "a", expected)
    done = command(rubric, tmp_path / "samples")
    assert done.returncode == 2
    assert complaint in done.stderr.decode()


def test_without_samples_or_reference_nothing_is_command(tmp_path: Path) -> None:
    """One line says why, and the exit code is 2."""
    rubric = write_rubric(tmp_path)
    cases = {
        (rubric, tmp_path / "none"): "is not a folder with samples",
        (rubric, tmp_path): "has no samples: no folder in it has an expected.toml",
        (write_rubric(tmp_path / "..", TOP.replace('reference = "birch.urdf"\n', "")),): 'add reference = "FOLDER"',
    }
    for arguments, words in cases.items():
        done = command(*arguments)
        assert done.returncode == 2
        assert not done.stdout
        assert words in done.stderr.decode()


def test_the_seed_decides_and_the_same_seed_gives_the_same_bytes(tmp_path: Path) -> None:
    """Another seed takes another sample."""
    rubric = write_rubric(tmp_path)
    first, again, other = (command(rubric, "--mutants", 50, "--seed", seed).stdout for seed in (1, 1, 2))
    assert first == again != other
    found = data(rubric, "--mutants", 50, "--seed", 1)
    assert found["seed"] == 1
    assert found["mutants"]["tried"] == 50 < found["mutants"]["total"]


def test_a_sentence_fits_the_screen(tmp_path: Path) -> None:
    """Lines are wrapped, and those of a diff are cut around the change."""
    text = command(write_rubric(tmp_path, robot=ARM.replace("\n", " "))).stdout.decode()
    assert max(map(len, text.splitlines())) <= 80
    assert "..." in text


@pytest.mark.parametrize(
    ("check", "changed"),
    [
        ('check = "urdf_loads"', {"robot.urdf"}),
        ('check = "package_found"\nwith = { name = "ash" }', {"robot.urdf", "package.xml"}),
        ('check = "setup_imports"', {"robot.urdf", "package.xml", "setup.py"}),
    ],
)
def test_a_package_is_changed_as_far_as_criteria_look(tmp_path: Path, check: str, changed: set[str]) -> None:
    """A rubric of the robot is not tested with mistakes in setup.py, and one that wants the package's name only with that."""
    package = tmp_path / "ash"
    package.mkdir()
    (package / "robot.urdf").write_text(SMALL)
    (package / "package.xml").write_text('<package format="3"><name>ash</name></package>')
    (package / "setup.py").write_text("from setuptools import setup\nsetup(name='ash')\n")
    top = TOP.replace("birch.urdf", "ash").replace(
        'title = "An arm"', 'title = "An arm"\npackage = "ash"\nurdf = "robot.urdf"'
    )
    text = f'{top}[[criterion]]\nid = "other"\npart = "model"\ntitle = "Another"\npoints = 1\n{check}\n'
    found = data(
        write_rubric(tmp_path, text + '[[test.ignore]]\nmutants = ["*"]\nreason = "All."\n'), "--mutants", 5000
    )
    assert found["reference"]["lost"] == []
    assert {row["path"] for row in found["ignored"]} <= changed
    without = data(write_rubric(tmp_path, top), "--mutants", 0)["mutants"]["total"]
    assert (found["mutants"]["total"] > without) == (len(changed) > 1)


MESH = '<visual><geometry><mesh filename="package://ash/meshes/wheel.stl"/></geometry></visual>'
WHEEL = """<robot name="r"><link name="base"/><link name="wheel">{}</link><joint name="j" type="continuous">\
<parent link="base"/><child link="wheel"/><origin rpy="-1.5708 0 0"/><axis xyz="0 0 1"/></joint></robot>"""
ROLLS = """\
[[criterion]]
id = "forward"
part = "model"
title = "It drives forward"
points = 4
check = "rolls_forward"
with = { link = "wheel", base = "base", tolerance = 5 }
"""


@pytest.mark.parametrize("bonus", ["", "bonus = true\n"])
def test_a_reference_on_which_a_criterion_cannot_be_decided_does_not_get_full_marks(tmp_path: Path, bonus: str) -> None:
    """Both commands name the criterion and exit with 1; one for manual grading or extra credit does not matter."""
    rubric = write_rubric(tmp_path, TOP + PENDING + ROLLS.replace("points", f"{bonus}points"), WHEEL.format(MESH))
    done = run(("rubric", "check", rubric))
    text = " ".join(done.stdout.decode().split())
    assert (done.returncode, "does not get forward: the size of mesh" in text) == (int(not bonus), not bonus)
    assert ("its reference gets full marks" in text) == bool(bonus)
    assert "by-hand" not in text
    tested = command(rubric, "--mutants", 0)
    assert (tested.returncode, b"  forward: the size of mesh" in tested.stdout) == (int(not bonus), not bonus)


def test_a_reference_may_have_large_files_that_are_not_parsed(tmp_path: Path) -> None:
    """A mesh above the limit of the XML parser: `rubric new`, `check` and `test` accept it."""
    package = tmp_path / "ash"
    (package / "meshes").mkdir(parents=True)
    (package / "meshes" / "wheel.stl").write_bytes(bytes((1 << 20) + 1))
    (package / "ash.urdf").write_text(WHEEL.format(MESH), "utf-8")
    (package / "package.xml").write_text("<package><name>ash</name></package>", "utf-8")
    rubric = tmp_path / "lab.toml"
    assert run(("rubric", "new", rubric, "--from", package)).returncode == 0
    assert run(("rubric", "check", rubric)).returncode == 0
    found = data(rubric)
    assert found["mutants"]["tried"] and found["reference"]["lost"] == []
