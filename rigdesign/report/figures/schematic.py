"""Schematic of the rig from the stated case: gearboxes, shafts, couplings, motor, bracing and oil, seen from above."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from textwrap import fill
from typing import TYPE_CHECKING

from rigdesign.base.part_name import GearName
from rigdesign.report.figures.drawing import new_figure, plain
from rigdesign.report.input_sheets import CaseSheet
from rigdesign.report.palette import INK, MUTED, gearbox_colours

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

BOX_HALF, WALL, GEAR_HALF = 0.3, 0.36, 0.055
"""Half widths of a gearbox, of its reach above the outer shafts, and of a gear, in distances between gearboxes."""
SMALL = 7.0
BRACINGS = {
    ("torque_controlled", "gear"): "load unit shifts it axially, torque controlled",
    ("shift_held", "gear"): "shifted axially and held",
    ("torque_controlled", "coupling"): "twisted, torque controlled",
    ("twist_held", "coupling"): "twisted and held",
}
"""What happens to the part that braces, by mode and part."""


@dataclass(frozen=True)
class DrawingForm:
    """Size of the drawing, and how its words are broken so that its type keeps its size.

    width : [in]; level : height of a line of shafts [in]
    above, below : room for words over the first and under the last line of shafts, in distances of the lines
    motor : its length, in distances between gearboxes
    title, circuit, note : most characters of a line
    """

    width: float
    level: float
    above: float
    below: float
    motor: float
    title: int
    circuit: int
    note: int
    stacked: bool = False
    """Names of gears and couplings in a line a word."""

    def gear_words(self, name: str, teeth: float) -> str:
        """Name of a gear with its teeth."""
        return "\n".join([*name.split(), f"z = {teeth:g}"]) if self.stacked else f"{name}, z = {teeth:g}"

    def coupling_words(self, name: str, state: str) -> str:
        """Name of a coupling and what is done to it, where something is; one word of that where words are few."""
        if self.stacked:
            return "\n".join(["coupling", *name.split(), *state.split()[:1]])
        return f"coupling {name}\n{state}".strip()

    def circuit_words(self, oil: str, feed: str) -> str:
        """An oil circuit with its temperature and flow."""
        text = f"{oil}:\n{feed}" if self.stacked else f"{oil}: {feed}"
        return "\n".join(fill(line, self.circuit, break_on_hyphens=False) for line in text.split("\n"))


PRINTED = DrawingForm(width=7.3, level=0.7, above=0.98, below=0.62, motor=0.2, title=60, circuit=60, note=200)
"""As wide as the text of a printed page."""
PHONE = DrawingForm(
    width=3.75, level=0.9, above=1.35, below=1.15, motor=0.36, title=16, circuit=27, note=64, stacked=True
)
"""As wide as a phone, for a rig of at most two gearboxes."""
PHONE_GEARBOXES = 2


@dataclass(frozen=True)
class Gear:
    """A gear at its gearbox (column) on its line of shafts (level)."""

    name: str
    column: int
    level: int
    teeth: float


@dataclass(frozen=True)
class RigPlan:
    """Where everything stands: columns are gearboxes, levels are lines of coupled shafts."""

    gears: Mapping[str, Gear]
    """By ``gearbox.gear``."""
    column_of: Mapping[str, int]
    """Of shafts."""
    level_of: Mapping[str, int]
    """Of shafts."""
    colours: Sequence[str]
    """Of gearboxes."""
    form: DrawingForm = PRINTED

    @property
    def levels(self) -> int:
        """How many lines of shafts lie one below the other."""
        return 1 + max((gear.level for gear in self.gears.values()), default=0)


def rig_plan(case: CaseSheet, form: DrawingForm = PRINTED) -> RigPlan:
    """Every gear by column and level: gears that mesh are neighbours, coupled shafts lie on one level."""
    lines = _lines(case)
    shafts: dict[GearName, str] = {}
    column_of: dict[str, int] = {}
    level: dict[str, int] = {}
    for column, (box, table) in enumerate(case.tables("gearboxes")):
        own = {gear: entry.raw("shaft", f"{box}.{gear}") for gear, entry in table.tables("gears")}
        shafts |= {GearName(box, gear): shaft for gear, shaft in own.items()}
        column_of |= {shaft: column for shaft in own.values() if shaft not in column_of}
        pairs = [(mesh.raw("pinion"), mesh.raw("wheel")) for _, mesh in table.tables("meshes")]
        known = {gear: level[lines.get(s, s)] for gear, s in own.items() if lines.get(s, s) in level}
        level |= {
            lines.get(own[gear], own[gear]): at for gear, at in _levels(list(own), pairs, known).items()
        }
    least = min(level.values(), default=0)
    level_of = {shaft: level[lines.get(shaft, shaft)] - least for shaft in column_of}
    gears: dict[str, Gear] = {
        name: Gear(name.part, column_of[shaft], level_of[shaft], _teeth(case, name))
        for name, shaft in shafts.items()
    }
    names = [name for name, _ in case.tables("gearboxes")]
    styles = gearbox_colours(names)
    return RigPlan(gears, column_of, level_of, [styles[name].colour for name in names], form)


def _teeth(case: CaseSheet, name: GearName) -> float:
    try:
        return float(case.raw(f"gearboxes.{name.gearbox}.gears.{name.part}.teeth"))
    except ValueError:
        return 1.0


def _levels(
    gears: Sequence[str], pairs: Sequence[tuple[str, str]], known: Mapping[str, int]
) -> dict[str, int]:
    """Levels of the gears of one gearbox, some of which its couplings fix: each next to a mate."""
    mates = {gear: [b for a, b in (*pairs, *(pair[::-1] for pair in pairs)) if a == gear] for gear in gears}
    found = {gear: at for gear, at in known.items() if gear in mates}
    for start in sorted(gears, key=lambda gear: (gear not in found, len(mates[gear]))):
        found.setdefault(start, 1 + max(found.values(), default=-1))
        waiting = [start]
        for gear in waiting:
            for mate in mates[gear]:
                if mate in found:
                    continue
                around = [found[other] for other in mates[mate] if other in found]
                between = (min(around) + max(around)) // 2 if len(set(around)) > 1 else around[0] + 1
                free = between not in found.values()
                found[mate] = between if free else 2 * around[0] - between
                waiting.append(mate)
    return found


def _lines(case: CaseSheet) -> dict[str, str]:
    """First shaft of the line of coupled shafts that a shaft belongs to."""
    line: dict[str, str] = {}
    for _, coupling in case.tables("drivetrain.couplings"):
        pair = [name.strip() for name in coupling.raw("shafts").split(",")]
        ends = {line.get(name, name) for name in pair}
        first = min(ends)
        line |= dict.fromkeys([*pair, *(name for name, at in line.items() if at in ends)], first)
    return line


def phone_schematic_figure(case: CaseSheet) -> "Figure | None":
    """The schematic as a phone shows it; None where it has no room for the rig."""
    if len(list(case.tables("gearboxes"))) > PHONE_GEARBOXES:
        return None
    return schematic_figure(case, PHONE)


def schematic_figure(case: CaseSheet, form: DrawingForm = PRINTED) -> "Figure | None":
    """The rig seen from above; None where the case states no gearbox."""
    plan = rig_plan(case, form)
    boxes = list(case.tables("gearboxes"))
    if not plan.gears:
        return None
    figure = new_figure(form.level * (plan.levels - 0.5 + form.above + form.below), form.width)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set_axis_off()
    side = BOX_HALF + 0.22 + form.motor
    left = BOX_HALF + 0.1 if form.stacked and _motor_side(case, plan, len(boxes)) > 0.0 else side
    axes.set_xlim(-left, len(boxes) - 1 + side)
    axes.set_ylim(plan.levels - 0.5 + form.below, -form.above)
    for number, (name, box) in enumerate(boxes):
        _gearbox(axes, number, (name, box), plan)
    for shaft in plan.column_of:
        _shaft(axes, plan, shaft)
    for gear in plan.gears.values():
        _gear(axes, gear, plan)
    _couplings(axes, case, plan)
    _motor(axes, case, plan, len(boxes))
    _bracing(axes, case, plan)
    return figure


def _gearbox(axes: "Axes", column: int, named: tuple[str, CaseSheet], plan: RigPlan) -> None:
    from matplotlib.patches import FancyBboxPatch

    name, box = named
    levels = [gear.level for gear in plan.gears.values() if gear.column == column]
    if not levels:
        return
    top, bottom = min(levels) - WALL - 0.12, max(levels) + WALL + 0.12
    colour = plan.colours[column]
    axes.add_patch(
        FancyBboxPatch(
            (column - BOX_HALF, top), 2 * BOX_HALF, bottom - top, boxstyle="round,pad=0,rounding_size=0.03",
            facecolor="#f3f5f7", edgecolor=colour, linewidth=1.3,
        )
    )  # fmt: skip
    role = box.raw("role")
    title = box.raw("title", absent=name) + (f" ({role})" if role else "")
    axes.text(
        column,
        top - 0.08,
        plain(fill(title, plan.form.title)),
        ha="center",
        va="bottom",
        fontsize=8,
        fontweight="bold",
        color=colour,
    )
    circuits = [_circuit(box, key, words) for key, words in CIRCUITS if box.table(key).entries]
    text = "\n".join(plan.form.circuit_words(*circuit) for circuit in circuits)
    axes.text(
        column, bottom + 0.08, plain(text), ha="center", va="top", fontsize=SMALL, color=INK, linespacing=1.25
    )


CIRCUITS = (("oil", "gear oil"), ("bearing_oil", "bearing oil"))


def _circuit(box: CaseSheet, key: str, words: str) -> tuple[str, str]:
    """Oil of a circuit or sump; its temperature and flow."""
    oil = box.table(key)
    words = "sump" if oil.raw("lubrication") == "dip" else words
    stated = (oil.value("inlet_temperature", "") or oil.value("sump_temperature", ""), oil.value("flow", ""))
    return f"{words} {oil.raw('oil')}", ", ".join(part for part in stated if part)


def _shaft(axes: "Axes", plan: RigPlan, shaft: str) -> None:
    """Its length in the gearbox, with a bearing in each wall."""
    from matplotlib.patches import Rectangle

    column, level = plan.column_of[shaft], plan.level_of[shaft]
    axes.plot([column - BOX_HALF - 0.05, column + BOX_HALF + 0.05], [level, level], color=INK, linewidth=2.0)
    for wall in (column - BOX_HALF, column + BOX_HALF):
        axes.add_patch(
            Rectangle(
                (wall - 0.014, level - 0.09), 0.028, 0.18, facecolor="white", edgecolor=INK, linewidth=0.8
            )
        )


def _gear(axes: "Axes", gear: Gear, plan: RigPlan) -> None:
    """A rectangle as high as its share of the teeth of its mesh, so that mates touch."""
    from matplotlib.patches import Rectangle

    mates = [
        other
        for other in plan.gears.values()
        if other.column == gear.column and abs(other.level - gear.level) == 1
    ]
    half = min((gear.teeth / (gear.teeth + mate.teeth) for mate in mates), default=0.4)
    colour = plan.colours[gear.column]
    axes.add_patch(
        Rectangle(
            (gear.column - GEAR_HALF, gear.level - half), 2 * GEAR_HALF, 2 * half, facecolor=colour, alpha=0.75,
            edgecolor="white", linewidth=0.8,
        )
    )  # fmt: skip
    words = plan.form.gear_words(gear.name.replace("_", " "), gear.teeth)
    axes.text(
        gear.column + GEAR_HALF + 0.01, gear.level - 0.1, plain(words), ha="left", va="bottom", fontsize=6.5, color=INK
    )  # fmt: skip


def _couplings(axes: "Axes", case: CaseSheet, plan: RigPlan) -> None:
    for name, coupling in case.tables("drivetrain.couplings"):
        ends = [end.strip() for end in coupling.raw("shafts").split(",")]
        if not all(end in plan.column_of for end in ends):
            continue
        first, second = sorted(ends, key=lambda end: plan.column_of[end])
        level = plan.level_of[first]
        left, right = plan.column_of[first] + BOX_HALF + 0.05, plan.column_of[second] - BOX_HALF - 0.05
        middle = 0.5 * (left + right)
        for start, end in ((left, middle - 0.02), (middle + 0.02, right)):
            axes.plot([start, end], [level, level], color=INK, linewidth=2.0)
        for x in (middle - 0.02, middle + 0.02):
            axes.plot([x, x], [level - 0.17, level + 0.17], color=INK, linewidth=2.4, solid_capstyle="butt")
        own = case.raw("drivetrain.bracing.coupling") == name
        twisted = BRACINGS.get((case.raw("drivetrain.bracing.mode"), "coupling"), "") if own else ""
        words = plan.form.coupling_words(name.replace("_", " "), twisted)
        axes.text(middle, level + 0.22, plain(words), ha="center", va="top", fontsize=6.5, color=INK)


def _motor(axes: "Axes", case: CaseSheet, plan: RigPlan, boxes: int) -> None:
    from matplotlib.patches import Rectangle

    shaft = case.raw("drivetrain.motor.shaft")
    if shaft not in plan.column_of:
        return
    column, level = plan.column_of[shaft], plan.level_of[shaft]
    side = _motor_side(case, plan, boxes)
    near, far = column + side * (BOX_HALF + 0.05), column + side * (BOX_HALF + 0.17)
    axes.plot([near, far], [level, level], color=INK, linewidth=2.0)
    length = plan.form.motor
    start = far if side > 0 else far - length
    axes.add_patch(
        Rectangle((start, level - 0.24), length, 0.48, facecolor="white", edgecolor=INK, linewidth=1.1)
    )
    torque = case.value("drivetrain.motor.torque_limit", "")
    axes.text(
        start + 0.5 * length,
        level,
        plain("motor" + (f"\n≤ {torque}" if torque else "")),
        ha="center",
        va="center",
        fontsize=SMALL,
    )


def _motor_side(case: CaseSheet, plan: RigPlan, boxes: int) -> float:
    """1 right of the rig, -1 left of it."""
    column = plan.column_of.get(case.raw("drivetrain.motor.shaft"), boxes - 1)
    return 1.0 if column > 0 or boxes == 1 else -1.0


def _bracing(axes: "Axes", case: CaseSheet, plan: RigPlan) -> None:
    """The arrow at the gear that is shifted, and the gear at which the test point counts."""
    mode, shifted = case.raw("drivetrain.bracing.mode"), case.raw("drivetrain.bracing.shifted_gear")
    if shifted in plan.gears and mode != "twist_held":
        gear = plan.gears[shifted]
        axes.annotate(
            "", (gear.column - GEAR_HALF - 0.15, gear.level), (gear.column - GEAR_HALF - 0.01, gear.level),
            arrowprops={"arrowstyle": "<->", "color": MUTED, "linewidth": 1.2},
        )  # fmt: skip
        axes.text(
            gear.column - BOX_HALF + 0.02,
            gear.level - 0.1,
            "shifted",
            ha="left",
            va="bottom",
            fontsize=6.5,
            color=INK,
        )
    point = f"{case.value('schedule.test_torque', '')} at {case.value('schedule.test_speed', '')}"
    at = case.raw("drivetrain.torque_at")
    lines = [f"Test point {point}{f', counted at {at}' if at else ''}."]
    if mode:
        part = "gear" if shifted and mode != "twist_held" else "coupling"
        name = shifted if part == "gear" else f"coupling {case.raw('drivetrain.bracing.coupling')}".strip()
        lines.append(f"Bracing: {name}: {BRACINGS.get((mode, part), mode)}.")
    axes.text(
        0.01, 0.99, plain(fill("  ".join(lines), plan.form.note)), transform=axes.transAxes, ha="left", va="top",
        fontsize=SMALL, color=MUTED,
    )  # fmt: skip
