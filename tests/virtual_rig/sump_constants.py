"""Constants of the heat part of a rig with sumps, with spreads; see `heat_constants`."""

from collections.abc import Mapping

from tests.virtual_rig.heat_constants import CONSTANTS as OF_JETS
from tests.virtual_rig.heat_constants import Constant

SHARED = (
    "k_housing", "k_field", "k_shafts", "k_slope", "foot_contact", "seat_contact", "free_wall", "free_top",
    "free_field", "draught", "draught_speed", "emissivity_housing", "emissivity_field", "emissivity_shaft",
    "film_overhang", "room_layers", "friction", "friction_load", "friction_speed", "friction_viscosity",
    "mesh_damping", "oil_viscosity", "oil_index", "oil_density", "oil_heat_capacity", "oil_conductivity", "film_drum",
)  # fmt: skip
"""Constants of every rig with a housing."""
# fmt: off
CONSTANTS: Mapping[str, Constant] = {
    **{name: OF_JETS[name] for name in SHARED},
    "shell_contact": Constant(8.0e3, 0.15),
    # films inside at the speed of the case [W/(m2 K)], and their exponents
    "film_bath": Constant(210.0, 0.10), "film_splash": Constant(270.0, 0.10),
    "exponent_bath": Constant(0.20, 0.05, True, 2.0), "exponent_splash": Constant(0.15, 0.05, True, 2.0, 0.05),
    "exponent_viscosity": Constant(0.15, 0.04, True, 2.0),
    "film_rim": Constant(1600.0, 0.10), "exponent_rim": Constant(0.33, 0.05, True, 2.0, -0.05),
    "side_share": Constant(0.65, 0.10), "film_seal_end": Constant(200.0, 0.15),
    "raceway_outer": Constant(900.0, 0.12), "raceway_inner": Constant(900.0, 0.12),
    "bearing_flow": Constant(6.0e-6, 0.25),
    "layers": Constant(4.0, 1.5, True, 1.5, 6.0),
    # losses
    "bearing_free": Constant(2.0, 0.12), "bearing_load": Constant(4.0e-4, 0.10),
    "churning": Constant(0.5, 0.15), "churning_pair": Constant(-0.6, 0.08, True, 2.0, 0.05),
    "lip_drag": Constant(1.0, 0.10), "level": Constant(0.0, 2e-3, True),
    "flank_contact": Constant(7.0, 0.15), "into_gears": Constant(0.85, 0.05), "pinion_share": Constant(0.92, 0.04),
}
# fmt: on
"""Those that are not of every rig:

film_rim       on the cylinder of the pitch circle, which has about half the surface of the teeth
side_share     share of the boundary layer of a disc that turns in oil alone
bearing_flow   oil that passes a bearing at the speed of the case [m3/s]
bearing_free   f_0 of Palmgren; bearing_load his f_1
churning       factor on the law of Boness: between published laws, which lie a factor of five apart on such gears
churning_pair  exponent of the speed on that factor: oil in a narrow box comes to turn with the gears, and drags
               that were measured grow less with speed than his law (assumed)
level          of the oil above that of the case [m]
flank_contact  heat that passes from gear to gear where flanks touch, at speed and torque of the case [W/K]:
               e / sqrt(pi t) on the area of contact, e = 12500 W s^0.5/(m2 K), t = 0.3 ms, 17 mm2
pinion_share   of half of the mesh loss: the hotter pinion takes less
"""
