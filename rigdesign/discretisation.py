"""How far the numbers the checks use are from those of an infinitely fine mesh.

The settled point is solved once more, same losses, films and oil, on meshes of another fidelity: quick beside
standard; quick and standard beside reference. From three meshes the error follows by Richardson extrapolation
with the order observed, from two with the order of a field at re-entrant edges. At quick there is nothing
coarser, only the energy norm of the recovered gradient is given.
Sources: Roache, Annu. Rev. Fluid Mech. 29 (1997) 123; Celik et al., J. Fluids Eng. 130 (2008) 078001 for meshes
without a constant ratio; Strang, Fix, An Analysis of the Finite Element Method, ch. 8: at an edge of 270 degrees
the gradient converges with order 2/3, integrals of the field with twice that.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import brentq

from rigdesign.coupling import PointResult, Residual, governing_point
from rigdesign.growth import HousingGrowth, expand_housing
from rigdesign.loads import mesh_models
from rigdesign.passes import PassResult, feedback_of
from rigdesign.results import DiscretisationRow, Fidelity
from rigdesign.rig.model import Rig
from rigdesign.state import growth_change, temperature_change
from rigdesign.temperatures import HousingField, body_mean, solve_housing
from thermal.fe.recovery import energy_error

ZERO = 273.15
MM, UM = 1e3, 1e6
EDGE_ORDER = 4.0 / 3.0
"""Order of integrals of the field where its gradient is that of a re-entrant edge of 270 degrees."""
ORDERS = (0.5, 4.0)
"""Orders that are believed; four is what second-order elements reach on smooth fields."""
LAW_TEMPERATURE = 373.15
"""Temperature [K] at which a conductivity law weighs the energy."""

COARSER: dict[Fidelity, tuple[Fidelity, ...]] = {
    "quick": (),
    "standard": ("quick",),
    "reference": ("quick", "standard"),
}


@dataclass(frozen=True)
class OneMesh:
    """Quantities (name, unit) -> value of one housing on one mesh."""

    nodes: int
    values: Mapping[tuple[str, str], float]


def coarser_rig(rig: Rig) -> Rig:
    """The rig on which the coupling iterates: at reference that of the standard mesh."""
    return replace(rig, fidelity="standard") if rig.fidelity == "reference" else rig


def on_finer_mesh(rig: Rig, settled: PointResult) -> PointResult:
    """The last pass of a point settled on a coarser mesh: fields, growth and warm gears on that of ``rig``.

    The residual that is added is the shift between the meshes.
    """
    fields, growth = _solved(rig, settled)
    done = replace(settled.last, fields=fields, growth=growth)
    before, after = settled.last.feedback, feedback_of(rig, done)
    feedback = replace(
        before,
        gear_temperature=after.gear_temperature,
        centre_distance=after.centre_distance,
        bearing_clearance=after.bearing_clearance,
        tooth_growth=after.tooth_growth,
    )
    shift = Residual(
        temperature=temperature_change(before, after), growth=growth_change(before, after), torque=0.0
    )
    last: PassResult = replace(done, feedback=feedback, models=mesh_models(rig, settled.point, feedback))
    return replace(settled, last=last, residuals=(*settled.residuals, shift))


def discretisation(rig: Rig, points: Sequence[PointResult]) -> list[DiscretisationRow]:
    """Errors of the governing held point, one row for each quantity, the energy norm of each housing first."""
    point = governing_point(points)
    rows = []
    coarser = []
    for fidelity in COARSER[rig.fidelity]:
        other = replace(rig, fidelity=fidelity)
        coarser.append((other, *_solved(other, point)))
    for name, field in point.last.fields.items():
        rows.append(_energy_row(rig, field, point.point.stage))
        meshes = [_measured(other, fields[name], growth.get(name)) for other, fields, growth in coarser]
        own = _measured(rig, field, point.last.growth.get(name))
        if meshes and meshes[-1].nodes != own.nodes:
            rows += _rows(name, point.point.stage, [*meshes, own])
    return rows


def _solved(rig: Rig, point: PointResult) -> tuple[dict[str, HousingField], dict[str, HousingGrowth]]:
    """Fields and growth of the housings at a settled point, on the mesh of ``rig``."""
    last = point.last
    fields = {
        name: solve_housing(rig, name, last.point, last.feedback, last.bearings, last.losses)
        for name in last.fields
    }
    return fields, {name: expand_housing(rig, fields[name]) for name in last.growth}


def _measured(rig: Rig, field: HousingField, growth: HousingGrowth | None) -> OneMesh:
    """Every number of a housing that a check or the heat table shows."""
    name, mesh = field.gearbox, rig.models[field.gearbox].mesh
    housing = field.temperature[mesh.cells[mesh.bodies.get("housing", slice(None))]]
    values: dict[tuple[str, str], float] = {
        ("max_temperature", "degC"): float(field.temperature.max()) - ZERO,
        ("housing.max_temperature", "degC"): float(housing.max()) - ZERO,
    }
    for gear, entry in rig.case.gearboxes[name].gears.items():
        if f"gear_{entry.shaft}" not in mesh.bodies:
            continue
        values[f"{gear}.bulk_temperature", "degC"] = body_mean(rig, field, f"gear_{entry.shaft}") - ZERO
    for kind, power in field.solution.balance.by_kind().items():
        values[f"heat.{kind}", "W"] = power
    if growth is None:
        return OneMesh(len(mesh.points), values)
    shape = growth.expansion
    for seal in shape.seals.values():
        values[f"{seal.name}.seal_gap", "mm"] = MM * seal.minimum
        values[f"{seal.name}.axial_shift", "mm"] = MM * seal.axial_shift
    for shaft in shape.shafts.values():
        values[f"{shaft.name}.growth", "mm"] = MM * (shaft.start + shaft.end)
        values[f"{shaft.name}.axial_play_change", "mm"] = MM * shaft.axial_play_change
    for bearing in shape.bearings.values():
        values[f"{bearing.name}.clearance_change", "um"] = UM * bearing.clearance_change
    for full, distance in growth.centre_distance.items():
        values[f"{full.split('.')[1]}.centre_distance", "mm"] = MM * distance
    return OneMesh(len(mesh.points), values)


def _energy_row(rig: Rig, field: HousingField, stage: str) -> DiscretisationRow:
    setup = rig.conduction[field.gearbox]
    k = {
        body: float(law(np.array([LAW_TEMPERATURE]))[0]) if callable(law) else float(law)
        for body, law in setup.conductivity.items()
    }
    found = energy_error(setup.elements, field.temperature, setup.elements.per_cell(k))
    return DiscretisationRow(
        quantity="temperature_gradient", gearbox=field.gearbox, stage=stage, value=found.energy,
        error=found.total, unit="(W K)^0.5", order=None,
        method="energy norm against the recovered gradient (Zienkiewicz, Zhu 1992)",
    )  # fmt: skip


def _rows(gearbox: str, stage: str, meshes: Sequence[OneMesh]) -> list[DiscretisationRow]:
    """One row for each quantity; meshes from coarse to fine, the last is that of the result."""
    counts = " and ".join(str(mesh.nodes) for mesh in meshes)
    rows = []
    for key, value in meshes[-1].values.items():
        error, order, how = richardson([m.nodes for m in meshes], [m.values[key] for m in meshes])
        rows.append(
            DiscretisationRow(
                quantity=key[0],
                gearbox=gearbox,
                stage=stage,
                value=value,
                error=error,
                unit=key[1],
                order=order,
                method=f"meshes of {counts} nodes, {how}",
            )
        )
    return rows


def richardson(nodes: Sequence[int], values: Sequence[float]) -> tuple[float, float | None, str]:
    """Error estimate of the last of two or three values, the order behind it, and how it was found.

    nodes : of the meshes, rising; the element size goes with their cube root
    """
    change = values[-1] - values[-2]
    ratio = (nodes[-1] / nodes[-2]) ** (1.0 / 3.0)
    if len(values) == 2:
        return _extrapolated(change, ratio, EDGE_ORDER), EDGE_ORDER, "order 4/3 of re-entrant edges assumed"
    before = values[-2] - values[-3]
    largest = max(abs(change), abs(before))
    if change * before <= 0.0:
        return largest, None, "not monotone: the largest change between meshes"
    order = _observed(before / change, (nodes[-2] / nodes[-3]) ** (1.0 / 3.0), ratio)
    if order is None:
        return largest, None, "no order between 0.5 and 4: the largest change between meshes"
    return _extrapolated(change, ratio, order), order, f"Richardson with the observed order {order:.2f}"


def _extrapolated(change: float, ratio: float, order: float) -> float:
    return float(abs(change) / (ratio**order - 1.0))


def _observed(quotient: float, first: float, second: float) -> float | None:
    """Order p with (r_1^p - 1) r_2^p / (r_2^p - 1) equal to the quotient of both changes; None outside of ORDERS."""

    def open_by(order: float) -> float:
        return float((first**order - 1.0) * second**order / (second**order - 1.0) - quotient)

    low, high = ORDERS
    if open_by(low) * open_by(high) > 0.0 or not math.isfinite(quotient):
        return None
    return float(brentq(open_by, low, high, xtol=1e-6))
