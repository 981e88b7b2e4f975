"""The folders that the usual entries of a CMakeLists.txt installs as they are. CMake is never run.

`install(DIRECTORY launch meshes DESTINATION share/${PROJECT_NAME})` counts outside of conditions, loops and functions,
and so does `install(DIRECTORY meshes/ DESTINATION share/${PROJECT_NAME}/meshes)`; what else a file installs is not
evaluated.
"""

import re

from grader.errors import InputError
from grader.files.tree import Tree

_MAX_SIZE = 128 * 1024  # bytes
_COMMENT = re.compile(r"#\[(=*)\[.*?(?:\]\1\]|\Z)|#[^\n]*", re.DOTALL)
_BRACKET = re.compile(r"\[=*\[")  # an argument that may hold anything
_ENTRY = re.compile(r"^[ \t]*+install\s*+\(\s*+DIRECTORY\s([^()]*+)\)", re.IGNORECASE | re.MULTILINE)
_SHARE = "share/${PROJECT_NAME}/"
_BLOCK = re.compile(r"\b(end)?(?:if|foreach|while|function|macro|block)\s*\(|\breturn\s*\(", re.IGNORECASE)


def installs(tree: Tree, name: str, path: str) -> bool:
    """Return whether a build of a package certainly installs a file at the same path in the package's share folder."""
    try:
        text = _COMMENT.sub("", tree.files["CMakeLists.txt"].read(_MAX_SIZE).decode("utf-8", "replace"))
    except InputError:
        return False
    if _BRACKET.search(text) or not re.search(rf"\bproject\s*\(\s*{re.escape(name)}[\s)]", text, re.IGNORECASE):
        return False
    folders: set[str] = set()
    position = depth = 0
    for entry in _ENTRY.finditer(text):
        depth += sum(-1 if found[1] else 1 for found in _BLOCK.finditer(text, position, entry.start()))  # or a return()
        position = entry.end()
        words = entry[1].replace('"', "").split()
        if not depth and words[-2:-1] == ["DESTINATION"]:
            target = f"{words[-1].rstrip('/')}/"
            folders.update(
                it.strip("/") for it in words[:-2] if target == (_SHARE + it if it.endswith("/") else _SHARE)
            )
    return path in tree.files and path.partition("/")[0] in folders
