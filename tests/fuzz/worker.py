"""Run one harness under atheris: `python -m tests.fuzz.worker NAME FOLDER FLAGS...`, with the flags of libFuzzer.

Each kind of finding is saved once in the folder, and the search goes on: the input as `crash-...`, and its traceback. The
slowest input is saved as `slowest`.
"""

import hashlib
import sys
import tempfile
import time
import traceback
import warnings
from pathlib import Path
from random import Random

import atheris  # of the extra `fuzz`

with atheris.instrument_imports(include=["grader"]):
    from tests.fuzz.harness import GUARD, MAX_SECONDS, mutated
    from tests.fuzz.harnesses import HARNESSES

_WARM_UP = 10  # every tenth seed is run before coverage is measured
_SLOW = 0.5  # seconds of processor time, from which on an input is saved


def signature(error: BaseException) -> str:
    """Return the name of a kind of finding: the exception, and the last places in our own files."""
    frames = traceback.extract_tb(error.__traceback__)
    places = [
        f"{Path(frame.filename).stem}:{frame.name}:{frame.lineno}"
        for frame in frames
        if "/site-packages/" not in frame.filename
    ]
    return (
        f"{type(error).__name__}-"
        + hashlib.sha256("\n".join(places[-3:]).encode()).hexdigest()[:12]
    )


def main() -> None:
    """Search until libFuzzer's limits are reached."""
    name, folder, *flags = sys.argv[1:]
    out = Path(folder)
    warnings.simplefilter("error")
    slowest = _SLOW
    GUARD.folder = tempfile.tempdir = tempfile.mkdtemp(dir=out)
    harness = HARNESSES[name]

    def target(data: bytes) -> None:
        nonlocal slowest
        start = time.process_time()
        try:
            with GUARD.watching():
                harness.run(data)
        except Exception as error:  # noqa: BLE001  every one is a finding
            file = out / f"crash-{signature(error)}"
            if not file.exists():
                file.write_bytes(data)
                Path(f"{file}.txt").write_text("".join(traceback.format_exception(error)))
        seconds = time.process_time() - start
        if seconds > slowest:
            slowest = seconds
            (out / "slowest").write_bytes(data)
            (out / "slowest.txt").write_text(f"{seconds:.2f}")
        if seconds > MAX_SECONDS:
            (out / f"slow-{hashlib.sha256(data).hexdigest()[:12]}").write_bytes(data)

    def mutate(data: bytes, size: int, seed: int) -> bytes:
        chance = Random(seed)
        if chance.random() < 0.5:
            return bytes(atheris.Mutate(data, size))
        return mutated(data, chance, harness.words, size)

    with atheris.instrument_imports(include=["grader"]):  # of what is imported late, too
        for data in harness.inputs(name)[::_WARM_UP]:
            target(data)
    atheris.Setup([sys.argv[0], *flags], target, custom_mutator=mutate)
    atheris.Fuzz()


if __name__ == "__main__":
    main()
