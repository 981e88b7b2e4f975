"""ROS 2's own verdict on a URDF: urdfdom's `check_urdf`, as the `test` extra installs it, that of Jazzy.

That of Lyrical is in an environment of its own, which URDFDOM_6 names.
"""

import os
import re
import signal
import subprocess
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path
from typing import Literal

import pytest

from grader.ros.known.releases import Release

LYRICAL: Release = "lyrical"  # whose urdfdom is that of URDFDOM_6
_MISSING = "check_urdf is not installed: pip install --editable '.[test]'"
_MISSING_6 = "needs the oracle urdfdom 6: see CONTRIBUTING.md"

# `check_urdf` never reports a link that the root does not reach: it is only not printed. Each link but the root of an
# accepted file is the child of a joint, so these two say which links should have been printed.
_MARKUP = re.compile(
    rb"""<!--.*?-->|<!\[CDATA\[.*?\]\]>|<((?:"[^"]*"|'[^']*'|[^"'<>])*)>""", re.DOTALL
)
_LINK = re.compile(rb"""\s*link\s(?:.*?[\s"'])??name\s*=\s*(["'])(.*?)\1""", re.DOTALL)
_CHILD = re.compile(rb"""\s*child\s(?:.*?[\s"'])??link\s*=\s*(["'])(.*?)\1""", re.DOTALL)
_PRINTED = re.compile(rb"( *)child\(\d+\):  (.*)\n")
_INDENT = 4
_OUT_OF_TIME = (
    -signal.SIGXCPU,
    -signal.SIGKILL,
)  # the signal for a process that has used up its processor time


@dataclass(frozen=True, slots=True)
class OracleVerdict:
    """The verdict of `check_urdf` on a file, how it ended, and the errors that it printed."""

    verdict: Literal["clean", "degraded", "rejected"]
    ending: Literal["finished", "hung", "aborted"]
    stderr: str


@cache
def check_urdf_path(release: Release = "jazzy") -> Path | None:
    """Return the path of the program of a release; None if it is not installed or not available for this platform."""
    if release != "jazzy":
        folder = Path(os.environ.get("URDFDOM_6") or os.devnull)
        return next(folder.glob("lib/python3*/site-packages/cmeel.prefix/bin/check_urdf"), None)
    try:
        path = Path(str(distribution("cmeel-urdfdom").locate_file("cmeel.prefix/bin/check_urdf")))
    except PackageNotFoundError:
        return None
    return path if os.access(path, os.X_OK) else None


def check_urdf(text: bytes, seconds: int = 2, release: Release = "jazzy") -> OracleVerdict:
    """Run `check_urdf` on a file with this content; it hangs if it takes more than so many seconds of processor time.

    Skips the calling test if the program is not installed.
    """
    binary = check_urdf_path(release)
    if binary is None:
        pytest.skip(_MISSING_6 if release != "jazzy" else _MISSING)
    with tempfile.NamedTemporaryFile(suffix=".urdf") as file, tempfile.TemporaryFile() as errors:
        file.write(text)
        file.flush()
        environment = {"LD_LIBRARY_PATH": str(binary.parent.parent / "lib")}
        command = [
            "sh",
            "-c",
            'ulimit -t "$1" && shift && exec "$@"',
            "sh",
            str(seconds),
            str(binary),
            file.name,
        ]
        hangs = False
        with subprocess.Popen(
            command, env=environment, stdout=subprocess.PIPE, stderr=errors
        ) as process:
            printed = set()
            for depth, name in _children(process):
                printed.add(name)
                # No path is longer than there are tags, so the rest of this one would run until the stack overflows.
                if depth > text.count(b"<"):
                    hangs = True
                    process.kill()
                    break
            code = process.wait()
        errors.seek(0)
        stderr = errors.read().decode(errors="replace")
    if hangs or code in _OUT_OF_TIME:
        return OracleVerdict("rejected", "hung", stderr)
    if code < 0:
        return OracleVerdict("rejected", "aborted", stderr)
    if code > 0:
        return OracleVerdict("rejected", "finished", stderr)
    return OracleVerdict(
        "degraded" if stderr or _omitted(text, printed) else "clean", "finished", stderr
    )


def _children(process: subprocess.Popen[bytes]) -> Iterator[tuple[int, bytes]]:
    assert process.stdout is not None
    for line in process.stdout:
        if found := _PRINTED.fullmatch(line):
            yield len(found[1]) // _INDENT, found[2]


def _omitted(text: bytes, printed: set[bytes]) -> set[bytes]:
    tags = [match[1] or b"" for match in _MARKUP.finditer(text)]
    links, children = (
        {found[2] for tag in tags if (found := pattern.match(tag))} for pattern in (_LINK, _CHILD)
    )
    # The oracle decides how a name with an entity or a line ending is printed.
    return {name for name in (links & children) - printed if not re.search(rb"[&\r\n]", name)}
