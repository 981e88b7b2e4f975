"""The class in submissions/class: the files of twelve invented students, made from samples as students.toml says."""

import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from grader.files.zip_writing import make_zip
from tests.samples import ROOT, SAMPLES

FOLDER = ROOT / "submissions/class"
STUDENTS: list[dict[str, Any]] = tomllib.loads(
    (FOLDER / "students.toml").read_text(encoding="utf-8")
)["student"]
_EVIDENCE = ROOT / "submissions/lab6/reference/evidence"
_FIRST_USER, _FIRST_UPLOAD = 101, 5001  # Canvas numbers users and uploads
_BROKEN_AFTER = 3000  # bytes
TOP = """\
# A class of twelve invented students

`files/` is what Canvas gives with *Download Submissions*, and `roster.csv` has the names. From the folder of the checkout:

```sh
grader batch submissions/class/files --roster submissions/class/roster.csv --due 2026-11-20T23:59+01:00
```

[Grade a class](../../docs/grade-a-class.md) says what follows. All names are invented; all files here are written from
`students.toml` by `python tests/sample_files.py`.

| student | what was submitted | points of 90, before manual grading |
|---|---|---|
"""


def package_files(folder: Path) -> dict[str, bytes]:
    """Return the files of a package, except those in its folder `urdf`."""
    files = {
        path.relative_to(folder): path
        for path in folder.rglob("*")
        if path.is_file() and path.suffix != ".pyc"
    }
    return {
        path.as_posix(): file.read_bytes()
        for path, file in files.items()
        if path.parts[0] != "urdf"
    }


def class_files() -> Iterator[tuple[Path, bytes]]:
    """Yield the path of each file that is made from students.toml, and its content."""
    ids = range(_FIRST_USER, _FIRST_USER + len(STUDENTS))
    rows = (
        f"{row['name'].split()[1].lower()},{row['name']},{user}\n"
        for user, row in zip(ids, STUDENTS, strict=True)
    )
    yield FOLDER / "roster.csv", "".join(("id,name,canvas id\n", *rows)).encode()
    about = (
        f"| {row['name']} | {row['about']} | {row.get('points', 'none')} |\n" for row in STUDENTS
    )
    yield FOLDER / "README.md", "".join((TOP, *about)).encode()
    for number, student in enumerate(STUDENTS):
        first, last = student["name"].lower().split()
        late = "_LATE" * student.get("is_late", False)
        for upload, (name, data) in enumerate(_uploads(student)):
            canvas = f"{_FIRST_USER + number}_{_FIRST_UPLOAD + number + 100 * upload}"
            yield FOLDER / "files" / f"{last}{first}{late}_{canvas}_{name}", data


def _uploads(student: dict[str, Any]) -> Iterator[tuple[str, bytes]]:
    """Yield the files that a student uploaded, in order."""
    if "robot" not in student:
        return
    pictures = {name: (_EVIDENCE / name).read_bytes() for name in student.get("pictures", ())}
    pictures = pictures or {path.name: path.read_bytes() for path in sorted(_EVIDENCE.iterdir())}
    robot = _urdf(student["robot"])
    package = student.get("package", "reference")
    if not package:
        yield from {robot.name: robot.read_bytes(), **pictures}.items()
        return
    files = {
        f"my_robot/{path}": data
        for path, data in package_files(_urdf(package).parent.parent).items()
    } | pictures
    if "answers" in student:
        answers = zip(("Task 1, Step 15", "Task 2, Step 2"), student["answers"], strict=True)
        files["answers.md"] = "\n".join(
            f"## {step}\n\n{answer}\n" for step, answer in answers
        ).encode()
    robots = [*map(_urdf, filter(None, [student.get("first")])), robot]
    for number, urdf in enumerate(robots):
        data = make_zip({**files, "my_robot/urdf/my_robot.urdf": urdf.read_bytes()})
        yield (
            f"lab6-{number}.zip" if number else "lab6.zip",
            data[: _BROKEN_AFTER if student.get("is_broken") else None],
        )


def _urdf(sample: str) -> Path:
    """Return the URDF in the package of a sample."""
    return next(SAMPLES[sample].expected.folder.rglob("my_robot/urdf/my_robot.urdf"))
