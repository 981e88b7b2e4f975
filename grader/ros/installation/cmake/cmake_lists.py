"""Evaluates a package's CMakeLists.txt for what a build installs.

What CMake and ament_cmake certainly do is known; modules, and commands that are not known, leave
undecided what they could touch.
"""

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress

from grader.base.grouping import texts_among
from grader.base.names import near
from grader.base.patterns import on_use
from grader.base.source import Source
from grader.files.tree import Tree
from grader.ros.installation.cmake.ament_checks import check_tests
from grader.ros.installation.cmake.cmake_build import BUILD_COMMANDS, Build
from grader.ros.installation.cmake.cmake_values import (
    OF_INTERFACES,
    Text,
    Values,
    joined,
    split_list,
)
from grader.ros.installation.cmake.conditions import Condition
from grader.ros.installation.cmake.language import (
    BLOCK_WORDS,
    CMakeFault,
    Command,
    all_commands,
    parse_cmake,
)
from grader.ros.installation.file_search import PackageListing
from grader.ros.installation.installation import FoundPackage, Installation
from grader.ros.known.cmake_words import cmake_words
from grader.ros.known.released import is_released
from grader.ros.known.releases import RELEASES
from grader.ros.python.budget import Budget, OutOfBudget
from grader.ros.python.parse import START, Position, SyntaxFault, location_in
from grader.ros.python.values import Unknown

_MAX_DEPTH = 60  # blocks and calls in each other
_PARTS_A_CALL = 10  # for about as long as it takes
_VERSION = on_use(r"\d{1,4}(\.\d{1,4}){0,3}")


class _Returns(Exception):
    """The file is evaluated no further."""


def read_cmake(
    text: str,
    path: str,
    tree: Tree,
    name: str,
    budget: Budget | None = None,
    *,
    is_plain: bool = False,
) -> Installation:
    """Evaluate the CMakeLists.txt of a package with these files, which package.xml gives this name.

    It never raises. A package of `is_plain` CMake needs no ament_package().
    """
    source = Source(path, text)
    try:
        commands = parse_cmake(source)
    except CMakeFault as fault:
        return Installation(
            source, SyntaxFault(source, str(fault), location_in(source, fault.at), fault.is_certain)
        )
    listing = PackageListing(tree, budget)
    build = Build(listing, Values(listing.budget), name, text)
    build.is_plain = is_plain
    every_command = list(all_commands(commands))
    names = {command.name for command in every_command}
    build.may_have_other_targets = not names.isdisjoint(cmake_words().target_makers)
    try:
        with suppress(_Returns):
            _Evaluation(build).run(commands)
        check_tests(build, commands)
    except OutOfBudget:
        build.give_up("the file is too long to evaluate", START)
    build.note_calls(every_command)
    return build.result(source)


def _newest_minimum(texts: Sequence[Text]) -> tuple[int, ...] | None:
    """Return the version for which the policies of CMake are set: of `VERSION 3.1...3.20` the last.

    The result is None where it is not known.
    """
    words = texts_among(texts)
    if len(words) < len(texts) or words[:1] != ["VERSION"] or len(words) < 2:
        return None
    newest = words[1].rpartition("...")[2]
    if not _VERSION.fullmatch(newest):
        return None
    return tuple(map(int, newest.split(".")))


class _Evaluation:
    """Runs the commands of a file."""

    def __init__(self, build: Build) -> None:
        self.build = build
        self.values = build.values
        self.own: dict[str, Command] = {}  # functions and macros
        self._depth = 0  # of blocks and calls in each other
        self._for_outside: dict[str, Text] = {}  # what the current function sets with PARENT_SCOPE

    def run(self, commands: Sequence[Command]) -> None:
        """Evaluate commands in their order: those of a file, or of a block or function in it."""
        if self._depth == _MAX_DEPTH:
            self.build.give_up(
                "blocks and calls that are nested so deeply are not evaluated", START
            )
            return
        self._depth += 1
        try:
            self._run_each(commands)
        finally:
            self._depth -= 1

    def _run_each(self, commands: Sequence[Command]) -> None:
        for command in commands:
            self.values.budget.charge(1 + len(command.arguments))
            self.build.last = command.at
            self._require_provider(command)
            self._note_release(command)
            self.build.require_closed(command)
            if command.name in _COMMANDS:
                _COMMANDS[command.name](self, command)
            elif command.name in BUILD_COMMANDS:
                BUILD_COMMANDS[command.name](self.build, command)
            elif command.name in cmake_words().named_targets:
                self.build.name_target(command)
            elif command.name in self.own:
                self._call(command)
            elif command.name in cmake_words().harmless:
                self._forget_outputs(command)
            else:
                self.build.give_up(f"{command.name}() is not evaluated", command.at)

    def _require_provider(self, command: Command) -> None:
        """Stop the build at a command that no package defines which was found."""
        if self.values.is_opaque or self.build.doubts or command.name in self.own:
            return
        default = "ament_cmake" if command.name.startswith("ament_") else ""
        provider = cmake_words().providers.get(command.name, default)
        reached = self.values.reached_packages() if provider else None
        if reached is None or provider in reached:
            return
        needed = provider
        if provider in cmake_words().exports["ament_cmake"].split():
            needed = "ament_cmake"
        if provider == "rosidl_cmake":
            needed = "rosidl_default_generators"
        self.build.stop(
            f"CMake knows no command {command.name}(), because nothing finds the package {needed}",
            command.at,
            hint=f"; write find_package({needed} REQUIRED)",
            change=("", f"find_package({needed} REQUIRED)\n"),
        )
        self.values.packages.add(needed)

    def _note_release(self, command: Command) -> None:
        """Note a command that later releases do not have, or a version that their CMake refuses."""
        gone = cmake_words().gone_command(command.name)
        if gone and command.name not in self.own:
            first = RELEASES[RELEASES.index(gone.until) + 1]
            reason = f"CMake knows no command {command.name}()"
            self.build.stop_later(reason, first, command.at, f"use {gone.instead}")
        if command.name != "cmake_minimum_required":
            return
        asked = _newest_minimum(self.values.texts(command.arguments))
        for release in RELEASES:
            oldest = cmake_words().oldest_minimum.get(release)
            if oldest is not None and asked is not None and asked < oldest:
                shown = ".".join(map(str, oldest))
                reason = f"CMake refuses cmake_minimum_required() below {shown}"
                self.build.stop_later(reason, release, command.at, "write VERSION 3.10")

    def _forget_outputs(self, command: Command) -> None:
        """Forget the variables that a harmless command sets; message() may stop."""
        texts = self.values.texts(command.arguments)
        if command.name == "message" and texts[:1] in (["FATAL_ERROR"], ["SEND_ERROR"]):
            words = " ".join(text for text in texts[1:] if isinstance(text, str))
            self.build.stop(f"CMakeLists.txt stops with the message {words!r}", command.at)
        self.build.may_make_files |= command.name == "execute_process"
        self.values.is_opaque |= command.name in cmake_words().opaque
        index = cmake_words().outputs.get(command.name, len(texts))
        names = texts if index < 0 else texts[index : index + 1]
        self.values.note_libraries(command.name, names, texts)
        self.values.forget(names, f"the result of {command.name}() is not evaluated", command.at)

    # --- Control flow
    # ----------------------------------------------------------------------

    def _maybe(self, commands: Sequence[Command], reason: Unknown) -> None:
        """Evaluate commands that may run, or may run several times."""
        before = self.values.uncertain
        self.values.uncertain = self.values.uncertain or reason
        try:
            self.run(commands)
        finally:
            self.values.uncertain = before

    def if_(self, command: Command) -> None:
        """Evaluate the branches that may run, up to the first whose condition certainly holds."""
        doubt: Unknown | None = None
        for branch in (command, *command.others):
            holds = True if branch.name == "else" else self._holds(branch)
            if holds is None:
                doubt = doubt or Unknown(
                    f"the condition of {branch.name}() is not known", branch.at
                )
            if holds is not False and doubt:
                self._maybe(branch.body, doubt)
            elif holds:
                self.run(branch.body)
            if holds:
                return

    def _holds(self, command: Command) -> bool | None:
        tokens = []
        for argument in command.arguments:
            is_plain = argument.kind in ("unquoted", "paren")
            tokens += [(text, is_plain) for text in self.values.expanded(argument)]
        return Condition(tokens, self.values, self.build.exists, command.at).holds()

    def foreach(self, command: Command) -> None:
        """Evaluate a loop over known items, and its body once for each that is not known."""
        name, items = self.values.first_and_rest(command)
        if items[:1] == ["IN"]:
            items = list(self._items(items[1:], command.at))
        elif items[:1] == ["RANGE"]:
            items = [Unknown("a range is not evaluated", command.at)]
        for item in items:
            doubt = next((text for text in (name, item) if isinstance(text, Unknown)), None)
            self.values.assign(str(name), item)
            if doubt:
                self._maybe(command.body, doubt)
            else:
                self.run(command.body)

    def _items(self, texts: Sequence[Text], at: Position) -> Iterator[Text]:
        """Yield the items of foreach(... IN LISTS lists ITEMS items)."""
        is_list = False
        for text in texts:
            if text in ("LISTS", "ITEMS"):
                is_list = text == "LISTS"
            elif is_list and isinstance(text, str):
                value = self.values.lookup(text, at)
                if isinstance(value, Unknown):
                    yield value
                else:
                    yield from split_list(value)
            else:
                yield text

    def repeat(self, command: Command) -> None:
        """Evaluate the body of while() or block(), of which more is not known."""
        self._maybe(command.body, Unknown(f"{command.name}() is not evaluated", command.at))

    def define(self, command: Command) -> None:
        """Remember a function or macro."""
        self.own[str(self.values.first(command)).lower()] = command

    def _call(self, command: Command) -> None:
        """Evaluate the body of an own function or macro.

        The variables of a function are its own.
        """
        definition, values = self.own.pop(command.name), self.values  # so that none calls itself
        values.budget.charge(_PARTS_A_CALL)
        texts = values.texts(command.arguments)
        names = [str(text) for text in values.texts(definition.arguments[1:])]
        if definition.name == "function":
            values.enter_function()
        values.assign_all(dict(zip(names, texts, strict=False)))
        given = {"ARGV": joined(texts, ";"), "ARGN": joined(texts[len(names) :], ";")}
        values.assign_all({**given, "ARGC": str(len(texts))})
        with suppress(_Returns):
            self.run(definition.body)
        if definition.name == "function":
            values.leave_function(self._for_outside)
        self._for_outside = {}
        self.own[command.name] = definition

    def return_(self, command: Command) -> None:
        """End the file, or note that it may end here."""
        if not self.values.uncertain:
            raise _Returns
        self.build.give_up("return() may end the file", command.at)

    # --- Variables
    # ----------------------------------------------------------------------

    def project(self, command: Command) -> None:
        """Set the name of the project."""
        name = self.values.first(command)
        self.values.assign("PROJECT_NAME", name)
        self.values.assign("CMAKE_PROJECT_NAME", name)
        self.values.packages.add(str(name).lower())

    def set_(self, command: Command) -> None:
        """Set or unset a variable."""
        name, values = self.values.first_and_rest(command)
        if isinstance(name, Unknown):
            self.values.is_opaque = True
            return
        end = next(
            (index for index, value in enumerate(values) if value in ("CACHE", "PARENT_SCOPE")),
            len(values),
        )
        value = joined(values[:end] if command.name == "set" else (), ";")
        if values[end:] == ["PARENT_SCOPE"]:
            self._for_outside[name] = self.values.uncertain or value
        else:
            self.values.assign(name, value)

    def option(self, command: Command) -> None:
        """Set an option to its default, which colcon does not change."""
        name, rest = self.values.first_and_rest(command)
        if isinstance(name, str) and name not in self.values.variables:
            self.values.assign(name, rest[1] if len(rest) > 1 else "OFF")

    def list_(self, command: Command) -> None:
        """Append to a list; the results of other operations are not known."""
        match self.values.texts(command.arguments):
            case ["APPEND", str() as name, *items]:
                old = self.values.variables.get(name, "")
                self.values.assign(name, joined([*([old] if old else []), *items], ";"))
            case texts:
                self.values.forget(texts[1:], "this list() is not evaluated", command.at)

    def include(self, command: Command) -> None:
        """Set what a well-known module does; another one may do anything."""
        name = self.values.first(command)
        if name == "GNUInstallDirs":
            self.values.assign_all(cmake_words().install_dirs)
        elif name not in cmake_words().modules:
            self.build.give_up("include() is not evaluated", command.at)

    def find_package(self, command: Command) -> None:
        """Remember a package, whose variables are not known.

        One that is surely misspelt stops the build, if it is required, and is not found.
        """
        name, words = self.values.first_and_rest(command)
        if isinstance(name, Unknown):
            self.values.is_opaque = True
            return
        known = cmake_words().exports
        meant = near(name, known) if name.lower() not in known else None
        if meant is not None and not is_released(name):
            if "REQUIRED" not in words:
                return
            self.build.stop(f"there is no package {name!r}", command.at, change=(name, meant))
            name = meant
        is_certain = not self.values.uncertain
        looked_for = FoundPackage(name, command.at, "REQUIRED" in words, is_certain)
        self.build.found_packages.append(looked_for)
        self.values.packages.add(name.lower())
        self.values.finds_interfaces |= name not in known and name.endswith(OF_INTERFACES)
        self.values.assign(f"{name}_FOUND", "1")

    def file_(self, command: Command) -> None:
        """Search files; the results of other operations are not known."""
        texts = self.values.texts(command.arguments)
        match texts:
            case ["GLOB" | "GLOB_RECURSE" as word, str() as name, *patterns]:
                found_paths = self.build.searched(patterns, command.at, recursive=word != "GLOB")
                self.values.assign(name, found_paths)
            case _:
                names = [
                    text for text in texts[1:] if isinstance(text, str) and text.isidentifier()
                ]
                self.values.forget(names, "the result of file() is not evaluated", command.at)


_COMMANDS: dict[str, Callable[[_Evaluation, Command], None]] = {
    "if": _Evaluation.if_,
    "foreach": _Evaluation.foreach,
    "while": _Evaluation.repeat,
    "block": _Evaluation.repeat,
    "function": _Evaluation.define,
    "macro": _Evaluation.define,
    "return": _Evaluation.return_,
    "project": _Evaluation.project,
    "set": _Evaluation.set_,
    "unset": _Evaluation.set_,
    "option": _Evaluation.option,
    "list": _Evaluation.list_,
    "include": _Evaluation.include,
    "find_package": _Evaluation.find_package,
    "file": _Evaluation.file_,
}


def known_commands() -> frozenset[str]:
    """Return the names of the commands that are known of CMake and ament_cmake."""
    words = cmake_words()
    known = {*_COMMANDS, *BUILD_COMMANDS, *words.harmless, *words.named_targets, *BLOCK_WORDS}
    return frozenset(known)
