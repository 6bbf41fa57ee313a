"""Rows of the strain-gauge paper (P1): no case of that rig exists yet, so none is modelled."""

from collections.abc import Iterator

from rigdesign.validation.rows import Basis, PublishedQuantity, ValidationRow, not_modelled

NO_CASE = "no case of P1's rig yet: its tooth numbers, helix angle and profile shifts are not printed"
NO_FE = "needs loaded tooth contact with FE influence numbers and stress at a gauge"

ROWS: tuple[tuple[str, str, str, str, str, Basis, str], ...] = (
    ("P1-eps-free", "contact ratio of the test gear without load", "P1, text", "1.03", "1", "fitted", NO_FE),
    ("P1-eps-loaded", "contact ratio of the test gear at 238 N m", "P1, text", "1.24", "1", "fitted", NO_FE),
    ("P1-eps-reference", "contact ratio of the reference gear", "P1, text", "1.595", "1", "fitted", NO_CASE),
    ("P1-sigma", "largest root stress, gauge II, 189 N m", "P1, derived from Figure 10", "about 125", "MPa",
     "fitted",
     NO_FE),
    ("P1-static-MBS", "largest static deviation, MBS", "P1, Figure 9", "8.75, below 10 %", "MPa", "predicted",
     NO_FE),
    ("P1-static-FE", "largest static deviation, tooth contact analysis", "P1, Figure 9", "4.7, below 10 %",
     "MPa",
     "predicted", NO_FE),
    ("P1-coupling", "elastic against rigid couplings, 100 and 1500 rpm", "P1, Figure 8", "below 2 %", "1",
     "predicted", NO_CASE),
    ("P1-speed-measured", "change of the maximum, 100 to 1500 rpm, measured", "P1, Figure 10",
     "-7 % (8.8 MPa)", "1",
     "predicted", NO_FE),
    ("P1-speed-simulated", "change of the maximum, 100 to 1500 rpm, simulated", "P1, Figure 10",
     "-4 % (5 MPa)", "1",
     "predicted", NO_FE),
    ("P1-speed-start", "start of mesh from 100 to 1500 rpm", "P1, Figure 10", "rises", "1", "predicted",
     NO_FE),
    ("P1-pattern", "contact pattern at 140, 336 and 483 N m", "P1, Figure 7",
     "top left and bottom right unloaded, shifted right at low load", "1", "fitted", NO_FE),
)  # fmt: skip


def p1_rows() -> Iterator[ValidationRow]:
    """Every number of P1 with what it waits for."""
    for identity, quantity, source, published, unit, basis, reason in ROWS:
        yield not_modelled(
            PublishedQuantity(id=identity, text=quantity, source=source, printed=published, unit=unit),
            basis,
            reason=reason,
        )
