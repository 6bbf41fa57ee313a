"""Events of a case: what they may state, and every fault with its key."""

from pathlib import Path

import pytest

from rigdesign.base.errors import CaseError, Fault
from rigdesign.case import Case, load_case
from rigdesign.case.events import EmergencyStop, Overspeed, ToothLoss
from tests.builders.paths import CASES

LOSS = 'kind = "tooth_loss"\nmesh = "test.main"\n'


def case_of(tmp_path: Path, event: str) -> Case:
    file = tmp_path / "case.toml"
    base = CASES / "uhcf_prototype" / "case.toml"
    file.write_text(f'extends = "{base}"\n[events.one]\n{event}', encoding="utf-8")
    return load_case(file)


def faults(tmp_path: Path, event: str) -> list[Fault]:
    with pytest.raises(CaseError) as error:
        case_of(tmp_path, event)
    return list(error.value.faults)


def test_each_kind_is_read(tmp_path: Path) -> None:
    loss = case_of(
        tmp_path, LOSS + 'teeth = 2\nmonitor = "drivetrain.couplings.pinion_side"\ntrip_torque = "210 N m"\n'
    )
    assert isinstance(event := loss.events["one"], ToothLoss)
    assert (event.teeth, event.gear, event.trip_torque, event.trip_delay) == (2, "pinion", 210.0, 0.01)
    stop = case_of(tmp_path, 'kind = "emergency_stop"\nstop_time = "6 s"\n').events["one"]
    assert isinstance(stop, EmergencyStop) and stop.stop_time == 6.0
    fast = case_of(tmp_path, 'kind = "overspeed"\nspeed = "13200 rpm"\n').events["one"]
    assert isinstance(fast, Overspeed)


@pytest.mark.parametrize(
    ("event", "path", "text"),
    [
        (LOSS + "teeth = 3\n", "events.one.teeth", "3"),
        (LOSS.replace("test.main", "test.man"), "events.one.mesh", 'did you mean "test.main"'),
        (LOSS + 'speed = "20000 rpm"\n', "events.one.speed", "the schedule runs up to"),
        (LOSS + 'torque = "500 N m"\n', "events.one.torque", "the schedule goes up to"),
        (LOSS + 'trip_torque = "200 N m"\n', "events.one", "without a monitor"),
        (LOSS + 'monitor = "drivetrain.couplings.pinion_side"\n', "events.one", "without one limit"),
        (
            LOSS + 'monitor = "drivetrain.couplings.side"\ntrip_torque = "200 N m"\n',
            "events.one.monitor",
            "no such coupling or bearing",
        ),
        (
            LOSS + 'monitor = "gearboxes.test.bearings.pinion_rear"\ntrip_torque = "200 N m"\n',
            "events.one.monitor",
            "give trip_velocity",
        ),
        (
            LOSS
            + 'monitor = "drivetrain.couplings.pinion_side"\ntrip_torque = "200 N m"\ntrip_time_maximum = "1 s"\n',
            "events.one.trip_time_maximum",
            "for which the event is followed",
        ),
        ('kind = "emergency_stop"\n', "events.one", "state one of the two"),
        (
            'kind = "emergency_stop"\nstop_time = "3 s"\nbrake_torque = "5 N m"\n',
            "events.one",
            "state one of the two",
        ),
        ('kind = "overspeed"\nspeed = "9000 rpm"\n', "events.one.speed", "is no overspeed"),
        ('kind = "earthquake"\n', "events.one.kind", "earthquake"),
    ],
)
def test_faults(tmp_path: Path, event: str, path: str, text: str) -> None:
    (fault,) = faults(tmp_path, event)
    assert fault.path == path
    assert text in str(fault)
