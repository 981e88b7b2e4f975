"""Generate classes of submissions to test a grader: `python benchmarks/class_generator.py FOLDER --count 1000 --seed 1`.

The same seed gives the same names and bytes everywhere: nothing depends on the order of a set, on the clock, on a compressor's
version, or on more of `random` than `Random.random`. No URDF has the bytes of another one. The mistakes and their proportions are
those of 51 real submissions of the lab; every name and every line is made up.
"""

import argparse
import csv
import hashlib
import io
import json
import os
import re
import struct
import tarfile
import tomllib
import unicodedata
import zipfile
import zlib
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from functools import cache
from pathlib import Path
from random import Random
from typing import Any, NamedTuple, TypeVar

ROOT = Path(__file__).resolve().parent.parent
RUBRIC = ROOT / "rubrics/lab6/rubric.toml"
PACKAGE = ROOT / "rubrics" / "lab6" / "my_robot"
URDF = "urdf/my_robot.urdf"
LAYOUTS = ("folders", "canvas", "moodle")

T = TypeVar("T")


class Dice:
    """A random source that is the same everywhere: only `Random.random` keeps its sequence between Python versions."""

    def __init__(self, seed: str) -> None:
        self.random = Random(seed).random

    def below(self, count: int) -> int:
        """Return an integer from 0 to `count` - 1."""
        return int(self.random() * count)

    def pick(self, values: Sequence[T]) -> T:
        """Return one of some values."""
        return values[int(self.random() * len(values))]

    def chance(self, share: float) -> bool:
        """Return True with this probability."""
        return self.random() < share

    def shuffled(self, values: Iterable[T]) -> list[T]:
        """Return the values in another order."""
        mixed = list(values)
        for last in range(len(mixed) - 1, 0, -1):
            other = self.below(last + 1)
            mixed[last], mixed[other] = mixed[other], mixed[last]
        return mixed


# --- Ways to build the robot: right ones, common mistakes, and what is no XML or no robot -----------------------------


class Edit(NamedTuple):
    """A change of the reference: in the element of this name the text `old` becomes `new`; an empty `old` is all of it."""

    element: str
    old: str
    new: str = ""


class Variant(NamedTuple):
    """A way to build or break the robot, its frequency, the elements that it `touches`, and the criteria that it loses."""

    name: str
    weight: int
    touches: str
    lost: str
    edits: tuple[Edit, ...]


_LIDAR, _LEFT, _RIGHT = "base_lidar_joint", "base_left_wheel_joint", "base_right_wheel_joint"
_CASTER, _FOOTPRINT = "base_caster_wheel_joint", "base_joint"
_GROUND = "footprint-at-wheel-bottoms stands-on-ground"
_EVERYTHING = "everything"
_RIGHT_SIDE = "right-place right-angle"
_ALL_WHEELS = f"left-place left-angle left-axis {_RIGHT_SIDE} right-axis"
_RIGHT_TURNED = Edit(_RIGHT, "-1.57 0 0", "1.57 0 0")
_RIGHT_OUTWARD = Edit("right_wheel", "0 0 -0.025", "0 0 0.025")
_CAMERA = """</link>
  <link name="camera"/>
  <joint name="camera_joint" type="fixed">
    <parent link="base_link"/>
    <child link="camera"/>
    <origin xyz="0.3 0 0.1"/>
  </joint>"""
_COLLISION = '</visual>\n    <collision><geometry><box size="1 1 1"/></geometry></collision>'


def _left(*criteria: str) -> str:
    return "".join(f" left-wheel-{criterion}" for criterion in criteria)


def _right(*criteria: str) -> str:
    return "".join(f" right-wheel-{criterion}" for criterion in criteria)


def _lidar_at(name: str, weight: int, xyz: str, lost: str) -> Variant:
    return Variant(name, weight, "lidar", lost, (Edit(_LIDAR, "0.15 0 0.225", xyz),))


def _in_visual(link: str, xyz: str) -> Edit:
    """Return the edit that gives a visual without an origin one."""
    return Edit(link, "<visual>", f'<visual>\n      <origin xyz="{xyz}"/>')


def _quarter_turns() -> Iterator[Variant]:
    """Yield other spellings of a quarter turn about x, and axes of other lengths."""
    rolls = ("-1.5708", "-1.5705", "-1.570796326794897", "4.712389", "-7.853982")
    for side, joint in (("left", _LEFT), ("right", _RIGHT)):
        for rpy in (*(f"{roll} 0 0" for roll in rolls), "1.57159265 3.14159265 3.14159265"):
            yield Variant(
                f"{side}-turned-by-{rpy}", 1, f"{side}-angle", "", (Edit(joint, "-1.57 0 0", rpy),)
            )
        for length in ("2", "0.5", "10"):
            yield Variant(
                f"{side}-axis-{length}",
                1,
                f"{side}-axis",
                "",
                (Edit(joint, "0 0 1", f"0 0 {length}"),),
            )


# fmt: off
# The weights of the first ones are their counts in the 51 submissions; the others are less frequent.
MISTAKES = (
    Variant("right-mirrored", 10, _RIGHT_SIDE, "right-wheel-forward right-wheel-axis", (_RIGHT_TURNED, _RIGHT_OUTWARD)),
    Variant("right-mirrored-into-base", 3, _RIGHT_SIDE, _right("placed", "forward", "axis", "clear"), (_RIGHT_TURNED,)),
    _lidar_at("lidar-buried", 10, "0.15 0 0.2", "lidar-frame lidar-on-top"),
    _lidar_at("lidar-buried-a-little", 1, "0.15 0 0.22", "lidar-frame lidar-on-top"),
    _lidar_at("lidar-floating", 2, "0.15 0 0.25", "lidar-frame lidar-on-top"),
    Variant("lidar-offset-in-visual", 6, "lidar", "lidar-frame",
        (Edit(_LIDAR, "0.15 0 0.225", "0 0 0"), _in_visual("lidar", "0.15 0 0.225"))),
    _lidar_at("lidar-in-the-middle", 2, "0 0 0.225", "lidar-frame"),
    _lidar_at("lidar-too-far-ahead", 1, "0.2 0 0.225", "lidar-frame"),
    _lidar_at("lidar-beyond-the-box", 1, "0.6 0 0.225", "lidar-frame lidar-on-top"),
    _lidar_at("lidar-at-the-back", 1, "-0.15 0 0.225", "lidar-frame"),
    Variant("left-into-base", 1, "left-place", _left("placed", "clear"), (Edit("left_wheel", "0 0 0.025", "0 0 -0.025"),)),
    Variant("left-typo-0.0025", 1, "left-place", _left("placed", "clear"), (Edit("left_wheel", "0 0 0.025", "0 0 0.0025"),)),
    Variant("right-into-base", 1, _RIGHT_SIDE, _right("placed", "clear"), (_RIGHT_OUTWARD,)),
    Variant("wheels-half-inside", 1, "left-place right-place", _left("placed", "clear") + _right("placed", "clear"),
        (Edit("left_wheel", "0 0 0.025", "0 0 0"), Edit("right_wheel", "0 0 -0.025", "0 0 0"))),
    Variant("axes-along-x", 2, "left-axis right-axis right-angle", _left("forward", "spins") + _right("forward", "spins"),
        (Edit(_LEFT, "0 0 1", "1 0 0"), Edit(_RIGHT, "0 0 1", "1 0 0"))),
    Variant("footprint-missing", 2, "footprint", f"footprint-virtual footprint-root {_GROUND}",
        (Edit("base_footprint", ""), Edit(_FOOTPRINT, ""))),
    Variant("footprint-too-high", 2, "footprint", _GROUND, (Edit(_FOOTPRINT, "0 0 0.1", "0 0 0.05"),)),
    Variant("footprint-at-the-base", 1, "footprint", _GROUND, (Edit(_FOOTPRINT, "0 0 0.1", "0 0 0"),)),
    Variant("green-full", 2, "green", "base-green", (Edit("green", "0 0.6 0 1", "0 1 0 1"),)),
    Variant("green-see-through", 1, "green", "base-green", (Edit("green", "0 0.6 0 1", "0 0.6 0 0.8"),)),
    Variant("no-joints", 1, f"lidar {_ALL_WHEELS} caster footprint names rpy",
        f"urdf-loads lidar-fixed lidar-frame lidar-on-top joint-names caster-placed footprint-root {_GROUND} "
        + _left("continuous", "placed", "forward", "axis", "spins", "clear")
        + _right("continuous", "placed", "forward", "axis", "spins", "clear"),
        tuple(Edit(joint, "") for joint in (_LIDAR, _LEFT, _RIGHT, _CASTER, _FOOTPRINT))),
    Variant("right-frame-turned-over", 1, f"{_RIGHT_SIDE} right-axis", "right-wheel-axis",
        (_RIGHT_TURNED, _RIGHT_OUTWARD, Edit(_RIGHT, "0 0 1", "0 0 -1"))),
    Variant("wheels-turned-in-visual", 1, _ALL_WHEELS, "left-wheel-axis right-wheel-axis",
        (Edit(_LEFT, 'xyz="-0.15 0.2 0" rpy="-1.57 0 0"', 'xyz="-0.15 0.225 0"'), Edit(_LEFT, "0 0 1", "0 1 0"),
         Edit(_RIGHT, 'xyz="-0.15 -0.2 0" rpy="-1.57 0 0"', 'xyz="-0.15 -0.225 0"'), Edit(_RIGHT, "0 0 1", "0 1 0"),
         Edit("left_wheel", 'xyz="0 0 0.025" rpy="0 0 0"', 'rpy="1.57 0 0"'),
         Edit("right_wheel", 'xyz="0 0 -0.025" rpy="0 0 0"', 'rpy="1.57 0 0"'))),
    Variant("lidar-turning", 1, "lidar", "lidar-fixed", (Edit(_LIDAR, '"fixed"', '"continuous"'),)),
    Variant("lidar-dark", 1, "white", "lidar-white", (Edit("white", "0.9 0.9 0.9 1", "0.5 0.5 0.5 1"),)),
    Variant("wheels-black", 1, "gray", _left("gray") + _right("gray"), (Edit("gray", "0.7 0.7 0.7 1", "0 0 0 1"),)),
    Variant("base-half-sunk", 1, "base", "base-on-ground lidar-on-top", (Edit("base_link", "0 0 0.1", "0 0 0"),)),
    Variant("caster-behind", 1, "caster", "caster-placed", (Edit(_CASTER, "0.2 0 -0.05", "-0.2 0 -0.05"),)),
    Variant("wheel-misnamed", 1, "names", "joint-names", (Edit(_LEFT, f'"{_LEFT}"', '"left_wheel_joint"'),)),
)

# Nothing is lost by any of these.
EQUIVALENTS = (
    *_quarter_turns(),
    Variant("right-joint-at-the-outer-face", 4, _RIGHT_SIDE, "", (Edit(_RIGHT, "-0.15 -0.2 0", "-0.15 -0.25 0"), _RIGHT_OUTWARD)),
    Variant("joints-at-centres", 6, "left-place right-place", "",
        (Edit(_LEFT, "-0.15 0.2 0", "-0.15 0.225 0"), Edit("left_wheel", '<origin xyz="0 0 0.025" rpy="0 0 0"/>'),
         Edit(_RIGHT, "-0.15 -0.2 0", "-0.15 -0.225 0"), Edit("right_wheel", '<origin xyz="0 0 -0.025" rpy="0 0 0"/>'))),
    Variant("left-a-little-off", 2, "left-place", "", (Edit(_LEFT, "-0.15 0.2 0", "-0.1505 0.2005 0"),)),
    Variant("box-turned", 3, "base", "",
        (Edit("base_link", "0.6 0.4 0.2", "0.4 0.6 0.2"), Edit("base_link", '0.1" rpy="0 0 0"', '0.1" rpy="0 0 1.5708"'))),
    _lidar_at("lidar-a-little-off", 2, "0.1501 0 0.2255", ""),
    Variant("caster-offset-in-visual", 2, "caster", "",
        (Edit(_CASTER, "0.2 0 -0.05", "0.2 0 0"), _in_visual("caster_wheel", "0 0 -0.05"))),
    Variant("white-1", 2, "white", "", (Edit("white", "0.9 0.9 0.9 1", "1 1 1 1"),)),
    Variant("white-0.8", 2, "white", "", (Edit("white", "0.9 0.9 0.9 1", "0.8 0.8 0.8 1"),)),
    Variant("white-0.95", 1, "white", "", (Edit("white", "0.9 0.9 0.9 1", "0.95 0.95 0.95 1"),)),
    Variant("wheels-see-through", 1, "gray", "", (Edit("gray", "0.7 0.7 0.7 1", "0.7 0.7 0.7 0.5"),)),
    Variant("green-in-the-link", 2, "green", "",
        (Edit("green", ""), Edit("base_link", '"green"/>', '"green"><color rgba="0 0.6 0 1"/></material>'))),
    Variant("footprint-of-no-size", 2, "footprint", "",
        (Edit("base_footprint", "/>", '>\n    <visual><geometry><box size="0 0 0"/></geometry></visual>\n  </link>'),)),
    Variant("name-in-closing-tag", 1, "footprint", "", (Edit("base_footprint", "/>", '></link name="base_footprint">'),)),
    Variant("footprint-joint-otherwise-named", 2, "footprint", "", (Edit(_FOOTPRINT, '"base_joint"', '"footprint_joint"'),)),
    Variant("camera", 2, "extra", "", (Edit("base_link", "</link>", _CAMERA),)),
    Variant("collision", 2, "physics", "", (Edit("base_link", "</visual>", _COLLISION),)),
    Variant("without-rpy", 3, "rpy", "", (Edit(_LIDAR, ' rpy="0 0 0"'), Edit(_CASTER, ' rpy="0 0 0"'))),
)

# Variants without edits change the whole text.
BROKEN = (
    Variant("tag-parent", 2, "", "urdf-loads", (Edit(_LIDAR, "<parent link=", "<parent="),)),
    Variant("tag-origin", 2, "", "urdf-loads", (Edit(_FOOTPRINT, "<origin xyz=", "<origin="),)),
    Variant("comma-between-attributes", 2, "", "urdf-loads", (Edit("lidar", '"0.1" length', '"0.1", length'),)),
    Variant("comment-before-declaration", 2, "", "urdf-loads", ()),
    Variant("declaration-without-quotes", 1, "", "urdf-loads", ()),
    Variant("truncated", 2, "", _EVERYTHING, ()),
    Variant("text-after-robot", 2, "", "urdf-loads", ()),
    Variant("closed-twice", 1, "", "", ()),  # the parser of ROS 2 reads past it
    Variant("joint-without-child", 1, "", "urdf-loads joint-names caster-placed stands-on-ground",
        (Edit(_CASTER, '<child link="caster_wheel"/>'),)),
    Variant("joint-without-parent", 1, "", "urdf-loads caster-placed stands-on-ground",
        (Edit(_CASTER, '<parent link="base_link"/>'),)),
    Variant("unknown-link", 2, "", "urdf-loads lidar-fixed lidar-frame lidar-on-top joint-names",
        (Edit(_LIDAR, '<child link="lidar"/>', '<child link="laser"/>'),)),
    Variant("duplicate-link", 2, "", "urdf-loads", (Edit("caster_wheel", "</link>", '</link>\n  <link name="caster_wheel"/>'),)),
)
# fmt: on


def _bag(variants: Sequence[Variant]) -> tuple[Variant, ...]:
    """Return each value as often as its weight."""
    return tuple(variant for variant in variants for _ in range(variant.weight))


_MISTAKES, _EQUIVALENTS, _BROKEN = _bag(MISTAKES), _bag(EQUIVALENTS), _bag(BROKEN)


# --- One URDF ---------------------------------------------------------------------------------------------------------


class GeneratedUrdf(NamedTuple):
    """A generated URDF: its text, its kind, its variants, and exactly the criteria that it loses."""

    text: str
    sort: str
    variants: tuple[str, ...]
    lost: tuple[str, ...]


_COMMENTS = (
    "<!-- the wheels -->",
    "<!-- 0.6 / 4 = 0.15 -->",
    '<!-- <origin xyz="9 9 9" rpy="0 0 0"/> -->',
    "<!-- TODO: ask the tutor & fix this < later > -->",
    "<!-- die Räder -->",
    "<!-- length = 5 m -->",
)
_DECLARATIONS = (
    *30 * ('<?xml version="1.0"?>\n',),
    *10 * ('<?xml version="1.0" encoding="UTF-8"?>\n',),
    *4 * ("<?xml version='1.0' ?>\n\n",),
    *4 * ("",),
    '\n\n<?xml version="1.0"?>\n',
    '\ufeff<?xml version="1.0"?>\n',
)
_NUMBERS = re.compile(r'(?<=[a-z]=")[-.\d][-.\d ]*(?=")')
_ORIGIN = re.compile(r'(xyz="[^"]*") (rpy="[^"]*")')


@cache
def elements() -> dict[str, str]:
    """Return the elements of the reference below <robot>, by name, without comments."""
    text = re.sub(r"<!--.*?-->", "", (PACKAGE / URDF).read_text(encoding="utf-8"), flags=re.DOTALL)
    found = re.finditer(
        r'<(material|link|joint) name="([^"]+)"[^>]*?(?:/>|>.*?</\1>)', text, re.DOTALL
    )
    return {match[2]: re.sub(r" +\n", "\n", match[0]) for match in found}


@cache
def criteria() -> tuple[str, ...]:
    """Return the criteria of a URDF, in the order of the rubric."""
    rubric = tomllib.loads(RUBRIC.read_text(encoding="utf-8"))
    return tuple(
        criterion["id"] for criterion in rubric["criterion"] if criterion["part"] == "task1"
    )


def make_urdf(dice: Dice, author: str) -> GeneratedUrdf:
    """Return a URDF like a student's: of 100, 37 are correct (half of them with other numbers than the handout), 6 broken."""
    throw = dice.random()
    if throw < 0.185:
        return built(dice, author, "as told", ())
    if throw < 0.37:
        return built(dice, author, "equivalent", chosen(dice, _EQUIVALENTS, 1 + dice.below(5)))
    if throw < 0.94:
        count = 1 + (dice.random() < 0.5) + (dice.random() < 0.25)
        mistakes = chosen(dice, _MISTAKES, count)
        return built(
            dice,
            author,
            "mistaken",
            (*mistakes, *chosen(dice, _EQUIVALENTS, dice.below(3), mistakes)),
        )
    return built(dice, author, "broken", (dice.pick(_BROKEN),))


def chosen(
    dice: Dice, bag: Sequence[Variant], count: int, beside: Iterable[Variant] = ()
) -> tuple[Variant, ...]:
    """Return so many variants, or fewer, of which no two touch the same elements, nor those of `beside`."""
    taken = {part for variant in beside for part in variant.touches.split()}
    found: list[Variant] = []
    for _ in range(count):
        variant = dice.pick(bag)
        if taken.isdisjoint(variant.touches.split()):
            taken.update(variant.touches.split())
            found.append(variant)
    return tuple(found)


def built(dice: Dice, author: str, sort: str, variants: Sequence[Variant]) -> GeneratedUrdf:
    """Return the reference with these variants, in some style; the author's name makes it unique."""
    parts = dict(elements())
    for variant in variants:
        for edit in variant.edits:
            parts[edit.element] = (
                parts[edit.element].replace(edit.old, edit.new, 1) if edit.old else ""
            )
    lost = {criterion for variant in variants for criterion in variant.lost.split()}
    named = tuple(criterion for criterion in criteria() if criterion in lost or _EVERYTHING in lost)
    text = _spoilt(dice, _written(dice, author, parts), variants)
    return GeneratedUrdf(text, sort, tuple(variant.name for variant in variants), named)


def _written(dice: Dice, author: str, parts: dict[str, str]) -> str:
    """Return the text of a robot; no two styles change its meaning."""
    texts = _in_order(dice, [part for part in parts.values() if part])
    share = dice.pick((0.0, 0.1, 0.4))
    blocks = (
        f"  {dice.pick(_COMMENTS)}\n  {part}" if dice.chance(share) else f"  {part}"
        for part in texts
    )
    body = (
        f'<robot name="my_robot">\n\n{dice.pick((chr(10), chr(10) * 2)).join(blocks)}\n\n</robot>\n'
    )
    body = body.replace("  ", dice.pick(("  ", "  ", "    ", "\t", "")))
    share = dice.pick((0.0, 0.0, 0.2, 0.6))
    if share:
        body = _NUMBERS.sub(lambda found: _other_digits(dice, found[0], share), body)
    if dice.chance(0.2):
        body = _ORIGIN.sub(r"\2 \1", body)
    if dice.chance(0.1):
        body = body.replace('="', ' = "')
    if dice.chance(0.1):
        body = body.replace('"', "'")
    return f"{dice.pick(_DECLARATIONS)}<!-- {author} -->\n{body}"


def _in_order(dice: Dice, texts: list[str]) -> list[str]:
    """Return the elements as in the handout, links before joints, or in any order."""
    throw = dice.random()
    if throw < 0.6:
        return texts
    return sorted(texts, key=lambda text: text[1] == "j") if throw < 0.8 else dice.shuffled(texts)


def _other_digits(dice: Dice, numbers: str, share: float) -> str:
    """Return the same numbers, some of them in other digits."""
    pieces = [
        _other_form(dice, piece) if dice.chance(share) else piece for piece in numbers.split()
    ]
    return ("  " if dice.chance(0.1) else " ").join(pieces)


def _other_form(dice: Dice, number: str) -> str:
    if "." not in number:
        return number + dice.pick((".", ".0", ".00", "e0"))
    forms = (
        number + "0",
        number + "00",
        number + "e0",
        number.replace("0.", ".", 1) if "0." in number[:3] else number,
    )
    return dice.pick(forms)


def _spoilt(dice: Dice, text: str, variants: Sequence[Variant]) -> str:
    """Return the text after a variant's change of the whole of it, and with the line endings of some system."""
    below = text[text.index("<!--") :]
    match variants[0].name if variants else "":
        case "comment-before-declaration":
            text = f'<!-- Lab 6 -->\n<?xml version="1.0"?>\n{below}'
        case "declaration-without-quotes":
            text = f"<?xml version = 1.0>\n{below}"
        case "truncated":
            start, end = text.index("<robot") + 20, text.index("<link")
            text = text[: start + dice.below(end - start)]
        case "text-after-robot":
            text += dice.pick(("done\n", "```\n", "Lab 6, task 1\n"))
        case "closed-twice":
            text += "</robot>\n"
    return text.replace("\n", "\r\n") if dice.chance(0.15) else text


# --- People -----------------------------------------------------------------------------------------------------------


class Person(NamedTuple):
    """A generated student. `number` is their number in Canvas and Moodle, each with another leading digit."""

    first: str
    last: str
    login: str
    number: int
    is_late: bool

    @property
    def name(self) -> str:
        """Return the full name."""
        return f"{self.first} {self.last}"

    @property
    def is_awkward(self) -> bool:
        """Return whether the name is more than plain letters."""
        return not (self.first + self.last).isascii() or not (self.first + self.last).isalpha()

    @property
    def key(self) -> str:
        """Return the name of the submission in a class folder: the login, or the whole of an awkward name."""
        return self.name if self.is_awkward else self.login


_FIRST = ("Mira", "Tolo", "Anik", "Berin", "Sulu", "Katto", "Orla", "Pim", "Vesna", "Ilu")
_SYLLABLES = ("ta", "lo", "ven", "mar", "ki", "su", "dor", "pel", "na", "gri")
AWKWARD = (
    ("Zoë", "Müller-Weiß"),
    ("Sean", "O'Quote"),
    ('"Quoted"', 'Dou"ble'),
    ("=SUM(1;2)", "Formula"),
    ("+1", "Plus"),
    ("@at", "Minus-"),
    ("Comma, The", "Semi;colon"),
    ("שלום", "עולם"),
    ("مثال", "طالب"),
    ("測試", "學生"),
    ("Emoji😀", "Flag🏁"),
    ("Combining", "e\u0301a\u0308o\u0302"),
    ("Turned\u202eover", "Bidi"),
    ("Per%20cent", "Hash#1"),
    ("Two  Spaces", "Dot."),
    ("Line\nBreak", "Tab\tStop"),
    ("<b>Bold<b>", "&amp;"),
    ("$(touch x)", "`id`"),
    ("Under_score", "LATE_12_34_x"),
    ("Long", "Name" * 40),
)


def person(seed: int, index: int, *, with_awkward: bool) -> Person:
    """Return the student of this number; one in ten has an awkward name, if allowed, and one in twelve is late."""
    dice = Dice(f"{seed}/person/{index}")
    first, last = dice.pick(_FIRST), "".join(dice.pick(_SYLLABLES) for _ in range(3))
    login = f"{last}{index:06d}"
    is_late = dice.chance(1 / 12)
    if not with_awkward or index % 10 != 3:
        return Person(first, last.capitalize(), login, index, is_late)
    times, which = divmod(index // 10, len(AWKWARD))
    first, last = AWKWARD[which]
    return Person(first, f"{last} {times + 1}" if times else last, login, index, is_late)


# --- Archives that are the same everywhere: stored, with no time and no system's own marks ------------------------------


class Item(NamedTuple):
    """A file, a folder (`data` is None), or a link to `link`.

    `path` may contain undecodable bytes, as os.fsdecode writes them.
    """

    path: str
    data: bytes | None = None
    link: str = ""


def zipped(items: Iterable[Item]) -> bytes:
    """Return a zip of these items."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for item in items:
            info = zipfile.ZipInfo(
                item.path if item.data is not None or item.link else f"{item.path}/"
            )
            info.create_system, mode = 3, 0o120777 if item.link else 0o100644
            info.external_attr = (
                mode << 16 if item.data is not None or item.link else 0o40755 << 16 | 0x10
            )
            archive.writestr(info, item.link or item.data or b"")
    return buffer.getvalue()


def tarred(items: Iterable[Item]) -> bytes:
    """Return a tar.gz of these items."""
    buffer = io.BytesIO()
    with tarfile.open(fileobj=buffer, mode="w", format=tarfile.PAX_FORMAT) as archive:
        for item in items:
            info = tarfile.TarInfo(item.path)
            info.type = (
                tarfile.SYMTYPE
                if item.link
                else tarfile.REGTYPE
                if item.data is not None
                else tarfile.DIRTYPE
            )
            info.linkname, info.size = item.link, len(item.data or b"")
            archive.addfile(info, io.BytesIO(item.data or b""))
    data = buffer.getvalue()
    ends = struct.pack("<2I", zlib.crc32(data), len(data))
    return b"\x1f\x8b\x08\0\0\0\0\0\0\xff" + stored(data) + ends


def stored(data: bytes) -> bytes:
    """Return an uncompressed deflate stream: zlib's output differs between versions."""
    pieces = [data[start : start + 65535] for start in range(0, len(data), 65535)] or [b""]
    last = len(pieces) - 1
    heads = (
        struct.pack("<B2H", index == last, len(piece), 65535 - len(piece))
        for index, piece in enumerate(pieces)
    )
    return b"".join(head + piece for head, piece in zip(heads, pieces, strict=True))


@cache
def bomb() -> bytes:
    """Return a zip of 64 KiB that unpacks to 64 MiB of zeros: one deflate block with codes of one bit."""
    head, tail = bytes.fromhex("edc101010000008220ffaf6e484001"), bytes.fromhex("f706")
    data = head + bytes(65_000) + tail
    zeros = zlib.decompressobj(-15).decompress(data)
    common = struct.pack(
        "<5H3I2H", 20, 0, 8, 0, 0x21, zlib.crc32(zeros), len(data), len(zeros), 13, 0
    )
    local = b"PK\3\4" + common + b"my_robot.urdf" + data
    central = b"PK\1\2\x14\0" + common + struct.pack("<3H2I", 0, 0, 0, 0, 0) + b"my_robot.urdf"
    return (
        local + central + b"PK\5\6" + struct.pack("<4H2IH", 0, 0, 1, 1, len(central), len(local), 0)
    )


def picture(dice: Dice) -> bytes:
    """Return a PNG of one pixel."""

    def chunk(name: bytes, data: bytes) -> bytes:
        return (
            struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
        )

    pixel = bytes([0, dice.below(256), dice.below(256), dice.below(256)])
    packed = b"\x78\x01" + stored(pixel) + struct.pack(">I", zlib.adler32(pixel))
    size = struct.pack(">2I5B", 1, 1, 8, 2, 0, 0, 0)
    return (
        b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", size) + chunk(b"IDAT", packed) + chunk(b"IEND", b"")
    )


# --- What is submitted ------------------------------------------------------------------------------------------------


class ItemFactory:
    """Random choices and URDFs for one student. `made` is the URDF that counts; None if it is uncertain."""

    def __init__(self, dice: Dice, author: str) -> None:
        self.dice, self._author = dice, author
        self.made: GeneratedUrdf | None = None

    def urdf(self) -> bytes:
        """Return a new URDF, which counts from now on."""
        self.made = make_urdf(self.dice, self._author)
        return self.made.text.encode()

    def uncertain(self, data: bytes) -> bytes:
        """Return the same bytes, with an unknown result."""
        self.made = None
        return data

    def garbage(self, count: int) -> bytes:
        """Return meaningless bytes."""
        return hashlib.shake_128(f"{self._author}".encode()).digest(count)


@cache
def _package() -> tuple[Item, ...]:
    files = sorted(
        path for path in PACKAGE.rglob("*") if path.is_file() and "__pycache__" not in path.parts
    )
    return tuple(Item(path.relative_to(PACKAGE).as_posix(), path.read_bytes()) for path in files)


def package(desk: ItemFactory, top: str = "my_robot") -> list[Item]:
    """Return the package with the student's URDF."""
    urdf = desk.urdf()
    return [
        Item(f"{top}/{item.path}", urdf if item.path == URDF else item.data) for item in _package()
    ]


def workspace(desk: ItemFactory) -> list[Item]:
    """Return a workspace with the products of an old build, pictures and answers."""
    built_before = desk.urdf()
    stale = "roscourse_sim_ws/install/my_robot/share/my_robot"
    return [
        Item(f"{stale}/my_robot.urdf", built_before),
        Item(f"{stale}/package.xml", b"<package/>"),
        Item("roscourse_sim_ws/build/COLCON_IGNORE", b""),
        *package(desk, "roscourse_sim_ws/src/my_robot"),
        *loose_files(desk),
    ]


def loose_files(desk: ItemFactory) -> list[Item]:
    """Return pictures and answers."""
    answers = b"Task 1 Step 15: the model vanishes.\nTask 2 Step 2: rviz2 shows the robot.\n"
    names = ("Task1_Step8.png", "task1 step18.PNG", "Task1_Step36.png", "T3S3.png")
    return [*(Item(name, picture(desk.dice)) for name in names), Item("answers.txt", answers)]


def single(desk: ItemFactory) -> list[Item]:
    """Return one URDF."""
    return [Item("my_robot.urdf", desk.urdf())]


def _laughs() -> bytes:
    entities = "".join(f'<!ENTITY l{n} "{f"&l{n - 1};" * 10}">' for n in range(1, 10))
    return f'<!DOCTYPE robot [<!ENTITY l0 "ha">{entities}]><robot name="&l9;"/>'.encode()


def _nested(count: int, data: bytes) -> bytes:
    for _ in range(count):
        data = zipped([Item("inner.zip", data)])
    return data


def _wrapped(desk: ItemFactory) -> list[Item]:
    """Return a zip as macOS makes it."""
    inside = [Item(f"Lab 6/{item.path}", item.data) for item in package(desk)]
    return [
        Item("lab6.zip", zipped([*inside, Item("__MACOSX/Lab 6/._my_robot", desk.garbage(100))]))
    ]


def _escaping(desk: ItemFactory) -> list[Item]:
    variants = (
        "../../escaped.urdf",
        "/escaped.urdf",
        "C:\\escaped.urdf",
        "a/../../../escaped.urdf",
    )
    return [
        *(Item(path, desk.uncertain(desk.urdf())) for path in variants),
        Item("notes.txt", b"nothing"),
    ]


def _links_out(_: ItemFactory) -> list[Item]:
    return [
        Item("my_robot", link="../../.."),
        Item("my_robot.urdf", link="/etc/hostname"),
        Item("again", link="."),
    ]


def _cut(data: bytes) -> bytes:
    return data[: len(data) * 2 // 3]


Attempts = list[list[Item]]
Kind = Callable[[ItemFactory], Attempts]


def _once(build: Callable[[ItemFactory], list[Item]]) -> Kind:
    return lambda desk: [build(desk)]


def _raw(name: str, data: Callable[[ItemFactory], bytes]) -> Kind:
    """Return one file with an unknown result."""
    return lambda desk: [[Item(name, desk.uncertain(data(desk)))]]


def _folder(data: Callable[[ItemFactory], list[Item]]) -> Kind:
    """Return a folder with an unknown result."""

    def build(desk: ItemFactory) -> Attempts:
        items = data(desk)
        desk.made = None
        return [items]

    return build


# The number of each kind in a class of about a hundred. An empty list is a missing submission.
KINDS: dict[str, tuple[int, Kind]] = {
    "nothing": (4, lambda _: []),
    "urdf": (22, _once(single)),
    "package": (12, _once(package)),
    "package-zip": (14, _once(lambda desk: [Item("my_robot.zip", zipped(package(desk)))])),
    "wrapped-zip": (4, _once(_wrapped)),
    "workspace": (6, _once(workspace)),
    "workspace-zip": (
        4,
        _once(lambda desk: [Item("roscourse_sim_ws.zip", zipped(workspace(desk)))]),
    ),
    "tar-gz": (4, _once(lambda desk: [Item("my_robot.tar.gz", tarred(package(desk)))])),
    "loose-files": (5, _once(lambda desk: [*single(desk), *loose_files(desk)])),
    "odd-folder": (
        3,
        _once(lambda desk: [Item("Neuer Ordner (2)/end gültig/robot final.urdf", desk.urdf())]),
    ),
    "pictures-only": (4, _folder(loose_files)),
    "two-attempts": (3, lambda desk: [single(desk), single(desk)]),
    "three-zips": (2, lambda desk: [[Item("lab6.zip", zipped(package(desk)))] for _ in range(3)]),
    "xacro": (1, _raw("my_robot.urdf.xacro", ItemFactory.urdf)),
    "empty-folder": (1, _folder(lambda _: [Item("my_robot")])),
    "empty-file": (1, _raw("my_robot.urdf", lambda _: b"")),
    "empty-zip": (1, _raw("lab6.zip", lambda _: zipped([]))),
    "broken-zip": (1, _raw("lab6.zip", lambda desk: _cut(zipped(package(desk))))),
    "broken-tar": (1, _raw("lab6.tar.gz", lambda desk: _cut(tarred(package(desk))))),
    "garbage-zip": (1, _raw("lab6.zip", lambda desk: desk.garbage(5_000))),
    "zip-bomb": (1, _raw("lab6.zip", lambda _: bomb())),
    "zips-in-zips": (1, _raw("lab6.zip", lambda desk: _nested(6, zipped(package(desk))))),
    "escaping-zip": (1, _raw("lab6.zip", lambda desk: zipped(_escaping(desk)))),
    "escaping-tar": (1, _raw("lab6.tar.gz", lambda desk: tarred(_escaping(desk)))),
    "links-out": (1, _folder(_links_out)),
    "links-out-zip": (1, _raw("lab6.zip", lambda desk: zipped(_links_out(desk)))),
    "links-out-tar": (1, _raw("lab6.tar.gz", lambda desk: tarred(_links_out(desk)))),
    "deep-folders": (1, _folder(lambda desk: [Item("d/" * 80 + "my_robot.urdf", desk.urdf())])),
    "deep-zip": (
        1,
        _raw("lab6.zip", lambda desk: zipped([Item("d/" * 400 + "my_robot.urdf", desk.urdf())])),
    ),
    "garbage": (1, _raw("my_robot.urdf", lambda desk: desk.garbage(1024 * 1024))),
    "too-large": (1, _raw("my_robot.urdf", lambda desk: desk.urdf() + b" " * (1024 * 1024))),
    "deep-xml": (1, _raw("my_robot.urdf", lambda _: b'<robot name="a">' + b"<link>" * 150_000)),
    "billion-laughs": (1, _raw("my_robot.urdf", lambda _: _laughs())),
    "nul-bytes": (1, _raw("my_robot.urdf", lambda desk: desk.urdf().replace(b"<link", b"\0<link"))),
    "utf-16": (1, _raw("my_robot.urdf", lambda desk: desk.urdf().decode().encode("utf-16-le"))),
    "latin-text": (
        1,
        _raw(
            "my_robot.urdf", lambda desk: desk.urdf().replace(b"<robot", b"<!-- \xfc -->\n<robot")
        ),
    ),
    "latin-name": (1, _folder(lambda desk: [Item("\udcfcbung/m\udcf6ller.urdf", desk.urdf())])),
}


class GeneratedSubmission(NamedTuple):
    """The attempts of one student, and their kind. The last of the `attempts` counts; there may be none."""

    person: Person
    kind: str
    attempts: Attempts
    made: GeneratedUrdf | None


def submissions(count: int, seed: int, kind: str) -> Iterator[GeneratedSubmission]:
    """Yield a class of so many students. A mixed one has one more, who is on no list and comes last."""
    is_mixed = kind == "mixed"
    for index in range(count + is_mixed):
        name = card(seed, index) if is_mixed and index < count else "urdf"
        who = person(seed, index, with_awkward=is_mixed)
        desk = ItemFactory(Dice(f"{seed}/hand-in/{index}"), who.login)
        attempts = KINDS[name][1](desk)
        yield GeneratedSubmission(who, name, attempts, desk.made)


def card(seed: int, index: int) -> str:
    """Return the kind of a student's submission, drawn from shuffled decks with each kind in its proportion."""
    size = sum(weight for weight, _ in KINDS.values())
    return _deck(seed, index // size)[index % size]


@cache
def _deck(seed: int, number: int) -> list[str]:
    cards = (name for name, (weight, _) in KINDS.items() for _ in range(weight))
    return Dice(f"{seed}/deck/{number}").shuffled(cards)


# --- Where it is put --------------------------------------------------------------------------------------------------

ENDINGS = (".urdf.xacro", ".tar.gz", ".urdf", ".zip")


def in_folders(submission: GeneratedSubmission) -> Iterator[Item]:
    """Yield a file named after the student, or a folder; later attempts are numbered as browsers do."""
    for number, items in enumerate(submission.attempts):
        key = f"{submission.person.key} ({number})" if number else submission.person.key
        ending = _only_ending(items)
        if ending:
            yield items[0]._replace(path=key + ending)
        else:
            yield Item(key)
            yield from _below(key, items)


def in_canvas(submission: GeneratedSubmission) -> Iterator[Item]:
    """Yield files as in a Canvas download; folders are zipped. The same name in a later attempt is numbered."""
    who = submission.person
    for number, items in enumerate(submission.attempts):
        is_flat = all(item.data is not None and "/" not in item.path for item in items)
        files = items if is_flat else [Item("lab6.zip", zipped(_plainly(items)))]
        for position, item in enumerate(files):
            stem, dot, ending = item.path.partition(".")
            name = f"{stem}-{number}{dot}{ending}" if number else item.path
            attachment = 10 * (10 * who.number + number) + position + 1_000_000
            late = "_LATE" if who.is_late else ""
            yield item._replace(
                path=f"{canvas_name(who)}{late}_{canvas_id(who)}_{attachment}_{name}"
            )


def in_moodle(submission: GeneratedSubmission) -> Iterator[Item]:
    """Yield a folder for each participant, with the last attempt in it."""
    who = submission.person
    if submission.attempts:
        top = f"{moodle_name(who)}_{moodle_id(who)}_assignsubmission_file"
        yield Item(top)
        yield from _below(top, submission.attempts[-1])


_PLACING = {"folders": in_folders, "canvas": in_canvas, "moodle": in_moodle}


def canvas_id(who: Person) -> int:
    """Return the user's number in Canvas."""
    return 100_000 + who.number


def moodle_id(who: Person) -> int:
    """Return the participant's number in Moodle."""
    return 5_000_000 + who.number


def canvas_name(who: Person) -> str:
    """Return the sortable name as Canvas writes it into file names: lower-case letters with their accents, and digits only."""
    name = re.sub(r"_(\d+)_", r"\1", f"{who.last}, {who.first}")
    kept = (
        letter
        for letter in name
        if letter.isalnum() or letter == "_" or unicodedata.category(letter)[0] == "M"
    )
    return "".join(kept).lower()


def moodle_name(who: Person) -> str:
    """Return the full name as Moodle writes it into folder names, without characters that file names may not have."""
    return re.sub(r'[\x00-\x1f\\/:*?"<>|&]', "", who.name.replace("_", " ")).strip()


def _only_ending(items: Sequence[Item]) -> str:
    """Return the ending of the single submitted file; empty if there is no single file."""
    if len(items) != 1 or items[0].data is None or "/" in items[0].path:
        return ""
    return next((ending for ending in ENDINGS if items[0].path.endswith(ending)), "")


def _below(top: str, items: Iterable[Item]) -> Iterator[Item]:
    return (item._replace(path=f"{top}/{item.path}") for item in items)


def _plainly(items: Iterable[Item]) -> Iterator[Item]:
    """Return the items with names that a zip can hold."""
    return (item._replace(path=os.fsencode(item.path).decode("latin-1")) for item in items)


def write(root: str, item: Item) -> None:
    """Write a file, folder or link below a folder; omit what the file system cannot hold."""
    path = f"{root}/{item.path}"
    if item.data is not None and "/" not in item.path:
        with open(path, "wb") as file:  # noqa: PTH123  a hundred thousand of them
            file.write(item.data)
        return
    with suppress(OSError):  # names that are no UTF-8, and links
        Path(path).parent.mkdir(parents=True, exist_ok=True)
        if item.link:
            Path(path).symlink_to(item.link)
        elif item.data is None:
            Path(path).mkdir(exist_ok=True)
        else:
            Path(path).write_bytes(item.data)


# --- The class --------------------------------------------------------------------------------------------------------


class WrittenSubmission(NamedTuple):
    """A written submission: student, kind, paths (top names of the last attempt), and its lost criteria if certain."""

    person: Person
    kind: str
    paths: tuple[str, ...]
    made: GeneratedUrdf | None


def make_class(
    folder: Path, count: int, seed: int = 1, kind: str = "urdf", layout: str = "folders"
) -> Iterator[WrittenSubmission]:
    """Write a class into a folder, one submission after the other."""
    folder.mkdir(parents=True, exist_ok=True)
    root, target = str(folder), _PLACING[layout]
    for submission in submissions(count, seed, kind):
        tops: dict[str, None] = {}
        for item in target(submission):
            write(root, item)
            tops[item.path.partition("/")[0]] = None
        yield WrittenSubmission(submission.person, submission.kind, tuple(tops), submission.made)


def roster(people: Iterable[Person]) -> str:
    """Return an instructor's roster."""
    header = ["id", "name", "email", "login", "canvas id", "moodle id", "late"]
    rows = (
        [
            _sis(who),
            who.name,
            _email(who),
            who.login,
            canvas_id(who),
            moodle_id(who),
            "yes" if who.is_late else "",
        ]
        for who in people
    )
    return _csv(header, rows, "\n")


def canvas_gradebook(people: Iterable[Person]) -> str:
    """Return a gradebook as Canvas exports it, with one assignment and no grades."""
    header = ["Student", "ID", "SIS User ID", "SIS Login ID", "Section", "Lab 6 (98765)"]
    points = ["    Points Possible", "", "", "", "", "100.00"]
    rows = (
        [f"{who.last}, {who.first}", canvas_id(who), _sis(who), who.login, "Lab group 1", ""]
        for who in people
    )
    return _csv(header, [points, *rows], "\n")


def moodle_worksheet(people: Iterable[Person], submitted: set[Person]) -> str:
    """Return a Moodle grading worksheet without grades."""
    header = [
        "Identifier",
        "Full name",
        "Email address",
        "Status",
        "Grade",
        "Maximum grade",
        "Grade can be changed",
        "Last modified (submission)",
        "Last modified (grade)",
        "Feedback comments",
    ]
    rows = (
        [
            f"Participant {moodle_id(who)}",
            who.name,
            _email(who),
            "Submitted for grading" if who in submitted else "No submission",
            "",
            "100.00",
            "Yes",
            "Tuesday, 1 September 2026, 10:00 AM" if who in submitted else "-",
            "-",
            "",
        ]
        for who in people
    )
    return "\ufeff" + _csv(header, rows, "\n")


def _sis(who: Person) -> str:
    return f"S{700_000 + who.number}"


def _email(who: Person) -> str:
    return f"{who.login}@example.org"


def _csv(header: list[str], rows: Iterable[Sequence[Any]], end: str) -> str:
    buffer = io.StringIO(newline="")
    writer = csv.writer(buffer, lineterminator=end)
    writer.writerow(header)
    writer.writerows(rows)
    return buffer.getvalue()


def expectation(written: WrittenSubmission) -> dict[str, Any]:
    """Return the known data of a submission; `lost` are all criteria of the URDF that it loses, null if uncertain."""
    made = written.made
    return {
        "kind": written.kind,
        "paths": [os.fsencode(path).decode("utf-8", "replace") for path in written.paths],
        "sort": made.sort if made else None,
        "variants": made.variants if made else None,
        "lost": made.lost if made else None,
    }


def main() -> None:
    """Write a class, and the files of an LMS and of a test next to it."""
    parser = argparse.ArgumentParser(
        description="Generate a class of invented submissions of Lab 6."
    )
    parser.add_argument("folder", type=Path, help="the class folder to write")
    parser.add_argument(
        "--count", type=int, default=1000, help="number of students (default: 1000)"
    )
    parser.add_argument(
        "--seed", type=int, default=1, help="seed of the random choices (default: 1)"
    )
    parser.add_argument(
        "--kind",
        choices=("urdf", "mixed"),
        default="urdf",
        help="URDFs only, or packages and damaged files as well",
    )
    parser.add_argument(
        "--layout", choices=LAYOUTS, default="folders", help="layout of the class folder"
    )
    parser.add_argument(
        "--expected",
        type=Path,
        help="write the expected lost criteria of each submission to this JSON file",
    )
    parser.add_argument("--roster", type=Path, help="write a roster to this CSV file")
    parser.add_argument(
        "--lms",
        type=Path,
        help="write a Canvas gradebook or Moodle grading worksheet to this CSV file",
    )
    given = parser.parse_args()
    made = make_class(given.folder, given.count, given.seed, given.kind, given.layout)
    if not (given.expected or given.roster or given.lms):
        has_submitted = [bool(one.paths) for one in made]
        print(f"{len(has_submitted)} students, {sum(has_submitted)} with a submission")
        return
    written = list(made)
    write_beside(written, given.count, given.layout, given.expected, given.roster, given.lms)
    unlisted = len(written) - given.count
    extra = f" ({unlisted} not on the roster)" if unlisted else ""
    submitted = sum(bool(one.paths) for one in written)
    print(f"{len(written)} students{extra}, {submitted} with a submission")


def write_beside(
    written: Sequence[WrittenSubmission],
    count: int,
    layout: str,
    expected: Path | None,
    people: Path | None,
    lms: Path | None,
) -> None:
    """Write the files that belong to a class but are not in it. Students after the first `count` are on no list."""
    students = [submission.person for submission in written[:count]]
    if expected:
        known = {submission.person.key: expectation(submission) for submission in written}
        expected.write_text(
            json.dumps(known, indent=1, ensure_ascii=False) + "\n", encoding="utf-8"
        )
    if people:
        people.write_bytes(roster(students).encode())
    if lms:
        submitted = {submission.person for submission in written if submission.paths}
        text = (
            moodle_worksheet(students, submitted)
            if layout == "moodle"
            else canvas_gradebook(students)
        )
        lms.write_bytes(text.encode())


if __name__ == "__main__":
    main()
