"""The folders of several students in one repository, told by name from parts and versions of one student's work."""

import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from itertools import accumulate
from typing import NamedTuple

from grader.submission.labs import without_archive

_CAMEL = re.compile(r"(?<=[^\W\d_A-Z])(?=[A-Z])")
_WORD = re.compile(r"[^\W\d_]+|\d+")
_DATE = re.compile(
    r"(?<!\d)(?:(?:19|20)\d\d[-_.]?[01]\d[-_.]?[0-3]\d"  # 2025-03-14, 20250314
    r"|[0-3]?\d[-_.][01]?\d[-_.](?:20)?\d\d)(?!\d)"  # 14.3.2025, 14_03_25
)
_MIN_NUMBER = 4  # digits of a number that is part of a login, and not of a version
_MIN_ID = 7  # digits of a name that is a number only, such as that of a student at the university

# Words in the names of folders that are part of any submission.
_PARTS = frozenset(
    {
        "src", "source", "sources", "launch", "config", "configs", "configuration", "resource", "resources", "test",
        "tests", "build", "install", "log", "logs", "doc", "docs", "document", "documents", "documentation", "image",
        "images", "img", "imgs", "picture", "pictures", "pic", "pics", "photo", "photos", "screenshot", "screenshots",
        "evidence", "answer", "answers", "report", "reports", "mesh", "meshes", "world", "worlds", "model", "models",
        "param", "params", "map", "maps", "include", "includes", "script", "scripts", "media", "asset", "assets",
        "code", "codes", "package", "packages", "pkg", "pkgs", "ws", "ros", "homework", "hw", "video", "videos", "data",
        "task", "tasks", "part", "parts", "step", "steps", "exercise", "exercises", "ex", "lab", "labs", "prelab",
        "postlab", "pre", "post", "assignment", "assignments", "week", "question", "questions", "q", "bot",
        "description", "bringup", "interface", "interfaces", "msgs", "sim", "simulation", "simulator", "control",
        "controller", "controllers", "navigation", "nav", "slam", "sensor", "sensors", "lidar", "laser", "camera",
        "webcam", "wheel", "wheels", "wheeled", "base", "chassis", "arm", "gripper", "box", "boxes", "cylinder",
        "sphere", "caster", "footprint", "mobile", "diff", "differential", "drive", "driver", "vehicle", "car", "rover",
        "cart", "tutorial", "tutorials", "example", "examples", "demo", "demos", "template", "templates", "handout",
        "given", "provided", "starter", "skeleton", "reference", "project", "projects", "course", "programming", "file",
        "files", "folder", "dir", "stuff", "misc", "other", "others", "common", "shared", "util", "utils", "lib",
        "library", "tool", "tools", "bin", "share", "material", "materials", "inertia", "inertial", "macro", "macros",
        "component", "components", "desktop", "downloads", "home", "user", "ubuntu", "linux", "windows", "mac", "vm",
        "docker", "github", "git", "repo", "repository", "main", "master", "dev", "devel", "develop", "branch", "app",
        "moveit", "python", "cpp", "notebook", "notebooks", "note", "notes", "input", "output", "result", "results",
        "zip", "rar", "proto", "protos", "plugin", "plugins", "team", "teams", "group", "groups", "class", "student",
        "students", "member", "members", "deliverable", "deliverables", "practice", "playground", "plain", "simple",
        "basic", "advanced", "html", "web", "static", "public", "private", "extra", "extras", "bonus", "irp",
        "introduction", "intro", "abgabe", "aufgabe", "aufgaben", "bilder", "praktikum", "optional", "required", "real",
        "fake", "dummy", "sample", "samples", "visual", "visuals", "collision", "geometry",
    }
)  # fmt: skip
_STEMS = re.compile(
    r"robot|urdf|xacro|gazebo|rviz|webots|turtle|workspace|backup|homework|screenshot|lab\d|catkin|colcon"
)
# Words in the names of versions, which say nothing of whose the folder is.
_VERSIONS = frozenset(
    {
        "old", "older", "oldest", "new", "newer", "newest", "copy", "copies", "kopie", "bak", "v", "ver", "version",
        "versions", "final", "finals", "finished", "latest", "current", "previous", "prev", "orig", "original",
        "solution", "solutions", "sol", "solved", "try", "attempt", "attempts", "draft", "drafts", "wip", "tmp", "temp",
        "work", "working", "works", "good", "bad", "better", "best", "broken", "fixed", "fix", "correct", "corrected",
        "correction", "wrong", "submission", "submissions", "submit", "submitted", "handin", "upload", "uploads",
        "uploaded", "resubmission", "resubmit", "revised", "revision", "rev", "update", "updated", "improved", "first",
        "second", "third", "last", "complete", "completed", "done", "full", "initial", "start", "before", "after",
        "archive", "archived", "save", "saved", "saves", "export", "exported", "trash", "unused", "deprecated",
        "legacy", "ready", "my", "mine", "the", "of", "and", "or", "for", "with", "without", "to", "in", "on", "a",
        "from", "only", "not", "this", "use", "alternative", "alt", "variant", "option", "one", "two", "three", "ii",
        "iii", "iv", "versuch", "untitled", "unnamed", "von",
    }
)  # fmt: skip
_NUMBERED = frozenset({"student", "team", "group", "member", "gruppe"})  # team 1 and team 2 are two


class StudentWork(NamedTuple):
    """A robot or package, the folder it is in, and whether it surely is what the lab asks for."""

    folder: str
    is_of_lab: bool


def students_in(
    works: Collection[StudentWork], packages: Mapping[str, str], lab: Collection[str], package_name: str
) -> tuple[str, ...]:
    """Return the folders of students, in order, if the works are those of several students; else none.

    `packages` has the names of packages by their folders, `lab` the words that name the lab, and `package_name` is
    the name that the lab gives the package.

    Of ash/lab6, bo/lab6 and ash2/lab6, the students are in ash and bo: ash2 is a version of ash. Of team/ash/pkg and
    team/bo/pkg they are in team/ash and team/bo. Of ash/lab6 and old/lab6 there is one student.
    """
    owners = {work: tuple(_owners(work.folder, packages, lab, package_name)) for work in works}
    shared = _count_common(owners.values())
    by_person: dict[str, list[tuple[str, bool]]] = {}
    free = [work for work, own in owners.items() if len(own) == shared]
    for work, own in owners.items():
        if len(own) > shared:
            person, folder = own[shared]
            by_person.setdefault(person, []).append((folder, work.is_of_lab))
    for person in list(by_person):
        first_version = person.rstrip("0123456789")
        if first_version != person and first_version in by_person:
            by_person[first_version] += by_person.pop(person)
    sure = [entries for entries in by_person.values() if any(is_of_lab for _, is_of_lab in entries)]
    chosen = sure if sure or free else list(by_person.values())
    return tuple(sorted(min(entries)[0] for entries in chosen)) if len(chosen) > 1 else ()


def students_beside(
    folder: str, folders: Collection[str], packages: Mapping[str, str], lab: Collection[str], package_name: str
) -> tuple[str, tuple[str, ...]]:
    """Return the folder of the student whose work is in a folder, and those beside it that may be others'; or none.

    `folders` are all of the submission; the other arguments are those of `students_in`.
    """
    for person, own in _owners(folder, packages, lab, package_name):
        parent = own.rpartition("/")[0]
        names = [path.rpartition("/")[2] for path in folders if path != own and path.rpartition("/")[0] == parent]
        known = {name: person_in(name, lab).rstrip("0123456789") for name in names}
        others = [name for name, other in known.items() if other and other != person.rstrip("0123456789")]
        if others:
            return own, tuple(sorted(f"{parent}/{name}" if parent else name for name in others))
    return "", ()


def is_part(name: str, lab: Collection[str] = ()) -> bool:
    """Return whether a folder's name is that of a part or version of a submission. `lab` are words to ignore."""
    words = _words(name)
    if _is_numbered(words):
        return False
    letters = [word for word in words if word not in lab and not word.isdecimal() and word not in _VERSIONS]
    is_version = not letters and not all(map(str.isdecimal, words))
    return is_version or not _PARTS.isdisjoint(letters) or any(map(_STEMS.search, (*letters, "".join(letters))))


def person_in(name: str, lab: Collection[str] = ()) -> str:
    """Return whose a folder is, by its name; empty for a part or version of a submission. `lab` are words to ignore."""
    words = _words(name)
    if _is_numbered(words):
        return "".join(words)
    rest = [word for word in words if word not in _VERSIONS and word not in lab]
    letters = sum(len(word) for word in rest if not word.isdecimal())
    number = max((len(word) for word in rest if word.isdecimal()), default=0)
    is_short = letters < 2 and number < (_MIN_NUMBER if letters else _MIN_ID)
    return "" if is_short or is_part(name, lab) else "".join(rest)


def _is_numbered(words: list[str]) -> bool:
    return len(words) == 2 and words[0] in _NUMBERED and words[1].isdecimal()


def _words(name: str) -> list[str]:
    """Return the words of a name without dates; of an email address those before the @."""
    plain = without_archive(name)[:100].partition("@")[0]
    return _WORD.findall(_CAMEL.sub(" ", _DATE.sub(" ", plain)).casefold())


def _owners(
    folder: str, packages: Mapping[str, str], lab: Collection[str], package_name: str
) -> Iterator[tuple[str, str]]:
    """Yield whose a folder is, with the folder on its path that tells it: a package's only if it is renamed."""
    for path in accumulate(folder.split("/") if folder else (), "{}/{}".format):
        name = path.rpartition("/")[2]
        package = packages.get(path)
        person = person_in(name, lab) if package is None or (package == package_name and name != package_name) else ""
        if person:
            yield person, path
        if package is not None:
            return


def _count_common(owners: Iterable[tuple[tuple[str, str], ...]]) -> int:
    """Return how many owners all of these begin with: the team's repository, and its members' common folder."""
    count = 0
    for level in zip(*owners, strict=False):
        if len(set(level)) > 1:
            break
        count += 1
    return count
