"""CLASSROOM/autograders/ASSIGNMENT/autograder.py of a Classroom 50 repository: grades a submission with grader.

Ends with 0 whatever the mark; otherwise the runner takes it that the autograder itself is broken.
"""

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

GRADER = "urdf-grader[documents] @ git+https://github.com/YOUR-ORG/grader@v1"
# Parts that a program decides by itself: what waits for a person would count as not passed.
OPTIONS = ["--rubric", "lab6", "--part", "task1", "--part", "task2"]
# Where the runner looks for the results, and their formats.
RESULTS = {"result.json": "classroom50", "release-body.md": "markdown"}

# What a student has committed under these names is no result, and no link that is written through.
for name in RESULTS:
    if Path(name).is_dir() and not Path(name).is_symlink():
        shutil.rmtree(name)
    else:
        Path(name).unlink(missing_ok=True)

with tempfile.TemporaryDirectory() as home:
    subprocess.run([sys.executable, "-I", "-m", "venv", home], check=True)
    python = [str(Path(home, "bin", "python")), "-I", "-m"]
    subprocess.run([*python, "pip", "install", "--quiet", GRADER], check=True)
    saves = [part for name, kind in RESULTS.items() for part in ("--save", f"{kind}={Path(home, name)}")]
    code = subprocess.run([*python, "grader", "grade", ".", *OPTIONS, *saves], check=False).returncode
    for name in RESULTS:
        if Path(home, name).exists():
            shutil.move(Path(home, name), name)
sys.exit(0 if code in (0, 1) else code)
