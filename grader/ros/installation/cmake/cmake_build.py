"""The targets and the installed files of a CMakeLists.txt, and what stops its build."""

import re
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from contextlib import suppress
from fnmatch import translate
from itertools import pairwise, takewhile
from posixpath import basename, dirname, join, normpath, splitext

from grader.base.grouping import are_texts, distinct, texts_among
from grader.base.names import MAX_GUESSES, closest, near
from grader.base.patterns import on_use
from grader.base.source import Source
from grader.base.text import quoted
from grader.files.limits import ignored_part
from grader.ros.installation.cmake.cmake_targets import CmakeTargets
from grader.ros.installation.cmake.cmake_values import OF_INTERFACES, ROOT, Text, Values
from grader.ros.installation.cmake.language import Command
from grader.ros.installation.file_search import EmptyGlob, PackageListing
from grader.ros.installation.installation import (
    CmakeComponent,
    FoundPackage,
    GeneratedInterfaces,
    Installation,
    InstalledFile,
    InstallError,
    LaterStop,
    UnclosedExpression,
)
from grader.ros.installation.places import PREFIX
from grader.ros.known.cmake_words import cmake_words
from grader.ros.known.released import is_released
from grader.ros.known.releases import Release
from grader.ros.python.parse import START, Position
from grader.ros.python.values import Undetermined, Unknown

_MANIFEST = "package.xml"
_GENERATE = "rosidl_generate_interfaces"
_INCLUDED = "target_include_directories"
_GENERATOR = on_use(r"\$<|>")
_Options = Mapping[str, list[str]]
_Groups = Sequence[tuple[str, list[str]]]  # arguments by the keyword before them


class Build:
    """What a build makes and installs, as far as the file was evaluated."""

    def __init__(self, listing: PackageListing, values: Values, name: str, text: str) -> None:
        """`name` is the one in package.xml, `text` that of CMakeLists.txt."""
        self.listing = listing
        self.values = values
        self.name = name
        self.text = text
        self.targets: dict[str, str] = {}  # executable, library, interfaces or unknown
        self.made = CmakeTargets(listing)
        self.copies: dict[str, InstalledFile] = {}  # by the path below the prefix
        self.programs: set[str] = set()  # paths below the prefix
        self.scripts: set[str] = set()  # likewise, of files
        self.modules: list[str] = []  # Python packages
        self.interfaces: list[GeneratedInterfaces] = []
        self.stops: list[InstallError] = []
        self.later_stops: list[LaterStop] = []
        self.found_packages: list[FoundPackage] = []
        self._unclosed: list[UnclosedExpression] = []
        self._exported: set[str] = set()  # targets
        self.unknown: list[Unknown] = []
        self.doubts: list[Unknown] = []
        self.last = START
        self.is_plain = False  # whether colcon builds it as CMake without ament
        self._package_at: Position | None = None  # where ament_package() is called
        self._automatic: list[str] = []  # targets that ament_auto_package() installs
        self._guesses = 0
        # The folders below the prefix of installed programs, each with the target.
        self._installed: list[tuple[str, str]] = []
        self.may_make_files = False  # by programs that run while CMake reads the file
        self._may_find_more = False  # in a search after that
        self.may_have_other_targets = False  # of projects that CMake adds

    def result(self, source: Source) -> Installation:
        """Return what is known at the end."""
        if not self._package_at and not self.doubts and not self.is_plain:
            self.stop(
                "CMakeLists.txt does not call ament_package(), so ROS 2 does not find the package",
                self.last,
            )
        self._name_programs()
        unclosed = []
        for expression in self._unclosed:
            if expression.target in self._exported and expression.command == _INCLUDED:
                reason = f"{expression.message}, so CMake cannot export {expression.target!r}"
                self.stops.append(InstallError("", reason, expression.at))
            else:
                unclosed.append(expression)
        project = self.values.variables.get("PROJECT_NAME")
        first_stops = {stop.reason: stop for stop in reversed(self.later_stops)}
        return Installation(
            source,
            name=project if isinstance(project, str) else None,
            copies=tuple(self.copies.values()),
            programs=tuple(sorted(self.programs)),
            scripts=tuple(sorted(self.scripts)),
            stops=tuple(self.stops),
            later_stops=tuple(first_stops.values()),
            empty=tuple(self.listing.empty),
            unknown=distinct(self.doubts + self.unknown),
            doubt=self.doubts[0] if self.doubts else None,
            called_at=self._package_at or self.last,
            files_at=self._package_at or self.last,
            packages=tuple(self.modules),
            interfaces=tuple(self.interfaces),
            found_packages=tuple(self.found_packages),
            unclosed=tuple(unclosed),
            targets=self.made.all(
                {
                    written_path: self._source(written_path)
                    for written_path in self.made.written_sources
                }
            ),
        )

    def _name_programs(self) -> None:
        """Add the installed programs of targets under the names of their files."""
        for folder, target in self._installed:
            name = self.made.file_name(target)
            if isinstance(name, Unknown):
                self._leave_open(name)
            else:
                self.programs.add(f"{folder}/{name}")

    def give_up(self, reason: str, at: Position) -> None:
        """Note that something is not evaluated.

        It may set variables, install files or stop the build.
        """
        self.doubts.append(self.values.uncertain or Unknown(reason, at))
        self.values.is_opaque = True

    def stop(
        self,
        reason: str,
        at: Position,
        path: str = "",
        hint: str = "",
        change: tuple[str, str] = ("", ""),
    ) -> None:
        """Note an error that stops the build; a change is what is written and what is meant."""
        if change[0] and change[1]:
            hint = f"; did you mean {quoted(change[1])}?"
        if self.values.uncertain:
            self.doubts.append(self.values.uncertain)
        else:
            self.stops.append(InstallError(path, reason, at, hint, "install()", change))

    def stop_later(self, reason: str, since: Release, at: Position, instead: str) -> None:
        """Note an error that stops the build from a release on."""
        if not self.values.uncertain:
            self.later_stops.append(LaterStop(reason, since, at, instead))

    def _guess(self, name: str, known: Collection[str]) -> tuple[str, str]:
        """Return a name, and which one may be meant by it; empty if none is close.

        This is done for the first missing names only, because comparing names takes long.
        """
        self._guesses += 1
        meant = closest(name, known) if self._guesses <= MAX_GUESSES else None
        return name, meant or ""

    # --- Files
    # ----------------------------------------------------------------------

    def inside(self, text: str) -> str | None:
        """Return a path as one in the package, without dots; None for one outside of it."""
        path = normpath("" if text == ROOT else text.removeprefix(f"{ROOT}/"))
        if path == ".":
            return ""
        return None if path.startswith(("/", "..")) else path

    def _source(self, text: str) -> str | None:
        """Return the path of a source, whose ending may lack (policy CMP0115 of CMake)."""
        path = self.inside(text)
        if path is None or splitext(path)[1] or path in self.listing.files:
            return path
        for ending in cmake_words().source_endings:
            if path + ending in self.listing.files:
                return path + ending
        return path

    def _has(self, path: str) -> bool | None:
        """Return whether the package has a file or folder at a path.

        The result is None where that is not known.
        """
        try:
            is_there = not path or self.listing.real(path) is not None
        except Undetermined:
            return None
        if not is_there and ignored_part(path):
            return None
        return is_there

    def exists(self, text: str) -> bool | None:
        """Return whether a file or folder of the package exists.

        The result is None where that is not known, as below an empty folder, which may be a
        submodule.
        """
        path = self.inside(text)
        if path is None:
            return None
        folder = dirname(path)
        is_there = self._has(path)
        if not is_there and folder and self._has(folder) and not self.listing.names(folder):
            return None
        return is_there

    def searched(self, texts: Sequence[Text], at: Position, *, recursive: bool) -> Text:
        """Return the list that file(GLOB) makes."""
        start = f"{ROOT}/"
        words = [text for text in texts if text not in ("CONFIGURE_DEPENDS", "FOLLOW_SYMLINKS")]
        if words[:1] == ["RELATIVE"]:
            if words[1:2] != [ROOT]:
                return Unknown("a search relative to another folder is not evaluated", at)
            words = words[2:]
            start = ""
        found_paths = set()
        for word in words:
            pattern = self.inside(word) if isinstance(word, str) else None
            if pattern is None or words[0] == "LIST_DIRECTORIES":
                return Unknown("a search is not evaluated", at)
            paths = self._matching(pattern, recursive=recursive)
            self._may_find_more = self._may_find_more or self.may_make_files
            if not paths and not self.may_make_files:
                self.listing.empty[EmptyGlob(pattern, at)] = None
            found_paths.update(paths)
        text = ";".join(f"{start}{path}" for path in sorted(found_paths))
        self.listing.budget.charge(1, len(text))
        return text

    def _matching(self, pattern: str, *, recursive: bool) -> list[str]:
        """Return the files that a pattern of CMake matches.

        Without `recursive`, folders are matched, too.
        """
        if not recursive:
            with suppress(Undetermined):
                return self.listing.glob(pattern)
            return []
        folder, _, name = pattern.rpartition("/")
        matches = re.compile(translate(name)).match
        below = self.listing.files_below(folder)
        return [path for path in below if matches(basename(path))]

    # --- Targets
    # ----------------------------------------------------------------------

    def add_target(self, command: Command) -> None:
        """Add an executable or a library, whose sources must exist."""
        name, texts = self.values.first_and_rest(command)
        if isinstance(name, Unknown):
            self.give_up("the name of a target is not known", command.at)
            return
        kind = "executable" if command.name.endswith("executable") else "library"
        self.targets[name] = kind if not self.values.uncertain else "unknown"
        is_certain = not self.values.uncertain
        self.made.add(name, kind, command.at, is_certain=is_certain, texts=texts)
        if command.name.startswith("ament_auto"):
            self._automatic.append(name)
            self.made.install(name)
        words = texts_among(texts)
        if {"IMPORTED", "ALIAS", "DIRECTORY"}.isdisjoint(words):
            self.require_sources(words, command)

    def name_target(self, command: Command) -> None:
        """Add a target that tests have, or that is made by a command of its own."""
        name = self.values.first(command)
        if command.name.startswith("ament_add_g") and not self.values.is_opaque:
            texts = self.values.texts(command.arguments[1:])
            words = list(takewhile(lambda text: text not in cmake_words().test_keywords, texts))
            self.require_sources(texts_among(words), command)
        if isinstance(name, str):
            self.targets[name] = "executable" if not self.values.uncertain else "unknown"
        else:
            self.may_have_other_targets = True

    def set_properties(self, command: Command) -> None:
        """Note the properties that name the files of targets."""
        texts = self.values.texts(command.arguments)
        if command.name == "set_property":
            if texts[:1] != ["TARGET"]:
                return
            texts = texts[1:]
        word = "PROPERTY" if command.name == "set_property" else "PROPERTIES"
        if word not in texts:
            return
        end = texts.index(word)
        for key, value in pairwise(texts[end + 1 :]):
            for target in texts[:end]:
                given = self.values.uncertain or value
                self.made.set_property(str(target), str(key), given)

    def require_sources(self, sources: Sequence[str], command: Command) -> None:
        """Stop the build at a source that is not there."""
        for source in sources:
            path = self.inside(source) or ""
            is_file = source not in cmake_words().target_keywords and splitext(path)[1]
            if is_file and self._has(path) is False:
                self._stop_missing(command, path)

    def require_closed(self, command: Command) -> None:
        """Note a generator expression in a command of a target that is not closed."""
        if self.values.uncertain or not command.name.startswith("target_"):
            return
        opened = []
        for argument in command.arguments:
            for piece in _GENERATOR.findall(argument.text):
                if piece == "$<":
                    opened.append(argument)
                elif opened:
                    opened.pop()
        if opened:
            target = str(self.values.first(command))
            unclosed = UnclosedExpression(command.name, target, opened[0].text, opened[0].at)
            self._unclosed.append(unclosed)

    def _stop_missing(self, command: Command, path: str) -> None:
        reason = f"{command.name}() lists {path!r}, but there is no such file"
        self.stop(reason, command.at, change=self._guess(path, self.listing.files))

    def use_target(self, command: Command) -> None:
        """Note a target that is not defined, and a package that was not found."""
        name, rest = self.values.first_and_rest(command)
        if isinstance(name, Unknown):
            return
        names_packages = command.name == "ament_target_dependencies"
        if names_packages:
            self.made.depend(name, rest)
        else:
            self.made.link(name, self._own_links(command))
        if self.values.is_opaque:
            return
        if name not in self.targets:
            self._stop_target(command, name)
        self._use_packages(command, rest if names_packages else _owners_of_targets(rest))

    def _own_links(self, command: Command) -> list[Text]:
        """Return what a target links, without libraries of others whose names are not known."""
        links = []
        for argument in command.arguments[1:]:
            texts = self.values.expanded(argument)
            is_unknown = any(isinstance(text, Unknown) for text in texts)
            if not is_unknown or self.values.may_name_own_target(argument):
                links += texts
        return links

    def _use_packages(self, command: Command, texts: Sequence[Text]) -> None:
        """Note a package that a target depends on, and that was not found."""
        packages = self.values.packages
        reached = self.values.reached_packages()
        for text in texts:
            if not isinstance(text, str) or not text.islower() or text in (reached or packages):
                continue
            if self.values.finds_interfaces and text.endswith(OF_INTERFACES):
                continue
            self.listing.budget.charge(len(packages))
            # What is found may export the package, unless it is surely misspelt.
            if reached is not None or near(text, packages) is not None:
                self.stop(
                    f"{command.name}() names the package {text!r}, without find_package({text})",
                    command.at,
                )

    def _stop_target(self, command: Command, name: str) -> None:
        if self.may_have_other_targets and near(name, self.targets) is None:
            self._leave_open(Unknown(f"another project may have the target {name}", command.at))
            return
        reason = f"{command.name}() names the target {name!r}, which is not defined"
        self.stop(reason, command.at, change=self._guess(name, self.targets))

    def register_component(self, command: Command) -> None:
        """Install the program that rclcpp_components_register_node() makes.

        Its EXECUTABLE names the program.
        """
        texts = self.values.texts(command.arguments)
        after = dict(pairwise(texts))
        name = after.get("EXECUTABLE", "")
        library = texts[:1]
        plugin = after.get("PLUGIN")
        if isinstance(plugin, str) and library and isinstance(library[0], str):
            component = CmakeComponent(plugin, command.at, name if isinstance(name, str) else "")
            self.made.register(library[0], component)
        if isinstance(name, Unknown):
            self.give_up("the name of a program is not known", command.at)
        elif name and not self.values.uncertain:
            self.programs.add(f"lib/{self._project()}/{name}")
        elif name:
            self._leave_open(Unknown(f"the program {name} is not known", command.at))

    def register_components(self, command: Command) -> None:
        """Note the classes that rclcpp_components_register_nodes() registers."""
        library, plugins = self.values.first_and_rest(command)
        for plugin in plugins:
            if isinstance(library, str) and isinstance(plugin, str):
                self.made.register(library, CmakeComponent(plugin, command.at))

    def add_sources(self, command: Command) -> None:
        """Add sources to a target."""
        name, texts = self.values.first_and_rest(command)
        if isinstance(name, str):
            doubt = self.values.uncertain
            self.made.add_sources(name, [*texts, *([doubt] if doubt else [])])

    def generate_interfaces(self, command: Command) -> None:
        """Install the message, service and action files of a package."""
        texts = self.values.texts(command.arguments)
        keywords = cmake_words().interface_keywords
        words = list(takewhile(lambda text: text not in keywords, texts))
        known = texts_among(words)
        if not words or len(known) < len(words):
            self.interfaces.append(GeneratedInterfaces(command.at, is_certain=False))
            self.give_up("the arguments of rosidl_generate_interfaces() are not known", command.at)
            return
        name, *files = known
        self.targets[name] = "interfaces"
        made = self._copy_interfaces(files, command)
        rest = texts[len(words) :]
        groups: dict[str, list[str]] = {}
        for keyword, items in _groups([str(text) for text in rest], keywords):
            groups.setdefault(keyword, []).extend(items)
        is_known = len(made) == len(files) and are_texts(rest)
        interfaces = GeneratedInterfaces(
            command.at,
            tuple(made),
            tuple(groups.get("DEPENDENCIES", ())),
            is_certain=is_known and not self.values.uncertain and not self._may_find_more,
            needs_group=groups.keys().isdisjoint(("SKIP_INSTALL", "SKIP_GROUP_MEMBERSHIP_CHECK")),
        )
        self.interfaces.append(interfaces)

    def note_calls(self, commands: Iterable[Command]) -> None:
        """Note the calls of rosidl_generate_interfaces() in branches that are not taken here.

        Variables that the command line of the build sets may decide it.
        """
        evaluated = {interfaces.at for interfaces in self.interfaces}
        for command in commands:
            if command.name == _GENERATE and command.at not in evaluated:
                self.interfaces.append(GeneratedInterfaces(command.at, is_certain=False))

    def _copy_interfaces(self, texts: Sequence[str], command: Command) -> list[str]:
        """Install the files of interfaces, and return those that are known."""
        paths = []
        for text in texts:
            path = self._interface_file(text, command)
            if path is not None:
                paths.append(path)
                self._copy(path, f"{self._share()}/{'/'.join(path.split('/')[-2:])}", command.at)
        return paths

    def _interface_file(self, text: str, command: Command) -> str | None:
        """Return the file of an interface; of a missing one, the one that is surely meant.

        The result is None where no file is known.
        """
        path = self.inside(text.replace(f"{ROOT}:", f"{ROOT}/"))
        if path is None:
            self.give_up(f"{text} is not in the package", command.at)
            return None
        if self._has(path) is not False:
            return path
        if self.may_make_files:
            return None
        self._stop_missing(command, path)
        self.listing.budget.charge(len(self.listing.files))
        meant = closest(path, self.listing.files)
        if meant is None or not meant.endswith(splitext(path)[1]):
            return None
        return meant  # as which the rest is read

    # --- Installed files
    # ----------------------------------------------------------------------

    def package(self, command: Command) -> None:
        """End the package, as ament_package() does.

        The name of the project must be that in package.xml.
        """
        if self.values.uncertain:
            self.give_up("it is not known whether ament_package() is called", command.at)
            return
        self._package_at = command.at
        project = self.values.variables.get("PROJECT_NAME", "")
        if isinstance(project, str) and self.name and project != self.name:
            self.stop(
                f"project() names the package {project!r}, package.xml names it {self.name!r}",
                command.at,
            )
        if _MANIFEST in self.listing.files:
            self._copy(_MANIFEST, f"{self._share()}/{_MANIFEST}", command.at)

    def auto_package(self, command: Command) -> None:
        """Install the targets of ament_cmake_auto and whole folders, and end the package."""
        texts = self.values.known(command)
        if texts is None:
            self.give_up("the arguments of ament_auto_package() are not known", command.at)
            return
        for name in self._automatic:
            if self.targets[name] == "executable":
                self._installed.append((f"lib/{self._project()}", name))
        groups = _groups(texts, cmake_words().auto_keywords)
        for keyword, folders in groups[1:]:
            target = self._share() if keyword == "INSTALL_TO_SHARE" else "bin"
            for folder in folders:
                self._copy_folder(folder, target, command, groups[:1])
        self.package(command)

    def python_package(self, command: Command) -> None:
        """Install a Python package, whose folder must have an __init__.py."""
        texts = self.values.known(command)
        if not texts:
            self.give_up(
                "the arguments of ament_python_install_package() are not known", command.at
            )
            return
        options = dict(_groups(texts, cmake_words().python_keywords))
        folder = self.inside((options.get("PACKAGE_DIR") or texts)[0])
        self.modules.append(texts[0])
        if "SCRIPTS_DESTINATION" in options or "setup.cfg" in self.listing.files:
            self.unknown.append(
                Unknown("the programs of a setup.cfg are not evaluated", command.at)
            )
        if folder is not None and self._has(f"{folder}/__init__.py") is False:
            what = "has no __init__.py" if self._has(folder) else "does not exist"
            self.stop(
                f"ament_python_install_package() needs the folder {folder!r}, which {what}",
                command.at,
            )

    def plugin_description(self, command: Command) -> None:
        """Install the description of plugins in the package's share folder."""
        texts = self.values.known(command) or []
        self._copy_files(texts[1:2], self._share(), command, {})

    def install(self, command: Command) -> None:
        """Install files, folders, programs or targets."""
        texts = self.values.texts(command.arguments)
        if not texts:
            self.stop("install() has no arguments", command.at)
            return
        kind = texts[0]
        if kind in ("EXPORT", "RUNTIME_DEPENDENCY_SET"):
            return
        unknown = next((text for text in texts if isinstance(text, Unknown)), None)
        groups = _groups([str(text) for text in texts[1:]], cmake_words().install_keywords)
        if unknown:
            self._leave_open(unknown)
        elif kind not in ("DIRECTORY", "FILES", "PROGRAMS", "TARGETS"):
            self._leave_open(Unknown(f"install({kind} ...) is not evaluated", command.at))
        elif kind == "TARGETS":
            self._install_targets(groups, command)
        elif groups[0][1]:  # without paths, CMake does not look at the rest
            self._install_paths(str(kind), groups, command)

    def _install_paths(self, kind: str, groups: _Groups, command: Command) -> None:
        """Install files, programs, or what is in folders."""
        options = dict(groups[1:])
        texts = groups[0][1]
        target = self._destination(options, command)
        before = set(self.copies)
        if target is not None and kind == "DIRECTORY":
            for text in texts:
                self._copy_folder(text, target, command, groups)
        elif target is not None:
            self._copy_files(texts, target, command, options)
        if kind == "PROGRAMS" or any("PERMISSIONS" in key for key in options):
            self.scripts.update(self.copies.keys() - before)

    def _leave_open(self, reason: Unknown) -> None:
        """Note that more may be installed."""
        self.unknown.append(self.values.uncertain or reason)

    def _destination(self, options: _Options, command: Command) -> str | None:
        """Return the path below the prefix where files go.

        The result is None where it is not known, or there is none.
        """
        values = options.get("DESTINATION", [])
        if len(values) != 1:
            if "TYPE" in options:
                self._leave_open(Unknown("install(... TYPE ...) is not evaluated", command.at))
            else:
                self.stop("install() has no DESTINATION", command.at)
            return None
        target = normpath(values[0].removeprefix(f"{PREFIX}/"))
        if target.startswith(("/", "..")):
            self._leave_open(Unknown(f"{target} is outside of the prefix", command.at))
            return None
        return target

    def _install_targets(self, groups: _Groups, command: Command) -> None:
        """Install executables; where libraries go is not needed."""
        target = _folder_of_programs(groups)
        for name in groups[0][1]:
            known = self.targets.get(name)
            if any(keyword == "EXPORT" for keyword, _ in groups):
                self._exported.add(name)
            self.made.install(name)
            if known is None and not self.values.is_opaque:
                self._stop_target(command, name)
            elif known in (None, "unknown") or self.values.uncertain:
                self._leave_open(Unknown(f"the target {name} is not known", command.at))
            elif known == "executable":
                self._installed.append((target, name))

    def _copy_files(
        self, texts: Sequence[str], target: str, command: Command, options: _Options
    ) -> None:
        if options.get("RENAME") and len(texts) > 1:
            self.stop("install() gives several files one name with RENAME", command.at)
            return
        for text in texts:
            self._copy_file(text, target, command, options)

    def _copy_file(self, text: str, target: str, command: Command, options: _Options) -> None:
        path = self.inside(text)
        state = self._has(path) if path is not None else None
        if path is None or (state is None and path not in self.listing.files):
            self._leave_open(Unknown(f"{text} is not a file of the package", command.at))
        elif path in self.listing.files:
            name = [*options.get("RENAME", ()), basename(path)][0]
            self._copy(path, normpath(join(target, name)), command.at)
        elif state:
            self.stop("it is a folder: write install(DIRECTORY ...)", command.at, path or text)
        elif "OPTIONAL" not in options:
            change = self._guess(path, self.listing.files)
            self.stop("there is no such file", command.at, path or text, change=change)

    def _copy_folder(self, text: str, target: str, command: Command, groups: _Groups) -> None:
        """Install the files of a folder; with a slash at its end without its own name."""
        options = dict(groups)
        patterns = _Patterns(groups)
        path = self.inside(text)
        state = self._has(path) if path is not None else None
        if path is None or state is None or patterns.has_regex or text == ".":
            self._leave_open(
                Unknown(f"which files of {text} are installed is not known", command.at)
            )
        elif path in self.listing.files:
            self.stop("it is a file: write install(FILES ...)", command.at, path)
        elif not state and patterns.is_limited:
            pass  # CMake takes it for a file that no pattern matches
        elif not state and "OPTIONAL" not in options:
            change = self._guess(path, self.listing.folders)
            self.stop("there is no such folder", command.at, path, change=change)
        else:
            above = target if text.endswith("/") else join(target, basename(path))
            self._copy_below(path, above, patterns, command)

    def _copy_below(self, path: str, above: str, patterns: "_Patterns", command: Command) -> None:
        """Install the files below a folder that patterns include."""
        for file in self.listing.files_below(path):
            self.listing.budget.charge(patterns.count * (1 + file.count("/")), len(file))
            name = file.removeprefix(f"{path}/")
            if patterns.include(path, name):
                self._copy(file, normpath(join(above, name)), command.at)

    def _copy(self, path: str, target: str, at: Position) -> None:
        if self.values.uncertain:
            self.unknown.append(self.values.uncertain)
        else:
            self.copies[target] = InstalledFile(path, target, at)

    def _project(self) -> str:
        name = self.values.variables.get("PROJECT_NAME", "")
        return name if isinstance(name, str) else self.name

    def _share(self) -> str:
        return f"share/{self._project()}"


class _Patterns:
    """The options PATTERN of install(DIRECTORY ...).

    What they match is excluded, or with FILES_MATCHING included.
    """

    def __init__(self, groups: _Groups) -> None:
        keywords = [keyword for keyword, _ in groups]
        self.has_regex = "REGEX" in keywords
        self.is_limited = "FILES_MATCHING" in keywords
        self._excluded: list[re.Pattern[str]] = []
        self._included: list[re.Pattern[str]] = []
        self.count = sum(keyword == "PATTERN" for keyword in keywords)
        for (keyword, values), after in zip(groups, [*keywords[1:], ""], strict=True):
            if keyword == "PATTERN" and values:
                glob = translate(values[0]).replace(".*", "[^/]*")
                (self._excluded if after == "EXCLUDE" else self._included).append(
                    re.compile(f"(?:.*/)?{glob}")
                )

    def include(self, folder: str, path: str) -> bool:
        """Return whether a file at a path below an installed folder is installed.

        The folder itself may be excluded.
        """
        parts = f"{folder}/{path}".split("/")
        above = len(parts) - path.count("/") - 1
        reached = ["/".join(parts[:count]) for count in range(above, len(parts) + 1)]
        if any(pattern.match(end) for pattern in self._excluded for end in reached):
            return False
        return not self.is_limited or any(pattern.match(reached[-1]) for pattern in self._included)


def _owners_of_targets(texts: Sequence[Text]) -> list[Text]:
    """Return the packages of ROS 2 whose targets are linked, as rclcpp::rclcpp is."""
    owners = [text.partition("::")[0] for text in texts if isinstance(text, str) and "::" in text]
    return [owner for owner in owners if is_released(owner)]


def _groups(texts: Sequence[str], keywords: frozenset[str]) -> list[tuple[str, list[str]]]:
    """Return arguments by the keyword before them; the first ones have none."""
    groups: list[tuple[str, list[str]]] = [("", [])]
    for text in texts:
        if text in keywords:
            groups.append((text, []))
        else:
            groups[-1][1].append(text)
    return groups


BUILD_COMMANDS: dict[str, Callable[[Build, Command], None]] = {
    **dict.fromkeys(
        ("add_executable", "add_library", "ament_auto_add_executable", "ament_auto_add_library"),
        Build.add_target,
    ),
    **dict.fromkeys(("target_link_libraries", "ament_target_dependencies"), Build.use_target),
    **dict.fromkeys(("set_target_properties", "set_property"), Build.set_properties),
    "generate_parameter_library": Build.add_target,  # its YAML file is a source
    "rclcpp_components_register_node": Build.register_component,
    "rclcpp_components_register_nodes": Build.register_components,
    "target_sources": Build.add_sources,
    _GENERATE: Build.generate_interfaces,
    "ament_package": Build.package,
    "ament_auto_package": Build.auto_package,
    "ament_python_install_package": Build.python_package,
    "pluginlib_export_plugin_description_file": Build.plugin_description,
    "install": Build.install,
}


def _folder_of_programs(groups: _Groups) -> str:
    """Return the folder below the prefix to which install(TARGETS ...) copies executables.

    Of several destinations of one kind, the last counts (CMake 3.25, run).
    """
    kind = ""
    places = {}
    for keyword, values in groups[1:]:
        if keyword in cmake_words().artifacts:
            kind = keyword
        elif keyword == "DESTINATION" and values:
            places[kind] = normpath(values[0].removeprefix(f"{PREFIX}/"))
    return places.get("RUNTIME") or places.get("") or "bin"
