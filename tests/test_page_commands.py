"""The command lines on the pages can be run as they are written, in a folder with the files that the pages presume.

Each line of a `sh` block, and each command in the text that names its arguments, is run here, or by another test, or is
in `NOT_RUN` with the reason. The tutorials are followed by tests of their own, which compare the outputs too.
"""

import os
import re
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.checkout import checkout
from tests.command_line import HANG_TIMEOUT, ROOT, clean_environment, run_with_input
from tests.tutorial import follow, run_commands
from tests.wheels import offline

pytestmark = pytest.mark.exhaustive

PAGES = sorted(
    [
        *(ROOT / name for name in ("README.md", "CONTRIBUTING.md")),
        *(ROOT / "docs").glob("*.md"),
        *(ROOT / "rubrics").glob("*/README.md"),
        *(ROOT / "submissions").glob("*/README.md"),
    ]
)
FOLLOWED = {  # pages whose blocks belong together
    "write-a-rubric.md": "test_tutorial.py",
    "code-lab.md": "test_tutorial.py",
    "change-dimensions.md": "here: test_the_page_on_dimensions",
    "ci.md": "here: test_the_set_up_of_ci",
    "installation.md": "here: test_the_installation",
}
OTHER_FILES = {
    "recordings.md": {
        "solution": "submissions/rover/equivalent-recorded"
    },  # what only these pages presume, and what it is
    "grade-one-submission.md": {"arm.urdf": "rubrics/arm/arm.urdf"},
    "gradescope.md": {"my_lab.toml": "rubrics/arm/rubric.toml"},
    "graph.md": {"rubrics/diffdrive": "rubrics/diffdrive"},
    "inspect.md": {
        "submissions/diffdrive/spawner-misspelt": "submissions/diffdrive/spawner-misspelt"
    },
    "rubric-test.md": {"my_lab.toml": "rubrics/arm/rubric.toml"},
    "grade-a-class.md": {
        "my_lab.toml": "rubrics/lab6/rubric.toml",
        "my_robot": "rubrics/lab6/my_robot",
    },
}
ELSEWHERE = {  # beginnings of command lines that another test runs
    "python3 -m venv .venv && .venv/bin/pip install": ".ci/run",
    ".venv/bin/python -m pytest": ".ci/run",
    ".venv/bin/ruff check": ".ci/run",
    "grader batch submissions --roster canvas.csv": "classroom/test_walkthrough.py",
    'grader mark "Anik Tagrigri"': "classroom/test_walkthrough.py",
    'grader mark "Ilu Lopelgri"': "classroom/test_walkthrough.py",
    "grader mark 100099": "classroom/test_walkthrough.py",
    "grader review --by": "browser/test_review.py",
    "grader view submissions": "cli/test_view.py",
    "pip install --editable '.[test]'": "cli/test_plugin_template.py",
    "pytest": "cli/test_plugin_template.py",
    "grader explain distance_between": "cli/test_plugin_template.py",
    "grader rubric check arm_lab.toml": "cli/test_plugin_template.py",
    "pip install pre-commit && pre-commit install": "ci/test_pre_commit.py",
    "pre-commit run --all-files": "ci/test_pre_commit.py",
}
NOT_RUN = {  # beginnings of command lines that no test runs, and why
    ".venv/bin/pip install --upgrade 'pip>=25.1'": "takes what .ci/run installs from the network",
    "uv pip compile ": "takes the newest versions from the network",
    "ros2 launch ": "needs ROS 2; cli/test_log_option.py runs the pipe",
    "ros2 bag record ": "needs ROS 2; tests/recordings/writing.py writes such files",
    "docker ": "needs Docker; ci/test_templates.py runs what the image runs",
}
CODES = {  # the robot has a mistake
    "grader grade ": 1,
    "grader grade submissions/lab6/reference": 0,
    "grader inspect submissions/diffdrive/spawner-misspelt": 1,
}
FOLDERS = dict.fromkeys(
    ("grader grade . ", "grader grade  ", "grader grade`"), "src/my_robot"
)  # a student's repository
PLACEHOLDERS = {
    "COMMAND": "grade",
    "EXPORTED": "canvas.csv",
    "FOLDER": "copied",
    "LEVEL": "place",
    "LMS": "canvas",
    "NEWPATH": "submissions",
    "PATH": "my_robot.urdf",
    "RULE": "topic-type",
    "STUDENT": "alice",
    "TIME": "2026-11-20T23:59+01:00",
    "<id>": "lab6",
    "arm/NAME": "arm/axis-sign",
    "lab6/NAME": "lab6/reference",
    "rover/NAME": "rover/mass-on-top",
    "sensors/NAME": "sensors/no-xacro",
    "diffdrive/NAME": "diffdrive/gui-always",
    "schema NAME": "schema report",
}
IN_TEXT = {  # commands in the text that are not run here: a test that does, or the reason
    "grader grade src/my_robot --watch": "cli/test_watch.py",
    "grader inspect --watch": "cli/test_watch.py",
    "grader inspect drive": "recordings/test_inspect.py",
    "grader view my_robot": "recordings/test_playback.py",
    "grader view drive --log run.log": "recordings/test_playback.py",
    "grader graph ws --recorded drive": "recordings/test_graph.py",
    "grader view src/my_robot --rubric lab6": "cli/test_view.py",
    "grader --install-completion": "changes the files of the shell; corpus/refusals.toml",
    "grader rubric new my_lab.toml --from solution.urdf": "docs/index.md has the same",
}
OTHER_PROGRAMS = {  # commands of other programs in the text of the README and of docs/: a test that runs them, or why none does
    "git clone https://github.com/urdf-grader/urdf-grader": "nothing is published yet",
    "pip install 'urdf-grader[recordings]'": "nothing is published yet; .ci/run installs what the extra has",
    "pip install --editable '.[editor]'": "walks/editor.md installs the wheel with this extra",
    "python -m tests.parameters.make_known CHECKOUT...": "needs checkouts of ros2_control and ros2_controllers",
    "gh repo edit YOUR-ORG/NAME --template": "needs GitHub",
    "python CHECKOUT/benchmarks/class_generator.py submissions --count 121 --kind mixed --layout canvas --lms canvas.csv": "classroom/test_walkthrough.py",
    "ssh -L 8000:127.0.0.1:8000 host": "needs another machine",
    "uv tool install .": "installs for the user; tried by hand with uv 0.13",
    "uvx --from . grader grade my_robot.urdf": "needs uv; tried by hand with uv 0.13",
    "pipx install .": "installs for the user; tried by hand with pipx 1.18",
    "wsl --install": "needs Windows",
    "python -m grader": "an example of what not to do",
    "python -I -m grader": "bundle/test_setup.py",
    "python3 -m venv .venv": "here: test_the_installation",
    "sudo apt install python3-venv": "installs for the whole machine",
    "sudo apt install python3.11 python3.11-venv": "installs for the whole machine",
    "SUBMISSION=my_robot pytest test_rubric.py": "test_api.py",
    "URDF=my_robot.urdf pytest test_lab6.py": "test_api.py",
}
WALK_THROUGH = "grader mark 100006"  # a student of the class that docs/grade-a-class.md generates
STUDENTS = ("alice", "bob", "carol", "dave")
CANVAS = "Student,ID,SIS User ID,SIS Login ID,Section,Lab 6 (12345)\n    Points Possible,,,,,100\n"
GH = """\
#!/bin/sh -e
if [ "$1 $2" = "repo create" ]; then  # gh repo create NAME --private --source . [--remote REMOTE] --push
  git init --quiet --bare "$GH_HOST_FOLDER/$3"
  remote=origin
  if [ "$7" = --remote ]; then remote=$8; fi
  git remote add "$remote" "$GH_HOST_FOLDER/$3"
  git push --quiet --set-upstream "$remote" HEAD
  git --git-dir "$GH_HOST_FOLDER/$3" symbolic-ref HEAD "refs/heads/$(git branch --show-current)"
fi
echo "gh $*" >> "$GH_HOST_FOLDER/calls"
"""


@pytest.fixture(scope="module")
def presumed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with a robot, a package, a rubric and a class of four students with a gradebook."""
    folder = tmp_path_factory.mktemp("presumed")
    shutil.copy(
        ROOT / "submissions/lab6/lidar-offset-in-visual/my_robot/urdf/my_robot.urdf", folder
    )
    shutil.copytree(ROOT / "rubrics/lab6/my_robot", folder / "src/my_robot")
    for path in folder.glob("src/my_robot/urdf/*.urdf"):
        shutil.copy(folder / "my_robot.urdf", path)
    shutil.copy(ROOT / "rubrics/arm/arm.urdf", folder / "solution.urdf")
    shutil.copy(ROOT / "rubrics/arm/arm.urdf", folder)
    shutil.copytree(ROOT / "submissions/arm/axis-sign", folder / "samples/arm-axis-sign")
    (folder / "submissions").mkdir()
    for number, student in ((1, "alice"), (2, "bob"), (4, "dave")):  # as Canvas names them
        shutil.make_archive(
            str(folder / f"submissions/example{student}_{number}_50{number}_lab6"),
            "zip",
            folder / "src",
        )
    roster = "id,name,canvas id,participant id,section,marker\n"
    rows = CANVAS
    for number, student in enumerate(STUDENTS, start=1):
        roster += f"{student},{student.title()} Example,{number},{100 + number},Lab A,Kim\n"
        rows += f'"Example, {student.title()}",{number},{student},{student},Lab A,\n'
    (folder / "roster.csv").write_text(roster, encoding="utf-8")
    (folder / "canvas.csv").write_text(rows, encoding="utf-8")
    marks = "student,criterion,points,comment\nalice,answer-floating-link,2,short\n"
    (folder / "marks.csv").write_text(marks, encoding="utf-8")
    (folder / "marks.txt").write_text("0\n", encoding="utf-8")
    shutil.make_archive(str(folder / "submissions"), "zip", folder / "submissions")
    for _ in range(2):  # `diff` compares two runs
        done = run_with_input(
            ("batch", "submissions", "--roster", "roster.csv", "--force"), b"", folder=folder
        )
        assert done.returncode == 0, done.stderr
    return folder


def lines_of(page: Path) -> Iterator[str]:
    """Yield each line of the `sh` blocks of a page."""
    for block in blocks(page):
        yield from (line.strip() for line in block.splitlines())


def blocks(page: Path) -> list[str]:
    """Return the `sh` blocks of a page."""
    return re.findall(
        r"^ *```sh\n(.*?)^ *```", page.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE
    )


WITH_COMMANDS = [page for page in PAGES if page.name not in FOLLOWED and blocks(page)]


@pytest.mark.parametrize("page", WITH_COMMANDS, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_every_command_line_of_a_page_works(page: Path, presumed: Path, tmp_path: Path) -> None:
    """Each exit code is the expected one, and nothing is refused."""
    folder = tmp_path / "folder"
    if page.parent.name == "docs":
        shutil.copytree(presumed, folder)
    else:
        checkout(folder)
    for name, source in OTHER_FILES.get(page.name, {}).items():
        copy = shutil.copytree if (ROOT / source).is_dir() else shutil.copy
        copy(ROOT / source, folder / name)
    for line in lines_of(page):
        if line.startswith((*ELSEWHERE, *NOT_RUN)):
            continue
        line = line.replace(WALK_THROUGH, "grader mark alice")
        inside = next(
            (inside for beginning, inside in FOLDERS.items() if line.startswith(beginning)), ""
        )
        printed, code = run_commands(line, folder / inside)
        expected = [code for beginning, code in CODES.items() if line.startswith(beginning)]
        assert code == (expected or [0])[-1], (line, printed)


def codes(page: Path) -> list[str]:
    """Return what is in backticks in the text of a page."""
    text = re.sub(
        r"^ *```.*?^ *```", "", page.read_text(encoding="utf-8"), flags=re.DOTALL | re.MULTILINE
    )
    return [" ".join(code.split()) for code in re.findall(r"`([^`]+)`", text)]


def commands_in_text(page: Path) -> list[str]:
    """Return the commands of the grader in the text of a page, with values for what is written in capitals."""
    found = [code for code in codes(page) if code.startswith("grader ")]
    names = "|".join(sorted(map(re.escape, PLACEHOLDERS), key=len, reverse=True))
    return [
        re.sub(rf"(?<![\w-])({names})(?!\w)", lambda name: PLACEHOLDERS[name[1]], command)
        for command in found
    ]


def is_name(command: str) -> bool:
    """Return whether a text only names a command."""
    return bool(re.fullmatch(r"grader [a-z]+|grader (rubric|bundle|export) [a-z]+", command))


def test_every_command_in_the_text_works(presumed: Path, tmp_path: Path) -> None:
    """None is refused; a text that only names a command names one that exists."""
    folder = tmp_path / "folder"
    shutil.copytree(presumed, folder)
    for place in ("lab6", "Lab6/my_robot", "Lab6/Birch", "labs/lab6/my_robot"):
        shutil.copytree(ROOT / "rubrics/lab6/my_robot", folder / place)
    shutil.copytree(ROOT / "rubrics/lab6/my_robot", folder / "my_robot")
    shutil.copytree(ROOT / "rubrics/diffdrive", folder / "rubrics/diffdrive")
    shutil.copy(ROOT / "rubrics/lab6/rubric.toml", folder / "my_lab.toml")
    (rover,) = (ROOT / "rubrics/rover").rglob("rover.urdf")
    shutil.copy(rover, folder)
    pages = [*PAGES, ROOT / "docs/schemas/README.md"]
    for command, page in {
        command: one for one in pages for command in commands_in_text(one)
    }.items():
        line = f"{command} --help" if is_name(command) else command
        if command not in IN_TEXT:
            printed, code = run_commands(
                line, ROOT if page.parent.parent.name == "submissions" else folder
            )
            assert code in (0, 1), (line, printed)


def test_every_exception_is_on_a_page() -> None:
    """The tables name command lines and pages that exist."""
    lines = [line for page in PAGES for line in lines_of(page)]
    for beginning in (*ELSEWHERE, *NOT_RUN, *CODES):
        assert any(line.startswith(beginning) for line in lines), beginning
    assert set(IN_TEXT) <= {command for page in PAGES for command in commands_in_text(page)}
    assert set(FOLLOWED) <= {page.name for page in PAGES if blocks(page)}


def test_every_command_of_another_program_is_listed() -> None:
    """Each with its arguments in the text is run by a test, or the table says why it is not."""
    programs = re.compile(r"([A-Z]+=\S+|sudo|pipx|uvx?|wsl|gh|git|ssh|python3?|pip|docker) .*")
    pages = [
        page
        for page in PAGES
        if page.parent in (ROOT, ROOT / "docs") and page.name != "CONTRIBUTING.md"
    ]
    found = {code for page in pages for code in codes(page) if programs.fullmatch(code)}
    assert found - {"gh api", "pip install", "pip download", "pip list", "pip --group"} == set(
        OTHER_PROGRAMS
    )


def test_the_page_on_dimensions(tmp_path: Path) -> None:
    """Each command of the page prints what the page shows: lab6 with other dimensions is a rubric without mistakes."""
    page = (ROOT / "docs/change-dimensions.md").read_text(encoding="utf-8")
    followed, steps = follow(page, tmp_path)
    assert followed == page
    assert [step.code for step in steps] == [0, 2, 0, 0]


def script(text: str, folder: Path, **variables: str) -> None:
    """Run lines of a page in one shell, which stops at the first that fails."""
    done = subprocess.run(
        ["bash", "-euo", "pipefail", "-c", text],
        cwd=folder,
        env={**clean_environment(), **variables},
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        check=False,
        timeout=HANG_TIMEOUT,
    )
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_set_up_of_ci(tmp_path: Path) -> None:
    """The steps of docs/ci.md make three repositories, the first without answers; `gh` only makes them in a folder."""
    programs, host = tmp_path / "programs", tmp_path / "host"
    programs.mkdir()
    host.mkdir()
    for name, text in (("gh", GH), ("sleep", "#!/bin/sh\n")):
        (programs / name).write_text(text, encoding="utf-8")
        (programs / name).chmod(0o755)
    named = {
        f"GIT_{who}_{what}": "a@example.org"
        for who in ("AUTHOR", "COMMITTER")
        for what in ("NAME", "EMAIL")
    }
    variables = {
        **named,
        "GH_HOST_FOLDER": str(host),
        "PATH": f"{programs}{os.pathsep}{os.environ['PATH']}",
    }
    project = checkout(tmp_path / "work" / "grader")
    script(
        "git init --quiet --initial-branch main && git add --all && git commit --quiet -m All",
        project,
        **variables,
    )
    steps = [block for block in blocks(ROOT / "docs/ci.md") if "git " in block]
    script("\n".join(steps).replace("YOUR-ORG", "my-org"), project, **variables)
    for name in ("grader", "lab6-template", "grading"):
        script(f"git clone --quiet {host}/my-org/{name} {tmp_path}/{name}", tmp_path, **variables)
    assert (tmp_path / "grader/action.yml").exists()
    assert not [
        *(tmp_path / "grader").rglob("*answers.toml"),
        *(tmp_path / "grader").glob("submissions"),
    ]
    workflow = (tmp_path / "lab6-template/.github/workflows/lab6.yml").read_text(encoding="utf-8")
    assert "my-org/grader@v1" in workflow
    reference = (ROOT / "rubrics/lab6/my_robot/urdf/my_robot.urdf").read_bytes()
    assert (tmp_path / "lab6-template/my_robot/urdf/my_robot.urdf").read_bytes() == reference
    assert "my-org" in (tmp_path / "grading/.github/workflows/class.yml").read_text(
        encoding="utf-8"
    )
    assert "gh run watch --exit-status" in (host / "calls").read_text(encoding="utf-8")


def test_the_installation(tmp_path: Path) -> None:
    """The commands of docs/installation.md work in a checkout; dependencies are those that are installed here."""
    project = checkout(tmp_path / "checkout")
    wheels = tmp_path / "wheels"
    wheels.mkdir()
    variables = offline(wheels)
    lines = [
        line
        for line in lines_of(ROOT / "docs/installation.md")
        if not line.startswith(tuple(NOT_RUN))
    ]
    script("\n".join(lines), project, **variables)
