"""New entries of data_files in setup.py, written as the lab's handout does, and the imports that they need."""

import ast
import posixpath
from collections.abc import Mapping, Sequence
from fnmatch import fnmatch

from grader.package.edits.python_file import PythonFile, keyword
from grader.package.edits.task import Task
from grader.package.launch.places import SHARE
from grader.source import Edit

_LAUNCH_PATTERN = "*launch.[pxy][yma]*"


def new_entries(task: Task, file: PythonFile, missing: Mapping[str, Sequence[str]]) -> list[Edit]:
    """Return the edits that add entries for files, and the imports that they need."""
    new = [_entry(task, file, kind, paths[0]) for kind, paths in missing.items() if paths]
    if not new:
        return []
    listed = data_files(file)
    if listed is None:
        inserted = _new_list(file, new)
    elif listed.elts:
        last = listed.elts[-1]
        start, end = file.span(last)
        indent = file.text[file.text.rfind("\n", 0, start) + 1 : start]
        indent = indent if not indent.strip() else " " * 8
        text = "".join(f",{file.newline}{indent}{entry}" for entry in new)
        inserted = [file.source.edit(end, end, text)]
    else:
        inserted = [file.replaced(listed, _list_of(file, new))]
    return [*file.with_imports(["os", "glob"]), *inserted] if inserted else []


def _list_of(file: PythonFile, new: Sequence[str]) -> str:
    return "".join(["[", *(f"{file.newline}        {entry}," for entry in new), f"{file.newline}    ]"])


def _new_list(file: PythonFile, new: Sequence[str]) -> list[Edit]:
    for call in file.calls("setup"):
        for argument in [keyword(call, "packages"), *call.keywords[-1:]]:
            if argument is not None:
                end = file.span(argument)[1]
                return [file.source.edit(end, end, f",{file.newline}    data_files={_list_of(file, new)}")]
    return []


def data_files(file: PythonFile) -> ast.List | None:
    """Return the list of data_files, also where it is assigned to a name."""
    for call in file.calls("setup"):
        given = keyword(call, "data_files")
        value = given.value if given is not None else None
        if isinstance(value, ast.Name):
            assigned = (node for node in file.nodes if isinstance(node, ast.Assign))
            value = next(
                (it.value for it in assigned if any(getattr(target, "id", "") == value.id for target in it.targets)),
                None,
            )
        if isinstance(value, ast.List):
            return value
    return None


def _entry(task: Task, file: PythonFile, kind: str, path: str) -> str:
    """Return the entry for a file as the lab's handout writes it: for all files of its folder."""
    name = "package_name" if "package_name" in file.bound else repr(task.package.name)
    inside = below_share(task, path)
    target = "".join(f", {part!r}" for part in inside.split("/") if part)
    folder, base = posixpath.split(path)
    function = (
        "glob.glob"
        if any(isinstance(node, ast.Import) and node.names[0].name == "glob" for node in file.imports)
        else "glob"
    )
    if not folder:
        source = f"[{path!r}]"
    elif kind == "launch" and fnmatch(base, _LAUNCH_PATTERN):
        source = f"{function}(os.path.join({folder!r}, {_LAUNCH_PATTERN!r}))"
    else:
        has_folders = any(posixpath.dirname(it) == folder for it in task.package.tree.folders)
        pattern = f"{folder}/*{posixpath.splitext(base)[1] if has_folders else ''}"
        source = f"{function}({pattern!r})"
    return f"(os.path.join('share', {name}{target}), {source})"


def below_share(task: Task, path: str) -> str:
    """Return the folder below share/<package> that a file belongs in: where the launch file looks for it, else as in the reference."""
    package, name = task.package, posixpath.basename(path)
    share = f"{SHARE}/{package.name}/"
    for launch in map(package.launch, package.launch_files[:1]):
        for named in launch.references:
            if named.path is not None and named.path.startswith(share) and posixpath.basename(named.path) == name:
                return posixpath.dirname(named.path.removeprefix(share))
    installed = task.reference.installed if task.reference is not None else {}
    ending = posixpath.splitext(name)[1]
    like = next(
        (
            target
            for target, source in installed.items()
            if target.startswith("share/") and source.endswith(ending) and source.count("/") == 1
        ),
        None,
    )
    is_launch = path in package.launch_files
    if is_launch or like is None:
        return "launch" if is_launch else ""
    return "/".join(posixpath.dirname(like).split("/")[2:])
