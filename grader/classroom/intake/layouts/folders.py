"""The plain layout: each folder, archive or URDF is what one student or team has handed in, and is named after them.

Class repositories of GitHub are `<assignment>-<login>/`. A browser saves a second `alice.zip` as `alice (1).zip`, a later attempt;
a folder may hold nothing but attempts. Where two names differ in their ending only, a folder counts, then the endings in the
order of `names.ENDINGS`; the other one is left out, and named.
"""

from collections import Counter
from collections.abc import Callable, Iterable
from itertools import groupby
from typing import NamedTuple

from grader.classroom.intake.layouts.attempts import attempts_in, last_copy
from grader.classroom.intake.layouts.layout import IgnoredFiles, place_key
from grader.classroom.intake.layouts.prefix import class_prefix, has_prefix
from grader.classroom.intake.listing import Children, Listing
from grader.classroom.intake.names import ending_of, without_copy
from grader.classroom.students import ClassSubmission, Student
from grader.files.ignore_rules import BUILD_FOLDERS

_NO_SUBMISSION = "is not a folder, an archive or a URDF"
_BUILT = "is a folder of a build"


class _Copy(NamedTuple):
    """The last of several copies: the name without its number, which attempt it is, and the earlier ones."""

    stem: str
    attempt: int
    earlier: tuple[str, ...]


class FolderSubmissions:
    """Hand-ins of which only the names are kept: the rest is worked out when it is asked for."""

    assignments: frozenset[str] = frozenset()

    def __init__(self, listing: Listing, start: str, prefix: str, folders: frozenset[str]) -> None:
        self._listing = listing
        self._start = start
        self._prefix = prefix
        self._folders = folders  # those that have the name of an archive or URDF
        self._names: list[str] = []
        self._copies: dict[str, _Copy] = {}
        self._keys: dict[str, str] = {}  # of names that cannot be keys
        self.contested: tuple[Student, ...] = ()

    def __len__(self) -> int:
        return len(self._names)

    def student(self, index: int) -> Student:
        """Who has handed in, as the name says."""
        name = self._names[index]
        key, stem, plain = self._key(name), self._stem(name), self._plain(name)
        return Student(
            key,
            name=plain if not plain.isprintable() and _is_text(plain) else "",  # as a roster has it
            login=stem if key != stem or stem != name.removesuffix(self._ending(name)) else "",
        )

    def hand_in(self, index: int) -> ClassSubmission:
        """What was handed in; a folder is looked into for attempts."""
        name = self._names[index]
        path = self._start + name
        copy = self._copies.get(name)
        attempt = copy.attempt if copy is not None else 1
        earlier = tuple(self._start + each for each in copy.earlier) if copy is not None else ()
        found = None if self._ending(name) else attempts_in(self._listing, path)
        if found is not None:
            path, attempt, earlier = found.last, found.number, (*earlier, *found.earlier)
        return ClassSubmission(self.student(index), (path,), attempt=attempt, earlier=earlier)

    def place(self, index: int) -> str:
        """The path of the student's folder or file; of several copies that of the last one."""
        return self._start + self._names[index]

    def fill(self, names: list[str], knows: Callable[[str], bool] | None, ignored: IgnoredFiles) -> None:
        """Put the names on the shelf: one for each student, in the order of their keys."""
        names.sort(key=self._shared_by_copies)
        for _, group in groupby(names, key=self._shared_by_copies):
            same = list(group)
            plain = self._plain(same[0])
            if len(same) > 1 or self._own_stem(same[0]) != plain:
                for stem, copies in self._by_student(plain, same, knows):
                    last, number, earlier = last_copy(copies, self._folders_among(same), ignored, self._start)
                    self._names.append(last)
                    self._copies[last] = _Copy(stem, number, earlier)
            else:
                self._names.append(same[0])
        self._settle_keys()
        if self._copies or self._keys:
            self._names.sort(key=self._key)

    def _by_student(
        self, plain: str, names: Iterable[str], knows: Callable[[str], bool] | None
    ) -> Iterable[tuple[str, list[tuple[int, str]]]]:
        """Names that may be of one student, with the numbers of copies.

        `alice (1)` is alice's where there is an `alice`, or the roster has her: without either it may be a team's own name.
        """
        numbered = [(without_copy(self._own_stem(name), self._ending(name))[1], name) for name in names]
        if any(number == 0 for number, _ in numbered) or (knows is not None and knows(plain)):
            return [(plain, numbered)]
        by_stem: dict[str, list[tuple[int, str]]] = {}
        for number, name in numbered:
            by_stem.setdefault(self._own_stem(name), []).append((number, name))
        return by_stem.items()

    def _settle_keys(self) -> None:
        """Make keys printable and different; only where there is something odd can they fail to be."""
        if not self._prefix and not self._copies and all(name.isprintable() for name in self._names):
            return
        counts = Counter(map(self._key, self._names))
        self.contested = tuple(Student(key) for key, count in sorted(counts.items()) if count > 1 and key.isprintable())
        self._keys = {
            name: place_key(self._start + name)
            for name in self._names
            if counts[self._key(name)] > 1 or not self._key(name).isprintable()
        }

    def _folders_among(self, names: list[str]) -> Callable[[str], bool]:
        folders = {name for name in names if not self._ending(name)}
        return folders.__contains__

    def _ending(self, name: str) -> str:
        return "" if name in self._folders else ending_of(name)

    def _own_stem(self, name: str) -> str:
        """A name without its ending and the class's prefix."""
        stem = name[: len(name) - len(ending)] if (ending := self._ending(name)) else name
        return stem[len(self._prefix) :] if self._is_prefixed(stem) else stem

    def _is_prefixed(self, name: str) -> bool:
        return bool(self._prefix) and has_prefix(name, self._prefix)

    def _plain(self, name: str) -> str:
        stem = self._own_stem(name)
        return without_copy(stem, self._ending(name))[0] if stem.endswith(")") else stem

    def _shared_by_copies(self, name: str) -> str:
        """What copies have in common: `alice` is no copy of `lab6-alice`."""
        return f"{self._plain(name)}\0{self._prefix}" if self._is_prefixed(name) else self._plain(name)

    def _stem(self, name: str) -> str:
        copy = self._copies.get(name)
        return copy.stem if copy is not None else self._own_stem(name)

    def _key(self, name: str) -> str:
        return self._keys.get(name) or self._stem(name)


def _is_text(name: str) -> bool:
    """Whether a name is in UTF-8."""
    try:
        name.encode()
    except UnicodeEncodeError:
        return False
    return True


def find_submissions(
    listing: Listing,
    children: Children,
    start: str,
    ignored: IgnoredFiles,
    rubric_id: str = "",
    knows: Callable[[str], bool] | None = None,
) -> FolderSubmissions:
    """The hand-ins of a class folder; `knows` says whether a name stands in the roster."""
    folders = [name for name in children.folders if name not in BUILD_FOLDERS]
    ignored.add_all((start + name, _BUILT) for name in children.folders if name in BUILD_FOLDERS)
    files: list[str] = []
    for name in children.files:
        if ending_of(name):
            files.append(name)
        else:
            ignored.add(start + name, _NO_SUBMISSION)
    ignored.add_all((start + name, reason) for name, reason in children.refused)
    prefix = class_prefix(folders or [name.removesuffix(ending_of(name)) for name in files], rubric_id, knows)
    shelf = FolderSubmissions(listing, start, prefix, frozenset(name for name in folders if ending_of(name)))
    folders += files
    shelf.fill(folders, knows, ignored)
    return shelf
