"""Materials: robot-level ones first, then those in links in file order; the first definition of a name wins."""

from tests.robot.edge_cases.case import clean, degraded, joint, links, one_link, rejected, robot, visual

_DEFINED = "a visual may name a material of the robot, wherever that is defined"
_IN_PLACE = "a material defined in a link is known to the links after it"
_UNDEFINED = "a material without colour or texture must be defined before"
_NEEDS_COLOUR = "a material of the robot needs a colour or a texture"
_NAMELESS = "a material in a visual needs a name"
_TWICE = "a material name must not be used twice at robot level"
_AGAIN = "a second definition in a link is ignored"
_COUNT = "a wrong count of channels is silently black"
_VALUE = "a colour that cannot be read is an error"
_FIRST = "of repeated elements the first counts"
_IGNORED = "unknown tags and attributes are ignored"

_RED = '<color rgba="1 0 0 1"/>'
_BAD = '<color rgba="255 0 0 1"/>'
_UNTEXTURED = '<texture filename=""/>'
_TEXTURE = '<texture filename="a.png"/>'


def _material(name: str, body: str = "") -> str:
    return f'<material name="{name}">{body}</material>'


def _shown(name: str, material: str) -> str:
    return f'<link name="{name}">{visual(material)}</link>'


def _two(first: str, second: str, before: str = "", after: str = "") -> str:
    return robot(before + _shown("a", first) + _shown("b", second) + joint("a", "b") + after)


_USE = _material("m")
_SET = _material("m", _RED)

CASES = (
    clean("material-in-robot", _DEFINED, robot(_SET + _shown("a", _USE))),
    clean("material-in-robot-after-joints", _DEFINED, _two(_USE, _USE, after=_SET)),
    clean("material-in-robot-unused", _DEFINED, robot(_SET + links("a"))),
    clean("material-in-place", _IN_PLACE, robot(_shown("a", _SET))),
    clean("material-in-place-then-used", _IN_PLACE, _two(_SET, _USE)),
    clean("material-in-place-then-used-in-same-link", _IN_PLACE, one_link(visual(_SET) + visual(_USE))),
    degraded("material-used-then-in-place", _IN_PLACE, _two(_USE, _SET)),
    degraded("material-used-then-in-place-in-same-link", _IN_PLACE, one_link(visual(_USE) + visual(_SET))),
    degraded("material-undefined", _UNDEFINED, one_link(visual(_USE))),
    degraded("material-undefined-in-second-visual", _UNDEFINED, one_link(visual("") + visual(_USE))),
    degraded("material-undefined-in-both-links", _UNDEFINED, _two(_USE, _USE)),
    degraded("material-of-other-case", _UNDEFINED, robot(_material("M", _RED) + _shown("a", _USE))),
    degraded("material-with-trailing-space", _UNDEFINED, robot(_material("m ", _RED) + _shown("a", _USE))),
    degraded("material-defined-in-collision", _UNDEFINED, _two(_USE, "").replace("</visual>", f"</visual>{_SET}", 1)),
    degraded("material-defined-in-link-itself", _UNDEFINED, one_link(_SET + visual(_USE))),
    degraded("material-defined-in-gazebo", _UNDEFINED, robot(f"<gazebo>{_SET}</gazebo>{_shown('a', _USE)}")),
    degraded("material-defined-in-second-robot", _UNDEFINED, one_link(visual(_USE)) + robot(_SET)),
    degraded("material-defined-in-bad-visual", _UNDEFINED, _two(_SET, _USE).replace("box", "bix", 1)),
    clean("material-empty-name-in-visual", "an empty material name is none", one_link(visual(_material("")))),
    clean("material-empty-name-with-colour", "an empty material name is none", one_link(visual(_material("", _RED)))),
    degraded("material-nameless-in-visual", _NAMELESS, one_link(visual("<material/>"))),
    degraded("material-name-in-capitals", _NAMELESS, one_link(visual('<material Name="m"/>'))),
    degraded("material-nameless-in-robot", _NEEDS_COLOUR, robot("<material/>" + links("a"))),
    degraded("material-nameless-colour-in-robot", _NEEDS_COLOUR, robot(f"<material>{_RED}</material>{links('a')}")),
    rejected("materials-nameless-in-robot", _TWICE, robot("<material/><material/>" + links("a"))),
    rejected("material-nameless-and-empty-name", _TWICE, robot(f"<material/>{_material('', _RED)}{links('a')}")),
    rejected("materials-of-one-name", _TWICE, robot(_SET + _SET + links("a"))),
    rejected("materials-of-one-name-second-bare", _TWICE, robot(_SET + _USE + links("a"))),
    rejected("materials-of-one-name-both-bare", _TWICE, robot(_USE + _USE + links("a"))),
    clean("materials-of-two-cases", _TWICE, robot(_SET + _material("M", _RED) + links("a"))),
    clean("material-again-in-link", _AGAIN, robot(_SET + _shown("a", _material("m", _TEXTURE)))),
    clean("material-again-in-second-link", _AGAIN, _two(_SET, _material("m", _TEXTURE))),
    degraded("material-again-in-link-bad", _VALUE, robot(_SET + _shown("a", _material("m", _BAD)))),
    degraded("material-bare-in-robot", _NEEDS_COLOUR, robot(_USE + links("a"))),
    degraded("material-bare-in-robot-used", _NEEDS_COLOUR, robot(_USE + _shown("a", _USE))),
    degraded("material-bare-in-robot-set-in-link", _NEEDS_COLOUR, robot(_USE + _shown("a", _SET))),
    degraded("material-colour-without-rgba", _NEEDS_COLOUR, robot(_material("m", "<color/>") + links("a"))),
    degraded("material-colour-rgb", _NEEDS_COLOUR, robot(_material("m", '<color rgb="1 0 0"/>') + links("a"))),
    degraded("material-colour-british", _NEEDS_COLOUR, robot(_material("m", '<colour rgba="1 0 0 1"/>') + links("a"))),
    clean("material-texture", _NEEDS_COLOUR, robot(_material("m", _TEXTURE) + links("a"))),
    clean("material-texture-and-colour", _NEEDS_COLOUR, robot(_material("m", _TEXTURE + _RED) + links("a"))),
    degraded("material-texture-and-bad-colour", _VALUE, robot(_material("m", _TEXTURE + _BAD) + links("a"))),
    clean("material-texture-in-visual", _IN_PLACE, one_link(visual(_material("m", _TEXTURE)))),
    degraded("material-texture-and-bad-colour-in-visual", _VALUE, one_link(visual(_material("m", _TEXTURE + _BAD)))),
    degraded("material-colour-without-rgba-in-visual", _UNDEFINED, one_link(visual(_material("m", "<color/>")))),
    degraded("material-bad-colour-in-robot", _VALUE, robot(_material("m", _BAD) + links("a"))),
    degraded("material-bad-colour-in-robot-used", _VALUE, robot(_material("m", _BAD) + _shown("a", _USE))),
    degraded("material-bad-colour-in-visual", _VALUE, one_link(visual(_material("m", _BAD)))),
    clean("material-three-channels-in-robot", _COUNT, robot(_material("m", '<color rgba="1 0 0"/>') + links("a"))),
    clean("material-no-channels-in-robot", _COUNT, robot(_material("m", '<color rgba=""/>') + links("a"))),
    clean("material-three-channels-defines", _COUNT, _two(_material("m", '<color rgba="1 0 0"/>'), _USE)),
    clean("material-two-colours-second-bad", _FIRST, one_link(visual(_material("m", _RED + _BAD)))),
    degraded("material-two-colours-first-bad", _FIRST, one_link(visual(_material("m", _BAD + _RED)))),
    degraded("material-two-colours-first-bare", _FIRST, one_link(visual(_material("m", "<color/>" + _RED)))),
    degraded("material-twice-in-visual-first-nameless", _FIRST, one_link(visual("<material/>" + _SET))),
    clean("material-unknown-content", _IGNORED, one_link(visual(_material("m", f'<ambient a="b"/>{_RED}<specular/>')))),
    clean("material-in-capitals", "names are case-sensitive", one_link(visual("<Material/>"))),
)
