"""Comments, settings and options by which an inspection leaves out problems, and which no grading obeys."""

import json
import re
import shutil
from pathlib import Path

import pytest

from grader.app.settings import read_settings
from grader.base.ignore_comments import read_ignore_comments
from tests.classroom.gradebooks import grader
from tests.command_line import ROOT, run

RAW = ROOT / "submissions/lab6/raw-xacro/my_robot.urdf"
# A file, its text, and the lines and codes of each comment: from where it is to the last line whose problems it ignores.
COMMENTS = [
    ("a.py", "x = 1  # grader:ignore REF001\n", [(1, 1, "REF001")]),
    ("a.py", "x = 1  # why: grader:ignore REF001, LCH,PKG0 and more\n", [(1, 1, "REF001 LCH PKG0")]),
    ("a.py", "  # grader:ignore REF001\nx = 1\n", [(1, 2, "REF001")]),
    ("a.py", "x = 'grader:ignore REF001'\n", []),
    ("a.py", "# grader: ignore REF001\n# grader:ignored REF001\n", []),
    ("a.py", "# grader:ignore ref001\n", [(1, 2, "")]),
    ("a.py", "# grader:ignore REF001", [(1, 1, "REF001")]),
    ("a.py", "\ufeff# grader:ignore REF001\r\nx = 1\r\n", [(1, 2, "REF001")]),
    ("a.yaml", "a:  # grader:ignore REF004\n  # grader:ignore REF005\n  b: 1\n", [(1, 1, "REF004"), (2, 3, "REF005")]),
    ("a/CMakeLists.txt", "# grader:ignore PKG\ninstall()\n", [(1, 2, "PKG")]),
    ("a.cpp", "int a;  // grader:ignore REF007\n", [(1, 1, "REF007")]),
    ("a.cpp", "/* grader:ignore REF007 */\nint a;\n", [(1, 2, "REF007")]),
    ("a.cpp", "int a = b # c;  grader:ignore REF007\n", []),
    ("a.urdf", "<a/> <!-- grader:ignore URDF01 -->\n<b/>\n", [(1, 1, "URDF01")]),
    ("a.urdf", "<!-- grader:ignore URDF01 -->\n<b\n c='1'\n/>\n<c/>\n", [(1, 4, "URDF01")]),
    ("a.urdf", "<!-- grader:ignore URDF01 --> <b\n/>\n", [(1, 1, "URDF01")]),
    ("a.urdf", "<!--\n grader:ignore URDF01\n-->\n<b/>\n", [(2, 4, "URDF01")]),
    ("a.urdf", "<!-- grader:ignore URDF01 -->\ntext > more\n", [(1, 2, "URDF01")]),
    ("a.urdf", "<!-- a --> grader:ignore URDF01 <!-- b -->\n", []),
    ("a.urdf", "<!-- grader:ignore URDF01\n", []),
    ("a.urdf", "<a b='grader:ignore URDF01'/>\n", []),
]  # fmt: skip


@pytest.mark.parametrize(("path", "text", "expected"), COMMENTS)
def test_comments_are_read(path: str, text: str, expected: list[tuple[int, int, str]]) -> None:
    """Only in comments of the file's language; one that is alone in its line is about the next one, in XML the next tag."""
    found = [*read_ignore_comments(path, text)]
    assert [(it.location.line, it.last, " ".join(it.codes)) for it in found] == expected


@pytest.mark.slow
def test_no_grading_obeys(tmp_path: Path) -> None:
    """Settings beside a submission and above it, and comments in it, change nothing in a report or in grades but hashes."""
    reports, tables = [], []
    for name in ("plain", "ignoring"):
        folder = tmp_path / name / "class" / "ash"
        folder.mkdir(parents=True)
        text = RAW.read_text(encoding="utf-8")
        mark = "other:words" if name == "plain" else "grader:ignore"
        text = text.replace("<link", f"<!-- {mark} URDF, XACRO -->\n<link")
        (folder / "my_robot.urdf").write_text(text, encoding="utf-8")
        if name == "ignoring":
            for place in (folder, folder.parent, folder.parent.parent):
                (place / "grader.toml").write_text('ignore = ["URDF", "XACRO"]')
        done = run(("grade", folder, "--format", "concise"))
        reports.append(done.stdout.replace(str(tmp_path / name).encode(), b""))
        report = json.loads(run(("grade", folder, "--format", "json")).stdout)
        reports.append(json.dumps([report["results"], report["problems"]]).encode())
        book = tmp_path / name / "book"
        assert grader("batch", folder.parent, "--gradebook", book).returncode == 0
        tables.append(re.sub(rb"[0-9a-f]{16,}", b"", (book / "grades.csv").read_bytes()))
        shown = run(("inspect", folder / "my_robot.urdf", "--format", "concise")).stdout
        assert (b": URDF" in shown) == (name == "plain")
    assert [it.replace(b"../", b"").replace(b"/plain", b"/ignoring") for it in reports[:2]] == [
        it.replace(b"../", b"") for it in reports[2:]
    ]
    assert tables[0] == tables[1]


def test_settings_are_kept_for_others(tmp_path: Path) -> None:
    """The release and the rubric, of a file its folder's; a symlink is no file with settings."""
    (tmp_path / "src").mkdir()
    (tmp_path / "grader.toml").write_text('distro = "humble"\nrubric = "arm"\n')
    shutil.copy(RAW, tmp_path / "src")
    for path in (tmp_path, tmp_path / "src", tmp_path / "src" / RAW.name):
        settings = read_settings(str(path))
        assert (settings.distro, settings.rubric, settings.ignore) == ("humble", "arm", ())
    (tmp_path / "src" / "grader.toml").symlink_to("/etc/passwd")
    assert read_settings(str(tmp_path / "src")).distro == "humble"
    assert read_settings("-") == read_settings("/")
