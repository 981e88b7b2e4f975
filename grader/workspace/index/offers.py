"""What an editor offers at a place: a name, what it is, and how well it fits."""

from collections.abc import Callable, Iterable
from typing import NamedTuple

from grader.ros.known.releases import RELEASES
from grader.ros.package.package import Package
from grader.workspace.index.typed_places import TypedPlace
from grader.workspace.model.workspace import Workspace

BEST, GOOD, POSSIBLE, UNLIKELY = range(4)


class Offer(NamedTuple):
    """A name that may be written at a place."""

    name: str
    detail: str = ""  # what it is, in a few words
    text: str = ""  # what is known of it, a fact a line
    rank: int = BEST


Offers = Iterable[Offer]
Finder = Callable[[Workspace, TypedPlace], Offers]


def offers(names: Iterable[str], detail: str, rank: int = BEST) -> Offers:
    """Return offers of names of one kind."""
    return (Offer(name, detail, "", rank) for name in names)


def offer_released(
    workspace: Workspace, name: str, detail: str, releases: Iterable[str], rank: int
) -> Offer:
    """Return the offer of what some releases have; none are named for what all have."""
    having = list(releases)
    wanted = workspace.releases or RELEASES[-1:]
    is_other = bool(having) and not {*having} & {*wanted}
    text = f"releases: {', '.join(having)}" if having else ""
    return Offer(name, detail, text, UNLIKELY if is_other else rank)


def package_at(workspace: Workspace, path: str) -> Package | None:
    """Return the innermost package that has a file."""
    holding = [package for package in workspace.packages if package.holds(path)]
    return max(holding, key=lambda package: len(package.folder), default=None)
