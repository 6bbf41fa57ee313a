"""Torque in shafts and joints of a loop in a periodic state, from the forces of its meshes.

The drivetrain between the meshes is linear: every harmonic of the torques on the gear bodies is taken to the twist of
each section by the receptance, the mean by the stiffness. Exact for the state that is given.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dynamics.rotor.graph import TwistRows
from dynamics.rotor.linear_system import LinearSystem
from dynamics.rotor.parts import harmonic_loads, within_period
from dynamics.rotor.static_loop import PortModel, line_ratios, port_model
from dynamics.tooth.law import MeshLaw
from dynamics.tooth.mesh_force import evaluate_mesh
from dynamics.vibration.harmonic_balance import input_torques, mesh_inputs
from dynamics.vibration.response_curve import CurvePoint, Waveform

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


@dataclass(frozen=True, eq=False)
class SectionTorques:
    """A loop at one running state; makes the torques of its sections at any periodic state found with it."""

    system: LinearSystem
    rows: TwistRows
    model: PortModel
    ratios: Array
    """(n,) speed of each freedom per speed of the drive freedom."""
    into: Complex
    """(n_states, n_inputs) modal loads of unit torques on the inputs of the meshes (`mesh_inputs`)."""
    seen: Complex
    """(r, n_states) twist rate of each row per modal state."""
    flexibility: Array
    """(r, n) twist of each row per load on each freedom at rest."""

    def over_period(self, point: CurvePoint, drag_torques: Mapping[str, float] | None = None) -> Array:
        """Torque (r, count) at the times of ``point.wave`` [N m]; positive where the first end turns ahead.

        drag_torques : by name of ``system.drag_loads`` [N m], those with which the state was found
        """
        wave = point.wave
        count = wave.time.size
        base = 2.0 * np.pi / (count * float(wave.time[1] - wave.time[0]))
        loads = self._mesh_loads(wave)
        spectrum = np.fft.rfft(loads, axis=1) / count
        cells = round(self.model.laws[0].teeth_1 * point.speed / base)  # mesh periods in the period
        top = min(count // 4, cells * (point.harmonics.shape[1] - 1))
        drive_speed = point.speed / float(self.ratios[self.system.mesh_ports[0, 0]])
        omega = base * np.arange(1, top + 1)
        form = self.system.form
        states = self.into @ spectrum[:, 1 : top + 1]
        states += self._driven(point, base, drive_speed, top)
        states /= 1j * omega - form.poles[:, None]
        rate = self.seen @ states
        rows = self.rows
        coefficients = np.zeros((len(rows.sections), count // 2 + 1), complex)
        coefficients[:, 1 : top + 1] = (rows.stiffness[:, None] / (1j * omega) + rows.damping[:, None]) * rate
        coefficients[:, 0] = self._mean(point, spectrum[:, 0].real, drive_speed, drag_torques or {})
        return np.asarray(np.fft.irfft(coefficients * count, count, axis=1))

    def _mesh_loads(self, wave: Waveform) -> Array:
        """Torque (n_inputs, count) on the inputs of the meshes."""
        loads = np.zeros((len(self.model.loads), wave.time.size))
        for m, (packed, inputs) in enumerate(zip(self.model.packed, mesh_inputs(self.model))):
            motion = wave.angle[m], wave.approach[m], wave.omega_1[m], wave.omega_2[m]
            for at, (torque, *_) in zip(inputs, input_torques(self.model, m, evaluate_mesh(packed, *motion))):
                loads[at] += torque
        return loads

    def _driven(self, point: CurvePoint, base: float, drive_speed: float, top: int) -> Complex:
        """Modal loads (n_states, top) of loads that alternate with a shaft, in phase with the pinion.

        Those alone that the response was found with, which the asked period holds: not those that fit into the longer
        time that a subharmonic motion, or one without a period, is shown for.
        """
        wave = point.wave
        form = self.system.form
        loads = np.zeros((form.poles.size, top), complex)
        if not self.system.periodic_loads:
            return loads
        pinion = float(self.ratios[self.system.mesh_ports[0, 0]])
        lead = float(np.mean(wave.angle[0] / pinion - drive_speed * (wave.time - wave.time[0])))
        turns = drive_speed / base
        asked = (
            turns / point.motion.periods
            if point.motion.periods
            else 1.0 / (self.model.laws[0].teeth_1 * pinion)
        )
        held = within_period(self.system.periodic_loads, self.ratios, asked)
        for harmonic, load in harmonic_loads(held, self.ratios, turns, drive_speed).items():
            if harmonic <= top:
                phase = np.exp(1j * lead * harmonic / turns)
                loads[:, harmonic - 1] += 0.5 * phase * (form.loads @ load)
        return loads

    def _mean(
        self, point: CurvePoint, mesh: Array, drive_speed: float, drag_torques: Mapping[str, float]
    ) -> Array:
        system = self.system
        load = system.twist_load * point.twist - system.damping @ self.ratios * drive_speed
        load += self.model.loads.T @ mesh
        load[system.drive_dof] += point.drive_torque
        for name, torque in drag_torques.items():
            load = load + system.drag_loads[name] * torque
        twist = self.flexibility @ load - self.rows.bracing * point.twist
        return np.asarray(self.rows.stiffness * twist)


def section_torques(system: LinearSystem, laws: Sequence[MeshLaw], rows: TwistRows) -> SectionTorques:
    """Torques of the sections of a system with the mesh laws of its periodic states."""
    scale = float(np.max(np.abs(np.diag(system.stiffness))))
    held = system.stiffness + scale * system.rigid @ system.rigid.T
    model = port_model(system, laws)
    return SectionTorques(
        system=system,
        rows=rows,
        model=model,
        ratios=line_ratios(system, laws),
        into=system.form.into(model.loads),
        seen=rows.rows @ system.form.velocity_shapes,
        flexibility=np.asarray(np.linalg.solve(held.T, rows.rows.T).T, float),
    )
