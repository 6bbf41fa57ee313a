"""Modes over speed and dynamic torques of the warm loop, on two cores where there are two."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from rigdesign.base.parallel import BackgroundTasks
from rigdesign.records.campbell import campbell
from rigdesign.records.dwell_speeds import DwellSources, dwell_record
from rigdesign.records.loop_states import loop_states
from rigdesign.records.section_torques import section_torque_record
from rigdesign.records.solved_rig import SolvedRig
from rigdesign.records.start_torque import StartResponse, start_response
from rigdesign.results.vibration import CampbellRecord, DwellRecord, SectionTorqueRecord


@dataclass(frozen=True)
class LoopVibration:
    """What the warm loop does over speed."""

    campbell: CampbellRecord
    torques: SectionTorqueRecord
    dwell: DwellRecord


def loop_vibration(solved: SolvedRig) -> LoopVibration:
    """Campbell diagram, torques of every section, speeds at which the rig may dwell, of a rig with loads."""
    rig, run, loads = solved.rig, solved.run, solved.loads
    assert run is not None and loads is not None
    top = max(run.curves.response.speeds) / rig.pinion_speed(1.0)
    states = loop_states(rig, run.test, float(top))
    works: list[Callable[[], CampbellRecord | StartResponse | None]] = [
        partial(campbell, rig, run.test, states, loads.modes),
        partial(start_response, rig, run),
    ]
    with BackgroundTasks(works) as tasks:
        torques = section_torque_record(solved, states)
        diagram, start = tasks.results()
    assert isinstance(diagram, CampbellRecord)
    assert start is None or isinstance(start, StartResponse)
    sources = DwellSources(
        loads=loads, torques=torques, diagram=diagram, start=start, near=solved.near_dwells
    )
    return LoopVibration(
        campbell=diagram,
        torques=torques,
        dwell=dwell_record(rig, run, sources),
    )
