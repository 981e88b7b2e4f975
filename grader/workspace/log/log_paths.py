"""The files of a workspace that the paths in a log mean."""

import re
from collections.abc import Iterator

from grader.base.names import last_part
from grader.base.patterns import on_use
from grader.base.source import Location
from grader.workspace.log.log_messages import LogMessage
from grader.workspace.opening.opened import OpenedWorkspace

_INSTALLED = on_use(r"/(?:install|build)/(?P<package>[\w-]{1,100})/(?P<path>\S[^\n]{0,400})")
_MODULES = on_use(r"(?:(?:site|dist)-packages|build/lib)/")
_FOREIGN = ("/opt/", "/usr/")
_MAX_FOLDERS = 20
# How programs name a line of a file: Python and YAML; launch; xacro; compilers, CMake and Gazebo.
_NAMED = tuple(
    re.compile(pattern)
    for pattern in (
        r'(?:File|in) "(?P<path>[^"]{1,400}+)", line (?P<line>[0-9]{1,7}+)',
        r"\((?P<path>[^\s(),]{1,300}+), line (?P<line>[0-9]{1,7}+)\)",
        r"line (?P<line>[0-9]{1,7}+), column [0-9]{1,7}+.{0,80}? file: (?P<path>\S{1,400}+)",
        r"YAML file (?P<path>\S{1,400}+) at position \((?P<line>[0-9]{1,7}+):",
        r"--params-file (?P<path>[^']{1,400}+)'.{0,200}? line(?:_num)?:? (?P<line>[0-9]{1,7}+)",
        r"(?P<path>(?<![\w./~-])[\w./~+-]{1,400}+):L?(?P<line>[0-9]{1,7}+)(?![\w.])",
    )
)
_EXCERPT = on_use(r" [0-9]{1,7} \| | ?Check that:")  # the line itself, or advice
_BETWEEN = "0123456789:,])^~ "  # a column, and what ends a place
_MAX_NAMED = 40  # places of a message


class LogPaths:
    """The files of a workspace, by the paths that programs print of them."""

    def __init__(self, opened: OpenedWorkspace) -> None:
        self._opened = opened
        self._by_name: dict[str, list[str]] = {}
        for path in opened.whole_tree.files:
            self._by_name.setdefault(last_part(path), []).append(path)

    def find_source(self, path: str, package: str = "") -> str | None:
        """Return the file that a path means: one that a build copies, or the only one that fits.

        Args:
            path: As a program prints it, such as one below install/.
            package: The one that is built, in whose folder a relative path begins.
        """
        if path.startswith(_FOREIGN):
            return None
        match = _INSTALLED.search(path)
        for other in self._opened.packages if match else ():
            assert match
            if other.name == match["package"]:
                inside = _MODULES.split(match["path"])[-1]
                source = other.path(other.installed.get(match["path"]) or inside)
                if source in self._opened.whole_tree.files:
                    return source
        files = self._by_name.get(last_part(path), ())
        for end in _list_ends(path):
            fitting = [file for file in files if f"/{file}".endswith(f"/{end}")]
            if len(fitting) > 1:
                fitting = [file for file in fitting if self._is_of(package, file)]
            if len(fitting) == 1:
                return fitting[0]
        return None

    def _is_of(self, package: str, file: str) -> bool:
        """Return whether a file is in the folder of a package."""
        folders = [other.folder for other in self._opened.packages if other.name == package]
        return any(not folder or file.startswith(f"{folder}/") for folder in folders)

    def named_in(self, message: LogMessage) -> Iterator[tuple[Location, str]]:
        """Yield the lines of the workspace that a message names, and what it says behind each."""
        matches = []
        for pattern in _NAMED:
            matches += list(pattern.finditer(message.text))[:_MAX_NAMED]
        for match in sorted(matches, key=lambda match: match.start()):
            file = self.find_source(match["path"], message.package)
            source = self._opened.source(file) if file is not None else None
            line = int(match["line"])
            rest = message.text[match.end() :]
            if not source or not source.line(line).strip():
                continue
            if match[0].startswith("File"):
                # Python prints the line: the file is the one that ran if it is the same.
                _, printed, rest = rest.partition(" ".join(source.line(line).split()))
                if not printed:
                    continue
            yield Location(source.path, line, 1), _EXCERPT.split(rest)[0].lstrip(_BETWEEN)


def _list_ends(path: str) -> Iterator[str]:
    """Yield the ends of a path, the longest first; its name alone only if it is all there is."""
    names = path.strip("/").split("/")
    last = len(names) if len(names) == 1 else len(names) - 1
    for start in range(max(0, len(names) - _MAX_FOLDERS), last):
        yield "/".join(names[start:])
