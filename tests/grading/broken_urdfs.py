"""Files that ROS 2 rejects, or drops content of, as students write them: the reference with one text replaced by another."""

from typing import NamedTuple

from tests.samples import LAB6, ROOT

REFERENCE = (ROOT / "rubrics" / LAB6.id / "my_robot" / "urdf" / "my_robot.urdf").read_text(encoding="utf-8")


class Broken(NamedTuple):
    """A mistake: what stands in the reference, and what stands in the file. `is_everywhere`: wherever it stands."""

    name: str
    right: str
    wrong: str
    is_everywhere: bool = False

    @property
    def text(self) -> str:
        """Return the broken file."""
        assert self.right in REFERENCE, self.name
        return REFERENCE.replace(self.right, self.wrong, -1 if self.is_everywhere else 1)


_CHILD = '<child link="lidar"/>'
_LIDAR = '<link name="lidar">'
_JOINT = '<joint name="base_lidar_joint" type="fixed">'
_ORIGIN = 'xyz="0.15 0 0.225"'
_AXIS = '<axis xyz="0 0 1"/>'
_LAST = "the radius of the wheels -->"

TAGS = (
    Broken("quote-not-closed", f"{_ORIGIN} rpy", 'xyz="0.15 0 0.225 rpy'),
    Broken("quote-not-closed-at-the-end", _CHILD, '<child link="lidar/>'),
    Broken("quote-not-opened", _CHILD, '<child link=lidar"/>'),
    Broken("no-quotes", _CHILD, "<child link=lidar/>"),
    Broken("no-quotes-around-numbers", _ORIGIN, "xyz=0.15 0 0.225"),
    Broken("typographic-quotes", 'name="lidar"', "name=\u201clidar\u201d"),
    Broken("german-quotes", 'name="lidar"', "name=\u201elidar\u201c"),
    Broken("two-kinds-of-quotes", 'name="lidar"', "name='lidar\""),
    Broken("no-equals-sign", _CHILD, '<child link "lidar"/>'),
    Broken("two-equals-signs", _CHILD, '<child link=="lidar"/>'),
    Broken("colon-for-equals-sign", _CHILD, '<child link:"lidar"/>'),
    Broken("no-attribute-name", _CHILD, '<child="lidar"/>'),
    Broken("no-attribute-name-of-a-box", '<box size="0.6 0.4 0.2"/>', '<box="0.6 0.4 0.2"/>'),
    Broken("no-attribute", _CHILD, "<child lidar/>"),
    Broken("tag-glued-to-its-attribute", _LIDAR, '<linkname="lidar">'),
    Broken("no-end-of-an-empty-tag", _CHILD, '<child link="lidar"'),
    Broken("no-end-of-a-tag", _LIDAR, '<link name="lidar"'),
    Broken("no-slash", _CHILD, '<child link="lidar">'),
    Broken("no-slash-anywhere", ' rpy="0 0 0"/>', ' rpy="0 0 0">', is_everywhere=True),
    Broken("a-slash-too-much", _LIDAR, '<link name="lidar"/>'),
    Broken("a-robot-that-closes-itself", '<robot name="my_robot">', '<robot name="my_robot"/>'),
    Broken("a-backslash", "</link>", "<\\link>"),
    Broken("a-backslash-at-the-end", _CHILD, '<child link="lidar"\\>'),
    Broken("a-space-after-the-slash", "</link>", "</ link>"),
    Broken("a-space-in-the-name", "<visual>", "<vis ual>"),
    Broken("no-start-of-a-tag", _LIDAR, 'link name="lidar">'),
    Broken("no-start-of-an-empty-tag", '<origin xyz="0.15', 'origin xyz="0.15'),
    Broken("no-start-of-a-closing-tag", "</visual>", "/visual>"),
    Broken("two-starts", "<visual>", "<<visual>"),
    Broken("a-semicolon", f'{_ORIGIN} rpy="', f'{_ORIGIN}; rpy="'),
    Broken("an-attribute-twice", f'{_ORIGIN} rpy="0', f'{_ORIGIN} xyz="0'),
    Broken("a-comment-in-a-tag", f"{_ORIGIN} rpy", f"{_ORIGIN} <!-- on top --> rpy"),
)
ELEMENTS = (
    Broken("no-closing-visual", "</visual>", ""),
    Broken("no-closing-geometry", "</geometry>", ""),
    Broken("no-closing-link", "</link>", ""),
    Broken("no-closing-joint", "</joint>", ""),
    Broken("no-closing-robot", "</robot>", ""),
    Broken("no-closing-visual-and-link", "    </visual>\n  </link>\n", ""),
    Broken("closing-tag-misspelt", "</visual>", "</visaul>"),
    Broken("closing-tag-of-another", "</joint>", "</link>"),
    Broken("closing-tag-without-slash", "</link>", "<link>"),
    Broken("closing-tag-twice", "</link>", "</link>\n  </link>"),
    Broken("start-tag-misspelt", "<visual>", "<visaul>"),
    Broken("no-start-of-a-geometry", "<geometry>\n", ""),
    Broken("no-start-of-a-link", _LIDAR, ""),
    Broken("no-start-of-a-joint", _JOINT, ""),
    Broken("robot-twice", '<robot name="my_robot">', '<robot name="my_robot">\n<robot name="my_robot">'),
    Broken("robot-ends-early", "  <!-- Caster", "</robot>\n  <!-- Caster"),
    Broken("no-robot", '<robot name="my_robot">', ""),
    Broken("robot-misspelt", "robot>", "robto>"),
    Broken("comment-not-closed", "drives forward -->", "drives forward"),
    Broken("comment-closed-badly", _LAST, _LAST.replace("-->", "->")),
    Broken("comment-opened-badly", "<!-- Caster", "<-- Caster"),
    Broken("declaration-closed-badly", '<?xml version="1.0"?>', '<?xml version="1.0">'),
    Broken("declaration-opened-badly", '<?xml version="1.0"?>', '<xml version="1.0"?>'),
    Broken("declaration-pasted", "  <!-- Wheels", '<?xml version="1.0"?>\n  <!-- Wheels'),
    Broken("text-before-the-declaration", "<?xml", "ash@lab:~$ cat my_robot.urdf\n<?xml"),
    Broken("text-after-the-robot", "</robot>", "</robot>\n\nros2 launch my_robot my_robot_rviz.launch.py"),
)
NAMES = (
    Broken("visual-capitalised", "visual>", "Visual>", is_everywhere=True),
    Broken("cylinder-misspelt", "<cylinder", "<cilinder", is_everywhere=True),
    Broken("cube-for-box", "<box", "<cube"),
    Broken("child-misspelt", "<child", "<chlid"),
    Broken("axis-misspelt", "<axis", "<axes"),
    Broken("colour-in-british-english", "<color", "<colour", is_everywhere=True),
    Broken("radius-misspelt", "radius", "raduis"),
    Broken("link-with-an-id", _LIDAR, '<link id="lidar">'),
    Broken("child-with-a-name", _CHILD, '<child name="lidar"/>'),
    Broken("no-child", _CHILD, ""),
    Broken("no-parent", '<parent link="base_link"/>', ""),
    Broken("no-joint-name", _JOINT, '<joint type="fixed">'),
    Broken("no-joint-type", _JOINT, '<joint name="base_lidar_joint">'),
    Broken("no-link-name", _LIDAR, "<link>"),
    Broken("unknown-type", 'type="continuous"', 'type="rotational"'),
    Broken("type-with-a-space", 'type="fixed"', 'type=" fixed"'),
    Broken("type-that-needs-limits", 'type="continuous"', 'type="revolute"', is_everywhere=True),
    Broken("unknown-parent", 'link="base_link"', 'link="base"', is_everywhere=True),
    Broken("link-with-another-name", '<link name="caster_wheel"', '<link name="caster"'),
    Broken("link-pasted", '<link name="right_wheel"', '<link name="left_wheel"'),
    Broken("joint-pasted", "base_right_wheel_joint", "base_left_wheel_joint"),
    Broken("child-pasted", '<child link="right_wheel"', '<child link="left_wheel"'),
    Broken("parent-of-itself", f'<parent link="base_link"/>\n    {_CHILD}', f'<parent link="lidar"/>\n    {_CHILD}'),
    Broken("no-geometry", "<geometry>\n        <box", "<geometry/>\n        <box"),
    Broken("no-size", ' size="0.6 0.4 0.2"', ""),
    Broken("no-radius", 'radius="0.1" ', ""),
    Broken("no-robot-name", ' name="my_robot"', ""),
    Broken("version-two", "<robot name", '<robot version="2.0" name'),
    Broken("material-misspelt", '<material name="green"/>', '<material name="Green"/>'),
    Broken("material-without-a-name", '<material name="white"/>', "<material/>"),
    Broken("material-without-a-colour", '<color rgba="0.9 0.9 0.9 1"/>', ""),
)
NUMBERS = (
    Broken("decimal-comma", 'radius="0.05"', 'radius="0,05"'),
    Broken("commas", "0.15 0 0.225", "0.15, 0, 0.225"),
    Broken("both-kinds-of-commas", "0.15 0 0.225", "0,15, 0, 0,225"),
    Broken("semicolons", "0.15 0 0.225", "0.15;0;0.225"),
    Broken("tabs", "0.15 0 0.225", "0.15\t0\t0.225"),
    Broken("line-breaks", "0.15 0 0.225", "0.15\n0\n0.225"),
    Broken("spaces-of-a-word-processor", "0.15 0 0.225", "0.15\u00a00\u00a00.225"),
    Broken("brackets", "0.15 0 0.225", "(0.15, 0, 0.225)"),
    Broken("minus-of-a-word-processor", '"-0.15 -0.2 0"', '"\u22120.15 \u22120.2 0"'),
    Broken("numbers-glued", '"-0.15 -0.2 0"', '"-0.15-0.2 0"'),
    Broken("unit", 'radius="0.05"', 'radius="0.05m"'),
    Broken("units", "0.6 0.4 0.2", "60cm 40cm 20cm"),
    Broken("degrees", "-1.57 0 0", "-89.9544deg 0 0", is_everywhere=True),
    Broken("expression", "-1.57 0 0", "${-3.14/2} 0 0", is_everywhere=True),
    Broken("space-at-the-end", 'radius="0.05"', 'radius="0.05 "'),
    Broken("letter-for-zero", "0.15 0 0.225", "0.15 O 0.225"),
    Broken("two-points", "0.225", "0..225"),
    Broken("two-numbers", "0.15 0 0.225", "0.15 0.225"),
    Broken("four-numbers", "0.15 0 0.225", "0.15 0 0.225 0"),
    Broken("word", _AXIS, '<axis xyz="z"/>'),
    Broken("no-numbers", _AXIS, '<axis xyz=""/>'),
    Broken("colour-up-to-255", "0 0.6 0 1", "0 153 0 1"),
    Broken("colour-without-opacity", "0 0.6 0 1", "0 0.6 0"),
)
BROKEN = (*TAGS, *ELEMENTS, *NAMES, *NUMBERS)
