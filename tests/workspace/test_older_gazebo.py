"""Names of Ignition beside packages of Gazebo, which are for Ignition in the releases before Jazzy."""

from pathlib import Path

import pytest

from tests.command_line import run

_WORLD = """\
<sdf version="1.9"><world name="hall">
  <plugin filename="ignition-gazebo-physics-system" name="ignition::gazebo::systems::Physics"/>
</world></sdf>
"""
_MANIFEST = """\
<package format="3"><name>hall</name><version>1.0.0</version><description>A hall.</description>
  <maintainer email="ash@example.org">Ash</maintainer><license>MIT</license>
  <exec_depend>ros_gz_sim</exec_depend></package>
"""


@pytest.mark.parametrize(
    ("options", "is_said"), [((), False), (("humble",), False), (("jazzy",), True)]
)
def test_releases(options: tuple[str, ...], is_said: bool, tmp_path: Path) -> None:
    """Gazebo's packages of Humble are for Fortress, and without a release they may be."""
    for path, text in (("package.xml", _MANIFEST), ("worlds/hall.sdf", _WORLD)):
        (tmp_path / path).parent.mkdir(exist_ok=True)
        (tmp_path / path).write_text(text, encoding="utf-8")
    given = [f"--distro={name}" for name in options]
    printed = run(("inspect", tmp_path, "--format", "concise", *given)).stdout
    assert (b"is a name of Ignition" in printed) is is_said
