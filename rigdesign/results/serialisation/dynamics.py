"""Dynamic loads as rows of the result."""

import math

from dynamics.gear.pair import GearPair
from rigdesign.coupling.mesh_models import MeshModel
from rigdesign.results.dynamics import RootStressHistory
from rigdesign.results.loads import RootStressPath
from rigdesign.results.units import MM, MPA


def root_stress_row(path: RootStressPath) -> RootStressHistory:
    """Root stress of one gear over its rolling angle."""
    return RootStressHistory(
        gear=path.gear,
        stage=path.stage,
        rolling_angle_deg=[math.degrees(angle) for angle in path.rolling_angle],
        dynamic_MPa=[stress * MPA for stress in path.dynamic],
        quasi_static_MPa=[stress * MPA for stress in path.quasi_static],
        source=path.source,
    )


def _diameters(radii: tuple[float, float]) -> str:
    """Of pinion and wheel [mm], to the micrometre."""
    return f"{2.0 * MM * radii[0]:.3f} / {2.0 * MM * radii[1]:.3f}"


def geometry_row(drawn: GearPair, model: MeshModel) -> dict[str, float | str]:
    """Gear data of one mesh as drawn, with those of the warm ``model`` that differ."""
    warm = model.pair
    return {
        "teeth": f"{drawn.teeth[0]} / {drawn.teeth[1]}",
        "normal_module_mm": MM * drawn.normal_module,
        "pressure_angle_deg": math.degrees(drawn.pressure_angle),
        "helix_angle_deg": math.degrees(drawn.helix_angle),
        "profile_shifts": f"{drawn.profile_shifts[0]:.4f} / {drawn.profile_shifts[1]:.4f}",
        "reference_diameters_mm": _diameters(drawn.reference_radii),
        "tip_diameters_cold_mm": _diameters(drawn.tip_radii),
        "tip_diameters_hot_mm": _diameters(warm.tip_radii),
        "root_diameters_mm": _diameters(drawn.root_radii),
        "transverse_contact_ratio": drawn.transverse_contact_ratio,
        "total_contact_ratio": drawn.total_contact_ratio,
        "centre_distance_cold_mm": MM * drawn.centre_distance,
        "centre_distance_hot_mm": MM * warm.centre_distance,
        "transverse_contact_ratio_hot": warm.transverse_contact_ratio,
        "mean_mesh_stiffness_N_um": 1e-6 * model.whole.mean_stiffness,
        "friction_coefficient": model.friction.value,
    }
