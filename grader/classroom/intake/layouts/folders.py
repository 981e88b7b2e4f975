"""The plain layout: each folder, archive or URDF is what one student or team has handed in, and is named after them.

Class repositories of GitHub are `<assignment>-<login>/`. A browser saves a second `alice.zip` as `alice (1).zip`, a later attempt;
a folder may hold nothing but attempts. Where two names differ in their ending only, a folder counts, then the endings in the
order of `names.ENDINGS`; the other one is left out, and named.
"""

from collections.abc import Callable, Iterable
from itertools import groupby
from typing import NamedTuple

from grader.classroom.intake.layouts.attempts import attempts_in, last_copy
from grader.classroom.intake.layouts.prefix import class_prefix, has_prefix
from grader.classroom.intake.layouts.shelf import LeftOut, unique
from grader.classroom.intake.listing import Children, Listing
from grader.classroom.intake.names import ending_of, without_copy
from grader.classroom.students import HandIn, Student
from grader.submission.files import printable_path
from grader.submission.tree import BUILT

_NO_SUBMISSION = "is not a folder, an archive or a URDF"
_BUILT = "is a folder of a build"


class _Special(NamedTuple):
    """What is known of a name beyond what it says itself."""

    key: str
    attempt: int = 1
    earlier: tuple[str, ...] = ()


class FolderShelf:
    """Hand-ins of which only the names are kept: the rest is worked out when it is asked for."""

    def __init__(self, listing: Listing, start: str, prefix: str, folders: frozenset[str]) -> None:
        self._listing = listing
        self._start = start
        self._prefix = prefix
        self._folders = folders  # those that have the name of an archive or URDF
        self._names: list[str] = []
        self._special: dict[str, _Special] = {}

    def __len__(self) -> int:
        return len(self._names)

    def student(self, index: int) -> Student:
        """Who has handed in, as the name says."""
        name = self._names[index]
        key, plain = self._key(name), self._plain(name)
        return Student(
            key,
            name=""
            if plain.isprintable() or not _is_text(plain)
            else plain,  # as a roster has it: the key is spelt out
            login=key if self._stem(name) != name.removesuffix(self._ending(name)) else "",
        )

    def hand_in(self, index: int) -> HandIn:
        """What was handed in; a folder is looked into for attempts."""
        name = self._names[index]
        path = self._start + name
        _, attempt, earlier = self._special.get(name) or (None, 1, ())
        earlier = tuple(self._start + each for each in earlier)
        found = None if self._ending(name) else attempts_in(self._listing, path)
        if found is not None:
            path, attempt, earlier = found.last, found.number, (*earlier, *found.earlier)
        return HandIn(self.student(index), (path,), attempt=attempt, earlier=earlier)

    def fill(self, names: list[str], knows: Callable[[str], bool] | None, left_out: LeftOut) -> None:
        """Put the names on the shelf: one for each student, in the order of their keys."""
        names.sort(key=self._plain)
        for plain, group in groupby(names, key=self._plain):
            same = list(group)
            if len(same) > 1 or self._stem(same[0]) != plain:
                for stem, copies in self._by_student(plain, same, knows):
                    last, number, earlier = last_copy(copies, self._folders_among(same), left_out, self._start)
                    self._names.append(last)
                    self._special[last] = _Special(stem, number, earlier)
            else:
                self._names.append(same[0])
        self._settle_keys()
        if self._special:
            self._names.sort(key=self._key)

    def _by_student(
        self, plain: str, names: Iterable[str], knows: Callable[[str], bool] | None
    ) -> Iterable[tuple[str, list[tuple[int, str]]]]:
        """Names that may be of one student, with the numbers of copies.

        `alice (1)` is alice's where there is an `alice`, or the roster has her: without either it may be a team's own name.
        """
        numbered = [(without_copy(self._stem(name), self._ending(name))[1], name) for name in names]
        if any(number == 0 for number, _ in numbered) or (knows is not None and knows(plain)):
            return [(plain, numbered)]
        by_stem: dict[str, list[tuple[int, str]]] = {}
        for number, name in numbered:
            by_stem.setdefault(self._stem(name), []).append((number, name))
        return by_stem.items()

    def _settle_keys(self) -> None:
        """See to it that keys are printable and differ; only where there is something odd can they fail to."""
        if not self._special and all(name.isprintable() for name in self._names):
            return
        keys = [self._key(name) for name in self._names]
        taken = {key for key in keys if key.isprintable()}
        met: set[str] = set()
        for name, wanted in zip(self._names, keys, strict=True):
            if wanted in met or not wanted.isprintable():
                key = unique(printable_path(wanted), taken)
                taken.add(key)
                self._special[name] = (self._special.get(name) or _Special(key))._replace(key=key)
            met.add(wanted)

    def _folders_among(self, names: list[str]) -> Callable[[str], bool]:
        folders = {name for name in names if not self._ending(name)}
        return folders.__contains__

    def _ending(self, name: str) -> str:
        return "" if name in self._folders else ending_of(name)

    def _stem(self, name: str) -> str:
        stem = name[: len(name) - len(ending)] if (ending := self._ending(name)) else name
        return stem[len(self._prefix) :] if self._prefix and has_prefix(stem, self._prefix) else stem

    def _plain(self, name: str) -> str:
        stem = self._stem(name)
        return without_copy(stem, self._ending(name))[0] if stem.endswith(")") else stem

    def _key(self, name: str) -> str:
        special = self._special.get(name)
        return special.key if special is not None else self._stem(name)


def _is_text(name: str) -> bool:
    """Whether a name is in UTF-8."""
    try:
        name.encode()
    except UnicodeEncodeError:
        return False
    return True


def shelve(
    listing: Listing,
    children: Children,
    start: str,
    left_out: LeftOut,
    rubric_id: str = "",
    knows: Callable[[str], bool] | None = None,
) -> FolderShelf:
    """The hand-ins of a class folder; `knows` says whether a name stands in the roster."""
    folders = [name for name in children.folders if name not in BUILT]
    left_out.add_all((start + name, _BUILT) for name in children.folders if name in BUILT)
    files: list[str] = []
    for name in children.files:
        if ending_of(name):
            files.append(name)
        else:
            left_out.add(start + name, _NO_SUBMISSION)
    left_out.add_all((start + name, reason) for name, reason in children.refused)
    prefix = class_prefix(folders or [name.removesuffix(ending_of(name)) for name in files], rubric_id, knows)
    shelf = FolderShelf(listing, start, prefix, frozenset(name for name in folders if ending_of(name)))
    folders += files
    shelf.fill(folders, knows, left_out)
    return shelf
