"""Search for inputs on which a reader fails or takes too long, guided by coverage: `python -m tests.fuzz [NAME...] --seconds 60`.

Without a name the harnesses are listed. Each runs in a process of its own under atheris (the extra `fuzz`), with at most 5 s
of processor time and 512 MiB for an input. The exit code is 1 if anything was found; `--json FILE` adds the figures of each harness to a file.
"""

import argparse
import json
import re
import subprocess
import sys
import tempfile
import time
from base64 import b64encode
from collections.abc import Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor, as_completed
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from tests.fuzz.harness import GUARD, MAX_SECONDS
from tests.fuzz.harnesses import HARNESSES
from tests.samples import ROOT

# With counters of coverage, and on a busy machine, an input takes longer: those that took long are run once more without.
_LIMITS = ("-timeout=60", "-rss_limit_mb=512", "-print_final_stats=1", "-close_fd_mask=1")
_STATE = re.compile(r"#(\d+)\s+(\w+)\s+cov: (\d+) ft: (\d+)")
_COUNT, _COUNTED = 20_000_000, 0.3  # steps of an empty loop, and the seconds that they take
_MOST_ENDS = 5  # findings after which libFuzzer ends, of one harness


def search(name: str, out: Path, seconds: int, runs: int) -> dict[str, Any]:
    """Run one harness until its time or its runs are over; return its figures."""
    folder = out / name
    for part in ("corpus", "seeds"):
        (folder / part).mkdir(parents=True, exist_ok=True)
    for path in _found(folder, "crash", "oom", "slow", "timeout"):  # by an earlier search
        path.unlink()
    harness = HARNESSES[name]
    for number, data in enumerate(harness.inputs(name)):
        (folder / "seeds" / str(number)).write_bytes(data[: harness.size])
    (folder / "words").write_text("".join(f'"{_escaped(word)}"\n' for word in harness.words))
    start, done, states, ends = time.monotonic(), 0, [], 0
    while (
        ends < _MOST_ENDS
        and (left := seconds - (time.monotonic() - start)) > 1
        and (not runs or done < runs)
    ):
        flags = [
            f"-max_total_time={int(left)}",
            f"-runs={runs - done if runs else -1}",
            f"-max_len={harness.size}",
        ]
        flags += [
            *_LIMITS,
            f"-dict={folder / 'words'}",
            f"-artifact_prefix={folder}/",
            f"-seed={ends + 1}",
        ]
        command = [sys.executable, "-m", "tests.fuzz.worker", name, str(folder), *flags]
        ended = subprocess.run(
            [*command, str(folder / "corpus"), str(folder / "seeds")],
            cwd=ROOT,
            capture_output=True,
            check=False,
        )
        log = ended.stderr.decode("utf-8", "replace")
        (folder / f"log-{ends}").write_text(log)
        found = re.findall(r"stat::number_of_executed_units: +(\d+)", log) or [
            state[0] for state in _STATE.findall(log)[-1:]
        ]
        done += int((found or ["0"])[-1])
        states += _STATE.findall(log)
        if ended.returncode == 0:
            break
        ends += 1
    spent = time.monotonic() - start
    edges = [int(state[2]) for state in states] or [0]
    first = next((int(state[2]) for state in states if state[1] == "INITED"), 0)
    findings = sorted(path.name for path in _found(folder, "crash", "oom") if path.suffix != ".txt")
    findings += [path.name for path in _found(folder, "slow", "timeout") if is_too_slow(name, path)]
    ends -= len(_found(folder, "oom", "timeout"))  # those of libFuzzer that have a reason
    slowest = folder / "slowest.txt"
    return {
        "harness": name,
        "inputs": done,
        "seconds": round(spent),
        "coverage": max(edges),
        "new": max(edges) - first,
        "slowest": float(slowest.read_text()) if slowest.exists() else 0.0,
        "findings": findings,
        "failures": max(0, ends),
    }


def _found(folder: Path, *kinds: str) -> list[Path]:
    return [path for kind in kinds for path in folder.glob(f"{kind}-*")]


def is_too_slow(name: str, path: Path) -> bool:
    """Return whether an input takes more than the allowed processor time without counters of coverage."""
    command = [sys.executable, "-m", "tests.fuzz", name, "--input", str(path)]
    try:
        done = subprocess.run(
            command, cwd=ROOT, capture_output=True, check=False, timeout=20 * MAX_SECONDS
        )
    except subprocess.TimeoutExpired:
        return True
    return float(done.stdout or MAX_SECONDS) >= MAX_SECONDS


def run_once(name: str, path: Path) -> float:
    """Run one input without atheris; return the seconds of processor time, on a slow machine as on one that counts to `_COUNT` in `_COUNTED` seconds."""
    with TemporaryDirectory() as folder:
        GUARD.folder = tempfile.tempdir = folder
        for data in HARNESSES[name].inputs(name)[:1]:  # imports
            HARNESSES[name].run(data)
        start = time.process_time()
        HARNESSES[name].run(path.read_bytes())
        spent = time.process_time() - start
    start = time.process_time()
    for _ in range(_COUNT):
        pass
    return spent * min(1.0, _COUNTED / (time.process_time() - start))


def _described(folder: Path) -> Iterator[str]:
    """Yield each traceback and its input, for a log that is all that is left of a machine."""
    for path in _found(folder, "crash"):
        yield (
            path.read_text()
            if path.suffix == ".txt"
            else f"{path.name}: {b64encode(path.read_bytes()).decode()}"
        )


def _escaped(word: str) -> str:
    return "".join(
        chr(byte) if 32 <= byte < 127 and byte not in b'"\\' else f"\\x{byte:02X}"
        for byte in word.encode()
    )


def line(row: Mapping[str, Any]) -> str:
    """Return the figures of a harness as a row of the table."""
    rate = row["inputs"] / max(1, row["seconds"])
    found = " ".join(row["findings"]) or "none"
    return (
        f"{row['harness']:14}{row['inputs']:>10}{row['seconds']:>9}{rate:>7.0f}{row['coverage']:>8}{row['new']:>6}"
        f"{row['slowest']:>9}  {found}"
    )


def main() -> int:
    """Run harnesses and print a line for each."""
    parser = argparse.ArgumentParser(prog="python -m tests.fuzz", description=__doc__)
    parser.add_argument("names", nargs="*", choices=[*HARNESSES, []], metavar="NAME")
    parser.add_argument("--all", action="store_true", help="run every harness")
    parser.add_argument("--seconds", type=int, default=60, help="of each harness (default: 60)")
    parser.add_argument(
        "--runs",
        type=int,
        default=0,
        help="inputs of each harness (default: as many as there is time for)",
    )
    parser.add_argument("--jobs", type=int, default=1, help="harnesses at once (default: 1)")
    parser.add_argument(
        "--out",
        type=Path,
        default=ROOT / "build" / "fuzz",
        help="what is found (default: build/fuzz)",
    )
    parser.add_argument("--json", type=Path, help="a file to which the figures are added")
    parser.add_argument(
        "--input",
        type=Path,
        help="run this input only, without atheris, and print its processor time",
    )
    options = parser.parse_args()
    if options.input is not None:
        print(f"{run_once(options.names[0], options.input):.2f}")
        return 0
    names = [*HARNESSES] if options.all else options.names
    if not names:
        print("\n".join(f"{name:14} {HARNESSES[name].meaning}" for name in HARNESSES))
        return 0
    print(
        f"{'harness':14}{'inputs':>10}{'seconds':>9}{'per s':>7}{'edges':>8}{'new':>6}{'slowest':>9}  findings",
        flush=True,
    )
    rows = []
    with TemporaryDirectory() as GUARD.folder, ThreadPoolExecutor(options.jobs) as pool:
        out = options.out.resolve()
        tasks = [pool.submit(search, name, out, options.seconds, options.runs) for name in names]
        for task in as_completed(tasks):
            rows.append(task.result())
            print(line(rows[-1]), *_described(out / rows[-1]["harness"]), sep="\n", flush=True)
            if options.json is not None:
                with options.json.open("a") as file:
                    file.write(json.dumps(rows[-1]) + "\n")
    print(
        f"{sum(row['inputs'] for row in rows)} inputs, {sum(len(row['findings']) for row in rows)} findings"
    )
    return 1 if any(row["findings"] or row["failures"] for row in rows) else 0


if __name__ == "__main__":
    sys.exit(main())
