"""grader grade --watch: which changes are graded, the first lines, and the end."""

import json
import os
import pty
import re
import shutil
import signal
import subprocess
import sys
import termios
import time
from collections.abc import Callable, Sequence
from functools import partial
from itertools import cycle
from pathlib import Path
from types import SimpleNamespace
from typing import NamedTuple

import pytest

from grader.app.cli.streams import TERMINAL
from grader.app.commands.repeating import changes, repeat_on_change
from grader.app.grading import GradeRequest, GradeRun, grade_request
from grader.base.processor_time import CAN_LIMIT
from grader.report.screen import Screen
from grader.report.writing import Warn
from tests.classroom.class_runs import shell_code, started
from tests.cli.terminals import needs_terminal
from tests.command_line import HANG_TIMEOUT, ROOT, clean_environment, run

REFERENCE = ROOT / "submissions/lab6/reference"
URDF = REFERENCE / "roscourse_sim_ws/src/my_robot/urdf/my_robot.urdf"  # 70 of 70
SHORT = ROOT / "submissions/lab6/lidar-offset-in-visual/my_robot/urdf/my_robot.urdf"  # 64 of 70
BETTER = "\n64 -> 70 of 70 points (+6)\nnow passed: lidar-frame (+6)\n"
WORSE = "\n70 -> 64 of 70 points (-6)\nnow failed: lidar-frame (-6)\n"
END = "  IRP Lab 6: a wheeled base\n"  # of a report
NEXT = "\0 next\n"
Watch = Callable[..., "Rounds"]


class Rounds(NamedTuple):
    """What a watch printed after each change on standard output and standard error, the start first, and its exit code."""

    out: list[str]
    err: list[str]
    code: int


@pytest.fixture
def watch(monkeypatch: pytest.MonkeyPatch) -> Callable[..., Rounds]:
    """Return a function that watches while files change, one change after the other, and presses Ctrl-C then."""

    def run_watch(
        arguments: Sequence[object], *edits: Callable[[], object], command: str = "grade"
    ) -> Rounds:
        waiting, looks = (
            iter(edits),
            cycle(range(3)),
        )  # a change is seen at the first look, and graded at the second

        def sleep(_seconds: float) -> None:
            if next(looks) == 0:
                sys.stdout.write(NEXT)
                sys.stdout.flush()
                sys.stderr.write(NEXT)
                sys.stderr.flush()
                edit = next(waiting, None)
                if edit is None:
                    raise KeyboardInterrupt
                edit()

        clock = SimpleNamespace(
            sleep=sleep, monotonic=time.monotonic, strftime=lambda _: "12:00:00"
        )
        monkeypatch.setattr("grader.app.commands.repeating.time", clock)
        done = run((command, "--watch", *map(str, arguments)))
        out, err = (stream.decode().split(NEXT) for stream in (done.stdout, done.stderr))
        assert (len(out), out[-1], err[-1]) == (len(edits) + 2, "", "grader: interrupted\n"), done
        return Rounds(out[:-1], err[:-1], done.returncode)

    return run_watch


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


def test_each_round_ends_with_the_changes(robot: Path, watch: Watch) -> None:
    """The first report is that of grade; then a rule with the time, the whole report, a blank line, and the changes."""
    changed = b"\n" + SHORT.read_bytes()
    sources: tuple[Path | bytes, ...] = (URDF, SHORT, SHORT, changed, URDF)
    done = watch([robot], *(partial(put, source, robot) for source in sources))
    first, better, worse, same, other, last = done.out
    assert first.encode() == run(("grade", str(SHORT))).stdout.replace(
        str(SHORT).encode(), str(robot).encode()
    )
    rule = "-- 12:00:00 " + "-" * 68 + "\nlab6: "
    assert (better.startswith(rule), better.partition(BETTER)[1:]) == (True, (BETTER, ""))
    assert (worse.startswith(rule), worse.partition(WORSE)[1:]) == (True, (WORSE, ""))
    assert same.endswith(f"{END}\n64 -> 64 of 70 points\n")
    assert other.endswith(f"{END}\n64 -> 64 of 70 points\n")
    assert last.startswith(rule)
    assert done.err == [f"grader: watching {robot}; stop with Ctrl-C\n", "", "", "", "", ""]
    assert done.code == 130


def test_unreadable_states_are_waited_out(robot: Path, watch: Watch) -> None:
    """A file that is not there yet, removed, too large, or back, also with its folder: one line each; the comparison continues."""

    def replace_folder() -> None:
        shutil.rmtree(robot.parent)
        robot.parent.mkdir()
        put(b" " * 2_000_000, robot)

    robot.unlink()
    first = partial(put, SHORT, robot)
    done = watch(
        [robot], first, robot.unlink, replace_folder, partial(put, URDF, robot), robot.unlink
    )
    gone = f"grader: {robot} does not exist\n"
    assert done.err[0].endswith(gone)
    assert (done.err[1], done.err[2], done.err[4], done.err[5]) == ("", gone, "", gone)
    assert "is larger than 1 MiB" in done.err[3]
    assert (done.out[0], done.out[2], done.out[3], done.out[5], done.code) == ("", "", "", "", 130)
    assert "\n64/70" in done.out[1]
    assert "\n70/70" in done.out[4]
    assert BETTER in done.out[4]


@pytest.mark.slow
def test_a_folder_with_saved_reports_in_it(tmp_path: Path, watch: Watch) -> None:
    """Whatever is graded counts; the grader's own output does not, to avoid endless rounds."""
    folder = tmp_path / "lab6"
    shutil.copytree(REFERENCE, folder)
    urdf = folder / URDF.relative_to(REFERENCE)
    (folder / "out").mkdir()
    (tmp_path / "link").symlink_to(folder / "out")
    launch = urdf.parent.parent / "launch"
    saves = [
        f"--save=json={folder / 'report.json'}",
        f"--save=markdown={tmp_path / 'link' / 'report.md'}",
    ]
    edits = (
        partial(put, SHORT, urdf),
        partial(put, URDF, urdf),
        partial(launch.rename, launch.with_name("nothing")),
    )
    done = watch([folder, *saves], *edits)
    for shown, news in zip(
        done.out[1:],
        ("now failed: lidar-frame (", "now passed: lidar-frame (", "now failed: "),
        strict=True,
    ):
        assert news in shown
    assert "launch" in done.out[-1].partition("now failed: ")[2]
    assert '"lidar-frame"' in (folder / "report.json").read_text()


@pytest.mark.slow
def test_a_rubric_in_a_file_is_watched(robot: Path, tmp_path: Path, watch: Watch) -> None:
    """Its mistakes are reported line by line and waited out; the URDF is graded by the current rubric."""
    rubric = tmp_path / "rules" / "lab.toml"
    rubric.parent.mkdir()
    text = (ROOT / "rubrics/lab6/rubric.toml").read_text()
    rubric.write_text(text)
    renamed = text.replace('id = "lidar-frame"', 'id = "lidar-place"')
    texts = text.replace("points = 6", "points = -6"), "id = [", renamed
    done = watch([robot, "--rubric", rubric], *(partial(put, new, rubric) for new in texts))
    assert "\n64/70" in done.out[0]
    assert "lab.toml:" in done.err[1]
    assert "invalid value: id = [" in done.err[2]
    assert done.out[3].endswith("now failed: lidar-place\n")


def test_an_included_file_is_watched(tmp_path: Path, watch: Watch) -> None:
    """A single xacro file is graded again when a file that it includes from its folder changes."""
    opening = '<robot name="my_robot" xmlns:xacro="http://www.ros.org/wiki/xacro">'
    lidar = '<link name="lidar"'
    parts, robot = tmp_path / "parts.xacro", tmp_path / "my_robot.urdf.xacro"

    def put_parts(source: Path) -> None:
        text = source.read_text()
        put(f"{opening}{text[text.index(lidar) : text.index('</robot>')]}</robot>", parts)

    text = SHORT.read_text()
    head = text[text.index("<robot") : text.index(lidar)].partition(">")[2]
    robot.write_text(f'{opening}{head}<xacro:include filename="parts.xacro"/></robot>')
    put_parts(SHORT)
    done = watch([robot], partial(put_parts, URDF))
    assert BETTER in done.out[1]
    assert done.code == 130


@pytest.mark.parametrize(("look", "pause"), [(0.001, 0.2), (0.02, 0.2), (0.05, 0.5), (0.5, 5)])
def test_a_pause_follows_the_time_of_a_look_alone(
    robot: Path, monkeypatch: pytest.MonkeyPatch, look: float, pause: float
) -> None:
    """However long the work and its report take, the next change is seen as soon as after a rest."""
    now, pauses, rounds = 0.0, [], []

    def monotonic() -> float:
        nonlocal now
        now += look  # between two readings of the clock
        return now

    def take(seconds: float) -> None:
        nonlocal now
        now += seconds

    def sleep(seconds: float) -> None:
        take(seconds)
        pauses.append(seconds)
        if len(pauses) == 7:
            raise KeyboardInterrupt
        if len(pauses) in (1, 4):
            put(f"<robot name='{len(pauses)}'/>", robot)

    def work() -> tuple[str, list[Path]]:
        take(60)
        return robot.read_text(), []

    def show(text: str) -> None:
        take(3)
        rounds.append((text, len(pauses)))

    clock = SimpleNamespace(sleep=sleep, monotonic=monotonic)
    monkeypatch.setattr("grader.app.commands.repeating.time", clock)
    first = robot.read_text()
    with pytest.raises(KeyboardInterrupt):
        repeat_on_change([robot.parent], [], TERMINAL, 60, work, show)
    assert pauses == pytest.approx([pause] * 7)
    # A change is graded at the second look after it.
    assert rounds == [(first, 0), ("<robot name='1'/>", 2), ("<robot name='4'/>", 5)]


SEVERAL = ROOT / "submissions/lab6/several-mistakes/my_robot/urdf/my_robot.urdf"
CLEAR = "\x1b[H\x1b[2J"
FIXED = ('xyz="0.15 0 0.2"', 'xyz="0.15 0 0.225"')


@pytest.fixture
def on_a_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    """Make standard output a terminal of 80 columns and 24 rows."""
    screen = Screen(80, is_terminal=True, rows=24)
    for command in ("grade", "inspect"):
        monkeypatch.setattr(
            f"grader.app.cli.{command}.TERMINAL", TERMINAL._replace(screen=lambda: screen)
        )


def rows_of(output: str) -> list[str]:
    """Return the rows that a terminal shows, without colours, after it is cleared once."""
    before, _, text = output.partition(CLEAR)
    assert (before, CLEAR in text) == ("", False)
    return re.sub(r"\x1b\[[0-9;]*m", "", text).splitlines()


@pytest.mark.usefixtures("on_a_terminal")
def test_a_terminal_shows_the_first_mistake_and_what_changed(robot: Path, watch: Watch) -> None:
    """In 24 rows the first mistake is whole, with its place, line and hint, and what changed; a file that is not there is said alone."""
    put(SEVERAL, robot)
    better = SEVERAL.read_text().replace(*FIXED, 1)
    done = watch([robot], partial(put, better, robot), robot.unlink, partial(put, SEVERAL, robot))
    first, second, gone, third = map(rows_of, done.out)
    assert [len(rows) for rows in (first, second, third)] == [23, 23, 23]
    rule = "-- 12:00:00 Ctrl-C ends "
    assert all(rows[0] == rule.ljust(80, "-") for rows in (first, second, gone, third))
    assert "✗ -8 points: lidar-frame 6, lidar-on-top 2  my_robot.urdf:39:15" in " ".join(first[2:6])
    assert "  Check line 39: z of the joint origin of 'lidar'." in first
    assert first[-1] == "43/70  IRP Lab 6: a wheeled base"
    assert "✗ -7 points: right-wheel-forward 6, right-wheel-axis 1" in " ".join(second[2:6])
    assert "  the sign of the roll of the joint origin of 'right_wheel'." in second
    assert re.fullmatch(r"\.\.\. \d+ more rows without --watch, or with --verbose", second[-6])
    assert second[-2:] == [
        "43 -> 51 of 70 points (+8)",
        "now passed: lidar-frame (+6) and lidar-on-top (+2)",
    ]
    assert (gone[1:], done.err[2]) == ([], f"grader: {robot} does not exist\n")
    assert third[-2].startswith("51 -> 43 of 70 points")


@pytest.mark.usefixtures("on_a_terminal")
def test_verbose_shows_all_on_a_terminal(robot: Path, watch: Watch) -> None:
    """What is asked for in full is not cut, nor what fits."""
    put(SEVERAL, robot)
    whole = rows_of(watch([robot, "--verbose"]).out[0])
    assert len(whole) > 60
    put(URDF, robot)
    fitting = rows_of(watch([robot]).out[0])
    assert len(fitting) < 23
    assert not any("more rows" in row for row in (*whole, *fitting))


@needs_terminal
@pytest.mark.parametrize(("kind", "is_terminal"), [("xterm", True), ("dumb", False)])
def test_a_terminal_without_commands_is_written_as_a_pipe(
    kind: str, is_terminal: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It has its size, and is not cleared."""
    outer, inner = pty.openpty()
    termios.tcsetwinsize(inner, (30, 100))
    with open(outer, "rb"), open(inner, "w") as terminal:
        monkeypatch.setattr("sys.stdout", terminal)
        monkeypatch.setenv("TERM", kind)
        shown = TERMINAL.screen()
    assert (shown.width, shown.rows, shown.is_terminal) == (100, 30, is_terminal)


@pytest.mark.slow
def test_ctrl_c_and_a_closed_standard_output_end_the_process(robot: Path) -> None:
    """Ctrl-C ends it quietly; output that is closed, with one line and exit code 2 at the next output."""
    with started("grade", "--watch", robot) as process:
        assert process.stderr is not None
        assert process.stderr.readline().endswith("stop with Ctrl-C\n")
        process.send_signal(signal.SIGINT)
        _, err = process.communicate(timeout=HANG_TIMEOUT)
        assert shell_code(process.returncode) == 130
        assert set(err.splitlines()) <= {"grader: interrupted"}
    read, written = os.pipe()
    command = [sys.executable, "-m", "grader", "grade", "--watch", str(robot)]
    with subprocess.Popen(
        command, cwd=ROOT, env=clean_environment(), stdout=written, stderr=subprocess.PIPE
    ) as watched:
        os.close(written)
        text = b""
        while not text.endswith(END.encode()):
            text += os.read(read, 65536)
        os.close(read)
        put(URDF, robot)
        _, error = watched.communicate(timeout=HANG_TIMEOUT)
    assert (watched.returncode, error.splitlines()[1:]) == (
        2,
        [b"grader: cannot write the report: standard output: Broken pipe"],
    )


@pytest.mark.slow
@pytest.mark.skipif(not CAN_LIMIT, reason="has no limits of processor time")
def test_a_round_that_takes_too_long_is_reported(
    robot: Path, watch: Watch, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The next change is graded again, and compared with what was graded last."""
    monkeypatch.setattr("grader.app.commands.watch.GRADE_SECONDS", 5)

    def grade_or_hang(request: GradeRequest, warn: Warn) -> GradeRun:
        hangs = robot.read_bytes() == b"hangs"
        while hangs:
            pass
        return grade_request(request, warn)

    monkeypatch.setattr("grader.app.commands.watch.grade_request", grade_or_hang)
    done = watch([robot], partial(put, b"hangs", robot), partial(put, URDF, robot))
    assert done.err[1:] == ["grader: this takes more than 5 s of processor time\n", ""]
    assert (done.out[1], BETTER in done.out[2]) == ("", True)


def test_an_inspection_is_repeated(tmp_path: Path, watch: Watch) -> None:
    """The first one is that of inspect; then a rule with the time, and the whole one; reports are saved each time."""
    robot, report = tmp_path / "a.urdf", tmp_path / "a.sarif"
    texts = [f"<robot name='a'><link name='b'/>{more}</robot>" for more in ("", "<link/>", "<")]
    robot.write_text(texts[0])
    saved = []

    def edit(text: str) -> None:
        saved.append(json.loads(report.read_text(encoding="utf-8"))["runs"][0]["results"])
        put(text, robot)

    arguments = [robot, "--save", f"sarif={report}"]
    edits = [partial(edit, text) for text in (*texts[1:], texts[0])]
    done = watch(arguments, *edits, robot.unlink, command="inspect")
    outputs = []
    for text in (*texts, texts[0]):
        put(text, robot)
        outputs.append(run(("inspect", str(robot))).stdout.decode())
    rule = "-- 12:00:00 " + "-" * 68 + "\n"
    assert done.out == [outputs[0], *(rule + text for text in outputs[1:]), ""]
    assert [[result["ruleId"] for result in results] for results in saved] == [
        [],
        ["URDF080", "URDF030"],
        ["URDF001"],
    ]
    start, *rest, gone = done.err
    assert start == f"grader: watching {robot}; stop with Ctrl-C\n"
    assert "does not exist" in gone
    assert (rest, done.code) == (["", "", ""], 130)


@pytest.mark.parametrize("is_changed", [True, False])
def test_a_change_while_a_file_is_read_for_the_first_time_is_seen(
    tmp_path: Path, is_changed: bool
) -> None:
    """Which files are read besides is known only afterwards; one that changed meanwhile is read again, once."""
    first, besides = tmp_path / "first.xacro", tmp_path / "part.xacro"
    for file in (first, besides):
        file.write_text("old")
    time.sleep(0.05)  # the clock of the file system is a little behind
    looks = iter(range(8))

    def wait(_seconds: float) -> object:
        if next(looks, None) is None:
            raise KeyboardInterrupt
        return None

    reads = []
    with pytest.raises(KeyboardInterrupt):
        for read in changes([first], (), 0.0, wait):
            reads.append(besides.read_text())
            read[:] = [besides]
            if is_changed and len(reads) == 1:
                besides.write_text("new")
    assert reads == (["old", "new"] if is_changed else ["old"])
