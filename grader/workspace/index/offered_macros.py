"""The parameters of the macros of a workspace, as their files write them."""

import re
from collections.abc import Iterator

from grader.workspace.opening.opened import OpenedWorkspace

_MACRO = re.compile(r"<xacro:macro\s(?P<attributes>[^<>]*+)>")
_NAME = re.compile(r"\bname\s*=\s*[\"'](?:xacro:)?(?P<value>[^\"'<]*)[\"']")
_PARAMETERS = re.compile(r"\bparams\s*=\s*[\"'](?P<value>[^\"<]*)[\"']")
# A default may hold spaces in quotes, brackets or an expression.
_PARAMETER = re.compile(
    r"(?:[^\s'\"\[{(]|'[^']*+'?|\"[^\"]*+\"?|\[[^\]]*+\]?|\{[^}]*+\}?|\([^)]*+\)?)+"
)
_ENDING = ".xacro"


def parameters_of_macro(opened: OpenedWorkspace, name: str) -> Iterator[tuple[str, list[str]]]:
    """Yield the file of each macro of a name, and its parameters as they are written."""
    for path in sorted(opened.whole_tree.files):
        source = opened.source(path) if path.endswith(_ENDING) else None
        for macro in _MACRO.finditer(source.text if source is not None else ""):
            written = _NAME.search(macro["attributes"])
            if written is not None and written["value"] == name:
                parameters = _PARAMETERS.search(macro["attributes"])
                yield path, _PARAMETER.findall(parameters["value"]) if parameters else []
