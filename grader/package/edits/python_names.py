"""Names that a Python file uses and does not define: the missing imports, and what an import should be."""

import ast
import re
from collections.abc import Iterable, Iterator

from grader.edits import Proposal
from grader.package.edits.python_file import PythonFile
from grader.package.edits.syntax import missing_commas
from grader.package.edits.task import proposal
from grader.source import Edit, Location

_MAX_COMMAS = 4
_CALL = re.compile(r"(?<![\w.])glob\(")
_MODULE_CALL = re.compile(r"(?<![\w.])glob\.glob\(")


def defined(file: PythonFile, faults: Iterable[Location], what: str) -> Iterator[Proposal]:
    """Yield edits that define the names at the places of Python's errors, or add the comma that is missing there."""
    places = list(faults)
    words = [file.word_at(place.line, place.column) for place in places]
    if missing := file.with_imports(words):
        yield proposal(missing, f"a missing import in {what}", _added(missing, what))
    for edit in _other_glob(file):
        kind = "function" if edit.new.startswith("from") else "module"
        yield proposal(
            [edit], f"an import of glob in {what} that does not fit its use", f"import the {kind} glob in {what}"
        )
    uses = [match.start() for match in _CALL.finditer(file.text)]
    if uses:
        edits = [file.source.edit(start, start + len("glob"), "glob.glob") for start in uses]
        yield proposal(edits, f"a call of the module glob in {what}", f"call the function of the module glob in {what}")
    lines = {place.line for place in places}
    commas = sorted(missing_commas(file), key=lambda edit: min((abs(edit.line - line) for line in lines), default=0))
    for edit in commas[:_MAX_COMMAS] if places else ():
        yield proposal([edit], f"a missing comma in {what}", f"add the missing comma in {what}")


def _added(edits: Iterable[Edit], what: str) -> str:
    lines = [line for edit in edits for line in edit.new.split("\n") if line.strip()]
    return f"add the missing import to {what}" if len(lines) == 1 else f"add the missing imports to {what}"


def _other_glob(file: PythonFile) -> Iterator[Edit]:
    """Yield the edit that imports the function glob instead of the module, or the reverse, as the file uses it."""
    for node in file.imports:
        if [alias.name for alias in node.names] != ["glob"] or node.names[0].asname:
            continue
        if isinstance(node, ast.Import) and _CALL.search(file.text):
            yield file.replaced(node, "from glob import glob")
        elif isinstance(node, ast.ImportFrom) and _MODULE_CALL.search(file.text):
            yield file.replaced(node, "import glob")
