"""Spell a plain URDF as students do: with xacro properties, macros and included files. The robot stays the same."""

import re
from collections.abc import Callable, Mapping
from copy import deepcopy
from typing import Any

from lxml import etree

XACRO = "http://www.ros.org/wiki/xacro"
MAIN = ""  # the key of the file that is graded
Files = dict[str, str]  # texts by their names beside the main file

_PROPERTIES = {"length": "0.6", "width": "0.4", "radius": "0.1", "thickness": "0.05"}
_ARITHMETIC = {
    "0.6": "${length}",
    "0.4": "${width}",
    "0.2": "${width/2}",
    "-0.2": "${-width/2}",
    "0.1": "${radius}",
    "0.05": "${thickness}",
    "-0.05": "${-thickness}",
    "0.025": "${thickness/2}",
    "-0.025": "${-(thickness / 2)}",
    "0.15": "${length/4}",
    "-0.15": "${-1*length/4}",
    "0.225": "${2*radius + thickness/2}",
    "1.57": "${pi/2}",
    "-1.57": "${-pi/2}",
}
_NUMERIC = ("xyz", "rpy", "size", "radius", "length")

_INERTIAL_MACROS = """
<xacro:macro name="inertial_box" params="mass x y z *origin">
  <inertial>
    <xacro:insert_block name="origin"/>
    <mass value="${mass}"/>
    <inertia ixx="${(1/12) * mass * (y*y+z*z)}" ixy="0.0" ixz="0.0" iyy="${(1/12) * mass * (x*x+z*z)}" iyz="0.0"
             izz="${(1/12) * mass * (x*x+y*y)}"/>
  </inertial>
</xacro:macro>
<xacro:macro name="inertial_sphere" params="mass radius *origin">
  <inertial>
    <xacro:insert_block name="origin"/>
    <mass value="${mass}"/>
    <inertia ixx="${(2/5) * mass * (radius*radius)}" ixy="0.0" ixz="0.0" iyy="${(2/5) * mass * (radius*radius)}" iyz="0.0"
             izz="${(2/5) * mass * (radius*radius)}"/>
  </inertial>
</xacro:macro>
"""
_WHEEL_MACRO = """
<xacro:macro name="wheel" params="side xyz rpy axis offset:='0 0 0' turn:='0 0 0' type:=continuous colour:=gray">
  <link name="${side}_wheel">
    <visual>
      <origin xyz="${offset}" rpy="${turn}"/>
      <geometry><cylinder radius="%s" length="%s"/></geometry>
      <material name="${colour}"/>
    </visual>
  </link>
  <joint name="base_${side}_wheel_joint" type="${type}">
    <parent link="base_link"/>
    <child link="${side}_wheel"/>
    <origin xyz="${xyz}" rpy="${rpy}"/>
    <axis xyz="${axis}"/>
  </joint>
</xacro:macro>
"""


def plain(text: str) -> Files:
    """Return the text as it is."""
    return {MAIN: text}


def numbers(text: str) -> Files:
    """Return it with properties and arithmetic, also on pi."""
    root = _with_arithmetic(_parsed(text))
    return {MAIN: _written(root)}


def inertial(text: str) -> Files:
    """Return it with inertial macros, which it defines itself and calls in every visible link."""
    root = _with_inertials(_with_arithmetic(_parsed(text)))
    _insert(root, _INERTIAL_MACROS)
    return {MAIN: _written(root)}


def wheel(text: str) -> Files:
    """Return it with a macro for the wheels, of which both must have the same shape."""
    root = _parsed(text)
    shapes = set()
    for side in ("left", "right"):
        (link,) = root.xpath(f"link[@name='{side}_wheel']")
        (joint,) = root.xpath(f"joint[child/@link='{side}_wheel']")
        call = etree.Element(f"{{{XACRO}}}wheel", side=side, type=joint.get("type"))
        for element, xyz, rpy in ((joint, "xyz", "rpy"), (link[0], "offset", "turn")):
            for origin in element.findall("origin"):
                call.set(xyz, origin.get("xyz", "0 0 0"))
                call.set(rpy, origin.get("rpy", "0 0 0"))
        call.set("axis", joint.find("axis").get("xyz"))
        call.set("colour", link.find("visual/material").get("name"))
        cylinder = link.find("visual/geometry/cylinder")
        shapes.add((cylinder.get("radius"), cylinder.get("length")))
        root.replace(link, call)
        root.remove(joint)
    (shape,) = shapes
    _insert(root, _WHEEL_MACRO % shape)
    return {MAIN: _written(root)}


def including(text: str, where: str = "") -> Files:
    """Return it with inertial macros in a second file, which it includes from `where`."""
    root = _with_inertials(_parsed(text))
    _insert(root, f'<xacro:include filename="{where}inertial_macros.xacro"/>')
    return {MAIN: _written(root), "inertial_macros.xacro": _library(_INERTIAL_MACROS)}


def finding(text: str) -> Files:
    """Return it with inertial macros from $(find my_robot)."""
    return including(text, "$(find my_robot)/urdf/")


def elsewhere(text: str) -> Files:
    """Return it with inertial macros from a package of the course that was not submitted."""
    return {MAIN: including(text, "$(find course_macros)/urdf/")[MAIN]}


def unsubmitted(text: str) -> Files:
    """Return it with inertial macros from a file beside it that was not submitted."""
    return {MAIN: including(text)[MAIN]}


def parts(text: str) -> Files:
    """Return a file that only includes others: colours and base, lidar, wheels."""
    return _split(text, "robot_core.xacro", "a_lidar.xacro", "drive.xacro")


def named_parts(text: str) -> Files:
    """Return the same, with one part whose name begins like that of the robot."""
    return _split(text, "my_robot_core.xacro", "my_robot_lidar.xacro", "my_robot_wheels.xacro")


def generated(text: str) -> Files:
    """Return a plain URDF with the xacro beside it from which it was generated."""
    return {
        MAIN: f"<!-- autogenerated by xacro from my_robot.urdf.xacro -->\n{_body(text)}",
        **_beside(inertial(text)),
    }


def in_other_words(text: str) -> Files:
    """Return it with single quotes, CRLF, tabs, and a declaration after spaces around the equals signs."""
    return {MAIN: text.replace('="', ' = "').replace("  ", "\t").replace("\n", "\r\n")}


SPELLINGS: Mapping[str, Callable[[str], Files]] = {
    function.__name__: function
    for function in (
        plain,
        numbers,
        inertial,
        wheel,
        including,
        finding,
        elsewhere,
        unsubmitted,
        parts,
        named_parts,
        generated,
        in_other_words,
    )
}


def _parsed(text: str) -> Any:
    source = etree.fromstring(text.encode(), etree.XMLParser(remove_comments=True))
    root = etree.Element("robot", dict(source.attrib), nsmap={"xacro": XACRO})
    root.text = "\n  "
    root.extend(source)
    return root


def _written(root: Any) -> str:
    return f'<?xml version="1.0"?>\n{etree.tostring(root, encoding="unicode")}\n'


def _body(text: str) -> str:
    return re.sub(r"^\s*<\?xml[^>]*>\s*", "", text)


def _insert(root: Any, content: str) -> None:
    """Put content at the beginning of a robot."""
    for position, element in enumerate(etree.fromstring(_library(content).encode())):
        root.insert(position, element)


def _library(content: str) -> str:
    return f'<robot xmlns:xacro="{XACRO}">{content}</robot>\n'


def _with_arithmetic(root: Any) -> Any:
    for element in root.iter("*"):
        for attribute in _NUMERIC:
            if (value := element.get(attribute)) is not None:
                element.set(
                    attribute, " ".join(_ARITHMETIC.get(number, number) for number in value.split())
                )
    _insert(
        root,
        "".join(
            f'<xacro:property name="{name}" value="{value}"/>'
            for name, value in _PROPERTIES.items()
        ),
    )
    return root


def _with_inertials(root: Any) -> Any:
    for link in root.findall("link"):
        if link.find("visual") is None:
            continue
        is_round = link.find("visual/geometry/sphere") is not None
        call = etree.SubElement(
            link, f"{{{XACRO}}}inertial_{'sphere' if is_round else 'box'}", mass="0.5"
        )
        for name, value in (
            {"radius": "0.05"}.items()
            if is_round
            else zip("xyz", ("0.6", "0.4", "0.2"), strict=True)
        ):
            call.set(name, value)
        etree.SubElement(call, "origin", xyz="0 0 0", rpy="0 0 0")
    return root


def _split(text: str, *names: str) -> Files:
    core, lidar, drive = names
    root = _parsed(text)
    found: dict[str, list[Any]] = {name: [] for name in names}
    for element in root:
        about = " ".join(
            [
                element.get("name", ""),
                *(child.get("link", "") for child in element.findall("child")),
            ]
        )
        is_part = element.tag != "material"
        found[
            lidar
            if is_part and "lidar" in about
            else drive
            if is_part and "wheel" in about
            else core
        ].append(element)
    files = {MAIN: _main_of(root, names)}
    for name, elements in found.items():
        part = etree.Element("robot", nsmap={"xacro": XACRO})
        part.extend(deepcopy(elements))
        files[name] = _written(part)
    return files


def _main_of(root: Any, names: tuple[str, ...]) -> str:
    main = etree.Element("robot", dict(root.attrib), nsmap={"xacro": XACRO})
    for name in names:
        etree.SubElement(main, f"{{{XACRO}}}include", filename=name)
    return _written(main)


def _beside(files: Files) -> Files:
    return {"my_robot.urdf.xacro" if name == MAIN else name: text for name, text in files.items()}
