"""The fields that C++ uses of messages: certain ones with their path, and nothing where a type is not certain."""

from pathlib import Path

import pytest

from tests.nodes.test_cpp_nodes import nodes_of
from tests.workspace.test_cpp_nodes import messages

pytestmark = pytest.mark.slow

_SCAN, _TWIST = "sensor_msgs.msg.LaserScan", "geometry_msgs.msg.Twist"


def uses(parameter: str, body: str, before: str = "") -> list[tuple[str, str]]:
    """Return the types and paths of the fields that a function uses."""
    text = (
        "#include <rclcpp/rclcpp.hpp>\nusing Reading = sensor_msgs::msg::LaserScan;\n"
        f"{before} void heard({parameter}) {{ {body} }}\nint main() {{}}\n"
    )
    return [(it.type, ".".join(it.path)) for it in nodes_of(text).field_uses]


@pytest.mark.parametrize(
    "parameter",
    [
        "const sensor_msgs::msg::LaserScan::SharedPtr m",
        "sensor_msgs::msg::LaserScan::ConstSharedPtr m",
        "const sensor_msgs::msg::LaserScan & m",
        "std::shared_ptr<const sensor_msgs::msg::LaserScan> m",
        "std::unique_ptr<sensor_msgs::msg::LaserScan> m",
        "const Reading::SharedPtr & m",
    ],
)
def test_a_parameter_has_the_type_that_is_written(parameter: str) -> None:
    """By value, by reference or by any pointer, also under another name."""
    assert uses(parameter, "use(m->header.stamp);") == [
        (_SCAN, "header.stamp"),
        (_SCAN, "header"),
    ]


@pytest.mark.parametrize(
    "made",
    [
        "geometry_msgs::msg::Twist m;",
        "auto m = geometry_msgs::msg::Twist();",
        "auto m = geometry_msgs::msg::Twist{};",
        "auto m = std::make_shared<geometry_msgs::msg::Twist>();",
        "auto m = std::make_unique<geometry_msgs::msg::Twist>();",
    ],
)
def test_a_variable_has_the_type_that_it_is_made_of(made: str) -> None:
    """As it is declared, or by what it is set to."""
    assert uses("", f"{made} m.linear = v;") == [(_TWIST, "linear")]


def test_items_and_sections_are_followed() -> None:
    """A method is no field, and an item of a list is one of its type."""
    found = uses(
        "const std::shared_ptr<geometry_msgs::srv::Go::Request> m",
        "m->poses[0].x; m->poses.size();",
    )
    assert found == [
        ("geometry_msgs.srv.Go.Request", "poses.[].x"),
        ("geometry_msgs.srv.Go.Request", "poses"),
        ("geometry_msgs.srv.Go.Request", "poses"),
    ]


@pytest.mark.parametrize(
    ("parameter", "body", "before"),
    [
        ("auto m", "use(m->header);", ""),
        ("int m", "use(m.header);", ""),
        ("const Reading & m", "{ Other m; use(m.header); }", ""),  # another one of the name
        ("const Reading & m", "for (auto m : all) { use(m.header); }", ""),
        ("const Reading & m", "use(m.*member);", ""),
        ("const Reading & m", "use(make(m).header); use(all().header);", ""),
        ("const Reading & m", "\n#if A\nuse(m.header);\n#endif\n", ""),
        ("const T & m", "use(m.header);", "template <typename T>"),
        (
            "",
            "auto m = make(); auto n = all.front(); auto o = Reading::first; use(m.a, n.a, o.a);",
            "",
        ),
        ("", "auto m = std::make_shared(); auto n = convert<Reading>(); use(m.a, n.a);", ""),
        ("", "use(unknown.header);", ""),
    ],
)
def test_what_is_not_certain_is_not_listed(parameter: str, body: str, before: str) -> None:
    """A type that is computed, a name that stands for several things, and code behind #if."""
    assert uses(parameter, body, before) == []


def test_a_field_that_a_message_does_not_have(tmp_path: Path) -> None:
    """It is named with what may be meant, as in Python."""
    watcher = "beacon/src/watcher.cpp"
    [found] = messages(tmp_path, (watcher, "point.point.z = ", "point.position.z = "))
    assert found == (
        "interfaces",
        "geometry_msgs/msg/PointStamped has no field 'position'; it has header and point",
        True,
    )
