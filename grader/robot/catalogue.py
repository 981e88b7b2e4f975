"""Every kind of problem that a URDF can have, with what ROS 2 does about it. `docs/problems.md` is generated from it."""

from grader.problems import drops, kinds_in, notes, rejects, warns
from grader.xml import catalogue as xml_catalogue

NO_ROBOT = rejects(
    "URDF013",
    "No <robot> at the top of the file",
    'A URDF is one <robot name="..."> that holds the links and joints. ROS 2 finds none at the top level and loads nothing.',
)
RAW_XACRO = warns(
    "URDF014",
    "xacro that has not been expanded",
    "ROS 2's URDF reader does not know xacro: <xacro:...> tags are ignored and ${...} is not a number. Expand the file first: "
    "`ros2 run xacro xacro my_robot.urdf.xacro > my_robot.urdf`.",
)
ROBOT_WITHOUT_NAME = rejects(
    "URDF020", "A robot without a name", 'ROS 2 demands <robot name="...">; an empty name is accepted.'
)
BAD_VERSION = rejects(
    "URDF021",
    "A URDF version that ROS 2 does not know",
    'The `version` of <robot> must be of the form x.y, and ROS 2 Jazzy knows 1.0 only. Leave it out, or write version="1.0".',
)
NO_LINKS = rejects("URDF022", "A robot without links", "ROS 2 loads a robot only if it has at least one <link>.")
LINK_WITHOUT_NAME = drops(
    "URDF030",
    "A link without a name",
    "ROS 2 logs an error and keeps an empty link named '' without what it shows. Two of them are a duplicate.",
)
DUPLICATE_LINK = rejects(
    "URDF031",
    "Two links with one name",
    "Link names must be unique; ROS 2 loads nothing. It comes about by copy and paste: rename the copy.",
)
DUPLICATE_JOINT = rejects(
    "URDF032",
    "Two joints with one name",
    "Joint names must be unique; ROS 2 loads nothing. It comes about by copy and paste: rename the copy.",
)
DUPLICATE_MATERIAL = rejects(
    "URDF033",
    "Two materials with one name directly under <robot>",
    "A material may be defined under <robot> only once; ROS 2 loads nothing. Materials without a name all count as one name.",
)
JOINT_WITHOUT_NAME = rejects("URDF034", "A joint without a name", 'ROS 2 demands <joint name="..." type="...">.')
BAD_INERTIAL = drops(
    "URDF040",
    "An <inertial> that cannot be read",
    "ROS 2 logs an error and drops the link's visuals and collisions with it. An inertial needs <mass value> and <inertia> "
    "with ixx, ixy, ixz, iyy, iyz, izz, all plain numbers.",
)
BAD_VISUAL = drops(
    "URDF041",
    "A <visual> that cannot be read",
    "ROS 2 logs an error and drops this visual, every visual of the link behind it, and all its collisions. A visual needs "
    "<geometry> with <box size>, <cylinder radius length>, <sphere radius> or <mesh filename>.",
)
BAD_COLLISION = drops(
    "URDF042",
    "A <collision> that cannot be read",
    "ROS 2 logs an error and drops this collision and every collision of the link behind it.",
)
FORMAT_DIRECTIVE = rejects(
    "URDF043",
    "A %n in a value that ROS 2 cannot read",
    "ROS 2 prints the value that it cannot read through printf, where %n writes to memory: the program can crash.",
)
UNNAMED_MATERIAL = drops(
    "URDF050",
    "A material without a name",
    "ROS 2 logs an error; no link can use the material, as there is no name to refer to.",
)
UNDEFINED_MATERIAL = drops(
    "URDF051",
    "A material that is not defined, or not yet",
    "The link is shown without the colour. Materials directly under <robot> are known everywhere; one defined inside a link "
    "is known from that link on, in file order. Define it under <robot>.",
)
BAD_COLOUR = drops(
    "URDF052",
    "A colour that cannot be read",
    'rgba holds four numbers from 0 to 1: red, green, blue, opacity, as in rgba="0 0.6 0 1". ROS 2 logs an error; a material '
    "under <robot> becomes black, one inside a link stays undefined. Divide values in 0..255 by 255.",
)
COLOUR_COUNT = warns(
    "URDF053",
    "A colour without exactly four numbers",
    "rgba holds four numbers: red, green, blue, opacity. With another count ROS 2 silently shows black. Add the opacity: 1.",
)
COLOURLESS_MATERIAL = drops(
    "URDF054",
    "A material under <robot> without a colour",
    "ROS 2 logs an error and makes it black. Give it <color rgba> or <texture filename>.",
)
REDEFINED_MATERIAL = warns(
    "URDF055",
    "A second definition of a material, which is ignored",
    "Of several definitions of one material name the first counts, and those under <robot> come before those in links.",
)
TYPE_MISSING = rejects(
    "URDF060",
    "A joint without a type",
    "ROS 2 demands a type: fixed, continuous, revolute, prismatic, floating or planar.",
)
TYPE_UNKNOWN = rejects(
    "URDF061",
    "A joint type that does not exist",
    "The types are fixed, continuous, revolute, prismatic, floating and planar, in lower case without spaces. ROS 2 loads "
    "nothing with any other.",
)
BAD_JOINT_ORIGIN = rejects(
    "URDF062",
    "A joint origin that cannot be read",
    'xyz and rpy hold three numbers each, separated by spaces: <origin xyz="0.15 0 0.225" rpy="0 0 0"/>. ROS 2 loads nothing.',
)
BAD_AXIS = rejects(
    "URDF063",
    "A joint axis that cannot be read",
    'An axis holds three numbers, separated by spaces: <axis xyz="0 0 1"/>. ROS 2 loads nothing (it does not look at the axis '
    "of fixed and floating joints).",
)
LIMIT_MISSING = rejects(
    "URDF064",
    "A revolute or prismatic joint without limits",
    'ROS 2 demands <limit lower upper effort velocity> for them. For a wheel that turns without end use type="continuous".',
)
BAD_LIMIT = rejects(
    "URDF065",
    "A joint limit that is incomplete or cannot be read",
    "Any <limit>, even of a fixed or continuous joint, needs effort and velocity, and only plain numbers. ROS 2 loads nothing.",
)
BAD_DYNAMICS = rejects(
    "URDF066",
    "A joint's <dynamics> that is empty or cannot be read",
    "<dynamics> needs damping, friction or both, as plain numbers. ROS 2 loads nothing.",
)
BAD_MIMIC = rejects(
    "URDF067",
    "A joint's <mimic> that names no joint or cannot be read",
    "<mimic> needs the name of a joint; multiplier and offset are plain numbers. ROS 2 loads nothing.",
)
BAD_SAFETY = rejects(
    "URDF068",
    "A joint's <safety_controller> that is incomplete or cannot be read",
    "<safety_controller> needs k_velocity; all its values are plain numbers. ROS 2 loads nothing.",
)
BAD_CALIBRATION = rejects(
    "URDF069",
    "A joint's <calibration> that cannot be read",
    "rising and falling are plain numbers. ROS 2 loads nothing.",
)
NO_PARENT_OR_CHILD = rejects(
    "URDF070",
    "A joint without parent or child",
    'A joint holds one link to another: it needs <parent link="..."/> and <child link="..."/>. ROS 2 loads nothing.',
)
UNKNOWN_LINK = rejects(
    "URDF071",
    "A joint that names a link which does not exist",
    "Names are compared letter by letter, case included. ROS 2 loads nothing.",
)
DEFAULT_AXIS = notes(
    "URDF072",
    "A moving joint without an axis",
    "ROS 2 takes the x axis (1 0 0) of the joint's frame. Say which axis is meant.",
)
ZERO_AXIS = warns(
    "URDF073",
    "A joint axis of length zero",
    "ROS 2 loads the file, but the pose of everything behind this joint is undefined (NaN), and TF drops it. An <axis> "
    "without xyz is 0 0 0, too.",
)
SCALED_AXIS = notes(
    "URDF074",
    "A joint axis whose length is not 1",
    "Only the direction counts: ROS 2 normalises the axis, so its length changes no speed and no distance.",
)
EMPTY_RANGE = warns(
    "URDF075",
    "Joint limits that leave nothing to move",
    "lower and upper default to 0 and ROS 2 does not check them: a joint whose lower limit is not below its upper one cannot "
    "be moved by its sliders and controllers.",
)
MIMIC_TARGET = warns(
    "URDF076",
    "A mimic of a joint that does not exist, or of itself",
    "ROS 2 loads the file, but nothing ever moves this joint, and robot_state_publisher does not publish its pose.",
)
UNPUBLISHED_JOINT = notes(
    "URDF077",
    "A floating or planar joint",
    "robot_state_publisher does not publish floating joints and treats planar ones as fixed: something else has to publish "
    "the transform.",
)
NEGATIVE_SIZE = warns(
    "URDF078",
    "A size below zero",
    "ROS 2 does not check sizes. What is shown for a negative one depends on the program that draws it.",
)
TWO_ROOTS = rejects(
    "URDF080",
    "Links that are not joined to the rest",
    "All links must form one tree: every link but one is the child of a joint. ROS 2 finds several roots and loads nothing. "
    "Add the missing joint, or mend the link names in the joints.",
    is_consequence=True,
)
NO_ROOT = rejects(
    "URDF081",
    "A tree without a root",
    "Every link is the child of some joint, so the links form a loop, and ROS 2 finds nowhere to begin. One link, the root, "
    "must not be the child of any joint.",
    is_consequence=True,
)
CYCLE = rejects(
    "URDF082",
    "A loop of joints",
    "Following the joints from parent to child comes back to the same link. robot_state_publisher follows the loop for ever "
    "and crashes. A robot in a URDF is a tree.",
)
DETACHED_CYCLE = drops(
    "URDF083",
    "Links on a loop apart from the robot",
    "These links form a loop that is not joined to the root. ROS 2 loads the file, but they are not in the tree and not shown.",
    detaches_links=True,
)
TWO_PARENTS = warns(
    "URDF084",
    "A link that two joints claim as their child",
    "ROS 2 loads the file; the joint that comes last in the alphabet holds the link, the others have no effect on it.",
)
TOO_MANY_PATHS = rejects(
    "URDF085",
    "A tree that branches and meets again too often",
    "Links with two parents are visited once for every path that leads to them. Here the paths are so many that ROS 2 does "
    "not finish loading.",
)
REPEATED_ELEMENT = notes(
    "URDF090",
    "An element that may stand only once",
    "Of several <origin>, <geometry>, <parent>, <child> or the like in one place the first counts; ROS 2 ignores the others.",
)
MISSPELT = notes(
    "URDF091",
    "A tag or attribute that ROS 2 does not know and ignores",
    "Unknown names are skipped in silence. This one looks like a misspelling of a known one.",
)
DEGREES = warns(
    "URDF092",
    "An angle that looks like degrees",
    "rpy is in radians: 90 degrees are 1.5708, 180 degrees 3.1416.",
)
ROOT_INERTIA = notes(
    "URDF093",
    "A root link with an inertia",
    "robot_state_publisher warns of it, because KDL ignores the inertia of the root. Use a root link without one, such as "
    "base_footprint.",
)
COMMENT_TRAP = notes(
    "URDF094",
    "A comment that can break a launch file",
    "Where a launch file passes robot_description without ParameterValue(..., value_type=str), ROS 2 reads the URDF as YAML, "
    "and a comment with a colon and a space, or with a tab, stops the launch.",
)
UNLISTED = notes(
    "URDF099",
    "More problems than are listed",
    "Only the first thousand problems of a file are listed. Mend these first; many of the others may go with them.",
)

CATALOGUE = kinds_in([*vars(xml_catalogue).values(), *globals().values()])
