"""Travel of journals through an event: read in the march, added to their place before it, and their clearance."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from dynamics.rotor.assembly import assemble_rig
from dynamics.rotor.bearing import constant_coefficients
from dynamics.rotor.craig_bampton import SeenRig, mesh_ports
from dynamics.rotor.reduction import reduce_rig
from dynamics.vibration.event_march import Channel, Watched
from dynamics.vibration.march_inputs import DriveState
from rigdesign.case import load_case
from rigdesign.postprocessing.events import journal_channels, largest_travels, travel_warnings
from rigdesign.rig.model import build_rig
from tests.builders.elastic_rig import bearings, prototype_rig, running
from tests.builders.paths import CASES


def test_channels_read_the_motion_of_journals_against_their_seats() -> None:
    rig = prototype_rig(0.03)
    model = assemble_rig(rig)
    seen = SeenRig(
        reduced=reduce_rig(model, bearings(rig), 10e3),
        ports={mesh.name: mesh_ports(model, mesh.name) for mesh in rig.drivetrain.meshes},
    )
    system = seen.system(running(rig))
    names = ["test_pinion front", "reference_wheel rear"]
    watched = Watched(journal_channels(seen, names))
    eta = np.random.default_rng(1).normal(size=seen.reduced.size)
    assert system.coordinates is not None
    angles = system.coordinates.freedoms @ eta
    assert seen.on_coordinates(angles) == pytest.approx(eta, rel=1e-9, abs=1e-12)
    found = watched.read(DriveState(angles=angles, speeds=np.zeros_like(angles), twist=0.0))
    expected = np.concatenate([(model.ports[name] @ (seen.reduced.basis @ eta))[:2] for name in names])
    assert found == pytest.approx(expected, rel=1e-9, abs=1e-12)


def test_a_journal_goes_from_its_place_before_the_event() -> None:
    """At 30 um before it, then 40 um on across: 50 um from the middle. Without the travel it stays at 30 um."""
    none = np.zeros((1, 1))
    channels = [
        Channel(place="test.pinion_front", kind=kind, angle=none, speed=none)  # type: ignore[arg-type]
        for kind in ("bearing", "journal travel", "journal travel")
    ]
    history: Any = SimpleNamespace(
        values=np.array([[1e3, 2e3], [7e-6, 7e-6], [2e-6, 42e-6]]), before=np.array([1e3, 7e-6, 2e-6])
    )
    coefficients = {"test.pinion_front": constant_coefficients(1e8, 0.0, (3e3, 0.0))}
    assert coefficients["test.pinion_front"].position == pytest.approx([30e-6, 0.0])
    (travel,) = largest_travels(channels, history, coefficients).values()
    assert travel == pytest.approx(50e-6)
    history.values[:] = history.before[:, None]
    assert largest_travels(channels, history, coefficients)["test.pinion_front"] == pytest.approx(30e-6)


def test_a_journal_that_passes_its_clearance_is_warned_of() -> None:
    rig = build_rig(load_case(CASES / "loop_1to1"), "quick")
    names = ("test.pinion_front", "test.wheel_front")
    (warning,) = travel_warnings(rig, dict(zip(names, (50e-6, 39e-6))), dict.fromkeys(names, 80e-6))
    assert "test.pinion_front: journal displacement 50 um exceeds the radial clearance 40 um" in warning
