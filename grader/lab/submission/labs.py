"""The folder of a lab in a repository that holds several labs."""

from collections import defaultdict
from collections.abc import Collection, Iterable, Mapping, Sequence
from enum import IntEnum
from functools import cached_property

from grader.base.names import last_part
from grader.base.patterns import on_use
from grader.files.limits import ARCHIVES, PACKAGE_FILES
from grader.files.tree import parents

MAX_WRAPPERS = 3  # folders around a download
_WORD = on_use(r"[^\W\d_]+|\d+")
_NUMBER = on_use(r"\d+")
_NUMBER_BORDER = on_use(r"(?<=\d) (?=\d)")
_NUMBER_WORDS = {
    word: str(number)
    for number, word in enumerate(
        [
            "one",
            "two",
            "three",
            "four",
            "five",
            "six",
            "seven",
            "eight",
            "nine",
            "ten",
            "eleven",
            "twelve",
        ],
        start=1,
    )
}
# Words in the names of folders that are a part or version of a submission.
_PARTS = frozenset(
    {
        "src",
        "launch",
        "config",
        "resource",
        "resources",
        "test",
        "build",
        "install",
        "log",
        "docs",
        "images",
        "pictures",
        "screenshots",
        "evidence",
        "answers",
        "meshes",
        "worlds",
        "models",
        "code",
        "package",
        "ws",
        "part",
        "task",
        "step",
        "lab",
        "prelab",
        "description",
        "base",
        "template",
        "old",
        "new",
        "copy",
        "backup",
        "v",
        "version",
        "final",
        "solution",
        "second",
        "submission",
        "submissions",
        "project",
        "my",
        "team",
        "students",
    }
)
_ROBOTICS = on_use("robot|urdf|xacro|gazebo|rviz|webots|turtle|workspace")
_FINAL = on_use(r"(?:final|course|term|semester|capstone)projects?|capstone")


class Belonging(IntEnum):
    """Where a file is, the best place first."""

    THIS_LAB = 0
    NO_LAB = 1
    OTHER_LAB = 2


class LabFolders:
    """Tells the folders of a lab, by the names that a rubric gives, from those of other labs.

    Case, spaces, hyphens, underscores and leading zeros do not matter. Another lab has the same
    name with another number, or is a final project. A name that contains more, such as Lab6_Ash,
    counts if no folder of this lab has exactly its name, and if it has a number; the folder of a
    package never counts by such a name. Folders inside a package, such as the module lab6_robot,
    name no lab.
    """

    def __init__(self, names: Sequence[str], paths: Iterable[str] = ()) -> None:
        self._own = {_join_words(lab_words(name)) for name in names}
        self._shapes = {
            _NUMBER.sub("#", own_lab) for own_lab in self._own if _NUMBER.search(own_lab)
        }
        self._known: dict[str, Belonging] = {}
        self._packages = set()
        self._folders = set()
        if not self._own:
            paths = ()
        for path in paths:
            folder, _, name = path.rpartition("/")
            self._folders.add(folder)
            if name in PACKAGE_FILES:
                self._packages.add(folder)
        # A package may be above others: the folders between them are not its own.
        self._above_packages = {above for folder in self._packages for above in parents(folder)}
        every_folder = {above for folder in self._folders for above in (folder, *parents(folder))}
        self._has_exact = any(
            self.is_lab(last_part(folder)) and not self._is_inside_package(folder)
            for folder in every_folder
        )

    def is_lab(self, name: str) -> bool:
        """Return whether a folder has exactly the name of this lab."""
        return _join_words(lab_words(_without_archive(name))) in self._own

    def is_project(self, path: str) -> bool:
        """Return whether a file is in the folder of a final project."""
        return any(_FINAL.search(_join_words(lab_words(name))) for name in path.split("/")[:-1])

    def belonging(self, path: str) -> Belonging:
        """Return where a file is. Of the folders around it the nearest that names a lab decides."""
        if not self._own:
            return Belonging.NO_LAB
        return self._belonging_of_folder(path.rpartition("/")[0])

    @cached_property
    def _labs_by_folder(self) -> Mapping[str, Sequence[str]]:
        """The folders and archives that name a lab, by the folder that they are in."""
        folders = defaultdict(list)
        for folder in {above for path in self._folders for above in (path, *parents(path))}:
            if folder and self._own_belonging(folder) is not Belonging.NO_LAB:
                folders[folder.rpartition("/")[0]].append(folder)
        return folders

    def is_beside_archive(self, path: str) -> bool:
        """Return whether a file of no lab is beside an archive of this lab and no other.

        It is enough that a folder around it is.
        """
        if self.belonging(path) is not Belonging.NO_LAB:
            return False
        labs = next(
            (
                self._labs_by_folder[parent]
                for parent in (*parents(path), "")
                if parent in self._labs_by_folder
            ),
            (),
        )
        are_of_lab = (
            self._own_belonging(lab) is Belonging.THIS_LAB and lab.endswith(ARCHIVES)
            for lab in map(str.lower, labs)
        )
        return bool(labs) and all(are_of_lab)

    def around(self, path: str) -> str:
        """Return the outermost folder around a file that names a lab; empty if there is none."""
        if not self._own:
            return ""
        named = (
            folder
            for folder in parents(path)
            if self._own_belonging(folder) is not Belonging.NO_LAB
        )
        return next(reversed(list(named)), "")

    def _belonging_of_folder(self, folder: str) -> Belonging:
        if not folder:
            return Belonging.NO_LAB
        if folder not in self._known:
            own_belonging = self._own_belonging(folder)
            self._known[folder] = (
                own_belonging
                if own_belonging is not Belonging.NO_LAB
                else self._belonging_of_folder(folder.rpartition("/")[0])
            )
        return self._known[folder]

    def _is_inside_package(self, folder: str) -> bool:
        if folder in self._packages or folder in self._above_packages:
            return False
        return not self._packages.isdisjoint([*parents(folder), ""])

    def _own_belonging(self, folder: str) -> Belonging:
        if self._is_inside_package(folder):
            return Belonging.NO_LAB
        words = lab_words(_without_archive(last_part(folder)))
        name = _join_words(words)
        if name in self._own:
            return Belonging.THIS_LAB
        if _NUMBER.sub("#", name) in self._shapes or _FINAL.fullmatch(name):
            return Belonging.OTHER_LAB
        if folder in self._packages:
            return Belonging.NO_LAB
        spans = {
            _join_words(words[i:j]) for i in range(len(words)) for j in range(i + 1, len(words) + 1)
        }
        if any(map(_NUMBER.search, spans & self._own)):
            return Belonging.NO_LAB if self._has_exact else Belonging.THIS_LAB
        is_other = any(
            _NUMBER.sub("#", span) in self._shapes or _FINAL.fullmatch(span) for span in spans
        )
        return Belonging.OTHER_LAB if is_other else Belonging.NO_LAB


def lab_words(name: str) -> Sequence[str]:
    """Return the words and numbers of a name: lab and 6 of Lab_06 or Lab Six."""
    words = _WORD.findall(name[:100].casefold())
    return tuple(
        str(int(word)) if word.isdecimal() else _NUMBER_WORDS.get(word, word) for word in words
    )


def is_part(name: str, lab: Collection[str] = ()) -> bool:
    """Return whether a folder's name is that of a part or version of a submission.

    `lab` are words to ignore.
    """
    words = [word for word in lab_words(name) if word not in lab]
    return (
        not _PARTS.isdisjoint(words)
        or all(map(str.isdecimal, words))
        or any(map(_ROBOTICS.search, words))
    )


def _join_words(words: Sequence[str]) -> str:
    """Return words without spaces, but a point between numbers.

    For example, this is lab6, or lab6.2 of Lab6 (2), which is not lab 62.
    """
    return _NUMBER_BORDER.sub(".", " ".join(words)).replace(" ", "")


def _without_archive(name: str) -> str:
    """Return a name without the ending of an archive."""
    stem, dot, ending = name.rpartition(".")
    if dot and f".{ending.lower()}" in ARCHIVES:
        return _without_archive(stem)
    return name
