"""The attempts of a submission: those that a name numbers, and the copies that a browser numbers."""

import re
from collections.abc import Iterable
from typing import NamedTuple

from grader.classroom.intake.layouts.layout import IgnoredFiles
from grader.classroom.intake.names import ENDINGS, ending_of, without_copy
from grader.classroom.listing import ClassListing
from grader.text import printable_path

_ATTEMPT = re.compile(r"(?:attempt|submission|try|versuch|abgabe)[ _-]?([0-9]{1,6})", re.IGNORECASE)


_MAX_ATTEMPTS = 1_000


class Attempts(NamedTuple):
    """The last attempt, its number, and the earlier ones in order."""

    last: str
    number: int
    earlier: tuple[str, ...]


def attempts_in(listing: ClassListing, folder: str) -> Attempts | None:
    """Return the attempts in a folder that contains nothing else; of two with the same number a folder is later."""
    first = first_of(listing, folder)
    if first is None or _number(first) is None:  # a shortcut for nearly all folders
        return None
    children = listing.children(folder, _MAX_ATTEMPTS)
    found: list[tuple[int, bool, str]] = []
    for names, is_folder in ((children.folders, True), (children.files, False)):
        for name in names:
            number = _number(name)
            if number is None or not (is_folder or ending_of(name)):
                return None
            found.append((number, is_folder, f"{folder}/{name}"))
    if not found or children.refused:
        return None
    *earlier, last = sorted(found)
    return Attempts(last[2], last[0], tuple(path for *_, path in earlier))


def first_of(listing: ClassListing, folder: str) -> str | None:
    """Return one name in a folder; None if it is empty or cannot be opened."""
    children = listing.children(folder)
    return next(iter((*children.folders, *children.files, *(name for name, _ in children.refused))), None)


def home_of(path: str) -> str:
    """Return the part of a submission's path that its other attempts, copies and endings share."""
    folder, _, name = path.rpartition("/")
    if folder and _number(name) is not None:
        return home_of(folder)
    ending = ending_of(name)
    return f"{folder}/{without_copy(name.removesuffix(ending), ending)[0]}"


def _number(name: str) -> int | None:
    found = _ATTEMPT.fullmatch(name.removesuffix(ending_of(name)))
    return int(found[1]) if found else None


def last_copy(names: Iterable[tuple[int, str]], folders: set[str], ignored: IgnoredFiles, start: str) -> Attempts:
    """Return the copies as attempts, by the browser's numbers; of one number a folder counts, or the best ending."""
    by_number: dict[int, list[str]] = {}
    for number, name in names:
        by_number.setdefault(number, []).append(name)
    chosen: list[str] = []
    for _, same in sorted(by_number.items()):
        first, *others = sorted(
            same, key=lambda name: (-1 if name in folders else ENDINGS.index(ending_of(name).lower()), name)
        )
        chosen.append(first)
        reason = f"was ignored: {printable_path(first)} has the same name, and counts"
        ignored.add_all(start, ((other, reason) for other in others))
    return Attempts(chosen[-1], len(chosen), tuple(chosen[:-1]))
