"""The test gear of P1 as far as it is printed; tooth numbers, helix angle and shift split are assumed here.

Printed: a 112.5 mm, m_n 6 mm, b 25 mm, tip shortening 2.5 mm of the wheel (it keeps clear of the gauges in the root of
the pinion), C_beta1 3 um, C_alpha2 25 um, C_beta2 32 um, twist of the wheel 160 um, f_Hbeta1 -10 um for the axes.

The twist is read as S_alpha, the difference of the profile slopes at both ends of the face: corners of +-40 um. With
C_alpha + C_beta = 57 um no corner stands out of the flank then, and two opposite ones are free, as the contact patterns
of Figure 7 show; read as the amount at the corner, two corners would stand out by 103 um and carry first.
P1 does not say to which end twist and f_Hbeta count. Here the tip of the wheel is free at its rear end, as its natural
twist has it, and the pinion at its front end.
"""

from math import radians

from dynamics.gear.microgeometry import Microgeometry
from dynamics.gear.pair import GearPair
from dynamics.gear.pair_geometry import TipShortening, shift_sum

TWIST = 160e-6
PINION = Microgeometry(lead_crowning=3e-6, helix_slope=-10e-6)
WHEEL = Microgeometry(profile_crowning=25e-6, lead_crowning=32e-6, profile_twist=0.25 * TWIST)


def p1_pair(helix_angle: float = 10.0) -> GearPair:
    """Test gear with 18/18 teeth and equal shifts; helix angle [deg]."""
    beta = radians(helix_angle)
    total = shift_sum(6e-3, radians(20.0), beta, (18, 18), 112.5e-3)
    return GearPair.from_centre_distance(
        normal_module=6e-3,
        teeth=(18, 18),
        centre_distance=112.5e-3,
        helix_angle=beta,
        face_widths=(25e-3, 25e-3),
        profile_shift_1=0.5 * total,
        tips=TipShortening(shortening=(0.0, 2.5e-3)),
    )
