"""Every command that prints has the same output twice: on one processor and two, in other folders, locales and time zones.

Each session of commands runs in processes of its own, in each of the circumstances below; output, exit codes and written files
are equal. Only the time of a run, its zone and progress are not compared.
"""

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import NamedTuple

import pytest

from grader.report.formats import Format, GraphFormat, InspectFormat
from tests.command_line import GRADER, HANG_TIMEOUT, PROGRESS, ROOT, clean_environment
from tests.examples import light

_DAYS = "|".join(f"{datetime.now(UTC) + timedelta(days):%Y-%m-%d}" for days in (-1, 0, 1))
_NOW = re.compile(rf"({_DAYS})[T ]\d\d:\d\d(:\d\d(\.\d+)?)?(\s+\(UTC[^)]*\)\s*)?".encode())
# What a gradebook keeps for later runs: one line a result, in the order in which they are ready, and absolute paths.
_STATE = ("results.jsonl", "reports.jsonl")
_SAMPLES = {
    "lab": "submissions/lab6/several-mistakes",
    "broken": "submissions/lab6/broken-tag-parent",
    "ws": "submissions/diffdrive/spawner-misspelt",
    "right": "rubrics/diffdrive",
    "sensors": "rubrics/sensors",
    "files": "submissions/class/files",
    "class": "submissions/class",
}


class Circumstances(NamedTuple):
    """In what a command runs that no output may depend on."""

    folder: str  # below a temporary one
    variables: Mapping[str, str]
    processors: int
    is_busy: bool = False  # whether another program computes meanwhile


_USUAL = Circumstances(
    "work", {"PYTHONHASHSEED": "0", "TZ": "UTC", "LC_ALL": "C.UTF-8"}, processors=2
)
_OTHERS = (
    Circumstances(
        "deep/in another/folder",
        {"PYTHONHASHSEED": "4242", "TZ": "Asia/Kolkata", "LC_ALL": "C"},
        processors=1,
        is_busy=True,
    ),
    Circumstances(
        "w",
        {"PYTHONHASHSEED": "7", "TZ": "America/St_Johns", "LC_ALL": "tr_TR.UTF-8"},
        processors=2,
    ),
)


class Session(NamedTuple):
    """Commands that run one after the other in a folder with samples; some write what others read."""

    name: str
    commands: tuple[str, ...]


def _formats(command: str, formats: type[Format | InspectFormat | GraphFormat]) -> tuple[str, ...]:
    return tuple(f"{command} --format {name}" for name in formats)


_BATCH = "batch files --gradebook book --roster class/roster.csv --due 2026-11-20T23:59+01:00"
_SESSIONS = (
    Session(
        "quick",
        (
            "grade lab --format json",
            "inspect ws --format json",
            "graph right --format json",
            "explain REF004",
        ),
    ),
    Session("grade", (*_formats("grade lab", Format), *_formats("grade broken", Format))),
    Session("grade nodes", _formats("grade ws --rubric diffdrive", Format)),
    Session(
        "grade to files", ("grade lab --save html=a.html --save svg=a.svg --save junit=a.xml",)
    ),
    Session("inspect", _formats("inspect ws", InspectFormat)),
    Session("inspect a robot", _formats("inspect lab", InspectFormat)),
    Session("graph", _formats("graph right", GraphFormat)),
    Session(
        "class",
        (
            f"{_BATCH} --format json",
            "mark hazel stands-on-ground 1 --comment seen --by ann",
            f"{_BATCH} --force",
            "export csv",
            "export json",
            "export html --output pages",
            "export canvas",
            "stats",
            "stats --format json",
            "diff book",
            "diff book --format json",
            "rubric review book",
        ),
    ),
    Session(
        "rubrics",
        (
            "rubric list",
            "rubric show diffdrive",
            "rubric checks",
            "rubric check sensors/rubric.toml",
            "rubric new draft.toml --from right/diffdrive_robot",
            "rubric check draft.toml",
            "rubric new arm.toml --from sensors",
            "rubric copy rover copied",
        ),
    ),
    Session("rubric test", ("rubric test lab6 --format json", "rubric test rover")),
    Session(
        "rubric test of a draft",
        ("rubric new draft.toml --from right/diffdrive_robot", "rubric test draft.toml"),
    ),
    Session(
        "explanations",
        (
            *(f"schema {name}" for name in ("report", "rubric", "inspect", "class", "diff")),
            *(f"schema {name}" for name in ("rubric-test", "graph")),
            "explain URDF012",
            "explain frame_at",
            "explain lidar-frame",
            "explain ekf_node.frequency",
            "--help",
            "grade --help",
        ),
    ),
    Session("bundle", ("bundle gradescope --output bundle.zip --rubric lab6",)),
)


@contextmanager
def _in(circumstances: Circumstances) -> Iterator[None]:
    """Let programs start on so many processors, and beside one that computes, if it is asked for."""
    processors = os.sched_getaffinity(0)
    os.sched_setaffinity(0, sorted(processors)[: circumstances.processors])
    busy = []
    try:
        if circumstances.is_busy:
            busy.append(subprocess.Popen([sys.executable, "-c", "while True: pass"]))
        yield
    finally:
        os.sched_setaffinity(0, processors)
        for process in busy:
            process.kill()
            process.wait()


def _outputs(session: Session, circumstances: Circumstances, top: Path) -> dict[str, bytes]:
    """Return what the commands print, with their exit codes, and the files that they write."""
    folder = top / circumstances.folder
    folder.mkdir(parents=True)
    for name, source in _SAMPLES.items():
        shutil.copytree(ROOT / source, folder / name)
    given = {path for path in folder.rglob("*") if path.is_file()}
    found = {}
    with _in(circumstances):
        for command in session.commands:
            done = subprocess.run(
                [*GRADER, *command.split()],
                cwd=folder,
                env={**clean_environment(), **circumstances.variables},
                capture_output=True,
                check=False,
                timeout=HANG_TIMEOUT,
            )
            told = PROGRESS.sub("", done.stderr.decode()).encode()
            output = b"%d\n%b\n%b" % (done.returncode, done.stdout, told)
            found[command] = _NOW.sub(b"NOW", output)
    for path in sorted({path for path in folder.rglob("*") if path.is_file()} - given):
        if path.name not in _STATE:
            found[path.relative_to(folder).as_posix()] = _NOW.sub(b"NOW", path.read_bytes())
    return found


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="needs a choice of processors")
@pytest.mark.parametrize(
    "session",
    light(_SESSIONS, lambda session: session.name != "quick"),
    ids=lambda session: session.name,
)
def test_the_output_is_equal_in_other_circumstances(session: Session, tmp_path: Path) -> None:
    """On one processor beside a busy program, with another hash seed, locale, time zone and folder."""
    usual = _outputs(session, _USUAL, tmp_path / "usual")
    for number, others in enumerate(_OTHERS):
        outputs = _outputs(session, others, tmp_path / str(number))
        assert outputs.keys() == usual.keys()
        assert [name for name, text in outputs.items() if text != usual[name]] == [], others
    assert all(usual[command].strip() for command in session.commands)
