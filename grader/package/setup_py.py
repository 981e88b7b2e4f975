"""What a build would install by a package's setup.py: told by following the file, which is never run."""

import ast
from collections.abc import Iterable
from dataclasses import dataclass, replace

from grader.files.tree import Tree
from grader.package.data_files import Copy, Entries, Stop
from grader.package.file_functions import WRITING, EmptyGlob, Found, file_functions
from grader.package.globbing import ORDERS, Listing
from grader.source import Location, Source
from grader.static_python.library import plain_functions
from grader.static_python.machine import Machine
from grader.static_python.methods import FOLDER
from grader.static_python.parse import Code, SyntaxFault
from grader.static_python.values import Fault, Spot, TooHard, Unknown, at

_ROOT = f"/{FOLDER}"
_START = Spot(1, 1)
_SETUPS = ("setuptools.setup", "distutils.core.setup", "?.setup")
# Calls that make, move or delete files: what is there afterwards is not told.
_CHANGES = (
    WRITING, "os.link", "os.makedirs", "os.mkdir", "os.popen", "os.remove", "os.rename", "os.replace", "os.rmdir",
    "os.spawn", "os.exec", "os.symlink", "os.system", "os.unlink", "pathlib.Path.", "shutil.", "subprocess.", "tarfile.",
    "tempfile.", "urllib.", "xacro.", "zipfile.",
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class Setup:
    """What is known of a setup.py. `fault` is set where Python cannot read it: nothing else is known then.

    `unknown` has what could not be told: a file that is not among `copies` may be installed all the same.
    """

    path: str
    source: Source
    fault: SyntaxFault | None = None
    name: str | None = None
    copies: tuple[Copy, ...] = ()
    stops: tuple[Stop, ...] = ()
    empty: tuple[EmptyGlob, ...] = ()
    faults: tuple[Fault, ...] = ()
    unknown: tuple[Unknown, ...] = ()
    is_called: bool = True
    called_at: Spot = _START

    def location(self, spot: Spot) -> Location:
        """A place in the file."""
        return place(self.source, spot)

    def installed(self) -> dict[str, str]:
        """Each installed file's source by its path below the prefix."""
        return {copy.target: copy.source for copy in self.copies}


def place(source: Source, spot: Spot) -> Location:
    """A place as Python counts it, in bytes, as a place in characters."""
    line = source.line(spot.line)
    column = len(line.encode("utf-8", "surrogateescape")[: spot.column - 1].decode("utf-8", "ignore"))
    return Location(source.path, spot.line, column + 1)


def read_setup(code: Code | SyntaxFault, tree: Tree) -> Setup:
    """Follow a setup.py whose package has these files. Never raises."""
    path = code.source.path
    if isinstance(code, SyntaxFault):
        return Setup(path, code.source, code)
    setup = _follow(code, tree, ORDERS[0])
    others = () if any(each.at == Spot(1, 1) for each in setup.unknown) else ORDERS[1:]
    if any(_outcome(_follow(code, tree, order)) != _outcome(setup) for order in others):
        doubt = Unknown("what is installed depends on the order in which folders are listed", Spot(1, 1))
        return replace(setup, copies=(), stops=(), unknown=(*setup.unknown, doubt))
    return setup


def _outcome(setup: Setup) -> tuple[set[Copy], set[Stop], set[Fault]]:
    return set(setup.copies), set(setup.stops), set(setup.faults)


def _follow(code: Code, tree: Tree, order: str) -> Setup:
    """What a file comes to where folders are listed in some order."""
    path = code.source.path
    listing = Listing(tree, order)
    library = {**plain_functions(_ROOT), **file_functions(listing, _ROOT)}
    machine = Machine(code, library, special={"__file__": f"{_ROOT}/setup.py"})
    machine.run()
    calls = [made for made in machine.made if made.name in _SETUPS]
    reader = Entries(tree, listing, _ROOT, _places(code, machine.notes))
    name = calls[0].kwargs.get("name") if calls else None
    try:
        for call in calls:
            reader.read(call)
    except TooHard as error:
        reader.unknown.append(Unknown(str(error), calls[0].at))
    reader.finish(next((made for made in machine.made if made.name.startswith(_CHANGES)), None))
    if machine.stopped:
        reader.unknown.append(Unknown(machine.stopped, Spot(1, 1)))
    return Setup(
        path,
        code.source,
        None,
        name if isinstance(name, str) else None,
        tuple(reader.copies),
        tuple(reader.stops),
        tuple(dict.fromkeys(note for note in machine.notes if isinstance(note, EmptyGlob))),
        tuple(sorted(machine.faults, key=lambda fault: fault.at)),
        tuple(reader.unknown),
        bool(calls) or bool(machine.stopped),
        calls[0].at if calls else _START,
    )


def _places(code: Code, notes: Iterable[object]) -> dict[str, Spot]:
    """Where a path in data_files comes from: the search that found it, or the text that it is written as."""
    places: dict[str, Spot] = {}
    for note in notes:
        if isinstance(note, Found):
            places |= dict.fromkeys(map(str, note.paths), note.at)
    for node in ast.walk(code.tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            places.setdefault(node.value, at(node))
    return places
