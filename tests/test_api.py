"""The Python API: docs/python.md lists it, its examples run, and a type checker accepts them."""

import ast
import contextlib
import io
import json
import os
import pydoc
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import grader
from grader.report.formats import Format, render
from tests.command_line import ROOT, run

PAGE = (ROOT / "docs" / "python.md").read_text(encoding="utf-8")
EXAMPLES = re.findall(r"```python\n(.*?)```\n\n```text\n(.*?)```", PAGE, re.DOTALL)
COURSE_TESTS = [
    code for code in re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL) if "import pytest" in code
]
SAMPLES = ROOT / "submissions/lab6"


def test_the_stub_and_the_page_name_what_there_is() -> None:
    """Every public name can be used, is typed in the stub, and is on the page, and these have no other name."""
    public = {name for name in vars(grader)["_MODULES"] if getattr(grader, name)}
    stub = ast.parse((ROOT / "grader" / "__init__.pyi").read_text(encoding="utf-8"))
    typed = {
        alias.name for node in stub.body if isinstance(node, ast.ImportFrom) for alias in node.names
    }
    assert (
        typed
        == public
        == {name for name in public if re.search(rf"`{name}\b", PAGE)} | {"Reading", "Rubric"}
    )
    assert public <= set(dir(grader))
    assert public == set(grader.__all__)
    with pytest.raises(AttributeError, match="has no attribute 'grad'"):
        grader.grad  # type: ignore[attr-defined]  # noqa: B018


@pytest.mark.parametrize(("code", "shown"), EXAMPLES)
def test_the_examples_print_what_the_page_shows(code: str, shown: str, tmp_path: Path) -> None:
    """With a sample as my_robot.urdf."""
    shutil.copy(SAMPLES / "lidar-offset-in-visual/my_robot/urdf/my_robot.urdf", tmp_path)
    with contextlib.chdir(tmp_path), contextlib.redirect_stdout(io.StringIO()) as printed:
        exec(code, {})
    assert printed.getvalue() == shown


@pytest.mark.slow
@pytest.mark.parametrize(
    "path",
    [
        "several-mistakes",
        "reference",
        "pictures-only",
        "lidar-over-the-edge/my_robot/urdf/my_robot.urdf",
    ],
)
def test_a_report_is_that_of_the_command(path: str) -> None:
    """Points, messages and hints, with a rubric by id, by path, and loaded."""
    printed = json.loads(run(("grade", SAMPLES / path, "--format", "json")).stdout)
    for rubric in ("lab6", ROOT / "rubrics/lab6/rubric.toml", grader.load_rubric("lab6")):
        assert json.loads(render(grader.grade(SAMPLES / path, rubric), Format.JSON)) == printed


def test_parts_are_graded_alone() -> None:
    """As with --part; an unknown one is refused."""
    report = grader.grade(SAMPLES / "reference", parts=["task2"])
    assert report.results == grader.grade(str(SAMPLES / "reference"), parts="task2").results
    assert f"{report.score}/{report.max_score}" == "20/20"
    with pytest.raises(grader.GraderError, match="has no part 'task9'"):
        grader.grade(SAMPLES / "reference", parts=["task9"])


def test_what_cannot_be_graded_raises_one_error(tmp_path: Path) -> None:
    """A missing file and a broken rubric."""
    (tmp_path / "lab.toml").write_text("id = 3", encoding="utf-8")
    with pytest.raises(grader.GraderError, match="does not exist"):
        grader.grade(tmp_path / "none.urdf")
    with pytest.raises(grader.RubricError):
        grader.grade(SAMPLES / "reference", tmp_path / "lab.toml")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("number", "variable", "sample", "failed"),
    [
        (0, "URDF", "reference", []),
        (0, "URDF", "lidar-offset-in-visual", ["test_lidar"]),
        (1, "SUBMISSION", "reference", []),
        (1, "SUBMISSION", "lidar-offset-in-visual", ["test_criterion[lidar-frame]"]),
    ],
)
def test_the_tests_of_a_course_run(
    number: int, variable: str, sample: str, failed: list[str], tmp_path: Path
) -> None:
    """The files to copy pass on the reference, and fail where a robot is wrong."""
    (tmp_path / "test_lab.py").write_text(COURSE_TESTS[number], encoding="utf-8")
    (urdf,) = (SAMPLES / sample).rglob("my_robot.urdf")
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "test_lab.py"]
    environment = {**os.environ, variable: str(urdf)}
    done = subprocess.run(
        command, cwd=tmp_path, env=environment, check=False, capture_output=True, text=True
    )
    assert re.findall(r"^FAILED test_lab.py::(\S+)", done.stdout, re.MULTILINE) == failed, (
        done.stdout + done.stderr
    )
    assert done.returncode == (1 if failed else 0)


def test_a_urdf_is_read_from_a_path(tmp_path: Path) -> None:
    """As from its bytes, under its own name in locations; a file that is not there is an error."""
    path = tmp_path / "my.urdf"
    path.write_text("<robot", encoding="utf-8")
    for given in (path, str(path)):
        read = grader.read_urdf(given)
        assert (read.verdict, read.problems[0].location.path) == ("rejected", str(path))
    for absent in (tmp_path / "absent", "absent.urdf"):
        with pytest.raises(grader.GraderError, match=r"cannot read .*absent"):
            grader.read_urdf(absent)


def test_help_and_star_import_give_the_public_names() -> None:
    """`python -m pydoc grader` lists the functions and types, and `from grader import *` gives them."""
    names: dict[str, object] = {}
    exec("from grader import *", names)
    assert set(grader.__all__) == names.keys() - {"__builtins__"}
    shown = pydoc.plain(pydoc.render_doc(grader))
    functions = shown[shown.index("\nFUNCTIONS\n") :]
    documented = {
        *re.findall(r"^    class (\w+)\(", shown, re.M),
        *re.findall(r"^    (\w+)\(", functions, re.M),
    }
    assert documented == set(grader.__all__)
    for name in ("Configuration", "Joint", "Link", "Robot", "Transform"):
        members = re.findall(
            r"^ \|  (_\w+)", pydoc.plain(pydoc.render_doc(getattr(grader, name))), re.MULTILINE
        )
        own = {member for member in members if not member.startswith("__")}
        assert own <= {"_asdict", "_fields", "_field_defaults", "_make", "_replace"}, name


@pytest.mark.parametrize(
    "text", ["", "<robot", "\ud800", '<robot name="a"><link name="b"/></robot>']
)
def test_a_urdf_is_read_from_text(text: str) -> None:
    """As from its bytes, whatever is in it."""
    read, same = grader.read_urdf(text), grader.read_urdf(text.encode("utf-8", "surrogatepass"))
    assert (read.verdict, read.robot, read.problems) == (same.verdict, same.robot, same.problems)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("code", "modules"),
    [
        ("import grader", ("grader.", "lxml")),
        (
            "import grader; grader.grade('submissions/lab6/lidar-offset-in-visual/my_robot/urdf/my_robot.urdf')",
            ("numpy",),
        ),
    ],
)
def test_the_import_is_light(code: str, modules: tuple[str, ...]) -> None:
    """`import grader` loads no other module of the grader and no library; a URDF is graded without numpy."""
    listed = (
        f"import sys; {code}; print([name for name in sys.modules if name.startswith({modules})])"
    )
    done = subprocess.run(
        [sys.executable, "-c", listed], cwd=ROOT, check=True, capture_output=True, text=True
    )
    assert done.stdout == "[]\n"


@pytest.mark.exhaustive
def test_a_type_checker_accepts_the_examples(tmp_path: Path) -> None:
    """`mypy --strict` knows all types as a user has them, and finds a wrong name and a wrong type."""
    pytest.importorskip("mypy")
    for number, (code, _) in enumerate(EXAMPLES):
        (tmp_path / f"example_{number}.py").write_text(code, encoding="utf-8")
    wrong = 'import grader\ngrader.grade(3)\ngrader.grade("a").scor\nscore: str = grader.grade("a").score\n'
    (tmp_path / "wrong.py").write_text(wrong, encoding="utf-8")
    checked = [
        sys.executable,
        "-m",
        "mypy",
        "--strict",
        "--no-error-summary",
        "--cache-dir",
        os.devnull,
        ".",
    ]
    done = subprocess.run(checked, cwd=tmp_path, check=False, capture_output=True, text=True)
    lines = [
        re.match(r"(\S+?:\d+): error.*\[([\w-]+)\]$", line) for line in done.stdout.splitlines()
    ]
    assert [line and line.groups() for line in lines] == [
        ("wrong.py:2", "arg-type"),
        ("wrong.py:3", "attr-defined"),
        ("wrong.py:4", "assignment"),
    ], done.stdout + done.stderr


def test_the_example_of_another_tool_prints_connections_and_findings() -> None:
    """docs/examples/read_workspace.py reads a workspace by its API alone."""
    script = ROOT / "docs/examples/read_workspace.py"
    sample = ROOT / "submissions/diffdrive/spawner-misspelt"
    command = [sys.executable, str(script), str(sample)]
    done = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True)
    *_, joined, finding = done.stdout.splitlines()
    assert joined == "topic /joint_states: /joint_state_broadcaster -> /robot_state_publisher"
    assert "launch.py:38: REF003 controller-defined: spawner: there is no controller" in finding


def test_a_robot_is_shown_by_its_values() -> None:
    """Its representation says what it has."""
    robot = grader.read_urdf('<robot name="arm"><link name="base"/></robot>').robot
    assert repr(robot).startswith("Robot('arm', (Link(")
