"""Edits of the materials of a robot: names, definitions and colours."""

from collections.abc import Iterator
from itertools import islice

from grader.edits import Proposal
from grader.robot.edits.draft import Draft, child_of
from grader.robot.edits.families import Slot, Values, named, written
from grader.robot.edits.values import values_of
from grader.robot.model import Material
from grader.xml.parsing import Element

_MAX_NAMES = 4  # materials that may be meant
_CLOSE = 0.01  # of a channel


def material(draft: Draft, reference: Draft, link: str) -> Iterator[Proposal]:
    """Name a material or correct its colour: a misspelt name, no material in the visual, 0 1 0 1 for the green of the lab."""
    own, other = draft.link(link), reference.link(link)
    visual = child_of(own, "visual") if own is not None else None
    expected = reference.robot.link(link).visuals if other is not None else ()
    wanted = next((shown.material for shown in expected[:1] if shown.material is not None), None)
    if visual is None or wanted is None:
        return
    used = child_of(visual, "material")
    found = _missing(draft, visual, wanted) if used is None else _used(draft, used, wanted)
    yield from (proposal._replace(of=f"the visual of {link!r}", link=link) for proposal in found)


def _missing(draft: Draft, visual: Element, wanted: Material) -> Iterator[Proposal]:
    """Name a material with the expected colour, or define one in the visual."""
    cause = "the material{} is missing"
    for known in _alike(draft, wanted):
        yield Proposal(draft.insert(visual, f'<material name="{known.name}"/>'), cause, "name the material{}")
    yield Proposal(draft.insert(visual, _definition(wanted.name, wanted)), cause, "add the material{}")


def _used(draft: Draft, used: Element, wanted: Material) -> Iterator[Proposal]:
    """Correct the name that a visual uses, the definition of that name, or its colour."""
    name = used.get("name") or wanted.name
    cause, action = "the name of the material", "correct the name of the material{}"
    others = [known.name for known in _alike(draft, wanted)] + ([wanted.name] if len(used) else [])
    for other in dict.fromkeys(others):
        if other != used.get("name"):
            yield from (Proposal(edits, cause, action) for edits in draft.set(used, "name", other))
    for found in draft.root.iterchildren("material"):
        if found.get("name") != name and _is_alike(_channels(found), wanted):
            for edits in draft.set(found, "name", name):
                yield Proposal(
                    edits, "the name of a definition", "correct the name of the definition of the material{}"
                )
    if name != wanted.name and draft.material(wanted.name) is None:
        definition = draft.insert(draft.root, _definition(wanted.name, wanted))
        edits = (*draft.set(used, "name", wanted.name)[0], *definition)
        yield Proposal(edits, "the material", "name another material{}, and define it")
    cause = "the material{}, which is not defined under <robot>"
    yield Proposal(draft.insert(draft.root, _definition(name, wanted)), cause, "define the material{}")
    defined = draft.material(name)
    for found in dict.fromkeys(found for found in (defined, used) if found is not None):
        if found is defined or len(found):
            yield from _colours(draft, found, wanted)


def _colours(draft: Draft, definition: Element, wanted: Material) -> Iterator[Proposal]:
    """Give a definition the expected colour; its opacity stays if that is enough."""
    inside, colour = child_of(definition, "color"), written(wanted.rgba)
    if inside is None:
        edits = draft.insert(definition, f'<color rgba="{colour}"/>')
        yield Proposal(edits, "the colour{} is missing", "add the colour{}")
        return
    given = _channels(definition)
    change, is_named = named(Slot("rgba", given), wanted.rgba)
    if is_named:
        for edits in draft.set(inside, "rgba", written(change.values)):
            yield Proposal(edits, change.cause, change.action)
    for text in dict.fromkeys((written((*wanted.rgba[:3], *given[3:4])), colour)):
        if len(text.split()) == len(wanted.rgba) and inside.get("rgba") != text:
            for edits in draft.set(inside, "rgba", text):
                yield Proposal(edits, "the colour", f"set the colour{{}} to {text}")


def _alike(draft: Draft, wanted: Material) -> Iterator[Material]:
    return islice((known for known in draft.robot.materials if _is_alike(known.rgba, wanted)), _MAX_NAMES)


def _definition(name: str, wanted: Material) -> str:
    return f'<material name="{name}">\n  <color rgba="{written(wanted.rgba)}"/>\n</material>'


def _channels(definition: Element) -> Values:
    colour = child_of(definition, "color")
    return values_of(colour.get("rgba") or "") if colour is not None else ()


def _is_alike(channels: Values, wanted: Material) -> bool:
    return len(channels) == len(wanted.rgba) and all(
        abs(a - b) < _CLOSE for a, b in zip(channels, wanted.rgba, strict=True)
    )


def coloured(draft: Draft, link: str, colour: Values) -> Iterator[Proposal]:
    """Give the material of a link the channels that a criterion expects."""
    own = draft.link(link)
    used = next(own.iter("material"), None) if own is not None else None
    defined = draft.material(used.get("name") or "") if used is not None else None
    inside = child_of(defined, "color") if defined is not None else None
    given = values_of(inside.get("rgba") or "") if inside is not None else ()
    if inside is not None and len(given) >= len(colour):
        wanted = (*colour, *given[len(colour) :])
        change, _ = named(Slot("rgba", given), wanted)
        for edits in draft.set(inside, "rgba", written(wanted)):
            yield Proposal(edits, change.cause, change.action, f"the visual of {link!r}", link)
