"""Families of effects: what is off, and what follows from that for its healthy spread, its traces and its runs."""

from dataclasses import dataclass, replace


@dataclass(frozen=True, kw_only=True)
class Family:
    """Kind of thing that is off; it names the amplitude of what cannot be distinguished from it.

    amplitude : of `rigdesign.diagnosis.statistics.amplitudes.Amplitudes`, on the healthy spread of its effects
    dynamic : leaves temperatures and losses nearly as they are, shows in orders and natural frequencies
    circuit : changes how the power circuit passes on what the teeth excite
    heat : a constant that moves the heat
    strain : shows at strain gauges in tooth roots alone, but for traces in mesh orders
    sizes : shares of the bounds at which a nonlinear effect is run
    one_sided_sizes : the same of an effect whose size has one sign
    tooth_contact : every run solves the contact of the teeth anew
    run_rank : place in the order in which runs are started, longest first
    """

    name: str
    amplitude: str
    dynamic: bool = False
    circuit: bool = False
    heat: bool = False
    strain: bool = False
    sizes: tuple[float, ...] = (-1.0, -0.4, -0.12, 0.12, 0.4, 1.0)
    one_sided_sizes: tuple[float, ...] = (-1.0, -0.4, -0.12, 0.12, 0.4, 1.0)
    tooth_contact: bool = False
    run_rank: int = 7


FEWER_SIZES = (-1.0, -0.3, 0.3, 1.0)
"""Of the flanks of a gear, whose runs take longest, and of inertias, which move little."""

YIELDING_SIZES = (0.12, 0.4, 0.7, 1.0)
"""Of a tooth that yields: the model may refuse the largest sizes."""

EXCITATION = Family(name="excitation", amplitude="tooth", dynamic=True, run_rank=4)
TOOTH = Family(
    name="tooth", amplitude="tooth", dynamic=True, sizes=FEWER_SIZES, one_sided_sizes=YIELDING_SIZES,
    tooth_contact=True, run_rank=0,
)  # fmt: skip
STIFFNESS = Family(name="stiffness", amplitude="constant_loop", dynamic=True, circuit=True, run_rank=1)
BEARING = replace(STIFFNESS, name="bearing", sizes=FEWER_SIZES)
"""Bearings and their supports, of which there are many."""
INERTIA = Family(
    name="inertia", amplitude="constant_loop", dynamic=True, circuit=True, sizes=FEWER_SIZES,
    one_sided_sizes=YIELDING_SIZES, run_rank=2,
)  # fmt: skip
DAMPING = Family(name="damping", amplitude="constant_loop", dynamic=True, circuit=True, run_rank=3)
LOSS = Family(name="loss", amplitude="constant_loss", heat=True)
SPLIT = Family(name="split", amplitude="constant_film", heat=True)
FILM = Family(name="film", amplitude="constant_film", heat=True)
CONTACT = Family(name="contact", amplitude="constant_film", heat=True)
FLOW = Family(name="flow", amplitude="constant_oil", heat=True)
OIL = Family(name="oil", amplitude="constant_oil", heat=True, run_rank=6)
ONE_FEED = replace(FLOW, name="one feed", one_sided_sizes=(0.4, 1.0))
"""Oil of one bearing: two runs, as there are many of them."""
ONE_JOINT = replace(CONTACT, name="one joint", one_sided_sizes=(0.12, 1.0))
"""Joint of one shell, the same."""
FACE = Family(name="face", amplitude="sensor", strain=True, sizes=FEWER_SIZES, tooth_contact=True, run_rank=0)
"""Load over the face and profile; spreads as tolerances and inspection give them."""
GAUGE_PLACE = Family(name="gauge place", amplitude="sensor", strain=True)
CHAIN = Family(name="measuring chain", amplitude="sensor", strain=True, one_sided_sizes=(0.12, 0.4, 1.0))
STATE = Family(name="state", amplitude="constant_loop", run_rank=5)
