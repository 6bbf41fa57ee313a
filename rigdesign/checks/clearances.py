"""Checks of warm clearances: seals, shafts, meshes, bearings.

Of a gearbox whose housing is not expanded those of its drawing are held. Its gears and axes have the temperatures of
its oil, so that backlash and tip clearance are those of the meshes that carry the load; what expansion would do to the
rest is left out, and reported as such.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from rigdesign.checks.films import no_film
from rigdesign.checks.omissions import EXPANSION, HEAT, of_gearboxes, sealed, unexpanded, with_play
from rigdesign.checks.places import housed_seals
from rigdesign.checks.registry import REGISTRY, RigRule, RuleFamily, Topic, Values
from rigdesign.checks.rules import Rule
from rigdesign.results.check import Check
from rigdesign.results.units import MICROMETRE, MILLIMETRE

if TYPE_CHECKING:
    from rigdesign.coupling.mesh_models import MeshModel
    from rigdesign.postprocessing.solved_rig import SolvedRig

GROUP = "clearances"
NO_PLAY = "no shaft states an axial play between stops at both of its bearings"
NO_SEAL = "no shaft has a seal without contact"
NOT_EXPANDED = of_gearboxes(EXPANSION, unexpanded)
SEALS_NOT_EXPANDED = of_gearboxes(EXPANSION, sealed)
PLAY_NOT_EXPANDED = of_gearboxes(EXPANSION, with_play)


def _seal_gaps(solved: SolvedRig) -> Iterator[tuple[float, str]]:
    """Warm gap of every seal less the motion of the shaft once a turn; as drawn where the housing is not expanded."""
    whirl = solved.seal_amplitudes
    for warm in solved.warm:
        for seal in warm.seals:
            amplitude = whirl.get((warm.stage, seal.name), 0.0)
            where = f"{seal.name} at {math.degrees(seal.angle_of_minimum):.0f} deg"
            yield seal.minimum - amplitude, where + _less(amplitude)
    for name in solved.unexpanded:
        for part, seals in solved.case.gearboxes[name].seals.items():
            if not seals.end.touches:
                found = [value for (_, seal), value in whirl.items() if seal == f"{name}.{part}"]
                amplitude = max(found, default=0.0)
                yield seals.radial_gap - amplitude, f"{name}.{part}, as drawn" + _less(amplitude)


def _less(amplitude: float) -> str:
    """What a shaft that whirls takes from a gap [m], in words."""
    return f", less {MICROMETRE.shown(amplitude):.2g} um of whirl" if amplitude else ""


def _plays(solved: SolvedRig) -> Iterator[tuple[float, str]]:
    """Warm axial play of every shaft between stops; as drawn where the housing is not expanded."""
    for warm in solved.warm:
        for shaft in warm.shafts:
            if shaft.play_as_drawn > 0.0:
                yield shaft.play, shaft.name
    for name in solved.unexpanded:
        for bearing in solved.case.gearboxes[name].bearings.values():
            if bearing.axial_play > 0.0:
                yield bearing.axial_play, f"{bearing.shaft}, {name}, as drawn"


def _meshes(solved: SolvedRig) -> Iterator[tuple[str, MeshModel]]:
    """Every mesh at every held stage."""
    for point in solved.points:
        for model in point.last.models:
            bare = model.name.gearbox in solved.unexpanded
            basis = ", gears and axes at the temperature of their oil" if bare else ""
            yield f"{model.name}{basis}, stage {point.point.stage}", model


def _backlashes(solved: SolvedRig) -> Values:
    return ((model.pair.transverse_backlash, where) for where, model in _meshes(solved))


def _tip_clearances(solved: SolvedRig) -> Values:
    return ((min(model.pair.tip_clearances), where) for where, model in _meshes(solved))


def _bearing_clearances(solved: SolvedRig) -> Values:
    return (
        (clearance, f"{name}, stage {point.point.stage}")
        for point in solved.points
        for name, clearance in point.last.coupling_state.bearing_clearance.items()
        if solved.rig.bearing(name).has_film
    )


RULES = (
    RigRule(
        key="clearance.seal_gap",
        title="smallest hot radial gap of a seal",
        procedure=(
            "Radial gap as drawn plus thermal expansion of bore and shaft and the offset between both at "
            "the held stages, less the motion of the shaft by unbalance, bow and run-out; least over the circumference "
            "and all seals without contact."
        ),
        unit=MILLIMETRE,
        group=GROUP,
        source="limits.clearances.seal_gap_minimum",
        comparison=">=",
        limit=lambda limits: limits.clearances.seal_gap_minimum,
        values=_seal_gaps,
        absent=NO_SEAL,
        leaves_out=(SEALS_NOT_EXPANDED, *HEAT),
        moved_by=frozenset({"housing"}),
    ),
    RigRule(
        key="clearance.axial_play",
        title="smallest hot axial play of a shaft",
        procedure=(
            "Axial play as drawn plus thermal expansion of the housing less that of the shaft between its "
            "stops, at the held stages. The least counts."
        ),
        unit=MILLIMETRE,
        group=GROUP,
        source="limits.clearances.axial_play_minimum",
        comparison=">=",
        limit=lambda limits: limits.clearances.axial_play_minimum,
        values=_plays,
        absent=NO_PLAY,
        leaves_out=(PLAY_NOT_EXPANDED, *HEAT),
        moved_by=frozenset({"housing", "axial play"}),
    ),
    RigRule(
        key="clearance.backlash",
        title="smallest hot backlash",
        procedure=(
            "Transverse backlash at the working pitch circle with the warm centre distance and the warm "
            "teeth, at the held stages. The least of all meshes counts."
        ),
        unit=MILLIMETRE,
        group=GROUP,
        source="limits.clearances.backlash_minimum",
        comparison=">=",
        limit=lambda limits: limits.clearances.backlash_minimum,
        values=_backlashes,
        leaves_out=(NOT_EXPANDED, *HEAT),
        moved_by=frozenset({"housing"}),
    ),
    RigRule(
        key="clearance.tip_clearance",
        title="smallest hot tip clearance",
        procedure=(
            "Warm centre distance less tip radius and root radius of the partner, at the held stages; the "
            "lesser of both gears, the least of all meshes."
        ),
        unit=MILLIMETRE,
        group=GROUP,
        source="limits.clearances.tip_clearance_minimum",
        comparison=">=",
        limit=lambda limits: limits.clearances.tip_clearance_minimum,
        values=_tip_clearances,
        leaves_out=(NOT_EXPANDED, *HEAT),
        moved_by=frozenset({"housing"}),
    ),
    RigRule(
        key="clearance.bearing_clearance",
        title="smallest hot diametral bearing clearance",
        procedure=(
            "Diametral clearance as drawn plus thermal expansion of bore less journal at the held stages. "
            "The least of all bearings counts."
        ),
        unit=MICROMETRE,
        group=GROUP,
        source="limits.clearances.bearing_clearance_minimum",
        comparison=">=",
        limit=lambda limits: limits.clearances.bearing_clearance_minimum,
        values=_bearing_clearances,
        absent=no_film,
        leaves_out=(NOT_EXPANDED, *HEAT),
        moved_by=frozenset({"housing"}),
    ),
)


@dataclass(frozen=True, kw_only=True)
class SealTravel(RuleFamily):
    """One rule for the seals of every shaft in a housing; the place is ``gearbox.seals``."""

    def rule(self, limit: float | None, place: str = "") -> Rule:
        """The rule of one place with its limit [SI]."""
        box, _, name = place.partition(".")
        return replace(
            super().rule(limit, place),
            title=f"axial movement of the {name} shaft in its seals ({box})",
            source=f"gearboxes.{box}.seals.{name}.axial_travel",
        )


SEAL_TRAVEL = SealTravel(
    key="clearance.seal_travel",
    title="axial movement of a shaft in its seals, {place}",
    procedure=(
        "Axial movement of the shaft in its seals by thermal expansion, from its locating bearing on, "
        "at the held stages. The largest counts."
    ),
    unit=MILLIMETRE,
    group=GROUP,
    source="gearboxes.{place}.axial_travel",
    places=housed_seals,
    housed=True,
    leaves_out=HEAT,
    moved_by=frozenset({"housing"}),
)


def checks(solved: SolvedRig) -> list[Check]:
    """One for every limit of a clearance, then the travel of every shaft in its seals."""
    return [*(rule.check(solved) for rule in RULES), *seal_travel(solved)]


def seal_travel(solved: SolvedRig) -> Iterator[Check]:
    """Axial movement of every shaft in its seals against what they take, the worst of the held stages."""
    for box in dict.fromkeys(warm.gearbox for warm in solved.warm):
        for name, seals in solved.case.gearboxes[box].seals.items():
            rule = SEAL_TRAVEL.rule(seals.axial_travel, f"{box}.{name}")
            shifts = (
                (abs(seal.axial_shift), f"{seal.name}, stage {warm.stage}")
                for warm in solved.warm
                if warm.gearbox == box
                for seal in warm.seals
                if seal.shaft == seals.shaft
            )
            yield SEAL_TRAVEL.worst(solved, rule, shifts)


REGISTRY.register(Topic(order=32, families=(*RULES, SEAL_TRAVEL), checks=checks, of_housing_mesh=True))
