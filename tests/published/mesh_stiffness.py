"""Rows of mesh stiffness at rest: influence numbers of plane sections against ISO 6336-1 and the peer program ROSS.

Gears in one piece with their shafts: held at half the root radius, as the formulas know no bore. The theoretical
stiffness of ISO 6336-1 stands on the teeth of Weber and Banaschek on a half plane, its factor C_M = 0.8 on tests;
finite elements lie between both. ROSS: gear element with time-varying mesh stiffness, its printed example.
"""

from collections.abc import Iterator
from dataclasses import replace

from dynamics.gear.pair import GearPair
from dynamics.rating.iso_rating import RatingOptions, mesh_data, mesh_stiffness
from dynamics.standards import iso6336_1_2006 as iso6336_1_2006_stiffness
from dynamics.tooth.compliance import InterpolatedCompliance
from dynamics.tooth.influence_model import influence_numbers
from dynamics.tooth.loaded_mesh import LoadedMesh
from dynamics.tooth.mesh_cycle import MeshCycle
from dynamics.tooth.points import FaceGrid
from rigdesign.rig.tooth_influence import gear_model
from tests.published.rows import Goal, PublishedQuantity, ValidationRow, compare

NEAR = Goal(0.10)
PER_WIDTH = 1e-9
"""N/(mm um) per N/m2."""
FZG_TORQUE, ROSS_TORQUE = 302.0, 300.0
"""On the pinion [N m]; ROSS: of 3192 N in its line of action."""
MEASURED, THEORY = (RatingOptions(measured_correction=c, low_load_factor=False) for c in (0.8, 1.0))


def mesh_stiffness_rows() -> Iterator[ValidationRow]:
    """FZG-C against ISO's single and mean stiffness, the 20/20 pair of ROSS against its own."""
    pair = GearPair.from_centre_distance(
        normal_module=4.5e-3,
        teeth=(16, 24),
        centre_distance=91.5e-3,
        face_widths=(14e-3, 14e-3),
        profile_shift_1=0.1817,
    )
    cycle = plane_cycle(pair, FZG_TORQUE)
    alone = (cycle.closing.max(axis=2) > 0.0).sum(axis=1) == 1
    data = mesh_data(pair)
    standard = iso6336_1_2006_stiffness.stiffness(data, FZG_TORQUE / pair.base_radii[0] / pair.face_width)
    quantities = (
        ("stiffness-single", "largest stiffness of one pair of FZG-C, c'_th", standard.c_prime_th,
         float(cycle.secant_stiffness[alone].max())),
        ("stiffness-theory", "mean mesh stiffness of FZG-C, C_M = 1",
         PER_WIDTH * mesh_stiffness(pair, FZG_TORQUE, THEORY),
         float(cycle.secant_stiffness.mean())),
        ("stiffness-measured", "mean mesh stiffness of FZG-C, C_M = 0.8",
         PER_WIDTH * mesh_stiffness(pair, FZG_TORQUE, MEASURED), float(cycle.secant_stiffness.mean())),
    )  # fmt: skip
    for identity, text, published, stiffness in quantities:
        yield compare(
            PublishedQuantity(
                id=identity, text=text, source="ISO 6336-1, regression", value=published, unit="N/(mm um)"
            ),
            PER_WIDTH * stiffness / pair.face_width,
            "predicted",
            None if identity == "stiffness-theory" else NEAR,
            assumptions=f"{FZG_TORQUE:.0f} N m, plane strain, gears held at half their root radius",
        )
    yield from _peer_rows()


def _peer_rows() -> Iterator[ValidationRow]:
    pair = GearPair.from_centre_distance(
        normal_module=10e-3,
        teeth=(20, 20),
        centre_distance=200e-3,
        face_widths=(30e-3, 30e-3),
        profile_shift_1=0.0,
    )
    cycle = plane_cycle(pair, ROSS_TORQUE)
    source = "ROSS, 20/20 teeth, m 10 mm, b 30 mm"
    yield compare(
        PublishedQuantity(
            id="stiffness-ROSS", text="mean mesh stiffness", source=source, value=518.0, unit="N/um"
        ),
        1e-6 * float(cycle.secant_stiffness.mean()),
        "predicted",
        NEAR,
        assumptions="its flattening is linear and its body a ring on the bore; ours held at half the root radius",
    )
    yield compare(
        PublishedQuantity(
            id="contact-ratio-ROSS", text="contact ratio", source=source, value=1.5525, unit="1"
        ),
        pair.transverse_contact_ratio,
        "arithmetic",
        Goal(0.005),
        assumptions="full-depth teeth by geometry; the printed ratio stays below that of its own formula",
    )


def plane_cycle(pair: GearPair, torque: float) -> MeshCycle:
    """Loaded contact of a spur pair in plane strain under a torque on the pinion [N m], 2 s a gear."""
    first, second = (
        InterpolatedCompliance.of(
            influence_numbers(replace(gear_model(pair, index), plane_strain=True)).even()
        )
        for index in (0, 1)
    )
    mesh = LoadedMesh(
        pair=pair, gears=(first, second), grid=FaceGrid.over(pair.face_width, 1), n_positions=128
    )
    return mesh.cycle(torque / pair.base_radii[0])
