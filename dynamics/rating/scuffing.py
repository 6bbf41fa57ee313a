"""Scuffing by the flash temperature method, ISO/TS 6336-20:2017: contact temperature over the path. SI in and out."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dynamics.rating.flank_contact import FlankContact
from dynamics.rating.iso_rating import MM, UM
from dynamics.standards import iso_ts_6336_20_2017 as iso

Array = NDArray[np.float64]
ZERO = 273.15
PATH_POINTS = 201


@dataclass(frozen=True, kw_only=True)
class FlankFilmState:
    """Oil and bodies of a mesh as scuffing and micropitting need them.

    oil_temperature : injected, or of the sump [K]; bulk_temperature : of the teeth, mean of both gears [K]
    viscosity : dynamic, at the oil temperature [Pa s]; oil_factor : X_L of its kind, 1 for mineral oil
    roughness : Ra, mean of both flanks [m]; thermal_contact : B_M of pinion and wheel [W s^0.5/(m2 K)]
    """

    oil_temperature: float
    bulk_temperature: float
    viscosity: float
    oil_factor: float
    roughness: float
    thermal_contact: tuple[float, float]


@dataclass(frozen=True, kw_only=True, eq=False)
class ContactTemperature:
    """Contact temperature over the path of contact.

    path : (n,) positions from the pitch point, from A to E [m]; flash : (n,) temperature rise [K]
    bulk : of the teeth [K]; friction : mean coefficient [-]
    """

    path: Array
    flash: Array
    bulk: float
    friction: float

    @property
    def highest(self) -> float:
        """Theta_Bmax [K]."""
        return self.bulk + float(self.flash.max())

    @property
    def hottest(self) -> float:
        """Path position of it [m]."""
        return float(self.path[self.flash.argmax()])


def friction(contact: FlankContact, state: FlankFilmState) -> float:
    """mu_m of the whole mesh, load with all K factors [-]."""
    pair = contact.pair
    return iso.mu_m(
        iso.FrictionContact(
            w_Bt=1e-3
            * contact.load.factors.product
            * contact.load.torque
            / pair.reference_radii[0]
            / pair.face_width,
            v_t=contact.pitch_line_speed,
            sum_over_pitch=contact.sum_speed_factor,
            rho_relC=MM * float(contact.reduced_radius(np.asarray(0.0))),
            eta_oil=1e3 * state.viscosity,
            Ra=UM * state.roughness,
        ),
        state.oil_factor,
    )


def contact_temperature(
    contact: FlankContact, state: FlankFilmState, path: Array | None = None
) -> ContactTemperature:
    """Bulk temperature plus flash temperature from A to E.

    path : (n,) positions [m]; None: `PATH_POINTS` and the points where the load sharing bends

    Raises DynamicsInputError for a transverse contact ratio of 2 or more.
    """
    if path is None:
        whole = contact.pair.path
        path = np.union1d(np.linspace(whole.start, whole.end, PATH_POINTS), list(contact.points.values()))
    mu = friction(contact, state)
    line_load, rho = contact.line_load(path), contact.reduced_radius(path)
    flash = iso.Theta_fl(
        mu,
        line_load,
        contact.rolling_speeds(path),
        iso.band_half_width(line_load, rho, contact.reduced_modulus),
        state.thermal_contact,
    )
    approach = iso.X_J(
        contact.path_parameter(path),
        contact.parameters,
        UM * contact.approach_excess,
        contact.load.pinion_drives,
    )
    return ContactTemperature(path=path, flash=flash * approach, bulk=state.bulk_temperature, friction=mu)


def scuffing_temperature(
    load_stage: float, oil_factor: float, viscosity_90: float, structural_factor: float = 1.0
) -> float:
    """Theta_S [K] of an oil whose test gears scuff at ``load_stage`` of the FZG test A/8.3/90.

    oil_factor : X_L of its kind; viscosity_90 : dynamic, at the 90 degC of the test [Pa s]; structural_factor : X_W
    """
    lubricant = iso.lubricant_factor(oil_factor, 1e3 * viscosity_90)
    return ZERO + iso.Theta_S(load_stage, lubricant, structural_factor)


def scuffing_safety(contact: ContactTemperature, state: FlankFilmState, scuffing: float) -> float:
    """S_B for the scuffing temperature ``scuffing`` [K].

    Counted from the oil; from the bulk temperature where the gears are colder than the oil fed, which is the safe side.

    Raises DynamicsInputError where nothing slides, and the contact is as warm as its body.
    """
    base = min(state.oil_temperature, contact.bulk)
    return iso.S_B(scuffing - ZERO, base - ZERO, contact.highest - ZERO)
