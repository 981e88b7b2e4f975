"""The package, and the files that a build by its setup.py would install."""

import pytest

from grader.checks.installs import build_installs, installs_files, setup_imports
from grader.checks.package import package_found, package_type
from grader.source import Location
from tests.checks.outcomes import finds, graded, lacks
from tests.checks.submissions import (
    FOLDER,
    LAUNCH,
    MANIFEST,
    REFERENCE,
    RVIZ,
    SETUP,
    URDF,
    Submitted,
    png,
    start_of,
)

KINDS = {"urdf": "my_robot.urdf", "launch": "my_robot_rviz.launch.py", "rviz": "my_robot.rviz"}
SOURCES = {"urdf": "urdf/my_robot.urdf", "launch": "launch/my_robot_rviz.launch.py", "rviz": "rviz/my_robot.rviz"}
INSTALLED = {
    "urdf": "share/my_robot/my_robot.urdf",
    "launch": "share/my_robot/launch/my_robot_rviz.launch.py",
    "rviz": "share/my_robot/my_robot.rviz",
}
ENTRY = "(os.path.join('share', package_name), glob('{}/*')),"
URDF_ENTRY, RVIZ_ENTRY = ENTRY.format("urdf"), ENTRY.format("rviz")
LAUNCH_ENTRY = "(os.path.join('share', package_name, 'launch'), glob(os.path.join('launch', '*launch.[pxy][yma]*'))),"
LAUNCH_GLOB = "glob(os.path.join('launch', '*launch.[pxy][yma]*'))"
STOPS = "the build stops here: "

every_kind = pytest.mark.parametrize("kind", KINDS)


def setup(old: str, new: str, of: Submitted = REFERENCE) -> Submitted:
    """Return a submission with another text in its setup.py."""
    return of.replacing(SETUP, old, new)


def manifest(old: str, new: str) -> Submitted:
    """Return the reference with another text in its package.xml."""
    return REFERENCE.replacing(MANIFEST, old, new)


def statuses(submitted: Submitted) -> dict[str, str]:
    """Return the status for each kind of file, or what is missing."""
    found: dict[str, str] = {}
    for kind, name in KINDS.items():
        try:
            found[kind] = finds(build_installs, submitted, kind=kind, name=name)[0]
        except LookupError as error:
            found[kind] = str(getattr(error, "kind", error))
    return found


# --- The package ------------------------------------------------------------------------------------------------------


TOP = Submitted({path.removeprefix("my_robot/"): content for path, content in REFERENCE.files.items()})
HELPERS = {"a_helpers/package.xml": manifest(">my_robot<", ">helpers<").files[MANIFEST], "a_helpers/setup.py": ""}


@pytest.mark.parametrize(
    ("submitted", "name"),
    [
        (REFERENCE, "my_robot"),
        (REFERENCE.renaming(FOLDER, "ros2_ws/src/my_robot"), "my_robot"),
        (REFERENCE.renaming(FOLDER, "lab6_final"), "my_robot"),
        (TOP, "my_robot"),
        (manifest(">my_robot<", ">\n  my_robot\n  <"), "my_robot"),
        (REFERENCE.with_files(HELPERS), "my_robot"),
        (manifest("<name>my_robot</name>", "<name>my_robt</name>"), "my_robt"),
        (manifest("<name>my_robot</name>", "<name>My_Robot</name>"), "My_Robot"),
    ],
    ids=["reference", "deeper", "other-folder", "top", "blanks", "several", "misspelt", "case"],
)
def test_the_package_of_the_lab_is_found(submitted: Submitted, name: str) -> None:
    """A package of the expected name passes, wherever it is; one with another name fails at that name."""
    found = finds(package_found, submitted, name="my_robot")
    if name == "my_robot":
        assert found == ("passed", "the package is named 'my_robot'", None)
    else:
        message = f"the package is named {name!r}; it should be named 'my_robot'"
        assert found == ("failed", message, submitted.location_of(MANIFEST, "<name>"))


@pytest.mark.parametrize(
    "submitted", [Submitted({"x.png": png()}), Submitted({"my_robot.urdf": REFERENCE.files[URDF]})]
)
def test_a_missing_package_is_reported(submitted: Submitted) -> None:
    """Pictures or a URDF are no package."""
    message = "the submission has no ROS 2 package: there is no package.xml"
    assert lacks(package_found, submitted, name="my_robot") == ("package", "", message, None)


TAG = "package.xml is not readable as XML: Opening and ending tag mismatch: name line 4 and nam"
ROBOT = manifest('<package format="3">', "<robot>").replacing(MANIFEST, "</package>", "</robot>")
NO_XML = "the folder 'my_robot' has a setup.py, but no package.xml, so it is not a ROS 2 package"


@pytest.mark.parametrize(
    ("submitted", "message", "at"),
    [
        (manifest("</name>", "</nam>"), TAG, Location(MANIFEST, 4, 23)),
        (ROBOT, "the root of package.xml is <robot>, not <package>", Location(MANIFEST, 1, 1)),
        (REFERENCE.without(MANIFEST), NO_XML, None),
    ],
    ids=["broken", "robot", "missing"],
)
def test_a_package_xml_that_cannot_be_read(submitted: Submitted, message: str, at: Location | None) -> None:
    """A package.xml that is broken or missing is missed once, under one key, with its location."""
    expected = ("package.xml", "my_robot", message, at)
    assert lacks(package_found, submitted, name="my_robot") == expected
    assert lacks(package_type, submitted, build_type="ament_python") == expected


def test_a_package_xml_that_is_too_large() -> None:
    """It was not read, so it neither passes nor fails."""
    large = REFERENCE.with_files({MANIFEST: str(REFERENCE.files[MANIFEST]) + " " * 1_100_000})
    for check, arguments in ((package_found, {"name": "my_robot"}), (package_type, {"build_type": "ament_python"})):
        outcome = graded(check, large, **arguments)
        assert (outcome.status, "larger than" in outcome.message) == ("pending", True)


def test_a_package_without_name() -> None:
    """A name that is missing or empty fails the check of the name, not that of the build type."""
    none, empty = manifest("  <name>my_robot</name>\n", ""), manifest(">my_robot<", "> <")
    assert finds(package_found, none, name="my_robot") == (
        "failed",
        "package.xml has no <name>",
        none.location_of(MANIFEST, "<package"),
    )
    message = "<name> of package.xml is empty"
    assert finds(package_found, empty, name="my_robot") == ("failed", message, empty.location_of(MANIFEST, "<name>"))
    for files in (none, empty):
        assert finds(package_type, files, build_type="ament_python")[0] == "passed"


CATKIN = "the build type is 'catkin' (ROS 1; also the default without <build_type>); it should be 'ament_python'"


@pytest.mark.parametrize(
    ("old", "new", "message", "at"),
    [
        ("ament_python", "ament_cmake", "the build type is 'ament_cmake'; it should be 'ament_python'", "<build_type>"),
        ("ament_python", "", "<build_type> in package.xml is empty; it should be 'ament_python'", "<build_type>"),
        ("<build_type>ament_python</build_type>", "", CATKIN, "<package format"),
        ("ament_python", "catkin", CATKIN, "<build_type>"),
        ("ament_python", "ament_python", "the build type is 'ament_python'", ""),
        ("ament_python", "\n ament_python ", "the build type is 'ament_python'", ""),
    ],
    ids=["cmake", "empty", "none", "catkin", "same", "blanks"],
)
def test_another_build_type_fails(old: str, new: str, message: str, at: str) -> None:
    """Another build type, or none, fails where it is or should be."""
    submitted = manifest(old, new)
    expected = ("failed", message, submitted.location_of(MANIFEST, at)) if at else ("passed", message, None)
    assert finds(package_type, submitted, build_type="ament_python") == expected


# --- What is installed ------------------------------------------------------------------------------------------------


@every_kind
def test_the_reference_is_installed(kind: str) -> None:
    """The message says which file is installed where."""
    message = f"a build installs {SOURCES[kind]} as {INSTALLED[kind]}"
    assert finds(build_installs, REFERENCE, kind=kind, name=KINDS[kind]) == ("passed", message, None)


LOOP = """\
from glob import glob

from setuptools import setup

package_name = 'my_robot'


def entries():
    found = [('share/ament_index/resource_index/packages', ['resource/' + package_name])]
    found.append(('share/' + package_name, ['package.xml']))
    for folder in ('urdf', 'launch', 'rviz'):
        found += [(f'share/{package_name}/{folder}', glob(f'{folder}/*'))]
    return found


setup(name=package_name, packages=[package_name], data_files=entries())
"""
SHARE = "os.path.join('share', package_name), glob('urdf/*')"
GUARDED = str(REFERENCE.files[SETUP]).replace("\nsetup(", "\nif __name__ == '__main__':\n  setup(")
# However data_files is written, the installed files count.
EQUIVALENT = {
    "reference": REFERENCE,
    "list": setup("glob('urdf/*')", "['urdf/my_robot.urdf']"),
    "name": setup("glob('urdf/*')", "glob('urdf/my_robot.*')"),
    "join": setup("glob('urdf/*')", "glob(os.path.join('urdf', '*'))"),
    "listdir": setup("glob('urdf/*')", "['urdf/' + name for name in os.listdir('urdf')]"),
    "f-string": setup(SHARE, "f'share/{package_name}', glob('urdf/*')"),
    "plus": setup(SHARE, "'share/' + package_name, glob('urdf/*')"),
    "slash": setup(SHARE, "'share/my_robot/', glob('urdf/*')"),
    "module": setup("from glob import glob", "import glob").replacing(SETUP, " glob(", " glob.glob("),
    "nested": setup(URDF_ENTRY, "(os.path.join('share', package_name, 'urdf'), glob('urdf/*')),"),
    "alias": setup("from glob import glob", "import glob as g").replacing(SETUP, " glob(", " g.glob("),
    "loop": REFERENCE.with_files({SETUP: LOOP}),
    "main-guard": REFERENCE.with_files({SETUP: GUARDED}),
    "assert": setup("import os\n", "import os\n\nassert len(str(__file__)) > 0\n"),
    # Another URDF or RViz file is accepted if there is no other, and one of several that may be the URDF is enough.
    "other-names": REFERENCE.renaming(URDF, f"{FOLDER}/urdf/robot.urdf.xacro").renaming(
        RVIZ, f"{FOLDER}/rviz/view.rviz"
    ),
    "xacro-beside": REFERENCE.renaming(URDF, f"{FOLDER}/urdf/robot.urdf").with_files(
        {f"{FOLDER}/xacro/my_robot.xacro": "<robot/>"}
    ),
    "without-package.xml": REFERENCE.without(MANIFEST),
    # A missing import fails only once.
    "no-import-os": setup("import os\n", ""),
    "no-import-glob": setup("from glob import glob\n", ""),
}


@pytest.mark.parametrize("name", EQUIVALENT)
def test_equivalent_packages_are_installed(name: str) -> None:
    """Every kind of file is installed, and every name is defined but for the imports that are missing."""
    assert statuses(EQUIVALENT[name]) == dict.fromkeys(KINDS, "passed")
    found = finds(setup_imports, EQUIVALENT[name])
    assert found == ("passed", "every name that setup.py uses is defined", None) or name.startswith("no-import")


@pytest.mark.parametrize(
    ("kind", "entry"), [("urdf", URDF_ENTRY), ("launch", LAUNCH_ENTRY), ("rviz", RVIZ_ENTRY)], ids=list(KINDS)
)
def test_a_missing_entry_is_reported(kind: str, entry: str) -> None:
    """A file without an entry fails for its kind; the others are installed."""
    submitted = setup(f"        {entry}\n", "")
    message = f"a build does not install {SOURCES[kind]}: no entry of data_files in setup.py names it"
    assert lacks(build_installs, submitted, kind=kind, name=KINDS[kind]) == (f"installed {kind}", FOLDER, message, None)
    assert statuses(submitted) == {**dict.fromkeys(KINDS, "passed"), kind: f"installed {kind}"}


NO_MATCH = "the pattern '{}' in setup.py matches no file{}"
NO_FOLDER = ", because there is no folder '{}'{}"


@pytest.mark.parametrize(
    ("kind", "old", "pattern", "reason"),
    [
        ("urdf", "glob('urdf/*')", "udrf/*", NO_FOLDER.format("udrf", "; did you mean 'urdf'?")),
        ("rviz", "glob('rviz/*')", "rvis/*.rviz", NO_FOLDER.format("rvis", "; did you mean 'rviz'?")),
        ("urdf", "glob('urdf/*')", "urdf/*.udrf", "; there is urdf/my_robot.urdf"),
        ("launch", LAUNCH_GLOB, "launch/*.launch.xml", "; there is launch/my_robot_rviz.launch.py"),
        ("urdf", "glob('urdf/*')", "description/*.urdf", NO_FOLDER.format("description", "")),
    ],
    ids=["folder", "folder-and-ending", "ending", "language", "other-folder"],
)
def test_a_pattern_without_a_match_is_reported(kind: str, old: str, pattern: str, reason: str) -> None:
    """A glob without a match installs nothing, silently: it is reported, with its location, if meant for the file."""
    submitted = setup(old, f"glob('{pattern}')")
    message = f"a build does not install {SOURCES[kind]}: {NO_MATCH.format(pattern, reason)}"
    expected = (f"installed {kind}", FOLDER, message, submitted.location_of(SETUP, f"glob('{pattern}')"))
    assert lacks(build_installs, submitted, kind=kind, name=KINDS[kind]) == expected
    other = setup(URDF_ENTRY, "(os.path.join('share', package_name, 'config'), glob('config/*.yaml')),")
    message = "a build does not install urdf/my_robot.urdf: no entry of data_files in setup.py names it"
    assert lacks(build_installs, other, kind="urdf", name="my_robot.urdf")[2] == message


@pytest.mark.parametrize(
    ("kind", "folder", "message"),
    [
        ("urdf", "my_robot/urdf", "the package has no URDF: no file ends in .urdf or .xacro"),
        ("rviz", "my_robot/rviz", "the package has no RViz file: no file ends in .rviz"),
        (
            "launch",
            "my_robot/launch",
            (
                "the package has no launch file: no file ends in .launch.py, .launch.xml or .launch.yaml, "
                "and there is no folder launch"
            ),
        ),
    ],
    ids=list(KINDS),
)
def test_no_such_file_at_all(kind: str, folder: str, message: str) -> None:
    """If a package has no file of the kind, the file is the missing thing."""
    what = {"urdf": "URDF", "rviz": "RViz file", "launch": "launch file"}[kind]
    expected = (f"{what} in the package", "", message, None)
    assert lacks(build_installs, REFERENCE.without(folder), kind=kind, name=KINDS[kind]) == expected


def test_a_file_that_the_urdf_includes_does_not_count_for_it() -> None:
    """The URDF has another ending than in the handout; only the file that it includes is installed."""
    include = '<robot><xacro:include filename="parts/macros.xacro"/>'
    xacro = REFERENCE.replacing(URDF, '<robot name="my_robot">', include).renaming(URDF, f"{URDF}.xacro")
    xacro = xacro.with_files({f"{FOLDER}/urdf/parts/macros.xacro": "<robot/>"})
    submitted = setup(URDF_ENTRY, "('share/my_robot/urdf/parts', glob('urdf/parts/*')),", xacro)
    assert lacks(build_installs, submitted, kind="urdf", name=KINDS["urdf"])[2].startswith(
        "a build does not install urdf/my_robot"
    )


def test_a_launch_file_of_another_name_is_installed() -> None:
    """The name is graded by another criterion."""
    for name in ("my_robot_rvix.launch.py", "display.launch.py", "my_robot_rviz_launch.py", "my_robot_rviz.launch.xml"):
        submitted = REFERENCE.renaming(LAUNCH, f"my_robot/launch/{name}")
        assert finds(build_installs, submitted, kind="launch", name=KINDS["launch"])[0] == "passed"


def test_a_launch_file_without_extension_does_not_match() -> None:
    """The usual pattern does not match it; glob('launch/*') does."""
    bare = REFERENCE.renaming(LAUNCH, "my_robot/launch/my_robot_rviz")
    message = (
        "a build does not install launch/my_robot_rviz: the pattern 'launch/*launch.[pxy][yma]*' in setup.py matches no file; "
        "there is launch/my_robot_rviz"
    )
    expected = ("installed launch", FOLDER, message, bare.location_of(SETUP, "glob(os.path"))
    assert lacks(build_installs, bare, kind="launch", name=KINDS["launch"]) == expected
    all_files = setup("'*launch.[pxy][yma]*'", "'*'", bare)
    assert finds(build_installs, all_files, kind="launch", name=KINDS["launch"])[0] == "passed"


@pytest.mark.parametrize(
    ("folder", "target"),
    [("'share'", "share/my_robot.urdf"), ("os.path.join('lib', package_name)", "lib/my_robot/my_robot.urdf")],
    ids=["share", "lib"],
)
def test_a_file_installed_elsewhere_fails(folder: str, target: str) -> None:
    """ROS 2 searches share/<package> only."""
    submitted = setup(URDF_ENTRY, f"({folder}, glob('urdf/*')),")
    message = (
        f"a build installs urdf/my_robot.urdf as {target}; ROS 2 looks for the package's files below share/my_robot/"
    )
    expected = ("failed", message, submitted.location_of(SETUP, "glob('urdf/*')"))
    assert finds(build_installs, submitted, kind="urdf", name="my_robot.urdf") == expected


def test_the_name_in_the_resource_index_counts() -> None:
    """ROS 2 finds a package by its entry in the resource index, so another name in package.xml is one fault, not four."""
    other = manifest(">my_robot<", ">robot_lab<")
    assert statuses(other) == dict.fromkeys(KINDS, "passed")
    marker = "        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),\n"
    assert statuses(setup(marker, "", other)) == dict.fromkeys(KINDS, "failed")


NO_FILE = "data_files lists '{}', but there is no such file; did you mean '{}'?"
A_STRING = "data_files lists '{}', but the files of an entry are a string, not a list: write [...] around it"
A_FOLDER = (
    "data_files lists 'urdf/meshes', but it is a folder, and only files can be installed: "
    "a pattern such as '*.urdf' does not match it"
)


@pytest.mark.parametrize(
    ("submitted", "kind", "at", "reason"),
    [
        (setup("glob('urdf/*')", "['urdf/robot.urdf']"), "urdf", "'urdf/robot.urdf'",
         NO_FILE.format("urdf/robot.urdf", "urdf/my_robot.urdf")),
        (REFERENCE.with_files({"my_robot/urdf/meshes/a.stl": "solid"}), "urdf", "glob('urdf/*')", A_FOLDER),
        (setup("glob('rviz/*')", "['rviz/my_robot.rvis']"), "rviz", "'rviz/my_robot.rvis'",
         NO_FILE.format("rviz/my_robot.rvis", "rviz/my_robot.rviz")),
        (setup("glob('rviz/*')", "'rviz/my_robot.rviz'"), "rviz", "'rviz/my_robot.rviz'",
         A_STRING.format("rviz/my_robot.rviz")),
        (setup(LAUNCH_GLOB, "['launch/robot.launch.py']"), "launch", "'launch/robot.launch.py'",
         NO_FILE.format("launch/robot.launch.py", "launch/my_robot_rviz.launch.py")),
    ],
    ids=["no-file", "folder", "misspelt", "no-list", "launch"],
)  # fmt: skip
def test_an_entry_that_stops_the_build_fails_its_own_kind(
    submitted: Submitted, kind: str, at: str, reason: str
) -> None:
    """An entry that cannot be installed fails only the kind of file that it is about."""
    expected = ("failed", f"the build stops here: {reason}", submitted.location_of(SETUP, at))
    assert finds(build_installs, submitted, kind=kind, name=KINDS[kind]) == expected
    assert statuses(submitted) == {**dict.fromkeys(KINDS, "passed"), kind: "failed"}


NO_PACKAGES = "packages=[...] is missing, and setuptools cannot choose between the folders launch, my_robot, resource, rviz and urdf"


@pytest.mark.parametrize(
    ("submitted", "reason"),
    [
        (REFERENCE.without("my_robot/resource"), "data_files lists 'resource/my_robot', but there is no such file"),
        (setup("['package.xml']", "'package.xml'"), A_STRING.format("package.xml")),
        (setup("    packages=find_packages(exclude=['test']),\n", ""), NO_PACKAGES),
    ],
    ids=["resource", "package.xml", "packages"],
)
def test_an_error_that_stops_the_build_fails_one_criterion(submitted: Submitted, reason: str) -> None:
    """An entry about no kind of file counts as one about the URDF, so that one mistake fails one criterion."""
    for kind, file in KINDS.items():
        status, message, _ = finds(build_installs, submitted, kind=kind, name=file)
        assert status == ("failed" if kind == "urdf" else "passed")
        assert kind != "urdf" or message == STOPS + reason


@pytest.mark.parametrize("folder", ["dist", "venv", "env", "requirements", "fabfile", "site_scons", "urdf2"])
def test_setuptools_does_not_choose_some_folders(folder: str) -> None:
    """A message on packages=[...] names only folders that setuptools would take for packages."""
    without = setup("    packages=find_packages(exclude=['test']),\n", "")
    more = without.with_files({f"my_robot/{folder}/notes.txt": ""})
    messages = [finds(build_installs, it, kind="urdf", name=KINDS["urdf"])[1] for it in (without, more)]
    assert (messages[0] == messages[1]) == (folder != "urdf2")


@every_kind
def test_a_package_without_setup_py(kind: str) -> None:
    """A package without setup.py installs nothing."""
    message = "the package has no setup.py, so a build of an ament_python package installs nothing"
    expected = ("setup.py", FOLDER, message, None)
    assert lacks(build_installs, REFERENCE.without(SETUP), kind=kind, name=KINDS[kind]) == expected
    assert lacks(setup_imports, REFERENCE.without(SETUP)) == expected
    assert lacks(installs_files, REFERENCE.without(SETUP), files=["urdf/*"]) == expected


def test_a_setup_py_with_a_syntax_error_is_missed() -> None:
    """Python's own message is reported at Python's location, under one key for all checks that need setup.py."""
    comma = setup("zip_safe=True,", "zip_safe=True")
    message = "Python cannot read setup.py: invalid syntax. Perhaps you forgot a comma?"
    expected = ("setup.py", FOLDER, message, comma.location_of(SETUP, "True\n"))
    bracket = setup("    ],\n    install", "    install")
    for kind, file in KINDS.items():
        assert lacks(build_installs, comma, kind=kind, name=file) == expected
        assert lacks(build_installs, bracket, kind=kind, name=file)[:2] == expected[:2]
    assert lacks(setup_imports, comma) == expected


def test_a_setup_py_in_another_encoding_is_missed() -> None:
    """Python reads UTF-8 by default."""
    umlaut = REFERENCE.with_files({SETUP: b"# caf\xe9\n" + REFERENCE.data(SETUP)})
    assert lacks(setup_imports, umlaut)[0::3] == ("setup.py", start_of(SETUP))
    declared = REFERENCE.with_files({SETUP: b"# -*- coding: latin-1 -*-\n# caf\xe9\n" + REFERENCE.data(SETUP)})
    assert finds(setup_imports, declared)[0] == "passed"
    assert statuses(declared) == dict.fromkeys(KINDS, "passed")


@pytest.mark.parametrize("text", ["", "from setuptools import setup\n", "import os\n\nprint(os.getcwd())\n"])
def test_a_setup_py_without_setup_is_one_fault(text: str) -> None:
    """A setup.py that never calls setup() installs nothing: one missing thing, the same for each kind."""
    submitted = REFERENCE.with_files({SETUP: text})
    expected = ("call of setup", FOLDER, "a build installs nothing: setup.py does not call setup()", None)
    for kind, file in KINDS.items():
        assert lacks(build_installs, submitted, kind=kind, name=file) == expected
    assert finds(setup_imports, submitted)[0] == "passed"


@every_kind
def test_cmake_packages_need_manual_grading(kind: str) -> None:
    """CMakeLists.txt is not evaluated, and there is no setup.py."""
    cmake = (
        manifest("ament_python", "ament_cmake").without(SETUP).with_files({"my_robot/CMakeLists.txt": "install()\n"})
    )
    message = "the grader does not evaluate CMakeLists.txt, which lists what is installed; needs manual grading"
    assert finds(build_installs, cmake, kind=kind, name=KINDS[kind]) == ("pending", message, None)
    assert finds(setup_imports, cmake) == ("pending", message, None)
    assert finds(installs_files, cmake, files=["urdf/*"]) == ("pending", message, None)
    left_over = cmake.with_files({SETUP: REFERENCE.files[SETUP]})
    assert finds(build_installs, left_over, kind=kind, name=KINDS[kind]) == ("pending", message, None)
    not_used = REFERENCE.with_files({"my_robot/CMakeLists.txt": "install()\n"})
    assert finds(build_installs, not_used, kind=kind, name=KINDS[kind])[0] == "passed"


@every_kind
def test_entries_known_only_at_run_time_need_manual_grading(kind: str) -> None:
    """Entries that cannot be determined statically leave every file pending that is not known to be installed."""
    submitted = setup("glob('urdf/*')", "os.environ['FILES'].split()")
    status, message, location = finds(build_installs, submitted, kind=kind, name=KINDS[kind])
    if kind != "urdf":
        assert status == "passed"
        return
    assert (status, location) == ("pending", None)
    assert message.startswith("cannot determine statically whether a build installs urdf/my_robot.urdf: ")
    assert message.endswith(" of setup.py); needs manual grading")


def test_a_setup_py_that_is_too_large_needs_manual_grading() -> None:
    """A file that was not read neither passes nor fails."""
    large = REFERENCE.with_files({SETUP: str(REFERENCE.files[SETUP]) + "#" * 200_000})
    message = "setup.py cannot be read (my_robot/setup.py is larger than 131072 bytes); needs manual grading"
    for kind, file in KINDS.items():
        assert finds(build_installs, large, kind=kind, name=file) == ("pending", message, None)
    assert finds(setup_imports, large) == ("pending", message, None)


def test_files_by_patterns() -> None:
    """A lab may ask for files of any kind by patterns."""
    with_config = REFERENCE.with_files({"my_robot/config/nav.yaml": "{}\n"})
    for submitted, files, kind, name, message in (
        (REFERENCE, ["config/*.yaml", "*.yml"], "file", "config/*.yaml",
         "the package has no file that matches 'config/*.yaml' or '*.yml'"),
        (with_config, ["config/*.yaml"], "installed config/nav.yaml", FOLDER,
         "a build does not install config/nav.yaml: no entry of data_files in setup.py names it"),
    ):  # fmt: skip
        assert lacks(installs_files, submitted, files=files) == (kind, name, message, None)
    installed = setup(URDF_ENTRY, f"{URDF_ENTRY}\n        ('share/my_robot/config', glob('config/*')),", with_config)
    message = "a build installs config/nav.yaml as share/my_robot/config/nav.yaml"
    assert finds(installs_files, installed, files=["config/*.yaml"]) == ("passed", message, None)


# --- Names in setup.py ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("old", "new", "message", "at"),
    [
        ("import os\n", "", "the name 'os' is not defined or imported",
         "os.path.join('share', package_name), ['package.xml']"),
        ("from glob import glob\n", "", "the name 'glob' is not defined or imported", "glob('urdf/*')"),
        ("from glob import glob", "import glob", "glob is a module here and cannot be called: write glob.glob(...)",
         "glob('urdf/*')"),
        ("package_name = 'my_robot'\n", "", "the name 'package_name' is not defined or imported", "package_name,\n"),
    ],
    ids=["os", "glob", "module", "variable"],
)  # fmt: skip
def test_an_undefined_name(old: str, new: str, message: str, at: str) -> None:
    """An undefined name is reported once, at its first use."""
    submitted = setup(old, new)
    assert finds(setup_imports, submitted) == ("failed", message, submitted.location_of(SETUP, at))


def test_several_undefined_names_are_listed() -> None:
    """All names are reported at once, each once; of many only the first."""
    both = setup("import os\n", "").replacing(SETUP, "from glob import glob\n", "")
    status, message, _ = finds(setup_imports, both)
    assert status == "failed"
    assert message.count("'os'") == message.count("'glob'") == 1
    many = REFERENCE.with_files({SETUP: "a()\nb()\nc()\nd()\ne()\n"})
    assert finds(setup_imports, many)[1].endswith("; ... and 2 more")
