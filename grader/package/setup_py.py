"""The files that a build installs by a package's setup.py, which is evaluated, never run."""

import ast
from dataclasses import dataclass, replace

from grader.files.tree import Tree
from grader.package.data_files import DataFiles, InstalledFile, InstallError
from grader.package.file_functions import WRITING, file_functions
from grader.package.globbing import ORDERS, EmptyGlob, PackageListing
from grader.source import Location, Source
from grader.static_python.evaluation import EvaluationStopped, PythonError
from grader.static_python.functions import standard_functions
from grader.static_python.interpreter import Interpreter
from grader.static_python.parse import START, Code, Position, SyntaxFault, position_of
from grader.static_python.values import PACKAGE_FOLDER, Unknown

_ROOT = f"/{PACKAGE_FOLDER}"
_SETUPS = ("setuptools.setup", "distutils.core.setup", "?.setup")
# Calls that make, move or delete files: the files that exist afterwards are not known.
_CHANGES = (
    WRITING, "os.link", "os.makedirs", "os.mkdir", "os.popen", "os.remove", "os.rename", "os.replace", "os.rmdir",
    "os.spawn", "os.exec", "os.symlink", "os.system", "os.unlink", "pathlib.Path.", "shutil.", "subprocess.",
    "tarfile.", "tempfile.", "urllib.", "xacro.", "zipfile.",
)  # fmt: skip


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

    The file system lists a folder, and Python a set, in any order. If there are several files or values, other orders
    are evaluated as well; what differs between them is unknown.
    """
    if isinstance(code, SyntaxFault):
        return Setup(code.source, code)
    strings = [node for node in ast.walk(code.tree) if isinstance(node, ast.Constant) and isinstance(node.value, str)]
    written = {str(node.value): position_of(node) for node in reversed(strings)}  # the first of several counts
    setup, order_matters = _evaluate(code, tree, ORDERS[0], written)
    others = [_evaluate(code, tree, order, written)[0] for order in ORDERS[1:]] if order_matters else []
    results = {(it.name, frozenset(it.copies), frozenset(it.stops), frozenset(it.faults)) for it in (setup, *others)}
    if len(results) == 1:
        return setup
    doubt = Unknown("the result depends on the order of the files in a folder, or of a set", START)
    return replace(setup, name=None, copies=(), stops=(), unknown=(*setup.unknown, doubt))


def _evaluate(code: Code, tree: Tree, order: str, written: dict[str, Position]) -> tuple[Setup, bool]:
    """Evaluate a file with folders listed in some order; return the result and whether it may depend on that order."""
    listing = PackageListing(tree, order)
    functions = {**standard_functions(_ROOT), **file_functions(listing, _ROOT)}
    interpreter = Interpreter(functions, {"__file__": f"{_ROOT}/setup.py"})
    interpreter.run(code)
    calls = [call for call in interpreter.calls if call.name in _SETUPS]
    data_files = DataFiles(tree, listing, _ROOT, written | listing.positions)
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
        source=code.source,
        name=name if isinstance(name, str) else None,
        copies=tuple(data_files.copies),
        stops=tuple(data_files.stops),
        empty=tuple(listing.empty),
        faults=tuple(sorted(interpreter.errors, key=lambda error: error.at)),
        unknown=tuple(data_files.unknown),
        is_called=bool(calls) or bool(interpreter.stop_reason),
        called_at=calls[0].at if calls else START,
    )
    return setup, listing.order_matters and not interpreter.stop_reason
