"""The tests in a CMakeLists.txt: their sources, and the package that has their command.

colcon builds them: BUILD_TESTING is on, unless it is told otherwise. What else is below
if(BUILD_TESTING) is not evaluated, because it installs nothing.
"""

from collections.abc import Iterator, Sequence

from grader.base.patterns import on_use
from grader.ros.installation.cmake.cmake_build import Build
from grader.ros.installation.cmake.cmake_values import OF_INTERFACES
from grader.ros.installation.cmake.language import Argument, Command
from grader.ros.installation.installation import FoundPackage
from grader.ros.known.cmake_words import cmake_words

_SWITCH = "BUILD_TESTING"
_GTEST = on_use(r"ament_add_(?:ros_isolated_)?(g(?:test|mock))(?:_executable)?")
_VARIABLE = on_use(r"\$\{(\w+)\}|\$")
# With one of these, the command of a test may come from a package that is not known.
_OTHER_WAYS = ("ament_auto", "ament_lint_auto_find_test_dependencies", "ament_cmake_ros")


def check_tests(build: Build, commands: Sequence[Command]) -> None:
    """Note what stops the build of tests: a source that is not there, a command without package.

    The packages that tests require are noted as well.
    """
    if build.values.variables.get(_SWITCH) != "":
        return
    for command in commands:
        if command.name == "if" and [one.text for one in command.arguments] == [_SWITCH]:
            build.found_packages += _required_packages(command.body)
            if not build.doubts:
                _check_providers(build, command.body)
                _check_sources(build, command.body)
    if not build.doubts:
        _check_providers(build, commands)


def _required_packages(commands: Sequence[Command]) -> Iterator[FoundPackage]:
    """Yield the packages without which tests are not built."""
    for command in commands:
        words = [argument.text for argument in command.arguments]
        if command.name == "find_package" and "REQUIRED" in words[1:]:
            yield FoundPackage(words[0], command.at, True, True, is_for_tests=True)


def _check_sources(build: Build, commands: Sequence[Command]) -> None:
    """Note the tests with a source that is not there."""
    for command in commands:
        if _GTEST.fullmatch(command.name):
            build.require_sources(list(_sources(build, command)), command)


def _check_providers(build: Build, commands: Sequence[Command]) -> None:
    """Note the tests of a block whose command no package has that is found."""
    packages = set(build.values.packages)
    for command in commands:
        if command.name == "find_package" and command.arguments:
            packages.add(command.arguments[0].text.lower())
        kind = _GTEST.fullmatch(command.name)
        if kind:
            _require_provider(build, command, f"ament_cmake_{kind[1]}", packages)


def _require_provider(build: Build, command: Command, needed: str, packages: set[str]) -> None:
    """Stop the build at a test whose command no package has that is found before it."""
    text = build.text
    if any(word in text for word in _OTHER_WAYS) or build.values.is_opaque:
        return
    project = str(build.values.variables.get("PROJECT_NAME", "")).lower()
    others = packages - cmake_words().exports.keys() - cmake_words().without_tests - {project}
    if any(not name.endswith(OF_INTERFACES) for name in others):
        return
    build.stop(
        f"CMake knows no command {command.name}(), because nothing finds the package {needed}",
        command.at,
        hint=f"; write find_package({needed} REQUIRED)",
        change=("", f"find_package({needed} REQUIRED)\n"),
    )


def _sources(build: Build, command: Command) -> Iterator[str]:
    """Yield the sources of a test whose paths are known."""
    for argument in command.arguments[1:]:
        if argument.text in cmake_words().test_keywords:
            return
        if _is_known(build, argument):
            for text in build.values.expanded(argument):
                if isinstance(text, str):
                    yield text


def _is_known(build: Build, argument: Argument) -> bool:
    """Return whether all variables in an argument are set before the tests."""
    names = [match[1] for match in _VARIABLE.finditer(argument.text)]
    return all(name is not None and name in build.values.variables for name in names)
