"""Slips that hide much of a robot, and values that are missing, in correct robots of several labs."""

import re
from collections.abc import Iterator
from functools import cache
from typing import NamedTuple

from grader.lab.rubric.rubric import Rubric, load_rubric
from grader.lab.submission.submission import Submission
from tests.samples import opened

_WORKS = (
    ("lab6", "equivalent-xacro-macros"),
    ("lab6", "equivalent-with-collisions-and-inertia"),
    ("arm", "equivalent-xacro-limits"),
    ("sensors", "equivalent-macro-included"),
    ("diffdrive", "equivalent-other-names"),
)
_LIMIT = 2  # slips of one way in one file


class Way(NamedTuple):
    """A kind of slips: where one may be, and what is written there."""

    kind: str
    pattern: str
    new: str


_CONTENT = r"(?s)(<robot[^>]*>)(.*)</robot>"
WAYS = (
    Way("prefix", r'\s+xmlns:xacro="[^"]*"', ""),
    Way("prefix", r"(?s)<robot xmlns:xacro=[^>]*>(.*)</robot>", r"\1"),
    Way("include in a comment", r"<xacro:include [^>]*/>", r"<!-- \g<0> -->"),
    Way("command", r"\$\(find (?=\w)", "$(find-pkg-share "),
    Way("command", r"\$\(arg (\w+)(\w)(\w)\)", r"$(arg \1\3)"),
    Way("parameter", r'params="(\w+) ([\w ]+)"', r'params="\1"'),
    Way("parameter", r'(params="[^"]*\w):=(?=[^"]*")', r"\1:"),
    Way("parameter", r'(params="[^"]*)\*+(?=\w+")', r"\1"),
    Way("name in braces", r'(<xacro:property name=")(\w+)"', r'\1${\2}"'),
    Way("name in braces", r'(<xacro:property name=")(\w+)"', r'\1{\2}"'),
    Way("name of a library", r"(?<=[${ (*/+-])pi\b", "M_PI"),
    Way("name of a library", r"(?<=[${ (*/+-])pi\b", "np.pi"),
    Way("name of a library", r"\bradians\(", "deg2rad("),
    Way("copied call", r'(<xacro:\w+ [^>]*)"right"', r'\1"left"'),
    Way("open comment", r"(<!--[^\n]*?\w) -->(?=.*\n(?s:.*)<!--)", r"\1 --"),
    Way("open comment", r"(<!--[^\n]*?\w) -->(?=.*\n(?s:.*)<!--)", r"\1"),
    Way("nested robot", _CONTENT, r'\1<robot name="inner">\2</robot></robot>'),
    Way("separator", r'(<box size="[-\d.]+) ([-\d.]+) ([-\d.]+)"', r'\1x\2x\3"'),
    Way("separator", r'((?:xyz|rpy)="[^"$]*)-(?=[^"$]*")', r"\1–"),
    Way("element", r'<origin xyz="([^"$]*)" rpy="([^"$]*[1-9][^"$]*)"\s*/>', r'<origin xyz="\1"/><rpy>\2</rpy>'),
    Way("equals", r'(<(?:sphere|cylinder|box|mass|axis|parent|color)[^>=]*)="', r'\1"'),
    Way("missing value", r'(<box size="[^" $]+ [^" $]+) [^" $]+"', r'\1"'),
    Way("missing value", r'(<cylinder[^>]*?) length="[^"]*"', r"\1"),
    Way("missing value", r' ixy="[^"]*"', ""),
    Way("missing value", r"<mass [^>]*/>", ""),
)  # fmt: skip


class WrittenKind(NamedTuple):
    """A correct work with a slip of a kind: its file, and the text with the slip."""

    rubric: Rubric
    work: str
    kind: str
    path: str
    old: str
    text: str

    @property
    def name(self) -> str:
        """Where the slip is."""
        return f"{self.work}, {self.path}: {self.old[:60]!r}"


@cache
def work(rubric: str, name: str) -> Submission:
    """Return a correct work of a lab."""
    return opened(f"submissions/{rubric}/{name}", load_rubric(rubric))


def written_kinds(kind: str) -> Iterator[WrittenKind]:
    """Yield the slips of a kind in all works."""
    for rubric, name in _WORKS:
        files = work(rubric, name).whole_tree.files
        for path in [path for path in files if path.endswith((".urdf", ".xacro"))]:
            text = files[path].read(1 << 20).decode()
            for way in (way for way in WAYS if way.kind == kind):
                for found in [*re.finditer(way.pattern, text)][:_LIMIT]:
                    new = text[: found.start()] + found.expand(way.new) + text[found.end() :]
                    yield WrittenKind(load_rubric(rubric), name, kind, path, found[0], new)
