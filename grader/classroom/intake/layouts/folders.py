"""The folders layout: each folder, archive or URDF is the submission of one student or team, and is named after them.

Class repositories of GitHub are `<assignment>-<login>/`. A browser saves a second `alice.zip` as `alice (1).zip`, a
later attempt; a folder may contain only attempts. If two names differ in their ending only, a folder counts, then the
endings in the order of `names.ENDINGS`; the other one is ignored, and reported.
"""

import re
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from itertools import groupby

from grader.classroom.intake.attempts import Attempts, attempts_in, last_copy
from grader.classroom.intake.layouts.layout import ClassFolder, Submissions, path_key
from grader.classroom.intake.names import ending_of, stems_of, without_copy
from grader.classroom.students import ClassSubmission, Student
from grader.files.names import BUILD_FOLDERS

_LAB = re.compile(r"lab-?\d+-", re.IGNORECASE)


class FolderSubmissions(Submissions):
    """Submissions of which only the names are kept in memory; everything else is computed on demand."""

    def __init__(self, folder: ClassFolder) -> None:
        super().__init__(())
        self._listing, self._start = folder.listing, folder.start
        self._knows = folder.roster.knows_submission if folder.roster is not None else None
        self._ignored = folder.ignored
        self._names: list[str] = []
        self._stems: dict[str, str] = {}  # of the last of several copies, without its number
        self._copies: dict[str, Attempts] = {}
        self._keys: dict[str, str] = {}  # of names that cannot be keys
        start, ignored, (names, files, refused) = folder.start, folder.ignored, folder.children
        ignored.add_all(start, ((name, "is a build folder") for name in names if name in BUILD_FOLDERS))
        unsupported = "is not a folder, an archive or a URDF"
        ignored.add_all(start, ((name, unsupported) for name in files if not ending_of(name)))
        ignored.add_all(start, refused)
        folders = [name for name in names if name not in BUILD_FOLDERS]
        files = [name for name in files if ending_of(name)]
        self._prefix = class_prefix(folders or stems_of([], files), folder.rubric_id, self._knows)
        self._folders = frozenset(name for name in folders if ending_of(name))  # those that are named like a file
        self._add(folders + files)

    def __len__(self) -> int:
        return len(self._names)

    def student(self, index: int) -> Student:
        """Return the student that the name of a submission identifies."""
        name = self._names[index]
        key, stem, plain = self._key(name), self._stem(name), self._without_copy(name)
        is_odd = not plain.isprintable() and plain.encode(errors="ignore").decode() == plain
        login = stem if key != stem or stem != name.removesuffix(self._ending(name)) else ""
        return Student(key, name=plain if is_odd else "", login=login)  # the name as on a roster

    def submission(self, index: int) -> ClassSubmission:
        """Return a submission; a folder is searched for attempts."""
        name = self._names[index]
        copy = self._copies.get(name) or Attempts(name, 1, ())
        earlier = tuple(self._start + other for other in copy.earlier)
        inner = None if self._ending(name) else attempts_in(self._listing, self._start + name)
        path, attempt, before = inner or (self._start + name, copy.number, ())
        return ClassSubmission(self.student(index), (path,), attempt=attempt, earlier=(*earlier, *before))

    def path(self, index: int) -> str:
        """Return the path of the student's folder or file; of several copies that of the last one."""
        return self._start + self._names[index]

    def _add(self, names: list[str]) -> None:
        """Add all names, one for each student, in the order of their keys."""
        names.sort(key=self._group)
        for _, group in groupby(names, key=self._group):
            same = list(group)
            plain = self._without_copy(same[0])
            if len(same) == 1 and self._without_prefix(same[0]) == plain:
                self._names.append(same[0])
                continue
            folders = {name for name in same if not self._ending(name)}
            for stem, copies in self._by_student(plain, same):
                attempts = last_copy(copies, folders, self._ignored, self._start)
                self._names.append(attempts.last)
                self._stems[attempts.last], self._copies[attempts.last] = stem, attempts
        if self._prefix or self._copies or not all(map(str.isprintable, self._names)):
            self._make_keys_unique()
            self._names.sort(key=self._key)

    def _by_student(self, plain: str, names: Iterable[str]) -> Iterable[tuple[str, list[tuple[int, str]]]]:
        """Group names that may belong to one student, with the numbers of copies.

        `alice (1)` belongs to alice if there is an `alice`, or the roster has her; otherwise it may be a team's own
        name.
        """
        numbered = [(without_copy(self._without_prefix(name), self._ending(name))[1], name) for name in names]
        if any(number == 0 for number, _ in numbered) or (self._knows is not None and self._knows(plain)):
            return [(plain, numbered)]
        by_stem: dict[str, list[tuple[int, str]]] = {}
        for number, name in numbered:
            by_stem.setdefault(self._without_prefix(name), []).append((number, name))
        return by_stem.items()

    def _make_keys_unique(self) -> None:
        """Give names with an unprintable or ambiguous key a path key."""
        counts = Counter(map(self._key, self._names))
        self.contested = tuple(Student(key) for key, count in sorted(counts.items()) if count > 1 and key.isprintable())
        self._keys = {
            name: path_key(self._start + name)
            for name in self._names
            if counts[self._key(name)] > 1 or not self._key(name).isprintable()
        }

    def _ending(self, name: str) -> str:
        return "" if name in self._folders else ending_of(name)

    def _without_prefix(self, name: str) -> str:
        """Return a name without its ending and the class's prefix."""
        stem = name[: len(name) - len(ending)] if (ending := self._ending(name)) else name
        return stem[len(self._prefix) :] if self._is_prefixed(stem) else stem

    def _is_prefixed(self, name: str) -> bool:
        return bool(self._prefix) and has_prefix(name, self._prefix)

    def _without_copy(self, name: str) -> str:
        stem = self._without_prefix(name)
        return without_copy(stem, self._ending(name))[0] if stem.endswith(")") else stem

    def _group(self, name: str) -> str:
        """Return what copies have in common: `alice` is not a copy of `lab6-alice`."""
        plain = self._without_copy(name)
        return f"{plain}\0{self._prefix}" if self._is_prefixed(name) else plain

    def _stem(self, name: str) -> str:
        return self._stems.get(name) or self._without_prefix(name)

    def _key(self, name: str) -> str:
        return self._keys.get(name) or self._stem(name)


def class_prefix(names: Sequence[str], rubric_id: str, knows: Callable[[str], bool] | None) -> str:
    """Return the prefix to remove from the names that have it, in lower case; empty if there is none.

    It is the rubric's id with a hyphen, or `lab` and a number if most names have it. With a roster (`knows` says
    whether a name is on it) it can be any prefix behind which the most names are on the roster. One more folder cannot
    change what the others mean.
    """
    if not names or (knows and all(map(knows, names))):
        return ""
    own = f"{rubric_id.lower()}-"
    if len(own) > 1 and any(has_prefix(name, own) for name in names):
        return own
    labs = Counter(
        found[0].lower() for name in names if (found := _LAB.match(name)) and has_prefix(name, found[0].lower())
    )
    for prefix, count in labs.most_common(1):
        if count * 2 > len(names):
            return prefix
    return _roster_prefix(names, knows) if knows is not None else ""


def _roster_prefix(names: Sequence[str], knows: Callable[[str], bool]) -> str:
    """Return the prefix that leaves the most known names: at least two, and more than are known with their prefix."""
    counts = Counter(
        name[: index + 1].lower()
        for name in names
        for index, letter in enumerate(name)
        if letter == "-" and knows(name[index + 1 :])
    )
    minimum = max(1, sum(map(knows, names)))
    prefix, count = max(counts.items(), key=lambda item: (item[1], item[0]), default=("", 0))
    return prefix if count > minimum else ""


def has_prefix(name: str, prefix: str) -> bool:
    """Return whether a name starts with a prefix and continues behind it, in any case."""
    return len(name) > len(prefix) and name[: len(prefix)].lower() == prefix
