"""What each part of the method is worth: the same sets diagnosed without it.

    python -m tests.blind.score run dev plain --out WORK --ablation white

Each takes one part away from the calibration that is frozen.
"""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from rigdesign.diagnosis import catalogue, run
from rigdesign.diagnosis.catalogue.effects import Effect
from rigdesign.diagnosis.decision import claims, search
from rigdesign.diagnosis.decision import held_out_data as kept_numbers
from rigdesign.diagnosis.decision.defaults import Calibration
from rigdesign.diagnosis.statistics.amplitudes import Amplitudes

OWN = ("point", "series_mesh_point", "series_shaft_point", "frequency")
"""Amplitudes of what each number is off by itself: the hedge for what no simulator spans."""
MODEL = (
    "link",
    "link_speed",
    "answer",
    "source",
    "channel",
    "channel_speed",
    "series_mean",
    "series_mesh",
    "series_shaft",
)
"""Amplitudes of what a model has wrong besides its constants."""
LOCAL = frozenset({"one_bearing_loss", "one_bearing_oil", "one_bearing_joint", "leak_one_side", "draught"})
"""Kinds of effects at one place of a gearbox."""
STATED = ("sensor", "input")
"""Those that the measurement states."""


def white(calibration: Calibration) -> Calibration:
    """Noise of the readings alone: the evidence of independent errors."""
    return _only(calibration, ())


def own_variants(calibration: Calibration) -> Calibration:
    """What the tool's own uncertain constants, sensors and settings span."""
    gone = Amplitudes(**dict.fromkeys(Amplitudes().as_dict(), 0.0))
    kept = {
        name: value for name, value in calibration.amplitudes.as_dict().items() if name not in (*MODEL, *OWN)
    }
    return replace(calibration, amplitudes=gone.with_values(kept), inflation={})


def bands(calibration: Calibration) -> Calibration:
    """A variance for every number by itself, as large as calibration finds all parts together to be at most."""
    level = max(calibration.amplitudes.channel, calibration.amplitudes.point, 0.03)
    only = _only(calibration, (*STATED, *OWN))
    return replace(only, amplitudes=replace(only.amplitudes, point=level))


def no_hedge(calibration: Calibration) -> Calibration:
    """Nothing that each number is off by itself."""
    return replace(calibration, amplitudes=calibration.amplitudes.with_values(dict.fromkeys(OWN, 0.0)))


def no_widening(calibration: Calibration) -> Calibration:
    """No inflation along single effects."""
    return replace(calibration, inflation={}, drift=replace(calibration.drift, inflation={}))


def no_anonymous(calibration: Calibration) -> Calibration:
    """No competitors without a name."""
    search.unmodelled_causes = lambda library, channels: iter(())
    return calibration


def no_tiers(calibration: Calibration) -> Calibration:
    """Orders of the meshes decide like the others."""
    domains = kept_numbers.Numbers.domains.fget
    assert domains is not None
    kept_numbers.Numbers.domains = property(lambda numbers: [tiers[-1:] for tiers in domains(numbers)])  # type: ignore[assignment, method-assign]
    return calibration


def no_domains(calibration: Calibration) -> Calibration:
    """Heat and rotation at once, in tiers."""
    kept_numbers.Numbers.domains = property(lambda numbers: [("all",)])  # type: ignore[assignment, method-assign]
    return calibration


def no_agreement(calibration: Calibration) -> Calibration:
    """Channels and operating points need not agree on the size of a name."""
    claims.DISAGREEMENT = 0.0
    return calibration


def no_groups(calibration: Calibration) -> Calibration:
    """No groups of effects that leave one trace; such a group of two or three is found by its posterior alone."""
    plain, given = (replace(one, one_trace=0) for one in (calibration.plain, calibration.given_baseline))
    return replace(calibration, plain=plain, given_baseline=given)


def no_local(calibration: Calibration) -> Calibration:
    """No effects at one place of a gearbox in the catalogue."""

    def effects_of(*args: Any, **keywords: Any) -> tuple[Effect, ...]:
        return tuple(effect for effect in catalogue.effects_of(*args, **keywords) if effect.kind not in LOCAL)

    module: Any = run
    module.effects_of = effects_of
    return calibration


def virtual_model(calibration: Calibration) -> Calibration:
    """A model alone that is as good as it is on virtual rigs, in place of the wide errors of real ones."""
    return replace(calibration, least_alone={})


def _only(calibration: Calibration, kept: tuple[str, ...]) -> Calibration:
    values = calibration.amplitudes.as_dict()
    gone = {name: 0.0 for name in values if name not in kept}
    return replace(calibration, amplitudes=calibration.amplitudes.with_values(gone), inflation={})


ABLATIONS: dict[str, Callable[[Calibration], Calibration]] = {
    "white": white,
    "own_variants": own_variants,
    "bands": bands,
    "no_hedge": no_hedge,
    "no_widening": no_widening,
    "no_anonymous": no_anonymous,
    "no_tiers": no_tiers,
    "no_domains": no_domains,
    "no_agreement": no_agreement,
    "no_groups": no_groups,
    "no_local": no_local,
    "virtual_model": virtual_model,
}
"""By the name they have on the command line."""
