"""Plugins of own packages: the classes that files name, and what describes and exports these."""

import posixpath
import re
from collections.abc import Iterator, Sequence

from grader.base.names import closest, near
from grader.base.patterns import on_use
from grader.base.records import Named
from grader.base.source import Location, Source
from grader.ros.package.package import MANIFEST, Package
from grader.ros.xml.elements import first_text
from grader.workspace.graph.started_controllers import defined_controllers
from grader.workspace.model.text_files import MAX_YAML
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Compared,
    Facts,
    Mismatch,
    Mismatches,
    warning,
)
from grader.workspace.rules.rule_table import (
    NO_CONTROLLER,
    Rule,
)

_MADE = (".xml.in", ".xml.em")  # endings of files of which a build makes descriptions
_DESCRIBES = "base_class_type"
_LIBRARY = on_use(r"<library\s++path\s*+=\s*+[\"']([^\"']++)[\"']")
_CLASS = on_use(r"<class\s++([^<>]*+)>")
_ATTRIBUTE = on_use(r"\b(\w++)\s*+=\s*+[\"']([^\"']*+)[\"']")
# The packages whose classes are the bases of controllers and of hardware.
_CONTROLLERS = "controller_interface::"
_HARDWARE = "hardware_interface::"


class _DescribedClass(Named):
    """A class that a file for pluginlib describes, and where its element begins."""

    name: str  # by which pluginlib finds it
    type: str
    base: str
    package: str
    location: Location


class _NamedClass(Named):
    """A class that a file names for pluginlib."""

    name: str
    location: Location
    base: str
    user: str


def plugin_class_facts(workspace: Workspace) -> Facts:
    """Yield the classes of own packages that no file describes, and files that nothing exports."""
    described: list[_DescribedClass] = []
    for package in workspace.packages:
        for source in _descriptions(workspace, package):
            described += _classes_in(source, package.name)
            yield from _not_exported(package, source)
            yield from _other_libraries(package, source)
    yield from _not_described(workspace, described)


def _classes_in(source: Source, package: str) -> Iterator[_DescribedClass]:
    for element in _CLASS.finditer(source.text):
        attributes = {}
        for name, value in _ATTRIBUTE.findall(element[1]):
            attributes[name] = value
        kind = attributes.get("type", "")
        base = attributes.get(_DESCRIBES, "")
        at = source.at(element.start())
        yield _DescribedClass(attributes.get("name", kind), kind, base, package, at)


def described_classes(workspace: Workspace) -> Iterator[_DescribedClass]:
    """Yield the classes that the packages describe for pluginlib."""
    for package in workspace.packages:
        for source in _descriptions(workspace, package):
            yield from _classes_in(source, package.name)


def _descriptions(workspace: Workspace, package: Package) -> Iterator[Source]:
    """Yield the files of a package that describe classes."""
    for source in workspace.texts.read_sources(package, (".xml",)):
        if _DESCRIBES in source.text and source.path != package.path(MANIFEST):
            yield source


def named_classes(workspace: Workspace) -> Iterator[_NamedClass]:
    """Yield the controllers and hardware whose classes files name."""
    for controller in defined_controllers(workspace):
        name = controller.type.text or ""
        yield _NamedClass(name, controller.type.location, _CONTROLLERS, f"{controller.name}.type")
    for robot in workspace.robots.known:
        for system in robot.systems:
            for plugin in system.iterfind("hardware/plugin"):
                name = first_text(plugin)
                yield _NamedClass(name, robot.place(plugin), _HARDWARE, "<plugin>")


_PLUGIN_CLASS = Rule(
    "plugin-class",
    "controllers",
    NO_CONTROLLER,
    "A package of the workspace describes the controller or hardware that a file names.",
    why=(
        "pluginlib finds classes by the names in description files. For another name it reports"
        " that the class does not exist, and nothing is loaded."
    ),
    wrong="arm_controller: {type: rover/ArmControl}",
    right="arm_controller: {type: rover/ArmController}",
    frame="types/controllers.yaml",
    beside={
        "package.xml": "",
        "arm.cpp": "",
        "rover.launch.py": "",
        "arm/CMakeLists.txt": """
pluginlib_export_plugin_description_file(controller_interface plugins.xml)
""",
        "./plugins.xml": """
<class name="rover/ArmController" type="rover::Arm"
       base_class_type="controller_interface::ControllerInterface"/>
""",
    },
)


def _not_described(workspace: Workspace, described: Sequence[_DescribedClass]) -> Facts:
    """Yield the names of classes that their own package does not describe.

    It is yielded only of a package that describes classes of the same kind, and makes no
    descriptions.
    """
    for wanted in named_classes(workspace):
        prefix = re.split(r"/|::", wanted.name, maxsplit=1)[0]
        names = [
            each.name
            for each in described
            if each.package == prefix and each.base.startswith(wanted.base)
        ]
        owner = workspace.own_packages.get(prefix)
        if not names or not owner or any(path.endswith(_MADE) for path in owner.tree.files):
            continue
        yield Compared("controllers")
        if any(wanted.name in (each.name, each.type) for each in described):
            continue
        workspace.charge(len(names))
        meant = closest(wanted.name, names)
        hint = f"did you mean {meant!r}?" if meant is not None else f"it has {', '.join(names)}"
        message = f"{wanted.user}: the package {prefix!r} describes no {wanted.name!r}; {hint}"
        yield Mismatch(_PLUGIN_CLASS, message, wanted.location).correcting(wanted.name, meant)


_PLUGIN_EXPORTED = Rule(
    "plugin-exported",
    "controllers",
    NO_CONTROLLER,
    "CMakeLists.txt exports the files that describe plugins.",
    why=(
        "pluginlib reads only description files that are registered in the ament index. It "
        "reports an unknown class although the library is built and installed."
    ),
    wrong="# the build exports nothing",
    right="pluginlib_export_plugin_description_file(controller_interface plugins.xml)",
    frame="arm/CMakeLists.txt",
    beside={
        "package.xml": "",
        "arm.cpp": "",
        "rover.launch.py": "",
        "./plugins.xml": """
<class name="rover/ArmController" type="rover::Arm"
       base_class_type="controller_interface::ControllerInterface"/>
""",
        "arm.yaml": "arm: 1",
    },
    at="plugins.xml",
)


def _not_exported(package: Package, source: Source) -> Mismatches:
    """Yield a file of classes that neither CMakeLists.txt nor package.xml exports."""
    setup = package.installation
    if not setup or not package.is_cmake or setup.fault:
        return
    name = posixpath.basename(source.path)
    manifest = (package.tree.read(MANIFEST, MAX_YAML) or b"").decode("utf-8", "replace")
    text = setup.source.text
    is_read = "include(" not in text and "configure_file" not in text and "foreach" not in text
    if is_read and name not in text and name not in manifest and "pluginlib" in text:
        message = (
            f"no pluginlib_export_plugin_description_file() names {name}, so pluginlib finds none "
            "of its classes"
        )
        yield warning(_PLUGIN_EXPORTED, message, Location(source.path, 1, 1))


_PLUGIN_LIBRARY = Rule(
    "plugin-library",
    "controllers",
    NO_CONTROLLER,
    "A target makes the library of a file that describes plugins.",
    why=(
        "pluginlib knows the class, but finds no library to load it from. It raises a "
        "LibraryLoadException, and the controller or hardware is not loaded."
    ),
    wrong="""
<library path="arm_controls">
  <class type="rover::Arm" base_class_type="controller_interface::ControllerInterface"/>
</library>
""",
    right="""
<library path="arm_control">
  <class type="rover::Arm" base_class_type="controller_interface::ControllerInterface"/>
</library>
""",
    frame="./descriptions.xml",
    beside={
        "package.xml": "",
        "arm.cpp": "",
        "rover.launch.py": "",
        "arm/CMakeLists.txt": """
pluginlib_export_plugin_description_file(controller_interface descriptions.xml)
""",
        "arm.yaml": "arm: 1",
    },
)


def _other_libraries(package: Package, source: Source) -> Mismatches:
    """Yield the libraries of a file of classes that no target makes, where a similar one is."""
    setup = package.installation
    targets = setup.targets if setup and not setup.fault else ()
    names = [target.name for target in targets]
    for match in _LIBRARY.finditer(source.text):
        path = posixpath.basename(match[1])
        meant = near(path, names)
        if meant is None or {path, path.removeprefix("lib")} & {*names} or "$" in path:
            continue
        at = source.at(match.start(1))
        message = f"no target makes the library {path!r}"
        yield warning(_PLUGIN_LIBRARY, message, at).meaning(path, meant)
