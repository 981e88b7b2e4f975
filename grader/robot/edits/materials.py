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


def material(draft: Draft, reference: Draft, link: str) -> Iterator[Proposal]:
    """Name a material or correct its colour: a misspelt name, no material in the visual, 0 1 0 1 for the green of the lab."""
    own, other = draft.link(link), reference.link(link)
    visual = child_of(own, "visual") if own is not None else None
    expected = reference.robot.link(link).visuals if other is not None else ()
    wanted = next((shown.material for shown in expected[:1] if shown.material is not None), None)
    if visual is None or wanted is None:
        return
    of, used = f"the visual of {link!r}", child_of(visual, "material")
    for known in islice((found for found in draft.robot.materials if _is_alike(found, wanted)), _MAX_NAMES):
        if used is None:
            yield Proposal(
                draft.insert(visual, f'<material name="{known.name}"/>'),
                "the material{}, which is missing",
                "name the material{}",
                of,
                link,
            )
        elif used.get("name") != known.name:
            yield from (
                Proposal(edits, "the name of the material", "correct the name of the material{}", of, link)
                for edits in draft.set(used, "name", known.name)
            )
    name = (used.get("name") if used is not None else None) or wanted.name
    for found in draft.root.iterchildren("material"):
        if found.get("name") != name and _is_alike_text(found, wanted):
            for edits in draft.set(found, "name", name):
                yield Proposal(edits, "the name of the material's definition", f"call the material {name!r}", "", link)
    colour = " ".join(f"{channel:g}" for channel in wanted.rgba)
    definition = f'<material name="{name}">\n  <color rgba="{colour}"/>\n</material>'
    defined = draft.material(name)
    if used is None:
        yield Proposal(
            draft.insert(visual, definition), "the material{}, which is missing", "add the material{}", of, link
        )
        return
    if name != wanted.name and len(used):
        for edits in draft.set(used, "name", wanted.name):
            yield Proposal(edits, "the name of the material", "correct the name of the material{}", of, link)
    if name != wanted.name and draft.material(wanted.name) is None:
        second = definition.replace(f'"{name}"', f'"{wanted.name}"', 1)
        edits = (*draft.set(used, "name", wanted.name)[0], *draft.insert(draft.root, second))
        yield Proposal(edits, "the material", "name another material{}, and define it", of, link)
    yield Proposal(
        draft.insert(draft.root, definition),
        f"the material {name!r}{{}}, which is not defined under <robot>",
        "define the material{}",
        of,
        link,
    )
    for found in (found for found in (defined, used) if found is not None and (found is defined or len(found))):
        inside = child_of(found, "color")
        if inside is None:
            yield Proposal(
                draft.insert(found, f'<color rgba="{colour}"/>'),
                "the colour{}, which is missing",
                "add the colour{}",
                of,
                link,
            )
        elif inside.get("rgba") != colour:
            given = values_of(inside.get("rgba") or "")
            change, is_named = named(Slot("rgba", given), wanted.rgba)
            if is_named:
                for edits in draft.set(inside, "rgba", written(change.values)):
                    yield Proposal(edits, change.cause, change.action, of, link)
            if len(given) == 4:  # the opacity stays
                kept = written((*wanted.rgba[:3], given[3]))
                for edits in draft.set(inside, "rgba", kept):
                    yield Proposal(edits, "the colour", f"set the colour{{}} to {kept}", of, link)
            yield from (
                Proposal(edits, "the colour", f"set the colour{{}} to {colour}", of, link)
                for edits in draft.set(inside, "rgba", colour)
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


def _is_alike_text(definition: Element, wanted: Material) -> bool:
    colour = child_of(definition, "color")
    values = values_of(colour.get("rgba") or "") if colour is not None else ()
    return len(values) == 4 and all(abs(a - b) < 0.01 for a, b in zip(values, wanted.rgba, strict=True))


def _is_alike(one: Material, other: Material) -> bool:
    return all(abs(a - b) < 0.01 for a, b in zip(one.rgba, other.rgba, strict=True))
