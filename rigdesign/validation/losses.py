"""Rows of the tooth-loss factor: FZG gears of DIN ISO 14635 and P2's test gear with its open profile shifts.

Found by these rows: the often quoted 0.3043 of FZG-A is Ohlendorf's formula, which counts one sign wrong
where the pitch point lies in double contact; its own load sharing integrates to 0.3006. The split of P2's
profile shifts, which is not printed, decides the mesh loss of the test gear by a factor of 2.8.
"""

from collections.abc import Iterator

from dynamics.gear.pair import GearPair
from dynamics.mesh.sliding import ToothPath, ohlendorf_factor, tooth_loss_factor
from rigdesign.validation.prototype import Prototype
from rigdesign.validation.rows import ValidationRow, compare, compare_printed, stated

SOURCE = "DIN ISO 14635-1 geometry, Ohlendorf as in FVA"


def loss_rows(prototype: Prototype) -> Iterator[ValidationRow]:
    """H_V of FZG-C and FZG-A, and of the test gear for two splits."""
    path_c, path_a = fzg_path(0.1817, 14e-3), fzg_path(0.8532, 20e-3)
    yield compare_printed(
        id="FZG-C-HV", quantity="tooth-loss factor, FZG-C, integral", source=SOURCE, printed="0.1986",
        computed=tooth_loss_factor(path_c), unit="1", assumptions="rigid load sharing, no dynamics",
    )  # fmt: skip
    yield compare_printed(
        id="FZG-A-HV", quantity="tooth-loss factor, FZG-A, Ohlendorf's formula", source=SOURCE,
        printed="0.3043",
        computed=ohlendorf_factor(path_a, 16), unit="1", assumptions="closed formula, for comparison only",
    )  # fmt: skip
    yield compare(
        id="FZG-A-HV-integral", quantity="tooth-loss factor, FZG-A, integral", source=SOURCE,
        published=0.3043,
        computed=tooth_loss_factor(path_a), unit="1", basis="verification",
        assumptions="the pitch point lies in double contact, where the closed formula counts a sign wrong",
    )  # fmt: skip
    for identity, text, pair in (
        ("x1-0", "x1 = 0, as shipped", prototype.test_pair),
        ("equal", "x1 = x2", prototype.equal_shifts),
    ):
        yield stated(
            id=f"P2-HV-{identity}", quantity=f"tooth-loss factor, test gear of P2, {text}",
            source="P2, Figure 7",
            published="split of the profile shifts not printed", unit="1", basis="arithmetic",
            computed=tooth_loss_factor(ToothPath.of_pair(pair)),
            assumptions="the heat of the test mesh is proportional to it",
        )  # fmt: skip


def fzg_path(profile_shift: float, face_width: float) -> ToothPath:
    """Path of contact of an FZG gear: 16/24 teeth, module 4.5 mm, centre distance 91.5 mm, full addendum."""
    pair = GearPair.from_centre_distance(
        normal_module=4.5e-3,
        teeth=(16, 24),
        centre_distance=91.5e-3,
        face_widths=(face_width, face_width),
        profile_shift_1=profile_shift,
    )
    return ToothPath.of_pair(pair)
