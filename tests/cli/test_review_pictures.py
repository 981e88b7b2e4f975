"""grader review --pictures: which files are written, for whom, and what they never overwrite."""

import shutil
import subprocess
import time
from pathlib import Path
from types import SimpleNamespace

import pytest

from grader.classroom.gradebook.submission_files import SubmissionFiles, SubmissionSources
from grader.classroom.intake.fingerprint import fingerprint
from grader.files.reading import URDF_LIMIT
from grader.submission.urdf import Read
from tests.checks.submissions import gif
from tests.classroom.gradebooks import PNG, batch, grader, lab, lab_text, refusal, urdf, write_submission

SVG = b"<svg xmlns='http://www.w3.org/2000/svg' onload='alert(1)'/>"


@pytest.fixture
def top(tmp_path: Path) -> Path:
    """Return a class of three: a picture, an SVG under the name of a picture, two pictures in a zip."""
    folder = tmp_path / "class"
    write_submission(folder / "ash")
    write_submission(folder / "birch")
    (folder / "birch" / "screen.png").write_bytes(SVG)
    write_submission(folder / "cedar")
    (folder / "cedar" / "screen-2.png").write_bytes(gif())
    (tmp_path / "roster.csv").write_text("id,name\nash,Ash Ek\nbirch,Birch Oh\ncedar,Cedar Fi\n")
    (tmp_path / "small.toml").write_text(lab_text())
    assert batch(tmp_path).returncode == 0
    return tmp_path


def review(top: Path, typed: str = "", *more: object) -> subprocess.CompletedProcess[str]:
    """Review with pictures in the folder `out`."""
    arguments = ("--gradebook", top / "book.db", "--pictures", top / "out", *more)
    return grader("review", *arguments, stdin=typed, COLUMNS="300")


def files(top: Path) -> dict[str, bytes]:
    """Return the pictures that were written."""
    return {
        path.relative_to(top / "out").as_posix(): path.read_bytes()
        for path in sorted((top / "out").rglob("*"))
        if path.is_file() and path.name != "index.csv"
    }


def test_pictures_are_files_that_are_named(top: Path) -> None:
    """One file for each picture, with the ending of what it is; the list says whose it is, and what is not shown."""
    done = review(top)
    assert (done.returncode, done.stderr) == (0, "")
    assert files(top) == {"picture/ash.1.png": PNG, "picture/cedar.1.gif": gif(), "picture/cedar.2.png": PNG}
    assert done.stdout.splitlines()[:4] == [
        f"Ash Ek (ash), picture: {top}/out/picture/ash.1.png  screen.png (1 x 1 pixels)",
        "Birch Oh (birch), picture: screen.png: its content is SVG, which can contain scripts: open it yourself, with care",
        f"Cedar Fi (cedar), picture: {top}/out/picture/cedar.1.gif  screen-2.png (320 x 240 pixels)",
        f"Cedar Fi (cedar), picture: {top}/out/picture/cedar.2.png  screen.png (1 x 1 pixels)",
    ]
    assert done.stdout.endswith("0 marked, 6 left\n")


def test_each_item_of_the_review_names_its_files(top: Path) -> None:
    """The terminal review goes on after the list, from the first item."""
    done = review(top, "1\n2\n3\n1\nq\n")
    items = done.stdout.split("points, 0 to ")
    assert "1 of 6  Ash Ek (ash): About essay" in items[0]
    assert f"Pictures:\n  {top}/out/picture/ash.1.png  screen.png (1 x 1 pixels)\n" in items[3]
    assert (
        "Pictures:\n  screen.png: its content is SVG, which can contain scripts: open it yourself, with care\n"
        in items[4]
    )
    assert done.stdout.endswith("4 marked, 2 left\n")


def test_a_submission_that_has_changed_shows_no_picture(top: Path) -> None:
    """What is shown is what was graded."""
    (top / "class" / "ash" / "screen.png").write_bytes(PNG + b"\0")
    done = review(top)
    why = "the files have changed or moved since they were graded: run `grader batch` again"
    assert f"Ash Ek (ash), picture: pictures: {why}\n" in done.stdout
    assert "picture/ash.1.png" not in files(top)


def test_a_copy_with_the_same_content_is_no_change(top: Path) -> None:
    """The contents count, not the times of the files."""
    (top / "class").rename(top / "moved")
    shutil.copytree(top / "moved", top / "class", copy_function=shutil.copyfile)
    review(top)
    assert len(files(top)) == 3


def test_another_limit_of_a_urdf_is_no_change(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A submission that was graded with --max-size is opened with the same limit."""
    write_submission(tmp_path / "ash")
    (tmp_path / "ash" / "robot.urdf").write_text(urdf() + " " * 2_000_000)
    later = time.time_ns() + 10**9  # files that were just written have no fingerprint
    monkeypatch.setattr("grader.classroom.gradebook.submission_files.time", SimpleNamespace(time_ns=lambda: later))
    for limit, is_read in ((3_000_000, True), (URDF_LIMIT, False)):
        stamp = fingerprint(str(tmp_path), ("ash",), later)
        sources = SubmissionSources(SubmissionFiles(str(tmp_path), ("ash",), (), "ash", stamp, "", limit), lab())
        assert isinstance(sources.urdf, Read) == is_read
    assert SubmissionSources(SubmissionFiles(str(tmp_path), ("ash",), (), "ash", f"{stamp}1"), lab()).submission is None


def test_a_symlink_is_not_followed(top: Path) -> None:
    """Neither in the submission, nor in the folder of the pictures."""
    (top / "secret.png").write_bytes(PNG)
    picture = top / "class" / "birch" / "screen.png"
    picture.unlink()
    picture.symlink_to(top / "secret.png")
    assert batch(top).returncode == 0
    review(top)
    assert not any("birch" in name for name in files(top))
    (top / "out" / "picture" / "ash.1.png").unlink()
    (top / "out" / "picture" / "ash.1.png").symlink_to(top / "secret.png")
    done = review(top)
    assert (done.returncode, done.stderr.endswith("ash.1.png is a symlink\n")) == (2, True)
    assert (top / "secret.png").read_bytes() == PNG


@pytest.mark.parametrize("name", ["class", "class/pictures", "class/ash/pictures"])
def test_no_picture_is_written_into_the_class(name: str, top: Path) -> None:
    """The next run would take the folder for a submission."""
    why = "the next run would take them for a submission; choose a folder outside of the class folder"
    before = sorted(top.rglob("*"))
    done = grader("review", "--gradebook", top / "book.db", "--pictures", top / name)
    assert refusal(done) == f"cannot write files to {top / name}: {why}"
    assert sorted(top.rglob("*")) == before


def test_no_picture_of_another_student_is_overwritten(top: Path) -> None:
    """A folder that has a file of that name for another student is refused before anything is written."""
    assert review(top).returncode == 0
    index = top / "out" / "index.csv"
    index.write_text(index.read_text().replace("ash,ash", "ash,elm"))
    (top / "out" / "picture" / "ash.1.png").write_bytes(b"elm's")
    assert "out has a report of elm named ash: choose another folder" in refusal(review(top))
    assert files(top)["picture/ash.1.png"] == b"elm's"


def test_nothing_needs_manual_grading(top: Path) -> None:
    """Then no folder is made."""
    review(top, "1\n1\n1\n1\n1\n1\n")
    for path in sorted((top / "out").rglob("*"), reverse=True):
        path.rmdir() if path.is_dir() else path.unlink()
    (top / "out").rmdir()
    assert review(top).stdout == "nothing needs manual grading\n"
    assert not (top / "out").exists()


def test_a_measured_vector_is_no_list_of_files(tmp_path: Path) -> None:
    """A second opinion on an overridden check shows no paths made of its numbers, and writes no pictures."""
    write_submission(tmp_path / "class" / "ash")
    centre = '"centre_at"\nwith = { link = "base", relative_to = "base", xyz = [0, 0, 1], tolerance = 0.001 }'
    before, middle = lab_text(middle="1").split('id = "middle"')
    text = f'{before}id = "middle"{middle.replace(chr(34) + "urdf_loads" + chr(34), centre)}'
    (tmp_path / "small.toml").write_text(text)
    (tmp_path / "roster.csv").write_text("id\nash\n")
    assert batch(tmp_path).returncode == 0
    assert grader("mark", "ash", "middle", "1", "--by", "Kim", "--gradebook", tmp_path / "book.db").returncode == 0
    done = review(tmp_path, "q\n", "--second", "--by", "Lee", "--criterion", "middle")
    assert "1 of 1  ash: About middle" in done.stdout
    assert not {word for word in ("Look at", "Pictures", "submission") if word in done.stdout}, done.stdout
