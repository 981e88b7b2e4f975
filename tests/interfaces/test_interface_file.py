"""Files of messages, services and actions are read as rosidl_adapter does."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.ros.interfaces.interface_file import read_interface
from grader.ros.interfaces.interface_types import Interface
from grader.ros.interfaces.known_interfaces import known_interfaces
from tests.examples import examples
from tests.interfaces.make_known import text_of_type


def read(text: str, path: str = "hub/msg/State.msg") -> Interface:
    """Return what a file of the package hub defines."""
    return read_interface(text.encode(), path, "hub")


def fields(text: str) -> dict[str, str]:
    """Return the fields of a message that rosidl accepts, with their types."""
    found = read(text)
    assert found.faults == ()
    [section] = found.sections
    return {field.name: text_of_type(field.type) for field in section.fields.values()}


ACCEPTED = [
    ("float64 value", {"value": "float64"}),
    ("# a state\n\nfloat64\tvalue # m", {"value": "float64"}),
    (
        "string<=5 a\nwstring[<=3] b\nint32[4] c\nbool[] d",
        {"a": "string<=5", "b": "wstring[<=3]", "c": "int32[4]", "d": "bool[]"},
    ),
    ("State other\ngeometry_msgs/Pose pose", {"other": "hub/State", "pose": "geometry_msgs/Pose"}),
    ("int32 A=1\nint32 B_2 = 0x10\nfloat32 x 1.5", {"x": "float32"}),
    ('string[] a ["x, y", z]\nint8[2] b [1, -2]', {"a": "string[]", "b": "int8[2]"}),
    ("char c 255\nbyte b 0\nbool t True", {"c": "char", "b": "byte", "t": "bool"}),
    ("duration d\ntime t", {"d": "duration", "t": "time"}),
    ("", {}),
]


@pytest.mark.parametrize(("text", "expected"), ACCEPTED)
def test_a_message_has_fields(text: str, expected: dict[str, str]) -> None:
    """Names and types, lists and bounds, constants and defaults."""
    assert fields(text) == expected


REFUSED = [
    ("float65 value", "there is no type 'float65'; there are float32 and float64", None),
    ("double value", "there is no type 'double'; did you mean 'float64'?", "float64"),
    (
        "std_msgs/msg/Bool x",
        "there is no type 'std_msgs/msg/Bool'; write 'std_msgs/Bool'",
        "std_msgs/Bool",
    ),
    ("a/b/c x", "there is no type 'a/b/c'", None),
    ("Std/Bool x", "'Std' is no name of a package", None),
    ("float64", "'float64' is no field: it needs a type and a name", None),
    (" float64 x", "a line begins with a space: it should begin with the type of a field", None),
    (
        "float64 maxSpeed",
        "the name of a field is written as max_speed, not 'maxSpeed'",
        "max_speed",
    ),
    ("float64 x_", "the name of a field is written as max_speed, not 'x_'", None),
    ("int8 a\nint8 a", "there are two fields a", None),
    ("int8 A=1\nint8 A=1", "there are two constants A", None),
    ("int8 a=1", "the name of a constant is written as MAX_SPEED, not 'a'", "A"),
    ("Bool A=1", "the type of a constant is primitive, not 'Bool'", "bool"),
    ("int8 A=128", "'128' is no int8, a whole number from -128 to 127", None),
    ("uint8 a -1", "'-1' is no uint8, a whole number from 0 to 255", None),
    ("float32 a b", "'b' is no number", None),
    ("bool a yes", "a bool is true or false, not 'yes'", None),
    ('string a "b" c"', "a quote in the text 'b\" c' needs a \\ before it", None),
    ("string<=2 a abc", "the default has more than 2 characters", None),
    ("string<=0 a", "the bound of 'string<=0' is no whole number above 0", None),
    ("int8[0] a", "the size of 'int8[0]' is no whole number above 0", None),
    ("int8] a", "'int8]' ends with ], and has no [", None),
    ("int8[2] a [1]", "the default has 1 items; the list has 2", None),
    ("int8[<=1] a [1, 2]", "the default has 2 items; the list has at most 1", None),
    ("int8[] a 1", "the default of a list is written as [1, 2], not '1'", None),
    ("string[] a ['b]", 'the text "\'b" is not closed', None),
    ("string[] a [,b]", "an item of the default is missing", None),
    ("State a 1", "a field of the type State has no default", None),
    ("time a 1", "a value of the type time cannot be written", None),
]


@pytest.mark.parametrize(("text", "message", "meant"), REFUSED)
def test_what_rosidl_refuses_is_a_fault(text: str, message: str, meant: str | None) -> None:
    """The message says what is wrong, and what may be meant, where the line begins."""
    [fault] = read(text).faults
    assert (fault.message, fault.meant) == (message, meant)
    assert fault.location.line == text.count("\n") + 1


def test_a_service_has_two_sections() -> None:
    """A line with spaces behind the separator is none."""
    assert len(read("int8 a\n---\nint8 b", "hub/srv/Ask.srv").sections) == 2
    for text, line in (("int8 a", 1), ("---\n---", 2), ("int8 a\n--- \nint8 b", 2)):
        [fault] = read(text, "hub/srv/Ask.srv").faults
        assert fault.message.startswith("a .srv has one line --- between request and response")
        assert fault.location.line == line


def test_an_action_has_three_sections() -> None:
    """They are called goal, result and feedback."""
    found = read("int8 a\n---\n---\nint8 b", "hub/action/Go.action")
    assert found.faults == ()
    goal, feedback = found.section("Goal"), found.section("Feedback")
    assert goal is not None and feedback is not None
    assert (list(goal.fields), list(feedback.fields)) == (["a"], ["b"])
    assert found.section("Request") is None
    [fault] = read("---", "hub/action/Go.action").faults
    assert "2 lines --- between goal, result and feedback; this file has 1" in fault.message


def test_a_file_has_a_name_and_text() -> None:
    """rosidl makes a class of the name."""
    [fault] = read("", "hub/msg/state.msg").faults
    assert "begins with no capital letter" in fault.message
    [fault] = read_interface(b"\xff", "hub/msg/State.msg", "hub").faults
    assert fault.message == "the file is not UTF-8 text (byte 0)"
    [fault] = read("\n" * 2_001).faults
    assert "more than 2000 lines" in fault.message


@given(st.text(), st.sampled_from(["msg", "srv", "action"]))
@examples(200)
def test_any_text_is_read(text: str, kind: str) -> None:
    """No text raises an error, and what has no fault has all sections."""
    data = text.encode("utf-8", "surrogatepass")
    found = read_interface(data, f"hub/{kind}/State.{kind}", "hub")
    assert found.faults or len(found.sections) == {"msg": 1, "srv": 2, "action": 3}[kind]


WORDS = st.sampled_from(
    ["int8", "string<=3", "bool[]", "a", "MAX", "=", "1", "[1]", "# x", "---", " ", "\t"]
)


@pytest.mark.slow
@given(st.lists(st.lists(WORDS, max_size=5), max_size=6))
@examples(200)
def test_a_fault_has_a_place(lines: list[list[str]]) -> None:
    """Each is in a line of the file."""
    text = "\n".join(map("".join, lines))
    for fault in read(text).faults:
        assert 1 <= fault.location.line <= text.count("\n") + 1
        assert fault.location.column >= 1


def test_known_packages_have_types_by_release() -> None:
    """A type that later releases add is unknown before, and fields of several releases are joined."""
    assert known_interfaces("robots_of_mars") is None
    types = known_interfaces("std_srvs") or {}
    assert sorted(types) == ["srv.Empty", "srv.SetBool", "srv.Trigger"]
    assert "msg.VelocityStamped" not in (known_interfaces("geometry_msgs", ("foxy",)) or {})
    assert "msg.VelocityStamped" in (known_interfaces("geometry_msgs", ("foxy", "humble")) or {})
    marker = (known_interfaces("visualization_msgs") or {})["msg.Marker"].section("")
    assert marker is not None
    assert "ARROW" in marker.constants
    assert marker.fields["pose"].type.full_name == "geometry_msgs.msg.Pose"
