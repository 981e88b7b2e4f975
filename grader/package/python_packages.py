"""The Python packages that setuptools finds in a folder."""

from collections.abc import Iterator
from fnmatch import fnmatchcase

from grader.package.globbing import PackageListing
from grader.static_python.evaluation import Evaluation
from grader.static_python.values import Call, Unknown, Value


def find_packages(listing: PackageListing, _: Evaluation, call: Call) -> Value:
    """Return the folders with an __init__.py; those without need other rules."""
    where, exclude, include = (call.argument(place, name) for place, name in enumerate(("where", "exclude", "include")))
    exclude, include = () if exclude is None else exclude, ["*"] if include is None else include
    is_known = where in (None, ".", "./") and call.kwargs.keys() <= {"where", "exclude", "include"}
    is_listed = isinstance(exclude, list | tuple) and isinstance(include, list | tuple)
    if not is_known or "namespace" in call.name or not is_listed:
        return Unknown("which packages there are is not evaluated", call.at)
    return [name for name in _packages(listing, "") if _fits(name, include) and not _fits(name, exclude)]


def _packages(listing: PackageListing, folder: str) -> Iterator[str]:
    for name in listing.names(folder):
        path = below(folder, name)
        if "." not in name and f"{path}/__init__.py" in listing.files:
            yield path.replace("/", ".")
            yield from _packages(listing, path)


def below(folder: str, name: str) -> str:
    """Return the path of a name in a folder, which may be the package's, empty."""
    return f"{folder}/{name}" if folder else name


def _fits(name: str, patterns: Value) -> bool:
    return any(isinstance(pattern, str) and fnmatchcase(name, pattern) for pattern in patterns)
