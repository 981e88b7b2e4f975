"""The nodes of a package that are written in C++: what they declare and open.

The text is read and never compiled.

Only what is written as a text, number or constant is known. What is opened under a condition is
listed as well. Macros, templates and code behind `#if` leave open what a node does.
"""

from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from typing import NamedTuple

from grader.base.grouping import as_text, only_one
from grader.base.names import closest
from grader.base.patterns import on_use
from grader.base.source import Location
from grader.ros.cpp.cpp_evaluation import CppEvaluation, LibraryCalls
from grader.ros.cpp.cpp_values import CppCall, CppName, CppValue
from grader.ros.cpp.declarations import (
    CppClass,
    CppFunction,
    declared_in,
    name_in,
    plain,
    short_name,
)
from grader.ros.cpp.objects import class_written, find_object, find_taker, find_variable
from grader.ros.cpp.syntax import (
    CppNode,
    CppNodes,
)
from grader.ros.cpp.unit import (
    called_name,
    called_object,
    is_conditional,
    list_arguments,
)
from grader.ros.installation.installation import Installation
from grader.ros.known.package_tables import cpp_table
from grader.ros.nodes.cpp.call_sites import CallSites
from grader.ros.nodes.cpp.cpp_faults import cpp_faults
from grader.ros.nodes.cpp.cpp_files import CompiledTarget, CppFiles, may_hide
from grader.ros.nodes.cpp.cpp_frames import frames_in, transforms_in
from grader.ros.nodes.cpp.cpp_message_content import CppContentReader
from grader.ros.nodes.cpp.cpp_message_uses import cpp_field_uses
from grader.ros.nodes.cpp.cpp_programs import program_faults
from grader.ros.nodes.cpp.node_holders import Holder, NodeHolders, NodeKey
from grader.ros.nodes.cpp.rclcpp_calls import (
    ACTIONS,
    DECLARES,
    INTERFACES_OF_ACTION,
    METHODS,
    facts_of_method,
    filter_subscription,
    message_type,
    read_endpoint,
)
from grader.ros.nodes.node_facts import (
    CodeFault,
    CodeFaults,
    Doubt,
    EncodingsByLocation,
    Endpoint,
    FieldUse,
    NodeFact,
    NodeFacts,
    NodeFrame,
    NodeParameter,
    NodeProgram,
    PackageNodes,
    SynchronisedType,
    make_node,
    updater_facts,
)
from grader.ros.package.package import Package
from grader.ros.python.budget import Budget, OutOfBudget

_SETTING = {"get_parameter": 1, "get_parameter_or": 1}
_REGISTERED = on_use(r"\bRCLCPP_COMPONENTS_REGISTER_NODE\s*\(\s*([\w:]+)\s*\)")
_SUBSCRIBER = "message_filters::Subscriber"
_UPDATER = "diagnostic_updater::Updater"
_OF_OWNER = ("subscribe", "add")  # methods of these
_POINTER = on_use(r"^std::(?:unique|shared)_ptr<|>$")
_FILTER = on_use(r"(?P<class>(?<![\w:])[\w:]*\bSubscriber)\s*+<\s*+(?P<type>[\w:]++)\s*+[,>]")
_CALLED_MACRO = on_use(r"\b[A-Z][A-Z0-9_]{3,}\b(?=\s*\(|\Z)")
_MESSAGE_PART = on_use(r"::(msg|srv|action)::")
_LISTS = ("argument_list", "initializer_list")
_OF_NODE = 20  # parts of a class that may be that of a node
_INTERFACE = "get_node_base_interface"
_SELF = ("shared_from_this", "weak_from_this", _INTERFACE)
# Methods that return what their object is, or points to.
_SAME = (*_SELF, "get", "lock")
_OF_ANOTHER = "its node is one of another program"


class _Created(NamedTuple):
    """Where an object of a class of nodes is made: the class, and the arguments."""

    class_name: str
    arguments: tuple[CppNode, ...]
    node: CppNode


class _Parameter(NamedTuple):
    """That a class gives its node the name that its constructor gets."""

    position: int
    default: CppValue


_Name = str | _Parameter | None


def read_cpp_nodes(package: Package) -> PackageNodes:
    """Return the nodes in the C++ files that a build of a package compiles. It never raises."""
    nodes: dict[Location, NodeFacts] = {}
    programs: list[NodeProgram] = []
    doubts: dict[Doubt, None] = {}
    faults: dict[CodeFault, None] = {}
    loose_frames: dict[NodeFrame, None] = {}
    field_uses: dict[FieldUse, None] = {}
    synchronised: dict[SynchronisedType, None] = {}
    is_loose = False
    files = CppFiles(package)
    try:
        for compiled in files.compiled:
            target = _Target(compiled, package.work)
            for node in target.nodes:
                nodes.setdefault(node.location, node)
            programs += target.programs(package)
            doubts |= dict.fromkeys(target.doubts)
            faults |= dict.fromkeys((*target.faults(), *target.unregistered(package)))
            faults |= dict.fromkeys(program_faults(compiled, starts_nodes=target.makes_nodes))
            loose_frames |= dict.fromkeys(target.loose_frames)
            field_uses |= dict.fromkeys(target.field_uses)
            synchronised |= dict.fromkeys(target.content.synchronised_types())
            is_loose = is_loose or target.has_loose_declarations
    except OutOfBudget:
        start = Location(package.path("CMakeLists.txt"), 1, 1)
        doubts[Doubt("the C++ files are too long to evaluate", start)] = None
        programs = [program._replace(nodes=()) for program in programs]
    return PackageNodes(
        nodes=tuple(nodes.values()),
        programs=tuple(programs),
        doubts=tuple(doubts),
        has_loose_declarations=is_loose,
        faults=tuple(faults),
        loose_frames=tuple(loose_frames),
        field_uses=tuple(field_uses),
        synchronised=tuple(synchronised),
        texts=files.texts_with("package://"),
        cpp_files=files.read_paths,
    )


class _Target:
    """The nodes in the files that are compiled into one target."""

    def __init__(self, compiled: CompiledTarget, budget: Budget) -> None:
        self._compiled = compiled
        self._unit = compiled.unit
        self._budget = budget
        interface = LibraryCalls(cpp_table().reading, _SETTING)
        self._evaluation = CppEvaluation(self._unit, interface, budget)
        self._sites = CallSites(self._unit, self._evaluation, budget)
        self.content = CppContentReader(self._unit, self._evaluation, budget)
        self.has_loose_declarations = False
        self.doubts: list[Doubt] = []
        self.loose_frames: list[NodeFrame] = []
        self.field_uses: list[FieldUse] = []
        for unread in compiled.unread:
            self.doubts.append(
                Doubt(f"C++ is not read as a whole: {unread.reason}", unread.location)
            )
        if not compiled.target.is_certain:
            self.doubts.append(Doubt("its sources are not known", self._start))
        self._facts: dict[NodeKey, list[NodeFact]] = {name: [] for name in self._node_classes}
        self._created = list(self._find_created())
        self._created_at = {created.node: created for created in self._created}
        self._nodes: dict[NodeKey, NodeFacts] = {}
        # What is given a node, and the calls of methods of what holds one.
        self._flows: dict[NodeKey, dict[NodeKey, None]] = {}
        self._pending: list[Holder] = []
        self._loose_calls: dict[Holder, CppNodes] = {}
        known = {*self._node_classes, *cpp_table().nodes}
        self._holders = NodeHolders(self._unit, frozenset(known), self._key_made, budget)
        for created in self._created:
            if created.class_name in cpp_table().nodes:
                self._facts[created.node] = []
        for function in self._unit.functions:
            self._read_function(function)
        for created in self._created:
            self._give_object(created)
        self._follow_holders()
        self._strangers = list(self._find_strangers())
        self._add_doubts()

    @property
    def _start(self) -> Location:
        """The place of the target itself."""
        return self._compiled.at

    # --- Classes
    # ----------------------------------------------------------------------

    @cached_property
    def _node_classes(self) -> Mapping[str, CppClass]:
        """The classes of nodes by their full names: those that are derived from one of rclcpp's."""
        kinds = set(cpp_table().nodes)
        node_classes = {}
        is_growing = True
        while is_growing:
            is_growing = False
            for name, classes in self._unit.classes.items():
                self._budget.charge(_OF_NODE)
                if name not in node_classes and self._is_node(classes[0], kinds):
                    node_classes[name] = classes[0]
                    kinds.add(name)
                    is_growing = True
        return node_classes

    def _is_node(self, each: CppClass, kinds: set[str]) -> bool:
        scopes = each.name.split("::")[:-1]
        return any(not kinds.isdisjoint(self._unit.meanings(base, scopes)) for base in each.bases)

    def _doubts_of_class(self, each: CppClass) -> Iterator[Doubt]:
        """Yield why a class may declare or open more than its own methods do."""
        at = each.node.location
        scopes = each.name.split("::")[:-1]
        harmless = {*cpp_table().nodes, *cpp_table().other_bases, *self._node_classes}
        for base in each.bases:
            if harmless.isdisjoint(self._unit.meanings(base, scopes)):
                yield Doubt("what another base class does is not added", at)
        if each.is_template or each.is_conditional or len(self._unit.classes[each.name]) > 1:
            yield Doubt("the class is a template, or has several definitions", at)

    def _add_doubts(self) -> None:
        """Add what leaves open what each node does."""
        common = list(self.doubts)
        for word in sorted(cpp_table().options):
            for use in self._unit.uses.get(word, ())[:1]:
                common.append(Doubt(f"{word} of its NodeOptions", use.location))
        for key, facts in self._facts.items():
            if not isinstance(key, Holder):
                facts.extend(common)
            if isinstance(key, str):
                facts.extend(self._doubts_of_class(self._node_classes[key]))

    # --- Objects
    # ----------------------------------------------------------------------

    def _find_created(self) -> Iterator[_Created]:
        """Yield where nodes are made, in the functions of the target."""
        for file in self._unit.files:
            for node in file.calls:
                name = self._class_made_by(node)
                if name is not None:
                    yield _Created(name, self._given_to(node), node)

    def _class_made_by(self, node: CppNode) -> str | None:
        """Return the class of nodes of which something makes an object; None for something else."""
        written = class_written(node)
        if written and self._unit.function_around(node):
            return self._class_named(written, node)
        return None

    def _given_to(self, node: CppNode) -> tuple[CppNode, ...]:
        if node.kind != "declaration":
            return tuple(list_arguments(node))
        for _, value in declared_in(node):
            return tuple(value.children)
        return ()

    def _class_named(self, written: str, node: CppNode) -> str | None:
        """Return the full name of the class of nodes that a name means; None for another class."""
        scopes = self._unit.scopes_at(node)
        for meaning in self._unit.meanings(plain(written), scopes):
            if meaning in self._node_classes or meaning in cpp_table().nodes:
                return meaning
        return None

    def _key_made(self, node: CppNode) -> NodeKey | None:
        """Return the node that something makes; None for something else."""
        created = self._created_at.get(node)
        if not created:
            return None
        return node if node in self._facts else created.class_name

    def _receiver(self, call: CppNode, function: CppFunction) -> NodeKey | None:
        """Return the node whose method a call is; None where that is not known."""
        owner = called_object(call)
        if owner and owner.kind != "this":
            return self._holders.find_node(owner, function)
        name = function.class_name
        if name in self._facts:
            return name
        is_other = self._holders.has_other_base(name)
        is_own = not is_other or self._is_own_function(call, called_name(call), function)
        return None if is_own else Holder("own", name, "")

    def _give_object(self, created: _Created) -> None:
        """Note what is given a node that is made, which may declare or open more."""
        function = self._unit.function_around(created.node)
        key = self._key_made(created.node)
        if not function or key is None:
            return
        variable = find_variable(created.node)
        is_held = self._give(created.node, function, key)
        if not variable or is_held:
            return
        if variable.kind == "identifier" and variable.field == "declarator":
            uses = self._unit.uses_in(function, variable.text)
        else:
            uses = list(self._unit.uses.get(variable.text, ()))
        self._budget.charge(1 + len(uses))
        for use in uses:
            where = self._unit.function_around(use)
            if where:
                self._give(find_object(use, _SAME), where, key)

    def _give(self, node: CppNode, function: CppFunction, key: NodeKey) -> bool:
        """Note what is given a node by an expression; return whether something holds it then.

        Something else that is given the node may declare or open more.
        """
        opened = self._opened_by_taker(node)
        if opened is not None:
            self._facts.setdefault(key, []).extend(opened)
            return False
        holder = self._holders.holder_given(node, function)
        if holder:
            self._flows.setdefault(key, {})[holder] = None
            self._pending.append(holder)
            return True
        taker = find_taker(node)
        if taker is not None and not _is_harmless(taker):
            doubt = Doubt(f"{taker} is given the node", node.location)
            self._facts.setdefault(key, []).append(doubt)
        return False

    def _follow_holders(self) -> None:
        """Note what is given the nodes that variables, parameters and members hold."""
        self._pending += [key for key in self._facts if isinstance(key, Holder)]
        followed = set()
        while self._pending:
            holder = self._pending.pop()
            if holder in followed:
                continue
            followed.add(holder)
            for use in self._holders.find_uses(holder):
                function = self._unit.function_around(use)
                if function:
                    self._give(find_object(use, _SAME), function, holder)
        for name, node_class in self._node_classes.items():
            for base in node_class.bases:
                for meaning in self._unit.meanings(base, name.split("::")[:-1]):
                    if meaning in self._node_classes:
                        self._flows.setdefault(name, {})[meaning] = None

    def _reached_from(self, key: NodeKey) -> list[NodeKey]:
        """Return a node, the classes that it is derived from, and all that holds it."""
        reached: dict[NodeKey, None] = {}
        pending = [key]
        while pending:
            each = pending.pop()
            if each not in reached:
                reached[each] = None
                self._budget.charge(1)
                pending += self._flows.get(each, ())
        return list(reached)

    def _find_strangers(self) -> Iterator[NodeFacts]:
        """Yield the nodes of other programs that classes get, as those of controllers.

        Where a node is none of these, it may be any one of the target.
        """
        nodes = [key for key in self._facts if not isinstance(key, Holder)]
        known = {reached for key in nodes for reached in self._reached_from(key)}
        keys_by_class: dict[str, list[Holder]] = {}
        for key in [key for key in self._facts if key not in known]:
            assert isinstance(key, Holder)
            owner = self._find_class(key)
            if self._holders.has_other_base(owner):
                keys_by_class.setdefault(owner, []).append(key)
                continue
            for call in self._loose_calls.get(key, ()):
                self._doubt_loose(call)
        for name, keys in keys_by_class.items():
            at = self._unit.classes[name][0].node.location
            stranger = self._collect_facts(keys, name, None, at)
            yield stranger._replace(doubts=(Doubt(_OF_ANOTHER, at), *stranger.doubts))

    def _find_class(self, holder: Holder) -> str:
        """Return the class that holds a node, in a member or in one of its methods."""
        if isinstance(holder.scope, str):
            return holder.scope
        function = self._unit.function_around(holder.scope)
        return function.class_name if function else ""

    def _doubt_loose(self, call: CppNode) -> None:
        """Doubt what all nodes of the target do, as a call may be a method of each."""
        name = called_name(call)
        self.has_loose_declarations |= name in DECLARES
        self.doubts.append(Doubt(f"the node of this {name}() is not known", call.location))

    # --- Functions
    # ----------------------------------------------------------------------

    def _read_function(self, function: CppFunction) -> None:
        """Add what the calls in a function declare and open to the facts of its node."""
        scopes = function.inner_scopes
        owner = function.class_name
        for node in self._unit.calls_in(function):
            if node.kind == "this":
                if owner in self._facts:
                    self._give(node, function, owner)
            elif node.kind == "call_expression":
                self._read_call(node, function, scopes, owner)
        self.field_uses += cpp_field_uses(function, self._unit)
        frames = frames_in(function, self._unit, self._evaluation)
        if owner in self._facts:
            self._facts[owner] += frames
            self._facts[owner] += transforms_in(function, self._unit, self._evaluation)
        else:
            self.loose_frames += [frame for frame in frames if frame.use == "publishes"]

    def _read_call(
        self, call: CppNode, function: CppFunction, scopes: Sequence[str], owner: str
    ) -> None:
        name = called_name(call)
        short = short_name(name)
        if name in ACTIONS or f"rclcpp_action::{name}" in ACTIONS:
            self._read_action(call, name, function)
        elif short in METHODS and name == short:
            self._read_method(call, function, scopes)
        elif short in METHODS:
            self._read_function_of_library(call, function)
        elif owner in self._facts and short.isupper() and len(short) > 3:
            self._read_macro(call, short, owner)
        elif owner in self._facts and short in _SELF:
            self._give(call, function, owner)

    def _read_macro(self, call: CppNode, name: str, owner: str) -> None:
        """Doubt what a class does with a macro that is not known to be harmless."""
        if not self._is_harmless_macro(name):
            reason = f"the macro {name} is not evaluated"
            self._facts[owner].append(Doubt(reason, call.location))

    def _is_harmless_macro(self, name: str) -> bool:
        """Return whether a macro is known to be harmless, or an own one that only calls such."""
        known = tuple(cpp_table().macros)
        texts = self._unit.texts_of_macro(name) if not name.startswith(known) else ()
        for text in texts:
            called = _CALLED_MACRO.findall(text)
            if may_hide(text) or not all(other.startswith(known) for other in called):
                return False
        return bool(texts) or name.startswith(known)

    def _read_method(self, call: CppNode, function: CppFunction, scopes: Sequence[str]) -> None:
        key = self._receiver(call, function)
        name = called_name(call)
        if key is None:
            if self._is_own_function(call, name, function):
                return
            self._doubt_loose(call)
            return
        value = self._evaluation.evaluate_node(call)
        facts = self._facts.setdefault(key, [])
        if isinstance(key, Holder):
            self._loose_calls.setdefault(key, []).append(call)
        for alternative in self._alternatives(value):
            facts += facts_of_method(alternative, self._unit, scopes)
        if function.is_template or is_conditional(call, function.node) or function.is_conditional:
            facts.append(Doubt("it depends on the preprocessor or on a template", call.location))

    def _alternatives(self, value: CppValue) -> list[CppCall]:
        """Return what a call may be, with the values of the parameters of its function.

        A class of nodes whose objects get different ones is left open.
        """
        alternatives = self._sites.alternatives(value)
        is_many = len(alternatives) > 1
        if is_many and self._sites.is_of_constructor(value, self._node_classes):
            alternatives = [value]
        return [each for each in alternatives if isinstance(each, CppCall)]

    def _is_own_function(self, call: CppNode, name: str, function: CppFunction) -> bool:
        """Return whether a call certainly is one of a function of the files themselves."""
        if called_object(call):
            return False
        return any(
            candidate.class_name in ("", function.class_name)
            for candidate in self._unit.functions_by_name.get(name, ())
        )

    def _read_function_of_library(self, call: CppNode, function: CppFunction) -> None:
        """Add that a function such as rclcpp::create_timer() is given a node, which may be open."""
        name = called_name(call)
        is_timer = short_name(name) in ("create_timer", "create_wall_timer")
        if is_timer:
            return
        doubt = Doubt(f"what {name}() opens is not evaluated", call.location)
        arguments = list_arguments(call)
        key = self._holders.find_node(arguments[0], function) if arguments else None
        if key is None:
            self.doubts.append(doubt)
        else:
            self._facts.setdefault(key, []).append(doubt)

    def _read_action(self, call: CppNode, name: str, function: CppFunction) -> None:
        """Add the action that rclcpp_action::create_server() or create_client() opens."""
        full = name if name in ACTIONS else f"rclcpp_action::{name}"
        value = self._evaluation.evaluate_node(call)
        is_of_action = name in ACTIONS or "rclcpp_action" in self._unit.opened
        if not isinstance(value, CppCall) or not is_of_action:
            self._read_plain_action(call)
            return
        arguments = list_arguments(call)
        first = arguments[0] if arguments else call
        position = 1
        if first.kind == "call_expression" and called_name(first) == _INTERFACE:
            position = INTERFACES_OF_ACTION
            key = self._receiver(first, function)
        else:
            key = self._holders.find_node(first, function)
        if key is None:
            self.doubts.append(Doubt(f"the node of this {name}() is not known", call.location))
            return
        scopes = function.inner_scopes
        for alternative in self._alternatives(value):
            endpoint = read_endpoint(ACTIONS[full], alternative, self._unit, scopes, position)
            self._facts.setdefault(key, []).append(endpoint)
        if isinstance(key, Holder):
            self._loose_calls.setdefault(key, []).append(call)

    def _read_plain_action(self, call: CppNode) -> None:
        """Add a client of a service, whose function has the name of that of actions."""
        function = self._unit.function_around(call)
        if function and called_name(call) in METHODS:
            self._read_method(call, function, function.inner_scopes)

    def _opened_by_taker(self, node: CppNode) -> Sequence[Endpoint | NodeParameter] | None:
        """Return what a library's object that is given a node opens and declares for it.

        It is a filter of message_filters or an updater of diagnostics. The result is None where
        something else is given the node.
        """
        given = node.parent
        taker = node.parent.parent
        function = self._unit.function_around(node)
        if given.kind not in _LISTS or not function:
            return None
        scopes = function.inner_scopes
        written = self._type_given(taker, scopes)
        arguments = given.code
        is_first = arguments[:1] == [node]
        if _UPDATER in self._unit.meanings(plain(_POINTER.sub("", written)), scopes):
            return updater_facts(taker.location) if is_first else ()
        match = _FILTER.search(written)
        if not match or not is_first or called_name(taker) == "add":
            return None
        if _SUBSCRIBER not in self._unit.meanings(match["class"], scopes):
            return None
        type_name = message_type(match["type"], self._unit, scopes)
        values = [self._evaluation.evaluate_node(argument) for argument in arguments]
        subscription = filter_subscription(type_name, values, taker.location)
        return None if not subscription else (subscription,)

    def _type_given(self, taker: CppNode, scopes: Sequence[str]) -> str:
        """Return the type, as it is written, of what gets the given arguments.

        It gets the arguments of a call, of an initializer or of a declaration. The result is
        empty where it is not known.
        """
        if taker.kind == "call_expression" and called_name(taker) in _OF_OWNER:
            owner = called_object(taker)
            name = owner.child("field") if owner.kind == "field_expression" else owner
        elif taker.kind == "field_initializer":
            name = taker.first
        elif taker.kind == "init_declarator":
            return taker.parent.child("type").text
        else:
            return class_written(taker)
        variables = self._unit.variables_named(name.text, scopes)
        return variables[0].type if len(variables) == 1 else ""

    # --- Results
    # ----------------------------------------------------------------------

    @cached_property
    def nodes(self) -> tuple[NodeFacts, ...]:
        """The nodes of the target: its classes, what is made of rclcpp's own, and strangers."""
        nodes = [self._node(key) for key in self._facts if not isinstance(key, Holder)]
        return (*nodes, *self._strangers)

    def _node(self, key: str | CppNode) -> NodeFacts:
        """Return the facts of a node, once all functions are read."""
        if key not in self._nodes:
            self._nodes[key] = self._make_node(key)
        return self._nodes[key]

    def _make_node(self, key: str | CppNode) -> NodeFacts:
        if isinstance(key, str):
            name = self._names[key]
            at = self._node_classes[key].node.location
        else:
            name = self._name_of_object(key)
            at = key.location
        class_name = as_text(key) or ""
        return self._collect_facts(self._reached_from(key), class_name, as_text(name), at)

    def _collect_facts(
        self, keys: Sequence[NodeKey], class_name: str, name: str | None, at: Location
    ) -> NodeFacts:
        """Return a node with the facts of all that holds it."""
        facts = [fact for key in keys for fact in self._facts.get(key, ())]
        node = make_node(facts, self._encodings, class_name, name, at)
        endpoints = dict.fromkeys(node.endpoints)
        doubts = dict.fromkeys(node.doubts)
        return node._replace(endpoints=tuple(endpoints), doubts=tuple(doubts))

    @cached_property
    def _encodings(self) -> EncodingsByLocation:
        """The encodings of images, by the places of the endpoints that send or get them."""
        return self.content.encodings()

    def _name_of_object(self, node: CppNode) -> str | None:
        """Return the name that a node of rclcpp's own class is given."""
        arguments = self._created_at[node].arguments
        name = self._evaluation.evaluate_node(arguments[0]) if arguments else None
        return as_text(name)

    @cached_property
    def _names(self) -> Mapping[str, _Name]:
        """The name that each class gives its node."""
        names_of_classes: dict[str, set[_Name]] = {name: set() for name in self._node_classes}
        for function in self._unit.functions:
            owner = function.class_name
            if owner in names_of_classes and function.name == short_name(owner):
                names_of_classes[owner] |= set(self._names_in(function))
        return {name: only_one(names) for name, names in names_of_classes.items()}

    def _names_in(self, constructor: CppFunction) -> Iterator[_Name]:
        """Yield the name that a constructor gives its base class, if that is rclcpp's own."""
        scopes = constructor.inner_scopes
        for initializers in constructor.node.of_kind("field_initializer_list"):
            for each in initializers.of_kind("field_initializer"):
                written = each.first.text
                meanings = {*self._unit.meanings(plain(written), scopes)}
                is_base = bool(meanings & cpp_table().nodes)
                is_short = any(
                    node_class.endswith(f"::{written}") for node_class in cpp_table().nodes
                )
                if is_base or is_short:
                    given = list_arguments(each)
                    yield self._name_given(given[0], constructor) if given else None
                    self._note_namespace(given, constructor)

    def _name_given(self, node: CppNode, constructor: CppFunction) -> _Name:
        value = self._evaluation.evaluate_node(node)
        if isinstance(value, str):
            return value
        if isinstance(value, CppName):
            for position, parameter in enumerate(constructor.parameters):
                if name_in(parameter.child("declarator")).text == value.name:
                    default = parameter.child("default_value")
                    return _Parameter(position, self._evaluation.evaluate_node(default))
        return None

    def _note_namespace(self, given: CppNodes, constructor: CppFunction) -> None:
        """Add that a node is given a namespace."""
        second = self._evaluation.evaluate_node(given[1]) if len(given) > 1 else None
        if isinstance(second, str) and second not in ("", "/"):
            self._facts[constructor.class_name].append(
                Doubt("its program gives it a namespace", given[1].location)
            )

    def faults(self) -> CodeFaults:
        """Yield what keeps the nodes of the target from doing anything."""
        created = [
            started.node if started.node in self._facts else started.class_name
            for started in self._created
        ]
        is_known = not any(self._node(key).doubts for key in created)
        is_read = not self._compiled.unread and self._compiled.target.is_certain
        is_program = self._compiled.target.kind == "executable" and bool(created) and is_known
        yield from cpp_faults(
            self._unit, self._node_classes, is_program=is_program, is_read=is_read
        )

    @property
    def makes_nodes(self) -> bool:
        """Whether functions of the target make nodes."""
        return bool(self._created)

    def unregistered(self, package: Package) -> CodeFaults:
        """Yield the components that CMakeLists.txt registers and no source does."""
        target = self._compiled.target
        setup = package.installation
        is_read = target.is_certain and not self._compiled.unread
        if not setup or not is_read or "CLASS_LOADER_REGISTER_CLASS" in self._unit.uses:
            return
        registered: dict[str, Location] = {}
        for file in self._unit.files:
            registered |= file.found(_REGISTERED)
        for component in target.components:
            if component.plugin in registered:
                continue
            meant = closest(component.plugin, registered)
            guess = f"; did you mean {meant!r}?" if meant is not None else ""
            message = f"no source registers the component {component.plugin!r}{guess}"
            related = registered[meant] if meant is not None else None
            at = setup.location(component.at)
            yield CodeFault("component-macro", message, at, related)

    def programs(self, package: Package) -> Iterator[NodeProgram]:
        """Yield the programs that the target is, and those of its components."""
        target = self._compiled.target
        if target.kind == "executable":
            mains = self._unit.mains
            nodes = tuple(self._started_by(started) for started in self._created)
            at = mains[0].node.location if mains else self._start
            path = at.path.removeprefix(package.path(""))
            name = target.program or target.name
            program = NodeProgram(name, nodes if mains else (), at, path, "main")
            yield program._replace(may_have_more=self._may_have_more)
        if package.installation:
            yield from self._programs_of_components(package.installation)

    @property
    def _may_have_more(self) -> bool:
        """Whether the target may have nodes of classes of other packages, which are not known."""
        added = 0
        for file in self._unit.files:
            for node in file.calls:
                if called_name(node) == "add_node" and node.kind == "call_expression":
                    added += 1
                elif self._is_of_other_package(class_written(node), node):
                    return True
        return added > len(self._created)

    def _is_of_other_package(self, written: str, node: CppNode) -> bool:
        """Return whether a class that is made is in the namespace of a package that is not read."""
        if not written or _MESSAGE_PART.search(written):
            return False
        scopes = self._unit.scopes_at(node)
        is_known = False
        for meaning in self._unit.meanings(plain(written), scopes):
            is_known = is_known or "::" not in meaning or meaning in self._unit.classes
            is_known = is_known or meaning.startswith(tuple(cpp_table().without_nodes))
        return not is_known

    def _programs_of_components(self, setup: Installation) -> Iterator[NodeProgram]:
        """Yield the programs that rclcpp_components makes of the target's components."""
        for component in self._compiled.target.components:
            if component.executable:
                name = component.plugin.removeprefix("::")
                component_nodes = [self._node(name)] if name in self._facts else []
                at = setup.location(component.at)
                yield NodeProgram(component.executable, tuple(component_nodes), at, "", "")

    def _started_by(self, created: _Created) -> NodeFacts:
        """Return the node that an object is, with the name that its constructor is given."""
        if created.node in self._facts:
            return self._node(created.node)
        node = self._node(created.class_name)
        name = self._names[created.class_name]
        if not isinstance(name, _Parameter):
            return node
        given = name.default
        if name.position < len(created.arguments):
            given = self._evaluation.evaluate_node(created.arguments[name.position])
        return node._replace(name=as_text(given))


def _is_harmless(taker: str) -> bool:
    """Return whether what is given a node declares and opens nothing that is not listed."""
    short = short_name(taker)
    return taker in ACTIONS or short in METHODS or short in cpp_table().harmless
