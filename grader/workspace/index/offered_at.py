"""The names that may be written at a place, by the kind of file and what is around it."""

from collections.abc import Iterable, Iterator, Mapping
from functools import partial
from itertools import product

from grader.base.patterns import on_use
from grader.ros.known.typed_places import TypedRow, typed_places
from grader.workspace.index import offered_builds as builds
from grader.workspace.index import offered_code as code
from grader.workspace.index import offered_names as names
from grader.workspace.index import offered_settings as settings
from grader.workspace.index.offers import UNLIKELY, Finder, Offer, Offers
from grader.workspace.index.typed_places import TypedPlace
from grader.workspace.model.workspace import Workspace

_WORD = on_use(r"[a-z]{2,}")
# By the names in typed_places.toml.
_FINDERS: Mapping[str, Finder] = {
    "RViz settings": settings.find_rviz_settings,
    "attributes": builds.find_attributes,
    "bridged": settings.find_bridged,
    "commands": builds.find_commands,
    "controllers": names.find_controllers,
    "declared parameters": code.find_declared_parameters,
    "dependencies": builds.find_dependencies,
    "elements": builds.find_elements,
    "fields": code.find_fields,
    "files": names.find_files,
    "frames": names.find_frames,
    "found packages": builds.find_found_packages,
    "hardware": settings.find_hardware,
    "imported types": code.find_imported_types,
    "included arguments": names.find_included_arguments,
    "keys": settings.find_keys,
    "needed targets": builds.find_needed_targets,
    "opened names": code.find_opened_names,
    "packages": names.find_packages,
    "program parameters": names.find_program_parameters,
    "programs": names.find_programs_at,
    "properties": builds.find_properties,
    "remapped names": code.find_remapped,
    "sources": builds.find_sources,
    "targets": builds.find_targets,
    "topics": code.find_topics,
    "types": code.find_types,
    "values": settings.find_values,
}


def offered_at(workspaces: Iterable[Workspace], place: TypedPlace) -> list[Offer]:
    """Return what may be written at a place, the best first; each name once.

    The first ones go on with what is typed; of these, the ones that fit best, and whose words are
    in the name of the attribute, argument or key: base_link for base_frame.
    """
    level = place.levels[0]
    listed = [level.given[key] for key in level.given if key.isdigit() or key == level.slot]
    given = " ".join(listed).split()
    best: dict[str, Offer] = {}
    for offer in (*_words_at(place), *_names_at(workspaces, place)):
        name = offer.name.removeprefix(place.before)
        rank = offer.rank + UNLIKELY * int(name in given)
        known = best.get(name)
        is_better = not known or rank < known.rank
        if name and is_better and offer.name.startswith(place.before):
            best[name] = offer._replace(name=name, rank=rank)
    beside = level.given.get("0" if place.part else "from", "")
    if place.language == "yaml":
        beside += f" {place.holder.name}"
    words = {*_WORD.findall(f"{place.holder.slot} {beside}".lower())}
    return sorted(best.values(), key=partial(_order, place.typed.lower(), words))


def _order(typed: str, words: set[str], offer: Offer) -> tuple[bool, bool, int, int, str]:
    name = offer.name.lower()
    shared = len(words & {*_WORD.findall(name)})
    return not name.startswith(typed), typed not in name, offer.rank, -shared, offer.name


def _words_at(place: TypedPlace) -> Offers:
    """Yield the words that a place may have, in the order of the table."""
    table = typed_places().words
    holder = place.holder
    words = table.get(f"{holder.name} {holder.slot}") or table.get(f"* {holder.slot}", {})
    for number, (word, meaning) in enumerate(words.items()):
        yield Offer(word, meaning, rank=number)


def _names_at(workspaces: Iterable[Workspace], place: TypedPlace) -> Iterator[Offer]:
    rows = [row for row in typed_places().row if _is_meant(row, place)]
    for workspace, row in product(workspaces, rows):
        if row.names:
            yield from _FINDERS[row.names](workspace, place)
        for rank, kind in enumerate(row.kinds):
            for offer in names.defined(workspace, place, kind):
                yield offer._replace(rank=offer.rank + rank)


def _is_meant(row: TypedRow, place: TypedPlace) -> bool:
    """Return whether a place is one of a row; what a row does not say may be anything."""
    holder = place.holder
    pairs = (row.holders, holder.name), (row.slots, holder.slot), (row.languages, place.language)
    is_there = all(not words or word in words for words, word in pairs)
    is_part = row.part in ("", place.part) and place.path.endswith(row.path)
    return is_there and is_part and row.is_text == place.is_text
