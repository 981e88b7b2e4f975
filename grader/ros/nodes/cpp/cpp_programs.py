"""C++ programs and components that do not link, do not compile, or stop when they make a node."""

from grader.base.patterns import on_use
from grader.ros.cpp.declarations import CppClass, plain, short_name
from grader.ros.cpp.syntax import CppNode, CppNodes
from grader.ros.cpp.unit import CppUnit, called_name
from grader.ros.known.cmake_words import cmake_words
from grader.ros.nodes.cpp.cpp_files import CompiledTarget
from grader.ros.nodes.node_facts import (
    CodeFault,
    CodeFaults,
)

_SOURCES = (".cpp", ".cc", ".cxx", ".c++")
_MAIN = on_use(r"(?<![a-z])main(?![a-z])")
_REGISTERED = on_use(r"\bRCLCPP_COMPONENTS_REGISTER_NODE\s*\(\s*([\w:]+)\s*\)")
_INIT = ("init", "init_and_remove_ros_arguments", "Context", "InitOptions")
_OPTIONS = "NodeOptions"
# What NodeOptions is not converted to.
_OTHER_TYPES = on_use(
    r"(?:const\s+)?(?:std::string(?:_view)?|bool|char|int|float|double|(?:unsigned|long|short)\b.*"
    r"|std::(?:size_t|u?int\d+_t)|size_t|u?int\d+_t)(?:\s+const)?"
)
_SMALL_LIBRARIES = frozenset({"m", "dl", "pthread", "rt", "stdc++fs", "Threads", "Eigen3"})
_MESSAGES = ("_msgs", "_srvs", "_interfaces")


def program_faults(compiled: CompiledTarget, *, starts_nodes: bool) -> CodeFaults:
    """Yield why a target does not build, or why its program stops at once.

    Args:
        compiled: The target with its files.
        starts_nodes: Whether its functions make nodes.
    """
    target = compiled.target
    unit = compiled.unit
    if compiled.unread or not target.is_certain or target.has_other_sources:
        return
    yield from _components_without_constructor(unit)
    if target.kind == "executable" and all(path.endswith(_SOURCES) for path in target.sources):
        yield from _without_main(compiled)
        if starts_nodes:
            yield from _without_init(compiled)


def _without_main(compiled: CompiledTarget) -> CodeFaults:
    """Yield that no source of a program has a main()."""
    target = compiled.target
    unit = compiled.unit
    others = target.links + target.packages
    for file in unit.files:
        macros = [macro.name for macro in file.macros]
        words = (*file.words, *file.called_macros, *macros, *file.includes)
        if any(_MAIN.search(word.lower()) for word in words):
            return
    if any(_MAIN.search(name.lower()) for name in others) or not target.sources:
        return
    is_component = any(True for file in unit.files for _ in file.found(_REGISTERED))
    advice = ": a component is made by add_library()" if is_component else ""
    message = f"no source of the program {target.name!r} has a main(), so it does not link{advice}"
    yield CodeFault("program-main", message, compiled.at)


def _without_init(compiled: CompiledTarget) -> CodeFaults:
    """Yield that a program makes nodes, and nothing in it calls rclcpp::init().

    A library that is not read may call it, and so may what main() gives its arguments.
    """
    target = compiled.target
    unit = compiled.unit
    if len(unit.mains) != 1 or any(not file.words.isdisjoint(_INIT) for file in unit.files):
        return
    links = {name.partition("::")[0] for name in target.links + target.packages}
    if not all(_is_known_library(name) for name in links):
        return
    [main] = unit.mains
    parameters = {word.text for each in main.parameters for word in each.walk()}
    for node in main.body.walk():
        if node.kind == "identifier" and node.text in parameters:
            return  # it is given away
    message = "main() calls no rclcpp::init(), so the node is not made: the context is not valid"
    for call in unit.calls_in(main):
        if call.kind == "call_expression" and "rclcpp" in called_name(call):
            yield CodeFault("rclcpp-init", message, call.location)
            return
    yield CodeFault("rclcpp-init", message, main.node.location)


def _is_known_library(name: str) -> bool:
    words = cmake_words()
    known = words.exports.keys() | words.without_tests | _SMALL_LIBRARIES
    return name in known or name.lower() in known or name.endswith(_MESSAGES)


def _components_without_constructor(unit: CppUnit) -> CodeFaults:
    """Yield the registered classes of nodes that no NodeOptions can make.

    rclcpp_components makes them with std::make_shared<Class>(options).
    """
    for file in unit.files:
        for name, at in file.found(_REGISTERED):
            classes = unit.classes.get(plain(name), ())
            if len(classes) == 1 and _takes_options(unit, classes[0], 0) is False:
                message = (
                    f"the component {plain(name)!r} has no constructor that takes "
                    f"rclcpp::NodeOptions, so it does not compile"
                )
                yield CodeFault("component-constructor", message, classes[0].node.location, at)


def _takes_options(unit: CppUnit, each: CppClass, depth: int) -> bool | None:
    """Return whether a class can be made of NodeOptions; None where that is not known."""
    body = each.node.child("body")
    if not body or each.is_conditional or each.is_template or depth > 5:
        return None
    short = short_name(each.name)
    answers = []
    for node in body.children:
        if node.kind.startswith("preproc") or node.kind == "template_declaration":
            return None
        if node.kind == "using_declaration":
            answers.append(_inherits(unit, each, node, depth))
        constructor = _constructor_in(node, short)
        if constructor is not None:
            answers.append(_accepts(constructor))
    if True in answers:
        return True
    return None if None in answers else False


def _inherits(unit: CppUnit, each: CppClass, using: CppNode, depth: int) -> bool | None:
    """Return whether a constructor that `using` takes from a base takes NodeOptions."""
    written = plain(using.text.removeprefix("using").strip(" ;\n"))
    base, _, last = written.rpartition("::")
    scopes = each.name.split("::")[:-1]
    if short_name(base) != last:
        return False  # of another name
    for meaning in unit.meanings(base, scopes):
        if meaning in ("rclcpp::Node", "rclcpp_lifecycle::LifecycleNode"):
            return False  # they take a name first
        if len(unit.classes.get(meaning, ())) == 1:
            return _takes_options(unit, unit.classes[meaning][0], depth + 1)
    return None


def _constructor_in(node: CppNode, short: str) -> CppNodes | None:
    """Return the parameters of a constructor; None for another member."""
    if node.kind not in ("function_definition", "declaration", "field_declaration"):
        return None
    declarator = node.child("declarator")
    if declarator.kind != "function_declarator" or node.child("type"):
        return None
    is_of_class = declarator.child("declarator").text == short
    return declarator.child("parameters").code if is_of_class else None


def _accepts(parameters: CppNodes) -> bool | None:
    """Return whether a constructor can be called with one NodeOptions."""
    needed = [each for each in parameters if each.kind != "optional_parameter_declaration"]
    if not parameters or len(needed) > 1:
        return False
    kind = parameters[0].child("type")
    if not kind or parameters[0].kind == "variadic_parameter_declaration":
        return None
    if short_name(kind.text) == _OPTIONS:
        return True
    return False if _OTHER_TYPES.fullmatch(kind.text) else None
