"""Rows of the tooth-loss factor: FZG gears of DIN ISO 14635 and P2's test gear with its open profile shifts.

Found by these rows: the often quoted 0.3043 of FZG-A is Ohlendorf's formula, which counts one sign wrong
where the pitch point lies in double contact; its own load sharing integrates to 0.3006. The split of P2's
profile shifts, which is not printed, decides the mesh loss of the test gear by a factor of 2.8.
"""

from collections.abc import Iterator

from dynamics.gear.pair import GearPair
from dynamics.tooth.friction import ToothPath, ohlendorf_factor, tooth_loss_factor
from tests.published.prototype import Prototype
from tests.published.rows import PublishedQuantity, ValidationRow, compare, compare_printed

SOURCE = "DIN ISO 14635-1 geometry, Ohlendorf as in FVA"


def loss_rows(prototype: Prototype) -> Iterator[ValidationRow]:
    """H_V of FZG-C and FZG-A, and of the test gear for two splits."""
    path_c, path_a = fzg_path(0.1817, 14e-3), fzg_path(0.8532, 20e-3)
    yield compare_printed(
        PublishedQuantity(
            id="FZG-C-HV",
            text="tooth-loss factor, FZG-C, integral",
            source=SOURCE,
            printed="0.1986",
            unit="1",
        ),
        tooth_loss_factor(path_c),
        assumptions="rigid load sharing, no dynamics",
    )
    yield compare_printed(
        PublishedQuantity(
            id="FZG-A-HV",
            text="tooth-loss factor, FZG-A, Ohlendorf's formula",
            source=SOURCE,
            printed="0.3043",
            unit="1",
        ),
        ohlendorf_factor(path_a, 16),
        assumptions="closed formula, for comparison only",
    )
    yield compare(
        PublishedQuantity(
            id="FZG-A-HV-integral",
            text="tooth-loss factor, FZG-A, integral",
            source=SOURCE,
            value=0.3043,
            unit="1",
        ),
        tooth_loss_factor(path_a),
        "verification",
        assumptions="the pitch point lies in double contact, where the closed formula counts a sign wrong",
    )
    for identity, text, pair in (
        ("x1-0", "x1 = 0, as shipped", prototype.test_pair),
        ("equal", "x1 = x2", prototype.equal_shifts),
    ):
        yield compare(
            PublishedQuantity(
                id=f"P2-HV-{identity}",
                text=f"tooth-loss factor, test gear of P2, {text}",
                source="P2, Figure 7",
                printed="split of the profile shifts not printed",
                unit="1",
            ),
            tooth_loss_factor(ToothPath.of_pair(pair)),
            "arithmetic",
            assumptions="the heat of the test mesh is proportional to it",
        )


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
