"""Mutated URDFs: the verdict of ROS 2's library on each against that of the grader's reader.

The kind `undefined` is a value with %n that ROS 2 passes to printf as a format: whether it crashes depends on the memory.
The kind `beyond Unicode` is a difference of the library of Lyrical that no file shows but a random one.
"""

import re
import sys
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from random import Random

from grader.ros.known.releases import Release
from grader.ros.urdf.reader import read_urdf
from grader.ros.urdf.urdf_problems import FORMAT_DIRECTIVE
from tests.differential.compared import Compared
from tests.oracles.urdfdom import verdicts
from tests.urdf.edge_cases import EDGE_CASES

_SAMPLES = Path(__file__).parents[2] / "submissions"
_MAX_SIZE = 12_000  # bytes: longer files take longer, and are mutated in the same ways
_NUMBERS = (
    b"0",
    b"1",
    b"-1",
    b"+1",
    b"1.",
    b".5",
    b"-.5e1",
    b"007",
    b"1e3",
    b"1E-400",
    b"1e400",
    b"1e",
    b"nan",
    b"inf",
    b"0x10",
    b"1_0",
    b"1,5",
    b"1.0f",
    b" 1",
    b"1 ",
    b"\t1",
    b"1\t",
    b"\n",
    b"",
    b"-",
    b".",
    b"1 2",
    b"1 2 3 4",
    b"\xc2\xa01",
    b"\xe2\x88\x921",
    b"${pi}",
    b"%s%n",
    b"1..2",
    b"&#49;",
    b"1\r\n",
    b"- 1",
    b"--1",
    b"9" * 400,
    b"1e-5 ",
    b"1.0 0",
    b"0 0 1.2",
    b"0.5 0.5 0.5 1",
    b"0 0 0 0",
)
_PIECES = (
    b"<",
    b">",
    b"/>",
    b"</",
    b'"',
    b"'",
    b"&",
    b"&amp;",
    b"&lt;",
    b"&bad;",
    b"&#0;",
    b"&#x41;",
    b"<!--",
    b"-->",
    b"<!-- -- -->",
    b"<![CDATA[",
    b"]]>",
    b"<?pi?>",
    b'<?xml version="1.0"?>',
    b"<!DOCTYPE robot>",
    b"\0",
    b"\xff",
    b"\xef\xbb\xbf",
    b"\r",
    b"\r\n",
    b"\n",
    b"\t",
    b" ",
    b"=",
    b"x",
    b":",
    b"/",
    b"<robot>",
    b"</robot>",
    b"<link/>",
    b'<link name="x"/>',
    b'<joint name="x" type="fixed"/>',
    b"<visual/>",
    b"<axis/>",
    b"<limit/>",
    b'<limit effort="1" velocity="1"/>',
    b"<dynamics/>",
    b'<mimic joint="x"/>',
    b"<origin/>",
    b"<geometry/>",
    b"<material/>",
    b'<material name="x"/>',
    b'<material name="x"><color rgba="0 0 0 1"/></material>',
    b"<inertial/>",
    b"<collision/>",
    b"<safety_controller/>",
    b"<calibration/>",
    b'<safety_controller k_velocity="1"/>',
    b"<xacro:x/>",
    b'xmlns="u"',
    b'xmlns:x="u"',
    b' version="1.0"',
    b' version="1.1"',
    b' version="1.2"',
    b' version="2.0"',
    b' quat_xyzw="0 0 0.6 0.8"',
    b' acceleration="1"',
    b' jerk="-1"',
    b'<capsule radius="1" length="2"/>',
    b'<limit lower="-1" upper="1"/>',
    b' name=""',
)
_WORDS = (
    b"fixed",
    b"revolute",
    b"continuous",
    b"prismatic",
    b"planar",
    b"floating",
    b"Fixed",
    b"base_link",
    b"lidar",
    b"",
    b"x",
    b"box",
    b"cylinder",
    b"sphere",
    b"capsule",
    b"mesh",
    b"link",
    b"joint",
    b"robot",
    b"visual",
    b"origin",
    b"name",
    b"type",
    b"xyz",
    b"rpy",
    b"quat_xyzw",
    b"deceleration",
    b"1.1",
    b"1.2",
    b"a b",
)
_ATTRIBUTE = re.compile(rb"""\s[\w:]+\s*=\s*("[^"]*"|'[^']*')""")
_VALUE = re.compile(rb"""(?<==["'])[^"'<>]*(?=["'])""")
_NUMBER = re.compile(rb"[-+]?\d*\.?\d+(?:[eE][-+]?\d+)?")
_WORD = re.compile(rb"[A-Za-z_]\w*")
_TAG = re.compile(rb"<[^<>]*>")
_ELEMENT = re.compile(rb"<(\w+)\b[^<>]*(?:/>|>(?:(?!<\1\b).)*?</\1\s*>)", re.DOTALL)


@cache
def seeds() -> tuple[bytes, ...]:
    """Return the texts that are mutated: our samples, and the edge cases of the reader."""
    found = {path.read_bytes() for path in sorted(_SAMPLES.rglob("*.urdf"))}
    samples = sorted(text for text in found if len(text) <= _MAX_SIZE)
    cases = [case for case in EDGE_CASES if len(case.text) <= _MAX_SIZE and case.oracle == "agrees"]
    loading = [case.text for case in cases if case.verdict != "rejected"]
    return (
        *samples,
        *loading * 2,
        *(case.text for case in cases[::3] if case.verdict == "rejected"),
    )


def mutant(seed: int) -> bytes:
    """Return the text of a seed: a sample with one to four changes."""
    random = Random(seed)
    text = random.choice(seeds())
    for _ in range(random.choice((1, 1, 1, 1, 1, 2, 2, 3, 4))):
        text = random.choice(_CHANGES)(random, text)
    return text


def _spot(random: Random, pattern: re.Pattern[bytes], text: bytes) -> tuple[int, int]:
    """Return where a random match of a pattern is; a random empty place if there is none."""
    start = random.randrange(len(text) + 1)
    found = pattern.search(text, start) or pattern.search(text)
    return found.span() if found else (start, start)


def _byte(random: Random, text: bytes) -> bytes:
    at = random.randrange(len(text) + 1)
    new = (
        bytes((random.randrange(256),)) if random.random() < 0.3 else random.choice((b"", *_PIECES))
    )
    return text[:at] + new + text[at + random.randint(0, 2) :]


def _piece(random: Random, text: bytes) -> bytes:
    """Insert a piece of XML or of a URDF beside a tag."""
    start, end = _spot(random, _TAG, text)
    at = random.choice((start, end, max(start, end - 1)))
    return text[:at] + random.choice(_PIECES) + text[at:]


def _replaced(
    pattern: re.Pattern[bytes], pieces: tuple[bytes, ...]
) -> Callable[[Random, bytes], bytes]:
    def change(random: Random, text: bytes) -> bytes:
        start, end = _spot(random, pattern, text)
        return text[:start] + random.choice(pieces) + text[end:]

    return change


def _moved(pattern: re.Pattern[bytes]) -> Callable[[Random, bytes], bytes]:
    """Remove a match, double it, or exchange it for another."""

    def change(random: Random, text: bytes) -> bytes:
        (start, end), (other, other_end) = (
            _spot(random, pattern, text),
            _spot(random, pattern, text),
        )
        taken = text[start:end]
        return random.choice(
            (
                text[:start] + text[end:],
                text[:end] + taken + text[end:],
                text[:other] + taken + text[other_end:],
                text[:other] + taken + text[other:],
            )
        )

    return change


def _cut(random: Random, text: bytes) -> bytes:
    return text[: random.randrange(len(text) + 1)]


def _joined(random: Random, text: bytes) -> bytes:
    """Put a robot, or a part of it, behind or into another."""
    other = random.choice(seeds())
    start, end = _spot(random, _ELEMENT, other)
    at = random.choice((len(text), _spot(random, _ELEMENT, text)[1]))
    return text[:at] + (other[start:end] if random.random() < 0.9 else other) + text[at:]


_CHANGES = (
    _byte,
    _byte,
    _piece,
    _piece,
    _replaced(_NUMBER, _NUMBERS),
    _replaced(_NUMBER, _NUMBERS),
    _replaced(_VALUE, _NUMBERS + _WORDS),
    _replaced(_WORD, _WORDS),
    _moved(_ATTRIBUTE),
    _moved(_ELEMENT),
    _moved(_ELEMENT),
    _moved(_TAG),
    _moved(_VALUE),
    _moved(_VALUE),
    _cut,
    _joined,
)


def _refers_beyond_unicode(text: bytes) -> bool:
    """Return whether a reference is beyond U+10FFFF: TinyXML2 10 decodes it, as the reader does, and 11 does not."""
    for digits in re.findall(rb"&#(x?[0-9a-fA-F]+);", text):
        value = (
            int(digits[1:], 16) if digits[:1] == b"x" else int(re.sub(rb"\D", b"", digits) or b"0")
        )
        if value > sys.maxunicode:
            return True
    return False


def compare(numbers: range, release: Release = "jazzy") -> Iterator[Compared]:
    """Compare the verdicts on the mutants of some seeds, for a release."""
    texts = [mutant(seed) for seed in numbers]
    for seed, text, expected in zip(numbers, texts, verdicts(texts, release), strict=True):
        reading = read_urdf(text, "robot.urdf", (release,))
        found = reading.verdict
        if any(problem.kind is FORMAT_DIRECTIVE for problem in reading.problems):
            yield Compared(
                seed,
                "undefined",
                None if found == "rejected" else f"it can crash ROS 2, grader: {found}",
            )
        elif release != "jazzy" and found != expected and _refers_beyond_unicode(text):
            yield Compared(seed, "beyond Unicode")
        else:
            yield Compared(
                seed, expected, None if found == expected else f"ROS 2: {expected}, grader: {found}"
            )
