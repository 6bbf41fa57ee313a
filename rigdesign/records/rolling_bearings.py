"""Records of the rolling bearings of solved points."""

from collections.abc import Iterable, Iterator

from dynamics.bearing.rolling_state import rolling_state
from rigdesign.coupling.loop import PointResult
from rigdesign.results.rolling_bearings import RollingBearingRecord
from rigdesign.rig.model import Rig


def rolling_bearings(rig: Rig, points: Iterable[PointResult]) -> Iterator[RollingBearingRecord]:
    """Every rolling bearing at every held stage."""
    for point in points:
        for name, found in point.last.bearings.items():
            state = rolling_state(found)
            if state is None:
                continue
            friction, life = state.friction, state.life
            yield RollingBearingRecord(
                name=name,
                stage=point.point.stage,
                designation=rig.bearing(name).label,
                radial_load=state.load,
                axial_load=state.axial_load,
                speed=state.omega,
                torques=(friction.rolling, friction.sliding, friction.seals, friction.drag),
                power=state.power,
                temperature=state.film_temperature,
                inner_ring=state.inner_ring_temperature,
                outer_ring=state.outer_ring_temperature,
                heat_to_shaft=state.heat_to_shaft,
                heat_to_housing=state.heat_to_housing,
                clearance=point.last.coupling_state.bearing_clearance[name],
                basic_life=life.basic_life,
                modified_life=life.modified_life,
                static_safety=life.static_safety,
                viscosity_ratio=life.viscosity_ratio,
                speed_utilisation=state.speed_utilisation,
                minimum_load=state.minimum_load,
                radial_stiffness=state.stiffness.radial,
                axial_stiffness=state.stiffness.axial,
                tilting_stiffness=state.stiffness.tilting,
            )
