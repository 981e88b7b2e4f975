"""The content of an autograder's zip, and the cases in which none is written."""

import importlib.metadata
import json
import re
import shutil
import subprocess
import sys
import tomllib
import zipfile
from dataclasses import replace
from pathlib import Path

import pytest

from grader.app.bundle import gradescope as installed
from grader.app.bundle.gradescope import autograder_zip, package_files, requirements
from grader.base.errors import InputError
from grader.files.reading import hash_bytes
from grader.lab.checks.check import describe
from grader.lab.checks.outcome import Outcome
from grader.lab.rubric.rubric import load_rubric, shipped_rubrics
from grader.ros.urdf.kinematics import Configuration
from tests.bundle.gradescope import Autograder, environment_for, unpacked
from tests.classroom.gradebooks import grader, lab_text, write_submission
from tests.samples import LAB6, ROOT

RUBRICS = [f"grader/rubrics/{name}/rubric.toml" for name in shipped_rubrics()]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]


def members(path: Path) -> dict[str, zipfile.ZipInfo]:
    """Return the entries of a zip by their names."""
    with zipfile.ZipFile(path) as archive:
        return {entry.filename: entry for entry in archive.infolist()}


def test_the_files(bundle: Path) -> None:
    """The files that Gradescope needs are in the root, the grader is complete, and nothing else is in the zip."""
    names = members(bundle)
    files = (path.relative_to(ROOT) for path in (ROOT / "grader").rglob("*.*"))
    second = {path.as_posix() for path in files if "__pycache__" not in path.parts}
    assert {name for name in names if "/" not in name} == {
        "setup.sh",
        "run_autograder",
        "autograder.py",
        "autograder.json",
        "requirements.txt",
    }
    rendered = {name for name in names if name.startswith("grader/")}
    reference = {
        f"grader/{path.relative_to(ROOT)}"
        for path in (ROOT / "rubrics/lab6/my_robot").rglob("*")
        if path.is_file()
    }
    assert reference
    assert rendered == {
        *second,
        "grader/app/bundle/on_gradescope/run_autograder",
        *RUBRICS,
        *reference,
    }
    assert {name for name in names if "rubrics/" in name} == {*RUBRICS, *reference}
    assert not [
        name for name in names if "__pycache__" in name or name.endswith(".pyc") or "tests" in name
    ]
    assert list(names) == sorted(names)


def test_model_answers_are_excluded(bundle: Path, tmp_path: Path) -> None:
    """The zip contains no model answers: neither those of lab6 nor those that a rubric keeps in a separate file."""
    secret = "Because of the roots."
    rubric = tmp_path / "small.toml"
    text = lab_text().replace(f', answer = "{secret}"', "")
    rubric.write_text(f'answers = "small.answers.toml"\n{text}', encoding="utf-8")
    (tmp_path / "small.answers.toml").write_text(f'essay = "{secret}"\n', encoding="utf-8")
    done = grader("bundle", "gradescope", tmp_path / "own.zip", "--rubric", rubric)
    assert done.returncode == 0, done.stderr
    assert secret.encode() not in (tmp_path / "own.zip").read_bytes()
    assert b'answers = "small.answers.toml"' in (tmp_path / "own.zip").read_bytes()
    assert b"The model vanishes" not in bundle.read_bytes()


def test_permissions_and_times(bundle: Path) -> None:
    """Only the two scripts are executable, and no timestamp depends on the clock."""
    programs = {
        name for name, entry in members(bundle).items() if entry.external_attr >> 16 == 0o100755
    }
    assert programs == {"setup.sh", "run_autograder"}
    others = {
        entry.external_attr >> 16 for name, entry in members(bundle).items() if name not in programs
    }
    assert others == {0o100644}
    assert {(entry.date_time, entry.create_system) for entry in members(bundle).values()} == {
        ((1980, 1, 1, 0, 0, 0), 3)
    }


@pytest.mark.exhaustive
def test_scripts_have_unix_lines(
    source: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Scripts have Unix line endings even if git checked them out with CRLF; bash accepts them."""
    from grader.app.bundle import gradescope

    for name in ("setup.sh", "run_autograder", "autograder.py"):
        (tmp_path / name).write_bytes((source / name).read_bytes().replace(b"\n", b"\r\n"))
    monkeypatch.setattr(gradescope, "_SCRIPTS", tmp_path)
    (tmp_path / "out.zip").write_bytes(autograder_zip(LAB6))
    other = unpacked(tmp_path / "out.zip", tmp_path / "other")
    for name in ("setup.sh", "run_autograder", "autograder.py"):
        assert (other / name).read_bytes() == (source / name).read_bytes()
        assert b"\r" not in (source / name).read_bytes()
    for name in ("setup.sh", "run_autograder"):
        subprocess.run(["bash", "-n", other / name], check=True)


def test_bundles_are_reproducible(bundle: Path, tmp_path: Path) -> None:
    """A bundle made in another folder and under another name has the same bytes."""
    (tmp_path / "Other.ZIP").write_bytes(b"of yesterday")
    done = grader("bundle", "gradescope", tmp_path / "Other.ZIP")
    assert done.returncode == 0
    assert (tmp_path / "Other.ZIP").read_bytes() == bundle.read_bytes()
    assert [path.name for path in tmp_path.iterdir()] == ["Other.ZIP"]


def in_order(requirement: str) -> str:
    """Return a requirement as hatchling writes it."""
    name = re.split("[<>=]", requirement)[0]
    return name + ",".join(sorted(requirement.removeprefix(name).split(",")))


def as_wheel(into: Path) -> Path:
    """Lay out the package as a wheel installs it: rubrics and reference solutions inside, metadata beside it."""
    skipped = shutil.ignore_patterns("__pycache__")
    shutil.copytree(ROOT / "grader", into / "grader", ignore=skipped)
    shutil.copytree(ROOT / "rubrics", into / "grader" / "rubrics", ignore=skipped)
    lines = [f"Requires-Dist: {in_order(dependency)}" for dependency in PROJECT["dependencies"]]
    for extra, expected in PROJECT["optional-dependencies"].items():
        lines += [
            f"Provides-Extra: {extra}",
            *(
                f"Requires-Dist: {in_order(requirement)}; extra == '{extra}'"
                for requirement in expected
            ),
        ]
    (into / "urdf_grader-9.9.dist-info").mkdir()
    head = "Metadata-Version: 2.4\nName: urdf-grader\nVersion: 9.9\n"
    (into / "urdf_grader-9.9.dist-info" / "METADATA").write_text(head + "\n".join(lines) + "\n")
    return into


@pytest.mark.exhaustive
def test_from_a_wheel(bundle: Path, tmp_path: Path) -> None:
    """A bundle from an installed wheel has the same bytes as one from a checkout."""
    target = as_wheel(tmp_path / "packages")
    out = tmp_path / "out.zip"
    start = (
        f"import sys; sys.path.insert(0, {str(target)!r}); from grader.__main__ import main; main()"
    )
    subprocess.run(
        [sys.executable, "-I", "-c", start, "bundle", "gradescope", str(out)],
        cwd=tmp_path,
        check=True,
    )
    assert out.read_bytes() == bundle.read_bytes()


def test_requirements(bundle: Path) -> None:
    """The requirements are those of the grader and of the extra for documents, no others."""
    with zipfile.ZipFile(bundle) as archive:
        lines = archive.read("requirements.txt").decode().splitlines()
    assert lines == sorted(
        map(in_order, PROJECT["dependencies"] + PROJECT["optional-dependencies"]["documents"])
    )


def test_requirements_with_conditions(monkeypatch: pytest.MonkeyPatch) -> None:
    """Environment markers are kept; the marker of the extra is removed."""
    declared = [
        "plain!=1.5,<2,>=1",
        'old>=2; python_version < "3.12"',
        "word[all] >= 3; extra == 'documents'",
        'both>=4; python_version < "3.12" and extra == "documents"',
        "other>=5 ; extra == 'test'",
        'third>=6; sys_platform == "linux" and extra == "test"',
    ]
    monkeypatch.setattr(installed, "requires", {"urdf-grader": declared}.get)
    assert requirements("documents") == [
        'both>=4 ; python_version < "3.12"',
        'old>=2 ; python_version < "3.12"',
        "plain!=1.5,<2,>=1",
        "word[all] >= 3",
    ]


def test_a_missing_distribution(monkeypatch: pytest.MonkeyPatch) -> None:
    """If no distribution is installed, the requirements are unknown and the command says so."""

    def not_found(name: str) -> list[str]:
        raise importlib.metadata.PackageNotFoundError(name)

    monkeypatch.setattr(installed, "requires", not_found)
    with pytest.raises(InputError, match="install it with pip"):
        requirements("documents")


def test_unrelated_files_are_excluded(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Files of editors, Python and operating systems beside the code are not bundled."""
    monkeypatch.setattr(installed, "_PACKAGE", tmp_path / "grader")
    for name in (
        "a.py",
        "b/c.txt",
        "b/.c.swp",
        ".DS_Store",
        "__pycache__/a.pyc",
        "b/d.pyc",
        ".git/x",
        "rubrics/old/rubric.toml",
    ):
        (tmp_path / "grader" / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "grader" / name).touch()
    assert sorted(package_files()) == ["grader/a.py", "grader/b/c.txt", *RUBRICS]


# --- The rubric -------------------------------------------------------------------------------------------------------


@pytest.mark.exhaustive
def test_a_custom_rubric(tmp_path: Path) -> None:
    """The file of a custom rubric is in the bundle byte for byte, and submissions are graded by it."""
    own = tmp_path / "my lab.toml"
    own.write_bytes(("\ufeff" + lab_text().replace("\n", "\r\n")).encode())
    done = grader("bundle", "gradescope", tmp_path / "out.zip", "--rubric", own)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout == (
        f"wrote {tmp_path}/out.zip: A small lab (5 criteria, 11 points)\n"
        "next: upload it under Configure Autograder; autograder points: 6; manual grading: 5 points for essay (4), picture (1)\n"
    )
    source = unpacked(tmp_path / "out.zip", tmp_path / "source")
    assert (source / "rubric.toml").read_bytes() == own.read_bytes()
    settings = json.loads((source / "autograder.json").read_text())
    assert (settings["rubric"], settings["sha256"]) == (
        "source/rubric.toml",
        hash_bytes(own.read_bytes()),
    )
    autograder = Autograder(
        tmp_path / "autograder", source, environment_for(source, tmp_path / "venv")
    )
    autograder.submission.rmdir()
    write_submission(autograder.submission)
    results = autograder.run()
    assert (results["score"], len(results["tests"])) == (6, 5)
    (source / "rubric.toml").write_text(lab_text(loads="30"))
    assert autograder.run()["score"] == 0


def test_a_file_named_like_a_shipped_rubric(tmp_path: Path) -> None:
    """A path to a file selects that file, not the shipped rubric of the same id."""
    own = tmp_path / "lab6.toml"
    own.write_bytes((ROOT / "rubrics/lab6/rubric.toml").read_bytes() + b"# changed\n")
    assert grader("bundle", "gradescope", tmp_path / "out.zip", "--rubric", own).returncode == 0
    with zipfile.ZipFile(tmp_path / "out.zip") as archive:
        assert archive.read("rubric.toml") == own.read_bytes()
        assert json.loads(archive.read("autograder.json"))["rubric"] == "source/rubric.toml"


def test_a_plugin_check() -> None:
    """A rubric with a plug-in check is refused, because the check would be missing on Gradescope."""

    def strange(robot: Configuration) -> Outcome:
        """The robot always passes."""
        raise NotImplementedError

    strange.__module__ = "elsewhere.checks"
    rubric = load_rubric("lab6")
    first = rubric.criteria[0]._replace(check=describe(strange))
    with pytest.raises(InputError, match=r"urdf-loads uses a check of the package elsewhere"):
        autograder_zip(replace(rubric, criteria=(first, *rubric.criteria[1:])))
