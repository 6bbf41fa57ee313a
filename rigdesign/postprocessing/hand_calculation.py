"""Numbers an engineer can redo on paper, next to the key results."""

import math
from collections.abc import Sequence

import numpy as np

from dynamics.losses.loss import RIVAL_POWER
from rigdesign.base.part_name import BearingName
from rigdesign.case.geometry import seals_on
from rigdesign.coupling.expansion import centrifugal_expansion
from rigdesign.coupling.mesh_models import MeshModel
from rigdesign.postprocessing.solved_rig import SolvedRig
from rigdesign.results.check import HandCalculation
from rigdesign.results.quantity import Records
from rigdesign.results.units import MM, UM
from rigdesign.results.warm_gearbox import WarmGearbox
from thermal.conduction.balance import HeatFlow

PLATE = (
    "s + R [alpha_h (T_h - T_0) - alpha_s (T_s - T_0)], T_h the mean of the partition; the colder box round the plate "
    "narrows the bore further"
)
RING = "s + R [alpha_h (T_h - T_0) - alpha_s (T_s - T_0)], T_h of the bore; a warmer wall round it widens it further"
BORE = (
    "C + D [alpha_h (T_w - T_0) - alpha_s (T_j - T_0)] less the centrifugal expansion, T_w the mean of the end wall, "
    "T_j of the journal: a wall that is warmer away from its bore widens it more than the temperature of the bore "
    "itself; a warmer box behind the wall stretches it further, the bore by 2/(1 - nu) times that stretch"
)

WINDAGE = (
    "2.82e-7 (1 + 2.3 b/R) n^2.8 R^4.6 (0.028 eta + 0.019)^0.2 kW (Anderson and Loewenthal), a mist of about 27 kg/m3 "
    "built in; the default law takes the density of the case, 1.2 to 20 kg/m3 plausible; put a range on "
    "loss_factors.windage where both still differ"
)

RISE = (
    "alpha_f h_f (T_f - T_0) + alpha h (T_h - T_0), T_f the mean of the field under the housing, T_h of the housing; "
    "end walls colder than that rise less, a field that bows towards its warm side lifts them"
)


def hand_checks(solved: SolvedRig) -> Records[HandCalculation]:
    """In the order of the report."""
    return Records([*_loads(solved), *_losses(solved), *_expansion(solved)])


def _row(quantity: str, computed: float, by_hand: float, unit: str, formula: str) -> HandCalculation:
    return HandCalculation(quantity=quantity, computed=computed, by_hand=by_hand, unit=unit, formula=formula)


def _loads(solved: SolvedRig) -> list[HandCalculation]:
    last, rig = solved.test.last, solved.rig
    rows = []
    for model in last.models:
        box, mesh = rig.mesh(model.name)
        shaft = box.gears[box.meshes[mesh].pinion].shaft
        speed = rig.shaft_speed(shaft, solved.test.point.speed)
        torque = abs(last.coupling_state.mesh_torque[model.name])
        stiffness, pair = model.whole.mean_stiffness, model.pair
        deflection = torque / pair.base_radii[0] / stiffness + mean_gap(model)
        rows.append(
            _row(
                f"mesh frequency, {model.name}", speed * pair.teeth[0] / (2.0 * math.pi),
                pair.teeth[0] * speed * 30.0 / math.pi / 60.0, "Hz", "z_1 n_1 / 60",
            )
        )  # fmt: skip
        if last.response is not None:
            index = rig.mesh_names.index(model.name)
            approach = abs(float(last.response.wave.approach[index].mean()))
            if last.response.flank[index] < 0:
                approach -= model.law.backlash
            rows.append(
                _row(
                    f"mean tooth deflection, {model.name}", UM * approach, UM * deflection, "um",
                    "T_1 / (r_b1 c_gamma b) + mean gap of the flanks, weighted with their stiffness; early contact and "
                    "the edges of crowned flanks that do not touch explain the difference",
                )
            )  # fmt: skip
    return rows


def mean_gap(model: MeshModel) -> float:
    """Gap of the modified flanks over the path of contact and the face, weighted with the stiffness [m]."""
    law, path = model.law, model.pair.path
    at = law.path_start + law.path_step * np.arange(law.gap.shape[1])
    active = (at >= path.start) & (at <= path.end)
    return float(np.average(law.gap[:, active], weights=law.stiffness[:, active]))


def _losses(solved: SolvedRig) -> list[HandCalculation]:
    rows = []
    for placed in solved.test.last.losses:
        details = placed.loss.details
        if placed.loss.kind == "mesh" and not placed.given:
            by_hand = math.prod(
                float(details[key])
                for key in ("transmitted_power", "friction_coefficient", "tooth_loss_factor")
            )
            rows.append(
                _row(
                    f"sliding loss, {placed.name}", placed.loss.power, by_hand, "W",
                    "P mu H_V of rigid teeth; deflected ones share the load beyond the ends of the path. The gear bulk "
                    "temperature depends on the difference",
                )
            )  # fmt: skip
        if placed.loss.kind == "windage" and not placed.given:
            rows.append(
                _row(
                    f"windage, {placed.name}", placed.loss.power, float(details[RIVAL_POWER]), "W",
                    f"{WINDAGE}; at losses.chamber_density = {float(details['mist_density']):.3g} kg/m3 here",
                )
            )  # fmt: skip
    for balance in solved.cooling:
        given, taken = balance.put_in, balance.taken_out
        rows.append(
            _row(f"heat carried away, stage {balance.stage}", taken, given, "W",
                 "cooler + room = losses + jets of the pump + heaters")
        )  # fmt: skip
    return rows


def _expansion(solved: SolvedRig) -> list[HandCalculation]:
    rows = []
    for warm in solved.warm:
        rows += [
            _row(
                f"thermal expansion of {shaft.name}", MM * shaft.total, MM * shaft.free, "mm",
                "alpha L (T_m - T_0)",
            )
            for shaft in warm.shafts
        ]  # fmt: skip
        for seal in warm.seals:
            plate = partition_gap(solved, warm, seal.name)
            by_hand, formula = (plate, PLATE) if plate is not None else (seal.by_hand, RING)
            rows.append(_row(f"mean gap of seal {seal.name}", MM * seal.mean, MM * by_hand, "mm", formula))
        for bearing in warm.bearings:
            clearance = end_wall_clearance(solved, warm, BearingName.read(bearing.name))
            if clearance is not None:
                rows.append(
                    _row(
                        f"hot diametral clearance of {bearing.name}", UM * bearing.clearance, UM * clearance, "um",
                        BORE,
                    )
                )  # fmt: skip
        for coupling in warm.couplings:
            if not all(coupling.housed):
                _, up = coupling.moved
                rise = MM * (up if coupling.housed[0] else -up)
                name = f"rise of the shaft at coupling {coupling.coupling}"
                rows.append(_row(name, rise, MM * axis_rise(solved, warm), "mm", RISE))
    return rows


def axis_rise(solved: SolvedRig, warm: WarmGearbox) -> float:
    """Free expansion of the housing and of the field under it, if meshed, up to the shaft axes [m], by their means."""
    name = warm.gearbox
    housing = solved.case.housings[name]
    field = next(p for p in solved.points if p.point.stage == warm.stage).last.fields[name].temperature
    elements, bodies = solved.rig.conduction[name].elements, solved.rig.models[name].mesh.bodies
    box = elements.mesh.points[np.unique(elements.mesh.cells[bodies["housing"]]), :2]
    low, high = box.min(axis=0), box.max(axis=0)
    reference, rise = solved.case.ambient.reference_temperature, 0.0
    for body, material, height in (
        ("field", housing.field.material, housing.field.thickness),
        ("housing", housing.material, housing.shaft_height),
    ):
        if body not in bodies:
            continue
        values, volumes = elements.at_points(field, bodies[body])
        places, _ = elements.at_points(elements.mesh.points[:, :2], bodies[body])
        under = ((places >= low) & (places <= high)).all(axis=1)
        mean = float(np.average(values[under], weights=volumes[under]))
        rise += solved.rig.materials[material].expansion_coefficient * height * (mean - reference)
    return rise


def partition_gap(solved: SolvedRig, warm: WarmGearbox, seal: str) -> float | None:
    """Hot gap [m] of a seal in a partition: a free plate widens its bore by its mean strain, however its warmth lies.

    None for the seals at the ends, whose walls have no surfaces of their own. Source: disc with a free bore,
    Timoshenko and Goodier, Theory of Elasticity, section 150.
    """
    shaft, _, side = seal.rpartition("_")
    housing = solved.case.gearboxes[warm.gearbox].housing
    if housing is None or shaft not in housing.shafts:
        return None
    entry = housing.shafts[shaft]
    if entry.seal_diameter is None:
        return None
    point = next(p for p in solved.points if p.point.stage == warm.stage)
    rows = point.last.fields[warm.gearbox].solution.balance.rows
    plate, journal = (
        _mean_temperature(rows, names)
        for names in ((f"partition_warm_{side}", f"partition_cold_{side}"), (f"shaft_{shaft}_seal_{side}",))
    )
    materials = solved.rig.materials
    reference = solved.case.ambient.reference_temperature
    wide = materials[housing.material].expansion_coefficient * (plate - reference)
    thick = materials[entry.material].expansion_coefficient * (journal - reference)
    gap = seals_on(solved.case.gearboxes[warm.gearbox], shaft).radial_gap
    return gap + 0.5 * entry.seal_diameter * (wide - thick)


def end_wall_clearance(solved: SolvedRig, warm: WarmGearbox, full: BearingName) -> float | None:
    """Hot diametral clearance [m] of a bearing: its end wall widens the bore by its mean strain.

    None for a user's mesh that has no material where the box has its end wall, and for a bearing whose rings move its
    clearance. Source: as `partition_gap`.
    """
    rig = solved.rig
    name, part = full.both
    housing = solved.case.housings[name]
    entry, geometry = solved.case.gearboxes[name].bearings[part], rig.geometries[name]
    if not entry.has_film:
        return None
    point = next(p for p in solved.points if p.point.stage == warm.stage)
    field = point.last.fields[name]
    elements, cells = rig.conduction[name].elements, rig.models[name].mesh.bodies["housing"]
    values, volumes = elements.at_points(field.temperature, cells)
    places, _ = elements.at_points(elements.mesh.points[:, 0], cells)
    depth = places if entry.side == "front" else geometry.length - places
    inside = depth < geometry.end_wall_thickness
    if not inside.any():
        return None
    wall = float(np.average(values[inside], weights=volumes[inside]))
    journal = _mean_temperature(field.solution.balance.rows, (f"shaft_{entry.shaft}_journal_{entry.side}",))
    reference, materials = solved.case.ambient.reference_temperature, rig.materials
    wide = materials[housing.material].expansion_coefficient * (wall - reference)
    thick = materials[housing.shafts[entry.shaft].material].expansion_coefficient * (journal - reference)
    spin = centrifugal_expansion(rig, entry, point.point.speed)
    return entry.drawn_clearance + entry.shaft_diameter * (wide - thick) - spin


def _mean_temperature(rows: Sequence[HeatFlow], surfaces: tuple[str, ...]) -> float:
    """Area mean over some surfaces [K]."""
    found = {row.surface: row for row in rows if row.surface in surfaces}
    return float(
        np.average([r.mean_temperature for r in found.values()], weights=[r.area for r in found.values()])
    )
