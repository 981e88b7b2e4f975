"""Slips in the form of a robot's markup and expressions, by kind, in the reference robots of all rubrics."""

import re
from collections.abc import Iterator
from functools import cache
from typing import NamedTuple

from grader.lab.rubric.rubric import Rubric
from tests.samples import RUBRICS, reference

_NUMBERS = r"[-\d.]+(?: [-\d.]+)*"


class Form(NamedTuple):
    """A kind of slips: where one may be, and the ways to write it there."""

    kind: str
    pattern: str
    ways: tuple[str, ...]


_ROBOT = r"(?s)<robot( .*)</robot>"
_EMPTY = r"<{tag} {name}=\"([^\"]*)\"\s*/>"


def _main(tag: str, name: str) -> Form:
    ways = (rf"<{tag}>\1</{tag}>", rf"<{tag}><{name}>\1</{name}></{tag}>")
    return Form("text and children", _EMPTY.format(tag=tag, name=name), ways)


FORMS = (
    Form("root", _ROBOT, (r"<Robot\1</Robot>", r"<ROBOT\1</ROBOT>", r"<robott\1</robott>", r"<Robot\1</robot>", r"<robot\1</Robot>")),
    _main("parent", "link"),
    _main("child", "link"),
    _main("axis", "xyz"),
    _main("box", "size"),
    _main("sphere", "radius"),
    _main("color", "rgba"),
    _main("mass", "value"),
    Form("text and children", r"<(parent|child) link=(\"[^\"]*\")/>", (r"<\1><link name=\2/></\1>",)),
    Form("text and children", r"<origin xyz=\"([^\"]*)\" rpy=\"([^\"]*)\"/>", (r"<origin>\1 \2</origin>", r"<origin><xyz>\1</xyz><rpy>\2</rpy></origin>")),
    Form("text and children", r"<cylinder radius=\"([^\"]*)\" length=\"([^\"]*)\"/>", (r"<cylinder><radius>\1</radius><length>\2</length></cylinder>",)),
    Form("text and children", r"<limit lower=\"([^\"]*)\"", (r'<limit lower=" \1"',)),
    Form("text and children", r"<link name=\"([^\"]*)\">", (r"<link><name>\1</name>",)),
    Form("text and children", r"<joint name=\"([^\"]*)\" type=\"([^\"]*)\">", (r'<joint name="\1"><type>\2</type>', r'<joint type="\2"><name>\1</name>')),
    Form("quotes", rf"=\"({_NUMBERS})\" (\w+)=\"", (r'="\1 \2="', r'="\1\2="', "=\"\\1' \\2=\"", r'=\1" \2="')),
    Form("quotes", r"name=\"(\w+)\" type=\"", (r'name="\1 type="', r'name=\1" type="')),
    Form("quotes", rf"=\"({_NUMBERS})\"/>", (r'="\1/>', r'=\1"/>', r"=\1/>")),
    Form("quotes", r"(link|name|type)=\"([\w${}]+)\"(?=/?>)", (r'\1="\2', r'\1=\2"', "\\1='\\2\"", r"\1=\2")),
    Form("quotes", rf"(?<!version)=\"({_NUMBERS})\"", ("='\\1\"", "=\"\\1'")),
    Form("equals", r"(?<=[ ])(xyz|rpy|link|size|radius|name|value)=\"(?=[^\"$]*\")", (r'\1 "', r'\1=="', r'\1:"', r'\1: "', r'\1 = = "')),
    Form("tags without <", r"<(?=(?:origin|axis|parent|child|sphere|box|cylinder|mass|color) )", ("",)),
    Form("tags without <", r"<(?=/?(?:link|joint|visual|collision|geometry|inertial)[ >])", ("",)),
    Form("tags without >", r"(?<=/)>|(?<=\")>", ("",)),
    Form("text and children", r"<(parent|child) (link=\"[^\"]*\")/>", (r"<\1>\2</\1>",)),
    Form("end tags", r"</(?:link|joint|visual|collision|geometry|inertial|material)>", ("",)),
    Form("nesting", r"<parent link=(\"[^\"]*\")/>\s*<child link=(\"[^\"]*\")/>", (r"<parent link=\1><child link=\2/></parent>", r"<child link=\2><parent link=\1/></child>")),
    Form("nesting", r"<(parent|child)( [^>]*)/>(\s*)(<origin [^>]*>)", (r"<\1\2>\4</\1>",)),
    Form("nesting", r"(?s)(<visual>.*?)</visual>(\s*)(<collision>.*?</collision>)", (r"\1\3\2</visual>",)),
    Form("nesting", r"(?s)(<link name=\"[^\"]*\")/>", (r"\1>",)),
    Form("nesting", r"(?s)(<link name=\"[^\"]*\")/>(\s*)(<joint .*?</joint>)", (r"\1>\2\3\2</link>",)),
    Form("nesting", r"(?s)</link>(\s*)(<joint .*?</joint>)", (r"\1\2\1</link>",)),
    Form("nesting", r"</joint>\n(?=\s*<(?:link|joint))", ("</joint>\n</robot>\n",)),
    Form("nesting", r"(?s)(<child link=\"[^\"]*\")/>([^<]*(?:<origin[^>]*>[^<]*)?(?:<!--[^<]*-->\s*)?)(<axis [^>]*>)", (r"\1>\3</child>\2",)),
    Form("nesting", r"<parent link=(\"[^\"]*\")/>\s*<child link=(\"[^\"]*\")/>", (r"<parent link=\1 child=\2/>", r"<child link=\2 parent=\1/>", r"<links parent=\1 child=\2/>")),
    Form("nesting", r"(<joint name=\"[^\"]*\" type=\"\w+\")>\s*<parent link=(\"[^\"]*\")/>\s*<child link=(\"[^\"]*\")/>", (r"\1 parent=\2 child=\3>",)),
    Form("nesting", r"(<origin [^>]*>)(\s*<geometry>)", (r"\2\1",)),
    Form("nesting", r"<geometry>(\s*<[^>]*/>\s*)</geometry>", (r"\1",)),
    Form("shapes", r"<box (?=size=\"[^\"]*\"/>)", ("<cube ", "<cuboid ", "<Cube ")),
    Form("shapes", r"<sphere (?=radius=\"[^\"]*\"/>)", ("<ball ", "<Sphere ")),
    Form("inertial", rf"<mass value=\"({_NUMBERS})\"/>", (r'<mass value="\1 kg"/>', r'<mass value="\1kg"/>', r'<mass mass="\1"/>')),
    Form("inertial", r"(?<=\s)i(?P<rest>xx|yy|zz|xy|xz|yz)=", (r"l\1=",)),
    Form("copied names", r"base_right_wheel_joint", ("base_left_wheel_joint",)),
    Form("end tags of macros", r"</xacro:macro>", ("</macro>", "</xacro>", "", "</xacro:marco>", "</Xacro:macro>", "<xacro:macro/>")),
    Form("end tags of macros", r"</xacro:(if|unless)>", (r"</\1>", "</xacro>")),
    Form("attributes of xacro", r"(<xacro:macro name=\"\w+\" )params=", (r"\1param=", r"\1parameters=", r"\1args=")),
    Form("attributes of xacro", r"(<xacro:property name=\"\w+\" )value=", (r"\1val=", r"\1vaule=", r"\1wert=")),
    Form("attributes of xacro", r"<xacro:(property|macro|arg) name=", (r"<xacro:\1 nam=", r"<xacro:\1 id=")),
    Form("attributes of xacro", r"<xacro:include filename=", ("<xacro:include file=", "<xacro:include path=", "<xacro:include filname=")),
    Form("attributes of xacro", r"(<xacro:arg name=\"\w+\" )default=", (r"\1value=", r"\1defualt=")),
    Form("attributes of xacro", r"<xacro:(if|unless) value=", (r"<xacro:\1 condition=", r"<xacro:\1 val=")),
    Form("expressions", r"\$\{([^{}\"]*)\}", (r"${\1", r"$[\1]", r"${\1)")),
    Form("expressions", r"\$\{([^{}\"]*[-+*/][^{}\"]*)\}", (r"$(\1)",)),
    Form("expressions", r"\$\{([^{}\"]*)\}", (r"{\1}", r"$ {\1}", r"${{\1}}", r"${\1}}")),
    Form("text of xacro", r"(<xacro:(property|arg) name=\"\w+\") (?:value|default)=\"([^\"]*)\"/>", (r"\1>\3</xacro:\2>",)),
    Form("expressions", r"(?<=(?:[ ]y|zz)=\")\$\{([^{}\"-][^{}\"]*/[^{}\"]*)\}", (r"\1", r"$\1", r"$(\1}")),
    Form("calls of macros", r"(<xacro:wheel [^>]*)/>", (r"\1>",)),
    Form("calls of macros", r"<xacro:wheel side=\"(\w+)\" y=(\"[^\"]*\")/>", (r"<xacro:wheel y=\2><side>\1</side></xacro:wheel>",)),
    Form("text of xacro", r"<xacro:include filename=\"([^\"]*)\"/>", (r"<xacro:include>\1</xacro:include>",)),
    Form("expressions", r"(?<=\w) \* (?=\w)", (" x ", " × ")),
    Form("arguments of macros", r"(<xacro:wheel [^>]*) (?:y|side)=(\"[^\"]*\")", (r"\1 \2", r"\1 =\2")),
    Form("arguments of macros", r"<xacro:wheel (?:side)=(\"[^\"]*\")", (r"<xacro:wheel \1",)),
    Form("arguments of macros", r"(<xacro:wheel [^>]*)\bside=", (r"\1sidé=",)),
    Form("words of SDFormat", r"(?s)<(sensor|lidar|camera|topic|range|image|samples|update_rate)([ >].*?)</\1>", (r"<\g<1>_\2</\g<1>_>",)),
)  # fmt: skip
_CASED = ("sensor", "lidar", "camera", "topic", "range", "image", "samples", "update_rate", "scan")
_LIMIT = 4  # slips of one way in one file


class FormSlip(NamedTuple):
    """A correct submission with a slip: the file, and its text with the slip."""

    rubric: Rubric
    kind: str
    path: str
    old: str
    new: str
    text: str

    @property
    def name(self) -> str:
        """What is written for what."""
        return f"{self.path}: {self.old[:60]!r} -> {self.new[:60]!r}"


@cache
def form_slips() -> tuple[FormSlip, ...]:
    """Return slips of every kind in the robots of all rubrics."""
    return tuple(_form_slips())


def _form_slips() -> Iterator[FormSlip]:
    for rubric in RUBRICS.values():
        files = reference(rubric).whole_tree.files
        for path in files:
            if not path.endswith((".urdf", ".xacro")):
                continue
            text = files[path].read(1 << 20).decode()
            seen = {text}
            for kind, pattern, way in _ways(text):
                matches = [*re.finditer(pattern, text)]
                step = max(1, len(matches) // _LIMIT)
                for match in matches[::step]:
                    new = match.expand(way)
                    changed = text[: match.start()] + new + text[match.end() :]
                    if changed not in seen:
                        seen.add(changed)
                        yield FormSlip(rubric, kind, path, match[0], new, changed)


def _ways(text: str) -> Iterator[tuple[str, str, str]]:
    for form in FORMS[:-1]:
        for way in form.ways:
            yield form.kind, form.pattern, way
    if "<gazebo" in text:
        for word in _CASED:
            pattern = rf"(?s)<{word}([ >].*?)</{word}>"
            for new in sorted({word.capitalize(), word.upper(), word.replace("_", "")} - {word}):
                yield "words of SDFormat", pattern, rf"<{new}\1</{new}>"
