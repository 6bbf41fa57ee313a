"""Churning of a dipped stage by all laws: the range they span and the one to use."""

from dataclasses import dataclass

from dynamics.losses.churning import LAWS, ChurningLaw, stage_churning
from dynamics.losses.immersion import OilBath, RunningGear
from dynamics.losses.mesh_loss import Loss

EXTRAPOLATION = 1.5
"""Factor by which a number may leave the range of a law before another law is recommended (a choice, no source)."""


@dataclass(frozen=True, kw_only=True)
class ChurningComparison:
    """One stage by all laws that its data allow.

    losses : both gears by law; recommended : the first of `LAWS` that is extrapolated by no more than `EXTRAPOLATION`,
    else the least extrapolated; reason : one sentence with the factors. The laws can differ by more than
    five on small gears.
    """

    losses: dict[ChurningLaw, tuple[Loss, Loss]]
    recommended: ChurningLaw
    reason: str

    @property
    def powers(self) -> dict[ChurningLaw, float]:
        """Sum of both gears by law [W]."""
        return {law: first.power + second.power for law, (first, second) in self.losses.items()}


def compare_churning(stage: tuple[RunningGear, RunningGear], bath: OilBath) -> ChurningComparison:
    """All laws on one stage and the one to use; ISO/TR 14179-2 is left out where the hydraulic length is missing.

    Raises LossError for a level at or above the top of a shaft.
    """
    laws = [law for law in LAWS if law != "iso_tr_14179_2" or bath.hydraulic_length is not None]
    losses = {law: stage_churning(stage, bath, law) for law in laws}
    factors = {
        law: max(float(loss.details["extrapolation"]) for loss in pair) for law, pair in losses.items()
    }
    near = [law for law in laws if factors[law] <= EXTRAPOLATION]
    best = near[0] if near else min(laws, key=lambda law: factors[law])
    factors_text = ", ".join(f"{law} {factor:.3g}" for law, factor in factors.items())
    reason = (
        f"{best}: first law extrapolated by no more than {EXTRAPOLATION:g} ({factors_text})"
        if near
        else f"{best}: least extrapolated of all ({factors_text}); measure the no-load torque"
    )
    return ChurningComparison(losses=losses, recommended=best, reason=reason)
