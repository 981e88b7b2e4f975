"""CLASSROOM/autograders/ASSIGNMENT/autograder.py of a Classroom 50 repository: grades a submission
with grader.

Exits with 0 whatever the score: the runner treats any other exit code as a broken autograder.
"""

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

GRADER, VERSION = "https://github.com/YOUR-ORG/grader", "v1"
# Automatic parts only: what needs manual grading would count as not passed.
OPTIONS = ["--rubric", "lab6", "--part", "task1", "--part", "task2"]
# The files that the runner reads, and their formats.
RESULTS = {"result.json": "classroom50", "release-body.md": "markdown"}

# Remove files and symlinks of these names that a student committed.
for name in RESULTS:
    if Path(name).is_dir() and not Path(name).is_symlink():
        shutil.rmtree(name)
    else:
        Path(name).unlink(missing_ok=True)

with tempfile.TemporaryDirectory() as home:
    subprocess.run([sys.executable, "-I", "-m", "venv", home], check=True)
    python = [str(Path(home, "bin", "python")), "-I", "-m"]
    source = str(Path(home, "source"))
    clone = ["git", "clone", "--quiet", "--depth", "1", "--branch", VERSION, GRADER, source]
    subprocess.run(clone, check=True)
    lock = ["--require-hashes", "--requirement", str(Path(source, "requirements.lock"))]
    for wanted in (lock, ["--no-deps", "--no-build-isolation", source]):
        # pip keeps what it downloads in its cache, and verifies the hashes of what is there.
        subprocess.run([*python, "pip", "install", "--quiet", *wanted], check=True)
    saves = [
        part for name, kind in RESULTS.items() for part in ("--save", f"{kind}={Path(home, name)}")
    ]
    code = subprocess.run(
        [*python, "grader", "grade", ".", *OPTIONS, *saves], check=False
    ).returncode
    for name in RESULTS:
        if Path(home, name).exists():
            shutil.move(Path(home, name), name)
sys.exit(0 if code in (0, 1) else code)
