"""What reports keep for the next time: nothing is searched or written twice, and no page is older than what it shows."""

import json
import shutil
from pathlib import Path
from typing import Any

import pytest

from grader.classroom.reports import kept_reports
from grader.lab.hints.hinting import hinted
from tests.classroom.class_runs import grader
from tests.samples import ROOT

SAMPLES = ROOT / "submissions/lab6"


@pytest.fixture
def top(tmp_path: Path) -> Path:
    """Return a folder with a class that is graded: two equal robots with a mistake, another one, and a correct one."""
    wrong = next((SAMPLES / "lidar-buried").rglob("*.urdf")).read_bytes()
    files = {
        "ash": wrong,
        "birch": wrong,
        "cedar": wrong.replace(b"0.6 0.4 0.2", b"0.6 0.4 0.25"),
        "oak": next((SAMPLES / "reference").rglob("*.urdf")).read_bytes(),
    }
    (tmp_path / "class").mkdir()
    for name, data in files.items():
        (tmp_path / f"class/{name}.urdf").write_bytes(data)
    assert grader("batch", tmp_path / "class", "--gradebook", tmp_path / "g").returncode == 0
    return tmp_path


@pytest.fixture
def searches(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Return the paths of the robots for which hints are searched."""
    paths = list[str]()

    def counted(report: Any, submission: Any, level: Any) -> Any:
        paths.append(submission.path)
        return hinted(report, submission, level)

    monkeypatch.setattr(kept_reports, "hinted", counted)
    return paths


def pages(top: Path) -> dict[str, tuple[bytes, int]]:
    """Write the pages, and return the bytes and the time of each student's."""
    done = grader("export", "html", "--gradebook", top / "g")
    assert done.stderr == f"grader: 4 reports written to {top / 'g/reports'}\n"
    files = sorted((top / "g/reports").glob("*.html"))
    return {file.stem: (file.read_bytes(), file.stat().st_mtime_ns) for file in files}


def written(before: dict[str, tuple[bytes, int]], after: dict[str, tuple[bytes, int]]) -> set[str]:
    """Return whose pages were written since."""
    return {name for name in after if after[name][1] != before[name][1]}


@pytest.mark.slow
def test_equal_robots_are_searched_once(top: Path, searches: list[str]) -> None:
    """Each page has its hints all the same, with its own file."""
    found = pages(top)
    assert searches == ["ash.urdf", "cedar.urdf", "oak.urdf"]
    for name in ("ash", "birch", "cedar"):
        assert f"{name}.urdf".encode() in found[name][0]
        assert b'class="hint' in found[name][0] or b"hint" in found[name][0]


@pytest.mark.slow
def test_only_what_changed_is_written(top: Path, searches: list[str]) -> None:
    """A mark, a submission that is gone and a page that was edited or deleted; what is searched is kept."""
    before = pages(top)
    del searches[:]
    assert written(before, pages(top)) == set()
    grader("mark", "ash", "grade", "50", "--gradebook", top / "g", "--by", "Kim")
    marked = pages(top)
    assert written(before, marked) == {"ash"}
    assert b"Final mark: 50 points, given by Kim" in marked["ash"][0]
    (top / "g/reports/birch.html").write_text("edited")
    (top / "g/reports/oak.html").unlink()
    restored = pages(top)
    assert written(marked, restored) == {"birch", "oak"}
    assert (restored["birch"][0], restored["oak"][0]) == (before["birch"][0], before["oak"][0])
    (top / "class/cedar.urdf").unlink()
    moved = pages(top)
    assert written(restored, moved) == {"cedar"}
    assert b"has moved or changed since it was graded" in moved["cedar"][0]
    assert searches == []


@pytest.mark.slow
def test_what_is_kept_may_be_lost(top: Path, searches: list[str]) -> None:
    """A damaged line counts for nothing, and without the file everything is written again, as it was."""
    before = pages(top)
    kept = top / "g/reports.jsonl"
    kept.write_bytes(kept.read_bytes().replace(b'"message":"', b'"message":"not '))
    for page in (top / "g/reports").glob("*.html"):
        page.unlink()
    del searches[:]
    again = pages(top)
    assert searches == ["ash.urdf", "cedar.urdf"]
    kept.unlink()
    last = pages(top)
    assert written(again, last) == {*before}
    texts = [{name: text for name, (text, _) in run.items()} for run in (before, again, last)]
    assert texts[0] == texts[1] == texts[2]


@pytest.mark.slow
@pytest.mark.parametrize("level", ["edit", "cause"])
def test_hints_are_the_same_when_they_are_kept(level: str, tmp_path: Path) -> None:
    """Also with edits, for each sample of the lab with a package."""
    rubric = tmp_path / "rubric"
    assert grader("rubric", "copy", "lab6", rubric).returncode == 0
    [file] = rubric.rglob("rubric.toml")
    text = file.read_text(encoding="utf-8")
    file.write_text(text.replace('hints = "cause"', f'hints = "{level}"'), encoding="utf-8")
    book, folder = tmp_path / "g", tmp_path / "class"
    folder.mkdir()
    for name in ("several-mistakes", "lidar-buried", "axis-negated"):
        shutil.copytree(SAMPLES / name, folder / name)
    reports = ("--report-format", "json", "--reports", tmp_path / "reports")
    command = ("batch", folder, "--gradebook", book, "--rubric", file, *reports)
    texts = list[dict[str, bytes]]()
    for _ in range(2):
        assert grader(*command).returncode == 0
        files = sorted((tmp_path / "reports").glob("*.json"))
        texts.append({path.name: path.read_bytes() for path in files})
        for path in files:
            path.unlink()
    assert texts[0] == texts[1]
    assert b'"hints": [{' in b"".join(b" ".join(text.split()) for text in texts[0].values())


@pytest.mark.slow
def test_pictures_of_robots_are_kept(top: Path) -> None:
    """The class's page is the same where no report is written again; equal robots share a picture."""
    pages(top)
    first = (top / "g/index.html").read_text()
    data = json.loads(first.partition('id="data">')[2].partition("</script>")[0])
    assert data["robots"][0] == data["robots"][1]
    assert len({*data["robots"]}) == len(data["stills"]) == 3
    pages(top)
    assert (top / "g/index.html").read_text() == first
