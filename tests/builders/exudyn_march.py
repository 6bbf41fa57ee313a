"""A drivetrain with k(phi) meshes marched by Exudyn (generalised-alpha), phase by the angle of the pinion.

M q'' + C q' + K q = load + mesh forces, with the force k(phi) x + d k(phi) / k_m x' of each mesh on its ports and, on
the pinion, what one potential k(phi) x^2 / 2 turns it with. The mesh is a user function with its Jacobian.
"""

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from time import process_time
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.sparse import csr_array

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class WaveMesh:
    """Contact for ever with the stiffness k (1 + depth cos(z phi)), phi the angle of the pinion.

    approach : (n,) row [m]; angle : (n,) row of the pinion [rad]; damping : [N s/m], waves with the stiffness
    play : added to the approach, backlash of a mesh that runs on its back flanks [m]
    """

    approach: Array
    angle: Array
    stiffness: float
    damping: float
    depth: float
    teeth: int
    play: float = 0.0

    def force(self, q: Array, rate: Array) -> float:
        """Normal force [N]."""
        shape = 1.0 + self.depth * np.cos(self.teeth * (self.angle @ q))
        x = self.approach @ q + self.play
        return float(shape * (self.stiffness * x + self.damping * (self.approach @ rate)))

    def torque(self, q: Array) -> float:
        """What the change of the stiffness turns the pinion with [N m]."""
        slope = -self.teeth * self.depth * self.stiffness * np.sin(self.teeth * (self.angle @ q))
        return float(-0.5 * slope * (self.approach @ q + self.play) ** 2)

    def tangent(self, q: Array) -> tuple[float, float]:
        """Change of the force with approach and rate, what Newton's method needs."""
        shape = 1.0 + self.depth * np.cos(self.teeth * (self.angle @ q))
        return shape * self.stiffness, shape * self.damping


@dataclass(frozen=True, kw_only=True)
class Motion:
    """Matrices (n, n), constant load (n,) and the state (n,) of the first instant."""

    mass: Array
    damping: Array
    stiffness: Array
    load: Array
    angles: Array
    speeds: Array


@dataclass(frozen=True, kw_only=True)
class ExudynSolver:
    """Matrices and their factors sparse or dense; relative tolerance of Newton's method."""

    sparse: bool = False
    tolerance: float = 1e-9


PRECISE = ExudynSolver()


def exudyn_march(
    motion: Motion,
    meshes: Sequence[WaveMesh],
    step: float,
    steps: int,
    every: int,
    solver: ExudynSolver = PRECISE,
) -> tuple[Array, float]:
    """Mesh forces (n_meshes, steps // every) after every so many steps, and processor seconds of the whole march.

    Spectral radius at infinity 0.9, modified Newton with matrices factored once.
    """
    exu = pytest.importorskip("exudyn")
    import exudyn.itemInterface as items  # noqa: N813

    body = exu.SystemContainer().AddSystem()
    n = len(motion.load)
    node = body.AddNode(
        items.NodeGenericODE2(
            numberOfODE2Coordinates=n,
            referenceCoordinates=[0.0] * n,
            initialCoordinates=list(motion.angles),
            initialCoordinates_t=list(motion.speeds),
        )
    )

    def contained(matrix: Any) -> Any:
        found = exu.MatrixContainer()
        if solver.sparse:
            found.SetWithSparseMatrix(csr_array(matrix), n, n, useDenseMatrix=False)
        else:
            found.SetWithDenseMatrix(matrix, useDenseMatrix=True)
        return found

    def force(mbs: Any, t: float, number: int, q: Any, rate: Any) -> Array:
        at, moving = np.asarray(q), np.asarray(rate)
        found = np.zeros(n)
        for mesh in meshes:
            found += mesh.torque(at) * mesh.angle - mesh.force(at, moving) * mesh.approach
        return found

    def jacobian(mbs: Any, t: float, number: int, q: Any, rate: Any, by_q: float, by_rate: float) -> Any:
        at = np.asarray(q)
        tangents = [mesh.tangent(at) for mesh in meshes]
        return contained(
            sum(
                (by_q * spring + by_rate * damper) * np.outer(mesh.approach, mesh.approach)
                for mesh, (spring, damper) in zip(meshes, tangents)
            )
        )

    body.AddObject(
        items.ObjectGenericODE2(
            nodeNumbers=[node],
            massMatrix=contained(motion.mass),
            stiffnessMatrix=contained(motion.stiffness),
            dampingMatrix=contained(motion.damping),
            forceVector=list(motion.load),
            forceUserFunction=force,
            jacobianUserFunction=jacobian,
        )
    )
    with warnings.catch_warnings():
        # names that the newest releases call by others
        warnings.simplefilter("ignore", DeprecationWarning)
        settings = exu.SimulationSettings()
        time = settings.timeIntegration
        time.numberOfSteps, time.endTime, time.verboseMode = steps, steps * step, 0
        time.generalizedAlpha.spectralRadius = 0.9
        time.newton.useModifiedNewton = True
        time.newton.modifiedNewtonContractivity = 1e3
        time.newton.relativeTolerance = solver.tolerance
        settings.parallel.numberOfThreads = 1
        settings.linearSolverType = getattr(
            exu.LinearSolverType, "EigenSparse" if solver.sparse else "EigenDense"
        )
        settings.solutionSettings.writeSolutionToFile = False
        settings.solutionSettings.sensorsWritePeriod = every * step
    sensor = body.AddSensor(
        items.SensorUserFunction(
            storeInternal=True,
            sensorUserFunction=lambda mbs, t, sensors, factors, configuration: [
                mesh.force(
                    np.asarray(mbs.systemData.GetODE2Coordinates()),
                    np.asarray(mbs.systemData.GetODE2Coordinates_t()),
                )
                for mesh in meshes
            ],
        )
    )
    body.Assemble()
    before = process_time()
    body.SolveDynamic(settings, solverType=exu.DynamicSolverType.GeneralizedAlpha)
    spent = process_time() - before
    return np.asarray(body.GetSensorStoredData(sensor))[1:, 1:].T, spent
