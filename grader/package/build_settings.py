"""What else a build needs: the other arguments of setup(), setup.cfg and pyproject.toml."""

import re
import tomllib
from collections.abc import Callable, Iterator, Mapping
from configparser import ConfigParser, Error

from grader.errors import InputError
from grader.package.globbing import PackageListing
from grader.static_python.knowledge import unknown_in
from grader.static_python.values import Unknown, Value
from grader.text import enumerated

# The arguments that name the Python packages; without one, setuptools searches for packages, but not in the folders
# below, those of `FlatLayoutPackageFinder.DEFAULT_EXCLUDE`.
_PACKAGES = ("packages", "py_modules", "ext_modules", "package_dir")
_NO_PACKAGES = frozenset(
    {"ci", "bin", "debian", "doc", "docs", "documentation", "manpages", "news", "newsfragments", "changelog", "test",
     "tests", "unit_test", "unit_tests", "example", "examples", "scripts", "tools", "util", "utils", "python", "build",
     "benchmark", "benchmarks", "exercise", "exercises", "htmlcov", "tasks", "dist", "venv", "env", "requirements",
     "fabfile", "site_scons"}
)  # fmt: skip
# PEP 440, as packaging.version has it; the name and value of an entry point, as importlib.metadata has them.
_VERSION = re.compile(
    r"\s*v?(?:\d+!)?\d+(?:\.\d+)*(?:[-_.]?(?:alpha|a|beta|b|preview|pre|c|rc)[-_.]?\d*)?"
    r"(?:-\d+|[-_.]?(?:post|rev|r)[-_.]?\d*)?(?:[-_.]?dev[-_.]?\d*)?(?:\+[a-z0-9]+(?:[-_.][a-z0-9]+)*)?\s*",
    re.IGNORECASE,
)
_ENTRY_POINT = re.compile(r"\s*[^=\s][^=]*=\s*[\w.]+\s*(?::\s*[\w.]+\s*)?(?:\[.*\]\s*)?")
_REQUIREMENT = re.compile(
    r"\s*[A-Za-z0-9](?:[\w.-]*[A-Za-z0-9])?(?:\[[\w, -]*\])?(?:\s*(?:[<>~!=]=?|===)\s*[\w.*+!-]+\s*,?)*\s*"
)
_TEXTS = ("name", "description", "long_description", "author", "author_email", "maintainer", "maintainer_email", "url",
          "license", "download_url", "long_description_content_type", "python_requires", "test_suite")  # fmt: skip
_LISTS = ("keywords", "classifiers", "platforms")
_FLAGS = ("zip_safe", "include_package_data")
# The arguments that are checked below.
_CHECKED = ("version", "packages", "py_modules", "data_files", "entry_points", "extras_require", "setup_requires")
_REQUIREMENTS = ("install_requires", "tests_require")
_AT_HAND = ("setuptools", "wheel")  # what setup_requires may name without a download
# The sections of setup.cfg that concern a build: of these, the options that are known to be accepted.
_SECTIONS = {"develop": {"script_dir", "install_scripts"}, "install": {"install_scripts", "install-scripts"}}
_OF_TOOLS = re.compile(
    r"flake8|pycodestyle|pydocstyle|pep8|pep257|mypy\b.*|isort|pylint|yapf|black|tool:.*|coverage:.*|bdist_wheel|sdist|test"
)
_MAX_SETTINGS = 64 * 1024  # bytes

# A fault, or what is not evaluated.
Finding = str | Unknown


def argument_findings(
    kwargs: Mapping[str, Value], listing: PackageListing, unknown: Callable[[str], Unknown], is_configured: bool
) -> Iterator[Finding]:
    """Yield what is wrong with the arguments of setup() besides data_files, and what of them is not evaluated."""
    for name, value in kwargs.items():
        if name not in (*_CHECKED, *_REQUIREMENTS) and not _is_usual(name, value):
            yield unknown_in(value) or unknown(f"this value of {name} in setup() is not evaluated")
    for check in (_version, _entry_points, _requirements):
        yield from check(kwargs, unknown)
    yield from _packages(kwargs, listing, unknown)
    modules = kwargs.get("py_modules") or []
    if not _is_list(modules) or any(f"{name.replace('.', '/')}.py" not in listing.files for name in modules):
        yield unknown("this value of py_modules is not evaluated")
    if not is_configured and all(kwargs.get(name) is None for name in _PACKAGES) and "src" not in listing.folders:
        yield from _discovery(listing)


def _is_usual(name: str, value: Value) -> bool:
    """Return whether setuptools certainly accepts an argument."""
    if value is None:
        return True
    if name in _TEXTS:
        return isinstance(value, str | Unknown)
    if name == "package_data":
        return isinstance(value, dict) and all(isinstance(key, str) and _is_list(it) for key, it in value.items())
    if name in _LISTS:
        return isinstance(value, str) or _is_list(value)
    return name in _FLAGS and isinstance(value, bool)


def _is_list(value: Value) -> bool:
    return isinstance(value, list | tuple) and all(isinstance(item, str) for item in value)


def _version(kwargs: Mapping[str, Value], unknown: Callable[[str], Unknown]) -> Iterator[Finding]:
    version = kwargs.get("version")
    if isinstance(version, str):
        if version and not _VERSION.fullmatch(version):
            yield f"the version {version!r} is not valid: write numbers with dots, such as 0.1.0"
    elif not isinstance(version, int | float | None):
        yield unknown_in(version) or unknown("this version is not evaluated")


def _entry_points(kwargs: Mapping[str, Value], unknown: Callable[[str], Unknown]) -> Iterator[Finding]:
    groups = kwargs.get("entry_points")
    if groups is None:
        return
    is_plain = isinstance(groups, dict) and all(isinstance(group, list | tuple) for group in groups.values())
    if not is_plain or unknown_in(groups) is not None:
        yield unknown_in(groups) or unknown("these entry points are not evaluated")
        return
    for line in (line for group in groups.values() for line in group):
        if not isinstance(line, str):
            yield unknown("an entry point that is no string is not evaluated")
        elif "=" not in line or not _ENTRY_POINT.fullmatch(line):
            yield f"the entry point {line!r} is not valid: write name = package.module:function"


def _requirements(kwargs: Mapping[str, Value], unknown: Callable[[str], Unknown]) -> Iterator[Finding]:
    for name in (*_REQUIREMENTS, "setup_requires"):
        given = kwargs.get(name)
        listed = [given] if isinstance(given, str) else given if isinstance(given, list | tuple) else []
        fits = all(isinstance(it, str) and _REQUIREMENT.fullmatch(it) for it in listed)
        if given and (not listed or not fits):
            yield unknown_in(given) or unknown(f"this value of {name} is not evaluated")
        elif name == "setup_requires" and not {*listed} <= {*_AT_HAND}:
            yield unknown("whether the packages in setup_requires can be installed is not evaluated")
    if kwargs.get("extras_require"):
        groups = kwargs["extras_require"]
        lists = [*groups.values()] if isinstance(groups, dict) else [[None]]
        if not all(isinstance(it, str) and _REQUIREMENT.fullmatch(it) for group in lists for it in group or [None]):
            yield unknown("this value of extras_require is not evaluated")


def _packages(
    kwargs: Mapping[str, Value], listing: PackageListing, unknown: Callable[[str], Unknown]
) -> Iterator[Finding]:
    packages = kwargs.get("packages")
    if isinstance(packages, list | tuple) and all(isinstance(it, str) for it in packages):
        for name in packages:
            if name.replace(".", "/") not in listing.folders:
                yield f"packages lists {name!r}, but there is no such folder"
    elif packages is not None and not isinstance(packages, Unknown):
        yield unknown("this value of packages is not evaluated")


def _discovery(listing: PackageListing) -> Iterator[Finding]:
    """Yield the error of setuptools where it searches for packages and finds several."""
    folders = [name for name in listing.names("") if name in listing.folders and name.isidentifier()]
    found = sorted(name for name in folders if name not in _NO_PACKAGES and not name.startswith("_"))
    if len(found) > 1:
        yield f"packages=[...] is missing, and setuptools cannot choose between the folders {enumerated(found)}"


def file_findings(listing: PackageListing, unknown: Callable[[str], Unknown]) -> Iterator[Finding]:
    """Yield what is wrong with setup.cfg and pyproject.toml, and what of them is not evaluated."""
    for name, read in (("setup.cfg", _cfg), ("pyproject.toml", _toml)):
        if name in listing.files:
            try:
                yield from read(listing.files[name].read(_MAX_SETTINGS).decode(), unknown)
            except (InputError, UnicodeDecodeError):
                yield unknown(f"{name} cannot be read")


def _cfg(text: str, unknown: Callable[[str], Unknown]) -> Iterator[Finding]:
    parser = ConfigParser()
    parser.optionxform = str  # type: ignore[assignment,method-assign]
    try:
        parser.read_string(text)
        options = {section: {*map(str, parser[section])} for section in parser.sections()}
        for section, names in options.items():
            for option in names:
                parser.get(section, option)
    except Error as error:
        yield f"setup.cfg cannot be read: {' '.join(str(error).split())[:200]}"
        return
    for section, names in options.items():
        if section in _SECTIONS:
            yield from _options(section, names - _SECTIONS[section], unknown)
        elif names and not _OF_TOOLS.fullmatch(section):
            yield unknown(f"the section [{section}] of setup.cfg is not evaluated")


def _options(section: str, others: set[str], unknown: Callable[[str], Unknown]) -> Iterator[Finding]:
    if section == "install" and "script_dir" in others:
        yield "setup.cfg sets script_dir in [install], where it is called install_scripts"
    elif others:
        yield unknown(f"the option {min(others)} in [{section}] of setup.cfg is not evaluated")


def _toml(text: str, unknown: Callable[[str], Unknown]) -> Iterator[Finding]:
    try:
        table = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        yield f"pyproject.toml cannot be read: {error}"
        return
    tools = table.get("tool", {})
    if "project" in table or not isinstance(tools, dict) or "setuptools" in tools:
        yield unknown("[project] and [tool.setuptools] of pyproject.toml are not evaluated")
