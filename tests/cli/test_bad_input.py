"""Bad input: one clear line on standard error, the correct exit code, nothing on standard output, no traceback."""

import json
import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from tests.command_line import HANG_TIMEOUT, ROOT, run, run_with_input

REFERENCE = ROOT / "submissions/lab6/reference/roscourse_sim_ws/src/my_robot/urdf/my_robot.urdf"
MEBIBYTE = 1024 * 1024


def refuse(*arguments: str, words: str, code: int = 2) -> None:
    """Assert that a command fails with one line that contains the words."""
    done = run(arguments)
    message = done.stderr.decode()
    assert done.returncode == code
    assert done.stdout == b""
    assert message.count("\n") == 1, message
    assert message.startswith("grader: ")
    assert words in message
    assert "Traceback" not in message


@pytest.mark.parametrize("command", ["grade", "inspect"])
class TestPaths:
    """Paths that cannot be graded."""

    def test_missing(self, command: str, tmp_path: Path) -> None:
        """A path that does not exist."""
        refuse(command, str(tmp_path / "nothing.urdf"), words="does not exist")

    def test_empty_folder(self, command: str, tmp_path: Path) -> None:
        """An empty folder, and one with only hidden files."""
        refuse(command, str(tmp_path), words="is empty")
        (tmp_path / ".git").mkdir()
        (tmp_path / ".git" / "config").touch()
        refuse(command, str(tmp_path), words="hidden files and build folders are ignored")

    def test_damaged_archive(self, command: str, tmp_path: Path) -> None:
        """A truncated archive, an empty one, and unsupported kinds."""
        (tmp_path / "lab6.ZIP").write_bytes(b"PK\x03\x04")
        refuse(command, str(tmp_path / "lab6.ZIP"), words="cannot be read as an archive")
        (tmp_path / "lab6.tar.gz").touch()
        refuse(command, str(tmp_path / "lab6.tar.gz"), words="damaged or empty")
        (tmp_path / "lab6.7z").write_bytes(b"7z\xbc\xaf\x27\x1c")
        refuse(command, str(tmp_path / "lab6.7z"), words="submit a .zip or .tar.gz")
        with zipfile.ZipFile(tmp_path / "empty.zip", "w"):
            pass
        refuse(command, str(tmp_path / "empty.zip"), words="is empty")

    def test_too_large(self, command: str, tmp_path: Path) -> None:
        """A file above the size limit."""
        (tmp_path / "large.urdf").write_bytes(b" " * (2 * MEBIBYTE))
        refuse(command, str(tmp_path / "large.urdf"), words="larger than 1048576 bytes")

    @pytest.mark.skipif(os.geteuid() == 0, reason="root may read every file")
    def test_unreadable(self, command: str, tmp_path: Path) -> None:
        """A file without read permission."""
        (tmp_path / "secret.urdf").touch(mode=0o000)
        refuse(command, str(tmp_path / "secret.urdf"), words="Permission denied")

    def test_fifo(self, command: str, tmp_path: Path) -> None:
        """A named pipe that nobody writes to."""
        os.mkfifo(tmp_path / "pipe.urdf")
        refuse(command, str(tmp_path / "pipe.urdf"), words="not a regular file")

    def test_device(self, command: str) -> None:
        """A device that never ends."""
        refuse(command, "/dev/zero", words="not a regular file")

    def test_symlink_loop(self, command: str, tmp_path: Path) -> None:
        """A symbolic link to itself."""
        (tmp_path / "loop.urdf").symlink_to(tmp_path / "loop.urdf")
        refuse(command, str(tmp_path / "loop.urdf"), words="ymbolic link")

    def test_symlink_out_of_a_folder(self, command: str, tmp_path: Path) -> None:
        """A symlink that leads out of the submission is not followed."""
        folder = tmp_path / "submission"
        folder.mkdir()
        (folder / "my_robot.urdf").symlink_to(REFERENCE)
        refuse(command, str(folder), words="is a symlink that leads out of the submission")

    def test_name_with_nul_or_too_long(self, command: str, tmp_path: Path) -> None:
        """A name that no file can have."""
        refuse(command, str(tmp_path / ("x" * 5000)), words="cannot read")

    def test_control_characters_in_a_name(self, command: str, tmp_path: Path) -> None:
        """A name with an escape sequence is printed escaped."""
        refuse(command, str(tmp_path / "\x1b[31m\nred.urdf"), words="\\x1b[31m\\x0ared.urdf")


@pytest.mark.parametrize("name", ["grades.csv", "Grades.XLSX", "grades.ods"])
def test_a_table_is_no_submission(name: str, tmp_path: Path) -> None:
    """An export of grades is refused before it is read, also by `inspect`."""
    (tmp_path / name).write_bytes(b"id,total\n")
    for command in ("grade", "inspect"):
        done = run([command, tmp_path / name])
        expected = (
            f"grader: {tmp_path / name} is a table, not a submission: give a .urdf file, or the folder or archive"
        )
        assert (done.returncode, done.stdout) == (2, b"")
        assert done.stderr.decode().startswith(expected)


def test_a_folder_without_a_urdf_is_graded_and_cannot_be_inspected(tmp_path: Path) -> None:
    """A submission without a URDF gets a report that says so; there is nothing to inspect."""
    (tmp_path / "build").mkdir()
    (tmp_path / "build" / "old.urdf").write_bytes(REFERENCE.read_bytes())
    (tmp_path / "notes.txt").write_text("no robot")
    done = run(("grade", str(tmp_path), "--format", "json"))
    assert (done.returncode, done.stderr) == (1, b"")
    report = json.loads(done.stdout)
    assert report["submission"]["path"] is None
    assert report["submission"]["other_candidates"][0]["path"] == "build/old.urdf"
    assert report["results"][0]["message"].startswith("no URDF was submitted")
    assert report["score"] == 0
    refuse("inspect", str(tmp_path), words="has no URDF")


def test_a_single_urdf_has_no_package() -> None:
    """A part that needs more than a URDF cannot be selected for a single URDF."""
    refuse("grade", str(REFERENCE), "--part", "task2", words="give the folder or archive")


CONTENTS = {
    "empty": b"",
    "blank": b" \n\t\n",
    "binary": bytes(range(256)) * 40,
    "utf-32": '<robot name="a"><link name="b"/></robot>'.encode("utf-32"),
    "external-entity": b'<!DOCTYPE r [<!ENTITY x SYSTEM "file:///etc/passwd">]><robot name="&x;">',
    "bomb": b'<!DOCTYPE r [<!ENTITY a "aaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;">]><robot name="&b;">',
    "deep": b"<robot name='a'>" + b"<a>" * 100_000,
    "deep-and-closed": b"<robot name='a'>" + b"<a>" * 100_000 + b"</a>" * 100_000 + b"</robot>",
    "gzip": b"\x1f\x8b\x08\x00" + b"\x00" * 50,
}


@pytest.mark.parametrize("name", CONTENTS)
def test_an_unreadable_urdf_gets_a_report(name: str, tmp_path: Path) -> None:
    """A file that ROS 2 cannot read fails urdf-loads, the rest is skipped; the exit code is 1."""
    (tmp_path / "my_robot.urdf").write_bytes(CONTENTS[name])
    done = run(("grade", str(tmp_path / "my_robot.urdf"), "--format", "json"))
    assert (done.returncode, done.stderr) == (1, b"")
    report = json.loads(done.stdout)
    assert report["score"] == 0
    assert report["results"][0]["status"] == "failed"
    assert {result["because"] for result in report["results"][1:]} == {"urdf-loads"}
    assert b"root:" not in done.stdout
    assert run(("inspect", str(tmp_path / "my_robot.urdf"))).returncode == 1


def test_a_doctype_is_graded_and_opens_nothing(tmp_path: Path) -> None:
    """ROS 2 leaves entities unresolved, and so does the grader."""
    text = b'<!DOCTYPE r [<!ENTITY x SYSTEM "file:///etc/passwd">]>\n<robot name="a"><link name="&x;"/></robot>'
    (tmp_path / "a.urdf").write_bytes(text)
    done = run(("inspect", str(tmp_path / "a.urdf"), "--format", "json"))
    assert done.returncode == 0
    assert b'"links": ["&x;"]' in done.stdout


def test_usage() -> None:
    """Wrong options, formats, parts, thresholds, joints and names."""
    reference = str(REFERENCE)
    refuse("grade", reference, "--rubric", "lab66", words="did you mean 'lab6'?")
    refuse("grade", reference, "--rubric", "nowhere/lab.toml", words="No such file")
    refuse("grade", reference, "--part", "task11", words="did you mean 'task1'?")
    refuse("grade", reference, "--fail-under", "many", words="--fail-under takes points or a percentage")
    refuse("grade", reference, "--format", "pdf", words="pdf")
    refuse("grade", reference, "--save", "json", words="--save takes FORMAT=FILE")
    refuse("grade", reference, "--save", "pdf=x.pdf", words="terminal, markdown, json")
    refuse("grade", reference, "--save", "json=/nowhere/at/all.json", words="cannot write")
    refuse("grade", reference, "--hints", words="--hints")
    refuse("inspect", words="PATH")
    refuse("grad", reference, words="grad")
    refuse("inspect", reference, "--joint", "base_left_wheel_joint", words="--joint takes NAME=VALUE")
    refuse("inspect", reference, "--joint", "base_left_wheel_joint=fast", words="--joint takes NAME=VALUE")
    refuse("inspect", reference, "--joint", "left_wheel_joint=1", words="did you mean 'base_left_wheel_joint'?")
    refuse("inspect", reference, "--joint", "base_lidar_joint=1", words="is fixed")
    refuse("inspect", reference, "--relative-to", "chassis", words="there is no link 'chassis'")
    refuse("explain", "URDF999", words="there is no problem code, criterion or check")
    refuse("schema", "gradebook", words="gradebook")
    refuse("rubric", "tset", "lab6", words="tset")


def test_a_rubric_with_mistakes_is_refused_with_all_of_them(tmp_path: Path) -> None:
    """Every mistake is on a line of its own, and nothing is graded."""
    text = 'id = "x"\ntitel = "y"\n[[part]]\nid = "p"\n[[criterion]]\nid = "a"\npart = "q"\npoints = -1\ncheck = "urdf_load"\n'
    (tmp_path / "bad.toml").write_text(text)
    done = run(("grade", str(REFERENCE), "--rubric", str(tmp_path / "bad.toml")))
    lines = done.stderr.decode().splitlines()
    assert (done.returncode, done.stdout) == (2, b"")
    assert len(lines) == 7
    assert all(line.startswith("grader: ") and "bad.toml:" in line for line in lines)
    (tmp_path / "bad.toml").write_text("id = [\n")
    refuse(
        "rubric",
        "check",
        str(tmp_path / "bad.toml"),
        words="bad.toml:2:1: invalid value: an empty line",
    )


@pytest.mark.parametrize("form", ["terminal", pytest.param("json", marks=pytest.mark.exhaustive)])
def test_closed_standard_output(form: str) -> None:
    """One line on standard error and exit code 2, whether it was closed before or during the output."""
    command = f'"{sys.executable}" -m grader grade submissions/lab6/reference --format {form}'
    for redirected in (f"{command} >&-", f"({command}; echo $? >&2) | true", f"{command} > /dev/full"):
        done = subprocess.run(
            ["bash", "-c", redirected], cwd=ROOT, capture_output=True, check=False, timeout=HANG_TIMEOUT
        )
        assert b"standard output" in done.stderr or b"| true" in redirected.encode(), done.stderr
        assert b"Traceback" not in done.stderr
        if "|" not in redirected:
            assert done.returncode == 2
            assert done.stderr.count(b"\n") == 1


def test_standard_input() -> None:
    """A URDF can come from a pipe."""
    done = run_with_input(("grade", "-", "--format", "json"), REFERENCE.read_bytes())
    assert done.returncode == 0
    assert b'"id": "stdin", "path": "-"' in done.stdout
