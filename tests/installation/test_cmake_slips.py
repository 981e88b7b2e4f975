"""Words of a CMakeLists.txt that surely stand for others."""

import pytest

from grader.base.element_edits import edited
from grader.base.source import Source
from grader.files.tree import make_tree
from grader.ros.installation.cmake.cmake_slips import cmake_slips

_RIGHT = """\
project(rover)
set(place share)
install(DIRECTORY launch DESTINATION ${place}/${PROJECT_NAME})
ament_package()
"""
_PATH = "CMakeLists.txt"


@pytest.mark.parametrize(
    "wrong",
    [
        "${place}/$PROJECT_NAME",
        "${place}/{PROJECT_NAME}",
        "${place}/$(PROJECT_NAME)",
        "${place}/PROJECT_NAME",
        "${place}/${PROJECT_NAM}",
        "$(place)/${PROJECT_NAME}",
        "$place/${PROJECT_NAME}",
    ],
)
def test_a_variable_in_another_form_is_read_as_one(wrong: str) -> None:
    """One edit writes the variable as CMake reads it."""
    text = _RIGHT.replace("${place}/${PROJECT_NAME}", wrong)
    tree = make_tree("rover", (), ("launch",))
    [slip] = cmake_slips(Source(_PATH, text), tree, "rover", ())
    assert edited(text, _PATH, slip.edits) == _RIGHT


def test_words_that_are_no_variables_stay() -> None:
    """The names of variables may be words of other commands, and parts of longer words."""
    text = _RIGHT + "message(place)\nset(other place PROJECT_NAMES $<place> my/places)\n"
    assert cmake_slips(Source(_PATH, text), make_tree("rover", (), ("launch",)), "rover", ()) == []
