"""The files that a CMakeLists.txt certainly installs, as far as its plain commands say. CMake is never run.

Only `install(DIRECTORY|FILES|PROGRAMS ... DESTINATION ...)` and `ament_auto_package(INSTALL_TO_SHARE ...)` outside of
conditions, loops and functions are followed, with variables of one value.
"""

import posixpath
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from grader.errors import InputError
from grader.files.tree import Tree

# The syntax of cmake-language(7).
_TOKEN = re.compile(
    r"""
      \#\[(=*)\[.*?(?:\]\1\]|\Z)    # a comment of several lines: #[[ ... ]], #[=[ ... ]=]
    | \#[^\n]*
    | "((?:\\.|[^"\\])*)"           # "my \"robot\".urdf"
    | ([()])
    | ((?:\\.|[^\s()"\#])+)         # install, share/${PROJECT_NAME}
    """,
    re.DOTALL | re.VERBOSE,
)
_VARIABLE = re.compile(r"\$\{(\w+)\}")
_SOURCE = "${CMAKE_CURRENT_SOURCE_DIR}/"
_MAX_SIZE = 128 * 1024  # bytes
_OPENING = ("if", "foreach", "while", "function", "macro", "block")
_KINDS = ("DIRECTORY", "FILES", "PROGRAMS")
# Commands that install no file of a share folder, and change no variable.
_HARMLESS = frozenset(
    {"add_compile_options", "add_definitions", "add_executable", "add_library", "ament_environment_hooks",
     "ament_export_dependencies", "ament_export_include_directories", "ament_export_libraries", "ament_export_targets",
     "ament_lint_auto_find_test_dependencies", "ament_package", "ament_python_install_package",
     "ament_target_dependencies", "cmake_minimum_required", "else", "elseif", "find_package", "include_directories",
     "message", "target_compile_features", "target_compile_options", "target_include_directories",
     "target_link_libraries", *_OPENING, *(f"end{name}" for name in _OPENING)}
)  # fmt: skip


@dataclass(slots=True)
class CMake:
    """The files of a package that a build installs: their paths in the package by their paths below the prefix.

    `is_certain` is False where it may install others, too.
    """

    tree: Tree = field(repr=False)
    installed: dict[str, str] = field(default_factory=dict)
    is_certain: bool = True
    _variables: dict[str, str | None] = field(default_factory=dict, repr=False)

    def run(self, name: str, arguments: Sequence[str]) -> None:
        """Follow a command that is not inside of another one."""
        match name, arguments:
            case "project", [project, *_]:
                self._variables |= dict.fromkeys(("PROJECT_NAME", "CMAKE_PROJECT_NAME"), self._text(project))
            case "set", [variable, value]:
                self._variables[variable] = self._text(value)
            case "set", [variable, *_]:
                self._variables[variable] = None
            case "install", ["TARGETS" | "EXPORT", *_]:
                pass
            case "install", [kind, *rest] if kind in _KINDS and rest.count("DESTINATION") == 1:
                where = rest.index("DESTINATION")
                self._install(kind, rest[:where], rest[where + 1 :])
            case "ament_auto_package", ["INSTALL_TO_SHARE", *folders]:
                self._install("DIRECTORY", folders, ["share/${PROJECT_NAME}"])
            case "ament_auto_package", []:
                pass
            case _ if name not in _HARMLESS:
                self.doubt(arguments)

    def doubt(self, arguments: Sequence[str]) -> None:
        """Take into account a command that is not followed: it may install files, and set variables that it names."""
        self.is_certain = False
        self._variables |= dict.fromkeys(set(arguments) & self._variables.keys())

    def _install(self, kind: str, names: Sequence[str], destination: Sequence[str]) -> None:
        sources = [self._text(name.removeprefix(_SOURCE)) for name in names]
        folder = self._text(destination[0]) if len(destination) == 1 else None  # what follows may exclude files
        for source in sources:
            if source is None or folder is None or source.startswith(("/", "..")):
                self.is_certain = False
            elif kind == "DIRECTORY":
                self._copy(source, folder)
            elif (path := posixpath.normpath(source)) in self.tree.files:
                self.installed[posixpath.normpath(f"{folder}/{posixpath.basename(path)}")] = path

    def _copy(self, source: str, target: str) -> None:
        """Install a folder; with a slash at its end, what is in it."""
        path = posixpath.normpath(source) if source.strip("/") else "."
        start = "" if path == "." else f"{path}/"
        kept = "" if source.endswith("/") or not start else posixpath.basename(path)
        for file in self.tree.files:
            if file.startswith(start):
                self.installed[posixpath.normpath(posixpath.join(target, kept, file.removeprefix(start)))] = file

    def _text(self, word: str) -> str | None:
        """Return an argument with its variables; None where one of them is not known."""
        values = [self._variables.get(name) for name in _VARIABLE.findall(word)]
        if None in values:
            return None
        text = _VARIABLE.sub(lambda found: self._variables[found[1]] or "", word)
        return None if "$" in text or "\\" in text or ";" in text else text


def read_cmake(tree: Tree) -> CMake:
    """Return what the CMakeLists.txt of a package with these files installs."""
    cmake, depth = CMake(tree), 0
    try:
        text = tree.files["CMakeLists.txt"].read(_MAX_SIZE).decode("utf-8", "replace")
    except InputError:
        return CMake(tree, is_certain=False)
    for name, arguments in _commands(text):
        depth += (name in _OPENING) - (name.removeprefix("end") in _OPENING and name.startswith("end"))
        if name == "return" or any(word.startswith("[") for word in arguments):  # a bracket argument may hold anything
            cmake.is_certain = False
            break
        if not depth:
            cmake.run(name, arguments)
        elif name not in _HARMLESS:
            cmake.doubt(arguments)
    return cmake


def _commands(text: str) -> Iterator[tuple[str, list[str]]]:
    """Yield each command with its arguments; parentheses in them are ignored."""
    name, arguments, depth = "", list[str](), 0
    for token in _TOKEN.finditer(text):
        _, in_quotes, bracket, word = token.groups()
        if bracket == "(":
            depth += 1
        elif bracket == ")":
            depth -= 1
            if depth == 0:
                yield name.lower(), arguments
                arguments = []
        elif depth and (in_quotes is not None or word is not None):
            arguments.append(word if in_quotes is None else in_quotes)
        elif word is not None:
            name = word
