"""The kinds of problems of names: one for each family, one for similar names. docs/examples/ref.toml explains each."""

from collections.abc import Mapping
from functools import partial

from grader.problems import Kind, Problem, kinds_in
from grader.workspace.names import Agreement, Family

_error = partial(Kind, severity="error", effect="other")
_warning = partial(Kind, severity="warning", effect="other")

NO_FILE = _error("REF001", "File that a build does not install")
NO_FRAME = _error("REF002", "Frame, link or joint that does not exist")
NO_CONTROLLER = _error("REF003", "Controller or interface that does not exist")
NO_PARAMETER = _error("REF004", "Parameters that no node gets, or that a node does not have")
NO_ARGUMENT = _error("REF005", "Argument that nothing declares")
NO_PROGRAM = _error("REF006", "Program, entry point or node that does not exist")
NO_TOPIC = _error("REF007", "Topic with another name, type or quality of service")
NO_DEPENDENCY = _warning("REF008", "Package that package.xml does not declare")
SIMILAR = _warning("REF009", "Name that is similar to one that is defined")

_OF_FAMILY: Mapping[Family, Kind] = {
    "files": NO_FILE, "frames": NO_FRAME, "controllers": NO_CONTROLLER, "parameters": NO_PARAMETER,
    "arguments": NO_ARGUMENT, "programs": NO_PROGRAM, "topics": NO_TOPIC, "dependencies": NO_DEPENDENCY,
}  # fmt: skip
NAME_CATALOGUE = kinds_in(globals().values())


def name_problems(found: Agreement) -> tuple[Problem, ...]:
    """Return what does not agree as problems, in the order of files and lines."""
    return tuple(
        Problem(_OF_FAMILY[it.family] if it.is_sure else SIMILAR, it.message, it.location, it.family)
        for it in found.mismatches
    )
