"""Files that a launch file looks for in the wrong place: other folders, misspelt names, paths of one machine."""

import ast
import posixpath
import re
from collections.abc import Iterator, Sequence

from grader.edits import Proposal
from grader.names import closest
from grader.package.edits.launch_nodes import fitting, node_at
from grader.package.edits.paths import moved
from grader.package.edits.python_file import PythonFile, keyword
from grader.package.edits.task import Task, proposal
from grader.package.launch.model import Launch, Reference
from grader.package.launch.places import HOME, PREFIX, SHARE, WORKING_FOLDER
from grader.source import Edit, Source

_WHAT = "the launch file"
_ENDINGS = {"urdf": (".urdf", ".xacro"), "rviz": (".rviz",), "include": (".launch.py", ".launch.xml", ".launch.yaml")}
_KEYWORDS = {"urdf": "parameters", "rviz": "arguments"}
_MAX_REFERENCES = 8
_MAX_EDITS = 3  # of one path
_SHARE_FUNCTION = "get_package_share_directory"
_EXPANDUSER = re.compile(r"(?:os\.path\.)?expanduser\(\s*$")


def found(task: Task, launch: Launch, source: Source, like: PythonFile | None) -> Iterator[Proposal]:
    """Yield edits with which a launch file finds its files: of all together, then of one path each."""
    file = PythonFile(source)
    ways: list[Sequence[list[Edit]]] = []
    for named in launch.references[:_MAX_REFERENCES]:
        if named.path is None and named.reason:
            ways.append(_as_reference(file, like, named))
        elif named.path is not None and not _is_found(task, named.path):
            ways.append(_found_at(task, file, named))
    ways = [way[:_MAX_EDITS] for way in ways if way]
    cause, action = f"a wrong path in {_WHAT}", f"name the place where a build installs the file in {_WHAT}"
    if len(ways) > 1:
        together = [edit for way in ways for edit in way[0]]
        yield proposal(
            together, f"wrong paths in {_WHAT}", f"name the places where a build installs the files in {_WHAT}"
        )
    for way in ways:
        for edits in way:
            yield proposal(edits, cause, action)


def _is_found(task: Task, path: str) -> bool:
    return posixpath.normpath(path).removeprefix(f"{PREFIX}/") in task.package.installed


def _found_at(task: Task, file: PythonFile, named: Reference) -> list[list[Edit]]:
    """Return the edits with which a path becomes the one that the file is installed at."""
    actual = named.path or ""
    target = _target(task, named)
    if target is None:
        return []
    share = f"{SHARE}/{task.package.name}"
    source, wanted = file.source, f"{share}/{target}"
    first = [*_renamed(task, named, target), *_installed_elsewhere(task, actual, target)]
    if actual.startswith(PREFIX):
        return [*first, *([edit] for edit in moved(source, actual, wanted, named.location.line))]
    absolute = [[edit] for edit in moved(source, actual, target, named.location.line)] if actual.startswith("/") else []
    if not source.path.endswith(".py"):
        root = f"$(find-pkg-share {task.package.name})/"
        return [
            *absolute[:1],
            *(
                [edit]
                for edit in moved(source, actual.removeprefix(f"{WORKING_FOLDER}/"), root + target, named.location.line)
            ),
        ]
    return [*_of_one_machine(task, file, actual, target), *absolute]


def _renamed(task: Task, named: Reference, target: str) -> list[list[Edit]]:
    """Return the edit that gives a file the name by which the launch file looks for it, if the reference has a file of this name."""
    name = posixpath.basename(named.path or "")
    path = task.package.installed.get(f"share/{task.package.name}/{target}", "")
    names = {posixpath.basename(it) for it in task.reference.tree.files} if task.reference is not None else set()
    is_meant = name in names and name not in map(posixpath.basename, task.files) and path
    return [[task.renamed(path, posixpath.join(posixpath.dirname(path), name))]] if is_meant else []


def _installed_elsewhere(task: Task, actual: str, target: str) -> list[list[Edit]]:
    """Return the edits of setup.py that install a file where the launch file looks: in a folder of the name that it has in the package."""
    share = f"share/{task.package.name}/"
    source = task.package.installed.get(share + target, "")
    looked, installed = actual.removeprefix(f"{PREFIX}/"), share + target
    folder = posixpath.dirname(source)
    is_misspelt = posixpath.dirname(target) and posixpath.dirname(looked) == share + folder != posixpath.dirname(
        installed
    )
    return [[edit] for edit in moved(task.setup.source, installed, looked)] if is_misspelt and task.setup else []


def _target(task: Task, named: Reference) -> str | None:
    """Return where a build installs the file that is meant, below the package's share folder."""
    share = f"share/{task.package.name}/"
    endings = _ENDINGS[named.purpose]
    targets = [
        path.removeprefix(share)
        for path in task.package.installed
        if path.startswith(share) and path.lower().endswith(endings)
    ]
    names = {posixpath.basename(path): path for path in reversed(targets)}
    name = posixpath.basename(named.path or "")
    similar = name if name in names else closest(name, names) or next(iter(names), None) if names else None
    return names[similar] if similar else None


def _of_one_machine(task: Task, file: PythonFile, actual: str, target: str) -> list[list[Edit]]:
    """Return the edits that replace a path of one machine, or one relative to the working folder, by the package's share folder."""
    share = f"{_SHARE_FUNCTION}({task.package.name!r})"
    found: list[list[Edit]] = []
    for literal in file.literals:
        text = literal.text.rstrip("/")
        for path in (text, text.replace("~", HOME, 1), f"{WORKING_FOLDER}/{text}"):
            if not text or not (actual == path or actual.startswith(f"{path}/")):
                continue
            rest = actual.removeprefix(path).strip("/")
            start, end = _with_call(file, literal.outer_start, literal.outer_end)
            new = share if rest else f"os.path.join({share}, {target!r})"
            names = [_SHARE_FUNCTION, *([] if rest else ["os"])]
            others = moved(file.source, rest, target)[:1] if rest and rest != target else []
            if rest in ("", target) or others:
                found.append([*file.with_imports(names), file.source.edit(start, end, new), *others])
    return found


def _with_call(file: PythonFile, start: int, end: int) -> tuple[int, int]:
    """Return the span of a string with the call of expanduser around it."""
    call = _EXPANDUSER.search(file.text[:start])
    return (call.start(), file.text.find(")", end) + 1) if call is not None else (start, end)


def _as_reference(file: PythonFile, like: PythonFile | None, named: Reference) -> list[list[Edit]]:
    """Return the edits that give a node the arguments or parameters that it has in the reference."""
    name = _KEYWORDS.get(named.purpose, "")
    call = _node_around(file, named)
    program = _program(call) if call is not None else None
    for other in like.calls("Node") if like is not None and program else ():
        wanted = keyword(other, name)
        if like is None or call is None or wanted is None or _program(other) != program:
            continue
        codes = [fitting(like, wanted.value, bound) for bound in (file.bound, ())]
        return [[*file.with_imports(names), _with_keyword(file, call, name, code)] for code, names in codes]
    return []


def _with_keyword(file: PythonFile, call: ast.Call, name: str, code: str) -> Edit:
    """Return the edit that sets a keyword argument of a call, or adds it."""
    own = keyword(call, name)
    if own is not None:
        return file.replaced(own.value, code)
    if not call.keywords:
        end = file.span(call)[1] - 1
        return file.source.edit(end, end, f"{name}={code}")
    start, end = file.span(call.keywords[-1])
    line = file.text[file.text.rfind("\n", 0, start) + 1 : start]
    space = f"{file.newline}{line}" if not line.strip() else " "
    return file.source.edit(end, end, f",{space}{name}={code}")


def _node_around(file: PythonFile, named: Reference) -> ast.Call | None:
    """Return the call of Node that a path is given to."""
    call = node_at(file, named.location)
    if call is not None and call in file.calls("Node"):
        return call
    at = file.source.offset(named.location.line, named.location.column)
    around = [node for node in file.calls("Node") if file.span(node)[0] <= at < file.span(node)[1]]
    programs = {"urdf": "robot_state_publisher", "rviz": "rviz2"}
    others = [node for node in file.calls("Node") if _program(node) == programs.get(named.purpose)]
    return next(iter([*around, *others]), None)


def _program(call: ast.Call) -> str | None:
    given = keyword(call, "executable")
    return (
        given.value.value
        if given is not None and isinstance(given.value, ast.Constant) and isinstance(given.value.value, str)
        else None
    )
