"""Speed of the march: steps per second with the shipped mesh law, and against Exudyn on a law both can express.

Times are processor times of one thread, the best of some runs; a figure that is missed is printed, not failed.
Run with ``pytest -m performance -s tests/performance/test_dynamics_speed.py``.
"""

import warnings
from time import process_time

import numpy as np
import pytest

from dynamics.gear.microgeometry import Microgeometry
from dynamics.rating.iso_rating import mesh_stiffness
from dynamics.rotor.graph import assemble
from dynamics.rotor.linear_system import LinearSystem
from dynamics.rotor.static_loop import LoopLoad
from dynamics.tooth.law import MeshLaw
from dynamics.tooth.mesh_laws import ContactDiscretisation, MeshDissipation, mesh_law, pair_stiffness
from dynamics.vibration.initial_state import wound_state
from dynamics.vibration.march_inputs import DriveLoads, DriveState, MarchSettings
from dynamics.vibration.time_integration import TimeMarch
from tests.builders.mesh import wavy_law
from tests.builders.p2_gears import ALLOWANCES, helical_pair, spur_pair
from tests.builders.rig import BASE_RADIUS_REFERENCE, BASE_RADIUS_TEST, prototype

pytestmark = pytest.mark.performance

SPEED = 12000.0 * np.pi / 30.0
TORQUE = 180.0
SAMPLE_RATE = 40e3
DEPTHS = (0.25, 0.05)
STIFFNESSES = (1.1e8, 7.0e8)
DAMPING = 1e3
BACKLASH = 100e-6


def rig() -> LinearSystem:
    """The prototype with 62 freedoms."""
    return assemble(prototype(element_length=0.033, linear_drag=7e-4))


def shipped_laws() -> list[MeshLaw]:
    """Test gear in 5 slices and reference gear in 12, with the modifications of P2, Figure 7."""
    test = spur_pair(**ALLOWANCES)
    reference = helical_pair(**ALLOWANCES)
    micro = (
        Microgeometry(profile_crowning=7e-6, lead_crowning=5e-6),
        Microgeometry(profile_crowning=5e-6, lead_crowning=3e-6),
    )
    laws = []
    for pair, relief, slices in ((test, micro[0], 5), (reference, micro[1], 12)):
        load = TORQUE / pair.base_radii[0] / pair.face_width
        shape = pair_stiffness(pair, load).scaled_to(mesh_stiffness(pair, TORQUE))
        laws.append(
            mesh_law(
                pair,
                shape,
                micro=(relief, relief),
                dissipation=MeshDissipation(damping=DAMPING, friction=0.04),
                discretisation=ContactDiscretisation(n_slices=slices),
            )
        )
    return laws


def phase_laws() -> list[MeshLaw]:
    """One contact whose stiffness is a cosine of the mesh angle: a law that Exudyn can be given as an expression."""
    laws = []
    for radius, stiffness, depth in zip((BASE_RADIUS_TEST, BASE_RADIUS_REFERENCE), STIFFNESSES, DEPTHS):
        law = wavy_law(depth, damping=DAMPING, backlash=BACKLASH)
        pitch = 2.0 * np.pi * radius / 99
        laws.append(
            law._replace(
                base_radius_1=radius,
                base_radius_2=radius * 102 / 99,
                base_pitch=pitch,
                path_step=pitch / 200,
                stiffness=law.stiffness * stiffness / law.mean_stiffness,
                mean_stiffness=stiffness,
                damping_depth=1e-9,
                back_phase=0.0,
            )
        )
    return laws


def march_time(
    system: LinearSystem, laws: list[MeshLaw], start: DriveState, substeps: int, samples: int
) -> float:
    """Processor seconds per internal step."""
    given = np.tile([0.0, start.twist, 0.0, 0.0], (samples, 1))
    best = np.inf
    for _ in range(5):
        march = TimeMarch(
            system,
            laws,
            start,
            settings=MarchSettings(
                step=1.0 / SAMPLE_RATE / substeps, substeps=substeps, accounts=False, record_all=False
            ),
        )
        march.advance(given[:50])
        before = process_time()
        march.advance(given)
        best = min(best, (process_time() - before) / samples / substeps)
        assert march.unconverged == 0
    return best


def test_shipped_law_on_the_prototype() -> None:
    system, laws = rig(), shipped_laws()
    start, _, _ = wound_state(system, laws, speed=SPEED, load=LoopLoad(torque=TORQUE))
    step = march_time(system, laws, start, 8, 8000)
    rate = 1e-6 / step
    modes = len(TimeMarch(system, laws, start, settings=MarchSettings(step=1e-6)).model.eigenvalues)
    print(
        f"\nshipped law, {len(system.inertia)} freedoms, {modes} modes, 5 + 12 slices: "
        f"{rate:.2f} million steps/s (wanted 2), {320e3 * step:.3f} s per simulated second"
    )


def test_shared_body_on_the_prototype() -> None:
    """The same mesh stiffness with 40 % of the compliance in bodies that the pairs share, against none."""
    system, laws = rig(), shipped_laws()
    shared = [
        law._replace(stiffness=law.stiffness / 0.6, body_compliance=0.4 / law.mean_stiffness) for law in laws
    ]
    times: dict[bool, float] = {False: np.inf, True: np.inf}
    for _ in range(4):
        for body, of in ((False, laws), (True, shared)):
            start, _, _ = wound_state(system, of, speed=SPEED, load=LoopLoad(torque=TORQUE))
            times[body] = min(times[body], march_time(system, of, start, 8, 2000))
    print(
        f"\nshared body: {1e-6 / times[True]:.2f} million steps/s, {times[True] / times[False]:.2f} times "
        "the time of pairs that deflect alone (wanted 1.5)"
    )


def forces_of_march(
    system: LinearSystem, start: DriveState, drive: float, substeps: int, samples: int
) -> np.ndarray:
    """Mesh forces at the samples (2, n), without the derivative torques that the expression lacks."""
    march = TimeMarch(
        system,
        phase_laws(),
        start,
        settings=MarchSettings(
            step=1.0 / SAMPLE_RATE / substeps,
            substeps=substeps,
            accounts=False,
            record_all=False,
            derivative_torques=False,
        ),
        loads=DriveLoads(drive_torque=drive),
    )
    force = march.advance(np.tile([drive, start.twist, 0.0, 0.0], (samples, 1))).force
    return force[:, substeps - 1 :: substeps]


def forces_of_exudyn(
    system: LinearSystem, start: DriveState, drive: float, substeps: int, samples: int, solver: str
) -> tuple[np.ndarray, float]:
    """Mesh forces at the samples (2, n) and processor seconds per step, generalised-alpha, mesh law compiled."""
    exu = pytest.importorskip("exudyn")
    import exudyn.itemInterface as items  # noqa: N813
    from exudyn.advancedUtilities import CreateSymbolicUserFunction

    n = len(system.inertia)
    load = system.twist_load * start.twist
    load[system.drive_dof] += drive
    symbols = exu.symbolic
    body = exu.SystemContainer().AddSystem()
    node = body.AddNode(
        items.NodeGenericODE2(
            numberOfODE2Coordinates=n,
            referenceCoordinates=[0.0] * n,
            initialCoordinates=list(start.angles),
            initialCoordinates_t=list(start.speeds),
        )
    )
    body.AddObject(
        items.ObjectGenericODE2(
            nodeNumbers=[node],
            massMatrix=system.inertia,
            stiffnessMatrix=system.stiffness,
            dampingMatrix=system.damping,
            forceVector=list(load),
        )
    )
    sensors = []
    for (pinion, wheel), law, depth in zip(system.mesh_ports, phase_laws(), DEPTHS):
        markers = [
            body.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=int(at)))
            for at in (wheel, pinion)
        ]
        spring = body.AddObject(
            items.ObjectConnectorCoordinateSpringDamperExt(
                markerNumbers=markers,
                stiffness=law.mean_stiffness,
                damping=DAMPING,
                factor0=law.base_radius_2,
                factor1=law.base_radius_1,
            )
        )
        k, frequency = law.mean_stiffness, 99.0 * float(start.speeds[pinion])
        first = 99.0 * float(start.angles[pinion])

        # the signature is Exudyn's
        def force(
            mbs,
            t,
            itemNumber,
            displacement,
            velocity,
            stiffness,
            damping,
            offset,
            velocityOffset,
            dynamicFrictionForce,
            staticFrictionOffsetForce,
            exponentialDecayStatic,
            viscousFrictionFactor,
            frictionProportionalZone,
            k=k,
            frequency=frequency,
            depth=depth,
            first=first,
        ):
            shape = 1.0 + depth * symbols.cos(frequency * t + first)
            play = displacement + BACKLASH
            none = 0.0 * displacement
            front = symbols.max(shape * (k * displacement + DAMPING * velocity), none)
            back = symbols.min(shape * (k * play + DAMPING * velocity), none)
            return symbols.IfThenElse(displacement > 0.0, front, none) + symbols.IfThenElse(
                play < 0.0, back, none
            )

        symbolic = CreateSymbolicUserFunction(body, _fixed(force), "springForceUserFunction", spring)
        body.SetObjectParameter(spring, "springForceUserFunction", symbolic)
        sensors.append(
            body.AddSensor(
                items.SensorObject(
                    objectNumber=spring, storeInternal=True, outputVariableType=exu.OutputVariableType.Force
                )
            )
        )
    body.Assemble()
    settings = exu.SimulationSettings()
    time = settings.timeIntegration
    time.numberOfSteps, time.endTime = samples * substeps, samples / SAMPLE_RATE
    time.generalizedAlpha.spectralRadius = 0.9
    time.newton.useModifiedNewton = True
    time.newton.modifiedNewtonContractivity = 1e3
    time.newton.relativeTolerance = 1e-6
    settings.parallel.numberOfThreads = 1
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)
        settings.linearSolverType = getattr(exu.LinearSolverType, solver)
        settings.solutionSettings.writeSolutionToFile = False
        settings.solutionSettings.sensorsWritePeriod = 1.0 / SAMPLE_RATE
    before = process_time()
    body.SolveDynamic(settings, solverType=exu.DynamicSolverType.GeneralizedAlpha)
    spent = process_time() - before
    return np.array([body.GetSensorStoredData(s)[1:, 1] for s in sensors]), spent / samples / substeps


def _fixed(force):
    """Hide the bound values from Exudyn, which counts the arguments."""

    def bound(a, b, c, d, e, f, g, h, i, j, k, l, m, n):  # noqa: E741
        return force(a, b, c, d, e, f, g, h, i, j, k, l, m, n)

    return bound


def error(force: np.ndarray, reference: np.ndarray) -> float:
    """Rms error over the dynamic part of the first mesh."""
    n = min(force.shape[1], reference.shape[1])
    difference = force[0, :n] - reference[0, :n]
    return float(np.sqrt(np.mean(difference**2)) / np.std(reference[0, :n]))


def test_phase_law_against_exudyn() -> None:
    pytest.importorskip("exudyn")
    system, laws = rig(), phase_laws()
    speed = 3000.0 * np.pi / 30.0
    start, drive, _ = wound_state(system, laws, speed=speed, load=LoopLoad(torque=TORQUE))
    step = march_time(system, laws, start, 8, 8000)
    print(f"\nk(phi) law: {1e-6 / step:.2f} million steps/s (wanted 5)")
    samples = 400
    ours = {n: forces_of_march(system, start, drive, n, samples) for n in (8, 16, 64)}
    theirs = {n: forces_of_exudyn(system, start, drive, n, samples, "EigenSparse") for n in (8, 16, 64)}
    dense = min(forces_of_exudyn(system, start, drive, 8, samples, "EXUdense")[1] for _ in range(2))
    sparse = min(theirs[n][1] for n in theirs)
    for n in (8, 16):
        print(
            f"  {n:2d} steps per sample: error {error(ours[n], ours[64]):.1e}, "
            f"Exudyn {error(theirs[n][0], theirs[64][0]):.1e}"
        )
    print(
        f"  the two references differ by {error(theirs[64][0], ours[64]):.1e} (phase from angle or from time)"
    )
    coarse, fine = error(ours[8], ours[64]), error(theirs[8][0], theirs[64][0])
    as_good = np.sqrt(max(fine / coarse, 1.0))
    print(
        f"  Exudyn {sparse * 1e6:.1f} us per step (sparse, loosest Newton), {dense * 1e6:.1f} us (dense): "
        f"{sparse / step:.0f} and {dense / step:.0f} times ours at equal steps, {as_good * sparse / step:.0f} and "
        f"{as_good * dense / step:.0f} times at equal error (wanted 100)"
    )
