"""The kinds of problems that a URDF can have. docs/examples/urdf.toml explains each one."""

from grader.base.problems import drops, kinds_in, notes, rejects, warns
from grader.ros.xml import xml_problems

NO_ROBOT = rejects("URDF013", "No <robot> at the top level")
RAW_XACRO = warns("URDF014", "xacro that is not expanded")
ROBOT_WITHOUT_NAME = rejects("URDF020", "A robot without a name")
BAD_VERSION = rejects("URDF021", "An unsupported URDF version")
NEWER_ATTRIBUTE = drops("URDF023", "An attribute of a newer version of URDF")
IGNORED_QUATERNION = warns("URDF024", "A quaternion that ROS 2 does not read")
NO_LINKS = rejects("URDF022", "A robot without links")
LINK_WITHOUT_NAME = drops("URDF030", "A link without a name")
DUPLICATE_LINK = rejects("URDF031", "Two links with the same name")
DUPLICATE_JOINT = rejects("URDF032", "Two joints with the same name")
DUPLICATE_MATERIAL = rejects("URDF033", "Two materials with the same name directly under <robot>")
JOINT_WITHOUT_NAME = rejects("URDF034", "A joint without a name")
BAD_INERTIAL = drops("URDF040", "An invalid <inertial>")
BAD_VISUAL = drops("URDF041", "An invalid <visual>")
BAD_COLLISION = drops("URDF042", "An invalid <collision>")
FORMAT_DIRECTIVE = rejects("URDF043", "A %n in an invalid value")
UNNAMED_MATERIAL = drops("URDF050", "A material without a name")
UNDEFINED_MATERIAL = drops(
    "URDF051", "A material that is not defined, or used before its definition"
)
BAD_COLOUR = drops("URDF052", "An invalid colour")
COLOUR_COUNT = warns("URDF053", "A colour without exactly four numbers")
COLOURLESS_MATERIAL = drops("URDF054", "A material under <robot> without a colour")
REDEFINED_MATERIAL = warns("URDF055", "A second definition of a material, which is ignored")
TYPE_MISSING = rejects("URDF060", "A joint without a type")
TYPE_UNKNOWN = rejects("URDF061", "An unknown joint type")
BAD_JOINT_ORIGIN = rejects("URDF062", "An invalid joint origin")
BAD_AXIS = rejects("URDF063", "An invalid joint axis")
LIMIT_MISSING = rejects("URDF064", "A revolute or prismatic joint without limits")
BAD_LIMIT = rejects("URDF065", "An incomplete or invalid joint limit")
BAD_DYNAMICS = rejects("URDF066", "An empty or invalid <dynamics>")
BAD_MIMIC = rejects("URDF067", "A <mimic> without a joint, or with an invalid number")
BAD_SAFETY = rejects("URDF068", "An incomplete or invalid <safety_controller>")
BAD_CALIBRATION = rejects("URDF069", "An invalid <calibration>")
NO_PARENT_OR_CHILD = rejects("URDF070", "A joint without parent or child")
UNKNOWN_LINK = rejects("URDF071", "A joint with a link that does not exist")
DEFAULT_AXIS = notes("URDF072", "A moving joint without an axis")
ZERO_AXIS = warns("URDF073", "A joint axis of length zero")
SCALED_AXIS = notes("URDF074", "A joint axis whose length is not 1")
EMPTY_RANGE = warns("URDF075", "Joint limits without a range")
MIMIC_TARGET = warns("URDF076", "A mimic of a joint that does not exist, or of itself")
UNPUBLISHED_JOINT = notes("URDF077", "A floating or planar joint")
NEGATIVE_SIZE = warns("URDF078", "A negative size")
LIMIT_IN_DEGREES = notes("URDF079", "A joint limit that looks like degrees")
TWO_ROOTS = rejects("URDF080", "Links that are not connected to the robot", is_consequence=True)
NO_ROOT = rejects("URDF081", "A tree without a root", is_consequence=True)
CYCLE = rejects("URDF082", "A loop of joints")
DETACHED_CYCLE = drops("URDF083", "A detached loop of links", detaches_links=True)
TWO_PARENTS = warns("URDF084", "A link that is the child of two joints")
TOO_MANY_PATHS = rejects("URDF085", "A tree with too many paths")
REPEATED_ELEMENT = notes("URDF090", "A repeated element")
MISSPELT = notes("URDF091", "An unknown tag or attribute, which is ignored")
DEGREES = warns("URDF092", "An angle that looks like degrees")
ROOT_INERTIA = notes("URDF093", "A root link with an inertia")
COMMENT_TRAP = notes("URDF094", "A comment that can break a launch file")
NOT_FOR_PYTHON = warns("URDF095", "A file that joint_state_publisher cannot read")
CONTROLLED_JOINT = warns("URDF096", "A joint of ros2_control that the robot does not have")
HARDWARE_PLUGIN = warns("URDF097", "A <hardware> of ros2_control without <plugin>")
UNLISTED = notes("URDF099", "More problems than are listed")

CATALOGUE = kinds_in([*vars(xml_problems).values(), *globals().values()])

# Those of which a slip may be the cause.
OF_SLIPS = frozenset(
    {
        MISSPELT,
        BAD_VISUAL,
        BAD_COLLISION,
        BAD_INERTIAL,
        BAD_COLOUR,
        COLOURLESS_MATERIAL,
        UNDEFINED_MATERIAL,
    }
)

# Those of what is written as a URDF has it, so that no slip is the cause.
OF_VALUES = frozenset(
    {SCALED_AXIS, UNPUBLISHED_JOINT, LIMIT_IN_DEGREES, DEGREES, ROOT_INERTIA, COMMENT_TRAP}
)

# Those of the attributes of one tag, whatever is around it.
OF_ATTRIBUTES = frozenset(
    {BAD_COLOUR, TYPE_UNKNOWN, BAD_JOINT_ORIGIN, BAD_AXIS, BAD_LIMIT, BAD_DYNAMICS, BAD_MIMIC}
)
