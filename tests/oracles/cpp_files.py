"""C++ files that are made of the statements of nodes, with comments, macros and literals between them."""

from collections.abc import Iterator
from random import Random

_LITERALS = (
    *(
        '"scan"',
        '"a\\"b"',
        '"a\\\\"',
        'R"(a"b)"',
        'R"x(a)")x"',
        'u8"é"',
        '"a" "b"',
        "'a'",
        "'\\''",
        '"//"',
        '"/*"',
    ),
    *(
        "10",
        "0x1F",
        "1'000",
        "1.5e-3",
        ".5f",
        "500ms",
        "0.5s",
        '"a"s',
        "true",
        "nullptr",
        "-3",
        "017",
        "42ULL",
    ),
)
_STATEMENTS = (
    "publisher_ = create_publisher<std_msgs::msg::String>({0}, {1});",
    "this->declare_parameter<double>({0}, {1});",
    "auto value = get_parameter({0}).as_string() + {1};",
    "rclcpp::QoS qos({0}); qos.best_effort().keep_last({1});",
    "timer_ = create_wall_timer({0}, [this]() {{ step({1}); }});",
    "transform.header.frame_id = {0}; // a comment with {1}",
    "/* {0} */ broadcaster_->sendTransform(transform({1}));",
    "for (const auto & it : items({0})) {{ handle(it, {1}); }}",
    "if (compare({0}) < {1} && ready()) {{ return; }}",
    "std::vector<std::pair<int, std::map<int, double>>> all{{{0}, {1}}};",
    "auto shared = std::make_shared<Node<int>>({0}, std::move(other), {1});",
    "RCLCPP_INFO(get_logger(), {0}, value({1}));",
    "switch (mode) {{ case {1}: start({0}); break; default: stop(); }}",
    "auto add = [](auto left, auto right) -> double {{ return left + right * scale({0}, {1}); }};",
)
_HEAD = (
    '#include "rclcpp/rclcpp.hpp"\n',
    '#define TOPIC "scan"\n',
    "using namespace std::chrono_literals;\n",
    "template<typename T> class Node;\n",
    "namespace a::b { constexpr auto c = 1; }\n",
)


def written_files(count: int) -> Iterator[str]:
    """Yield as many files, the same in every run."""
    chance = Random(78)
    for number in range(count):
        head = "".join(chance.sample(_HEAD, chance.randint(0, len(_HEAD))))
        lines = []
        for _ in range(chance.randint(1, 15)):
            statement = chance.choice(_STATEMENTS)
            lines.append(
                "    " + statement.format(chance.choice(_LITERALS), chance.choice(_LITERALS))
            )
        body = "\n".join(lines)
        yield f"{head}class N{number} : public rclcpp::Node\n{{\npublic:\n  N{number}()\n  {{\n{body}\n  }}\n}};\n"
