"""Modes over speed and dynamic torques of the warm loop, on two cores where there are two."""

from collections.abc import Callable
from functools import partial

from rigdesign.base.parallel import BackgroundTasks
from rigdesign.records.campbell import campbell
from rigdesign.records.dynamics import DynamicRun
from rigdesign.records.loop_states import loop_states
from rigdesign.records.section_torques import section_torque_record
from rigdesign.results.campbell import CampbellRecord
from rigdesign.results.loads import DynamicLoads
from rigdesign.results.section_torques import SectionTorqueRecord
from rigdesign.rig.model import Rig


def loop_vibration(
    rig: Rig, run: DynamicRun, loads: DynamicLoads
) -> tuple[CampbellRecord, SectionTorqueRecord]:
    """Campbell diagram and torques of every section; loads : of the run."""
    top = max(run.curves.response.speeds) / rig.pinion_speed(1.0)
    states = loop_states(rig, run.test, float(top))
    works: list[Callable[[], CampbellRecord | SectionTorqueRecord]] = [
        partial(campbell, rig, run.test, states, loads.modes),
        partial(section_torque_record, rig, run, loads, states),
    ]
    with BackgroundTasks(works) as tasks:
        diagram, torques = tasks.results()
    assert isinstance(diagram, CampbellRecord) and isinstance(torques, SectionTorqueRecord)
    return diagram, torques
