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
    "plus-leading-point": "+.5",
    "minus-trailing-point": "-1.",
    "exponent": "1e3",
    "exponent-upper": "1E3",
    "exponent-plus": "1e+3",
    "exponent-minus": "1e-3",
    "exponent-zeros": "1e003",
    "point-exponent": "1.e3",
    "leading-point-exponent": ".5e1",
    "leading-zeros": "007",
    "zeros": "00.00",
    "underflow": "1e-400",
    "far-underflow": "1e-99999",
    "denormal": "4.9e-324",
    "largest": "1.7976931348623157e308",
    "zero-with-huge-exponent": "0e400",
    "many-digits": "3.14159265358979323846264338327950288419716939937510",
    "forty-digits": "1" * 40,
    "many-zeros": "0." + "0" * 400 + "1",
}
_REFUSED = {
    "nan": "nan",
    "nan-upper": "NaN",
    "inf": "inf",
    "infinity": "Infinity",
    "minus-inf": "-inf",
    "hex": "0x10",
    "hex-float": "0x1p3",
    "overflow": "1e400",
    "minus-overflow": "-1e400",
    "rounds-to-overflow": "1.8e308",
    "four-hundred-digits": "1" * 400,
    "exponent-missing": "1e",
    "exponent-only-sign": "1e+",
    "exponent-with-point": "1e2.5",
    "exponent-twice": "1e2e3",
    "exponent-alone": "e5",
    "float-suffix": "1.0f",
    "long-suffix": "1L",
    "fortran-exponent": "1d3",
    "underscore": "1_000",
    "comma": "1,5",
    "trailing-comma": "1,",
    "trailing-semicolon": "1;",
    "apostrophe": "1'000",
    "two-points": "1..5",
    "version-like": "1.2.3",
    "point-alone": ".",
    "sign-alone": "-",
    "plus-alone": "+",
    "two-signs": "--1",
    "plus-minus": "+-1",
    "sign-after": "1-",
    "bracket": "[1",
    "letter": "x",
    "degrees": "90deg",
    "degree-sign": "90°",
    "fraction": "1/2",
    "sum": "1+1",
    "percent": "50%",
    "pi": "pi",
    "xacro-constant": "${pi}",
    "xacro-argument": "$(arg)",
    "quoted": "'1'",
    "true": "true",
    "none": "None",
    "unicode-minus": "\u22121",
    "en-dash": "\u20131",
    "full-width-digit": "\uff11",
    "arabic-digit": "\u0661",
    "superscript": "1\u00b2",
    "half": "\u00bd",
    "no-break-space-after": "1\u00a0",
    "no-break-space-in-front": "\u00a01",
    "zero-width-space-after": "1\u200b",
    "mark-in-front": "\ufeff1",
    "control-after": "1\x01",
}

# Whole vectors.
_WHOLE = {
    "one-space": "1 2 3",
    "two-spaces": "1  2  3",
    "leading-space": " 1 2 3",
    "trailing-space": "1 2 3 ",
    "spaces-about": "   1   2   3   ",
    "leading-tab": "\t1 2 3",
    "leading-newline": "\n1 2 3",
    "leading-crlf": "\r\n1 2 3",
    "leading-form-feed": "\v\f1 2 3",
    "space-tab": "1 \t2 3",
    "space-newline": "1 \n2 3",
    "space-newline-tabs": "1 2 \n\t\t\t3",
    "space-then-several": "1 \n\n\t2 3",
}
_BROKEN = {
    "empty": "",
    "blank": " ",
    "tab-only": "\t",
    "one-piece": "1",
    "two-pieces": "1 2",
    "four-pieces": "1 2 3 4",
    "six-pieces": "1 2 3 4 5 6",
    "tab": "1\t2\t3",
    "one-tab": "1\t2 3",
    "tab-space": "1\t 2 3",
    "newline": "1\n2\n3",
    "newline-space": "1\n 2 3",
    "space-newline-space": "1 \n 2 3",
    "crlf": "1 2\r\n3",
    "carriage-return": "1 2\r3",
    "trailing-tab": "1 2 3\t",
    "trailing-newline": "1 2 3\n",
    "trailing-space-newline": "1 2 3 \n",
    "vertical-tab": "1\v2 3",
    "form-feed": "1\f2 3",
    "no-break-spaces": "1\u00a02\u00a03",
    "thin-spaces": "1\u20092\u20093",
    "ideographic-spaces": "1\u30002\u30003",
    "commas": "1,2,3",
    "commas-and-spaces": "1, 2, 3",
    "commas-after-spaces": "1 ,2 ,3",
    "commas-apart": "1 , 2 , 3",
    "semicolons": "1; 2; 3",
    "brackets": "[1 2 3]",
    "parentheses": "(1 2 3)",
    "braces": "{1 2 3}",
    "xacro": "${x} ${y} ${z}",
    "xacro-product": "0 0 ${h / 2}",
    "smart-quote": "1 2 3\u201d",
    "last-not-a-number": "1 2 x",
    "middle-not-a-number": "1 x 3",
    "extra-not-a-number": "1 2 3 x",
}

# Whole scalars.
_SCALARS = {"leading-space": " 1", "leading-spaces": "   1", "leading-tab": "\t1", "leading-newline": "\r\n1"}
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
    "just-one": "1.0000 1e0 +1 1",
    "underflow": "1e-400 0 0 1",
    "three-numbers": "1 0 0",
    "five-numbers": "1 0 0 1 1",
    "one-number": "1",
    "empty": "",
    "blank": "  ",
}
_NO_COLOURS = {
    "byte": "255 0 0 255",
    "alpha-byte": "1 0 0 255",
    "just-above": "1.0000001 0 0 1",
    "negative": "-0.1 0 0 1",
    "tiny-negative": "-1e-300 0 0 1",
    "nan": "nan 0 0 1",
    "overflow": "1e400 0 0 1",
    "hex": "#ff0000",
    "word": "red",
    "commas": "1, 0, 0, 1",
    "tabs": "1\t0\t0\t1",
    "trailing-newline": "1 0 0 1\n",
    "byte-in-three-numbers": "255 0 0",
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
    "tab-after-point": "1.\t0",
    "leading-zeros": "01.00",
    "plus": "+1.0",
    "plus-both": "+1.+0",
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
    "point-in-front": ".1.0",
    "two-trailing-points": "1.0..",
    "three-fields": "1.0.0",
    "one-one": "1.1",
    "two-zero": "2.0",
    "zero-one": "0.1",
    "negative": "-1.0",
    "negative-minor": "1.-1",
    "trailing-space": "1.0 ",
    "trailing-newline": "1.0\n",
    "space-before-point": "1 .0",
    "comma": "1,0",
    "letter": "v1.0",
    "letters": "one.zero",
    "suffix": "1.0a",
    "hex": "0x1.0",
    "exponent": "1e0.0",
    "full-width": "\uff11.0",
    "no-break-space": "\u00a01.0",
    "huge-major": "99999999999999999999.0",
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
    "letter": "%c",
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
