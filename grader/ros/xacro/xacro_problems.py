"""The kinds of problems that a xacro file can have. docs/examples/xacro.toml explains each one."""

from functools import partial

from grader.base.problems import Kind, kinds_in, notes, rejects, warns

_stops = partial(rejects, is_before_ros=True)

XACRO_NOT_XML = _stops("XACRO001", "A xacro file that is not well-formed XML")
XACRO_EXPRESSION = _stops("XACRO002", "An expression that xacro cannot evaluate")
XACRO_MACRO = _stops("XACRO003", "A macro call that xacro refuses")
XACRO_FILE = _stops("XACRO004", "An included file that does not exist")
XACRO_TAG = _stops("XACRO005", "A xacro tag that xacro refuses")
XACRO_UNDETERMINED = Kind(
    "XACRO006",
    "xacro that cannot be determined statically",
    severity="warning",
    effect="undetermined",
)
# xacro writes these to stderr, and expands the file all the same.
XACRO_REDEFINED = warns("XACRO007", "A built-in name of xacro that is redefined")
XACRO_DEPRECATED = warns("XACRO008", "A function that is called without its namespace")
XACRO_PREFIXED = warns("XACRO009", "A macro whose name begins with xacro:")
XACRO_ATTRIBUTE = warns("XACRO010", "An attribute that a xacro tag does not have")
XACRO_CHILDREN = warns("XACRO011", "Elements inside an include")
XACRO_MESSAGE = warns("XACRO012", "A message that the file lets xacro write")
WRITTEN_TO_STDERR = frozenset(
    {
        XACRO_REDEFINED,
        XACRO_DEPRECATED,
        XACRO_PREFIXED,
        XACRO_ATTRIBUTE,
        XACRO_CHILDREN,
        XACRO_MESSAGE,
    }
)
XACRO_CARET = notes("XACRO013", "An exclusive or where a power may be meant")

XACRO_CATALOGUE = kinds_in(globals().values())
