"""The kinds of problems that a URDF's XML can have, and what ROS 2 does about them. Source of `docs/problems.md`."""

from grader.problems import Kind, notes, rejects, warns

MALFORMED_TAG = rejects(
    "URDF001",
    "A malformed tag",
    'ROS 2 stops at a tag that is not of the form <name attribute="value" ...>. Usual causes: a missing attribute '
    "name, a comma between attributes, a missing or typographic quote, a duplicate attribute.",
)
MISMATCHED_TAG = rejects(
    "URDF002",
    "A tag without its own closing tag",
    "Every <tag> needs its </tag>, and the tag opened last is closed first; <tag/> closes itself. The file may end too "
    "early.",
)
EMPTY_DOCUMENT = rejects("URDF003", "An empty file", "The file contains no XML, so ROS 2 has nothing to load.")
UNTERMINATED = rejects(
    "URDF004",
    "A comment, CDATA section or declaration without an end",
    "A comment ends at -->, a CDATA section at ]]>, a declaration at ?>. Else the rest of the file is part of it.",
)
MISPLACED_DECLARATION = rejects(
    "URDF005",
    "An XML declaration that is not at the top",
    "<?xml ...?> must be at the very top of the file, before comments and tags, and so must processing instructions "
    "(<? ... ?>). The usual cause is a second file that was pasted in.",
)
STRAY_TEXT = rejects("URDF006", "Text after the robot", "Only white space and comments may follow </robot>.")
TOO_DEEP = rejects(
    "URDF007", "Tags nested too deep", "TinyXML2, which reads the file for ROS 2, stops at the 499th level of nesting."
)
NOT_UTF8 = rejects(
    "URDF008",
    "A file that is not UTF-8 text",
    "ROS 2 reads UTF-8 (plain ASCII is UTF-8). It cannot read a binary file, or one saved as UTF-16, which some "
    "Windows editors call Unicode: save the file again as UTF-8.",
)
NOT_WELL_FORMED = notes(
    "URDF009",
    "XML that is not well-formed, which ROS 2 accepts",
    "The XML reader of ROS 2 is more lenient than XML. Other tools (xacro, editors, simulators, Python parsers) reject "
    "this file, so fix it.",
)
DOCTYPE = warns(
    "URDF010",
    "A DOCTYPE",
    "ROS 2 skips a DOCTYPE and does not expand the entities that it defines: &name; stays as it is.",
)
IGNORED_REST = warns(
    "URDF011",
    "A part of the file that ROS 2 never reads",
    "For ROS 2 the file ends at a NUL byte, or at a surplus closing tag after the root. It silently ignores the rest.",
)
SEVERAL_ROOTS = warns(
    "URDF012",
    "More than one element at the top level",
    "ROS 2 reads the first <robot> at the top level and ignores every other top-level element.",
)
RECOVERED = Kind(
    "URDF015",
    "An assumption about a broken tag",
    "ROS 2 loads nothing of a file with a broken tag. To grade the rest of it, the grader assumes where an element "
    "ends, or reads a tag without the attributes that are broken. Fix the tag: with other assumptions the file means "
    "something else.",
    severity="warning",
    effect="other",
)
