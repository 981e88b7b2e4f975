"""Files that hold a robot: recognised by their content, whatever they are called.

Nothing is parsed.
"""

import re
from collections.abc import Callable, Sequence
from posixpath import basename

from grader.base.errors import InputError
from grader.base.patterns import on_use
from grader.base.records import Named
from grader.files.reading import URDF_LIMIT
from grader.files.tree import File, Tree

_START = 4096  # bytes that are read of a file
_LONG_START = 64 * 1024  # bytes that are read if these are comments only
_MAX_READ = 2000  # files
_MAX_ROBOTS = 400  # found by their content alone

# What may come before the first element of XML, also where a declaration ends in > instead of ?>.
# Possessive: always linear.
_PROLOG = on_use(
    rb"""
    (?:\xef\xbb\xbf)?                             # the byte-order mark that Windows editors write
    (?>
        \s+
      | <\?[^>]*>                                 # <?xml version="1.0"?>, <?xml version="1.0">
      | <!--.*?-->
      | <!DOCTYPE[^<>\[]*(?>\[.*?\]\s*)?>         # <!DOCTYPE robot>, <!DOCTYPE robot [ ... ]>
    )*+
    """,
    re.DOTALL | re.IGNORECASE | re.VERBOSE,
)
_ROBOT = on_use(rb"<\s*robot(?=[\s/>])([^<>]*)")
_NAME = on_use(rb"(?<![\w:])name\s*=\s*[\"']([^\"']*)")
_COMMENT = on_use(rb"<!--.*?(?:-->|\Z)", re.DOTALL)
_INCLUDE = on_use(rb"<xacro:include\s[^<>]*filename\s*=\s*[\"'](?:[^\"']*/)?([^\"'/]+)[\"']")
_LIKELY = on_use("urdf|xacro|robot")  # in names of files that are read first
# Files that are no text, and need not be read.
_BINARY = frozenset(
    {
        ".png",
        ".jpg",
        ".jpeg",
        ".gif",
        ".webp",
        ".bmp",
        ".tif",
        ".tiff",
        ".heic",
        ".svg",
        ".ico",
        ".pdf",
        ".doc",
        ".docx",
        ".odt",
        ".pages",
        ".xls",
        ".xlsx",
        ".ppt",
        ".pptx",
        ".mp3",
        ".mp4",
        ".mov",
        ".webm",
        ".mkv",
        ".avi",
        ".zip",
        ".tar",
        ".gz",
        ".tgz",
        ".bz2",
        ".xz",
        ".7z",
        ".rar",
        ".stl",
        ".dae",
        ".obj",
        ".ply",
        ".glb",
        ".blend",
        ".pyc",
        ".so",
        ".a",
        ".o",
        ".exe",
        ".dll",
        ".bin",
        ".db",
        ".db3",
    }
)


class RobotFile(Named):
    """A file that may be graded as the URDF: it is called .urdf, or its first element is <robot>.

    `robot` is the name of the robot, and `includes` are the names of the files that it includes, as
    far as its beginning tells.
    """

    path: str
    size: int
    is_urdf: bool  # by its name
    robot: str = ""
    includes: frozenset[str] = frozenset()

    @property
    def name(self) -> str:
        """The last part of its path."""
        return basename(self.path)


def find_robots(
    tree: Tree, urdf_name: str = "", max_size: int = URDF_LIMIT
) -> tuple[RobotFile, ...]:
    """Return the files of a tree that may be the URDF.

    A file called `urdf_name` is among them whatever it contains, and one of xacro that cannot be
    read.

    Of other files only those of at most `max_size` bytes are read, and of these the first bytes.
    """
    robots = []
    by_content = read = 0
    for file in _list_candidates(tree):
        is_urdf = file.suffix == ".urdf" or file.name == urdf_name
        is_read = read < _MAX_READ and by_content < _MAX_ROBOTS
        most = file.size if file.suffix == ".xacro" else max_size
        if not is_urdf and (not is_read or file.suffix in _BINARY or not 0 < file.size <= most):
            continue
        read += 1
        start = None
        if is_read:
            try:
                start = _robot_start(file)
            except InputError:  # it is damaged
                is_urdf = is_urdf or file.suffix == ".xacro"
        if start:
            by_content += not is_urdf
            name_and_includes = _name_and_includes(start)
            robots.append(RobotFile(file.path, file.size, is_urdf, *name_and_includes))
        elif is_urdf:
            robots.append(RobotFile(file.path, file.size, is_urdf))
    return tuple(sorted(robots))


def _list_candidates(tree: Tree) -> list[File]:
    """Return the files that may be a URDF, the likely ones first if there are very many."""
    # An SRDF is MoveIt's description of groups, which is a <robot> as well.
    files = [file for file in tree.files.values() if ".srdf" not in file.name]
    if len(tree.files) > _MAX_READ:
        files.sort(key=lambda file: not _LIKELY.search(file.name.lower()))
    return files


def is_robot(read: Callable[[int], bytes]) -> bool:
    """Return whether a file is a robot: its first element is <robot>.

    `read` reads its first bytes.
    """
    data = read(_START)
    return _ROBOT.match(data, _end_of_prolog(data)) is not None


def list_parts(robots: Sequence[RobotFile]) -> frozenset[str]:
    """Return the paths of those files that another one includes."""
    includers: dict[str, set[str]] = {}
    for robot in robots:
        for name in robot.includes:
            includers.setdefault(name, set()).add(robot.path)
    parts = set()
    for robot in robots:
        if includers.get(robot.name, set()) - {robot.path}:
            parts.add(robot.path)
    return frozenset(parts)


def _robot_start(file: File) -> bytes | None:
    """Return the beginning of a file from its <robot> on, a longer one of xacro.

    Returns None if another element is first. Raises InputError if it cannot be read.
    """
    if not file.size:
        return None
    for count in (_START, _LONG_START):
        data = file.read(count, first=True)
        end = _end_of_prolog(data)
        if _ROBOT.match(data, end):
            if count < _LONG_START and len(data) == count and b"xacro:" in data:
                continue
            return data[end:]
        # Only comments so far, the last of which may have been cut.
        if len(data) < count or (end < len(data) and not data.startswith((b"<!", b"<?"), end)):
            return None
    return None


def _end_of_prolog(data: bytes) -> int:
    match = _PROLOG.match(data)
    return match.end() if match else 0


def _name_and_includes(start: bytes) -> tuple[str, frozenset[str]]:
    tag = _ROBOT.match(start)
    name = _NAME.search(tag[1]) if tag else None
    includes = (
        include.decode("utf-8", "replace") for include in _INCLUDE.findall(_COMMENT.sub(b"", start))
    )
    return name[1].decode("utf-8", "replace").strip() if name else "", frozenset(includes)
