"""The folders layout: each folder, archive or URDF is the submission of one student or team, and is named after them.

Class repositories of GitHub are `<assignment>-<login>/`. A browser saves a second `alice.zip` as `alice (1).zip`, a later attempt;
a folder may contain only attempts. If two names differ in their ending only, a folder counts, then the endings in the
order of `names.ENDINGS`; the other one is ignored, and reported.
"""

from collections import Counter
from collections.abc import Callable, Iterable
from itertools import groupby
from typing import NamedTuple

from grader.classroom.intake.layouts.attempts import attempts_in, last_copy
from grader.classroom.intake.layouts.layout import IgnoredFiles, path_key
from grader.classroom.intake.layouts.prefix import class_prefix, has_prefix
from grader.classroom.intake.listing import Children, ClassListing
from grader.classroom.intake.names import ending_of, stems_of, without_copy
from grader.classroom.students import ClassSubmission, Student
from grader.files.ignore_rules import BUILD_FOLDERS

_UNSUPPORTED = "is not a folder, an archive or a URDF"
_BUILD = "is a build folder"


class _NumberedCopy(NamedTuple):
    """The last of several copies: the name without its number, which attempt it is, and the earlier ones."""

    stem: str
    attempt: int
    earlier: tuple[str, ...]


class FolderSubmissions:
    """Submissions of which only the names are kept in memory; everything else is computed on demand."""

    assignments: frozenset[str] = frozenset()

    def __init__(self, listing: ClassListing, start: str, prefix: str, folders: frozenset[str]) -> None:
        self._listing = listing
        self._start = start
        self._prefix = prefix
        self._folders = folders  # those that are named like an archive or URDF
        self._names: list[str] = []
        self._copies: dict[str, _NumberedCopy] = {}
        self._keys: dict[str, str] = {}  # of names that cannot be keys
        self.contested: tuple[Student, ...] = ()

    def __len__(self) -> int:
        return len(self._names)

    def student(self, index: int) -> Student:
        """Return the student that the name of a submission identifies."""
        name = self._names[index]
        key, stem, plain = self._key(name), self._stem(name), self._without_copy(name)
        return Student(
            key,
            name=plain if not plain.isprintable() and _is_unicode(plain) else "",  # as on a roster
            login=stem if key != stem or stem != name.removesuffix(self._ending(name)) else "",
        )

    def submission(self, index: int) -> ClassSubmission:
        """Return a submission; a folder is searched for attempts."""
        name = self._names[index]
        path = self._start + name
        copy = self._copies.get(name)
        attempt = copy.attempt if copy is not None else 1
        earlier = tuple(self._start + other for other in copy.earlier) if copy is not None else ()
        attempts = None if self._ending(name) else attempts_in(self._listing, path)
        if attempts is not None:
            path, attempt, earlier = attempts.last, attempts.number, (*earlier, *attempts.earlier)
        return ClassSubmission(self.student(index), (path,), attempt=attempt, earlier=earlier)

    def path(self, index: int) -> str:
        """Return the path of the student's folder or file; of several copies that of the last one."""
        return self._start + self._names[index]

    def add(self, names: list[str], knows: Callable[[str], bool] | None, ignored: IgnoredFiles) -> None:
        """Add all names, one for each student, in the order of their keys."""
        names.sort(key=self._group)
        for _, group in groupby(names, key=self._group):
            same = list(group)
            plain = self._without_copy(same[0])
            if len(same) == 1 and self._without_prefix(same[0]) == plain:
                self._names.append(same[0])
                continue
            folders = {name for name in same if not self._ending(name)}
            for stem, copies in self._by_student(plain, same, knows):
                last, number, earlier = last_copy(copies, folders.__contains__, ignored, self._start)
                self._names.append(last)
                self._copies[last] = _NumberedCopy(stem, number, earlier)
        if self._prefix or self._copies or not all(map(str.isprintable, self._names)):
            self._make_keys_unique()
            self._names.sort(key=self._key)

    def _by_student(
        self, plain: str, names: Iterable[str], knows: Callable[[str], bool] | None
    ) -> Iterable[tuple[str, list[tuple[int, str]]]]:
        """Group names that may belong to one student, with the numbers of copies.

        `alice (1)` belongs to alice if there is an `alice`, or the roster has her; otherwise it may be a team's own name.
        """
        numbered = [(without_copy(self._without_prefix(name), self._ending(name))[1], name) for name in names]
        if any(number == 0 for number, _ in numbered) or (knows is not None and knows(plain)):
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
        copy = self._copies.get(name)
        return copy.stem if copy is not None else self._without_prefix(name)

    def _key(self, name: str) -> str:
        return self._keys.get(name) or self._stem(name)


def _is_unicode(name: str) -> bool:
    try:
        name.encode()
    except UnicodeEncodeError:
        return False
    return True


def find_submissions(
    listing: ClassListing,
    children: Children,
    start: str,
    ignored: IgnoredFiles,
    rubric_id: str = "",
    knows: Callable[[str], bool] | None = None,
) -> FolderSubmissions:
    """Return the submissions of a class folder; `knows` says whether a name is on the roster."""
    folders = [name for name in children.folders if name not in BUILD_FOLDERS]
    files = [name for name in children.files if ending_of(name)]
    ignored.add_all(start, ((name, _BUILD) for name in children.folders if name in BUILD_FOLDERS))
    ignored.add_all(start, ((name, _UNSUPPORTED) for name in children.files if not ending_of(name)))
    ignored.add_all(start, children.refused)
    prefix = class_prefix(folders or stems_of([], files), rubric_id, knows)
    submissions = FolderSubmissions(listing, start, prefix, frozenset(name for name in folders if ending_of(name)))
    submissions.add(folders + files, knows, ignored)
    return submissions
