"""The kinds of problems that a URDF can have, and what ROS 2 does about them. Source of `docs/problems.md`."""

from grader.problems import drops, kinds_in, notes, rejects, warns
from grader.xml import catalogue as xml_catalogue

NO_ROBOT = rejects(
    "URDF013", "No <robot> at the top level", 'A URDF is one <robot name="..."> that contains the links and joints.'
)
RAW_XACRO = warns(
    "URDF014",
    "xacro that is not expanded",
    "ROS 2's URDF reader does not support xacro: it ignores <xacro:...> tags, and ${...} is not a number. Expand the "
    "file first: `ros2 run xacro xacro my_robot.urdf.xacro > my_robot.urdf`.",
)
ROBOT_WITHOUT_NAME = rejects("URDF020", "A robot without a name", "ROS 2 requires a name, which may be empty.")
BAD_VERSION = rejects(
    "URDF021",
    "An unsupported URDF version",
    "The `version` of <robot> must be of the form x.y, and ROS 2 Jazzy supports only 1.0. It may be missing.",
)
NO_LINKS = rejects("URDF022", "A robot without links", "ROS 2 requires at least one <link>.")
LINK_WITHOUT_NAME = drops(
    "URDF030",
    "A link without a name",
    "ROS 2 logs an error and keeps an empty link named '', without its visuals. Two of them are duplicates.",
)
_COPIED = "The usual cause is copy and paste: rename the copy."
DUPLICATE_LINK = rejects("URDF031", "Two links with the same name", _COPIED)
DUPLICATE_JOINT = rejects("URDF032", "Two joints with the same name", _COPIED)
DUPLICATE_MATERIAL = rejects(
    "URDF033",
    "Two materials with the same name directly under <robot>",
    "A material name may be defined under <robot> only once. Materials without a name count as having the same name.",
)
JOINT_WITHOUT_NAME = rejects("URDF034", "A joint without a name", "ROS 2 requires a name.")
BAD_INERTIAL = drops(
    "URDF040",
    "An invalid <inertial>",
    "ROS 2 logs an error and drops the link's inertial, visuals and collisions. An inertial needs <mass value> and "
    "<inertia> with ixx, ixy, ixz, iyy, iyz, izz, all plain numbers.",
)
BAD_VISUAL = drops(
    "URDF041",
    "An invalid <visual>",
    "ROS 2 logs an error and drops this visual, every later visual of the link, and all its collisions. A visual needs "
    "<geometry> with <box size>, <cylinder radius length>, <sphere radius> or <mesh filename>.",
)
BAD_COLLISION = drops(
    "URDF042",
    "An invalid <collision>",
    "ROS 2 logs an error and drops this collision and every later collision of the link.",
)
FORMAT_DIRECTIVE = rejects(
    "URDF043",
    "A %n in an invalid value",
    "ROS 2 prints a value that it cannot read through printf, where %n writes to memory: the program can crash.",
)
UNNAMED_MATERIAL = drops(
    "URDF050",
    "A material without a name",
    "ROS 2 logs an error. No link can use the material, because links refer to it by its name.",
)
UNDEFINED_MATERIAL = drops(
    "URDF051",
    "A material that is not defined, or used before its definition",
    "The link is shown without the colour. A material directly under <robot> is defined for every link; one inside a "
    "link is defined for that link and the links after it. Define it under <robot>.",
)
BAD_COLOUR = drops(
    "URDF052",
    "An invalid colour",
    "rgba takes four numbers from 0 to 1: red, green, blue, opacity. ROS 2 logs an error; a material under <robot> "
    "becomes black, one inside a link stays undefined. Divide values in 0..255 by 255.",
)
COLOUR_COUNT = warns(
    "URDF053",
    "A colour without exactly four numbers",
    "rgba takes four numbers: red, green, blue, opacity. With another count ROS 2 silently shows black.",
)
COLOURLESS_MATERIAL = drops(
    "URDF054",
    "A material under <robot> without a colour",
    "ROS 2 logs an error and makes it black. Add <color rgba> or <texture filename>.",
)
REDEFINED_MATERIAL = warns(
    "URDF055",
    "A second definition of a material, which is ignored",
    "ROS 2 uses the first definition of a material name; those under <robot> come before those in links.",
)
_TYPES = "The types are fixed, continuous, revolute, prismatic, floating and planar, in lower case without spaces."
TYPE_MISSING = rejects("URDF060", "A joint without a type", _TYPES)
TYPE_UNKNOWN = rejects("URDF061", "An unknown joint type", _TYPES)
BAD_JOINT_ORIGIN = rejects(
    "URDF062", "An invalid joint origin", "xyz and rpy take three numbers each, separated by spaces."
)
BAD_AXIS = rejects(
    "URDF063",
    "An invalid joint axis",
    "An axis takes three numbers. ROS 2 ignores the axis of fixed and floating joints.",
)
LIMIT_MISSING = rejects(
    "URDF064",
    "A revolute or prismatic joint without limits",
    'These joints require <limit>. For a wheel that turns without end use type="continuous".',
)
BAD_LIMIT = rejects(
    "URDF065",
    "An incomplete or invalid joint limit",
    "Every <limit>, of any joint, needs effort and velocity, as numbers.",
)
BAD_DYNAMICS = rejects(
    "URDF066", "An empty or invalid <dynamics>", "<dynamics> needs damping, friction or both, as plain numbers."
)
BAD_MIMIC = rejects(
    "URDF067",
    "A <mimic> without a joint, or with an invalid number",
    "A joint is required; multiplier and offset are numbers.",
)
BAD_SAFETY = rejects(
    "URDF068", "An incomplete or invalid <safety_controller>", "k_velocity is required; all values are plain numbers."
)
BAD_CALIBRATION = rejects("URDF069", "An invalid <calibration>", "rising and falling are plain numbers.")
NO_PARENT_OR_CHILD = rejects(
    "URDF070", "A joint without parent or child", "A joint connects two links: it needs the names of both."
)
UNKNOWN_LINK = rejects(
    "URDF071", "A joint with a link that does not exist", "Names must match exactly, including upper and lower case."
)
DEFAULT_AXIS = notes(
    "URDF072", "A moving joint without an axis", "ROS 2 uses the x axis (1 0 0) of the joint's frame. State the axis."
)
ZERO_AXIS = warns(
    "URDF073",
    "A joint axis of length zero",
    "ROS 2 loads the file, but the pose of every link below this joint is undefined (NaN), and TF drops it. An <axis> "
    "without xyz is 0 0 0, too.",
)
SCALED_AXIS = notes(
    "URDF074",
    "A joint axis whose length is not 1",
    "Only the direction counts: ROS 2 normalizes the axis, so its length changes neither speed nor distance.",
)
EMPTY_RANGE = warns(
    "URDF075",
    "Joint limits without a range",
    "lower and upper default to 0, and ROS 2 does not check them: sliders and controllers cannot move a joint whose "
    "lower limit is not below its upper limit.",
)
MIMIC_TARGET = warns(
    "URDF076",
    "A mimic of a joint that does not exist, or of itself",
    "ROS 2 loads the file, but nothing ever moves this joint, and robot_state_publisher does not publish its pose.",
)
UNPUBLISHED_JOINT = notes(
    "URDF077",
    "A floating or planar joint",
    "robot_state_publisher does not publish floating joints and treats planar joints as fixed: another node has to "
    "publish the transform.",
)
NEGATIVE_SIZE = warns(
    "URDF078",
    "A negative size",
    "ROS 2 does not check sizes. How a negative size is shown depends on the program that draws it.",
)
LIMIT_IN_DEGREES = notes(
    "URDF079",
    "A joint limit that looks like degrees",
    "The limits of a revolute joint are in radians: 90 degrees are 1.5708, 180 degrees 3.1416. ROS 2 loads the file, "
    "but the joint can turn many times.",
)
TWO_ROOTS = rejects(
    "URDF080",
    "Links that are not connected to the robot",
    "All links must form one tree: every link but one is the child of a joint. Add the missing joint, or fix the link "
    "names in the joints.",
    is_consequence=True,
)
NO_ROOT = rejects(
    "URDF081",
    "A tree without a root",
    "Every link is the child of a joint, so the links form a loop. One link, the root, must not be a child.",
    is_consequence=True,
)
CYCLE = rejects(
    "URDF082",
    "A loop of joints",
    "The joints lead from parent to child back to the same link. robot_state_publisher follows the loop without "
    "end and crashes. A robot in a URDF is a tree.",
)
DETACHED_CYCLE = drops(
    "URDF083",
    "A detached loop of links",
    "These links form a loop that is not connected to the root. ROS 2 loads the file, but ignores them.",
    detaches_links=True,
)
TWO_PARENTS = warns(
    "URDF084",
    "A link that is the child of two joints",
    "ROS 2 loads the file and uses the joint that comes last in name order; the others have no effect on the link.",
)
TOO_MANY_PATHS = rejects(
    "URDF085",
    "A tree with too many paths",
    "ROS 2 visits a link with two parents once for every path that leads to it. Here the paths are so many that it "
    "does not finish loading.",
)
REPEATED_ELEMENT = notes(
    "URDF090",
    "A repeated element",
    "ROS 2 reads only the first of several <origin>, <geometry>, <parent>, <child> and the like in the same place.",
)
MISSPELT = notes(
    "URDF091",
    "An unknown tag or attribute, which is ignored",
    "ROS 2 silently ignores unknown names. This one looks like a misspelling of a known name.",
)
DEGREES = warns(
    "URDF092", "An angle that looks like degrees", "rpy is in radians: 90 degrees are 1.5708, 180 degrees 3.1416."
)
ROOT_INERTIA = notes(
    "URDF093",
    "A root link with an inertia",
    "robot_state_publisher warns because KDL ignores the inertia of the root. Use a root link without one, such as "
    "base_footprint.",
)
COMMENT_TRAP = notes(
    "URDF094",
    "A comment that can break a launch file",
    "If a launch file passes robot_description without ParameterValue(..., value_type=str), ROS 2 reads the URDF as "
    "YAML, and a comment that contains a colon and a space, or a tab, stops the launch.",
)
UNLISTED = notes(
    "URDF099",
    "More problems than are listed",
    "Only the first thousand problems of a file are listed. Fix these first; many of the others may disappear with "
    "them.",
)

CATALOGUE = kinds_in([*vars(xml_catalogue).values(), *globals().values()])
