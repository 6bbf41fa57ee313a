"""What streams and volumes of the housings add to the heat balance of the rig."""

from dataclasses import replace

import pytest

from rigdesign.report.pages.report import report_html
from rigdesign.results.housing import CoolingBalance
from rigdesign.results.quantity import Records, row
from tests.builders.report import small_result


def balance(streams: float | None, volumes: float | None) -> CoolingBalance:
    return CoolingBalance(
        stage="test", losses=1000.0, pump=0.0, heater=0.0, cooler=500.0, room=300.0, stored=None, not_heat=0.0,
        flow=1e-4, streams=streams, volumes=volumes,
    )  # fmt: skip


def test_streams_take_heat_out_and_volumes_put_it_in() -> None:
    assert balance(None, None).imbalance == 200.0
    assert balance(250.0, 50.0).imbalance == pytest.approx(0.0)


def test_only_a_rig_with_streams_and_volumes_has_their_columns() -> None:
    heads = ("<th>streams [W]</th>", '<th class="n">streams [W]</th>')
    without, found = (
        report_html(replace(small_result(), cooler=Records([balance(*terms)])))
        for terms in ((None, None), (250.0, 0.0))
    )
    assert not any(head in without for head in heads) and any(head in found for head in heads)
    assert "cooler + room + streams" in found and "volumes" not in without
    shown = row(balance(250.0, 0.0))
    assert (shown["streams_W"], shown["volumes_W"], shown["imbalance_W"]) == (250.0, 0.0, -50.0)
