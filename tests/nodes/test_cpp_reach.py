"""How far the nodes in C++ are read: an error, a library or a macro leaves open no more than it hides."""

import pytest

from tests.nodes.test_cpp_nodes import _CMAKE, _HEAD, _MAIN, node_of, nodes_of

_TALKER = 'class Talker : public rclcpp::Node { public: Talker() : Node("talker") { declare_parameter("a", 1); } };'
_NO_CPP = "C++ is not read as a whole: this is no C++ that is known"

AROUND = [
    'void log() { RCLCPP_INFO(logger(), "%" PRIu64 " messages", count); }',
    '#ifdef __cplusplus\nextern "C" {\n#endif\nint plain();\n#ifdef __cplusplus\n}\n#endif\n',
    '#if __cplusplus\nextern "C"\n{  // linkage\n#endif\nint plain();\n#if __cplusplus\n}  /* extern "C" */\n#endif\n',
    "template class std::vector<hub::Reading>;",
    "struct Values { int sum(int i) { return values->operator[](i); } };",
    "void swap() { rows = new double *[(count + 1)]; }",
]  # fmt: skip


@pytest.mark.parametrize("text", AROUND)
def test_harmless_errors(text: str) -> None:
    """A text that the grammar does not know hides no more than its statement."""
    [program] = nodes_of(f"{_HEAD}{text}\n{_TALKER}\n{_MAIN}").programs
    [node] = program.nodes
    assert [parameter.name for parameter in node.parameters] == ["a"]
    assert node.doubts == ()


HIDING = [
    'void log() { node->declare_parameter("%" PRIu64 " messages", count); }',
    'void log() { take(node, "%" PRIu64 "); }',
    'void log() { take(*this, "%" PRIu64 " messages"); }',
    "class Mine : public { int a; };",
    "void log() { if (a { b(); }",
    'void log() { "a',
]  # fmt: skip


@pytest.mark.parametrize("text", HIDING)
def test_hiding_errors(text: str) -> None:
    """A text that may hide a node, or what one opens, leaves the file open."""
    reasons = {doubt.reason for doubt in nodes_of(f"{_HEAD}{_TALKER}\n{_MAIN}\n{text}").doubts}
    assert _NO_CPP in reasons


MACROS = [
    ("#define LOG_INFO(text) RCLCPP_INFO(get_logger(), text)", 'LOG_INFO("a");', ()),
    ("#define LOG_INFO RCLCPP_INFO", 'LOG_INFO(get_logger(), "a");', ()),
    ("#define DECLARE(name) declare_parameter(name, 1)", 'DECLARE("a");', ("DECLARE",)),
    ("#define TAKE_ALL OTHER_MACRO", "TAKE_ALL(a);", ("TAKE_ALL",)),
]  # fmt: skip


@pytest.mark.parametrize(("macro", "statement", "doubted"), MACROS)
def test_own_macros(macro: str, statement: str, doubted: tuple[str, ...]) -> None:
    """An own macro that only logs leaves nothing open; another one does."""
    body = (
        f'class Talker : public rclcpp::Node {{ public: Talker() : Node("a") {{ {statement} }} }};'
    )
    [program] = nodes_of(f"{_HEAD}{macro}\n{body}\n{_MAIN}").programs
    reasons = [doubt.reason for doubt in program.nodes[0].doubts]
    assert reasons == [f"the macro {name} is not evaluated" for name in doubted]


LINKS = [
    ("find_package(OpenCV REQUIRED)", "${OpenCV_LIBS}", True),
    ("find_package(PCL REQUIRED)", "${PCL_LIBRARIES} ${std_msgs_TARGETS}", False),
    ("find_package(std_msgs REQUIRED)", "${std_msgs_TARGETS}", True),
    ("find_library(SERIAL serial)", "${SERIAL}", True),
    ("find_package(PkgConfig REQUIRED)\npkg_check_modules(SERIAL libserial)", "${SERIAL_LIBRARIES}", True),
    ("execute_process(COMMAND uname OUTPUT_VARIABLE LIBS)", "${LIBS}", False),
    ("find_package(OpenCV REQUIRED)", "$<$<CONFIG:Debug>:part>", False),
]  # fmt: skip


@pytest.mark.parametrize(("before", "linked", "is_known"), LINKS)
def test_libraries_of_others(before: str, linked: str, is_known: bool) -> None:
    """The variables of packages name libraries of others; what is not known may be an own one."""
    made = f"{before}\nadd_executable(talk src/talk.cpp)\ntarget_link_libraries(talk {linked})\n"
    is_opaque = "std_msgs" in linked and "std_msgs" not in before
    unknown = "\ninclude(${ANY}/any.cmake)\n" if is_opaque else ""
    cmake = _CMAKE.replace("add_executable(talk src/talk.cpp)\n", unknown + made)
    [program] = nodes_of(f"{_HEAD}{_TALKER}\n{_MAIN}", cmake).programs
    reasons = [doubt.reason for doubt in program.nodes[0].doubts]
    assert (reasons == []) == is_known


def test_statements_of_nodes() -> None:
    """A node's own statement that is no C++ hides nothing of the others."""
    node = node_of('RCLCPP_INFO(get_logger(), "%" PRIu64, 1);', 'declare_parameter("a", 1);')
    assert ([parameter.name for parameter in node.parameters], node.doubts) == (["a"], ())
