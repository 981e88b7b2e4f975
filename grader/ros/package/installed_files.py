"""What builds install at the paths where files look for others, and what a package has instead."""

import re
from posixpath import basename, dirname
from typing import Literal

from grader.base.grouping import only_one
from grader.base.names import closest, near
from grader.base.patterns import on_use
from grader.base.records import Named
from grader.ros.package.package import CMAKE, Package

_FOR_TESTS = on_use(r"if\s*+\(\s*+BUILD_TESTING.*?(?:endif|\Z)", re.DOTALL)
_MAX_CMAKE, _MAX_FILE = 128 * 1024, 512 * 1024  # bytes


class Lookup(Named):
    """What a build installs at a path where a file is looked for, or why nothing.

    The reason is the end of a sentence.
    """

    state: Literal["installed", "unknown", "no build", "elsewhere", "not installed", "absent"]
    # the file of the package; elsewhere: where a build installs it, below the prefix
    path: str = ""
    text: str = ""


def look_up(owner: Package, target: str) -> Lookup:
    """Return what a build of a package installs at a path below the prefix.

    If it installs nothing there, return what the package has instead.
    """
    setup = owner.installation
    if not setup:
        return Lookup("no build", text=f"its package has no {owner.missing_build_file}")
    if setup.fault:
        if setup.unread:
            return Lookup("unknown", text=setup.unread)
        return Lookup("no build", text=setup.fault_text)
    if target in owner.installed:
        return Lookup("installed", owner.installed[target])
    if not setup.unknown:
        return _instead(owner, target)
    if setup.is_unknown_after_error:
        lookup = Lookup("no build", text=setup.faults[0].message)
    else:
        lookup = Lookup("unknown", text=f"cannot determine statically what {setup.file} installs")
    return lookup


def _instead(owner: Package, target: str) -> Lookup:
    """Return what a package, or a build of it, has instead of a file at a path below the prefix."""
    name = basename(target)
    sources = _meant_by(owner, target)
    elsewhere = next((path for path, source in owner.installed.items() if source in sources), "")
    if not sources:  # builds may install a file under another name
        elsewhere = next((path for path in owner.installed if basename(path) == name), "")
    if elsewhere:
        return Lookup("elsewhere", elsewhere, f"a build installs it as {elsewhere}")
    if not sources:
        return Lookup("absent", text=f"the package has no file {name!r}")
    text = f"a build does not install {sources[0]}"
    for path, source in owner.installed.items():
        if basename(source) == name:
            return Lookup("not installed", sources[0], f"{text}; it installs {source} as {path}")
    return Lookup("not installed", sources[0], text)


def _meant_by(owner: Package, target: str) -> list[str]:
    """Return the file of a package that is at the same place in its folder.

    If there is none, return all with the same name.
    """
    inside = target.removeprefix(owner.share)
    name = basename(target)
    if inside in owner.tree.files:
        return [inside]
    return owner.files_by_name.get(name, [])


def is_surely_absent(package: Package, target: str) -> bool:
    """Return whether a file is surely not installed at a path below the prefix.

    The package does not have the file.

    What a program writes is in a folder of its own, and like no other, or a folder itself.
    """
    folder, _, name = target.rpartition("/")
    folders = {dirname(path) for path in package.installed}
    is_like_another = similar_file(package, name) is not None
    return is_like_another or (folder in folders and "." in name)


def similar_file(package: Package, name: str) -> str | None:
    """Return the name of the file of a package that may be meant by another name."""
    return closest(name, map(basename, package.tree.files))


def meant_file(package: Package, target: str) -> str:
    """Return the only file of a package whose name a misspelt path below the prefix surely means.

    It is empty without one, and where the package has a file of the name that is written.
    """
    if _meant_by(package, target):
        return ""
    meant = near(basename(target), map(basename, package.tree.files))
    paths = [path for path in package.tree.files if basename(path) == meant]
    return only_one(paths) or ""


def are_installs_known(package: Package) -> bool:
    """Return whether it is known what a build of a package installs."""
    setup = package.installation
    is_known = setup is not None and not setup.fault and not setup.unknown
    return is_known and not _installs_for_tests(package)


def open_meant(
    package: Package, path: str, *, absent_are_empty: bool = False
) -> tuple[bytes, str] | None:
    """Return what builds install at a path below the prefix.

    If they install nothing, return the only file of its name in the package of the path.

    With `absent_are_empty`, a file that surely is not there is empty.
    """
    opened = package.open_installed(path)
    parts = path.split("/")
    owner = package.find(parts[1]) if opened is None and len(parts) > 2 else None
    if not owner:
        return opened
    named = _meant_by(owner, path)
    if (
        not named
        and absent_are_empty
        and are_installs_known(owner)
        and is_surely_absent(owner, path)
    ):
        return b"", path
    data = owner.tree.read(named[0], _MAX_FILE) if len(named) == 1 else None
    if data is not None:
        return (data, owner.path(named[0]))
    return None


def _installs_for_tests(package: Package) -> bool:
    """Return whether CMakeLists.txt installs something only if BUILD_TESTING is on.

    By default it is on.
    """
    if package.is_cmake:
        text = package.tree.files[CMAKE].read(_MAX_CMAKE).decode("utf-8", "replace")
    else:
        text = ""
    return any("install(" in block.lower() for block in _FOR_TESTS.findall(text))
