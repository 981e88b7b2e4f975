"""The files that a build installs by a package's setup.py, which is evaluated, never run.

`data_files` is read in the order of setuptools' install_data. Whether the build succeeds at all
also depends on the other arguments of setup(), on setup.cfg and on pyproject.toml.
"""

import ast
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from configparser import ConfigParser, Error
from dataclasses import field
from itertools import chain
from pathlib import PurePosixPath
from posixpath import basename, dirname, join, normpath, splitext

import tomli

from grader.base.errors import InputError
from grader.base.grouping import Strings, are_texts, distinct
from grader.base.names import closest, did_you_mean
from grader.base.patterns import on_use
from grader.base.records import Record
from grader.base.source import Source
from grader.base.text import enumerated
from grader.files.limits import ignored_part
from grader.files.tree import Tree
from grader.ros.installation.file_search import ORDERS, PackageListing, file_functions
from grader.ros.installation.installation import (
    IgnoredArgument,
    Installation,
    InstalledFile,
    InstallError,
)
from grader.ros.known.releases import Releases
from grader.ros.python.budget import Budget
from grader.ros.python.evaluation import Evaluation, PythonError
from grader.ros.python.interpreter import Interpreter
from grader.ros.python.library import MAX_PATH, PACKAGE_FOLDER, standard_functions
from grader.ros.python.parse import START, Code, Position, SyntaxFault, make_position, parse
from grader.ros.python.values import (
    PLAIN,
    SCALARS,
    Call,
    Function,
    Items,
    QualifiedName,
    Undetermined,
    Unknown,
    Value,
    iterate,
    unknown_in,
)
from grader.ros.python.walking import walk

_Arguments = Mapping[str, Value]

_MAX_GUESSES = 10
_ROOT = f"/{PACKAGE_FOLDER}"
_SETUPS = ("setuptools.setup", "distutils.core.setup")
# The arguments that name the Python packages; without one, setuptools searches for packages, but
# not in the folders below, those of `FlatLayoutPackageFinder.DEFAULT_EXCLUDE`.
_PACKAGES = ("packages", "py_modules", "ext_modules", "package_dir")
_NO_PACKAGES = frozenset(
    {
        "ci",
        "bin",
        "debian",
        "doc",
        "docs",
        "documentation",
        "manpages",
        "news",
        "newsfragments",
        "changelog",
        "test",
        "tests",
        "unit_test",
        "unit_tests",
        "example",
        "examples",
        "scripts",
        "tools",
        "util",
        "utils",
        "python",
        "build",
        "benchmark",
        "benchmarks",
        "exercise",
        "exercises",
        "htmlcov",
        "tasks",
        "dist",
        "venv",
        "env",
        "requirements",
        "fabfile",
        "site_scons",
    }
)
# Most files need no packaging, whose import takes a tenth of reading a package.
_PLAIN_VERSION = on_use(r"[0-9]+(?:\.[0-9]+)*")
_PLAIN_REQUIREMENT = on_use(r"[A-Za-z0-9]+(?:[_-][A-Za-z0-9]+)*")
# The name and value of an entry point, as importlib.metadata has them.
_ENTRY_POINT = on_use(r"\s*[^=\s][^=]*=\s*[\w.]+\s*(?::\s*[\w.]+\s*)?(?:\[.*\]\s*)?")
_TEXTS = (
    "name",
    "description",
    "long_description",
    "author",
    "author_email",
    "maintainer",
    "maintainer_email",
    "url",
    "license",
    "download_url",
    "long_description_content_type",
    "python_requires",
    "test_suite",
)
# The arguments whose faults are found below.
_SWITCHES = ("zip_safe", "include_package_data")
_CHECKED = ("version", "packages", "py_modules", "data_files", "entry_points", *_SWITCHES)
# The other arguments that setuptools 68 knows, and those that well-known plug-ins add.
_OTHERS = (
    "package_dir",
    "ext_modules",
    "ext_package",
    "scripts",
    "script_name",
    "script_args",
    "cmdclass",
    "command_options",
    "options",
    "libraries",
    "include_dirs",
    "headers",
    "provides",
    "requires",
    "obsoletes",
    "license_file",
    "license_files",
    "project_urls",
    "namespace_packages",
    "exclude_package_data",
    "eager_resources",
    "dependency_links",
    "features",
    "test_loader",
    "test_runner",
    "use_2to3",
    "convert_2to3_doctests",
    "distclass",
    "licence",
    "provides_extras",
    "contact",
    "contact_email",
    "fullname",
    "password",
    "verbose",
    "dry_run",
    "help",
    "src_root",
    "use_scm_version",
    "cffi_modules",
    "pbr",
    "rust_extensions",
    "use_incremental",
    "cmake_args",
    "cmake_install_dir",
)
_AT_HAND = frozenset({"setuptools", "wheel"})  # what setup_requires may name without a download
# The sections of setup.cfg that concern a build: of these, the options that are known to be
# accepted. setuptools 68 takes a dash for an underscore, with a warning (dist.py,
# `warn_dash_deprecation`).
_SECTIONS = {"develop": {"script_dir", "install_scripts"}, "install": {"install_scripts"}}
_TOOL_SECTIONS = on_use(
    r"flake8|pycodestyle|pydocstyle|pep8|pep257|mypy\b.*|isort|pylint|yapf|black|tool:.*|coverage:.*|bdist_wheel|sdist|test"
)
_MAX_SETTINGS = 64 * 1024  # bytes
# A fault, or what is not evaluated.
_Finding = str | Unknown
_Findings = Iterator[_Finding]


def read_setup(
    data: bytes,
    path: str,
    tree: Tree,
    budget: Budget | None = None,
    releases: Releases = (),
) -> Installation:
    """Evaluate the setup.py of a package with these files; its work is charged to the budget.

    Python is that of the releases. It never raises.

    The file system lists a folder in any order. If there are several files, other orders are
    evaluated as well. colcon runs the file twice, with __file__ as "setup.py" and as an absolute
    path. What differs between these is unknown.
    """
    code = parse(data, path, releases)
    if isinstance(code, SyntaxFault):
        return Installation(code.source, code)
    budget = budget or Budget()
    strings = [
        node
        for node in walk(code.tree)
        if isinstance(node, ast.Constant) and isinstance(node.value, str)
    ]
    written = {
        str(node.value): make_position(node) for node in reversed(strings)
    }  # the first of several counts
    listing = PackageListing(tree, budget, ORDERS[0])
    setups = [_evaluate_setup(code, listing, written, "setup.py")]
    if "__file__" in code.text:
        setups.append(
            _evaluate_setup(
                code, PackageListing(tree, budget, ORDERS[0]), written, f"{_ROOT}/setup.py"
            )
        )
    orders = ORDERS[1:] if listing.order_matters else ()
    setups += [
        _evaluate_setup(code, PackageListing(tree, budget, order), written, "setup.py")
        for order in orders
    ]
    return _common_result(setups)


def _common_result(setups: Sequence[Installation]) -> Installation:
    """Return the first of several results; what differs between them is unknown."""
    results = {
        (setup.name, frozenset(setup.copies), setup.is_called, bool(setup.faults))
        for setup in setups
    }
    doubts = [unknown for setup in setups[1:] for unknown in setup.unknown]
    if len(results) == 1 and not doubts:
        return setups[0]
    doubt = Unknown(
        "the result depends on the order of the files in a folder, or on __file__", START
    )
    if doubts:
        doubt = doubts[0]
    unknown = distinct([*setups[0].unknown, doubt])
    return setups[0]._replace(name=None, copies=(), stops=(), unknown=unknown, doubt=doubt)


def _evaluate_setup(
    code: Code, listing: PackageListing, written: dict[str, Position], file: str
) -> Installation:
    """Evaluate a file with folders listed in some order; `file` is what __file__ is."""
    data_files = _DataFiles(listing, _ROOT, written, is_first=file == "setup.py")
    calls = []

    def setup(_: Evaluation, call: Call) -> Value:
        calls.append(call)
        _read_call(data_files, call)
        return Unknown("the result of setup() is not evaluated", call.at)

    def write(_: Evaluation, call: Call) -> None:
        if "file" not in call.kwargs:
            data_files.stop(
                "setup.py prints something, and colcon reads what it prints: print to sys.stderr",
                call.at,
            )
            return
        stream = call.kwargs["file"]
        if not isinstance(stream, QualifiedName) or stream.name != "sys.stderr":
            raise Undetermined("this use of print is not evaluated", call.at, is_final=True)

    functions = {
        **standard_functions(_ROOT),
        **file_functions(listing, _ROOT),
        **dict.fromkeys(_SETUPS, setup),
    }
    interpreter = Interpreter(
        {**functions, "builtins.print": write},
        {"__file__": file},
        stand_ins=(_ROOT,),
        budget=listing.budget,
        local_modules=listing.modules(),
    )
    interpreter.run(code)
    data_files.finish()
    given = calls[0].kwargs if calls else {}  # a second call of setup() builds nothing
    name = given.get("name")
    faults = sorted(interpreter.errors, key=lambda error: error.at)
    if code.conflict is not None:
        faults.insert(0, PythonError(*code.conflict))
    doubts = data_files.doubts
    if interpreter.doubt:
        doubts = [interpreter.doubt, *doubts]
    return Installation(
        source=code.source,
        name=name if isinstance(name, str) else None,
        copies=tuple(data_files.copies),
        stops=tuple(data_files.stops),
        empty=tuple(listing.empty),
        faults=tuple(faults),
        unknown=distinct(doubts + data_files.unknown),
        doubt=doubts[0] if doubts else None,
        is_called=bool(calls) or interpreter.doubt is not None,
        called_at=calls[0].at if calls else START,
        files_at=_files_at(calls[0], code.source) if calls else START,
        entry_points=given.get("entry_points"),
        ignored=tuple(data_files.ignored),
        scripts_folder=_scripts_folder(listing),
        packages=_packages_in(given.get("packages")),
    )


def _files_at(call: Call, source: Source) -> Position:
    """Return the position of the argument data_files; without it, of the call."""
    at = call.places.get("data_files")
    if not at:
        return call.at
    name = source.line(at.line).find("data_files")
    return at._replace(column=name + 1) if 0 <= name < at.column else at


def _read_call(data_files: "_DataFiles", call: Call) -> None:
    """Read a call of setup(): the files that it installs, and whether a build succeeds with it."""
    if call.args:
        data_files.stop("setup() takes arguments by name only: write name=...", call.at)
    for ignored in _ignored_arguments(call.kwargs):
        data_files.ignored.append(ignored)
        value = call.kwargs.pop(ignored.name)
        if ignored.meant == "data_files":
            data_files.read(value, call.at)
            data_files.stops.clear()  # setuptools does not read them
    entries = call.kwargs.get("data_files")
    if entries is not None:
        data_files.read(entries, call.at)
    of_files = list(_file_findings(data_files.listing, call))
    is_configured = any(isinstance(finding, Unknown) for finding in of_files)
    for finding in (
        *_argument_findings(call.kwargs, data_files.listing, call.at, is_configured),
        *of_files,
    ):
        if isinstance(finding, str):
            data_files.stop(finding, call.at)
        else:
            data_files.doubts.append(finding)


class _DataFiles(Record, frozen=False):
    """Installs the files of data_files as setuptools' install_data does, without touching any."""

    listing: PackageListing
    root: str  # the absolute path that stands for the package's folder
    written: Mapping[str, Position]  # where each text is written
    is_first: bool = True  # whether it is the run of setup.py in which colcon asks for data_files
    copies: list[InstalledFile] = field(default_factory=list)
    stops: list[InstallError] = field(default_factory=list)
    unknown: list[Unknown] = field(default_factory=list)  # what is installed as well, or elsewhere
    doubts: list[Unknown] = field(
        default_factory=list
    )  # with these, whether the build succeeds is not known either
    ignored: list[IgnoredArgument] = field(default_factory=list)

    def read(self, entries: Value, at: Position) -> None:
        """Add the files of the argument data_files."""
        if not isinstance(entries, list | tuple):
            self._give_up(entries, "this value of data_files is not evaluated", at)
            return
        for entry in entries:
            self._entry(entry, at)

    def finish(self) -> None:
        """Remove what is not certain: files with the same target."""
        sources = defaultdict(set)
        for copy in self.copies:
            sources[copy.target].add(copy.source)
        several = [copy for copy in self.copies if len(sources[copy.target]) > 1]
        self.copies = [copy for copy in self.copies if len(sources[copy.target]) == 1]
        for target, at in {copy.target: copy.at for copy in several}.items():
            reason = (
                f"several files are installed as {target}: {enumerated(sorted(sources[target]))}"
            )
            self.unknown.append(Unknown(reason, at))

    def _origin(self, path: str, at: Position) -> Position:
        """Return the position of the search that finds a path, or where it is written."""
        if path:
            return self.listing.positions.get(path) or self.written.get(path, at)
        return at

    def _give_up(self, value: Value, reason: str, at: Position) -> None:
        """Add the unknown parts of a value, or that it is not supported."""
        self.doubts.append(unknown_in(value) or Unknown(reason, at))

    def stop(self, reason: str, at: Position, path: str = "") -> None:
        """Add an error that stops the build."""
        self.stops.append(InstallError(path, reason, self._origin(path, at)))

    def _entry(self, entry: Value, at: Position) -> None:
        """Add an entry of data_files.

        colcon takes it as a file, or as a tuple of a folder and a list of files.
        """
        match entry:
            case str():
                self._file(entry, "", at)
            case (folder, files) if isinstance(entry, tuple):
                self._folder(folder, files, at)
            case Unknown() | Call():
                self._give_up(entry, "an entry of data_files is not evaluated", at)
            case [folder, files]:
                self.stop("an entry of data_files is not a tuple: write (folder, [files])", at)
                self._folder(folder, files, at)
            case list() | dict() | set():
                self.stop("an entry of data_files is not a tuple: write (folder, [files])", at)
                for folder, files in entry.items() if isinstance(entry, dict) else ():
                    self._folder(folder, files, at)
            case (*folders, list() as files) if are_texts(folders):
                self.stop(
                    "an entry of data_files is not a tuple of a folder and a list of files", at
                )
                self._folder(join("", *folders), files, at)
            case _:
                self.stop(
                    "an entry of data_files is not a tuple of a folder and a list of files", at
                )

    def _folder(self, folder: Value, files: Value, at: Position) -> None:
        if isinstance(folder, PurePosixPath):
            self._not_text(folder, "the folder of an entry", at)
            folder = str(folder)
        if not isinstance(folder, str):
            self._not_text(folder, "the folder of an entry", at)
        elif folder.startswith(self.root):
            self._give_up(None, "a target in the package itself is not supported", at)
        elif folder.startswith("/"):
            self.stop(
                (
                    f"the folder {folder!r} is absolute; colcon takes one below the prefix, "
                    "such as share/..."
                ),
                at,
            )
            self._files(files, folder.strip("/"), at)
        elif ".." in folder.split("/") or len(folder) > MAX_PATH:
            self._give_up(None, f"the target {folder[:MAX_PATH]} is not supported", at)
        else:
            self._files(files, folder, at)

    def _files(self, files: Value, folder: str, at: Position) -> None:
        """Add the files of an entry.

        What is no list stops the build, and is read as the list that is meant.
        """
        if isinstance(files, str) and files:
            self.stop(
                "the files of an entry are a string, not a list: write [...] around it", at, files
            )
            files = [files] if files in self.listing.files else []
        elif isinstance(files, Items | tuple | set):
            self._not_list(files, at)
            files = sorted(files, key=str) if isinstance(files, set) else list(iterate(files))
        if not isinstance(files, list):
            self._not_list(files, at)
            return
        for file in files:
            self._file(file, folder, at)
            for inner in (
                file if isinstance(file, list) else ()
            ):  # a list in the list, which stops the build
                self._file(inner, folder, at)

    def _not_list(self, files: Value, at: Position) -> None:
        if isinstance(files, Items):
            self.stop(
                "the files of an entry are an iterator, not a list: write list(...) around it", at
            )
        elif isinstance(files, (*PLAIN, set, QualifiedName, Function)):
            kind = type(files).__name__
            self.stop(
                (
                    f"the files of an entry are of the type {kind}, not a list: write list(...) "
                    "around it"
                ),
                at,
            )
        else:
            self._give_up(files, "the files of an entry are not evaluated", at)

    def _not_text(self, value: Value, what: str, at: Position) -> None:
        if isinstance(value, PurePosixPath):
            self.stop(
                f"{what} is a path, and colcon takes strings only: write str(...) around it", at
            )
        elif isinstance(value, (*PLAIN, Items, QualifiedName, Function)):
            self.stop(f"{what} is not a string: is a bracket misplaced?", at)
        else:
            self._give_up(value, f"{what} is not evaluated", at)

    def _file(self, file: Value, folder: str, at: Position) -> None:
        self.listing.budget.charge(5)
        if isinstance(file, PurePosixPath):
            self._not_text(file, "a file of an entry", at)
            file = str(file)
        if isinstance(file, str):
            self._path(file, folder, self._origin(file, at))
        else:
            self._not_text(file, "a file of an entry", at)

    def _path(self, text: str, folder: str, at: Position) -> None:
        is_absolute = text.startswith(self.root + "/")
        text = text.removeprefix(self.root + "/")
        if len(text) > MAX_PATH:
            self._give_up(None, "the path of a file is too long", at)
            return
        try:
            path = self.listing.real(text)
        except Undetermined:
            if text.startswith("/"):
                self.stop(
                    "the path is absolute, and colcon takes paths in the package only", at, text
                )
            else:
                self._give_up(None, f"{text} is outside of the package, or ignored", at)
            return
        if PACKAGE_FOLDER in text:
            self._give_up(None, "the name of the package's folder is not known", at)
        elif is_absolute and self.is_first:
            self.stop("the path is absolute, and colcon takes paths in the package only", at, text)
            self._copy(path, folder, at)
        elif path is None:
            self._missing_path(text, at)
        elif not self._copy(path, folder, at):
            reason = f"it is a folder, and only files can be installed{self._narrower(path)}"
            self.stops.append(InstallError(text, reason, at))

    def _missing_path(self, text: str, at: Position) -> None:
        """Note that there is no file at a path, or that it is ignored."""
        if ignored_part(normpath(text)):
            self._give_up(None, f"{text} is an ignored file", at)
        else:
            guess = did_you_mean(text, self.listing.files) if len(self.stops) < _MAX_GUESSES else ""
            self.stops.append(InstallError(text, "there is no such file", at, guess))

    def _copy(self, path: str | None, folder: str, at: Position) -> bool:
        """Install a file of the package; return whether it is one."""
        if path is None or path not in self.listing.files:
            return False
        target = normpath(join(folder, basename(path)))
        self.copies.append(InstalledFile(path, target, at))
        return True

    def _narrower(self, folder: str) -> str:
        """Return the hint about a pattern that matches the other files next to a folder.

        It does not match the folder.
        """
        above = dirname(folder)
        names = self.listing.names(above) if above else []
        beside = [splitext(name)[1] for name in names if join(above, name) in self.listing.files]
        if not any(beside):
            return ""
        most_common = max(sorted(set(beside) - {""}), key=beside.count)
        return f": a pattern such as '*{most_common}' does not match it"


def _argument_findings(
    kwargs: _Arguments, listing: PackageListing, at: Position, is_configured: bool
) -> _Findings:
    """Yield what is wrong with the arguments of setup() besides data_files.

    What of them is not evaluated is yielded, too.
    """
    yield from _unusual_values(kwargs, at)
    yield from _version_findings(kwargs, at)
    yield from _switch_findings(kwargs, at)
    yield from _entry_point_findings(kwargs, at)
    yield from _package_findings(kwargs, listing, at)
    if not _is_list(kwargs.get("py_modules") or []):  # one that is not there is a warning
        yield Unknown("this value of py_modules is not evaluated", at)
    names_packages = any(kwargs.get(name) is not None for name in _PACKAGES)
    if not is_configured and not names_packages and "src" not in listing.folders:
        yield from _discovery_findings(listing)


def _unusual_values(kwargs: _Arguments, at: Position) -> Iterator[Unknown]:
    """Yield that arguments which are not checked further have values that are not evaluated."""
    for name, value in kwargs.items():
        if name in _CHECKED or value is None:
            continue
        if name not in _USUAL or not _USUAL[name](value):
            yield unknown_in(value) or Unknown(
                f"this value of {name} in setup() is not evaluated", at
            )


def _switch_findings(kwargs: _Arguments, at: Position) -> _Findings:
    """Yield what is wrong with the arguments that are True or False."""
    for name in _SWITCHES:
        value = kwargs.get(name)
        if not isinstance(value, (*SCALARS, type(None))):
            yield unknown_in(value) or Unknown(f"this value of {name} is not evaluated", at)
        elif value not in (True, False, None):
            yield f"{name} is True or False, not {value!r}"


def _ignored_arguments(kwargs: _Arguments) -> list[IgnoredArgument]:
    """Return the arguments that setuptools does not know, with what they may mean.

    Each has the missing argument that it may mean.
    """
    known = {*_USUAL, *_CHECKED, *_OTHERS}
    return [
        IgnoredArgument(name, closest(name, known - kwargs.keys()))
        for name in kwargs
        if name not in known
    ]


def _is_list(value: Value) -> bool:
    return isinstance(value, list | tuple) and are_texts(value)


def _are_requirements(value: Value) -> bool:
    if isinstance(value, str):
        value = [value] if value else []
    return _is_list(value) and all(map(_is_requirement, value))


def _is_requirement(text: str) -> bool:
    """Return whether setuptools accepts the text of a requirement (PEP 508)."""
    if _PLAIN_REQUIREMENT.fullmatch(text):
        return True
    from packaging.requirements import InvalidRequirement, Requirement

    try:
        Requirement(text)
    except InvalidRequirement:
        return False
    return True


def _is_version(text: str) -> bool:
    """Return whether setuptools accepts the text of a version (PEP 440)."""
    if _PLAIN_VERSION.fullmatch(text):
        return True
    from packaging.version import InvalidVersion, Version

    try:
        Version(text)
    except InvalidVersion:
        return False
    return True


# Whether setuptools certainly accepts the value of an argument.
_USUAL: Mapping[str, Callable[[Value], bool]] = {
    **dict.fromkeys(_TEXTS, lambda argument: isinstance(argument, str | Unknown)),
    **dict.fromkeys(
        ("keywords", "classifiers", "platforms"),
        lambda argument: isinstance(argument, str) or _is_list(argument),
    ),
    **dict.fromkeys(("install_requires", "tests_require"), _are_requirements),
    "setup_requires": lambda argument: (
        _are_requirements(argument)
        and _AT_HAND.issuperset([argument] if isinstance(argument, str) else argument)
    ),
    "extras_require": lambda argument: (
        isinstance(argument, dict) and all(map(_are_requirements, argument.values()))
    ),
    "package_data": lambda argument: (
        isinstance(argument, dict)
        and all(map(_is_list, argument.values()))
        and _is_list(list(argument))
    ),
}


def _version_findings(kwargs: _Arguments, at: Position) -> _Findings:
    version = kwargs.get("version")
    if isinstance(version, str):
        if version and not _is_version(version):
            yield f"the version {version!r} is not valid: write numbers with dots, such as 0.1.0"
    elif not isinstance(version, int | float | None):
        yield unknown_in(version) or Unknown("this version is not evaluated", at)


def _entry_point_findings(kwargs: _Arguments, at: Position) -> _Findings:
    groups = kwargs.get("entry_points")
    if groups is None:
        return
    unknown = unknown_in(groups)
    if unknown or not isinstance(groups, dict):
        yield unknown or Unknown("these entry points are not evaluated", at)
        return
    if not all(isinstance(group, list | tuple) for group in groups.values()):
        yield Unknown("these entry points are not evaluated", at)
        return
    for line in chain.from_iterable(groups.values()):
        if not isinstance(line, str):
            yield Unknown("an entry point that is no string is not evaluated", at)
        elif "=" not in line or not _ENTRY_POINT.fullmatch(line):
            yield f"the entry point {line!r} is not valid: write name = package.module:function"


def _folder_of_package(name: str, package_dir: Value) -> str | None:
    """Return the folder of a package, as setuptools finds it by package_dir; None if not known."""
    path = name.replace(".", "/")
    if package_dir is None:
        return path
    if not isinstance(package_dir, dict) or not isinstance(package_dir.get("", ""), str):
        return None
    if any(key for key in package_dir):
        return None  # some packages have folders of their own
    return normpath(join(str(package_dir.get("", "")), path))


def _package_findings(kwargs: _Arguments, listing: PackageListing, at: Position) -> _Findings:
    packages = kwargs.get("packages")
    if isinstance(packages, list | tuple) and are_texts(packages):
        for name in packages:
            folder = _folder_of_package(name, kwargs.get("package_dir"))
            if folder is not None and folder not in listing.folders:
                yield f"packages lists {name!r}, but there is no such folder"
    elif packages is not None and not isinstance(packages, Unknown):
        yield Unknown("this value of packages is not evaluated", at)


def _discovery_findings(listing: PackageListing) -> _Findings:
    """Yield the error of setuptools where it searches for packages and finds several."""
    folders = [
        name for name in listing.names("") if name in listing.folders and name.isidentifier()
    ]
    candidates = sorted(
        name for name in folders if name not in _NO_PACKAGES and not name.startswith("_")
    )
    if len(candidates) > 1:
        yield (
            "packages=[...] is missing, and setuptools cannot choose between the folders "
            f"{enumerated(candidates)}"
        )


def _file_findings(listing: PackageListing, call: Call) -> _Findings:
    """Yield what is wrong with setup.cfg and pyproject.toml, and what of them is not evaluated."""
    for name, read in (("setup.cfg", _cfg_findings), ("pyproject.toml", _toml_findings)):
        if name in listing.files:
            try:
                yield from read(listing.files[name].read(_MAX_SETTINGS).decode(), call)
            except (InputError, UnicodeDecodeError):
                yield Unknown(f"{name} cannot be read", call.at)


def _cfg_findings(text: str, call: Call) -> _Findings:
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
            options_of_section = {name.replace("-", "_") for name in names}
            yield from _option_findings(section, options_of_section - _SECTIONS[section], call.at)
        elif names and not _TOOL_SECTIONS.fullmatch(section):
            yield Unknown(f"the section [{section}] of setup.cfg is not evaluated", call.at)


def _packages_in(value: Value) -> Strings:
    if isinstance(value, list | tuple):
        return tuple(name.replace("/", ".") for name in value if isinstance(name, str))
    return ()


def _scripts_folder(listing: PackageListing) -> str:
    """Return the folder below the prefix that console_scripts are installed to.

    It is bin unless setup.cfg names another.
    """
    parser = ConfigParser()
    file = listing.files.get("setup.cfg")
    try:
        parser.read_string(file.read(_MAX_SETTINGS).decode() if file else "")
        options = {option.replace("-", "_"): value for option, value in parser["install"].items()}
        return normpath(options["install_scripts"].removeprefix("$base").lstrip("/"))
    except (InputError, UnicodeDecodeError, Error, KeyError):
        return "bin"


def _option_findings(section: str, others: set[str], at: Position) -> _Findings:
    if section == "install" and "script_dir" in others:
        yield "setup.cfg sets script_dir in [install], where it is called install_scripts"
    elif others:
        yield Unknown(f"the option {min(others)} in [{section}] of setup.cfg is not evaluated", at)


def _toml_findings(text: str, call: Call) -> _Findings:
    try:
        table = tomli.loads(text)
    except tomli.TOMLDecodeError as error:
        yield f"pyproject.toml cannot be read: {error}"
        return
    tools = table.get("tool", {})
    named = {"name": call.kwargs.get("name"), "version": call.kwargs.get("version")}
    # A [project] that only repeats these changes nothing.
    is_plain = table.get("project", named) == named
    if not is_plain or not isinstance(tools, dict) or "setuptools" in tools:
        message = "[project] and [tool.setuptools] of pyproject.toml are not evaluated"
        yield Unknown(message, call.at)
