"""Numbers by hand stand near the computed ones, and on the same side."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from dynamics.losses.windage import anderson_loewenthal
from rigdesign import load_case
from rigdesign.base.part_name import BearingName
from rigdesign.coupling.expansion import centrifugal_expansion
from rigdesign.coupling.iteration import initial_state
from rigdesign.coupling.loop import solve_point
from rigdesign.coupling.losses import rotating_losses
from rigdesign.coupling.mesh_models import mesh_models
from rigdesign.coupling.preloaded_loop import LoadedCircuit, brace_initial, respond
from rigdesign.coupling.time_run import held_points
from rigdesign.postprocessing.hand_calculation import _losses, end_wall_clearance, mean_gap, partition_gap
from rigdesign.rig.model import build_rig
from tests.builders.paths import CASES
from tests.builders.warm_prototype import base
from thermal.expansion.expansion import expand

PROTOTYPE = CASES / "uhcf_prototype"


def test_crowning_belongs_to_the_mean_deflection() -> None:
    """Reference gear: 5 + 5 um over the profile and the face add about as much as the load."""
    rig = build_rig(load_case(PROTOTYPE), "quick")
    point = held_points(rig)[0]
    cold = initial_state(rig, point)
    models = mesh_models(rig, point, cold)
    response = respond(rig, LoadedCircuit(point, models, {}, brace_initial(rig, point, cold), rig.system))
    for index, model in enumerate(models):
        approach = abs(float(response.wave.approach[index].mean()))
        if response.flank[index] < 0:
            approach -= model.law.backlash
        elastic = abs(response.mean[index]) / model.pair.base_radii[0] / model.law.mean_stiffness
        by_hand = elastic + mean_gap(model)
        assert approach == pytest.approx(by_hand, rel=0.35)
        assert abs(approach - by_hand) < abs(approach - elastic) or index == 0


def test_a_bearing_opens_with_its_end_wall_not_with_its_bore() -> None:
    """Bore and journal differ by 1 to 2 K, alpha D dT = 1 um, and yet the clearance grows by 8 to 9 um.

    The wall is 10 K warmer away from its bore, cooled by the film: a free plate of that mean temperature accounts
    for half of it, a box that is warmer still for the rest. Shown by two fields: with the whole housing at one
    temperature the bore grows as its own temperature says, with the rest of the box at the mean of the end wall as
    the line by hand says.
    """
    rig, result = base()
    solved: Any = SimpleNamespace(case=rig.case, rig=rig, points=(result,))
    warm: Any = SimpleNamespace(gearbox="test", stage=result.point.stage)
    field, bores = result.last.fields["test"], result.last.expansion["test"].deformed.bearings
    rows = {row.surface: row.mean_temperature for row in field.solution.balance.rows}
    mesh, setup, geometry = rig.models["test"].mesh, rig.expansion["test"], rig.geometries["test"]
    nodes = np.unique(mesh.cells[mesh.bodies["housing"]])
    strain = rig.materials["structural_steel"].expansion_coefficient
    elements = rig.conduction["test"].elements
    values, volumes = elements.at_points(field.temperature, mesh.bodies["housing"])
    at, _ = elements.at_points(mesh.points[:, 0], mesh.bodies["housing"])
    for name, entry in rig.case.gearboxes["test"].bearings.items():
        station = f"{entry.shaft}_{entry.side}"
        bore, journal = rows[f"bearing_bore_{station}"], rows[f"shaft_{entry.shaft}_journal_{entry.side}"]
        own = strain * entry.diameter * (bore - journal)
        computed = bores[station].clearance_change
        by_hand = end_wall_clearance(solved, warm, BearingName("test", name))
        assert by_hand is not None
        by_hand += centrifugal_expansion(rig, entry, result.point.speed) - entry.diametral_clearance
        assert own < 1.5e-6
        assert computed > 7e-6
        assert own < by_hand < computed
        assert abs(computed - by_hand) < 0.6 * abs(computed - own)

    def expanded(temperature: NDArray[np.float64]) -> dict[str, float]:
        shape = expand(setup, temperature, 293.15, tolerance=1e-6)
        return {key: bearing.bore_expansion for key, bearing in shape.bearings.items()}

    even = field.temperature.copy()
    even[nodes] = 325.0
    diameter = 0.04008
    assert list(expanded(even).values()) == pytest.approx(
        [strain * diameter * (325.0 - 293.15)] * 4, rel=0.05
    )
    depth = np.minimum(mesh.points[nodes, 0], geometry.length - mesh.points[nodes, 0])
    ends = [at < geometry.end_wall_thickness, at > geometry.length - geometry.end_wall_thickness]
    mean = float(np.mean([np.average(values[end], weights=volumes[end]) for end in ends]))
    plates = field.temperature.copy()
    plates[nodes[depth > geometry.end_wall_thickness + 1e-9]] = mean
    assert list(expanded(plates).values()) == pytest.approx(
        [strain * diameter * (mean - 293.15)] * 4, rel=0.05
    )


def test_a_plate_warmer_at_its_bore_narrows_the_gap_by_hand_too() -> None:
    rig = build_rig(load_case(PROTOTYPE / "given_losses.toml"), "quick")
    result = solve_point(rig, held_points(rig)[0])
    solved: Any = SimpleNamespace(case=rig.case, rig=rig, points=(result,))
    warm: Any = SimpleNamespace(gearbox="test", stage=result.point.stage)
    for name, seal in result.last.expansion["test"].deformed.seals.items():
        by_hand = partition_gap(solved, warm, name)
        if by_hand is not None:
            assert abs(seal.mean - by_hand) < abs(seal.mean - seal.gap_by_hand)


def test_both_windage_laws_stand_beside_each_other_and_the_range_of_the_mist_holds_them() -> None:
    """Every gear of the prototype: Anderson and Loewenthal lie between the default law at 1.2 and at 20 kg/m3."""
    rig, result = base()
    solved: Any = SimpleNamespace(rig=rig, test=result, cooling=())
    rows = {row.quantity: row for row in _losses(solved) if row.quantity.startswith("windage")}
    assert len(rows) == 4
    wide = rows["windage, reference.pinion"]
    fed = rig.case.gearboxes["reference"].oil
    mean = 0.5 * (fed.inlet_temperature + result.last.coupling_state.oil_outlet["reference.gear_oil"])
    oil = rig.oils[fed.oil].dynamic_viscosity(mean)
    warm = next(model.pair for model in result.last.models if model.name == "reference.main")
    radius, halves = warm.gears[0].reference_radius, 0.08
    assert wide.by_hand == pytest.approx(
        anderson_loewenthal(radius, halves, result.point.speed, oil), rel=1e-9
    )
    assert 1.2 < wide.computed / wide.by_hand < 2.0
    powers = {}
    for density in ("1.2 kg/m3", "20 kg/m3"):
        changed = build_rig(rig.case.with_value("losses.chamber_density", density), "quick")
        losses = rotating_losses(
            changed, result.point, result.last.coupling_state, result.last.models, result.last.bearings
        )
        powers[density] = {p.name: p.loss.power for p in losses if p.loss.kind == "windage"}
    for name, row in rows.items():
        gear = name.removeprefix("windage, ")
        assert powers["1.2 kg/m3"][gear] < row.by_hand < powers["20 kg/m3"][gear]
