"""Work of this lab that is missing: another robot, no package of the lab, a package under two names."""

import json
import re
import shutil
from pathlib import Path
from typing import Any

import pytest

from tests.checks.submissions import png
from tests.command_line import ROOT, run

REFERENCE = ROOT / "submissions/lab6/reference"
IN_SAMPLE = "roscourse_sim_ws/src/my_robot"
BOX = b'<robot name="box">\n <link name="box"><visual><geometry><box size="0.6 0.4 0.2"/></geometry></visual></link>\n</robot>\n'
FORMATS = (
    "terminal",
    "markdown",
    "json",
    "junit",
    "sarif",
    "github",
    "gradescope",
    "classroom50",
    "codeclimate",
    "html",
    "svg",
)
CLASSROOM = {
    name: "x" for name in ("CLASSROOM", "ASSIGNMENT", "USERNAME", "COMMIT_URL", "RELEASE_URL", "REVIEW_URL")
} | {"SUBMISSION_TAG": "submit/2026-09-01T10-00-00Z-ab12cd3"}


def graded(path: Path, *more: object) -> dict[str, Any]:
    """Return the JSON report on a submission."""
    return dict(json.loads(run(("grade", path, "--format", "json", *more)).stdout))


def results(path: Path, *more: object) -> dict[str, Any]:
    """Return the results of a submission by criterion."""
    return {row["id"]: row for row in graded(path, *more)["results"]}


def rubric(folder: Path, *keys: str) -> Path:
    """Write the rubric of Lab 6 with only these keys set to "manual"."""
    folder.mkdir(parents=True, exist_ok=True)
    text = (ROOT / "rubrics/lab6/rubric.toml").read_text(encoding="utf-8")
    path = folder / "lab6.toml"
    for key in {"without_urdf", "without_package"}.difference(keys):
        text = re.sub(rf"^{key} = .*\n", "", text, flags=re.MULTILINE)
    path.write_text(text, encoding="utf-8")
    shutil.copy(ROOT / "rubrics/lab6/answers.toml", folder)
    (folder / "my_robot").symlink_to(ROOT / "rubrics/lab6/my_robot")
    return path


def written(folder: Path, files: dict[str, bytes]) -> Path:
    """Write a submission."""
    for path, data in files.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_bytes(data)
    return folder


def renamed(folder: Path, *, marker: bool, launch: bool = True) -> Path:
    """Write the reference with a setup.py, and a launch file, that call the package my_robots."""
    shutil.copytree(REFERENCE, folder)
    package = folder / IN_SAMPLE
    files = ["setup.py", *(["launch/my_robot_rviz.launch.py"] if launch else [])]
    for name, old in zip(files, ("package_name = 'my_robot'", "directory('my_robot')"), strict=False):
        path = package / name
        text = path.read_text()
        path.write_text(text.replace(old, old.replace("my_robot", "my_robots")))
        assert path.read_text() != text
    if marker:
        (package / "resource/my_robot").rename(package / "resource/my_robots")
    return folder


# --- A package under two names ------------------------------------------------------------------------------------------


def test_what_a_build_installs_under_another_name_does_not_count(tmp_path: Path) -> None:
    """`ros2 launch my_robot` would find no launch file: the package is registered, and its files are installed, as my_robots."""
    found = results(renamed(tmp_path / "two", marker=True), "--hints", "none")
    lost = {name for name, row in found.items() if row["status"] == "failed"}
    assert lost == {"package-found", "setup-installs-urdf", "setup-installs-launch", "setup-installs-rviz"}
    assert found["package-found"]["message"] == (
        "package.xml names the package 'my_robot', but setup.py registers it as 'my_robots'"
    )
    assert found["setup-installs-launch"]["message"].endswith(
        "ROS 2 looks for the package's files below share/my_robot/"
    )


@pytest.mark.parametrize("marker", [True, False])
def test_the_hint_makes_one_name_everywhere(marker: bool, tmp_path: Path) -> None:
    """With the hint's edits the package has the name of package.xml in every file, and all points."""
    path, out = renamed(tmp_path / "two", marker=marker), tmp_path / "fixed"
    out.mkdir()
    done = run(("grade", path, "--fix", out))
    assert done.returncode == 1
    for file in out.rglob("*"):
        assert not file.is_file() or b"my_robots" not in file.read_bytes(), file
        assert file.name != "my_robots"
    whole = shutil.copytree(path, tmp_path / "whole")
    shutil.copytree(out, whole, dirs_exist_ok=True)
    if marker:
        (whole / IN_SAMPLE / "resource/my_robots").unlink()
    report = graded(whole)
    assert (report["score"], report["pending"]) == (90, 10)


def test_the_name_that_the_lab_wants_is_enough_for_installed_files(tmp_path: Path) -> None:
    """If only package.xml has another name, `ros2 launch my_robot` works: one criterion fails."""
    path = shutil.copytree(REFERENCE, tmp_path / "two")
    manifest = path / IN_SAMPLE / "package.xml"
    manifest.write_text(manifest.read_text().replace("<name>my_robot<", "<name>my_robots<"))
    assert {name for name, row in results(path, "--hints", "none").items() if row["status"] == "failed"} == {
        "package-found"
    }


def test_another_name_is_no_missing_slash(tmp_path: Path) -> None:
    """A launch file that looks in my_robots is told so, unless what follows the name is a file or folder of the package."""
    path = renamed(tmp_path / "two", marker=False)
    found = results(path, "--hints", "none")["launch-finds-files"]
    assert (
        found["message"] == "the launch file looks in a package 'my_robots', but the graded package is named 'my_robot'"
    )
    for ending in ("my_robot.urdf", "urdf/my_robot.urdf"):
        launch = (
            shutil.copytree(REFERENCE, tmp_path / ending.replace("/", "_"))
            / IN_SAMPLE
            / "launch/my_robot_rviz.launch.py"
        )
        launch.write_text(launch.read_text().replace("os.path.join(share, 'my_robot.urdf')", f"share + '{ending}'"))
        assert "a slash is missing after 'my_robot'" in results(launch.parent.parent)["launch-finds-files"]["message"]


# --- No package of this lab -----------------------------------------------------------------------------------------------

URDF = (REFERENCE / IN_SAMPLE / "urdf/my_robot.urdf").read_bytes()
PICTURES = {"Lab6/Task1_Step36.png": png(), "Lab6/Task2_Step6.png": png()}
PACKAGE_XML = (
    b"<package format='3'><name>arm_demo</name><export><build_type>ament_python</build_type></export></package>"
)


@pytest.mark.parametrize(
    "files",
    [
        {**PICTURES, "Lab6/my_robot.urdf": URDF},
        {**PICTURES, "Lab7/my_robot.urdf": URDF},
        {**PICTURES, "Lab7/arm_demo/package.xml": PACKAGE_XML, "Lab7/arm_demo/urdf/my_robot.urdf": URDF},
    ],
    ids=["this lab", "another lab", "another lab's package"],
)
def test_criteria_of_a_missing_package_need_manual_grading(files: dict[str, bytes], tmp_path: Path) -> None:
    """With `without_package = "manual"` a submission with a robot and evidence loses no point for its package."""
    path = written(tmp_path / "Ash", files)
    report = graded(path, "--rubric", rubric(tmp_path / "manual", "without_package"))
    assert (report["score"], report["pending"]) == (70, 30)
    found = next(row for row in report["results"] if row["id"] == "package-found")
    assert found["message"].endswith("Task2_Step6.png were submitted; needs manual grading")
    default = graded(path, "--rubric", rubric(tmp_path / "default"))
    assert default["pending"] == 10
    assert default["score"] < 90


def test_a_package_of_the_lab_is_graded_whatever_the_key_says(tmp_path: Path) -> None:
    """With a package of the lab, also in another lab's folder, or without evidence, the checks decide."""
    manual, default = rubric(tmp_path / "manual", "without_package"), rubric(tmp_path / "default")
    misnamed = shutil.copytree(ROOT / "submissions/lab6/package-misnamed", tmp_path / "misnamed")
    written(misnamed, {"Task2_Step6.png": png()})
    elsewhere = written(tmp_path / "Ash", PICTURES)
    shutil.copytree(REFERENCE / IN_SAMPLE, elsewhere / "Lab7/my_robot")
    bare = written(tmp_path / "bare", {"my_robot.urdf": URDF})
    for path in (misnamed, elsewhere, bare):
        first, second = (
            {name: row["status"] for name, row in results(path, "--rubric", it, "--hints", "none").items()}
            for it in (manual, default)
        )
        assert first == second


def test_a_batch_counts_submissions_without_a_package(tmp_path: Path) -> None:
    """The end of the summary, `stats` and JSON say how many this concerns, and which key to set."""
    folder = tmp_path / "class"
    written(folder / "ash", {**PICTURES, "Lab7/my_robot.urdf": URDF})
    written(folder / "birch", {"Task1_Step36.png": png(), "my_robot.urdf": URDF})
    written(folder / "cedar", {"my_robot.urdf": URDF})
    shutil.copytree(REFERENCE, folder / "elm")
    written(folder, {"fir.urdf": URDF})
    book = tmp_path / "lab.db"
    done = run(("batch", folder, "--gradebook", book, "--jobs", 1, "--rubric", rubric(tmp_path / "default")))
    text = (
        "2 submissions have pictures or documents, but no package of this lab: the criteria of the package fail. "
        'Set `without_package = "manual"` in the rubric to grade them manually, or "failed" to keep this'
    )
    for printed in (done, run(("stats", "--gradebook", book))):
        assert " ".join(printed.stdout.decode().split()).endswith(text)
    data = json.loads(run(("stats", "--gradebook", book, "--format", "json")).stdout)
    assert (data["evidence_without_urdf"], data["evidence_without_package"]) == (0, 2)
    manual = rubric(tmp_path / "manual", "without_package")
    assert (
        b"no package of this lab"
        not in run(("batch", folder, "--gradebook", book, "--jobs", 1, "--rubric", manual)).stdout
    )


# --- Another robot ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", FORMATS)
def test_every_format_says_that_it_is_another_robot(name: str, tmp_path: Path) -> None:
    """A robot that has none of the links that the rubric names, nor similar ones, is called another robot, once and first."""
    path = written(tmp_path, {"box.urdf": BOX}) / "box.urdf"
    done = run(("grade", path, "--format", name), **CLASSROOM)
    text = " ".join(re.sub(r"<[^>]+>", " ", done.stdout.decode()).split())
    assert "his looks like another robot: it has none of the links that the rubric names" in text, text
    if name == "terminal":
        assert text.index("another robot") < text.index("joint-names")
        assert "no link" not in text


def test_another_robot_has_no_hint(tmp_path: Path) -> None:
    """No edit of a mistake makes it the robot of the lab."""
    report = graded(written(tmp_path, {"box.urdf": BOX}) / "box.urdf")
    assert report["score"] == 3
    assert not any(row["hints"] for row in report["results"])


def test_a_robot_with_other_names_has_hints(tmp_path: Path) -> None:
    """A robot with as many links as the lab's may be the lab's: the hints rename its links."""
    text = URDF.decode()
    for link, name in (("base_footprint", "fuss"), ("base_link", "rumpf"), ("lidar", "scanner"), ("left_wheel", "rad_1"), ("right_wheel", "rad_2"), ("caster_wheel", "kugel")):  # fmt: skip
        text = text.replace(f'"{link}"', f'"{name}"')
    report = graded(written(tmp_path, {"a.urdf": text.encode()}) / "a.urdf")
    assert "another robot" in json.dumps(report)
    assert any(row["hints"] for row in report["results"])


@pytest.mark.parametrize(
    ("links", "is_another"),
    [
        (["base_link", "lidar"], True),
        (["base_link", "lidar", "left_wheel"], False),
        (["Base_Link", "lidarr", "leftwheel", "arm"], False),
        ([f"arm_{n}" for n in range(9)], True),
    ],
)
def test_half_of_the_links_make_the_robot_of_the_lab(links: list[str], is_another: bool, tmp_path: Path) -> None:
    """A robot with fewer than half of the rubric's links, also under similar names, is called another robot."""
    data = "".join(f'<link name="{link}"/>' for link in links)
    path = written(tmp_path, {"box.urdf": f'<robot name="box">{data}</robot>'.encode()}) / "box.urdf"
    assert ("another robot" in json.dumps(graded(path))) == is_another


def test_a_robot_with_an_unknown_part_is_not_called_another_robot(tmp_path: Path) -> None:
    """What a file of another package adds may be the robot of the lab: also with `without_urdf` its criteria are undecided."""
    data = b"""<robot name="r" xmlns:xacro="http://ros.org/wiki/xacro"><link name="mast"/>
    <xacro:include filename="$(find other)/wheels.xacro"/></robot>"""
    path = written(tmp_path / "ash", {"my_robot.urdf.xacro": data, "Task1_Step8.png": png()})
    report = graded(path, "--rubric", rubric(tmp_path / "manual", "without_urdf"))
    assert "another robot" not in json.dumps(report)
    assert {row["status"] for row in report["results"] if row["id"].startswith("base")} == {"pending"}


def test_another_robot_counts_as_no_urdf(tmp_path: Path) -> None:
    """With `without_urdf = "manual"` and evidence its criteria need manual grading, and `batch` counts it."""
    path = written(tmp_path / "class" / "ash", {"box.urdf": BOX, "Task1_Step8.png": png()})
    report = graded(path, "--rubric", rubric(tmp_path / "manual", "without_urdf"))
    assert (report["score"], report["pending"]) == (0, 100)
    assert report["results"][0]["message"] == (
        "this looks like another robot: it has none of the links that the rubric names, but Task1_Step8.png was "
        "submitted; needs manual grading"
    )
    book = tmp_path / "lab.db"
    default = rubric(tmp_path / "default")
    done = run(("batch", path.parent, "--gradebook", book, "--jobs", 1, "--format", "json", "--rubric", default))
    assert json.loads(done.stdout)["evidence_without_urdf"] == 1


def test_another_robot_is_no_identical_work(tmp_path: Path) -> None:
    """Students who submitted the robot of an earlier lab are not listed as identical work; others are."""
    folder = written(tmp_path / "class", {f"{name}.urdf": BOX for name in ("ash", "birch")})
    written(folder, {f"{name}.urdf": URDF.replace(b"0.7", b"0.6") for name in ("cedar", "elm")})
    done = run(("batch", folder, "--gradebook", tmp_path / "lab.db", "--jobs", 1, "--format", "json"))
    assert [group["students"] for group in json.loads(done.stdout)["identical"]] == [["cedar", "elm"]]
