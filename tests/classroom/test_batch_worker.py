"""The result of one submission: whether it could be read does not depend on the folder or archive around it."""

import io
import json
import shutil
import zipfile
from pathlib import Path

import pytest

from grader.classroom.results.results import StoredResult
from grader.classroom.run.batch_worker import ClassContext, Task, grade_all
from grader.lab.checks.outcome import Outcome, failed, how_far_off, judged, measured, measured_point
from tests.classroom.class_runs import report_in_process
from tests.samples import LAB6, ROOT

pytestmark = pytest.mark.slow

URDF = (ROOT / "submissions/lab6/lidar-buried/my_robot/urdf/my_robot.urdf").read_bytes()
LARGE = URDF + b" " * 1024 * 1024


def zipped(files: dict[str, bytes]) -> bytes:
    """Make a zip with these files."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for name, data in files.items():
            archive.writestr(name, data)
    return buffer.getvalue()


def damaged(name: str) -> bytes:
    """Make a zip in which one file of this name has a wrong checksum."""
    data = zipped({name: URDF})
    start = data.index(b"<robot")
    return data[:start] + b"<R" + data[start + 2 :]


CUT = zipped({"a.urdf": URDF})[:-30]
UNREADABLE = {
    "cut": ("lab6.zip", CUT, "lab6.zip cannot be read as an archive: File is not a zip file"),
    "garbage": ("lab6.zip", b"garbage", "lab6.zip is not a readable archive"),
    "rar": ("lab6.rar", b"Rar!\x1a\x07\x00", "lab6.rar is a rar archive, which is not supported"),
    "empty": ("lab6.zip", zipped({}), "lab6.zip is empty"),
    "checksum": ("lab6.zip", damaged("a.urdf"), "a.urdf: Bad CRC-32"),
    "large": ("a.urdf", LARGE, "a.urdf is larger than 1 MiB, the limit for a URDF"),
    "large-in-a-zip": (
        "lab6.zip",
        zipped({"a.urdf": LARGE}),
        "a.urdf is larger than 1 MiB, the limit for a",
    ),
    "nested": ("lab6.zip", zipped({"b.zip": CUT}), "b.zip cannot be read as an archive"),
}


def graded(top: Path, *paths: str) -> StoredResult:
    """Return the result of a submission below a folder."""
    (result,) = grade_all(
        ClassContext((str(top),), LAB6.data, str(LAB6.path)), [Task("ann", 0, paths)]
    )
    return result


@pytest.mark.parametrize("kind", UNREADABLE)
@pytest.mark.parametrize("wrapped", ["", "ann/", "ann/src/lab/"])
def test_the_folder_around_it_does_not_matter(kind: str, wrapped: str, tmp_path: Path) -> None:
    """A file that cannot be read alone cannot be read in a folder; the reason names it."""
    name, data, reason = UNREADABLE[kind]
    folder = tmp_path / "class" / wrapped / name
    folder.parent.mkdir(parents=True)
    folder.write_bytes(data)
    top = tmp_path / "class"
    result = graded(top, wrapped.partition("/")[0] or name)
    assert (result.verdict, reason in result.reason.replace("'", "")) == ("unreadable", True), (
        result.reason
    )
    assert ("(--max-size raises it)" in result.reason) == kind.startswith("large")
    assert str(tmp_path) not in result.reason


def test_each_unreadable_file_has_its_own_digest(tmp_path: Path) -> None:
    """It is that of its bytes: a mark for one that cannot be read is older than another such file."""
    (tmp_path / "ann.zip").write_bytes(CUT)
    first = graded(tmp_path, "ann.zip")
    (tmp_path / "ann.zip").write_bytes(CUT + b" ")
    second = graded(tmp_path, "ann.zip")
    assert (
        (first.verdict, first.reason)
        == (second.verdict, second.reason)
        == ("unreadable", first.reason)
    )
    assert first.digest != second.digest


def test_a_folder_has_the_same_report(tmp_path: Path) -> None:
    """Points, pending criteria and messages of a folder equal those of `grader grade`."""
    shutil.copytree(ROOT / "submissions/lab6/reference", tmp_path / "ann")
    (urdf,) = (tmp_path / "ann").rglob("*.urdf")
    urdf.write_bytes(LARGE)
    result = graded(tmp_path, "ann")
    _, alone = report_in_process(tmp_path / "ann", tmp_path / "alone.json")
    reported = json.loads(alone)
    assert (result.verdict, result.reason.partition(" is ")[0]) == (
        "unreadable",
        str(urdf.relative_to(tmp_path / "ann")),
    )
    statuses = {row["id"]: (row["points"], row["status"]) for row in reported["results"]}
    found = {name: (points or 0, status) for name, (points, status, *_) in result.results.items()}
    assert found == statuses
    assert sum(points for points, _ in found.values()) > 0
    assert (
        grade_all(
            ClassContext((str(tmp_path),), LAB6.data, str(LAB6.path)),
            [Task("ann", 0, ("ann",), graded=result.digest)],
        )[0].verdict
        == "unchanged"
    )


@pytest.mark.parametrize(
    "files",
    [
        {"lab6.zip": CUT, "a.urdf": URDF},
        {"lab6.zip": CUT, "my_robot/package.xml": b"<package/>"},
        {"lab6.zip": zipped({"a.urdf": URDF}), "other.zip": CUT},
        pytest.param({"report.pdf": b"%PDF"}, marks=pytest.mark.exhaustive),
        {"lab6.zip": zipped({}), "answers.txt": b"1. The root is base_footprint."},
    ],
    ids=["urdf", "package", "archive", "pdf", "answers"],
)
def test_readable_files_are_graded(files: dict[str, bytes], tmp_path: Path) -> None:
    """Files beside a damaged archive are graded, and so is an empty folder."""
    for name, data in files.items():
        folder = tmp_path / "ann" / name
        folder.parent.mkdir(parents=True, exist_ok=True)
        folder.write_bytes(data)
    assert (graded(tmp_path, "ann").verdict, graded(tmp_path, "ann").reason) == ("graded", "")


def test_several_archives_are_counted(tmp_path: Path) -> None:
    """The first is named with its error."""
    (tmp_path / "ann").mkdir()
    for name in ("a.zip", "b.zip", "c.zip"):
        (tmp_path / "ann" / name).write_bytes(b"garbage")
    assert graded(tmp_path, "ann").reason == (
        "nothing to grade was found: 'a.zip' is not a readable archive: it is damaged or empty "
        "(and 2 more cannot be opened)"
    )


def test_a_submission_without_its_documents(tmp_path: Path) -> None:
    """Answers need manual grading, and the result says why; all other criteria have their points."""
    shutil.copytree(ROOT / "submissions/lab6/several-mistakes", tmp_path / "ann")
    (tmp_path / "ann/answers.md").write_text("Task 1 step 15: It vanishes.\n")
    context = ClassContext((str(tmp_path),), LAB6.data, str(LAB6.path))
    whole, without = (
        grade_all(context, [Task("ann", 0, ("ann",), no_documents=why)])[0]
        for why in ("", "it took long")
    )
    assert (without.verdict, without.no_documents, without.texts) == ("graded", "it took long", {})
    assert {
        name: entry[0] for name, entry in without.results.items() if name != "evidence-webcam"
    } == {name: entry[0] for name, entry in whole.results.items() if name != "evidence-webcam"}
    assert without.results["answer-launch-nodes"][:2] == (None, "pending")


def test_a_submission_that_has_no_documents_is_not_tried_without(tmp_path: Path) -> None:
    """Nothing would be different: the reason is that of the first time, and so is its limit of time."""
    (tmp_path / "ann.urdf").write_bytes(URDF)
    context = ClassContext((str(tmp_path),), LAB6.data, str(LAB6.path))
    [whole, lost] = grade_all(
        context,
        [
            Task("ann", 0, ("ann.urdf",)),
            Task("ann", 0, ("ann.urdf",), no_documents="it took long", reached=20),
        ],
    )
    assert (lost.verdict, lost.reason, lost.timeout) == ("errored", "it took long", 20)
    assert (lost.digest, lost.no_documents) == (whole.digest, "")


@pytest.mark.parametrize(
    ("outcome", "off"),
    [
        (measured("it is", 0.2, 0.1, 0.002), 0.1),
        (measured("it is", 0.1, 0.1, 0.002), None),
        (measured("it is", float("nan"), 0.1, 0.002), None),
        (measured_point("it is", (0.0, 0.1, 0.0), (0.3, 0.0, 0.0), 0.002, "base"), 0.3),
        (judged(False, "it is", 0.2, 0.2, 0.002, "m"), None),
        (judged(False, "it is", "red", "green", None, "m"), None),
        (judged(False, "it is", 2.0, 1.0, 0.1, "kg"), None),
        (failed("it is not there"), None),
    ],
)
def test_how_far_a_length_is_off(outcome: Outcome, off: float | None) -> None:
    """Only of a length or a point that is measured in metres and out of its tolerance; the largest difference counts."""
    assert how_far_off(outcome) == (off if off is None else pytest.approx(off))
