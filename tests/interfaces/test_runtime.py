"""What a package with interfaces depends on when they are used."""

from pathlib import Path

import pytest

from grader.files.reading import URDF_LIMIT
from grader.workspace.opening.opening import open_workspace
from grader.workspace.rules.reading import read_agreement
from tests.labs.variants import make_variant


@pytest.mark.slow
def test_generated_interfaces_need_the_runtime_of_rosidl(tmp_path: Path) -> None:
    """package.xml declares it, as each package that is used."""
    workspace = make_variant("laundry", "solution", tmp_path)
    manifest = workspace / "src/laundry_interfaces/package.xml"
    opened = open_workspace(str(workspace), URDF_LIMIT, {})
    assert read_agreement(opened.workspace).mismatches == ()
    text = manifest.read_text()
    line = "<exec_depend>rosidl_default_runtime</exec_depend>"
    assert line in text
    manifest.write_text(text.replace(line, ""))
    opened = open_workspace(str(workspace), URDF_LIMIT, {})
    [found] = read_agreement(opened.workspace).mismatches
    assert (found.family, found.location.path) == (
        "dependencies",
        "src/laundry_interfaces/CMakeLists.txt",
    )
    assert "does not declare 'rosidl_default_runtime'" in found.message
