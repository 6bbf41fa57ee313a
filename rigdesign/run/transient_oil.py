"""Heaters and cooler over time as records: curves, and the moment at which each must give or take most."""

from collections.abc import Iterator, Sequence

from rigdesign.records.solved_rig import SolvedRig
from rigdesign.results.transient import OilPowerCurve, WorstMoment
from rigdesign.transient.oil_power import OilPower

KW = 1e-3


def oil_power_curve(power: OilPower) -> OilPowerCurve:
    """One branch in the units of the result."""
    return OilPowerCurve(
        branch=power.name,
        time_s=power.times.tolist(),
        phase=[power.phases[number].name for number in power.phase],
        heater_W=power.heater.tolist(),
        cooler_W=power.cooler.tolist(),
        streams_W={name: heat.tolist() for name, heat in power.streams.items()},
    )


def largest_stream(power: OilPower, quantity: str, at: int) -> str:
    """The stream that asks most of heaters or cooler at a time."""
    sign = -1.0 if quantity == "heater_power" else 1.0
    return max(power.streams, key=lambda name: sign * float(power.streams[name][at]))


def worst_powers(solved: SolvedRig, powers: Sequence[OilPower], planned: bool) -> Iterator[WorstMoment]:
    """Largest power of heaters and of the cooler over some branches."""
    limits = solved.case.limits.oil
    for quantity, key, limit in (
        ("heater_power", "heater_W", limits.heater_power_maximum),
        ("cooler_power", "cooler_W", limits.cooler_power_maximum),
    ):
        value, branch, at = max(
            (
                (float(values.max()), power, int(values.argmax()))
                for power in powers
                for values in (power.heater if quantity == "heater_power" else power.cooler,)
            ),
            key=lambda entry: entry[0],
        )
        yield WorstMoment(
            quantity=quantity,
            value=KW * value,
            unit="kW",
            place=largest_stream(branch, quantity, at),
            steady=max((KW * float(row[key]) for row in solved.cooler), default=None),
            limit=None if limit is None else KW * limit,
            planned=planned,
            time_s=float(branch.times[at]),
            branch=branch.name,
            phase=branch.phases[branch.phase[at]].name,
        )
