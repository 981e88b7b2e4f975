"""A `grade` that ends with exit code 2 changes no file."""

import shutil
import subprocess
from pathlib import Path

import pytest

from tests.command_line import GRADER, ROOT, run_with_input
from tests.examples import spread

MISTAKES = ROOT / "submissions/lab6/several-mistakes/my_robot/urdf/my_robot.urdf"
REFUSALS = {
    "a path that does not exist": ("none.urdf",),
    "a path that is too long": ("a" * 5000,),
    "two paths": ("a.urdf", "b.urdf"),
    "an argument that is too long": ("a.urdf", "--arg", "x=" + "a" * 5000, "--fail-under", "most"),
    "a report whose name is too long": ("a.urdf", "--save", "json=" + "a" * 5000),
    "an unknown option": ("a.urdf", "--colour"),
    "an unknown option before the command": ("--colour", "grade", "a.urdf"),
    "an unknown option with a value": ("a.urdf", "--due=today"),
    "a misspelt option": ("a.urdf", "--saves", "json=r.json"),
    "a flag with a value": ("a.urdf", "--verbose=yes"),
    "an option without its value": ("a.urdf", "--part"),
    "an unknown format": ("a.urdf", "--format", "pdf"),
    "an empty format": ("a.urdf", "--format="),
    "a format without its variables": ("a.urdf", "--format", "classroom50"),
    "a saved format without its variables": ("a.urdf", "--save", "classroom50=c.json"),
    "an unknown format to save": ("a.urdf", "--save", "pdf=a.pdf"),
    "a format to save without a file": ("a.urdf", "--save", "json"),
    "one file for two reports": ("a.urdf", "--save", "junit=r.json"),
    "a report in a folder that does not exist": ("a.urdf", "--save", "json=none/r.json"),
    "a report over the submission": ("a.urdf", "--save", "json=a.urdf"),
    "a report over the rubric": ("a.urdf", "--rubric", "lab.toml", "--save", "json=lab.toml"),
    "a report over the reference": (
        "a.urdf",
        "--rubric",
        "lab.toml",
        "--save",
        "json=solution/my_robot/setup.py",
    ),
    "a report over the model answers": (
        "a.urdf",
        "--rubric",
        "lab.toml",
        "--save",
        "json=lab.answers.toml",
    ),
    "a report through a symlink": ("a.urdf", "--save", "json=link.json"),
    "a size of nothing": ("a.urdf", "--max-size", "0"),
    "a size that is no number": ("a.urdf", "--max-size", "1 MiB"),
    "an unknown level of hints": ("a.urdf", "--hints", "all"),
    "a hash that is none": ("a.urdf", "--expect-rubric", "lab6"),
    "another hash": ("a.urdf", "--expect-rubric", "0" * 64),
    "an unknown rubric": ("a.urdf", "--rubric", "lab60"),
    "an empty rubric": ("a.urdf", "--rubric", ""),
    "a rubric that does not exist": ("a.urdf", "--rubric", "none.toml"),
    "a broken rubric": ("a.urdf", "--rubric", "broken.toml"),
    "an unknown part": ("a.urdf", "--part", "task9"),
    "a threshold that is none": ("a.urdf", "--fail-under", "most"),
    "a threshold above all": ("a.urdf", "--fail-under", "101%"),
    "an argument without a value": ("a.urdf", "--arg", "colour"),
    "a fix below the level edit": ("a.urdf", "--hints", "cause", "--fix", "f.urdf"),
    "a fix over the submission": ("a.urdf", "--fix", "a.urdf"),
    "a fix over a symlink to the submission": ("a.urdf", "--fix", "mine.urdf"),
    "a fix over the rubric": ("a.urdf", "--rubric", "./lab.toml", "--fix", "lab.toml"),
    "a fix over a hard link to the rubric": (
        "a.urdf",
        "--rubric",
        "lab.toml",
        "--fix",
        "hard.toml",
    ),
    "a fix over the reference": (
        "a.urdf",
        "--rubric",
        "lab.toml",
        "--fix",
        "solution/my_robot/setup.py",
    ),
    "a fix over the model answers": (
        "a.urdf",
        "--rubric",
        "lab.toml",
        "--fix",
        "x/../lab.answers.toml",
    ),
    "a fix over a report": ("a.urdf", "--fix", "./r.json"),
    "a fix in a folder that does not exist": ("a.urdf", "--fix", "none/f.urdf"),
    "a fix that cannot be written": ("a.urdf", "--fix", "/dev/full"),
    "a fix and --watch": ("a.urdf", "--watch", "--fix", "f.urdf"),
    "a format and --watch": ("a.urdf", "--watch", "--format", "json"),
    "standard input and --watch": ("-", "--watch"),
}


@pytest.fixture
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return the current folder: submissions, a rubric with its reference and model answers, and an old report."""
    monkeypatch.chdir(tmp_path)
    for name in ("a", "b", "class/ada/ada", "class/bob/bob"):
        Path(name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(MISTAKES, f"{name}.urdf")
    rubric = (ROOT / "rubrics/lab6/rubric.toml").read_text()
    for old, new in (
        ('reference = "my_robot"', 'reference = "solution/my_robot"'),
        ('"answers.toml"', '"lab.answers.toml"'),
        ('hints = "cause"', 'hints = "edit"'),
    ):
        assert old in rubric
        rubric = rubric.replace(old, new)
    Path("lab.toml").write_text(rubric)
    shutil.copytree(ROOT / "rubrics/lab6", "solution")
    shutil.copy(ROOT / "rubrics/lab6/answers.toml", "lab.answers.toml")
    Path("broken.toml").write_text("id = ")
    Path("hard.toml").hardlink_to("lab.toml")
    Path("mine.urdf").symlink_to("a.urdf")
    Path("link.json").symlink_to("elsewhere.json")
    Path("x").mkdir()
    Path("r.json").write_text('{"score": 100}')
    return tmp_path


def files(place: Path) -> dict[str, bytes]:
    """Return the content of every file in a folder."""
    return {
        str(path.relative_to(place)): path.read_bytes()
        for path in place.rglob("*")
        if path.is_file()
    }


@pytest.mark.parametrize("is_first", [True, False])
@pytest.mark.parametrize("why", spread(REFUSALS, 4))
def test_a_refused_run_changes_nothing(place: Path, why: str, is_first: bool) -> None:
    """Whatever is wrong and wherever `--save` stands, an old report stays as it was, as does every other file."""
    before = files(place)
    words = [*(() if "grade" in REFUSALS[why] else ("grade",)), *REFUSALS[why]]
    at = (
        words.index("grade") + 1 if is_first or words[-1] == "--part" else len(words)
    )  # that takes the next word
    words[at:at] = "--save", "json=r.json"
    done = run_with_input(words, b"", folder=place)
    assert (done.returncode, done.stdout) == (2, b""), done.stderr
    assert done.stderr.startswith(b"grader: "), done.stderr
    assert files(place) == before, done.stderr


@pytest.mark.exhaustive
def test_a_report_that_cannot_be_printed_is_not_saved(place: Path) -> None:
    """Nor is the first of two reports written if the second cannot be written beside its place."""
    before = files(place)
    with Path("/dev/full").open("wb") as full:
        done = subprocess.run(
            [*GRADER, "grade", "a.urdf", "--save", "json=r.json"], stdout=full, check=False
        )
    assert (done.returncode, files(place)) == (2, before), done.stderr
    done = run_with_input(
        ["grade", "a.urdf", "--save", "json=r.json", "--save", "svg=none/r.svg"], b"", folder=place
    )
    assert (done.returncode, files(place)) == (2, before), done.stderr


@pytest.mark.slow
@pytest.mark.parametrize("target", ["r.json", "solution/new.urdf", "f.urdf"])
def test_other_files_are_written(place: Path, target: str) -> None:
    """A fix may replace any other file, and a file that is not there yet may be beside what is read."""
    done = run_with_input(
        ["grade", "a.urdf", "--rubric", "lab.toml", "--fix", target], b"", folder=place
    )
    assert (
        done.returncode,
        b"wrote my_robot.urdf" in done.stderr or b"wrote a.urdf" in done.stderr,
    ) == (1, True)
    assert Path(target).read_text().startswith("<?xml")
