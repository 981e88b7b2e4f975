"""grader grade and batch on repositories of several labs, several students, odd file names and stale builds."""

import json
import shlex
import shutil
import zipfile
from pathlib import Path

import pytest

from grader.report.formats import Format
from tests.classroom.class_runs import grader, rows, verdicts
from tests.cli.jobs import GithubJob
from tests.command_line import run_with_input
from tests.samples import ROOT

PACKAGE = ROOT / "submissions/lab6/reference/roscourse_sim_ws/src/my_robot"
URDF = PACKAGE / "urdf/my_robot.urdf"
BURIED = ROOT / "submissions/lab6/lidar-buried/my_robot/urdf/my_robot.urdf"


def grade(path: Path | str, *more: str, folder: Path = ROOT) -> tuple[int, str, str]:
    """Return the exit code, standard output and standard error of `grader grade`."""
    done = run_with_input(("grade", str(path), *more), b"", folder=folder)
    return done.returncode, done.stdout.decode(), done.stderr.decode()


def report(path: Path | str, *more: str) -> dict[str, object]:
    """Return the report on a submission as data."""
    return dict(json.loads(grade(path, "--format", "json", *more)[1]))


def message_of(path: Path, criterion: str) -> str:
    """Return the message of a criterion that fails."""
    results = json.loads(grade(path, "--format", "json")[1])["results"]
    (found,) = (result for result in results if result["id"] == criterion)
    assert found["status"] == "failed"
    return str(found["message"])


def put(path: Path, source: Path = URDF) -> Path:
    """Copy a file or folder to a path."""
    path.parent.mkdir(parents=True, exist_ok=True)
    (shutil.copytree if source.is_dir() else shutil.copy)(source, path)
    return path


@pytest.fixture
def team(tmp_path: Path) -> Path:
    """Make the repository of a team of two with two labs."""
    put(tmp_path / "our team/Lab6/Ash/my_robot", PACKAGE)
    put(tmp_path / "our team/Lab6/Birch/urdf.Xacro file.txt", BURIED)
    put(tmp_path / "our team/Lab7/Ash/my_robot", PACKAGE)
    (tmp_path / "our team/README.md").write_text("a team")
    return tmp_path / "our team"


# --- Robots by content ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["urdf.xacro file", "urdf.xacro file.py", "urdf.Xacro file.txt", "my_robot"])
def test_a_robot_under_any_name(name: str, tmp_path: Path) -> None:
    """It is graded on its own, in a folder and in a class, and gets the mark of the same URDF under its usual name."""
    put(tmp_path / "class/ash" / name)
    alone = report(tmp_path / "class/ash" / name)
    assert (alone["score"], alone["max_score"]) == (70, 70)
    assert report(tmp_path / "class/ash")["score"] == 70
    assert grader("batch", tmp_path / "class", "--gradebook", tmp_path / "g.db", "--part", "task1").returncode == 0
    assert rows(tmp_path / "g.db", "SELECT key, score, out_of FROM grade") == [("ash", 700_000, 700_000)]


def test_files_that_only_contain_a_robot(tmp_path: Path) -> None:
    """A Markdown page or launch file that quotes one is none, on its own and in a folder."""
    (tmp_path / "notes.md").write_text(f"# My robot\n{URDF.read_text()}")
    (tmp_path / "a.launch.py").write_text(f"ROBOT = '''{URDF.read_text()}'''")
    for name in ("notes.md", "a.launch.py"):
        code, _, error = grade(tmp_path / name)
        assert (code, f"{name} is not a URDF: give a .urdf file" in error) == (2, True)
    assert "no URDF was submitted: none of the 2 files contains a <robot>" in message_of(tmp_path, "urdf-loads")


# --- Several labs -----------------------------------------------------------------------------------------------------


def test_the_folder_of_the_lab_wins_over_depth(tmp_path: Path) -> None:
    """The mark is that of Lab 6, whatever is in Lab 7, and its pictures are no evidence."""
    put(tmp_path / "Lab_7/my_robot", PACKAGE)
    put(tmp_path / "Lab_7/my_robot/urdf/my_robot.urdf", BURIED)
    put(tmp_path / "Lab_7/Task3_Step3.png", BURIED)
    put(tmp_path / "Lab6/lab/ws/src/my_robot", PACKAGE)
    found = report(tmp_path)
    assert (found["score"], found["notes"], found["other_pictures"]) == (90, [], [])
    assert "Task3_Step3" not in json.dumps(found["evidence"])
    assert "Lab_7/my_robot/urdf/my_robot.urdf" in json.dumps(found["submission"])


def test_another_lab_is_graded_with_a_note_in_every_format(tmp_path: Path) -> None:
    """If there is nothing else; the note comes before all others."""
    put(tmp_path / "repo/Lab7/my_robot", PACKAGE)
    note = "no folder of this lab was found: Lab7, the folder of another lab, was graded"
    found = report(tmp_path / "repo")
    assert (found["score"], found["notes"]) == (90, [note])
    saved = {kind: tmp_path / f"report.{kind}" for kind in Format if kind.needs != "identity"}
    assert grade(tmp_path / "repo", *(f"--save={kind}={file}" for kind, file in saved.items()))[0] == 0
    unnoted = {kind for kind, file in saved.items() if note not in " ".join(file.read_text().split())}
    assert unnoted == {Format.CODECLIMATE, Format.SVG}  # which hold findings only, and a picture


def test_pictures_in_the_lab_and_a_robot_in_another(tmp_path: Path) -> None:
    """The robot of Lab 7 is graded if there is no other, and the report says so first; pictures are those of Lab 6."""
    put(tmp_path / "Lab6/Task1_Step8.png", BURIED)
    put(tmp_path / "Lab7/my_robot", PACKAGE)
    put(tmp_path / "Lab7/Task1_Step18.png", BURIED)
    found = report(tmp_path)
    note = "Lab6, the folder of this lab, has no robot of this lab: Lab7, the folder of another lab, was graded"
    assert found["score"] == 90
    assert json.dumps(found["notes"]).startswith(json.dumps([note])[:-1])
    assert '"Lab6/Task1_Step8.png"' in json.dumps(found["evidence"])
    assert "Lab7/Task1" not in json.dumps(found["evidence"])
    (tmp_path / "Lab7").rename(tmp_path / "Final Project")
    assert report(tmp_path)["score"] == 0


def test_an_archive_of_the_lab_is_opened(tmp_path: Path) -> None:
    """Also beside the package and URDF of another lab, of which no archive is opened."""
    put(tmp_path / "Lab7/my_robot", PACKAGE)
    for name in ("Lab6", "other"):
        with zipfile.ZipFile(tmp_path / f"{name}.zip", "w") as archive:
            archive.write(BURIED, "my_robot.urdf")
    found = report(tmp_path)
    assert '"Lab6.zip/my_robot.urdf"' in json.dumps(found["submission"])
    assert "other.zip/" not in json.dumps(found)


# --- Several students -------------------------------------------------------------------------------------------------


def test_several_students_are_not_graded_as_one(team: Path) -> None:
    """Exit code 2, with the command for each and for all; each of the commands works as it is printed."""
    options = ("--part", "task1")
    code, out, error = grade(team.name, *options, folder=team.parent)
    assert (code, out) == (2, "")
    head, *lines = (line.removeprefix("grader: ") for line in error.splitlines())
    assert head == "our team contains the submissions of 2 students: nothing was graded"
    assert lines == [
        "to grade one: grader grade 'our team/Lab6/Ash' --part task1",
        "to grade one: grader grade 'our team/Lab6/Birch' --part task1",
        "to grade all: grader batch 'our team' --layout teams --gradebook lab6.db --part task1",
    ]
    *each, batch = (shlex.split(line.partition(": ")[2])[1:] for line in lines)
    scores = [
        json.loads(run_with_input((*words, "--format", "json"), b"", folder=team.parent).stdout)["score"]
        for words in each
    ]
    assert scores == [70, 62]
    done = run_with_input(batch, b"", folder=team.parent)
    assert done.returncode == 0
    assert "ignored: Lab7 is outside the folder of the lab" in done.stderr.decode()
    graded = rows(team.parent / "lab6.db", "SELECT key, score, out_of FROM grade ORDER BY key")
    assert graded == [("Ash", 700_000, 700_000), ("Birch", 620_000, 700_000)]


def test_the_refusal_names_the_rubric(team: Path) -> None:
    """A rubric of one's own is named in the commands, quoted."""
    rubric = team.parent / "my lab.toml"
    shutil.copy(ROOT / "rubrics/lab6/rubric.toml", rubric)
    shutil.copytree(ROOT / "rubrics/lab6/my_robot", team.parent / "my_robot")
    _, _, error = grade(team, "--rubric", str(rubric))
    assert error.count(f" --rubric {shlex.quote(str(rubric))}\n") == 3


def test_several_students_in_an_archive(team: Path) -> None:
    """The commands are for the extracted folder."""
    packed = shutil.make_archive(str(team.parent / "team"), "gztar", team)
    code, _, error = grade(packed)
    assert code == 2
    assert "grader: extract the archive; in its folder:\ngrader: to grade one: grader grade Lab6/Ash\n" in error
    assert error.endswith("grader: to grade all: grader batch . --layout teams --gradebook lab6.db\n")


def test_batch_leaves_several_students_unassigned(team: Path) -> None:
    """Unless the layout splits them: the candidates are named, and no grade is exported."""
    (team / "Lab6/resources").mkdir()  # so that the layout is not detected
    put(team.parent / "class/solo/my_robot", PACKAGE)
    team.rename(team.parent / "class/pair")
    book = team.parent / "g.db"
    assert grader("batch", team.parent / "class", "--gradebook", book).returncode == 0
    assert verdicts(book) == {"pair": "unreadable", "solo": "graded"}
    reason = "it contains the submissions of 2 students, Lab6/Ash and Lab6/Birch: left unassigned (--layout teams grades each)"
    assert rows(book, "SELECT reason, score, pending FROM grade WHERE key = 'pair'") == [(reason, 0, 1_000_000)]
    done = grader("export", "csv", "--gradebook", book)
    assert f"it could not be graded: {reason}" in done.stdout
    done = grader("batch", team.parent / "class", "--gradebook", team.parent / "teams.db", "--layout", "teams")
    assert verdicts(team.parent / "teams.db") == {"pair/Ash": "graded", "pair/Birch": "graded", "solo": "graded"}
    assert "ignored: pair/Lab6/resources is named like a part of a submission" in done.stderr


def test_versions_of_one_student(tmp_path: Path) -> None:
    """They are graded as one submission, the one in front of its versions."""
    for name in ("my_robot", "backup/my_robot", "v2/my_robot", "2024-11-05/my_robot", "final/my_robot"):
        put(tmp_path / "Lab6" / name, PACKAGE)
    found = report(tmp_path)
    assert found["score"] == 90
    assert '"path": "Lab6/my_robot/urdf/my_robot.urdf"' in json.dumps(found["submission"])


def test_the_action_names_the_students_and_takes_one(tmp_path: Path) -> None:
    """On GitHub the refusal is an annotation; the folder of one student is graded by the input `path`."""
    job = GithubJob(tmp_path)
    for name in ("Ash", "Birch"):
        put(job.checkout / "Lab6" / name / "my_robot", PACKAGE)
    (job.checkout / "my_robot.urdf").unlink()
    done = job.run("grade", ".")
    assert done.returncode == 2
    assert "::error title=Nothing was graded::" in done.stderr.decode()
    assert "grader grade Lab6/Birch" in done.stderr.decode()
    assert job.run("grade", "Lab6/Birch").returncode == 0


# --- The package ------------------------------------------------------------------------------------------------------


def test_another_package_earns_no_points(tmp_path: Path) -> None:
    """The package of a final project beside the URDF is named, and all criteria of the package fail or are skipped."""
    put(tmp_path / "my_robot.urdf")
    put(tmp_path / "other_robot_gazebo", PACKAGE)
    (tmp_path / "other_robot_gazebo/urdf/my_robot.urdf").unlink()
    file = tmp_path / "other_robot_gazebo/package.xml"
    file.write_text(file.read_text().replace("<name>my_robot<", "<name>other_robot_gazebo<"))
    assert message_of(tmp_path, "package-found") == (
        "no package is named 'my_robot', and none contains the graded URDF;"
        " there is 'other_robot_gazebo' in other_robot_gazebo"
    )
    assert report(tmp_path, "--part", "task2")["score"] == 0
    file.write_text(file.read_text().replace("other_robot_gazebo", "my_robot"))
    assert report(tmp_path, "--part", "task2")["score"] == 15  # without its URDF


def test_a_package_with_a_similar_name_is_graded(tmp_path: Path) -> None:
    """If it contains the graded URDF: only its name is wrong."""
    put(tmp_path / "my_robott", PACKAGE)
    file = tmp_path / "my_robott/package.xml"
    file.write_text(file.read_text().replace("<name>my_robot<", "<name>my_robott<"))
    assert message_of(tmp_path, "package-found") == "the package is named 'my_robott'; it should be named 'my_robot'"
    assert report(tmp_path, "--part", "task2")["score"] == 19


# --- Stale builds -----------------------------------------------------------------------------------------------------


def test_a_build_has_what_the_source_lacks(tmp_path: Path) -> None:
    """Each failure about a missing file names the copy in the build of this package, and no other."""
    put(tmp_path / "src/my_robot", PACKAGE)
    share = tmp_path / "install/my_robot/share/my_robot"
    for name in ("launch/my_robot_rviz.launch.py", "rviz/my_robot.rviz", "urdf/my_robot.urdf"):
        put(share / name, PACKAGE / name)
        put(tmp_path / "install/a_robot/share/a_robot" / name, PACKAGE / name)
    assert report(tmp_path)["score"] == 90
    for folder in ("launch", "rviz", "urdf"):
        shutil.rmtree(tmp_path / "src/my_robot" / folder)
    asked = "was the source not committed?"
    below = "a build contains install/my_robot/share/my_robot"
    assert message_of(tmp_path, "launch-found").endswith(f"; {below}/launch/my_robot_rviz.launch.py: {asked}")
    assert message_of(tmp_path, "rviz-found").endswith(f"; {below}/rviz/my_robot.rviz: {asked}")
    assert asked in message_of(tmp_path, "urdf-loads")
    put(tmp_path / "src/my_robot/launch/other.launch.py", PACKAGE / "launch/my_robot_rviz.launch.py")
    assert message_of(tmp_path, "launch-found") == (
        "there is no launch file 'my_robot_rviz.launch.py'; the package has launch/other.launch.py;"
        f" {below}/launch/my_robot_rviz.launch.py: {asked}"
    )


def test_a_build_without_its_package(tmp_path: Path) -> None:
    """A repository that holds only the build of the package."""
    put(tmp_path / "my_robot.urdf")
    put(tmp_path / "install/my_robot/share/my_robot/package.xml", PACKAGE / "package.xml")
    assert message_of(tmp_path, "package-found") == (
        "the submission has no ROS 2 package: there is no package.xml;"
        " a build contains install/my_robot/share/my_robot/package.xml: was the source not committed?"
    )


# --- Names in commands ------------------------------------------------------------------------------------------------


def test_commands_quote_names(tmp_path: Path) -> None:
    """A path with spaces or quotes is one word of the command that a message suggests."""
    urdf = put(tmp_path / "it's mine/my_robot.urdf")
    book = tmp_path / "my book.db"
    rubric = tmp_path / "my lab.toml"
    shutil.copy(ROOT / "rubrics/lab6/rubric.toml", rubric)
    package = put(tmp_path / "my robot", PACKAGE)
    commands = {
        f"grader grade {shlex.quote(str(urdf))}": (urdf,),
        f"grader batch PATH --gradebook '{book}'": ("stats", "--gradebook", book),
        f"grader rubric show '{rubric}'": ("grade", urdf, "--rubric", rubric, "--part", "task9"),
        f"grader grade '{package}'": ("batch", package, "--gradebook", book),
        "grader explain lidar-frame --rubric 'my lab.toml'": ("grade", BURIED, "--rubric", rubric),
    }
    for command, arguments in commands.items():
        done = run_with_input(arguments, b"")
        words = " ".join((done.stdout + done.stderr).decode().split())
        assert f"`{command}`" in words or f"Next: {command}" in words, arguments
