"""The harnesses by name, each with its seeds, its dictionary and the size of its inputs."""

from functools import partial

from tests.fuzz import classes, documents, packages, robots, seeds, submissions
from tests.fuzz.harness import Harness

_XML = (
    *("<!--", "-->", "<![CDATA[", "]]>", "<?xml version='1.0'?>", "&#65;", "&#x0;", "&amp;", "&lt;", "&x;", "xmlns='u'", "\0"),
    *("<!DOCTYPE r>", "\ufeff", "\u2028", "'", '"', "/>", "</", "=", "\r\n", "\t"),
)
_URDF = (
    *('<link name="a"/>', "<visual>", "<collision>", "<inertial>", "<geometry>", '<mass value="1"/>', '<sphere radius="1"/>'),
    *('<box size="1 1 1"/>', '<cylinder radius="1" length="1"/>', '<mesh filename="a.stl" scale="1 1 1"/>', '<mimic joint="j"/>'),
    *('<origin xyz="0 0 0" rpy="0 0 0"/>', '<axis xyz="0 0 1"/>', '<limit effort="1" velocity="1" lower="0" upper="1"/>'),
    *('<joint name="j" type="fixed">', '<parent link="a"/>', '<child link="a"/>', '<color rgba="1 0 0 1"/>', "planar", "floating"),
    *('<material name="m"/>', "base_link", "prismatic", "<safety_controller", "<calibration", "<gazebo>", "<transmission>"),
)
_XACRO = (
    *('<xacro:property name="a" value="1"/>', '<xacro:macro name="m" params="a b:=1 *c **d">', "<xacro:m/>", "${a}", "$(arg a)"),
    *('<xacro:include filename="b.xacro" ns="n"/>', '<xacro:if value="${a}">', "<xacro:unless", '<xacro:insert_block name="c"/>'),
    *('<xacro:arg name="a" default="1"/>', "$(find my_robot)", "${xacro.load_yaml('a.yaml')}", '<xacro:call macro="m"/>', "$${"),
    *('<xacro:element xacro:name="a"/>', '<xacro:attribute name="a" value="1"/>', "lazy_eval='false'", "scope='parent'", "$(eval 1)"),
)
_EXPRESSION = (
    *("lambda x: x", "[x for x in", "range(9)", "**", "//", "%", "<<", "'%s' %", "if 1 else 2", "not", "and", "in", "is", "dict("),
    *("math.pi", "sin(", "python.str(", "sorted(", "max(", "round(", "len(", "int(", "float(", "a", "b", "c", "d", "e", "[::-1]"),
    *(".split()", ".join(", ".format(", "f'{a}'", "1e308", "inf", "0x1f", "xacro.tokenize(", "{**e}", "*d", ":=", "1j", "{1: 2}"),
)
_PYTHON = (
    *("import os", "from glob import glob", "from setuptools import setup", "os.path.join(", "data_files=[", "('share/', ['a'])"),
    *("for x in", "while True:", "if __name__ == '__main__':", "try:", "except:", "def f(*a, **k):", "return", "lambda:", "with open("),
    *("yield", "class A:", "global x", "del x", "raise", "match x:", "case _:", "async", "f'{x!r:>{y}}'", "x[1:2] = y", "@d"),
    *("Path(__file__).parent", "os.walk('.')", "glob('urdf/*', recursive=True)", "print(", "exit()", "package_name", "**kwargs"),
)
_LAUNCH = (
    *("LaunchDescription([", "Node(package='a', executable='b'", "generate_launch_description", "get_package_share_directory("),
    *("Command(['xacro ', x])", "LaunchConfiguration('a')", "DeclareLaunchArgument('a', default_value='b')", "OpaqueFunction("),
    *("IncludeLaunchDescription(", "IfCondition(", "PathJoinSubstitution([", "FindPackageShare('my_robot')", "parameters=[{"),
    *("robot_state_publisher", "robot_description", "frame_prefix", "FindExecutable(name='xacro')", "GroupAction(", "TimerAction("),
)
_FRONTEND = (
    *("$(find-pkg-share my_robot)", "$(var a)", "$(env HOME)", "$(command 'xacro x')", "$(eval '1+1')", "$(dirname)", "$(if 1 2)"),
    *("<node pkg='a' exec='b'>", "<param name='a' value='b'/>", "<include file='a'/>", "<arg name='a' default='b'/>", "<let"),
    *("<group>", "if='true'", "unless='$(var a)'", "<executable cmd='ls'/>", "<set_env", "$(not true)", "$(equals 1 2)"),
)
_YAML = ("&a", "*a", "<<: *a", "- ", ": ", "!!str ", "|", ">-", "{a: b}", "[1, 2]", "---", "...", "#", "? ", "true", "null", "\u2028", "\ufeff")

_MARKDOWN = (
    *("# Task 1 Step 15", "## Step 2", "**REQUIRED Question:**", "Answer 2:", "Q1", "1.", "2)", "- ", "| a |", "```", "===", "\x0c"),
    *("\ufffc", "[picture]", "<b>", "<!--", "Task 2", "task 1 step 15", "> ", "# 24.5 / 30 points: lab6", "\u2028", "\ufeff", "nodes"),
)
_TOML = (
    *('"""', "'''", "[[criterion]]", "[[part]]", "[late]", "check = \"shows_box\"", "with = {", "requires = [", "points = ", "a.b.c = 1"),
    *("[[evidence]]", "[[carried]]", "[test]", "1_000", "0x1f", "1979-05-27", "inf", "nan", "true", "at = {", "bonus = true", "hints = "),
    *("[adjust]", "\ufeff", "“", "# ", "{}", "[]", "link = ", "tolerance = ", "size = [1, 1, 1]", "reference = ", "package = "),
)
_CSV = (",", ";", "\t", '"', '""', "\r\n", "\r", "\ufeff", "sep=;", "=1+1", "@", "id", "name", "email", "Student", "\0", "é", "\u202e", "Ash, Ann")
_HTTP = (
    *("GET /t/1 HTTP/1.1\r\n", "POST /t/1 HTTP/1.1\r\n", "Host: 127.0.0.1:80\r\n", "Origin: http://127.0.0.1:80\r\n", "\r\n\r\n"),
    *("Content-Length: 9\r\n", "Transfer-Encoding: chunked\r\n", "Content-Type: application/json\r\n", "Expect: 100-continue\r\n"),
    *("Connection: keep-alive\r\n", "Sec-Fetch-Site: cross-site\r\n", "/t/", "/t/end", "/picture/1", "/report", "?", "#", "%2e%2e", "HTTP/0.9"),
    *('{"do":"next"}', '"points":', '"comment":', '"shown":', '"item":', "PUT", "DELETE", "HEAD", "\r\n ", "\x85", "999999999999"),
)

HARNESSES: dict[str, Harness] = {
    "urdf": Harness(robots.urdf, (), (*_XML, *_URDF), 1024, seeds.urdfs),
    "inspection": Harness(robots.inspection, ("rubrics/**/*.urdf",), _URDF, 3072, seeds.urdfs),
    "tinyxml2": Harness(robots.tinyxml2, (), (*_XML, *_URDF), 512, seeds.urdfs),
    "syntax": Harness(robots.syntax, ("rubrics/**/*.xacro",), (*_XML, *_URDF), 2048, seeds.broken),
    "xacro": Harness(robots.xacro, ("rubrics/**/*.xacro", "submissions/*/*.xacro"), (*_XACRO, *_EXPRESSION, "\n=== urdf/b.xacro\n", "\n=== urdf/a.yaml\n"), 1536, seeds.xacro),
    "expressions": Harness(robots.expressions, (), _EXPRESSION, 200, seeds.expressions),
    "yaml-values": Harness(robots.yaml_values, (), (*_YAML, "!degrees 90", "!radians a*2", "1_000", "0x1f", "1:30", ".nan", "~"), 512, seeds.yaml_files),
    "setup": Harness(packages.setup, ("tests/package/setup_samples/*", "rubrics/**/setup.py"), _PYTHON),
    "launch-py": Harness(packages.LAUNCHES["py"], ("tests/package/launch_samples/*.py.txt", "rubrics/**/*.launch.py"), (*_PYTHON, *_LAUNCH)),
    "launch-xml": Harness(packages.LAUNCHES["xml"], ("tests/package/launch_samples/*.xml.txt",), (*_XML, *_FRONTEND)),
    "launch-yaml": Harness(packages.LAUNCHES["yaml"], ("tests/package/launch_samples/*.yaml.txt",), (*_YAML, *_FRONTEND)),
    "cmake": Harness(packages.cmake, ("submissions/**/CMakeLists.txt",), ("install(DIRECTORY", "DESTINATION", "${PROJECT_NAME}", "#[[", "]]", "if(", "endif()", "set(a", "foreach(", "ament_auto_package(INSTALL_TO_SHARE", "share/", "FILES", "return()")),
    "manifest": Harness(packages.manifest, ("rubrics/**/package.xml", "submissions/*/package.xml"), (*_XML, "<name>", "<export>", "<build_type>", "ament_python")),
    "rviz": Harness(packages.rviz, ("rubrics/**/*.rviz", "submissions/*/*.rviz"), (*_YAML, "Visualization Manager:", "Displays:", "Class: rviz_default_plugins/TF", "Enabled: true", "Fixed Frame:")),
    "yaml": Harness(packages.yaml, ("tests/package/launch_samples/*.yaml.txt",), _YAML, 2048),
    "archive": Harness(documents.archive, (), ("PK\x03\x04", "PK\x01\x02", "PK\x05\x06", "ustar", "../", "/etc/passwd", "GNUSparse", "path=", "\x1f"), 4096, documents.archives),
    "class-zip": Harness(documents.class_zip, (), ("_LATE_", "_assignsubmission_file_", "submitted/", ".zip", "__MACOSX/", "-1", "(1)", "../"), 4096, documents.classes),
    "answers": Harness(documents.answers, ("submissions/*/answers.md",), _MARKDOWN, 1024, documents.documents),
    "names": Harness(documents.names, (), ("Task1_Step8.png", "task 3", "webcam", " (1)", ".jpeg", "/", "step", "T1S8", "prelab", "_", ".pdf", "Schritt"), 512, lambda: [b"Task1_Step8.png\nTask 1/step18 (2).jpg\nT2S6.PNG\nwebcm.gif\na/b/camera.pdf\nstep 3.png"]),
    "picture": Harness(documents.picture, (), ("IHDR", "Exif", "VP8X", "II*", "MM", "<svg", "ftypheic"), 512, documents.pictures),
    "rubric": Harness(classes.rubric, (), _TOML, 8192, classes.rubrics),
    "roster": Harness(classes.roster, (), _CSV, 1024, classes.rosters),
    **{name: Harness(run, (), (*_CSV, "EX", "n/a", "Points Possible", "11.00", "11,00", "Username", "Section"), 2048, classes.LMS_SEEDS[name]) for name, run in classes.LMS.items()},
    "requests": Harness(classes.requests, (), _HTTP, 1024, classes.sent_requests),
    "grade-lab6": Harness(partial(submissions.urdf, rubric="lab6"), ("rubrics/lab6/**/*.urdf", "submissions/*/my_robot.urdf"), (*_XML, *_URDF)),
    "grade-arm": Harness(partial(submissions.urdf, rubric="arm"), ("rubrics/arm/*.urdf", "submissions/arm-*/*.urdf", "submissions/equivalent-arm-*/*.urdf"), (*_XML, *_URDF), 6144),
    "grade-package": Harness(partial(submissions.package, rubric="lab6"), ("rubrics/lab6", "submissions/reference"), (*_XML, *_URDF, *_PYTHON, *_LAUNCH), 16384),
    "grade-xacro": Harness(partial(submissions.package, rubric="sensors"), ("rubrics/sensors", "submissions/sensors-*", "submissions/equivalent-sensors-*"), (*_XML, *_URDF, *_XACRO, *_LAUNCH), 12288),
}  # fmt: skip
