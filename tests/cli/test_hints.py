"""Hints of grader grade: their levels, the files that --fix writes, and what --watch says about them."""

import json
import shutil
from pathlib import Path
from typing import Any

import pytest

from grader.lab.rubric.hint_levels import LEVELS
from tests.command_line import run
from tests.samples import ROOT

pytestmark = pytest.mark.usefixtures("shows_edits")
MISTAKES = ROOT / "submissions/lab6/several-mistakes/my_robot/urdf/my_robot.urdf"
REFERENCE = ROOT / "submissions/lab6/reference/roscourse_sim_ws/src/my_robot/urdf/my_robot.urdf"


def graded(*arguments: object) -> dict[str, Any]:
    """Return the report of a submission as JSON."""
    data: dict[str, Any] = json.loads(run(("grade", *arguments, "--format", "json")).stdout)
    return data


def hints(*arguments: object) -> dict[str, list[dict[str, Any]]]:
    """Return the hints of each criterion that has some."""
    return {
        result["id"]: result["hints"] for result in graded(*arguments)["results"] if result["hints"]
    }


def lab(folder: Path, level: str) -> Path:
    """Return a copy of the rubric of lab 6 with another level of hints."""
    text = (ROOT / "rubrics/lab6/rubric.toml").read_text()
    assert 'hints = "cause"' in text
    text = text.replace('hints = "cause"', f'hints = "{level}"' if level else "")
    text = text.replace('reference = "', f'reference = "{ROOT}/rubrics/lab6/').replace(
        "answers =", "# answers ="
    )
    (folder / "lab.toml").write_text(text)
    return folder / "lab.toml"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("level", "says"),
    [
        (
            "place",
            'Check `rpy="1.57 0 0"` (line 73) and `xyz="0 0 0.025"` (line 65).',
        ),
        ("cause", "Check lines 65 and 73: the sign of z of the visual origin"),
        ("edit", 'Change `rpy="1.57 0 0"` to `rpy="-1.57 0 0"`'),
    ],
)
def test_levels(level: str, says: str) -> None:
    """Each level says more; only the last one has the edit, in no format below it."""
    [hint] = hints(MISTAKES, "--hints", level)["right-wheel-forward"]
    assert hint["message"].startswith(says)
    assert bool(hint["edits"]) == (level == "edit")
    for kind in ("terminal", "markdown", "github", "junit", "gradescope"):
        text = run(("grade", MISTAKES, "--hints", level, "--format", kind)).stdout.decode()
        assert ("-1.57" in text) == (level == "edit"), kind


@pytest.mark.slow
@pytest.mark.parametrize("wanted", LEVELS)
@pytest.mark.parametrize("allowed", ["", *LEVELS])
def test_an_option_never_exceeds_the_rubric(allowed: str, wanted: str, tmp_path: Path) -> None:
    """--hints lowers the level of the rubric, whose default is cause."""
    level = min(allowed or "cause", wanted, key=LEVELS.index)
    found = hints(MISTAKES, "--rubric", lab(tmp_path, allowed), "--hints", wanted)
    expected = hints(MISTAKES, "--hints", level)
    assert bool(found) == (level != "none")
    assert {name: [hint["message"] for hint in some] for name, some in found.items()} == {
        name: [hint["message"] for hint in some] for name, some in expected.items()
    }


def test_a_rubric_without_a_reference(tmp_path: Path) -> None:
    """The student's own numbers with another sign are tried all the same; no number of a criterion is written."""
    rubric = lab(tmp_path, "edit")
    kept = [line for line in rubric.read_text().splitlines() if not line.startswith("reference")]
    rubric.write_text("\n".join(kept))
    mirrored = tmp_path / "a.urdf"
    turned, text = 'rpy="-1.57 0 0"', REFERENCE.read_text()
    mirrored.write_text('rpy="1.57 0 0"'.join(text.rsplit(turned, 1)))
    edits = {
        name: some[0]["edits"][0]["new"]
        for name, some in hints(mirrored, "--rubric", rubric).items()
    }
    assert set(edits.values()) == {'rpy="-1.57 0 0"'}


def test_fix_writes_the_robot_with_all_edits(tmp_path: Path) -> None:
    """It gets full marks, and only the lines of the edits differ."""
    done = run(("grade", MISTAKES, "--fix", tmp_path / "fixed.urdf"))
    assert done.returncode == 1
    assert b"43 -> 70 of 70 points" in done.stderr
    assert run(("grade", tmp_path / "fixed.urdf")).returncode == 0
    before, after = (
        MISTAKES.read_bytes().split(b"\n"),
        (tmp_path / "fixed.urdf").read_bytes().split(b"\n"),
    )
    differing = [
        number
        for number, pair in enumerate(zip(before, after, strict=True), 1)
        if pair[0] != pair[1]
    ]
    assert differing == [6, 39, 65, 73, 99]


@pytest.mark.slow
def test_fix_of_several_files_needs_a_folder(tmp_path: Path) -> None:
    """Each file is written under its path in the submission; the folder is made, and a file that exists is no target."""
    copy = shutil.copytree(ROOT / "submissions/lab6/setup-as-created", tmp_path / "in")
    urdf = copy / "my_robot/urdf/my_robot.urdf"
    urdf.write_text(urdf.read_text().replace("0 0.6 0 1", "0 1 0 1"))
    (tmp_path / "taken").write_text("mine")
    for name in ("fixed.urdf", "taken"):
        done = run(("grade", copy, "--fix", tmp_path / name))
        assert (done.returncode, f"{name} names a file: " in done.stderr.decode(), done.stdout) == (
            2,
            True,
            b"",
        )
    assert (tmp_path / "taken").read_text() == "mine"
    out = tmp_path / "new/out"
    run(("grade", copy, "--fix", out))
    written = sorted(path.relative_to(out).as_posix() for path in out.rglob("*.*"))
    assert written == ["my_robot/setup.py", "my_robot/urdf/my_robot.urdf"]
    assert "0 0.6 0 1" in (out / "my_robot/urdf/my_robot.urdf").read_text()
    (tmp_path / "other").mkdir()
    (tmp_path / "other/my_robot").touch()
    done = run(("grade", copy, "--fix", tmp_path / "other"))
    assert (done.returncode, b"cannot make the folder " in done.stderr) == (2, True)


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["same", "symlink", "hard link", "inside"])
def test_fix_never_overwrites_what_is_graded(kind: str, tmp_path: Path) -> None:
    """Neither by its name, nor by a link, nor another file of the folder that is graded."""
    graded_file = tmp_path / "lab" / "robot.urdf"
    graded_file.parent.mkdir()
    graded_file.write_bytes(MISTAKES.read_bytes())
    path, target = graded_file, graded_file
    if kind == "symlink":
        target = tmp_path / "link.urdf"
        target.symlink_to(graded_file)
    elif kind == "hard link":
        target = tmp_path / "hard.urdf"
        target.hardlink_to(graded_file)
    elif kind == "inside":
        path, target = graded_file.parent, graded_file.parent / "other.txt"
        target.write_text("mine")
    done = run(("grade", path, "--fix", target))
    assert done.returncode == 2
    assert done.stderr.decode().count("\n") == 1
    assert graded_file.read_bytes() == MISTAKES.read_bytes()
    assert kind != "inside" or target.read_text() == "mine"


def test_fix_of_nothing(tmp_path: Path) -> None:
    """Nothing is written where nothing is to be fixed."""
    done = run(("grade", REFERENCE, "--fix", tmp_path / "fixed.urdf"))
    assert done.returncode == 0
    assert done.stderr == b"grader: --fix: nothing was written: no criterion failed\n"
    assert not (tmp_path / "fixed.urdf").exists()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("steps", "reserve", "written"), [(0, 20, False), (26, 20, True), (4, 0, False)]
)
def test_a_search_that_is_cut_off_is_reported(
    steps: int, reserve: int, written: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A note of every report, and the words of `--fix`, say that the budget ended the search."""
    monkeypatch.setattr("grader.lab.hints.search._MAX_GRADINGS", steps)
    monkeypatch.setattr("grader.lab.hints.search._RESERVE", reserve)
    note = "the search for hints ended at its limit: there may be more"
    assert note in graded(MISTAKES)["notes"]
    assert f"Note: {note}" in run(("grade", MISTAKES)).stdout.decode()
    done = run(("grade", MISTAKES, "--fix", tmp_path / "fixed.urdf"))
    assert (tmp_path / "fixed.urdf").exists() == written
    words = (
        "limit: there may be more"
        if written
        else "the search for edits ended at its limit before it found one"
    )
    assert done.stderr.decode().endswith(f"{words}\n")


def test_a_submission_that_is_too_large_has_its_own_sentence(tmp_path: Path) -> None:
    """Nothing was searched then, and `--fix` says so."""
    (tmp_path / "big.urdf").write_text(
        MISTAKES.read_text().replace("</robot>", " " * 300_000 + "</robot>")
    )
    done = run(("grade", tmp_path / "big.urdf", "--fix", tmp_path / "fixed.urdf"))
    assert (
        done.stderr
        == b"grader: --fix: nothing was written: the submission is too large to search for edits\n"
    )


def _fail(*_: object, **__: object) -> None:
    raise ZeroDivisionError


@pytest.mark.parametrize(
    ("place", "failing"),
    [
        ("grader.lab.hints.search.HintSearch.run", _fail),
        ("grader.lab.hints.search.STAGES", (_fail,)),
    ],
    ids=["run", "stages"],
)
def test_a_search_that_failed_has_its_own_sentence(
    place: str, failing: object, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """`--fix` does not say that there is nothing to fix."""
    monkeypatch.setattr(place, failing)
    done = run(("grade", MISTAKES, "--fix", tmp_path / "fixed.urdf"))
    assert (
        done.stderr.decode().splitlines()[-1]
        == "grader: --fix: nothing was written: the search for edits failed"
    )


def test_one_of_several_equal_texts_of_a_line_is_named(tmp_path: Path) -> None:
    """The hint says which of them it is; not where there is only one."""
    line = " ".join(REFERENCE.read_text().split())
    head, tail = line.split("</robot>")[0].rsplit('rpy="-1.57 0 0"', 1)
    (tmp_path / "a.urdf").write_text(f'{head}rpy="1.57 0 0"{tail}<!-- rpy="1.57 0 0" --></robot>')
    shown = " ".join(run(("grade", tmp_path / "a.urdf")).stdout.decode().split())
    assert "(line 1, number 1 of 2)" in shown
    (tmp_path / "b.urdf").write_text(f'{head}rpy="1.57 0 0"{tail}</robot>')
    shown = " ".join(run(("grade", tmp_path / "b.urdf")).stdout.decode().split())
    assert 'Change `rpy="1.57 0 0"` to `rpy="-1.57 0 0"` (line 1)' in shown


@pytest.mark.parametrize("arguments", [("--hints", "cause"), ("--watch",)])
def test_fix_needs_edits(arguments: tuple[str, ...], tmp_path: Path) -> None:
    """It is refused below the level edit, and with --watch, which never ends."""
    done = run(("grade", MISTAKES, "--fix", tmp_path / "fixed.urdf", *arguments))
    assert done.returncode == 2
    assert done.stderr.startswith(b"grader: --")
    assert not (tmp_path / "fixed.urdf").exists()


def test_a_rubric_that_shows_no_edits_writes_no_fix(tmp_path: Path) -> None:
    """The level of the rubric counts, whatever --hints says."""
    done = run(
        (
            "grade",
            MISTAKES,
            "--rubric",
            lab(tmp_path, "cause"),
            "--fix",
            tmp_path / "f.urdf",
            "--hints",
            "edit",
        )
    )
    assert done.returncode == 2
    assert b"the rubric lab6 allows cause" in done.stderr


MISSPELT_FRAME = ROOT / "submissions/lab6/rviz-fixed-frame-misspelt"


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(path.name for path in MISSPELT_FRAME.glob("my_robot/*")))
def test_what_is_missing_costs_no_other_hint(name: str, tmp_path: Path) -> None:
    """Without any one file or folder of the package the search does not fail."""
    shutil.copytree(MISSPELT_FRAME, tmp_path / "sample")
    gone = tmp_path / "sample/my_robot" / name
    shutil.rmtree(gone) if gone.is_dir() else gone.unlink()
    assert b"the grader itself failed" not in run(("grade", tmp_path / "sample")).stderr


@pytest.mark.slow
@pytest.mark.parametrize(
    ("place", "failing"),
    [
        ("grader.lab.hints.package_edits.package_names", _fail),
        ("grader.lab.hints.generators.of_siblings", lambda *_: map(_fail, [1])),
        ("grader.lab.hints.search.missing_hints", _fail),
    ],
    ids=["of the package", "of the robot", "missing parts"],
)
def test_a_fault_of_one_generator_costs_no_other_hint(
    place: str, failing: object, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """The hints of the others are shown, and standard error says that some are missing."""
    shutil.copytree(MISSPELT_FRAME, tmp_path / "sample")
    urdf = tmp_path / "sample/my_robot/urdf/my_robot.urdf"
    urdf.write_text(urdf.read_text().replace("0 0.6 0 1", "0 1 0 1"))

    monkeypatch.setattr(place, failing)
    done = run(("grade", tmp_path / "sample", "--format", "json"))
    found = {result["id"] for result in json.loads(done.stdout)["results"] if result["hints"]}
    assert found == {"base-green", "rviz-fixed-frame"}
    assert (
        done.stderr
        == b"grader: some hints are missing: the grader itself failed (ZeroDivisionError); please report it\n"
    )
