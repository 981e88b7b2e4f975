"""The nodes of a package that are written in Python: what they declare and open.

The text is read and never run.

Only what is written as a text, number or constant is known.
What is opened under a condition is listed as well; actions and the topics of tf2 are not.
"""

import ast
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from functools import cache, cached_property, partial
from itertools import chain
from posixpath import basename

from grader.base.grouping import as_text, group_values, only_one
from grader.base.patterns import on_use
from grader.base.records import Named
from grader.base.reuse import Answers
from grader.base.slips import Slip, Slips
from grader.base.source import Edits, Location
from grader.base.text import first_part, last_part
from grader.ros.known.python_names import MODULES, python_names
from grader.ros.known.releases import RELEASES, Release
from grader.ros.nodes.message_uses import CodePart, field_uses, given_argument, type_imports
from grader.ros.nodes.node_facts import (
    CodeFault,
    Doubt,
    EncodingsByLocation,
    Endpoint,
    EndpointKind,
    FieldUse,
    NameOrParts,
    NodeFact,
    NodeFacts,
    NodeFrame,
    NodeParameter,
    NodeProgram,
    PackageNodes,
    Qos,
    SynchronisedType,
    Timer,
    TypeImport,
    make_node,
    updater_facts,
)
from grader.ros.nodes.python.branches import (
    calls_caught,
    calls_in_branches,
    loops_over_tuples,
)
from grader.ros.nodes.python.broadcast_transforms import SENDS, SendingMethod, sent_transforms
from grader.ros.nodes.python.code_faults import (
    ModuleText,
    attributes_in,
    code_faults,
    said_faults,
)
from grader.ros.nodes.python.endpoint_names import Bindings, EndpointNames, bindings
from grader.ros.nodes.python.inherited_nodes import OwnClass, with_inherited
from grader.ros.nodes.python.message_content import SUBSCRIBER, ContentReader
from grader.ros.nodes.python.rclpy_names import HARMLESS, NODE_CLASSES
from grader.ros.nodes.python.undefined_names import wrong_fields, wrong_objects
from grader.ros.nodes.python.unused_publishers import unused_publishers
from grader.ros.package.entry_points import (
    entry_as_meant,
    entry_points,
    module_path,
    read_module,
    unreadable_module,
)
from grader.ros.package.package import Package
from grader.ros.python.bindings import names_bound
from grader.ros.python.budget import PYTHON_LIMIT, Budget
from grader.ros.python.constants import Constants, constant_in, count_stored, dotted, make_order
from grader.ros.python.evaluation import record
from grader.ros.python.parse import (
    START,
    AnyFunction,
    Code,
    every_node,
    location_in,
    make_position,
    own_nodes,
    parse,
)
from grader.ros.python.python_slips import python_slips
from grader.ros.python.values import SCALARS, Call, QualifiedName, Scope, Unknown, Value
from grader.ros.python.walking import walk

_MAX_SEARCHED = 32 * 1024  # bytes of a program in which slips are searched
_MAX_MODULES = 100
_MAX_CODE = 512 * 1024  # characters of the modules of a package in which faults are searched
_OF_CALL = 4  # parts of a call that leads to a node
_MAX_ROUNDS = 50  # of a loop
_MAX_GUESSED = 20  # entry points of a package, of which each that names nothing may be misspelt
_BYTES_A_PART = 2  # of a program in which slips are searched, charged as one part
_DEPTH_OF_FILTERS = 10  # by message_filters of Jazzy
_CREATES = frozenset({"rclpy.create_node", *NODE_CLASSES})
_KINDS: dict[str, EndpointKind] = {
    "create_publisher": "publisher",
    "create_lifecycle_publisher": "publisher",
    "create_subscription": "subscription",
    "create_service": "service",
    "create_client": "client",
}
_ACTIONS: dict[str, EndpointKind] = {
    "ActionClient": "action client",
    "ActionServer": "action server",
}
_WITHOUT_NODES = ("rclpy", "tf2_ros", "message_filters", "numpy", "cv2", "cv_bridge", "yaml")
_MESSAGE_PART = on_use(r"\.(msg|srv|action)\.")
_READS_IF_DECLARED = ("get_parameter_or", "has_parameter")
_READS = ("get_parameter", *_READS_IF_DECLARED)
_DECLARES = ("declare_parameter", "declare_parameters")
# Of tf2_ros.Buffer of Jazzy, with the position of the source frame behind the target frame.
_LOOKUPS = {
    "lookup_transform": 1,
    "lookup_transform_async": 1,
    "lookup_transform_full": 2,
    "lookup_transform_full_async": 2,
}
_OPENING_METHODS = frozenset({*_KINDS, *_DECLARES})
_METHODS = frozenset({*_KINDS, *_READS, *_DECLARES, "create_timer"})
# Makes a node in the same process by itself, for which launch gives parameters: moveit_py of
# moveit2.
_MAKES_A_NODE = ("moveit.planning.MoveItPy", "moveit.MoveItPy")
# By rclpy/qos.py of Jazzy, as qos_profile_NAME and as QoSPresetProfiles.NAME.value: depth,
# reliability, durability.
_PROFILES = {
    "sensor_data": (5, "best_effort", "volatile"),
    "services_default": (10, "reliable", "volatile"),
    "parameters": (1000, "reliable", "volatile"),
    "system_default": (None, "system_default", "system_default"),
}
# The policies that are told apart, by the group that older names begin with.
_GROUPS = {
    "reliable": "reliability",
    "best_effort": "reliability",
    "transient_local": "durability",
    "volatile": "durability",
}
# Arguments of Node that let it accept other parameters, or change its names; None is for **.
_OPTIONS = (
    None,
    "namespace",
    "cli_args",
    "parameter_overrides",
    "allow_undeclared_parameters",
    "automatically_declare_parameters_from_overrides",
)


class _Name(Named):
    """The name that a node is given, and where."""

    name: str | None
    location: Location


_TRANSFORM = "TransformStamped"
_Fact = NodeFact | _Name


def read_nodes(
    package: Package, answers: Answers[Package], *, reads_meant: bool = False
) -> PackageNodes:
    """Return the nodes in the Python modules that a build of a package installs. It never raises.

    With `reads_meant`, an entry point that surely is misspelt creates the nodes of the one meant.
    `answers` are what the package says of the others in its workspace.
    """
    modules, unread = _read_modules(package)
    doubts = [Doubt("the file is not read", Location(package.path(path), 1, 1)) for path in unread]
    every_module = _modules_with_bases(package, modules, answers)
    every_node = _nodes_of_modules(every_module)
    nodes = [node for node in every_node if package.holds(node.location.path)]
    if not unread:
        unused = unused_publishers(module.text().code for module in every_module.values())
        # Other packages have modules that are not read here.
        unused = {at for at in unused if package.holds(at.path)}
        nodes = [_with_unused(node, unused) for node in nodes]
    doubts += (doubt for module in modules.values() for doubt in module.doubts)
    searched = _search_faults(modules.values(), package.releases)
    programs = []
    for program in _programs(package, modules, nodes, reads_meant=reads_meant):
        read, doubts_of_program = _without_stopped(package, program, searched)
        programs.append(read)
        doubts += doubts_of_program
    return _joined_nodes(searched, nodes, programs, doubts)


def _nodes_of_modules(modules: Mapping[str, "_Module"]) -> list[NodeFacts]:
    """Return the nodes of modules, each with what its base classes in them do."""
    kinds = _derived_classes(modules)
    nodes = []
    classes: dict[str, OwnClass] = {}
    for module in modules.values():
        nodes += module.read_nodes(kinds)
        classes |= module.own_classes()
    return with_inherited(nodes, classes, _OPTIONS)


def _with_unused(node: NodeFacts, unused: Collection[Location]) -> NodeFacts:
    """Return a node whose publishers at some places are not used."""
    if not unused:
        return node
    endpoints = []
    for endpoint in node.endpoints:
        is_unused = endpoint.kind == "publisher" and endpoint.location in unused
        endpoints.append(endpoint._replace(is_unused=is_unused))
    return node._replace(endpoints=tuple(endpoints))


def _without_stopped(
    package: Package, program: NodeProgram, searched: "_Searched"
) -> tuple[NodeProgram, list[Doubt]]:
    """Return a program, without its nodes if it stops before it makes them; and why it stops."""
    slips = _find_slips(package, program, searched)
    if slips is None:
        doubt = Doubt("not all programs are read", program.location)
        return program._replace(nodes=()), [doubt]
    is_read = package.path(program.path) in searched.modules
    syntax = None if is_read else unreadable_module(package, program.path)
    read = program._replace(nodes=() if slips else program.nodes, syntax=syntax)
    return read, [Doubt(slip.reaction, slip.location) for slip in slips]


def _read_modules(package: Package) -> tuple[dict[str, "_Module"], list[str]]:
    """Return the modules that a build installs, by their names, and the files that are not read."""
    modules = {}
    unread = []
    for name, path in _module_paths(package).items():
        code = read_module(package, path)
        if not code:
            unread.append(path)
        else:
            is_package = path.endswith("/__init__.py")
            modules[name] = _Module(code, name, package.work, is_package=is_package)
    return modules, unread


def _modules_with_bases(
    package: Package, modules: Mapping[str, "_Module"], answers: Answers[Package]
) -> dict[str, "_Module"]:
    """Return modules with those of other packages of the workspace that have base classes."""
    every = dict(modules)
    pending = list(modules.values())
    while pending and len(every) < _MAX_MODULES:
        for base in chain.from_iterable(pending.pop().bases.values()):
            name = (base or "").rpartition(".")[0]
            file = None if name in every else answers.ask(partial(_base_module, name))
            code = parse(*file, package.releases) if file else None
            if isinstance(code, Code):
                is_package = code.source.path.endswith("/__init__.py")
                every[name] = _Module(code, name, package.work, is_package=is_package)
                pending.append(every[name])
    return every


def _base_module(name: str, package: Package) -> tuple[bytes, str] | None:
    """Return the content and the path of a module that a package of the workspace installs.

    It is None if colcon does not build that package, which is ignored or in another one.
    """
    owner = package.packages.get(first_part(name))
    if not owner or owner.ignored_by:
        return None
    others = (other for other in package.packages.values() if other is not owner)
    path = _module_paths(owner).get(name)
    data = owner.tree.read(path, PYTHON_LIMIT) if path else None
    if not path or data is None or any(other.holds(owner.path("")) for other in others):
        return None
    return data, owner.path(path)


def _derived_classes(modules: Mapping[str, "_Module"]) -> set[str]:
    """Return the full names of the classes of nodes, rclpy's own ones and those of modules."""
    bases: dict[str, Sequence[str | None]] = {}
    for module in modules.values():
        bases |= module.bases
    derived = group_values((base, full) for full, own_bases in bases.items() for base in own_bases)
    kinds = set(NODE_CLASSES)
    reached = list(NODE_CLASSES)
    while reached:
        more = [full for full in derived.get(reached.pop(), ()) if full not in kinds]
        kinds.update(more)
        reached += more
    return kinds


class _Searched(Named):
    """The modules of a package, and the faults that are found in each of them, by their paths."""

    modules: Mapping[str, "_Module"]
    faults: Mapping[str, Sequence[CodeFault]]
    is_whole: bool  # whether all of them are searched


def _joined_nodes(
    searched: _Searched,
    nodes: Sequence[NodeFacts],
    programs: Sequence[NodeProgram],
    doubts: Sequence[Doubt],
) -> PackageNodes:
    """Return the nodes of a package with what its modules import and use, and their faults."""
    modules = searched.modules.values()
    is_loose = any(module.has_loose_declarations for module in modules)
    imports = [type_import for module in modules for type_import in module.type_imports()]
    uses = [use for module in modules for use in module.field_uses]
    synchronised: list[SynchronisedType] = []
    for module in modules:
        synchronised += module.synchronised_types()
    faults: list[CodeFault] = []
    for of_module in searched.faults.values():
        faults += said_faults(of_module)
    return PackageNodes(
        nodes=tuple(nodes),
        programs=tuple(programs),
        doubts=tuple(doubts),
        has_loose_declarations=is_loose,
        imports=tuple(imports),
        field_uses=tuple(uses),
        faults=tuple(faults),
        synchronised=tuple(synchronised),
        has_more_faults=not searched.is_whole,
    )


def _search_faults(modules: Collection["_Module"], releases: Sequence[Release]) -> _Searched:
    """Return the modules of a package with the faults in their code."""
    texts = [module.text() for module in modules]
    by_name = {text.name: text for text in texts}
    attributes = attributes_in(texts)
    by_path = {}
    faults = {}
    left = _MAX_CODE
    is_whole = True
    for module, text in zip(modules, texts, strict=True):
        source = text.code.source
        by_path[source.path] = module
        left -= len(source.text)
        try:
            if left >= 0:
                computed = wrong_objects(source, module.field_uses)
                of_code = code_faults(text, by_name, attributes, releases)
                faults[source.path] = [*of_code, *computed]
        except RecursionError:
            left = -1
        is_whole = is_whole and left >= 0
    return _Searched(by_path, faults, is_whole)


def program_slips(package: Package) -> Slips:
    """Yield the slips for which a program in Python stops, or does nothing."""
    slips: dict[Edits, Slip] = {}
    modules, _ = _read_modules(package)
    searched = _search_faults(modules.values(), package.releases)
    for program in _programs(package, {}, ()):
        for slip in _find_slips(package, program, searched) or ():
            slips.setdefault(slip.edits, slip)
    yield from slips.values()


def _find_slips(
    package: Package, program: NodeProgram, searched: _Searched
) -> Sequence[Slip] | None:
    """Return the slips of a program; None where too many programs are in a file to search each."""
    data = package.tree.read(program.path, _MAX_SEARCHED)
    if not package.budget.take_of_whole(len(data or b"") // _BYTES_A_PART):
        return None
    path = package.path(program.path)
    module = searched.modules.get(path)
    if data is None:
        return ()
    if not module:
        return python_slips(data, path)
    from grader.ros.nodes.python.running_code import assumed_fixes  # late: many have no programs

    text = module.text()
    fields = wrong_fields(text.code.source, module.field_uses, package.releases)
    faults = [*searched.faults.get(path, ()), *fields]
    return list(assumed_fixes(text, program.function, faults))


def _module_paths(package: Package) -> dict[str, str]:
    """Return the files of the installed modules, and those of installed programs.

    Modules are listed by their full names, programs by their paths.
    """
    setup = package.installation
    if not setup:
        return {}
    files = [path for path in package.tree.files if path.endswith(".py")]
    folders = {path.rpartition("/")[0] for path in files if path.endswith("/__init__.py")}
    packages = {name.replace(".", "/") for name in setup.packages} or folders
    modules = {}
    for path in files:
        if path.rpartition("/")[0] in packages:
            name = path.removesuffix(".py").removesuffix("/__init__").replace("/", ".")
            modules[name] = path
    rows = list(modules.items())
    rows += [(script.source, script.source) for script in package.python_scripts]
    return dict(rows[:_MAX_MODULES])


def _programs(
    package: Package,
    modules: "dict[str, _Module]",
    nodes: Sequence[NodeFacts],
    *,
    reads_meant: bool = False,
) -> Iterator[NodeProgram]:
    """Yield the entry points, and the files that are programs, with the nodes that they create."""
    by_key: dict[object, list[NodeFacts]] = {}
    for node in nodes:
        by_key.setdefault(node.location, []).append(node)
        if node.class_name:
            by_key.setdefault(node.class_name, []).append(node)
    created_by = partial(_created_by, package, modules, by_key)
    may_guess = _MAX_GUESSED if reads_meant else 0
    for number, written in enumerate(entry_points(package)):
        entry = entry_as_meant(package, written) if number < may_guess else written
        created, has_more = created_by(entry.module, entry.function)
        path = module_path(package, entry.module) or ""
        program = NodeProgram(entry.name, created, entry.location, path, entry.function)
        yield program._replace(may_have_more=has_more)
    for copy in package.python_scripts:
        at = Location(package.path(copy.source), 1, 1)
        name = basename(copy.target)
        created, has_more = created_by(copy.source, "")
        program = NodeProgram(name, created, at, copy.source, "")
        yield program._replace(may_have_more=has_more)


def _created_by(
    package: Package,
    modules: "dict[str, _Module]",
    nodes: Mapping[object, Sequence[NodeFacts]],
    module: str,
    function: str,
) -> tuple[tuple[NodeFacts, ...], bool]:
    """Return the nodes that a function creates, and whether it may create others.

    Those of the functions and classes that it calls count. Classes that are not of the package may
    be those of nodes, those that methods call only if they are of the workspace. Without a name,
    the function is the module's body. None are known where too many
    functions call others.

    `nodes` are those at a place, and those of a class by its full name.
    """
    created: dict[Location, NodeFacts] = {}
    pending = [(f"{module}.{function}", False)]
    seen = set()
    has_more = False
    while pending:
        name, is_of_class = pending.pop(0)
        owner = modules.get(name.rpartition(".")[0]) or modules.get(name)
        other = package.packages.get(first_part(name))
        is_other = other is not None and other.name != package.name
        may_be_node = _may_be_node_class(name) and (is_other or not is_of_class)
        has_more = has_more or (not owner and may_be_node)
        if name in seen or not owner:
            continue
        seen.add(name)
        calls = owner.calls_in(last_part(name))
        if not package.budget.take_of_whole(_OF_CALL * (1 + len(calls))):
            return (), True
        for called, at in calls:
            created |= {
                node.location: node for node in (*nodes.get(at, ()), *nodes.get(called, ()))
            }
            pending.append((called, name in owner.bases))
    return tuple(created.values()), has_more


def _may_be_node_class(name: str) -> bool:
    """Return whether a full name may be that of a class of nodes of another package."""
    package, _, rest = name.partition(".")
    last = last_part(rest)
    is_other = package not in python_names(MODULES, RELEASES) and package not in _WITHOUT_NODES
    return is_other and last[:1].isupper() and not _MESSAGE_PART.search(name)


def _find_calls(nodes: Sequence[ast.AST]) -> list[ast.Call]:
    return sorted((node for node in nodes if isinstance(node, ast.Call)), key=make_order)


class _Module:
    """A module.

    First its scopes and the bases of its classes are read, then, once all nodes are known, their
    calls.
    """

    def __init__(self, code: Code, name: str, work: Budget, *, is_package: bool) -> None:
        self._code = code
        self._name = name
        self._at = code.at
        functions = dict.fromkeys(("rclpy.qos.QoSProfile", *_CREATES), record)
        syntax = code.nodes
        self._constants = Constants(syntax, name, functions, work, is_package=is_package)
        # Of the classes, by full names; None for a base that is not known.
        self.bases: dict[str, list[str | None]] = {}
        self.doubts: list[Doubt] = []
        self.has_loose_declarations = False
        for alias in _find_aliases(code.tree):
            if alias.attr in _DECLARES:
                self.has_loose_declarations = True
            else:
                self.doubts.append(Doubt(f"another name may call {alias.attr}", self._at(alias)))
        self._classes: dict[Location, str] = {}
        self._class_nodes: dict[Location, ast.ClassDef] = {}
        self._facts: dict[Location, list[_Fact]] = {}  # of each node
        # The nodes that parameters of functions are, by the names of both.
        self._given_nodes: Mapping[tuple[str, str], Location | None] = {}
        self._parts: list[CodePart] = []
        body = own_nodes(code.tree)
        scope = self._constants.bound(body, Scope({}))
        for part in body:
            if isinstance(part, AnyFunction | ast.ClassDef) and part.name in scope.names:
                scope.names[part.name] = QualifiedName(f"{name}.{part.name}")
        self._parts.append(CodePart("", code.tree, _find_calls(body), scope))
        for part in body:
            if isinstance(part, AnyFunction):
                inner = walk(part)
                self._parts.append(
                    CodePart(
                        part.name,
                        part,
                        _find_calls(inner),
                        self._constants.bound(inner, Scope({}, scope)),
                    )
                )
            elif isinstance(part, ast.ClassDef):
                self._add_class(part, scope)

    def _add_class(self, node: ast.ClassDef, scope: Scope) -> None:
        """Keep a class and its methods, which reach its constants as attributes of self."""
        at = self._at(node)
        full = f"{self._name}.{node.name}"
        bases = [self._constants.evaluate_node(base, scope) for base in node.bases]
        self.bases[full] = [name for name in map(_full_name, bases) if name != "abc.ABC"]
        self._classes[at] = full
        self._class_nodes[at] = node
        nodes_of_class = own_nodes(node)
        constants = self._constants.bound(nodes_of_class, Scope({}, scope)).names
        attributes = Scope({f"self.{name}": value for name, value in constants.items()}, scope)
        for method in nodes_of_class:
            if not isinstance(method, AnyFunction):
                continue
            nodes = walk(method)
            local = self._constants.bound(nodes, Scope({}, attributes))
            for name in [name for name in local.names if name.startswith("self.")]:
                value = local.names.pop(name)
                is_first = name not in attributes.names
                attributes.names[name] = (
                    value if is_first else Unknown("it is not bound once", START)
                )
            self._parts.append(CodePart(method.name, method, _find_calls(nodes), local, at))

    def read_nodes(self, kinds: Collection[str]) -> list[NodeFacts]:
        """Return the nodes, once the full names of all classes of nodes are known."""
        for at, full in self._classes.items():
            if full in kinds:
                self._facts[at] = []
                if not NODE_CLASSES.issuperset(self.bases[full]):
                    reason = "what another base class does is not added"
                    doubt = Doubt(reason, at, "base class")
                    self._facts[at].append(doubt)
        self._read_calls()
        if self._constants.budget.is_spent:
            self.doubts.append(
                Doubt("the module is too long to evaluate", Location(self._code.source.path, 1, 1))
            )
        if "frame_id" in self._code.text:
            for part in self._parts:
                if part.of in self._facts:
                    self._facts[part.of] += self._frames_of_messages(part)
        encodings = self._content.encodings() if self._uses("cv_bridge") else {}
        return [self._node(at, facts, encodings) for at, facts in self._facts.items()]

    def own_classes(self) -> dict[str, OwnClass]:
        """Return the classes of the module by their full names."""
        scopes = {part.of: part.scope for part in self._parts if part.name == "__init__"}
        own_classes = {}
        for at, full in self._classes.items():
            evaluate = partial(self._value_in, scopes.get(at, Scope({})))
            own_classes[full] = OwnClass(self._class_nodes[at], self.bases[full], at.path, evaluate)
        return own_classes

    def _read_calls(self) -> None:
        """Add the nodes that calls make, then the facts that calls add to nodes."""
        calls = [(part, call) for part in self._parts for call in part.calls]
        for part, call in calls:
            if self._called(part, call) in _CREATES:
                name = as_text(self._argument(part, call, 0, "node_name"))
                self._facts[self._at(call)] = [_Name(name, self._at(call))]
        self._read_parameters_that_are_nodes(calls)
        for part, call in calls:
            for round_part in self._rounds.get(call, [part]):
                self._read_call(round_part, call)
            self._read_transforms(part, call)
            if self._called(part, call) in _MAKES_A_NODE:
                for facts in self._facts.values():
                    facts.append(
                        Doubt("another node takes the parameters of the process", self._at(call))
                    )

    def _read_parameters_that_are_nodes(self, calls: Sequence[tuple[CodePart, ast.Call]]) -> None:
        """Keep which parameters of the module's functions are nodes, as all their calls say.

        A function that is given a node may give it to another one.
        """
        given = []
        for part, call in calls if self._facts else ():
            called = self._called(part, call).removeprefix(f"{self._name}.")
            if called in self._functions:
                for name, argument in _parameters_given(self._functions[called].node, call):
                    given.append((part, called, name, argument))
        for _ in self._functions if given else ():
            nodes: dict[tuple[str, str], Location | None] = {}
            for part, called, name, argument in given:
                node = self._receiver(part, argument)
                nodes[called, name] = node if nodes.get((called, name), node) == node else None
            if nodes == self._given_nodes:
                break
            self._given_nodes = nodes

    def synchronised_types(self) -> Iterator[SynchronisedType]:
        """Yield the types of the messages that synchronisers compare."""
        if self._uses("message_filters"):
            yield from self._content.synchronised_types()

    def _uses(self, module: str) -> bool:
        """Return whether the code imports another module, or something of it."""
        return any(first_part(name) == module for name in self._constants.imported)

    @cached_property
    def _content(self) -> ContentReader:
        return ContentReader(
            self._parts, self._code.source, self._constants.evaluate_node, self._bindings_around
        )

    def _bindings_around(self, part: CodePart) -> Bindings:
        """Return what the names in a function, and the attributes of its class, are bound to."""
        return self._bindings_in(part.of).within(self._find_bindings(part.node))

    def text(self) -> ModuleText:
        """Return the module as it is searched for faults."""
        nodes = {
            at: self._class_nodes[at]
            for at, full in self._classes.items()
            if self.bases[full] and NODE_CLASSES.issuperset(self.bases[full])
        }
        return ModuleText(
            self._name,
            self._code,
            self._parts,
            self._constants.imported,
            nodes,
            self._class_nodes,
        )

    def type_imports(self) -> Iterator[TypeImport]:
        """Yield the messages, services and actions that the module certainly imports."""
        return type_imports(self._code.tree, self._code.source)

    @cached_property
    def field_uses(self) -> Sequence[FieldUse]:
        """The fields that the module uses of messages, services and actions."""
        nodes = self.text().nodes
        return list(field_uses(self._code, self._parts, self._constants.evaluate_node, nodes))

    def _node(
        self,
        at: Location,
        facts: "Sequence[_Fact]",
        encodings: EncodingsByLocation,
    ) -> NodeFacts:
        names = {fact.name: fact.location for fact in facts if isinstance(fact, _Name)}
        name, named_at = next(iter(names.items())) if len(names) == 1 else (None, None)
        node = make_node(facts, encodings, self._classes.get(at, ""), name, at)
        return node._replace(named_at=named_at)

    def calls_in(self, function: str) -> Sequence[tuple[str, Location]]:
        """Return the full name and place of each call in a function of the module, or its body."""
        return self._calls_by_function.get(function, ())

    @cached_property
    def _functions(self) -> Mapping[str, CodePart]:
        """The functions of the module by their names."""
        return {part.name: part for part in self._parts if not part.of and part.name}

    @cached_property
    def _calls_by_function(self) -> Mapping[str, Sequence[tuple[str, Location]]]:
        calls: dict[str, list[tuple[str, Location]]] = {}
        constructing = set()
        for part in self._parts:
            for call in part.calls if part.name == "__init__" else ():
                constructing.add((part.of, dotted(call.func).removeprefix("self.")))
        for part in self._parts:
            # A class is called, and with it its constructor, and what that calls.
            if part.of and part.name != "__init__" and (part.of, part.name) not in constructing:
                continue
            name = last_part(self._classes[part.of]) if part.of else part.name
            of_part = calls.setdefault(name, [])
            for call in part.calls:
                called = self._called(part, call)
                helper = self._functions.get(called.removeprefix(f"{self._name}."))
                made = self._made_by(helper, part, call) if helper else ()
                of_part += [(name, self._at(call)) for name in (called, *made)]
        return calls

    def _made_by(self, helper: CodePart, part: CodePart, call: ast.Call) -> Iterator[str]:
        """Yield the full names of the classes that a function is given by a call, and calls."""
        called = {dotted(inner.func) for inner in helper.calls}
        for name, argument in _parameters_given(helper.node, call):
            given = constant_in(part.scope, dotted(argument))
            if isinstance(given, QualifiedName) and name in called:
                yield given.name

    @cached_property
    def _rounds(self) -> Mapping[ast.Call, list[CodePart]]:
        """The calls in loops over tuples that the file lists, each with a part for each tuple."""
        rounds: dict[ast.Call, list[CodePart]] = {}
        for part in self._parts:
            for target, items, body in loops_over_tuples(part.node):
                bound = self._bindings_around(part).values.get(dotted(items), items)
                values = self._constants.evaluate_node(bound, part.scope)
                parts = list(_bind_rounds(part, target, values))[:_MAX_ROUNDS]
                if parts:
                    rounds |= dict.fromkeys(_find_calls(body), parts)
        return rounds

    def _called(self, part: CodePart, call: ast.Call) -> str:
        first, dot, rest = dotted(call.func).partition(".")
        constant = constant_in(part.scope, first)
        if isinstance(constant, QualifiedName):
            return f"{constant.name}{dot}{rest}"
        return ""

    def _argument(self, part: CodePart, call: ast.Call, position: int, name: str) -> Value:
        """Return an argument of a call.

        The result is None where it is missing, Unknown where * or ** may give it.
        """
        if any(isinstance(argument, ast.Starred) for argument in call.args[: position + 1]):
            return Unknown("it is unpacked", make_position(call))
        given = given_argument(call, position, name)
        if not given and any(keyword.arg is None for keyword in call.keywords):
            return Unknown("it is unpacked", make_position(call))
        return self._constants.evaluate_node(given, part.scope)

    def _endpoints(
        self, part: CodePart, call: ast.Call, position: int, name: str, endpoint: Endpoint
    ) -> Iterator[Endpoint]:
        """Yield an endpoint for each name that an argument of a call gives it."""
        for text, parts in self._names(part, call, position, name):
            is_conditional = call in self._conditional_calls
            yield endpoint._replace(
                name=text,
                parts=parts,
                is_conditional=is_conditional,
                is_caught=call in self._caught_calls,
            )

    @cached_property
    def _conditional_calls(self) -> frozenset[ast.Call]:
        """The calls that a condition decides, searched once."""
        return calls_in_branches(self._code.tree)

    @cached_property
    def _caught_calls(self) -> frozenset[ast.Call]:
        """The calls whose errors may be caught, searched once."""
        return calls_caught(self._code.tree)

    def _names(
        self, part: CodePart, call: ast.Call, position: int, name: str
    ) -> Iterator[NameOrParts]:
        """Yield each name that an argument of a call is, as its text or its parts."""
        value = self._argument(part, call, position, name)
        given = given_argument(call, position, name)
        if isinstance(value, str) or not given:
            yield as_text(value), ()
        else:
            yield from self._names_written(part, given)

    def _names_written(self, part: CodePart, given: ast.expr) -> Iterator[NameOrParts]:
        """Yield each name that an expression is, as its text or its parts."""
        names = EndpointNames(self._bindings_around(part), partial(self._value_in, part.scope))
        for parts in names.read(given):
            kinds = {name_part.kind for name_part in parts}
            if kinds == {"text"}:
                yield parts[0].text, ()
            else:
                yield None, parts if kinds != {"unknown"} else ()

    def _value_in(self, scope: Scope, node: ast.expr) -> Value:
        return self._constants.evaluate_node(node, scope)

    def _bindings_in(self, of: Location | None) -> Bindings:
        """Return what the attributes of self in a class are bound to once."""
        if not of:
            return Bindings({}, {})
        return self._find_bindings(self._class_nodes[of])

    @cached_property
    def _find_bindings(self) -> Callable[[ast.AST], Bindings]:
        """What the names in a function, or the attributes of self in a class, are bound to."""
        return cache(_find_bindings)

    def _receiver(self, part: CodePart, node: ast.expr) -> Location | None:
        """Return the place of the node that an expression is; None where that is not known."""
        name = dotted(node)
        if name == "self":
            if part.of in self._facts:
                return part.of
            return None
        value = constant_in(part.scope, name)
        at: Location | None = None
        if isinstance(value, Call) and value.name in _CREATES:
            at = location_in(self._code.source, value.at)
        elif not part.of:
            at = self._given_nodes.get((part.name, name))
        return at if at in self._facts else None

    def _read_call(self, part: CodePart, call: ast.Call) -> None:
        """Add what a call declares or opens to the facts of its node."""
        match call.func:
            case ast.Attribute(value=owner, attr="__init__") if (
                part.name == "__init__" and part.of in self._facts
            ):
                self._facts[part.of] += self._read_init(part, call, owner)
            case ast.Attribute(value=owner, attr=method) if method in _METHODS:
                self._read_node_method(self._receiver(part, owner), part, call, method)
            case ast.Attribute(value=owner, attr=method) if (
                method in _LOOKUPS and part.of in self._facts and self._is_buffer(part, owner)
            ):
                self._facts[part.of] += self._looked_up(part, call, _LOOKUPS[method])
            case function:
                self._read_given_nodes(part, call, dotted(function) or "this call")

    def _read_transforms(self, part: CodePart, call: ast.Call) -> None:
        """Add the transforms that a method of a node sends."""
        is_sending = isinstance(call.func, ast.Attribute) and call.func.attr == SENDS
        if not is_sending or part.of not in self._facts:
            return
        method = SendingMethod(
            part.node,
            self._class_nodes[part.of],
            self._bindings_around(part),
            partial(self._names_written, part),
            self._at,
            partial(self._value_in, part.scope),
        )
        self._facts[part.of] += sent_transforms(method, call)

    def _read_node_method(
        self, at: Location | None, part: CodePart, call: ast.Call, method: str
    ) -> None:
        """Add what the call of a method declares or opens to the facts of the node at a place."""
        facts = self._facts.get(at) if at else None
        if facts is not None:
            facts += self._read_method(part, call, method)
            return
        self.has_loose_declarations |= method in _DECLARES
        reason = f"the node of this {method}() is not known"
        self.doubts.append(Doubt(reason, self._at(call)))

    def _read_given_nodes(self, part: CodePart, call: ast.Call, function: str) -> None:
        """Add what a call makes of the nodes that it is given."""
        name = last_part(function)
        arguments = [*call.args, *(keyword.value for keyword in call.keywords)]
        made = self._called(part, call)
        called = made.removeprefix(f"{self._name}.")
        for argument in arguments:
            at = None
            if isinstance(argument, ast.Name):
                at = self._receiver(part, argument)
                if not at and first_part(made) != first_part(self._name):
                    at = self._made_in(part, argument.id)
            if not at or at in self._nodes_given_to(called):
                continue
            if made == SUBSCRIBER:
                self._facts[at] += self._filtered(part, call)
            elif made == "diagnostic_updater.Updater":
                self._facts[at] += updater_facts(self._at(call))
            elif name in _ACTIONS:
                self._facts[at] += self._action(part, call, _ACTIONS[name])
            elif name not in HARMLESS:
                self._facts[at].append(Doubt(f"{name} is given the node", self._at(call)))

    def _made_in(self, part: CodePart, variable: str) -> Location | None:
        """Return the class of nodes of which a variable is an object."""
        made = self._bindings_around(part).values.get(variable)
        full = self._called(part, made) if isinstance(made, ast.Call) else ""
        places = [at for at, name in self._classes.items() if name == full]
        return only_one(self._facts.keys() & places)

    def _nodes_given_to(self, function: str) -> Collection[Location | None]:
        """Return the nodes that a function of the module is given by all of its calls."""
        return [at for (name, _), at in self._given_nodes.items() if name == function]

    def _is_buffer(self, part: CodePart, node: ast.expr) -> bool:
        """Return whether an expression is a buffer of tf2."""
        made = self._bindings_around(part).values.get(dotted(node))
        return isinstance(made, ast.Call) and last_part(dotted(made.func)) == "Buffer"

    def _frames_of_messages(self, part: CodePart) -> Iterator[NodeFrame]:
        """Yield the frames of messages that are not transforms, where they are no plain texts.

        Those that are plain texts are among the fields that code uses.
        """
        made = self._bindings_around(part).values
        for node in walk(part.node):
            match node:
                case ast.Assign(targets=[ast.Attribute(attr="frame_id") as target], value=value):
                    name = dotted(target).removesuffix(".frame_id").removesuffix(".header")
                    kind = made.get(name)
                    if isinstance(kind, ast.Call) and not dotted(kind.func).endswith(_TRANSFORM):
                        for _, parts in self._names_written(part, value):
                            if parts:
                                yield NodeFrame("names", None, self._at(value), parts)

    def _looked_up(self, part: CodePart, call: ast.Call, second: int) -> Iterator[NodeFrame]:
        """Yield the frames between which a call looks up the transform."""
        for position, name in ((0, "target_frame"), (second, "source_frame")):
            given = given_argument(call, position, name)
            at = self._at(given or call)
            for text, parts in self._names(part, call, position, name):
                yield NodeFrame("looks up", text, at, parts, lookup=self._at(call))

    def _filtered(self, part: CodePart, call: ast.Call) -> Iterator[Endpoint]:
        """Yield the subscription of a filter: Subscriber(node, type, topic, qos_profile=...)."""
        made = self._argument(part, call, 1, "msg_type")
        qos = self._constants.evaluate_node(
            given_argument(call, len(call.args), "qos_profile"), part.scope
        )
        type_name = _full_name(made)
        quality = _qos(qos if qos is not None else _DEPTH_OF_FILTERS)
        endpoint = Endpoint("subscription", type_name, None, self._at(call), quality)
        yield from self._endpoints(part, call, 2, "topic", endpoint)

    def _action(self, part: CodePart, call: ast.Call, kind: EndpointKind) -> Iterator[Endpoint]:
        made = self._argument(part, call, 1, "action_type")
        type_name = _full_name(made)
        endpoint = Endpoint(kind, type_name, None, self._at(call))
        yield from self._endpoints(part, call, 2, "action_name", endpoint)

    def _read_init(self, part: CodePart, call: ast.Call, owner: ast.expr) -> "Iterator[_Fact]":
        """Yield the name that a class gives its node, if its base is rclpy's Node itself."""
        assert part.of
        is_super = isinstance(owner, ast.Call) and dotted(owner.func) == "super"
        base = self._constants.evaluate_node(owner, part.scope)
        is_base = isinstance(base, QualifiedName) and base.name in NODE_CLASSES
        if (is_super or is_base) and NODE_CLASSES.intersection(self.bases[self._classes[part.of]]):
            position = 0 if is_super else 1
            name = as_text(self._argument(part, call, position, "node_name"))
            written = given_argument(call, position, "node_name")
            if name is None and isinstance(written, ast.Name):
                name = self._constructor_text(part, self._classes[part.of], written.id)
            yield _Name(name, self._at(call))
            for keyword in call.keywords:
                if keyword.arg in _OPTIONS:
                    reason = f"{keyword.arg or 'more arguments'} of its Node"
                    yield Doubt(reason, self._at(call), "" if keyword.arg else "more arguments")

    def _constructor_text(self, part: CodePart, owner: str, name: str) -> str | None:
        """Return the text that a parameter of a constructor has in each call of its class.

        It is None where calls give several, or where the constructor binds the name again.
        """
        assert isinstance(part.node, AnyFunction)
        parameters = part.node.args.posonlyargs + part.node.args.args
        names = [each.arg for each in parameters]
        defaults = part.node.args.defaults
        if name not in names or name in names_bound(walk(ast.Module(part.node.body, []))):
            return None
        position = names.index(name)
        default = ([None] * (len(names) - len(defaults)) + list(defaults))[position]
        texts = set()
        for caller in self._parts:
            for call in caller.calls:
                if self._called(caller, call) == owner:
                    given = self._argument(caller, call, position - 1, name)
                    if given is None:
                        given = self._constants.evaluate_node(default, part.scope)
                    texts.add(as_text(given))
        return only_one(texts)

    def _read_method(self, part: CodePart, call: ast.Call, method: str) -> "Iterator[_Fact]":
        """Yield what a method of a node declares, opens or reads."""
        at = self._at(call)
        argument = partial(self._argument, part, call)
        if method in _KINDS:
            kind = _KINDS[method]
            is_topic = kind in ("publisher", "subscription")
            made = argument(0, "msg_type" if is_topic else "srv_type")
            qos = None
            if is_topic:
                qos = argument(2 if kind == "publisher" else 3, "qos_profile")
            type_name = _full_name(made)
            endpoint = Endpoint(kind, type_name, None, at, _qos(qos))
            name = "topic" if is_topic else "srv_name"
            yield from self._endpoints(part, call, 1, name, endpoint)
        elif method == "create_timer":
            period = argument(0, "timer_period_sec")
            yield Timer(float(period) if isinstance(period, int | float) else None, at)
        elif method == "declare_parameters":
            yield from _declared(argument(0, "namespace"), argument(1, "parameters"), at)
        else:
            yield self._parameter(part, call, method)

    def _parameter(self, part: CodePart, call: ast.Call, method: str) -> NodeParameter:
        """Return the parameter that a method declares or reads."""
        argument = partial(self._argument, part, call)
        is_declared = method == "declare_parameter"
        default = argument(1, "value") if is_declared else None
        is_plain = argument(2, "descriptor") is None
        return NodeParameter(
            as_text(argument(0, "name")),
            _default(default),
            self._at(call),
            is_declared,
            is_plain,
            is_needed=method not in _READS_IF_DECLARED,
            is_guard=method == "has_parameter",
            is_unset=isinstance(default, QualifiedName) and _default(default) is None,
        )


def _parameters_given(function: ast.AST, call: ast.Call) -> Iterator[tuple[str, ast.expr]]:
    """Yield the parameters of a function with what a call gives them, without what is unpacked.

    A parameter that is bound again, or that an inner function has as well, is not among them.
    """
    assert isinstance(function, AnyFunction)
    bound = count_stored(walk(function))
    arguments = function.args
    positional = arguments.posonlyargs + arguments.args
    for position, parameter in enumerate(positional + arguments.kwonlyargs):
        behind = position if position < len(positional) else len(call.args)
        given = given_argument(call, behind, parameter.arg)
        if given and bound[parameter.arg] == 1:
            yield parameter.arg, given


def _bind_rounds(part: CodePart, target: ast.Tuple, values: Value) -> Iterator[CodePart]:
    """Yield a part of code with the names of a loop for each tuple; none where one is not known."""
    items = values if isinstance(values, list | tuple) else ()
    if all(isinstance(item, tuple) and len(item) == len(target.elts) for item in items):
        names = [dotted(name) for name in target.elts]
        for item in items:
            bound = dict(zip(names, item, strict=True))
            yield part._replace(scope=Scope(bound, part.scope))


def _find_aliases(tree: ast.Module) -> Iterator[ast.Attribute]:
    """Yield where methods of a node are named and not called: another name may then call them."""
    called = {node.func for node in every_node(tree) if isinstance(node, ast.Call)}
    for node in every_node(tree):
        match node:
            case ast.Attribute(attr=name) if name in _OPENING_METHODS and node not in called:
                yield node


def _find_bindings(node: ast.AST) -> Bindings:
    return bindings(walk(node), of_self=isinstance(node, ast.ClassDef))


def _full_name(value: Value) -> str | None:
    return value.name if isinstance(value, QualifiedName) else None


def _default(value: Value) -> Value:
    """Return the default of a parameter; a type in its place, as Parameter.Type.DOUBLE, is none."""
    is_rclpy = isinstance(value, QualifiedName) and value.name.startswith("rclpy.")
    if is_rclpy and ".Parameter.Type." in value.name:
        return None
    items = value if isinstance(value, list | tuple) else [value]
    is_known = all(isinstance(scalar, SCALARS) or scalar is None for scalar in items)
    if is_known:
        return value
    return Unknown("the default is computed", getattr(value, "at", START))


def _declared(namespace: Value, parameters: Value, at: Location) -> Iterator[NodeParameter]:
    """Yield the parameters of declare_parameters: tuples of a name, a default and a descriptor."""
    before = "" if namespace in (None, "") else f"{namespace}."
    for item in parameters if isinstance(parameters, list | tuple) else (parameters,):
        name, default = (*item, None)[:2] if isinstance(item, tuple) and item else (None, item)
        is_known = isinstance(name, str) and isinstance(namespace, str | None)
        is_plain = isinstance(item, tuple) and len(item) < 3
        yield NodeParameter(
            f"{before}{name}" if is_known else None, _default(default), at, is_plain=is_plain
        )


def _qos(value: Value) -> Qos:
    """Return a quality of service: a depth, a QoSProfile, or one of the profiles of rclpy."""
    match value:
        case bool():
            return Qos()
        case int():
            return Qos(value, "reliable", "volatile")
        case QualifiedName(name=name) if name.startswith("rclpy.qos."):
            profile = last_part(name.removesuffix(".value")).lower().removeprefix("qos_profile_")
            return Qos(*_PROFILES.get(profile, ()))
        case Call(name="rclpy.qos.QoSProfile", kwargs=given):
            depth = given.get("depth") if "history" not in given else None
            reliability: str | None = "reliable"
            if "reliability" in given:
                reliability = _policy(given["reliability"])
            durability: str | None = "volatile"
            if "durability" in given:
                durability = _policy(given["durability"])
            return Qos(depth if isinstance(depth, int) else None, reliability, durability)
    return Qos()


def _policy(value: Value) -> str | None:
    """Return a policy by its name in rclpy.qos, as ReliabilityPolicy.BEST_EFFORT.

    The result is None where it is not known.
    """
    if not isinstance(value, QualifiedName):
        return None
    name = last_part(value.name).lower()
    for policy, group in _GROUPS.items():
        if name in (policy, f"rmw_qos_policy_{group}_{policy}"):
            return policy
    return None
