"""The words of a URDF that surely are meant where others are written: tags, attributes, numbers."""

import re
from collections.abc import Iterable

from grader.base.grouping import StringsByName, only_one
from grader.base.names import closest, near
from grader.base.patterns import on_use
from grader.ros.urdf.numbers import NumberError, number, numbers, readable_numbers
from grader.ros.xml.urdf_format import (
    ATTRIBUTES,
    CHILDREN,
    OWNERS,
    PARTS,
    REQUIRED,
    TAGS,
    numbers_in,
)

_MAX_LENGTH = 64  # characters of a value
_SEPARATORS = on_use(r"(?:(?<!\s)\s++)?[,;]\s*")
_DECIMAL_COMMA = on_use(r"(?<=\d),(?=\d)")
_BRACKETS = on_use(r"\s*[(\[{](.*)[)\]}]\s*")
_TIMES = on_use(r"(?<=[\d.])\s*+[xX×*]\s*(?=[-+.\d])")  # 0.6x0.4x0.2
_DASHES = str.maketrans(dict.fromkeys("‐‑‒–—−", "-"))
_LETTERS = str.maketrans("OoIl", "0011")
# How people write the units of attributes, without those of another unit in another element.
_UNITS = {
    "value": ("kg",),
    "size": ("m",),
    "radius": ("m",),
    "length": ("m",),
    "rpy": ("rad",),
    "lower": ("rad", "m"),
    "upper": ("rad", "m"),
    "velocity": ("rad/s", "m/s"),
    "effort": ("Nm", "N m", "N*m", "N"),
    **dict.fromkeys(
        ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"), ("kg m^2", "kg*m^2", "kgm^2", "kg m2")
    ),
}
_DIGIT_AND_LETTER = on_use(r"(?=.*\d)[-+.\dOoIl]+(?:e[-+]?\d+)?")


def meant_tag(tag: str, parent: str, present: set[str]) -> str | None:
    """Return the child of `parent` that a tag surely stands for, which is not `present` yet.

    Returns None for a tag that is right, or that is of another tool.
    """
    if tag in TAGS or tag.startswith("{"):
        return None
    children = CHILDREN.get(parent, ())
    if parent == "robot":  # it has many of each
        return _surely_meant(tag, children)
    if parent == "geometry" and not present.isdisjoint(children):  # it has one shape
        return None
    return _surely_meant(tag, [name for name in children if name not in present])


def meant_attribute(name: str, tag: str, values: StringsByName) -> str | None:
    """Return the attribute of `tag` that a name surely stands for.

    It is not among its `values` yet.
    """
    if name in ATTRIBUTES[tag] or name.startswith("{"):
        return None
    absent = [other for other in TAGS[tag].attributes if other not in values]
    meant = TAGS[tag].aliases.get(name)
    if meant is None and name in OWNERS:
        return _other_vector(name, values[name], tag, absent)
    if meant is None:
        meant = _surely_meant(name, absent) or _only_absent(name, tag, absent)
    if meant in absent and _may_have(meant, values[name]):
        return meant
    return None


def _only_absent(name: str, tag: str, absent: list[str]) -> str | None:
    """Return the attribute that an element needs and that a short name stands for.

    It differs in one letter, as lxx from ixx, or is called as the element: <mass mass="1"/>.
    """
    needed = [other for other in absent if other in REQUIRED[tag]]
    if name == tag and len(TAGS[tag].attributes) == len(needed) == 1:
        return needed[0]
    similar = []
    for other in needed:
        differing = sum(one != letter for one, letter in zip(name, other, strict=False))
        if len(other) == len(name) and differing == 1:
            similar.append(other)
    return only_one(similar)


def _other_vector(name: str, value: str, tag: str, absent: list[str]) -> str | None:
    """Return the one vector of an element whose name is written as another vector's.

    An example is <axis rpy="0 0 1"/>.
    """
    count = len(PARTS[name])
    vectors = [other for other in TAGS[tag].attributes if len(PARTS[other]) == count]
    if count > 1 and len(numbers_in(value)) == count and vectors == absent:
        return vectors[0]
    return None


def _may_have(attribute: str, value: str) -> bool:
    """Return whether a value has the numbers of an attribute, or surely stands for such numbers."""
    count = len(PARTS.get(attribute, ()))
    return not count or _is_read(value, count) or meant_value(value, attribute) is not None


def meant_value(text: str, attribute: str) -> str | None:
    """Return the numbers that a value surely stands for.

    Returns None for one that ROS 2 reads, or that may be several.
    """
    count = len(PARTS.get(attribute, ()))
    if not count or len(text) > _MAX_LENGTH or _is_read(text, count):
        return None
    plain = _without_letters(_without_unit(text.translate(_DASHES), attribute))
    if count > 1:
        plain = _TIMES.sub(" ", plain)
    decimal = _DECIMAL_COMMA.sub(".", plain)
    ways = {plain, _SEPARATORS.sub(" ", plain).strip(), _SEPARATORS.sub(" ", decimal).strip()}
    readable_ways = {way for way in ways if _is_read(way, count)}
    if len(readable_ways) == 1:
        return readable_ways.pop()
    readable = readable_numbers(text, count) if not readable_ways else None
    return " ".join(readable) if readable is not None and len(readable) == count else None


def _without_unit(text: str, attribute: str) -> str:
    """Return a value without the unit that a URDF has: 1.2 kg, but no g, mm or degree."""
    for unit in _UNITS.get(attribute, ()):
        text = re.sub(rf"(?<=[\d.])\s*\[?{re.escape(unit)}\]?(?![\w/*^])", "", text)
    return text


def _without_letters(text: str) -> str:
    """Return a value without brackets, and with digits for the letters that look like them."""
    bracketed = _BRACKETS.fullmatch(text)
    inner = (bracketed[1] if bracketed else text).strip()
    words = re.split(r"([\s,;]+)", inner)
    for index, word in enumerate(words):
        if _DIGIT_AND_LETTER.fullmatch(word):
            words[index] = word.translate(_LETTERS)
    return "".join(words)


def _is_read(text: str, count: int) -> bool:
    try:
        if count == 1:
            number(text)
            return True
        return len(numbers(text)) == count
    except NumberError:
        return False


def _surely_meant(name: str, known: Iterable[str]) -> str | None:
    """Return the one of a few known words that another word surely stands for."""
    known = list(known)
    return near(name, known) or closest(name, known, is_clear=True)
