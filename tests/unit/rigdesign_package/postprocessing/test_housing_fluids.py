"""What streams and volumes of the housings add to the heat balance of the rig."""

import pytest

from rigdesign.results.housing import CoolingBalance, HeatSource, RigHeat
from rigdesign.results.serialisation.housing import cooling_row


def balance(streams: float | None, volumes: float | None) -> CoolingBalance:
    box = HeatSource(name="test", kind="gearbox", power=300.0, sinks={"room": 300.0})
    heat = RigHeat(stage="test", sources=(box,), drive_power=1e3, mains_power=1e3, input_power=1e3)
    return CoolingBalance(
        stage="test", losses=1000.0, pump=0.0, heater=0.0, cooler=500.0, room=300.0, stored=None, not_heat=0.0,
        flow=1e-4, heat=heat, streams=streams, volumes=volumes,
    )  # fmt: skip


def test_streams_take_heat_out_and_volumes_put_it_in() -> None:
    assert balance(None, None).imbalance == 200.0
    assert balance(250.0, 50.0).imbalance == pytest.approx(0.0)


def test_only_a_rig_with_streams_and_volumes_has_their_columns() -> None:
    assert not {"streams_W", "volumes_W"} & set(cooling_row(balance(None, None)))
    row = cooling_row(balance(250.0, 0.0))
    assert (row["streams_W"], row["volumes_W"], row["open_W"]) == (250.0, 0.0, -50.0)
