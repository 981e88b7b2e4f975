"""What `grader batch` refuses gives one clear line on standard error and exit code 2, and nothing is lost."""

import os
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.classroom.class_runs import contents, counted, grader, rows, urdf_class, verdicts, without_hints
from tests.samples import ROOT


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Make a class of three."""
    return urdf_class(tmp_path / "class", 3)


def refused(*arguments: str | Path) -> str:
    """Return the single line in which a command is refused."""
    done = grader(*arguments)
    assert (done.returncode, done.stdout) == (2, "")
    *before, line = done.stderr.splitlines()
    assert all(message.startswith("grader: ") for message in (*before, line))
    assert "Traceback" not in done.stderr
    return line.removeprefix("grader: ")


def _missing(top: Path) -> Path:
    return top / "missing"


def _empty(top: Path) -> Path:
    (top / "empty").mkdir()
    return top / "empty"


def _one_submission(_: Path) -> Path:
    return ROOT / "submissions/lab6/reference/roscourse_sim_ws/src/my_robot"


def _one_file(_: Path) -> Path:
    return ROOT / "submissions/lab6/lidar-buried/my_robot/urdf/my_robot.urdf"


def _broken_zip(top: Path) -> Path:
    with zipfile.ZipFile(top / "whole.zip", "w") as archive:
        archive.writestr("ann.urdf", "<robot/>" * 100)
    (top / "broken.zip").write_bytes((top / "whole.zip").read_bytes()[:-30])
    return top / "broken.zip"


def _empty_zip(top: Path) -> Path:
    zipfile.ZipFile(top / "empty.zip", "w").close()
    return top / "empty.zip"


def _pictures(top: Path) -> Path:
    (top / "pictures").mkdir()
    (top / "pictures/a.png").touch()
    return top / "pictures"


@pytest.mark.parametrize(
    ("make", "output"),
    [
        (_missing, "does not exist"),
        (_empty, "is empty"),
        (_one_submission, "is one submission and not a class"),
        (_one_file, "is neither a folder nor a zip"),
        (_broken_zip, "cannot be read as a zip"),
        (_empty_zip, "is empty"),
        (_pictures, "there is no submission in"),
    ],
)
def test_no_class(make: Callable[[Path], Path], output: str, tmp_path: Path) -> None:
    """No gradebook is made for a path that is no class."""
    assert output in refused("batch", make(tmp_path), "--gradebook", tmp_path / "lab6.db")
    assert not (tmp_path / "lab6.db").exists()


def test_a_gradebook_in_a_missing_folder(folder: Path, tmp_path: Path) -> None:
    """The message names the gradebook."""
    path = tmp_path / "missing" / "lab6.db"
    assert refused("batch", folder, "--gradebook", path).startswith(f"cannot create the gradebook {path}: ")


@pytest.mark.skipif(os.geteuid() == 0, reason="nothing is closed to root")
def test_a_read_only_gradebook(folder: Path, tmp_path: Path) -> None:
    """A file or a folder without write permission is reported."""
    path = tmp_path / "lab6.db"
    assert grader("batch", folder, "--gradebook", path).returncode == 0
    path.chmod(0o400)
    assert "readonly" in refused("batch", folder, "--gradebook", path, "--force")


def test_a_gradebook_on_a_device(folder: Path) -> None:
    """A device that takes no file is refused."""
    assert refused("batch", folder, "--gradebook", "/dev/full").startswith("the gradebook /dev/full: ")


@pytest.mark.parametrize(
    "arguments",
    [
        ("--jobs", "0"),
        ("--jobs", "-1"),
        ("--jobs", "many"),
        ("--timeout", "0"),
        ("--timeout", "nan"),
        ("--timeout", "-1"),
        ("--layout", "heaps"),
        ("--report-format", "pdf"),
        ("--due", "tomorrow"),
        ("--rubric", "lab66"),
        ("--rubric", "missing.toml"),
        ("--roster", "missing.csv"),
    ],
)
def test_wrong_usage(arguments: tuple[str, str], folder: Path, tmp_path: Path) -> None:
    """Nothing is started."""
    line = refused("batch", folder, "--gradebook", tmp_path / "lab6.db", *arguments)
    assert arguments[0].removeprefix("--") in line or arguments[1] in line
    assert not (tmp_path / "lab6.db").exists()


def test_a_broken_rubric_and_a_broken_roster(folder: Path, tmp_path: Path) -> None:
    """The mistake is reported with its line, and nothing is started."""
    (tmp_path / "broken.toml").write_text(
        (ROOT / "rubrics/lab6/rubric.toml").read_text().replace("points = 6", "points = 'six'", 1)
    )
    (tmp_path / "broken.csv").write_text("colour\nred\n")
    command = ("batch", folder, "--gradebook", tmp_path / "lab6.db")
    assert "broken.toml:" in refused(*command, "--rubric", tmp_path / "broken.toml")
    assert "broken.csv has no column for an id" in refused(*command, "--roster", tmp_path / "broken.csv")
    assert not (tmp_path / "lab6.db").exists()


def test_a_file_in_place_of_the_reports(folder: Path, tmp_path: Path) -> None:
    """It is reported before anything is graded, and the file is unchanged."""
    (tmp_path / "reports").write_text("precious")
    book = tmp_path / "lab6.db"
    assert "reports: it is not a folder" in refused(
        "batch", folder, "--gradebook", book, "--reports", tmp_path / "reports"
    )
    assert (tmp_path / "reports").read_text() == "precious"
    assert "cannot write" in refused("batch", folder, "--gradebook", book, "--csv", tmp_path / "missing" / "a.csv")
    assert not book.exists()


def test_grades_do_not_replace_what_the_command_reads(folder: Path, tmp_path: Path) -> None:
    """Not the roster or a robot, under any name, and nothing in the class: every file keeps its content."""
    roster, robot = tmp_path / "roster.csv", tmp_path / "robot.urdf"
    roster.write_text("id\nash\n")
    robot.write_text("<robot name='a'><link name='b'/></robot>")
    (tmp_path / "link.csv").symlink_to("roster.csv")
    inputs = ("--roster", roster, "--ignore-file", robot, "--gradebook", tmp_path / "lab6.db")
    before = {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}
    for name in ("roster.csv", "link.csv", "robot.urdf"):
        line = refused("batch", folder, *inputs, "--csv", tmp_path / name)
        assert (
            line == f"cannot write {tmp_path / name}: the command also reads or writes it; name another file for --csv"
        )
    inside = refused("batch", folder, *inputs, "--csv", folder / "grades.csv")
    assert inside.endswith("the next run would take it for a submission; choose a file outside of the class")
    assert {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()} == before


@pytest.mark.parametrize("option", ["--reports", "--csv", "--gradebook"])
def test_symlinks_of_a_submission_are_not_written_through(option: str, folder: Path, tmp_path: Path) -> None:
    """They are refused before anything is graded; a symlink beside the class is followed."""
    (folder / "mallory").mkdir()
    (tmp_path / "elsewhere").mkdir()
    (folder / "mallory" / "out").symlink_to(tmp_path / "elsewhere")
    (tmp_path / "link").symlink_to("elsewhere")
    book = () if option == "--gradebook" else ("--gradebook", tmp_path / "lab6.db")
    line = refused("batch", folder, *book, option, folder / "mallory" / "out" / "a")
    assert line.endswith("mallory/out is a symlink in the submission; choose a file outside of it")
    assert not list((tmp_path / "elsewhere").iterdir())
    assert not (tmp_path / "lab6.db").exists()
    assert grader("batch", folder, *book, option, tmp_path / "link" / "a").returncode == 0
    assert list((tmp_path / "elsewhere").iterdir())


@pytest.mark.skipif(os.geteuid() == 0, reason="nothing is closed to root")
def test_a_submission_without_read_permission(folder: Path, tmp_path: Path) -> None:
    """It is unreadable, the others are graded, and it is graded once it may be read."""
    (folder / "closed").mkdir()
    (folder / "closed").chmod(0)
    book = tmp_path / "lab6.db"
    done = grader("batch", folder, "--gradebook", book)
    assert (done.returncode, verdicts(book)["closed"]) == (0, "unreadable")
    (folder / "closed").chmod(0o700)
    (folder / "closed/my_robot.urdf").write_text("<robot name='a'><link name='b'/></robot>")
    assert counted(grader("batch", folder, "--gradebook", book)) == "1 graded, 3 unchanged"


def test_a_class_that_disappears(folder: Path, tmp_path: Path) -> None:
    """Results so far are kept, and no student gets another grade."""
    book = tmp_path / "lab6.db"
    assert grader("batch", folder, "--gradebook", book).returncode == 0
    before = rows(book, "SELECT * FROM grade")
    folder.rename(tmp_path / "gone")
    assert "does not exist" in refused("batch", folder, "--gradebook", book)
    assert rows(book, "SELECT * FROM grade") == before


def test_the_timeout_excludes_reports(tmp_path: Path) -> None:
    """Writing the reports of a class may take longer than the timeout of a submission."""
    folder = urdf_class(tmp_path / "class", 5)
    reports = tmp_path / "reports"
    command = (
        "batch",
        folder,
        "--gradebook",
        tmp_path / "lab6.db",
        "--reports",
        reports,
        "--timeout",
        "0.1",
        "--rubric",
        without_hints(),
    )
    done = grader(*command, "--report-format", "terminal", "--report-format", "json")
    assert done.returncode == 0, done.stderr
    assert len(contents(reports)) == 10
