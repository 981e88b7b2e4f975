"""Compare the reader with rosidl's own: `python -m tests.interfaces.compare_rosidl CHECKOUT [COUNT]`.

CHECKOUT is one of github.com/ros2/rosidl (branch jazzy), whose rosidl_adapter/parser.py is imported. COUNT random files
are made of words that are right, and of some that are not.
"""

import importlib.util
import sys
from collections.abc import Iterator
from contextlib import redirect_stderr
from io import StringIO
from pathlib import Path
from random import Random
from typing import Any

from grader.ros.interfaces.interface_file import read_interface
from grader.ros.interfaces.interface_types import SECTIONS, InterfaceKind
from tests.interfaces.make_known import text_of_type

_SEED, _COUNT = 1, 50_000
_TYPES = (
    *("bool", "byte", "char", "float32", "float64", "int8", "uint8", "int16", "uint64", "string"),
    *(
        "wstring",
        "duration",
        "time",
        "string<=5",
        "wstring<=3",
        "string<=0",
        "string<=a",
        "float65",
    ),
    *("Header", "std_msgs/Header", "std_msgs/msg/Header", "Foo_Request", "Sample_X", "a__b/C"),
    *("pkg_/C", "int", "1a", "Pose2D", "", "geometry_msgs/pose", "x/Y", "int32<=3"),
)
_ENDS = (
    *("", "", "", "", "[]", "[3]", "[<=3]", "[0]", "[a]", "[<=0]", "[-1]", "]", "[ 2]", "[<=]"),
    *("[1_0]", "[2][3]"),
)
_NAMES = (
    *("x", "abc", "aB", "a_b", "a__b", "a_", "_a", "X", "MAX", "MAX_A", "MAX__A", "M_", "1x", "x1"),
    *("A1_2", "MAXa", "x:", "é", "x;"),
)
_VALUES = (
    *("", "1", "-1", "255", "256", "0x10", "1.5", "1e3", "true", "False", '"a"', "'b'", '"a" b"'),
    *("[1, 2, 3]", "[1,2]", "[]", '["a", "b"]', "['a,b', c, d]", "[a b, c]", '"', "[true]", "abc"),
    *('"abcdef"', "[1,]", "[ , ]", "nan", "1_000", "[1, 2", "= 3", '"a=b"', '["a\\"b", "c"]'),
    *('[" x", ]', "'a'b'", '""', "[,1]"),
)
_ODD = ("", "# x", "  # y", "#", "   ", "---", "--- ", "----", " ---", "\ufeff", "--")
_FILES = ("Foo", "Foo", "Foo", "Foo", "foo", "Foo_Request", "Sample_Foo", "F_o", "F1")
Sections = list[tuple[dict[str, str], set[str]]]


def line(random: Random) -> str:
    """Return a line of a file."""
    if random.random() < 0.12:
        return random.choice(_ODD)
    kind = random.choice(_TYPES) + random.choice(_ENDS)
    text = kind + random.choice((" ", "  ", "\t", "   ")) + random.choice(_NAMES)
    choice = random.random()
    if choice < 0.25:
        text += random.choice(("=", " = ", "= ", " =")) + random.choice(_VALUES)
    elif choice < 0.55:
        text += random.choice((" ", "  ", "\t")) + random.choice(_VALUES)
    elif choice < 0.6:
        text = f" {text}"
    elif choice < 0.65:
        text = kind
    return text + random.choice(("", "", "# c", " # c", "#"))


def files(count: int) -> Iterator[tuple[InterfaceKind, str, str]]:
    """Yield the kinds, names and texts of random files."""
    random = Random(_SEED)
    for _ in range(count):
        kind = random.choice([*SECTIONS])
        parts = [
            "\n".join(line(random) for _ in range(random.choice((0, 1, 1, 2))))
            for _ in SECTIONS[kind]
        ]
        yield kind, random.choice(_FILES), "\n---\n".join(parts)


def read_by_rosidl(parser: Any, kind: InterfaceKind, name: str, text: str) -> Sections | None:
    """Return the fields and constants of each section; None if rosidl refuses the text."""
    try:
        with redirect_stderr(StringIO()):
            match kind:
                case "msg":
                    found = [parser.parse_message_string("hub", name, text)]
                case "srv":
                    service = parser.parse_service_string("hub", name, text)
                    found = [service.request, service.response]
                case "action":
                    action = parser.parse_action_string("hub", name, text)
                    found = [action.goal, action.result, action.feedback]
    except Exception:  # noqa: BLE001  rosidl raises errors of many classes
        return None
    return [
        ({it.name: str(it.type) for it in one.fields}, {it.name for it in one.constants})
        for one in found
    ]


def read_by_us(kind: InterfaceKind, name: str, text: str) -> Sections | None:
    """Return the same by our reader."""
    found = read_interface(text.encode(), f"hub/{kind}/{name}.{kind}", "hub")
    if found.faults:
        return None
    sections: Sections = []
    for section in found.sections:
        types = {field.name: text_of_type(field.type) for field in section.fields.values()}
        sections.append((types, {*section.constants}))
    return sections


def main(checkout: str, count: int) -> None:
    """Print what differs."""
    path = Path(checkout) / "rosidl_adapter" / "rosidl_adapter" / "parser.py"
    spec = importlib.util.spec_from_file_location("rosidl_parser", path)
    assert spec is not None and spec.loader is not None
    parser = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(parser)
    accepted = different = 0
    for kind, name, text in files(count):
        expected, found = read_by_rosidl(parser, kind, name, text), read_by_us(kind, name, text)
        accepted += expected is not None
        if expected != found:
            different += 1
            print(f"{name}.{kind} {text!r}: {expected} by rosidl, {found} by us")
    print(f"{count} files, {accepted} accepted, {different} different")


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else _COUNT)
