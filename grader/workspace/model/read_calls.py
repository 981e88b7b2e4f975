"""The calls by which code opens topics and services and declares parameters, known or not.

They are counted in the texts of all files: code that is not understood is silent otherwise.
"""

import re
from collections import Counter
from collections.abc import Iterator

from grader.base.patterns import on_use
from grader.base.records import Named
from grader.ros.package.package import Package
from grader.workspace.model.text_files import CODE_ENDINGS, MAX_YAML, read_paths
from grader.workspace.model.workspace import Workspace

_COMMENT_OF_CPP = on_use(rb"//[^\n]*|/\*.*?(?:\*/|\Z)", re.DOTALL)
_COMMENT_OF_PYTHON = on_use(rb"#[^\n]*")
_CALL = on_use(
    rb"(?<!def )\b(?:create_(?:lifecycle_)?(?:publisher|subscription|service|client|server)"
    rb"|declare_parameters?|Action(?:Server|Client))\s*[(<]"
)
_MAX_READ = 16 * 1024 * 1024  # bytes of all files


class ReadCalls(Named):
    """How many calls there are, and of how many the node and the name are known."""

    known: int
    total: int
    # The files with the others, and how many each has, most first.
    unread_files: tuple[tuple[str, int], ...]


def read_calls(workspace: Workspace) -> ReadCalls:
    """Return how many calls of the code in a workspace are known."""
    left = _MAX_READ
    total = 0
    unread = []
    for package in workspace.packages:
        known_in_files = Counter(path for path, _ in set(_known_places(workspace, package)))
        code = [path for path in package.tree.files if path.endswith(CODE_ENDINGS)]
        for path in read_paths(package, code):
            data = package.tree.read(path, min(left, MAX_YAML)) or b""
            left -= len(data)
            comment = _COMMENT_OF_PYTHON if path.endswith(".py") else _COMMENT_OF_CPP
            count = len(_CALL.findall(comment.sub(b"", data)))
            total += count
            unknown = count - known_in_files[package.path(path)]
            if unknown > 0:
                unread.append((package.path(path), unknown))
    unread.sort(key=lambda file: (-file[1], file[0]))
    return ReadCalls(total - sum(count for _, count in unread), total, tuple(unread))


def _known_places(workspace: Workspace, package: Package) -> Iterator[tuple[str, int]]:
    """Yield the file and line of each call of a node of a package whose name is known."""
    for node in workspace.code.by_package[package.name].nodes:
        for endpoint in node.endpoints:
            if not endpoint.is_computed:
                yield endpoint.location.path, endpoint.location.line
        for parameter in node.parameters:
            if parameter.is_declared and parameter.name is not None:
                yield parameter.location.path, parameter.location.line
