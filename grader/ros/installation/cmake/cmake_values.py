"""The variables of a CMakeLists.txt, and the texts that its arguments stand for."""

import re
from collections.abc import Iterable, Mapping, Sequence
from itertools import chain

from grader.base.grouping import texts_among
from grader.base.patterns import on_use
from grader.ros.installation.cmake.language import Argument, Command
from grader.ros.installation.places import PREFIX
from grader.ros.known.cmake_words import cmake_words
from grader.ros.python.budget import Budget
from grader.ros.python.library import PACKAGE_FOLDER
from grader.ros.python.parse import Position
from grader.ros.python.values import Unknown

Text = str | Unknown
ROOT, _BUILD = f"/{PACKAGE_FOLDER}", "/<build>"  # the folders of the package, and of what is built
_FOLDERS = {
    **dict.fromkeys(("CMAKE_SOURCE_DIR", "CMAKE_CURRENT_SOURCE_DIR", "PROJECT_SOURCE_DIR"), ROOT),
    "CMAKE_CURRENT_LIST_DIR": ROOT,
    **dict.fromkeys(("CMAKE_BINARY_DIR", "CMAKE_CURRENT_BINARY_DIR", "PROJECT_BINARY_DIR"), _BUILD),
    "CMAKE_INSTALL_PREFIX": PREFIX,
}
_PIECES = on_use(r"\\(.)|(\$\{)|(\})|\$(?:ENV|CACHE)\{[^}]*\}?|\$<|[^\\$}]+|.", re.DOTALL)
_ESCAPES = {"n": "\n", "t": "\t", "r": "\r", ";": "\\;"}
_NAMES = on_use(r"\$\{([^${}]*)\}")
_SEPARATOR = on_use(r"(?<!\\);")
_MAX_TEXT = 64 * 1024  # characters of a value

# How the names of packages of interfaces end; what each of these exports besides others.
OF_INTERFACES = ("_msgs", "_srvs", "_interfaces", "_actions")
_WITH_INTERFACES = ("builtin_interfaces", "action_msgs", "service_msgs", "rosidl_default_runtime")


class Values:
    """The variables of a file while it is evaluated."""

    def __init__(self, budget: Budget) -> None:
        self.budget = budget
        self.variables: dict[str, Text] = {**cmake_words().variables, **_FOLDERS}
        self.packages: set[str] = set()  # that were found, in lower case
        self.finds_interfaces = False  # whether some have interfaces, and bring what is not known
        # why it is not known whether the current command is run
        self.uncertain: Unknown | None = None
        self.is_opaque = False  # whether something that is not evaluated may have set any variable
        # The names of libraries: variables that find_library() sets, and how those of
        # pkg_check_modules() begin.
        self.libraries: set[str] = set()
        self.prefixes: set[str] = set()
        # What variables were outside of the functions that are called; None for unset ones.
        self._outside: list[dict[str, Text | None]] = []
        self._reached: tuple[tuple[int, str], set[str] | None] | None = None

    def reached_packages(self) -> set[str] | None:
        """Return the packages that were found, with those that they export.

        The result is None where it is not known which these are. A package of interfaces exports
        others of interfaces and nothing else.
        """
        if self.is_opaque:
            return None
        key = (len(self.packages), str(self.variables.get("PROJECT_NAME")).lower())
        if self._reached is None or self._reached[0] != key:
            self._reached = (key, self._reach(self.packages - {key[1]}))
        return self._reached[1]

    def _reach(self, packages: set[str]) -> set[str] | None:
        exports = cmake_words().exports
        self.budget.charge(len(packages))
        if any(name not in exports and not name.endswith(OF_INTERFACES) for name in packages):
            return None
        brought = _WITH_INTERFACES if self.finds_interfaces else ()
        return reachable_packages([*packages, *brought])

    def texts(self, arguments: Sequence[Argument]) -> list[Text]:
        """Return what arguments stand for; a list is several texts."""
        return [text for argument in arguments for text in self.expanded(argument)]

    def known(self, command: Command) -> list[str] | None:
        """Return what the arguments of a command stand for; None if one is not known."""
        texts = self.texts(command.arguments)
        known = texts_among(texts)
        if len(known) == len(texts):
            return known
        return None

    def first(self, command: Command) -> Text:
        """Return what the first argument of a command stands for; an empty text without any."""
        return next(iter(self.texts(command.arguments[:1])), "")

    def first_and_rest(self, command: Command) -> tuple[Text, list[Text]]:
        """Return what the arguments of a command stand for; the first is empty without any."""
        first, *rest = self.texts(command.arguments) or [""]
        return first, rest

    def expanded(self, argument: Argument) -> list[Text]:
        """Return what an argument stands for."""
        if argument.kind in ("bracket", "paren"):
            return [argument.text]
        text = self._value(argument.text, argument.at)
        if isinstance(text, Unknown) or argument.kind == "quoted":
            return [text]
        return list(split_list(text))

    def _value(self, text: str, at: Position) -> Text:
        """Return a text with the values of variables, whose names may be made of variables."""
        stack: list[list[Text]] = [[]]
        for piece in _PIECES.finditer(text):
            escaped, opening, closing = piece.groups()
            if opening:
                stack.append([])
            elif closing and len(stack) > 1:
                name = joined(stack.pop())
                stack[-1].append(name if isinstance(name, Unknown) else self.lookup(name, at))
            elif escaped:
                stack[-1].append(_ESCAPES.get(escaped, escaped))
            elif piece[0].startswith("$") and len(piece[0]) > 1:
                stack[-1].append(Unknown(f"{piece[0]} is not known", at))
            else:
                stack[-1].append(piece[0])
        return self._bounded(joined(chain.from_iterable(stack)), len(text), at)

    def _bounded(self, value: Text, length: int, at: Position) -> Text:
        """Return a value unless it is too long; its length, or that of its text, is charged."""
        self.budget.charge(1, length if isinstance(value, Unknown) else len(value))
        if isinstance(value, str) and len(value) > _MAX_TEXT:
            return Unknown("a value is too long", at)
        return value

    def lookup(self, name: str, at: Position) -> Text:
        """Return the value of a variable: an empty text if it is certainly not set."""
        if name in self.variables:
            return self.variables[name]
        if self.is_opaque or self._is_of_package(name):
            return Unknown(f"the value of {name} is not known", at)
        return ""

    def _is_of_package(self, name: str) -> bool:
        """Return whether CMake or a package that was found sets a variable."""
        lower = name.lower()
        ends = [index for index, letter in enumerate(lower) if letter == "_"]
        self.budget.charge(1, len(ends) * len(name))
        is_found = any(lower[:end] in self.packages for end in ends)
        return is_found or lower.startswith((*cmake_words().foreign,))

    def note_libraries(self, command: str, names: Sequence[Text], texts: Sequence[Text]) -> None:
        """Note the variables in which a command puts the names of libraries of others.

        `names` are the variables that it sets, `texts` its arguments.
        """
        if command == "find_library":
            self.libraries.update(str(name) for name in names)
        if command in ("pkg_check_modules", "pkg_search_module"):
            self.prefixes.update(f"{text}_" for text in texts[:1])

    def may_name_own_target(self, argument: Argument) -> bool:
        """Return whether an argument whose value is not known may name targets of the file.

        The variables of packages, as OpenCV_LIBS, and what find_library() finds name others.
        """
        names = _NAMES.findall(argument.text)
        for name in names:
            is_foreign = name not in self.variables and self._is_of_package(name)
            is_foreign = is_foreign or name.startswith(tuple(self.prefixes))
            if not is_foreign and name not in self.libraries:
                return True
        return not names

    def assign(self, name: str, value: Text) -> None:
        """Set a variable; to what is not known if the command may not run."""
        self.assign_all({name: self.uncertain or value})

    def assign_all(self, values: Mapping[str, Text]) -> None:
        """Set variables, in the function that is called."""
        if self._outside:
            for name in values:
                self._outside[-1].setdefault(name, self.variables.get(name))
        self.variables |= values

    def enter_function(self) -> None:
        """Begin a function, whose variables are its own."""
        self._outside.append({})

    def leave_function(self, kept: Mapping[str, Text]) -> None:
        """End a function, which sets these variables outside of it."""
        for name, value in self._outside.pop().items():
            if value is None:
                self.variables.pop(name, None)
            else:
                self.variables[name] = value
        self.assign_all(kept)

    def forget(self, names: Iterable[Text], reason: str, at: Position) -> None:
        """Set variables to a value that is not known."""
        texts = texts_among(names)
        self.assign_all(dict.fromkeys(texts, Unknown(reason, at)))


def reachable_packages(packages: Iterable[str]) -> set[str]:
    """Return packages with those that they export, directly or not."""
    pending = list(packages)
    reached = set()
    while pending:
        package = pending.pop()
        if package not in reached:
            reached.add(package)
            pending += cmake_words().exports.get(package, "").split()
    return reached


def split_list(text: str) -> list[str]:
    """Return the items of a list that are not empty."""
    return [part.replace("\\;", ";") for part in _SEPARATOR.split(text) if part]


def joined(parts: Iterable[Text], between: str = "") -> Text:
    """Return one text; a part that is not known makes it unknown."""
    known = []
    for part in parts:
        if isinstance(part, Unknown):
            return part
        known.append(part)
    return between.join(known)
