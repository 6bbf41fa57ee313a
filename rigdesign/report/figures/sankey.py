"""Layout of a flow diagram: nodes in columns, ribbons between them whose widths add up. No drawing."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

NODE_WIDTH = 0.022
"""Of a node, as a share of the picture's width."""
LEAST = 5e-4
"""Share of the whole below which a flow is left out: a line too thin to see."""


@dataclass(frozen=True)
class Flow:
    """A flow from one node to another, not below zero."""

    source: str
    target: str
    value: float


@dataclass(frozen=True)
class Box:
    """A node in the picture: left edge, lower and upper end, both 0 to 1."""

    name: str
    x: float
    low: float
    high: float
    value: float
    column: int


@dataclass(frozen=True)
class Ribbon:
    """A flow in the picture: lower and upper end where it leaves and where it arrives."""

    flow: Flow
    start: tuple[float, float, float]
    """x, low, high."""
    end: tuple[float, float, float]


@dataclass(frozen=True)
class SankeyLayout:
    """Everything of a flow diagram; ``scale`` is height per unit of flow."""

    boxes: tuple[Box, ...]
    ribbons: tuple[Ribbon, ...]
    scale: float


def layout(
    columns: Sequence[Sequence[str]], flows: Sequence[Flow], *, gap: float = 0.05, low: Collection[int] = ()
) -> SankeyLayout:
    """Place nodes and ribbons.

    columns : names of the nodes from left to right, each from top to bottom
    flows : between nodes of different columns, to the right; ``gap`` is the room between nodes of a column
    low : numbers of the columns that stand at the bottom of the picture, not in the middle of its height
    Raises ValueError for a negative flow, a node in no column and a flow to the left.
    """
    place = {name: number for number, names in enumerate(columns) for name in names}
    for flow in flows:
        if flow.value < 0.0:
            raise ValueError(f"flow {flow.source} to {flow.target} is {flow.value}; turn it round")
        if flow.source not in place or flow.target not in place or place[flow.source] >= place[flow.target]:
            raise ValueError(f"flow {flow.source} to {flow.target} does not lead to a column on the right")
    whole = sum(flow.value for flow in flows if place[flow.source] == 0)
    kept = [flow for flow in flows if flow.value > LEAST * whole]
    sizes = {
        name: max(
            sum(flow.value for flow in kept if flow.source == name),
            sum(flow.value for flow in kept if flow.target == name),
        )
        for name in place
    }
    shown = [[name for name in names if sizes[name] > 0.0] for names in columns]
    scale = min(
        ((1.0 - gap * (len(names) - 1)) / sum(sizes[name] for name in names) for names in shown if names),
        default=1.0,
    )
    step = (1.0 - NODE_WIDTH) / max(1, len(columns) - 1)
    boxes = {
        box.name: box
        for number, names in enumerate(shown)
        for box in _column(_Column(number, number * step, low=number in low), names, sizes, scale, gap)
    }
    return SankeyLayout(tuple(boxes.values()), tuple(_ribbons(kept, boxes, scale)), scale)


@dataclass(frozen=True)
class _Column:
    """Place of a column: number, left edge, whether it stands at the bottom of the picture."""

    number: int
    x: float
    low: bool


def _column(
    place: _Column, names: Sequence[str], sizes: Mapping[str, float], scale: float, gap: float
) -> list[Box]:
    """Nodes of one column from the top."""
    height = scale * sum(sizes[name] for name in names) + gap * (len(names) - 1)
    top = height if place.low else 0.5 + 0.5 * height
    found = []
    for name in names:
        bottom = top - scale * sizes[name]
        found.append(Box(name, place.x, bottom, top, sizes[name], place.number))
        top = bottom - gap
    return found


def _ribbons(flows: Sequence[Flow], boxes: Mapping[str, Box], scale: float) -> list[Ribbon]:
    """Ribbons that leave and enter every node from the top in the order of the nodes on their other side."""
    leaving = {name: box.high for name, box in boxes.items()}
    entering = dict(leaving)
    starts: dict[Flow, tuple[float, float, float]] = {}
    for flow in sorted(flows, key=lambda f: -boxes[f.target].high):
        high = leaving[flow.source]
        leaving[flow.source] = low = high - scale * flow.value
        starts[flow] = (boxes[flow.source].x + NODE_WIDTH, low, high)
    found = []
    for flow in sorted(flows, key=lambda f: -boxes[f.source].high):
        high = entering[flow.target]
        entering[flow.target] = low = high - scale * flow.value
        found.append(Ribbon(flow, starts[flow], (boxes[flow.target].x, low, high)))
    return found


def spread(places: Sequence[float], room: float) -> list[float]:
    """Heights of labels near ``places`` (falling), at least ``room`` apart and between 0 and 1 where they fit."""
    found: list[float] = []
    for place in places:
        found.append(place if not found else min(place, found[-1] - room))
    if found and found[-1] < 0.0:
        found[-1] = 0.0
        for i in range(len(found) - 2, -1, -1):
            found[i] = max(found[i], found[i + 1] + room)
    return found
