"""The repositories of the class, one row each, with the reason for it."""

from typing import NamedTuple

Extra = tuple[str, str]  # a key of EXTRAS, and the folder that it is put into


class Work(NamedTuple):
    """A robot: the sample that it is, its spelling and its path; its package, and the file that the launch file runs xacro on.

    `installed_as` is the name that setup.py and the launch file give the package, if it is another one than that of package.xml.
    `lost` are the criteria of Task 2 that fail, and `unknown` others that do not pass. Without a package nothing passes.
    """

    sample: str
    path: str
    spelling: str = "plain"
    package: str | None = None
    launched: str = ""
    package_name: str = "my_robot"
    installed_as: str = ""
    lost: tuple[str, ...] = ()
    unknown: tuple[str, ...] = ()


class Row(NamedTuple):
    """A repository: its name, the reason for it, the robot of each student (by the folder, empty if there is one student), the rest."""

    name: str
    about: str
    works: dict[str, Work] = {}
    extras: tuple[Extra, ...] = ()
    zipped: str = ""  # the folder that is submitted as a zip
    undecided: tuple[
        str, ...
    ] = ()  # criteria of Task 1 that need manual grading for lack of a file
    failed: tuple[str, ...] = ()  # criteria of Task 1 that the spelling costs


def one(
    sample: str,
    path: str,
    spelling: str = "plain",
    package: str | None = None,
    launched: str = "",
    **more: object,
) -> dict[str, Work]:
    """Return the robot of the only student."""
    return {"": Work(sample, path, spelling, package, launched, **more)}  # type: ignore[arg-type]


SRC = "roscourse_sim_ws/src/my_robot"
URDF = "urdf/my_robot.urdf"
MIRRORED, BURIED, LOW, INSIDE = (
    "right-wheel-mirrored",
    "lidar-buried",
    "footprint-too-low",
    "wheel-inside-base",
)
VISUAL, GREEN, BACK, MISSING = (
    "lidar-offset-in-visual",
    "green-0-1-0",
    "caster-at-the-back",
    "footprint-missing",
)
AXIS, ALONG_X, SWAPPED, TRUNCATED = (
    "axis-for-the-z-up-wheel",
    "wheel-axes-along-x",
    "base-size-swapped",
    "truncated-file",
)
SEVERAL, CENTRES, MACRO_FILE = (
    "several-mistakes",
    "equivalent-wheel-joints-at-centres",
    "my_robot.urdf.xacro",
)

ROWS = (
    # The workspace at the root of the repository.
    Row(
        "alder",
        "the handout, followed to the letter",
        one("reference", f"{SRC}/{URDF}", package=SRC),
        (("pictures", ""), ("answers", "")),
    ),
    Row(
        "ash",
        "a mistake of many, with a build that was committed",
        one(MIRRORED, f"{SRC}/{URDF}", package=SRC),
        (("stale build", "roscourse_sim_ws"), ("pictures", "evidence")),
    ),
    Row(
        "aspen",
        "the package is at the root of the repository",
        one(BURIED, URDF, package=""),
        (("readme", "docs"), ("git", "")),
    ),
    Row(
        "bamboo",
        "xacro that the launch file expands",
        one(LOW, f"{SRC}/urdf/{MACRO_FILE}", "inertial", SRC, MACRO_FILE),
        (("pdf", ""),),
    ),
    Row(
        "banyan",
        "xacro in a .urdf that the launch file expands",
        one(INSIDE, f"{SRC}/{URDF}", "inertial", SRC, "my_robot.urdf"),
        (("docx", ""),),
    ),
    Row(
        "baobab",
        "a macro for the wheels",
        one("reference", f"{SRC}/urdf/{MACRO_FILE}", "wheel", SRC, MACRO_FILE),
        (("pictures", "Task 1"),),
    ),
    Row(
        "beech",
        "macros in a file beside it",
        one(VISUAL, f"{SRC}/urdf/{MACRO_FILE}", "including", SRC, MACRO_FILE),
        (("box", f"{SRC}/urdf"),),
    ),
    Row(
        "birch",
        "macros from $(find my_robot)",
        one(
            GREEN,
            f"{SRC}/urdf/{MACRO_FILE}",
            "finding",
            SRC,
            MACRO_FILE,
            lost=("launch-finds-files",),
        ),
    ),
    Row(
        "bonsai",
        "a main file that only includes others",
        one(BACK, f"{SRC}/urdf/{MACRO_FILE}", "parts", SRC, MACRO_FILE),
    ),
    Row(
        "boxwood",
        "a plain URDF generated from the xacro beside it",
        one(AXIS, f"{SRC}/{URDF}", "generated", SRC),
        (("webots", "webots_ws/src/my_world"),),
    ),
    # A folder of the lab.
    Row(
        "buckeye",
        "the lab's folder holds the workspace",
        one(ALONG_X, f"Lab6/{SRC}/{URDF}", package=f"Lab6/{SRC}"),
        (("another package", "Lab7/my_robot"), ("pictures of another lab", "Lab7")),
    ),
    Row(
        "catalpa",
        "lab6/<login>/lab",
        one(MISSING, f"lab6/catalpa/lab/{URDF}", package="lab6/catalpa/lab"),
        (("pictures", "lab6/catalpa"),),
    ),
    Row(
        "cedar",
        "Lab6/<name>, and a later lab beside it",
        one(SWAPPED, "Lab6/Cedar/my_robot.urdf"),
        (("another version", "Lab_7/Cedar"), ("pdf", "Lab6/Cedar")),
    ),
    Row(
        "cherry",
        "another spelling of the folder",
        one(TRUNCATED, "Lab 06/my_robot.urdf"),
        (("another version", "Lab 05"), ("another version", "lab7")),
    ),
    Row(
        "chestnut",
        "several labs, xacro with an odd name",
        one(BURIED, "Lab6/urdf.xacro file", "inertial"),
        (("another version", "Lab7/urdf"), ("loosely named pictures", "Lab6")),
    ),
    Row(
        "cork",
        "the xacro file of the handout, saved as Python",
        one(MIRRORED, "Lab6/Cork/urdf.xacro file.py", "numbers"),
        (("pdf", "Lab6/Cork"), ("another package", "Lab_7/my_robot")),
    ),
    Row(
        "cypress",
        "the same, saved as text",
        one(LOW, "Lab6/urdf.Xacro file.txt", "inertial"),
        (("docx", "Lab6"),),
    ),
    Row(
        "dogwood",
        "completed_urdf.xacro.txt",
        one("reference", "lab_6/completed_urdf.xacro.txt", "wheel"),
        (("pictures", "lab_6"),),
    ),
    Row(
        "ebony",
        "no extension",
        one(INSIDE, "lab6/my_robot"),
        (("readme", ""), ("pictures", "lab6")),
    ),
    Row("elder", "capitals", one(VISUAL, "LAB6/My_Robot.URDF", "in_other_words")),
    Row(
        "elm",
        "a final project with other packages at the root",
        one(GREEN, f"Lab6/{URDF}", package="Lab6"),
        (("final project", "final_project/src"), ("final project", "FinalProject")),
    ),
    Row(
        "fig",
        "a final project beside a lone URDF",
        one(BACK, "Lab6/my_robot.urdf"),
        (("final project", "src"),),
    ),
    Row(
        "fir",
        "a backup that is less deep than the robot",
        one(AXIS, f"Lab6/ws/src/my_robot/{URDF}", package="Lab6/ws/src/my_robot"),
        (("another version", "Lab6/backup"), ("another version", "Lab6/old")),
    ),
    Row(
        "ginkgo",
        "a zip in the lab's folder",
        one(ALONG_X, f"Lab6/my_robot/{URDF}", package="Lab6/my_robot"),
        (("macOS", "Lab6"), ("pictures", "Lab6")),
        zipped="Lab6",
    ),
    Row(
        "guava",
        "what macOS adds",
        one(MISSING, f"Lab6/{URDF}", package="Lab6"),
        (("macOS", "Lab6"),),
    ),
    Row(
        "gum",
        "a robot of several mistakes in xacro numbers",
        one(SEVERAL, "Lab6/my_robot.xacro", "numbers"),
        (("answers", "Lab6"),),
    ),
    Row(
        "hawthorn",
        "the package has another name",
        one(
            SWAPPED,
            f"{SRC}/{URDF}",
            package=SRC,
            package_name="hawthorn_robot",
            lost=("package-found",),
            unknown=("launch-nodes", "launch-finds-files"),
        ),
    ),
    Row(
        "hazel",
        "a launch file without extension",
        one(
            BURIED,
            f"Lab6/my_robot/{URDF}",
            package="Lab6/my_robot",
            lost=("launch-found", "setup-installs-launch"),
        ),
        (("pdf", "Lab6"),),
    ),
    Row(
        "hemlock",
        "joints at the centres of the wheels, with macros",
        one(CENTRES, f"{SRC}/urdf/{MACRO_FILE}", "inertial", SRC, MACRO_FILE),
    ),
    Row(
        "hickory",
        "a .urdf with xacro in it that nothing expands: ROS 2 rejects it",
        one(MIRRORED, f"Lab6/{URDF}", "inertial"),
        failed=("urdf-loads",),
    ),
    Row(
        "holly",
        "the included file was not submitted",
        one(LOW, "Lab6/my_robot.urdf.xacro", "unsubmitted"),
        failed=("urdf-loads",),
    ),
    Row(
        "ivy",
        "macros from a package of the course",
        one(INSIDE, "Lab6/my_robot.urdf.xacro", "elsewhere"),
        undecided=("urdf-loads",),
    ),
    Row(
        "juniper",
        "a part is named like the robot, the main file is not",
        one(VISUAL, "Lab6/Juniper/robot.urdf.xacro", "named_parts"),
    ),
    Row(
        "larch",
        "the included file sorts before the main one",
        one(GREEN, "Lab6/robot.urdf.xacro", "including"),
    ),
    Row(
        "laurel",
        "the main file includes its parts, in a folder of xacro",
        one(BACK, "Lab6/xacro/robot.urdf.xacro", "parts"),
    ),
    Row(
        "lilac",
        "$(find my_robot) of a package that was not submitted",
        one(AXIS, "Lab6/urdf/urdf.xacro file", "finding"),
    ),
    Row(
        "linden",
        "workspace, stale build, later labs, and a whole package as a backup",
        one(ALONG_X, f"Lab6/{SRC}/{URDF}", package=f"Lab6/{SRC}"),
        (
            ("stale build", "Lab6/roscourse_sim_ws"),
            ("another package", "Lab8/my_robot"),
            ("another package", "Lab6/backup/my_robot"),
        ),
    ),
    Row(
        "locust",
        "only another lab's folder, whose robot is the one of this lab",
        one(MISSING, f"Lab7/{URDF}", package="Lab7"),
    ),
    Row(
        "magnolia",
        "the robot is outside the lab's folder, which holds pictures",
        one(SWAPPED, f"ros2_ws/src/my_robot/{URDF}", package="ros2_ws/src/my_robot"),
        (("pictures", "Lab6"), ("pictures of another lab", "Lab5")),
    ),
    Row(
        "mahogany",
        "Webots and the box of the prelab beside the lab",
        one("reference", f"Lab6/my_robot/{URDF}", package="Lab6/my_robot"),
        (("webots", "webots_ws/src/my_world"), ("box", "Prelab6"), ("box", "Lab6")),
    ),
    Row(
        "mango",
        "the robot is called otherwise, in a package that is not",
        one(
            BURIED,
            f"{SRC}/urdf/wheeled_base.urdf",
            package=SRC,
            lost=("launch-nodes", "launch-finds-files"),
        ),
    ),
    Row(
        "maple",
        "a plain URDF in a xacro file, and an old one at the path of the handout",
        one(MIRRORED, "Lab6/my_robot.urdf.xacro"),
        (("another version", "Lab6/old/urdf"),),
    ),
    Row(
        "mimosa",
        "xacro that the launch file expands, from $(find my_robot)",
        one(
            LOW,
            f"{SRC}/urdf/{MACRO_FILE}",
            "finding",
            SRC,
            MACRO_FILE,
            lost=("launch-finds-files",),
        ),
        (("stale build", "roscourse_sim_ws"),),
    ),
    Row(
        "mulberry",
        "the lab's folder has the login in its name",
        one(INSIDE, f"lab6-mulberry/{URDF}", package="lab6-mulberry"),
        (("another version", "lab5-mulberry"),),
    ),
    # No robot.
    Row("myrtle", "pictures only", extras=(("pictures", "Lab6"),)),
    Row(
        "nutmeg",
        "pictures with other names",
        extras=(
            ("loosely named pictures", "Lab6/Nutmeg"),
            ("another package", "Final Project/Nutmeg/my_robot"),
        ),
    ),
    Row("oak", "one PDF with headings", extras=(("pdf", "Lab6"), ("readme", ""))),
    Row("oleander", "one Word file with headings", extras=(("docx", "lab6/oleander/lab"),)),
    Row(
        "olive",
        "a PDF, and the worlds of another lab",
        extras=(("pdf", "Lab6"), ("webots", "Lab4")),
    ),
    Row(
        "palm",
        "pictures, and a final project with another robot",
        extras=(("pictures", "Lab6"), ("final project", "Final Project")),
    ),
    Row("pear", "nothing of this lab but a README", extras=(("readme", ""),)),
    # Several students.
    Row(
        "team-pine",
        "two students with a package each",
        {
            "Lab6/Pine": Work(
                "reference", f"Lab6/Pine/my_robot/{URDF}", package="Lab6/Pine/my_robot"
            ),
            "Lab6/Plum": Work(MIRRORED, f"Lab6/Plum/my_robot/{URDF}", package="Lab6/Plum/my_robot"),
        },
        (
            ("pictures", "Lab6/Pine"),
            ("pdf", "Lab6/Plum"),
            ("another package", "Lab7/Pine/my_robot"),
        ),
    ),
    Row(
        "team-poplar",
        "two students with xacro under odd names",
        {
            "Lab6/Poplar": Work(BURIED, "Lab6/Poplar/urdf.xacro file", "inertial"),
            "Lab6/Quince": Work(LOW, "Lab6/Quince/urdf.xacro file.py", "wheel"),
        },
        (("pdf", "Lab6/Poplar"), ("loosely named pictures", "Lab6/Quince")),
    ),
    Row(
        "team-redwood",
        "logins with a folder lab, three students",
        {
            "lab6/redwood": Work(VISUAL, f"lab6/redwood/lab/{URDF}", package="lab6/redwood/lab"),
            "lab6/rowan": Work(GREEN, "lab6/rowan/lab/my_robot.urdf.xacro", "numbers"),
            "lab6/sandal": Work(BACK, "lab6/sandal/lab/my_robot", "plain"),
        },
        (("readme", ""), ("final project", "project")),
    ),
    Row(
        "team-spruce",
        "workspaces with a stale build, and labs before and after",
        {
            "Lab6/Spruce": Work(
                AXIS, f"Lab6/Spruce/ws/src/my_robot/{URDF}", package="Lab6/Spruce/ws/src/my_robot"
            ),
            "Lab6/Sumac": Work(
                INSIDE,
                f"Lab6/Sumac/ws/src/my_robot/urdf/{MACRO_FILE}",
                "including",
                "Lab6/Sumac/ws/src/my_robot",
                MACRO_FILE,
            ),
        },
        (
            ("stale build", "Lab6/Spruce/ws"),
            ("another version", "Lab5/Spruce"),
            ("another version", "Lab_7/Sumac"),
        ),
    ),
    # One student again, with traces of versions and of several machines.
    Row(
        "sycamore",
        "versions in dated folders",
        one(ALONG_X, "Lab6/my_robot/my_robot.urdf"),
        (("another version", "Lab6/my_robot/old"), ("readme", "Lab6")),
    ),
    Row(
        "tamarind",
        "a workspace with another package beside it",
        one(SEVERAL, f"ws/src/my_robot/{URDF}", package="ws/src/my_robot"),
        (("final project", "ws/src"),),
    ),
    Row(
        "teak",
        "a zip of a workspace with its build",
        one(MISSING, f"ws/src/my_robot/{URDF}", package="ws/src/my_robot"),
        (("stale build", "ws"), ("macOS", "ws")),
        zipped="ws",
    ),
    Row(
        "walnut",
        "xacro numbers in the package's URDF, opened without xacro",
        one(SWAPPED, f"{SRC}/{URDF}", "numbers", SRC),
        failed=("urdf-loads",),
    ),
    Row(
        "hornbeam",
        "typographic quotes in one joint",
        one("smart-quotes", "Lab6/my_robot.urdf"),
        (("another version", "Lab5"),),
    ),
    Row("tupelo", "a tag that is not closed", one("tag-not-closed", f"{SRC}/{URDF}", package=SRC)),
    Row(
        "whitebeam",
        "setup.py and the launch file have another name for the package",
        one(
            BURIED,
            f"{SRC}/{URDF}",
            package=SRC,
            installed_as="my_robots",
            lost=(
                "package-found",
                "setup-installs-urdf",
                "setup-installs-launch",
                "setup-installs-rviz",
            ),
        ),
    ),
    Row(
        "yew",
        "pictures, and the robot of the prelab",
        extras=(("pictures", "Lab6"), ("prelab", "Lab6")),
    ),
    Row(
        "zelkova",
        "pictures, and the robot in a later lab, without its package",
        one(BURIED, "Lab7/Zelkova/my_robot.urdf"),
        (("pictures", "Lab6/Zelkova"),),
    ),
    Row(
        "willow",
        "a README of an answer, and the robot as a plain file at the root",
        one(TRUNCATED, "my_robot.urdf"),
        (("answers", ""), ("loosely named pictures", "")),
    ),
)
