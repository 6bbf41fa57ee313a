"""Strain gauges of a case as measuring points in the root of their gears, held against face width and fillet."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from math import isnan

from dynamics.gear.cylindrical_gear import CylindricalGear
from dynamics.gear.pair import GearPair
from dynamics.gear.root_arc import RootArc, root_arc
from rigdesign.base.errors import CaseError, Fault
from rigdesign.base.part_name import GearName, MeshName
from rigdesign.base.units import show
from rigdesign.case.gears import PLACES, Gear, StrainBridge, StrainGaugeInput
from rigdesign.case.model import Case
from rigdesign.properties.materials import Material
from rigdesign.strain_gauge.gauge import Bridge, StrainGauge
from rigdesign.strain_gauge.measuring_point import GaugePlacement, MeasuringPoint, RootRegion, SurfaceStress

BRIDGE_KEYS = tuple(StrainBridge.model_fields)
KINDS = {"tangent_angle": "angle", "root_diameter": "length"}
"""Kind of quantity of the places that are not a length along the fillet."""


@dataclass(frozen=True, kw_only=True)
class RootGauge:
    """A strain gauge on a tooth.

    tooth : its number, from 0; front : under the front flank, else under the back flank
    point : gauge, bridge, surface and place on the root
    """

    name: str
    gear: GearName
    tooth: int
    front: bool
    point: MeasuringPoint


def root_gauges(
    case: Case, pairs: Mapping[MeshName, GearPair], materials: Mapping[str, Material]
) -> dict[str, RootGauge]:
    """Strain gauges of all gears by ``gearbox.gear.gauge``.

    Raises
    ------
    CaseError
        With every fault of every gauge: a grid that reaches over the face or the fillet, a bridge or gauge that cannot
        be.
    """
    found: dict[str, RootGauge] = {}
    faults: list[Fault] = []
    for box_name, box in case.gearboxes.items():
        toothings = {
            gear: pairs[MeshName(box_name, mesh)].gears[side]
            for gear, (mesh, side) in box.first_meshes().items()
        }
        for gear_name, gear in box.gears.items():
            for name, entry in gear.strain_gauges.items():
                at = f"gearboxes.{box_name}.gears.{gear_name}.strain_gauges.{name}"
                try:
                    point = _point(at, entry, _Root(gear, toothings[gear_name], materials[gear.material]))
                except CaseError as error:
                    faults += error.faults
                    continue
                found[f"{box_name}.{gear_name}.{name}"] = RootGauge(
                    name=name,
                    gear=GearName(box_name, gear_name),
                    tooth=entry.tooth,
                    front=entry.fillet == "front",
                    point=point,
                )
    if faults:
        raise CaseError(faults, str(case.path))
    return found


@dataclass(frozen=True)
class _Root:
    """What a gauge sits on."""

    gear: Gear
    toothing: CylindricalGear
    material: Material


def _point(at: str, entry: StrainGaugeInput, root: _Root) -> MeasuringPoint:
    with _told_at(at, entry):
        fillet = root_arc(root.toothing)
        gauge = StrainGauge(
            gauge_factor=entry.gauge_factor,
            resistance=entry.resistance,
            grid_length=entry.grid_length,
            grid_width=entry.grid_width,
            transverse_sensitivity=entry.transverse_sensitivity,
        )
        circuit = entry.bridge
        return MeasuringPoint(
            name=at,
            bridge=Bridge(
                kind=circuit.kind,
                gauge=gauge,
                supply_voltage=circuit.supply_voltage,
                arms=circuit.arms,
                completion_resistance=circuit.completion_resistance,
                wires=circuit.wires,
                lead_resistance=circuit.lead_resistance,
            ),
            surface=SurfaceStress(
                youngs_modulus=root.material.elastic_modulus,
                poisson_ratio=root.material.poisson_ratio,
                state=entry.stress_state,
            ),
            placement=GaugePlacement(
                face_position=entry.face_position,
                fillet_position=_along(entry, fillet),
                misalignment=entry.misalignment,
            ),
            region=RootRegion(
                face_width=root.gear.face_width,
                fillet_start=float(fillet.arc[0]),
                fillet_end=float(fillet.arc[-1]),
            ),
        )


def _along(entry: StrainGaugeInput, fillet: RootArc) -> float:
    """Place along the fillet from the 30 deg tangent [m]."""
    if entry.tangent_angle is not None:
        ends = (float(fillet.tangent[-1]), float(fillet.tangent[0]))
        return _within("tangent_angle", entry.tangent_angle, fillet.at_tangent(entry.tangent_angle), ends)
    if entry.root_diameter is not None:
        ends = (2.0 * float(fillet.radius[0]), 2.0 * float(fillet.radius[-1]))
        return _within(
            "root_diameter", entry.root_diameter, fillet.at_radius(0.5 * entry.root_diameter), ends
        )
    return entry.fillet_position or 0.0


def _within(key: str, given: float, place: float, ends: tuple[float, float]) -> float:
    if isnan(place):
        first, last = (show(end, KINDS[key]) for end in ends)
        raise CaseError([Fault(
            key, show(given, KINDS[key]), f"the fillet reaches from {first} to {last}",
            "write a place on the fillet, or fillet_position",
        )])  # fmt: skip
    return place


@contextmanager
def _told_at(at: str, entry: StrainGaugeInput) -> Iterator[None]:
    """Put the path of the gauge before the keys of faults, and that of its bridge before those of the bridge."""
    try:
        yield
    except CaseError as error:
        raise CaseError([_placed(fault, at, entry) for fault in error.faults]) from None


def _placed(fault: Fault, at: str, entry: StrainGaugeInput) -> Fault:
    key = fault.path.removeprefix(f"{at}.")
    if key in BRIDGE_KEYS:
        return replace(fault, path=f"{at}.bridge.{key}")
    if key == "fillet_position":
        for place in PLACES[1:]:
            if (given := getattr(entry, place)) is not None:
                return replace(fault, path=f"{at}.{place}", given=show(given, KINDS[place]))
    return replace(fault, path=f"{at}.{key}")
