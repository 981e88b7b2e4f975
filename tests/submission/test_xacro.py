"""Which files are graded as xacro expands them, and what is graded of those that xacro refuses or cannot determine."""

import re
import shutil
from pathlib import Path

import pytest

from grader.lab.grading.grade import grade
from grader.lab.submission.opening import read_submission
from grader.lab.submission.submission import Submission
from grader.ros.package.robot_file import Read
from tests.samples import LAB6, opened

REFERENCE = (LAB6.path.parent / LAB6.reference / LAB6.urdf).read_text(encoding="utf-8")
NAMESPACE = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
PLAIN = REFERENCE.replace('rpy="-1.57 0 0"', 'rpy="${-pi/2} 0 0"').replace(
    "<robot ", f"<robot {NAMESPACE} "
)
MACRO = PLAIN.replace("</robot>", '<xacro:macro name="m" params="p"/>\n</robot>')


def inserted(text: str, *, at: str = "</robot>", also: str = "") -> str:
    """Return the reference as xacro, with a text before another one."""
    assert at in PLAIN
    return PLAIN.replace(at, f"{text}\n{at}{also}", 1)


def statuses(submission: Submission) -> dict[str, str]:
    """Return the status of each criterion of Task 1."""
    return {
        result.criterion.id: result.outcome.status
        for result in grade(LAB6, submission, ["task1"]).results
    }


def single(text: str, name: str = "my_robot.urdf.xacro") -> Submission:
    """Return a submission that is one file."""
    return read_submission(text.encode(), identity="ash", path=name)


def package_with(
    folder: Path, text: str, *, name: str = "my_robot.urdf", command: str = ""
) -> Submission:
    """Return the reference package with another URDF, whose launch file runs a command on it, or reads it."""
    shutil.copytree(LAB6.path.parent / LAB6.reference, folder / "my_robot")
    (folder / "my_robot" / LAB6.urdf).unlink()
    (folder / "my_robot" / "urdf" / name).write_text(text)
    launch = folder / "my_robot" / "launch" / "my_robot_rviz.launch.py"
    if command:
        new = f"    from launch.substitutions import Command\n    robot_description = Command([{command}])\n"
        changed = re.sub(r"    with open.*?read\(\)\n", new, launch.read_text(), flags=re.DOTALL)
        assert "Command" in changed
        launch.write_text(changed)
    return opened(folder)


def state(submission: Submission) -> str:
    """Return how a submission's URDF is read."""
    urdf = submission.urdf
    assert isinstance(urdf, Read)
    return "both" if urdf.as_it_stands is not None else "expanded" if urdf.is_expanded else "read"


def test_a_launch_file_that_runs_xacro_means_expansion(tmp_path: Path) -> None:
    """A .urdf is expanded if the launch file runs xacro on it; else ROS 2 gets the text as it stands."""
    command = "'xacro ', share + '/my_robot.urdf'"
    for text in (PLAIN, MACRO):
        found = package_with(tmp_path / str(len(text)), text, command=command)
        assert (state(found), found.verdict) == ("expanded", "clean")
    as_it_stands = package_with(tmp_path / "as-it-stands", PLAIN)
    assert (state(as_it_stands), as_it_stands.verdict) == ("both", "rejected")


def test_a_name_that_says_xacro_means_expansion() -> None:
    """A name with .xacro in it means expansion, in any case and with anything after it.

    A name with neither means expansion too: nothing loads such a file as a URDF.
    """
    for name in (
        "a.urdf.xacro",
        "a.xacro",
        "urdf.Xacro file.txt",
        "urdf.xacro file.py",
        "a.urdf.xacro.txt",
        "a.xacro.urdf",
    ):
        assert state(single(MACRO, name)) == "expanded", name
    assert state(single(MACRO, "my_robot")) == state(single(MACRO, "robot.xml")) == "expanded"
    for name in ("a.urdf", "A.URDF", "a.urdf.txt", "-"):
        assert state(single(PLAIN, name)) == "both", name
    assert state(single(REFERENCE, "a.xacro")) == "read"


def test_xacro_that_makes_no_difference_is_read_as_it_stands() -> None:
    """Macros for masses alone, and an include that is missing, take nothing away from what ROS 2 loads and RViz shows."""
    mass = '<xacro:macro name="m"><inertial><mass value="${1}"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></xacro:macro>'
    for more in (mass, mass + '<xacro:include filename="$(find other)/more.xacro"/>'):
        text = PLAIN.replace("${-pi/2}", "-1.57").replace("</robot>", f"{more}</robot>")
        text = text.replace('<link name="lidar">', '<link name="lidar"><xacro:m/>')
        found = single(text, "my_robot.urdf")
        assert (state(found), found.verdict) == ("read", "clean")
        assert set(statuses(found).values()) == {"passed"}


def test_launch_arguments_reach_xacro(tmp_path: Path) -> None:
    """The arguments that the launch file gives xacro count before the defaults of the file."""
    text = PLAIN.replace('name="lidar"', 'name="$(arg sensor)"').replace(
        'link="lidar"', 'link="$(arg sensor)"'
    )
    text = text.replace("</robot>", '<xacro:arg name="other" default="1"/></robot>')
    text = text.replace(
        '<link name="base_link">',
        '<xacro:arg name="sensor" default="scanner"/><link name="base_link">',
        1,
    )
    given = package_with(
        tmp_path / "a", text, command="'xacro ', share + '/my_robot.urdf', ' sensor:=lidar'"
    )
    assert set(statuses(given).values()) == {"passed"}
    default = package_with(tmp_path / "b", text, command="'xacro ', share + '/my_robot.urdf'")
    assert statuses(default)["lidar-shape"] == "failed"


def test_an_unknown_macro_of_a_missing_include_hides_nothing_of_its_link(tmp_path: Path) -> None:
    """A call of a macro from another package inside of a link leaves the link's own visual."""
    include = '<xacro:include filename="$(find other_robot)/urdf/inertia.xacro"/>'
    text = inserted(include, at='<link name="base_link">', also='<xacro:inertial_box mass="1"/>')
    found = package_with(tmp_path, text, name="my_robot.urdf.xacro")
    assert {name for name, status in statuses(found).items() if status != "passed"} == {
        "urdf-loads"
    }


def test_an_include_that_a_build_installs_elsewhere_is_found(tmp_path: Path) -> None:
    """$(find my_robot)/x.xacro is urdf/x.xacro if setup.py installs it there."""
    text = inserted('<xacro:include filename="$(find my_robot)/more.xacro"/>')
    found = package_with(tmp_path, text, name="my_robot.urdf.xacro")
    assert statuses(found)["urdf-loads"] == "failed"
    (tmp_path / "my_robot" / "urdf" / "more.xacro").write_text("<robot/>")
    assert set(statuses(opened(tmp_path)).values()) == {"passed"}


def test_a_part_of_a_package_includes_its_own_files(tmp_path: Path) -> None:
    """Without a package.xml, $(find my_robot) is taken for the package that the files are a part of."""
    (tmp_path / "urdf").mkdir()
    (tmp_path / "urdf" / "more.xacro").write_text("<robot/>")
    text = inserted('<xacro:include filename="$(find my_robot)/urdf/more.xacro"/>')
    (tmp_path / "urdf" / "my_robot.urdf.xacro").write_text(text)
    assert set(statuses(opened(tmp_path)).values()) == {"passed"}


@pytest.mark.parametrize("ending", ["", ".txt", " file", " file.py"])
def test_files_that_were_renamed_alike_include_each_other(ending: str, tmp_path: Path) -> None:
    """Without a package, an ending that was added to the name of a file may be added to those that it includes as well."""
    include = '<xacro:include filename="macros.xacro"/>'
    (tmp_path / f"urdf.xacro{ending}").write_text(inserted(include))
    (tmp_path / f"macros.xacro{ending}").write_text(f"<robot {NAMESPACE}/>")
    assert statuses(opened(tmp_path))["urdf-loads"] == "passed"
    (tmp_path / f"macros.xacro{ending}").rename(tmp_path / "macros.xacro.bak")
    assert statuses(opened(tmp_path))["urdf-loads"] == "failed"
    (tmp_path / "macros.xacro.bak").rename(tmp_path / f"macros.xacro{ending}")
    shutil.copy(LAB6.path.parent / LAB6.reference / "package.xml", tmp_path)
    assert statuses(opened(tmp_path))["urdf-loads"] == ("failed" if ending else "passed")


def test_a_refused_expression_costs_what_depends_on_it() -> None:
    """An undefined property fails urdf-loads and the criteria of its element, all else is graded."""
    text = PLAIN.replace('<box size="0.6 0.4 0.2"/>', '<box size="${lenght} 0.4 0.2"/>')
    assert text != PLAIN
    found = statuses(single(text))
    assert found["urdf-loads"] == found["base-box"] == "failed"
    assert (
        found["lidar-frame"] == found["left-wheel-forward"] == found["footprint-root"] == "passed"
    )


def test_a_failure_names_what_xacro_refuses() -> None:
    """A frame or shape that xacro cannot place fails with xacro's problem, at the attribute."""
    text = PLAIN.replace('xyz="0.15 0 0.225"', 'xyz="${heigth} 0 0.225"').replace(
        "0.6 0.4 0.2", "${lenght} 0.4 0.2"
    )
    results = {
        result.criterion.id: result.outcome
        for result in grade(LAB6, single(text), ["task1"]).results
    }
    for name, wrong in (("lidar-frame", "heigth"), ("base-box", "lenght")):
        outcome = results[name]
        assert f"XACRO002: there is no property {wrong} at this place" in outcome.message
        assert outcome.location is not None
        line = text.split("\n")[outcome.location.line - 1]
        assert line[outcome.location.column - 1 :].startswith(("xyz=", "size="))


def test_an_environment_variable_leaves_only_its_element_undecided() -> None:
    """What an environment variable decides needs manual grading, all else is graded."""
    found = statuses(
        single(PLAIN.replace('<box size="0.6 0.4 0.2"/>', '<box size="$(env LENGTH) 0.4 0.2"/>'))
    )
    assert found["urdf-loads"] == found["base-box"] == "pending"
    assert found["lidar-frame"] == found["left-wheel-continuous"] == "passed"
    assert "failed" not in found.values()


def test_what_an_undecided_condition_defines_is_undecided() -> None:
    """A property or macro in it may exist, and one that existed before may have another value."""
    condition = '<xacro:if value="$(env REAL)">{}</xacro:if>'
    size = '<box size="0.6 0.4 0.2"/>'
    text = PLAIN.replace(size, '<box size="${long} 0.4 0.2"/>')
    before, inside = (
        '<xacro:property name="long" value="9"/>',
        '<xacro:property name="long" value="0.6"/>',
    )
    for start in ("", before):
        found = statuses(
            single(text.replace("<link", start + condition.format(inside) + "<link", 1))
        )
        assert found["base-box"] == found["urdf-loads"] == "pending"
        assert "failed" not in found.values()
    macro = condition.format(f'<xacro:macro name="m">{size}</xacro:macro>')
    text = PLAIN.replace(size, "<xacro:m/>").replace("<link", macro + "<link", 1)
    assert "failed" not in statuses(single(text)).values()


def test_xml_that_xacro_refuses_hides_nothing_else() -> None:
    """A blank line before the declaration, or no xmlns:xacro, fails urdf-loads, and all else is graded."""
    assert PLAIN.startswith("<?xml")
    for text in ("\n" + PLAIN, MACRO.replace(NAMESPACE, "")):
        found = {
            name: status for name, status in statuses(single(text)).items() if status != "passed"
        }
        assert found == {"urdf-loads": "failed"}
