"""Modes over speed and dynamic torques of the warm loop, on two cores where there are two."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from rigdesign.base.parallel import BackgroundTasks
from rigdesign.records.campbell import campbell
from rigdesign.records.contact_loss_maps import contact_loss_maps
from rigdesign.records.dwell_speeds import DwellSources, dwell_record
from rigdesign.records.dynamics import DynamicRun
from rigdesign.records.loop_states import loop_states
from rigdesign.records.press_fits import press_fits
from rigdesign.records.seat_torques import held_seat_torques
from rigdesign.records.section_torques import section_torque_record
from rigdesign.records.spline_capacity import spline_stresses
from rigdesign.records.start_torque import StartResponse, start_response
from rigdesign.results.campbell import CampbellRecord
from rigdesign.results.contact_in_motion import ContactLossMap
from rigdesign.results.dwell import DwellRecord
from rigdesign.results.loads import DynamicLoads
from rigdesign.results.press_fit import PressFitCapacity
from rigdesign.results.section_torques import SectionTorqueRecord
from rigdesign.results.spline_capacity import SplineStress
from rigdesign.rig.model import Rig

Maps = tuple[ContactLossMap, ...]


@dataclass(frozen=True)
class LoopVibration:
    """What the warm loop does over speed."""

    campbell: CampbellRecord
    torques: SectionTorqueRecord
    dwell: DwellRecord
    maps: Maps
    press_fits: tuple[PressFitCapacity, ...]
    splines: tuple[SplineStress, ...]


def loop_vibration(rig: Rig, run: DynamicRun, loads: DynamicLoads) -> LoopVibration:
    """Campbell diagram, torques of every section, speeds at which the rig may dwell; loads : of the run."""
    top = max(run.curves.response.speeds) / rig.pinion_speed(1.0)
    states = loop_states(rig, run.test, float(top))
    works: list[Callable[[], CampbellRecord | Maps | StartResponse | None]] = [
        partial(campbell, rig, run.test, states, loads.modes),
        partial(contact_loss_maps, rig, run, states, loads),
        partial(start_response, rig, run, states),
    ]
    with BackgroundTasks(works) as tasks:
        torques = section_torque_record(rig, run, loads, states)
        diagram, maps, start = tasks.results()
    assert isinstance(diagram, CampbellRecord) and isinstance(maps, tuple)
    assert start is None or isinstance(start, StartResponse)
    sources = DwellSources(loads=loads, torques=torques, diagram=diagram, start=start)
    seats = tuple(held_seat_torques(rig, run.points))
    return LoopVibration(
        campbell=diagram,
        torques=torques,
        dwell=dwell_record(rig, run, sources),
        maps=maps,
        press_fits=tuple(press_fits(rig, seats)),
        splines=tuple(spline_stresses(rig, seats)),
    )
