"""Grade the submission in the current folder, as Gradescope lays it out, and write results/results.json.

Whatever the grader does, a results.json stands in the end: run_autograder has written one that says that nothing was graded, and
here it is replaced by a better one, or stays. Only the standard library is needed.
"""

import json
import os
import signal
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryFile
from typing import IO, Any, NamedTuple

# Isolated: nothing in the current folder, in the submission or named by the environment is imported.
GRADER = (sys.executable, "-I", "-X", "utf8", "-m", "grader")
ENVIRONMENT = {"PATH": os.defpath, "LC_ALL": "C.UTF-8"}
GRADED, NOT_GRADED = (0, 1, 3), 2  # the grader's exit codes
MOST_BYTES = 32 * 1024 * 1024
MOST_CHARACTERS = 2000


class Ended(NamedTuple):
    """How the grader ended: its exit code, None if it took too long, and what it has written."""

    code: int | None
    output: bytes
    errors: bytes


def main(arguments: list[str]) -> int:
    """Grade, or with --check only see whether the grader runs and takes the rubric; the exit code."""
    settings = json.loads(Path("source", "autograder.json").read_text(encoding="utf-8"))
    if arguments == ["--check"]:
        return subprocess.call([*GRADER, "rubric", "show", settings["rubric"]], env=ENVIRONMENT)
    options = ["--rubric", settings["rubric"], "--expect-rubric", settings["sha256"], "--format", "gradescope"]
    ended = run([*GRADER, "grade", "submission", *options], settings["seconds"])
    print(f"the grader ended with exit code {ended.code}\n{printable(ended.errors)}".rstrip())
    results = results_of(ended, settings["seconds"])
    if results is None:
        print("what it has written is no report; the results say that nothing was graded")
        return 1
    write(Path("results", "results.json"), results)
    return 0


def run(command: list[str], seconds: float) -> Ended:
    """Run the grader for so long at most; then it is ended with all that it has started."""
    # Files and no pipes: nothing can be held up by who does not close them.
    with TemporaryFile() as output, TemporaryFile() as errors:
        process = subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=errors,
            env=ENVIRONMENT,
            start_new_session=True,
        )
        code: int | None
        try:
            code = process.wait(seconds)
        except subprocess.TimeoutExpired:
            code = None
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
        return Ended(code, start_of(output), start_of(errors))


def start_of(file: IO[bytes]) -> bytes:
    """What stands in a file, or one byte more of it than is taken."""
    file.seek(0)
    return file.read(MOST_BYTES + 1)


def results_of(ended: Ended, seconds: float) -> dict[str, Any] | None:
    """What students are to see; None where the grader has failed."""
    if ended.code is None:
        return nothing_graded(f"The grader was stopped because it took longer than {seconds:g} seconds.")
    if ended.code == NOT_GRADED:
        return nothing_graded(f"The grader could not grade what you have handed in. It says:\n\n{said(ended.errors)}")
    return report(ended.output) if ended.code in GRADED else None


def nothing_graded(why: str) -> dict[str, Any]:
    """Results with no points, and why."""
    return {
        "score": 0,
        "output": f"{why}\n\nNothing was graded yet. Look at what you have handed in, and hand in again. If you cannot tell what is "
        "wrong, ask your instructor.",
        "output_format": "text",
        "visibility": "visible",
        "stdout_visibility": "hidden",
        "tests": [],
    }


def said(errors: bytes) -> str:
    """The grader's words on standard error, without its name before each line."""
    return "\n".join(line.removeprefix("grader: ") for line in printable(errors).splitlines())


def printable(data: bytes) -> str:
    """The start of some text, without any character that could do more than be read."""
    lines = data.decode("utf-8", "replace")[:MOST_CHARACTERS].split("\n")
    return "\n".join("".join(each if each.isprintable() else "?" for each in line) for line in lines).strip()


def report(output: bytes) -> dict[str, Any] | None:
    """The grader's report; None if this is none."""
    if len(output) > MOST_BYTES:
        return None
    try:
        found = json.loads(output.decode(), parse_constant=refused)
    except (ValueError, RecursionError):
        return None
    return found if isinstance(found, dict) and isinstance(found.get("score"), int | float) else None


def refused(constant: str) -> float:
    """NaN and Infinity, which Python reads as JSON and others do not."""
    raise ValueError(constant)


def write(path: Path, results: dict[str, Any]) -> None:
    """Write the results so that they are there whole or not at all."""
    temporary = path.with_name("results.json.tmp")
    # Half a surrogate pair is no character, and not everybody's JSON can hold it.
    temporary.write_bytes(json.dumps(results, ensure_ascii=False, indent=1).encode("utf-8", "replace"))
    temporary.replace(path)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
