"""Gradescope's folders as an autograder finds them, and the results that Gradescope accepts."""

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

from tests.command_line import HANG_TIMEOUT
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
    """A folder laid out like /autograder; the submission is empty at first."""

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
        """Return the folder of the student's files."""
        return self.root / "submission"

    def submit(self, sample: str) -> None:
        """Copy one of the sample submissions into the submission folder."""
        shutil.copytree(ROOT / "submissions/lab6" / sample, self.submission, dirs_exist_ok=True)

    def run(self, **variables: str) -> dict[str, Any]:
        """Run the autograder as Gradescope does and return the results, which are valid and without paths of this machine."""
        done = self.ended(**variables)
        assert done.returncode == 0, done
        text = (self.root / "results" / "results.json").read_text(encoding="utf-8")
        assert str(self.root) not in text
        assert [path.name for path in (self.root / "results").iterdir()] == ["results.json"]
        results: dict[str, Any] = json.loads(text)
        jsonschema.validate(results, SCHEMA, jsonschema.Draft202012Validator)
        return results

    def ended(self, **variables: str) -> subprocess.CompletedProcess[str]:
        """Return the exit of run_autograder and the output that instructors see."""
        return subprocess.run(
            [self.root / "run_autograder"],
            cwd=self.root,
            env={**os.environ, **variables},
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            check=False,
            timeout=HANG_TIMEOUT,
        )


def unpacked(bundle: Path, into: Path) -> Path:
    """Unpack the autograder's files with their permissions, as Gradescope does."""
    with zipfile.ZipFile(bundle) as archive:
        archive.extractall(into)
        for entry in archive.infolist():
            (into / entry.filename).chmod(entry.external_attr >> 16 & 0o777)
    return into


def environment_for(source: Path, into: Path) -> Path:
    """Make the environment that setup.sh makes, but with the packages that are installed here."""
    venv.create(into, symlinks=True)
    (packages,) = into.glob("lib/python*/site-packages")
    (packages / "autograder.pth").write_text(f"{source}\n{sysconfig.get_path('purelib')}\n")
    return into
