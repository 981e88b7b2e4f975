"""Edits of a launch file with which it runs xacro on the robot that it reads."""

import ast
import re
from collections.abc import Iterator

from grader.package.edits.python_file import PythonFile, called
from grader.source import Edits, Source

_CAT = re.compile(r"\bcat(?=\s)")


def with_xacro(source: Source) -> Iterator[Edits]:
    """Yield the edits of a launch file that read the robot with xacro instead of open or cat."""
    for found in _CAT.finditer(source.text):
        yield (source.edit(found.start(), found.end(), "xacro"),)
    file = PythonFile(source)
    for call in [*file.calls("read"), *file.calls("read_text")] if source.path.endswith(".py") else ():
        owner = file.meant(call.func.value) if isinstance(call.func, ast.Attribute) else call
        owner = file.values.get(owner.id, owner) if isinstance(owner, ast.Name) else owner
        is_open = isinstance(owner, ast.Call) and called(owner) == "open" and owner.args
        if is_open or called(call) == "read_text":
            path = owner.args[0] if isinstance(owner, ast.Call) and is_open else owner
            new = f"xacro.process_file({file.segment(path)}).toxml()"
            yield (*file.with_imports(["xacro"]), file.replaced(call, new))
