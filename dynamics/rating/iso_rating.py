"""ISO 6336 ratings of a gear pair: the SI geometry put into the documents' symbols and units."""

from dataclasses import dataclass
from math import cos, degrees, inf, pi

from dynamics.gear.pair import GearPair
from dynamics.standards import (
    iso1328_1_2013,
    iso6336_1_2006,
    iso6336_3_2006,
)
from dynamics.standards import (
    iso6336_1_2006 as iso6336_1_2006_stiffness,
)
from dynamics.standards.iso6336_1_2006 import (
    DynamicFactor,
    GearLoad,
    MeshData,
    RunIn,
    RunningIn,
    StiffnessChoices,
    ToothDeviations,
)
from dynamics.standards.iso6336_3_2006 import NOMINAL_LOAD, LoadFactors, RootStress, ToothLoad, ToothRoot

MM = 1e3
UM = 1e6


@dataclass(frozen=True, kw_only=True)
class RatingOptions:
    """Choices that ISO 6336-1 leaves to the user."""

    grade: int = 5
    """ISO 1328-1:2013 tolerance grade of both gears."""
    tip_relief: float | None = None
    """Designed C_a [m]; None: relief by running-in from sigma_hlim."""
    sigma_hlim: tuple[float, float] = (1500e6, 1500e6)
    """Allowable contact stress numbers [Pa], for running-in only."""
    run_in: RunIn = "case_hardened"
    application_factor: float = 1.0
    low_load_factor: bool = True
    measured_correction: float = 0.8
    """C_M."""
    exact_inertia: bool = False
    """Reduced mass from the moments of inertia of the bodies instead of the disc formula."""
    base_pitch_deviation: float | None = None
    """f_pb [m]; None: from the grade."""
    profile_form_deviation: float | None = None
    """f_falpha [m]; None: from the grade."""
    relief_grade: int = 6
    """Coarsest grade whose tip relief counts in K_V."""


def mesh_data(pair: GearPair) -> MeshData:
    """The pair as ISO 6336-1 reads it (mm, degrees), with the contact ratio of the active flanks."""
    pinion, wheel = pair.gears
    bores = tuple(0.5 * bore / gear.mean_radius for bore, gear in zip(pair.bore_diameters, pair.gears))
    return MeshData(
        z_1=pair.teeth[0],
        z_2=pair.teeth[1],
        z_n1=pinion.virtual_teeth,
        z_n2=wheel.virtual_teeth,
        m_n=pair.normal_module * MM,
        alpha_Pn=degrees(pair.pressure_angle),
        alpha_t=degrees(pair.transverse_pressure_angle),
        beta=degrees(pair.helix_angle),
        x_1=pair.profile_shifts[0],
        x_2=pair.profile_shifts[1],
        h_fP1=pair.racks[0].dedendum,
        h_fP2=pair.racks[1].dedendum,
        b=pair.face_width * MM,
        d_1=2.0 * pinion.reference_radius * MM,
        d_b1=2.0 * pinion.base_radius * MM,
        d_m1=2.0 * pinion.mean_radius * MM,
        d_m2=2.0 * wheel.mean_radius * MM,
        epsilon_alpha=pair.transverse_contact_ratio,
        epsilon_beta=pair.overlap_ratio,
        rho_1=pair.densities[0] * 1e-9,
        rho_2=pair.densities[1] * 1e-9,
        q_1=bores[0],
        q_2=bores[1],
        E_1=pair.youngs_moduli[0] * 1e-6,
        E_2=pair.youngs_moduli[1] * 1e-6,
        b_s_over_b=(_web(pair, 0), _web(pair, 1)),
        s_R_over_m_n=(_rim(pair, 0) / pair.normal_module, _rim(pair, 1) / pair.normal_module),
    )


def _web(pair: GearPair, index: int) -> float | None:
    """Web over face width of a gear with a thin web [-]; None for a solid one."""
    web = pair.details[index].web_thickness
    return None if web is None else web / pair.face_widths[index]


def tangential_force(pair: GearPair, torque: float) -> float:
    """F_t [N] at the reference circle for the pinion ``torque`` [N m]."""
    return torque / pair.gears[0].reference_radius


def deviations(pair: GearPair, options: RatingOptions) -> tuple[float, float]:
    """Larger f_pb and f_falpha of both gears [um], from the ISO 1328-1:2013 grade unless given.

    f_pb is the transverse single pitch tolerance times cos(alpha_t). Raises DynamicsInputError for a grade outside
    1 to 11.
    """
    module = pair.normal_module * MM
    diameters = [2.0 * gear.reference_radius * MM for gear in pair.gears]
    pitch = max(iso1328_1_2013.f_pT(d, module, options.grade) for d in diameters)
    f_pb = pitch * cos(pair.transverse_pressure_angle)
    f_falpha = iso1328_1_2013.f_falphaT(module, options.grade)
    if options.base_pitch_deviation is not None:
        f_pb = options.base_pitch_deviation * UM
    if options.profile_form_deviation is not None:
        f_falpha = options.profile_form_deviation * UM
    return f_pb, f_falpha


def mesh_stiffness(pair: GearPair, torque: float, options: RatingOptions | None = None) -> float:
    """ISO 6336-1 mesh stiffness c_gamma_alpha [N/m per m of face width = N/m2] at the pinion torque [N m]."""
    options = options or RatingOptions()
    load = tangential_force(pair, torque) * options.application_factor / (pair.face_width * MM)
    tooth = iso6336_1_2006_stiffness.stiffness(mesh_data(pair), load, _stiffness_choices(options))
    return tooth.c_gamma_alpha * 1e9


def dynamic_factor(
    pair: GearPair, torque: float, speed: float, options: RatingOptions | None = None
) -> DynamicFactor:
    """K_V by ISO 6336-1:2006 method B, every factor with it.

    torque : of the pinion, above 0 [N m]; speed : of the pinion, not negative [rad/s]
    options : choices that the document leaves open; default ``RatingOptions()``

    Raises DynamicsInputError for a torque or speed out of range and where the stiffness regression fails.
    """
    options = options or RatingOptions()
    f_pb, f_falpha = deviations(pair, options)
    return iso6336_1_2006.dynamic_factor(
        mesh_data(pair),
        GearLoad(F_t=tangential_force(pair, torque), n_1=speed * 30.0 / pi, K_A=options.application_factor),
        ToothDeviations(f_pb=f_pb, f_falpha=f_falpha, grade=options.grade, relief_grade=options.relief_grade),
        RunningIn(
            C_a=None if options.tip_relief is None else options.tip_relief * UM,
            sigma_Hlim=(options.sigma_hlim[0] * 1e-6, options.sigma_hlim[1] * 1e-6),
            run_in_class=options.run_in,
        ),
        _stiffness_choices(options),
        exact_m_red=_exact_reduced_mass(pair) if options.exact_inertia else None,
    )


def _stiffness_choices(options: RatingOptions) -> StiffnessChoices:
    return StiffnessChoices(low_load_factor=options.low_load_factor, C_M=options.measured_correction)


def transverse_load_factor(
    pair: GearPair, factor: DynamicFactor, *, dynamic: float = 1.0, face_load: float = 1.0
) -> float:
    """K_Falpha of ISO 6336-1:2006, 8.3.2, from the stiffness and the run-in pitch deviation of ``factor``.

    ``dynamic`` is K_V and ``face_load`` K_Hbeta in the determinant load F_tH; K_Fbeta in its place is on the
    safe side, a smaller load shares worse.
    """
    return iso6336_3_2006.K_Falpha(
        pair.transverse_contact_ratio,
        pair.total_contact_ratio,
        factor.stiffness.c_gamma_alpha,
        factor.f_pb_eff,
        factor.specific_load * dynamic * face_load,
    )


def _exact_reduced_mass(pair: GearPair) -> float:
    """Reduced mass per face width [kg/mm] of the bodies as they are, width beyond the common one included."""
    (inertia_1, inertia_2), (r_1, r_2) = pair.inertias, pair.base_radii
    return iso6336_1_2006.m_red_exact(
        inertia_1 * MM**2, inertia_2 * MM**2, r_1 * MM, r_2 * MM, pair.face_width * MM
    )


def tooth_root(pair: GearPair, index: int) -> ToothRoot:
    """Gear ``index`` (0 pinion, 1 wheel) as ISO 6336-3 reads it, with the generating profile shift."""
    gear = pair.gears[index]
    return ToothRoot(
        z=gear.teeth,
        m_n=gear.normal_module * MM,
        alpha_n=degrees(gear.pressure_angle),
        beta=degrees(gear.helix_angle),
        x=gear.generating_profile_shift,
        h_fP=gear.rack.dedendum,
        rho_fP=gear.rack.tip_radius,
        d_a=2.0 * pair.flanks[index].tip_radius * MM,
        s_pr=pair.details[index].protuberance * MM,
    )


def permissible_factors(pair: GearPair, index: int, cycles: float) -> dict[str, float]:
    """Factors that turn sigma_FE into the strength of gear ``index`` after ``cycles``, by printed symbol.

    Steel gears; the surface factor Y_RrelT is left at 1, the root roughness of the test gears behind sigma_FE.
    """
    root = tooth_root(pair, index)
    return {
        "Y_NT": iso6336_3_2006.Y_NT(cycles),
        "Y_deltarelT": iso6336_3_2006.Y_deltarelT(iso6336_3_2006.root_section(root)),
        "Y_X": iso6336_3_2006.Y_X(root.m_n),
    }


def root_width(pair: GearPair, index: int) -> float:
    """Face width b [m] of ISO 6336-3:2006, 5.2: one module a side beyond the common width at most."""
    return min(pair.face_widths[index], pair.face_width + 2.0 * pair.normal_module)


def _rim(pair: GearPair, index: int) -> float:
    """Rim under the root circle [m], stated or down to the bore; inf for a solid gear."""
    stated = pair.details[index].rim_thickness
    if stated is not None:
        return stated
    bore = 0.5 * pair.bore_diameters[index]
    return pair.root_radii[index] - bore if bore else inf


def root_stress(
    pair: GearPair,
    torque: float,
    index: int,
    factors: LoadFactors = NOMINAL_LOAD,
    *,
    grade: int = 5,
    rim_thickness: float | None = None,
) -> RootStress:
    """Root stress of gear ``index`` (0 pinion, 1 wheel) by ISO 6336-3:2006 method B, every factor with it.

    Parameters
    ----------
    torque : of the pinion [N m]
    factors : K_A, K_V, K_Fbeta, K_Falpha
    grade : ISO 1328-1 tolerance grade, for the deep tooth factor
    rim_thickness : [m]; None: that of the gear, or what the bore leaves under the root

    Raises DynamicsInputError for a rim of half a tooth height or less, and where the 30 degree tangent is not found.
    """
    rim = _rim(pair, index) if rim_thickness is None else rim_thickness
    return iso6336_3_2006.root_stress(
        tooth_root(pair, index),
        ToothLoad(
            F_t=tangential_force(pair, torque),
            b=root_width(pair, index) * MM,
            epsilon_alpha=pair.transverse_contact_ratio,
            epsilon_beta=pair.overlap_ratio,
        ),
        factors,
        grade=grade,
        s_R=rim * MM,
    )
