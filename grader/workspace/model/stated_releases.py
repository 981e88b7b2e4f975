"""The releases of ROS 2 for which a workspace says that it is."""

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import lru_cache

from grader.base.errors import InputError
from grader.base.names import first_part
from grader.base.patterns import on_use
from grader.files.tree import File, Tree
from grader.ros.known.releases import RELEASES, Release, StatedReleases
from grader.workspace.model.workspace import Workspace

_NAME = rf"({'|'.join(RELEASES)})(?![a-z0-9])"
_RELEASE = on_use(_NAME, re.IGNORECASE)
_LIST = rf"(?:\s*(?:[,/&|+]|_%7C_|\band\b|\bor\b)\s*(?:ROS ?2 )?{_NAME})*"
# What any file says: /opt/ros/humble, ros-humble-xacro, ros:humble.
_PLACE = on_use(rf"/opt/ros/{_NAME}|(?<![a-z])ros2?[:-]{_NAME}", re.IGNORECASE)
# A setting: ROS_DISTRO: humble, required-ros-distributions: humble; its value may be a list.
_SETTING = on_use(
    r"ros[_-]?2?[_-]?distr(?:o|ibution)s?\b[\"']?(?:\s*[:=]|\s)[\s\"'{$:=-]*"
    rf"(\[[^]]{{0,200}}|(?:{_NAME}[\s,\"'-]*)+)",
    re.IGNORECASE,
)
_SECOND_NAMES = "Fitzroy|Geochelone|Hawksbill|Irwini|Jalisco|Kaiju|Luth|Ridley"
# A sentence, a badge or a link in a line: ROS 2 Humble, ROS_2-Humble, docs.ros.org/en/humble.
_SENTENCE = on_use(
    rf"(?<![a-z])ROS[ _-]?2?(?:[\W_]*(?:distro\w{{0,30}}|version))?[\W_]{{0,5}}{_NAME}{_LIST}"
    rf"|{_NAME} (?:{_SECOND_NAMES})"
    rf"|(?:docs\.ros\.org/en|img\.shields\.io/ros/v)/{_NAME}|index\.ros\.org/[\w/]+#{_NAME}",
    re.IGNORECASE,
)
_BRANCH = on_use(rf"{_NAME}\W{{0,4}}branch|branch\W{{1,4}}{_NAME}", re.IGNORECASE)
# What a work was made from, and what it is for now: Ported from ROS 2 Jazzy to Lyrical.
_ORIGIN = on_use(
    r"\b(?:port|migrat|convert|upgrad|updat|mov|adapt|translat)\w*\b"
    r"(?:[ \n]+[\w/]+){0,4}?[ \n]+from"
    rf"\W{{1,4}}(?:ROS[ _-]?2?\W{{1,4}})?{_NAME}(?:\s+to\s+(?:ROS[ _-]?2?\s+)?(?P<to>{_NAME}))?"
    rf"|\b(?:originally|formerly|previously|initially)\b[^.\n]{{0,40}}?\b(?:for|on|in|with)\s+"
    rf"(?:ROS[ _-]?2?\W{{1,4}})?{_NAME}",
    re.IGNORECASE,
)
# What a workflow is run for: another branch than the one that is read.
_OF_BRANCH = on_use(rf"\b(?:ref\w*|branches)[ \t]*:[\s\[\"'-]*{_NAME}(?=[\"'\]\s])", re.IGNORECASE)
_OF_UBUNTU = {
    **dict.fromkeys(("20.04", "focal"), ("foxy", "galactic")),
    **dict.fromkeys(("22.04", "jammy"), ("humble", "iron")),
    **dict.fromkeys(("24.04", "noble"), ("jazzy", "kilted")),
    **dict.fromkeys(("26.04", "resolute"), ("lyrical",)),
}
# A line of a history: a date, and what was so then.
_HISTORY = on_use(r"^\W*(?:19|20)\d\d(?:[-./]\d\d?){0,2}\b[^\n]*", re.MULTILINE)
_UBUNTU = on_use(rf"\bubuntu:({'|'.join(map(re.escape, _OF_UBUNTU))})\b")
_VARIABLE = "ROS_DISTRO"
_COMMENT = on_use(r"(?:^|(?<=\s))#[^\n]*")
_MAX_FILES, _MAX_SIZE = 60, 128 * 1024  # of one kind; bytes


def stated_releases(tree: Tree) -> StatedReleases:
    """Return the releases that files of a workspace state.

    The files are its containers, workflows and README, else other texts, else images of Ubuntu.
    """
    every = list(tree.files.values())
    settings = [file for file in every if _is_container(file.name.lower())]
    settings += [file for file in tree.settings() if file.name != ".gitmodules"]
    readmes = [file for file in every if file.name.lower().startswith("readme")]
    texts = [file for file in every if file.suffix in (".md", ".sh", ".bash")]
    levels = [
        [(settings, _in_setting_of_every_branch), (_highest(tree, readmes), _in_prose)],
        [(settings, _in_setting)],
        [(readmes, _in_prose)],
        [(texts, _in_prose)],
        [(settings, _by_ubuntu)],
    ]
    for level in levels:
        stated = _stated_by(level)
        if stated.releases:
            return stated
    return StatedReleases()


def _highest(tree: Tree, files: Sequence[File]) -> list[File]:
    """Return the files beside the packages; an archive of a repository has all in one folder."""
    depth = len({first_part(path) for path in tree.files}) == 1
    return [file for file in files if file.path.count("/") <= depth]


_Reader = tuple[Sequence[File], Callable[[str], set[str]]]  # files, and what finds releases in them


def _stated_by(readers: Sequence[_Reader]) -> StatedReleases:
    """Return the releases that some files state, and which of them do."""
    stated = set()
    places = []
    for files, find in readers:
        for path, text in _read(files):
            names = find(text)
            if names:
                stated |= names
                places.append(path)
    releases = tuple(release for release in RELEASES if release in stated)
    return StatedReleases(releases, tuple(sorted(places)))


def _is_container(name: str) -> bool:
    is_compose = name.startswith(("compose", "docker-compose")) and name.endswith((".yml", ".yaml"))
    return is_compose or "dockerfile" in name


def _read(files: Sequence[File]) -> Iterator[tuple[str, str]]:
    """Yield the texts of files, with their paths; without comments, but for prose."""
    for file in files[:_MAX_FILES]:
        if file.size > _MAX_SIZE:
            continue
        try:
            text = file.read(_MAX_SIZE).decode("utf-8", "replace")
        except InputError:
            continue
        is_prose = file.name.lower().startswith("readme") or file.suffix == ".md"
        yield file.path, text if is_prose else _COMMENT.sub("", text)


def _names_in(pattern: re.Pattern[str], text: str) -> set[str]:
    """Return the releases in what a pattern matches."""
    releases: set[str] = set()
    for match in pattern.finditer(text):
        releases.update(name.lower() for name in _RELEASE.findall(match[0]))
    return releases


def _in_setting(text: str) -> set[str]:
    """Return the releases that a Dockerfile, a workflow or a script states."""
    return _names_in(_PLACE, text) | _names_in(_SETTING, text)


def _in_setting_of_every_branch(text: str) -> set[str]:
    """Return the same without the releases whose branches a workflow is for."""
    return _in_setting(text) - _names_in(_OF_BRANCH, text)


def _in_prose(text: str) -> set[str]:
    """Return the releases that a README states.

    Those that are on other branches, those that the work was ported from, and the older ones of a
    history are not among them.
    """
    text = _ORIGIN.sub(lambda match: f"ROS 2 {match['to'] or ''}", text)
    in_history = _in_lines(_HISTORY.findall(text))
    newest = sorted(in_history, key=RELEASES.index)[-1:]
    return _in_lines(_HISTORY.sub("", text).splitlines()) or {*newest}


def _in_lines(lines: Iterable[str]) -> set[str]:
    releases = set()
    for line in lines:
        releases |= (_in_setting(line) | _names_in(_SENTENCE, line)) - _names_in(_BRANCH, line)
    return releases


def _by_ubuntu(text: str) -> set[str]:
    """Return the releases for the images of Ubuntu that a Dockerfile or a workflow names."""
    releases: set[str] = set()
    for version in _UBUNTU.findall(text):
        releases.update(_OF_UBUNTU[version])
    return releases


def releases_in_path(path: str) -> list[Release]:
    """Return the releases that a file such as humble/nav2.yaml is for as well."""
    words = re.split("[^a-z]+", path.lower())
    return [release for release in RELEASES if release in words]


@lru_cache(maxsize=2)
def deciding_launch_files(workspace: Workspace) -> frozenset[str]:
    """Return the launch files that decide by the name of the release what each release has."""
    sources = [launch.source for launch in workspace.launches.every]
    return frozenset(source.path for source in sources if _VARIABLE in source.text)
