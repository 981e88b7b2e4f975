"""What an inspection does not show: problems that a comment, a setting or an option ignores."""

import os
from bisect import bisect_left
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from fnmatch import fnmatchcase
from pathlib import Path

from grader.app.settings import Settings
from grader.base.ignore_comments import COMMENTED, MARK, IgnoreComment, read_ignore_comments
from grader.base.names import last_part
from grader.base.problems import Problem
from grader.base.records import Named
from grader.files.reading import URDF_LIMIT
from grader.files.tree import Tree
from grader.report.inspection import Inspection

_ROBOT = ("URDF", "XACRO")  # the beginnings of the codes of a robot


class Selection(Named):
    """Which problems are shown: of several codes that match a problem the longest one decides."""

    select: Sequence[str] = ()  # from --select; without any all are selected
    ignore: Sequence[str] = ()  # from --ignore
    settings: Settings = Settings()
    folder: Path = Path()  # that the paths of problems begin in

    def is_selected(self, problem: Problem) -> bool:
        """Return whether --select names a problem."""
        return not self.select or _longest(self.select, problem) > 0

    def is_ignored(self, problem: Problem) -> bool:
        """Return whether an option or a setting ignores a problem."""
        codes = [*self.ignore, *self.settings.ignore]
        if self.settings.file and self.settings.per_file_ignores:
            top = self.settings.file.parent
            path = Path(os.path.relpath(self.folder / problem.location.path, top)).as_posix()
            for pattern, its_codes in self.settings.per_file_ignores.items():
                if _matches(path, pattern):
                    codes += its_codes
        length = _longest(codes, problem)
        return length > 0 and length >= _longest(self.select, problem)


def _longest(codes: Iterable[str], problem: Problem) -> int:
    return max((len(code) for code in codes if problem.is_meant_by(code)), default=0)


def _matches(path: str, pattern: str) -> bool:
    """Return whether a pattern is that of a path.

    It may be of the name of the file, or of a folder around it; * stands for slashes as well.
    """
    name = last_part(path)
    folder = pattern.rstrip("/") + "/*"
    return any(map(fnmatchcase, (path, name, path), (pattern, pattern, folder)))


def without_ignored(
    inspection: Inspection, tree: Tree, files: Sequence[str], selection: Selection
) -> Inspection:
    """Return an inspection without the problems that are ignored, which are counted.

    It has the comments that ignore nothing.

    Args:
        inspection: The inspection of everything.
        tree: The files.
        files: The paths of those whose comments count.
        selection: What options and settings say.
    """
    commented, useless = _by_comments(inspection, list(_comments(tree, files)))
    shown = set()
    count = 0
    for problem in dict.fromkeys((*inspection.problems, *useless)):
        if problem in commented or selection.is_ignored(problem):
            count += selection.is_selected(problem)
        elif selection.is_selected(problem):
            shown.add(problem)
    robots = [
        replace(robot, hidden=frozenset(robot.problems) - shown) for robot in inspection.robots
    ]
    others = [problem for problem in (*inspection.package_problems, *useless) if problem in shown]
    file = selection.settings.file
    return replace(
        inspection,
        robots=tuple(robots),
        package_problems=tuple(others),
        ignored=count,
        besides=inspection.besides if not file else (*inspection.besides, file),
    )


def _comments(tree: Tree, files: Iterable[str]) -> Iterator[IgnoreComment]:
    for path in files:
        if path.endswith(COMMENTED):
            data = tree.read(path, URDF_LIMIT)
            if data is not None and MARK in data:
                yield from read_ignore_comments(path, data.decode("utf-8", "replace"))


def _by_comments(
    inspection: Inspection, comments: Sequence[IgnoreComment]
) -> tuple[set[Problem], list[Problem]]:
    """Return the problems that comments ignore, and those that are comments which ignore nothing.

    Of one robot only the codes of robots in its own file are judged: others may need the rest.
    """
    ignored = set()
    useless = []
    problems = inspection.problems
    by_path: dict[str, list[tuple[int, int]]] = {}  # their lines, in order, and their numbers
    for number, problem in enumerate(problems):
        for where in filter(None, (problem.location, problem.around)):
            by_path.setdefault(where.path, []).append((where.line, number))
    for places in by_path.values():
        places.sort()
    for comment in comments:
        used = set()
        places = by_path.get(comment.location.path, [])
        first = bisect_left(places, (comment.location.line,))
        for _, number in places[first : bisect_left(places, (comment.last + 1,))]:
            codes = [code for code in comment.codes if problems[number].is_meant_by(code)]
            used.update(codes)
            if codes:
                ignored.add(problems[number])
        left = [code for code in comment.codes if code not in used]
        if not inspection.extent:
            if comment.location.path != inspection.path:
                continue
            left = [code for code in left if code.startswith(_ROBOT)]
        if left or not comment.codes:
            useless.append(comment.useless_problem(left))
    return ignored, useless
