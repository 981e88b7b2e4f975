"""The files that a build installs by a package's setup.py, which is evaluated, never run."""

import ast
from dataclasses import dataclass, replace

from grader.errors import InputError
from grader.files.tree import File, Tree
from grader.package.build_settings import argument_findings, file_findings
from grader.package.data_files import DataFiles, InstalledFile, InstallError
from grader.package.file_functions import file_functions
from grader.package.globbing import ORDERS, EmptyGlob, PackageListing
from grader.python.budget import PYTHON_LIMIT, Budget
from grader.python.evaluation import Evaluation, PythonError
from grader.python.interpreter import Interpreter
from grader.python.library import PACKAGE_FOLDER, standard_functions
from grader.python.parse import START, Code, Position, SyntaxFault, parse, position_of
from grader.python.values import Call, EvaluationFails, QualifiedName, Undetermined, Unknown, Value
from grader.source import Location, Source

_ROOT = f"/{PACKAGE_FOLDER}"
_SETUPS = ("setuptools.setup", "distutils.core.setup", "?.setup")


@dataclass(frozen=True, slots=True)
class Setup:
    """The result of a setup.py. `fault` is set where Python cannot read it: nothing else is known then."""

    source: Source
    fault: SyntaxFault | None = None
    name: str | None = None
    copies: tuple[InstalledFile, ...] = ()
    stops: tuple[InstallError, ...] = ()
    empty: tuple[EmptyGlob, ...] = ()
    faults: tuple[PythonError, ...] = ()
    unknown: tuple[Unknown, ...] = ()  # with any of these, a file that is not among the copies may be installed as well
    doubt: Unknown | None = (
        None  # the first that is not evaluated, so that whether the file gets to its end is not known
    )
    is_called: bool = True
    called_at: Position = START
    entry_points: Value = None  # what setup() is given

    def has_program(self, name: str) -> bool | None:
        """Return whether a build installs a program for `ros2 run`; None where this is not known."""
        installed = [copy.target.rpartition("/") for copy in self.copies]
        if any(target == name and folder.startswith("lib/") for folder, _, target in installed):
            return True
        points = self.entry_points if self.entry_points is not None else {}
        scripts = points.get("console_scripts", []) if isinstance(points, dict) else None
        if not isinstance(scripts, list) or not all(isinstance(script, str) for script in scripts) or self.unknown:
            return None
        return name in [script.partition("=")[0].strip() for script in scripts]

    def location(self, position: Position) -> Location:
        """Return the location of a position in the file."""
        return location_in(self.source, position)

    def installed(self) -> dict[str, str]:
        """Return each installed file's source by its path below the prefix."""
        return {copy.target: copy.source for copy in self.copies}


def location_in(source: Source, position: Position) -> Location:
    """Return the location of a position that Python gives: it counts columns in bytes, a location in characters."""
    line = source.line(position.line)
    column = len(line.encode("utf-8", "surrogateescape")[: position.column - 1].decode("utf-8", "ignore"))
    return Location(source.path, position.line, column + 1)


def read_setup_file(file: File, path: str, tree: Tree, budget: Budget) -> Setup:
    """Read and evaluate the setup.py of a package with these files. Never raises."""
    try:
        code = parse(file.read(PYTHON_LIMIT), path)
    except InputError as error:
        code = SyntaxFault(Source(path, ""), str(error), Location(path, 1, 1), sure=False)
    return read_setup(code, tree, budget)


def read_setup(code: Code | SyntaxFault, tree: Tree, budget: Budget | None = None) -> Setup:
    """Evaluate the setup.py of a package with these files; its work is charged to the budget. Never raises.

    The file system lists a folder in any order. If there are several files, other orders are evaluated as well. colcon
    runs the file twice, with __file__ as "setup.py" and as an absolute path. What differs between these is unknown.
    """
    if isinstance(code, SyntaxFault):
        return Setup(code.source, code)
    budget = budget or Budget()
    strings = [node for node in ast.walk(code.tree) if isinstance(node, ast.Constant) and isinstance(node.value, str)]
    written = {str(node.value): position_of(node) for node in reversed(strings)}  # the first of several counts
    listing = PackageListing(tree, budget, ORDERS[0])
    setups = [_evaluate(code, listing, written, "setup.py")]
    if "__file__" in code.source.text:
        setups.append(_evaluate(code, PackageListing(tree, budget, ORDERS[0]), written, f"{_ROOT}/setup.py"))
    orders = ORDERS[1:] if listing.order_matters else ()
    setups += [_evaluate(code, PackageListing(tree, budget, order), written, "setup.py") for order in orders]
    results = {(it.name, frozenset(it.copies), it.is_called, bool(it.faults)) for it in setups}
    doubts = [unknown for it in setups[1:] for unknown in it.unknown]
    if len(results) == 1 and not doubts:
        return setups[0]
    doubt = (
        doubts[0]
        if doubts
        else Unknown("the result depends on the order of the files in a folder, or on __file__", START)
    )
    return replace(setups[0], name=None, copies=(), stops=(), unknown=(*setups[0].unknown, doubt), doubt=doubt)


def _evaluate(code: Code, listing: PackageListing, written: dict[str, Position], file: str) -> Setup:
    """Evaluate a file with folders listed in some order; `file` is what __file__ is."""
    data_files = DataFiles(listing, _ROOT, written, is_first=file == "setup.py")
    calls: list[Call] = []

    def setup(_: Evaluation, call: Call) -> Value:
        calls.append(call)
        _read_call(data_files, call)
        return Unknown("the result of setup() is not evaluated", call.at)

    def write(_: Evaluation, call: Call) -> None:
        if "file" not in call.kwargs:
            data_files.stop("setup.py prints something, and colcon reads what it prints: print to sys.stderr", call.at)
        elif not isinstance(call.kwargs["file"], QualifiedName) or call.kwargs["file"].name != "sys.stderr":
            raise Undetermined("this use of print is not evaluated", call.at, is_final=True)

    functions = {**standard_functions(_ROOT), **file_functions(listing, _ROOT), **dict.fromkeys(_SETUPS, setup)}
    interpreter = Interpreter(
        {**functions, "builtins.print": write},
        {"__file__": file},
        stand_ins=(_ROOT,),
        budget=listing.budget,
        local_modules=listing.modules(),
    )
    interpreter.run(code)
    name = calls[0].kwargs.get("name") if calls else None
    data_files.finish()
    doubts = [*filter(None, [interpreter.doubt]), *data_files.doubts]
    return Setup(
        source=code.source,
        name=name if isinstance(name, str) else None,
        copies=tuple(data_files.copies),
        stops=tuple(data_files.stops),
        empty=tuple(listing.empty),
        faults=tuple(sorted(interpreter.errors, key=lambda error: error.at)),
        unknown=tuple(dict.fromkeys([*doubts, *data_files.unknown])),
        doubt=doubts[0] if doubts else None,
        is_called=bool(calls) or interpreter.doubt is not None,
        called_at=calls[0].at if calls else START,
        entry_points=calls[0].kwargs.get("entry_points") if calls else None,
    )


def _read_call(data_files: DataFiles, call: Call) -> None:
    """Read a call of setup(): the files that it installs, and whether a build succeeds with it."""

    def unknown(reason: str) -> Unknown:
        return Unknown(reason, call.at)

    if call.args:
        raise EvaluationFails("setup() takes arguments by name only: write name=...")
    entries = call.kwargs.get("data_files")
    if entries is not None:
        data_files.read(entries, call.at)
    of_files = [*file_findings(data_files.listing, unknown)]
    is_configured = any(isinstance(finding, Unknown) for finding in of_files)
    for finding in (*argument_findings(call.kwargs, data_files.listing, unknown, is_configured), *of_files):
        if isinstance(finding, str):
            data_files.stop(finding, call.at)
        else:
            data_files.doubts.append(finding)
