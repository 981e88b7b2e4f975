"""Cut the power at any moment of some commands, and look at what the disk holds: `python -m tests.faults.power [SEEDS]`.

The shim records what the commands write. A disk after a power failure has all that was synced. Of the rest it has nothing,
everything, or any part in sectors of 512 bytes; and of the names that changed since their folder was synced, the first ones.
"""

import random
import shutil
import struct
import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from tempfile import mkdtemp
from typing import NamedTuple

from tests.faults import scenarios
from tests.faults.scenarios import SCENARIOS
from tests.faults.shim import KINDS, Shim, is_preloaded, run_preloaded
from tests.faults.trial import RESULTS, Bench

_SECTOR = 512
_HEAD = struct.Struct("llll")
_SEQUENCE = (
    *("mark", "mark-new", "mark-import", "batch-again", "mark", "review"),
    *("export-csv", "grade", "grade-fix", "batch"),
)
_SEEDS = 8


class Call(NamedTuple):
    """A recorded call: its kind, the file, the offset or size, and the data or the new name."""

    kind: str
    path: str
    offset: int
    data: bytes


def calls_of(record: Path) -> list[Call]:
    """Return the calls in a record."""
    data, at, found = record.read_bytes(), 0, list[Call]()
    while at < len(data):
        kind, offset, length, size = _HEAD.unpack_from(data, at)
        at += _HEAD.size
        found.append(
            Call(
                KINDS[kind],
                data[at : at + length].decode(),
                offset,
                data[at + length : at + length + size],
            )
        )
        at += length + size
    return found


class Inode:
    """The content of a file: what is on the disk, and the writes since it was synced; without data, a new size."""

    def __init__(self, synced: bytes = b"") -> None:
        self.synced = synced
        self.pending: list[tuple[int, bytes | None]] = []

    def content(self, survives: "random.Random | bool") -> bytes:
        """Return the content after a power failure: of each sector of a pending write decides `survives`."""
        data = bytearray(self.synced)
        for offset, written in self.pending:
            if written is None:
                if _decide(survives):
                    data = data[:offset].ljust(offset, b"\0")
                continue
            start = 0
            while start < len(written):
                end = min(len(written), (offset + start) // _SECTOR * _SECTOR + _SECTOR - offset)
                if _decide(survives):
                    data = data.ljust(offset + end, b"\0")
                    data[offset + start : offset + end] = written[start:end]
                start = end
        return bytes(data)

    def sync(self) -> None:
        """Write everything to the disk."""
        self.synced, self.pending = self.content(survives=True), []


def _decide(survives: "random.Random | bool") -> bool:
    return survives.random() < 0.5 if isinstance(survives, random.Random) else survives


class Disk:
    """Names, as they are on the disk, with the changes that no sync of their folder has made permanent."""

    def __init__(self, top: Path) -> None:
        files = [path for path in top.rglob("*") if path.is_file()]
        self.names: dict[str, Inode] = {str(path): Inode(path.read_bytes()) for path in files}
        self._durable = dict(self.names)
        self._changes: list[tuple[str, Inode | None]] = []

    def apply(self, call: Call) -> None:
        """Do what a call did."""
        match call.kind:
            case "open" if call.path not in self.names:
                self._name(call.path, Inode())
            case "open" if call.offset:
                self.names[call.path].pending.append((0, None))
            case "write":
                self.names[call.path].pending.append((call.offset, call.data))
            case "truncate":
                self.names[call.path].pending.append((call.offset, None))
            case "sync" if call.path in self.names:
                self.names[call.path].sync()
            case "sync":  # a folder
                for path, inode in self._changes:
                    self._set(self._durable, path, inode)
                self._changes = []
            case "rename":
                inode = self.names[call.path]
                self._name(call.data.decode(), inode)
                self._name(call.path, None)
            case "unlink":
                self._name(call.path, None)

    def _name(self, path: str, inode: Inode | None) -> None:
        self._set(self.names, path, inode)
        self._changes.append((path, inode))

    @staticmethod
    def _set(names: dict[str, Inode], path: str, inode: Inode | None) -> None:
        if inode is None:
            names.pop(path, None)
        else:
            names[path] = inode

    def after_failure(self, seed: int) -> dict[str, bytes]:
        """Return the files after a power failure: nothing that is pending survives, everything, or a random part."""
        chance = random.Random(seed)
        survives: random.Random | bool = seed == 1 if seed < 2 else chance
        names = dict(self._durable)
        count = (0, len(self._changes))[seed] if seed < 2 else chance.randint(0, len(self._changes))
        for path, inode in self._changes[:count]:
            self._set(names, path, inode)
        return {path: inode.content(survives) for path, inode in names.items()}


def main(arguments: Sequence[str]) -> int:
    """Record the commands and cut the power after each call; return 1 if a disk does not hold what it should."""
    if not is_preloaded():
        return run_preloaded("tests.faults.power", arguments)
    seeds = int(arguments[0]) if arguments else _SEEDS
    folder = Path(mkdtemp())
    top, template = folder / "top", folder / "template"
    top.mkdir()
    scenarios.prepare(top)
    top.rename(template)
    bench = Bench(top, template, Shim(top))
    found, cuts = Counter[str](), 0
    bench.reset()
    disk, states = Disk(top), [bench.state()]
    for name in _SEQUENCE:
        calls = _recorded(bench, name)
        kept = top.rename(folder / "kept")
        shutil.copytree(kept, top)
        states.append(bench.state())
        for number, call in enumerate(calls, 1):
            disk.apply(call)
            for seed in range(seeds):
                cuts += 1
                _write(disk.after_failure(seed), top)
                lines = _complaints(bench.state(), states, is_done=number == len(calls))
                found.update(f"{name}: {line}" for line in lines)
        shutil.rmtree(top)
        kept.rename(top)
        print(f"{name}: the power was cut after each of {len(calls)} calls", flush=True)
    print(*(f"{count} x {line}" for line, count in found.items()), sep="\n")
    print(f"{cuts} power failures, {found.total()} findings")
    return 1 if found else 0


def _recorded(bench: Bench, name: str) -> list[Call]:
    """Return the calls of a command."""
    bench.record = bench.top.with_name("record")
    bench.record.unlink(missing_ok=True)
    ran = bench.run(next(one for one in SCENARIOS if one.name == name))
    assert ran.code in (0, 1), (name, ran)
    return calls_of(bench.record)


def _write(files: dict[str, bytes], top: Path) -> None:
    shutil.rmtree(top, ignore_errors=True)
    for path, data in files.items():
        Path(path).parent.mkdir(parents=True, exist_ok=True)
        Path(path).write_bytes(data)


def _complaints(
    state: dict[str, bytes], states: list[dict[str, bytes]], *, is_done: bool
) -> Iterator[str]:
    """Yield what is wrong with a disk: each file is as before or after the last command, and all marks are there."""
    before, after = states[-2:]
    for name in sorted(before.keys() | after.keys()):
        found, allowed = state.get(name), [before.get(name), after.get(name)]
        if "/marks/" in name:
            if found not in (allowed[1:] if is_done else allowed):
                yield f"{name} lacks marks: {found!r} of {allowed[1]!r}"
        elif name.endswith(RESULTS):
            known = {line for one in (before, after) for line in one.get(name, b"").splitlines()}
            if lost := [line for line in (found or b"").splitlines() if line not in known]:
                yield f"{name} has other results: {lost}"
        elif name.endswith(
            "/grades.csv"
        ):  # it can be an older one, and is written again by each command
            if found not in [None, *(one.get(name) for one in states)]:
                yield f"{name} is none of those that were written"
        elif allowed[0] != allowed[1] and found not in (*allowed, None):
            yield f"{name} has {'no' if found is None else len(found)} bytes of {[one and len(one) for one in allowed]}"


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
