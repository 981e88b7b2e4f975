"""Edits of a robot's text: what has no text to edit has no edit, and the pieces of the body of a link."""

import pytest

from grader.robot.edits.bodies import body_pieces
from grader.robot.edits.difference import RobotDifference
from grader.robot.edits.draft import Draft
from grader.robot.edits.elements import Set
from grader.robot.reader import read_urdf
from grader.submission.urdf import Read
from tests.samples import SAMPLES

BOX, SPHERE = '<geometry><box size="1 1 1"/></geometry>', '<geometry><sphere radius="1"/></geometry>'
NO_INERTIA = '<inertial><mass value="1"/></inertial>'


def draft_of(text: str) -> Draft:
    """Return the draft of a robot with the link 'base', which has this text inside."""
    draft = Draft.of(read_urdf(f'<robot name="r"><link name="base">{text}</link></robot>'.encode()))
    assert draft is not None
    return draft


@pytest.mark.parametrize(
    ("text", "mass", "causes"),
    [
        ("", 1.0, []),
        (NO_INERTIA, None, []),
        ('<visual><geometry><mesh filename="a.stl"/></geometry></visual>', 1.0, ["the <collision> of {} is missing"]),
        (f"<visual>{BOX}</visual>", 1e-400, ["the <collision> of {} is missing"]),
        (f"<visual>{BOX}</visual>", 1.0, ["the <inertial> of {} is missing", "the <collision> of {} is missing"]),
        (f"{NO_INERTIA}<visual>{BOX}</visual>", 1.0, []),
        (f"<collision>{BOX}</collision>", None, ["a collision of {} that is not shown"]),
    ],
)
def test_the_pieces_of_a_body(text: str, mass: float | None, causes: list[str]) -> None:
    """What a link lacks beside what it shows; nothing of what ROS 2 drops, and no mass without a solid."""
    difference = RobotDifference(draft_of(text), draft_of(text))
    found = [piece.cause for piece in body_pieces(difference, {"link": "base", "mass": mass})]
    assert found == [cause.format("the link 'base'") for cause in causes]
    assert [*body_pieces(difference, {"link": "nowhere"})] == []


def test_what_has_no_text_to_edit() -> None:
    """An empty element has no text, and an attribute that is not written cannot be renamed."""
    draft = draft_of(f"<visual>{BOX}</visual>")
    [box] = draft.root.iter("box")
    assert draft.write_text(box, "1") == draft.rename_attribute(box, "sise", "size") == ()
    [edit] = draft.rename_attribute(box, "size", "sise")
    assert edit.new == 'sise="1 1 1"'


def test_a_shape_is_replaced_with_its_twin() -> None:
    """The collision of the same shape becomes that of the reference in the same edit."""
    own, other = (f"<visual>{shape}</visual><collision>{shape}</collision>" for shape in (SPHERE, BOX))
    pieces = RobotDifference(draft_of(own), draft_of(other)).pieces
    assert max(len(piece.edits) for piece in pieces) == 2


def test_elements_of_one_macro_are_set_once() -> None:
    """Two wheels that come from one text have one edit of it."""
    urdf = SAMPLES["equivalent-xacro-macros"].open().urdf
    assert isinstance(urdf, Read)
    draft = Draft.of(urdf.reading)
    assert draft is not None
    cylinders = [it for it in draft.root.iter("cylinder") if len(draft.siblings(it)) > 1]
    ways = draft.ways([Set(cylinder, "", "radius", "0.3") for cylinder in cylinders])
    assert ways == draft.ways([Set(it, "", "radius", "0.3") for it in reversed(cylinders)]) != [()]
