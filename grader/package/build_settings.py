"""What else a build needs: the other arguments of setup(), setup.cfg and pyproject.toml."""

import re
import tomllib
from collections.abc import Callable, Iterator, Mapping
from configparser import ConfigParser, Error

from grader.errors import InputError
from grader.package.file_search import PackageListing
from grader.python.values import Unknown, Value, unknown_in
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
# The arguments whose faults are found below.
_CHECKED = ("version", "packages", "py_modules", "data_files", "entry_points")
_AT_HAND = frozenset({"setuptools", "wheel"})  # what setup_requires may name without a download
# The sections of setup.cfg that concern a build: of these, the options that are known to be accepted.
_SECTIONS = {"develop": {"script_dir", "install_scripts"}, "install": {"install_scripts", "install-scripts"}}
_OF_TOOLS = re.compile(
    r"flake8|pycodestyle|pydocstyle|pep8|pep257|mypy\b.*|isort|pylint|yapf|black|tool:.*|coverage:.*|bdist_wheel|sdist|test"
)
_MAX_SETTINGS = 64 * 1024  # bytes

# A fault, or what is not evaluated.
_Finding = str | Unknown


def argument_findings(
    kwargs: Mapping[str, Value], listing: PackageListing, unknown: Callable[[str], Unknown], is_configured: bool
) -> Iterator[_Finding]:
    """Yield what is wrong with the arguments of setup() besides data_files, and what of them is not evaluated."""
    for name, value in kwargs.items():
        if name not in _CHECKED and value is not None and not (name in _USUAL and _USUAL[name](value)):
            yield unknown_in(value) or unknown(f"this value of {name} in setup() is not evaluated")
    yield from _version_findings(kwargs, unknown)
    yield from _entry_point_findings(kwargs, unknown)
    yield from _package_findings(kwargs, listing, unknown)
    modules = kwargs.get("py_modules") or []
    if not _is_list(modules) or any(f"{name.replace('.', '/')}.py" not in listing.files for name in modules):
        yield unknown("this value of py_modules is not evaluated")
    if not is_configured and all(kwargs.get(name) is None for name in _PACKAGES) and "src" not in listing.folders:
        yield from _discovery_findings(listing)


def _is_list(value: Value) -> bool:
    return isinstance(value, list | tuple) and all(isinstance(item, str) for item in value)


def _are_requirements(value: Value) -> bool:
    if isinstance(value, str):
        value = [value] if value else []
    return _is_list(value) and all(map(_REQUIREMENT.fullmatch, value))


# Whether setuptools certainly accepts the value of an argument.
_USUAL: Mapping[str, Callable[[Value], bool]] = {
    **dict.fromkeys(_TEXTS, lambda it: isinstance(it, str | Unknown)),
    **dict.fromkeys(("keywords", "classifiers", "platforms"), lambda it: isinstance(it, str) or _is_list(it)),
    **dict.fromkeys(("zip_safe", "include_package_data"), lambda it: isinstance(it, bool)),
    **dict.fromkeys(("install_requires", "tests_require"), _are_requirements),
    "setup_requires": lambda it: _are_requirements(it) and _AT_HAND.issuperset([it] if isinstance(it, str) else it),
    "extras_require": lambda it: isinstance(it, dict) and all(map(_are_requirements, it.values())),
    "package_data": lambda it: isinstance(it, dict) and all(map(_is_list, it.values())) and _is_list([*it]),
}


def _version_findings(kwargs: Mapping[str, Value], unknown: Callable[[str], Unknown]) -> Iterator[_Finding]:
    version = kwargs.get("version")
    if isinstance(version, str):
        if version and not _VERSION.fullmatch(version):
            yield f"the version {version!r} is not valid: write numbers with dots, such as 0.1.0"
    elif not isinstance(version, int | float | None):
        yield unknown_in(version) or unknown("this version is not evaluated")


def _entry_point_findings(kwargs: Mapping[str, Value], unknown: Callable[[str], Unknown]) -> Iterator[_Finding]:
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


def _package_findings(
    kwargs: Mapping[str, Value], listing: PackageListing, unknown: Callable[[str], Unknown]
) -> Iterator[_Finding]:
    packages = kwargs.get("packages")
    if isinstance(packages, list | tuple) and all(isinstance(it, str) for it in packages):
        for name in packages:
            if name.replace(".", "/") not in listing.folders:
                yield f"packages lists {name!r}, but there is no such folder"
    elif packages is not None and not isinstance(packages, Unknown):
        yield unknown("this value of packages is not evaluated")


def _discovery_findings(listing: PackageListing) -> Iterator[_Finding]:
    """Yield the error of setuptools where it searches for packages and finds several."""
    folders = [name for name in listing.names("") if name in listing.folders and name.isidentifier()]
    found = sorted(name for name in folders if name not in _NO_PACKAGES and not name.startswith("_"))
    if len(found) > 1:
        yield f"packages=[...] is missing, and setuptools cannot choose between the folders {enumerated(found)}"


def file_findings(listing: PackageListing, unknown: Callable[[str], Unknown]) -> Iterator[_Finding]:
    """Yield what is wrong with setup.cfg and pyproject.toml, and what of them is not evaluated."""
    for name, read in (("setup.cfg", _cfg_findings), ("pyproject.toml", _toml_findings)):
        if name in listing.files:
            try:
                yield from read(listing.files[name].read(_MAX_SETTINGS).decode(), unknown)
            except (InputError, UnicodeDecodeError):
                yield unknown(f"{name} cannot be read")


def _cfg_findings(text: str, unknown: Callable[[str], Unknown]) -> Iterator[_Finding]:
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
            yield from _option_findings(section, names - _SECTIONS[section], unknown)
        elif names and not _OF_TOOLS.fullmatch(section):
            yield unknown(f"the section [{section}] of setup.cfg is not evaluated")


def _option_findings(section: str, others: set[str], unknown: Callable[[str], Unknown]) -> Iterator[_Finding]:
    if section == "install" and "script_dir" in others:
        yield "setup.cfg sets script_dir in [install], where it is called install_scripts"
    elif others:
        yield unknown(f"the option {min(others)} in [{section}] of setup.cfg is not evaluated")


def _toml_findings(text: str, unknown: Callable[[str], Unknown]) -> Iterator[_Finding]:
    try:
        table = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        yield f"pyproject.toml cannot be read: {error}"
        return
    tools = table.get("tool", {})
    if "project" in table or not isinstance(tools, dict) or "setuptools" in tools:
        yield unknown("[project] and [tool.setuptools] of pyproject.toml are not evaluated")
