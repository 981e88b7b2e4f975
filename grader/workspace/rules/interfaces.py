"""Interfaces: the files of messages, services and actions, and the types that nodes use.

What generates code of the files is here, too, and so are the fields that nodes use.
"""

from collections.abc import Sequence
from functools import partial

from grader.base.names import closest, near
from grader.base.source import Location
from grader.base.text import MAX_NAMED, enumerated, quoted
from grader.ros.interfaces.interface_types import (
    BOOLEANS,
    FLOATS,
    INTEGERS,
    TEXTS,
    FieldType,
    Interface,
    InterfaceField,
)
from grader.ros.interfaces.known_interfaces import (
    find_change,
    is_open_in,
    known_interfaces,
)
from grader.ros.known.cmake_words import cmake_words
from grader.ros.known.releases import RELEASES, Release
from grader.ros.nodes.node_facts import FieldUse
from grader.ros.nodes.used_fields import FindInterface, UsedField, resolve_field
from grader.ros.package.package import Package
from grader.ros.package.package_interfaces import PackageInterfaces
from grader.ros.python.values import Value
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Compared,
    Facts,
    Mismatch,
    Mismatches,
    Undecided,
)
from grader.workspace.rules.rule_table import NO_INTERFACE, Rule, Symptom

_GROUP = "rosidl_interface_packages"
# What rosidl brings for services and actions without naming them.
_IMPLICIT = ("service_msgs", "action_msgs", "builtin_interfaces", "unique_identifier_msgs")
# What rosidl puts into messages, requests and goals without fields (rosidl_parser,
# EMPTY_STRUCTURE_REQUIRED_MEMBER_NAME); the classes of Python do not have it.
_OF_EMPTY = "structure_needs_at_least_one_member"
# Releases whose setters check the type of what is assigned: rosidl_generator_py of Foxy to Iron.
_CHECKING = RELEASES[: RELEASES.index("jazzy")]
# Types whose lists take bytes, too, or items of several types.
_OPEN_ITEMS = BOOLEANS | {"byte", "char", "octet", "uint8", "int8"}
# Releases that have the headers of all packages in one folder, where a compiler finds them.
_OF_ONE_FOLDER = frozenset({"foxy", "galactic"})


def interface_facts(workspace: Workspace) -> Facts:
    """Yield what is wrong with interfaces, and types and fields that are used and do not exist."""
    for package in workspace.packages:
        interfaces = workspace.code.interfaces[package.name]
        if not interfaces.location and not interfaces.unlisted:
            continue
        yield Compared("interfaces")
        if not interfaces.is_complete:
            reason = f"which interfaces {package.name!r} generates is not evaluated"
            yield Undecided("interfaces", reason)
        yield from _no_group(package, interfaces)
        yield from _unreadable_files(interfaces)
        yield from _types_of_fields(workspace, package, interfaces)
    for package in workspace.packages:
        yield from _used_types(workspace, package)
        for use in workspace.code.by_package[package.name].field_uses:
            workspace.charge(1 + len(use.path))
            yield from _used_field(workspace, use)


# --- Files and CMakeLists.txt


_INTERFACE_GROUP = Rule(
    "interface-group",
    "interfaces",
    NO_INTERFACE,
    "package.xml of a package with interfaces has <member_of_group>.",
    why=(
        "rosidl_generate_interfaces() stops CMake with an error. colcon builds neither the "
        "package nor those that depend on it."
    ),
    symptoms=(
        Symptom(
            "interfaces-without-group",
            pattern=(
                r"Packages installing interfaces must include "
                r"'<member_of_group>rosidl_interface_packages</member_of_group>'"
            ),
            source="ros2/rosidl 95739d5b, rosidl_cmake/cmake/rosidl_generate_interfaces.cmake:224",
            sentence="package.xml of a package with interfaces lacks a line.",
            example=(
                "Packages installing interfaces must include "
                "'<member_of_group>rosidl_interface_packages</member_of_group>' in their "
                "package.xml"
            ),
        ),
    ),
    wrong="<!-- no member_of_group -->",
    right="<member_of_group>rosidl_interface_packages</member_of_group>",
    frame="package.xml",
    beside={
        "types/CMakeLists.txt": "",
        "Speed.msg": "float64 speed",
    },
    at="package.xml",
)


def _no_group(package: Package, interfaces: PackageInterfaces) -> Mismatches:
    """Yield that package.xml does not say that a package has interfaces.

    Nothing is said of one that is not read whole, or that ROS 2 refuses.
    """
    manifest = package.manifest
    if not manifest or manifest.unread or manifest.refusals:
        return
    if interfaces.needs_group and _GROUP not in manifest.groups:
        message = (
            f"package.xml needs <member_of_group>{_GROUP}</member_of_group>: without it, "
            "rosidl_generate_interfaces() stops the build"
        )
        wrong = Mismatch(_INTERFACE_GROUP, message, manifest.name_location, interfaces.location)
        yield wrong.offering("", f"<member_of_group>{_GROUP}</member_of_group>")


_INTERFACE_FILE = Rule(
    "interface-file",
    "interfaces",
    NO_INTERFACE,
    "rosidl reads the files of messages, services and actions.",
    why=(
        "The build of the package stops at the file. None of its messages are generated, and "
        "packages that depend on it are not built."
    ),
    symptoms=(
        Symptom(
            "invalid-field-name",
            pattern=r"'(?P<field>\w{1,200}+)' is an invalid field name\.",
            source="ros2/rosidl 95739d5b, rosidl_adapter/rosidl_adapter/parser.py:372",
            sentence="The names of fields are written in lower case with single underscores.",
            example=(
                "Error processing 'int8 Id' of 'cell_msgs/Part': ''Id' is an invalid field name. "
                "It should have the pattern '^(?!.*__)(?!.*_$)[a-z][a-z0-9_]*$''"
            ),
            within=("field",),
        ),
        Symptom(
            "invalid-message-name",
            pattern=r"'(?P<file>\w{1,200}+)' is an invalid message name\.",
            source="ros2/rosidl 95739d5b, rosidl_adapter/rosidl_adapter/parser.py:222",
            sentence="The files of messages are named in CamelCase.",
            example=(
                "'part' is an invalid message name. It should have the pattern "
                "'^[A-Z][A-Za-z0-9]*$'"
            ),
            within=("file",),
        ),
    ),
    wrong="float Speed",
    right="float64 speed",
    frame="Speed.msg",
    beside={
        "types/CMakeLists.txt": "",
        "package.xml": "<member_of_group>rosidl_interface_packages</member_of_group>",
    },
)


def _unreadable_files(interfaces: PackageInterfaces) -> Mismatches:
    """Yield what rosidl cannot read in the files of interfaces."""
    for own_type in interfaces.types.values():
        for fault in own_type.interface.faults:
            message = f"rosidl cannot read the file: {fault.message}"
            wrong = Mismatch(_INTERFACE_FILE, message, fault.location)
            wrong = wrong.correcting(fault.written, fault.meant)
            yield wrong.offering(fault.written, fault.meant)


def _types_of_fields(
    workspace: Workspace, package: Package, interfaces: PackageInterfaces
) -> Mismatches:
    """Yield that nothing defines the type of a field.

    Otherwise yield that CMakeLists.txt does not name the package of the type.
    """
    for own_type in interfaces.types.values():
        for section in own_type.interface.sections:
            for field in section.fields.values():
                workspace.charge(1)
                kind = field.type
                at = field.location
                if not kind.package or not at:
                    continue
                absent = _no_type(workspace, f"{kind.package}.msg.{kind.name}", at)
                if absent:
                    yield absent
                elif kind.package != package.name:
                    yield from _no_dependency(workspace, interfaces, field, at)


_INTERFACE_DEPENDENCY = Rule(
    "interface-dependency",
    "interfaces",
    NO_INTERFACE,
    "rosidl_generate_interfaces() names the packages whose types fields have.",
    why=(
        "The build stops, because the generated code includes message headers of the other "
        "package that the compiler does not find."
    ),
    wrong='rosidl_generate_interfaces(${PROJECT_NAME} "msg/Speed.msg")',
    right='rosidl_generate_interfaces(${PROJECT_NAME} "msg/Speed.msg" DEPENDENCIES std_msgs)',
    frame="CMakeLists.txt",
    beside={
        "package.xml": "<member_of_group>rosidl_interface_packages</member_of_group>",
        "Speed.msg": "std_msgs/Header header",
    },
    at="msg/Speed.msg",
)


def _no_dependency(
    workspace: Workspace, interfaces: PackageInterfaces, field: InterfaceField, at: Location
) -> Mismatches:
    """Yield that CMakeLists.txt does not name the package of the type of a field.

    Nothing is said where not all is known that it names, and for releases that have all headers
    in one folder.
    """
    if not interfaces.is_complete or _OF_ONE_FOLDER.intersection(workspace.releases):
        return
    reached = _reached(workspace, interfaces)
    if reached is not None and field.type.package not in reached:
        message = (
            f"the field {field.name} has a type of {field.type.package}, which DEPENDENCIES of "
            "rosidl_generate_interfaces() does not name: the build stops"
        )
        yield Mismatch(_INTERFACE_DEPENDENCY, message, at, interfaces.location)


def _reached(workspace: Workspace, interfaces: PackageInterfaces) -> set[str] | None:
    """Return the packages whose messages an interface may use; None if not all are known."""
    exports = cmake_words().exports
    pending = [*interfaces.dependencies, *_IMPLICIT]
    reached = set()
    while pending:
        name = pending.pop()
        if name in reached:
            continue
        reached.add(name)
        other = workspace.code.interfaces.get(name)
        if other:
            pending += other.dependencies
        elif known_interfaces(name) is not None:
            pending += _packages_used(name)
        elif name not in exports:
            return None
        pending += exports.get(name, "").split() if not other else ()
    return reached


def _packages_used(package: str) -> set[str]:
    """Return the packages whose messages those of a well-known package use."""
    names = set[str]()
    for interface in (known_interfaces(package) or {}).values():
        for section in interface.sections:
            names.update(field.type.package for field in section.fields.values())
    return names - {"", package}


# --- Types


def is_absent(workspace: Workspace, name: str) -> bool:
    """Return whether nothing defines a type, such as chat_msgs.srv.Ask, if this is certain."""
    package, _, own_name = name.partition(".")
    if "_" in own_name:
        return False  # of a section or an event, which rosidl generates too
    interfaces = workspace.code.interfaces.get(package)
    if interfaces:
        return interfaces.is_complete and own_name not in interfaces.types
    known = known_interfaces(package, workspace.releases)
    if known is None or own_name in known:
        return False
    if is_open_in(workspace.releases):
        return find_change(package, own_name, workspace.releases) != ""
    return True


_INTERFACE_TYPE = Rule(
    "interface-type",
    "interfaces",
    NO_INTERFACE,
    "The messages, services and actions that code and interface files use exist.",
    why=(
        "A Python node ends at its start with an ImportError or ModuleNotFoundError. A C++ file"
        " does not compile, because the header does not exist."
    ),
    symptoms=(
        Symptom(
            "type-not-imported",
            pattern=(
                r"cannot import name '(?P<type>\w{1,200}+)' from "
                r"'[\w.]{1,200}\.(?:msg|srv|action)'"
            ),
            source="python/cpython v3.11.7, Lib/traceback.py:953",
            sentence="A package has no such message, service or action.",
            example="ImportError: cannot import name 'Twits' from 'geometry_msgs.msg'",
            within=("type",),
        ),
    ),
    wrong="""
def __init__(self):
    super().__init__('pilot')
    from std_msgs.msg import Float
    self.speeds = self.create_publisher(Float, 'speed', 10)
""",
    right="""
def __init__(self):
    super().__init__('pilot')
    from std_msgs.msg import Float64
    self.speeds = self.create_publisher(Float64, 'speed', 10)
""",
    frame="pilot.py",
)


def _no_type(workspace: Workspace, name: str, at: Location) -> Mismatch | None:
    """Return that nothing defines a type, if this is certain."""
    if not is_absent(workspace, name):
        return None
    package, _, own_name = name.partition(".")
    kind, _, short = own_name.partition(".")
    shown = f"there is no type {package}/{kind}/{short}"
    interfaces = workspace.code.interfaces.get(package)
    if interfaces and own_name in interfaces.unlisted:
        reason = f"rosidl_generate_interfaces() of {package} does not name its file"
        if not interfaces.location:
            reason = f"{package} does not call rosidl_generate_interfaces()"
        return Mismatch(_INTERFACE_TYPE, f"{shown}: {reason}", at, interfaces.location)
    if interfaces:
        names = list(interfaces.types)
    else:
        names = list(known_interfaces(package, workspace.releases) or {})
    workspace.charge(len(names))
    change = find_change(package, own_name, workspace.releases) if not interfaces else ""
    if change:
        return Mismatch(_INTERFACE_TYPE, f"{shown} {change}", at)
    return _no_type_among(names, shown, f"{package}/", own_name, at)


def _no_type_among(
    names: Sequence[str], shown: str, folder: str, own_name: str, at: Location
) -> Mismatch:
    """Return that a package has no type of a name, with one of another kind or a similar one."""
    kind, _, short = own_name.partition(".")
    for other in names:
        if other.partition(".")[2] == short:
            hint = f"there is {folder}{other.replace('.', '/')}"
            return Mismatch(_INTERFACE_TYPE, f"{shown}; {hint}", at)
    of_kind = [each.partition(".")[2] for each in names if each.startswith(f"{kind}.")]
    return _no_type_of_kind(shown, short, of_kind, at)


def _no_type_of_kind(shown: str, name: str, names: Sequence[str], at: Location) -> Mismatch:
    """Return that there is no type of a name, among those of its kind, and which one is meant."""
    meant = near(name, names) or closest(name, names)
    hint = ""
    if meant is not None:
        hint = f"; did you mean {meant}?"
    elif names and len(names) <= MAX_NAMED:
        hint = f"; there is {enumerated(names)}"
    wrong = Mismatch(_INTERFACE_TYPE, f"{shown}{hint}", at).correcting(name, meant)
    return wrong.offering(name, meant)


def _used_types(workspace: Workspace, package: Package) -> Facts:
    """Yield the types that a package's code imports or opens, and that do not exist."""
    nodes = workspace.code.by_package[package.name]
    used = {used_type.name: used_type.location for used_type in reversed(nodes.imports)}
    for node in nodes.nodes:
        for endpoint in node.endpoints:
            if endpoint.type is not None and endpoint.type.count(".") == 2:
                used.setdefault(endpoint.type, endpoint.location)
    for name, at in used.items():
        is_own = name.partition(".")[0] in workspace.code.interfaces
        if is_own or known_interfaces(name.partition(".")[0]) is not None:
            yield Compared("interfaces")
        absent = _no_type(workspace, name, at)
        if absent:
            yield absent


def find_interface(workspace: Workspace, package: str, name: str) -> Interface | None:
    """Return an interface by its package and name, msg.Twist; None where it is not known."""
    interfaces = workspace.code.interfaces.get(package)
    if interfaces:
        own_type = interfaces.types.get(name)
        return (
            own_type.interface if own_type is not None and not own_type.interface.faults else None
        )
    return (known_interfaces(package, workspace.releases) or {}).get(name)


# --- Fields


def _used_field(workspace: Workspace, use: FieldUse) -> Facts:
    """Yield that a type has no field that is used, or that it gets a value of another type."""
    find = partial(find_interface, workspace)
    used = resolve_field(use, find)
    if not used:
        return
    field = used.section.fields.get(used.name)
    if field:
        for value in use.literal:
            if isinstance(value, list):
                yield from _other_list(workspace, field, value, used.owner, use.location)
            elif not _fits(field.type, value, workspace.releases):
                message = (
                    f"the field {field.name} of {used.owner} is {_type_in_words(field.type)}; it "
                    f"is set to {_in_words(value)}"
                )
                yield Mismatch(_FIELD_VALUE, message, use.location)
    elif used.is_absent:
        yield from _no_field(workspace, used, find, use.location)


_INTERFACE_FIELD = Rule(
    "interface-field",
    "interfaces",
    NO_INTERFACE,
    "The fields and constants that code uses exist.",
    why=(
        "Python raises an AttributeError when the line runs, often first in a callback. A C++ "
        "file does not compile."
    ),
    symptoms=(
        Symptom(
            "no-attribute",
            pattern=r"'\w{1,200}' object has no attribute '(?P<field>\w{1,200}+)'",
            source="python/cpython v3.11.7, Lib/traceback.py:953",
            sentence="An object has no such field or method.",
            example="AttributeError: 'Twist' object has no attribute 'linaer'",
            within=("field",),
        ),
    ),
    wrong="""
speed = Float64()
speed.value = 1.0
self.speeds.publish(speed)
""",
    right="""
speed = Float64()
speed.data = 1.0
self.speeds.publish(speed)
""",
    frame="tick/pilot.py",
)


def _no_field(
    workspace: Workspace, used: UsedField, find: FindInterface, at: Location
) -> Mismatches:
    """Yield that a type does not have a field or a constant that code uses."""
    if used.name == _OF_EMPTY and not used.section.fields and not at.path.endswith(".py"):
        return
    workspace.charge(len(used.names))
    meant = used.find_meant(find)
    if meant is not None:
        hint = f"did you mean {meant}?"
    else:
        hint = f"it has {enumerated(used.names[:MAX_NAMED]) or 'none'}"
        if len(used.names) > MAX_NAMED:
            hint = f"{hint} and others"
    message = f"{used.owner} has no {used.noun} {quoted(used.name)}; {hint}"
    yield Mismatch(_INTERFACE_FIELD, message, at).correcting(used.name, meant)


_FIELD_VALUE = Rule(
    "field-value",
    "interfaces",
    NO_INTERFACE,
    "A field is set to a value of its type.",
    is_of_type=True,
    why=(
        "Up to Iron the assignment raises an AssertionError that stops a Python node. Later "
        "releases convert the value or fail when the message is sent."
    ),
    symptoms=(
        Symptom(
            "field-type",
            pattern=r"The '(?P<field>\w{1,200}+)' (?:sub )?field must be of type '",
            source="ros2/rosidl_python 4b5dfcf, rosidl_generator_py/resource/_msg.py.em:567",
            sentence="A field of a message is set to a value of another type.",
            example="AssertionError: The 'data' field must be of type 'float'",
            within=("field",),
        ),
    ),
    wrong="""
speed = Float64()
speed.data = '1.0'
self.speeds.publish(speed)
""",
    right="""
speed = Float64()
speed.data = 1.0
self.speeds.publish(speed)
""",
    frame="tick/pilot.py",
)


def _type_in_words(kind: FieldType) -> str:
    """Return the type of a field, as messages name it."""
    wanted = kind.full_name.replace(".", "/")
    return f"a list of {wanted}" if kind.is_list else wanted


def _other_list(
    workspace: Workspace, field: InterfaceField, items: Sequence[Value], shown: str, at: Location
) -> Mismatches:
    """Yield that a field is set to a list of another length, or with an item of another type.

    Up to Iron the setters of rclpy check both. From Jazzy on they convert numbers to floats, and
    refuse only what is no number, or a float among integers where the length is not fixed. That an
    integer is given for a float is a warning where no release is stated.
    """
    kind = field.type
    owner = f"the field {field.name} of {shown} is {_type_in_words(field.type)}"
    if not kind.is_list:
        if not kind.package and kind.name not in TEXTS:
            yield Mismatch(_FIELD_VALUE, f"{owner}; it is set to a list", at)
        return
    if kind.size is not None:
        is_wrong = len(items) > kind.size if kind.is_bounded else len(items) != kind.size
        if is_wrong:
            most = "at most " if kind.is_bounded else ""
            message = f"{owner} with {most}{kind.size} items; it is set to a list of {len(items)}"
            yield Mismatch(_FIELD_VALUE, message, at)
            return
    for item in items:
        if not isinstance(item, bool | int | float | str) or _fits_item(kind, item):
            continue
        message = f"{owner}; an item is {_in_words(item)}"
        is_certain = _is_refused(kind, item, workspace.releases)
        releases = workspace.releases
        if not is_certain and releases and not {*releases} & {*_CHECKING}:
            continue
        if not is_certain:
            message += ", which rclpy refuses up to Iron"
        yield Mismatch(_FIELD_VALUE, message, at, is_certain=is_certain)
        return


def _fits_item(kind: FieldType, item: Value) -> bool:
    """Return whether a list of a type certainly takes an item in all releases."""
    if kind.package or kind.name in _OPEN_ITEMS:
        return True
    return isinstance(item, _choose_type(kind))  # a bool is an int for rclpy, too


def _is_refused(kind: FieldType, item: Value, releases: tuple[Release, ...]) -> bool:
    """Return whether rclpy certainly refuses an item of another type, in all stated releases."""
    if releases and all(release in _CHECKING for release in releases):
        return not isinstance(item, bool)  # an integer
    is_text = isinstance(item, str)
    if kind.name in TEXTS or is_text:
        return is_text != (kind.name in TEXTS)
    is_fixed = kind.size is not None and not kind.is_bounded
    return kind.name in INTEGERS and isinstance(item, float) and not is_fixed


def _in_words(value: Value) -> str:
    kinds = {bool: "a boolean", int: "an integer", float: "a float", str: "a text"}
    if value is None:
        return "None"
    return f"{str(value)[:20]!r}, {kinds[type(value)]}"


def _fits(kind: FieldType, value: Value, releases: tuple[Release, ...]) -> bool:
    """Return whether a field may be set to a value; whether it is not is certain.

    From Jazzy on the setters check nothing, and the value is converted when the message is sent: 0
    then stands for 0.0 and False by chance.
    """
    if kind.package:
        return False
    if kind.is_list:
        return isinstance(value, str)  # text is a list of bytes for some
    is_checked = bool(releases) and all(release in _CHECKING for release in releases)
    is_zero = type(value) is int and value == 0
    if is_zero and not is_checked:
        return kind.name not in TEXTS
    return isinstance(value, _choose_type(kind))


def _choose_type(kind: FieldType) -> type:
    """Return the type of Python that a plain field has; object for one of several."""
    if kind.name in BOOLEANS:
        return bool
    if kind.name in FLOATS:
        return float
    if kind.name in INTEGERS - {"char"}:
        return int
    if kind.name in TEXTS:
        return str
    return object
