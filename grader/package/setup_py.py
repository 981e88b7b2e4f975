"""The files that a build installs by a package's setup.py, which is evaluated, never run."""

import ast
from collections.abc import Iterable
from dataclasses import dataclass, replace

from grader.files.tree import Tree
from grader.package.data_files import DataFiles, InstalledFile, InstallError
from grader.package.file_functions import WRITING, EmptyGlob, FoundPaths, file_functions
from grader.package.globbing import ORDERS, PackageListing
from grader.source import Location, Source
from grader.static_python.control_flow import EvaluationStopped, PythonError
from grader.static_python.functions import standard_functions
from grader.static_python.inspection import PACKAGE_FOLDER
from grader.static_python.interpreter import Interpreter
from grader.static_python.parse import Code, SyntaxFault
from grader.static_python.positions import START, Position, position_of
from grader.static_python.values import Unknown

_ROOT = f"/{PACKAGE_FOLDER}"
_SETUPS = ("setuptools.setup", "distutils.core.setup", "?.setup")
# Calls that make, move or delete files: the files that exist afterwards are not known.
_CHANGES = (
    WRITING, "os.link", "os.makedirs", "os.mkdir", "os.popen", "os.remove", "os.rename", "os.replace", "os.rmdir",
    "os.spawn", "os.exec", "os.symlink", "os.system", "os.unlink", "pathlib.Path.", "shutil.", "subprocess.", "tarfile.",
    "tempfile.", "urllib.", "xacro.", "zipfile.",
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class Setup:
    """The result of a setup.py. `fault` is set where Python cannot read it: nothing else is known then.

    `unknown` has what cannot be determined: a file that is not among `copies` may still be installed.
    """

    path: str
    source: Source
    fault: SyntaxFault | None = None
    name: str | None = None
    copies: tuple[InstalledFile, ...] = ()
    stops: tuple[InstallError, ...] = ()
    empty: tuple[EmptyGlob, ...] = ()
    faults: tuple[PythonError, ...] = ()
    unknown: tuple[Unknown, ...] = ()
    is_called: bool = True
    called_at: Position = START

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


def read_setup(code: Code | SyntaxFault, tree: Tree) -> Setup:
    """Evaluate the setup.py of a package with these files. Never raises.

    The file system lists a folder in any order. Where a search finds several files, other orders are evaluated as well; what
    differs between them is unknown.
    """
    if isinstance(code, SyntaxFault):
        return Setup(code.source.path, code.source, code)
    setup, order_matters = _evaluate(code, tree, ORDERS[0])
    if order_matters:
        others = (_evaluate(code, tree, order)[0] for order in ORDERS[1:])
        if any(_outcome(other) != _outcome(setup) for other in others):
            doubt = Unknown("the result depends on the order in which folders are listed", START)
            return replace(setup, copies=(), stops=(), unknown=(*setup.unknown, doubt))
    return setup


def _outcome(setup: Setup) -> tuple[set[InstalledFile], set[InstallError], set[PythonError]]:
    return set(setup.copies), set(setup.stops), set(setup.faults)


def _evaluate(code: Code, tree: Tree, order: str) -> tuple[Setup, bool]:
    """Evaluate a file with folders listed in some order; return the result and whether it may depend on that order."""
    listing = PackageListing(tree, order)
    functions = {**standard_functions(_ROOT), **file_functions(listing, _ROOT)}
    interpreter = Interpreter(functions, {"__file__": f"{_ROOT}/setup.py"})
    interpreter.run(code)
    calls = [call for call in interpreter.calls if call.name in _SETUPS]
    data_files = DataFiles(tree, listing, _ROOT, _positions(code, interpreter.records))
    name = calls[0].kwargs.get("name") if calls else None
    try:
        for call in calls:
            data_files.read(call)
    except EvaluationStopped as error:
        data_files.unknown.append(Unknown(str(error), calls[0].at))
    data_files.finish(next((call for call in interpreter.calls if call.name.startswith(_CHANGES)), None))
    if interpreter.stop_reason:
        data_files.unknown.append(Unknown(interpreter.stop_reason, START))
    setup = Setup(
        path=code.source.path,
        source=code.source,
        name=name if isinstance(name, str) else None,
        copies=tuple(data_files.copies),
        stops=tuple(data_files.stops),
        empty=tuple(dict.fromkeys(record for record in interpreter.records if isinstance(record, EmptyGlob))),
        faults=tuple(sorted(interpreter.errors, key=lambda error: error.at)),
        unknown=tuple(data_files.unknown),
        is_called=bool(calls) or bool(interpreter.stop_reason),
        called_at=calls[0].at if calls else START,
    )
    return setup, listing.order_matters and not interpreter.stop_reason


def _positions(code: Code, records: Iterable[object]) -> dict[str, Position]:
    """Return where each path of data_files comes from: the search that found it, or the string that it is written as."""
    positions: dict[str, Position] = {}
    for record in records:
        if isinstance(record, FoundPaths):
            positions |= dict.fromkeys(map(str, record.paths), record.at)
    for node in ast.walk(code.tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            positions.setdefault(node.value, position_of(node))
    return positions
