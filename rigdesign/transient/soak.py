"""How long the rig must soak before full torque: the shortest warm-up after which every clearance limit holds.

The gears warm in minutes, the box in hours. What the gears are ahead takes backlash and tip clearance away for a
while; a warm-up at standstill with the oil on brings the box along.
"""

from collections.abc import Callable, Sequence

from rigdesign.case.model import Case
from rigdesign.transient.branch import Branch, broken, clearance_limits
from rigdesign.transient.warm_up import Soak

TRIALS = 4
"""Runs between a warm-up that is too short and one that is long enough."""
Trial = Callable[[int], bool]
"""Whether all limits of clearances hold after the warm-up has been left at this of its time steps."""


def soak_of(case: Case, planned: Branch, unwarmed: Branch | None, trial: Trial) -> Soak:
    """Soak time of one gearbox.

    planned : the schedule with its warm-up; unwarmed : without it, None if the case does not ask for it
    trial : runs the schedule from a time step of the warm-up to the end of the dwell
    """
    stage = next(phase.name for phase in planned.phases if phase.held)
    if not clearance_limits(case):
        return _soak(planned, stage, None, "the case states no limit of a clearance")
    last = planned.ends(next(phase.name for phase in reversed(planned.phases) if phase.held))
    lasting = [
        f"{kind.replace('_', ' ')} of {place}" for kind, place, _ in broken(case, planned.clearances[last])
    ]
    if lasting:
        return _soak(
            planned,
            stage,
            None,
            f"{', '.join(lasting)} stays below its limit at the end of the dwell: no warm-up mends that",
        )
    text = first_broken(case, planned)
    if text is not None:
        return _soak(
            planned, stage, None, f"after the planned warm-up of {hours(planned.phases[0].duration)}: {text}"
        )
    if unwarmed is None:
        return _soak(
            planned, stage, planned.phases[0].duration,
            "the planned warm-up is enough; a shorter one was not tried (event cold_start is not listed)",
        )  # fmt: skip
    text = first_broken(case, unwarmed)
    if text is None:
        return _soak(planned, stage, 0.0, "every limit of a clearance holds from a cold start")
    steps = [i for i, number in enumerate(planned.phase) if number == 0]
    enough = shortest(steps, trial)
    return _soak(
        planned, stage, float(planned.times[enough]),
        f"from a cold start {text}; shortest of {len(steps)} time steps of the warm-up after which all limits of "
        "clearances hold",
    )  # fmt: skip


def shortest(steps: Sequence[int], trial: Trial) -> int:
    """The first of ``steps`` found to be enough: the first is too short, the last long enough."""
    low, high = 0, len(steps) - 1
    for _ in range(TRIALS):
        if high - low < 2:
            break
        middle = (low + high) // 2
        low, high = (low, middle) if trial(steps[middle]) else (middle, high)
    return steps[high]


def first_broken(case: Case, branch: Branch) -> str | None:
    """The first limit a branch breaks up to the end of its last dwell, in words; None if all hold."""
    last = max(i for i, phase in enumerate(branch.phases) if phase.held)
    for time, number, found in zip(branch.times, branch.phase, branch.clearances, strict=True):
        if number > last:
            break
        for quantity, place, value in broken(case, found):
            limit = clearance_limits(case)[quantity]
            return (
                f"{quantity.replace('_', ' ')} of {place} falls to {1e6 * value:.1f} um, below {1e6 * limit:.1f} um, "
                f"{hours(float(time))} after the start, in phase {branch.phases[number].name}"
            )
    return None


def hours(time: float) -> str:
    """A time [s] as an engineer says it."""
    if time < 120.0:
        return f"{time:.0f} s"
    return f"{time / 60.0:.0f} min" if time < 7200.0 else f"{time / 3600.0:.1f} h"


def _soak(branch: Branch, stage: str, time: float | None, reason: str) -> Soak:
    return Soak(gearbox=branch.gearbox, stage=stage, soak_time_s=time, reason=reason)
