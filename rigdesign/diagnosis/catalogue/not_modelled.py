"""Effects that engineers know of and no entry holds yet, each with what the model or the channels lack."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Waiting:
    """An effect without an entry.

    signature : how it would show; lacks : what has to come first
    """

    name: str
    title: str
    signature: str
    lacks: str


STEADY_LINES = "lines that do not turn with a gear as channels"

WAITING = (
    Waiting(
        "thermal_bow",
        "shaft bent by heat",
        "order 1 that grows while the rig warms up",
        "effects that change over the points: the case has one `temperature_difference` of a bow for all of them",
    ),
    Waiting(
        "coupling_misalignment",
        "couplings between axes out of line",
        "order 2, lateral, and forces that stand in the bearings",
        "what a disc pack makes of an offset twice a turn: the case has the force that stands (`cold_offset_lateral`), "
        "a torque at order 2 (`coupling_order_2`), run-out of the flanges, and the bending of cross joints",
    ),
    Waiting(
        "whirl",
        "oil whirl of a journal",
        "a line below half the speed",
        f"{STEADY_LINES}, and the limit cycle in the film: the model has its onset (stability of the check) only",
    ),
    Waiting(
        "rub",
        "seal or gear that touches",
        "orders and half orders of the shaft, heat at one place",
        "contact of shaft and seal in the response",
    ),
    Waiting(
        "looseness",
        "loose bearing cap or foot",
        "many orders of the shaft, one-sided",
        "supports that lift off: accelerations are channels, supports are linear",
    ),
    Waiting(
        "foundation",
        "resonance of housing or foundation",
        "peaks at one frequency on all sensors of the housing",
        f"{STEADY_LINES}, and modes of the housing beyond those of its bearing seats",
    ),
    Waiting(
        "sharing",
        "uneven sharing of a double helix",
        "one half carries more, with the axial order of the other",
        "a share of the halves as a number of the case: `carrying_halves` knows both alike or one alone; a gauge of a "
        "double-helical gear stands for either half",
    ),
    Waiting(
        "backlash",
        "backlash in the power circuit",
        "low torque only, contact lost, orders between",
        "points with contact loss in the library: the response to them is not smooth",
    ),
    Waiting(
        "spline_stick",
        "spline that sticks and slips",
        "a mean that depends on the way there, orders at reversal",
        "friction with memory in splines",
    ),
    Waiting(
        "mesh_shape",
        "shape of the mesh stiffness",
        "mesh orders among each other",
        "a stiffness curve with free harmonics",
    ),
    Waiting(
        "extended_contact",
        "contact beyond the path of contact",
        "fast edges at entry and exit, more with torque",
        "a key of the case: the loaded contact behind the root gauges has it as the tips make it",
    ),
    Waiting(
        "crack_growth",
        "root crack that grows",
        "the answer of a weak tooth, rising from point to point",
        "effects that change over the points",
    ),
    Waiting(
        "running_in",
        "friction that falls while running in",
        "losses that fall from point to point",
        "effects that change over the points",
    ),
    Waiting(
        "flange_drift",
        "drift or cross-talk of a torque flange",
        "mean torque that follows temperature or axial force",
        "temperature of the flange as a setting",
    ),
    Waiting(
        "aliasing",
        "mesh frequency folded by the logger",
        "a line that runs against the speed",
        "sample rate of recordings as an input",
    ),
    Waiting(
        "local_heat",
        "one bearing alone (loss, oil, joint), leak into one side, draught on one wall",
        "one place warmer or colder than the gearbox as a whole would be",
        "constants of the diagnosis fitted with them: the model and its case keys have them",
    ),
    Waiting(
        "base_conduction",
        "heat into the base",
        "foot and field, slow",
        "the base as a body with a joint of its own in every case",
    ),
    Waiting(
        "oil_mist",
        "oil mist and air gap as a path of heat",
        "the hottest point, small",
        "air in the chamber as a medium with its own balance",
    ),
    Waiting(
        "drain",
        "oil that backs up in the drain",
        "churning that jumps above a flow, sump warmer",
        "the level of the oil in the chamber",
    ),
    Waiting(
        "barrier_air",
        "barrier air of the seals",
        "shaft ends colder, less oil at the outlet",
        "air through seals in the balance",
    ),
    Waiting(
        "heat_misalignment",
        "misalignment by uneven thermal expansion of the housing",
        "follows temperature, not time",
        "an entry: root gauges have the axes of the warm housing, as its films and joints make them",
    ),
)
"""In the order of the page, which leaves out what the catalogue holds by now."""
