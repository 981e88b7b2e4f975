"""Gradescope's folders, as an autograder finds them, and what it takes as results."""

import json
import os
import shutil
import subprocess
import sysconfig
import venv
import zipfile
from pathlib import Path
from typing import Any

import jsonschema

from tests.command_line import PATIENCE
from tests.samples import ROOT

SCHEMA = json.loads((ROOT / "tests/report/schemas/gradescope.json").read_text())
FALLBACK = "The grader did not finish"
METADATA = {
    "id": 123456,
    "created_at": "2026-11-20T12:00:00.000000-08:00",
    "assignment": {"title": "Lab 6", "total_points": "100.0"},
    "users": [{"name": "Ada Example", "email": "ada@example.org"}],
    "previous_submissions": [],
}


class Autograder:
    """A folder laid out as /autograder is, with the submission still empty."""

    def __init__(self, root: Path, source: Path, environment: Path) -> None:
        self.root = root
        for name in ("submission", "results"):
            (root / name).mkdir(parents=True)
        (root / "source").symlink_to(source)
        (root / "venv").symlink_to(environment)
        (root / "submission_metadata.json").write_text(json.dumps(METADATA))
        shutil.copy(source / "run_autograder", root)

    @property
    def submission(self) -> Path:
        """Where the student's files are."""
        return self.root / "submission"

    def hand_in(self, sample: str) -> None:
        """Put one of the sample submissions there."""
        shutil.copytree(ROOT / "submissions" / sample, self.submission, dirs_exist_ok=True)

    def run(self, **variables: str) -> dict[str, Any]:
        """Run it as Gradescope does; what students see, which is always there, valid and without a path of this machine."""
        done = self.ended(**variables)
        assert done.returncode == 0, done
        text = (self.root / "results" / "results.json").read_text(encoding="utf-8")
        assert str(self.root) not in text
        assert [path.name for path in (self.root / "results").iterdir()] == ["results.json"]
        results: dict[str, Any] = json.loads(text)
        jsonschema.validate(results, SCHEMA, jsonschema.Draft202012Validator)
        return results

    def ended(self, **variables: str) -> subprocess.CompletedProcess[str]:
        """How run_autograder ends, and what instructors see."""
        return subprocess.run(
            [self.root / "run_autograder"],
            cwd=self.root,
            env={**os.environ, **variables},
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            check=False,
            timeout=PATIENCE,
        )


def unpacked(bundle: Path, into: Path) -> Path:
    """The autograder's files, unpacked with their permissions as Gradescope does."""
    with zipfile.ZipFile(bundle) as archive:
        archive.extractall(into)
        for entry in archive.infolist():
            (into / entry.filename).chmod(entry.external_attr >> 16 & 0o777)
    return into


def environment_for(source: Path, into: Path) -> Path:
    """What setup.sh makes, but with the packages that are installed here already."""
    venv.create(into, symlinks=True)
    (packages,) = into.glob("lib/python*/site-packages")
    (packages / "autograder.pth").write_text(f"{source}\n{sysconfig.get_path('purelib')}\n")
    return into
