"""The kinds of problems that the XML of a URDF can have, with what ROS 2 does about them. `docs/problems.md` is generated from it."""

from grader.problems import notes, rejects, warns

MALFORMED_TAG = rejects(
    "URDF001",
    "A tag that cannot be read",
    'ROS 2 stops at a tag that is not of the form <name attribute="value" ...>. Usual causes: a missing attribute name '
    '(<parent="base_link"/> for <parent link="base_link"/>), a comma between attributes, a missing or typographic quote, '
    "an attribute given twice. Nothing of the file is loaded until the tag is mended.",
)
MISMATCHED_TAG = rejects(
    "URDF002",
    "A tag that is not closed by its own closing tag",
    "Every <tag> needs its </tag>, and the one opened last is closed first; <tag/> closes itself. Where they do not match, "
    "ROS 2 loads nothing of the file. A file that ends too early is the same case.",
)
EMPTY_DOCUMENT = rejects("URDF003", "An empty file", "There is no XML in the file, so ROS 2 has nothing to load.")
UNTERMINATED = rejects(
    "URDF004",
    "A comment, CDATA section or declaration that never ends",
    "A comment ends at -->, a CDATA section at ]]>, a declaration at ?>. Where the end is missing, the rest of the file "
    "belongs to it, and ROS 2 loads nothing.",
)
MISPLACED_DECLARATION = rejects(
    "URDF005",
    "An XML declaration that does not stand at the very top",
    "<?xml ...?> may stand only at the top of the file, before comments and tags. ROS 2 refuses the file otherwise; it comes "
    "about when a second file is pasted in. Processing instructions (<? ... ?>) are refused in the same way.",
)
STRAY_TEXT = rejects(
    "URDF006",
    "Text after the robot",
    "Behind </robot> only blank space and comments may follow. ROS 2 refuses a file that ends in text.",
)
TOO_DEEP = rejects(
    "URDF007",
    "Tags nested too deep",
    "TinyXML2, which reads the file for ROS 2, gives up at the 499th level of nesting.",
)
NOT_UTF8 = rejects(
    "URDF008",
    "A file that is not UTF-8 text",
    "ROS 2 reads UTF-8 (plain ASCII is UTF-8). A file saved as UTF-16, which some Windows editors call Unicode, or a binary "
    "file, cannot be read: save it again as UTF-8.",
)
NOT_WELL_FORMED = notes(
    "URDF009",
    "ROS 2 loads it, but it is not well-formed XML",
    "The reader of ROS 2 is more lenient than XML. Other tools (xacro, editors, simulators, Python parsers) will refuse this "
    "file, so it is worth mending.",
)
DOCTYPE = warns(
    "URDF010",
    "A DOCTYPE",
    "ROS 2 skips a DOCTYPE and leaves the entities that it defines unresolved: &name; stays as it stands.",
)
IGNORED_REST = warns(
    "URDF011",
    "A part of the file that ROS 2 never reads",
    "A NUL byte, or a closing tag too many behind the root, ends the file for ROS 2. What follows is ignored in silence.",
)
SEVERAL_ROOTS = warns(
    "URDF012",
    "More than one element at the top of the file",
    "ROS 2 takes the first <robot> at the top level and ignores everything else beside it.",
)
