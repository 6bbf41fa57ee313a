"""Rows of the strain-gauge paper (P1), on the case of its rig: contact ratio and pattern; others wait for root stress.

Found by these rows: crowned flanks hand over from pair to pair, so that their contact ratio in the limit of no load is
1 whatever the gears; P1's "load-free" 1.03 is that of a small load. Tooth number, helix angle and sign of the twist
were chosen with 1.24, the pattern and the stress in view (``cases/strain_gauge_rig/search_gears.py``).
"""

from collections.abc import Iterator

from rigdesign.validation.rows import (
    Basis,
    Goal,
    PublishedQuantity,
    ValidationRow,
    compare,
    not_modelled,
)

CHOSEN = 3
"""Inputs chosen with the contact in view: tooth number, helix angle, sign of the twist."""
PATTERN_TORQUES = (140.0, 336.0, 483.0)
TEXT = "P1, text"
PATTERN = "P1, text on Figure 7"
NO_FE = "needs stress at a gauge from influence numbers"
NO_SLOW = "needs stress at a gauge, at 100 rpm too, where no periodic response of the loop is found"

WAITING: tuple[tuple[str, str, str, str, str, Basis, str], ...] = (
    ("P1-sigma", "largest root stress, gauge II, 189 N m", "P1, derived from Figure 10", "about 125", "MPa",
     "fitted", NO_FE),
    ("P1-static-MBS", "largest static deviation, MBS", "P1, Figure 9", "8.75, below 10 %", "MPa", "predicted",
     NO_FE),
    ("P1-static-FE", "largest static deviation, tooth contact analysis", "P1, Figure 9", "4.7, below 10 %",
     "MPa", "predicted", NO_FE),
    ("P1-coupling", "elastic against rigid couplings, 100 and 1500 rpm", "P1, Figure 8", "below 2 %", "1",
     "predicted", NO_SLOW),
    ("P1-speed-measured", "change of the maximum, 100 to 1500 rpm, measured", "P1, Figure 10",
     "-7 % (8.8 MPa)", "1", "predicted", NO_SLOW),
    ("P1-speed-simulated", "change of the maximum, 100 to 1500 rpm, simulated", "P1, Figure 10",
     "-4 % (5 MPa)", "1", "predicted", NO_SLOW),
    ("P1-speed-start", "start of mesh from 100 to 1500 rpm", "P1, Figure 10", "rises", "1", "predicted",
     NO_SLOW),
)  # fmt: skip


def p1_rows() -> Iterator[ValidationRow]:
    """Every number of P1: those of the loaded contact, and the others with what they wait for."""
    yield from contact_rows()
    yield from waiting_rows()


def waiting_rows() -> Iterator[ValidationRow]:
    """Numbers of P1 whose model does not exist yet."""
    for identity, quantity, source, published, unit, basis, reason in WAITING:
        yield not_modelled(
            PublishedQuantity(id=identity, text=quantity, source=source, printed=published, unit=unit),
            basis,
            reason=reason,
        )


def contact_rows() -> Iterator[ValidationRow]:
    """Contact ratios and pattern of the shipped case on the analytic compliance of the teeth."""
    from rigdesign.case import load_case
    from rigdesign.case.shipped import case_folder
    from rigdesign.coupling.loads import mesh_microgeometry
    from rigdesign.rig.model import build_rig
    from rigdesign.validation.p1_contact import (
        contact_of,
        corner_load,
        cycle_at,
        ratio_without_load,
        torque_of_ratio,
    )

    rig = build_rig(load_case(case_folder("strain_gauge_rig")), "quick")
    pair = rig.pairs["test.main"]
    mesh = contact_of(pair, mesh_microgeometry(rig, "test.main", pair))
    teeth = (
        f"{pair.teeth[0]}/{pair.teeth[1]} teeth and the helix angle that meet 1.24, by geometry "
        f"{pair.total_contact_ratio:.2f}; analytic compliance"
    )
    yield compare(
        PublishedQuantity(
            id="P1-eps-free",
            text="contact ratio of the test gear without load",
            source=TEXT,
            value=1.03,
            unit="1",
        ),
        ratio_without_load(mesh),
        "fitted",
        Goal(0.02),
        free_parameters=CHOSEN,
        assumptions="limit of no load: crowned flanks touch at one pair; 1.03 is reached at "
        f"{torque_of_ratio(mesh, 1.03):.0f} N m",
    )
    yield compare(
        PublishedQuantity(
            id="P1-eps-loaded",
            text="contact ratio of the test gear at 238 N m",
            source=TEXT,
            value=1.24,
            unit="1",
        ),
        cycle_at(mesh, 238.0).contact_ratio,
        "fitted",
        Goal(0.02),
        free_parameters=CHOSEN,
        assumptions=teeth,
    )
    yield compare(
        PublishedQuantity(
            id="P1-eps-reference",
            text="contact ratio of the reference gear",
            source=TEXT,
            value=1.595,
            unit="1",
        ),
        rig.pairs["reference.main"].total_contact_ratio,
        "input",
        Goal(0.02),
        free_parameters=1,
        assumptions="both tips cut to it; full tips would give 1.687",
    )
    corners = {torque: corner_load(pair, cycle_at(mesh, torque).pattern(0)) for torque in PATTERN_TORQUES}
    for torque, found in corners.items():
        yield compare(
            PublishedQuantity(
                id=f"P1-pattern-{torque:.0f}",
                text=f"share of the corners top left and bottom right that carries, {torque:.0f} N m",
                source=PATTERN,
                printed="unloaded",
                unit="1",
            ),
            found.start_to_end,
            "fitted",
            free_parameters=CHOSEN,
            assumptions=f"{found.across:.2f} of the other two corners carries; corner: a quarter of profile and face",
        )
    low, high = corners[PATTERN_TORQUES[0]], corners[PATTERN_TORQUES[-1]]
    yield compare(
        PublishedQuantity(
            id="P1-pattern-shift",
            text="centre of load to the right of mid-face, 140 N m",
            source=PATTERN,
            printed="shifted to the right at low loads",
            unit="mm",
        ),
        -1e3 * low.centre,
        "fitted",
        free_parameters=CHOSEN + 1,
        assumptions=f"{-1e3 * high.centre:.2f} mm at 483 N m; by f_Hbeta of 10 um, which P1 chose to meet the pattern",
    )
