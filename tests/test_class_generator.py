"""Generated classes are the same everywhere, and each URDF in them loses the expected criteria."""

import hashlib
import json
import os
import sys
from collections.abc import Iterable
from itertools import combinations
from pathlib import Path

import pytest

from grader.classroom.intake.submissions import read_class
from grader.classroom.results.results import StoredResult
from grader.classroom.roster.roster import read_roster
from grader.classroom.run.batch_worker import ClassContext, Task, grade_all
from grader.lab.grading.grade import grade
from grader.lab.submission.opening import read_submission
from tests.examples import spread
from tests.samples import LAB6, ROOT

sys.path.insert(0, str(ROOT / "benchmarks"))  # a folder of scripts
import class_generator as made_up

pytestmark = pytest.mark.slow

MIXED, MANY, SEED = 120, 300, 1
ALL_VARIANTS = (*made_up.MISTAKES, *made_up.EQUIVALENTS, *made_up.BROKEN)


def lost(text: str) -> set[str]:
    """Return the criteria of a URDF that did not pass."""
    report = grade(LAB6, read_submission(text.encode(), identity="student", path="my_robot.urdf"))
    assert not report.fault
    return {result.criterion.id for result in report.results if result.outcome.status != "passed"}


def digest(folder: Path) -> str:
    """Return a hash of all names, links and bytes below a folder."""
    found = hashlib.sha256()
    for path in sorted(folder.rglob("*"), key=os.fsencode):
        found.update(os.fsencode(path.relative_to(folder)) + b"\0")
        if path.is_symlink():
            found.update(os.fsencode(path.readlink()))
        elif path.is_file():
            found.update(path.read_bytes())
    return found.hexdigest()


def every(made: Iterable[made_up.WrittenSubmission]) -> list[made_up.WrittenSubmission]:
    """Return all submissions of a class, which are generated one by one."""
    return list(made)


@pytest.mark.parametrize("layout", made_up.LAYOUTS)
@pytest.mark.parametrize("kind", ["urdf", "mixed"])
def test_the_same_seed_gives_the_same_bytes(kind: str, layout: str, tmp_path: Path) -> None:
    """Two classes of one seed are equal byte for byte; one of another seed is not."""
    for name, seed in (("one", 1), ("two", 1), ("other", 2)):
        every(made_up.make_class(tmp_path / name, 40, seed, kind, layout))
    assert digest(tmp_path / "one") == digest(tmp_path / "two") != digest(tmp_path / "other")


def test_random_choices_are_the_same_on_every_python() -> None:
    """The results for one seed are recorded here."""
    dice = made_up.Dice("1/hand-in/0")
    assert [dice.below(1000) for _ in range(4)] == [215, 634, 638, 27]
    assert made_up.Dice("x").shuffled("abcdefgh") == list("hagbdcef")
    assert hashlib.sha256(made_up.bomb()).hexdigest()[:16] == "b1417c6a66512962"


def test_all_urdfs_differ() -> None:
    """A cache by content cannot help with the next one."""
    texts = {
        submission.made.text
        for submission in made_up.submissions(500, SEED, "urdf")
        if submission.made
    }
    assert len(texts) == 500


def test_the_proportions_are_those_of_real_classes() -> None:
    """Some 37 in 100 are correct, half of them with other numbers; 6 are broken; the most frequent mistakes come first."""
    made = [
        submission.made
        for submission in made_up.submissions(2_000, SEED, "urdf")
        if submission.made
    ]
    share = {
        sort: sum(submission.sort == sort for submission in made) / len(made)
        for sort in {submission.sort for submission in made}
    }
    expected = {"as told": 0.185, "equivalent": 0.185, "mistaken": 0.57, "broken": 0.06}
    assert share == pytest.approx(expected, abs=0.03)
    met = {
        variant.name: sum(variant.name in submission.variants for submission in made)
        for variant in ALL_VARIANTS
    }
    assert all(met.values())
    assert {"right-mirrored", "lidar-buried"} == set(sorted(met, key=lambda name: met[name])[-2:])


def test_a_generated_class_loses_the_expected_criteria() -> None:
    """Every URDF of a class gets the marks that it was generated for."""
    for submission in made_up.submissions(150, SEED, "urdf"):
        assert submission.made is not None
        assert lost(submission.made.text) == set(submission.made.lost), submission.made


@pytest.mark.parametrize("variant", spread(ALL_VARIANTS, 20), ids=lambda variant: variant.name)
def test_a_variant_loses_the_expected_criteria(variant: made_up.Variant) -> None:
    """Each way to build or break the robot alone, in two styles; each of its edits finds its text once."""
    for edit in variant.edits:
        assert not edit.old or made_up.elements()[edit.element].count(edit.old) == 1, edit
    for number in range(2):
        made = made_up.built(
            made_up.Dice(f"{variant.name}/{number}"), "a student", "alone", (variant,)
        )
        assert lost(made.text) == set(made.lost), made.text


def test_two_mistakes_do_not_hide_each_other() -> None:
    """Any two mistakes in different elements lose what both lose."""
    for one, two in combinations(made_up.MISTAKES, 2):
        if set(one.touches.split()).isdisjoint(two.touches.split()):
            made = made_up.built(made_up.Dice(one.name + two.name), "a student", "pair", (one, two))
            assert lost(made.text) == set(made.lost), made.variants


# --- A class of all kinds ---------------------------------------------------------------------------------------------


def test_all_kinds_and_names_occur(tmp_path: Path) -> None:
    """Each kind of submission and each awkward name occurs in a class of 300, and is written as far as the disk allows."""
    written = every(made_up.make_class(tmp_path, MANY, SEED, "mixed"))
    assert {submission.kind for submission in written} == set(made_up.KINDS)
    names = {submission.person.name for submission in written}
    assert {f"{first} {last}" for first, last in made_up.AWKWARD} <= names
    assert all(
        os.path.lexists(tmp_path / path) for submission in written for path in submission.paths
    )
    assert any(path.endswith(" (1).urdf") for submission in written for path in submission.paths)
    assert [submission.kind for submission in written if not submission.paths] == ["nothing"] * sum(
        submission.kind == "nothing" for submission in written
    )
    assert written[-1].person.login.endswith(str(MANY))


@pytest.mark.parametrize("layout", spread(made_up.LAYOUTS, 1))
def test_every_mixed_submission_is_opened(layout: str, tmp_path: Path) -> None:
    """None causes an error of the grader, and those with a known result get it."""
    folder = tmp_path / "class"
    written = every(made_up.make_class(folder, MIXED, SEED, "mixed", layout))
    by_path = {path: submission for submission in written for path in submission.paths}
    graded = {path: submission for path, submission in _graded(folder)}
    assert set(graded) <= set(by_path)
    assert {submission.verdict for submission in graded.values()} == {"graded", "unreadable"}
    assert len(graded) == sum(bool(submission.paths) for submission in written)
    for path, submission in graded.items():
        made = by_path[path].made
        assert made is None or (submission.verdict, _lost(submission)) == (
            "graded",
            set(made.lost),
        ), (
            by_path[path].kind,
            made,
        )
    refused = {
        by_path[path].kind
        for path, submission in graded.items()
        if submission.verdict == "unreadable"
    }
    assert layout == "moodle" or refused >= {"broken-zip", "garbage-zip", "zip-bomb"}


def _graded(folder: Path) -> Iterable[tuple[str, StoredResult]]:
    """Yield the result of each submission, with the top name of the one that counts."""
    common = ClassContext((str(folder),), LAB6.data, str(LAB6.path))
    for one in read_class([folder], None, rubric_id="lab6").submissions:
        (graded,) = grade_all(common, [Task(one.student.key, 0, one.paths, one.names)])
        yield one.paths[0].partition("/")[0], graded


def _lost(graded: StoredResult) -> set[str]:
    """Return the criteria of the URDF that failed or were skipped."""
    lost = {
        name for name, (_, status, *_) in graded.results.items() if status in ("failed", "skipped")
    }
    return lost & set(made_up.criteria())


@pytest.mark.parametrize("layout", ["canvas", "moodle"])
@pytest.mark.parametrize("list_name", ["roster.csv", "lms.csv"])
def test_the_lists_match_the_class(layout: str, list_name: str, tmp_path: Path) -> None:
    """With a roster or the LMS's own file, one submission is unmatched, and students without one are absent."""
    folder = tmp_path / "class"
    written = every(made_up.make_class(folder, MIXED, SEED, "mixed", layout))
    made_up.write_beside(
        written, MIXED, layout, None, tmp_path / "roster.csv", tmp_path / "lms.csv"
    )
    roster = read_roster((tmp_path / list_name).read_bytes(), list_name)
    intake = read_class([folder], roster, rubric_id="lab6")
    assert intake.layout == layout
    assert len(intake.unmatched) == 1 and not intake.unclear
    present = {one.student.key for one in intake.submissions}
    assert sum(one.key not in present for one in roster.students) == sum(
        not one.paths for one in written
    )


def test_expectations_are_written_beside_the_class(tmp_path: Path) -> None:
    """The JSON file has the expected result of every student, whatever bytes the names contain."""
    written = every(made_up.make_class(tmp_path / "class", MIXED, SEED, "mixed"))
    made_up.write_beside(written, MIXED, "folders", tmp_path / "expected.json", None, None)
    known = json.loads((tmp_path / "expected.json").read_text(encoding="utf-8"))
    assert len(known) == MIXED + 1
    assert known[written[0].person.key]["kind"] == written[0].kind
    assert known[written[-1].person.key]["lost"] is not None


def test_the_zip_bomb(tmp_path: Path) -> None:
    """A zip of 64 KiB that declares, and unpacks to, a thousand times as much."""
    import zipfile

    (tmp_path / "bomb.zip").write_bytes(made_up.bomb())
    with zipfile.ZipFile(tmp_path / "bomb.zip") as archive:
        assert archive.testzip() is None
        assert sum(info.file_size for info in archive.infolist()) > 900 * len(made_up.bomb())
