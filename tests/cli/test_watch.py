"""grader grade --watch: which changes are graded, the first lines, and the end."""

import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path
from threading import Condition, Thread
from types import TracebackType
from typing import IO, Self

import pytest

from grader.files.folder import is_looked_at, read_folder
from grader.usecases.watch import Watched, _stamps, changes
from tests.command_line import HANG_TIMEOUT
from tests.golden.cases import ROOT, run

REFERENCE = ROOT / "submissions/reference"
URDF = REFERENCE / "roscourse_sim_ws/src/my_robot/urdf/my_robot.urdf"  # 70 of 70
SHORT = ROOT / "submissions/lidar-offset-in-visual/my_robot.urdf"  # 64 of 70
BETTER = "\n64 -> 70 of 70 points (+6)\nnow passed: lidar-frame (+6)\n"
WORSE = "\n70 -> 64 of 70 points (-6)\nnow failed: lidar-frame (-6)\n"
END = "  IRP Lab 6: a wheeled base\n"  # of a report


class PipeReader:
    """The output of a pipe so far; waiting for words continues after the previous words."""

    def __init__(self, pipe: IO[bytes]) -> None:
        self._pipe, self._text, self._read, self._is_over = pipe, "", 0, False
        self._news = Condition()
        self.thread = Thread(target=self._run, daemon=True)
        self.thread.start()

    def _run(self) -> None:
        with self._pipe:
            while data := os.read(self._pipe.fileno(), 65536):
                with self._news:
                    self._text += data.decode()
                    self._news.notify_all()
        with self._news:
            self._is_over = True
            self._news.notify_all()

    def until(self, words: str) -> str:
        """Return everything up to these words, which must come."""
        with self._news:
            self._news.wait_for(lambda: self._is_over or words in self._text[self._read :], HANG_TIMEOUT)
            found = self._text.find(words, self._read)
            assert found >= 0, f"{words!r} is not in {self._text[self._read :]!r}"
            start, self._read = self._read, found + len(words)
            return self._text[start : self._read]

    def rest(self) -> str:
        """Return everything up to the end."""
        with self._news:
            assert self._news.wait_for(lambda: self._is_over, HANG_TIMEOUT)
            return self._text[self._read :]


class Watch:
    """The command line, watching."""

    def __init__(self, *arguments: object, stdout: int = subprocess.PIPE) -> None:
        command = [sys.executable, "-m", "grader", "grade", "--watch", *map(str, arguments)]
        environment = {**os.environ, "COLUMNS": "80", "PYTHONIOENCODING": "utf-8"}
        self.process = subprocess.Popen(command, cwd=ROOT, env=environment, stdout=stdout, stderr=subprocess.PIPE)
        assert self.process.stderr is not None
        self.err = PipeReader(self.process.stderr)
        self._out = PipeReader(self.process.stdout) if self.process.stdout is not None else None

    @property
    def out(self) -> PipeReader:
        """Discard its output if no test reads it."""
        assert self._out is not None
        return self._out

    def __enter__(self) -> Self:
        self.err.until("stop with Ctrl-C\n")
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.process.kill()
        self.process.wait(HANG_TIMEOUT)
        for reader in filter(None, (self._out, self.err)):
            reader.thread.join(HANG_TIMEOUT)

    def interrupt(self) -> int:
        """Press Ctrl-C and return the exit code."""
        self.process.send_signal(signal.SIGINT)
        return self.process.wait(HANG_TIMEOUT)


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    """Write a URDF with one mistake in a folder of its own."""
    (tmp_path / "work").mkdir()
    shutil.copy(SHORT, tmp_path / "work" / "my_robot.urdf")
    return tmp_path / "work" / "my_robot.urdf"


def put(data: Path | str | bytes, target: Path) -> None:
    """Replace a file atomically, as many editors do, so that nobody reads half of it."""
    beside = target.with_name(f".{target.name}.tmp")
    if isinstance(data, Path):
        shutil.copy(data, beside)
    else:
        beside.write_bytes(data if isinstance(data, bytes) else data.encode())
    beside.replace(target)


def test_each_round_ends_with_the_changes(robot: Path) -> None:
    """The first report is that of grade; then the whole report, a blank line, and the changes."""
    with Watch(robot) as watch:
        assert watch.out.until(END).encode() == run(("grade", str(robot))).stdout
        put(URDF, robot)
        assert watch.out.until(BETTER).startswith("grader ")
        assert (
            watch.out.until("\n") == 'hint applied: Move `<origin xyz="0.15 0 0.225" />` (line 34) to after line 40.\n'
        )
        put(SHORT, robot)
        assert watch.out.until(WORSE).startswith("grader ")
        put(SHORT, robot)
        assert watch.out.until("points\n") == "nothing has changed: 64 of 70 points\n"
        put(b"\n" + SHORT.read_bytes(), robot)
        changes = f"{END}\n64 of 70 points, as before; only other parts of the report changed\n"
        assert watch.out.until(changes).startswith("grader ")


def test_a_file_written_in_place(robot: Path) -> None:
    """Whatever is graded meanwhile, the last report is on the whole file."""
    with Watch(robot) as watch:
        watch.out.until(END)
        robot.write_bytes(URDF.read_bytes())
        watch.out.until("\n70/70")


@pytest.mark.parametrize(("source", "code"), [(SHORT, 1), (URDF, 0)])
def test_ctrl_c_ends_it_with_the_last_exit_code(robot: Path, source: Path, code: int) -> None:
    """It ends quietly with the exit code of the last grading, not of the first."""
    with Watch(robot) as watch:
        watch.out.until(END)
        put(URDF, robot)
        watch.out.until(BETTER)
        put(source, robot)
        watch.out.until(WORSE if source == SHORT else "nothing has changed")
        assert watch.interrupt() == code
        assert watch.err.rest() == ""


def test_unreadable_states_are_waited_out(robot: Path) -> None:
    """A file that is removed, too large, or back, also with its folder: one line each, and the comparison continues."""
    with Watch(robot) as watch:
        watch.out.until(END)
        robot.unlink()
        assert watch.err.until("\n") == f"grader: {robot} does not exist: waiting until it does\n"
        shutil.rmtree(robot.parent)
        robot.parent.mkdir()
        put(b" " * 2_000_000, robot)
        assert "is larger than 1048576 bytes" in watch.err.until("\n")
        put(URDF, robot)
        assert "\n70/70" in watch.out.until(BETTER)
        robot.unlink()
        watch.err.until("does not exist")
        assert watch.interrupt() == 2


def test_it_starts_before_the_file_exists(tmp_path: Path) -> None:
    """Neither the file nor its folder has to exist."""
    robot = tmp_path / "later" / "my_robot.urdf"
    with Watch(robot) as watch:
        watch.err.until("does not exist: waiting until it does\n")
        robot.parent.mkdir()
        put(SHORT, robot)
        assert watch.out.until("\n64/70").startswith("grader ")


def test_a_folder_with_saved_reports_in_it(tmp_path: Path) -> None:
    """Whatever is graded counts; the grader's own output does not, to avoid endless rounds."""
    folder = tmp_path / "lab6"
    shutil.copytree(REFERENCE, folder)
    urdf = folder / URDF.relative_to(REFERENCE)
    (folder / "out").mkdir()
    (tmp_path / "link").symlink_to(folder / "out")
    saves = [f"json={folder / 'report.json'}", f"markdown={tmp_path / 'link' / 'report.md'}"]
    with Watch(folder, "--save", saves[0], "--save", saves[1]) as watch:
        watch.out.until(END)
        for source, news in ((SHORT, "now failed"), (URDF, "now passed")) * 3:
            put(source, urdf)
            assert "nothing has changed" not in watch.out.until(f"{news}: lidar-frame (")
            assert '"lidar-frame"' in (folder / "report.json").read_text()
        launch = urdf.parent.parent / "launch"
        launch.rename(launch.with_name("nothing"))
        output = watch.out.until("now failed: ")
        assert "nothing has changed" not in output
        assert "launch" in watch.out.until("\n")


def test_a_replaced_folder(tmp_path: Path) -> None:
    """A submission that is unpacked again is watched from then on."""
    folder = tmp_path / "lab6"
    for name, source in (("lab6", SHORT), ("other", URDF)):
        (tmp_path / name).mkdir()
        shutil.copy(source, tmp_path / name / "my_robot.urdf")
    with Watch(folder, "--part", "task1") as watch:
        watch.out.until(END)
        folder.rename(tmp_path / "old")
        watch.err.until("does not exist")
        (tmp_path / "other").rename(folder)
        watch.out.until(BETTER)
        put(SHORT, folder / "my_robot.urdf")
        watch.out.until(WORSE)


def test_a_rubric_in_a_file_is_watched(robot: Path, tmp_path: Path) -> None:
    """Its mistakes are reported line by line and waited out; the URDF is graded by the current rubric."""
    rubric = tmp_path / "rules" / "lab.toml"
    rubric.parent.mkdir()
    text = (ROOT / "rubrics" / "lab6.toml").read_text()
    rubric.write_text(text)
    with Watch(robot, "--rubric", rubric) as watch:
        watch.out.until("\n64/70")
        put(text.replace("points = 6", "points = -6"), rubric)
        assert "lab.toml:" in watch.err.until("\n")
        put("id = [", rubric)
        watch.err.until("invalid value: id = [")
        put(text.replace('id = "lidar-frame"', 'id = "lidar-place"'), rubric)
        watch.out.until("now failed: lidar-place\nremoved: lidar-frame\n")


def test_closed_standard_output(robot: Path) -> None:
    """One line and exit code 2 at the next output, as anywhere else."""
    rendered, theirs = os.pipe()
    with Watch(robot, stdout=theirs) as watch:
        os.close(theirs)
        text = b""
        while not text.endswith(END.encode()):
            text += os.read(rendered, 65536)
        os.close(rendered)
        put(URDF, robot)
        assert watch.process.wait(HANG_TIMEOUT) == 2
        assert watch.err.rest() == "grader: cannot write the report: standard output: Broken pipe\n"


def refuse(words: str, *arguments: object) -> None:
    """Assert one line that contains the words, and exit code 2; nothing is watched."""
    done = run(("grade", "--watch", *map(str, arguments)))
    assert (done.returncode, done.stdout) == (2, b"")
    message = done.stderr.decode()
    assert message.count("\n") == 1, message
    assert words in message


def test_invalid_combinations_are_refused(robot: Path, tmp_path: Path) -> None:
    """Standard input, reports for programs, and errors that no change of a file would fix."""
    refuse("--watch takes a file or folder", "-")
    refuse("--watch takes a file or folder", "")
    refuse("use --save json=FILE instead of --format", robot, "--format", "json")
    refuse("did you mean 'lab6'?", robot, "--rubric", "lab66")
    refuse("has no part 'task9'", robot, "--part", "task9")
    refuse("--fail-under takes", robot, "--fail-under", "all")
    refuse("--save takes FORMAT=FILE", robot, "--save", "json")


def test_a_report_that_cannot_be_saved_ends_it(robot: Path, tmp_path: Path) -> None:
    """It ends the watch as it ends a single run."""
    done = run(("grade", "--watch", str(robot), "--save", f"json={tmp_path / 'nowhere' / 'a.json'}"))
    assert (done.returncode, done.stdout) == (2, b"")
    assert done.stderr.splitlines()[-1].startswith(b"grader: cannot write")


def counts(path: Path, changed: Path, *own: Path) -> bool:
    """Return whether a change of this path concerns the graded path."""
    watched = Watched(path, None, frozenset(map(os.path.realpath, own)))
    before = _stamps(watched)
    changed.parent.mkdir(parents=True, exist_ok=True)
    parents = _stamps(watched)
    changed.write_text("new")
    after = _stamps(watched)
    changed.unlink()
    assert before.items() <= parents.items()
    return parents != after


def test_which_changes_count_in_a_folder(tmp_path: Path) -> None:
    """All but ignored files and the grader's own output."""
    (tmp_path / "env").mkdir()
    (tmp_path / "env" / "pyvenv.cfg").touch()
    for name in ("my_robot.urdf", "a/b/c.txt", "a/b~", "building/x", "a/env/x", "report.txt"):
        assert counts(tmp_path, tmp_path / name), name
    for name in (
        "ws/build/x.urdf",
        "install/a",
        "log",
        ".git/index",
        ".hidden",
        "a/.b.swp",
        "a/__pycache__/b.pyc",
        "node_modules/a",
        "env/lib/a.py",
        "Thumbs.db",
    ):
        assert not counts(tmp_path, tmp_path / name), name
    (tmp_path / "link").symlink_to(tmp_path / "a")
    assert not counts(tmp_path, tmp_path / "a" / "r.json", tmp_path / "link" / "r.json")
    assert not counts(tmp_path, tmp_path / "link" / "r.json", tmp_path / "a" / "r.json")


def test_which_changes_count_for_a_file(tmp_path: Path) -> None:
    """Only changes of that file and of its symlink's target."""
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
    (tmp_path / "b" / "real.urdf").touch()
    (tmp_path / "a" / "link.urdf").symlink_to(tmp_path / "b" / "real.urdf")
    path = tmp_path / "a" / "link.urdf"
    before = _stamps(Watched(path))
    path.write_text("<robot/>")
    assert _stamps(Watched(path)) != before
    assert not counts(path, tmp_path / "a" / "other.urdf")
    assert not counts(path, tmp_path / "b" / "link.urdf")


def test_an_undecodable_name_is_a_change(tmp_path: Path) -> None:
    """And later changes are noticed."""
    heard = filter(None, changes(Watched(tmp_path)))
    next(heard)
    Path(os.fsdecode(os.fsencode(tmp_path) + b"/\xff.txt")).touch()
    next(heard)
    (tmp_path / "plain.txt").touch()
    next(heard)


def test_only_changes_are_yielded(tmp_path: Path) -> None:
    """At once, and whenever the file was written; a file that was read for the first time is no certain change."""
    robot, part = tmp_path / "my_robot.urdf", tmp_path / "part.xacro"
    put("<robot/>", robot)
    put("<robot/>", part)
    besides: list[Path] = []
    file = changes(Watched(robot, besides=besides))
    assert next(file)
    for text in ("a", "b", "longer"):
        put(text, robot)
        assert next(file)
    besides.append(part)
    assert not next(file)
    put("longer", part)
    assert next(file)


@pytest.mark.parametrize("name", sorted({path.name for path in (ROOT / "submissions").iterdir()})[:20])
def test_all_graded_files_are_watched(name: str) -> None:
    """Every file that is graded counts when it changes."""
    folder = ROOT / "submissions" / name
    assert all(is_looked_at(folder, path) for path in read_folder(folder).files)


def test_an_included_file_is_watched(tmp_path: Path) -> None:
    """A single xacro file is graded again when a file that it includes from its folder changes."""
    folder = tmp_path / "work"
    folder.mkdir()
    text = SHORT.read_text()
    start, end = text.index('<link name="lidar"'), text.index("</robot>")
    opening = '<robot name="my_robot" xmlns:xacro="http://www.ros.org/wiki/xacro">'
    (folder / "parts.xacro").write_text(f"{opening}{text[start:end]}</robot>")
    head = text[text.index("<robot") : start].partition(">")[2]
    (folder / "my_robot.urdf.xacro").write_text(f'{opening}{head}<xacro:include filename="parts.xacro"/></robot>')
    with Watch(folder / "my_robot.urdf.xacro") as watch:
        watch.out.until(END)
        parts = URDF.read_text()
        new = parts[parts.index('<link name="lidar"') : parts.index("</robot>")]
        (folder / "parts.xacro").write_text(f"{opening}{new}</robot>")
        watch.out.until(BETTER)
        assert watch.interrupt() == 0
