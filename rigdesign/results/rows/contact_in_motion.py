"""Contact of the teeth in motion as rows of the result."""

import math
from typing import Any

from rigdesign.results.contact_in_motion import PairShare


def pair_share_row(found: PairShare) -> dict[str, Any]:
    """Shares over the rolling angle of the pinion, line load over the face where a pair carries most."""
    return {
        "gearbox": found.mesh,
        "stage": found.stage,
        "rolling_angle_deg": [math.degrees(angle) for angle in found.angle],
        "share": list(found.share),
        "share_quasi_static": list(found.static_share),
        "force_over_mean": list(found.force),
        "most_loaded_angle_deg": math.degrees(found.most_loaded),
        "face_mm": [1e3 * place for place in found.face],
        "line_load_N_mm": [1e-3 * load for load in found.line_load],
        "line_load_quasi_static_N_mm": [1e-3 * load for load in found.static_line_load],
    }
