"""Heat from sources to sinks: of the whole rig at one stage, and through the bodies of one gearbox."""

from collections import defaultdict
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rigdesign.report.figures.drawing import new_figure, plain
from rigdesign.report.numbers import quantity_text
from rigdesign.report.palette import INK, SERIES
from rigdesign.results.housing import CoolingBalance, HousingTemperatures
from rigdesign.results.thermal import LossRow, OilRow

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# Layout of a flow diagram: nodes in columns, ribbons between them whose widths add up. No drawing.

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
    return SankeyLayout(tuple(boxes.values()), tuple(_placed_ribbons(kept, boxes, scale)), scale)


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


def _placed_ribbons(flows: Sequence[Flow], boxes: Mapping[str, Box], scale: float) -> list[Ribbon]:
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


OIL, BODIES, COOLER, ROOM, HEATERS = "oil", "gears, shafts, housings", "cooler", "room", "oil heaters"
STREAMS = "streams of the housings"
MACHINES = "motor and drive"
TURNING, STANDING = "gears and shafts", "housing and field"
WORDS = {
    "mesh_loss": "tooth friction",
    "bearing": "bearings",
    "squeeze": "squeezed oil",
    "mesh": "tooth friction",
    "air": "room air",
    "radiation": "radiation to the room",
    "chamber_radiation": "radiation in chambers",
    "bearing_film": "bearing films",
    "exchange": "seal gaps",
    "bearing_seats": "through rolling bearings",
    "bearing_loss": "rolling bearings",
}
LABEL_ROOM = 0.062
"""Between labels, as a share of the height."""


def rig_flow_figure(
    losses: Sequence[LossRow], oil: Sequence[OilRow], cooler: CoolingBalance
) -> "Figure | None":
    """Losses of one stage by kind, through oil and bodies, to cooler and room [W]; None without a loss.

    losses, oil : rows of the stage; cooler : its heat balance
    """
    into_oil: dict[str, float] = defaultdict(float)
    into_bodies: dict[str, float] = defaultdict(float)
    for row in losses:
        if not (row.into_oil or row.into_body):
            continue  # work of the mesh dampers is no heat
        into_oil[_words(row.kind)] += row.into_oil
        into_bodies[_words(row.kind)] += row.into_body
    flows = [Flow(kind, OIL, max(power, 0.0)) for kind, power in into_oil.items()]
    flows += [Flow(kind, BODIES, max(power, 0.0)) for kind, power in into_bodies.items()]
    if cooler.machines:
        flows.append(Flow(MACHINES, OIL, cooler.machines))
    flows += [Flow(HEATERS, OIL, cooler.heater), Flow(OIL, COOLER, cooler.cooler)]
    flows.append(Flow(BODIES, ROOM, max(cooler.room, 0.0)))
    flows.append(Flow(BODIES, STREAMS, max(cooler.streams or 0.0, 0.0)))
    given = sum(row.heat for row in oil) - sum(row.into_oil for row in losses)
    flows.append(Flow(BODIES, OIL, given) if given >= 0.0 else Flow(OIL, BODIES, -given))
    totals = {kind: into_oil[kind] + into_bodies[kind] for kind in into_oil}
    kinds = sorted(totals, key=lambda kind: (into_bodies[kind] > 0.1 * totals[kind], -totals[kind]))
    if not any(flow.value > 0.0 for flow in flows):
        return None
    middle, bodies = ([BODIES, OIL], 1) if given >= 0.0 else ([OIL, BODIES], 2)
    columns = [
        [HEATERS, *([MACHINES] if cooler.machines else []), *kinds],
        [middle[0]],
        [middle[1]],
        [COOLER, ROOM, STREAMS],
    ]
    return _drawn(layout(columns, flows, low=(bodies,)), len(kinds) + 1)


def body_flow_figure(thermal: HousingTemperatures) -> "Figure":
    """Heat into and out of the solids of one gearbox by kind of boundary [W]."""
    flows: dict[tuple[str, str, bool], float] = defaultdict(float)
    for row in thermal.heat:
        if row.area == 0.0 and row.surface not in thermal.bodies:
            continue  # of a volume of fluid
        kind = _words(row.kind.partition(":")[0])
        group = TURNING if row.surface.startswith(("shaft_", "gear_")) else STANDING
        flows[kind, group, row.power > 0.0] += abs(row.power)
    sources = _by_size({key: power for key, power in flows.items() if key[2]})
    sinks = _by_size({key: power for key, power in flows.items() if not key[2]})
    ribbons = [
        Flow(f"{kind} ", group, power) if source else Flow(group, f" {kind}", power)
        for (kind, group, source), power in flows.items()
    ]
    columns = [[f"{kind} " for kind in sources], [TURNING, STANDING], [f" {kind}" for kind in sinks]]
    return _drawn(layout(columns, ribbons, gap=0.09), max(len(sources), len(sinks)))


def _by_size(flows: Mapping[tuple[str, str, bool], float]) -> list[str]:
    totals: dict[str, float] = defaultdict(float)
    for (kind, _, _), power in flows.items():
        totals[kind] += power
    return sorted(totals, key=lambda kind: -totals[kind])


def _words(kind: str) -> str:
    return WORDS.get(kind, kind.replace("_", " "))


def _drawn(found: SankeyLayout, rows: int) -> "Figure":
    height = max(2.6, 0.9 + 0.34 * rows)
    figure = new_figure(height)
    axes = figure.add_axes((0.21, 0.03, 0.56, 0.92))
    axes.set_xlim(0.0, 1.0)
    axes.set_ylim(-0.07, 1.05)
    axes.set_axis_off()
    colours = _colours(found)
    _ribbons(axes, found, colours)
    _boxes(axes, found, colours)
    return figure


def _colours(found: SankeyLayout) -> dict[str, str]:
    """Sources each by a colour of their own, everything else in ink."""
    sources = [box.name for box in found.boxes if box.column == 0]
    return {name: SERIES[i % len(SERIES)] for i, name in enumerate(sources)}


def _ribbons(axes: "Axes", found: SankeyLayout, colours: Mapping[str, str]) -> None:
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path

    for ribbon in found.ribbons:
        (x0, low0, high0), (x1, low1, high1) = ribbon.start, ribbon.end
        middle = 0.5 * (x0 + x1)
        points = [
            (x0, low0), (middle, low0), (middle, low1), (x1, low1), (x1, high1), (middle, high1), (middle, high0),
            (x0, high0), (x0, low0),
        ]  # fmt: skip
        codes = [Path.MOVETO, *[Path.CURVE4] * 3, Path.LINETO, *[Path.CURVE4] * 3, Path.CLOSEPOLY]
        colour = colours.get(ribbon.flow.source, "#6b7a87")
        axes.add_patch(PathPatch(Path(points, codes), facecolor=colour, alpha=0.42, linewidth=0))


def _boxes(axes: "Axes", found: SankeyLayout, colours: Mapping[str, str]) -> None:
    from matplotlib.patches import Rectangle

    last = max(box.column for box in found.boxes)
    for column in range(last + 1):
        boxes = [box for box in found.boxes if box.column == column]
        heights = spread([0.5 * (box.low + box.high) for box in boxes], LABEL_ROOM)
        for box, height in zip(boxes, heights, strict=True):
            size = box.high - box.low
            colour = colours.get(box.name, INK)
            axes.add_patch(Rectangle((box.x, box.low), NODE_WIDTH, size, facecolor=colour, edgecolor="none"))
            power = quantity_text(box.value, "W", digits=3)
            text = f"{plain(box.name.strip())}  {power}"
            if column in (0, last):
                _outer_label(axes, box.x, 0.5 * (box.low + box.high), height, text, left=column == 0)
            else:
                below = box.low < 0.02
                axes.annotate(
                    text, (box.x + 0.5 * NODE_WIDTH, box.low if below else box.high), ha="center",
                    va="top" if below else "bottom", textcoords="offset points", xytext=(0, -3 if below else 3),
                    fontsize=8, fontweight="bold",
                    bbox={"facecolor": "white", "alpha": 0.8, "linewidth": 0.0, "pad": 1.0},
                )  # fmt: skip


def _outer_label(axes: "Axes", x: float, at: float, height: float, text: str, *, left: bool) -> None:
    edge, far, align = (x, x - 0.025, "right") if left else (x + NODE_WIDTH, x + NODE_WIDTH + 0.025, "left")
    axes.plot([edge, far], [at, height], color=INK, linewidth=0.5, clip_on=False)
    shift = -0.006 if left else 0.006
    axes.text(far + shift, height, text, ha=align, va="center", fontsize=8)
