"""Model answers are shown to those who grade, and to nobody else."""

import json
import shutil
from pathlib import Path

import pytest

from grader.grading.rubric import load_rubric
from grader.report.formats import Format
from tests.classroom.gradebooks import batch, grader, lab_text, refusal
from tests.report.reports import CLASSROOM50
from tests.samples import ROOT

SECRET = "Because of the roots."
INLINE = f', answer = "{SECRET}"'
REFERENCE = ROOT / "submissions/lab6/reference"
OF_LAB6 = ("The model vanishes", "joint_state_publisher_gui, publishes")


def with_separate_answers(top: Path, answers: str = f'essay = "{SECRET}"') -> Path:
    """Write the small lab with its model answers in a separate file."""
    rubric = top / "small.toml"
    text = lab_text().replace(INLINE, "").replace('id = "small"', 'id = "small"\nanswers = "small.answers.toml"', 1)
    rubric.write_text(text, encoding="utf-8")
    (top / "small.answers.toml").write_text(answers, encoding="utf-8")
    return rubric


@pytest.mark.parametrize("is_apart", [True, False])
def test_no_report_of_grade_or_batch_contains_one(graded_class: Path, tmp_path: Path, is_apart: bool) -> None:
    """In any format, saved or printed, in a job's summary or log, with the answer in the rubric or in a separate file."""
    top = tmp_path / "small"
    shutil.copytree(graded_class / "class", top / "class")
    shutil.copy(graded_class / "roster.csv", top)
    rubric = with_separate_answers(top) if is_apart else top / "small.toml"
    if not is_apart:
        rubric.write_text(lab_text(), encoding="utf-8")
        assert SECRET in rubric.read_text(encoding="utf-8")
    out = tmp_path / "out"
    out.mkdir()
    saves = [part for kind in Format for part in ("--save", f"{kind}={out / kind.ending}")]
    summary = {"GITHUB_ACTIONS": "true", "GITHUB_STEP_SUMMARY": str(out / "summary")}
    done = grader("grade", top / "class" / "anna", "--rubric", rubric, *saves, **CLASSROOM50, **summary)
    assert done.returncode == 0, done.stderr
    formats = [file_format for file_format in Format if file_format.needs != "identity"]
    expected = [part for kind in formats for part in ("--report-format", kind)]
    graded = batch(top, "--reports", out / "reports", *expected, "--csv", out / "csv")
    assert graded.returncode == 0, graded.stderr
    output = [done.stdout, done.stderr, graded.stdout, graded.stderr]
    for arguments in (
        ("explain", "essay", "--rubric", rubric),
        ("rubric", "show", rubric),
        ("export", "json", "--gradebook", top / "book.db"),
        ("export", "csv", "--gradebook", top / "book.db"),
        ("stats", "--gradebook", top / "book.db", "--format", "json"),
    ):
        shown = grader(*arguments)
        assert shown.returncode == 0, shown.stderr
        output.append(shown.stdout + shown.stderr)
    files = [path.read_text(encoding="utf-8") for path in out.rglob("*") if path.is_file()]
    assert len(files) > 2 * len(Format)
    assert any("The roots of " in text for text in files)  # what the student has answered
    assert all("of the roots" not in text for text in (*files, *output))


def test_those_who_grade_see_them(top: Path) -> None:
    """`rubric show --answers`, `grade --answers` in three formats, and `review` show them, also without the rubric."""
    rubric = with_separate_answers(top)
    file = top / "small.answers.toml"
    assert f"    Model answer: {SECRET}\n" in grader("rubric", "show", rubric, "--answers", file).stdout
    anna = ("grade", top / "class" / "anna", "--rubric", rubric, "--answers", file, "--format")
    assert SECRET in grader(*anna, "terminal").stdout
    assert f"\n  {SECRET}\n  ```\n" in grader(*anna, "markdown").stdout
    (essay,) = [result for result in json.loads(grader(*anna, "json").stdout)["results"] if result["id"] == "essay"]
    assert essay["expected"] == SECRET
    assert batch(top, "--force").returncode == 0
    for file in top.glob("*.toml"):
        file.unlink()
    done = grader("review", "--gradebook", top / "book.db", stdin="q\n")
    assert f"Model answer:\n  {SECRET}\n" in done.stdout


@pytest.mark.parametrize("command", ["batch", "review"])
def test_a_file_that_the_rubric_does_not_name(graded_class: Path, tmp_path: Path, command: str) -> None:
    """`batch --answers` and `review --answers` keep them in the gradebook, where later reviews find them."""
    top = tmp_path / "small"
    shutil.copytree(graded_class, top)
    rubric = with_separate_answers(top)
    file = (top / "small.answers.toml").rename(tmp_path / "elsewhere.toml")
    book = ("--gradebook", top / "book.db")
    assert batch(top, *(("--answers", file) if command == "batch" else ())).returncode == 0
    if command == "review":
        before = grader("review", *book, stdin="q\n")
        assert "Model answer" not in before.stdout
        assert before.stderr == ""
        assert SECRET in grader("review", *book, "--answers", file, stdin="q\n").stdout
    assert SECRET in grader("review", *book, stdin="q\n").stdout
    assert rubric.exists()


def test_the_file_can_be_the_rubric(top: Path) -> None:
    """`--answers` shows the model answers in the rubric if it names the rubric; a file with mistakes is refused."""
    rubric = top / "small.toml"
    rubric.write_text(lab_text(), encoding="utf-8")
    assert f"    Model answer: {SECRET}\n" in grader("rubric", "show", rubric, "--answers", rubric).stdout
    (top / "wrong.toml").write_text("esay = ''", encoding="utf-8")
    for command in (("rubric", "show", rubric), ("grade", top / "class" / "anna", "--rubric", rubric)):
        assert "has no question 'esay'" in refusal(grader(*command, "--answers", top / "wrong.toml"))
    assert "has no question 'esay'" in refusal(
        grader("review", "--gradebook", top / "book.db", "--answers", top / "wrong.toml")
    )


def test_the_file_is_never_overwritten(top: Path) -> None:
    """`--save` refuses it."""
    with_separate_answers(top)
    file = top / "small.answers.toml"
    anna = ("grade", top / "class" / "anna", "--rubric", top / "small.toml", "--answers", file)
    assert "the command also reads" in refusal(grader(*anna, "--save", f"json={file}"))
    assert SECRET in file.read_text(encoding="utf-8")


def test_formats_for_students_never_contain_them(top: Path, tmp_path: Path) -> None:
    """Neither Gradescope's results nor a job's summary, which students read, contains them with --answers."""
    summary = tmp_path / "summary"
    shown = grader(
        "grade", top / "class" / "anna", "--rubric", with_separate_answers(top),
        "--answers", top / "small.answers.toml", "--format", "gradescope",
        GITHUB_ACTIONS="true", GITHUB_STEP_SUMMARY=str(summary),
    )  # fmt: skip
    assert shown.returncode == 0, shown.stderr
    assert "About essay" in summary.read_text(encoding="utf-8")
    assert "of the roots" not in shown.stdout + shown.stderr + summary.read_text(encoding="utf-8")


def test_the_rubric_works_without_the_file(top: Path) -> None:
    """The hash and grades are the same, and `rubric check` says that there are no model answers."""
    rubric = with_separate_answers(top)
    before, shown = load_rubric(str(rubric)).sha256, grader("rubric", "show", rubric)
    anna = ("grade", top / "class" / "anna", "--rubric", rubric, "--format", "json")
    graded = grader(*anna)
    (top / "small.answers.toml").unlink()
    assert load_rubric(str(rubric)).sha256 == before
    assert grader("rubric", "show", rubric).stdout == shown.stdout
    assert grader(*anna).stdout == graded.stdout
    note = f"grader: small: the answers file {top}/small.answers.toml does not exist, so no model answers are shown\n"
    assert grader("rubric", "check", rubric).stderr == note
    assert batch(top, "--force").returncode == 0
    done = grader("review", "--gradebook", top / "book.db", stdin="q\n")
    assert (done.returncode, "Model answer" in done.stdout) == (0, False)


@pytest.mark.parametrize(
    ("answers", "why"),
    [
        (
            "a = 1\n\nesay = ''",
            "3: the rubric small has no question 'esay'; did you mean 'essay'?",
        ),
        ("\nbox = ''", "2: the rubric small has no question 'box'; there are: essay"),
        ("essay = 3", "1: the answer to essay must be a string"),
        ("essay = ", "1:9: invalid value: essay ="),
    ],
)
def test_mistakes_in_the_file_have_lines(tmp_path: Path, answers: str, why: str) -> None:
    """Mistakes are reported like those in the rubric; commands that need no model answers do not read the file."""
    rubric = with_separate_answers(tmp_path, answers)
    done = grader("rubric", "check", rubric)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.splitlines()[-1] == f"grader: {tmp_path}/small.answers.toml:{why}"
    assert grader("rubric", "show", rubric).returncode == 0


def test_an_answer_in_two_files_is_refused(tmp_path: Path) -> None:
    """A model answer in both the rubric and the file is refused."""
    rubric = with_separate_answers(tmp_path)
    rubric.write_text(rubric.read_text().replace('question = "Why?"', f'question = "Why?"{INLINE}'), encoding="utf-8")
    why = f"{tmp_path}/small.answers.toml:1: the answer to essay is already in the rubric: remove one of the two"
    assert refusal(grader("rubric", "check", rubric)) == why


@pytest.mark.parametrize("name", ["/etc/a.toml", "../a.toml", "a/../../a.toml", "C:\\\\a.toml", "a", ""])
def test_the_file_must_be_in_the_folder_of_the_rubric(tmp_path: Path, name: str) -> None:
    """No file outside it is read, whatever a rubric in a student's repository names."""
    rubric = with_separate_answers(tmp_path)
    rubric.write_text(rubric.read_text().replace("small.answers.toml", name), encoding="utf-8")
    assert f"{rubric}:2: answers must be a .toml file in the rubric's folder" in refusal(
        grader("rubric", "show", rubric)
    )


def test_a_symlink_to_another_file_is_not_followed(tmp_path: Path) -> None:
    """A rubric in a student's repository cannot quote other files."""
    (tmp_path / "lab").mkdir()
    rubric = with_separate_answers(tmp_path / "lab")
    (tmp_path / "lab" / "small.answers.toml").rename(tmp_path / "elsewhere.toml")
    (tmp_path / "lab" / "small.answers.toml").symlink_to(tmp_path / "elsewhere.toml")
    assert "must be in the rubric's folder" in refusal(grader("rubric", "check", rubric))


def test_lab6_has_a_separate_file() -> None:
    """Its answers are shown on request, and the rubric that students may have contains none."""
    shown = grader("rubric", "show", "lab6", "--answers", ROOT / "rubrics/lab6/answers.toml").stdout
    assert all(answer in " ".join(shown.split()) for answer in OF_LAB6)
    text = " ".join((ROOT / "rubrics/lab6/rubric.toml").read_text(encoding="utf-8").split())
    for arguments in (("rubric", "show", "lab6"), ("grade", REFERENCE), ("grade", REFERENCE, "--format", "json")):
        text += " ".join(grader(*arguments).stdout.split())
    assert not any(answer in text for answer in OF_LAB6)
