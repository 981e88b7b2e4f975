"""The places of the nodes and names of a graph: layers from left to right, with few crossings."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from grader.base.grouping import Strings
from grader.base.transforms import add_up

_Arrow = tuple[str, str]  # the names of two items

_LETTER, _LINE = 7.2, 18  # width and height of a letter, in units of the drawing
_PADDING, _GAP, _BETWEEN = 12, 14, 70  # inside of a box, below it, and between layers
_MIN_WIDTH = 60
_MAX_LETTERS = 44
_MIN_ROW = 400.0  # width of the rows of boxes without an arrow
_SWEEPS = 6  # over the layers, to order each by the places of its neighbours


class DrawnBox(NamedTuple):
    """A box of the drawing with its lines of text; the place is its upper left corner."""

    id: str
    lines: Strings
    x: float
    y: float
    width: float
    height: float


class Curve(NamedTuple):
    """An arrow from the right side of one box to the left side of another."""

    source: str
    target: str
    path: str  # as SVG has it


class _GraphLayout(NamedTuple):
    """A drawing with its size."""

    boxes: Mapping[str, DrawnBox]
    curves: tuple[Curve, ...]
    width: float
    height: float


def lay_out(texts: Mapping[str, Sequence[str]], arrows: Sequence[_Arrow]) -> _GraphLayout:
    """Return the places of items with lines of text, and arrows between them.

    Items without an arrow stand in rows below. The result depends on nothing but the arguments.
    """
    joined = {name for pair in arrows for name in pair}
    linked = [name for name in texts if name in joined]
    layers = _in_layers(linked, arrows)
    sized = {name: _sized(name, lines) for name, lines in texts.items()}
    order = _with_few_crossings(layers, arrows)
    boxes, height = _place_layers(order, sized)
    others = [box for name, box in sized.items() if name not in joined]
    height = _place_others(others, boxes, height)
    width = max((box.x + box.width for box in boxes.values()), default=0.0)
    curves = []
    for source, target in arrows:
        curves.append(Curve(source, target, _curve(boxes[source], boxes[target])))
    return _GraphLayout(boxes, tuple(curves), _rounded(width), _rounded(height))


def _place_layers(
    order: Sequence[Sequence[str]], sized: Mapping[str, DrawnBox]
) -> tuple[dict[str, DrawnBox], float]:
    """Return the boxes of each layer above each other, and the height of the highest layer."""
    boxes = {}
    heights = []
    for names in order:
        heights.append(add_up(sized[name].height + _GAP for name in names))
    height = max(heights, default=0.0)
    x = 0.0
    for names, own_height in zip(order, heights, strict=True):
        width = max(sized[name].width for name in names)
        y = (height - own_height) / 2
        for name in names:
            box = sized[name]
            boxes[name] = box._replace(x=x + (width - box.width) / 2, y=y)
            y += box.height + _GAP
        x += width + _BETWEEN
    return boxes, height


def _sized(name: str, lines: Sequence[str]) -> DrawnBox:
    """Return a box that holds lines of text, without its place."""
    shown = []
    for line in lines:
        is_long = len(line) > _MAX_LETTERS
        shown.append(f"{line[: _MAX_LETTERS - 3]}..." if is_long else line)
    width = max(_MIN_WIDTH, max(map(len, shown)) * _LETTER + 2 * _PADDING)
    return DrawnBox(name, tuple(shown), 0, 0, width, len(shown) * _LINE + _PADDING)


def _in_layers(names: Sequence[str], arrows: Sequence[_Arrow]) -> dict[str, int]:
    """Return the layer of each item: one more than the last that leads to it.

    An arrow that closes a circle counts for nothing.
    """
    after: dict[str, list[str]] = {name: [] for name in names}
    for source, target in arrows:
        after[source].append(target)
    forward = _without_circles(names, after)
    layers = dict.fromkeys(names, 0)
    for _ in names:  # the longest way has fewer arrows
        is_done = True
        for source, target in forward:
            if layers[target] <= layers[source]:
                layers[target] = layers[source] + 1
                is_done = False
        if is_done:
            break
    return layers


def _without_circles(names: Sequence[str], after: Mapping[str, Sequence[str]]) -> list[_Arrow]:
    """Return the arrows without those that lead back to an item on the way to them."""
    forward = []
    state = {}  # whether an item is on the way; absent before it is met
    for start in names:
        if start in state:
            continue
        state[start] = True
        stack = [(start, iter(after[start]))]
        while stack:
            name, targets = stack[-1]
            target = next(targets, None)
            if target is None:
                state[name] = False
                stack.pop()
            elif not state.get(target, False):
                forward.append((name, target))
                if target not in state:
                    state[target] = True
                    stack.append((target, iter(after[target])))
    return forward


def _with_few_crossings(layers: Mapping[str, int], arrows: Sequence[_Arrow]) -> list[list[str]]:
    """Return the items of each layer, ordered by the middle of their neighbours."""
    order: list[list[str]] = [[] for _ in range(max(layers.values(), default=-1) + 1)]
    for name, layer in layers.items():
        order[layer].append(name)
    neighbours: dict[str, list[str]] = {name: [] for name in layers}
    for source, target in arrows:
        neighbours[source].append(target)
        neighbours[target].append(source)
    for sweep in range(_SWEEPS):
        places = _places_in(order)
        for names in order if sweep % 2 == 0 else reversed(order):
            middles = {}
            for name in names:
                others = neighbours[name]
                middles[name] = add_up(places[other] for other in others) / len(others)
            names.sort(key=middles.__getitem__)
            places.update(_places_in([names]))
    return order


def _places_in(order: Sequence[Sequence[str]]) -> dict[str, float]:
    """Return where each item is in its layer, from -0.5 to 0.5."""
    places = {}
    for names in order:
        for index, name in enumerate(names):
            places[name] = (index + 0.5) / len(names) - 0.5
    return places


def _place_others(others: Sequence[DrawnBox], boxes: dict[str, DrawnBox], height: float) -> float:
    """Add the boxes of items without an arrow in rows below, and return the height of all."""
    width = max([_MIN_ROW, *(box.x + box.width for box in boxes.values())])
    x = 0.0
    y = height
    for box in others:
        if x > 0 and x + box.width > width:
            x = 0.0
            y = y + box.height + _GAP
        boxes[box.id] = box._replace(x=x, y=y)
        x += box.width + _GAP
        height = y + box.height + _GAP
    return height


def _curve(source: DrawnBox, target: DrawnBox) -> str:
    """Return a curve between the sides of two boxes that face each other."""
    start_x = source.x + source.width
    end_x = target.x
    start_y = source.y + source.height / 2
    end_y = target.y + target.height / 2
    bend = max(30.0, abs(end_x - start_x) / 2)
    numbers = [start_x, start_y, start_x + bend, start_y, end_x - bend, end_y, end_x - 5, end_y]
    words = [f"{_rounded(number):g}" for number in numbers]
    return f"M{words[0]} {words[1]}C{' '.join(words[2:])}"


def _rounded(number: float) -> float:
    return round(number, 1) + 0.0
