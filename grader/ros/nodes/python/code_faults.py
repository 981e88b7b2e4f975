"""What stops a node in Python, or keeps it from doing anything, in one module.

Each rule is about what certainly fails once it runs, in any code of the module: `running_code` says
what a program certainly runs. A callback is a function that is given to create_timer(),
create_subscription(), create_service() or ActionServer.
"""

import ast
import re
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from functools import cached_property, partial
from pathlib import PurePosixPath
from typing import Literal

from grader.base.grouping import StringsByName
from grader.base.names import closest, near
from grader.base.patterns import on_use
from grader.base.problems import NO_FIXES, Fix, Fixes
from grader.base.records import Named
from grader.base.text import cut, enumerated, first_part, last_part
from grader.ros.known.package_tables import python_table
from grader.ros.known.releases import RELEASES, Release
from grader.ros.nodes.message_uses import ClassesByLocation, CodePart, certain_nodes, given_argument
from grader.ros.nodes.node_facts import (
    CodeFault,
    CodeFaults,
    misnamed_callback,
)
from grader.ros.nodes.python.action_faults import (
    RegisteredGoal,
    answers_for_results,
    goals_without_state,
    loops_without_transforms,
    rejected_goals,
)
from grader.ros.nodes.python.branches import calls_in_branches, program_name
from grader.ros.nodes.python.callback_parameters import (
    CallbackFunctions,
    count_parameters,
    wrong_callbacks,
)
from grader.ros.nodes.python.called_functions import (
    CalledFunctions,
    imported_names,
    made_in,
    names_in_class,
)
from grader.ros.nodes.python.code_edits import CodeEdits
from grader.ros.nodes.python.log_calls import wrong_log_calls
from grader.ros.nodes.python.message_content import silent_synchronisers
from grader.ros.nodes.python.node_constructors import early_uses
from grader.ros.nodes.python.rclpy_names import CALLBACKS, NODE_CLASSES, is_passive
from grader.ros.nodes.python.standing_calls import (
    missing_members,
    repeated_calls,
    uncalled_functions,
)
from grader.ros.nodes.python.transform_buffers import (
    buffers_without_listener,
    unregistered_transforms,
)
from grader.ros.nodes.python.undefined_names import undefined_names, wrong_imports
from grader.ros.python.bindings import bound_names
from grader.ros.python.constants import binds_unseen, constant_in, count_bound, dotted, last_name
from grader.ros.python.parse import AnyFunction, Code, make_position
from grader.ros.python.values import QualifiedName
from grader.ros.python.walking import children, walk

_Names = Collection[str]

# With one of these, callbacks may run while another one waits.
_OTHER_THREADS = ("xecutor", "hread", "spin_once", "spin_some", "asyncio", "await ")
_MAX_FAULTS = 20  # of one module and rule
_MAX_SHOWN = 40  # characters of an expression
_ANSWERING = ("create_service", "ActionServer")
_INTERFACE = on_use(r"\w+\.(?:msg|srv|action)\.[A-Z]\w*+")
_SPINNING = "rclpy.spin_until_future_complete"
# Names of groups and executors with which a callback may wait for another one.
_CONCURRENT = ("MultiThreadedExecutor", "ReentrantCallbackGroup", "MutuallyExclusiveCallbackGroup")
_CONCURRENT_MODULES = frozenset({"threading", "multiprocessing", "concurrent", "asyncio"})
# Modules whose functions may run beside a loop.
_BESIDE = _CONCURRENT_MODULES | {"_thread", "signal", "sched", "socketserver", "http", "tkinter"}
_LOOPS = (
    *(ast.While, ast.For, ast.AsyncFor),
    *(ast.ListComp, ast.SetComp, ast.DictComp, ast.GeneratorExp),
)
_ENDING = frozenset({"sys.exit", "exit", "quit", "os._exit"})


# What may run the callbacks of nodes: rclpy/__init__.py, executors.py, wait_for_message.py and
# experimental/ of ros2/rclpy, from Humble to Rolling.
_SPINS = frozenset(
    {
        *("spin", "spin_once", "spin_until_future_complete", "spin_once_until_future_complete"),
        *("spin_until_complete", "spin_some", "spin_all", "_spin_once_impl"),
        *("wait_for_ready_callbacks", "_wait_for_ready_callbacks", "wait_for_message"),
        *("WaitSet", "AsyncNode"),  # the run() of the latter is awaited
    }
)
# What calls functions of a node besides its timers, subscriptions, services and actions.
_OTHER_CALLBACKS = ("TransformListener", "message_filters", "add_done_callback")
# What a loop may call that only waits.
_PAUSES = frozenset({"time.sleep", "sleep", "rate.sleep", "self.rate.sleep"})


# Words of modules that register what helpers of nodes need; packages of tf2 that do not.
_HELPERS = {"TransformRegistration": "conversions", "registerCallback": "callbacks"}
_WITHOUT_CONVERSIONS = frozenset({"tf2_ros", "tf2_py", "tf2_msgs"})


class ModuleText(Named):
    """A module of which faults are searched: its full name, its code and its parts.

    `imports` are the full names of what it imports.
    """

    name: str
    code: Code
    parts: Sequence[CodePart]
    imports: _Names
    nodes: ClassesByLocation  # the classes whose only bases are those of rclpy
    classes: ClassesByLocation  # all of them

    @property
    def is_script(self) -> bool:
        """Whether it is a file that is a program, whose name is its path."""
        return "/" in self.name or self.name.endswith(".py")

    @property
    def node_name(self) -> str:
        """The literal of the name that is assumed of a node without one: that of the file."""
        return f'"{PurePosixPath(self.code.source.path).stem}"'


_Modules = Mapping[str, ModuleText]


class _PackageAttributes(Named):
    """The attributes that modules of a package set, and the texts in them.

    hasattr() or getattr() may ask for the texts. The attributes are not all of them if names may
    be bound in ways that are not seen.
    """

    stored: _Names
    texts: _Names
    named: set[str]  # names that code reads
    may_be_more: bool
    # Whether all that the modules import is of the package, or known to have no nodes of its own.
    is_closed: bool
    helpers: _Names  # conversions of messages, and callbacks of filters: what there is


def attributes_in(modules: Iterable[ModuleText]) -> _PackageAttributes:
    """Return the attributes of the modules of a package."""
    stored = set()
    texts = set()
    named = set()
    increased = set()
    may_be_more = False
    imported = set[str]()
    packages = set()
    helpers = set[str]()
    for module in modules:
        helpers.update(kind for word, kind in _HELPERS.items() if word in module.code.text)
        imported.update(module.imports)
        packages.add(first_part(module.name))
        nodes = module.code.nodes
        plain_nodes = {*module.nodes.values()}
        may_be_more = may_be_more or binds_unseen(nodes)
        for node in nodes:
            match node:
                case ast.AugAssign(target=ast.Attribute() as target):
                    increased.add(target)  # which makes no attribute
                case ast.Attribute(attr=name, ctx=ast.Store()) if node not in increased:
                    stored.add(name)
                case ast.Constant(value=str(text)):
                    texts.add(text)
                case ast.Name(id=name, ctx=ast.Load()) | ast.Attribute(attr=name):
                    named.add(name)
                case ast.ClassDef(bases=[_, *_]) if node not in plain_nodes:
                    # it may define what a class asks for that it is derived from
                    stored.update(names_in_class(node))
    is_closed = all(is_passive(name) or first_part(name) in packages for name in imported)
    tops = {first_part(name) for name in imported} - _WITHOUT_CONVERSIONS
    helpers.update("conversions" for top in tops if top.startswith("tf2_"))
    return _PackageAttributes(stored, texts, named, may_be_more, is_closed, helpers)


def code_faults(
    module: ModuleText,
    others: _Modules,
    attributes: _PackageAttributes,
    releases: Sequence[Release],
) -> CodeFaults:
    """Yield what is wrong in a module.

    `others` are all modules of the package, by their names, and `attributes` those of all of
    them. Calls are those of the given releases, or of any that are known.
    """
    search = _Search(module, others, attributes)
    yield from undefined_names(module.code)
    names = {re.split("[./]", name.removesuffix(".py"))[-1] for name in others}
    yield from wrong_imports(module.code, names)
    yield from search.uncalled_main()
    yield from search.undefined_attributes()
    yield from search.called_callbacks()
    yield from search.wrong_parameters()
    yield from search.without_response()
    yield from search.waiting_callbacks()
    yield from search.misnamed_callbacks()
    yield from search.of_programs()
    yield from _early_uses(module, others, attributes)
    yield from _wrong_calls(module, others, releases or RELEASES)
    yield from wrong_log_calls(module.code, module.parts)
    imports = imported_names(module.code.nodes)
    yield from missing_members(module.code, module.parts, imports)
    yield from uncalled_functions(module.code, module.parts, module.nodes, imports)
    yield from repeated_calls(module.code, module.nodes.values())
    yield from search.of_helpers(imports)
    yield from search.of_actions()


def said_faults(faults: Iterable[CodeFault]) -> CodeFaults:
    """Yield the faults of a module that are said: of a name the first, and not too many.

    They have the fixes of which it is certain what they write.
    """
    said = set()
    counts = Counter[str]()
    for fault in faults:
        if fault.rule == "name-binding" and fault.message in said:
            continue
        said.add(fault.message)
        counts[fault.rule] += 1
        if counts[fault.rule] <= _MAX_FAULTS:
            yield fault._replace(fixes=Fixes(partial(_certain_fixes, fault)))


def _certain_fixes(fault: CodeFault) -> list[Fix]:
    return [fix for fix in fault.fixes if fix.is_certain]


def _early_uses(module: ModuleText, others: _Modules, attributes: _PackageAttributes) -> CodeFaults:
    """Yield what constructors of nodes use before the node is made, or without that."""
    bases = set[str]()
    for other in others.values():
        for owner in other.classes.values():
            bases.update(map(last_name, owner.bases))
    code = module.code
    name = module.node_name
    spun = _find_spun(module)
    for owner in module.nodes.values() if not attributes.may_be_more else ():
        if len(owner.bases) == 1 and not owner.keywords:
            yield from early_uses(code, owner, name, attributes.stored, bases, spun)


def _find_spun(module: ModuleText) -> set[str]:
    """Return the classes of the nodes that functions of a module make and spin."""
    spun = set()
    for part in module.parts:
        made = dict(made_in(walk(part.node)))
        for call in part.calls:
            if last_name(call.func) in _SPINS or last_name(call.func) == "add_node":
                for argument in call.args:
                    spun.add(dotted(getattr(argument, "func", argument)))
                    spun.add(made.get(dotted(argument), ""))
    return spun


def _wrong_calls(module: ModuleText, others: _Modules, releases: Sequence[Release]) -> CodeFaults:
    """Yield the calls of rclpy and tf2_ros whose arguments Python cannot bind."""
    nodes = module.code.nodes
    if binds_unseen(nodes):
        return
    functions = CalledFunctions(module.code, nodes, module.nodes.values(), releases)
    classes = {*NODE_CLASSES}
    for other in others.values():
        classes.update(f"{other.name}.{node.name}" for node in other.nodes.values())
    package = first_part(module.name)
    for part in module.parts:
        owner = module.nodes.get(part.of) if part.of else None
        kind_in_part = partial(_kind_in_part, package, classes, part, _other_names(part.node))
        filled = _find_filled(module, part)
        wrong = {}
        for call in part.calls:
            wrong_call = functions.wrong_call(call, owner, filled, kind_in_part)
            if wrong_call:
                wrong[call] = wrong_call
        certain = set(certain_nodes(part.node)) if wrong else set[ast.AST]()
        for call in sorted(wrong.keys() & certain, key=make_position):
            at = module.code.at(call)
            yield CodeFault("call-arguments", wrong[call].reaction, at, fixes=wrong[call].fixes)


def _find_filled(module: ModuleText, part: CodePart) -> dict[str, str]:
    """Return what is given to parameters in a function where it is missing."""
    filled = {"node_name": module.node_name}
    classes = {node.name for node in module.nodes.values()}
    made = [name for name, kind in made_in(walk(part.node)) if kind in classes]
    if part.of in module.nodes:
        filled["node"] = "self"
    elif len(made) == 1:
        filled["node"] = made[0]
    return filled


def _other_names(function: ast.AST) -> Mapping[str, ast.expr]:
    """Return the variables that a function binds once, to what has a name already."""
    counts = Counter[str]()
    values = {}
    for node in walk(function):
        match node:
            case ast.Assign(
                targets=[ast.Name(id=name)], value=ast.Name() | ast.Attribute() as value
            ):
                values[name] = value
        counts.update(bound_names(node))
    return {name: value for name, value in values.items() if counts[name] == 1}


def _kind_in_part(
    package: str,
    classes: _Names,
    part: CodePart,
    others: Mapping[str, ast.expr],
    node: ast.expr,
) -> Literal["node class", "type"] | None:
    """Return whether an expression in a part of a package's module surely is a class.

    This is one of the given classes of nodes, or a type of messages. `others` are other names.
    """
    first, dot, rest = dotted(others.get(dotted(node), node)).partition(".")
    value = constant_in(part.scope, first)
    if not isinstance(value, QualifiedName):
        return None
    name = f"{value.name}{dot}{rest}"
    if name in classes:
        return "node class"
    is_own = first_part(name) == package
    return "type" if _INTERFACE.fullmatch(name) and not is_own else None


class _Registered(Named):
    """A function that is given as a callback: the call that is given it, and what it is given."""

    by: str  # create_timer
    call: ast.Call
    given: ast.expr
    part: CodePart


class _Search:
    """The search for the faults of one module."""

    def __init__(
        self,
        module: ModuleText,
        others: _Modules,
        attributes: _PackageAttributes,
    ) -> None:
        self._module = module
        self._others = others
        self._attributes = attributes
        self._edits = CodeEdits(module.code.source)
        self._callbacks = CallbackFunctions(module.code, module.classes, attributes.stored)
        self._code = module.code
        self._at = module.code.at
        self._functions = {
            (part.of, part.name): part.node
            for part in module.parts
            if not isinstance(part.node, ast.Module)
        }
        self._registered = list(self._find_registered())

    def _find_registered(self) -> Iterator[_Registered]:
        for part in self._module.parts:
            for call in part.calls:
                name = last_name(call.func)
                if name in CALLBACKS:
                    given = given_argument(call, *CALLBACKS[name])
                    if given:
                        yield _Registered(name, call, given, part)

    def _find(self, node: ast.expr, part: CodePart) -> AnyFunction | None:
        """Return the function or own method that an expression surely is."""
        function = self._callbacks.find(part, node)
        return None if isinstance(function, ast.Lambda) else function

    def undefined_attributes(self) -> CodeFaults:
        """Yield the attributes of self that a class of nodes reads, and nothing sets or defines."""
        attributes = self._attributes
        if attributes.may_be_more:
            return
        known = {*python_table().node_attributes, *attributes.stored}
        # A class that its package does not name is the base of one in another package.
        closed = attributes.named - self._extended()
        asked = {*attributes.texts}
        if {*self._code.releases} == {"foxy"}:
            known |= python_table().of_foxy
        for part in self._module.parts:
            for variable, owner in self._list_own_nodes(part):
                is_plain = not owner.decorator_list and not owner.keywords
                if is_plain and owner.name in closed:
                    yield from self._undefined_in(part, variable, owner, known, asked)

    def _extended(self) -> set[str]:
        """Return the classes of nodes that another package is given, which may set attributes."""
        names = set[str]()
        if self._attributes.is_closed:
            return names
        package = first_part(self._module.name)
        imports = imported_names(self._code.nodes)
        for part in self._module.parts:
            given = set[str]()
            for call in part.calls:
                source = imports.get(first_part(dotted(call.func)), "")
                if first_part(source) not in ("", package) and not is_passive(source):
                    given.update(map(dotted, call.args))
                    given.update(dotted(keyword.value) for keyword in call.keywords)
            own_nodes = self._list_own_nodes(part)
            names.update(owner.name for variable, owner in own_nodes if variable in given)
        return names

    def _list_own_nodes(self, part: CodePart) -> Iterator[tuple[str, ast.ClassDef]]:
        """Yield the variables of a function that are own nodes, as self, with their classes."""
        if part.of:
            if part.of in self._module.nodes:
                yield "self", self._module.nodes[part.of]
            return
        by_name = {owner.name: owner for owner in self._module.nodes.values()}
        nodes = walk(part.node)
        bound = count_bound(nodes)
        for variable, kind in made_in(nodes):
            if bound[variable] == 1 and kind in by_name:
                yield variable, by_name[kind]

    def _undefined_in(
        self,
        part: CodePart,
        variable: str,
        owner: ast.ClassDef,
        known: _Names,
        asked: set[str],
    ) -> CodeFaults:
        """Yield those of a variable in a function, wherever they are used."""
        own_names = names_in_class(owner)
        read = []
        for node in certain_nodes(part.node):
            match node:
                case ast.Attribute(ctx=ast.Load()):
                    read += [node] if dotted(node.value) == variable else []
                case ast.AugAssign(target=ast.Attribute() as target):
                    read += [target] if dotted(target.value) == variable else []
        for node in sorted(read, key=make_position):
            name = node.attr
            if name in own_names or name in known or name in asked or name.startswith("_"):
                continue
            sure = near(name, own_names.union(known))
            meant = sure or closest(name, own_names)
            yield self._undefined_attribute(node, owner.name, meant, is_sure=sure is not None)

    def _undefined_attribute(
        self, node: ast.Attribute, owner: str, meant: str | None, *, is_sure: bool
    ) -> CodeFault:
        """Return that a class has no attribute of a name, with the one that may be meant."""
        hint = f"; did you mean {meant}?" if meant is not None else ""
        message = f"{owner} has no attribute {node.attr}{hint}"
        end = self._edits.span(node)[1]
        start = end - len(node.attr)
        fixes = NO_FIXES
        if is_sure and meant is not None:
            fixes = self._edits.rewrite(start, end, meant)
        return CodeFault("name-binding", message, self._code.source.at(start), fixes=fixes)

    # --- Callbacks

    def called_callbacks(self) -> CodeFaults:
        """Yield callbacks that are called in place of passed."""
        for registered in self._registered:
            is_of_rclpy = self._is_of_rclpy(registered.call, registered.part)
            if not is_of_rclpy or not isinstance(registered.given, ast.Call):
                continue
            function = self._find(registered.given.func, registered.part)
            if not function:
                continue
            name = dotted(registered.given.func)
            least, _ = count_parameters(function, is_method=name.startswith("self."))
            given = registered.given.args + registered.given.keywords
            are_known = not any(isinstance(each, ast.Starred | ast.keyword) for each in given)
            if are_known and len(given) < least:
                what = f"calls {name}() without its arguments"
            elif not _gives_value(function):
                what = f"is given what {name}() returns, which is None"
            else:
                continue
            message = f"{registered.by}() {what}; write {name} without the parentheses"
            at = self._at(registered.given)
            fixes = NO_FIXES
            if not given:
                fixes = self._edits.rewrite(*self._edits.span(registered.given), name)
            yield CodeFault("callback-call", message, at, fixes=fixes)

    def wrong_parameters(self) -> CodeFaults:
        """Yield callbacks that cannot take what they are called with."""
        if not self._attributes.may_be_more:
            yield from wrong_callbacks(
                self._code, self._module.parts, self._callbacks, self._is_of_rclpy
            )

    def _is_of_rclpy(self, call: ast.Call, part: CodePart) -> bool:
        """Return whether a call that is given a callback surely is one of rclpy.

        No function or class of the package has its name, and it is called of a class of nodes that
        has no other base, or nothing is imported that may be another library of nodes.
        """
        name = last_name(call.func)
        if name in self._defined:
            return False
        is_node = dotted(call.func) == f"self.{name}" and part.of in self._module.nodes
        return is_node or self._attributes.is_closed

    @cached_property
    def _defined(self) -> set[str]:
        """The names of the functions and classes of the package."""
        names = set[str]()
        for other in self._others.values():
            names.update(part.name for part in other.parts)
            names.update(node.name for node in other.classes.values())
        return names

    def _callback(self, registered: _Registered) -> AnyFunction | None:
        """Return the function that surely is given; None if it may be another one."""
        if not self._is_of_rclpy(registered.call, registered.part):
            return None
        return self._find(registered.given, registered.part)

    def without_response(self) -> CodeFaults:
        """Yield callbacks of services and actions that return nothing."""
        said = set()
        for registered in self._registered:
            function = self._callback(registered)
            if registered.by not in _ANSWERING or not function or function in said:
                continue
            said.add(function)
            if function.decorator_list or _is_generator(function):
                continue
            what = "response" if registered.by == "create_service" else "result"
            if what == "response":
                yield from self._wrong_responses(function, registered)
            for node, is_certain in _ends_without_value(function):
                message = f"{function.name}() ends without returning its {what} here"
                if node is function:
                    message = f"{function.name}() does not return its {what}"
                    if not is_certain:
                        message = f"{message} on every path"
                at = self._at(node)
                yield CodeFault(
                    "service-response", message, at, self._at(registered.call), is_certain
                )

    def _wrong_responses(self, function: AnyFunction, registered: _Registered) -> CodeFaults:
        """Yield where the callback of a service certainly returns something else."""
        for statement in _own_statements(function.body):
            if not isinstance(statement, ast.Return) or not statement.value:
                continue
            written = _no_response(statement.value, function)
            if written:
                message = (
                    f"{function.name}() returns {written} in place of its response, which rclpy "
                    "refuses with a TypeError"
                )
                at = self._at(statement)
                related = self._at(registered.call)
                yield CodeFault("service-response", message, at, related)

    def waiting_callbacks(self) -> CodeFaults:
        """Yield what callbacks wait for while nothing else can run.

        Nothing else can run with one thread, and one group of callbacks.
        """
        if self._is_concurrent():
            return
        clients = {*self._made_by("create_client")}
        rates = self._only_bound(self._made_by("create_rate"))
        for function in self._reached():
            for call in _calls_in(function):
                yield from self._waiting(call, function.name, clients, rates)
            loops = list(self._loops(function))
            yield from loops or self._sleeping(function)

    def _made_by(self, method: str) -> list[str]:
        """Return the variables and attributes that are bound to what a method of a node makes."""
        return [
            dotted(node.targets[0])
            for part in self._module.parts
            if part.of
            for node in walk(part.node)
            if isinstance(node, ast.Assign)
            and isinstance(node.value, ast.Call)
            and dotted(node.value.func) == f"self.{method}"
            and self._is_of_rclpy(node.value, part)
        ]

    def _only_bound(self, made: Sequence[str]) -> set[str]:
        """Return those of some names that the module binds to nothing else."""
        bound = count_bound(self._code.nodes if made else ())
        return {name for name in made if bound[last_part(name)] == made.count(name)}

    def _loops(self, function: AnyFunction) -> CodeFaults:
        """Yield the loops of a callback that do nothing until another callback has run."""
        for node in walk(function):
            if isinstance(node, ast.While) and _never_ends(node) and function.name != "main":
                message = (
                    f"the loop in the callback {function.name}() never ends, so no other "
                    "callback runs: use a timer"
                )
                yield CodeFault("callback-wait", message, self._at(node), is_certain=False)
            if not isinstance(node, ast.While) or not _only_waits(node.body):
                continue
            awaited = _awaited(node.test)
            if awaited and self._are_set_elsewhere(awaited, function):
                message = (
                    f"the loop in the callback {function.name}() waits for ever for "
                    f"{enumerated(awaited, word='or')}: no other callback runs until it ends"
                )
                yield CodeFault("callback-wait", message, self._at(node), is_certain=False)

    def _are_set_elsewhere(self, names: _Names, function: AnyFunction) -> bool:
        """Return whether only other functions set what a function waits for.

        What another library is given may set it in a thread of its own.
        """
        inside = {*walk(function), *self._given_away()}
        attributes = {last_part(name) for name in names}
        places: dict[str, list[bool]] = {name: [] for name in names}
        for node in self._code.nodes:
            if not isinstance(node, ast.Attribute) or not isinstance(node.ctx, ast.Store):
                continue
            if dotted(node) in places:
                places[dotted(node)].append(node in inside)
            elif node.attr in attributes:
                return False  # of another object, which may be this one
        return all(len(each) > 1 and not any(each) for each in places.values())

    def _given_away(self) -> set[ast.AST]:
        """Return the nodes in functions that something else than rclpy may call.

        These are those that it is given, that are decorated, and that these call; also lambdas.
        """
        passed = {each.given for each in self._registered}
        functions: dict[str, list[ast.AST]] = {}
        given = list[ast.AST]()
        for node in self._code.nodes:
            if isinstance(node, AnyFunction):
                functions.setdefault(node.name, []).append(node)
                given += [node] if node.decorator_list else []
            elif isinstance(node, ast.Call):
                passed.add(node.func)
        for node in self._code.nodes:
            if node in passed:
                continue
            if isinstance(node, ast.Lambda):
                given.append(node)
            elif isinstance(node, ast.Name | ast.Attribute):
                given += functions.get(dotted(node).removeprefix("self."), ())
        return _with_callees(given, functions)

    def _sleeping(self, function: AnyFunction) -> CodeFaults:
        """Yield where a callback first sleeps, in a module with another callback."""
        text = self._code.text
        has_others = len(self._registered) > 1 or any(word in text for word in _OTHER_CALLBACKS)
        calls = [call for call in _calls_in(function) if dotted(call.func) == "time.sleep"]
        loops = [node for node in walk(function) if isinstance(node, ast.While | ast.For)]
        in_loops = {node for loop in loops for node in walk(loop)}
        has_others = has_others or not in_loops.isdisjoint(calls)
        if not has_others or not calls or "time" not in self._module.imports:
            return
        at = self._at(min(calls, key=make_position))
        message = (
            f"while time.sleep() in the callback {function.name}() waits, no other callback runs"
        )
        yield CodeFault("callback-sleep", message, at, is_certain=False)

    def _waiting(self, call: ast.Call, name: str, clients: _Names, rates: _Names) -> CodeFaults:
        called = dotted(call.func)
        owner, _, method = called.rpartition(".")
        if any(keyword.arg == "timeout_sec" for keyword in call.keywords) or len(call.args) > 2:
            return
        message = ""
        if method == "call" and owner in clients:
            message = (
                f"{called}() in the callback {name}() waits for ever: the answer is only read "
                "when the callback has ended; use call_async()"
            )
        elif method == "sleep" and owner in rates:
            message = (
                f"{called}() in the callback {name}() waits for ever: the timer of a rate only "
                "runs when the callback has ended"
            )
        elif called == _SPINNING and list(map(dotted, call.args[:1])) == ["self"]:
            message = (
                f"spin_until_future_complete() in the callback {name}() waits for ever: the "
                "answer is only read when the callback has ended; use add_done_callback()"
            )
        if message:
            yield CodeFault("callback-wait", message, self._at(call))

    def _reached(self) -> Iterator[AnyFunction]:
        """Yield the callbacks of timers, subscriptions and services, and own methods they call."""
        seen = set()
        pending = [registered for registered in self._registered if registered.by != "ActionServer"]
        reached = [(self._callback(registered), registered.part) for registered in pending]
        while reached:
            function, part = reached.pop(0)
            if not function or function in seen:
                continue
            seen.add(function)
            yield function
            for call in _calls_in(function):
                if dotted(call.func).startswith("self."):
                    reached.append((self._find(call.func, part), part))

    def _is_concurrent(self) -> bool:
        """Return whether some module may run callbacks at the same time.

        It is this module, one that it imports or one that imports it.
        """
        for module in self._related_modules():
            text = module.code.text
            if any(word in text for word in _CONCURRENT):
                return True
            if not _CONCURRENT_MODULES.isdisjoint(
                first_part(imported) for imported in module.imports
            ):
                return True
        return False

    def _related_modules(self) -> Iterator[ModuleText]:
        """Yield this module, those that it imports and those that import it, directly or not."""
        related = {self._module.name: self._module}
        for imports in (True, False):
            pending = [self._module]
            while pending:
                module = pending.pop()
                for other in self._others.values():
                    by, to = (module, other) if imports else (other, module)
                    if other.name not in related and _imports(by, to):
                        related[other.name] = other
                        pending.append(other)
        yield from related.values()

    def of_actions(self) -> CodeFaults:
        """Yield what is done wrong with actions and transforms."""
        goals = []
        answering = []
        servers = [each for each in self._registered if each.by == "ActionServer"]
        for server in servers:
            goals += self._find_goals(server, server.given)
            call = server.call
            answering += self._find_goals(
                server, given_argument(call, len(call.args), "goal_callback")
            )
        yield from goals_without_state(self._code, goals)
        yield from rejected_goals(self._code, answering)
        text = self._code.text
        if goals and "lookup_transform" in text and not self._may_have_threads():
            yield from loops_without_transforms(self._code, goals, self._functions)
        if "get_result_async" in text:
            yield from answers_for_results(self._code, self._module.parts, self._functions)

    def of_helpers(self, imports: StringsByName) -> CodeFaults:
        """Yield what is wrong with buffers of transforms and synchronisers.

        `imports` has the full names of what the module imports.
        """
        code = self._code
        parts = self._module.parts
        helpers = self._attributes.helpers
        if "Buffer" in code.text and "TransformListener" not in code.text:
            yield from buffers_without_listener(code, imports)
        if "Buffer" in code.text and "conversions" not in helpers:
            yield from unregistered_transforms(code, parts, imports)
        if "Synchronizer" in code.text and "callbacks" not in helpers:
            yield from silent_synchronisers(code, parts, imports)

    def _find_goals(self, server: _Registered, given: ast.expr | None) -> list[RegisteredGoal]:
        """Return the function that an action server is given; nothing where it is not known."""
        function = self._callback(server._replace(given=given)) if given else None
        return [RegisteredGoal(function, server.call)] if function else []

    def _may_have_threads(self) -> bool:
        """Return whether anything but rclpy.spin() may run callbacks."""
        texts = [module.code.text for module in self._related_modules()]
        if not any("rclpy.spin(" in text for text in texts):
            return True
        return any(word in text for text in texts for word in _OTHER_THREADS)

    def misnamed_callbacks(self) -> CodeFaults:
        """Yield methods that override no callback of a node's lifecycle, and that nothing names."""
        for owner in self._module.nodes.values():
            if list(map(last_name, owner.bases)) != ["LifecycleNode"]:
                continue
            for method in owner.body:
                if isinstance(method, ast.FunctionDef) and self._is_state_method(method):
                    defined = names_in_class(owner)
                    fault = misnamed_callback(method.name, defined, self._at(method))
                    yield from [] if not fault else [fault]

    def _is_state_method(self, method: ast.FunctionDef) -> bool:
        """Return whether a method takes one argument, and nothing names it."""
        is_named = _count_names([self._module])[method.name] > 0
        is_plain = not method.decorator_list and len(method.args.args) == 2
        return is_plain and not is_named and method.name not in self._attributes.texts

    # --- Programs

    def of_programs(self) -> CodeFaults:
        """Yield that a module makes a node without rclpy.init(), or one that nothing spins.

        The latter is a node with callbacks that never run, with rclpy.init().
        """
        reached = self._reached_modules()
        if reached is None:
            return
        names = _count_names(reached)
        calls = [call for part in self._module.parts if not part.of for call in part.calls]
        by_name = {dotted(call.func): call for call in reversed(calls)}
        init = by_name.get("rclpy.init")
        spin = by_name.get("rclpy.spin")
        if not spin and "rclpy.executors" in self._code.text:
            spin = next((call for call in calls if last_name(call.func) == "add_node"), None)
        if init and self._registered:
            yield from self._unspun(init, reached)
        if spin and not self._is_initialised(names):
            message = "rclpy.init() is missing, so rclpy makes no node"
            [part] = [part for part in self._module.parts if spin in part.calls]
            fixes = self._edits.add_first(part.node.body, "rclpy.init()")
            yield CodeFault("rclpy-init", message, self._at(spin), fixes=fixes)

    def _unspun(self, init: ast.Call, reached: Sequence[ModuleText]) -> CodeFaults:
        """Yield that nothing spins a node with callbacks, or that it is spun once."""
        # A TransformListener can spin the node in a thread.
        if any("spin_thread" in module.code.text for module in reached):
            return
        if _may_spin(reached):
            yield from self._spun_once(reached)
        elif self._certainly_registers(init):
            message = (
                "nothing spins the node, so none of its callbacks runs; write rclpy.spin(node)"
            )
            is_certain = not self._may_work_in_loops(reached)
            at = self._at(init)
            fixes = self._spin()
            yield CodeFault("node-spins", message, at, None, is_certain, fixes)

    def _spin(self) -> Fixes:
        """Return the fix that spins the node of the only statement that makes one."""
        classes = {node.name for node in self._module.nodes.values()}
        calls = []
        statements = {}
        for part in self._module.parts:
            calls += [call for call in part.calls if dotted(call.func) in classes]
            for node in walk(part.node) if not part.of and part.name else ():
                if isinstance(node, ast.Expr | ast.Assign):
                    statements[node.value] = node
        statement = statements.get(calls[0]) if len(calls) == 1 else None
        match statement:
            case ast.Assign(targets=[ast.Name(id=name)]):
                return self._edits.add_behind(statement, f"rclpy.spin({name})")
            case ast.Expr(value=call):
                start, end = self._edits.span(call)
                made = self._code.text[start:end]
                return self._edits.rewrite(start, end, f"rclpy.spin({made})")
        return NO_FIXES

    def uncalled_main(self) -> CodeFaults:
        """Yield that a file that is a program defines main(), and calls nothing."""
        tree = self._code.tree
        text = self._code.text
        main = next((node for node in tree.body if getattr(node, "name", "") == "main"), None)
        if not isinstance(main, ast.FunctionDef) or not self._module.is_script:
            return
        if any(map(_acts, tree.body)) or self._is_imported():
            return
        message = "main() is never called, so the program does nothing"
        space = "\n\n" if text.endswith("\n") else "\n\n\n"
        code = f'{space}if __name__ == "__main__":\n    main()\n'
        fixes = self._edits.insert(len(text), code, "main() is called")
        yield CodeFault("program-main", message, self._at(main), fixes=fixes)

    def _certainly_registers(self, init: ast.Call) -> bool:
        """Return whether a node that functions of the module make certainly has a callback.

        Neither a condition decides about the callback, nor about the node.
        """
        conditional = calls_in_branches(self._code.tree)
        called = {"", "main", "__init__"}
        made = set()
        for part in self._module.parts:
            names = {last_name(call.func) for call in part.calls if call not in conditional}
            called |= names
            if init in part.calls:
                called.add(part.name)
            if not part.of:
                made |= names
        for node in reversed(list(self._module.classes.values())):  # which are below their bases
            if node.name in made:
                made.update(last_name(base) for base in node.bases)
        for registered in self._registered:
            of = registered.part.of
            is_made = not of or self._module.classes[of].name in made
            if is_made and registered.call not in conditional and registered.part.name in called:
                return True
        return False

    def _may_work_in_loops(self, modules: Sequence[ModuleText]) -> bool:
        """Return whether a loop of a program may do something, in place of its callbacks.

        A loop in a callback is not reached, and one that only waits does nothing, unless something
        else runs beside it.
        """
        unreached = self._nodes_in_callbacks()
        imported = {first_part(name) for module in modules for name in module.imports}
        has_others = not _BESIDE.isdisjoint(imported)
        for module in modules:
            for node in module.code.nodes:
                if not isinstance(node, ast.While) or node in unreached:
                    continue
                if has_others or not _only_waits(node.body) or not _is_plain_test(node.test):
                    return True
        return False

    def _nodes_in_callbacks(self) -> set[ast.AST]:
        """Return what is in functions that the code only gives as callbacks."""
        named = _count_names(self._others.values())
        inside = set()
        for registered in self._registered:
            function = self._callback(registered)
            if function and named[function.name] == 1:
                inside.update(walk(function))
        return inside

    def _spun_once(self, reached: Sequence[ModuleText]) -> CodeFaults:
        """Yield that a program runs one callback of a node at most.

        It is certain for a node that surely has several. One without a timeout may wait for the
        message of the only subscription.
        """
        names = _count_names(reached)
        spinning = [name for name in names if name in _SPINS]
        if spinning != ["spin_once"] or names["spin_once"] != 1 or self._is_imported():
            return
        kinds = [registered.by for registered in self._registered]
        for call in self._calls_run_once():
            has_timeout = len(call.args) + len(call.keywords) > 1
            if last_name(call.func) != "spin_once" or (
                kinds == ["create_subscription"] and not has_timeout
            ):
                continue
            message = (
                "spin_once() runs one callback at most, and nothing else spins the node; "
                "write rclpy.spin(node)"
            )
            is_certain = self._has_several_callbacks()
            yield CodeFault("node-spins", message, self._at(call), None, is_certain)

    def _calls_run_once(self) -> Iterator[ast.Call]:
        """Yield the calls that run once at most, as the functions are that have them.

        They are in the body of the module, or in a function that at most this calls, and in no
        loop. No other module imports this one.
        """
        named = _count_names([self._module])
        in_loops = {
            node for loop in self._code.nodes if isinstance(loop, _LOOPS) for node in walk(loop)
        }
        [body] = [part for part in self._module.parts if isinstance(part.node, ast.Module)]
        called = Counter(dotted(call.func) for call in body.calls if call not in in_loops)
        for part in self._module.parts:
            node = part.node
            if isinstance(node, ast.Module):
                calls = list(body.calls)
            elif (
                not part.of
                and not node.decorator_list
                and (named[part.name] == called[part.name] <= 1)
            ):
                calls = list(_calls_in(node))
            else:
                continue
            yield from (call for call in calls if call not in in_loops)

    def _has_several_callbacks(self) -> bool:
        """Return whether the only node of the module surely has more than one callback."""
        conditional = calls_in_branches(self._code.tree)
        sure = [each for each in self._registered if each.call not in conditional]
        owners = {registered.part.of for registered in self._registered}
        return len(sure) > 1 and len(owners) == 1

    def _is_initialised(self, names: _Names) -> bool:
        """Return whether the module, or one that imports it, may initialise rclpy."""
        if "init" in names or "context" in self._code.text.lower():
            return True
        return self._is_imported()

    def _is_imported(self) -> bool:
        others = [other for other in self._others.values() if other.name != self._module.name]
        return any(_imports(other, self._module) for other in others)

    def _reached_modules(self) -> list[ModuleText] | None:
        """Return the module and the own ones that it imports; None if others may spin a node."""
        reached = {self._module.name: self._module}
        pending = [self._module]
        while pending:
            for full in pending.pop().imports:
                own_module = self._others.get(full) or self._others.get(full.rpartition(".")[0])
                if not own_module:
                    if not is_passive(full):
                        return None
                elif own_module.name not in reached:
                    reached[own_module.name] = own_module
                    pending.append(own_module)
        return list(reached.values())


def _acts(statement: ast.stmt) -> bool:
    """Return whether a statement of a program's body may do more than to define names."""
    match statement:
        case ast.If(test=test, orelse=[]) if program_name(test) not in ("", "__main__"):
            return False
        case ast.Import() | ast.ImportFrom() | ast.FunctionDef() | ast.ClassDef():
            return False
        case ast.Assign() | ast.Expr() | ast.If(orelse=[]):
            return any(isinstance(part, ast.Call | ast.Await) for part in walk(statement))
    return True


def _imports(module: ModuleText, other: ModuleText) -> bool:
    """Return whether a module imports another one, or something in it."""
    # Scripts lie beside each other, and import each other by the names of their files.
    name = PurePosixPath(other.name).stem if other.is_script else other.name
    return any(f"{imported}.".startswith(f"{name}.") for imported in module.imports)


def _with_callees(
    given: Iterable[ast.AST], functions: Mapping[str, Sequence[ast.AST]]
) -> set[ast.AST]:
    """Return the nodes in functions, and in those that they call by their names."""
    inside = set()
    pending = list(given)
    while pending:
        function = pending.pop()
        if function in inside:
            continue
        for node in walk(function):
            inside.add(node)
            if isinstance(node, ast.Call):
                pending += functions.get(dotted(node.func).removeprefix("self."), ())
    return inside


def _calls_in(function: ast.AST) -> Iterator[ast.Call]:
    """Yield the calls in a function, without those of functions in it."""
    pending = children(function)
    while pending:
        node = pending.pop()
        if isinstance(node, AnyFunction | ast.Lambda):
            continue
        if isinstance(node, ast.Call):
            yield node
        pending += children(node)


def _own_statements(body: Sequence[ast.stmt]) -> Iterator[ast.stmt]:
    """Yield the statements of a function, also in blocks, without those of functions in it."""
    pending: list[ast.AST] = list(reversed(body))
    while pending:
        node = pending.pop()
        if isinstance(node, ast.stmt):
            yield node
        if isinstance(node, AnyFunction | ast.ClassDef):
            continue
        for inner in reversed(children(node)):
            if isinstance(inner, ast.stmt | ast.ExceptHandler | ast.match_case):
                pending.append(inner)


def _no_response(value: ast.expr, function: AnyFunction) -> str:
    """Return the text of a value that certainly is no response of a service; empty for others.

    It is a literal or a comparison, the request, or a field of the response.
    """
    request, response = _unbound_parameters(function)
    match value:
        case ast.Constant(value=None):
            return ""
        case ast.Constant() | ast.JoinedStr() | ast.List() | ast.Tuple() | ast.Dict() | ast.Set():
            return cut(ast.unparse(value), _MAX_SHOWN)
        case ast.Compare() | ast.UnaryOp(op=ast.Not()):
            return cut(ast.unparse(value), _MAX_SHOWN)
        case ast.Name(id=name) if name == request:
            return f"{name}, the request,"
        case ast.Attribute(value=ast.Name(id=name)) if name == response:
            return dotted(value)
    return ""


def _unbound_parameters(
    function: AnyFunction,
) -> tuple[str | None, str | None]:
    """Return the request and the response of a callback; None for both if it binds one anew."""
    names = [parameter.arg for parameter in function.args.args]
    if names[:1] == ["self"]:
        names = names[1:]
    for node in walk(function):
        is_bound = isinstance(node, ast.Name) and not isinstance(node.ctx, ast.Load)
        if is_bound and getattr(node, "id", "") in names:
            return None, None
    return (names[0], names[1]) if len(names) == 2 else (None, None)


def _is_generator(function: ast.AST) -> bool:
    return any(isinstance(node, ast.Yield | ast.YieldFrom) for node in walk(function))


def _gives_value(function: AnyFunction) -> bool:
    if isinstance(function, ast.AsyncFunctionDef) or _is_generator(function):
        return True
    returns = [inner for inner in _own_statements(function.body) if isinstance(inner, ast.Return)]
    return any(returned.value is not None for returned in returns)


def _ends_without_value(
    function: AnyFunction,
) -> Iterator[tuple[AnyFunction | ast.Return, bool]]:
    """Yield where a function ends without a value: a return, or the function itself for its end.

    Each comes with whether it certainly gets there on some path.
    """
    for statement in _own_statements(function.body):
        match statement:
            case ast.Return(value=None | ast.Constant(value=None)):
                yield statement, True
                return
    end = _falls_off(function.body)
    if end != "no":
        yield function, end == "yes"


def _falls_off(body: Sequence[ast.stmt]) -> str:
    """Return whether statements may come to their end: yes, no, or maybe.

    Maybe means that it depends on a condition that may always hold.
    """
    last = body[-1]
    match last:
        case ast.If(body=first, orelse=second) if second:
            return _either(_falls_off(first), _falls_off(second))
        case ast.If(body=first):
            return "yes" if _falls_off(first) != "no" else "maybe"
        case ast.With(body=inner) | ast.AsyncWith(body=inner):
            return _falls_off(inner)
        case ast.Try():
            return _falls_off_try(last)
    return _falls_off_plain(last)


def _falls_off_plain(statement: ast.stmt) -> str:
    """Return the same for a statement that is a loop, or has no blocks."""
    ending = "yes"
    match statement:
        case ast.Return() | ast.Raise() | ast.Continue() | ast.Break():
            ending = "no"
        case ast.Expr(value=ast.Call(func=made)) if dotted(made) in _ENDING:
            ending = "no"
        case ast.While(test=ast.Constant(value=value)) if value:
            has_break = any(isinstance(inner, ast.Break) for inner in walk(statement))
            ending = "maybe" if has_break else "no"
        case ast.While() | ast.For() | ast.AsyncFor() | ast.Match():
            ending = "maybe"
    return ending


def _falls_off_try(statement: ast.Try) -> str:
    if statement.finalbody and _falls_off(statement.finalbody) == "no":
        return "no"
    ending = _falls_off(statement.orelse or statement.body)
    for handler in statement.handlers:
        ending = _either(ending, _falls_off(handler.body))
    return ending


def _either(one: str, other: str) -> str:
    for answer in ("yes", "maybe"):
        if answer in (one, other):
            return answer
    return "no"


def _count_names(modules: Iterable[ModuleText]) -> Counter[str]:
    """Return how often names and attributes are written in modules."""
    names = Counter[str]()
    for module in modules:
        for node in module.code.nodes:
            names[getattr(node, "attr", "") or getattr(node, "id", "")] += 1
    return names


def _is_plain_test(test: ast.expr) -> bool:
    """Return whether the condition of a loop does nothing: it calls at most rclpy.ok()."""
    calls = [node for node in walk(test) if isinstance(node, ast.Call)]
    return all(dotted(call.func) == "rclpy.ok" for call in calls)


def _may_spin(modules: Sequence[ModuleText]) -> bool:
    """Return whether functions that modules call may spin a node."""
    names = {*_count_names(modules)}
    for module in modules:
        names.update(last_part(name) for name in module.imports)
        for node in module.code.nodes:
            if isinstance(node, ast.Constant) and isinstance(node.value, str):
                names.add(node.value)  # which getattr() may be given
    return not _SPINS.isdisjoint(names)


def _never_ends(loop: ast.While) -> bool:
    """Return whether nothing in a loop leaves it, as long as rclpy runs."""
    is_endless = isinstance(loop.test, ast.Constant) and bool(loop.test.value)
    if not is_endless and ast.unparse(loop.test) != "rclpy.ok()":
        return False
    leaving = (ast.Break, ast.Return, ast.Raise, ast.Yield, ast.YieldFrom, ast.Await)
    if any(isinstance(node, leaving) for node in walk(loop)):
        return False
    return not any(
        "spin" in dotted(call.func) or dotted(call.func) in _ENDING for call in _calls_in(loop)
    )


def _only_waits(body: Sequence[ast.stmt]) -> bool:
    """Return whether the body of a loop only sleeps and writes to the log."""
    for statement in body:
        match statement:
            case ast.Pass():
                continue
            case ast.Expr(value=ast.Call(func=called)):
                is_log = ".get_logger" in ast.unparse(called)
                if not is_log and dotted(called) not in _PAUSES and dotted(called) != "print":
                    return False
            case _:
                return False
    return True


def _awaited(test: ast.expr) -> list[str]:
    """Return the attributes of self that a condition of a loop is made of; none for others.

    A condition that calls a function, as rclpy.ok(), may become false otherwise.
    """
    names = []
    for node in walk(test):
        match node:
            case ast.Attribute():
                names.append(dotted(node))
            case ast.Call() | ast.NamedExpr() | ast.Await():
                return []
    is_own = bool(names) and all(name.count(".") == 1 for name in names)
    return names if is_own and all(name.startswith("self.") for name in names) else []
