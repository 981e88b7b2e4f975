"""Entries of data_files in setup.py: those that are missing, and those that install nothing, stop the build or install elsewhere."""

import posixpath
from collections import Counter
from collections.abc import Iterator, Sequence
from fnmatch import fnmatch

from grader.edits import Proposal
from grader.names import closest
from grader.package.edits.new_entries import below_share, data_files, new_entries
from grader.package.edits.paths import moved
from grader.package.edits.python_file import PythonFile
from grader.package.edits.task import Task, proposal
from grader.package.setup_py import Setup
from grader.source import Edit

_WHAT = "setup.py"
_ENDINGS = {"urdf": (".urdf", ".xacro"), "rviz": (".rviz",)}
_MAX_EDITS = 3  # of one entry
_MAX_ENTRIES = 8  # that are wrong in the same way


def files_of(task: Task, kind: str, name: str) -> list[str]:
    """Return the files of a kind that a build should install: the one of this name, else all."""
    if kind == "launch":
        path = task.package.launch_file(name)
        return [path] if path is not None else []
    paths = [path for path in task.files if path.lower().endswith(_ENDINGS[kind])]
    return [path for path in paths if posixpath.basename(path) == name] or paths


def entries(
    task: Task, file: PythonFile, setup: Setup, files: Sequence[str], missing: dict[str, Sequence[str]]
) -> Iterator[Proposal]:
    """Yield edits of data_files with which a build installs one of these files; `missing` are those of other kinds, too."""
    yield from _stops(task, file, setup)
    yield from _patterns(task, file, setup, files)
    yield from _targets(task, file, setup, files)
    yield from _second_entries(file, setup, files)
    for several in (missing, {kind: paths for kind, paths in missing.items() if list(paths) == list(files)}):
        edits = new_entries(task, file, several)
        count = "entries" if len(several) > 1 else "entry"
        if edits:
            yield proposal(
                edits, f"missing {count} of data_files in {_WHAT}", f"add the missing {count} of data_files in {_WHAT}"
            )


def _stops(task: Task, file: PythonFile, setup: Setup) -> Iterator[Proposal]:
    """Yield edits of what stops the build: a folder, a file that does not exist, a text instead of a list."""
    for stop in setup.stops[:_MAX_ENTRIES]:
        if stop.path.rstrip("/") in task.package.tree.folders:
            for edit in _narrower(task, file, stop.path, stop.at.line):
                yield proposal(
                    [edit],
                    f"a pattern in {_WHAT} that matches a folder",
                    f"let the pattern in {_WHAT} match the files only",
                )
        elif stop.path in task.files:
            for literal in file.literals:
                if literal.text == stop.path:
                    edit = file.source.edit(
                        literal.outer_start,
                        literal.outer_end,
                        f"[{file.text[literal.outer_start : literal.outer_end]}]",
                    )
                    yield proposal(
                        [edit], f"a file instead of a list of files in {_WHAT}", f"write the files as a list in {_WHAT}"
                    )
        elif stop.path:
            similar = closest(stop.path, task.files) or _same_name(task, stop.path)
            for edit in moved(file.source, stop.path, similar, stop.at.line)[:_MAX_EDITS] if similar else ():
                yield proposal([edit], f"a path in {_WHAT} without a file", f"name the file in {_WHAT} that exists")
                if posixpath.dirname(stop.path) == posixpath.dirname(similar or ""):
                    edits = [task.renamed(similar or "", stop.path)]
                    yield proposal(edits, f"a misspelt file name that {_WHAT} names", "rename the file")
            if stop.path == f"resource/{task.package.name}":
                edits = [Edit(task.package.path(stop.path), 1, 1, "", "")]
                yield proposal(
                    edits, "a missing file of the resource index", "create the empty file of the resource index"
                )


def _same_name(task: Task, path: str) -> str | None:
    name = posixpath.basename(path)
    return next((other for other in task.files if posixpath.basename(other) == name), None)


def _narrower(task: Task, file: PythonFile, folder: str, line: int) -> list[Edit]:
    """Return edits of a pattern that matches a folder, so that it matches the files beside it only."""
    above = posixpath.dirname(folder)
    beside = [posixpath.splitext(path)[1] for path in task.files if posixpath.dirname(path) == above]
    endings = [ending for ending, _ in Counter(filter(None, beside)).most_common(1)]
    pattern = posixpath.join(above, "*")
    edits = moved(file.source, folder, posixpath.join(folder, "*"), line)  # the folder itself is the pattern
    edits += [edit for ending in endings for edit in moved(file.source, pattern, pattern + ending, line)]
    return edits[:_MAX_EDITS]


def _patterns(task: Task, file: PythonFile, setup: Setup, files: Sequence[str]) -> Iterator[Proposal]:
    """Yield edits of patterns that match no file."""
    folders = list(dict.fromkeys(posixpath.dirname(path) for path in files))
    endings = list(dict.fromkeys(_ending(path) for path in files))
    for empty in setup.empty[:_MAX_ENTRIES]:
        folder, _, name = empty.pattern.replace("\\", "/").rpartition("/")
        yield from _renamed_folders(task, folder, folders)
        near = [closest(folder, task.package.tree.folders)] if folder else []
        wanted = [f"{it}/{name}" for it in dict.fromkeys([*near, *folders]) if it]
        wanted += [posixpath.join(it, f"*{ending}") for it in folders for ending in endings]
        fitting = (pattern for pattern in wanted if any(fnmatch(path, pattern) for path in files))
        for pattern in dict.fromkeys(fitting):
            for edit in moved(file.source, empty.pattern, pattern, empty.at.line)[:2]:
                yield proposal(
                    [edit], f"a pattern in {_WHAT} that matches no file", f"let the pattern in {_WHAT} match the files"
                )


def _renamed_folders(task: Task, folder: str, others: Sequence[str]) -> Iterator[Proposal]:
    """Yield edits that rename a misspelt folder to the one that setup.py names, if the reference has it as well."""
    if task.reference is None or folder not in task.reference.tree.folders or folder in task.package.tree.folders:
        return
    for other in others:
        if other.lower() != folder.lower() and closest(other, [folder]):
            paths = [path for path in task.files if posixpath.dirname(path) == other]
            edits = [task.renamed(path, f"{folder}/{posixpath.basename(path)}") for path in paths]
            yield proposal(edits, f"a misspelt folder {folder}", f"rename the folder to {folder}")


def _ending(path: str) -> str:
    name = posixpath.basename(path)
    return name[name.index(".launch") :] if ".launch" in name else posixpath.splitext(name)[1]


def _targets(task: Task, file: PythonFile, setup: Setup, files: Sequence[str]) -> Iterator[Proposal]:
    """Yield edits of the folder that files are installed in, where it is not below the package's share folder."""
    share = f"share/{task.package.name}"
    outside = [it for it in setup.copies if it.source in files and not it.target.startswith(f"{share}/")]
    for copy in outside[:_MAX_ENTRIES]:
        wanted = posixpath.join(share, below_share(task, copy.source), posixpath.basename(copy.source))
        for edit in moved(file.source, copy.target, wanted, copy.at.line)[:_MAX_EDITS]:
            yield proposal(
                [edit],
                f"a wrong folder of an entry of data_files in {_WHAT}",
                f"install the files below the package's share folder in {_WHAT}",
            )


def _second_entries(file: PythonFile, setup: Setup, files: Sequence[str]) -> Iterator[Proposal]:
    """Yield edits that remove one of several entries that install the same file."""
    lines = [copy.at.line for copy in setup.copies if copy.source in files]
    listed = data_files(file)
    if listed is None or len(lines) < 2:
        return
    for item in reversed(listed.elts):
        if any(item.lineno <= line <= (item.end_lineno or 0) for line in lines):
            start, end = file.span(item)
            end += file.text[end : end + 1] == ","
            start = file.text.rfind("\n", 0, start) + 1
            end = file.text.find("\n", end) + 1
            yield proposal(
                [file.source.edit(start, end, "")],
                f"two entries of data_files in {_WHAT} for one file",
                f"remove one of the two entries in {_WHAT}",
            )
