"""The steps of the action and of the workflows, run as GitHub's runner runs them."""

import json
import os
import random
import re
import shutil
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

import pytest

from grader.lab.rubric.rubric import load_rubric
from tests.ci.conftest import git, repository
from tests.ci.runner import Done, Runner, composite, load
from tests.command_line import HANG_TIMEOUT, ROOT

CHECKOUT = "actions/checkout@de0fac2e4500dabe0009e67214ff5f5447ce83dd"
PYTHON = "actions/setup-python@a309ff8b426b58ec0e2a45f0f869d46889d02405"
CACHE = "actions/cache@668228422ae6a00e4ad889ee87cd7109ec5666a7"
UPLOAD = "actions/upload-artifact@b7c566a772e6b6bfb58ed0dc250532a479d7789f"
WORKFLOWS = ROOT / "docs" / "ci"

pytestmark = [
    pytest.mark.exhaustive,
    pytest.mark.skipif(
        os.name == "nt" or shutil.which("bash") is None, reason="the steps are for bash"
    ),
]


def instead_of_github(host: Path) -> dict[str, str]:
    """Return git settings that fetch from a folder instead of from GitHub."""
    key, value = f"url.{host.as_uri()}/.insteadOf", "https://github.com/"
    return {"GIT_CONFIG_COUNT": "1", "GIT_CONFIG_KEY_0": key, "GIT_CONFIG_VALUE_0": value}


def nothing(_runner: Runner, _given: Mapping[str, str]) -> Done:
    """Stand in for an action that is not needed here."""
    return Done(0, "", "")


def installed(runner: Runner, action: Path, version: str = "") -> int:
    """Run the steps of the action that install it; return the exit code."""
    runner.contexts = {
        "github.action_path": str(action),
        "github.action_repository": "",  # some runners leave it empty
        "inputs.version": version,
    }
    restored = list[Mapping[str, str]]()

    def restore(_runner: Runner, given: Mapping[str, str]) -> Done:
        restored.append(given)
        return Done(0, "", "")

    runner.actions = {CACHE: restore}
    *install, _ = load(ROOT / "action.yml")["runs"]["steps"]
    code = runner.job(install)
    is_restored = code != 2  # an input that is refused is refused before
    folder = str(runner.temp / "grader-downloads")
    assert [given["path"] for given in restored] == ([folder] if is_restored else [])
    assert all(
        re.fullmatch(r"grader-Linux-X64-3\.\d+-[0-9a-f]{64}", given["key"]) for given in restored
    )
    return code


@pytest.fixture(scope="package")
def temp(tmp_path_factory: pytest.TempPathFactory, published: Path) -> Path:
    """Return the temporary folder of a job, in which the action is installed once."""
    temp = tmp_path_factory.mktemp("temp")
    runner = Runner(temp, temp)
    assert installed(runner, published / "YOUR-ORG/grader") == 0, runner.done
    return temp


class Job:
    """The last step of the action, in a student's repository."""

    def __init__(self, workspace: Path, temp: Path) -> None:
        self.runner = Runner(workspace, temp)
        action = load(ROOT / "action.yml")
        self.step = action["runs"]["steps"][-1]
        self.defaults = {
            f"inputs.{name}": about["default"] for name, about in action["inputs"].items()
        }

    def grade(self, **inputs: str) -> Done:
        """Run the step with some inputs; `_` in a name stands for `-`."""
        given = {f"inputs.{name.replace('_', '-')}": value for name, value in inputs.items()}
        self.runner.contexts = {**self.defaults, **given}
        self.runner.summary = ""
        return self.runner.step(self.step)

    def output(self, name: str) -> str:
        """Return one of the outputs."""
        return self.runner.value(f"${{{{ steps.grade.outputs.{name} }}}}")


@pytest.fixture
def job(tmp_path: Path, temp: Path) -> Job:
    """Return a job in a repository that contains the reference."""
    shutil.copytree(ROOT / "submissions/lab6/reference", tmp_path / "work")
    return Job(tmp_path / "work", temp)


def test_a_green_check(job: Job) -> None:
    """A robot without mistakes exits with 0 and has score, summary and reports."""
    done = job.grade()
    assert done.code == 0, done.stderr
    assert (job.output("score"), job.output("max-score"), job.output("pending")) == (
        "90",
        "100",
        "10",
    )
    assert job.runner.summary.startswith("# lab6: ")
    assert "90 of 90 points" in job.runner.summary
    for kind in ("json", "markdown", "junit", "html", "svg"):
        assert Path(job.output(f"report-{kind}")).stat().st_size > 0, kind
    assert json.loads(Path(job.output("report-json")).read_text(encoding="utf-8"))["score"] == 90
    assert "::error" not in done.stderr + done.stdout


def test_a_red_check(job: Job, tmp_path: Path) -> None:
    """A mistake exits with 1, is annotated on its line, and the outputs are set all the same."""
    [urdf] = (tmp_path / "work").rglob("*.urdf")
    urdf.write_bytes(
        (ROOT / "submissions/lab6/several-mistakes/my_robot/urdf/my_robot.urdf").read_bytes()
    )
    done = job.grade()
    path = urdf.relative_to(tmp_path / "work").as_posix()
    assert done.code == 1
    title = "-8 points%3A lidar-frame 6%2C lidar-on-top 2"
    assert (
        f"::error file={path},line=39,endLine=39,col=15,endColumn=30,title={title}::" in done.stderr
    )
    assert job.output("score") == "63"
    assert "lidar-frame" in job.runner.summary


def test_inputs(job: Job) -> None:
    """Threshold, parts, path and rubric are those of the inputs."""
    done = job.grade(part="task1\nquestions", path=".")
    assert (done.code, job.output("max-score")) == (0, "78")
    [setup] = (job.runner.workspace).rglob("setup.py")
    setup.write_text(setup.read_text(encoding="utf-8").replace("import os\n", ""), encoding="utf-8")
    assert job.grade().code == 1
    assert job.grade(fail_under="90%").code == 1
    assert job.grade(fail_under="88").code == 0
    assert job.grade(rubric="no-such-lab").code == 2
    assert job.grade(expect_rubric="0" * 64).code == 2
    assert job.grade(fail_under="88", expect_rubric=load_rubric("lab6").sha256).code == 0


def test_nothing_graded(job: Job, tmp_path: Path) -> None:
    """If nothing can be graded, the check is red, says why, and sets no score, not even an older one."""
    assert job.grade().code == 0
    shutil.rmtree(tmp_path / "work")
    (tmp_path / "work").mkdir()
    done = job.grade()
    assert done.code == 2
    assert "::error title=Nothing was graded::" in done.stderr
    assert "Nothing was graded" in job.runner.summary
    assert (job.output("score"), job.output("report-json")) == ("", "")


def test_inputs_are_not_executed(job: Job, tmp_path: Path) -> None:
    """No input is run as a command or read as an option."""
    for text in (
        "$(touch owned)",
        "; touch owned",
        "`touch owned`",
        '" && touch owned "',
        "--help",
    ):
        for name in ("path", "rubric", "part", "fail_under", "expect_rubric"):
            assert job.grade(**{name: text}).code == 2, (name, text)
    assert not list(tmp_path.rglob("owned"))


def test_modules_in_the_repository_are_not_imported(job: Job, tmp_path: Path) -> None:
    """Files named like Python's own modules, or like the grader, are not imported."""
    for name in (
        "json.py",
        "sys.py",
        "grader.py",
        "typing.py",
        "sitecustomize.py",
        "venv.py",
        "pip.py",
    ):
        (tmp_path / "work" / name).write_text("raise SystemExit('imported')\n", encoding="utf-8")
    shutil.copytree(ROOT / "rubrics", tmp_path / "work" / "rubrics")
    done = job.grade()
    assert (done.code, job.output("score")) == (0, "90"), done.stderr


def test_the_student_workflow(tmp_path: Path, temp: Path) -> None:
    """The template for student repositories runs from checkout to artifact, green and red."""
    workflow = load(WORKFLOWS / "student-repository.yml")
    kept: list[str] = []

    def upload(runner: Runner, given: Mapping[str, str]) -> Done:
        kept.extend(
            sorted(path.name for path in map(Path, given["path"].split()) if path.is_file())
        )
        return Done(0, "", "")

    for sample, code in (("reference", 0), ("missing-import-os", 1)):
        shutil.copytree(ROOT / "submissions/lab6" / sample, tmp_path / sample)
        runner = Runner(tmp_path / sample, temp)
        runner.actions = {
            CHECKOUT: nothing,
            "YOUR-ORG/grader@v1": composite(ROOT, only="Grade"),
            UPLOAD: upload,
        }
        assert runner.job(workflow["jobs"]["grade"]["steps"]) == code, runner.done
    assert kept == ["junit.xml", "report.html", "report.json", "report.md", "report.svg"] * 2


def test_two_uses_in_a_job_keep_their_reports(tmp_path: Path, job: Job) -> None:
    """Each has a folder of its own, and the first one's has the name that a workflow expects."""
    folders = []
    for rubric in ("lab6", "diffdrive"):
        done = job.grade(rubric=rubric)
        assert done.code in (0, 1), done.stderr
        report = Path(job.output("report-json"))
        folders.append(report.parent)
        assert json.loads(report.read_text(encoding="utf-8"))["rubric"]["id"] == rubric
    assert folders[0] != folders[1]
    first = json.loads((folders[0] / "report.json").read_text(encoding="utf-8"))
    assert first["rubric"]["id"] == "lab6"
    assert {path.name for path in folders[0].iterdir()} == {
        path.name for path in folders[1].iterdir()
    }


def test_a_changed_package_is_not_installed(tmp_path: Path, published: Path) -> None:
    """A file whose hash is not in the lock stops the installation, wherever it is from."""
    source = tmp_path / "grader"
    shutil.copytree(published / "YOUR-ORG/grader", source)
    lock = source / "requirements.lock"
    lock.write_text(re.sub(r"sha256:\w{8}", "sha256:00000000", lock.read_text()))
    assert installed(Runner(tmp_path, tmp_path), source) == 1


def test_a_version_is_taken_from_the_repository(tmp_path: Path, published: Path) -> None:
    """The input `version` installs that tag; anything that is no tag is refused before the installation."""
    runner = Runner(tmp_path, tmp_path, instead_of_github(published))
    for version, code in (("; touch owned", 2), ("--help", 2), ("v1", 0)):
        path = tmp_path / f"_actions/YOUR-ORG/grader/{version}"
        assert installed(runner, path, version) == code, runner.done
    done = subprocess.run(
        [tmp_path / "grader-venv/bin/grader", "--version"], capture_output=True, check=False
    )
    assert done.stdout.startswith(b"grader ")
    assert not (tmp_path / "owned").exists()


def too_large(host: Path) -> None:
    """Make repositories that no runner should check out: large to fetch, large when unpacked, with many files."""
    for name in ("lab6-pushed", "lab6-zeros", "lab6-many"):
        (host / name).mkdir()
    (host / "lab6-pushed" / "video.mp4").write_bytes(random.Random(1).randbytes(3 * 2**20))
    (host / "lab6-zeros" / "zeros.txt").write_bytes(bytes(3 * 2**20))
    for number in range(201):
        (host / "lab6-many" / f"{number}.txt").touch()
    for name in ("lab6-pushed", "lab6-zeros", "lab6-many"):
        repository(host / name)


def test_the_class_workflow(tmp_path: Path, published: Path) -> None:
    """The template for a class organisation fetches and grades every student's repository, even if some are broken."""
    host = tmp_path / "host"
    for name, sample in (
        ("lab6-ada", "reference"),
        ("lab6-grace", "missing-import-os"),
        ("other", "reference"),
    ):
        shutil.copytree(ROOT / "submissions/lab6" / sample, host / name)
        repository(host / name)
    too_large(host)
    (host / "lab6-none").mkdir()
    git(host / "lab6-none", "init", "--quiet")
    bin_ = tmp_path / "bin"
    bin_.mkdir()
    (bin_ / "gh").write_text(
        "#!/usr/bin/env bash\n"
        f'if [ "$2" = list ]; then ls "{host}"; echo lab6-gone; exit; fi\n'  # without templates, as --jq says
        f'git clone --quiet "file://{host}/${{3#*/}}" "$4" "${{@:6}}"\n',
        encoding="utf-8",
    )
    (bin_ / "gh").chmod(0o755)
    workflow = load(WORKFLOWS / "class.yml")
    runner = Runner(tmp_path / "instructors", tmp_path / "temp")
    for folder in (runner.workspace, runner.temp):
        folder.mkdir()
    (runner.workspace / "roster.csv").write_text(
        "login,name\nada,Ada L\ngrace,Grace H\nalan,Alan T\n", encoding="utf-8"
    )
    runner.variables = {"PATH": f"{bin_}{os.pathsep}{os.environ['PATH']}"}
    runner.contexts = {"secrets.CLASS_TOKEN": "none"}

    def checkout(runner: Runner, given: Mapping[str, str]) -> Done:
        if "repository" in given:
            git(
                runner.workspace,
                "clone",
                "--quiet",
                str(published / given["repository"]),
                given["path"],
            )
        return Done(0, "", "")

    runner.actions = dict.fromkeys((PYTHON, UPLOAD), nothing)
    runner.actions[CHECKOUT] = checkout
    limits = {
        **{name: str(value) for name, value in workflow["env"].items()},
        "MAX_MEGABYTES": "2",
        "MAX_FILES": "200",
    }
    assert runner.job(workflow["jobs"]["grade"]["steps"], limits) == 0, runner.done
    printed = "".join(done.stdout for _, done in runner.done)
    for name in ("gone", "pushed"):
        why = (
            "Not graded: this repository could not be fetched, or is larger than MAX_MEGABYTES (2)."
        )
        assert f"::warning title=lab6-{name}::{why}" in printed
    for name in ("many", "zeros"):
        why = "Not graded: it has more than MAX_MEGABYTES (2) or MAX_FILES (200) in this workflow."
        assert f"::warning title=lab6-{name}::{why}" in printed
    assert {path.name for path in (runner.temp / "class").iterdir()} == {
        "lab6-ada",
        "lab6-grace",
        "lab6-none",
    }
    assert "::warning title=lab6-none::This repository is empty." in printed
    grades = (runner.temp / "grades" / "grades.csv").read_text(encoding="utf-8")
    assert len(grades.splitlines()) == 5  # a header, the roster, and the empty one
    expected = {f"{name}.{ending}" for name in ("ada", "grace", "none") for ending in ("md", "svg")}
    assert {path.name for path in (runner.temp / "grades" / "reports").iterdir()} == expected


def test_the_classroom50_autograder(tmp_path: Path, published: Path) -> None:
    """The autograder for Classroom 50 writes both files to the student's checkout, and exits with 0 for a low mark."""
    work = tmp_path / "work"
    shutil.copytree(ROOT / "submissions/lab6/missing-import-os", work)
    (tmp_path / "victim").write_text("precious")
    (work / "result.json").symlink_to(tmp_path / "victim")
    (work / "release-body.md").mkdir()
    urls = ("COMMIT_URL", "RELEASE_URL", "REVIEW_URL")
    who = {
        "CLASSROOM": "robo",
        "ASSIGNMENT": "lab6",
        "USERNAME": "ada",
        **dict.fromkeys(urls, "https://example.org"),
    }
    variables = {
        **who,
        "SUBMISSION_TAG": "submit/2026-09-01T10-00-00Z-ab12cd3",
        **instead_of_github(published),
    }
    done = subprocess.run(
        [sys.executable, str(WORKFLOWS / "classroom50.py")],
        cwd=work,
        env={**os.environ, **variables},
        capture_output=True,
        check=False,
        timeout=HANG_TIMEOUT,
    )
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "victim").read_text() == "precious"
    result = json.loads((work / "result.json").read_text(encoding="utf-8"))
    assert (result["owner"], result["score"], result["max-score"]) == ("ada", 88, 90)
    assert "setup-imports" in (work / "release-body.md").read_text(encoding="utf-8")
    (work / "result.json").write_text('{"score": 90}')
    forged = subprocess.run(
        [sys.executable, str(WORKFLOWS / "classroom50.py")],
        cwd=work,
        env={**os.environ, **variables, "SUBMISSION_TAG": "none"},
        capture_output=True,
        check=False,
        timeout=HANG_TIMEOUT,
    )
    assert forged.returncode == 2
    assert not (work / "result.json").exists()


@pytest.mark.parametrize(
    ("sample", "code"), [("reference", 0), ("missing-import-os", 1), ("xacro-in-urdf", None)]
)
def test_the_gitlab_job(tmp_path: Path, published: Path, sample: str, code: int | None) -> None:
    """The exit code is the grader's; reports are not written through a student's symlinks, and old reports are removed."""
    work = tmp_path / "work"
    shutil.copytree(ROOT / "submissions/lab6" / sample, work)
    (tmp_path / "victim").mkdir()
    (work / "grader-reports").symlink_to("../victim")
    job = load(WORKFLOWS / "gitlab-ci.yml")["lab6"]
    grader = Path(sys.executable).with_name("grader")
    script = "\n".join(["set -e", *job["script"]]).replace("/tmp/", f"{tmp_path}/")
    variables = {
        **os.environ,
        **instead_of_github(published),
        **job["variables"],
        "PIP_CACHE_DIR": str(tmp_path / "cache"),
        "CI": "true",
        "CI_PROJECT_DIR": str(work),
    }
    done = subprocess.run(
        ["bash", "-c", script], cwd=work, env=variables, capture_output=True, text=True, check=False
    )
    alone = subprocess.run([grader, "grade", work], capture_output=True, check=False)
    assert done.returncode == (alone.returncode if code is None else code), done.stderr
    assert list((tmp_path / "victim").iterdir()) == []
    kept = [*job["artifacts"]["paths"], *job["artifacts"]["reports"].values()]
    assert all((work / path).stat().st_size for path in kept)
    assert "|| true" not in script
