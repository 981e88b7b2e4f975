"""Grade the submission in the current folder, and write results/results.json.

The folder is as Gradescope lays it out.

There is always a results.json: run_autograder writes one that says that nothing was graded, and
this script replaces it if the grader wrote a report. It needs only the standard library.
"""

import json
import os
import signal
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryFile
from typing import IO, Any, NamedTuple

# Isolated (-I): Python imports nothing from the current folder, the submission or PYTHON*
# variables.
_GRADER = (sys.executable, "-I", "-X", "utf8", "-m", "grader")
_ENVIRONMENT = {"PATH": os.defpath, "LC_ALL": "C.UTF-8"}
_GRADED, _NOT_GRADED = (0, 1, 3), 2  # the grader's exit codes
_MAX_BYTES = 32 * 1024 * 1024
_MAX_CHARACTERS = 2000
_ADVICE = (
    "Nothing was graded. Check your submission and submit again. If you cannot find the fault, "
    "ask your instructor."
)


class _Completed(NamedTuple):
    """The exit code of the grader, None if it took too long, and its output."""

    code: int | None
    output: bytes
    errors: bytes


def _main(arguments: list[str]) -> int:
    """Grade, or with --check only test that the grader runs and loads the rubric.

    Return the exit code.
    """
    settings = json.loads(Path("source", "autograder.json").read_text(encoding="utf-8"))
    if arguments == ["--check"]:
        return subprocess.call([*_GRADER, "rubric", "show", settings["rubric"]], env=_ENVIRONMENT)
    options = [
        "--rubric",
        settings["rubric"],
        "--expect-rubric",
        settings["sha256"],
        "--format",
        "gradescope",
    ]
    completed = _run([*_GRADER, "grade", "submission", *options], settings["seconds"])
    print(
        f"the grader ended with exit code {completed.code}\n{_printable(completed.errors)}".rstrip()
    )
    results = _read_results(completed, settings["seconds"])
    if results is None:
        print("its output is not a report; the results say that nothing was graded")
        return 1
    _write(Path("results", "results.json"), results)
    return 0


def _run(command: list[str], seconds: float) -> _Completed:
    """Run the grader with a time limit in seconds, at which it and all its children are killed."""
    # Files instead of pipes: a child that keeps a pipe open would block the reader.
    with TemporaryFile() as output, TemporaryFile() as errors:
        process = subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=errors,
            env=_ENVIRONMENT,
            start_new_session=True,
        )
        code: int | None
        try:
            code = process.wait(seconds)
        except subprocess.TimeoutExpired:
            code = None
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
        return _Completed(code, _read_start(output), _read_start(errors))


def _read_start(file: IO[bytes]) -> bytes:
    """Return the content of a file, of a long one MAX_BYTES + 1 bytes."""
    file.seek(0)
    return file.read(_MAX_BYTES + 1)


def _read_results(completed: _Completed, seconds: float) -> dict[str, Any] | None:
    """Return what students see; None if the grader failed."""
    if completed.code is None:
        return _nothing_graded(
            f"The grader was stopped because it took longer than {seconds:g} seconds."
        )
    if completed.code == _NOT_GRADED:
        lines = _printable(completed.errors).splitlines()
        messages = "\n".join(line.removeprefix("grader: ") for line in lines)
        return _nothing_graded(f"The grader could not grade your submission:\n\n{messages}")
    if completed.code in _GRADED:
        return _report(completed.output)
    return None


def _nothing_graded(why: str) -> dict[str, Any]:
    """Return results without points that give the reason."""
    return {
        "score": 0,
        "output": f"{why}\n\n{_ADVICE}",
        "output_format": "text",
        "visibility": "visible",
        "stdout_visibility": "hidden",
        "tests": [],
    }


def _printable(data: bytes) -> str:
    """Return the start of a text, with `?` for every character that is not printable."""
    text = data.decode("utf-8", "replace")[:_MAX_CHARACTERS]
    characters = (c if c.isprintable() or c == "\n" else "?" for c in text)
    return "".join(characters).strip()


def _report(output: bytes) -> dict[str, Any] | None:
    """Return the grader's report; None if the output is not a report."""
    if len(output) > _MAX_BYTES:
        return None
    try:
        report = json.loads(output.decode(), parse_constant=_refuse_constant)
    except (ValueError, RecursionError):
        return None
    if isinstance(report, dict) and isinstance(report.get("score"), int | float):
        return report
    return None


def _refuse_constant(constant: str) -> float:
    """Refuse NaN and Infinity, which Python accepts in JSON and other parsers do not."""
    raise ValueError(constant)


def _write(path: Path, results: dict[str, Any]) -> None:
    """Write the results atomically."""
    temporary = path.with_name("results.json.tmp")
    # An unpaired surrogate is not a character, and not every JSON parser accepts it.
    temporary.write_bytes(
        json.dumps(results, ensure_ascii=False, indent=1).encode("utf-8", "replace")
    )
    temporary.replace(path)


if __name__ == "__main__":
    sys.exit(_main(sys.argv[1:]))
