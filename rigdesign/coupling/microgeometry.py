"""Modifications and deviations of the gears of a case as the mesh law reads them."""

import math

from dynamics.flank.microgeometry import Microgeometry, cumulative_pitch, pitch_waves
from dynamics.gear.pair import GearPair
from rigdesign.case.gears import Gear
from rigdesign.rig.flank_topography import NOT_MEASURED, FlankTopographies
from rigdesign.rig.model import Rig


def mesh_microgeometry(rig: Rig, name: str, pair: GearPair) -> tuple[Microgeometry, Microgeometry]:
    """Modifications and deviations of pinion and wheel of a mesh as the mesh law reads them."""
    box, mesh = rig.mesh(name)
    entry = box.meshes[mesh]
    first, second = rig.mesh_gears(name)
    return (
        microgeometry(box.gears[entry.pinion], pair, 0, measured=rig.topography(first)),
        microgeometry(box.gears[entry.wheel], pair, 1, entry.tooth_offset, rig.topography(second)),
    )


def microgeometry(
    gear: Gear,
    pair: GearPair,
    index: int,
    tooth_offset: int = 0,
    measured: FlankTopographies = NOT_MEASURED,
) -> Microgeometry:
    """Modifications and deviations of one gear as the mesh law reads them.

    The law counts an eccentricity from the shaft; here it belongs to the teeth, and goes with them where the gear is
    put on its shaft ``tooth_offset`` teeth further.
    """
    flank = gear.flank
    relieved = {"both": (1.0, 1.0), "front": (1.0, 0.0), "rear": (0.0, 1.0)}[flank.end_relief_at]
    return Microgeometry(
        tip_relief=flank.tip_relief,
        tip_relief_length=_tip_path(flank.tip_relief_length, pair, index),
        tip_relief_exponent=flank.tip_relief_exponent,
        root_relief=flank.root_relief,
        root_relief_length=_root_path(flank.root_relief_length, pair, index),
        root_relief_exponent=flank.root_relief_exponent,
        end_relief=(relieved[0] * flank.end_relief, relieved[1] * flank.end_relief),
        end_relief_length=flank.end_relief_length,
        end_relief_exponent=flank.end_relief_exponent,
        profile_crowning=flank.profile_crowning,
        lead_crowning=flank.lead_crowning,
        lead_crowning_form=flank.lead_crowning_form,
        manufacturing_twist=flank.manufacturing_twist,
        profile_slope=flank.profile_slope,
        helix_slope=flank.helix_slope,
        profile_twist=0.25 * flank.twist,
        topography=measured[0],
        back_topography=measured[1],
        pitch_deviations=_tooth_places(gear),
        run_out=0.5 * flank.run_out,
        run_out_phase=flank.run_out_phase - 2.0 * math.pi * tooth_offset / gear.teeth,
        profile_slopes=flank.profile_slope_scatter,
        tooth_stiffness=_tooth_stiffness(gear),
    )


def _tooth_places(gear: Gear) -> tuple[float, ...]:
    """Place of each tooth ahead of its ideal one [m], from single pitch and waves; empty for an ideal pitch."""
    flank = gear.flank
    single = cumulative_pitch(flank.single_pitch) if flank.single_pitch else ()
    if not flank.pitch_waves:
        return single
    waves = pitch_waves(gear.teeth, ((wave.order, wave.amplitude, wave.phase) for wave in flank.pitch_waves))
    return tuple(map(sum, zip(single, waves))) if single else waves


def _tooth_stiffness(gear: Gear) -> tuple[float, ...]:
    """Stiffness share of each tooth [-]; empty for equal teeth."""
    weak, shares = gear.flank.weak_tooth, gear.flank.tooth_stiffness
    if weak.stiffness == 1.0:
        return shares
    shares = shares or (1.0,) * gear.teeth
    return tuple(share * (weak.stiffness if i == weak.tooth else 1.0) for i, share in enumerate(shares))


def _tip_path(height: float, pair: GearPair, index: int) -> float:
    """Path length of a tip relief from its radial height [m]."""
    gear = pair.gears[index]
    tip = pair.flanks[index].tip_radius
    return gear.roll_length(tip) - gear.roll_length(tip - height)


def _root_path(height: float, pair: GearPair, index: int) -> float:
    """Path length of a root relief from its radial height above the start of the active profile [m]."""
    gear = pair.gears[index]
    start = pair.rolling_radii[index] + (pair.path.start if index == 0 else -pair.path.end)
    return gear.roll_length(math.hypot(gear.base_radius, start) + height) - start
