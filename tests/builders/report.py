"""A synthetic result in the shape of a real one, for tests of writers, report and study. Not a prediction."""

from functools import cache

import numpy as np

from rigdesign.base.units import ZERO_CELSIUS
from rigdesign.case.assumptions import AssumptionRecord
from rigdesign.checks.rules import Rule, distance
from rigdesign.results.check import Check, Checks, Finding, HandCalculation
from rigdesign.results.dynamics import (
    DynamicFactorPoint,
    DynamicsResult,
    GearboxDynamics,
    RampHistory,
    RootStressHistory,
)
from rigdesign.results.housing import (
    BodyTemperature,
    CoolingBalance,
    HousingTemperatures,
    RadiationReadings,
)
from rigdesign.results.loads import (
    ContactLoss,
    HeldBracing,
    JointDamping,
    ListedMode,
    MeshResonance,
    RootStressRatio,
    StageLoad,
    TorqueBalance,
    UnsolvedSpeed,
)
from rigdesign.results.quantity import Records
from rigdesign.results.result import CouplingHistory, IterationResidual, RunResult
from rigdesign.results.thermal import (
    ExpansionResult,
    LossRow,
    OilRow,
    TemperatureField,
)
from rigdesign.results.units import L_MIN, RPM
from thermal.conduction.balance import HeatFlow
from thermal.fe.mesh import NamedMesh
from thermal.films.law import FilmCoefficient

KUHN = [(0, 1, 3, 7), (0, 1, 5, 7), (0, 2, 3, 7), (0, 2, 6, 7), (0, 4, 5, 7), (0, 4, 6, 7)]
TET_EDGES = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]
TET_FACES = [(0, 1, 2), (0, 1, 3), (0, 2, 3), (1, 2, 3)]


def voxel_mesh(body_of_voxel, names, spacing):
    """10-node tetrahedra from a grid of cubes; -1 is empty. Outer facets are one surface per body."""
    shape = np.array(body_of_voxel.shape)
    voxels = np.argwhere(body_of_voxel >= 0)
    corners = np.array([[(c >> k) & 1 for k in range(3)] for c in range(8)])
    grid = np.ravel_multi_index((voxels[:, None, :] + corners).reshape(-1, 3).T, shape + 1).reshape(-1, 8)
    used, tets = np.unique(grid[:, KUHN].reshape(-1, 4), return_inverse=True)
    tets = tets.reshape(-1, 4)
    points = np.array(np.unravel_index(used, shape + 1)).T * spacing
    volume = np.linalg.det(points[tets[:, 1:]] - points[tets[:, :1]])
    tets[volume < 0] = tets[volume < 0][:, [1, 0, 2, 3]]
    bodies = np.repeat(body_of_voxel[tuple(voxels.T)], 6)
    edges = np.sort(tets[:, TET_EDGES].reshape(-1, 2), axis=1)
    unique, mid = np.unique(edges, axis=0, return_inverse=True)
    cells = np.hstack([tets, len(points) + mid.reshape(-1, 6)]).astype(np.int32)
    points = np.vstack([points, points[unique].mean(axis=1)])
    mid_node = {tuple(edge): len(used) + i for i, edge in enumerate(unique.tolist())}
    faces = tets[:, TET_FACES].reshape(-1, 3)
    _, first, counts = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    surfaces = {name: [] for name in names}
    for index in first[counts == 1]:
        a, b, c = faces[index].tolist()
        inside = points[tets[index // 4]].mean(axis=0)
        if np.dot(np.cross(points[b] - points[a], points[c] - points[a]), points[a] - inside) < 0:
            b, c = c, b
        mids = [mid_node[tuple(sorted(pair))] for pair in ((a, b), (b, c), (c, a))]
        surfaces[names[bodies[index // 4]]].append([a, b, c, *mids])
    return NamedMesh(
        points=points,
        cells=cells,
        bodies={name: np.flatnonzero(bodies == i).astype(np.int32) for i, name in enumerate(names)},
        surfaces={f"{name}_outside": np.array(rows, dtype=np.int32) for name, rows in surfaces.items()},
    )


@cache
def gearbox_field(spacing=0.025):
    """A box on a plate with two square shafts through it, warm on one side."""
    names = ["housing", "clamping_field", "shaft_pinion", "shaft_wheel"]
    body = np.full((16, 12, 10), -1)
    body[:, :, 0] = 1
    body[2:14, 2:10, 1:9] = 0
    body[3:8, 3:9, 2:8] = -1
    body[9:13, 3:9, 2:8] = -1
    body[1:16, 4, 4], body[0:15, 7, 4] = 2, 3
    mesh = voxel_mesh(body, names, spacing)
    x, y, z = mesh.points.T
    warm = 1 / (1 + np.exp((x - 0.2) / 0.04))
    temperature = 313.15 + 95 * warm * np.exp(-(((z - 0.11) / 0.25) ** 2)) + 12 * np.cos(20 * y) * warm
    displacement = 1.2e-5 * (temperature - 293.15)[:, None] * (mesh.points - [0.35, 0.15, 0.0])
    heat_flux = -50.0 * np.column_stack([temperature * 0.01 / spacing, 0.0 * x, z])
    return TemperatureField("test", "dwell", mesh, temperature, displacement, heat_flux)


def make_check(identity, value, limit, *, verdict=None, comparison="<=", unit="mm", **more):
    """A check with margin and distance from value and limit."""
    margin = limit - value if comparison == "<=" else value - limit
    rule = Rule(id=identity, title="", unit=unit, source="", group="", limit=limit, comparison=comparison)
    given = {
        "title": identity.replace("_", " "),
        "source": "P2, text",
        "role": "rig",
        "group": "clearances",
        **more,
    }
    return Check(
        id=identity,
        value=value,
        limit=limit,
        unit=unit,
        comparison=comparison,
        margin=margin,
        distance=distance(rule, value),
        verdict=verdict or ("pass" if margin >= 0 else "fail"),
        **given,
    )


def checks():
    return [
        make_check(
            "root_stress_window",
            2180.0,
            950.0,
            unit="N/mm2",
            role="specimen",
            group="specimen",
            title="Root stress of the test pinion, ISO 6336-3 with simulated K_V",
            reason="nominal root stress 1.8 GPa at 180 Nm times K_V 1.21",
            assumptions=("gearboxes.test.gears.pinion.material",),
            source="ISO 6336-3:2006, method B",
        ),
        make_check(
            "seal_gap_minimum",
            0.571,
            0.3,
            comparison=">=",
            title="Smallest radial seal gap, hot",
            assumptions=("gearboxes.test.seals.gap",),
        ),
        make_check(
            "axial_play",
            0.062,
            0.06,
            comparison=">=",
            flags=("close",),
            title="Axial play, hot",
            reason="holds, but only 3 % of the limit are left",
        ),
        make_check(
            "bearing_film", 121.0, 130.0, unit="degC", group="temperatures", title="Bearing film temperature"
        ),
        make_check(
            "minimum_film", 14.2, 9.0, comparison=">=", unit="um", group="losses", title="Minimum oil film"
        ),
        make_check(
            "start_torque", 10.0, 10.0, unit="Nm", group="ramp", title="Torque before the transition speed"
        ),
        Check(
            id="bought_part_coupling",
            title="Limit of a bought part: coupling",
            value=None,
            limit=None,
            unit="Nm",
            comparison="<=",
            margin=None,
            distance=None,
            verdict="not applicable",
            source="datasheet",
            role="rig",
            reason="no coupling is fitted",
            group="ramp",
        ),
        Check(
            id="load_cycles",
            title="Load cycles in the planned test time",
            value=2.1e9,
            limit=1e9,
            unit="1",
            comparison="within",
            margin=1.1e9,
            distance=0.52,
            verdict="pass",
            source="P2, Figure 1",
            role="specimen",
            group="specimen",
            upper_limit=1e10,
        ),
    ]


def gearbox(role, excitation, resonances):
    speed = np.linspace(500, 12000, 200)
    kv = 1 + excitation * (
        0.25 + sum(h / (1 + ((speed - n) / 90) ** 2) for n, h in ((1219, 0.8), (1796, 1.0), (2954, 0.6)))
    )
    iso = np.where(
        speed < 2500, 1 + speed / 1e4, np.where(speed < 3400, 1.85, np.where(speed < 4500, 1.3, 0.87))
    )

    def curve(scale):
        return [
            DynamicFactorPoint(
                speed_rpm=float(n),
                simulated=float(1 + scale * (k - 1)),
                simulated_half_peak_to_peak=float(1 + 0.6 * scale * (k - 1)),
                iso_6336_1_method_b=float(i),
                method="harmonic_balance",
            )
            for n, k, i in zip(speed, kv, iso)
        ]

    phi = np.linspace(0, 9.2, 240)
    static = 1800 * np.clip(np.sin(np.pi * phi / 9.2), 0, None) ** 0.7
    histories = [
        RootStressHistory(
            gear=gear,
            stage="dwell",
            rolling_angle_deg=phi.tolist(),
            dynamic_MPa=(static * (1 + 0.16 * np.sin(11 * phi))).tolist(),
            quasi_static_MPa=static.tolist(),
        )
        for gear in ("pinion", "wheel")
    ]
    return GearboxDynamics(
        role=role,
        torque="180 Nm",
        dynamic_factor=curve(1.0),
        dynamic_factor_at={"90 Nm": curve(1.2)},
        stage_loads=[
            StageLoad(
                stage="run_up",
                dynamic_factor=1.4,
                speed=1796.0 / RPM,
                mean=90.0,
                peak=126.0,
                least=54.0,
                least_share=0.6,
                least_share_speed=1796.0 / RPM,
                least_share_mean=90.0,
            )
        ],
        dynamic_torque_peak_Nm=331.0,
        iso_factors={"K_V": 0.872, "N": 4.06, "c_gamma_alpha": 13.9, "range": "supercritical"},
        lift_off=[ContactLoss(stage="run_up", start=2.31, end=2.42, share=0.02, longest_gap=1e-3)],
        resonances=resonances,
        unsolved=[UnsolvedSpeed(curve="90 Nm", speed=1800.0 / RPM, reason="not settled")],
        root_stress=histories if role == "specimen" else [],
        root_stress_factor=[
            RootStressRatio(speed=float(n) / RPM, pinion=float(k * 0.97), wheel=float(k * 0.95))
            for n, k in zip(speed[::4], kv[::4])
        ],
        geometry={
            "normal_module_mm": 1.0,
            "teeth_pinion": 99,
            "teeth_wheel": 102,
            "transverse_contact_ratio": 1.26,
        },
    )


def ramp():
    time = np.linspace(0, 16, 1600)
    stage = np.select(
        [time < 1, time < 2, time < 3, time < 10, time < 11.5, time < 14],
        ["bracing", "to bearing speed", "half torque", "run-up", "full torque", "dwell"],
        "ramp-down",
    )
    speed = np.interp(time, [0, 1, 2, 3, 10, 14, 16], [0, 0, 750, 750, 12000, 12000, 0])
    torque = np.interp(time, [0, 1, 2, 3, 10, 11.5, 14, 16], [10, 10, 10, 90, 90, 180, 180, 90])
    half = torque * (0.1 + 0.7 * np.exp(-(((speed - 1796) / 500) ** 2)))
    envelopes = {
        name: {
            "mean": torque.tolist(),
            "maximum": (torque + f * half).tolist(),
            "minimum": (torque - 0.8 * f * half).tolist(),
        }
        for name, f in (("test", 1.0), ("reference", 0.3))
    }
    return RampHistory(
        time_s=time.tolist(),
        speed_rpm=speed.tolist(),
        stage=stage.tolist(),
        target_torque_Nm=torque.tolist(),
        drive_torque_Nm=(2 + speed / 1700).tolist(),
        torque=envelopes,
    )


def dynamics():
    resonances = [
        MeshResonance(
            torque="180 Nm",
            mode="pinion against wheel, test",
            frequency=4022.7,
            harmonic=2,
            speed=1219.0 / RPM,
            dynamic_factor=1.2,
            force_share=0.2,
            amplification=2.6,
            at_end=False,
            dangerous=True,
        ),
        MeshResonance(
            torque="180 Nm",
            mode="wheel shaft, test",
            frequency=5926.7,
            harmonic=2,
            speed=1796.0 / RPM,
            dynamic_factor=1.3,
            force_share=0.3,
            amplification=1.2,
            at_end=False,
            dangerous=False,
        ),
    ]
    return DynamicsResult(
        gearboxes={"test": gearbox("specimen", 0.5, resonances), "reference": gearbox("rig", 0.1, [])},
        natural_frequencies=Records(
            [
                ListedMode(
                    mode=1,
                    frequency=412.0,
                    damping_ratio=0.04,
                    shape="test against reference gearbox",
                    largest_at="test_pinion",
                )
            ]
        ),
        damping_audit=Records(
            [
                JointDamping(
                    joint="test pinion spline",
                    kind="spline",
                    damping_ratio=0.34,
                    corner_frequency=2100.0,
                    own_frequency=400.0,
                    warning="damping_ratio 0.34 above 0.3; check the damper",
                )
            ]
        ),
        sampling={"samples_per_mesh": 2.02, "internal_steps": 8},
        bracing=Records(
            [
                HeldBracing(
                    stage="dwell",
                    mode="torque_controlled",
                    torque=180.0,
                    twist=0.0229,
                    axial_shift=3.9e-3,
                    half_gear_rotation=0.0115,
                    actuator_force=1240.0,
                    spline_friction=0.0,
                    loop_stiffness=1e4,
                    torque_as_drawn=180.0,
                    axial_shift_as_drawn=3.9e-3,
                )
            ]
        ),
        ramp=ramp(),
        torque_balance=Records(
            [TorqueBalance(stage="dwell", drive_torque=9.1, drive_power=11435.0, losses=11410.0)]
        ),
    )


def losses():
    places = [
        ("test_mesh", "mesh", 2900.0),
        ("reference_mesh", "mesh", 1500.0),
        ("test_windage", "windage", 700.0),
        *((f"bearing_{n}", "journal_bearing", 600.0 + 20 * n) for n in range(1, 9)),
        ("test_seals", "seal", 90.0),
    ]
    shares = {"to bearing speed": 0.01, "half torque": 0.02, "run-up": 0.55, "dwell": 1.0}
    return [
        LossRow(
            place=place,
            kind=kind,
            stage=stage,
            power=share * power,
            into_oil=0.8 * share * power,
            into_body=0.2 * share * power,
            basis="computed",
            details={"friction_coefficient": 0.021},
        )
        for place, kind, power in places
        for stage, share in shares.items()
    ]


def thermal_and_expansion():
    film = FilmCoefficient(
        value=19.5,
        formula="niemann_winter",
        inputs={"wall_K": 393.15, "height_m": 0.4},
        valid_range="0 < dT < 150 K",
        source="P2, Formula 2",
    )
    heat = [
        ("housing_warm", "air", -800.0, 0.35, film),
        ("housing_cold", "air", -962.0, 1.1, film),
        ("housing_warm", "radiation", -617.0, 0.35, None),
        ("chamber_wall", "oil", 2300.0, 0.4, film),
        ("shells", "bearing_film", 79.0, 0.02, None),
    ]
    thermal = HousingTemperatures(
        gearbox="test",
        stage="dwell",
        max_temperature=178.6 + ZERO_CELSIUS,
        max_temperature_body="shaft_pinion",
        heat=tuple(
            HeatFlow(surface=s, kind=k, power=p, area=a, mean_temperature=393.15, piece=0, coefficient=c)
            for s, k, p, a, c in heat
        ),
        closure_relative=3.1e-11,
        nodes=29412,
        elements=18234,
        bodies={"housing": BodyTemperature(mean=371.15, max=431.15, min=314.15)},
        room_heat=2379.0,
        alternatives=RadiationReadings(
            highest_radiation_included_false=444.35,
            highest_radiation_included_true=451.75,
            heat_to_the_room_under_the_other_reading=2210.0,
        ),
    )
    angle = np.linspace(0, 360, 37)
    seals = [
        {
            "seal": f"seal {side} {shaft}",
            "cold_mm": 0.6,
            "hot_min_mm": 0.571,
            "hot_mean_mm": 0.59,
            "angle_of_min_deg": 90.0,
            "hot_mm": (0.59 - 0.02 * np.sin(np.radians(angle + phase))).tolist(),
            "angle_deg": angle.tolist(),
        }
        for shaft in ("pinion", "wheel")
        for side, phase in (("left", 0), ("right", 60))
    ]
    expansion = ExpansionResult(
        gearbox="test",
        stage="dwell",
        seal_gaps=seals,
        shafts=[
            {
                "shaft": "pinion",
                "growth_mm": 0.53,
                "axial_play_cold_mm": 0.3,
                "axial_play_hot_mm": 0.062,
                "free_expansion_mm": 0.55,
            }
        ],
        gears=[
            {
                "pair": "test",
                "centre_distance_cold_mm": 99.5,
                "centre_distance_hot_mm": 99.62,
                "backlash_cold_mm": 0.12,
                "backlash_hot_mm": 0.16,
                "tip_clearance_cold_mm": 0.25,
                "tip_clearance_hot_mm": 0.2,
            }
        ],
        bearings=[{"bearing": "1", "diametral_clearance_cold_um": 60.0, "diametral_clearance_hot_um": 48.0}],
    )
    return thermal, expansion


def make_result(**changes):
    """A complete result; ``changes`` replaces fields."""
    thermal, expansion = thermal_and_expansion()
    values = {
        "case": {
            "name": "uhcf_prototype",
            "path": "cases/uhcf_prototype/case.toml",
            "hash": "9c" * 32,
            "title": "High-speed back-to-back rig, prototype",
        },
        "fidelity": "standard",
        "verdict": "fail",
        "checks": checks(),
        "dynamics": dynamics(),
        "losses": losses(),
        "oil": [
            OilRow(
                consumer=f"bearing_{n}",
                stage="dwell",
                inlet=313.15,
                outlet=325.15 + n,
                flow=2.0 / L_MIN,
                heat=650.0,
            )
            for n in range(1, 9)
        ]
        + [
            OilRow(
                consumer="test_mesh",
                stage="dwell",
                inlet=413.15,
                outlet=424.15,
                flow=12.0 / L_MIN,
                heat=2900.0,
            )
        ],
        "cooler": [
            CoolingBalance(
                stage="dwell",
                losses=12265.0,
                pump=14.0,
                heater=600.0,
                cooler=10500.0,
                room=2379.0,
                stored=None,
                not_heat=0.0,
                flow=26.0 / 6e4,
            )
        ],
        "thermal": [thermal],
        "expansion": [expansion],
        "coupling": [
            CouplingHistory(
                stage="dwell",
                residuals=tuple(
                    IterationResidual(
                        temperature=80.0 / 20**n, expansion=3e-4 / 18**n, torque_relative=0.02 / 12**n
                    )
                    for n in range(4)
                ),
            )
        ],
        "hand_checks": [
            HandCalculation(
                quantity="shaft growth, pinion", computed=0.53, by_hand=0.55, unit="mm", formula="alpha L dT"
            )
        ],
        "assumptions": [
            AssumptionRecord(
                path="gearboxes.test.seals.gap",
                value="0.6 mm",
                reason="main rig, P2 text",
                range=("0.5 mm", "0.7 mm"),
                decides=("seal_gap_minimum",),
            )
        ],
        "overrides": [],
        "not_modelled": ["shaft bending and tooth flank wear"],
        "warnings": [Finding(id="iso_6336_range", text="stiffness regression outside its range")],
        "timings_s": {"total": 21.4, "dynamics": 9.1},
        "fields": [gearbox_field()],
    }
    given = {**values, **changes}
    return RunResult(**{**given, "checks": Checks(given["checks"])})


def small_result(**changes):
    """A result without pictures, for tests that are not about them."""
    without = {
        "dynamics": None,
        **{key: [] for key in ("losses", "expansion", "thermal", "fields", "coupling", "oil")},
    }
    return make_result(**{**without, **changes})
