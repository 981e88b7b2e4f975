"""Print what the tables have otherwise than upstream: `python -m tests.known.compare_upstream CHECKOUT...`.

The arguments are clones of the repositories in READERS, with the branches of their releases, which are read with git and not
checked out. Each line is a release and what differs there; a release without a branch is named. Nothing is written:
read the difference in the sources, and correct the table. `--since RELEASE` ignores older releases.
"""

import argparse
import posixpath
import re
import subprocess
import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import cast

import yaml

from grader.ros.interfaces.known_interfaces import known_interfaces
from grader.ros.known.parameter_rows import COVERED, ParameterRow, known_nodes, node_rows
from grader.ros.known.releases import RELEASES, Release, is_before, names_in, releases_with
from grader.ros.launch.launch_classes import class_named, first_release, front_end
from tests.interfaces.make_known import PACKAGES, interfaces_in
from tests.launch.launch_api import table
from tests.parameters.make_known import SOURCES, rows_in

# Branches of other names than their releases; those of ros2_control that Lyrical is released from, by ros/rosdistro.
_BRANCHES: Mapping[Release, tuple[str, ...]] = {
    "foxy": ("foxy", "foxy-devel"),
    "galactic": ("galactic", "galactic-devel"),
    "rolling": ("rolling",),
}
_ALSO: Mapping[str, Mapping[Release, str]] = {
    repository: {"lyrical": "master"} for repository in (*SOURCES, "ros-controls/control_msgs")
}
_NAV2 = "ros-navigation/navigation2"
# A call that declares or reads a parameter, up to the name.
_DECLARES = re.compile(r"declare|getParam|get_param", re.IGNORECASE)
_TEXT = re.compile(r'"\.?([A-Za-z_][\w.]*)"')
_COMMENT = re.compile(r"//[^\n]*")
_MAX_BEFORE = 220  # characters between the start of a call and the name of its parameter
Difference = tuple[Release, str]
Reader = Callable[["Checkout", Release, str], Iterator[str]]


class Checkout:
    """A clone of a repository, of which branches are read."""

    def __init__(self, path: str) -> None:
        self.path = path
        self.repository = _name_of(path)

    def git(self, *arguments: str) -> bytes:
        """Return what git prints."""
        command = ["git", "-C", self.path, *arguments]
        return subprocess.run(command, check=True, capture_output=True).stdout

    def branch_of(self, release: Release) -> str | None:
        """Return the branch of a release; None where it has none of its own."""
        if self.repository == "ros/rosdistro":
            return "HEAD"  # one branch has a folder for each release
        names = {line.strip(" *+") for line in self.git("branch").decode().splitlines()}
        wanted = [*_BRANCHES.get(release, (release,)), _ALSO.get(self.repository, {}).get(release)]
        return next((name for name in wanted if name in names), None)

    def paths(self, branch: str) -> list[str]:
        """Return the paths of the files of a branch."""
        return self.git("ls-tree", "-r", "--name-only", branch).decode().splitlines()

    def text(self, branch: str, path: str) -> str:
        """Return the text of a file of a branch; empty where it is not there."""
        command = ["git", "-C", self.path, "show", f"{branch}:{path}"]
        return subprocess.run(command, capture_output=True, check=False).stdout.decode(
            "utf-8", "replace"
        )


def _name_of(path: str) -> str:
    parts = Path(path).resolve().parts
    for repository in READERS:
        owner, _, name = repository.partition("/")
        if f"{owner}+{name}" in parts or name in parts:
            return repository
    raise SystemExit(f"{path} is no checkout of {', '.join(READERS)}")


def _packages(checkout: Checkout, release: Release, branch: str) -> Iterator[str]:
    """Yield the packages of releases.toml that a release has, and should not have, or lacks."""
    text = checkout.text(branch, f"{release}/distribution.yaml")
    if not text:
        return
    released: set[str] = set()
    for name, repository in yaml.safe_load(text)["repositories"].items():
        of_release = repository.get("release") or {}
        if of_release.get("version"):
            released |= set(of_release.get("packages", [name]))
    for name in names_in("package"):
        is_known = release in releases_with("package", name)
        if is_known and name not in released:
            yield f"releases.toml has the package {name}, which is not released"
        if not is_known and name in released:
            yield f"releases.toml lacks the package {name}, which is released"


def _parameters_of_nav2(checkout: Checkout, release: Release, branch: str) -> Iterator[str]:
    """Yield the parameters that the sources of Nav2 declare in a release, and not in the one before,
    and of which no row is; and those that they do not declare any more. Names are compared by their
    last parts, as the texts in calls: a table may have what is declared in another way.
    """
    before = RELEASES[RELEASES.index(release) - 1]
    branch_before = checkout.branch_of(before)
    if branch_before is None:
        yield f"there is no branch of {before}, so changes of parameters are not seen"
        return
    packages = {re.split("/|::", node)[0] for node in known_nodes() if node.startswith("nav2_")}
    for package in sorted(packages):
        ends = {_last_part(row.name) for row in _rows_of_package(package, release)}
        now, then = (_declared_in_package(checkout, it, package) for it in (branch, branch_before))
        for name in sorted(now - then):
            if name not in ends:
                yield f"{package} declares {name}, of which no row is"
        for name in sorted(then - now):
            if name in ends:
                yield f"{package} does not declare {name} any more, of which a row is"


def _last_part(name: str) -> str:
    return name.rpartition(".")[2]


def _declared_in_package(checkout: Checkout, branch: str, package: str) -> set[str]:
    """Return the last parts of the names that the sources of a package declare."""
    names: set[str] = set()
    for path in checkout.paths(branch):
        is_source = path.startswith(f"{package}/") and path.endswith((".cpp", ".hpp"))
        if is_source and "/test" not in path:
            names |= {_last_part(name) for name in _declared_in(checkout.text(branch, path))}
    return names


def _rows_of_package(package: str, release: Release) -> list[ParameterRow]:
    rows: list[ParameterRow] = []
    for node in known_nodes():
        known = node_rows(node)
        if known is not None and re.split("/|::", node)[0] == package:
            rows += [row for row in known.own_rows if row.is_in(release)]
    return rows


def _declared_in(text: str) -> set[str]:
    """Return the texts that follow the start of a call that declares or reads a parameter."""
    text = _COMMENT.sub("", text)
    names: set[str] = set()
    for match in _TEXT.finditer(text):
        before = text[max(0, match.start() - _MAX_BEFORE) : match.start()]
        if _DECLARES.search(re.split(r"[;{}]\s*\n", before)[-1]):
            names.add(match[1])
    return names


def _parameters_of_controllers(checkout: Checkout, release: Release, branch: str) -> Iterator[str]:
    """Yield the parameters of controllers that differ from the files that describe them."""
    del branch  # `rows_in` knows it
    for node, paths in SOURCES[checkout.repository].items():
        upstream = rows_in(checkout.path, paths, release) or {}
        known = node_rows(node)
        rows = {row.name: row for row in known.in_release(release)} if known is not None else {}
        for name, fields in upstream.items():
            if name not in rows:
                yield f"{node} has the parameter {name}, of which no row is"
            elif rows[name].type != fields["type"]:
                yield f"{node}.{name} has the type {fields['type']}, the row {rows[name].type}"


def _interfaces(checkout: Checkout, release: Release, branch: str) -> Iterator[str]:
    """Yield the interfaces that the tables lack or have, and fields that differ."""
    repository = checkout.repository.partition("/")[2]
    by_package = interfaces_in(checkout.git("archive", branch), repository)
    for package in PACKAGES[repository]:
        upstream = {name.replace("/", "."): it for name, it in by_package.get(package, {}).items()}
        known = known_interfaces(package, (release,)) or {}
        for name in sorted(upstream.keys() ^ known.keys()):
            where = "upstream" if name in upstream else "the table"
            yield f"only {where} has {package}.{name}"
        for name in sorted(upstream.keys() & known.keys()):
            if [set(it.fields) for it in upstream[name].sections] != [
                set(it.fields) for it in known[name].sections
            ]:
                yield f"{package}.{name} has other fields"


def _launch(checkout: Checkout, release: Release, branch: str) -> Iterator[str]:
    """Yield the classes, arguments and words of launch files that the table lacks; it is that of
    Jazzy with what came later.
    """
    if is_before(release, "jazzy"):
        return
    with tempfile.TemporaryDirectory() as folder:
        archive = checkout.git("archive", branch)
        subprocess.run(["tar", "-x", "-C", folder], input=archive, check=True)
        upstream = table(Path(folder), with_later=False)
    for name, row in upstream["classes"].items():
        cls = class_named(name)
        if cls is None:
            yield f"launch_classes.json lacks the class {name}"
            continue
        given = {*row["positional"], *row["keyword_only"]}
        for parameter in sorted(given - cls.parameters.keys()):
            yield f"the class {name} has an argument {parameter}, which the table lacks"
    for kind in ("action", "substitution"):
        for word in sorted(upstream[kind].keys() - front_end(kind).keys()):
            yield f"launch_classes.json lacks the {kind} {word}"
        for word in sorted(upstream[kind].keys() & front_end(kind).keys()):
            since = first_release(kind, word)
            if since and is_before(release, cast("Release", since)):
                yield f"there is the {kind} {word}, which the table has from {since} on"


READERS: Mapping[str, Reader] = {
    "ros/rosdistro": _packages,
    _NAV2: _parameters_of_nav2,
    **dict.fromkeys(SOURCES, _parameters_of_controllers),
    "ros2/launch": _launch,
    "ros2/launch_ros": _launch,
    **dict.fromkeys(
        (
            *("ros2/common_interfaces", "ros2/rcl_interfaces", "ros2/example_interfaces"),
            *("ros2/geometry2", "ros2/unique_identifier_msgs", "ros/ros_tutorials"),
            "ros-controls/control_msgs",
        ),
        _interfaces,
    ),
}


def differences(checkouts: Iterable[str], since: Release) -> Iterator[Difference]:
    """Yield what differs, by release, the oldest first."""
    opened = [Checkout(path) for path in checkouts]
    for release in RELEASES[RELEASES.index(since) :]:
        for checkout in opened:
            reader = READERS[checkout.repository]
            branch = checkout.branch_of(release)
            has_rows = reader in (_packages, _interfaces, _launch) or release in COVERED
            if branch is None:
                yield release, f"{checkout.repository} has no branch of it: not compared"
            elif has_rows:
                for text in reader(checkout, release, branch):
                    yield release, f"{posixpath.basename(checkout.repository)}: {text}"


def main() -> None:
    """Print the differences."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("checkouts", nargs="+", metavar="CHECKOUT")
    parser.add_argument("--since", choices=RELEASES, default="humble")
    given = parser.parse_args()
    for release, text in differences(given.checkouts, given.since):
        print(f"{release}: {text}")


if __name__ == "__main__":
    main()
