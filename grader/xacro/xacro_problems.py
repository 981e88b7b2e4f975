"""The kinds of problems that a xacro file can have. docs/examples/xacro.toml explains each one."""

from functools import partial

from grader.problems import Kind, kinds_in, rejects

_stops = partial(rejects, is_before_ros=True)

XACRO_NOT_XML = _stops("XACRO001", "A xacro file that is not well-formed XML")
XACRO_EXPRESSION = _stops("XACRO002", "An expression that xacro cannot evaluate")
XACRO_MACRO = _stops("XACRO003", "A macro call that xacro refuses")
XACRO_FILE = _stops("XACRO004", "An included file that does not exist")
XACRO_TAG = _stops("XACRO005", "A xacro tag that xacro refuses")
XACRO_UNDETERMINED = Kind(
    "XACRO006", "xacro that cannot be determined statically", severity="warning", effect="undetermined"
)

XACRO_CATALOGUE = kinds_in(globals().values())
