"""A URDF rewritten as xacro: properties for repeated numbers, a macro for a link."""

import re
from collections import Counter
from random import Random

from grader.mutation.elements import Element, elements
from grader.xml.urdf_format import PARTS

_NAMESPACE = ' xmlns:xacro="http://www.ros.org/wiki/xacro"'
_NUMBER = re.compile(r"(?<![\w.+-])-?(?:0|[1-9]\d*)(?:\.\d+)?(?![\w.])")  # that xacro writes as it is
_MAX_PROPERTIES = 8
_MAX_DIGITS = 12  # that survive the conversion to a float and back


def with_properties(random: Random, text: str) -> str | None:
    """Return the text with properties for numbers that occur more than once; None where there are none."""
    spans = [
        (found.start() + attribute.value[0], found.end() + attribute.value[0])
        for element in elements(text)
        if not element.is_foreign
        for attribute in element.attributes
        if PARTS.get(attribute.name)
        for found in _NUMBER.finditer(text[slice(*attribute.value)])
        if len(found[0]) <= _MAX_DIGITS
    ]
    counts = Counter(text[start:end] for start, end in spans)
    repeated = [number for number, count in counts.items() if count > 1]
    if not repeated or "$" in text:
        return None
    chosen = random.sample(repeated, min(len(repeated), _MAX_PROPERTIES))
    names = {number: f"number_{index}" for index, number in enumerate(chosen)}
    for start, end in sorted(spans, reverse=True):
        if text[start:end] in names:
            text = f"{text[:start]}${{{names[text[start:end]]}}}{text[end:]}"
    properties = "".join(f'\n  <xacro:property name="{name}" value="{number}"/>' for number, name in names.items())
    return _inserted(text, properties)


def with_macro(random: Random, text: str) -> str | None:
    """Return the text with a macro for one of its links; None where it has none."""
    links = [found for found in elements(text) if found.tag == "link" and found.parent == 0 and _name(text, found)]
    if not links or "$" in text:
        return None
    link = random.choice(links)
    start, end = next(attribute.value for attribute in link.attributes if attribute.name == "name")
    body = f"{text[link.start : start]}${{name}}{text[end : link.end]}"
    call = f'<xacro:part name="{text[start:end]}"/>'
    macro = f'\n  <xacro:macro name="part" params="name">\n  {body}\n  </xacro:macro>'
    return _inserted(text[: link.start] + call + text[link.end :], macro)


def _name(text: str, link: Element) -> str:
    return next((text[slice(*found.value)] for found in link.attributes if found.name == "name"), "")


def _inserted(text: str, content: str) -> str:
    """Return the text with content at the start of its root, which declares the namespace of xacro."""
    root = elements(text)[0]
    end = root.head_end - 1
    return f"{text[:end]}{_NAMESPACE}{text[end : root.head_end]}{content}{text[root.head_end :]}"
