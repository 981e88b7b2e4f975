"""The kinds of problems that a xacro file can have. `docs/problems.md` is generated from it."""

from functools import partial

from grader.problems import Kind, kinds_in, rejects

stops = partial(rejects, is_before_ros=True)

XACRO_NOT_XML = stops(
    "XACRO001",
    "A xacro file that is not well-formed XML",
    "xacro reads XML strictly, more strictly than ROS 2 reads a plain URDF. Usual causes: a blank line or comment "
    'before <?xml ...?>, no xmlns:xacro="http://www.ros.org/wiki/xacro" in <robot>, a tag without its closing tag.',
)
XACRO_EXPRESSION = stops(
    "XACRO002",
    "An expression that xacro cannot evaluate",
    "xacro stops at an expression with an error: a name that is not defined at this place, a division by zero, a text "
    "used as a number. A property must be defined before it is used, and a macro's own properties are unknown outside "
    "of it.",
)
XACRO_MACRO = stops(
    "XACRO003",
    "A macro call that xacro refuses",
    "xacro stops at a call of a macro that is not defined at this place, and at a parameter that the macro does not "
    "have, or that is missing and has no default. Define a macro, or include its file, above the first call.",
)
XACRO_FILE = stops(
    "XACRO004",
    "An included file that does not exist",
    "xacro looks for a file relative to the file that includes it, or in the folder that a build installs a package "
    "in, for $(find package). Correct the path, or submit the file.",
)
XACRO_TAG = stops(
    "XACRO005",
    "A xacro tag that xacro refuses",
    "xacro stops at a tag of its own with a missing attribute, a condition that is neither true nor false, or a name "
    "that cannot be a property.",
)
XACRO_UNDETERMINED = Kind(
    "XACRO006",
    "xacro that cannot be determined statically",
    "What a file contains can depend on what only a run shows: an environment variable, a package that is not part of "
    "the submission, an argument without a default. Give the folder or archive that was submitted, not the file alone, "
    "and the value of an argument with --arg NAME=VALUE.",
    severity="warning",
    effect="undetermined",
)

XACRO_CATALOGUE = kinds_in(globals().values())
