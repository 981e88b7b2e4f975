"""CLASSROOM/autograders/ASSIGNMENT/autograder.py of a Classroom 50 repository: grades a submission with grader.

Ends with 0 whatever the mark; otherwise the runner takes it that the autograder itself is broken.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

GRADER = "grader[documents] @ git+https://github.com/YOUR-ORG/grader@v1"
# Parts that a program decides by itself: what waits for a person would count as not passed.
OPTIONS = ["--rubric", "lab6", "--part", "task1", "--part", "task2"]

with tempfile.TemporaryDirectory() as home:
    subprocess.run([sys.executable, "-I", "-m", "venv", home], check=True)
    python = [str(Path(home, "bin", "python")), "-I", "-m"]
    subprocess.run([*python, "pip", "install", "--quiet", GRADER], check=True)
    saves = ["--save", "classroom50=result.json", "--save", "markdown=release-body.md"]
    code = subprocess.run([*python, "grader", "grade", ".", *OPTIONS, *saves], check=False).returncode
sys.exit(0 if code in (0, 1) else code)
