"""Two gearboxes with a pinion between two wheels each; two wheel shafts close the loop, the pinions idle."""

from dynamics.rotor.graph import Drivetrain
from dynamics.rotor.parts import Coupling, GearBody, MeshConnection, Motor
from dynamics.rotor.shaft import Section, Shaft
from dynamics.tooth.law import MeshLaw
from tests.builders.rig import synthetic_law

TEETH = (40, 40)
RADIUS = 0.04
DISTANCE = 0.09
COUPLING_STIFFNESS = 2e5
SPLINE_STIFFNESS = 1e6
SHAFTS = ("test_pinion", "test_left", "test_right", "ref_pinion", "ref_left", "ref_right")
MESHES = ("test left", "test right", "ref left", "ref right")


def idler_rig() -> Drivetrain:
    """Six shafts on four lines, four meshes, one loop; the motor drives the left line."""
    return Drivetrain(
        shafts=tuple(
            Shaft(name=name, sections=(Section(length=0.2, outer_diameter=0.05),), element_length=0.02)
            for name in SHAFTS
        ),
        gears=tuple(
            GearBody(
                name=name, shaft=name, position=0.1, inertia=1e-3, stiffness=SPLINE_STIFFNESS, damping=50.0
            )
            for name in SHAFTS
        ),
        couplings=tuple(
            Coupling(
                name=side, shafts=(f"test_{side}", f"ref_{side}"), stiffness=COUPLING_STIFFNESS, damping=20.0
            )
            for side in ("left", "right")
        ),
        meshes=tuple(
            MeshConnection(
                name=f"{box} {side}",
                pinion=f"{box}_pinion",
                wheel=f"{box}_{side}",
                base_radii=(RADIUS, RADIUS * TEETH[1] / TEETH[0]),
                teeth=TEETH,
                centre_distance=DISTANCE,
            )
            for box in ("test", "ref")
            for side in ("left", "right")
        ),
        motor=Motor(shaft="ref_left", position=0.2, inertia=0.01),
        bracing_coupling="left",
    )


def idler_laws(friction: float = 0.04, damping: float = 1500.0) -> tuple[MeshLaw, ...]:
    """Stiff meshes in the reference gearbox, softer ones in the test gearbox; the second of each lags in phase."""
    return tuple(
        synthetic_law(
            RADIUS, stiffness=stiffness, contact_ratio=1.6, teeth=TEETH, friction=friction, damping=damping
        )._replace(phase=phase)
        for stiffness, phase in ((1.5e8, 0.0), (1.5e8, 1e-3), (4e8, 0.0), (4e8, 2e-3))
    )
