"""grader grade --save: any number of reports from one run, each written completely or not at all."""

import errno
import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

from grader.report.formats import Format
from grader.usecases.writing import save
from tests.command_line import run
from tests.report.reports import CLASSROOM50
from tests.samples import ROOT

MISTAKEN = "submissions/lab6/several-mistakes/my_robot/urdf/my_robot.urdf"


def saved(*texts: str) -> subprocess.CompletedProcess[bytes]:
    """Grade the sample and save it so."""
    return run(("grade", MISTAKEN, *(part for text in texts for part in ("--save", text))), **CLASSROOM50)


def test_every_format_can_be_saved_at_once(tmp_path: Path) -> None:
    """Each file equals the output of that format and has its own ending; nothing else is in the folder."""
    names = {kind: f"report.{kind.ending}" for kind in Format}
    assert len(set(names.values())) == len(Format)
    done = saved(*(f"{kind}={tmp_path / name}" for kind, name in names.items()))
    assert (done.returncode, done.stderr) == (1, b"")
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(names.values())
    for kind, name in names.items():
        text = re.sub(rb"!\[.*\n\n", b"", (tmp_path / name).read_bytes())  # Markdown shows the SVG beside it
        assert text == run(("grade", MISTAKEN, "--format", kind), **CLASSROOM50).stdout


@pytest.mark.parametrize("other", ["{0}/a", "{0}/./a", "{0}/b/../a", "{0}/link"])
@pytest.mark.parametrize("kind", ["json", "junit"])
def test_one_file_holds_one_report(tmp_path: Path, kind: str, other: str) -> None:
    """Two reports for the same file are refused under any name, and nothing is written."""
    (tmp_path / "b").mkdir()
    (tmp_path / "link").symlink_to("a")
    done = saved(f"json={tmp_path}/a", f"{kind}={other.format(tmp_path)}")
    assert (done.returncode, done.stdout) == (2, b"")
    assert b"one file cannot hold two reports" in done.stderr
    assert not (tmp_path / "a").exists()


@pytest.mark.parametrize("text", ["pdf=a", "json", "json=", "json=-", "=a", "JSON=a", " json=a", "json:a", ""])
def test_an_invalid_option_is_refused(text: str) -> None:
    """One line lists the formats."""
    done = saved(text)
    assert (done.returncode, done.stdout) == (2, b"")
    assert b"--save takes FORMAT=FILE with one of the formats terminal, markdown, json, junit" in done.stderr
    assert done.stderr.count(b"\n") == 1


@pytest.mark.parametrize("place", ["nowhere/a", "folder", "file/a"])
def test_an_unwritable_path(tmp_path: Path, place: str) -> None:
    """Nothing is printed, the line says where and why, and no temporary file remains."""
    (tmp_path / "folder").mkdir()
    (tmp_path / "file").touch()
    before = sorted(tmp_path.rglob("*"))
    done = saved(f"json={tmp_path / place}")
    assert (done.returncode, done.stdout) == (2, b"")
    assert done.stderr.startswith(f"grader: cannot write {tmp_path / place}: ".encode())
    assert done.stderr.count(b"\n") == 1
    assert sorted(tmp_path.rglob("*")) == before


def test_a_file_is_replaced_atomically(tmp_path: Path) -> None:
    """Open handles still read the old file; permissions stay, and a symlink leads to the new one."""
    file, link = tmp_path / "a.json", tmp_path / "link.json"
    file.write_text("old")
    file.chmod(0o640)
    link.symlink_to("a.json")
    with file.open() as old:
        assert saved(f"json={link}").returncode == 1
        assert old.read() == "old"
    assert link.is_symlink()
    assert file.read_bytes() == run(("grade", MISTAKEN, "--format", "json")).stdout
    assert file.stat().st_mode & 0o777 == 0o640


@pytest.fixture
def sub(tmp_path: Path) -> Path:
    """Return a submission with a student's symlinks beside their targets."""
    folder = tmp_path / "sub"
    folder.mkdir()
    shutil.copy(ROOT / MISTAKEN, folder)
    (tmp_path / "victim").write_text("precious")
    (tmp_path / "etc").mkdir()
    (folder / "report.md").symlink_to("../victim")
    (folder / "out").symlink_to(tmp_path / "etc")
    (folder / "new").symlink_to("../later")
    (folder / "deep").mkdir()
    (folder / "deep" / "link").symlink_to("../out")
    (tmp_path / "mine").symlink_to("sub/out")
    (tmp_path / "sub-too").symlink_to("sub")
    return folder


PLANTED = ("sub/report.md", "sub/out/x", "sub/new", "sub/deep/link/x", "mine/x", "sub-too/out/x", "sub/../sub/./out/x")


@pytest.mark.parametrize("place", PLANTED)
@pytest.mark.parametrize("graded", ["sub", "sub-too", "sub/my_robot.urdf"])
def test_no_symlink_of_a_submission_is_followed(sub: Path, graded: str, place: str) -> None:
    """Also not within the path, for a single URDF, or through an instructor's symlink; nothing is written."""
    top = sub.parent
    before = {path: path.lstat().st_mtime_ns for path in top.rglob("*")}
    done = run(("grade", str(top / graded), "--save", f"markdown={top}/{place}"))
    assert (done.returncode, done.stdout) == (2, b"")
    assert done.stderr.startswith(f"grader: cannot write {top}/".encode())
    assert done.stderr.endswith(b" is a symlink in the submission; choose a file outside of it\n")
    assert done.stderr.count(b"\n") == 1
    assert {path: path.lstat().st_mtime_ns for path in top.rglob("*")} == before
    assert (top / "victim").read_text() == "precious"


def test_symlinks_of_the_instructor_are_followed(sub: Path) -> None:
    """Symlinks outside the submission are followed, and regular files in it are written."""
    top = sub.parent
    (top / "safe").symlink_to("etc")
    (top / "latest.md").symlink_to("etc/b.md")
    for place in ("safe/a.md", "latest.md", "sub/plain.md"):
        assert run(("grade", str(sub), "--save", f"markdown={top}/{place}")).returncode == 1
    assert sorted(path.name for path in (top / "etc").iterdir()) == ["a.md", "b.md"]
    assert (sub / "plain.md").read_text(encoding="utf-8").startswith("# 43 / 100 points")


@pytest.mark.parametrize("variable", ["GITHUB_WORKSPACE", "CI_PROJECT_DIR"])
def test_the_checkout_of_a_job_is_untrusted(sub: Path, variable: str) -> None:
    """A symlink in it is not followed, whatever part of it is graded."""
    top = sub.parent
    graded = str(sub / "deep")
    shutil.copy(ROOT / MISTAKEN, graded)
    done = run(("grade", graded, "--save", f"json={sub}/out/x"), **{variable: str(sub)})
    assert done.returncode == 2
    assert b"is a symlink in the submission" in done.stderr
    bundle = run(("bundle", "gradescope", f"{sub}/out/x.zip"), **{variable: str(sub)})
    assert (bundle.returncode, list((top / "etc").iterdir())) == (2, [])


def test_a_summary_is_not_written_through_a_symlink(sub: Path) -> None:
    """The report is printed all the same."""
    summary = {"GITHUB_ACTIONS": "true", "GITHUB_STEP_SUMMARY": str(sub / "report.md")}
    done = run(("grade", str(sub)), **summary)
    assert done.returncode == 1
    assert b"cannot write the job summary" in done.stderr
    assert (sub.parent / "victim").read_text() == "precious"


def test_temporary_names_are_unpredictable(sub: Path) -> None:
    """The temporary file has a new random name every time."""
    names, opened = [], os.open

    def watched(path: Path, flags: int, mode: int) -> int:
        names.append(path.name)
        assert flags & os.O_EXCL
        assert flags & os.O_NOFOLLOW
        return opened(path, flags, mode)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(os, "open", watched)
        for _ in range(3):
            save(sub / "plain.md", "text")
    assert len(set(names)) == 3
    assert sorted(path.name for path in sub.iterdir()) == [
        "deep",
        "my_robot.urdf",
        "new",
        "out",
        "plain.md",
        "report.md",
    ]


def test_what_is_graded_is_never_removed(sub: Path) -> None:
    """Neither a URDF, nor the rubric, nor any robot is removed, because it may be the graded file."""
    robot, rubric = sub / "my_robot.urdf", sub.parent / "lab.toml"
    rubric.write_bytes((ROOT / "rubrics/lab6/rubric.toml").read_bytes())
    (sub.parent / "hard.json").hardlink_to(robot)
    for graded, target in ((robot, robot), (sub, robot), (sub, rubric), (robot, sub.parent / "hard.json")):
        before = target.read_bytes()
        done = run(("grade", str(graded), "--rubric", str(rubric), "--save", f"json={target}"))
        assert (done.returncode, b"also reads or writes it" in done.stderr) == (2, True)
        assert target.read_bytes() == before
    assert run(("grade", str(sub / "none"), "--save", f"json={robot}")).returncode == 2
    assert robot.exists()


def test_a_device_is_written_to(tmp_path: Path) -> None:
    """A special file is not replaced, and one that cannot be written is reported."""
    assert saved("json=/dev/null").returncode == 1
    assert not os.path.isfile("/dev/null")
    done = saved("json=/dev/full")
    assert (done.returncode, done.stdout) == (2, b"")
    assert b"cannot write /dev/full: No space left on device" in done.stderr


def test_a_file_system_that_cannot_sync(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The file is written all the same."""

    def refused(_: int) -> None:
        raise OSError(errno.EINVAL, "Invalid argument")

    monkeypatch.setattr(os, "fsync", refused)
    save(tmp_path / "report", "text")
    assert (tmp_path / "report").read_text() == "text"
