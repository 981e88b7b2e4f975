"""The values of C++ expressions: what is written as a text, number or constant is known, and nothing else."""

import pytest

from grader.ros.cpp.cpp_evaluation import CppEvaluation, LibraryCalls
from grader.ros.cpp.cpp_values import CppCall, CppName, CppSum, CppValue
from grader.ros.cpp.declarations import CppFile
from grader.ros.cpp.syntax import parse_cpp
from grader.ros.cpp.unit import CppUnit, called_name, list_arguments
from grader.ros.python.budget import Budget
from grader.ros.python.values import Unknown

_CALLS = LibraryCalls(frozenset({"use", "read"}), {"get": 1})


def evaluated(*texts: str) -> list[CppValue]:
    """Return the values of the arguments of the last call of use() in files."""
    budget = Budget(10**7)
    files = [
        CppFile(parse_cpp(text.encode(), f"{number}.cpp", budget))
        for number, text in enumerate(texts)
    ]
    unit = CppUnit(files)
    evaluation = CppEvaluation(unit, _CALLS, budget)
    calls = [node for file in files for node in file.calls if node.kind == "call_expression"]
    used = [node for node in calls if called_name(node) == "use"]
    return [evaluation.evaluate_node(node) for node in list_arguments(used[-1])]


def shown(value: CppValue) -> object:
    """Return a value as text or number; None for one that is not known."""
    match value:
        case Unknown():
            return None
        case CppName():
            return f"<{value.name}>"
        case CppSum():
            return [shown(part) for part in value.parts]
        case CppCall():
            owner = f"{shown(value.owner)}." if value.owner is not None else ""
            types = f"<{', '.join(value.types)}>" if value.types else ""
            return f"{owner}{value.name}{types}({', '.join(str(shown(it)) for it in value.args)})"
        case list():
            return [shown(item) for item in value]
    return value


LITERALS = [
    ('"scan"', "scan"),
    ('"a" "b"\n"c"', "abc"),
    ('u8"a\\t\\x41\\101\\u00e9\\""', 'a\tAA\u00e9"'),
    ('R"(a\\n)"', "a\\n"),
    ('R"x(a)" )x"', 'a)" '),
    ('"scan"s', "scan"),
    ('std::string("a") + "b"', "ab"),
    ('std::string{"a"}', "a"),
    ("10", 10),
    ("-10", -10),
    ("1'000'000u", 1_000_000),
    ("0x1F", 31),
    ("0b101", 5),
    ("017", 15),
    ("0", 0),
    ("1.5f", 1.5),
    (".5", 0.5),
    ("1e3", 1000.0),
    ("-2.5e-1", -0.25),
    ("true", True),
    ("nullptr", None),
    ("500ms", "std::chrono::ms(500)"),
    ("0.5s", "std::chrono::s(0.5)"),
    ("1_km", None),
    ("{1, 2.0}", [1, 2.0]),
    ("std::vector<double>{1, 2}", "std::vector<double>(1, 2)"),
    ("(10)", 10),
    ("2 * 5", None),
    ("a ? 1 : 2", None),
    ("rclcpp::QoS(10).reliable()", "rclcpp::QoS(10).reliable()"),
    ("'a'", None),
    ("this", "<this>"),
    ("unseen", "<unseen>"),
]


@pytest.mark.parametrize(("text", "expected"), LITERALS)
def test_literals(text: str, expected: object) -> None:
    """A literal has the value that a compiler gives it; what is computed is not known."""
    [value] = evaluated(f"void f() {{ use({text}); }}")
    assert shown(value) == expected
    assert type(shown(value)) is type(expected)


NAMES = [
    ('#define NAME "a"\nvoid f() { use(NAME); }', "a"),
    ("#define NAME 5\nvoid f() { use(NAME); }", 5),
    ('#define NAME "a"\n#define NAME "b"\nvoid f() { use(NAME); }', None),
    ('#ifdef A\n#define NAME "a"\n#endif\nvoid f() { use(NAME); }', None),
    ("#define NAME OTHER\nvoid f() { use(NAME); }", None),
    ('#define NAME "a" OTHER\nvoid f() { use(NAME); }', None),
    ('const std::string name = "a"; void f() { use(name); }', "a"),
    ('constexpr char name[] = "a"; void f() { use(name); }', "a"),
    ('static const char * name = "a"; void f() { use(name); }', "a"),
    ('static constexpr auto name{"a"}; void f() { use(name); }', "a"),
    ('const std::string name("a"); void f() { use(name); }', "a"),
    ('namespace n { const auto name = "a"; } void f() { use(n::name); }', "a"),
    ('namespace n { const auto name = "a"; void f() { use(name); } }', "a"),
    ('namespace n { const auto name = "a"; } using namespace n; void f() { use(name); }', "a"),
    ('const auto name = "a"; namespace n { const auto name = "b"; void f() { use(name); } }', "b"),
    ('#if A\nconst auto name = "a";\n#endif\nvoid f() { use(name); }', None),
    ('const auto one = "a"; const std::string two = one + std::string("b"); void f() { use(two); }', "ab"),
    ("const auto one = two; const auto two = one; void f() { use(one); }", None),
    ('void f() { std::string name = "a"; use(name); }', "a"),
    ('void f() { std::string name; name = "a"; use(name); }', "a"),
    ('void f() { std::string name = "a"; name = "b"; use(name); }', "b"),
    ('void f() { std::string name = "a"; if (x) { name = "b"; } use(name); }', None),
    ('void f() { std::string name = "a"; name += "b"; use(name); }', None),
    ('void f() { std::string name = "a"; change(name); use(name); }', None),
    ('void f() { std::string name = "a"; read(name); use(name); }', "a"),
    ('void f() { std::string name = "a"; auto & other = name; use(name); }', None),
    ('void f() { std::string name = "a"; name.append("b"); use(name); }', "a.append(b)"),
    ('void f() { std::string name = "a"; if (x) { std::string name = "b"; } use(name); }', None),
    ('void f() { std::string name = "a"; use(name); name = "b"; }', "a"),
    ('void f() { std::string name; get("p", name); use(name); }', "get(p)"),
    ('void f() { std::string name; if (get("p", name)) {} use(name); }', None),
    ("void f(std::string name) { use(name); }", "<name>"),
    ("void f() { rclcpp::QoS qos(10); qos.best_effort(); use(qos); }", "rclcpp::QoS(10).best_effort()"),
    ("const int depth = 3; void f() { rclcpp::QoS qos(depth); use(qos); }", "rclcpp::QoS(3)"),
    ("void f() { int other(int); use(other); }", "<other>"),
    ("void f() { rclcpp::QoS qos(10); if (x) { qos.best_effort(); } use(qos); }", None),
    ("void f() { for (auto name : names) { use(name); } }", None),
    ('class A { void f() { use(name); } static constexpr auto name = "a"; };', "a"),
    ('class A { void f() { use(name); } std::string name{"a"}; };', "a"),
    ('class A { void f() { use(name); } std::string name{"a"}; void g() { name = "b"; } };', None),
    ('class A { A() : name("b") { use(name); } std::string name{"a"}; };', "b"),
    ('class A { A() { name = "b"; use(this->name); } std::string name; };', "b"),
    ('class A { A() { this->name = "b"; } void f() { use(name); } std::string name; };', "b"),
    ('class A { A() { use(name); name = "b"; } std::string name; };', None),
    ('class A { A() { if (x) { name = "b"; } use(name); } std::string name; };', None),
    ('class A { A() { change(name); use(name); } std::string name = "a"; };', None),
    ("class A { void f() { use(B::name); } }; struct B { static const int name = 3; };", 3),
    ('class B { void g() { name = "b"; } std::string name; }; class A { void f() { use(name); } std::string name = "a"; };', "a"),
    ('void g() { std::string name; name = "b"; } class A { void f() { use(name); } std::string name = "a"; };', "a"),
    ('void A::f() { use(name); } class A { static constexpr auto name = "a"; };', "a"),
    ('void f() { const std::string other; use(other + "b"); }', [None, "b"]),
]  # fmt: skip


@pytest.mark.parametrize(("text", "expected"), NAMES)
def test_names(text: str, expected: object) -> None:
    """A variable has a value where it is set once, before, and then only read."""
    [value] = evaluated(text)
    assert shown(value) == expected


def test_headers() -> None:
    """The constants of a header are those of the files that are compiled with it."""
    assert evaluated('#pragma once\n#define A "a"\n', "void f() { use(A); }") == ["a"]


BROKEN = [
    ('void f() { use("a"); ', "a"),
    ('void f() { use("a"); } class {', "a"),
    ('} ) void f() { use("a"); }', "a"),
    ('void f() { use("a"); g( }', "a"),
]


@pytest.mark.parametrize(("text", "expected"), BROKEN)
def test_half_written_files(text: str, expected: object) -> None:
    """A half-written file is read as far as it goes, and has the place of what is wrong."""
    assert evaluated(text) == [expected]
    assert parse_cpp(text.encode(), "a.cpp", Budget()).error is not None


def test_macros_without_effect() -> None:
    """Macros that only say what a library exports do not hide a class."""
    text = "class HUB_PUBLIC A : public B { RCLCPP_SMART_PTR_DEFINITIONS(A) Q_OBJECT int a; };"
    syntax = parse_cpp(text.encode(), "a.cpp", Budget())
    assert syntax.error is None
    [found] = CppFile(syntax).classes
    assert (found.name, found.bases) == ("A", ("B",))
