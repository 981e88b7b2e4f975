"""A small lab, and a class of it on disk."""

import subprocess
from pathlib import Path

from grader.lab.rubric.rubric import Rubric, read_rubric
from tests.command_line import clean_environment, run_with_input
from tests.samples import ROOT

POINTS = {"loads": "3", "box": "2.5", "tall": "0.5", "essay": "4", "picture": "1"}
_TOLERANCE = "tolerance = 0.001"
_CRITERIA = {
    "loads": 'part = "robot"\ncheck = "urdf_loads"',
    "box": f'part = "robot"\ncheck = "shows_box"\nwith = {{ link = "base", size = [1, 1, 1], {_TOLERANCE} }}',
    "tall": 'part = "robot"\nrequires = ["box"]\ncheck = "bottom_at_height"\n'
    f'with = {{ link = "base", relative_to = "base", height = -0.5, {_TOLERANCE} }}',
    "essay": 'part = "report"\ncheck = "answered"\n'
    'with = { question = "Why?", answer = "Because of the roots.", places = ["step 1"] }',
    "picture": 'part = "report"\ncheck = "evidence_shown"\nwith = { names = ["screen"] }',
}
ENVIRONMENT = clean_environment()
HOSTILE = ROOT / "tests" / "classroom" / "hostile"


def lab_text(late: str = "", **points: str) -> str:
    """Return the lab as TOML; `points` overrides those of some criteria, `late` is the table of the late policy."""
    worth = {name: points.get(name, POINTS.get(name, "1")) for name in (*POINTS, *points)}
    rows = [
        f'[[criterion]]\nid = "{name}"\ntitle = "About {name}"\npoints = {value}\n{_CRITERIA.get(name, _CRITERIA["loads"])}'
        for name, value in worth.items()
    ]
    parts = '[[part]]\nid = "robot"\ntitle = "Robot"\n\n[[part]]\nid = "report"\ntitle = "Report"\nneeds = "files"'
    policy = f"[late]\n{late}" if late else ""
    return "\n\n".join(
        ['id = "small"\ntitle = "A small lab"\nurdf = "robot.urdf"', parts, *rows, policy]
    )


def lab(late: str = "", **points: str) -> Rubric:
    """Return the lab as a rubric."""
    return read_rubric(lab_text(late, **points).encode(), Path("small.toml"))


def grader(
    *arguments: object, stdin: str | bytes = "", **variables: str
) -> subprocess.CompletedProcess[str]:
    """Run the command line from the project's root."""
    done = run_with_input(
        arguments, stdin if isinstance(stdin, bytes) else stdin.encode(), variables
    )
    out, err = done.stdout.decode(), done.stderr.decode()
    return subprocess.CompletedProcess(done.args, done.returncode, out, err)


def refusal(done: subprocess.CompletedProcess[str]) -> str:
    """Return the single line in which a command was refused."""
    assert done.returncode == 2, done
    assert done.stdout == "", done
    assert done.stderr.startswith("grader: "), done
    assert done.stderr.count("\n") == 1, done
    assert done.stderr[:-1].isprintable(), done
    return done.stderr.removeprefix("grader: ").rstrip("\n")


def urdf(size: str = "1 1 1") -> str:
    """Return a robot of one box."""
    return f'<robot name="r"><link name="base"><visual><geometry><box size="{size}"/></geometry></visual></link></robot>'


PNG = bytes.fromhex(
    "89504e470d0a1a0a0000000d49484452000000010000000108060000001f15c4890000000d49444154789c6360000002000001e221bc330000"
    "000049454e44ae426082"
)


def write_submission(folder: Path, size: str = "1 1 1", answer: str = "") -> None:
    """Write a submission with everything that the lab asks for, by default with an answer of its own."""
    folder.mkdir(parents=True)
    (folder / "robot.urdf").write_text(urdf(size))
    (folder / "answers.md").write_text(f"# Step 1\n\n{answer or f'The roots of {folder.name}.'}\n")
    (folder / "screen.png").write_bytes(PNG)


ROSTER = """\
id,name,email,login,canvas id
anna,Anna Ek,anna@example.org,ae1,101
ben,Ben Oh,ben@example.org,bo2,102
cleo,Cleo Ray,cleo@example.org,cr3,103
dora,Dora Fi,dora@example.org,df4,104
emil,Ben Oh,emil@example.org,eo5,105
"""


def make_class(top: Path, late: str = "") -> Path:
    """Make a class (anna correct, ben a single URDF, cleo no zip, dora missing, emil a wrong box); return the lab's path."""
    folder = top / "class"
    write_submission(folder / "anna")
    (folder / "ben.urdf").write_text(urdf())
    (folder / "cleo.zip").write_bytes(b"PK\x03\x04 broken")
    write_submission(folder / "emil", "1 1 2", "[bold]\x1b[31mRed\x1b[0m roots[/bold] \u202eturned")
    (top / "roster.csv").write_text(ROSTER)
    (top / "small.toml").write_text(lab_text(late))
    return top / "small.toml"


def batch(top: Path, *more: object, rubric: object = None) -> subprocess.CompletedProcess[str]:
    """Grade the class into the folder `book`."""
    return grader(
        "batch",
        top / "class",
        "--gradebook",
        top / "book",
        "--rubric",
        rubric or top / "small.toml",
        "--roster",
        top / "roster.csv",
        "--jobs",
        2,
        *more,
    )
