"""ROS 2's verdict on many URDFs: urdfdom's library is called in a child process, a hundred times as fast as `check_urdf`.

The model that it returns is read where GCC's C++ library keeps its parts on x86-64: a test compares every edge case with
`check_urdf` itself, so that another layout would be noticed.
"""

import ctypes
import faulthandler
import os
import platform
import re
import sys
import tempfile
import warnings
from collections.abc import Sequence
from functools import cache
from itertools import takewhile
from pathlib import Path

from grader.ros.known.releases import Release
from tests.oracles.check_urdf import check_urdf_path

_PARSE = "_ZN4urdf9parseURDFERKNSt7__cxx1112basic_stringIcSt11char_traitsIcESaIcEEE"
_NUMBER_OF_LINKS, _ROOT = (
    40,
    176,
)  # in a model: the size of the map of links, and the pointer to the root
_CHILDREN, _CHILDREN_END = 168, 176  # in a link: begin and end of the vector of its child links
_SHARED = 16  # bytes of a shared pointer
_SECONDS = 60  # of processor time, for all texts of a call
_MAX_STEPS = 200_000  # of a walk through the tree, which ends only without a loop
_VERDICTS = {b"c": "clean", b"d": "degraded", b"r": "rejected"}


def is_available(release: Release = "jazzy") -> bool:
    """Return whether the library of a release is installed, on a system whose layout of C++ objects is known."""
    is_known = sys.platform == "linux" and platform.machine() == "x86_64"
    return is_known and check_urdf_path(release) is not None


def verdicts(texts: Sequence[bytes], release: Release = "jazzy") -> list[str]:
    """Return the verdict on each text; a text that crashes the library, or never ends, is rejected.

    The library passes some values to printf as a format, where %n writes to memory: such texts have a process of their own.
    """
    found: list[str] = []
    while len(found) < len(texts):
        left = texts[len(found) :]
        group = list(takewhile(lambda text: b"%" not in text, left)) or left[:1]
        done = _until_crash(group, release)
        found += done
        if len(done) < len(group):
            found += _until_crash(group[len(done) :][:1], release) or ["rejected"]
    return found


def _until_crash(texts: Sequence[bytes], release: Release) -> list[str]:
    reading, writing = os.pipe()
    with warnings.catch_warnings():
        warnings.simplefilter(
            "ignore", DeprecationWarning
        )  # of threads, which the child does not use
        child = os.fork()
    if not child:
        try:
            import resource  # not on Windows

            faulthandler.disable()  # a crash is a verdict
            os.close(reading)
            resource.setrlimit(resource.RLIMIT_CPU, (_SECONDS, _SECONDS))
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
            with tempfile.TemporaryFile() as errors:
                os.dup2(errors.fileno(), 1)
                os.dup2(errors.fileno(), 2)
                for text in texts:
                    os.ftruncate(errors.fileno(), 0)
                    is_read, is_whole = _read(text, release)
                    is_silent = os.fstat(errors.fileno()).st_size == 0
                    os.write(
                        writing, b"r" if not is_read else b"c" if is_whole and is_silent else b"d"
                    )
        finally:
            os._exit(0)
    os.close(writing)
    with open(reading, "rb") as results:
        letters = results.read()
    os.waitpid(child, 0)
    return [_VERDICTS[letters[index : index + 1]] for index in range(len(letters))]


@cache
def _library(release: Release) -> ctypes.CDLL:
    binary = check_urdf_path(release)
    assert binary is not None
    folder = binary.parent.parent / "lib"
    for name in ("libtinyxml2", "libconsole_bridge", "liburdfdom_world", "liburdfdom_model"):
        path = sorted(Path(folder).glob(f"{name}.so*"))[0]
        library = ctypes.CDLL(str(path), mode=ctypes.RTLD_GLOBAL)
    return library


def _read(text: bytes, release: Release) -> tuple[bool, bool]:
    """Return whether a text is read, and whether its root reaches every link; a loop is followed for ever, so it is not read."""
    lines = b"".join(line + b"\n" for line in _lines(text))
    buffer = ctypes.create_string_buffer(lines, len(lines) + 1)
    string = (ctypes.c_uint64 * 4)(ctypes.addressof(buffer), len(lines), len(lines), 0)
    result = (ctypes.c_uint64 * 2)()
    getattr(_library(release), _PARSE)(ctypes.byref(result), ctypes.byref(string))
    model = result[0]
    if not model:
        return False, False
    reached, waiting, steps = set[int](), [_pointer(model + _ROOT)], 0
    while waiting:
        link = waiting.pop()
        reached.add(link)
        waiting += [
            _pointer(at)
            for at in range(_pointer(link + _CHILDREN), _pointer(link + _CHILDREN_END), _SHARED)
        ]
        steps += 1
        if steps > _MAX_STEPS:
            return False, False
    return True, len(reached) == _pointer(model + _NUMBER_OF_LINKS)


def _lines(text: bytes) -> list[bytes]:
    """Return the lines that `check_urdf` reads, which appends a line end to each, also to an empty one at the end."""
    return re.split(rb"\n", text)


def _pointer(address: int) -> int:
    return ctypes.c_uint64.from_address(address).value
