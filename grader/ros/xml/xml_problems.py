"""The kinds of problems that a URDF's XML can have. docs/examples/urdf.toml explains each one."""

from grader.base.problems import Kind, notes, rejects, warns

MALFORMED_TAG = rejects("URDF001", "A malformed tag")
MISMATCHED_TAG = rejects("URDF002", "A tag without its own closing tag")
EMPTY_DOCUMENT = rejects("URDF003", "An empty file")
UNTERMINATED = rejects("URDF004", "A comment, CDATA section or declaration without an end")
MISPLACED_DECLARATION = rejects("URDF005", "An XML declaration that is not at the top")
STRAY_TEXT = rejects("URDF006", "Text after the robot")
TOO_DEEP = rejects("URDF007", "Tags nested too deep")
NOT_UTF8 = rejects("URDF008", "A file that is not UTF-8 text")
NOT_WELL_FORMED = notes("URDF009", "XML that is not well-formed, which ROS 2 accepts")
DOCTYPE = warns("URDF010", "A DOCTYPE")
IGNORED_REST = warns("URDF011", "Content after the end of the robot is ignored")
SEVERAL_ROOTS = warns("URDF012", "More than one element at the top level")
MERGE_CONFLICT = rejects("URDF016", "An unresolved merge conflict of git")
RECOVERED = Kind("URDF015", "An assumption about what is meant", severity="warning", effect="other")
