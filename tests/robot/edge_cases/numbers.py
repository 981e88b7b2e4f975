"""Numbers in vectors, scalars, colours and the version; Python's `float` accepts others."""

from tests.robot.edge_cases.case import (
    EdgeCase,
    clean,
    degraded,
    geometry,
    links,
    one_joint,
    one_link,
    rejected,
    robot,
    visual,
)

_GRAMMAR = "a number is ASCII digits with a sign, a point and an exponent at most"
_VECTOR = "a vector is split at U+0020 only, into three pieces"
_LEADING = "white space before a number is taken, after it is not"
_SCALAR = "a scalar may have white space before it, not after"
_COLOUR = "a colour is a vector whose channels lie in 0..1"
_VERSION = "the version is two integers that come to 1 and 0"
_FORMAT = "an error about a vector is itself a printf format"

# Spellings of one number: they are read in a vector and as a scalar alike.
_ACCEPTED = {
    "zero": "0",
    "trailing-point": "1.",
    "leading-point": ".5",
    "plus": "+1",
    "minus": "-1",
    "minus-zero": "-0",
    "exponent": "1e3",
    "exponent-minus": "1e-3",
    "leading-zeros": "007",
    "underflow": "1e-400",
    "denormal": "4.9e-324",
    "largest": "1.7976931348623157e308",
    "zero-with-huge-exponent": "0e400",
    "forty-digits": "1" * 40,
}
_REFUSED = {
    "nan": "nan",
    "inf": "inf",
    "hex": "0x10",
    "overflow": "1e400",
    "four-hundred-digits": "1" * 400,
    "exponent-missing": "1e",
    "exponent-with-point": "1e2.5",
    "exponent-alone": "e5",
    "float-suffix": "1.0f",
    "underscore": "1_000",
    "comma": "1,5",
    "two-points": "1..5",
    "point-alone": ".",
    "sign-alone": "-",
    "two-signs": "--1",
    "degrees": "90deg",
    "percent": "50%",
    "xacro-constant": "${pi}",
    "unicode-minus": "\u22121",
    "arabic-digit": "\u0661",
    "no-break-space-after": "1\u00a0",
    "no-break-space-in-front": "\u00a01",
    "mark-in-front": "\ufeff1",
    "control-after": "1\x01",
}

# Whole vectors.
_WHOLE = {
    "one-space": "1 2 3",
    "leading-space": " 1 2 3",
    "trailing-space": "1 2 3 ",
    "spaces-about": "   1   2   3   ",
    "leading-tab": "\t1 2 3",
    "leading-newline": "\n1 2 3",
    "leading-form-feed": "\v\f1 2 3",
    "space-tab": "1 \t2 3",
    "space-newline": "1 \n2 3",
}
_BROKEN = {
    "empty": "",
    "blank": " ",
    "one-piece": "1",
    "two-pieces": "1 2",
    "four-pieces": "1 2 3 4",
    "tab": "1\t2\t3",
    "tab-space": "1\t 2 3",
    "newline": "1\n2\n3",
    "space-newline-space": "1 \n 2 3",
    "trailing-tab": "1 2 3\t",
    "trailing-newline": "1 2 3\n",
    "form-feed": "1\f2 3",
    "no-break-spaces": "1\u00a02\u00a03",
    "commas-and-spaces": "1, 2, 3",
    "commas-after-spaces": "1 ,2 ,3",
    "semicolons": "1; 2; 3",
    "brackets": "[1 2 3]",
    "xacro": "${x} ${y} ${z}",
    "last-not-a-number": "1 2 x",
    "extra-not-a-number": "1 2 3 x",
}

# Whole scalars.
_SCALARS = {"leading-space": " 1", "leading-tab": "\t1", "leading-newline": "\r\n1"}
_NO_SCALARS = {
    "empty": "",
    "blank": " ",
    "trailing-space": "1 ",
    "trailing-tab": "1\t",
    "trailing-newline": "1\n",
    "spaces-about": " 1 ",
    "two-numbers": "1 2",
    "inner-space": "- 1",
}


def _origin(vector: str) -> str:
    return one_joint(f'<origin xyz="{vector}"/>')


def _limit(lower: str) -> str:
    return one_joint(f'<limit lower="{lower}" effort="1" velocity="1"/>')


def _visual_origin(vector: str) -> str:
    return one_link(visual(f'<origin rpy="{vector}"/>'))


def _sphere(radius: str) -> str:
    return geometry(f'<sphere radius="{radius}"/>')


VECTORS: tuple[EdgeCase, ...] = (
    *(clean(f"vector-piece-{name}", _GRAMMAR, _origin(f"0 {value} 0")) for name, value in _ACCEPTED.items()),
    *(rejected(f"vector-piece-{name}", _GRAMMAR, _origin(f"0 {value} 0")) for name, value in _REFUSED.items()),
    *(clean(f"vector-{name}", _LEADING, _origin(value)) for name, value in _WHOLE.items()),
    *(rejected(f"vector-{name}", _VECTOR, _origin(value)) for name, value in _BROKEN.items()),
    *(clean(f"visual-vector-{name}", _LEADING, _visual_origin(value)) for name, value in _WHOLE.items()),
    *(degraded(f"visual-vector-{name}", _VECTOR, _visual_origin(value)) for name, value in _BROKEN.items()),
)

SCALARS: tuple[EdgeCase, ...] = (
    *(clean(f"limit-{name}", _GRAMMAR, _limit(value)) for name, value in _ACCEPTED.items()),
    *(rejected(f"limit-{name}", _GRAMMAR, _limit(value)) for name, value in _REFUSED.items()),
    *(clean(f"limit-{name}", _SCALAR, _limit(value)) for name, value in _SCALARS.items()),
    *(rejected(f"limit-{name}", _SCALAR, _limit(value)) for name, value in _NO_SCALARS.items()),
    *(clean(f"radius-{name}", _SCALAR, _sphere(value)) for name, value in _SCALARS.items()),
    *(degraded(f"radius-{name}", _SCALAR, _sphere(value)) for name, value in _NO_SCALARS.items()),
)


def _coloured(rgba: str) -> str:
    return one_link(visual(f'<material name="m"><color rgba="{rgba}"/></material>'))


_COLOURS = {
    "plain": "0.1 0.2 0.3 1",
    "spaces": "  0  0  0  1  ",
    "leading-tab": "\t0 0 0 1",
    "minus-zero": "-0 0 0 1",
    "underflow": "1e-400 0 0 1",
    "three-numbers": "1 0 0",
    "five-numbers": "1 0 0 1 1",
    "empty": "",
    "blank": "  ",
}
_NO_COLOURS = {
    "byte": "255 0 0 255",
    "just-above": "1.0000001 0 0 1",
    "negative": "-0.1 0 0 1",
    "nan": "nan 0 0 1",
    "overflow": "1e400 0 0 1",
    "hex": "#ff0000",
    "word": "red",
    "tabs": "1\t0\t0\t1",
    "trailing-newline": "1 0 0 1\n",
    "letter-in-five-numbers": "1 0 0 1 x",
    "percent": "100% 0 0 1",
}

COLOURS: tuple[EdgeCase, ...] = (
    *(clean(f"colour-{name}", _COLOUR, _coloured(value)) for name, value in _COLOURS.items()),
    *(degraded(f"colour-{name}", _COLOUR, _coloured(value)) for name, value in _NO_COLOURS.items()),
)

_VERSIONS = {
    "plain": "1.0",
    "leading-space": " 1.0",
    "leading-tab": "\t1.0",
    "leading-newline": "\n1.0",
    "space-after-point": "1. 0",
    "leading-zeros": "01.00",
    "plus": "+1.0",
    "minus-zero": "1.-0",
    "trailing-point": "1.0.",
    "minor-of-two-to-the-32": "1.4294967296",
    "major-of-two-to-the-32-and-one": "4294967297.0",
}
_NO_VERSIONS = {
    "empty": "",
    "blank": " ",
    "major-only": "1",
    "major-and-point": "1.",
    "minor-only": ".0",
    "point": ".",
    "two-points": "1..0",
    "one-one": "1.1",
    "negative": "-1.0",
    "trailing-space": "1.0 ",
    "trailing-newline": "1.0\n",
    "space-before-point": "1 .0",
    "comma": "1,0",
    "hex": "0x1.0",
    "exponent": "1e0.0",
    "full-width": "\uff11.0",
    "minor-of-two-to-the-31": "1.2147483648",
}


def _versioned(version: str) -> str:
    return robot(links("a"), f'name="r" version="{version}"')


VERSIONS: tuple[EdgeCase, ...] = (
    clean("version-absent", _VERSION, robot(links("a"))),
    clean("version-in-capitals", "names are case-sensitive", robot(links("a"), 'name="r" Version="7"')),
    *(clean(f"version-{name}", _VERSION, _versioned(value)) for name, value in _VERSIONS.items()),
    *(rejected(f"version-{name}", _VERSION, _versioned(value)) for name, value in _NO_VERSIONS.items()),
)

# What a conversion without its argument prints is chance; that it prints something is not, and `%n` writes through
# what happens to lie there.
_CONVERSIONS = {
    "percent": "%",
    "percent-twice": "%%",
    "integer": "%d",
    "hex": "%x",
    "wide": "%1000d",
    "real": "%f",
}
_NO_FORMAT = "an error about anything but a vector, radius, mass or colour is no format"

FORMATS: tuple[EdgeCase, ...] = (
    *(rejected(f"format-{name}", _FORMAT, _origin(f"{value} 0 0")) for name, value in _CONVERSIONS.items()),
    *(degraded(f"visual-format-{key}", _FORMAT, _visual_origin(f"{value} 0 0")) for key, value in _CONVERSIONS.items()),
    rejected("format-store", _FORMAT, _origin("%n 0 0"), "aborts"),
    rejected("format-store-in-visual", _FORMAT, _visual_origin("%n 0 0"), "aborts"),
    rejected("format-store-in-box", _FORMAT, geometry('<box size="%n 0 0"/>'), "aborts"),
    rejected("format-store-in-radius", _FORMAT, _sphere("%n"), "aborts"),
    rejected("format-store-in-mass", _FORMAT, one_link('<inertial><mass value="%n"/></inertial>'), "aborts"),
    rejected("format-store-in-colour", _FORMAT, _coloured("%n 0 0 1"), "aborts"),
    rejected("format-store-in-axis", _NO_FORMAT, one_joint('<axis xyz="%n 0 0"/>', "planar")),
    rejected("format-store-in-limit", _NO_FORMAT, _limit("%n")),
    rejected("format-store-in-type", _NO_FORMAT, one_joint(kind="%n")),
    degraded("format-store-in-scale", _NO_FORMAT, geometry('<mesh filename="a" scale="%n 0 0"/>')),
    degraded("format-store-in-link-name", _NO_FORMAT, robot('<link name="%n"><visual/></link>')),
    clean("format-store-in-names", _NO_FORMAT, robot(links("%n"), 'name="%s%n"')),
    clean("format-store-in-filename", _NO_FORMAT, geometry('<mesh filename="%n%s"/>')),
)

CASES = VECTORS + SCALARS + COLOURS + VERSIONS + FORMATS
