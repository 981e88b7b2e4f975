"""What git ignores in a folder, by its .gitignore files and those above it in the repository.

https://git-scm.com/docs/gitignore
"""

import os
import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from fnmatch import translate
from pathlib import Path

from grader.base.errors import InputError
from grader.base.grouping import Strings
from grader.base.patterns import on_use
from grader.base.records import Named
from grader.files.reading import read_capped
from grader.files.tree import Tree

_NAME = ".gitignore"
_MAX_SIZE = 64 * 1024  # bytes of such a file; a larger one is not read
_ANY = "**"  # any number of folders
_ESCAPED = on_use(r"\\(.)")


class _IgnoreRule(Named):
    """A line of a .gitignore: a pattern for each folder on the way, and for the name."""

    depth: int  # of the folder of the .gitignore
    parts: tuple[re.Pattern[str] | None, ...]  # None for any number of folders
    is_negated: bool
    is_for_folders: bool

    def matches(self, path: Sequence[str], *, is_folder: bool) -> bool:
        """Return whether it matches a path, whose folders are those of the .gitignore and more."""
        if self.is_for_folders and not is_folder:
            return False
        if len(self.parts) == 2 and self.parts[0] is None and self.parts[1] is not None:
            return self.parts[1].match(path[-1]) is not None
        return self._matches_folders(path[self.depth :])

    def _matches_folders(self, path: Sequence[str]) -> bool:
        at = part = 0
        again = None  # after the last `**`: its part, and where it is tried
        while at < len(path):
            pattern = self.parts[part] if part < len(self.parts) else re.compile("(?!)")
            if pattern is None:
                again = part + 1, at
                part += 1
            elif pattern.match(path[at]):
                part = part + 1
                at = at + 1
            elif again is not None:
                again = again[0], again[1] + 1
                part, at = again
            else:
                return False
        return part == len(self.parts)


def without_git_ignored(tree: Tree, folder: Path) -> Tree:
    """Return the files of a folder without those that git ignores, which are there and not seen.

    Tracked files that a pattern matches are ignored as well: the index of git is not read.
    """
    start, above = _rules_above(folder)
    rules = {"": (*above, *_read_rules(folder, len(start)))}
    ignored = set()
    for path in sorted({*tree.folders, *tree.files}):
        outer = path.rpartition("/")[0]
        if outer not in rules:  # it is in an ignored folder
            continue
        is_folder = path in tree.folders
        if _is_ignored((*start, *path.split("/")), rules[outer], is_folder=is_folder):
            ignored.add(path)
        elif is_folder:
            rules[path] = (
                *rules[outer],
                *_read_rules(folder / path, len(start) + path.count("/") + 1),
            )
    if not ignored:
        return tree

    def is_kept(path: str) -> bool:
        return path.rstrip("/") not in ignored and path.rstrip("/").rpartition("/")[0] in rules

    return replace(tree.only(is_kept), unseen=tree.unseen | ignored)


def _is_ignored(path: Sequence[str], rules: Sequence[_IgnoreRule], *, is_folder: bool) -> bool:
    """Return whether the last rule that matches a path ignores it."""
    for rule in reversed(rules):
        if rule.matches(path, is_folder=is_folder):
            return not rule.is_negated
    return False


def _rules_above(folder: Path) -> tuple[Strings, tuple[_IgnoreRule, ...]]:
    """Return the folders from the root of the repository down to a folder, and the rules there.

    Returns none where git ignores the folder itself.
    """
    real = Path(os.path.realpath(folder))
    root = next((above for above in (real, *real.parents) if (above / ".git").exists()), real)
    names = real.relative_to(root).parts
    rules: tuple[_IgnoreRule, ...] = ()
    for depth in range(len(names)):
        rules += tuple(_read_rules(root.joinpath(*names[:depth]), depth))
        if _is_ignored(names[: depth + 1], rules, is_folder=True):
            return names, ()
    return names, rules


def _read_rules(folder: Path, depth: int) -> Iterator[_IgnoreRule]:
    """Yield the rules of the .gitignore in a folder, which is so many folders below the root."""
    if not (folder / _NAME).is_file() or (folder / _NAME).is_symlink():
        return
    try:
        text = read_capped(folder / _NAME, _MAX_SIZE).decode("utf-8", "surrogateescape")
    except InputError:
        return
    for line in text.removeprefix("\ufeff").split("\n"):
        rule = _rule(line.removesuffix("\r"), depth)
        if rule:
            yield rule


def _rule(line: str, depth: int) -> _IgnoreRule | None:
    """Return the rule of a line; None for a comment, and for a pattern that matches nothing."""
    pattern = re.sub(r"(?:(?<![\\ ])|(?<=\\ )) ++$", "", line)
    is_negated = pattern.startswith("!")
    pattern = pattern.removeprefix("!")
    if pattern.strip("/") == "" or line.startswith("#") or re.search(r"(?<!\\)(\\\\)*\\$", pattern):
        return None
    is_for_folders = pattern.endswith("/")
    names = pattern.removesuffix("/").split("/")
    if len(names) == 1:
        names.insert(0, _ANY)
    elif names[0] == "":
        del names[0]
    if names[-1] == _ANY:  # what is in a folder, not the folder
        names.append("*")
    parts = [None if name == _ANY else _pattern(name) for name in names]
    return _IgnoreRule(depth, tuple(parts), is_negated, is_for_folders)


def _pattern(name: str) -> re.Pattern[str]:
    """Return the pattern of a name, in which a backslash stands before a plain character."""
    text = _ESCAPED.sub(lambda match: f"[{match[1]}]" if match[1] in "*?[" else match[1], name)
    return re.compile(translate(text.replace("[^", "[!")))
