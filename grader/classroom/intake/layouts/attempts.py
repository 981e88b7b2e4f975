"""Several things of one student: attempts, of which the last counts, and names that differ in their ending only."""

import re
from collections.abc import Callable, Iterable
from typing import NamedTuple

from grader.classroom.intake.layouts.layout import IgnoredFiles
from grader.classroom.intake.listing import Listing
from grader.classroom.intake.names import ENDINGS, ending_of, without_copy
from grader.text import printable_path

_ATTEMPT = re.compile(r"(?:attempt|submission|try|versuch|abgabe)[ _-]?([0-9]{1,6})", re.IGNORECASE)
_MAX_ATTEMPTS = 1_000


class Attempts(NamedTuple):
    """What counts, the number of the attempt that it is, and the earlier ones in order."""

    last: str
    number: int
    earlier: tuple[str, ...]


def attempts_in(listing: Listing, folder: str) -> Attempts | None:
    """The attempts in a folder that holds nothing else; of two with the same number a folder is the later one."""
    first = listing.first(folder)
    if first is None or _number(first) is None:  # as nearly every folder is told
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


def home_of(path: str) -> str:
    """What the path of a submission has in common with its other attempts, copies and endings."""
    folder, _, name = path.rpartition("/")
    if folder and _number(name) is not None:
        return home_of(folder)
    ending = ending_of(name)
    return f"{folder}/{without_copy(name.removesuffix(ending), ending)[0]}"


def _number(name: str) -> int | None:
    found = _ATTEMPT.fullmatch(name.removesuffix(ending_of(name)))
    return int(found[1]) if found else None


def last_copy(
    names: Iterable[tuple[int, str]], is_folder: Callable[[str], bool], ignored: IgnoredFiles, start: str
) -> Attempts:
    """Of names with the numbers that a browser gave them the highest; of two with one number see `folders`."""
    by_number: dict[int, list[str]] = {}
    for number, name in names:
        by_number.setdefault(number, []).append(name)
    chosen: list[tuple[int, str]] = []
    for number, same in sorted(by_number.items()):
        best, *others = sorted(same, key=lambda name: (_rank(name, is_folder=is_folder(name)), name))
        chosen.append((number, best))
        for other in others:
            ignored.add(start + other, f"was passed over: {printable_path(best)} has the same name, and counts")
    *earlier, last = chosen
    return Attempts(last[1], len(chosen), tuple(name for _, name in earlier))


def _rank(name: str, *, is_folder: bool) -> int:
    return -1 if is_folder else ENDINGS.index(ending_of(name).lower())
