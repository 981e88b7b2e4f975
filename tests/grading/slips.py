"""Slips of the hand in correct files of six kinds: each changes how one word is written."""

import re
from collections.abc import Callable, Iterator
from typing import NamedTuple

from grader.lab.rubric.rubric import Rubric, load_rubric
from grader.lab.submission.submission import Submission
from tests.samples import LAB6, reference

DIFFDRIVE = load_rubric("diffdrive")
_MIN_LETTERS = 4  # of a word in which two letters are exchanged


class WrittenSlip(NamedTuple):
    """A correct submission with one slip: the file, its text with the slip, and its line."""

    rubric: Rubric
    kind: str
    path: str
    line: int
    old: str
    new: str
    text: str

    @property
    def name(self) -> str:
        """What is written for what, and where."""
        return f"{self.kind}:{self.line} {self.new.strip()}"


def exchanged(word: str) -> str:
    """Return a word with two of its inner letters exchanged."""
    for index in range(1, len(word) - 2):
        if word[index] != word[index + 1] and word[index + 1].isalpha():
            return word[:index] + word[index + 1] + word[index] + word[index + 2 :]
    return word


def without_letter(word: str) -> str:
    """Return a word without its last letter but one."""
    return word[:-2] + word[-1]


_Change = Callable[[re.Match[str]], str]


def _replaced(group: str, new: Callable[[str], str]) -> _Change:
    def change(found: re.Match[str]) -> str:
        start, end = (offset - found.start() for offset in found.span(group))
        return found[0][:start] + new(found[group]) + found[0][end:]

    return change


# Of each kind of file, where a slip may be, and what it writes there.
_XML: tuple[tuple[str, _Change], ...] = (
    (r'(?<=[ ])(?P<name>size|radius|length|xyz|rpy|rgba)(?==")', _replaced("name", exchanged)),
    (
        r'="(?P<list>[-\d.]+ [-\d.]+ [-\d. ]+)"',
        _replaced("list", lambda text: text.replace(" ", ", ")),
    ),
    (
        r'="(?P<list>[-\d.]+ [-\d.]+ [-\d. ]+)"',
        _replaced("list", lambda text: text.replace(" ", ";")),
    ),
    (r'(?:radius|length)="(?P<number>0\.\d+)"', _replaced("number", lambda text: "O" + text[1:])),
    (
        r'(?:radius|length)="(?P<number>0\.\d+)"',
        _replaced("number", lambda text: text.replace(".", ",")),
    ),
    (r"<(?P<tag>cylinder|sphere|origin|axis)(?= )", _replaced("tag", exchanged)),
    (r"<(?P<tag>cylinder|sphere|origin|axis)(?= )", _replaced("tag", str.capitalize)),
    (r"<(?P<tag>parent|child)(?= )", _replaced("tag", exchanged)),
    (r"<(?:parent|child) (?P<name>link)(?==)", _replaced("name", lambda _: "name")),
)
_SETUP: tuple[tuple[str, _Change], ...] = (
    (r"(?<=[\])'e])(?P<end>,)\n", _replaced("end", lambda _: "")),
    (r"(?P<end>\)\),)\n", _replaced("end", lambda _: "),")),
    (r"(?<== )'\w+(?P<quote>')\n", _replaced("quote", lambda _: "")),
    (r"(?m)^(?P<word>import|from)\b", _replaced("word", exchanged)),
    (r"(?<=[ ])(?P<word>import)\b", _replaced("word", exchanged)),
)
_LAUNCH: tuple[tuple[str, _Change], ...] = (
    (r"(?<=[\])'\"])(?P<end>,)\n", _replaced("end", lambda _: "")),
    (r"(?<=\))(?P<end>:)\n", _replaced("end", lambda _: "")),
    (r"(?<=\S)(?P<end>\))\n", _replaced("end", lambda _: "")),
    (
        r"(?P<word>executable|parameters|arguments|condition|package)(?==)",
        _replaced("word", exchanged),
    ),
    (r"(?m)^ *(?P<word>return)\b", _replaced("word", exchanged)),
    (r"(?<=import )(?P<word>[A-Z]\w{4,})\n", _replaced("word", without_letter)),
)
_CMAKE: tuple[tuple[str, _Change], ...] = (
    (
        r"(?m)^(?P<word>project|find_package|install|ament_package)(?=\()",
        _replaced("word", exchanged),
    ),
    (
        r"(?m)^(?P<word>project|find_package|install|ament_package)(?=\()",
        _replaced("word", without_letter),
    ),
    (r"\b(?P<word>DIRECTORY|PROGRAMS|DESTINATION)\b", _replaced("word", exchanged)),
    (r"\((?P<word>diffdrive_robot)\)", _replaced("word", without_letter)),
    (r"(?P<end>\))\n", _replaced("end", lambda _: "")),
)
_YAML: tuple[tuple[str, _Change], ...] = (
    (r"(?P<colon>: )(?=\S)", _replaced("colon", lambda _: ":")),
    (r"(?P<end>\])\n", _replaced("end", lambda _: "")),
    (r"(?<=ros_)(?P<mark>_)", _replaced("mark", lambda _: "")),
)
_XACRO: tuple[tuple[str, _Change], ...] = (
    *_XML,
    (r"<(?P<tag>xacro:(?:wheel|diffdrive_control))(?= )", _replaced("tag", lambda tag: tag[6:])),
    (r"<xacro:wheel side=\"\w+\" (?P<name>y)(?==)", _replaced("name", lambda _: "z")),
    (r"<xacro:wheel (?P<name>side)(?==)", _replaced("name", exchanged)),
    (r"\$\{(?P<name>wheel_radius|wheel_width|caster_radius)\}", _replaced("name", exchanged)),
    (
        r"\b(?P<name>wheel_radius|wheel_width|caster_radius)(?=\" value)",
        _replaced("name", exchanged),
    ),
)
_FILES = (
    (LAB6, "urdf", "urdf/my_robot.urdf", _XML),
    (LAB6, "setup.py", "setup.py", _SETUP),
    (LAB6, "launch", "launch/my_robot_rviz.launch.py", _LAUNCH),
    (LAB6, "rviz", "rviz/my_robot.rviz", _YAML),
    (DIFFDRIVE, "xacro", "urdf/diffdrive.urdf.xacro", _XACRO),
    (DIFFDRIVE, "launch", "launch/diffdrive.launch.py", _LAUNCH),
    (DIFFDRIVE, "CMake", "CMakeLists.txt", _CMAKE),
    (DIFFDRIVE, "YAML", "config/controllers.yaml", _YAML),
)


def solution(rubric: Rubric) -> Submission:
    """Return the correct submission that slips are written into."""
    return reference(rubric)


def written_slips() -> Iterator[WrittenSlip]:
    """Yield every slip in every file."""
    for rubric, kind, end, changes in _FILES:
        submission = solution(rubric)
        files = submission.whole_tree.files
        path = next(path for path in files if path.endswith(end))
        text = files[path].read(1 << 20).decode()
        seen = {text}
        for pattern, change in changes:
            for found in re.finditer(pattern, text):
                start, end_of_match = found.span()
                new = change(found)
                changed = text[:start] + new + text[end_of_match:]
                if changed in seen:
                    continue
                seen.add(changed)
                line = text.count("\n", 0, start) + 1
                yield WrittenSlip(rubric, kind, path, line, found[0], new, changed)


# What ROS 2 ignores without harm: by the element that it is written in.
_IGNORED = {
    "link": (
        '<visuall><geometry><box size="9 9 9"/></geometry></visuall>',
        "<inertal/>",
        "<colision/>",
    ),
    "visual": ('<orgin xyz="0 0 0.3"/>', '<materal name="green"/>', '<origin_ xyz="1 1 1"/>'),
    "joint": (
        '<mimick joint="base_joint"/>',
        '<limitt lower="0" upper="0" effort="0" velocity="0"/>',
        '<axiss xyz="1 0 0"/>',
        '<orign xyz="5 5 5"/>',
        '<dynamcs damping="x"/>',
    ),
    "geometry": ("<sphre/>", '<boxx size="1 1 1"/>'),
    "robot": ('<materal name="gray"/>', '<lnk name="other"/>', '<jiont name="other"/>'),
}
_UNUSED_ATTRIBUTES = (
    'raduis="7"',
    'rgbaa="1 1 1 1"',
    'linkk="lidar"',
    'rpyy="0 0 3"',
    'ryp="1 1 1"',
    'sise="3 3 3"',
    'lenght="4"',
    'nmae="x"',
)


def with_something_ignored(text: str) -> Iterator[str]:
    """Yield a URDF with one element or attribute each that ROS 2 ignores."""
    for tag, elements in _IGNORED.items():
        for found in re.finditer(rf"</{tag}>", text):
            for element in elements:
                yield text[: found.start()] + element + text[found.start() :]
    for found in re.finditer(r'(?<=")(?=/>)', text):
        for attribute in _UNUSED_ATTRIBUTES:
            yield f"{text[: found.start()]} {attribute}{text[found.start() :]}"
