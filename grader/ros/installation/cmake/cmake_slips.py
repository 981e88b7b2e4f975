"""The slips of a CMakeLists.txt: words for which CMake stops or installs files elsewhere."""

from collections.abc import Collection, Iterable

from grader.base.names import MAX_GUESSES, near
from grader.base.patterns import on_use
from grader.base.slips import Slip, Slips
from grader.base.source import Source
from grader.base.text import quoted
from grader.files.tree import Tree
from grader.ros.installation.cmake.cmake_lists import known_commands
from grader.ros.installation.cmake.language import (
    Argument,
    CMakeFault,
    Command,
    all_commands,
    parse_cmake,
)
from grader.ros.known.cmake_words import cmake_words
from grader.ros.python.parse import Position, location_in

_KINDS = frozenset({"DIRECTORY", "FILES", "PROGRAMS", "TARGETS"})
_VARIABLE = on_use(r"\$\{(\w+)\}")
_UNMARKED = on_use(r"\$\{\w+\}|(?:\$\(|\$|\{)(\w+)[)}]?|(?<=/)(\w+)(?=/|$)")
_COMMAND = on_use(r"\s*[A-Za-z_]\w*\s*\(")


def cmake_slips(source: Source, tree: Tree, name: str, dependencies: Iterable[str]) -> list[Slip]:
    """Return the slips of a file; `name` and `dependencies` are those of package.xml."""
    try:
        commands = parse_cmake(source)
    except CMakeFault as fault:
        return list(_unclosed(source, fault))
    reader = _CMakeSlips(source, tree, name, frozenset(dependencies))
    return list(reader.found(commands))


def _unclosed(source: Source, fault: CMakeFault) -> Slips:
    """Yield the parenthesis that a command lacks: it belongs before the next command."""
    if not fault.is_certain or fault.args[0] != "a parenthesis is not closed":
        return
    first = location_in(source, fault.at).line
    lines = source.text.split("\n")
    last = first
    for number in range(first + 1, len(lines) + 1):
        if _COMMAND.match(lines[number - 1]):
            break
        if lines[number - 1].strip():
            last = number
    start = source.offset(last, 1)
    line = source.line(last)
    edit = source.edit(start, start + len(line), f"{line})")
    command = source.line(first).strip().partition("(")[0]
    yield Slip(
        (edit,),
        f"CMake cannot read the file: {fault}",
        f"{command}() ends in line {last}",
        source.at(source.offset(first, 1)),
        is_refused=True,
    )


class _CMakeSlips:
    """The search for the slips in the commands of a file."""

    def __init__(self, source: Source, tree: Tree, name: str, dependencies: frozenset[str]) -> None:
        self._source = source
        self._tree = tree
        self._name = name
        self._dependencies = dependencies
        self._variables = {"PROJECT_NAME"}
        self._guesses = 0
        self._commands = set(known_commands())

    def found(self, commands: Iterable[Command]) -> Slips:
        """Yield the slips of commands, also of those in blocks."""
        every_command = list(all_commands(commands))
        for command in every_command:
            if command.name in ("function", "macro", "set", "option") and command.arguments:
                names = self._variables if command.name in ("set", "option") else self._commands
                names.add(command.arguments[0].text)
        for command in every_command:
            yield from self._of_command(command)

    def _near(self, name: str, known: Collection[str]) -> str | None:
        """Return the name that surely is meant.

        This is done for the first misspelt ones only, because comparing names takes long.
        """
        self._guesses += 1
        return near(name, known) if self._guesses <= MAX_GUESSES else None

    def _of_command(self, command: Command) -> Slips:
        if command.name not in self._commands:
            meant = self._near(command.name, self._commands)
            if meant is None:
                return
            start = self._offset(command.at)
            edit = self._source.edit(start, start + len(command.name), meant)
            reaction = f"CMake knows no command {command.name}()"
            assumption = f"{command.name}() is read as {meant}()"
            yield Slip((edit,), reaction, assumption, self._source.at(start), is_refused=True)
            command = command._replace(name=meant)
        for argument in command.arguments:
            yield from self._of_variables(argument)
        if not command.arguments:
            return
        first = command.arguments[0]
        if command.name == "project":
            yield from self._of_project(first)
        elif command.name == "find_package":
            yield from self._of_package(first)
        elif command.name == "install":
            yield from self._of_install(command)

    def _of_project(self, argument: Argument) -> Slips:
        """Yield that project() has another name than package.xml."""
        if self._name and "$" not in argument.text and argument.text != self._name:
            reaction = (
                f"project() names the package {quoted(argument.text)}, package.xml names it "
                f"{quoted(self._name)}"
            )
            yield self._of_argument(argument, self._name, reaction)

    def _of_package(self, argument: Argument) -> Slips:
        """Yield that find_package() names a misspelt package."""
        known = {*self._dependencies, "ament_cmake"}
        meant = near(argument.text, known) if argument.text not in known else None
        if meant is not None:
            yield self._of_argument(argument, meant, f"there is no package {quoted(argument.text)}")

    def _of_install(self, command: Command) -> Slips:
        """Yield misspelt words of install(), and the paths that it lists."""
        first, *others = command.arguments
        if first.text not in _KINDS:
            meant = near(first.text, _KINDS)
            if meant is not None:
                yield self._of_argument(first, meant, f"install() knows no word {first.text}")
            return
        keywords = cmake_words().install_keywords
        is_listed = first.text != "TARGETS"  # whether the arguments are what is installed
        for argument in others:
            text = argument.text
            is_word = text.isupper() and argument.kind == "unquoted"
            keyword = near(text, keywords) if is_word and text not in keywords else None
            if text in keywords:
                is_listed = False
            elif keyword:
                is_listed = False
                yield self._of_argument(argument, keyword, f"install() knows no word {text}")
            elif is_listed and "$" not in text:
                yield from self._of_path(argument, is_folder=first.text == "DIRECTORY")

    def _of_path(self, argument: Argument, *, is_folder: bool) -> Slips:
        path = argument.text.rstrip("/").removeprefix("./")
        known = self._tree.folders if is_folder else self._tree.files
        if not path or path in known:
            return
        folder = path.rpartition("/")[0]
        meant = self._near(
            path, [other_path for other_path in known if other_path.rpartition("/")[0] == folder]
        )
        if meant is not None:
            new = argument.text.replace(path, meant)
            yield self._of_argument(argument, new, f"the package has no {argument.text}")

    def _of_variables(self, argument: Argument) -> Slips:
        for used in _VARIABLE.finditer(argument.text):
            name = used[1]
            meant = self._near(name, self._variables) if name not in self._variables else None
            if meant is not None:
                new = argument.text.replace(used[0], f"${{{meant}}}")
                reaction = f"no variable {name} is set, so that it is empty"
                yield self._of_argument(argument, new, reaction, is_refused=False)
        for written in _UNMARKED.finditer(argument.text):
            name = written[1] or written[2]
            if name in self._variables:
                new = argument.text.replace(written[0], f"${{{name}}}")
                reaction = f"{written[0]} is no variable"
                yield self._of_argument(argument, new, reaction, is_refused=False)

    def _of_argument(
        self, argument: Argument, new: str, reaction: str, *, is_refused: bool = True
    ) -> Slip:
        start = self._source.text.find(argument.text, self._offset(argument.at))
        edit = self._source.edit(start, start + len(argument.text), new)
        assumption = f"{argument.text} is read as {new}"
        return Slip((edit,), reaction, assumption, self._source.at(start), is_refused)

    def _offset(self, at: Position) -> int:
        location = location_in(self._source, at)
        return self._source.start_offset(location)
