"""The cost of a single input: the calls that the command makes, its memory, and messages about limits.

`python -m benchmarks.bounds` measures the times of the same inputs.
"""

import gzip
import io
import json
import random
import subprocess
import sys
import tarfile
import tempfile
import zipfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

import pytest

from tests.classroom.class_runs import environment
from tests.command_line import HANG_TIMEOUT
from tests.samples import ROOT

pytestmark = pytest.mark.exhaustive

MIB = 1024 * 1024
URDF = (ROOT / "rubrics/lab6/my_robot/urdf/my_robot.urdf").read_bytes()
# The calls that a command makes, at least three times what was counted: for a megabyte, and for the reference.
_CALLS, _FEW_CALLS, _MEMORY = 60_000_000, 1_500_000, 200 * MIB


class Cost(NamedTuple):
    """The cost and the output of a command."""

    calls: int
    bytes: int
    code: int
    out: str
    err: str


# An intermediate process, because a child's peak memory starts with that of the process that forked it.
_MEASURED = """
import json, os, subprocess, sys
process = subprocess.Popen(sys.argv[2:])
_, status, used = os.wait4(process.pid, 0)
process.returncode = os.waitstatus_to_exitcode(status)
with open(sys.argv[1], "w") as file:
    json.dump([used.ru_maxrss * 1024, process.returncode], file)
"""
_COUNTED = """
import sys
from pathlib import Path
from grader.__main__ import main
from grader.base import processor_time
from tests.work import limited_work
processor_time.CAN_LIMIT = False  # to count calls takes several times as long as to make them
path = Path(sys.argv.pop(1))
with limited_work() as work:
    try:
        main()
    finally:
        path.write_text(str(work.calls))
"""


def cost(*arguments: str | Path) -> Cost:
    """Run the command line in a process of its own and return its cost."""
    with tempfile.TemporaryDirectory() as folder:
        calls = Path(folder) / "calls"
        used = measured(sys.executable, "-W", "error", "-c", _COUNTED, calls, *arguments)
        return used._replace(calls=int(calls.read_text()))


def bounded(*arguments: str | Path, calls: int = _CALLS, code: int = 1) -> str:
    """Run the command line, fail if it costs more than it may, and return its output with single spaces."""
    used = cost(*arguments)
    assert used.code == code, used.err
    assert used.calls < calls
    assert used.bytes < _MEMORY
    return " ".join((used.out + used.err).split())


def measured(*command: str | Path) -> Cost:
    """Run a command and return its cost, without its calls."""
    with tempfile.TemporaryDirectory() as folder:
        figures = Path(folder) / "figures.json"
        done = subprocess.run(
            [sys.executable, "-c", _MEASURED, str(figures), *map(str, command)],
            env=environment(),
            capture_output=True,
            text=True,
            timeout=HANG_TIMEOUT,
            check=True,
        )
        size, code = json.loads(figures.read_text())
        return Cost(0, size, code, done.stdout, done.stderr)


def filled(piece: Callable[[int], str], size: int = MIB - 300) -> str:
    """Repeat pieces up to a size."""

    def pieces() -> Iterator[str]:
        left, number = size, 0
        while left > 0:
            text = piece(number)
            left, number = left - len(text), number + 1
            yield text

    return "".join(pieces())[:size].rpartition(">")[0] + ">"


def robot(body: str) -> str:
    """Return a URDF with this body."""
    return f'<robot name="r">{body}</robot>'


LOADED = (
    "unknown attributes of one link",
    "a million ampersands",
    "ampersands and references",
)  # into one tree
_HALF = MIB // 2 - 300
URDFS = {
    "unknown attributes": robot(filled(lambda n: f'<link name="a{n}" nme="b"/>')),
    "unknown attributes of one link": robot(
        "<link " + "".join(f'a{n}="" ' for n in range(80_000)) + 'name="a"/>'
    ),
    "many links": robot(filled(lambda n: f'<link name="a{n}"/>')),
    "joints without links": robot(
        filled(lambda n: f'<link name="link{n}"/>', _HALF)
        + filled(
            lambda n: (
                f'<joint name="j{n}" type="fixed"><parent link="link{n}x"/><child link="l{n}"/></joint>'
            ),
            _HALF,
        )
    ),
    "a million ampersands": robot('<link name="' + "&" * 1_000_000 + '"/>'),
    "ampersands and references": robot('<link name="&lt;' + "&" * 500_000 + "&#" * 200_000 + '"/>'),
}


@pytest.mark.parametrize("command", ["inspect", "grade"])
@pytest.mark.parametrize("kind", URDFS)
def test_a_urdf_of_a_megabyte(kind: str, command: str, tmp_path: Path) -> None:
    """Whatever its content, it takes linear work and little memory."""
    (tmp_path / "a.urdf").write_text(URDFS[kind])
    bounded(command, tmp_path / "a.urdf", code=int(command == "grade" or kind not in LOADED))


ROW = '[[criterion]]\nid = "c{0}"\npart = "{1}"\ntitle = "t"\npoints = 1\ncheck = "{2}"\n'
HEAD = 'id = "big"\ntitle = "b"\n[[part]]\nid = "p"\ntitle = "P"\n'
RUBRICS = {
    "criteria": HEAD + "".join(ROW.format(n, "p", "urdf_loads") for n in range(10_000)),
    "requirements": HEAD
    + "".join(
        f'{ROW.format(n, "p", "urdf_loads")}requires = ["c{n - 1}"]\n'.replace('["c-1"]', "[]")
        for n in range(9_000)
    ),
    "unknown parts": HEAD + "".join(ROW.format(n, "q", "urdf_loads") for n in range(9_000)),
    "unknown checks": HEAD + "".join(ROW.format(n, "p", "urdf_load") for n in range(9_000)),
    "unknown requirements": HEAD
    + "".join(f'{ROW.format(n, "p", "urdf_loads")}requires = ["x{n}"]\n' for n in range(9_000)),
    "parts": 'id = "big"\ntitle = "b"\n'
    + "".join(f'[[part]]\nid = "p{n}"\ntitle = "P"\npoints = 1\n' for n in range(7_000))
    + "".join(ROW.format(n, f"p{n}", "urdf_loads") for n in range(7_000)),
    "unknown keys": filled(lambda n: f"a{n} = 1\n").replace(">", ""),
}


@pytest.mark.parametrize("kind", RUBRICS)
def test_a_rubric_of_thousands_of_rows(kind: str, tmp_path: Path) -> None:
    """It is checked with linear work and little memory, mistakes included."""
    (tmp_path / "big.toml").write_text(RUBRICS[kind])
    bounded("rubric", "check", tmp_path / "big.toml", code=2 if kind.startswith("unknown") else 0)


DOCUMENTS = {
    "many files of blank lines": ("\n" * MIB, 30),
    "many files of headings": ("# Task 1 Step 1\n" * 60_000, 30),
    "headings that end nothing": ("foo bar step 15 and more words here so\n" * 26_000, 30),
    "one line": ("a1 " * 340_000, 30),
    "markup": ("- " * 500_000, 30),
}


@pytest.mark.parametrize("kind", DOCUMENTS)
def test_documents_of_a_megabyte(kind: str, tmp_path: Path) -> None:
    """Documents with answers take linear work and little memory together."""
    text, count = DOCUMENTS[kind]
    (tmp_path / "my_robot.urdf").write_bytes(URDF)
    for number in range(count):
        (tmp_path / f"{number}.md").write_text(text)
    bounded("grade", tmp_path)


def tarred(path: Path, files: dict[str, bytes], links: dict[str, str]) -> Path:
    """Make a tar.gz of some files and symlinks."""
    with tarfile.open(path, "w:gz") as archive:
        for name, data in files.items():
            info = tarfile.TarInfo(name)
            info.size = len(data)
            archive.addfile(info, io.BytesIO(data))
        for name, target in links.items():
            info = tarfile.TarInfo(name)
            info.type, info.linkname = tarfile.SYMTYPE, target
            archive.addfile(info)
    return path


@pytest.mark.parametrize(
    "name",
    [
        "{0}.txt",
        "{0}/package.xml",
        "{0}.png",
        "{0}.urdf",
        "/".join("e" * 10 for _ in range(50)) + "/{0}",
    ],
)
def test_symlinks_to_one_folder(name: str, tmp_path: Path) -> None:
    """240 symlinks to a folder of 200 files take bounded work and memory."""
    files = {"my_robot.urdf": URDF} | {f"d/{name.format(n)}": b"x" for n in range(200)}
    bounded("grade", tarred(tmp_path / "lab6.tar.gz", files, {f"l{n}": "d" for n in range(240)}))


def zipped(files: dict[str, bytes]) -> bytes:
    """Make a zip whose members are stored uncompressed."""
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w") as archive:
        for name, content in files.items():
            archive.writestr(name, content)
    return data.getvalue()


def test_archives_in_archives(tmp_path: Path) -> None:
    """Neither their sizes nor their number determines the memory used."""
    noise = random.Random(1).randbytes(60 * MIB)
    inner = zipped({"my_robot.urdf": URDF, "noise.bin": noise})
    (tmp_path / "lab6.zip").write_bytes(
        zipped({f"{n}/in.zip": zipped({"in.zip": inner}) for n in range(3)})
    )
    assert "0/in.zip/in.zip/my_robot.urdf" in bounded(
        "grade", tmp_path / "lab6.zip", calls=_FEW_CALLS
    )


def test_a_class_zip_of_archives_is_read_in_chunks(tmp_path: Path) -> None:
    """A submission is never in memory as a whole."""
    noise = random.Random(1).randbytes(60 * MIB)
    (tmp_path / "class.zip").write_bytes(
        zipped(
            {"ann.zip": zipped({"my_robot.urdf": URDF, **{f"{n}.bin": noise for n in range(4)}})}
        )
    )
    code = (
        "import sys; from grader.classroom.intake.class_files import open_class_submission\n"
        "print(open_class_submission(sys.argv[1], ('ann.zip',), (), 'ann').digest)"
    )
    used = measured(sys.executable, "-c", code, tmp_path / "class.zip")
    assert (used.code, len(used.out)) == (0, 65)
    assert used.bytes < _MEMORY


# --- One large file -----------------------------------------------------------------------------------------------------


def sparse(path: Path, megabytes: int) -> Path:
    """Make a sparse file of so many megabytes."""
    with path.open("wb") as file:
        file.truncate(megabytes * 1_000_000)
    return path


def large_submission(kind: str, path: Path, size: int) -> Path:
    """Write the reference's URDF beside a video of so many bytes, sparse where possible."""
    video = "Task3_Step3.mp4"
    if kind == "folder":
        path.mkdir()
        (path / "my_robot.urdf").write_bytes(URDF)
        sparse(path / video, size // 1_000_000)
    elif kind == "zip":
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr(video, b"")
            archive.writestr("my_robot.urdf", URDF)
            archive.infolist()[0].file_size = size
    else:
        head, small = tarfile.TarInfo(video), tarfile.TarInfo("my_robot.urdf")
        head.size, small.size = size, len(URDF)
        with path.open("wb") as file:
            file.write(head.tobuf())
            file.seek(size + -size % 512, io.SEEK_CUR)
            file.write(small.tobuf() + URDF + bytes(-len(URDF) % 512 + 1024))
        if kind == "tar.gz":
            path.write_bytes(gzip.compress(path.read_bytes(), 0))
    return path


@pytest.mark.parametrize("kind", ["folder", "zip", "tar", "tar.gz"])
def test_a_video_is_ignored_and_named(kind: str, tmp_path: Path) -> None:
    """The rest is graded, the report names the file with its size, and it counts as evidence all the same."""
    size = (
        100_000_000 if kind == "tar.gz" else 600_000_000
    )  # what is decompressed has to be written first
    path = large_submission(kind, tmp_path / f"lab6.{kind}", size)
    output = bounded("grade", path, "--part", "task1", "--part", "task3", calls=_FEW_CALLS, code=0)
    ignored = f"'Task3_Step3.mp4' ({size // 1_000_000} MB) is larger than 64 MiB, the limit for one file, and was ignored"
    for words in (ignored, "evidence-webcam (2): Task3_Step3.mp4", "70/72"):
        assert words in output


def test_a_compressed_tar_is_read_to_a_limit(tmp_path: Path) -> None:
    """An ignored file must be decompressed all the same, up to a limit that the message names."""
    path = large_submission("tar.gz", tmp_path / "plain.tar.gz", 80_000_000)
    packed = tmp_path / "lab6.tar.gz"
    packed.write_bytes(gzip.compress(gzip.decompress(path.read_bytes())))
    output = bounded("grade", packed, calls=_FEW_CALLS, code=2)
    assert "would unpack to more than 32 MiB, the limit for an archive, and was not read" in output
