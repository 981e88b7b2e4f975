"""Edits of elements keep the form of the file."""

import pytest

from grader.base.element_edits import with_child
from grader.base.source import Source


@pytest.mark.parametrize(
    ("text", "child"),
    [
        ('<a>\n  <b>\n    <c name="x"/>\n  </b>\n</a>', "      <d/>"),
        ('<a>\n\t<b>\n\t\t<c name="x"/>\n\t</b>\n</a>', "\t\t\t<d/>"),
        ('<a>\n    <!-- x -->\n <c name="x"/>\n</a>', "  <d/>"),
        ('<a><c name="x"/></a>', "   <d/>"),
    ],
)
def test_a_child_is_one_step_from_its_parent(text: str, child: str) -> None:
    """The step is that of the first tag of the file that is indented; three blanks if none is."""
    source = Source("a.urdf", text)
    edit = with_child(source, text.index("<c"), "<d/>")
    assert edit.new.splitlines()[1] == child
